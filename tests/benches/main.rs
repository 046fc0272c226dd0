//! How fast the parts are, each against something plain that is timed in the same run: machines differ, ratios less.
//!
//! `cargo bench` runs all, `cargo bench -- sums` those whose names hold a word. Nothing here is asserted: what is right is in `tests/physics`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[cfg(feature = "stats")]
mod campaign;
mod cycle;
mod elements;
mod laws;
mod pairs;
mod paper;
mod sums;
mod surfaces;
#[cfg(feature = "store")]
mod tables;
mod watch;

use std::env::args;

fn main() {
    // Cargo itself adds `--bench`.
    let wanted: Vec<String> = args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let all: [(&str, fn()); 8] = [
        ("pairs", pairs::run),
        ("sums", sums::run),
        ("surfaces", surfaces::run),
        #[cfg(feature = "store")]
        ("tables", tables::run),
        #[cfg(not(feature = "store"))]
        ("tables", || println!("tables: not without the feature `store`")),
        ("cycle", cycle::run),
        ("elements", elements::run),
        ("laws", laws::run),
        #[cfg(feature = "stats")]
        ("planning", campaign::run),
        #[cfg(not(feature = "stats"))]
        ("planning", || println!("planning: not without the feature `stats`")),
    ];
    for (name, run) in all {
        if wanted.is_empty() || wanted.iter().any(|word| name.contains(word.as_str())) {
            run();
        }
    }
}
