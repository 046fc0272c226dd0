//! Measured loops: read, evaluated, and made into tables.

use super::StageError;
use crate::keys::digest_of_file;
use crate::model::{Choice as _, LoopOptions};
use crate::physics::theory::probe::measured_loop::{DRIFT, Evaluated, Measured, evaluate};
use crate::physics::theory::probe::{Apparent, Estimate, Oriented, Probe, oriented};
use crate::schema::{MEASURED_LOOPS, MEASURED_STEPS};
use crate::stats::t_quantile;
use crate::store::Frame;
use crate::store::force_curve::{ForceCurve, read_force_curve};
use std::path::Path;

/// A measured loop with its results.
#[derive(Debug, Clone)]
pub struct MeasuredLoop {
    /// Name of the file in tables.
    pub source: String,
    /// BLAKE3 of the file.
    pub digest: String,
    /// Options of its reading.
    pub options: LoopOptions,
    /// Columns of the file.
    pub curve: ForceCurve,
    /// Columns with the signs of this program.
    pub oriented: Oriented,
    /// Baseline, energies and pull-off force.
    pub evaluated: Evaluated,
    /// Apparent works of adhesion, with a probe radius.
    pub apparent: Option<Apparent>,
}

/// Reads and evaluates a loop. `source` is its name in tables.
///
/// # Errors
/// A file that cannot be read, a loop that cannot be evaluated, and options out of range.
pub fn measure_loop(path: &Path, source: &str, options: &LoopOptions) -> Result<MeasuredLoop, StageError> {
    let refused = |why: String| StageError::Loop { path: path.to_owned(), why };
    let curve = read_force_curve(path, options).map_err(refused)?;
    let digest = digest_of_file(path)
        .map_err(|error| StageError::Loop { path: path.to_owned(), why: error.to_string() })?;
    let refused = |error: crate::physics::PhysicsError| StageError::Loop {
        path: path.to_owned(),
        why: error.to_string(),
    };
    let oriented = oriented(&curve.displacement_m, &curve.force_n, options.compression).map_err(refused)?;
    let measured = Measured {
        displacement_m: &oriented.displacement_m,
        load_n: &oriented.load_n,
        stiffness_n_m: options.machine_stiffness_n_m,
        baseline: options.baseline,
    };
    let evaluated = evaluate(&measured).map_err(refused)?;
    let probe = options.probe_radius_m.map(|radius| Probe::new(radius, options.contact_modulus_pa));
    let probe = probe.transpose().map_err(refused)?;
    let radius = curve.contact_radius_m.as_deref();
    let apparent = probe.map(|probe| evaluated.apparent(&probe, radius)).transpose().map_err(refused)?;
    let (source, options) = (source.to_owned(), options.clone());
    Ok(MeasuredLoop { source, digest, options, curve, oriented, evaluated, apparent })
}

/// Half-width of the 95 % confidence interval (Student).
#[must_use]
pub fn half_width(estimate: &Estimate) -> f64 {
    // Beyond 1000 degrees of freedom the quantile is that of the normal distribution.
    let degrees = estimate.degrees_of_freedom.min(1000);
    t_quantile(0.975, degrees).unwrap_or(f64::INFINITY) * estimate.standard_error
}

impl MeasuredLoop {
    /// Results with an interval, by column.
    #[must_use]
    pub fn estimates(&self) -> [(&'static str, Option<Estimate>); 9] {
        let (of, apparent) = (&self.evaluated, self.apparent.unwrap_or_default());
        [
            ("pull_off_load_n", of.pull_off_n),
            ("loss_j", Some(of.loss_j)),
            ("work_closing_j", Some(of.closing_j)),
            ("work_opening_j", Some(of.opening_j)),
            ("work_pull_off_j_m2", apparent.pull_off_j_m2),
            ("work_loss_j_m2", apparent.loss_j_m2),
            ("work_approach_j_m2", apparent.approach_j_m2),
            ("work_retraction_j_m2", apparent.retraction_j_m2),
            ("contact_modulus_fit_pa", apparent.modulus_pa),
        ]
    }

    /// Other numbers, by column.
    #[must_use]
    pub fn numbers(&self) -> [(&'static str, Option<f64>); 12] {
        let (of, apparent) = (&self.evaluated, self.apparent.unwrap_or_default());
        let [offset, slope, drift] = of.baseline;
        [
            ("fit_residual_approach_n", apparent.residuals_n[0]),
            ("fit_residual_retraction_n", apparent.residuals_n[1]),
            ("fit_residual", apparent.residual),
            ("max_load_n", Some(of.max_load_n)),
            ("probe_radius_m", self.options.probe_radius_m),
            ("contact_modulus_pa", self.options.contact_modulus_pa),
            ("machine_stiffness_n_m", self.options.machine_stiffness_n_m),
            ("baseline_offset_n", Some(offset)),
            ("baseline_slope_n_m", Some(slope)),
            ("baseline_drift_n", Some(drift)),
            ("noise_n", Some(of.noise_n)),
            ("closure", Some(of.closure)),
        ]
    }

    /// Fitted curve, if there was a fit.
    #[must_use]
    pub fn fit(&self) -> Option<&'static str> {
        let of = self.apparent.filter(|of| of.residual.is_some())?;
        Some(if of.is_of_radius { "radius" } else { "load" })
    }

    /// Sentences on limits of the result.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let of = &self.evaluated;
        let mut found = Vec::new();
        if of.closure.abs() > DRIFT {
            found.push(format!(
                "drift: the load at the end differs by {:.1} % of its range from that at the start (limit \
                 {:.0} %); Θ and F_po depend on the baseline",
                100.0 * of.closure,
                100.0 * DRIFT
            ));
        }
        if of.pull_off_n.is_none() {
            found.push(
                "no tension during unloading: no pull-off force and no apparent work of adhesion".to_owned(),
            );
        }
        if of.baseline_counts.contains(&0) && self.options.baseline.word() != "none" {
            found.push(
                "no points without contact at one end: the baseline is an offset, without slope and drift"
                    .to_owned(),
            );
        }
        if self.apparent.is_some_and(|of| of.residual.is_some_and(|residual| residual > 0.1)) {
            found.push(
                "the JKR fit of the retraction leaves more than 10 % of the maximum load: apparent works \
                 and modulus are not those of a smooth sphere"
                    .to_owned(),
            );
        }
        found
    }

