//! Measured loops, and how they are read.

use super::{Baseline, Compression};
use serde::Serialize;

/// Reading and evaluation of a measured loop. Empty texts and missing numbers are not given.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopOptions {
    /// Column of the force.
    pub force: String,
    /// Unit of the force.
    pub force_unit: String,
    /// Column of the displacement or penetration.
    pub displacement: String,
    /// Unit of the displacement.
    pub displacement_unit: String,
    /// Column of the contact radius or contact area.
    pub radius: String,
    /// Unit of the contact radius or contact area.
    pub radius_unit: String,
    /// Sign of a compressive force in the file.
    pub compression: Compression,
    /// Baseline that is subtracted.
    pub baseline: Baseline,
    /// Radius of the probe \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub probe_radius_m: Option<f64>,
    /// Reduced modulus \[Pa\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_modulus_pa: Option<f64>,
    /// Stiffness of the machine \[N/m\]: F/k is subtracted from the displacement.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub machine_stiffness_n_m: Option<f64>,
}

impl Default for LoopOptions {
    fn default() -> Self {
        let none = String::new;
        Self {
            force: none(),
            force_unit: none(),
            displacement: none(),
            displacement_unit: none(),
            radius: none(),
            radius_unit: none(),
            compression: Compression::Auto,
            baseline: Baseline::Line,
            probe_radius_m: None,
            contact_modulus_pa: None,
            machine_stiffness_n_m: None,
        }
    }
}

/// Measured loops of a spec.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Experiment {
    /// Files, each with one loop.
    pub loops: Vec<String>,
    /// Reading and evaluation of the files.
    #[serde(flatten)]
    pub options: LoopOptions,
}
