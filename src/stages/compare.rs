//! Comparison of finished runs, from their tables over realizations.

use super::StageError;
use super::done::Clock;
use super::report::pictures;
use crate::campaign::owned::{comparison_receipt, damage, run_around};
use crate::figures::{Panel, Tables, compared};
use crate::report::{Compared, comparison_page};
use crate::schema::{self, COMPARISON};
use crate::spec::Figures;
use crate::stats::{self, Group, Matched, Side, varying};
use crate::store::{Check, Found, Frame, commit, parquet, read_receipt};
use std::path::{Path, PathBuf};

/// Groups of cases up to which a comparison has its figures as PNG and PDF too.
const MOST_IN_ALL_FORMATS: usize = 4;

/// A written comparison.
#[derive(Debug)]
pub struct Comparison {
    /// The page.
    pub page: PathBuf,
    /// Its table.
    pub table: Frame,
    /// The cases that were compared, by the number of their group.
    pub names: Vec<String>,
}

/// Compares the campaigns in `folders` with the first one, and writes `comparison.parquet`,
/// `comparison.html` and `figures/` into `out`. A comparison of other campaigns in `out`, and files that no
/// comparison wrote, are replaced only if `force` is true.
///
/// # Errors
/// If a folder is given twice, lacks its tables over realizations or has damaged ones; if cases cannot be
/// distinguished; if no case is in all campaigns; if `out` is a run, or holds another comparison; if a file
/// cannot be written.
pub fn compare(folders: &[PathBuf], out: &Path, force: bool) -> Result<Comparison, StageError> {
    let clock = Clock::start();
    let same = |a: &PathBuf, b: &PathBuf| {
        a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
    };
    if let Some((_, twice)) = folders
        .iter()
        .enumerate()
        .find(|(place, folder)| folders[..*place].iter().any(|other| same(other, folder)))
    {
        return Err(StageError::ComparedTwice { path: twice.clone() });
    }
    if let Some(run) = run_around(out) {
        return Err(StageError::IntoRun { path: out.to_owned(), run });
    }
    let sides: Vec<Side> = labels(folders)
        .into_iter()
        .zip(folders)
        .map(|(label, folder)| side(label, folder))
        .collect::<Result<_, _>>()?;
    let file = out.join(COMPARISON.file);
    if !force && file.exists() && of_others(&file, &sides) {
        return Err(StageError::OtherComparison { path: out.to_owned() });
    }
    let matched = stats::matched(&sides)?;
    if matched.groups.is_empty() {
        let folders =
            folders.iter().map(|folder| folder.display().to_string()).collect::<Vec<_>>().join(", ");
        return Err(StageError::NothingInCommon { folders });
    }
    let table = stats::comparison(&sides, &matched)?;
    let names = names(&sides, &matched)?;
    let mut drawings: Vec<(String, Vec<Panel>)> = Vec::new();
    for (number, (group, name)) in matched.groups.iter().zip(&names).enumerate() {
        drawings.push((name.clone(), panels(&sides, group, &format!("compare{number}"))?));
    }
    let mut files = figures(&drawings, matched.groups.len())?;
    let page = comparison_page(&Compared {
        sides: &sides,
        matched: &matched,
        names: &names,
        drawings: &drawings,
        table: &table,
    })?;
    files.push((PAGE.to_owned(), page.into_bytes()));
    write(out, force, &files, &table, &clock)?;
    Ok(Comparison { page: out.join(PAGE), table, names })
}

/// Name of the page.
const PAGE: &str = "comparison.html";

/// The figures: places and contents.
fn figures(drawings: &[(String, Vec<Panel>)], groups: usize) -> Result<Vec<(String, Vec<u8>)>, StageError> {
    let formats = if groups > MOST_IN_ALL_FORMATS { vec!["svg"] } else { Figures::default().format };
    let wanted = Figures { format: formats, ..Figures::default() };
    let mut files = Vec::new();
    for panel in drawings.iter().flat_map(|(_, panels)| panels) {
        files.extend(pictures(&panel.stem, &panel.svg, &wanted)?);
    }
    Ok(files)
}

