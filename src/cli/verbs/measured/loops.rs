//! `import` of a measured loop: its results as text and as JSON, and its points as a table.

use super::super::outputs::may_be_written;
use super::super::{FAILED_CASES, Fault, failed, make_folder, say};
use super::inputs::unreadable;
use super::kinds::no_options_of_scans;
use crate::cli::ImportArguments;
use crate::formats::is_regular;
use crate::lengths::sizes;
use crate::model::{Baseline, Choice as _, Compression, LoopOptions};
use crate::stages::{Estimate, MeasuredLoop, half_width, measure_loop};
use crate::stats::significant;
use crate::store::force_curve::is_force_curve;
use crate::store::parquet::write_table;
use crate::text::{shown, wrapped};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// True if the file is a loop: by an option for loops, or by its heading.
pub(super) fn is_meant(asked: &ImportArguments, file: &Path) -> bool {
    let of = &asked.of_loop;
    of.is_loop || of.force_column.is_some() || of.displacement_column.is_some() || is_force_curve(file)
}

/// Evaluates a loop.
pub(super) fn import(asked: &ImportArguments, file: &Path) -> Result<u8, Fault> {
    no_options_of_scans(asked, file)?;
    let out = asked.out.clone().unwrap_or_else(|| named_after(file));
    let found = evaluated(asked, file, &out)?;
    let written = (!asked.dry_run).then_some(out.as_path());
    if asked.json {
        say(&format!("{:#}\n", answer(&found, written)))?;
    } else {
        say(&text(&found, file, written))?;
    }
    Ok(0)
}

/// Evaluates several loops, each with a table of its own, and names the loops that fail.
pub(super) fn import_all(asked: &ImportArguments) -> Result<u8, Fault> {
    for file in &asked.files {
        is_regular(file).map_err(|error| unreadable(file, &error))?;
    }
    let others: Vec<String> =
        asked.files.iter().filter(|file| !is_meant(asked, file)).map(|file| shown(file)).collect();
    if !others.is_empty() {
        return Err(failed(format!(
            "cannot import loops and other files in one command: {} {} no force and displacement in the \
             heading\nhelp: import them separately, or give --loop if they are loops",
            others.join(", "),
            if others.len() == 1 { "has" } else { "have" }
        )));
    }
    no_options_of_scans(asked, &asked.files[0])?;
    let outs = tables(asked)?;
    if let Some(folder) = asked.out.as_ref().filter(|_| !asked.dry_run) {
        make_folder(folder)?;
    }
    let (mut texts, mut answers, mut left) = (String::new(), Vec::new(), Vec::new());
    for (file, out) in asked.files.iter().zip(&outs) {
        match evaluated(asked, file, out) {
            Ok(found) => {
                let written = (!asked.dry_run).then_some(out.as_path());
                texts += &format!("{}\n", text(&found, file, written));
                answers.push(answer(&found, written));
            }
            Err(fault) => left.push((shown(file), fault.text.trim_start_matches("error: ").to_owned())),
        }
    }
    if answers.is_empty() {
        let (problem, help) =
            left.first().and_then(|(_, why)| why.split_once("\nhelp: ")).unwrap_or_default();
        return Err(failed(format!("none of {} loops was imported: {problem}\nhelp: {help}", outs.len())));
    }
    if asked.json {
        let left: Vec<Value> = left.iter().map(|(name, why)| json!({ "name": name, "why": why })).collect();
        say(&format!("{:#}\n", json!({ "loops": answers, "left_out": left })))?;
    } else {
        say(&texts)?;
        for (_, why) in &left {
            say(&wrapped(&format!("warning: left out: {}", why.replace('\n', "; ")), "  "))?;
        }
    }
    Ok(if left.is_empty() { 0 } else { FAILED_CASES })
}

/// Tables of several loops: in the folder of `--out`, or in the present folder.
fn tables(asked: &ImportArguments) -> Result<Vec<PathBuf>, Fault> {
    let folder = asked.out.clone().unwrap_or_default();
    let outs: Vec<PathBuf> = asked.files.iter().map(|file| folder.join(named_after(file))).collect();
    let twice = outs.iter().enumerate().find(|(place, out)| outs[..*place].contains(out));
    match twice {
        Some((place, out)) => Err(failed(format!(
            "cannot write two loops to {}: {} has the name of an earlier file\nhelp: import it separately, \
             with --out",
            shown(out),
            shown(&asked.files[place])
        ))),
        None => Ok(outs),
    }
}

