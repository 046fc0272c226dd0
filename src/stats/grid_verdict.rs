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

/// Fewest grid points per shortest wavelength of a grid.
const FEWEST_PER_WAVELENGTH: f64 = 4.0;

/// Columns of the table `cases` that the sentences name.
struct Columns<'a> {
    means: &'a [Option<f64>],
    highs: &'a [Option<f64>],
    grid: &'a [Option<f64>],
    area: &'a [Option<f64>],
    pull_off: &'a [Option<f64>],
    of_grids: &'a [Option<i64>],
    done: Vec<i64>,
    methods: Vec<&'a str>,
}

impl<'a> Columns<'a> {
    fn of(cases: &'a Frame) -> Result<Self, StatsError> {
        Ok(Self {
            means: cases.f64_or_null("loss_mean")?,
            highs: cases.f64_or_null("loss_ci95_high")?,
            grid: cases.f64_or_null("loss_grid_error")?,
            area: cases.f64_or_null("area_grid_error")?,
            pull_off: cases.f64_or_null("pull_off_grid_error")?,
            of_grids: cases.i64_or_null("grid_surface_count")?,
            done: cases.i64("done_count")?,
            methods: cases.text("method")?,
        })
    }

    /// Mean of a row by boundary elements.
    fn mean(&self, row: usize) -> Option<f64> {
        self.means[row].filter(|_| self.methods[row] == Method::BoundaryElements.word())
    }

    /// Θ of a row with its grid error, and those of the other results.
    fn sentence(&self, row: usize) -> Option<String> {
        let (mean, error) = self.mean(row).zip(self.grid[row])?;
        let others = [("A", self.area[row]), ("F_po", self.pull_off[row])].into_iter();
        let others = others.filter_map(|(of, error)| {
            Some(format!(", {of}\u{a0}±\u{a0}{}", grid_percent(error?).replace(' ', "\u{a0}")))
        });
        let surfaces = count(self.done[row]);
        let of_surfaces = self.highs[row].filter(|_| mean != 0.0).map_or_else(
            || format!(" ({surfaces})"),
            |high| format!(" ± {} ({surfaces})", percent((high - mean) / mean.abs())),
        );
        // Surfaces that a coarser grid lacks are in the mean and not in the error.
        let fewer = self.of_grids[row].filter(|of| *of < self.done[row]);
        let grid = fewer.map_or_else(|| "grid".to_owned(), |of| format!("grid, {}", count(of)));
        let others: String = others.collect();
        Some(format!("Θ = {} ± {} ({grid}){of_surfaces}{others}", number(mean), grid_percent(error)))
    }

    /// Θ of a row without a grid error.
    fn unknown(&self, row: usize) -> Option<String> {
        Some(format!("Θ = {}, grid error unknown", number(self.mean(row)?)))
    }
}

/// `Θ = 1.46e-3 ± 3 % (grid) ± 12 % (six surfaces), A ± 1 %, F_po ± 5 %` of a row of the table `cases`: the
/// mean over E* A0 h_rms, its estimated discretization error, the half-width of its 95 % confidence interval,
/// and the discretization errors of contact area and pull-off force. Nothing without the first error.
///
/// # Errors
/// If the table lacks a column.
pub fn grid_verdict(cases: &Frame, row: usize) -> Result<Option<String>, StatsError> {
    Ok(Columns::of(cases)?.sentence(row).map(|sentence| sentence.replace('\u{a0}', " ")))
}

/// Help where some rows have results by boundary elements, and none has a grid error; nothing otherwise.
///
/// # Errors
/// If the table lacks a column.
pub fn grid_help(cases: &Frame, rows: &[usize]) -> Result<Option<String>, StatsError> {
    let (columns, points) = (Columns::of(cases)?, cases.f64_or_null("element_points")?);
    let resolution = cases.f64_or_null("elements_per_wavelength_min")?;
    let mut by_elements = rows.iter().copied().filter(|row| columns.mean(*row).is_some());
    let Some(first) = by_elements.clone().next() else { return Ok(None) };
    let is_unknown = by_elements.all(|row| columns.grid[row].is_none());
    let list = points[first].map_or_else(
        || "points_per_wavelength = [8, 16]".to_owned(),
        |points| {
            let has_coarser = resolution[first].is_none_or(|found| found >= 2.0 * FEWEST_PER_WAVELENGTH);
            let finest = if has_coarser { points } else { 2.0 * points };
            // Grids with mirror images have even numbers of points.
            format!("points = [{}, {finest}]", 2.0 * (finest / 4.0).round())
        },
    );
    Ok(is_unknown.then(|| format!("grid error unknown; boundary_elements.{list} estimates it")))
}

/// Sentences on the listed rows, each with its case and load, and the rest of them as a number. None if no
/// row of the table has a grid error.
pub(super) fn lines(cases: &Frame, rows: &[Listed], loads: &[String]) -> Result<Vec<String>, StatsError> {
    let columns = Columns::of(cases)?;
    if columns.grid.iter().all(Option::is_none) {
        return Ok(Vec::new());
    }
    let of = |listed: &Listed| {
        let sentence = columns.sentence(listed.row).or_else(|| columns.unknown(listed.row))?;
        let label = listed.label.replace(" = ", "=");
        Some(format!("{label}, F_max={}: {sentence}", loads.get(listed.row)?))
    };
    let mut all: Vec<String> = rows.iter().filter_map(of).collect();
    let rest = all.len().saturating_sub(MOST);
    all.truncate(MOST);
    all.extend((rest > 0).then(|| format!("{rest} more: loss_grid_error in statistics/cases.parquet")));
    Ok(all)
}

/// Grid error above which it is not stated as a number: the grids disagree, as where contact is full on one
/// only.
const LARGEST: f64 = 1.0;

/// A relative grid error in percent with two digits, and at most 100 %: `3.1 %`, `> 100 %`.
#[must_use]
pub fn grid_percent(error: f64) -> String {
    if error > LARGEST { "> 100 %".to_owned() } else { percent(error) }
}

/// A share in percent with two digits.
fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 2))
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
