//! Layout of the source: imports go in one direction, and no modules import each other in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Folders and files of `src/physics`, and of the folders of both methods, each with what it may import besides itself. Of several rows of a module the last
/// holds.
///
/// `model`, `constants`, `error`, `event_kind`, `loop_position` and `memory` are free for all.
const PHYSICS: [(&str, &[&str]); 23] = [
    ("math", &[]),
    ("jkr", &[]),
    ("surface", &[]),
    ("theory", &["math", "jkr", "surface"]),
    ("cycle", &[]),
    ("asperities", &["math", "jkr", "surface", "cycle"]),
    ("asperities::numerics", &[]),
    ("asperities::constants", &["asperities::numerics"]),
    ("asperities::field", &["math", "cycle"]),
    ("asperities::contact", &["math", "jkr", "surface", "cycle", "asperities::numerics", "asperities::field"]),
    ("asperities::solve", &["math", "jkr", "cycle", "asperities::numerics", "asperities::field", "asperities::contact"]),
    (
        "asperities::path",
        &["math", "jkr", "cycle", "asperities::numerics", "asperities::field", "asperities::contact", "asperities::solve"],
    ),
    ("elements", &["surface", "theory", "cycle"]),
    ("elements::numerics", &[]),
    ("elements::grid", &[]),
    ("elements::law", &[]),
    ("elements::line", &["elements::grid", "elements::law"]),
    ("elements::problem", &["elements::numerics", "elements::grid", "elements::law", "elements::line"]),
    ("elements::equilibrium", &["elements::numerics", "elements::grid", "elements::law", "elements::line", "elements::problem"]),
    ("elements::events", &["elements::grid", "elements::problem"]),
    ("elements::path", &["cycle", "elements::grid", "elements::problem", "elements::equilibrium", "elements::events"]),
    ("elements::units", &[]),
    ("elements::options", &["elements::numerics", "elements::law"]),
];

/// Modules of `src/physics` that every other one may import.
const FREE: [&str; 6] = ["model", "constants", "error", "event_kind", "loop_position", "memory"];

type Graph = BTreeMap<Vec<String>, BTreeSet<Vec<String>>>;

/// Every module below a folder of sources, with its text without comments.
fn modules(folder: &Path, prefix: &[String], found: &mut Vec<(Vec<String>, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let mut module = prefix.to_vec();
        if path.is_dir() {
            // The Python package and the guide are not modules of the library.
            if !["python", "guide"].contains(&name.as_str()) {
                module.push(name);
                modules(&path, &module, found);
            }
        } else if path.extension().is_some_and(|e| e == "rs") && !["lib", "main", "build"].contains(&name.as_str()) {
            if name != "mod" {
                module.push(name);
            }
            let text = fs::read_to_string(&path).unwrap();
            let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap()).collect();
            found.push((module, code.join("\n")));
        }
    }
}

/// Paths of an item of a `use` declaration, braces expanded.
fn expand(item: &str, prefix: &str, paths: &mut Vec<String>) {
    let Some(open) = item.find('{') else {
        paths.push(format!("{prefix}{item}"));
        return;
    };
    let inner = &item[open + 1..item.rfind('}').unwrap_or(item.len())];
    let prefix = format!("{prefix}{}", &item[..open]);
    let (mut depth, mut start) = (0, 0);
    for (at, c) in inner.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                expand(&inner[start..at], &prefix, paths);
                start = at + 1;
            }
            _ => {}
        }
    }
    expand(&inner[start..], &prefix, paths);
}

/// Paths that begin with `crate`, `super` or `self`, in declarations and in expressions.
fn paths_in(code: &str) -> Vec<String> {
    let mut paths = Vec::new();
    for declaration in code.split(';') {
        let starts =
            |line: &str| ["use ", "pub use ", "pub(crate) use ", "pub(super) use "].into_iter().find(|start| line.starts_with(start));
        let lines: Vec<&str> = declaration.lines().map(str::trim).collect();
        let Some((at, start)) = lines.iter().enumerate().rev().find_map(|(at, line)| Some((at, starts(line)?))) else { continue };
        let item: String = lines[at..].concat()[start.len()..].chars().filter(|c| !c.is_whitespace()).collect();
        // A line of a message that begins with "use " is no declaration.
        if item.chars().all(|c| c.is_alphanumeric() || "_:{},*".contains(c)) {
            expand(&item, "", &mut paths);
        }
    }
    let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    paths.extend(code.split(|c| !is_path(c)).filter(|word| word.contains("::")).map(str::to_owned));
    paths.retain(|path| ["crate::", "super::", "self::"].iter().any(|start| path.starts_with(start)));
    paths
}

