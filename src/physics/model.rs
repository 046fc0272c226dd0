//! The material, and every choice that the model leaves open, by name.
//!
//! These types belong to no other module: a caller fills them, the physics reads them. They compute nothing.

use serde::{Deserialize, Serialize};

/// The elastic half-space and its adhesion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Contact modulus E* \[Pa\]: `1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂`.
    pub contact_modulus_pa: f64,
    /// Work of adhesion Δγ \[J/m²\].
    pub work_of_adhesion_j_m2: f64,
    /// Range of attraction ε \[m\]; it enters the Tabor parameter, Wu's jump-in distance and the strength
    /// Δγ/ε inside contacts of boundary elements only.
    pub interaction_range_m: f64,
}

impl Default for Material {
    fn default() -> Self {
        Self { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 }
    }
}

impl Material {
    /// `1/(πE*)` \[1/Pa\]: what a point load displaces at a distance, over load and inverse distance.
    #[must_use]
    pub fn compliance(&self) -> f64 {
        1.0 / (std::f64::consts::PI * self.contact_modulus_pa)
    }

    /// `Δγ/E*` \[m\]: the length of adhesion.
    #[must_use]
    pub fn adhesion_length_m(&self) -> f64 {
        self.work_of_adhesion_j_m2 / self.contact_modulus_pa
    }

    /// Pull-off force of an isolated JKR asperity over its radius, `3πΔγ/2` \[N/m\].
    #[must_use]
    pub fn pull_off_line_load(&self) -> f64 {
        1.5 * std::f64::consts::PI * self.work_of_adhesion_j_m2
    }

    /// `sqrt(2πΔγ/E*)` \[m^½\]: times the root of its radius, what adhesion draws a spot up (Eq 2).
    #[must_use]
    pub fn pull(&self) -> f64 {
        (2.0 * std::f64::consts::PI * self.work_of_adhesion_j_m2 / self.contact_modulus_pa).sqrt()
    }
}

/// A rigid sphere that carries the roughness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Radius R \[m\].
    pub radius_m: f64,
}

impl Probe {
    /// JKR length `(RΔγ²/E*²)^⅓` \[m\], the unit of the penetration of a smooth sphere: it leaves contact at
    /// a penetration of −1.61 of it.
    #[must_use]
    pub fn jkr_length_m(&self, material: &Material) -> f64 {
        (self.radius_m * material.adhesion_length_m().powi(2)).cbrt()
    }

    /// JKR radius of contact `(R²Δγ/E*)^⅓` \[m\]; a smooth sphere touches with 1.85 of it.
    #[must_use]
    pub fn jkr_radius_m(&self, material: &Material) -> f64 {
        (self.radius_m.powi(2) * material.adhesion_length_m()).cbrt()
    }
}

/// A layer of the elastic material, bonded to a rigid base.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Substrate {
    /// Thickness h \[m\].
    pub thickness_m: f64,
    /// Poisson's ratio ν, from 0 to 0.5.
    pub poisson_ratio: f64,
}

/// The machine that moves the rigid surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Compliance c of its spring \[m/N\], at least 0.
    pub compliance_m_n: f64,
    /// Elastic body at a distance from the contact.
    pub far_field: FarField,
    /// Controlled quantity.
    pub control: Control,
}

impl Default for Machine {
    fn default() -> Self {
        Self { compliance_m_n: 0.0, far_field: FarField::Cell, control: Control::Displacement }
    }
}

/// Displacement of a point load by its images on a square lattice of spacing L and the balancing uniform
/// load, in `−F/(πE*L)`: `−4ζ(½)β(½)`, with Riemann's and Dirichlet's functions.
pub const CELL_CONSTANT: f64 = 3.900_264_920_001_956;

/// A choice that a spec makes by a word.
pub trait Choice: Copy + PartialEq + Sized + 'static {
    /// Every value with its word, in the order in which they are shown.
    const WORDS: &'static [(&'static str, Self)];

    /// Every word with its meaning, in the same order.
    const MEANINGS: &'static [(&'static str, &'static str)];

    /// The word of this value.
    fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(_, value)| *value == self).map_or("", |(word, _)| word)
    }

    /// The value of a word, or nothing if no value has it.
    fn from_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, _)| *known == word).map(|(_, value)| *value)
    }
}

