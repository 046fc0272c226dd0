//! Computational effort of a step.

use serde::{Deserialize, Serialize};
use std::ops::{AddAssign, Sub};

/// Computational effort in counts of operations, independent of the machine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Effort {
    /// Pair fields evaluated.
    pub pairs: u64,
    /// Newton and relaxation iterations.
    pub iterations: u64,
    /// Products of the tangent with a vector, one for each iteration of GMRES.
    pub products: u64,
    /// Mesh transforms, forward or inverse.
    pub transforms: u64,
}

impl AddAssign for Effort {
    fn add_assign(&mut self, more: Self) {
        self.pairs += more.pairs;
        self.iterations += more.iterations;
        self.products += more.products;
        self.transforms += more.transforms;
    }
}

impl Sub for Effort {
    type Output = Self;

    fn sub(self, less: Self) -> Self {
        Self {
            pairs: self.pairs - less.pairs,
            iterations: self.iterations - less.iterations,
            products: self.products - less.products,
            transforms: self.transforms - less.transforms,
        }
    }
}
