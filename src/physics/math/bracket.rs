//! Change of sign of a function between two points, by the Illinois rule (Dowell & Jarratt, BIT 11:168,
//! 1971): the straight line between the ends. The value at an end is halved if that end is kept twice.

/// The values at both ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Illinois {
    low: f64,
    high: f64,
    last: Option<End>,
}

/// An end of the bracket.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    Low,
    High,
}

impl Illinois {
    /// Between two points at which the function has these values, of opposite sign.
    pub(crate) fn new(low: f64, high: f64) -> Self {
        Self { low, high, last: None }
    }

    /// Next point of evaluation, as a fraction of the interval from the low end, no nearer to an end than
    /// `margin`.
    pub(crate) fn share(&self, margin: f64) -> f64 {
        (self.low / (self.low - self.high)).clamp(margin, 1.0 - margin)
    }

    /// Replaces the low or the high end by the evaluated point; the function has this value there.
    pub(crate) fn narrow(&mut self, end: End, value: f64) {
        let (mine, other) = match end {
            End::Low => (&mut self.low, &mut self.high),
            End::High => (&mut self.high, &mut self.low),
        };
        *mine = value;
        if self.last == Some(end) {
            *other *= 0.5;
        }
        self.last = Some(end);
    }
}

#[cfg(test)]
mod tests {
    use super::{End, Illinois};

    #[test]
    fn law_a_bracket_narrows_to_the_root_faster_than_by_halving() {
        let f = |x: f64| x * x * x - 2.0;
        let (mut low, mut high) = (0.0, 4.0);
        let mut ends = Illinois::new(f(low), f(high));
        let mut evaluations = 0;
        while high - low > 1e-12 && evaluations < 60 {
            evaluations += 1;
            let x = low + ends.share(1e-4) * (high - low);
            let value = f(x);
            if value.abs() < 1e-14 {
                (low, high) = (x, x);
            } else if value < 0.0 {
                low = x;
                ends.narrow(End::Low, value);
            } else {
                high = x;
                ends.narrow(End::High, value);
            }
            assert!(f(low) <= 1e-14 && f(high) >= -1e-14, "the root stays inside");
        }
        assert!((low - 2f64.cbrt()).abs() < 1e-12, "{low}");
        // Halving takes 42 evaluations.
        assert!(evaluations <= 20, "{evaluations}");
    }
}
