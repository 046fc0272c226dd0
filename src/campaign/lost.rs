//! Files that no receipt names, and tasks whose receipt is lost.

use super::{Campaign, REPORT_PAGE, STATISTICS, Stage, Standing};
use crate::store::commit::is_temporary;
use crate::store::{Check, Receipt};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// The receipts of a folder, as an audit has found them.
#[derive(Default)]
pub(super) struct Sound {
    /// Files that receipts name, by their places below the output folder.
    named: HashSet<String>,
    /// Keys by place of the receipt; none of one that is damaged, which is a fault of its own.
    keys: HashMap<PathBuf, Option<String>>,
}

impl Sound {
    /// Enters what was found at a place; nothing where it cannot be read.
    pub(super) fn enter(&mut self, path: PathBuf, receipt: Option<Receipt>) {
        let key = receipt.map(|receipt| {
            self.named.extend(receipt.files.into_iter().map(|file| file.path));
            receipt.key
        });
        self.keys.insert(path, key);
    }
}

/// A stage and the id of one of its tasks.
type Owner<'a> = (Stage, &'a str);

impl Campaign {
    /// Tasks of the spec without a receipt, of which there are files or results built on them; and the other
    /// files that no receipt names.
    pub(super) fn lost(&self, sound: &Sound) -> (Vec<String>, Vec<String>) {
        let unnamed: Vec<String> =
            self.written().into_iter().filter(|file| !sound.named.contains(file)).collect();
        let mut finished: HashSet<Owner<'_>> = unnamed.iter().filter_map(|file| owner(file)).collect();
        let key =
            |(stage, id): Owner<'_>| sound.keys.get(&self.receipts_dir(stage).join(format!("{id}.json")));
        let is_there = |owner: Owner<'_>| matches!(key(owner), Some(Some(_)));
        self.built_on(&key, &mut finished);
        let surfaces = |stage: Stage| self.surfaces.iter().map(move |unit| (stage, unit.id.as_str()));
        let cycles =
            self.distinct().0.into_iter().map(|place| (Stage::Cycle, self.cycles[place].id.as_str()));
        let tasks = surfaces(Stage::Generate).chain(surfaces(Stage::Extract)).chain(cycles);
        let tasks = tasks.chain([(Stage::Aggregate, STATISTICS), (Stage::Report, REPORT_PAGE)]);
        let without: Vec<Owner<'_>> =
            tasks.filter(|task| finished.contains(task) && !is_there(*task)).collect();
        let known: HashSet<Owner<'_>> = without.iter().copied().collect();
        // A damaged receipt is a fault already.
        let lost = without
            .iter()
            .filter(|task| key(**task).is_none())
            .map(|(stage, id)| format!("{} {id}", stage.word()))
            .collect();
        let others = unnamed.iter().filter(|file| owner(file).is_none_or(|owner| !known.contains(&owner)));
        (lost, others.cloned().collect())
    }

    /// Adds the tasks on which something with a receipt was built.
    fn built_on<'a>(
        &'a self,
        key: &dyn Fn(Owner<'_>) -> Option<&'a Option<String>>,
        finished: &mut HashSet<Owner<'a>>,
    ) {
        let sound = |owner: Owner<'_>| key(owner).and_then(Option::as_ref);
        let standings = self.cycle_standings(Check::Sizes);
        // Cycles that have left nothing but the tables that were made of them.
        let all_done: Vec<Standing> = standings
            .iter()
            .map(|s| if *s == Standing::Planned { Standing::Done } else { s.clone() })
            .collect();
        let averaged =
            sound((Stage::Aggregate, STATISTICS)).is_some_and(|key| *key == self.statistics_key(&all_done));
        for (cycle, standing) in self.cycles.iter().zip(&standings) {
            let surface = self.surfaces[cycle.surface].id.as_str();
            if averaged && *standing == Standing::Planned {
                finished.insert((Stage::Cycle, &cycle.id));
            }
            if finished.contains(&(Stage::Cycle, cycle.id.as_str()))
                || sound((Stage::Cycle, &cycle.id)).is_some()
            {
                finished.extend([(Stage::Extract, surface), (Stage::Generate, surface)]);
            }
        }
        for surface in &self.surfaces {
            if finished.contains(&(Stage::Extract, surface.id.as_str()))
                || sound((Stage::Extract, &surface.id)).is_some()
            {
                finished.insert((Stage::Generate, &surface.id));
            }
        }
        if sound((Stage::Report, REPORT_PAGE)).is_some() {
            finished.insert((Stage::Aggregate, STATISTICS));
        }
    }

    /// The files in the folders that the program writes to, by their places below the output folder. Records
    /// of failures, checkpoints and files that are being written have no receipt.
    fn written(&self) -> Vec<String> {
        let mut folders = ["surfaces", "asperities", "estimates", "spectra", "statistics", "figures"]
            .map(|name| self.dir.join(name))
            .to_vec();
        folders.extend(entries(&self.dir.join("cycles")).into_iter().filter(|path| path.is_dir()));
        let mut files: Vec<PathBuf> =
            folders.iter().flat_map(|folder| entries(folder)).filter(|path| !path.is_dir()).collect();
        files.retain(|path| {
            !is_temporary(path)
                && path.file_name().is_none_or(|name| name != "failed.json" && name != "halfway.bin")
        });
        files.extend(
            ["campaign.toml", "datapackage.json", "report.html"]
                .map(|name| self.dir.join(name))
                .into_iter()
                .filter(|path| path.exists()),
        );
        let place = |path: PathBuf| {
            let parts = path.strip_prefix(&self.dir).unwrap_or(&path).components();
            parts.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect::<Vec<_>>().join("/")
        };
        files.into_iter().map(place).collect()
    }
}

/// The task that writes a file of this place.
pub(super) fn owner(file: &str) -> Option<Owner<'_>> {
    match file.split_once('/') {
        Some(("surfaces", name)) => Some((Stage::Generate, name.strip_suffix(".h5")?)),
        Some(("asperities" | "estimates" | "spectra", name)) => {
            Some((Stage::Extract, name.strip_suffix(".parquet")?))
        }
        Some(("cycles", rest)) => Some((Stage::Cycle, rest.split_once('/')?.0)),
        Some(("statistics", "panels.parquet")) | Some(("figures", _)) => Some((Stage::Report, REPORT_PAGE)),
        Some(("statistics" | "schemas", _)) => Some((Stage::Aggregate, STATISTICS)),
        Some(_) => None,
        None if file == "report.html" => Some((Stage::Report, REPORT_PAGE)),
        None => (file == "datapackage.json").then_some((Stage::Aggregate, STATISTICS)),
    }
}

/// Entries of a folder, by name; nothing if it cannot be read.
pub(super) fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .map(|all| all.flatten().map(|entry| entry.path()).collect())
        .unwrap_or_default();
    paths.sort();
    paths
}
