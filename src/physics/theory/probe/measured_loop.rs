//! Evaluation of a measured loop of load against displacement.
//!
//! # Steps
//! 1. The load reversal is the point of the maximum displacement. Each branch must go one way.
//! 2. The baseline is fitted to the points without contact at both ends and subtracted ([`Baseline`]).
//! 3. With the stiffness `k` of the machine the penetration is the displacement less `F/k`. Energies of a
//!    closed loop do not depend on it.
//! 4. Energies are sums of trapezoids. Works of closing and opening have the state of zero load on the
//!    unloading path as their reference, as those of simulated loops.
//!
//! # Errors of the results
//! Standard errors contain the scatter of the load without contact with the correlation of neighbours, the
//! error of the baseline, and the unknown place of a jump between two points, `|ΔF Δδ|/√12`. Errors of the
//! displacement are not included.

use super::baseline::{self, Fitted};
use super::{Estimate, pull_off};
use crate::PhysicsError;
use crate::model::Baseline;

/// Fewest points of a loop.
pub const FEWEST: usize = 30;
/// Fewest points of a branch.
const FEWEST_OF_BRANCH: usize = 8;
/// Largest way back of the displacement on a branch, over its range.
pub const MOST_WAY_BACK: f64 = 0.1;
/// Largest scatter of the load without contact, over the range of the load.
pub const MOST_NOISE: f64 = 0.05;
/// Load at the end of a loop over the range of the load, after subtraction of the baseline of approach, from
/// which on it does not close.
pub const OPEN: f64 = 0.1;
/// This load over the range of the load, from which on drift is a warning.
pub const DRIFT: f64 = 0.02;

/// Measured loop in SI units, in the order of the path.
#[derive(Debug, Clone, Copy)]
pub struct Measured<'a> {
    /// Displacement of the machine or penetration \[m\], increasing on approach.
    pub displacement_m: &'a [f64],
    /// Load \[N\], positive in compression.
    pub load_n: &'a [f64],
    /// Stiffness of the machine \[N/m\], if the displacement is that of the machine.
    pub stiffness_n_m: Option<f64>,
    /// Baseline that is subtracted.
    pub baseline: Baseline,
}

/// Evaluated loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// Row of the load reversal: last row of the approach.
    pub turn: usize,
    /// Penetration \[m\] of each row; 0 at the first contact on approach.
    pub penetration_m: Vec<f64>,
    /// Load \[N\] of each row less the baseline.
    pub load_n: Vec<f64>,
    /// True for rows with contact.
    pub in_contact: Vec<bool>,
    /// Work on the contact and the machine since the start of the branch \[J\].
    pub work_j: Vec<f64>,
    /// Subtracted offset \[N\], slope \[N/m\] and drift over the loop \[N\].
    pub baseline: [f64; 3],
    /// Points without contact on approach and on retraction to which the baseline was fitted.
    pub baseline_counts: [usize; 2],
    /// Standard deviation of the load without contact \[N\].
    pub noise_n: f64,
    /// Load at the end of the loop over the range of the load, relative to the baseline of approach.
    pub closure: f64,
    /// Load at the load reversal \[N\].
    pub max_load_n: f64,
    /// Pull-off force \[N\]; nothing without tension.
    pub pull_off_n: Option<Estimate>,
    /// Dissipated energy Θ \[J\].
    pub loss_j: Estimate,
    /// Energy of closing \[J\].
    pub closing_j: Estimate,
    /// Energy of opening \[J\].
    pub opening_j: Estimate,
    /// Row of the pull-off force.
    pub(super) pull_off_row: usize,
    pub(super) zero: Zero,
}

/// Uncertainty of the zero of load.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Zero {
    /// Covariance of the parameters of the baseline.
    pub(super) covariance: Vec<f64>,
    /// Load of each parameter at each row.
    pub(super) terms: Vec<Vec<f64>>,
    /// Compliance of the machine \[m/N\].
    pub(super) compliance_m_n: f64,
}

pub(super) fn fault(problem: String, help: &'static str) -> PhysicsError {
    PhysicsError::ProbeLoop { problem, help }
}

