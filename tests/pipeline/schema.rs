//! The schemas: consistent in themselves, and the files made from them up to date.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use hysteron::schema::{
    ASPERITIES, AVALANCHES, CASES, CONTACTS, CURVES, CYCLES, DIRECTORY, EVENT_KINDS, EVENTS, Kind, PANELS, REALIZATIONS, STEPS, TABLES,
    Table, files, metadata_json, readme_markdown, schema_json,
};
use hysteron::spec::{SCHEMA_FILE, json_schema};

/// The unit that a column's name promises: suffixes from the longest, as the contract has them.
fn promised(name: &str) -> &'static str {
    let stem = ["_mean", "_sd", "_ci95_low", "_ci95_high"].iter().find_map(|end| name.strip_suffix(end)).unwrap_or(name);
    [("_j_m2", "J/m^2"), ("_1_m2", "1/m^2"), ("_1_m", "1/m"), ("_m2", "m^2"), ("_pa", "Pa"), ("_m", "m"), ("_n", "N"), ("_j", "J")]
        .iter()
        .find(|(end, _)| stem.ends_with(end))
        .map_or("1", |(_, unit)| unit)
}

#[test]
fn law_names_and_units_agree() {
    for table in TABLES {
        for column in table.columns {
            let place = format!("{}.{}", table.name, column.name);
            match column.kind {
                Kind::F64 => assert_eq!(column.unit, promised(column.name), "{place}"),
                Kind::I64 if column.name.contains("_count") => {
                    assert_eq!(column.unit, "1", "{place}");
                }
                Kind::I64 | Kind::Bool | Kind::Text => assert_eq!(column.unit, "", "{place}"),
            }
        }
    }
}

#[test]
fn law_names_are_unique_plain_words_and_documented() {
    let names: BTreeSet<_> = TABLES.iter().map(|table| table.name).collect();
    assert_eq!(names.len(), TABLES.len());
    for table in TABLES {
        assert!(table.version >= 1 && table.doc.ends_with('.'), "{}", table.name);
        let mut seen = BTreeSet::new();
        for column in table.columns {
            let place = format!("{}.{}", table.name, column.name);
            assert!(seen.insert(column.name), "{place} is there twice");
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            assert!(!column.name.is_empty() && column.name.chars().all(plain), "{place}");
            assert!(column.doc.len() > 3 && !column.doc.ends_with('.'), "{place}: {}", column.doc);
            assert_eq!(table.column(column.name), Some(column));
        }
        assert_eq!(table.column("no such column"), None);
    }
}

/// The contract: these names stand in published files and are never changed.
#[test]
fn val_columns_are_those_of_the_contract() {
    let contract: [(_, &str); 8] = [
        (
            &ASPERITIES,
            "surface_id realization asperity_id x_m y_m height_m radius_m curvature_1_m curvature_min_1_m curvature_max_1_m grid_row grid_col refined",
        ),
        (
            &STEPS,
            "cycle_id case_id realization step branch max_load approach_m load_n least_load_n area_m2 area_union_m2 contact_count covered_count jump_in_count jump_off_count cover_count uncover_count snap_count merge_count split_count held_count touching_count dissipated_j work_j residual_m drift_m stability converged iteration_count pair_evaluation_count product_count transform_count load area penetration",
        ),
        (
            &CONTACTS,
            "cycle_id case_id realization step branch max_load asperity_id state contact_radius_m load_n penetration_m interaction_m",
        ),
        (
            &EVENTS,
            "cycle_id case_id realization step branch max_load kind asperity_id approach_m avalanche_id load_before_n load_after_n area_before_m2 area_after_m2 energy_lost_j",
        ),
        (
            &REALIZATIONS,
            "cycle_id surface_id asperities_id case_id sweep hurst magnification length_m rms_height_m points_per_shortest_wavelength normalization amplitudes contact_modulus_pa work_of_adhesion_j_m2 interaction_range_m interaction boundary coalescence jump_in as_printed approach_step realization max_load pull_off_load pull_off_load_n area_at_max_load area_union_at_max_load penetration_at_max_load loss loss_j loss_dk loss_dk_realised loss_ratio_dk dissipated_j audit_gap summit_count summit_density_1_m2 nayak_density_1_m2 contact_count_at_max_load step_count unconverged_count held_count tabor_min tabor_median tabor_max rms_slope rms_curvature_1_m nayak_parameter touching_share covered_share touching_count_at_max_load covered_count_at_max_load absorption_share dissipated dissipated_loading dissipated_loading_j dissipated_unloading dissipated_unloading_j dissipated_jump_in dissipated_jump_off_j dissipated_split_j tabor_mean low_tabor_share conformity conformity_realised persson_tosatti persson_tosatti_realised",
        ),
        (
            &CASES,
            "case_id sweep hurst jump_in max_load pull_off_load_mean pull_off_load_sd pull_off_load_ci95_low pull_off_load_ci95_high area_at_max_load_mean penetration_at_max_load_sd loss_mean loss_dk_mean loss_dk_realised_ci95_low loss_ratio_dk_ci95_high planned_count done_count failed_count caution dissipated_mean dissipated_j_mean dissipated_loading_sd dissipated_unloading_j_ci95_low dissipated_merge_ci95_high audit_gap_mean audit_gap_max tabor_min_min tabor_mean_mean low_tabor_share_mean touching_share_mean touching_share_max covered_share_mean conformity_mean conformity_realised_min persson_tosatti_realised_mean contact_count_at_max_load_mean contact_count_at_max_load_min touching_count_at_max_load_mean summit_count_mean summit_count_min absorption_share_max",
        ),
        (
            &CURVES,
            "case_id sweep max_load branch grid_index station tension_fraction load area_mean area_sd penetration_mean penetration_sd realization_count",
        ),
        (
            &AVALANCHES,
            "cycle_id surface_id asperities_id case_id sweep realization branch max_load avalanche_id step approach_m event_count jump_in_count jump_off_count cover_count uncover_count snap_count merge_count split_count energy_lost_j energy_lost load_drop_n area_change_m2",
        ),
    ];
    let own = [
        (&PANELS, "sweep panel curve name of point x y y_sd x_label y_label"),
        (&CYCLES, "case_id sweep realization cycle_id surface_id asperities_id status failure"),
    ];
    for (table, names) in contract.into_iter().chain(own) {
        for name in names.split(' ') {
            assert!(table.column(name).is_some(), "{} lost its column {name}", table.name);
        }
    }
    // Seven results, nine numbers of theories, and what the events lost; its two branches and every kind of event; what tells how far to trust the row. The losses are
    // there in both units.
    assert_eq!(CASES.columns.len(), 2 + 26 + 1 + (12 + 6) * 4 + (2 + EVENT_KINDS.len()) * 2 * 4 + 17 * 2 + 7);
}

