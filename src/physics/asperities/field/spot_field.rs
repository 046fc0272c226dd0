//! Displacement field of one JKR contact spot (Eqs 6–8), without cancellation.
//!
//! Outside the spot (`r > a`), with `x = a/r` and `w = sqrt(1 − x²)`,
//! `ŵ = a²/(πR)·[sqrt(r²/a² − 1) + (2 − r²/a²) asin x] − (2/π) sqrt(2πaΔγ/E*) asin x`. The bracket as printed
//! suffers from cancellation: its relative error grows as `(r/a)²` and is 1e-4 at `r/a` = 1e6. But
//! `[…]/x` and `asin(x)/x` are analytic in `w` on `[0, 1]` (the nearest singularity is `w = −1`). One
//! polynomial in `w` for each is therefore accurate for every `r ≥ a`.

use crate::model::Slips;
use multiversion::multiversion;
use std::f64::consts::FRAC_1_PI;

/// `[sqrt(1/x² − 1) + (2 − 1/x²) asin x]/x` in powers of `s = w − ½`, highest first.
///
/// Minimax approximation, relative error 9e-17.
const INDENTATION: [f64; 22] = [
    0.001166020232859638,
    -0.0016236722568745462,
    0.0007617147482043354,
    -0.0012016627625799537,
    0.002683823307720469,
    -0.003818847756087897,
    0.005178305326753135,
    -0.007438869846337943,
    0.010680746344367243,
    -0.015158587521104433,
    0.02137110262348854,
    -0.029898940016350056,
    0.041395191820704065,
    -0.05651807389310623,
    0.075682573829652,
    -0.09847681892188491,
    0.1223382371530662,
    -0.13952391392448704,
    0.12982222356259113,
    -0.04088700513833588,
    -0.27893276820819257,
    1.47279971743743,
];

/// `asin(x)/x` in powers of `s = w − ½`, highest first.
///
/// Minimax approximation; total relative error 2.4e-15 in double precision.
const ADHESION: [f64; 20] = [
    -0.00018447374107194618,
    0.000278513789393206,
    -0.00019817470016813036,
    0.00031264369210879685,
    -0.0006070460451784989,
    0.0009378575950287316,
    -0.0014210070629840405,
    0.002215128844038917,
    -0.003468983388172752,
    0.005442305326898612,
    -0.008575530995573085,
    0.013586836218737923,
    -0.0216716746061886,
    0.034865536463000904,
    -0.05673371072325626,
    0.09378606357545788,
    -0.15869717538018224,
    0.2789327682083683,
    -0.5272002825625688,
    1.209199576156145,
];

/// `[…]/x` and `asin(x)/x` at several points at once.
///
/// Each step advances all lanes and both polynomials: one Horner chain alone is limited by latency.
#[inline(always)]
fn polynomials<const L: usize>(s: &[f64; L]) -> ([f64; L], [f64; L]) {
    let mut indentation = [INDENTATION[0]; L];
    let mut arc = [ADHESION[0]; L];
    for &coefficient in &INDENTATION[1..3] {
        for k in 0..L {
            indentation[k] = indentation[k].mul_add(s[k], coefficient);
        }
    }
    for (&first, &second) in INDENTATION[3..].iter().zip(&ADHESION[1..]) {
        for k in 0..L {
            indentation[k] = indentation[k].mul_add(s[k], first);
            arc[k] = arc[k].mul_add(s[k], second);
        }
    }
    (indentation, arc)
}

/// One contact spot as a source of displacement.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spot {
    /// Position x \[m\].
    pub x: f64,
    /// Position y \[m\].
    pub y: f64,
    /// Contact radius a \[m\].
    pub a: f64,
    /// Radius of curvature R \[m\].
    pub radius: f64,
    /// Load F \[N\].
    pub load: f64,
    /// dF/da \[N/m\].
    pub load_slope: f64,
}

/// Displacement ŵ \[m\] by a spot, and its derivative to the spot's radius.
///
/// `r > 0` \[m\] is the distance from the centre of the spot.
///
/// `pull` is `sqrt(2πΔγ/E*)` \[m^½\]. Eqs 6 and 7 outside; inside, `ŵ = a²/R − r²/(2R) − sqrt(2πaΔγ/E*)`.
///
/// # Deviations
/// The paper's Eq 8 lacks `r²/(2R)` inside, without which the field jumps by `a²/(2R)` at the edge.
/// [`spot_field_as_printed`] can restore the printed equation.
#[must_use]
pub fn spot_field(r: f64, a: f64, radius: f64, pull: f64) -> (f64, f64) {
    spot_field_as_printed(r, a, radius, pull, Slips::NONE)
}

