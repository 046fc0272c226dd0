//! Position on a loading–unloading loop, for reports of progress.

/// Position that a computation of a loop has reached.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LoopPosition {
    /// Finished fraction of the loop, 0 to 1. It follows the load while loading and the contact area while
    /// unloading, and is no fraction of the run time.
    pub done: f64,
    /// Number of finished steps.
    pub steps: usize,
    /// True after the first load reversal.
    pub unloading: bool,
    /// Load F/(E* A0).
    pub load: f64,
}