/// A loop, with its points in a table unless nothing is to be written.
fn evaluated(asked: &ImportArguments, file: &Path, out: &Path) -> Result<MeasuredLoop, Fault> {
    let options = options(asked, file)?;
    let source = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let found = measure_loop(file, &source, &options).map_err(failed)?;
    if !asked.dry_run {
        may_be_written("the loop", out, file, asked.force)?;
        let steps = found.steps().map_err(failed)?;
        let keys = [
            ("measured", "true".to_owned()),
            ("source", found.source.clone()),
            ("source_blake3", found.digest.clone()),
            ("columns_read", found.curve.columns.join("; ")),
        ];
        write_table(out, &steps, &keys).map_err(failed)?;
    }
    Ok(found)
}

/// Radii of probes \[m\]: a number without a unit is in metres, and 20 for 20 µm is refused.
const PROBES_M: std::ops::RangeInclusive<f64> = 1e-9..=1.0;

/// `<name of the file>_loop.parquet` in the present folder.
fn named_after(file: &Path) -> PathBuf {
    let mut name = file.file_stem().unwrap_or(file.as_os_str()).to_owned();
    name.push("_loop.parquet");
    PathBuf::from(name)
}

fn options(asked: &ImportArguments, file: &Path) -> Result<LoopOptions, Fault> {
    let of = &asked.of_loop;
    let refused = |name: &str, value: &str, help: &str| {
        failed(format!("cannot import {}: {name} is {value}\nhelp: {help}", file.display()))
    };
    for (name, value) in [("--modulus", of.modulus), ("--machine-stiffness", of.machine_stiffness)] {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
            return Err(refused(name, &value.to_string(), "give a positive number"));
        }
    }
    let probe_radius_m = match of.probe_radius.as_deref() {
        None => None,
        Some(text) => match sizes(text).as_deref() {
            Some([radius]) if PROBES_M.contains(radius) => Some(*radius),
            Some([radius]) if radius.is_finite() && *radius > 0.0 => {
                let help = "give a length with its unit (20um), or in metres (2e-5); radii are 1 nm to 1 m";
                return Err(refused("--probe-radius", &format!("{text:?}, read as {radius:e} m"), help));
            }
            _ => {
                let help = "give a length with its unit (20um), or in metres (2e-5)";
                return Err(refused("--probe-radius", &format!("{text:?}"), help));
            }
        },
    };
    if of.modulus.is_some() && probe_radius_m.is_none() {
        let help = "give the radius of the probe too (--probe-radius), or leave the modulus out";
        return Err(refused("--modulus", "given without a probe", help));
    }
    let word = |text: &Option<String>| text.clone().unwrap_or_default();
    Ok(LoopOptions {
        force: word(&of.force_column),
        force_unit: word(&of.force_unit),
        displacement: word(&of.displacement_column),
        displacement_unit: word(&of.displacement_unit),
        radius: word(&of.radius_column),
        radius_unit: word(&of.radius_unit),
        compression: of.compression.as_deref().and_then(Compression::from_word).unwrap_or(Compression::Auto),
        baseline: of.baseline.as_deref().and_then(Baseline::from_word).unwrap_or(Baseline::Line),
        probe_radius_m,
        contact_modulus_pa: of.modulus,
        machine_stiffness_n_m: of.machine_stiffness,
    })
}

/// Names of the results in the text, and their units.
const LABELS: [(&str, &str); 9] = [
    ("F_po", "N"),
    ("Θ", "J"),
    ("closing", "J"),
    ("opening", "J"),
    ("w, F_po", "J/m²"),
    ("w, Θ", "J/m²"),
    ("w, approach", "J/m²"),
    ("w, retraction", "J/m²"),
    ("E*", "Pa"),
];