/// [`spot_field`], with Eq 8 as printed if `slips` contains it.
///
/// The printed equation is `ŵ = a²/R − sqrt(2πaΔγ/E*)` at every r inside.
///
/// The derivative to the spot's radius is unchanged; it does not include the jump at the edge.
#[must_use]
#[multiversion(targets("x86_64+avx2+fma"))]
pub fn spot_field_as_printed(r: f64, a: f64, radius: f64, pull: f64, slips: Slips) -> (f64, f64) {
    let ([value], [slope]) =
        field(&[r * r], &[a], &[a.sqrt()], &[1.0 / a.sqrt()], &[1.0 / radius], pull, sag(slips));
    (value, slope)
}

/// Coefficient of `r²/R` inside a spot: ½, or 0 with Eq 8 as printed.
pub(crate) fn sag(slips: Slips) -> f64 {
    if slips.eq8 { 0.0 } else { 0.5 }
}

/// Selects one of two computed values without a branch, so that the loop vectorises.
#[inline(always)]
fn either(first: bool, one: f64, other: f64) -> f64 {
    let mask = u64::from(first).wrapping_neg();
    f64::from_bits((one.to_bits() & mask) | (other.to_bits() & !mask))
}

/// Fields of several spots, from squared distances.
#[inline(always)]
pub(crate) fn field<const L: usize>(
    r2: &[f64; L],
    a: &[f64; L],
    root_a: &[f64; L],
    inverse_root_a: &[f64; L],
    curvature: &[f64; L],
    pull: f64,
    sag: f64,
) -> ([f64; L], [f64; L]) {
    let (mut r, mut inverse_r) = ([0.0; L], [0.0; L]);
    for k in 0..L {
        r[k] = r2[k].sqrt();
        inverse_r[k] = 1.0 / r[k];
    }
    field_at(&r, &inverse_r, a, root_a, inverse_root_a, curvature, pull, sag)
}

/// Fields of several spots, from distances and their inverses.
///
/// Both formulae are evaluated and one is selected, so that the loop vectorises.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
pub(crate) fn field_at<const L: usize>(
    r: &[f64; L],
    inverse_r: &[f64; L],
    a: &[f64; L],
    root_a: &[f64; L],
    inverse_root_a: &[f64; L],
    curvature: &[f64; L],
    pull: f64,
    sag: f64,
) -> ([f64; L], [f64; L]) {
    let (mut half_chord, mut s) = ([0.0; L], [0.0; L]);
    for k in 0..L {
        // `sqrt(r² − a²)` as `(r − a)(r + a)` keeps the digits that `1 − x²` would lose near the edge.
        half_chord[k] = ((r[k] - a[k]) * (r[k] + a[k])).max(0.0).sqrt();
        s[k] = half_chord[k].mul_add(inverse_r[k], -0.5);
    }
    let (indentation, arc) = polynomials(&s);
    let (mut value, mut slope) = ([0.0; L], [0.0; L]);
    for k in 0..L {
        let x = a[k] * inverse_r[k];
        let (arc, indentation) = (x * arc[k], x * indentation[k]);
        let flat = a[k] * curvature[k];
        let inside = r[k] <= a[k];
        let outer = FRAC_1_PI * (a[k] * flat).mul_add(indentation, -2.0 * pull * root_a[k] * arc);
        let inner = a[k].mul_add(flat, -sag * r[k] * r[k] * curvature[k]) - pull * root_a[k];
        value[k] = either(inside, inner, outer);
        // The slope is infinite at the edge; a large finite value keeps linear systems solvable.
        let crack = 0.5 * arc * inverse_root_a[k] + root_a[k] / half_chord[k].max(1e-7 * a[k]);
        let outer_slope = FRAC_1_PI * (4.0 * flat).mul_add(arc, -2.0 * pull * crack);
        let inner_slope = 2.0f64.mul_add(flat, -0.5 * pull * inverse_root_a[k]);
        slope[k] = either(inside, inner_slope, outer_slope);
    }
    (value, slope)
}

/// The `[…]` of Eq 6 and `asin(a/r)` as functions of `u = r/a ≥ 1`, for tests in higher precision.
#[must_use]
pub fn dimensionless_field(u: f64) -> (f64, f64) {
    let x = 1.0 / u;
    let s = [((u - 1.0) * (u + 1.0)).sqrt() * x - 0.5];
    let ([indentation], [arc]) = polynomials(&s);
    (x * indentation, x * arc)
}

/// Distance \[m\] at which the field of any spot is negligible.
pub(crate) const AWAY: f64 = 1e30;

/// Number of sources per pass.
///
/// It fixes the order of summation, independently of the machine.
pub(crate) const LANES: usize = 8;

/// Sources of a displacement field as columns, for vectorised evaluation.
///
/// The columns are padded to whole passes with spots that have no field; [`Self::len`] counts the real ones.
#[derive(Debug, Clone, Default)]
pub struct SpotColumns {
    count: usize,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) a: Vec<f64>,
    pub(crate) root_a: Vec<f64>,
    pub(crate) inverse_root_a: Vec<f64>,
    pub(crate) inverse_radius: Vec<f64>,
    pub(crate) load: Vec<f64>,
    pub(crate) load_slope: Vec<f64>,
}

