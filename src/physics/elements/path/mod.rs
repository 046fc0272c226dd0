//! Path of a cycle: steps, load reversals, records in the units of the grid.

pub mod adhesionless;
pub mod cycle;
pub mod records;
pub(crate) mod reversal;
pub(crate) mod stations;
pub(crate) mod step;
