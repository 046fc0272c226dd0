//! README and guide: specs parse, commands exist, keys, columns and links are real, Python blocks run.

mod blocks;
mod limits;
mod outputs;
mod snippets;
mod warnings;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Parser;
use clap::error::ErrorKind;
use hysteron::campaign::Campaign;
use hysteron::cli::{Arguments, generated};
use hysteron::model::{ElementOptions, MeasuredSurface};
use hysteron::schema::TABLES;
use hysteron::spec::{GridGoal, OTHER_GRIDS, OTHER_LOADS, Spec, Values, reference};
use serde_json::{Value, json};

use crate::bench::{code, stderr, stdout};
use crate::spec::schema::{root, valid};
use blocks::{Page, pages};

/// Every key of the four tables of a spec, as `surface.hurst`.
fn keys() -> BTreeSet<String> {
    // With every table and key that a spec need not have.
    let values = Values {
        radius_m: Some(1.0),
        thickness_m: Some(1.0),
        stiffness_n_m: Some(1.0),
        max_force_n: vec![1.0],
        measured: MeasuredSurface { files: vec!["a".to_owned()], ..MeasuredSurface::default() },
        max_pressure_pa: vec![1.0],
        elements: ElementOptions { per_wavelength: Some(8), ..ElementOptions::default() },
        goal: GridGoal { error: Some(0.1), max_points: 64, shifted_copies: 1 },
        ..Values::default()
    };
    let tables = serde_json::to_value(values).unwrap();
    let keys = |(table, keys): (&String, &Value)| keys.as_object().unwrap().keys().map(|key| format!("{table}.{key}")).collect::<Vec<_>>();
    tables.as_object().unwrap().iter().flat_map(keys).collect()
}

#[test]
fn e2e_generated_files_are_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (path, content) in generated() {
        let found = std::fs::read_to_string(root.join(&path)).unwrap_or_default().replace("\r\n", "\n");
        assert!(found == content, "{} differs from its source; to renew it: cargo run -- schema --write", path.display());
        let is_page = path.starts_with("src/guide");
        for line in content.lines().filter(|_| is_page) {
            assert!(line.chars().count() <= 100, "{}: {line}", path.display());
        }
    }
}

#[test]
fn e2e_every_page_is_a_module_and_every_fence_has_a_language() {
    let modules = include_str!("../../src/guide.rs");
    for page in pages() {
        let stem = page.name.strip_suffix(".md").unwrap();
        let is_listed = modules.contains(&format!("    {stem},\n")) || stem == "index";
        assert!(is_listed || !page.is_of_guide(), "{} is not in src/guide.rs", page.name);
        for block in &page.blocks {
            // A fence without a language would be compiled as Rust.
            let known = ["sh", "toml", "python", "r", "sql", "text"];
            assert!(known.contains(&block.language.as_str()), "{}: a fence of the language `{}`", page.name, block.language);
        }
    }
}

/// A part of a spec as a spec: with a name, and with a lone key in its table.
fn completed(part: toml::Table, known: &Value) -> Value {
    let mut spec = json!({ "name": "part" });
    for (key, value) in part {
        let value = serde_json::to_value(value).unwrap();
        if known.get(&key).is_some() {
            spec[key] = value;
        } else {
            let table = keys().into_iter().find_map(|path| Some(path.strip_suffix(&format!(".{key}"))?.to_owned()));
            let table = table.unwrap_or_else(|| panic!("`{key}` is not a key of a spec"));
            spec[table] = json!({ key: value });
        }
    }
    spec
}

#[test]
fn e2e_specs_of_the_guide_are_read() {
    let root = root();
    let (mut specs, mut parts) = (0, 0);
    for page in pages() {
        for text in page.code("toml") {
            let table: toml::Table = text.parse().unwrap_or_else(|error| panic!("{}: {error}\n{text}", page.name));
            if table.contains_key("name") {
                specs += 1;
                Spec::parse(text, &page.name).unwrap_or_else(|errors| panic!("{errors}"));
            } else {
                parts += 1;
                let spec = completed(table, &root["properties"]);
                assert!(valid(&root, &spec, &root), "{}: these keys or values are not those of a spec:\n{text}", page.name);
            }
        }
    }
    assert!(specs >= 7 && parts >= 7, "{specs} specs, {parts} parts");
}

