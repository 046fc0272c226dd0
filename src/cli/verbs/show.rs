//! `show`: one case or task with its parameters, results, warnings and files. `cite`: what a run cites.

use super::outputs::undamaged;
use super::place::{folder, open_dir};
use super::{Fault, failed, say};
use crate::campaign::{
    Campaign, CaseUnit, CycleUnit, REPORT_PAGE, STATISTICS, Stage, Standing, SurfaceUnit, Unit,
};
use crate::citation::bibtex;
use crate::cli::FolderArguments;
use crate::model::{GeneratedSurface, SurfaceSource};
use crate::schema::{self, Table};
use crate::spec::{CaseParams, GENERATED, MEASURED, NAMES, OF_ASPERITIES, REPLACED, WHERE_USED};
use crate::stages::cycle_results;
use crate::stats::{self, Given, grid_help, grid_percent, grid_verdict, significant, warnings_of};
use crate::store::{Check, ColumnData, Found, Frame, Kept, parquet, read_receipt};
use crate::text::{shell_path, shown, visible, wrapped};
use indicatif::HumanBytes;
use serde_json::{Map, Value, json};

/// Results in the printed text; JSON has all columns.
const RESULTS: [&str; 29] = [
    "max_load_n",
    "max_load_pa",
    "pull_off_load",
    "pull_off_load_n",
    "pull_off_pressure_pa",
    "area_at_max_load",
    "penetration_at_max_load",
    "contact_count_at_max_load",
    "touching_count_at_max_load",
    "summit_count",
    "loss",
    "loss_j",
    "loss_j_m2",
    "loss_over_adhesion",
    "work_closing_j_m2",
    "work_opening_j_m2",
    "work_approach_j_m2",
    "work_retraction_j_m2",
    "work_pull_off_j_m2",
    "work_loss_j_m2",
    "loss_dk_probe",
    "area_jkr_jump_in",
    "loss_ratio_dk",
    "audit_gap",
    "area_grid_error",
    "pull_off_grid_error",
    "loss_grid_error",
    "loading_grid_error",
    "unloading_grid_error",
];

/// A case or task.
#[derive(Default)]
struct Shown {
    kind: &'static str,
    state: String,
    parameters: Map<String, Value>,
    /// Sentences on the parameters.
    notes: Vec<String>,
    /// Rows of a table of statistics.
    results: Vec<Map<String, Value>>,
    /// Dissipated energy with its errors, of each of these rows that has them.
    verdicts: Vec<String>,
    warnings: Vec<String>,
    tasks: Vec<(String, String)>,
    files: Vec<Kept>,
}

pub(super) fn show(asked: &FolderArguments, id: &str) -> Result<u8, Fault> {
    let dir = folder(asked)?;
    let campaign = open_dir("show a task of", &dir)?;
    let Some(found) = find(&campaign, id)? else {
        let (dir, listed) = (shown(&dir), shell_path(&dir));
        return Err(failed(format!(
            "{dir} has no case or task {}\nhelp: `hysteron status {listed} --json` lists tasks, \
             statistics/cases.parquet lists cases",
            visible(id)
        )));
    };
    say(&if asked.json { format!("{:#}\n", answer(id, &found)) } else { described(id, &found) })?;
    Ok(0)
}

pub(super) fn cite(asked: &FolderArguments) -> Result<u8, Fault> {
    let campaign = open_dir("cite", &folder(asked)?)?;
    let bibtex = bibtex(campaign.case_counts());
    say(&if asked.json { format!("{:#}\n", json!({ "bibtex": bibtex })) } else { format!("{bibtex}\n") })?;
    Ok(0)
}

fn find(campaign: &Campaign, id: &str) -> Result<Option<Shown>, Fault> {
    if let Some(case) = campaign.cases.iter().position(|case| case.id == id) {
        return of_case(campaign, case, &campaign.cases[case]).map(Some);
    }
    if let Some(unit) = campaign.cycles.iter().find(|unit| unit.id == id) {
        return of_cycle(campaign, unit).map(Some);
    }
    if let Some(unit) = campaign.surfaces.iter().find(|unit| unit.id == id) {
        return Ok(Some(of_surface(campaign, unit)));
    }
    let stage = match id {
        STATISTICS => Stage::Aggregate,
        REPORT_PAGE => Stage::Report,
        _ => return Ok(None),
    };
    let survey = campaign.survey(Check::Sizes);
    let standing = if stage == Stage::Aggregate { survey.statistics } else { survey.report };
    let unit = Unit { stage, id, key: "" };
    Ok(Some(Shown {
        kind: stage.word(),
        state: state(&standing),
        files: files(campaign, &unit),
        ..Shown::default()
    }))
}

