//! What a case is made of: the material, and every choice that the model leaves open, by name.
//!
//! These types belong to no room: the spec fills them, the physics reads them, the keys hash them. They compute nothing.

use serde::{Deserialize, Serialize};

/// The elastic half-space and its adhesion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Contact modulus E* \[Pa\]: `1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂`.
    pub contact_modulus_pa: f64,
    /// Work of adhesion Δγ \[J/m²\].
    pub work_of_adhesion_j_m2: f64,
    /// Range of attraction ε \[m\]; it enters the Tabor parameter and Wu's jump-in distance only.
    pub interaction_range_m: f64,
}

impl Material {
    /// `1/(πE*)` \[1/Pa\]: what a point load displaces at a distance, over load and inverse distance.
    #[must_use]
    pub fn compliance(&self) -> f64 {
        1.0 / (std::f64::consts::PI * self.contact_modulus_pa)
    }

    /// `sqrt(2πΔγ/E*)` \[m^½\]: times the root of its radius, what adhesion draws a spot up (Eq 2).
    #[must_use]
    pub fn pull(&self) -> f64 {
        (2.0 * std::f64::consts::PI * self.work_of_adhesion_j_m2 / self.contact_modulus_pa).sqrt()
    }
}

/// A choice that a spec makes by a word.
pub trait Choice: Copy + PartialEq + Sized + 'static {
    /// Every value with its word, in the order in which they are shown.
    const WORDS: &'static [(&'static str, Self)];

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
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $word:literal),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum $name { $($(#[$variant_doc])* #[serde(rename = $word)] $variant),+ }

        impl Choice for $name {
            const WORDS: &'static [(&'static str, Self)] = &[$(($word, Self::$variant)),+];
        }
    };
}

choice! {
    /// How a surface gets its rms height.
    Normalization {
        /// The realised surface is scaled to the rms height exactly.
        Sample = "sample",
        /// The spectrum's integral is the mean square height; what a realisation has differs.
        Spectrum = "spectrum",
    }
}
choice! {
    /// The moduli of the Fourier modes.
    Amplitudes {
        /// `sqrt(C)`: only the phases are random, as in the paper.
        Fixed = "fixed",
        /// Rayleigh-distributed moduli: a Gaussian surface.
        Gaussian = "gaussian",
    }
}
choice! {
    /// What becomes of the missing points of a measured surface.
    Missing {
        /// A surface with missing points is refused.
        Refuse = "refuse",
        /// The heights around them are continued, as a membrane is.
        Fill = "fill",
    }
}
choice! {
    /// What is taken off the heights of a measured surface, by least squares.
    Detrend {
        /// Their mean.
        Mean = "mean",
        /// A plane: the tilt of the sample.
        Plane = "plane",
        /// A surface of second order: tilt and bow.
        Quadratic = "quadratic",
    }
}
choice! {
    /// How contact spots act on one another.
    Interaction {
        /// The displacement field of a JKR spot outside its contact (Eqs 6 and 7).
        Spots = "spots",
        /// Each spot acts as its load at its centre: the model has an exact potential.
        Point = "point",
        /// The mean of a spot's field where another is, and of that one's as a punch in return: one mutual energy for each pair, so an exact potential.
        Reciprocal = "reciprocal",
        /// No interaction: Greenwood and Williamson with JKR.
        None = "none",
    }
}
choice! {
    /// What surrounds the square.
    Boundary {
        /// Its own periodic images, with a self-balanced load.
        Periodic = "periodic",
        /// Nothing: a single patch on a half-space. The approach is measured from where the half-space lies far away, at rest.
        Isolated = "isolated",
    }
}
choice! {
    /// What happens when a spot grows over the centre of another asperity.
    Coalescence {
        /// The smaller one is covered: it rides with the greater spot and carries nothing.
        Cover = "cover",
        /// Touching spots become one of the same area.
        Merge = "merge",
        /// Nothing happens, as the paper's text has it.
        None = "none",
    }
}
choice! {
    /// When a free asperity jumps into contact.
    JumpIn {
        /// Wu's critical gap (Eq 3).
        Wu = "wu",
        /// At zero penetration, the rule of plain JKR.
        Jkr = "jkr",
    }
}
choice! {
    /// Which steps of the table of contact spots are kept.
    KeptContacts {
        /// Every step.
        All = "all",
        /// The turning points; and on the way the first steps at half their load, back at none, and the one of the greatest tension.
        Turning = "turning",
        /// None.
        None = "none",
    }
}
choice! {
    /// A slip of the paper that can be put back, to see what it changes.
    Slip {
        /// Eq 8 without the `r²/(2R)` inside a spot.
        Eq8 = "eq8",
        /// Eq 9 with `sqrt(πΔγ/(E*a))` for `sqrt(πΔγ/(2E*a))`.
        Eq9 = "eq9",
        /// Eq A2 with the exponent as printed.
        A2 = "a2",
        /// `sqrt(m4/3t)` for `sqrt(m4/3)·t` below Eq A3.
        A3 = "a3",
    }
}

choice! {
    /// A result of a cycle whose mean can be asked for to a given precision.
    Goal {
        /// The energy lost, Θ.
        Loss = "loss",
        /// The greatest tension on unloading.
        PullOff = "pull_off_load",
        /// The area of contact at the turning point.
        Area = "area_at_max_load",
    }
}

impl Slip {
    /// Whether the contact itself reads it. The others only enter Deng and Kesari's estimate beside it, so they make no other cycle.
    #[must_use]
    pub fn in_contact(self) -> bool {
        matches!(self, Self::Eq8 | Self::Eq9)
    }
}

/// Which slips of the paper are put back: one flag to each [`Slip`].
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
