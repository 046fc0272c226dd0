//! Parameters of a case: surface, material, method and loading path.

use super::{
    Amplitudes, AttractionKind, Boundary, Coalescence, FrontLaw, Interaction, JumpIn, KeptContacts, Machine,
    Material, MeasuredSurface, Method, Normalization, Nucleation, Opening, Probe, Slip, Slips,
    SpectrumConvention, SpectrumKind, Substrate,
};
use crate::physics::surface::psd_table::PsdTable;
use crate::physics::surface::shape::Shape;
use crate::physics::surface::spectrum::Spectrum;
use crate::physics::theory::flattening::flattening;
use serde::Serialize;
use std::sync::Arc;

/// Everything that a case is made of but its seed. It serializes as the tables of a spec.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CaseParams {
    /// The rough surface.
    pub surface: SurfaceSource,
    /// The sphere that carries the roughness; none for a flat surface.
    pub probe: Option<Probe>,
    /// The half-space and its adhesion.
    pub material: Material,
    /// The layer of the elastic material; none for a half-space.
    pub substrate: Option<Substrate>,
    /// The machine that moves the rigid surface.
    pub machine: Machine,
    /// The method and its options.
    pub method: MethodOptions,
    /// Uncorrected equations of the paper, sorted, each once. Boundary elements have those of analytical
    /// estimates alone.
    pub as_printed: Vec<Slip>,
    /// The loading and unloading path.
    pub cycle: LoadingPath,
}

/// Origin of a surface.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceSource {
    /// A self-affine surface of a spectrum.
    Generated(GeneratedSurface),
    /// A measured surface.
    Measured(Box<MeasuredSurface>),
}

/// A self-affine surface on a square.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GeneratedSurface {
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
    /// Longest wavelength \[m\], if it is below L.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub longest_wavelength_m: Option<f64>,
    /// Roll-off wavelength λ_r \[m\] of a plateau above it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_off_m: Option<f64>,
    /// Aspect ratio of the roughness, 1 if it is isotropic.
    #[serde(skip_serializing_if = "is_one")]
    pub aspect_ratio: f64,
    /// Direction of the lay, from the x axis towards the y axis \[°\].
    #[serde(skip_serializing_if = "is_zero")]
    pub angle_deg: f64,
    /// Tabulated spectrum; its file is empty for a power law.
    #[serde(skip)]
    pub tabulated: TabulatedSpectrum,
}

/// A tabulated spectrum and its reading.
#[derive(Debug, Clone, PartialEq)]
pub struct TabulatedSpectrum {
    /// Its file; empty for none.
    pub file: String,
    /// Quantity in its second column.
    pub kind: SpectrumKind,
    /// Normalization.
    pub convention: SpectrumConvention,
    /// Unit of length of both columns, if the heading does not state it.
    pub unit: String,
    /// Name of the data series of a table with several.
    pub series: String,
    /// Its isotropic density; nothing until the file has been read.
    pub table: Option<Arc<PsdTable>>,
    /// Quantity, convention and conversion in words; empty until the file has been read.
    pub reading: String,
}

fn is_one(value: &f64) -> bool {
    *value == 1.0
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// A method with its options.
#[derive(Debug, Clone, PartialEq)]
pub enum MethodOptions {
    /// Interacting asperities.
    Asperities(AsperityOptions),
    /// Boundary elements.
    Elements(ElementOptions),
}

/// Options of the asperity model.
#[derive(Debug, Clone, PartialEq)]
pub struct AsperityOptions {
    /// Elastic interaction between contacts.
    pub interaction: Interaction,
    /// Boundary condition of the square.
    pub boundary: Boundary,
    /// Coalescence rule: contacts grow together.
    pub coalescence: Coalescence,
    /// When a free asperity jumps into contact.
    pub jump_in: JumpIn,
    /// Go on where an asperity's Tabor parameter is below 2 and JKR no longer holds.
    pub allow_low_tabor: bool,
    /// Step of the mean penetration between outputs, as a part of the rms height.
    pub approach_step: f64,
}

/// Options of boundary elements.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementOptions {
    /// Grid points along a side; nothing for a grid that follows from the shortest wavelength.
    pub points: Option<u32>,
    /// Grid points per shortest wavelength of a measured surface, at least; nothing for the automatic number.
    pub per_wavelength: Option<u32>,
    /// Shift of the grid along rows and columns, as a part of its spacing; 0 but for shifted copies of
    /// coarser grids.
    pub shift: f64,
    /// Attraction between the surfaces.
    pub attraction: Attraction,
    /// Step of the mean penetration, as a part of the rms height.
    pub approach_step: f64,
    /// Most halvings of a step in which an event leaves its energy uncertain.
    pub halvings: u32,
    /// Rms residual over the maximum tension.
    pub precision: f64,
}