fn of_case(campaign: &Campaign, place: usize, case: &CaseUnit) -> Result<Shown, Fault> {
    let cycles = campaign.cycles.iter().filter(|cycle| cycle.case == place);
    let tasks: Vec<(String, String)> = cycles
        .map(|cycle| (cycle.id.clone(), state(&campaign.cycle_standing(cycle, Check::Sizes))))
        .collect();
    let done = tasks.iter().filter(|(_, state)| state == Standing::Done.word()).count();
    let done = format!("{done} of {} cycles done", tasks.len());
    if case.case.is_coarser_grid() {
        return of_coarser_grid(campaign, case, &done, tasks);
    }
    let mut found = Shown::default();
    if let Some(frame) = table(campaign, &schema::CASES)? {
        let rows = rows(&frame, "case_id", &case.id)?;
        found.results = rows.iter().map(|row| values(&frame, *row)).collect();
        for row in &rows {
            found.verdicts.extend(grid_verdict(&frame, *row).map_err(failed)?);
        }
        let help = grid_help(&frame, &rows).map_err(failed)?;
        found.verdicts.extend(help.map(|help| format!("help: {help}")));
        let warnings = warnings_of(&frame, &rows).map_err(failed)?;
        found.warnings = warnings
            .iter()
            .map(|warning| format!("{}: {}. {}", warning.kind.label, warning.measured, warning.kind.action))
            .collect();
    }
    Ok(Shown {
        kind: "case",
        state: format!("{done}; in sweep {}", case.case.sweeps.join(", ")),
        parameters: parameters(&case.case.params),
        notes: notes(&case.case.params),
        tasks,
        ..found
    })
}

/// A coarser grid of a case, with its means and their errors.
fn of_coarser_grid(
    campaign: &Campaign,
    unit: &CaseUnit,
    done: &str,
    tasks: Vec<(String, String)>,
) -> Result<Shown, Fault> {
    let family = unit.case.params.on_any_grid();
    let is_finer = |other: &&CaseUnit| other.case.params.on_any_grid() == family;
    let finest: Vec<&str> = campaign.shown_cases().filter(is_finer).map(|other| other.id.as_str()).collect();
    let mut results = Vec::new();
    if let Some(frame) = table(campaign, &schema::GRIDS)? {
        let cases = frame.text("case_id").map_err(failed)?;
        let rows = rows(&frame, "grid_case_id", &unit.id)?;
        let of_first = rows.iter().filter(|row| Some(&cases[**row]) == finest.first());
        results = of_first.map(|row| values(&frame, *row)).collect();
    }
    Ok(Shown {
        kind: unit.case.kind_of_grid(),
        state: format!("{done}; for the grid error of case {}", finest.join(", ")),
        parameters: parameters(&unit.case.params),
        notes: notes(&unit.case.params),
        results,
        tasks,
        ..Shown::default()
    })
}

fn of_cycle(campaign: &Campaign, unit: &CycleUnit) -> Result<Shown, Fault> {
    let standing = campaign.cycle_standing(unit, Check::Sizes);
    let (case, surface) = (&campaign.cases[unit.case], &campaign.surfaces[unit.surface]);
    let mut results = Vec::new();
    if let Some(frame) = table(campaign, &schema::REALIZATIONS)? {
        // Cases that differ only in estimates share a cycle.
        let cases = frame.text("case_id").map_err(failed)?;
        let own = rows(&frame, "cycle_id", &unit.id)?.into_iter().filter(|row| cases[*row] == case.id);
        results = own.map(|row| values(&frame, row)).collect();
    }
    if campaign.is_coarser_grid(unit) && standing == Standing::Done {
        let of_loads = cycle_results(campaign, unit).map_err(failed)?;
        results = of_loads.into_iter().map(|(max_load, of)| given(max_load, of)).collect();
    }
    let of = if campaign.is_coarser_grid(unit) { case.case.kind_of_grid() } else { "case" };
    Ok(Shown {
        kind: Stage::Cycle.word(),
        state: format!("{}; {of} {}, surface {}", state(&standing), case.id, surface.id),
        parameters: parameters(&case.case.params),
        notes: notes(&case.case.params),
        results,
        files: files(campaign, &unit.cycle()),
        ..Shown::default()
    })
}

