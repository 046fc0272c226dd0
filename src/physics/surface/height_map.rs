//! Heights on a square.

use super::edges::Edges;
use ndarray::ArrayView2;

/// Heights of a square surface.
#[derive(Debug, Clone, Copy)]
pub struct HeightMap<'a> {
    /// Heights \[m\]: rows along x, columns along y, as many of both.
    pub heights_m: ArrayView2<'a, f64>,
    /// Side \[m\].
    pub length_m: f64,
    /// True if the surface is one period. Otherwise it is continued by its mirror images, and loads, areas
    /// and energies are those of the surface.
    pub is_periodic: bool,
    /// Shortest wavelength \[m\].
    pub shortest_wavelength_m: f64,
    /// Rms height \[m\], the unit of the steps of mean penetration.
    pub rms_height_m: f64,
}

impl<'a> HeightMap<'a> {
    /// Its heights, side and edges.
    pub(crate) fn square(&self) -> SquareMap<'a> {
        SquareMap { heights_m: self.heights_m, length_m: self.length_m, edges: Edges::of(self.is_periodic) }
    }
}

/// Heights of a square with their continuation beyond its edges.
#[derive(Debug, Clone, Copy)]
pub struct SquareMap<'a> {
    /// Heights \[m\]: rows along x, columns along y, as many of both.
    pub heights_m: ArrayView2<'a, f64>,
    /// Side \[m\].
    pub length_m: f64,
    /// Edges.
    pub edges: Edges,
}
