//! The paper's material and its surfaces of H = 0.8.

use hysteron::model::{Amplitudes, Material, Normalization};
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::Spectrum;

pub const MATERIAL: Material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };

pub fn spectrum(magnification: u32) -> Spectrum {
    Spectrum {
        length_m: 1e-3,
        rms_height_m: 5e-6,
        hurst: 0.8,
        magnification,
        normalization: Normalization::Sample,
        amplitudes: Amplitudes::Fixed,
        shape: Shape::default(),
    }
}
