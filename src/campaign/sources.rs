//! Files of measured surfaces: their labels in tables, and their names in the resolved spec of a run.
//!
//! Relative names in `campaign.toml` start at its folder, so that a project can be moved. Its provenance
//! record has the absolute paths, so that the run alone can be moved.

use super::Campaign;
use crate::model::SurfaceSource;
use crate::paths::{relative, whole};
use crate::spec::Spec;
use crate::store::{Found, read_receipt};
use crate::text::{shown, visible};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The member of the provenance record of a resolved spec that has the absolute paths of files by their names
/// in it.
const PLACES: &str = "files";

/// Scans of a case whose names its label lists.
const MOST_NAMED: usize = 3;

/// Labels of the files of a spec: the name, with as many of its folders as distinguish it from the other
/// files.
pub(super) fn labels(spec: &Spec) -> BTreeMap<String, String> {
    let parts = |name: &String| -> Vec<String> {
        let part = |part: std::path::Component<'_>| part.as_os_str().to_string_lossy().into_owned();
        whole(Path::new(name)).components().rev().map(part).collect()
    };
    let mut sorted: Vec<(Vec<String>, &String)> = spec.files.keys().map(|name| (parts(name), name)).collect();
    sorted.sort();
    // Of sorted names, read from their ends, a neighbour shares most with each.
    let shared = |a: &[String], b: &[String]| {
        if a == b { 0 } else { a.iter().zip(b).take_while(|(a, b)| a == b).count() }
    };
    let label = |place: usize| {
        let (own, name) = &sorted[place];
        let before = place.checked_sub(1).map_or(0, |before| shared(own, &sorted[before].0));
        let after = sorted.get(place + 1).map_or(0, |after| shared(own, &after.0));
        let kept = own.iter().take(before.max(after) + 1).rev().collect::<PathBuf>();
        ((*name).clone(), kept.to_string_lossy().into_owned())
    };
    (0..sorted.len()).map(label).collect()
}

impl Campaign {
    /// Label in tables of the files of a measured surface or of a tabulated spectrum; other surfaces have
    /// none. Of many scans the first, the last and their number are named.
    #[must_use]
    pub fn label_of(&self, surface: &SurfaceSource) -> Option<String> {
        let labels: Vec<String> = surface.files().iter().map(|file| self.file_label(file)).collect();
        match &labels[..] {
            [] => None,
            [first, _, _, .., last] if labels.len() > MOST_NAMED => {
                Some(format!("{first} … {last} ({} scans)", labels.len()))
            }
            few => Some(few.join(", ")),
        }
    }

    /// Label of a file of a measured surface or loop in tables.
    pub(crate) fn file_label(&self, file: &str) -> String {
        let name = || Path::new(file).file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.labels.get(file).cloned().unwrap_or_else(name)
    }

    /// A message with the label of a file in place of its path: the part that begins like an absolute path
    /// and ends with the name of the file.
    pub(super) fn with_label(&self, message: &str, surface: &SurfaceSource) -> String {
        let [file] = surface.files() else { return message.to_owned() };
        let Some(name) = Path::new(file).file_name().map(|name| visible(&name.to_string_lossy())) else {
            return message.to_owned();
        };
        let label = self.file_label(file);
        let plain = message.replace(&shown(&whole(Path::new(file))), &label);
        let found = plain
            .find(&format!("/{name}"))
            .and_then(|at| Some((plain[..at + 1].find(" /")? + 1, at + 1 + name.len())));
        found.map_or(plain.clone(), |(start, end)| format!("{}{label}{}", &plain[..start], &plain[end..]))
    }

    /// The resolved spec as text, as the report shows it: files have their labels, since their paths differ
    /// between machines.
    #[must_use]
    pub fn labelled_toml(&self) -> String {
        self.spec.with_file_names(&self.labels).to_toml()
    }

