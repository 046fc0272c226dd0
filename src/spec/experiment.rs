//! `[experiment]`: measured loops for comparison with the simulated ones.

use std::path::Path;

use toml::de::DeValue;

use super::entries::{entries, lost, shown};
use super::fault::Faults;
use super::keys::Limits;
use super::number::number;
use super::value::word;
use super::written::{Written, array, wrong_type};
use crate::model::{Baseline, Choice as _, Compression, Experiment, LoopOptions};
use crate::text::quoted;

/// Texts and lists of the table: key, type, meaning.
pub(super) const MEANINGS: [(&str, &str, &str); 7] = [
    (
        "loops",
        "array of strings",
        "Files of measured loops, from the working directory or the folder of the spec.",
    ),
    ("force", "string", "Column of the force. Left out, the heading of the file has it."),
    ("force_unit", "string", "Unit of the force, such as \"nN\". Left out, the heading has it."),
    ("displacement", "string", "Column of the displacement or penetration. Left out, the heading has it."),
    (
        "displacement_unit",
        "string",
        "Unit of the displacement, such as \"um\". Left out, the heading has it.",
    ),
    (
        "radius",
        "string",
        "Column of the contact radius or contact area. Left out, the heading has it, or there is none.",
    ),
    ("radius_unit", "string", "Unit of the contact radius or area, such as \"um\" or \"um2\"."),
];
/// Keys of the table.
pub(super) const KEYS: [&str; 12] = [
    "loops",
    "force",
    "force_unit",
    "displacement",
    "displacement_unit",
    "radius",
    "radius_unit",
    "compression",
    "baseline",
    "probe_radius_m",
    "contact_modulus_pa",
    "machine_stiffness_n_m",
];
/// Longest text \[bytes\].
pub(super) const LONGEST: usize = 4096;
/// Most loops.
pub(super) const MOST_LOOPS: usize = 100;

/// Bounds of the radius of the probe.
pub(super) const RADIUS: Limits = Limits {
    low: 1e-9,
    above: false,
    high: 10.0,
    unit: " m",
    unit_name: "metres",
    slip: Some((1e-6, "micrometres")),
    note: "R, radius of the spherical probe",
};
/// Bounds of the reduced modulus.
pub(super) const MODULUS: Limits = Limits {
    low: 1.0,
    above: false,
    high: 1e13,
    unit: " Pa",
    unit_name: "pascals",
    slip: Some((1e6, "megapascals")),
    note: "E*, reduced modulus; left out, that of `[material]`",
};
/// Bounds of the stiffness of the machine.
pub(super) const STIFFNESS: Limits = Limits {
    low: 1e-6,
    above: false,
    high: 1e12,
    unit: " N/m",
    unit_name: "newtons per metre",
    slip: None,
    note: "k, stiffness of the machine; left out, nothing is subtracted from the displacement",
};

/// Words of the table with their meanings.
pub(super) const WORDS: [(&str, super::keys::Words); 2] =
    [("compression", Compression::MEANINGS), ("baseline", Baseline::MEANINGS)];

/// The table of a spec. Keys that it lacks keep their values before.
pub(super) fn experiment(
    value: &Written<'_>,
    known: Option<Experiment>,
    faults: &mut Faults<'_>,
) -> Option<Experiment> {
    let DeValue::Table(table) = value.get_ref() else {
        let help = "write [experiment] on a line of its own, and loops = [\"loop.csv\"] below it".to_owned();
        wrong_type("experiment", "a table", value.get_ref(), &value.span(), help, faults);
        return None;
    };
    let before = faults.count();
    let mut read = known.unwrap_or_default();
    let options = &mut read.options;
    for (name, span, written) in entries(table) {
        let path = format!("experiment.{name}");
        match name {
            "loops" => read.loops = loops(written, faults).unwrap_or_default(),
            "force" => options.force = text(&path, written, faults),
            "force_unit" => options.force_unit = text(&path, written, faults),
            "displacement" => options.displacement = text(&path, written, faults),
            "displacement_unit" => options.displacement_unit = text(&path, written, faults),
            "radius" => options.radius = text(&path, written, faults),
            "radius_unit" => options.radius_unit = text(&path, written, faults),
            "compression" => {
                let found = word(&path, &listed(Compression::MEANINGS), written, faults);
                options.compression = found.and_then(Compression::from_word).unwrap_or(options.compression);
            }
            "baseline" => {
                let found = word(&path, &listed(Baseline::MEANINGS), written, faults);
                options.baseline = found.and_then(Baseline::from_word).unwrap_or(options.baseline);
            }
            "probe_radius_m" => options.probe_radius_m = number(&path, &RADIUS, written, faults),
            "contact_modulus_pa" => options.contact_modulus_pa = number(&path, &MODULUS, written, faults),
            "machine_stiffness_n_m" => {
                options.machine_stiffness_n_m = number(&path, &STIFFNESS, written, faults);
            }
            unknown => {
                let elsewhere = |other: &str| format!("`{unknown}` belongs in [{other}]");
                let help = lost(unknown, &KEYS, elsewhere, "keys of [experiment]");
                faults.add(&span, format!("unknown key `{}` in [experiment]", shown(unknown)), help);
            }
        }
    }
    if read.loops.is_empty() && faults.count() == before {
        let help = "add a line such as loops = [\"loop.csv\"], or remove [experiment]".to_owned();
        faults.add(&value.span(), "[experiment] names no file".to_owned(), help);
    }
    Some(read).filter(|_| faults.count() == before)
}

