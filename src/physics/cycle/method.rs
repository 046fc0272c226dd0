//! The contract of a method with the pipeline: it loads and unloads a surface, and returns one [`Cycle`] in
//! SI units.

use super::Cycle;
use crate::{LoopPosition, PhysicsError};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A method, with the surface, material and options of one cycle.
///
/// What reads the [`Cycle`] need not know the method. A new method is an implementation of this trait; the
/// program then needs its options among the parameters of a case, their keys, and one arm where a cycle is
/// set up.
pub trait Method {
    /// Unfinished cycle, sufficient to continue in another process with identical results.
    type Checkpoint: Serialize + DeserializeOwned;
    /// State at a load reversal, sufficient to unload from there.
    type State;

    /// Word in the tables.
    const NAME: &'static str;
    /// Versions of the results, the present one last, with what has changed.
    const VERSIONS: &'static [(u32, &'static str)];

    /// Loads to the largest of the loads and unloads from each, from the beginning or from a checkpoint.
    ///
    /// `keep` receives every new checkpoint, `progress` the position that is reached. Loads without a result
    /// are listed in the cycle, with their error.
    ///
    /// # Errors
    /// If no load has a result.
    fn run_from(
        &self,
        checkpoint: Option<Self::Checkpoint>,
        keep: &mut (dyn FnMut(&Self::Checkpoint) + Send),
        progress: &(dyn Fn(LoopPosition) + Sync),
    ) -> Result<Cycle<Self::State>, PhysicsError>;

    /// Loads to the largest of the loads and unloads from each.
    ///
    /// # Errors
    /// If no load has a result.
    fn run(&self) -> Result<Cycle<Self::State>, PhysicsError> {
        self.run_from(None, &mut |_| {}, &|_| {})
    }

    /// Unloads from a state at the load reversal of a number: the steps that [`run`](Self::run) has from
    /// there, numbered from 0.
    ///
    /// # Errors
    /// An unknown load reversal; surfaces that do not separate.
    fn unload_from(&self, reversal: usize, state: Self::State) -> Result<Cycle<Self::State>, PhysicsError>;

    /// Name and number of the unknowns, for the record of the effort.
    fn size(&self) -> (&'static str, u64);
}