/// Attraction between the surfaces of boundary elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Attraction {
    /// The JKR limit: contact is bonded and opens like a crack.
    Bonded {
        /// Gap at which a point comes into contact.
        nucleation: Nucleation,
        /// Rule for the opening of contact.
        opening: Opening,
        /// Law of the edges of contact.
        law: FrontLaw,
    },
    /// Morse's law of a finite range.
    Range {
        /// Range ρ \[m\]; nothing for one that follows the grid.
        range_m: Option<f64>,
    },
}

/// The loading and unloading path.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadingPath {
    /// Load reversals `F/(E* A0)` of the one loading path, ascending, each once.
    pub max_load: Vec<f64>,
    /// Which steps of the table of contact spots are kept.
    pub contacts: KeptContacts,
}

impl CaseParams {
    /// True if boundary elements continue the surface by its mirror images.
    #[must_use]
    pub fn has_images(&self) -> bool {
        !self.surface.is_periodic() && self.probe.is_none()
    }

    /// Options of the asperity model, if it computes the case.
    #[must_use]
    pub fn asperities(&self) -> Option<&AsperityOptions> {
        if let MethodOptions::Asperities(options) = &self.method { Some(options) } else { None }
    }

    /// Options of boundary elements, if they compute the case.
    #[must_use]
    pub fn elements(&self) -> Option<&ElementOptions> {
        if let MethodOptions::Elements(options) = &self.method { Some(options) } else { None }
    }

    /// Boundary condition of the square.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.asperities().map_or(Boundary::Periodic, |options| options.boundary)
    }

    /// Elastic energy of the wavelengths of a tabulated spectrum below the shortest one, over the work of
    /// adhesion. Nothing without a table that has been read, and without adhesion.
    #[must_use]
    pub fn left_out_ratio(&self) -> Option<f64> {
        let surface = self.surface.generated()?;
        surface.tabulated.table.as_ref()?;
        let adhesion = self.material.work_of_adhesion_j_m2;
        (adhesion > 0.0)
            .then(|| surface.spectrum().left_out_m() * self.material.contact_modulus_pa / adhesion)
    }

    /// Uncorrected equations, in the form that the physics uses.
    #[must_use]
    pub fn slips(&self) -> Slips {
        self.as_printed.iter().copied().collect()
    }
}

impl SurfaceSource {
    /// The generated surface, if it is one.
    #[must_use]
    pub fn generated(&self) -> Option<&GeneratedSurface> {
        if let Self::Generated(surface) = self { Some(surface) } else { None }
    }

    /// The measured surface, if it is one.
    #[must_use]
    pub fn measured(&self) -> Option<&MeasuredSurface> {
        if let Self::Measured(surface) = self { Some(surface) } else { None }
    }

    /// Files of the measured surface, or the file of the tabulated spectrum of a generated one.
    #[must_use]
    pub fn files(&self) -> &[String] {
        match self {
            Self::Measured(surface) => surface.names(),
            Self::Generated(surface) if surface.is_tabulated() => {
                std::slice::from_ref(&surface.tabulated.file)
            }
            Self::Generated(_) => &[],
        }
    }

    /// Number of realizations that the surface itself states: its scans; nothing for a generated one.
    #[must_use]
    pub fn scan_count(&self) -> Option<u32> {
        self.measured().map(|surface| surface.names().len() as u32)
    }

    /// The surface of one realization: of several scans, that one.
    #[must_use]
    pub fn of_realization(&self, realization: u32) -> Self {
        match self {
            Self::Measured(surface) => Self::Measured(Box::new(surface.scan(realization))),
            Self::Generated(_) => self.clone(),
        }
    }

    /// True if it continues periodically.
    #[must_use]
    pub fn is_periodic(&self) -> bool {
        self.measured().is_none_or(|surface| surface.periodic)
    }

    /// Grid points per shortest wavelength; of a measured surface per cut-off wavelength of its filter.
    #[must_use]
    pub fn points_per_shortest_wavelength(&self) -> u32 {
        match self {
            Self::Generated(surface) => surface.points_per_shortest_wavelength,
            Self::Measured(surface) => surface.points_per_shortest_wavelength,
        }
    }
}

impl GeneratedSurface {
    /// Grid points along one side: ζ times the points per shortest wavelength. A validated spec limits it.
    #[must_use]
    pub fn grid(&self) -> u64 {
        u64::from(self.magnification) * u64::from(self.points_per_shortest_wavelength)
    }

    /// Target spectrum.
    #[must_use]
    pub fn spectrum(&self) -> Spectrum {
        Spectrum {
            length_m: self.length_m,
            rms_height_m: self.rms_height_m,
            hurst: self.hurst,
            magnification: self.magnification,
            normalization: self.normalization,
            amplitudes: self.amplitudes,
            shape: Shape {
                longest_wavelength_m: self.longest_wavelength_m,
                roll_off_m: self.roll_off_m,
                aspect_ratio: self.aspect_ratio,
                angle_rad: self.angle_deg.to_radians(),
                table: self.tabulated.table.clone(),
            },
        }
    }

