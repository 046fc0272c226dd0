//! `findings`: which findings of the paper each reading of its text yields.

use super::outputs::undamaged;
use super::place::folder_of;
use super::{Fault, failed, say};
use crate::schema::{CASES, REALIZATIONS, Table};
use crate::stats::{self, FINDINGS, Judged, Reading};
use crate::store::parquet::read_table;
use crate::text::{counted, shown, visible, wrapped};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Meaning of the numbers under the verdicts, by finding.
const NUMBERS: [&str; 7] = [
    "(max − min)/mean of F_po over F_max",
    "largest distance from a straight line, over the largest Θ",
    "least and largest Θ/Θ_DK",
    "A at largest over A at smallest ζ; the same over H",
    "F_po and Θ at largest over those at smallest ζ",
    "F_po and Θ at largest over those at smallest H",
    "comparisons of sd/mean with this sign",
];

pub(super) fn findings(runs: &[PathBuf], as_json: bool) -> Result<u8, Fault> {
    let mut readings = Vec::new();
    for run in runs {
        let dir = folder_of(run)?;
        let read = |table: &'static Table| {
            let path = dir.join(table.file);
            if path.is_file() {
                undamaged("judge the findings of", &dir, table.file)?;
            }
            read_table(&path, table).map_err(failed)
        };
        let found = stats::findings(&read(&CASES)?, &read(&REALIZATIONS)?).map_err(failed)?;
        let label = if runs.len() > 1 { shown(&dir) } else { String::new() };
        readings.extend(found.into_iter().map(|reading| (label.clone(), reading)));
    }
    if readings.is_empty() {
        let dirs = runs.iter().map(|run| shown(run)).collect::<Vec<_>>().join(", ");
        return Err(failed(format!(
            "cannot judge the findings: no two cases of {dirs} differ only in maximum load, magnification or \
             Hurst exponent\n\
             help: sweep `cycle.max_load`, `surface.magnification` or `surface.hurst`, as \
             pipelines/readings.toml does"
        )));
    }
    say(&if as_json {
        format!("{:#}\n", json!({ "findings": FINDINGS, "readings": as_values(&readings) }))
    } else {
        table(&readings)
    })?;
    Ok(0)
}

fn as_values(readings: &[(String, Reading)]) -> Vec<Value> {
    let judged = |judged: &Option<Judged>| {
        judged.as_ref().map(|of| json!({ "verdict": of.verdict.word(), "numbers": of.numbers }))
    };
    let value = |(run, reading): &(String, Reading)| {
        json!({
            "run": run, "name": reading.name, "case_ids": reading.case_ids,
            "planned_count": reading.planned_count, "failed_count": reading.failed_count,
            "findings": reading.findings.iter().map(judged).collect::<Vec<_>>(),
        })
    };
    readings.iter().map(value).collect()
}

/// A cell for each finding.
fn line(cells: impl Iterator<Item = String>) -> String {
    let cells = cells.map(|cell| format!("{cell:<10}")).collect::<Vec<_>>().join(" ");
    format!("  {}\n", cells.trim_end())
}

/// Table of verdicts and numbers, 80 columns wide, with the meaning of its numbers.
fn table(readings: &[(String, Reading)]) -> String {
    let mut text = line((1..=FINDINGS.len()).map(|number| number.to_string()));
    for (run, reading) in readings {
        let name = [run.as_str(), &reading.name]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(": ");
        let name = if name.is_empty() { "all cases".to_owned() } else { name };
        let failed = if reading.failed_count > 0 {
            format!(
                " ({} of {} failed)",
                reading.failed_count,
                counted(usize::try_from(reading.planned_count).unwrap_or(0), "cycle")
            )
        } else {
            String::new()
        };
        text += &format!("\n{}", wrapped(&visible(&format!("{name}{failed}")), ""));
        for cell in
            [|judged: &Judged| judged.verdict.word().to_owned(), |judged: &Judged| judged.text.clone()]
        {
            text += &line(
                reading.findings.iter().map(|judged| judged.as_ref().map_or_else(|| "–".to_owned(), cell)),
            );
        }
    }
    text += "\n";
    for (number, (finding, numbers)) in FINDINGS.iter().zip(NUMBERS).enumerate() {
        text += &wrapped(&format!("{}  {finding}: {numbers}", number + 1), "   ");
    }
    text
}
