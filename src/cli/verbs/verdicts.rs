//! Verdicts on cases before a run, as text and as JSON.

use crate::model::{Choice, Method, Regime};
use crate::stages::{Cost, Foreseen, Outside, Verdict, in_words};
use crate::stats::{Caution, significant};
use crate::text::{counted, visible, wrapped};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Indentation of further lines.
const INDENT: &str = "          ";

/// Codes of warnings that a run prints before its first task.
const BEFORE_A_RUN: [&str; 2] = ["slow_grid", "long_loop"];

/// Verdicts, warnings and expected errors of a plan, as lines of at most 80 columns.
pub(super) fn plan_text(of: &Foreseen) -> String {
    let warnings: String = of.warnings.iter().map(|warning| warning_text(warning, shown_count(of))).collect();
    regimes(&of.verdicts) + &costs(&of.verdicts) + &warnings + &errors(&of.verdicts)
}

/// Verdicts and the most important warnings before the first task of a run.
pub(super) fn run_text(of: &Foreseen) -> String {
    let warnings = BEFORE_A_RUN
        .iter()
        .filter_map(|code| of.warning(code))
        .map(|warning| warning_text(warning, shown_count(of)));
    let text = regimes(&of.verdicts) + &costs(&of.verdicts) + &warnings.collect::<String>();
    text.trim_end().to_owned()
}

/// Number of cases, without coarser grids of other cases.
fn shown_count(of: &Foreseen) -> usize {
    of.verdicts.iter().filter(|of| !of.is_coarser_grid).count()
}

/// Warning as text.
fn warning_text(of: &Outside, all: usize) -> String {
    let Caution { code, label, consequence, action, .. } = of.kind;
    let cases = format!("{} of {}", of.cases.len(), counted(all, "case"));
    let text = format!("warning[{code}]: {label}: {} for {cases}. {consequence} {action}", of.measured);
    wrapped(&text, "  ")
}

/// Smallest and largest of some values as text, with `digits` significant digits.
pub(super) fn range(values: impl Iterator<Item = f64> + Clone, digits: usize) -> Option<String> {
    let [low, high] = [f64::min, f64::max]
        .map(|choose| values.clone().reduce(choose).map(|value| significant(value, digits)));
    let (low, high) = (low?, high?);
    Some(if low == high { low } else { format!("{low} to {high}") })
}

/// One paragraph for each regime and method.
fn regimes(verdicts: &[Verdict]) -> String {
    let mut groups: BTreeMap<_, Vec<&Verdict>> = BTreeMap::new();
    let shown: Vec<&Verdict> = verdicts.iter().filter(|of| !of.is_coarser_grid).collect();
    for of in shown.iter().filter(|of| of.regime.is_some() || of.error.is_none()) {
        groups.entry((of.regime, of.is_table_missing, of.method)).or_default().push(of);
    }
    groups
        .values()
        .map(|group| wrapped(&format!("{:10}{}", "regime", regime(group, shown.len())), INDENT))
        .collect()
}

/// The regime of cases that share regime and method.
fn regime(group: &[&Verdict], all: usize) -> String {
    let cases = if group.len() == all { String::new() } else { format!(" ({} of {all} cases)", group.len()) };
    let [first, ..] = group else { return String::new() };
    let Some(regime) = first.regime else {
        if first.is_table_missing {
            return format!("unknown{cases}: the file of `surface.spectrum` is not there or changed");
        }
        return format!(
            "known after the stage extract{cases}: the scan is too large to be read for the plan"
        );
    };
    let ratio = range(group.iter().filter_map(|of| of.persson_tosatti), 2);
    let octave = range(group.iter().filter_map(|of| of.conformity.filter(|ratio| *ratio > 0.0)), 2);
    let ratios = ratio.map_or_else(|| "no adhesion".to_owned(), |ratio| format!("U_el/Δγ = {ratio}"));
    let octave = octave.map_or_else(String::new, |octave| format!(", U_1/Δγ = {octave}"));
    let expectation = regime.expectation(first.method);
    format!(
        "{}, {}{cases}: {ratios}{octave}. {expectation}.{}",
        regime.name(),
        first.method.name(),
        effective(group)
    )
}

