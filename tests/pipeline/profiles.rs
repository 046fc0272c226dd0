//! `Cargo.toml`: optimisation levels of crates, and the minimum Rust version.

use std::collections::BTreeSet;
use std::path::Path;

use toml::{Table, Value};

fn read(name: &str) -> Table {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap().parse().unwrap()
}

/// Names of the packages in `Cargo.lock`, and names with their versions.
fn locked() -> BTreeSet<String> {
    let word = |package: &Value, key: &str| package[key].as_str().unwrap().to_owned();
    let lock = read("Cargo.lock");
    let packages = lock["package"].as_array().unwrap().iter();
    packages.flat_map(|package| [word(package, "name"), format!("{}@{}", word(package, "name"), word(package, "version"))]).collect()
}

/// Crates of a profile at an optimisation level.
fn at(profile: &str, level: i64) -> BTreeSet<String> {
    let manifest = read("Cargo.toml");
    let packages = manifest["profile"][profile]["package"].as_table().unwrap();
    packages
        .iter()
        .filter(|(_, options)| options.get("opt-level").and_then(Value::as_integer) == Some(level))
        .map(|(name, _)| name.clone())
        .collect()
}

#[test]
fn law_profiles_name_crates_of_the_lock_file() {
    let locked = locked();
    for profile in ["dev", "release", "dist"] {
        for name in (0..=3).flat_map(|level| at(profile, level)).filter(|name| name != "*") {
            assert!(locked.contains(&name), "profile.{profile}.package.{name} is not in Cargo.lock");
        }
    }
}

/// A new dependency is named in `profile.release.package`, or accepted here as one that a run spends no time in.
#[test]
fn reg_crates_that_are_not_optimised() {
    let (rest, full) = (at("release", 0), at("release", 3));
    assert!(rest.contains("*") && full.len() > 10);
    let is_named = |name: &str| full.iter().any(|known| known.split('@').next() == Some(name));
    let slow: Vec<String> = locked().into_iter().filter(|name| !name.contains('@') && name != "hysteron" && !is_named(name)).collect();
    insta::assert_snapshot!("crates_that_are_not_optimised", slow.join("\n"));
}

/// A name in `release` has precedence over the star of `dist`.
#[test]
fn law_released_binaries_are_optimised_throughout() {
    assert!(at("dist", 3).contains("*"));
    let low: Vec<String> =
        (0..3).flat_map(|level| at("release", level)).filter(|name| name != "*" && !at("dist", 3).contains(name)).collect();
    assert!(low.is_empty(), "at a lower level in profile.release, and not named in profile.dist: {low:?}");
    let manifest = read("Cargo.toml");
    let profile = &manifest["profile"]["dist"];
    assert_eq!((profile["lto"].as_str(), profile["codegen-units"].as_integer()), (Some("thin"), Some(1)));
}

#[test]
fn law_the_minimum_rust_version_is_the_one_that_is_used() {
    let minimum = read("Cargo.toml")["package"]["rust-version"].as_str().unwrap().to_owned();
    let used = read("rust-toolchain.toml")["toolchain"]["channel"].as_str().unwrap().to_owned();
    let python = read("src/python/Cargo.toml")["package"]["rust-version"].as_str().unwrap().to_owned();
    assert_eq!((used, &python), (format!("{minimum}.0"), &minimum));
    let guide = include_str!("../../src/guide/contributing.md");
    assert!(guide.contains(&format!("minimum Rust version of `Cargo.toml` ({minimum})")), "src/guide/contributing.md has another version");
}

#[test]
fn law_the_packages_have_the_version_of_the_program() {
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(read("src/python/Cargo.toml")["package"]["version"].as_str(), Some(version));
    let recipe = Path::new(env!("CARGO_MANIFEST_DIR")).join(".ci/conda/recipe.yaml");
    // A published crate has no recipe.
    if let Ok(recipe) = std::fs::read_to_string(recipe) {
        assert!(recipe.contains(&format!("\n  version: \"{version}\"\n")), "{recipe}");
    }
    assert!(include_str!("../../CITATION.cff").contains(&format!("\nversion: {version}\n")));
}