macro_rules! choice {
    ($(#[$doc:meta])* $name:ident {
        $($(#[doc = $meaning:literal])+ $variant:ident = $word:literal),+ $(,)?
    }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum $name { $($(#[doc = $meaning])+ #[serde(rename = $word)] $variant),+ }

        impl Choice for $name {
            const WORDS: &'static [(&'static str, Self)] = &[$(($word, Self::$variant)),+];
            const MEANINGS: &'static [(&'static str, &'static str)] = &[$(($word, concat!($($meaning),+))),+];
        }
    };
}

choice! {
    /// Definition of the rms height of a surface.
    Normalization {
        /// Each surface is scaled to h_rms exactly.
        Sample = "sample",
        /// The integral of the spectrum is h_rms². The rms height of one surface differs from h_rms.
        Spectrum = "spectrum",
    }
}
choice! {
    /// The moduli of the Fourier modes.
    Amplitudes {
        /// Square root of the spectral density. Only the phases are random, as in the paper.
        Fixed = "fixed",
        /// Rayleigh-distributed amplitudes: a Gaussian surface.
        Gaussian = "gaussian",
    }
}
choice! {
    /// Elastic body at a distance from the contact.
    FarField {
        /// Periodic cell: the mean displacement of the surface is fixed.
        Cell = "cell",
        /// Half-space with one contact: the periodic images do not displace its centre.
        HalfSpace = "half_space",
    }
}
choice! {
    /// Quantity that the machine controls.
    Control {
        /// Displacement of the far end of its spring.
        Displacement = "displacement",
        /// Load: contact is lost at the maximum tension.
        Load = "load",
    }
}
choice! {
    /// Quantity of a tabulated spectrum.
    SpectrumKind {
        /// By the unit of C in its heading: m⁴ is isotropic, m³ a profile. A contact.engineering table
        /// states it.
        Auto = "auto",
        /// Isotropic spectrum C(q) of the surface, in m⁴.
        Isotropic = "isotropic",
        /// Spectrum C1(q) of profiles, in m³; converted by Abel's inversion, for an isotropic surface.
        Profile = "profile",
        /// In m³ as C1(q), with the approximation C1 = q C/π (`two_pi`), which contact.engineering exports
        /// for maps.
        QOverPi = "q_over_pi",
    }
}
choice! {
    /// Normalization of a tabulated spectrum.
    SpectrumConvention {
        /// A contact.engineering table has `two_pi`; of any other table it must be stated.
        Auto = "auto",
        /// `∫ C d²q = h_rms²`, as in this program; of profiles `∫ C1 dq = h_rms²` over q of both signs.
        Plain = "plain",
        /// `∫ C d²q/(2π)² = h_rms²` (contact.engineering); of profiles `∫ C1 dq/(2π) = h_rms²` over both
        /// signs.
        TwoPi = "two_pi",
        /// C1 alone: `∫ C1 dq/(2π) = h_rms²` over positive q.
        OneSided = "one_sided",
    }
}
choice! {
    /// Sign of a compressive load in the file of a measured loop.
    Compression {
        /// The sign of the load at the load reversal, relative to that without contact.
        Auto = "auto",
        /// Compression is positive.
        Positive = "positive",
        /// Compression is negative.
        Negative = "negative",
    }
}
choice! {
    /// Baseline that is subtracted from the load of a measured loop.
    Baseline {
        /// Offset, slope along the displacement and drift, fitted to the points without contact at both ends.
        Line = "line",
        /// Offset alone.
        Offset = "offset",
        /// Nothing is subtracted.
        None = "none",
    }
}
choice! {
    /// Treatment of the missing points of a measured surface.
    Missing {
        /// Missing points are an error.
        Refuse = "refuse",
        /// Harmonic in-fill: the heights solve Laplace's equation.
        Fill = "fill",
    }
}
choice! {
    /// Low-pass filter (S-filter) of a measured surface.
    Filter {
        /// Gaussian filter of ISO 16610-61: half of the amplitude of the cut-off wavelength remains.
        Gaussian = "gaussian",
        /// Sharp cut-off: wavelengths up to the cut-off are removed, all others remain unchanged. It rings at
        /// steps.
        Sharp = "sharp",
    }
}
choice! {
    /// Form that is subtracted from the heights of a measured surface, by least squares.
    Detrend {
        /// The mean height.
        Mean = "mean",
        /// The least-squares plane.
        Plane = "plane",
        /// The least-squares surface of second order.
        Quadratic = "quadratic",
    }
}
choice! {
    /// Cause of the end of a measured spectrum at short wavelengths.
    SpectrumEnd {
        /// The density falls below the self-affine spectrum.
        Empty = "empty",
        /// A Gaussian filter damps the spectrum; the end is where it transmits half of the amplitude.
        GaussianFilter = "gaussian_filter",
        /// White noise exceeds the self-affine spectrum.
        WhiteNoise = "white_noise",
    }
}
choice! {
    /// Cause of the lower end of the band in which the spectrum of a scan is reliable.
    LowEnd {
        /// The longest wavelength of a periodic surface.
        Side = "side",
        /// Three modes of the side: levelling and the window change lower ones.
        Window = "window",
        /// The long cut-off of the spectrum.
        LongCut = "long_cut",
    }
}
choice! {
    /// Cause of the upper end of the band in which the spectrum of a scan is reliable.
    HighEnd {
        /// Four points per wavelength.
        Grid = "grid",
        /// The reliability cut-off of the tip.
        Tip = "tip",
        /// The cut-off of the S-filter that the heights have passed.
        Filter = "filter",
        /// The density falls below the self-affine spectrum.
        Empty = "empty",
        /// A Gaussian filter of the instrument damps the spectrum.
        GaussianFilter = "gaussian_filter",
        /// White noise adds to the spectrum.
        WhiteNoise = "white_noise",
    }
}
choice! {
    /// Direction of the scan lines of a measured surface.
    FastAxis {
        /// The direction with the larger offsets between lines, else rows.
        Auto = "auto",
        /// Each row of the file is a scan line.
        Rows = "rows",
        /// Each column of the file is a scan line.
        Columns = "columns",
    }
}
choice! {
    /// Method of a contact cycle.
    Method {
        /// Asperity model: interacting JKR asperities.
        Asperities = "asperities",
        /// Boundary elements: the rough surface on a grid, with adhesion at every point.
        BoundaryElements = "boundary_elements",
        /// The asperity model for separate contacts (`U_el/Δγ` ≥ 2, `U_1/Δγ` of the shortest octave ≥ 1, less
        /// than 0.3 of the area in contact) if it holds there, else boundary elements.
        Auto = "auto",
    }
}
choice! {
    /// Attraction between the surfaces of boundary elements.
    AttractionKind {
        /// JKR limit, range 0: contact forms where the surfaces touch and opens from its edges.
        Bonded = "bonded",
        /// Morse law with the range ρ at every point.
        Range = "range",
    }
}
choice! {
    /// Gap at which a point of boundary elements comes into contact.
    Nucleation {
        /// Zero gap, plain JKR.
        Touch = "touch",
        /// Wu's critical gap (Eq 3) at the median radius of the asperities.
        Wu = "wu",
    }
}
choice! {
    /// Rule for the opening of contact of boundary elements.
    Opening {
        /// From the edges of contacts, and inside where the tension exceeds `Δγ/ε`, with the interaction
        /// range ε.
        Strength = "strength",
        /// From the edges of contacts only.
        Edges = "edges",
        /// Inside contacts too, where the tension exceeds the maximum tension of the law on the grid.
        Anywhere = "anywhere",
    }
}
choice! {
    /// Law of the bonded attraction of boundary elements.
    FrontLaw {
        /// Law of a straight front, with contact on a spring.
        Plain = "plain",
        /// With smaller errors of first order in the grid spacing: hard contact, line tension of fronts,
        /// heights divided by the spectrum of the law.
        Corrected = "corrected",
    }
}
choice! {
    /// Elastic interaction between contact spots.
    Interaction {
        /// Displacement field of a JKR contact spot outside its contact (Eqs 6 and 7).
        Spots = "spots",
        /// Each contact spot acts as a point force at its centre. The model has an exact potential.
        Point = "point",
        /// No interaction: the Greenwood–Williamson model with JKR asperities.
        None = "none",
    }
}
choice! {
    /// Surroundings of the square.
    Boundary {
        /// Periodic images of the square, with a self-balanced load.
        Periodic = "periodic",
        /// A single patch on a half-space. Δ is measured from the undeformed half-space far away.
        Isolated = "isolated",
    }
}
choice! {
    /// Rule for contact spots that grow together.
    Coalescence {
        /// Equal-area merging (ICHA): touching contact spots become one spot of the same area.
        Merge = "merge",
        /// An asperity whose centre a larger contact spot reaches is absorbed and carries no load.
        Cover = "cover",
        /// No rule, as in the text of the paper.
        None = "none",
    }
}
choice! {
    /// When a free asperity jumps into contact.
    JumpIn {
        /// Wu's critical gap (Eq 3).
        Wu = "wu",
        /// Zero penetration, the criterion of plain JKR.
        Jkr = "jkr",
    }
}
choice! {
    /// Which steps of the table of contact spots are kept.
    KeptContacts {
        /// Every step.
        All = "all",
        /// The load reversals and, while unloading, the step of maximum tensile load. With asperities also
        /// the first steps at half of each load while loading, and at zero load while unloading.
        Turning = "turning",
        /// No step.
        None = "none",
    }
}
choice! {
    /// A slip of the paper that can be put back, to see what it changes.
    Slip {
        /// Eq 8 without the term `r²/(2R)` inside a contact spot.
        Eq8 = "eq8",
        /// Eq 9 with `sqrt(πΔγ/(E*a))` in place of `sqrt(πΔγ/(2E*a))`.
        Eq9 = "eq9",
        /// Eq A2 with the exponent as printed.
        A2 = "a2",
        /// `sqrt(m4/3t)` in place of `sqrt(m4/3)·t` below Eq A3.
        A3 = "a3",
    }
}

choice! {
    /// A result of a cycle whose mean can have a target precision.
    Goal {
        /// Dissipated energy Θ.
        Loss = "loss",
        /// Pull-off force F_po.
        PullOff = "pull_off_load",
        /// Contact area A at the load reversal.
        Area = "area_at_max_load",
    }
}

impl Method {
    /// Name of the method in a sentence.
    #[must_use]
    pub fn name(self) -> String {
        self.word().replace('_', " ")
    }
}

impl Slip {
    /// True if the contact model itself uses the equation. The others only enter the estimate of Deng and
    /// Kesari, so they do not change the cycle.
    #[must_use]
    pub fn in_contact(self) -> bool {
        matches!(self, Self::Eq8 | Self::Eq9)
    }
}

/// Uncorrected equations of the paper: one flag for each [`Slip`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Slips {
    /// [`Slip::Eq8`].
    pub eq8: bool,
    /// [`Slip::Eq9`].
    pub eq9: bool,
    /// [`Slip::A2`].
    pub a2: bool,
    /// [`Slip::A3`].
    pub a3: bool,
}

impl Slips {
    /// Every equation as it is right.
    pub const NONE: Self = Self { eq8: false, eq9: false, a2: false, a3: false };
}

impl FromIterator<Slip> for Slips {
    fn from_iter<T: IntoIterator<Item = Slip>>(list: T) -> Self {
        let mut slips = Self::NONE;
        for slip in list {
            match slip {
                Slip::Eq8 => slips.eq8 = true,
                Slip::Eq9 => slips.eq9 = true,
                Slip::A2 => slips.a2 = true,
                Slip::A3 => slips.a3 = true,
            }
        }
        slips
    }
}
