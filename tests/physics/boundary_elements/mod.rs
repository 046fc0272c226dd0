//! Adhesive boundary elements against exact solutions.

mod johnson;
mod study;
