//! Evaluation of a measured loop of load against displacement.
//!
//! # Steps
//! 1. The load reversal is the point of the maximum displacement. Each branch must go one way.
//! 2. The baseline is fitted to the points without contact at both ends and subtracted ([`Baseline`]).
//! 3. With the stiffness `k` of the machine the penetration is the displacement less `F/k`. Energies of a closed loop do
//!    not depend on it.
//! 4. Energies are sums of trapezoids. Works of closing and opening have the state of zero load on the unloading path
//!    as their reference, as those of simulated loops.
//!
//! # Errors of the results
//! Standard errors contain the scatter of the load without contact with the correlation of neighbours, the error of
//! the baseline, and the unknown place of a jump between two points, `|ΔF Δδ|/√12`. Errors of the displacement are not
//! included.

use super::baseline::{self, Fitted};
use super::force_fit::Path;
use super::radius_fit::receding;
use super::regression::variance_along;
use super::{Branch, Estimate, Probe, pull_off};
use crate::PhysicsError;
use crate::model::Baseline;
use std::f64::consts::PI;

/// Fewest points of a loop.
pub const FEWEST: usize = 30;
/// Fewest points of a branch.
const FEWEST_OF_BRANCH: usize = 8;
/// Largest way back of the displacement on a branch, over its range.
pub const MOST_WAY_BACK: f64 = 0.1;
/// Largest scatter of the load without contact, over the range of the load.
pub const MOST_NOISE: f64 = 0.05;
/// Load at the end of a loop over the range of the load, after subtraction of the baseline of approach, from which on it
/// does not close.
pub const OPEN: f64 = 0.1;
/// The same, from which on drift is a warning.
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
    pull_off_row: usize,
    zero: Zero,
}

/// Uncertainty of the zero of load.
#[derive(Debug, Clone, PartialEq)]
struct Zero {
    /// Covariance of the parameters of the baseline.
    covariance: Vec<f64>,
    /// Load of each parameter at each row.
    terms: Vec<Vec<f64>>,
    /// Compliance of the machine \[m/N\].
    compliance_m_n: f64,
}

/// Loads and penetrations of all rows.
#[derive(Clone, Copy)]
struct Rows<'a> {
    penetration_m: &'a [f64],
    load_n: &'a [f64],
}

/// Apparent works of adhesion and modulus of a measured loop.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Apparent {
    /// From the pull-off force \[J/m²\].
    pub pull_off_j_m2: Option<Estimate>,
    /// From the dissipated energy \[J/m²\].
    pub loss_j_m2: Option<Estimate>,
    /// Fit on approach \[J/m²\].
    pub approach_j_m2: Option<Estimate>,
    /// Fit on retraction \[J/m²\].
    pub retraction_j_m2: Option<Estimate>,
    /// Fitted reduced modulus \[Pa\].
    pub modulus_pa: Option<Estimate>,
    /// Root-mean-square residuals of the load on approach and retraction \[N\].
    pub residuals_n: [Option<f64>; 2],
    /// Residual of retraction over the maximum magnitude of the load.
    pub residual: Option<f64>,
    /// True if contact radius was fitted; else load against penetration.
    pub is_of_radius: bool,
}

fn fault(problem: String, help: &'static str) -> PhysicsError {
    PhysicsError::ProbeLoop { problem, help }
}

/// Evaluates a loop.
///
/// # Errors
/// Columns of different length, fewer than 30 points, no load reversal, a branch that goes back by more than a tenth
/// of its range, no points without contact, and a loop that does not close.
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
        loss_j: energies.of(0, count - 1),
        closing_j,
        opening_j,
        pull_off_row,
        zero: zero_of_load,
        penetration_m,
        load_n: load,
    })
}

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
            format!("the loop has {count} points"),
            "a loop needs at least 30 points, from before contact to after separation",
        ));
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
        "record the loop from before contact to after separation, or subtract the baseline beforehand and set \
         the baseline to \"none\"",
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
            "record the loop until the surfaces have separated; correct a drift of the zero of load beforehand",
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

