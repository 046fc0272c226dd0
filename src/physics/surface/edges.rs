//! Edges of a square surface.

/// Continuation of a surface beyond the edges of its square.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edges {
    /// The surface is periodic.
    Periodic,
    /// The surface ends.
    Open,
}

impl Edges {
    /// Edges of a surface that is periodic or not.
    #[must_use]
    pub const fn of(is_periodic: bool) -> Self {
        if is_periodic { Self::Periodic } else { Self::Open }
    }
}