/// Fails unless the program accepts a command; `of_text` commands may leave arguments out.
fn is_accepted(words: &[String], of_text: bool, page: &Page) {
    let Err(error) = Arguments::try_parse_from(words) else { return };
    let kind = error.kind();
    let shown = matches!(kind, ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
    let part = [ErrorKind::MissingRequiredArgument, ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand].contains(&kind);
    assert!(shown || (of_text && part), "{}: {}: {error}", page.name, words.join(" "));
}

#[test]
fn e2e_commands_of_the_guide_are_accepted() {
    let mut count = 0;
    for page in pages() {
        for command in page.code("sh").flat_map(blocks::commands) {
            count += 1;
            is_accepted(&command, false, &page);
        }
        for span in page.spans.iter().filter(|span| span.starts_with("hysteron ")) {
            if let Some(command) = blocks::command_of_text(span) {
                count += 1;
                is_accepted(&command, true, &page);
            }
        }
    }
    assert!(count >= 40, "{count}");
}

#[test]
fn e2e_keys_of_the_guide_exist() {
    let known = keys();
    let mut count = 0;
    for page in pages() {
        for span in &page.spans {
            let path: String = span.chars().take_while(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || "._".contains(*c)).collect();
            let Some((table, name)) = path.split_once('.') else { continue };
            // `model.md` is a page.
            if ["surface", "material", "model", "boundary_elements", "cycle", "probe", "machine", "substrate"].contains(&table)
                && !["md", "rs", "h5"].contains(&name)
            {
                count += 1;
                assert!(known.contains(&path), "{}: `{span}` is not a key of a spec", page.name);
            }
        }
    }
    assert!(count >= 30, "{count}");
}

#[test]
fn e2e_columns_of_the_guide_exist() {
    let columns: BTreeSet<&str> = TABLES.iter().flat_map(|table| table.columns).map(|column| column.name).collect();
    let tables: BTreeSet<&str> = TABLES.iter().map(|table| table.name).collect();
    let known = keys();
    let is_key = |name: &str| known.iter().any(|path| path == name || path.ends_with(&format!(".{name}")));
    let ends = ["_m", "_n", "_pa", "_j", "_j_m2", "_1_m", "_m2", "_1_m2", "_count", "_mean", "_sd"];
    let mut count = 0;
    for page in pages() {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        let by_unit = page
            .spans
            .iter()
            .filter(|span| span.chars().all(plain) && !span.starts_with('_') && ends.iter().any(|end| span.ends_with(end)));
        for name in by_unit.chain(&page.columns) {
            count += 1;
            // A pattern stands for several columns, `/height_m` is a dataset, and `import --json` has keys of its own.
            let of_import = ["roll_off_m", "long_cut_m", "short_cut_m"].contains(&name.as_str());
            // A line of the resolved spec.
            let of_spec = name == "scan_sides_m";
            let exists = match name.split_once('*') {
                Some((before, after)) => columns.iter().any(|column| column.starts_with(before) && column.ends_with(after)),
                None => {
                    columns.contains(name.as_str())
                        || tables.contains(name.as_str())
                        || is_key(name)
                        || of_import
                        || of_spec
                        || name == "/height_m"
                }
            };
            assert!(exists, "{}: `{name}` is not a column", page.name);
        }
    }
    assert!(count >= 50, "{count}");
}

#[test]
fn law_the_stage_of_a_key_reads_it() {
    let spec = |text: &str| Spec::parse(text, "x.toml").unwrap_or_else(|errors| panic!("{errors}"));
    let digest = "0".repeat(64);
    let corrected = "surface.outliers = true\nsurface.align_rows = true\nsurface.tip_radius_m = 1e-8";
    let measured =
        format!("name = \"x\"\nsurface.file = \"a.h5\"\n{corrected}\nmodel.boundary = \"isolated\"\nfiles = {{ \"a.h5\" = \"{digest}\" }}");
    let elements = "name = \"x\"\nsurface.magnification = 8\nmodel.method = \"boundary_elements\"\nboundary_elements.law = \"corrected\"";
    let shape =
        "name = \"x\"\nsurface.longest_wavelength_m = 5e-4\nsurface.roll_off_m = 1e-4\nsurface.aspect_ratio = 2\nsurface.angle_deg = 30";
    let sphere = "name = \"x\"\nprobe.radius_m = 1e-3\nmachine.stiffness_n_m = 10\nsubstrate.thickness_m = 1e-3\nmodel.method = \"boundary_elements\"\nsurface.magnification = 8\ncycle.max_load = [1e-4]";
    let table = format!("name = \"x\"\nsurface.spectrum = \"a.csv\"\nfiles = {{ \"a.csv\" = \"{digest}\" }}");
    let campaigns = ["name = \"x\"", &measured, elements, shape, &table, sphere].map(|text| Campaign::new(spec(text), PathBuf::from("x")));
    let preimages = campaigns.map(|campaign| campaign.cycle_preimages(&campaign.cycles[0]));
    let page = reference();
    for path in keys() {
        let row = page.lines().find(|line| line.starts_with(&format!("| `{path}` |"))).unwrap();
        let stage = row.trim_end_matches(" |").rsplit(" | ").next().unwrap();
        // Of a file, its content is read.
        let pointer = if ["surface.file", "surface.files", "surface.spectrum"].contains(&path.as_str()) {
            "/reads/surface/blake3".to_owned()
        } else if OTHER_GRIDS.contains(&path.trim_start_matches("boundary_elements.")) {
            "/reads/boundary_elements/points".to_owned()
        } else if OTHER_LOADS.contains(&path.trim_start_matches("cycle.")) {
            "/reads/cycle/max_load".to_owned()
        } else {
            format!("/reads/{}", path.replace('.', "/"))
        };
        assert!(preimages.iter().any(|stages| stages[stage].pointer(&pointer).is_some()), "{path} is not read by {stage}");
    }
}

#[test]
fn e2e_schema_prints_one_file_and_writes_schemas_only() {
    let folder = tempfile::TempDir::new().unwrap();
    let schema = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_hysteron")).arg("schema").args(arguments).current_dir(folder.path()).output().unwrap()
    };
    for (path, content) in generated() {
        let name = path.file_name().unwrap().to_str().unwrap();
        assert_eq!(stdout(&schema(&[name])), content, "{name}");
    }
    let unknown = schema(&["spec.json"]);
    assert_eq!(code(&unknown), 1);
    assert!(stderr(&unknown).starts_with("error: unknown file spec.json\nhelp: one of asperities.v1.json, "), "{}", stderr(&unknown));
    assert_eq!(code(&schema(&["--write"])), 0);
    assert!(folder.path().join("schemas/spec.v1.json").is_file() && !folder.path().join("src").exists());
    // The standard output is a sequence of JSON values, the last one the schema of specs.
    let all = stdout(&schema(&[]));
    let values: Vec<Value> = serde_json::Deserializer::from_str(&all).into_iter().map(Result::unwrap).collect();
    assert_eq!(values.len(), TABLES.len() + 1);
    assert_eq!(values.last(), Some(&root()));
}