    /// Table of the points.
    ///
    /// # Errors
    /// A number that is not finite.
    pub fn steps(&self) -> Result<Frame, StageError> {
        steps(std::slice::from_ref(self))
    }
}

/// Table of the results of loops.
///
/// # Errors
/// A number that is not finite.
pub fn rows(loops: &[MeasuredLoop]) -> Result<Frame, StageError> {
    let words = |word: fn(&MeasuredLoop) -> String| loops.iter().map(word).collect::<Vec<_>>();
    let sign = |of: &MeasuredLoop| of.oriented.signs.map(|sign| format!("{sign:+.0}")).join(" ");
    let mut frame = Frame::of(&MEASURED_LOOPS)
        .text("source", words(|of| of.source.clone()))
        .text("source_blake3", words(|of| of.digest.clone()))
        .text("columns_read", words(|of| of.curve.columns.join("; ")))
        .text("signs", words(sign))
        .text("baseline", words(|of| of.options.baseline.word().to_owned()))
        .text_or_null("fit", loops.iter().map(MeasuredLoop::fit))
        .count("point_count", loops.iter().map(|of| of.evaluated.load_n.len()))
        .count("baseline_approach_count", loops.iter().map(|of| of.evaluated.baseline_counts[0]))
        .count("baseline_retraction_count", loops.iter().map(|of| of.evaluated.baseline_counts[1]));
    let estimates: Vec<_> = loops.iter().map(MeasuredLoop::estimates).collect();
    let numbers: Vec<_> = loops.iter().map(MeasuredLoop::numbers).collect();
    for place in 0..estimates.first().map_or(0, |of| of.len()) {
        let name = estimates[0][place].0;
        let of = || estimates.iter().map(|of| of[place].1);
        frame = frame
            .f64(name, of().map(|estimate| estimate.map(|estimate| estimate.value)))
            .f64(&format!("{name}_ci95_low"), of().map(|of| of.map(|of| of.value - half_width(&of))))
            .f64(&format!("{name}_ci95_high"), of().map(|of| of.map(|of| of.value + half_width(&of))));
    }
    for place in 0..numbers.first().map_or(0, |of| of.len()) {
        frame = frame.f64(numbers[0][place].0, numbers.iter().map(|of| of[place].1));
    }
    Ok(frame.build()?)
}

/// Table of the points of loops.
///
/// # Errors
/// A number that is not finite.
pub fn steps(loops: &[MeasuredLoop]) -> Result<Frame, StageError> {
    let all = || loops.iter().flat_map(|of| (0..of.evaluated.load_n.len()).map(move |row| (of, row)));
    let numbers =
        |value: fn(&MeasuredLoop, usize) -> f64| all().map(|(of, row)| value(of, row)).collect::<Vec<_>>();
    let optional = |value: fn(&MeasuredLoop, usize) -> Option<f64>| {
        all().map(|(of, row)| value(of, row)).collect::<Vec<_>>()
    };
    let branch =
        |(of, row): (&MeasuredLoop, usize)| if row <= of.evaluated.turn { "loading" } else { "unloading" };
    let radius = |of: &MeasuredLoop, row: usize| Some(*of.curve.contact_radius_m.as_ref()?.get(row)?);
    let frame = Frame::of(&MEASURED_STEPS)
        .text("source", all().map(|(of, _)| of.source.clone()))
        .count("step", all().map(|(_, row)| row))
        .text("branch", all().map(branch))
        .count("line", all().map(|(of, row)| of.curve.lines[row] as usize))
        .f64("approach_m", numbers(|of, row| of.evaluated.penetration_m[row]))
        .f64("load_n", numbers(|of, row| of.evaluated.load_n[row]))
        .f64("area_m2", all().map(|(of, row)| radius(of, row).map(|a| std::f64::consts::PI * a * a)))
        .f64("contact_radius_m", all().map(|(of, row)| radius(of, row)))
        .f64("time_s", optional(|of, row| Some(*of.curve.time_s.as_ref()?.get(row)?)))
        .f64("displacement_m", numbers(|of, row| of.oriented.displacement_m[row]))
        .f64("force_n", numbers(|of, row| of.oriented.load_n[row]))
        .f64("work_j", numbers(|of, row| of.evaluated.work_j[row]))
        .bool("in_contact", all().map(|(of, row)| of.evaluated.in_contact[row]));
    Ok(frame.build()?)
}
