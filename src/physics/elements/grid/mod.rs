//! Regular grid: response of the half-space by Fourier transforms, deterministic sums, resampling.

pub mod half_space;
mod images;
pub mod medium;
pub mod resample;
pub(crate) mod sums;
