//! Comparison of finished runs, from their tables over realizations.

use super::StageError;
use super::report::write_picture;
use crate::figures::{Panel, Tables, compared};
use crate::report::{Compared, comparison_page};
use crate::schema::{self, COMPARISON};
use crate::spec::Figures;
use crate::stats::{self, Group, Matched, Side, varying};
use crate::store::{Frame, commit, parquet};
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

/// Compares the campaigns in `folders` with the first one, and writes `comparison.parquet`, `comparison.html` and `figures/` into `out`. A comparison of
/// other campaigns in `out` is replaced only if `force` is true.
///
/// # Errors
/// If a folder is given twice or lacks its tables over realizations; if cases cannot be told apart; if no case is in all campaigns; if `out` holds another
/// comparison; a file that cannot be written.
pub fn compare(folders: &[PathBuf], out: &Path, force: bool) -> Result<Comparison, StageError> {
    let same = |a: &PathBuf, b: &PathBuf| a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
    if let Some((_, twice)) = folders.iter().enumerate().find(|(place, folder)| folders[..*place].iter().any(|other| same(other, folder))) {
        return Err(StageError::ComparedTwice { path: twice.clone() });
    }
    let sides: Vec<Side> = labels(folders).into_iter().zip(folders).map(|(label, folder)| side(label, folder)).collect::<Result<_, _>>()?;
    let file = out.join(COMPARISON.file);
    if !force && file.exists() && of_others(&file, &sides) {
        return Err(StageError::OtherComparison { path: out.to_owned() });
    }
    let matched = stats::matched(&sides)?;
    if matched.groups.is_empty() {
        let folders = folders.iter().map(|folder| folder.display().to_string()).collect::<Vec<_>>().join(", ");
        return Err(StageError::NothingInCommon { folders });
    }
    let table = stats::comparison(&sides, &matched)?;
    for path in [out.to_owned(), out.join("figures")] {
        std::fs::create_dir_all(&path).map_err(|source| StageError::Folder { path, source })?;
    }
    remove_figures(&out.join("figures"));
    let names = names(&sides, &matched)?;
    let mut drawings: Vec<(String, Vec<Panel>)> = Vec::new();
    for (number, (group, name)) in matched.groups.iter().zip(&names).enumerate() {
        drawings.push((name.clone(), panels(&sides, group, &format!("compare{number}"))?));
    }
    for panel in drawings.iter().flat_map(|(_, panels)| panels) {
        if matched.groups.len() > MOST_IN_ALL_FORMATS {
            let path = out.join("figures").join(format!("{}.svg", panel.stem));
            commit::commit_bytes("write a figure", &path, panel.svg.as_bytes())?;
        } else {
            write_picture(out, &panel.stem, &panel.svg, &Figures::default())?;
        }
    }
    parquet::write_table(&file, &table, &[])?;
    let path = out.join("comparison.html");
    let page = comparison_page(&Compared { sides: &sides, matched: &matched, names: &names, drawings: &drawings, table: &table })?;
    commit::commit_bytes("write the comparison", &path, page.as_bytes())?;
    Ok(Comparison { page: path, table, names })
}

/// True if a table compares other campaigns than these, or cannot be read.
fn of_others(file: &Path, sides: &[Side]) -> bool {
    let Ok(table) = parquet::read_table(file, &COMPARISON) else { return true };
    let (Ok(references), Ok(campaigns)) = (table.text("reference"), table.text("campaign")) else { return true };
    let Some((reference, others)) = sides.split_first() else { return true };
    references.iter().any(|label| *label != reference.label)
        || campaigns.iter().any(|label| others.iter().all(|side| side.label != *label))
        || others.iter().any(|side| campaigns.iter().all(|label| *label != side.label))
}

/// Removes the figures of an earlier comparison, of which there may have been more.
fn remove_figures(folder: &Path) {
    let is_figure = |name: &str| {
        name.strip_prefix("compare").is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
            && [".svg", ".png", ".pdf"].iter().any(|ending| name.ends_with(ending))
    };
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if is_figure(&entry.file_name().to_string_lossy()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Labels of campaigns: the names of their folders, or their whole paths where two have one name.
fn labels(folders: &[PathBuf]) -> Vec<String> {
    let name =
        |folder: &PathBuf| folder.file_name().map_or_else(|| folder.display().to_string(), |name| name.to_string_lossy().into_owned());
    let names: Vec<String> = folders.iter().map(name).collect();
    let alone = |name: &String| names.iter().filter(|other| *other == name).count() == 1;
    if names.iter().all(alone) { names } else { folders.iter().map(|folder| folder.display().to_string()).collect() }
}

fn side(label: String, folder: &Path) -> Result<Side, StageError> {
    let read = |table: &'static schema::Table| parquet::read_table(&folder.join(table.file), table);
    Ok(Side { label, cases: read(&schema::CASES)?, realizations: read(&schema::REALIZATIONS)?, curves: read(&schema::CURVES)? })
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
    let (cases, curves, realizations) = (stats::together(&cases)?, stats::together(&curves)?, stats::together(&realizations)?);
    Ok(compared(&Tables { cases: &cases, curves: &curves, realizations: &realizations }, &labels, stem)?)
}
