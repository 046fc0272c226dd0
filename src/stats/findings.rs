//! The seven findings of Violano and Afferrante (Lubricants 9:7, 2021), judged from the tables of a run.
//!
//! A *reading* is a set of cases that differ only in maximum load, magnification and Hurst exponent. Each
//! finding is a statement about a trend over one of these, so a reading is judged from its widest series over
//! each.

use super::StatsError;
use super::compare::{difference_of, names, singles, written};
use super::digits::significant;
use super::student::Sample;
use super::varying::varying;
use crate::store::Frame;

/// Statements of the paper, by number.
pub const FINDINGS: [&str; 7] = [
    "F_po does not depend on F_max",
    "Θ is linear in A at load reversal",
    "Θ agrees with Deng and Kesari",
    "A decreases with ζ and increases with H",
    "F_po and Θ decrease with ζ",
    "F_po and Θ increase with H",
    "A, F_po and Θ scatter more at small ζ and at large H",
];

/// Columns of area, pull-off force and dissipated energy in the table `realizations`.
const QUANTITIES: [&str; 3] = ["area_at_max_load", "pull_off_load", "loss"];

/// Relative spread of the mean pull-off forces over the loads: at most so much for yes, and for partly.
const SPREADS: [f64; 2] = [0.05, 0.2];

/// Residual of the straight line Θ(A) over the largest Θ: at most so much for yes, and for partly.
const RESIDUALS: [f64; 2] = [0.03, 0.1];

/// Factor between Θ and its estimate: at most so much for yes, and for partly.
const FACTORS: [f64; 2] = [1.25, 2.0];

/// Extent to which a finding holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// It holds.
    Yes,
    /// It holds in part, or within the scatter.
    Partly,
    /// It does not hold.
    No,
}

impl Verdict {
    /// The verdict as a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Yes => "yes",
            Self::Partly => "partly",
            Self::No => "no",
        }
    }

    /// By a deviation and the limits of yes and partly.
    fn within(deviation: f64, [yes, partly]: [f64; 2]) -> Self {
        if deviation <= yes {
            Self::Yes
        } else if deviation <= partly {
            Self::Partly
        } else {
            Self::No
        }
    }

    /// Of a statement with several parts.
    fn of_all(parts: &[Self]) -> Option<Self> {
        let first = *parts.first()?;
        Some(if parts.iter().all(|part| *part == first) { first } else { Self::Partly })
    }
}

/// A finding as one reading shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// Extent to which it holds.
    pub verdict: Verdict,
    /// The numbers that it was judged by, see the guide.
    pub numbers: Vec<f64>,
    /// The numbers as text.
    pub text: String,
}

/// One reading.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Parameters that distinguish it from the others.
    pub name: String,
    /// Identities of its cases, in the order of the table.
    pub case_ids: Vec<String>,
    /// Number of planned realizations of its cases.
    pub planned_count: i64,
    /// Number of failed ones.
    pub failed_count: i64,
    /// By the number of the finding; nothing where the run has no series for it.
    pub findings: [Option<Judged>; 7],
}

impl Reading {
    /// True if a finding was judged over a series; the third one needs none.
    fn has_series(&self) -> bool {
        self.findings.iter().enumerate().any(|(number, judged)| number != 2 && judged.is_some())
    }
}

/// A row of the table `cases`.
#[derive(Debug, Clone, Copy)]
struct Case {
    row: usize,
    /// Maximum load, magnification and Hurst exponent.
    at: [f64; 3],
}

/// Quantity that a series varies: place in [`Case::at`].
const LOAD: usize = 0;
const MAGNIFICATION: usize = 1;
const HURST: usize = 2;

/// The readings of a run and what each shows, in the order of the table `cases`. Readings without any series
/// are left out.
///
/// # Errors
/// If a table lacks a column.
pub fn findings(cases: &Frame, realizations: &Frame) -> Result<Vec<Reading>, StatsError> {
    let mut readings: Vec<(Vec<String>, Vec<Case>)> = Vec::new();
    let columns = ["max_load", "magnification", "hurst"].map(|name| cases.f64_or_null(name));
    let [loads, magnifications, hursts] = columns;
    let (loads, magnifications, hursts) = (loads?, magnifications?, hursts?);
    for row in 0..cases.row_count() {
        // Measured surfaces have no magnification, and failed cases no load.
        let (Some(load), Some(magnification), Some(hurst)) = (loads[row], magnifications[row], hursts[row])
        else {
            continue;
        };
        let key = choices(cases, row)?;
        let case = Case { row, at: [load, magnification, hurst] };
        match readings.iter_mut().find(|(known, _)| *known == key) {
            Some((_, rows)) => rows.push(case),
            None => readings.push((key, vec![case])),
        }
    }
    let firsts: Vec<usize> = readings.iter().map(|(_, rows)| rows[0].row).collect();
    let differing: Vec<_> =
        varying(cases, &firsts)?.into_iter().filter(|parameter| !SERIES.contains(&parameter.name)).collect();
    let mut found = Vec::new();
    for (place, (_, rows)) in readings.iter().enumerate() {
        let words = differing
            .iter()
            .filter(|parameter| !parameter.is_absent(place))
            .map(|parameter| parameter.named(place));
        let name = words.collect::<Vec<_>>().join(", ");
        let reading = Judge { cases, realizations, rows }.reading(name)?;
        found.extend(Some(reading).filter(Reading::has_series));
    }
    Ok(found)
}