fn text(found: &MeasuredLoop, file: &Path, written: Option<&Path>) -> String {
    let mut text = format!("{}\n", file.display());
    let mut line = |label: &str, value: &str| {
        text += &wrapped(&format!("  {label:<14}{value}"), "                ");
    };
    for column in &found.curve.columns {
        line("read", column);
    }
    for (label, value) in conditions(found) {
        line(label, &value);
    }
    for ((label, unit), (_, estimate)) in LABELS.iter().zip(found.estimates()) {
        if found.apparent.is_none() && label.starts_with(['w', 'E']) {
            continue;
        }
        line(label, &estimate.map_or_else(|| "none".to_owned(), |of| with_interval(&of, unit)));
    }
    match (found.fit(), found.apparent) {
        (Some(fit), Some(of)) => line("fit", &fit_text(fit, found, of.residual)),
        (None, Some(_)) => line("fit", "none: the loop has too few points in contact, or no tension"),
        (_, None) => line("probe", "no radius: give --probe-radius for works of adhesion and modulus"),
    }
    for warning in found.warnings() {
        text += &wrapped(&format!("warning: {warning}"), "  ");
    }
    text += "Intervals are 95 % confidence intervals.\n";
    text + &written
        .map_or_else(|| "No file was written.\n".to_owned(), |path| format!("Written: {}\n", path.display()))
}

/// Points, signs and baseline.
fn conditions(found: &MeasuredLoop) -> Vec<(&'static str, String)> {
    let of = &found.evaluated;
    let [way, load] = found.oriented.signs;
    let sign = |sign: f64, positive: &'static str, negative: &'static str| {
        if sign > 0.0 { positive } else { negative }
    };
    let [offset, slope, drift] = of.baseline;
    let [before, after] = of.baseline_counts;
    let count = of.load_n.len();
    let mut lines = vec![
        ("points", format!("{} on approach, {} on retraction", of.turn + 1, count - of.turn - 1)),
        (
            "signs",
            format!(
                "displacement {} on approach; compression {} in the file",
                sign(way, "increases", "decreases"),
                sign(load, "positive", "negative")
            ),
        ),
        (
            "baseline",
            format!(
                "subtracted: offset {offset:.3e} N, slope {slope:.3e} N/m, drift {drift:.3e} N; fitted to \
                 {before} points before contact and {after} after separation"
            ),
        ),
        (
            "noise",
            format!(
                "{:.2e} N without contact; closure {:.1} %",
                of.noise_n,
                (1e3 * of.closure).round() / 10.0 + 0.0
            ),
        ),
    ];
    if let Some(stiffness) = found.options.machine_stiffness_n_m {
        lines.push(("machine", format!("F/k subtracted from the displacement, k = {stiffness} N/m")));
    }
    if let Some(radius) = found.options.probe_radius_m {
        let modulus = found.options.contact_modulus_pa;
        let given = modulus.map_or_else(|| "E* fitted".to_owned(), |modulus| format!("E* = {modulus:e} Pa"));
        lines.push(("probe", format!("R = {} m, {given}", significant(radius, 4))));
    }
    lines.push(("F_max", format!("{} N", significant(of.max_load_n, 4))));
    lines
}

fn with_interval(of: &Estimate, unit: &str) -> String {
    format!("{} ± {:.1e} {unit}", significant(of.value, 4), half_width(of))
}

fn fit_text(fit: &str, found: &MeasuredLoop, residual: Option<f64>) -> String {
    let over = if fit == "radius" { "contact radius" } else { "penetration" };
    let given = if found.options.contact_modulus_pa.is_some() {
        "works with the given E*, E* free"
    } else {
        "works with E* free"
    };
    format!(
        "load over {over}, {given}; rms residual {:.2} % of the maximum load",
        100.0 * residual.unwrap_or_default()
    )
}

fn answer(found: &MeasuredLoop, written: Option<&Path>) -> Value {
    let of = &found.evaluated;
    let mut answer = json!({
        "file": written.map(|path| path.display().to_string()),
        "source": found.source,
        "source_blake3": found.digest,
        "columns_read": found.curve.columns,
        "point_count": of.load_n.len(),
        "approach_count": of.turn + 1,
        "signs": found.oriented.signs,
        "baseline": found.options.baseline.word(),
        "baseline_counts": of.baseline_counts,
        "fit": found.fit(),
        "warnings": found.warnings(),
    });
    for (name, estimate) in found.estimates() {
        answer[name] = json!(estimate.map(|of| of.value));
        answer[format!("{name}_ci95_low")] = json!(estimate.map(|of| of.value - half_width(&of)));
        answer[format!("{name}_ci95_high")] = json!(estimate.map(|of| of.value + half_width(&of)));
    }
    for (name, number) in found.numbers() {
        answer[name] = json!(number);
    }
    answer
}