#[test]
fn e2e_source_modules_of_the_guide_exist() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut count = 0;
    for page in pages() {
        for span in page.spans.iter().filter(|span| span.starts_with("physics::")) {
            let module = source.join(span.replace("::", "/"));
            assert!(module.is_dir() || module.with_extension("rs").is_file(), "{}: there is no module {span}", page.name);
            count += 1;
        }
    }
    assert!(count >= 10, "{count}");
}

/// The pages as the build script hands them to rustdoc.
#[test]
fn e2e_links_between_modules_lead_to_modules() {
    let folder = Path::new(env!("OUT_DIR")).join("guide");
    let modules = include_str!("../../src/guide.rs");
    let mut count = 0;
    for page in pages().iter().filter(|page| page.is_of_guide()) {
        let above = if page.name == "index.md" { "" } else { "../" };
        for link in Page::read(&folder.join(&page.name)).links.iter().filter(|link| !link.contains("://")) {
            let file = link.split('#').next().unwrap();
            let module = file.strip_prefix(above).and_then(|rest| rest.strip_suffix("index.html"));
            let is_module =
                module.is_some_and(|name| name.is_empty() || modules.contains(&format!("    {},\n", name.trim_end_matches('/'))));
            assert!(is_module || file.is_empty(), "{}: {link}", page.name);
            count += 1;
        }
    }
    assert!(count >= 60, "{count}");
}

#[test]
fn e2e_links_of_the_guide_lead_somewhere() {
    let mut count = 0;
    for page in pages() {
        for link in page.links.iter().filter(|link| !link.contains("://")) {
            count += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.path.clone() } else { page.path.with_file_name(file) };
            assert!(target.exists(), "{}: {link}: there is no such file", page.name);
            if !anchor.is_empty() {
                let headings = Page::read(&target).headings;
                assert!(headings.iter().any(|heading| heading == anchor), "{}: {link}: no such heading among {headings:?}", page.name);
            }
        }
    }
    assert!(count >= 80, "{count}");
}
