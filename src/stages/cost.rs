//! Memory and time of a cycle, estimated before it begins.

/// Memory and time of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Grid points along a side: of the surface for the asperity model, of the periodic square for boundary
    /// elements.
    pub points: u64,
    /// Grid points per shortest wavelength.
    pub per_wavelength: f64,
    /// True if the square is a surface with its mirror images.
    pub is_mirrored: bool,
    /// Memory \[bytes\].
    pub memory_bytes: f64,
    /// Time of one cycle \[s\].
    pub seconds: f64,
}
