//! Linear algebra, root bracketing and quadrature. Imports nothing of the physics.

pub(crate) mod bracket;
pub(crate) mod dense;
pub(crate) mod gmres;
pub(crate) mod grown;
pub(crate) mod quadrature;
pub(crate) mod vector;
