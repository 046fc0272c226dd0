//! Rough surfaces: spectra, synthesis, measured surfaces, and their asperities.

pub mod artefacts;
pub mod band_limited;
pub mod common_spectrum;
mod constants;
pub(crate) mod continuation;
pub mod edges;
mod height_map;
mod infill;
mod lattice;
mod levelling;
pub mod measured;
mod measured_summits;
pub mod modes;
pub mod outliers;
pub mod periodogram;
mod pieces;
pub(crate) mod psd_bin;
pub mod psd_table;
pub mod rows;
mod s_filter;
pub mod self_affine;
pub mod shape;
mod spectral_band;
mod spectral_line;
pub mod spectrum;
pub mod summits;
pub mod synthesis;
pub mod texture;
pub mod tip;

pub(super) use constants::CONSTANTS;
pub use height_map::{HeightMap, SquareMap};
