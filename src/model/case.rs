//! Parameters of a case: surface, material, model, boundary elements and loading path.

use super::{
    Amplitudes, Attraction, Boundary, Coalescence, Detrend, FastAxis, Filter, Interaction, JumpIn, KeptContacts, Material, Method, Missing,
    Normalization, Nucleation, Opening, Slip, Slips,
};
use crate::physics::surface::spectrum::Spectrum;
use serde::{Deserialize, Serialize};

/// Everything that a case is made of but its seed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseParams {
    /// The rough surface.
    pub surface: SurfaceParams,
    /// The half-space and its adhesion.
    pub material: Material,
    /// The choices that the model leaves open.
    pub model: ModelParams,
    /// Boundary elements; the defaults for the asperity model.
    pub boundary_elements: ElementParams,
    /// The loading and unloading path.
    pub cycle: CycleParams,
}

impl CaseParams {
    /// True if boundary elements compute the case.
    #[must_use]
    pub fn by_elements(&self) -> bool {
        self.model.method == Method::BoundaryElements
    }
}

/// A self-affine surface on a square, or a measured one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceParams {
    /// Side L of the square \[m\].
    pub length_m: f64,
    /// Root mean square height \[m\].
    pub rms_height_m: f64,
    /// Hurst exponent H, from 0.01 to 1.
    pub hurst: f64,
    /// Magnification ζ: the longest over the shortest wavelength.
    pub magnification: u32,
    /// Grid points per shortest wavelength.
    pub points_per_shortest_wavelength: u32,
    /// Normalization of the rms height.
    pub normalization: Normalization,
    /// The moduli of the Fourier modes.
    pub amplitudes: Amplitudes,
    /// The file of a measured surface; empty for a generated one. Of the parameters above a measured one reads the points per shortest wavelength alone.
    pub file: String,
    /// Which of the file's fields it is; empty for the only one.
    pub dataset: String,
    /// True if it continues periodically.
    pub periodic: bool,
    /// Distance of its points \[m\], if the file does not state it; else 0.
    pub pixel_m: f64,
    /// Size of the scan along x \[m\], where the file does not state it; else 0.
    pub size_m: f64,
    /// Size of the scan along y \[m\]; 0 for square pixels.
    pub size_y_m: f64,
    /// Unit of its heights, if the file does not state it.
    pub unit: String,
    /// Lines of a text that are not read.
    pub skip_lines: u32,
    /// Points of a scan line of a text whose lines are none; else 0.
    pub width: u32,
    /// True to exchange x and y.
    pub transpose: bool,
    /// Treatment of missing points.
    pub missing: Missing,
    /// Shape that is removed from its heights by least squares; the mean alone if it is periodic.
    pub detrend: Detrend,
    /// Low-pass filter of a measured surface.
    pub filter: Filter,
    /// True if outliers are replaced.
    pub outliers: bool,
    /// True if the offsets of scan lines are removed.
    pub align_rows: bool,
    /// Direction of the scan lines.
    pub fast_axis: FastAxis,
    /// Radius of the tip that measured it \[m\]; 0 if it is unknown or sharp.
    pub tip_radius_m: f64,
}

impl SurfaceParams {
    /// True if it is a measured surface.
    #[must_use]
    pub fn is_measured(&self) -> bool {
        !self.file.is_empty()
    }

    /// Grid points along one side: ζ times the points per shortest wavelength. A validated spec limits it.
    #[must_use]
    pub fn grid(&self) -> u64 {
        u64::from(self.magnification) * u64::from(self.points_per_shortest_wavelength)
    }
}

/// The choices that the model leaves open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelParams {
    /// Method of the cycle.
    pub method: Method,
    /// Elastic interaction between contacts.
    pub interaction: Interaction,
    /// Boundary condition of the square.
    pub boundary: Boundary,
    /// Coalescence rule: contacts grow together.
    pub coalescence: Coalescence,
    /// When a free asperity jumps into contact.
    pub jump_in: JumpIn,
    /// Uncorrected equations of the paper, sorted, each once.
    pub as_printed: Vec<Slip>,
    /// Go on where an asperity's Tabor parameter is below 2 and JKR no longer holds.
    pub allow_low_tabor: bool,
}

