//! Equilibria of a contact at one approach: global, local, and by relaxation.

pub(crate) mod global;
mod jacobian;
pub(crate) mod local;
mod newton;
pub(crate) mod relaxation;
pub(crate) mod residual;
mod schwarz;
pub(crate) mod trace;