fn of_surface(campaign: &Campaign, unit: &SurfaceUnit) -> Shown {
    let word = |unit: &Unit<'_>| state(&campaign.standing(unit, Check::Sizes));
    let mut parameters = Map::new();
    let of_surface = CaseParams { surface: unit.params.clone(), ..CaseParams::default() };
    flatten("surface", &json!(of_surface)["surface"], &mut parameters);
    keep_own(&unit.params, &mut parameters);
    parameters.insert("realization".to_owned(), unit.realization.into());
    Shown {
        kind: "surface",
        state: format!("generate {}, extract {}", word(&unit.surface()), word(&unit.asperities())),
        parameters,
        files: [files(campaign, &unit.surface()), files(campaign, &unit.asperities())].concat(),
        ..Shown::default()
    }
}

/// The state of a task, with the reason if there is one.
fn state(standing: &Standing) -> String {
    let why = standing.why().map(|why| format!(": {}", why.lines().next().unwrap_or_default()));
    format!("{}{}", standing.word(), why.unwrap_or_default())
}

/// The files of a finished task.
fn files(campaign: &Campaign, unit: &Unit<'_>) -> Vec<Kept> {
    match read_receipt(&campaign.receipt_path(unit)) {
        Found::Whole(receipt) => receipt.files,
        _ => Vec::new(),
    }
}

/// The parameters of a case as keys of a spec, without keys that its method does not read.
fn parameters(params: &CaseParams) -> Map<String, Value> {
    let mut all = Map::new();
    if let Value::Object(tables) = json!(params) {
        tables.iter().for_each(|(table, values)| flatten(table, values, &mut all));
    }
    keep_own(&params.surface, &mut all);
    let is_by_elements = params.elements().is_some();
    all.retain(|key, _| match key.split_once('.') {
        Some(("model", name)) => !(is_by_elements && OF_ASPERITIES.contains(&name)),
        Some(("boundary_elements", _)) => is_by_elements,
        _ => true,
    });
    all
}

/// Boundary condition of boundary elements, which read no `model.boundary`.
fn notes(params: &CaseParams) -> Vec<String> {
    if params.elements().is_none() {
        return Vec::new();
    }
    let others = OF_ASPERITIES.map(|name| format!("model.{name}")).join(", ");
    let boundary = match (params.surface.is_periodic(), params.probe) {
        (true, _) => "The surface is continued periodically.",
        (false, None) => "The scan is not periodic: its mirror images continue it to a periodic surface.",
        (false, Some(_)) => "The scan is not periodic, and on a probe it is not mirrored.",
    };
    vec![format!("Not read by boundary elements: {others}."), boundary.to_owned()]
}

/// Removes the keys of a measured surface from those of a generated one, and the other way round. Keys that
/// are
/// used by few surfaces remain where they are not at their default.
fn keep_own(surface: &SurfaceSource, all: &mut Map<String, Value>) {
    let others: &[&str] = surface.generated().map_or(&GENERATED, |_| &MEASURED);
    let is_tabulated = surface.generated().is_some_and(GeneratedSurface::is_tabulated);
    let default = json!(CaseParams::default());
    all.retain(|key, value| {
        let Some(name) = key.strip_prefix("surface.") else { return true };
        let is_optional = WHERE_USED.contains(&name) || NAMES.contains(&name);
        let is_unused = is_optional && default["surface"][name] == *value;
        // The rms height of a table is that of its band.
        let is_replaced = is_tabulated && name != "rms_height_m" && REPLACED.contains(&name);
        !(others.contains(&name) || is_unused || is_replaced)
    });
}

fn flatten(table: &str, values: &Value, all: &mut Map<String, Value>) {
    for (name, value) in values.as_object().into_iter().flatten() {
        all.insert(format!("{table}.{name}"), value.clone());
    }
}

/// A table of statistics, if it is written yet.
fn table(campaign: &Campaign, table: &'static Table) -> Result<Option<Frame>, Fault> {
    let path = campaign.dir.join(table.file);
    if !path.is_file() {
        return Ok(None);
    }
    undamaged("show results of", &campaign.dir, table.file)?;
    parquet::read_table(&path, table).map(Some).map_err(failed)
}

