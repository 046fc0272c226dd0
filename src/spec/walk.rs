//! From the text to a draft: every key looked up, every value checked by itself.

use std::collections::{BTreeMap, HashSet};
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::coarser::{self, Coarser};
use super::entries::{Entry, entries, keys, lost, shown};
use super::experiment::experiment;
use super::fault::Faults;
use super::figures::{Across, Figures, figures};
use super::files::files;
use super::keys::{KEYS, TABLES};
use super::origin::Origin;
use super::realizations::{DEFAULT, Realizations, realizations};
use super::sweep::{SweepDraft, sweeps};
use super::values::Values;
use super::{auto, sides, top, value};
use crate::model::{Experiment, Method};

/// A spec whose values are read and not yet combined.
pub(super) struct Draft {
    pub(super) name: Option<String>,
    pub(super) seed: u64,
    pub(super) realizations: Realizations,
    pub(super) figures: Figures,
    /// Sweeps that the figures name.
    pub(super) across: Across,
    pub(super) experiment: Option<Experiment>,
    pub(super) base: Values,
    /// Coarser grids of boundary elements of the base.
    pub(super) coarser: Vec<Coarser>,
    /// Origin of the base's value of each key, in the order of [`KEYS`].
    pub(super) origins: Vec<Origin>,
    /// The sweeps; nothing for one that has a fault, of which the cases are unknown.
    pub(super) sweeps: Vec<Option<SweepDraft>>,
    /// Place of the number of realizations in the text.
    pub(super) realizations_at: Option<Range<usize>>,
    /// BLAKE3 of the files that are named, and where it is written.
    pub(super) files: BTreeMap<String, (String, Range<usize>)>,
    /// Listed choices of `method = "auto"`, and where they are written.
    pub(super) auto_methods: Vec<Method>,
    pub(super) auto_at: Option<Range<usize>>,
    /// Listed sides of scans, and where they are written.
    pub(super) scan_sides_m: Vec<f64>,
    pub(super) sides_at: Option<Range<usize>>,
    /// True if the sides are those of the scans, read for this spec.
    pub(super) are_sides_read: bool,
}

/// Keys at the top of a spec.
const TOP: [&str; 17] = [
    "name",
    "seed",
    "realizations",
    "figures",
    "surface",
    "material",
    "model",
    "boundary_elements",
    "cycle",
    "probe",
    "machine",
    "substrate",
    "sweep",
    "files",
    "auto_methods",
    "scan_sides_m",
    "experiment",
];

/// Help for text that is no TOML.
pub(super) const TOML: &str = "each line is `key = value`, strings in quotes, lists in brackets, each key \
                               once; `hysteron init` prints a spec";

/// Reads a whole spec. Nothing, with the faults added, if it is no TOML.
pub(super) fn document(text: &str, faults: &mut Faults<'_>) -> Option<Draft> {
    let (root, broken) = DeTable::parse_recoverable(text);
    if !broken.is_empty() {
        let mut lines = HashSet::new();
        for error in broken {
            let span = error.span().unwrap_or(text.len()..text.len());
            let line = faults.line(&span);
            // A parser that recovers stumbles over the rest of the same line.
            if lines.insert(line) {
                let message = || format!("the spec is not valid TOML: {}", error.message());
                faults.add_with(&span, || (message(), Some(TOML.to_owned())));
            }
        }
        return None;
    }
    let mut draft = Draft {
        name: None,
        seed: top::DEFAULT_SEED,
        realizations: Realizations::Exactly(DEFAULT),
        figures: Figures::default(),
        across: Across::default(),
        realizations_at: None,
        experiment: None,
        base: Values::default(),
        coarser: Vec::new(),
        origins: vec![Origin::Default; KEYS.len()],
        sweeps: Vec::new(),
        files: BTreeMap::new(),
        auto_methods: Vec::new(),
        auto_at: None,
        scan_sides_m: Vec::new(),
        sides_at: None,
        are_sides_read: false,
    };
    let entries = entries(root.get_ref());
    if !entries.iter().any(|(key, ..)| *key == "name") {
        let what = if entries.is_empty() {
            "the spec is empty: it needs a `name`"
        } else {
            "the spec has no `name`"
        };
        faults.add(&(0..0), what.to_owned(), "add a first line such as name = \"first\"".to_owned());
    }
    for entry in entries {
        enter(entry, &mut draft, faults);
    }
    Some(draft)
}

/// Reads an entry of the top into a draft.
pub(super) fn enter((key, span, written): Entry<'_, '_>, draft: &mut Draft, faults: &mut Faults<'_>) {
    match key {
        "name" => draft.name = top::name("name", written, faults),
        "seed" => draft.seed = top::seed(written, faults).unwrap_or(draft.seed),
        "realizations" => {
            draft.realizations_at = Some(written.span());
            draft.realizations =
                realizations(written, draft.realizations, faults).unwrap_or(draft.realizations);
        }
        "figures" => {
            let before = (draft.figures.clone(), draft.across.clone());
            (draft.figures, draft.across) = figures(written, before, faults).unwrap_or_default();
        }
        "experiment" => draft.experiment = experiment(written, draft.experiment.take(), faults),
        "auto_methods" => {
            draft.auto_at = Some(written.span());
            draft.auto_methods = auto::methods(written, faults);
        }
        sides::KEY => {
            draft.sides_at = Some(written.span());
            draft.scan_sides_m = sides::sides(written, faults);
        }
        "files" => draft.files = files(written, &span, faults),
        "sweep" => sweeps(written, &span, &mut draft.sweeps, faults),
        table if TABLES.contains(&table) => base(table, written, &span, draft, faults),
        unknown => faults.add_with(&span, || {
            let help =
                lost(unknown, &TOP, |table| format!("`{unknown}` belongs in [{table}]"), "keys of a spec");
            (format!("unknown key `{}` at the top of the spec", shown(unknown)), Some(help))
        }),
    }
}

/// Reads a table of the base.
fn base(
    table: &str,
    written: &Spanned<DeValue<'_>>,
    span: &Range<usize>,
    draft: &mut Draft,
    faults: &mut Faults<'_>,
) {
    for (place, _, written) in keys(table, written, span, faults) {
        let key = &KEYS[place];
        let read = if coarser::LISTS.contains(&key.path) && written.get_ref().is_array() {
            let grids = coarser::grids(key, written, faults);
            grids.map(|(finest, coarser)| {
                draft.coarser = coarser;
                finest
            })
        } else if !key.kind.is_list() && written.get_ref().is_array() {
            let message = format!("`{}` must be a single value here, not an array", key.path);
            let help = match key.path {
                "surface.file" => "write surface.files for several scans of one sample, or use a [[sweep]]",
                path if coarser::FOR_ALL.contains(&path) => "write one number: it holds for all cases",
                _ => "move the array to a [[sweep]]",
            };
            faults.add(&written.span(), message, help.to_owned());
            None
        } else {
            value::read(key, written, faults)
        };
        draft.origins[place] = match read {
            Some(value) => {
                (key.set)(&mut draft.base, &value);
                Origin::Written(written.span())
            }
            None => Origin::Faulty,
        };
    }
}
