//! Both methods on the same surfaces: ratios of area, pull-off force and dissipated energy.

use super::listed::case_label;
use super::rows::{Rows, Value};
use super::student::Sample;
use super::varying::varying;
use super::{CaseInput, Given, StatsError, significant};
use crate::schema::METHODS;
use crate::store::Frame;

/// Compared columns of the table `realizations`.
const COMPARED: [&str; 3] = ["area_at_max_load", "pull_off_load", "loss"];

/// Rows of the table `realizations` of one surface and load, the first by asperities, the second by boundary
/// elements.
type Pair = [usize; 2];

/// Compares pairs of cases, of which the first is of the asperity model and the second of boundary elements.
/// The rows have the order of the pairs, and of the loads and surfaces of the first case.
///
/// # Errors
/// If the table lacks a column.
pub fn methods(
    cases: &[CaseInput],
    pairs: &[[String; 2]],
    realizations: &Frame,
) -> Result<Frame, StatsError> {
    let mut rows = Rows::of(&METHODS);
    for pair in pairs {
        let mut loads: Vec<f64> = cases
            .iter()
            .find(|case| case.case_id == pair[0])
            .map(|case| case.max_loads.clone())
            .unwrap_or_default();
        loads.sort_by(f64::total_cmp);
        for load in loads {
            let found = same_surfaces(pair, load, realizations)?;
            let mut shared: Given = Vec::new();
            let mut own: Vec<Given> = vec![Vec::new(); found.len()];
            for column in COMPARED {
                compare(column, &found, realizations, &mut shared, &mut own)?;
            }
            let (surfaces, numbers) = (realizations.text("surface_id")?, realizations.i64("realization")?);
            let ratio = realizations.f64_or_null("persson_tosatti_realised")?;
            for (of_surface, [first, _]) in own.iter().zip(&found) {
                let columns: [(&str, Value); 7] = [
                    ("asperities_case_id", pair[0].as_str().into()),
                    ("elements_case_id", pair[1].as_str().into()),
                    ("surface_id", surfaces[*first].into()),
                    ("realization", numbers[*first].into()),
                    ("max_load", load.into()),
                    ("persson_tosatti_realised", ratio[*first].into()),
                    ("surface_count", found.len().into()),
                ];
                let named: Given =
                    columns.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
                rows.push(&[&named, of_surface, &shared]);
            }
        }
    }
    rows.build()
}

/// The rows of the surfaces that both cases have at a load.
fn same_surfaces(pair: &[String; 2], load: f64, realizations: &Frame) -> Result<Vec<Pair>, StatsError> {
    let (ids, loads, surfaces) =
        (realizations.text("case_id")?, realizations.f64("max_load")?, realizations.text("surface_id")?);
    // A load reversal is a number of the spec, copied; the tolerance covers the rounding in a file.
    let of = |id: &str| -> Vec<usize> {
        (0..ids.len())
            .filter(|row| ids[*row] == id && (loads[*row] - load).abs() <= 1e-9 * load.abs())
            .collect()
    };
    let (first, second) = (of(&pair[0]), of(&pair[1]));
    let partner = |row: usize| {
        second.iter().copied().find(|other| surfaces[*other] == surfaces[row]).map(|other| [row, other])
    };
    Ok(first.into_iter().filter_map(partner).collect())
}

/// Values, ratios and their statistics of a column. There is no ratio of a dissipated energy that is not
/// resolved.
fn compare(
    column: &str,
    pairs: &[Pair],
    realizations: &Frame,
    shared: &mut Given,
    own: &mut [Given],
) -> Result<(), StatsError> {
    let values = realizations.f64_or_null(column)?;
    let mut ratios = Vec::new();
    for (row, [first, second]) in own.iter_mut().zip(pairs) {
        let (asperities, elements) = (values[*first], values[*second]);
        let ratio = asperities
            .zip(elements.filter(|elements| *elements != 0.0))
            .map(|(asperities, elements)| asperities / elements);
        row.push((format!("{column}_asperities"), asperities.into()));
        row.push((format!("{column}_elements"), elements.into()));
        row.push((format!("{column}_ratio"), ratio.into()));
        ratios.extend(ratio);
    }
    let sample = Sample::of(&ratios);
    let end = |sign: f64| sample.mean.zip(sample.ci95).map(|(mean, half)| mean + sign * half);
    shared.push((format!("{column}_ratio_mean"), sample.mean.into()));
    shared.push((format!("{column}_ratio_sd"), sample.sd.into()));
    shared.push((format!("{column}_ratio_ci95_low"), end(-1.0).into()));
    shared.push((format!("{column}_ratio_ci95_high"), end(1.0).into()));
    Ok(())
}

