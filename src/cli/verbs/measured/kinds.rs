//! Options of `import` for the other kind of file: those of loops with scans, and those of scans with loops.

use super::super::{BAD_SPEC, Fault};
use crate::cli::ImportArguments;
use crate::text::shown;
use std::path::Path;

/// Names of options; true if the option is given.
type Given = [(&'static str, bool)];

/// Refuses options of measured loops with scans.
pub(super) fn no_options_of_loops(asked: &ImportArguments, file: &Path) -> Result<(), Fault> {
    let of = &asked.of_loop;
    let given = [
        ("--loop", of.is_loop),
        ("--force-column", of.force_column.is_some()),
        ("--force-unit", of.force_unit.is_some()),
        ("--displacement-column", of.displacement_column.is_some()),
        ("--displacement-unit", of.displacement_unit.is_some()),
        ("--radius-column", of.radius_column.is_some()),
        ("--radius-unit", of.radius_unit.is_some()),
        ("--compression", of.compression.is_some()),
        ("--baseline", of.baseline.is_some()),
        ("--probe-radius", of.probe_radius.is_some()),
        ("--modulus", of.modulus.is_some()),
        ("--machine-stiffness", of.machine_stiffness.is_some()),
    ];
    // An archive is read as scans whatever is given.
    let help = if of.is_loop || of.force_column.is_some() || of.displacement_column.is_some() {
        "leave them out; unpack an archive of loops and import its files"
    } else {
        "leave them out, or give --loop if the file has a force and a displacement"
    };
    none_of(&given, "scan", "measured loops", (file, help))
}

/// Refuses options of scans with measured loops.
pub(super) fn no_options_of_scans(asked: &ImportArguments, file: &Path) -> Result<(), Fault> {
    let given = [
        ("--dataset", asked.dataset.is_some()),
        ("--pixel-m", asked.pixel_m.is_some()),
        ("--size", asked.size.is_some()),
        ("--unit", asked.unit.is_some()),
        ("--skip-lines", asked.skip_lines.is_some()),
        ("--width", asked.width.is_some()),
        ("--transpose", asked.transpose),
        ("--fill", asked.fill),
        ("--detrend", asked.detrend.is_some()),
        ("--outliers", asked.outliers),
        ("--align-rows", asked.align_rows),
        ("--fast-axis", asked.fast_axis.is_some()),
        ("--tip-radius", asked.tip_radius.is_some()),
        ("--periodic", asked.periodic),
        ("--filter", asked.filter.is_some()),
        ("--points", asked.points.is_some()),
    ];
    let help = "leave them out; --force-unit and --displacement-unit are the units of a loop";
    none_of(&given, "measured loop", "scans", (file, help))
}

/// The error of a file of this kind with options of the other kind.
fn none_of(given: &Given, kind: &str, others: &str, (file, help): (&Path, &str)) -> Result<(), Fault> {
    let names: Vec<&str> = given.iter().filter(|(_, is_given)| *is_given).map(|(name, _)| *name).collect();
    if names.is_empty() {
        return Ok(());
    }
    let (file, names) = (shown(file), names.join(", "));
    let text = format!("error: cannot import {file} as a {kind}: options of {others}: {names}\nhelp: {help}");
    Err(Fault { code: BAD_SPEC, text })
}