impl Evaluated {
    /// Apparent works of adhesion and modulus for a probe. `contact_radius_m` has one value for each row, 0 or no number
    /// without contact; without it, load against penetration is fitted.
    ///
    /// With the modulus of the probe the works are fitted with it, and the modulus apart from that. What cannot be
    /// fitted is nothing.
    ///
    /// # Errors
    /// A contact radius with another number of rows.
    pub fn apparent(
        &self,
        probe: &Probe,
        contact_radius_m: Option<&[f64]>,
    ) -> Result<Apparent, PhysicsError> {
        if let Some(radius) = contact_radius_m.filter(|radius| radius.len() != self.load_n.len()) {
            return Err(fault(
                format!("{} contact radii and {} loads", radius.len(), self.load_n.len()),
                "give one contact radius for each load",
            ));
        }
        let fit = |rows: Rows<'_>| match contact_radius_m {
            Some(radius) => self.of_radius(probe, rows, radius),
            None => self.of_force(probe, rows),
        };
        let mut found = fit(Rows { penetration_m: &self.penetration_m, load_n: &self.load_n });
        self.pool(&mut found);
        self.zero.widen(self, &mut found, fit);
        let scaled = |estimate: Estimate, value: f64, relative: f64| Estimate {
            value,
            standard_error: relative * value,
            ..estimate
        };
        found.pull_off_j_m2 = self.pull_off_n.and_then(|force| {
            let work = probe.work_from_pull_off(force.value).ok()?;
            Some(scaled(force, work, force.standard_error / force.value))
        });
        let given = probe.contact_modulus_pa.map(|value| (value, 0.0));
        let fitted = found.modulus_pa.map(|modulus| (modulus.value, modulus.standard_error / modulus.value));
        found.loss_j_m2 = given.or(fitted).and_then(|(modulus, relative)| {
            let work = probe.with_modulus(modulus).ok()?.work_from_loss(self.loss_j.value).ok()?;
            let of_loss = 0.6 * self.loss_j.standard_error / self.loss_j.value;
            // w ∝ Θ^(3/5) E*^(2/5).
            (work > 0.0).then(|| scaled(self.loss_j, work, of_loss.hypot(0.4 * relative)))
        });
        Ok(found)
    }

    /// Standard errors of fits with at least the scatter of the load without contact.
    fn pool(&self, found: &mut Apparent) {
        let factors = found.residuals_n.iter().flatten().map(|residual| self.noise_n / residual);
        let factor = factors.filter(|factor| factor.is_finite()).fold(1.0, f64::max);
        for estimate in [&mut found.approach_j_m2, &mut found.retraction_j_m2, &mut found.modulus_pa] {
            if let Some(estimate) = estimate {
                estimate.standard_error *= factor;
            }
        }
    }

    fn of_radius(&self, probe: &Probe, rows: Rows<'_>, radius: &[f64]) -> Apparent {
        let free = Probe { contact_modulus_pa: None, ..*probe };
        let all = rows.load_n;
        let area: Vec<f64> =
            radius.iter().map(|a| if a.is_finite() { PI * a.max(0.0).powi(2) } else { 0.0 }).collect();
        let approach = Branch { load_n: &all[..self.turn + 1], area_m2: &area[..self.turn + 1] };
        let approach = probe.fit_radius(approach).ok();
        let back = self.turn..area.len();
        let [load_n, area_m2] = receding(Branch { load_n: &all[back.clone()], area_m2: &area[back] });
        let retraction = Branch { load_n: &load_n, area_m2: &area_m2 };
        let free = free.fit_radius(retraction).ok();
        let retraction = probe.fit_radius(retraction).ok();
        Apparent {
            approach_j_m2: approach.and_then(|fit| fit.work_j_m2),
            retraction_j_m2: retraction.and_then(|fit| fit.work_j_m2),
            modulus_pa: free.and_then(|fit| fit.modulus_pa),
            residuals_n: [approach, retraction].map(|fit| fit.map(|fit| fit.residual_n)),
            residual: retraction.map(|fit| fit.residual),
            is_of_radius: true,
            ..Apparent::default()
        }
    }

    /// First row of the approach that is fitted: after the jump into contact, or where the load is smallest.
    fn first_of_approach(&self) -> usize {
        let touch = self.in_contact.iter().position(|in_contact| *in_contact).unwrap_or(self.turn);
        let rows = touch..=self.turn;
        let least = rows.min_by(|u, v| self.load_n[*u].total_cmp(&self.load_n[*v])).unwrap_or(self.turn);
        let next = (touch + 1).min(self.turn);
        // Of noisy loads the smallest is no fair choice.
        if self.load_n[next] < 0.5 * self.load_n[least] { next } else { least }
    }

    fn of_force(&self, probe: &Probe, rows: Rows<'_>) -> Apparent {
        let free = Probe { contact_modulus_pa: None, ..*probe };
        let path = |range: std::ops::Range<usize>| Path {
            penetration_m: &rows.penetration_m[range.clone()],
            load_n: &rows.load_n[range],
        };
        let first = self.first_of_approach();
        let fit = |probe: &Probe| {
            probe.fit_force(path(first..self.turn + 1), path(self.turn..self.pull_off_row + 1)).ok()
        };
        let of_works = fit(probe);
        let of_free = if probe.contact_modulus_pa.is_some() { fit(&free) } else { of_works };
        let approach = of_works.filter(|fit| fit.approach_j_m2.is_some());
        Apparent {
            approach_j_m2: of_works.and_then(|fit| fit.approach_j_m2),
            retraction_j_m2: of_works.and_then(|fit| fit.retraction_j_m2),
            modulus_pa: of_free.and_then(|fit| fit.modulus_pa),
            residuals_n: [approach.map(|fit| fit.residuals_n[0]), of_works.map(|fit| fit.residuals_n[1])],
            residual: of_works.map(|fit| fit.residual),
            ..Apparent::default()
        }
    }
}