/// Writes the files of a comparison, its table and its receipt, and removes files of the comparison that was
/// there.
fn write(
    out: &Path,
    force: bool,
    files: &[(String, Vec<u8>)],
    table: &Frame,
    clock: &Clock,
) -> Result<(), StageError> {
    let earlier = match read_receipt(&comparison_receipt(out)) {
        Found::Whole(receipt) => receipt.files,
        _ => Vec::new(),
    };
    let is_own = |place: &str| {
        earlier.iter().any(|file| file.path == place && file.fault(out, Check::Contents).is_none())
    };
    // Comparisons of earlier versions have no receipt, but their table.
    let is_known = earlier.is_empty() && out.join(COMPARISON.file).is_file();
    let is_foreign = |place: &&str| !is_known && !is_own(place) && out.join(place).symlink_metadata().is_ok();
    let places = || files.iter().map(|(place, _)| place.as_str()).chain([COMPARISON.file]);
    if let Some(place) = places().find(is_foreign).filter(|_| !force) {
        return Err(StageError::ForeignComparison { path: out.join(place) });
    }
    for path in [out.to_owned(), out.join("figures")] {
        std::fs::create_dir_all(&path).map_err(|source| StageError::Folder { path, source })?;
    }
    for file in earlier.iter().filter(|file| is_own(&file.path) && !places().any(|place| place == file.path))
    {
        let _ = std::fs::remove_file(out.join(&file.path));
    }
    let mut written = vec![parquet::write_table(&out.join(COMPARISON.file), table, &[])?];
    for (place, bytes) in files {
        written.push(commit::commit_bytes("write the comparison", &out.join(place), bytes)?);
    }
    clock.comparison_receipt(out, written)
}

/// True if a table compares other campaigns than these, or cannot be read.
fn of_others(file: &Path, sides: &[Side]) -> bool {
    let Ok(table) = parquet::read_table(file, &COMPARISON) else { return true };
    let (Ok(references), Ok(campaigns)) = (table.text("reference"), table.text("campaign")) else {
        return true;
    };
    let Some((reference, others)) = sides.split_first() else { return true };
    references.iter().any(|label| *label != reference.label)
        || campaigns.iter().any(|label| others.iter().all(|side| side.label != *label))
        || others.iter().any(|side| campaigns.iter().all(|label| *label != side.label))
}

/// Labels of campaigns: the names of their folders, or their whole paths where two have one name.
fn labels(folders: &[PathBuf]) -> Vec<String> {
    let name = |folder: &PathBuf| {
        folder
            .file_name()
            .map_or_else(|| folder.display().to_string(), |name| name.to_string_lossy().into_owned())
    };
    let names: Vec<String> = folders.iter().map(name).collect();
    let alone = |name: &String| names.iter().filter(|other| *other == name).count() == 1;
    if names.iter().all(alone) {
        names
    } else {
        folders.iter().map(|folder| folder.display().to_string()).collect()
    }
}

fn side(label: String, folder: &Path) -> Result<Side, StageError> {
    let read = |table: &'static schema::Table| -> Result<Frame, StageError> {
        match damage(folder, table.file).filter(|_| folder.join(table.file).is_file()) {
            Some(why) => Err(StageError::Damaged { dir: folder.to_owned(), why }),
            None => Ok(parquet::read_table(&folder.join(table.file), table)?),
        }
    };
    Ok(Side {
        label,
        cases: read(&schema::CASES)?,
        realizations: read(&schema::REALIZATIONS)?,
        curves: read(&schema::CURVES)?,
    })
}

/// Names of the groups: parameters that differ between the cases of the first campaign, and the load.
fn names(sides: &[Side], matched: &Matched) -> Result<Vec<String>, StageError> {
    let Some(first) = sides.first() else { return Ok(Vec::new()) };
    let rows: Vec<usize> = matched.groups.iter().map(|group| group.rows[0]).collect();
    let differing = varying(&first.cases, &rows)?;
    let loads = first.cases.f64("max_load")?;
    let loads = stats::labels(&rows.iter().map(|row| loads[*row]).collect::<Vec<f64>>());
    let name = |place: usize| {
        let parts = differing.iter().map(|parameter| parameter.assigned(place));
        parts.chain([format!("F_max = {}", loads[place])]).collect::<Vec<_>>().join(", ")
    };
    Ok((0..rows.len()).map(name).collect())
}

/// The panels of one group, its campaigns over one another.
fn panels(sides: &[Side], group: &Group, stem: &str) -> Result<Vec<Panel>, StageError> {
    let (mut cases, mut curves, mut realizations) = (Vec::new(), Vec::new(), Vec::new());
    for (number, (side, row)) in sides.iter().zip(&group.rows).enumerate() {
        let id = side.cases.text("case_id")?[*row];
        // Two campaigns may have one case, and it is to have a path in each.
        let own = format!("{number}-{id}");
        let of_case = |frame: &Frame| -> Result<Vec<usize>, StageError> {
            let ids = frame.text("case_id")?;
            Ok((0..ids.len()).filter(|k| ids[*k] == id).collect())
        };
        cases.push((&side.cases, vec![*row], own.clone()));
        curves.push((&side.curves, of_case(&side.curves)?, own.clone()));
        realizations.push((&side.realizations, of_case(&side.realizations)?, own));
    }
    let labels: Vec<String> = sides.iter().map(|side| side.label.clone()).collect();
    let (cases, curves, realizations) =
        (stats::together(&cases)?, stats::together(&curves)?, stats::together(&realizations)?);
    let tables = Tables {
        cases: &cases,
        curves: &curves,
        realizations: &realizations,
        avalanches: None,
        all_loads: true,
    };
    Ok(compared(&tables, &labels, stem)?)
}
