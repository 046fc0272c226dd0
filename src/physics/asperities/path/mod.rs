//! The path of equilibria under displacement control, from event to event.
//!
//! An event-driven predictor–corrector continuation in the mean penetration Δ. Local problems resolve the
//! events, in overlapping subdomains; their effect is propagated to the rest of the contact, the largest
//! pending displacement first (Gauss–Southwell); a global Newton–Krylov solve corrects the result.
//!
//! ```text
//!  F │                 load of the contact          ●  global solve at the end of an increment
//!    │        ●┄┄┄┄┄╮   ┄ linear predictors         │  event: the local problem jumps at constant Δ
//!    │              │
//!    │              ╰┄┄┄┄┄●┄┄┄┄┄┄┄┄●               one increment: h = h_0/2^k
//!    └────────┴─────┴─────┴────────┴───── Δ
//! ```
//!
//! ```text
//!  1  state ← all asperities free, one output step before the first contact           asperities::cycle
//!  2  for each branch: loading, and unloading from each load reversal
//!  3    solve the global problem; predictors δ_i(Δ) of contacts and near jump-ins     resume
//!  4    until the branch ends:                                                        step
//!  5      checkpoint; Δ* ← next multiple of h = h_0/2^k                               StepControl::target
//!  6      queue ← events predicted before Δ*                                          expect_events
//!  7      while the queue has an earliest event e:                                    run_events
//!  8        P ← 24 contacts nearest to e, and the free asperities among them          Neighbourhood::gather
//!  9        if members have pending displacements: apply, solve P, predict again      apply_pending
//! 10        locate e on the solution curve of P (a radius or a penetration is held,   locate
//!            or a touch is bracketed)
//! 11        none before Δ*: drop e; another one is earlier: put e back in place
//! 12        predictors of P to e, work of their loads; apply e, solve or relax P      finish_location, apply
//! 13        avalanche, at constant Δ:                                                 run_avalanche
//! 14          change of the field: next to P pending per contact, beyond as one load  propagate
//! 15          next: the most overdue transition that undoes none of the avalanche,    most_overdue
//! 16          or the contact with the largest pending displacement above the limit,   worst_pending
//!            or else the most overdue merging or splitting
//! 17          none: the avalanche ends; a large one or too many solves: global solve here, back to 6
//! 18          gather P there, apply, solve; dissipated += −change of the potential    finish
//! 19        predict the touched asperities again
//! 20      solve the global problem at Δ* (Newton, GMRES, nonlinear elimination)       correct
//! 21      reject if predictors were too far, an event is overdue, or no stable state  is_astray, overdue
//! 22        rejected: back to the checkpoint, k ← k + 1                               StepControl::halve
//! 23        from k = 6 the residual is accepted, contacts relax; k = 14: all at Δ*    relax_globally
//! 24      new predictors; close the energy balance with the potential                 restart_predictors
//! 25      record grid points inside the increment on excursions from the checkpoint   excursion
//! 26      load reversals by bracketing on excursions                                  turning
//! ```
//!
//! An increment does not depend on the output steps: these are read off the path.
//!
//! | part | owns |
//! |---|---|
//! | [`predictor::Predictor`] | state of the contact; linear predictors, load and area between solves |
//! | [`pending::PendingField`] | displacements by events that are not yet in the predictors |
//! | [`neighbourhood::Neighbourhood`] | local problem of the present event, and the shell around it |
//! | [`energy::EnergyLedger`] | energy balance since the last global solve |
//! | [`step_control::StepControl`] | lengths of increments, limit of the trials in one |
//! | [`chatter::ChatterGuard`] | asperities that change to and fro |
//! | [`event_log::EventLog`] | events, work, and segments of the load |
//! | [`checkpoint::Checkpoint`] | a path at a global solve, to go back to |
//!
//! An event kind is a variant of [`EventKind`](crate::EventKind) with its row (word, name, group, inverse),
//! and an arm of `conditions`: the quantity and its limit. Its lateness, its due state and its place on the
//! solution curve follow from the condition. The compiler then requires the change of the local problem
//! (`apply`), the status after it (`propagation`) and its columns (`schema::event_kinds`). It does not
//! require:
//!
//! - the asperities for which the event is looked for: `triggers`, `expectation`, and `overtaken` during a
//!   relaxation;
//! - pairs of kinds that undo each other: `Transition::returns`;
//! - the offset of the potential if a load law changes: `Problem::self_potential`.

mod apply;
mod arrival;
mod avalanche;
mod chatter;
mod checkpoint;
mod conditions;
mod corrector;
mod energy;
mod equilibrium_path;
mod event_log;
mod events;
mod excursion;
mod expectation;
mod merging;
mod neighbourhood;
mod pending;
mod predictor;
mod propagation;
mod rejection;
mod resume;
mod step_control;
mod triggers;
mod work;

pub(crate) use checkpoint::PathCheckpoint;
pub(crate) use equilibrium_path::EquilibriumPath;
pub(crate) use step_control::is_multiple;