/// Evaluates a loop.
///
/// # Errors
/// Columns of different length, fewer than 30 points, no load reversal, a branch that goes back by more than
/// a tenth of its range, no points without contact, and a loop that does not close.
pub fn evaluate(measured: &Measured<'_>) -> Result<Evaluated, PhysicsError> {
    let Measured { displacement_m, load_n, stiffness_n_m, baseline } = *measured;
    let turn = reversal(displacement_m, load_n)?;
    let fitted = baseline::fit(load_n, displacement_m, turn, baseline);
    let count = load_n.len();
    let place = |row: usize| row as f64 / count as f64;
    let load: Vec<f64> =
        (0..count).map(|row| load_n[row] - fitted.load(displacement_m[row], place(row))).collect();
    let closure = closed(displacement_m, load_n, turn, &fitted)?;
    if baseline != Baseline::None {
        has_zero(&load, &fitted)?;
    }
    let by_stiffness = stiffness_n_m.map_or(0.0, f64::recip);
    let mut penetration_m: Vec<f64> =
        displacement_m.iter().zip(&load).map(|(way, load)| way - load * by_stiffness).collect();
    let touch = penetration_m[fitted.contact[0].min(turn)];
    penetration_m.iter_mut().for_each(|way| *way -= touch);
    let noise_n = fitted.residuals.variance.sqrt();
    let found =
        pull_off::pull_off(&load[turn..fitted.contact[1].max(turn + 1)], noise_n, fitted.residuals.inflation);
    let pull_off_row = turn + found.map_or(0, |(_, row)| row);
    let pull_off_n = found.map(|(estimate, row)| {
        let row = turn + row;
        let of_baseline = fitted.variance(&fitted.gradient(displacement_m[row], place(row)));
        let standard_error = estimate.standard_error.hypot(of_baseline.sqrt());
        Estimate { standard_error, ..estimate }
    });
    let zero_of_load = Zero {
        covariance: fitted.covariance(),
        terms: fitted.by_term(displacement_m),
        compliance_m_n: by_stiffness,
    };
    let energies = Energies { way: displacement_m, load: &load, fitted: &fitted };
    let zero = found
        .map_or(count - 1, |_| (turn..=pull_off_row).rev().find(|row| load[*row] >= 0.0).unwrap_or(turn));
    let [closing_j, opening_j] = energies.works(zero);
    let loss_j = dissipated(energies.of(0, count - 1))?;
    Ok(Evaluated {
        turn,
        in_contact: (0..count).map(|row| (fitted.contact[0]..fitted.contact[1]).contains(&row)).collect(),
        work_j: energies.along(turn),
        baseline: fitted.terms(),
        baseline_counts: [fitted.free[0], count - fitted.free[1]],
        noise_n,
        closure,
        max_load_n: load[turn],
        pull_off_n,
        loss_j,
        closing_j,
        opening_j,
        pull_off_row,
        zero: zero_of_load,
        penetration_m,
        load_n: load,
    })
}

/// The dissipated energy of a loop, unless it is negative beyond its error.
fn dissipated(loss_j: Estimate) -> Result<Estimate, PhysicsError> {
    if loss_j.value >= -MOST_GAINED * loss_j.standard_error {
        return Ok(loss_j);
    }
    Err(fault(
        format!("the loop gains energy: Θ = {:.2e} J", loss_j.value),
        "check the order of the branches and the sign of compression: the load on retraction must be below \
         that on approach",
    ))
}

/// Standard errors by which the energy of a loop may be negative: beyond, it is not by noise.
const MOST_GAINED: f64 = 4.0;

/// Row of the load reversal of a loop whose branches go one way.
fn reversal(way: &[f64], load: &[f64]) -> Result<usize, PhysicsError> {
    let count = way.len();
    if count != load.len() {
        return Err(fault(
            format!("{count} displacements and {} loads", load.len()),
            "give one load for each displacement",
        ));
    }
    if count < FEWEST {
        return Err(fault(
            format!("the loop has {count} point{}", if count == 1 { "" } else { "s" }),
            "a loop needs at least 30 points, from before contact to after separation",
        ));
    }
    if range(load) == 0.0 {
        return Err(fault("the load is the same at all points".to_owned(), "check the column of the force"));
    }
    let turn = (0..count).max_by(|u, v| way[*u].total_cmp(&way[*v])).unwrap_or_default();
    if turn < FEWEST_OF_BRANCH || count - turn <= FEWEST_OF_BRANCH {
        return Err(fault(
            format!(
                "no load reversal: the maximum displacement is at point {} of {count}, so that there is one \
                 branch only",
                turn + 1
            ),
            "give approach and retraction in one file, one after the other; if the displacement decreases on \
             approach, reverse its sign",
        ));
    }
    let back = |branch: &mut dyn Iterator<Item = f64>| {
        let (mut high, mut most, mut low) = (f64::NEG_INFINITY, 0.0_f64, f64::INFINITY);
        for at in branch {
            high = high.max(at);
            low = low.min(at);
            most = most.max(high - at);
        }
        most / (high - low)
    };
    let approach = back(&mut way[..=turn].iter().copied());
    let retraction = back(&mut way[turn..].iter().rev().copied());
    for (branch, share) in [("approach", approach), ("retraction", retraction)] {
        if share.is_nan() || share > MOST_WAY_BACK {
            return Err(fault(
                format!(
                    "the displacement goes back by {:.0} % of its range on {branch} (limit 10 %)",
                    100.0 * share
                ),
                "give one loop: one approach followed by one retraction",
            ));
        }
    }
    Ok(turn)
}

