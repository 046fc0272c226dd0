//! The dissipated energy of each case by boundary elements with its errors: of the grid, and of the mean over
//! surfaces.

use super::listed::Listed;
use super::{StatsError, significant};
use crate::model::{Choice as _, Method};
use crate::store::Frame;

/// Lines of one sweep, at most.
const MOST: usize = 8;

/// Words of small numbers.
const WORDS: [&str; 11] =
    ["two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"];

/// Columns of the table `cases` that the sentences name.
struct Columns<'a> {
    means: &'a [Option<f64>],
    highs: &'a [Option<f64>],
    grid: &'a [Option<f64>],
    done: Vec<i64>,
    methods: Vec<&'a str>,
}

impl<'a> Columns<'a> {
    fn of(cases: &'a Frame) -> Result<Self, StatsError> {
        Ok(Self {
            means: cases.f64_or_null("loss_mean")?,
            highs: cases.f64_or_null("loss_ci95_high")?,
            grid: cases.f64_or_null("loss_grid_error")?,
            done: cases.i64("done_count")?,
            methods: cases.text("method")?,
        })
    }

    /// Θ of a finished row by boundary elements with its errors; nothing for other rows.
    fn sentence(&self, row: usize) -> Option<String> {
        let mean = self.means[row].filter(|_| self.methods[row] == Method::BoundaryElements.word())?;
        let of_grid = self.grid[row].map_or_else(
            || " (grid error unknown)".to_owned(),
            |error| format!(" ± {} (grid)", percent(error)),
        );
        let surfaces = count(self.done[row]);
        let of_surfaces = self.highs[row].filter(|_| mean != 0.0).map_or_else(
            || format!(" ({surfaces})"),
            |high| format!(" ± {} ({surfaces})", percent((high - mean) / mean.abs())),
        );
        Some(format!("Θ = {}{of_grid}{of_surfaces}", number(mean)))
    }
}

/// `Θ = 1.46e-3 ± 3 % (grid) ± 12 % (six surfaces)` of a row of the table `cases`: the mean over E* A0 h_rms, its
/// estimated discretization error, and the half-width of its 95 % confidence interval. Nothing for the
/// asperity model and without a result.
///
/// # Errors
/// If the table lacks a column.
pub fn grid_verdict(cases: &Frame, row: usize) -> Result<Option<String>, StatsError> {
    Ok(Columns::of(cases)?.sentence(row))
}

/// Help where a row by boundary elements has a result and no grid error; nothing otherwise.
///
/// # Errors
/// If the table lacks a column.
pub fn grid_help(cases: &Frame) -> Result<Option<String>, StatsError> {
    let columns = Columns::of(cases)?;
    let points = cases.f64_or_null("element_points")?;
    let is_unknown = |row: &usize| columns.grid[*row].is_none() && columns.sentence(*row).is_some();
    let Some(row) = (0..columns.means.len()).find(is_unknown) else { return Ok(None) };
    let finest = points[row].unwrap_or(128.0);
    Ok(Some(format!(
        "grid error unknown; boundary_elements.points = [{}, {finest}] estimates it",
        (finest / 2.0).round()
    )))
}

/// Sentences on the listed rows, each with its case and load, and the rest of them as a number.
pub(super) fn lines(cases: &Frame, rows: &[Listed], loads: &[String]) -> Result<Vec<String>, StatsError> {
    let columns = Columns::of(cases)?;
    let of = |listed: &Listed| {
        let sentence = columns.sentence(listed.row)?;
        let label = listed.label.replace(" = ", "=");
        Some(format!("{label}, F_max={}: {sentence}", loads.get(listed.row)?))
    };
    let mut all: Vec<String> = rows.iter().filter_map(of).collect();
    let rest = all.len().saturating_sub(MOST);
    all.truncate(MOST);
    all.extend((rest > 0).then(|| format!("{rest} more: loss_grid_error in statistics/cases.parquet")));
    Ok(all)
}

/// A share in percent with two digits below 10 %, and at most 1000 %.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent > 1000.0 { "1000 % or more".to_owned() } else { format!("{} %", significant(percent, 2)) }
}

/// A number with three digits and its exponent: 1.46e-3.
fn number(value: f64) -> String {
    if (0.1..1000.0).contains(&value.abs()) || value == 0.0 {
        significant(value, 3)
    } else {
        format!("{value:.2e}")
    }
}

/// A number of surfaces, small ones as words.
fn count(surfaces: i64) -> String {
    if surfaces == 1 {
        return "one surface".to_owned();
    }
    let word = usize::try_from(surfaces - 2).ok().and_then(|place| WORDS.get(place));
    word.map_or_else(|| format!("{surfaces} surfaces"), |word| format!("{word} surfaces"))
}
