//! Expected error of the asperity model: its results over those of boundary elements, by the ratio `U_el/Δγ`
//! of the surface.
//!
//! The table is the result of `pipelines/validity.toml`, reduced by `tests/reference/validity.py`. Its
//! heading states the versions of both methods that made it (`# versions:`), and later versions with which it
//! was compared or not (`# later:`).

use super::rows::Value;
use super::{CaseInput, Given, Limit};
use crate::campaign::{ELEMENTS_VERSION, asperities_version};
use std::sync::LazyLock;

const TABLE: &str = include_str!("model_error.csv");

/// Columns of the table `cases`: ratio of contact area, pull-off force and dissipated energy, each with its
/// uncertainty.
pub(super) const COLUMNS: [[&str; 2]; 3] = [
    ["area_model_ratio", "area_model_ratio_error"],
    ["pull_off_model_ratio", "pull_off_model_ratio_error"],
    ["loss_model_ratio", "loss_model_ratio_error"],
];

/// A ratio and its uncertainty.
type Ratio = [f64; 2];

/// Ratios of area, pull-off force and dissipated energy; nothing where the surfaces differ by more than the
/// mean.
type Ratios = [Option<Ratio>; 3];

/// A row: coalescence rule, `ln(U_el/Δγ)`, and the ratios.
type Row = (&'static str, f64, Ratios);

static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| TABLE.lines().filter_map(row).collect());

/// Versions of the asperity model and of boundary elements in a line of the heading of the table.
fn versions(of: &str) -> Option<[u32; 2]> {
    let line = TABLE.lines().find_map(|line| line.strip_prefix(of))?;
    let number = |name: &str| {
        let (_, rest) = line.split_once(name)?;
        rest.trim_start().split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
    };
    Some([number("asperities")?, number("boundary_elements")?])
}

/// Versions that made the table, as a sentence; nothing if they are those of the program.
pub(super) fn outdated() -> Option<String> {
    let present = [asperities_version(), ELEMENTS_VERSION];
    let made = versions("# versions:");
    let shown = |[asperities, elements]: [u32; 2]| {
        format!("version {asperities} of the asperity model and {elements} of boundary elements")
    };
    let text = made.map_or_else(|| "unknown versions".to_owned(), shown);
    (made != Some(present)).then(|| {
        format!(
            "The table of these ratios was made with {text}; this program has {} and {}.",
            present[0], present[1]
        )
    })
}

fn row(line: &'static str) -> Option<Row> {
    let mut cells = line.split(',');
    let coalescence = cells.next()?;
    let numbers: Vec<Option<f64>> = cells.map(|cell| cell.parse::<f64>().ok()).collect();
    let number = |at: usize| numbers.get(at).copied().flatten();
    // Means, standard deviations over the surfaces, and relative grid errors of boundary elements.
    let ratio = |of: usize| {
        let (mean, deviation, grid) = (number(1 + of)?, number(4 + of)?, number(7 + of)?);
        Some([mean, deviation.hypot(mean * grid)])
    };
    Some((coalescence, number(0)?.ln(), [ratio(0), ratio(1), ratio(2)]))
}

/// Ratios of the asperity model with a coalescence rule to boundary elements at `U_el/Δγ`, linear in its
/// logarithm between the rows of the table; nothing outside. The uncertainty adds the standard deviation over
/// surfaces and the grid error of boundary elements, squared.
pub(super) fn model_error(coalescence: &str, persson_tosatti: f64) -> Option<Ratios> {
    let at = persson_tosatti.ln();
    let rows: Vec<&Row> = ROWS.iter().filter(|row| row.0 == coalescence).collect();
    let pair = rows.windows(2).find(|pair| pair[0].1 <= at && at <= pair[1].1)?;
    let part = (at - pair[0].1) / (pair[1].1 - pair[0].1);
    let between = |low: Ratio, high: Ratio| [0, 1].map(|at| low[at] + part * (high[at] - low[at]));
    Some([0, 1, 2].map(|of| pair[0].2[of].zip(pair[1].2[of]).map(|(low, high)| between(low, high))))
}

/// The columns of a row of the table `cases`; missing without elastic interaction, for boundary elements, for
/// an anisotropic texture and outside the table.
pub(super) fn columns(row: &Given, case: &CaseInput) -> Given {
    let word = |column: &str| {
        case.parameters.iter().find(|(name, _)| name == column).and_then(|(_, value)| value.text())
    };
    let number =
        |column: &str| row.iter().find(|(name, _)| name == column).and_then(|(_, value)| value.number());
    let is_isotropic = !Limit::of("texture").is_some_and(|limit| limit.is_passed(number(limit.column)));
    let ratio = number("persson_tosatti_realised_mean").filter(|_| is_isotropic);
    let interacting = word("interaction").filter(|interaction| *interaction != "none");
    let found = interacting
        .and(word("coalescence"))
        .zip(ratio)
        .and_then(|(coalescence, ratio)| model_error(coalescence, ratio));
    COLUMNS
        .iter()
        .enumerate()
        .flat_map(|(of, names)| {
            let ratio = found.and_then(|ratios| ratios[of]);
            [0, 1].map(|at| (names[at].to_owned(), Value::from(ratio.map(|ratio| ratio[at]))))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{ROWS, model_error, outdated, versions};
    use crate::campaign::{ELEMENTS_VERSION, asperities_version};

    /// A version that moves requires the table: run
    /// `pipelines/validity.toml` and `tests/reference/validity.py`. If the ratios do not change, or if there
    /// is no time, the line `# later:` of the heading has the present versions and the reason; a run then
    /// prints the versions that made the table.
    #[test]
    fn law_the_table_states_the_present_versions() {
        let present = Some([asperities_version(), ELEMENTS_VERSION]);
        let made = versions("# versions:");
        assert!(
            made == present || versions("# later:") == present,
            "src/stats/model_error.csv was made with {made:?}, not with {present:?}"
        );
        assert_eq!(outdated().is_none(), made == present);
    }

    /// Between two rows the ratios lie between theirs, at a row they are its own, and outside the table there
    /// are none.
    #[test]
    fn law_ratios_are_those_of_the_table() {
        let merge: Vec<_> = ROWS.iter().filter(|row| row.0 == "merge").collect();
        assert!(merge.len() > 4 && merge.windows(2).all(|pair| pair[0].1 < pair[1].1));
        let [first, second] = [merge[0], merge[1]];
        let middle = model_error("merge", (0.5 * (first.1 + second.1)).exp());
        for (of, at) in [0, 1, 2].into_iter().flat_map(|of| [(of, 0), (of, 1)]) {
            let mean = first.2[of].zip(second.2[of]).map(|(low, high)| 0.5 * (low[at] + high[at]));
            let found = middle.and_then(|ratios| ratios[of]).map(|ratio| ratio[at]);
            assert!(
                found.zip(mean).is_some_and(|(found, mean)| (found - mean).abs() < 1e-12),
                "{found:?} and {mean:?}"
            );
        }
        // Each uncertainty is at least the standard deviation over the surfaces of the table.
        assert!(ROWS.iter().flat_map(|row| row.2).flatten().all(|[ratio, error]| error > 0.0 && ratio > 0.0));
        assert_eq!(model_error("merge", 1e-3), None);
        assert_eq!(model_error("merge", 1e6), None);
        assert_eq!(model_error("other", 3.0), None);
    }
}
