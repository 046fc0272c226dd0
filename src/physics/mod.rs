//! Adhesive contact of rough surfaces: loading, unloading, and the energy that is dissipated in between.
//!
//! Three calls of a library user: a surface ([`surface`]), a method on it ([`asperities::Asperities`] or
//! [`elements::Elements`]), and its [`run`](cycle::Method::run), which returns a [`cycle::Cycle`]. All
//! quantities are in SI units; compression and penetration are positive. The crate opens no files. Every
//! method implements [`cycle::Method`]. The numerical choices of each, [`asperities::Numerics`] and
//! [`elements::Numerics`], are options with a default; their fields state their effect.
//!
//! # A loop of the asperity model
//! ```
//! use hysteron_physics::asperities::{Asperities, Options};
//! use hysteron_physics::cycle::Method;
//! use hysteron_physics::model::{Amplitudes, Material, Normalization};
//! use hysteron_physics::surface::{HeightMap, shape::Shape, spectrum::Spectrum};
//! use hysteron_physics::surface::synthesis::{realization_seed, synthesize};
//!
//! let (normalization, amplitudes) = (Normalization::Spectrum, Amplitudes::Fixed);
//! let (length_m, rms_height_m) = (1e-3, 5e-6);
//! let (hurst, magnification, shape) = (0.8, 6, Shape::default());
//! let spectrum =
//!     Spectrum { length_m, rms_height_m, hurst, magnification, normalization, amplitudes, shape };
//! let surface = synthesize(&spectrum, &realization_seed(1, 0), 48);
//! let map = HeightMap {
//!     heights_m: surface.heights_m.view(),
//!     length_m: 1e-3,
//!     is_periodic: true,
//!     shortest_wavelength_m: 1e-3 / 6.0,
//!     rms_height_m: 5e-6,
//! };
//! let material =
//!     Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.01, interaction_range_m: 1e-9 };
//! let options = Options { approach_step: 0.05, ..Options::default() };
//! let cycle = Asperities::new(&map, &material, &[0.002], &options)?.run()?;
//! let pull_off_n = cycle.steps.iter().map(|step| -step.least_load_n).fold(0.0, f64::max);
//! let dissipated_j: f64 = cycle.events.iter().map(|event| event.energy_lost_j).sum();
//! assert!(pull_off_n > 0.0 && dissipated_j > 0.0);
//! # Ok::<(), hysteron_physics::PhysicsError>(())
//! ```
//!
//! # A loop by boundary elements
//! A measured height map that is not periodic is continued by its mirror images; loads, areas and energies
//! are those of the map.
//! ```
//! use hysteron_physics::cycle::Method;
//! use hysteron_physics::elements::{Elements, Options};
//! use hysteron_physics::model::Material;
//! use hysteron_physics::surface::HeightMap;
//! use ndarray::Array2;
//!
//! let heights_m = Array2::from_shape_fn((16, 16), |(i, j)| {
//!     2e-7 * ((0.4 * i as f64).sin() + (0.5 * j as f64 + 1.0).sin())
//! });
//! let (length_m, shortest_wavelength_m, rms_height_m) = (1.6e-5, 1.2e-5, 2e-7);
//! let heights_m = heights_m.view();
//! let map = HeightMap { heights_m, length_m, is_periodic: false, shortest_wavelength_m, rms_height_m };
//! let material =
//!     Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.002, interaction_range_m: 1e-9 };
//! let options = Options { points: 32, approach_step: 0.1, ..Options::default() };
//! let cycle = Elements::new(&map, &material, &[0.01], &options)?.run()?;
//! let largest_m2 = cycle.steps.iter().map(|step| step.area_m2).fold(0.0, f64::max);
//! assert!(largest_m2 > 0.0 && largest_m2 < length_m * length_m && !cycle.maps.is_empty());
//! # Ok::<(), hysteron_physics::PhysicsError>(())
//! ```
//!
//! # Events, progress and checkpoints
//! ```
//! # use hysteron_physics::elements::{Elements, Options};
//! # use hysteron_physics::model::Material;
//! # use hysteron_physics::surface::HeightMap;
//! # use ndarray::Array2;
//! use hysteron_physics::EventKind;
//! use hysteron_physics::cycle::Method;
//!
//! # let heights_m = Array2::from_shape_fn((16, 16), |(i, j)| {
//! #     2e-7 * ((0.4 * i as f64).sin() + (0.5 * j as f64 + 1.0).sin())
//! # });
//! # let (length_m, shortest_wavelength_m, rms_height_m) = (1.6e-5, 1.2e-5, 2e-7);
//! # let heights_m = heights_m.view();
//! # let map = HeightMap { heights_m, length_m, is_periodic: false, shortest_wavelength_m, rms_height_m };
//! # let material =
//! #     Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.002, interaction_range_m: 1e-9 };
//! let options = Options { points: 32, approach_step: 0.1, ..Options::default() };
//! let method = Elements::new(&map, &material, &[0.01], &options)?;
//! let mut checkpoints = 0;
//! let cycle = method.run_from(None, &mut |_| checkpoints += 1, &|at| assert!(at.done <= 1.0))?;
//! let jumps = cycle.events.iter().filter(|event| event.kind == EventKind::JumpIn).count();
//! assert!(jumps > 0 && checkpoints > 0);
//! for event in &cycle.events {
//!     println!("{} at Δ = {:e} m: {:e} J", event.word(), event.mean_penetration_m, event.energy_lost_j);
//! }
//! # Ok::<(), hysteron_physics::PhysicsError>(())
//! ```

pub mod asperities;
pub mod constants;
pub mod cycle;
pub mod elements;
mod error;
mod event_kind;
pub mod jkr;
mod loop_position;
mod math;
pub mod memory;
pub mod model;
pub mod surface;
pub mod theory;

use crate::constants::Constants;
pub use error::{LoopError, PhysicsError, Reason};
pub use event_kind::{EventCounts, EventGroup, EventKind, RegionChange, SpotStatus};
pub use loop_position::LoopPosition;

/// Tolerances and limits of the physics, by module.
pub const CONSTANTS: [Constants; 9] = [
    Constants { subject: "Valid cycles", module: "physics::cycle", rows: cycle::CONSTANTS },
    Constants {
        subject: "Path of the asperity model",
        module: "physics::asperities",
        rows: asperities::PATH,
    },
    Constants {
        subject: "Global and local problems",
        module: "physics::asperities",
        rows: asperities::SOLVERS,
    },
    Constants {
        subject: "Sums over contacts",
        module: "physics::asperities::field",
        rows: asperities::field::CONSTANTS,
    },
    Constants {
        subject: "Contacts",
        module: "physics::asperities::contact",
        rows: asperities::contact::CONSTANTS,
    },
    Constants { subject: "One asperity", module: "physics::jkr", rows: jkr::CONSTANTS },
    Constants { subject: "Boundary elements", module: "physics::elements", rows: elements::CONSTANTS },
    Constants { subject: "Measured surfaces", module: "physics::surface", rows: surface::CONSTANTS },
    Constants { subject: "Analytical models", module: "physics::theory", rows: theory::CONSTANTS },
];
