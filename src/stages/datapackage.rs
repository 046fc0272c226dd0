//! `datapackage.json`: what tables a run has and what their columns mean, as the Data Package standard
//! (version 2) has it.
//!
//! Each file is a resource of its own: readers of a resource of several Parquet files read the first one.
//! Files of one kind share a schema in `schemas/`, which their resources name.

use crate::campaign::Campaign;
use crate::schema::{Column, Kind, TABLES, Table};
use serde_json::{Value, json};

/// Files that describe the tables of a run: places below its folder, and contents.
pub(super) type Described = Vec<(String, String)>;

/// The schemas of the tables of which a run has several files, and `datapackage.json`, which describes the
/// tables of all finished cycles.
pub(super) fn files(campaign: &Campaign, done: &[bool]) -> Described {
    let ids = Ids::of(campaign, done);
    let mut files = Described::new();
    let mut resources: Vec<Value> = Vec::new();
    // A table that is in no folder of a run is no part of one.
    let surfaces = || campaign.cases.iter().map(|unit| &unit.case.params.surface);
    let has_lists = surfaces().any(|of| of.measured().is_some_and(|scan| !scan.files.is_empty()));
    let is_written = |table: &Table| match table.name {
        "measured_loops" | "measured_steps" => campaign.spec.experiment.is_some(),
        "scans" | "scan_spectra" | "spectrum" => has_lists,
        _ => true,
    };
    for table in TABLES.iter().filter(|table| table.file.contains('/') && is_written(table)) {
        let Some(parts) = ids.of_table(table) else {
            resources.push(resource(table, table.name.to_owned(), table.file.to_owned(), schema(table)));
            continue;
        };
        let place = format!("schemas/{}.json", table.name);
        let part = |id: &&str| {
            let file = table.file.replace("<id>", id);
            // Some tables are of one method only.
            let is_there = campaign.dir.join(&file).is_file();
            is_there.then(|| resource(table, part_name(table.name, id), file, json!(place)))
        };
        let before = resources.len();
        resources.extend(parts.iter().filter_map(part));
        if resources.len() > before {
            files.push((place.clone(), format!("{:#}\n", schema(table))));
        }
    }
    let there = |kind: &str, id: &str, file: String, description: &str| {
        campaign.dir.join(&file).is_file().then(|| hdf5(kind, id, file, description))
    };
    let surface = |id: &&str| there("surfaces", id, format!("surfaces/{id}.h5"), SURFACE);
    resources.extend(ids.surfaces.iter().filter_map(surface));
    let maps = |id: &&str| there("maps", id, format!("cycles/{id}/maps.h5"), MAPS);
    resources.extend(ids.cycles.iter().filter_map(maps));
    let package = json!({
        "generator": "hysteron",
        "$schema": "https://datapackage.org/profiles/2.0/datapackage.json",
        "name": campaign.spec.name.to_lowercase(),
        "description": "Adhesive hysteresis of rough surfaces: loading and unloading of self-affine surfaces \
                        with interacting JKR asperities. The spec is campaign.toml; what made each file is \
                        in receipts/.",
        "resources": resources,
    });
    files.push(("datapackage.json".to_owned(), format!("{package:#}\n")));
    files
}

const SURFACE: &str = "Height field: the dataset /height_m (f64, N x N, rows along x) with its coordinates \
                       /x_m and /y_m; parameters of the surface as attributes.";
const MAPS: &str = "Maps of boundary elements: a group for each load reversal, maximum tensile load and some \
                    steps between them, with the datasets gap_m and pressure_pa (f32, rows along x), and \
                    step, branch, max_load, approach_m and load_n as attributes; contact_gap_m of the file \
                    is the gap below which a bonded point is in contact.";

/// Ids of the surfaces and of the finished cycles.
struct Ids<'a> {
    surfaces: Vec<&'a str>,
    cycles: Vec<&'a str>,
}

impl<'a> Ids<'a> {
    fn of(campaign: &'a Campaign, done: &[bool]) -> Self {
        let finished = campaign.cycles.iter().zip(done).filter(|(_, done)| **done);
        let mut cycles: Vec<&str> = finished.map(|(unit, _)| unit.id.as_str()).collect();
        cycles.sort_unstable();
        cycles.dedup();
        Self { surfaces: campaign.surfaces.iter().map(|unit| unit.id.as_str()).collect(), cycles }
    }

    /// Ids of the files of a table; nothing for a table of statistics, which is one file.
    fn of_table(&self, table: &Table) -> Option<&[&'a str]> {
        match table.file.split('/').next() {
            Some("cycles") => Some(&self.cycles),
            Some("asperities" | "estimates" | "spectra") => Some(&self.surfaces),
            _ => None,
        }
    }
}

/// Name of the resource of one file: lower case, as the standard recommends.
fn part_name(kind: &str, id: &str) -> String {
    format!("{kind}-{id}").to_lowercase()
}

fn hdf5(kind: &str, id: &str, path: String, description: &str) -> Value {
    json!({
        "name": part_name(kind, id),
        "path": path,
        "format": "hdf5",
        "mediatype": "application/x-hdf5",
        "description": description,
    })
}

fn resource(table: &Table, name: String, path: String, schema: Value) -> Value {
    json!({
        "name": name,
        "path": path,
        "format": "parquet",
        "mediatype": "application/vnd.apache.parquet",
        "description": table.doc,
        "schema": schema,
    })
}

fn schema(table: &Table) -> Value {
    let fields: Vec<Value> = table.columns.iter().map(field).collect();
    json!({ "generator": "hysteron", "fields": fields, "missingValues": [] })
}

fn field(column: &Column) -> Value {
    let kind = match column.kind {
        Kind::F64 => "number",
        Kind::I64 => "integer",
        Kind::Bool => "boolean",
        Kind::Text => "string",
    };
    let mut field = json!({
        "name": column.name,
        "type": kind,
        "description": column.doc,
        "constraints": { "required": !column.nullable },
    });
    // Parquet stores nulls as such; frictionless reads them as "nan" from columns of numbers.
    if column.nullable && column.kind != Kind::Text {
        field["missingValues"] = json!(["nan"]);
    }
    // The standard has no place of its own for units and sources, and lets publishers add some.
    for (name, value) in [("unit", column.unit), ("source", column.source)] {
        if !value.is_empty() {
            field[name] = json!(value);
        }
    }
    field
}