/// Parameters over which a reading has series.
const SERIES: [&str; 2] = ["magnification", "hurst"];

/// The values of all parameters but those of the series.
fn choices(cases: &Frame, row: usize) -> Result<Vec<String>, StatsError> {
    names().filter(|name| !SERIES.contains(name)).map(|name| written(cases, name, row)).collect()
}

/// The cases of one reading.
struct Judge<'a> {
    cases: &'a Frame,
    realizations: &'a Frame,
    rows: &'a [Case],
}

impl Judge<'_> {
    fn reading(&self, name: String) -> Result<Reading, StatsError> {
        let ids = self.cases.text("case_id")?;
        let mut case_ids: Vec<String> = Vec::new();
        let (mut planned_count, mut failed_count) = (0, 0);
        let (planned, failed) = (self.cases.i64("planned_count")?, self.cases.i64("failed_count")?);
        for case in self.rows {
            // The loads of one case are rows of their own.
            if !case_ids.iter().any(|id| id == ids[case.row]) {
                case_ids.push(ids[case.row].to_owned());
                planned_count += planned[case.row];
                failed_count += failed[case.row];
            }
        }
        let (loads, magnifications, hursts) =
            (self.series(LOAD), self.series(MAGNIFICATION), self.series(HURST));
        let findings = [
            self.constant_pull_off(&loads)?,
            self.linear_loss(&loads)?,
            self.estimate()?,
            self.trends(&[(0, &magnifications, -1.0), (0, &hursts, 1.0)])?,
            self.trends(&[(1, &magnifications, -1.0), (2, &magnifications, -1.0)])?,
            self.trends(&[(1, &hursts, 1.0), (2, &hursts, 1.0)])?,
            self.scatter(&magnifications, &hursts)?,
        ];
        Ok(Reading { name, case_ids, planned_count, failed_count, findings })
    }

    /// The longest series over one of the three with the other two fixed, ascending; the first of the
    /// longest. Fewer than two are none.
    fn series(&self, over: usize) -> Vec<Case> {
        let fixed = |case: &Case| [0, 1, 2].map(|k| if k == over { 0.0 } else { case.at[k] });
        let mut longest: Vec<Case> = Vec::new();
        for case in self.rows {
            let mut series: Vec<Case> =
                self.rows.iter().filter(|other| fixed(other) == fixed(case)).copied().collect();
            series.sort_by(|a, b| a.at[over].total_cmp(&b.at[over]));
            series.dedup_by(|a, b| a.at[over] == b.at[over]);
            if series.len() > longest.len().max(1) {
                longest = series;
            }
        }
        longest
    }

    fn sample(&self, case: &Case, quantity: usize) -> Result<Sample, StatsError> {
        Ok(Sample::of(&singles(self.cases, self.realizations, case.row, QUANTITIES[quantity])?))
    }

    /// Means of a quantity over a series; nothing if one is missing or there are fewer than `least`.
    fn means(&self, series: &[Case], quantity: usize, least: usize) -> Result<Option<Vec<f64>>, StatsError> {
        let means: Vec<Option<f64>> = series
            .iter()
            .map(|case| Ok(self.sample(case, quantity)?.mean))
            .collect::<Result<_, StatsError>>()?;
        Ok(means.into_iter().collect::<Option<Vec<f64>>>().filter(|means| means.len() >= least))
    }

    /// Finding 1: `(max − min)/mean` of the mean pull-off forces.
    fn constant_pull_off(&self, loads: &[Case]) -> Result<Option<Judged>, StatsError> {
        let Some(means) = self.means(loads, 1, 2)? else { return Ok(None) };
        let (least, most) = extremes(&means);
        let spread = (most - least) * means.len() as f64 / means.iter().sum::<f64>();
        Ok(Some(Judged {
            verdict: Verdict::within(spread, SPREADS),
            numbers: vec![spread],
            text: percent(spread),
        }))
    }

    /// Finding 2: the largest residual of the straight line of least squares, over the largest Θ.
    fn linear_loss(&self, loads: &[Case]) -> Result<Option<Judged>, StatsError> {
        let (Some(areas), Some(losses)) = (self.means(loads, 0, 3)?, self.means(loads, 2, 3)?) else {
            return Ok(None);
        };
        let count = areas.len() as f64;
        let (x, y) = (areas.iter().sum::<f64>() / count, losses.iter().sum::<f64>() / count);
        let square: f64 = areas.iter().map(|a| (a - x).powi(2)).sum();
        let slope = areas.iter().zip(&losses).map(|(a, e)| (a - x) * (e - y)).sum::<f64>() / square;
        let largest = losses.iter().copied().fold(0.0, f64::max);
        let residual =
            areas.iter().zip(&losses).map(|(a, e)| (e - y - slope * (a - x)).abs()).fold(0.0, f64::max)
                / largest;
        Ok(Some(Judged {
            verdict: Verdict::within(residual, RESIDUALS),
            numbers: vec![residual],
            text: percent(residual),
        }))
    }

    /// Finding 3: smallest and largest `Θ/Θ_DK` of all cases.
    fn estimate(&self) -> Result<Option<Judged>, StatsError> {
        let ratios = self.cases.f64_or_null("loss_ratio_dk_mean")?;
        let ratios: Vec<f64> = self.rows.iter().filter_map(|case| ratios[case.row]).collect();
        if ratios.is_empty() {
            return Ok(None);
        }
        let (least, most) = extremes(&ratios);
        let verdict = Verdict::within(most.max(1.0 / least), FACTORS);
        Ok(Some(Judged {
            verdict,
            numbers: vec![least, most],
            text: format!("{}–{}", significant(least, 2), significant(most, 2)),
        }))
    }

    /// Findings 4 to 6: the ratio of the last mean to the first one of each series. It holds if the
    /// difference has the sign and exceeds its 95 % interval, and partly if it has the sign.
    fn trends(&self, parts: &[(usize, &[Case], f64)]) -> Result<Option<Judged>, StatsError> {
        let (mut verdicts, mut numbers) = (Vec::new(), Vec::new());
        for (quantity, series, sign) in parts {
            let (Some(first), Some(last)) = (series.first(), series.last()) else { continue };
            let found =
                difference_of(self.cases, self.realizations, [last.row, first.row], QUANTITIES[*quantity])?;
            let Some(found) = found else { continue };
            let certain = found.ci95.is_none_or(|half| half < found.of.abs());
            verdicts.push(match (found.of * sign > 0.0, certain) {
                (true, true) => Verdict::Yes,
                (true, false) => Verdict::Partly,
                (false, _) => Verdict::No,
            });
            numbers.push(found.means[0] / found.means[1]);
        }
        let text =
            numbers.iter().map(|ratio| format!("×{}", significant(*ratio, 2))).collect::<Vec<_>>().join(" ");
        Ok(Verdict::of_all(&verdicts).map(|verdict| Judged { verdict, numbers, text }))
    }

    /// Finding 7: in how many of the comparisons the relative standard deviation is larger where the paper
    /// says so.
    fn scatter(&self, magnifications: &[Case], hursts: &[Case]) -> Result<Option<Judged>, StatsError> {
        let ends = [(magnifications.first(), magnifications.last()), (hursts.last(), hursts.first())];
        let (mut larger, mut all) = (0_usize, 0_usize);
        for (wide, narrow) in ends {
            let (Some(wide), Some(narrow)) = (wide, narrow) else { continue };
            for quantity in 0..QUANTITIES.len() {
                let relative = |case: &Case| -> Result<Option<f64>, StatsError> {
                    let sample = self.sample(case, quantity)?;
                    Ok(sample.sd.zip(sample.mean).map(|(sd, mean)| sd / mean.abs()))
                };
                let (Some(wide), Some(narrow)) = (relative(wide)?, relative(narrow)?) else { continue };
                all += 1;
                larger += usize::from(wide > narrow);
            }
        }
        if all == 0 {
            return Ok(None);
        }
        let verdict = if larger + 1 >= all {
            Verdict::Yes
        } else if 2 * larger >= all {
            Verdict::Partly
        } else {
            Verdict::No
        };
        Ok(Some(Judged {
            verdict,
            numbers: vec![larger as f64, all as f64],
            text: format!("{larger} of {all}"),
        }))
    }
}

/// Smallest and largest value.
fn extremes(values: &[f64]) -> (f64, f64) {
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)))
}

fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 2))
}
