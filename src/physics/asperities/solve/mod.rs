//! Equilibria of a contact at one mean penetration: global, local, and by relaxation.

pub(crate) mod descent;
pub(crate) mod global;
pub(crate) mod local;
pub(crate) mod newton;
mod overdamped;
pub(crate) mod precision;
pub(crate) mod relaxation;
pub(crate) mod residual;
mod schwarz;
pub(crate) mod trace;