/// The effective work of adhesion of flattened surfaces, as a sentence.
fn effective(group: &[&Verdict]) -> String {
    let flat = || group.iter().filter(|of| of.regime == Some(Regime::Flattened));
    let energy = range(flat().filter_map(|of| of.effective_adhesion_j_m2), 3);
    let share = range(
        flat().filter_map(|of| Some(100.0 * of.effective_adhesion_j_m2? / of.work_of_adhesion_j_m2)),
        3,
    );
    energy.zip(share).map_or_else(String::new, |(energy, share)| {
        format!(" Effective work of adhesion {energy} J/m² ({share}\u{a0}% of Δγ).")
    })
}

/// Grids, memory and time of the cycles, one paragraph for each method.
fn costs(verdicts: &[Verdict]) -> String {
    let of = |method: Method| {
        let costs: Vec<Cost> =
            verdicts.iter().filter(|of| of.method == method).filter_map(|of| of.cost).collect();
        let points = range(costs.iter().map(|cost| cost.points as f64), 5)?;
        let per_wavelength = range(costs.iter().map(|cost| cost.per_wavelength), 2)?;
        let largest = |of: fn(&Cost) -> f64| costs.iter().map(of).fold(0.0, f64::max);
        let grid = match method {
            Method::BoundaryElements if costs.iter().any(|cost| cost.is_mirrored) => {
                "grid with mirror images"
            }
            Method::BoundaryElements => "grid",
            _ => "grid of the surface",
        };
        // The time has an accuracy of a factor of 3.
        let (memory, time) =
            (significant(largest(|cost| cost.memory_bytes) / 1e9, 1), in_words(largest(|cost| cost.seconds)));
        let text = format!(
            "{}: {grid} {points} points a side, {per_wavelength} per shortest wavelength; some {memory} GB, \
             up to about {time} a cycle",
            method.name()
        );
        Some(wrapped(&format!("{:10}{text}", "cost"), INDENT))
    };
    Method::WORDS.iter().filter_map(|(_, method)| of(*method)).collect()
}

/// Errors by which the run would fail, each with the number of its cases.
fn errors(verdicts: &[Verdict]) -> String {
    let mut known: Vec<((&str, bool), usize)> = Vec::new();
    for (error, is_coarser) in
        verdicts.iter().filter_map(|of| Some((of.error.as_deref()?, of.is_coarser_grid)))
    {
        match known.iter_mut().find(|(of, _)| *of == (error, is_coarser)) {
            Some((_, count)) => *count += 1,
            None => known.push(((error, is_coarser), 1)),
        }
    }
    let text = |((error, is_coarser), count): &((&str, bool), usize)| {
        let (problem, help) = error.split_once("\nhelp: ").unwrap_or((error, ""));
        let all = verdicts.iter().filter(|of| of.is_coarser_grid == *is_coarser).count();
        let noun = if *is_coarser { "coarser grid" } else { "case" };
        let problem = format!(
            "warning: the run would fail for {count} of {}: {}",
            counted(all, noun),
            visible(problem)
        );
        let help = if help.is_empty() {
            String::new()
        } else {
            wrapped(&format!("  help: {}", visible(help)), "  ")
        };
        wrapped(&problem, "  ") + &help
    };
    known.iter().map(text).collect()
}

/// Verdict in JSON.
pub(super) fn json(of: &Verdict) -> Value {
    json!({
        "id": of.case_id,
        "coarser_grid": of.is_coarser_grid,
        "method": of.method.word(),
        "regime": of.regime.map(Regime::name),
        "recommended_method": of.regime.map(|regime| regime.method().word()),
        "persson_tosatti": of.persson_tosatti,
        "conformity": of.conformity,
        "effective_work_of_adhesion_j_m2": of.effective_adhesion_j_m2,
        "grid_points": of.cost.map(|cost| cost.points),
        "points_per_shortest_wavelength": of.cost.map(|cost| cost.per_wavelength),
        "mirrored": of.cost.map(|cost| cost.is_mirrored),
        "memory_bytes": of.cost.map(|cost| cost.memory_bytes.round()),
        "seconds": of.cost.map(|cost| cost.seconds),
        "error": of.error,
    })
}

/// Cases with a warning, in JSON.
pub(super) fn outside_json(of: &Outside) -> Value {
    json!({
        "code": of.kind.code, "min": of.range[0], "max": of.range[1], "limit": of.limit, "cases": of.cases,
    })
}