    /// Elastic energy of flattening the target spectrum over E* \[m\].
    #[must_use]
    pub fn flattening_m(&self) -> f64 {
        flattening(&self.spectrum(), 1.0).whole_j_m2
    }

    /// True if its spectrum is a table.
    #[must_use]
    pub fn is_tabulated(&self) -> bool {
        !self.tabulated.file.is_empty()
    }

    /// True if its spectrum is known: a table is known once its file has been read.
    #[must_use]
    pub fn has_spectrum(&self) -> bool {
        !self.is_tabulated() || self.tabulated.table.is_some()
    }

    /// The surface with the rows of its tabulated spectrum, and the rms height of the spectrum's band.
    #[must_use]
    pub fn with_table(&self, table: Arc<PsdTable>, reading: &str) -> Self {
        let mut surface = self.clone();
        surface.tabulated.table = Some(table);
        reading.clone_into(&mut surface.tabulated.reading);
        surface.rms_height_m = surface.spectrum().moments().rms_height_m();
        surface
    }
}

impl Attraction {
    /// Key word of the attraction.
    #[must_use]
    pub fn kind(self) -> AttractionKind {
        match self {
            Self::Bonded { .. } => AttractionKind::Bonded,
            Self::Range { .. } => AttractionKind::Range,
        }
    }

    /// Rules for formation and opening of contact in the JKR limit; nothing with a range.
    #[must_use]
    pub fn bonded(self) -> Option<(Nucleation, Opening)> {
        if let Self::Bonded { nucleation, opening, .. } = self { Some((nucleation, opening)) } else { None }
    }

    /// Law of the edges of contact in the JKR limit; nothing with a range.
    #[must_use]
    pub fn law(self) -> Option<FrontLaw> {
        if let Self::Bonded { law, .. } = self { Some(law) } else { None }
    }
}

impl MethodOptions {
    /// Key word of the method.
    #[must_use]
    pub fn kind(&self) -> Method {
        match self {
            Self::Asperities(_) => Method::Asperities,
            Self::Elements(_) => Method::BoundaryElements,
        }
    }

    /// Step of the mean penetration, as a part of the rms height.
    #[must_use]
    pub fn approach_step(&self) -> f64 {
        match self {
            Self::Asperities(options) => options.approach_step,
            Self::Elements(options) => options.approach_step,
        }
    }
}

impl LoadingPath {
    /// The largest load `F/(E* A0)`.
    #[must_use]
    pub fn largest_load(&self) -> f64 {
        self.max_load.iter().copied().fold(0.0, f64::max)
    }
}

// The defaults are the paper's: its surface, its material, one of its loads.
impl Default for SurfaceSource {
    fn default() -> Self {
        Self::Generated(GeneratedSurface::default())
    }
}

impl Default for GeneratedSurface {
    fn default() -> Self {
        Self {
            length_m: 1e-3,
            rms_height_m: 5e-6,
            hurst: 0.8,
            magnification: 128,
            points_per_shortest_wavelength: 8,
            normalization: Normalization::Sample,
            amplitudes: Amplitudes::Fixed,
            longest_wavelength_m: None,
            roll_off_m: None,
            aspect_ratio: 1.0,
            angle_deg: 0.0,
            tabulated: TabulatedSpectrum::default(),
        }
    }
}

impl Default for TabulatedSpectrum {
    fn default() -> Self {
        Self {
            file: String::new(),
            kind: SpectrumKind::Auto,
            convention: SpectrumConvention::Auto,
            unit: String::new(),
            series: String::new(),
            table: None,
            reading: String::new(),
        }
    }
}

impl Default for MethodOptions {
    fn default() -> Self {
        Self::Asperities(AsperityOptions::default())
    }
}

impl Default for AsperityOptions {
    fn default() -> Self {
        Self {
            interaction: Interaction::Spots,
            boundary: Boundary::Periodic,
            coalescence: Coalescence::Merge,
            jump_in: JumpIn::Wu,
            allow_low_tabor: false,
            approach_step: 0.01,
        }
    }
}

impl Default for ElementOptions {
    fn default() -> Self {
        Self {
            points: None,
            per_wavelength: None,
            shift: 0.0,
            attraction: Attraction::default(),
            approach_step: 0.03,
            halvings: 6,
            precision: 1e-4,
        }
    }
}

impl Default for Attraction {
    fn default() -> Self {
        Self::Bonded { nucleation: Nucleation::Touch, opening: Opening::Strength, law: FrontLaw::Plain }
    }
}

impl Default for LoadingPath {
    fn default() -> Self {
        Self { max_load: vec![0.0071], contacts: KeptContacts::Turning }
    }
}
