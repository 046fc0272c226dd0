//! The contract of a method of a cycle: what it implements, its records in SI units, and the loop over
//! branches and checks that methods share.
//!
//! A cycle is one loading and an unloading from every load reversal. It begins before the first jump into
//! contact and ends with the last separation. Its area is therefore the total dissipated energy `Θ = ∮F dΔ`.

mod branches;
mod constants;
mod effort;
mod method;
mod record;
pub mod soundness;

pub(crate) use branches::{BranchRun, Done, run_branches};
pub(super) use constants::CONSTANTS;
pub use effort::Effort;
pub use method::Method;
pub use record::{
    Branch, Contact, Cycle, Event, Map, Merged, MergedAt, RegionShape, Site, Step, StepCounts, StepNumerics,
    Totals,
};
