//! Far-field multipole expansion of a spot: `ŵ = Σ_m c_m / r^(2m+1)`, m = 0 … 3.
//!
//! The coefficients follow from the series of Eqs 6 and 7 in `x = a/r`:
//! `[…] = (4/3) x (1 + x²/10 + 9x⁴/280 + 5x⁶/336 + …)` and `asin x = x + x³/6 + 3x⁵/40 + 5x⁷/112 + …`.
//! `c_0 = F/(πE*)`. The relative truncation error at the distance r is at most `(a/r)⁸/100`.

use super::ewald::ORDERS;
use super::spot_field::SpotColumns;
use crate::model::Interaction as Kind;
use std::f64::consts::FRAC_1_PI;

/// Coefficients of the indentation and of the adhesive part.
pub(super) const HERTZ: [f64; ORDERS] = [4.0 / 3.0, 4.0 / 30.0, 12.0 / 280.0, 20.0 / 1008.0];
pub(super) const PUNCH: [f64; ORDERS] = [1.0, 1.0 / 6.0, 3.0 / 40.0, 5.0 / 112.0];

/// Multipole moments of every spot, `c_m/L^(2m+1)` \[m\], and their derivatives to its radius.
#[derive(Debug, Clone, Default)]
pub(crate) struct Moments {
    pub(crate) value: Vec<[f64; ORDERS]>,
    pub(crate) slope: Vec<[f64; ORDERS]>,
}

impl Moments {
    /// Moments of the spots in the columns.
    ///
    /// `pull` is `sqrt(2πΔγ/E*)` \[m^½\], `compliance` is `1/(πE*)` \[1/Pa\], `length` is L \[m\].
    pub(crate) fn of(kind: Kind, spots: &SpotColumns, pull: f64, compliance: f64, length: f64) -> Self {
        let n = spots.len();
        let mut all = Self { value: Vec::with_capacity(n), slope: Vec::with_capacity(n) };
        for j in 0..n {
            let (mut value, mut slope) = ([0.0; ORDERS], [0.0; ORDERS]);
            match kind {
                Kind::None => {}
                Kind::Point => {
                    value[0] = compliance / length * spots.load[j];
                    slope[0] = compliance / length * spots.load_slope[j];
                }
                Kind::Spots => {
                    let a = spots.a[j];
                    let flat = a * a * spots.inverse_radius[j];
                    let stick = 2.0 * pull * spots.root_a[j];
                    let mut power = FRAC_1_PI * a / length;
                    for m in 0..ORDERS {
                        let (hertz, punch) = (HERTZ[m] * flat * power, PUNCH[m] * stick * power);
                        value[m] = hertz - punch;
                        // The terms scale as a³ and a^(3/2), and gain a factor a² with every order.
                        slope[m] = ((2 * m + 3) as f64 * hertz - (2.0 * m as f64 + 1.5) * punch) / a;
                        power *= (a / length) * (a / length);
                    }
                }
            }
            all.value.push(value);
            all.slope.push(slope);
        }
        all
    }
}

/// `Σ_m S_m c_m`: displacement from sums of powers of distance and the moments of a spot.
#[inline(always)]
pub(crate) fn product(sums: &[f64; ORDERS], moments: &[f64; ORDERS]) -> f64 {
    sums[0].mul_add(moments[0], sums[1] * moments[1]) + sums[2].mul_add(moments[2], sums[3] * moments[3])
}