impl Zero {
    /// Adds the uncertainty of the zero of load to the standard errors of fits, which are repeated with the load of each
    /// parameter of the baseline added.
    fn widen(&self, of: &Evaluated, found: &mut Apparent, fit: impl Fn(Rows<'_>) -> Apparent) {
        let count = self.terms.len();
        let moved: Vec<(f64, Apparent)> = (0..count)
            .map(|term| {
                let size = self.covariance[term * count + term].sqrt();
                let shift = |load: &f64, by: &f64| load + size * by;
                let load: Vec<f64> =
                    of.load_n.iter().zip(&self.terms[term]).map(|(u, v)| shift(u, v)).collect();
                let ways = of.penetration_m.iter().zip(&self.terms[term]);
                let way: Vec<f64> = ways.map(|(way, by)| way - self.compliance_m_n * size * by).collect();
                (size, fit(Rows { penetration_m: &way, load_n: &load }))
            })
            .collect();
        let places: [fn(&mut Apparent) -> &mut Option<Estimate>; 3] =
            [|of| &mut of.approach_j_m2, |of| &mut of.retraction_j_m2, |of| &mut of.modulus_pa];
        for place in places {
            let Some(estimate) = *place(found) else { continue };
            let slope = |(size, other): &(f64, Apparent)| {
                let other = place(&mut other.clone()).map_or(estimate.value, |other| other.value);
                if *size > 0.0 { (other - estimate.value) / size } else { 0.0 }
            };
            let gradient: Vec<f64> = moved.iter().map(slope).collect();
            let standard_error =
                estimate.standard_error.hypot(variance_along(&self.covariance, &gradient).sqrt());
            *place(found) = Some(Estimate { standard_error, ..estimate });
        }
    }
}