fn listed(meanings: &[(&'static str, &'static str)]) -> Vec<&'static str> {
    meanings.iter().map(|(word, _)| *word).collect()
}

/// Names of files, each once.
fn loops(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<Vec<String>> {
    let elements = array("experiment.loops", "strings", value, faults)?;
    let mut found: Vec<String> = Vec::new();
    for element in elements {
        let name = text("experiment.loops", element, faults);
        if name.is_empty() {
            continue;
        }
        if found.contains(&name) {
            let message = format!("\"{}\" is listed twice", shown(&name));
            faults.add(&element.span(), message, "name each loop once".to_owned());
        }
        found.push(name);
    }
    if found.len() > MOST_LOOPS {
        let message = format!("{} loops: at most {MOST_LOOPS} are allowed", found.len());
        faults.add(&value.span(), message, "name fewer files".to_owned());
    }
    Some(found)
}

/// A text without control characters that is not empty; else an empty one, with a fault.
fn text(path: &str, value: &Written<'_>, faults: &mut Faults<'_>) -> String {
    let span = value.span();
    match value.get_ref() {
        DeValue::String(found)
            if !found.is_empty() && found.len() <= LONGEST && !found.chars().any(char::is_control) =>
        {
            found.to_string()
        }
        DeValue::String(_) => {
            let message = format!("`{path}` cannot be {}", faults.written(&span));
            faults.add(&span, message, format!("write 1 to {LONGEST} bytes without control characters"));
            String::new()
        }
        other => {
            wrong_type(path, "a string", other, &span, "write it in quotes".to_owned(), faults);
            String::new()
        }
    }
}

/// The table as TOML.
pub(super) fn toml(of: &Experiment) -> String {
    let LoopOptions { force, force_unit, displacement, displacement_unit, radius, radius_unit, .. } =
        &of.options;
    let files: Vec<String> = of.loops.iter().map(|name| quoted(name)).collect();
    let mut text = format!("\n[experiment]\nloops = [{}]\n", files.join(", "));
    let texts = [
        ("force", force),
        ("force_unit", force_unit),
        ("displacement", displacement),
        ("displacement_unit", displacement_unit),
        ("radius", radius),
        ("radius_unit", radius_unit),
    ];
    for (name, value) in texts.into_iter().filter(|(_, value)| !value.is_empty()) {
        text += &format!("{name} = {}\n", quoted(value));
    }
    text += &format!("compression = \"{}\"\n", of.options.compression.word());
    text += &format!("baseline = \"{}\"\n", of.options.baseline.word());
    let numbers = [
        ("probe_radius_m", of.options.probe_radius_m),
        ("contact_modulus_pa", of.options.contact_modulus_pa),
        ("machine_stiffness_n_m", of.options.machine_stiffness_n_m),
    ];
    for (name, value) in numbers {
        if let Some(value) = value {
            text += &format!("{name} = {value:?}\n");
        }
    }
    text
}

/// Problem of a file of a loop, and help; nothing if it can be read and evaluated.
#[cfg(feature = "store")]
pub(super) fn fault(path: &Path, options: &LoopOptions) -> Option<(String, String)> {
    use crate::physics::theory::probe::measured_loop::{Measured, evaluate};
    use crate::physics::theory::probe::oriented;
    let read = crate::store::force_curve::read_force_curve(path, options);
    let found = read.and_then(|curve| {
        let oriented = oriented(&curve.displacement_m, &curve.force_n, options.compression)
            .map_err(|error| error.to_string())?;
        let measured = Measured {
            displacement_m: &oriented.displacement_m,
            load_n: &oriented.load_n,
            stiffness_n_m: options.machine_stiffness_n_m,
            baseline: options.baseline,
        };
        evaluate(&measured).map(drop).map_err(|error| error.to_string())
    });
    let why = found.err()?;
    let (problem, help) = why.split_once("\nhelp: ").unwrap_or((why.as_str(), ""));
    Some((problem.to_owned(), help.to_owned()))
}

/// Without the readers of files none is checked.
#[cfg(not(feature = "store"))]
pub(super) fn fault(_: &Path, _: &LoopOptions) -> Option<(String, String)> {
    None
}
