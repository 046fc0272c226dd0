//! Tabulated power spectral density: checks, conversion of profiles, interpolation.

use super::pieces::{Piece, Pieces};
use std::f64::consts::PI;

/// Largest ratio of neighbouring wavenumbers of a table.
pub const MAX_GAP: f64 = 4.0;
/// Nodes of Gauss's rule for a piece of the inversion of profiles.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_3),
];

/// Isotropic power spectral density C(q) with `∫ C d²q = h_rms²`, as a table.
///
/// Between its rows it is a power law, outside it is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct PsdTable {
    /// Wavenumbers q = 2π/λ \[1/m\], ascending.
    wavenumbers_1_m: Vec<f64>,
    /// Densities C \[m⁴\].
    densities_m4: Vec<f64>,
}

/// Fault of a row of a table, by its number from 0.
#[derive(Debug, Clone, PartialEq)]
pub struct RowFault {
    /// Number of the row; the number of rows if there are too few.
    pub row: usize,
    /// Fault, with its numbers.
    pub problem: String,
}

impl PsdTable {
    /// Table of wavenumbers \[1/m\] and densities \[m⁴\].
    ///
    /// # Errors
    /// Fewer than two rows; a value that is not positive and finite; wavenumbers that do not ascend, or
    /// neighbours with a ratio above [`MAX_GAP`].
    pub fn of(rows: &[[f64; 2]]) -> Result<Self, RowFault> {
        check(rows)?;
        Ok(Self {
            wavenumbers_1_m: rows.iter().map(|row| row[0]).collect(),
            densities_m4: rows.iter().map(|row| row[1]).collect(),
        })
    }

    /// Table from that of a profile: two-sided densities `C1` \[m³\] with `∫ C1 dq = h_rms²` over all q of
    /// both signs.
    ///
    /// The profile of an isotropic surface has `C1(p) = 2 ∫ q C(q)/√(q² − p²) dq` from p to infinity. Abel's
    /// inversion gives `C(q) = −(1/π) ∫ C1'(p)/√(p² − q²) dp` from q to infinity. Between the rows C1 is a
    /// power law, and the last one continues beyond the table.
    ///
    /// # Errors
    /// As [`Self::of`]. A C1 that grows with q, so that C is not positive, or that decreases too slowly at
    /// the end of the table for the integral to exist.
    pub fn of_profile(rows: &[[f64; 2]]) -> Result<Self, RowFault> {
        check(rows)?;
        let mut pieces = pieces_of(rows);
        let last = pieces.len() - 1;
        pieces[last].to = f64::INFINITY;
        if pieces[last].exponent <= 0.0 {
            let problem = "the spectrum of a profile does not decrease at its end".to_owned();
            return Err(RowFault { row: rows.len() - 1, problem });
        }
        let inverted = |(row, [q, _]): (usize, &[f64; 2])| {
            let density: f64 = pieces.iter().map(|piece| abel(piece, *q)).sum();
            if density > 0.0 {
                return Ok([*q, density]);
            }
            let problem =
                format!("Abel's inversion of the profile gives C = {density:.3e} m4, which is not positive");
            Err(RowFault { row, problem })
        };
        let inverted: Vec<[f64; 2]> = rows.iter().enumerate().map(inverted).collect::<Result<_, _>>()?;
        Self::of(&inverted)
    }

    /// First and last wavenumber \[1/m\].
    #[must_use]
    pub fn range_1_m(&self) -> [f64; 2] {
        let ends = [self.wavenumbers_1_m.first(), self.wavenumbers_1_m.last()];
        ends.map(|end| end.copied().unwrap_or_default())
    }

    /// Wavenumbers \[1/m\] and densities \[m⁴\].
    pub fn rows(&self) -> impl Iterator<Item = [f64; 2]> {
        self.wavenumbers_1_m.iter().zip(&self.densities_m4).map(|(q, density)| [*q, *density])
    }

    /// Density at a wavenumber \[m⁴\]: a power law between the rows, zero outside the table.
    #[must_use]
    pub fn density_m4(&self, wavenumber_1_m: f64) -> f64 {
        Pieces(self.pieces()).at(wavenumber_1_m)
    }

    /// Power laws between the rows. The last one includes the last row.
    pub(crate) fn pieces(&self) -> Vec<Piece> {
        let rows: Vec<[f64; 2]> = self.rows().collect();
        let mut pieces = pieces_of(&rows);
        if let Some(last) = pieces.last_mut() {
            last.to = last.to.next_up();
        }
        pieces
    }
}

/// Power laws between rows of q and C.
pub(super) fn pieces_of(rows: &[[f64; 2]]) -> Vec<Piece> {
    let between = |pair: &[[f64; 2]]| {
        let [[from, level], [to, next]] = [pair[0], pair[1]];
        Piece { from, to, level, exponent: -(next / level).ln() / (to / from).ln() }
    };
    rows.windows(2).map(between).collect()
}

fn check(rows: &[[f64; 2]]) -> Result<(), RowFault> {
    let fault = |row: usize, problem: String| Err(RowFault { row, problem });
    if rows.len() < 2 {
        return fault(rows.len(), format!("{} rows: a spectrum needs at least two", rows.len()));
    }
    for (row, values) in rows.iter().enumerate() {
        for (name, value) in ["q", "C"].into_iter().zip(values) {
            if !(*value > 0.0 && value.is_finite()) {
                return fault(row, format!("{name} is {value:e}: it must be positive and finite"));
            }
        }
        let Some(before) = row.checked_sub(1).map(|before| rows[before][0]) else { continue };
        let ratio = values[0] / before;
        if ratio == 1.0 {
            return fault(row, "the q of the row before it occurs twice".to_owned());
        } else if ratio < 1.0 {
            return fault(row, "q is smaller than in the row before it: q must ascend".to_owned());
        } else if ratio > MAX_GAP {
            return fault(
                row,
                format!("gap: q is {ratio:.3} times that of the row before it, at most {MAX_GAP}"),
            );
        }
    }
    Ok(())
}

/// `−(1/π) ∫ C1'(p)/√(p² − q²) dp` over the part of a power law beyond q.
///
/// With `p = q cosh u` the root cancels: `(m/π) ∫ C1(q cosh u)/(q cosh u) du`. The integrand decays as
/// `e^(−(m+1)u)`.
fn abel(piece: &Piece, q: f64) -> f64 {
    let (low, m) = (piece.from.max(q), piece.exponent);
    if low >= piece.to {
        return 0.0;
    }
    let start = (low / q).acosh();
    // Beyond 40 e-foldings nothing remains.
    let end = (piece.to / q).acosh().min(start + 40.0 / (m + 1.0).max(0.5));
    let panels = ((end - start) / 0.25).ceil().max(1.0);
    let half = 0.5 * (end - start) / panels;
    let at = |u: f64| {
        let p = q * u.cosh();
        piece.level * (p / piece.from).powf(-m) / p
    };
    let panel = |k: u32| {
        let centre = start + f64::from(2 * k + 1) * half;
        GAUSS
            .iter()
            .map(|(node, weight)| weight * (at(centre - half * node) + at(centre + half * node)))
            .sum::<f64>()
    };
    m / PI * half * (0..panels as u32).map(panel).sum::<f64>()
}