/// Columns by which tables are joined.
#[test]
fn law_every_table_names_what_its_rows_belong_to() {
    let has = |table: &Table, names: &[&str]| names.iter().for_each(|name| assert!(table.column(name).is_some(), "{}.{name}", table.name));
    for table in TABLES.iter().filter(|table| table.file.starts_with("cycles/")) {
        has(table, &["cycle_id", "case_id", "realization"]);
    }
    for table in [&REALIZATIONS, &AVALANCHES, &CYCLES] {
        has(table, &["cycle_id", "case_id", "realization", "surface_id", "asperities_id"]);
    }
    has(&ASPERITIES, &["surface_id", "realization", "asperity_id"]);
    // A cycle has the parameters of its case, under the same names and of the same kind.
    let parameters = REALIZATIONS.columns.iter().filter(|column| CASES.columns.contains(column) && column.name != "max_load");
    let mut count = 0;
    for column in parameters {
        assert_eq!(CYCLES.column(column.name), Some(column));
        count += 1;
    }
    assert_eq!(count, 2 + 26);
}

#[test]
fn law_every_kind_of_event_has_its_columns() {
    for kind in EVENT_KINDS {
        assert!(AVALANCHES.column(&format!("{kind}_count")).is_some(), "{kind}");
        for unit in ["", "_j"] {
            assert!(REALIZATIONS.column(&format!("dissipated_{kind}{unit}")).is_some(), "{kind}");
            assert!(CASES.column(&format!("dissipated_{kind}{unit}_mean")).is_some(), "{kind}");
        }
    }
}

#[test]
fn law_json_says_all_that_the_schema_says() {
    for table in TABLES {
        let text = schema_json(table);
        assert_eq!(text, schema_json(table));
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(json["table"], table.name);
        assert_eq!(json["version"], table.version);
        let columns = json["columns"].as_array().unwrap();
        assert_eq!(columns.len(), table.columns.len());
        for (found, column) in columns.iter().zip(table.columns) {
            assert_eq!(found["name"], column.name);
            assert_eq!(found["kind"], column.kind.word());
            assert_eq!(found["unit"], column.unit);
            assert_eq!(found["nullable"], column.nullable);
            assert_eq!(found["description"], column.doc);
            assert_eq!(found["source"], column.source);
        }
        let keys = BTreeMap::from([("key", "0a\"1"), ("program", "hysteron")]);
        let carried: serde_json::Value = serde_json::from_str(&metadata_json(table, &keys)).unwrap();
        assert_eq!(carried["columns"], json["columns"]);
        assert_eq!(carried["key"], "0a\"1");
    }
}

#[test]
fn law_markdown_has_a_row_for_every_column() {
    for table in TABLES {
        let page = readme_markdown(table);
        let rows: Vec<_> = page.lines().filter(|line| line.starts_with("| `")).collect();
        assert_eq!(rows.len(), table.columns.len());
        for (row, column) in rows.iter().zip(table.columns) {
            assert!(row.starts_with(&format!("| `{}` | ", column.name)));
            assert_eq!(row.replace("\\|", "").matches('|').count(), 7, "{row}");
        }
    }
}

#[test]
fn e2e_schema_files_are_up_to_date() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join(DIRECTORY);
    let mut expected: BTreeMap<_, _> = files().into_iter().map(|file| (file.name, file.content)).collect();
    expected.insert(SCHEMA_FILE.to_owned(), json_schema());
    let mut wrong = Vec::new();
    for (name, content) in &expected {
        if fs::read_to_string(directory.join(name)).ok().as_ref() != Some(content) {
            wrong.push(name.clone());
        }
    }
    for entry in fs::read_dir(&directory).into_iter().flatten() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        // Schemas of earlier versions stay, for the files that were written with them.
        let earlier = TABLES.iter().any(|table| (1..table.version).any(|version| name == format!("{}.v{version}.json", table.name)));
        if !expected.contains_key(&name) && !earlier {
            wrong.push(name);
        }
    }
    assert!(
        wrong.is_empty(),
        "schemas/ differs from src/schema/ in {}; to renew it: cargo run --release -- schema --write",
        wrong.join(", ")
    );
}