/// Means of both methods for a pair of cases at one load.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodPair {
    /// Ids of the cases: asperities, boundary elements.
    pub cases: [String; 2],
    /// Load at the reversal.
    pub max_load: f64,
    /// Surfaces.
    pub count: usize,
    /// Mean of the asperity model, of boundary elements, and mean and standard deviation of the ratio, of
    /// each compared quantity.
    pub quantities: [[Option<f64>; 4]; 3],
}

/// The pairs of cases of the table `methods`, in its order.
///
/// # Errors
/// If the table lacks a column.
pub fn method_pairs(methods: &Frame) -> Result<Vec<MethodPair>, StatsError> {
    let (first, second, loads) =
        (methods.text("asperities_case_id")?, methods.text("elements_case_id")?, methods.f64("max_load")?);
    let rows: Vec<usize> = (0..methods.row_count()).collect();
    let same =
        |a: &usize, b: &usize| first[*a] == first[*b] && second[*a] == second[*b] && loads[*a] == loads[*b];
    let mut pairs = Vec::new();
    for group in rows.chunk_by(same) {
        let row = group[0];
        let mut quantities = [[None; 4]; 3];
        for (quantity, column) in quantities.iter_mut().zip(COMPARED) {
            let mean = |end: &str| -> Result<Option<f64>, StatsError> {
                let values = methods.f64_or_null(&format!("{column}_{end}"))?;
                Ok(Sample::of(&group.iter().filter_map(|row| values[*row]).collect::<Vec<f64>>()).mean)
            };
            let one = |end: &str| -> Result<Option<f64>, StatsError> {
                Ok(methods.f64_or_null(&format!("{column}_ratio_{end}"))?[row])
            };
            *quantity = [mean("asperities")?, mean("elements")?, one("mean")?, one("sd")?];
        }
        let cases = [first[row], second[row]].map(str::to_owned);
        pairs.push(MethodPair { cases, max_load: loads[row], count: group.len(), quantities });
    }
    Ok(pairs)
}

const HEADER: &str = "\
Asperity model over boundary elements on the same surfaces: mean ± standard
deviation of the ratio; n: surfaces.
";

/// The ratios of all pairs of cases as lines of at most 80 columns; empty without a pair.
///
/// # Errors
/// If the table lacks a column.
pub fn methods_summary(cases: &Frame, methods: &Frame) -> Result<String, StatsError> {
    let pairs = method_pairs(methods)?;
    if pairs.is_empty() {
        return Ok(String::new());
    }
    let names = names_of_pairs(cases, &pairs)?;
    let mut text =
        format!("{HEADER}{:<38}{:>8}{:>4}{:>10}{:>10}{:>10}\n", "case", "F_max", "n", "A", "F_po", "Θ");
    for (pair, name) in pairs.iter().zip(&names) {
        let [area, pull_off, loss] = pair.quantities.map(|[.., mean, sd]| ratio(mean, sd));
        let name: String = name.chars().take(37).collect();
        let load = significant(pair.max_load, 4);
        text += &format!("{name:<38}{load:>8}{:>4}{area:>10}{pull_off:>10}{loss:>10}\n", pair.count);
    }
    Ok(text)
}

/// Names of pairs of cases: the parameters that vary among their cases, without parameters that differ
/// between the methods.
///
/// # Errors
/// If the table `cases` lacks a column.
pub fn names_of_pairs(cases: &Frame, pairs: &[MethodPair]) -> Result<Vec<String>, StatsError> {
    let ids = cases.text("case_id")?;
    let place = |id: &str| ids.iter().position(|known| *known == id).unwrap_or_default();
    let rows: Vec<usize> = pairs.iter().flat_map(|pair| pair.cases.each_ref().map(|id| place(id))).collect();
    let differing = varying(cases, &rows)?;
    let name = |at: usize| {
        let mut parts: Vec<String> = Vec::new();
        for row in [2 * at, 2 * at + 1] {
            let said =
                differing.iter().filter(|parameter| parameter.name != "method" && !parameter.is_absent(row));
            for part in said.map(|parameter| parameter.named(row)) {
                if !parts.contains(&part) {
                    parts.push(part);
                }
            }
        }
        if parts.is_empty() { case_label(cases, rows[2 * at]) } else { Ok(parts.join(", ")) }
    };
    (0..pairs.len()).map(name).collect()
}

fn ratio(mean: Option<f64>, sd: Option<f64>) -> String {
    match (mean, sd) {
        (None, _) => "-".to_owned(),
        (Some(mean), None) => format!("{mean:.2}"),
        (Some(mean), Some(sd)) => format!("{mean:.2}±{sd:.2}"),
    }
}