/// The module that a path in a module names, as far as it is known.
fn target(module: &[String], path: &str, known: &BTreeSet<Vec<String>>) -> Option<Vec<String>> {
    let mut full = module.to_vec();
    for word in path.split("::") {
        match word {
            // The physics is a crate of its own.
            "crate" => full.truncate(usize::from(module[0] == "physics")),
            "super" => drop(full.pop()),
            "self" => {}
            other => full.push(other.to_owned()),
        }
    }
    while !full.is_empty() && !known.contains(&full) {
        full.pop();
    }
    (!full.is_empty() && full != module).then_some(full)
}

fn imports() -> Graph {
    let mut found = Vec::new();
    modules(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &[], &mut found);
    let known: BTreeSet<Vec<String>> = found.iter().map(|(module, _)| module.clone()).collect();
    let of = |(module, code): (Vec<String>, String)| {
        let targets = paths_in(&code).iter().filter_map(|path| target(&module, path, &known)).collect();
        (module, targets)
    };
    found.into_iter().map(of).collect()
}

/// Modules that are left when those without imports among the rest are taken away, again and again: those in a circle, and what imports them.
fn in_circles(mut graph: Graph) -> Graph {
    loop {
        let left: BTreeSet<Vec<String>> = graph.keys().cloned().collect();
        graph.values_mut().for_each(|targets| targets.retain(|target| left.contains(target)));
        let imported: BTreeSet<Vec<String>> = graph.values().flatten().cloned().collect();
        let before = graph.len();
        graph.retain(|module, targets| !targets.is_empty() && imported.contains(module));
        if graph.len() == before {
            return graph;
        }
    }
}

#[test]
fn law_no_modules_import_each_other_in_a_circle() {
    let graph = imports();
    assert!(graph.len() > 100 && graph.values().map(BTreeSet::len).sum::<usize>() > 300, "too few imports found, the reader is wrong");
    let circles = in_circles(graph);
    assert!(circles.is_empty(), "modules in a circle of imports: {circles:#?}");
}

#[test]
fn law_imports_of_the_physics_go_in_one_direction() {
    let is_below = |module: &str, folder: &str| module.strip_prefix(folder).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"));
    let mut wrong = Vec::new();
    for (module, targets) in imports().iter().filter(|(module, _)| module.len() > 1 && module[0] == "physics") {
        let module = module[1..].join("::");
        let row = PHYSICS.iter().rev().find(|(folder, _)| is_below(&module, folder));
        for target in targets {
            let place = target[1..].join("::");
            let is_free = target[0] == "physics" && (place.is_empty() || FREE.contains(&place.as_str()));
            let is_allowed = |(folder, allowed): &(&str, &[&str])| allowed.iter().chain([folder]).any(|folder| is_below(&place, folder));
            let is_below_it = target[0] == "physics" && row.is_some_and(is_allowed);
            if !is_free && !is_below_it {
                wrong.push(format!("{module} imports {}", target.join("::")));
            }
        }
    }
    assert!(wrong.is_empty(), "imports against the direction of the layout: {wrong:#?}");
}

#[test]
fn law_tables_are_made_of_tables_alone() {
    let is_of_tables = |module: &[String]| match module {
        [first, ..] if ["stats", "figures", "report", "cli"].contains(&first.as_str()) => true,
        [first, second] => first == "stages" && ["aggregate", "cycle_input"].contains(&second.as_str()),
        _ => false,
    };
    let graph = imports();
    let of_tables: Vec<_> = graph.iter().filter(|(module, _)| is_of_tables(module)).collect();
    assert!(of_tables.len() > 50, "too few modules found, the reader is wrong");
    for (module, targets) in of_tables {
        assert!(targets.iter().all(|target| target[0] != "physics"), "{module:?} imports the physics");
    }
}

#[test]
fn reg_the_reader_of_imports() {
    let known: BTreeSet<Vec<String>> = ["a", "a::b", "a::c", "d"].iter().map(|m| m.split("::").map(str::to_owned).collect()).collect();
    let module = ["a".to_owned(), "b".to_owned()];
    let found = |code: &str| -> Vec<String> {
        paths_in(code).iter().filter_map(|path| target(&module, path, &known)).map(|target| target.join("::")).collect()
    };
    assert_eq!(found("use super::c::{X, Y as Z};\n"), ["a::c", "a::c", "a::c"]);
    assert_eq!(found("use crate::{d::D, a::{c, b::E}};\n"), ["d", "a::c"]);
    assert_eq!(found("let x = super::super::d::f(1);\n"), ["d"]);
    let graph = |edges: &[(&str, &str)]| -> Graph {
        edges.iter().map(|(from, to)| (vec![(*from).to_owned()], [vec![(*to).to_owned()]].into())).collect()
    };
    assert!(in_circles(graph(&[("x", "y"), ("y", "z")])).is_empty());
    assert_eq!(in_circles(graph(&[("w", "x"), ("x", "y"), ("y", "x")])).len(), 2);
}