/// The rows with an id.
fn rows(frame: &Frame, column: &str, id: &str) -> Result<Vec<usize>, Fault> {
    let ids = frame.text(column).map_err(failed)?;
    Ok((0..ids.len()).filter(|row| ids[*row] == id).collect())
}

fn values(frame: &Frame, row: usize) -> Map<String, Value> {
    let value = |data: &ColumnData| match data {
        ColumnData::F64(values) => json!(values[row]),
        ColumnData::I64(values) => json!(values[row]),
        ColumnData::Bool(values) => json!(values[row]),
        ColumnData::Text(values) => json!(values[row]),
    };
    frame.columns().map(|(column, data)| (column.name.to_owned(), value(data))).collect()
}

/// Results of a cycle as a row.
fn given(max_load: f64, columns: Given) -> Map<String, Value> {
    let value = |value: stats::Value| match value {
        stats::Value::Real(number) => json!(number),
        stats::Value::Whole(number) => json!(number),
        stats::Value::Word(word) => json!(word),
        stats::Value::Missing => Value::Null,
    };
    let columns = columns.into_iter().map(|(name, of)| (name, value(of)));
    std::iter::once(("max_load".to_owned(), json!(max_load))).chain(columns).collect()
}

fn answer(id: &str, found: &Shown) -> Value {
    let tasks: Vec<_> = found.tasks.iter().map(|(id, state)| json!({ "id": id, "state": state })).collect();
    let Shown { kind, state, parameters, notes, results, verdicts, warnings, files, .. } = found;
    json!({
        "id": id, "kind": kind, "state": state, "parameters": parameters, "notes": notes,
        "results": results, "verdicts": verdicts, "warnings": warnings, "tasks": tasks, "files": files,
    })
}

fn described(id: &str, found: &Shown) -> String {
    let mut text = wrapped(&format!("{} {id}: {}", found.kind, visible(&found.state)), "  ");
    let mut section = |heading: &str, lines: Vec<String>| {
        if !lines.is_empty() {
            text += &format!("\n{heading}\n");
            lines.iter().for_each(|line| text += &wrapped(&format!("  {line}"), "    "));
        }
    };
    section("Parameters", found.parameters.iter().map(|(key, value)| format!("{key} = {value}")).collect());
    section("Notes", found.notes.clone());
    for row in &found.results {
        let load = row.get("max_load").map(ToString::to_string).unwrap_or_default();
        section(
            &format!("Results at F_max/(E* A0) = {load}"),
            RESULTS.iter().filter_map(|name| result(row, name)).collect(),
        );
    }
    section("Verdict", found.verdicts.clone());
    section("Warnings", found.warnings.clone());
    section("Tasks", found.tasks.iter().map(|(id, state)| format!("{id}: {}", visible(state))).collect());
    section(
        "Files",
        found
            .files
            .iter()
            .map(|file| format!("{} ({})", visible(&file.path), HumanBytes(file.size_bytes)))
            .collect(),
    );
    text
}

/// A result, or its mean with its standard deviation, with its unit.
fn result(row: &Map<String, Value>, name: &str) -> Option<String> {
    let number = |name: &str| row.get(name).and_then(Value::as_f64).map(|number| significant(number, 4));
    if name.ends_with("_grid_error") {
        let error = row.get(name).and_then(Value::as_f64)?;
        return Some(format!("{name} = {}", grid_percent(error)));
    }
    let unit = schema::REALIZATIONS.column(name).map(|column| column.unit).filter(|unit| *unit != "1");
    let unit = unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    if let Some(own) = number(name) {
        return Some(format!("{name} = {own}{unit}"));
    }
    let mean = number(&format!("{name}_mean"))?;
    let sd = number(&format!("{name}_sd")).map(|sd| format!(" ± {sd}")).unwrap_or_default();
    let count = |name: &str| row.get(name).and_then(Value::as_i64);
    let fewer = count(&format!("{name}_count")).zip(count("done_count")).filter(|(own, done)| own < done);
    let fewer = fewer.map(|(own, done)| format!(" ({own} of {done} surfaces)")).unwrap_or_default();
    Some(format!("{name} = {mean}{sd}{unit}{fewer}"))
}
