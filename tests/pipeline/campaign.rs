//! Campaigns: what is done again and what is not, whatever happens to files and processes.

mod care;
mod checkpoints;
mod engines;
mod faults;
mod fields;
mod fuzz;
mod kills;
mod limits;
mod living;
mod lost;
mod outputs;
mod published;
mod relocation;
mod sampling;
mod signals;
mod snakemake;
mod tasks;

/// Two surfaces and two cycles, of which one load each: half a second of work.
const SMALL: &str =
    "name = \"small\"\nseed = 7\nrealizations = 2\n[surface]\nmagnification = 6\n[cycle]\nmax_load = [0.001]\napproach_step = 0.05\n";
