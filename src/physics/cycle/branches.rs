//! The branches of a cycle, for every method: one loading, and an unloading from each load reversal that it
//! reaches.

use crate::{LoopError, LoopPosition, PhysicsError};
use serde::{Deserialize, Serialize};

/// Branches that are done, and load reversals without a result, by their place in the settings.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Done {
    branches: usize,
    unreached: Vec<(usize, LoopError)>,
}

/// An unfinished cycle of a method.
pub(crate) trait BranchRun {
    /// Branches that are done.
    fn done(&mut self) -> &mut Done;

    /// Number of load reversals that the loading has reached.
    fn reversals(&self) -> usize;

    /// Continues a branch to its next checkpoint: the loading, or the unloading from a load reversal. True at
    /// its end.
    ///
    /// # Errors
    /// [`LoopError`] if the branch cannot go on; any other error ends the cycle.
    fn advance(
        &mut self,
        reversal: Option<usize>,
        progress: &dyn Fn(LoopPosition),
    ) -> Result<bool, PhysicsError>;

    /// Checks the energies of the loop to a load reversal, whose unloading is the last branch.
    ///
    /// # Errors
    /// A loop without energy balance or with negative dissipation.
    fn check(&self, reversal: usize) -> Result<(), LoopError>;

    /// Removes the unloading from a load reversal, if it is the last branch.
    fn forget(&mut self, reversal: usize);
}

/// Follows all branches to `loads` load reversals from where they are, and returns the load reversals without
/// a result.
///
/// `keep` is called at every checkpoint.
///
/// # Errors
/// The first error of a loop if no load reversal has a result, and any other error.
pub(crate) fn run_branches<R: BranchRun>(
    run: &mut R,
    loads: usize,
    keep: &mut dyn FnMut(&R),
    progress: &dyn Fn(LoopPosition),
) -> Result<Vec<(usize, LoopError)>, PhysicsError> {
    while run.done().branches <= loads {
        let reversal = run.done().branches.checked_sub(1);
        match advance(run, reversal, progress) {
            Ok(false) => {
                keep(run);
                continue;
            }
            Ok(true) => {}
            Err(PhysicsError::Loop(error)) => end_branch(run, reversal, loads, &error),
            Err(error) => return Err(error),
        }
        run.done().branches += 1;
    }
    let mut unreached = std::mem::take(&mut run.done().unreached);
    match unreached.first() {
        Some((_, error)) if unreached.len() == loads => Err(error.clone().into()),
        _ => {
            unreached.sort_by_key(|(reversal, _)| *reversal);
            Ok(unreached)
        }
    }
}

/// Continues a branch. A load reversal that was not reached has no unloading.
fn advance<R: BranchRun>(
    run: &mut R,
    reversal: Option<usize>,
    progress: &dyn Fn(LoopPosition),
) -> Result<bool, PhysicsError> {
    if reversal.is_some_and(|k| k >= run.reversals()) {
        return Ok(true);
    }
    let is_over = run.advance(reversal, progress)?;
    if let Some(k) = reversal.filter(|_| is_over) {
        run.check(k)?;
    }
    Ok(is_over)
}

/// Notes the load reversals of a branch that an error has ended: all further ones of the loading.
fn end_branch<R: BranchRun>(run: &mut R, reversal: Option<usize>, loads: usize, error: &LoopError) {
    let lost = match reversal {
        Some(k) => {
            run.forget(k);
            k..k + 1
        }
        None => run.reversals()..loads,
    };
    run.done().unreached.extend(lost.map(|k| (k, error.clone())));
}