/// Range of the values.
pub(super) fn range(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Refuses a loop without points without contact: too few, or with too large a scatter about a line.
fn has_zero(load: &[f64], fitted: &Fitted) -> Result<(), PhysicsError> {
    let scatter = fitted.residuals.variance.sqrt() / range(load);
    let is_missing = fitted.free[0] == 0 && fitted.free[1] == load.len();
    if !is_missing && scatter <= MOST_NOISE {
        return Ok(());
    }
    let why = if is_missing {
        String::new()
    } else {
        format!(": the load at its ends differs from a line by {:.0} % of its range", 100.0 * scatter)
    };
    Err(fault(
        format!("the zero of load is unknown, since the loop has no points without contact{why}"),
        "record the loop from before contact to after separation, or subtract the baseline beforehand and \
         set the baseline to \"none\"",
    ))
}

/// Load at the end over the range of the load, relative to the baseline of approach.
fn closed(way: &[f64], load: &[f64], turn: usize, fitted: &Fitted) -> Result<f64, PhysicsError> {
    let count = way.len();
    let ends = (count / 50).clamp(3, 50);
    let mean = |rows: std::ops::Range<usize>| {
        let length = rows.len() as f64;
        load[rows].iter().sum::<f64>() / length
    };
    let closure = (mean(count - ends..count) - mean(0..ends)) / range(load);
    let touch = way[fitted.contact[0].min(turn)];
    let is_short = way[count - 1] > touch;
    if is_short || closure.abs() > OPEN || !closure.is_finite() {
        let why = if is_short {
            "its retraction ends before the displacement of first contact".to_owned()
        } else {
            format!(
                "the load at its end differs by {:.0} % of its range from that at its start",
                100.0 * closure
            )
        };
        return Err(fault(
            format!("the loop does not close: {why}"),
            "record the loop until the surfaces have separated; correct a drift of the zero of load \
             beforehand",
        ));
    }
    Ok(closure)
}

/// Energies of a loop by trapezoids.
struct Energies<'a> {
    way: &'a [f64],
    load: &'a [f64],
    fitted: &'a Fitted,
}

impl Energies<'_> {
    fn trapezoid(&self, row: usize) -> f64 {
        0.5 * (self.load[row] + self.load[row + 1]) * (self.way[row + 1] - self.way[row])
    }

    /// Work from one row to another \[J\].
    fn of(&self, from: usize, to: usize) -> Estimate {
        let value = (from..to).map(|row| self.trapezoid(row)).sum();
        let mut weights = vec![0.0; self.way.len()];
        let mut jumps = 0.0;
        for row in from..to {
            let step = self.way[row + 1] - self.way[row];
            weights[row] += 0.5 * step;
            weights[row + 1] += 0.5 * step;
            jumps += ((self.load[row + 1] - self.load[row]) * step).powi(2) / 12.0;
        }
        let count = self.way.len() as f64;
        let mut gradient = self.fitted.gradient(self.way[0], 0.0);
        gradient.fill(0.0);
        for (row, weight) in weights.iter().enumerate() {
            let of_row = self.fitted.gradient(self.way[row], row as f64 / count);
            gradient.iter_mut().zip(of_row).for_each(|(sum, term)| *sum += weight * term);
        }
        let residuals = &self.fitted.residuals;
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        let scatter = residuals.variance * residuals.inflation * squares;
        Estimate {
            value,
            standard_error: (scatter + self.fitted.variance(&gradient) + jumps).sqrt(),
            degrees_of_freedom: residuals.degrees_of_freedom,
        }
    }

    /// Energies of closing and of opening: `zero` is the last row of the unloading path without tension.
    fn works(&self, zero: usize) -> [Estimate; 2] {
        let last = self.way.len() - 1;
        let (mut closing, mut opening) = (self.of(0, zero), self.of(zero, last));
        // Up to the zero of load between two rows.
        let above = self.load.get(zero + 1).filter(|next| **next < 0.0).map_or(0.0, |next| {
            let load = self.load[zero];
            0.5 * load * (self.way[zero + 1] - self.way[zero]) * load / (load - next)
        });
        closing.value = -(closing.value + above);
        opening.value -= above;
        [closing, opening]
    }

    /// Work since the start of the branch at each row.
    fn along(&self, turn: usize) -> Vec<f64> {
        let mut work = 0.0;
        let step = |row: usize| {
            if row == turn + 1 {
                work = 0.0;
            }
            if row > 0 {
                work += self.trapezoid(row - 1);
            }
            work
        };
        (0..self.way.len()).map(step).collect()
    }
}
