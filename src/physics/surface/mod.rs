//! Rough surfaces: spectra, synthesis, measured surfaces, and their asperities.

pub mod band_limited;
mod constants;
mod levelling;
pub mod measured;
pub(crate) mod modes;
pub mod periodogram;
pub(crate) mod psd_bin;
pub mod self_affine;
mod spectral_band;
mod spectral_line;
pub mod spectrum;
pub mod summits;
pub mod synthesis;
pub mod texture;

pub(super) use constants::CONSTANTS;