    /// Names of the files in `campaign.toml`: absolute if the spec has them so, or else from the output
    /// folder.
    fn resolved_names(&self) -> BTreeMap<String, String> {
        let relative = |name: &String| {
            let name = if self.spec.absolute_files.contains(name) {
                None
            } else {
                Some(relative(Path::new(name), &self.dir))
            };
            name.and_then(|path| path.to_str().map(str::to_owned))
        };
        self.spec.files.keys().filter_map(|name| Some((name.clone(), relative(name)?))).collect()
    }

    /// Text of `campaign.toml`.
    #[must_use]
    pub fn resolved_toml(&self) -> String {
        self.spec.with_file_names(&self.resolved_names()).to_toml()
    }

    /// Members of the provenance record of `campaign.toml`: the absolute paths of files with relative names,
    /// if there are any.
    #[must_use]
    pub fn resolved_record(&self) -> Map<String, Value> {
        let (names, known) = (self.resolved_names(), recorded(&self.dir));
        let place = |(found, name): (&String, &String)| {
            let lost = if Path::new(found).exists() { None } else { known.get(name).cloned() };
            (name.clone(), lost.unwrap_or_else(|| whole(Path::new(found))).to_string_lossy().into())
        };
        let places: Map<String, Value> = names.iter().map(place).collect();
        if places.is_empty() {
            Map::new()
        } else {
            Map::from_iter([(PLACES.to_owned(), Value::Object(places))])
        }
    }

    /// True if the provenance record of `campaign.toml` has the places of all files that are there.
    #[must_use]
    pub fn has_recorded_files(&self) -> bool {
        let known = recorded(&self.dir);
        self.resolved_names().iter().all(|(found, name)| {
            !Path::new(found).exists() || known.get(name) == Some(&whole(Path::new(found)))
        })
    }

    /// Absolute paths at which the file of a measured surface can be expected, the best one first.
    #[must_use]
    pub fn places_of(&self, file: &str) -> Vec<PathBuf> {
        let name = self.resolved_names().remove(file).unwrap_or_else(|| file.to_owned());
        let mut places = vec![whole(Path::new(file))];
        places.extend([self.dir.join(&name), PathBuf::from(&name)].map(|path| whole(&path)));
        places.extend(recorded(&self.dir).remove(&name));
        let mut seen = Vec::new();
        places.retain(|place| {
            !seen.contains(place) && {
                seen.push(place.clone());
                true
            }
        });
        places
    }
}

/// Absolute paths of files by their names in the `campaign.toml` of a folder, as its provenance record has
/// them.
fn recorded(dir: &Path) -> BTreeMap<String, PathBuf> {
    let Found::Whole(receipt) = read_receipt(&dir.join("receipts").join("campaign.json")) else {
        return BTreeMap::new();
    };
    let places = receipt.preimages.get(PLACES).and_then(Value::as_object).cloned().unwrap_or_default();
    places.into_iter().filter_map(|(name, place)| Some((name, PathBuf::from(place.as_str()?)))).collect()
}

/// The spec that was read from the `campaign.toml` of a folder. A file that is not where its relative name
/// leads has its recorded place, if it is there: the folder was moved.
#[must_use]
pub fn with_recorded_files(spec: Spec, dir: &Path) -> Spec {
    let lost: Vec<&String> = spec.files.keys().filter(|name| !Path::new(name).exists()).collect();
    if lost.is_empty() {
        return spec;
    }
    let places: BTreeMap<PathBuf, PathBuf> =
        recorded(dir).into_iter().map(|(name, place)| (whole(&dir.join(name)), place)).collect();
    let found = |name: &&String| {
        let place = places.get(&whole(Path::new(name))).filter(|place| place.exists())?;
        Some(((*name).clone(), place.to_str()?.to_owned()))
    };
    let names: BTreeMap<String, String> = lost.iter().filter_map(found).collect();
    spec.with_file_names(&names)
}
