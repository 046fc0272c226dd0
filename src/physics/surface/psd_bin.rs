//! One bin of a periodogram.

/// Average power spectral density over a ring of wavevectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Mean wavenumber q \[1/m\].
    pub wavenumber_1_m: f64,
    /// Mean power spectral density C(q) \[m⁴\].
    pub density_m4: f64,
    /// Number of modes.
    pub mode_count: u64,
}

/// Estimate of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Estimate {
    /// Periodogram, of a periodic surface or under a window.
    Periodogram,
    /// Mean of the periodograms under sine tapers.
    Tapered,
}
