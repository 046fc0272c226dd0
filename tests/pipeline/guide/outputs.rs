//! The tables of results in the tutorial and in the README are those that the program prints.

use super::blocks::{Page, pages};
use crate::bench::{Bench, code, stderr, stdout};
use std::path::Path;

fn page(name: &str) -> Page {
    pages().into_iter().find(|page| page.name == name).unwrap()
}

/// The output of a spec.
fn printed(spec: &str) -> String {
    let bench = Bench::new(spec);
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    stdout(&run)
}

fn quickstart() -> String {
    printed(&std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/quickstart.toml")).unwrap())
}

#[test]
fn e2e_tables_of_the_tutorial_are_those_of_the_program() {
    let page = page("tutorial.md");
    let tables: Vec<&str> = page.code("text").filter(|block| block.contains("F_max     n")).collect();
    let [spec, change, sweep] = page.code("toml").collect::<Vec<_>>()[..] else { panic!("the tutorial has other specs") };
    let old = spec.lines().find(|line| line.starts_with("max_load")).unwrap();
    let swept = format!("{}\n{sweep}", spec.replace(old, change.trim()));
    let outputs = [quickstart(), printed(spec), printed(&swept)];
    assert_eq!(tables.len(), outputs.len());
    for (table, output) in tables.iter().zip(&outputs) {
        assert!(output.contains(&format!("\n{table}")), "the tutorial has\n{table}\nbut the program prints\n{output}");
    }
}

/// A row of printed results: load, and the four results, each with the power of ten of its column.
fn rows(output: &str) -> Vec<(String, Vec<(String, String)>)> {
    let (mut rows, mut powers) = (Vec::new(), Vec::new());
    for line in output.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let Some(at) = words.iter().position(|word| *word == "F_max").filter(|at| words.get(at + 1) == Some(&"n")) {
            let mut heads: Vec<String> = Vec::new();
            for word in &words[at + 2..] {
                match word.strip_prefix('[') {
                    Some(power) => *heads.last_mut().unwrap() = power.trim_end_matches(']').to_owned(),
                    None => heads.push(String::new()),
                }
            }
            powers = heads;
        } else if line.matches('±').count() == 4 {
            let cells = words[words.len() - 4..].iter().map(|cell| (*cell).to_owned()).zip(powers.clone()).collect();
            rows.push((words[words.len() - 6].to_owned(), cells));
        }
    }
    rows
}

#[test]
fn e2e_the_table_of_the_readme_is_that_of_the_program() {
    let text = std::fs::read_to_string(page("README.md").path).unwrap();
    let found = rows(&quickstart());
    let mut count = 0;
    for line in text.lines().filter(|line| line.matches('±').count() == 4) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let results = cells[2..].iter().map(|cell| {
            let (number, power) = cell.strip_prefix('(').and_then(|cell| cell.split_once(") ")).unwrap_or((cell, ""));
            (number.replace(' ', ""), power.to_owned())
        });
        let row = (cells[1].to_owned(), results.collect::<Vec<_>>());
        assert!(found.contains(&row), "{line} is none of {found:?}");
        count += 1;
    }
    assert_eq!(count, 4);
}