impl ModelParams {
    /// Uncorrected equations, in the form that the physics uses.
    #[must_use]
    pub fn slips(&self) -> Slips {
        self.as_printed.iter().copied().collect()
    }
}

/// The loading and unloading path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CycleParams {
    /// Load reversals `F/(E* A0)` of the one loading path, ascending, each once.
    pub max_load: Vec<f64>,
    /// Step of the approach, as a part of the rms height.
    pub approach_step: f64,
    /// Which steps of the table of contact spots are kept.
    pub contacts: KeptContacts,
}

/// Parameters of boundary elements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElementParams {
    /// Grid points along a side; 0 for the automatic grid.
    pub points: u32,
    /// Attraction between the surfaces.
    pub attraction: Attraction,
    /// Range ρ of the Morse law \[m\]; 0 for one that follows the grid.
    pub range_m: f64,
    /// Gap at which a point comes into contact.
    pub nucleation: Nucleation,
    /// Rule for the opening of contact.
    pub opening: Opening,
    /// Step of the approach, as a part of the rms height.
    pub approach_step: f64,
    /// Most halvings of a step in which an event leaves its energy uncertain.
    pub halvings: u32,
    /// Rms residual over the maximum tension.
    pub precision: f64,
}

// The defaults are the paper's: its surface, its material, one of its loads.
impl Default for SurfaceParams {
    fn default() -> Self {
        Self {
            length_m: 1e-3,
            rms_height_m: 5e-6,
            hurst: 0.8,
            magnification: 128,
            points_per_shortest_wavelength: 8,
            normalization: Normalization::Sample,
            amplitudes: Amplitudes::Fixed,
            file: String::new(),
            dataset: String::new(),
            periodic: false,
            pixel_m: 0.0,
            size_m: 0.0,
            size_y_m: 0.0,
            unit: String::new(),
            skip_lines: 0,
            width: 0,
            transpose: false,
            missing: Missing::Refuse,
            detrend: Detrend::Plane,
            filter: Filter::Gaussian,
            outliers: false,
            align_rows: false,
            fast_axis: FastAxis::Auto,
            tip_radius_m: 0.0,
        }
    }
}

impl Default for ModelParams {
    fn default() -> Self {
        Self {
            method: Method::Asperities,
            interaction: Interaction::Spots,
            boundary: Boundary::Periodic,
            coalescence: Coalescence::Merge,
            jump_in: JumpIn::Wu,
            as_printed: Vec::new(),
            allow_low_tabor: false,
        }
    }
}

impl CycleParams {
    /// The largest load `F/(E* A0)`.
    #[must_use]
    pub fn largest_load(&self) -> f64 {
        self.max_load.iter().copied().fold(0.0, f64::max)
    }
}

impl Default for CycleParams {
    fn default() -> Self {
        Self { max_load: vec![0.0071], approach_step: 0.01, contacts: KeptContacts::Turning }
    }
}

impl Default for ElementParams {
    fn default() -> Self {
        Self {
            points: 0,
            attraction: Attraction::Bonded,
            range_m: 0.0,
            nucleation: Nucleation::Touch,
            opening: Opening::Strength,
            approach_step: 0.03,
            halvings: 6,
            precision: 1e-4,
        }
    }
}

impl From<&SurfaceParams> for Spectrum {
    /// Target spectrum of a generated surface.
    fn from(params: &SurfaceParams) -> Self {
        Self {
            length_m: params.length_m,
            rms_height_m: params.rms_height_m,
            hurst: params.hurst,
            magnification: params.magnification,
            normalization: params.normalization,
            amplitudes: params.amplitudes,
        }
    }
}
