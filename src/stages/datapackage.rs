//! `datapackage.json`: what tables a run has and what their columns mean, as the Data Package standard (version 2) has it.

use crate::campaign::{Campaign, CycleUnit};
use crate::schema::{Column, Kind, TABLES, Table};
use serde_json::{Value, json};

/// The description of the tables of a campaign; of the cycles only of those that are done.
pub(super) fn text(campaign: &Campaign, done: &[bool]) -> String {
    let of_method = |by_elements: bool| {
        let is = |unit: &CycleUnit| campaign.cases[unit.case].case.params.by_elements() == by_elements;
        let finished = campaign.cycles.iter().zip(done).filter(|(unit, done)| **done && is(unit));
        let mut ids: Vec<&str> = finished.map(|(unit, _)| unit.id.as_str()).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    };
    let (asperities, elements) = (of_method(false), of_method(true));
    let mut cycles = [asperities.as_slice(), elements.as_slice()].concat();
    cycles.sort_unstable();
    let surfaces: Vec<&str> = campaign.surfaces.iter().map(|unit| unit.id.as_str()).collect();
    let mut resources: Vec<Value> = TABLES
        .iter()
        // What stands in no folder of a run is no part of one.
        .filter(|table| table.file.contains('/'))
        .filter_map(|table| {
            let ids = match table.file.split('/').next() {
                // Tables of one method only.
                Some("cycles") if matches!(table.name, "turning" | "merged") => &asperities,
                Some("cycles") if table.name == "adhesionless" => &elements,
                Some("cycles") => &cycles,
                Some("asperities") => &surfaces,
                _ => return Some(resource(table, json!(table.file))),
            };
            let paths: Vec<String> = ids.iter().map(|id| table.file.replace("<id>", id)).collect();
            (!paths.is_empty()).then(|| resource(table, json!(paths)))
        })
        .collect();
    resources.push(json!({
        "name": "surfaces",
        "path": surfaces.iter().map(|id| format!("surfaces/{id}.h5")).collect::<Vec<_>>(),
        "format": "hdf5",
        "mediatype": "application/x-hdf5",
        "description": "Height fields: the dataset /height_m (f64, N x N, rows along x) with its coordinates /x_m and /y_m; parameters of the surface as attributes.",
    }));
    if !elements.is_empty() {
        resources.push(json!({
            "name": "maps",
            "path": elements.iter().map(|id| format!("cycles/{id}/maps.h5")).collect::<Vec<_>>(),
            "format": "hdf5",
            "mediatype": "application/x-hdf5",
            "description": "Maps of boundary elements: a group for each load reversal and maximum tensile load, with the datasets gap_m and pressure_pa (f32, rows along x), and step, branch, max_load, approach_m and load_n as attributes; contact_gap_m of the file is the gap below which a bonded point is in contact.",
        }));
    }
    let package = json!({
        "$schema": "https://datapackage.org/profiles/2.0/datapackage.json",
        "name": campaign.spec.name.to_lowercase(),
        "description": "Adhesive hysteresis of rough surfaces: loading and unloading of self-affine surfaces with interacting JKR asperities. \
                        The spec is campaign.toml; what made each file is in receipts/.",
        "resources": resources,
    });
    format!("{package:#}\n")
}

fn resource(table: &Table, path: Value) -> Value {
    let fields: Vec<Value> = table.columns.iter().map(field).collect();
    json!({
        "name": table.name,
        "path": path,
        "format": "parquet",
        "mediatype": "application/vnd.apache.parquet",
        "description": table.doc,
        "schema": { "fields": fields, "missingValues": [] },
    })
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