impl SpotColumns {
    /// Replaces the columns by those of the given spots.
    pub fn set(&mut self, spots: impl Iterator<Item = Spot>) {
        for column in [
            &mut self.x,
            &mut self.y,
            &mut self.a,
            &mut self.root_a,
            &mut self.inverse_root_a,
            &mut self.inverse_radius,
            &mut self.load,
            &mut self.load_slope,
        ] {
            column.clear();
        }
        self.count = 0;
        for spot in spots {
            let root_a = spot.a.sqrt();
            self.push([
                spot.x,
                spot.y,
                spot.a,
                root_a,
                1.0 / root_a,
                1.0 / spot.radius,
                spot.load,
                spot.load_slope,
            ]);
            self.count += 1;
        }
        self.fill_up();
    }

    /// Pads the columns to whole passes.
    fn fill_up(&mut self) {
        while !self.x.len().is_multiple_of(LANES) {
            // A flat spot without adhesion has no field.
            self.push([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        }
    }

    fn push(&mut self, [x, y, a, root_a, inverse_root_a, inverse_radius, load, load_slope]: [f64; 8]) {
        self.x.push(x);
        self.y.push(y);
        self.a.push(a);
        self.root_a.push(root_a);
        self.inverse_root_a.push(inverse_root_a);
        self.inverse_radius.push(inverse_radius);
        self.load.push(load);
        self.load_slope.push(load_slope);
    }

    /// The spots reordered: the new spot k is the old spot `from[k]`.
    pub(crate) fn in_order(&self, from: &[usize]) -> Self {
        let column = |given: &[f64]| {
            let mut ordered = Vec::with_capacity(from.len().next_multiple_of(LANES));
            ordered.extend(from.iter().map(|k| given[*k]));
            ordered
        };
        let mut found = Self {
            count: from.len(),
            x: column(&self.x),
            y: column(&self.y),
            a: column(&self.a),
            root_a: column(&self.root_a),
            inverse_root_a: column(&self.inverse_root_a),
            inverse_radius: column(&self.inverse_radius),
            load: column(&self.load),
            load_slope: column(&self.load_slope),
        };
        found.fill_up();
        found
    }

    /// Number of spots.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// True if there are no spots.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Number of entries including the padding.
    pub(crate) fn padded(&self) -> usize {
        self.x.len()
    }
}

/// Target point of a field, and the parameters of the evaluation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// Side of the periodic square, and its inverse.
    ///
    /// The inverse is 0 for an isolated square, which disables image shifts.
    pub(crate) length: f64,
    pub(crate) inverse_length: f64,
    pub(crate) pull: f64,
    /// Coefficient returned by [`sag`].
    pub(crate) sag: f64,
}

/// Squared distances \[m²\] of a place to the nearest images of several points.
#[inline(always)]
pub(crate) fn squared_distances(place: Place, x: &[f64; LANES], y: &[f64; LANES]) -> [f64; LANES] {
    let mut r2 = [0.0; LANES];
    for k in 0..LANES {
        let dx = place.x - x[k];
        let dy = place.y - y[k];
        let dx = dx - place.length * (dx * place.inverse_length).round_ties_even();
        let dy = dy - place.length * (dy * place.inverse_length).round_ties_even();
        r2[k] = dx.mul_add(dx, dy * dy);
    }
    r2
}

/// Sum of the fields of all sources at one point, without that of a source at the point itself.
///
/// With `SLOPES`, the derivative of each field to its spot's radius is written to `slopes`, which has the
/// padded length.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(crate) fn spot_fields<const SLOPES: bool>(place: Place, spots: &SpotColumns, slopes: &mut [f64]) -> f64 {
    let columns = [&spots.x, &spots.y, &spots.a, &spots.root_a, &spots.inverse_root_a, &spots.inverse_radius];
    let [x, y, a, root_a, inverse_root_a, inverse_radius] =
        columns.map(|column| column.as_chunks::<LANES>().0);
    let mut strands = [0.0; LANES];
    for pass in 0..x.len() {
        let r2 = squared_distances(place, &x[pass], &y[pass]);
        let (value, slope) = field(
            &r2,
            &a[pass],
            &root_a[pass],
            &inverse_root_a[pass],
            &inverse_radius[pass],
            place.pull,
            place.sag,
        );
        for k in 0..LANES {
            strands[k] += either(r2[k] == 0.0, 0.0, value[k]);
        }
        if SLOPES {
            for k in 0..LANES {
                slopes[pass * LANES + k] = either(r2[k] == 0.0, 0.0, slope[k]);
            }
        }
    }
    strands.iter().sum()
}
