//! The match of the stages on the method of a case. `steps`, `contacts`, `events`, `estimates` and the
//! checkpoints are common to all methods.
//!
//! A further method has its word in `physics/model.rs`, its options in `model/case.rs`, their keys in
//! `spec/keys.rs` and `spec/values.rs`, their columns in `schema/parameters.rs`, the inputs of its key in
//! `campaign/key_inputs.rs`, and an arm in each function here; the compiler names all of them but keys and
//! columns. These are more than four files since a key is read in `spec`, hashed in `campaign` and shown in a
//! column, and none of these may depend on the stages.

use super::super::StageError;
use super::super::cost::Cost;
use super::super::previews::Known;
use super::elements::{ElementsCase, Lattice, Square};
use super::{Computed, CycleTask, asperities, elements};
use crate::campaign::{Campaign, CycleUnit};
use crate::model::MethodOptions;
use crate::physics::cycle::Cycle;
use crate::spec::CaseParams;

/// Computes a cycle.
pub(super) fn run(task: &CycleTask<'_>) -> Result<Computed, StageError> {
    match &task.params().method {
        MethodOptions::Asperities(options) => asperities::run(task, options),
        MethodOptions::Elements(options) => elements::run(task, options),
    }
}

/// Unloads again from a load reversal of a finished cycle.
///
/// # Errors
/// The files of the cycle and of its surface must be complete, and contain that load.
pub fn unload_again(campaign: &Campaign, unit: &CycleUnit, max_load: f64) -> Result<Cycle<()>, StageError> {
    match &campaign.cases[unit.case].case.params.method {
        MethodOptions::Asperities(options) => asperities::unload_again(campaign, unit, options, max_load),
        MethodOptions::Elements(options) => elements::unload_again(campaign, unit, options, max_load),
    }
}

/// Grid of a case on a generated surface, or on the square of a measured one; nothing without it, and for a
/// method without a grid.
pub(in crate::stages) fn lattice(params: &CaseParams, square: Option<Square>) -> Option<Lattice> {
    match &params.method {
        MethodOptions::Asperities(_) => None,
        MethodOptions::Elements(options) => ElementsCase { params, options }.lattice(square),
    }
}

/// Grid, memory and time of a cycle at a ratio `U_el/Δγ`; nothing for a measured surface that is not known.
pub(in crate::stages) fn cost(
    params: &CaseParams,
    known: Option<&Known>,
    ratio: Option<f64>,
) -> Option<Cost> {
    match &params.method {
        MethodOptions::Asperities(options) => asperities::cost(params, options, known),
        MethodOptions::Elements(options) => ElementsCase { params, options }.cost(known, ratio),
    }
}

/// The error by which the cycles of a case fail on a generated surface, or on a measured one that is known,
/// as far as it is known before them.
pub(in crate::stages) fn refusal(params: &CaseParams, known: Option<&Known>) -> Option<StageError> {
    match &params.method {
        MethodOptions::Asperities(options) => asperities::refusal(params, options, known?),
        MethodOptions::Elements(options) => ElementsCase { params, options }.refusal(known),
    }
}
