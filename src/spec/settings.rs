//! `--set KEY=VALUE`: values of the command line that replace values of a spec.

use std::ops::Range;

use toml::de::DeTable;

use super::entries::entries;
use super::fault::{Faults, OPTION, in_setting};
use super::keys::{TABLES, find};
use super::origin::Origin;
use super::realizations::{DEFAULT, Realizations};
use super::sweep::SweepDraft;
use super::walk::{Draft, TOML, enter};
use super::{SpecErrors, coarser};
use crate::text::quoted;

/// Settings that name files.
const NAME_FILES: [&str; 5] =
    ["surface.file", "surface.files", "surface.spectrum", "experiment", "experiment.loops"];

/// Puts the settings into a draft, in their order, and gives them as TOML.
pub(super) fn apply(settings: &[String], draft: &mut Draft) -> Result<Vec<String>, SpecErrors> {
    for (number, setting) in settings.iter().enumerate() {
        let text = document(setting)?;
        let mut faults = Faults::new(&text, OPTION);
        set(number, &text, draft, &mut faults);
        faults.finish(Some(()))?;
    }
    Ok(documents(settings))
}

/// Settings as TOML.
pub(super) fn documents(settings: &[String]) -> Vec<String> {
    settings.iter().map(|setting| document(setting).unwrap_or_else(|_| setting.clone())).collect()
}

/// A setting as TOML. A value that is not TOML is a text without its quotes.
fn document(setting: &str) -> Result<String, SpecErrors> {
    let refused = |problem: &str| {
        let mut faults = Faults::new(setting, OPTION);
        faults.add(
            &(0..setting.len()),
            problem.to_owned(),
            "write --set KEY=VALUE, e.g. --set surface.hurst=0.7".to_owned(),
        );
        faults.finish::<String>(None)
    };
    let Some((key, value)) = setting.split_once('=').map(|(key, value)| (key.trim(), value.trim())) else {
        return refused("a setting has no `=`");
    };
    if setting.chars().any(char::is_control) {
        return refused("a setting has a control character");
    }
    let is_key = |text: &str| {
        !text.is_empty()
            && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-' || c == '.')
    };
    if !is_key(key) {
        return refused("a setting has no key");
    }
    let plain = format!("{key} = {value}");
    let is_toml = DeTable::parse(&plain).is_ok();
    Ok(if is_toml { plain } else { format!("{key} = {}", quoted(value)) })
}

/// Puts one setting into a draft, by its number.
fn set(number: usize, text: &str, draft: &mut Draft, faults: &mut Faults<'_>) {
    let (root, broken) = DeTable::parse_recoverable(text);
    if let Some(error) = broken.first() {
        faults.add(
            &error.span().unwrap_or(0..text.len()),
            format!("the setting is not valid TOML: {}", error.message()),
            TOML.to_owned(),
        );
        return;
    }
    let path = text.split(" = ").next().unwrap_or_default();
    let place = path.split_once('.').and_then(|(table, name)| find(table, name));
    if let Some(place) = place.filter(|_| coarser::CHOICES.contains(&path)) {
        // A setting replaces lists and other choices of the grid.
        draft.coarser.clear();
        coarser::clear_others(place, &coarser::CHOICES, &mut draft.base, &mut draft.origins);
    }
    // A setting of a whole table replaces it, and one of a key in it that key alone.
    match path {
        "figures" => (draft.figures, draft.across) = Default::default(),
        "realizations" => draft.realizations = Realizations::Exactly(DEFAULT),
        "experiment" => draft.experiment = None,
        _ => {}
    }
    for (key, span, written) in entries(root.get_ref()) {
        if matches!(key, "sweep" | "files" | "auto_methods" | "scan_sides_m")
            || TABLES.contains(&key) && !path.contains('.')
        {
            let help =
                "it takes name, seed, realizations, and keys of tables such as surface.hurst".to_owned();
            faults.add(&span, format!("{OPTION} cannot set `{key}`"), help);
            return;
        }
        if let Some(table) = TABLES.iter().find(|table| !path.contains('.') && find(table, key).is_some()) {
            faults.add(
                &span,
                format!("{OPTION} needs the table of `{key}`"),
                format!("write {OPTION} {table}.{key}=VALUE"),
            );
            return;
        }
        enter((key, span, written), draft, faults);
    }
    move_places(number, path, draft);
    // The hashes are of the files that the spec names.
    if NAME_FILES.contains(&path) {
        draft.files.clear();
    }
    let Some(place) = place else { return };
    // Other values may lead to another choice.
    draft.auto_methods.clear();
    if path.starts_with("surface.") || path.starts_with("cycle.") {
        draft.scan_sides_m.clear();
    }
    let has_axis = |sweep: &Option<SweepDraft>| {
        sweep.as_ref().is_some_and(|sweep| sweep.axes.iter().any(|axis| axis.key == place))
    };
    if !draft.sweeps.is_empty() && draft.sweeps.iter().all(has_axis) {
        let at: Range<usize> = 0..path.len();
        faults.add(
            &at,
            format!("every sweep of the spec sets `{path}`: {OPTION} has no effect"),
            "change the sweeps of the spec".to_owned(),
        );
    }
}

/// Places of what a setting has written: they are in the setting, and not in the spec.
fn move_places(number: usize, path: &str, draft: &mut Draft) {
    let moved = |at: &mut Range<usize>| *at = in_setting(number, at);
    if path == "realizations" || path.starts_with("realizations.") {
        draft.realizations_at.iter_mut().for_each(moved);
    }
    if ["figures", "figures.across"].contains(&path) {
        draft.across.places().for_each(moved);
    }
    if coarser::LISTS.contains(&path) {
        draft.coarser.iter_mut().map(|(_, at)| at).for_each(moved);
    }
    if let Some(Origin::Written(at)) = coarser::place(path).map(|place| &mut draft.origins[place]) {
        moved(at);
    }
}
