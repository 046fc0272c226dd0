//! Units of the solver in SI units.

use crate::{LoopError, PhysicsError};

/// Units of the solver in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Side of the periodic square \[m\]; twice that of a surface that is continued by mirror images.
    pub length_m: f64,
    /// Grid points along a side.
    pub points: usize,
    /// Reduced modulus \[Pa\].
    pub modulus_pa: f64,
    /// Rms height \[m\].
    pub rms_height_m: f64,
    /// Unit of the steps \[m\]: the rms height, or the JKR length of a probe.
    pub step_unit_m: f64,
    /// True if the square is a surface with its three mirror images. Loads, areas and energies are then those
    /// of the surface: a quarter.
    pub is_mirrored: bool,
    /// Place of the first grid point along x and y, from the first point of the surface \[m\].
    pub first_m: f64,
    /// Compliance of the machine, of the load of the square \[1/(E* dx)\].
    pub machine_compliance: f64,
    /// True if the machine is the soft spring of load control.
    pub is_load_controlled: bool,
}

impl Units {
    /// Grid spacing, the unit of length \[m\].
    #[must_use]
    pub fn spacing_m(&self) -> f64 {
        self.length_m / self.points as f64
    }

    /// Unit of the load of the square, as that of the surface \[N\].
    #[must_use]
    pub fn load_n(&self) -> f64 {
        self.point_load_n() * self.share()
    }

    /// Unit of the energy of the square, as that of the surface \[J\].
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        self.point_load_n() * self.spacing_m() * self.share()
    }

    /// Area of a point of the square, as that of the surface \[m²\].
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.spacing_m().powi(2) * self.share()
    }

    /// Unit of the load of a point \[N\].
    #[must_use]
    pub fn point_load_n(&self) -> f64 {
        self.modulus_pa * self.spacing_m().powi(2)
    }

    /// Share of the surface in the square.
    fn share(&self) -> f64 {
        if self.is_mirrored { 0.25 } else { 1.0 }
    }

    /// Grid points along a side of the surface.
    #[must_use]
    pub fn own_points(&self) -> usize {
        if self.is_mirrored { self.points / 2 } else { self.points }
    }

    /// Place of a grid point along x or y, from the first point of the surface \[m\].
    #[must_use]
    pub fn place_m(&self, point: f64) -> f64 {
        self.first_m + point * self.spacing_m()
    }

    /// Number of grid points: A0, and `E* A0` in the units of the solver.
    #[must_use]
    pub fn all(&self) -> f64 {
        (self.points * self.points) as f64
    }

    /// An error of the solver with its lengths, loads and energies as those of the surface: in SI units,
    /// loads over E\* A0.
    #[must_use]
    pub(super) fn error(&self, error: LoopError) -> LoopError {
        let spacing = self.spacing_m();
        match error {
            LoopError::LoadNotReached { wanted, reached, mean_penetration_m } => LoopError::LoadNotReached {
                wanted: wanted / self.all(),
                reached: reached / self.all(),
                mean_penetration_m: mean_penetration_m * spacing,
            },
            LoopError::Closed { mean_penetration_m } => {
                LoopError::Closed { mean_penetration_m: mean_penetration_m * spacing }
            }
            LoopError::Inseparable { mean_penetration_m } => {
                LoopError::Inseparable { mean_penetration_m: mean_penetration_m * spacing }
            }
            LoopError::UnresolvedLoop { max_load, loss_j, events_j, work_j } => {
                let [loss_j, events_j, work_j] =
                    [loss_j, events_j, work_j].map(|energy| energy * self.energy_j());
                LoopError::UnresolvedLoop { max_load: max_load / self.all(), loss_j, events_j, work_j }
            }
            other => other,
        }
    }

    /// As [`error`](Self::error), of an error that ends a cycle.
    #[must_use]
    pub(super) fn end(&self, error: PhysicsError) -> PhysicsError {
        match error {
            PhysicsError::Loop(error) => self.error(error).into(),
            other => other,
        }
    }
}
