//! Parameters of a case: those of the physics, and those of the spec.

mod case;
mod experiment;
mod measured;

pub use crate::physics::elements::probe::SPHERE_SHARE;
pub use crate::physics::model::*;
pub use crate::physics::theory::regime::{BRIDGED, FLATTENED, LARGE_AREA, Regime, SEPARATE};
pub use case::{
    AsperityOptions, Attraction, CaseParams, ElementOptions, GeneratedSurface, LoadingPath, MethodOptions,
    SurfaceSource, TabulatedSpectrum,
};
pub use experiment::{Experiment, LoopOptions};
pub use measured::MeasuredSurface;
