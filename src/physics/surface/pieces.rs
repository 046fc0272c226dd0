//! Isotropic spectra as sequences of power laws.

/// Power law `C = level (q/from)^(−exponent)` for `from ≤ q < to`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) level: f64,
    pub(crate) exponent: f64,
}

impl Piece {
    pub(super) fn at(&self, q: f64) -> f64 {
        self.level * (q / self.from).powf(-self.exponent)
    }

    /// `∫ q^n C dq` over the part of the piece from `low` to `high`.
    fn integral(&self, n: f64, low: f64, high: f64) -> f64 {
        let (low, high) = (low.max(self.from), high.min(self.to));
        if low >= high {
            return 0.0;
        }
        let (power, span) = (n + 1.0 - self.exponent, (high / low).ln());
        // `(x^p − 1)/p` without cancellation near p = 0.
        let relative = if power == 0.0 { span } else { (power * span).exp_m1() / power };
        self.at(low) * low.powf(n + 1.0) * relative
    }
}

/// Isotropic spectrum of adjacent power laws, zero outside.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pieces(pub(crate) Vec<Piece>);

impl Pieces {
    /// Density at a wavenumber.
    pub(crate) fn at(&self, q: f64) -> f64 {
        let place = self.0.partition_point(|piece| piece.to <= q);
        self.0.get(place).filter(|piece| piece.from <= q).map_or(0.0, |piece| piece.at(q))
    }

    /// `∫ q^n C dq` from `low` to `high`.
    pub(super) fn integral(&self, n: f64, low: f64, high: f64) -> f64 {
        let first = self.0.partition_point(|piece| piece.to <= low);
        self.0[first..]
            .iter()
            .take_while(|piece| piece.from < high)
            .map(|piece| piece.integral(n, low, high))
            .sum()
    }
}
