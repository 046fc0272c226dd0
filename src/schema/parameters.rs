//! Parameters of a case: column, symbol, axis label and value, each stated once.

use super::{Column, real, text};
use crate::model::{Attraction, CaseParams, Choice, ElementParams, ModelParams, SurfaceParams};
use ParameterValue::{Number, Word};

/// Value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValue {
    /// Number in the unit of the column.
    Number(f64),
    /// Word.
    Word(String),
}

/// Parameters of a case, with those that follow from its files.
#[derive(Debug, Clone)]
pub struct CaseFacts<'a> {
    /// Parameters of the spec.
    pub params: &'a CaseParams,
    /// Label of the file of a measured surface.
    pub surface_file: Option<String>,
    /// Side of the square \[m\].
    pub length_m: Option<f64>,
    /// Root-mean-square height: target of a generated surface, value of a measured one \[m\].
    pub rms_height_m: Option<f64>,
    /// Grid points of boundary elements along a side.
    pub element_points: Option<f64>,
    /// Range ρ of the Morse law \[m\].
    pub attraction_range_m: Option<f64>,
}

impl CaseFacts<'_> {
    fn measured(&self) -> Option<&SurfaceParams> {
        Some(&self.params.surface).filter(|surface| surface.is_measured())
    }

    fn generated(&self) -> Option<&SurfaceParams> {
        Some(&self.params.surface).filter(|surface| !surface.is_measured())
    }

    fn asperities(&self) -> Option<&ModelParams> {
        Some(&self.params.model).filter(|_| !self.params.by_elements())
    }

    fn elements(&self) -> Option<&ElementParams> {
        Some(&self.params.boundary_elements).filter(|_| self.params.by_elements())
    }

    fn bonded(&self) -> Option<&ElementParams> {
        self.elements().filter(|elements| elements.attraction == Attraction::Bonded)
    }

    /// Uncorrected equations in use, joined by `+`.
    fn errata(&self) -> String {
        self.params.model.as_printed.iter().map(|slip| slip.word()).collect::<Vec<_>>().join("+")
    }

    fn approach_step(&self) -> f64 {
        self.elements().map_or(self.params.cycle.approach_step, |elements| elements.approach_step)
    }
}

/// One parameter of a case.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Column of the tables over realizations.
    pub column: Column,
    /// Symbol; a word if there is none.
    pub symbol: &'static str,
    /// Label of an axis, with the markup of the figures.
    pub label: &'static str,
    /// Place in the labels of cases, from 0.
    pub rank: u8,
    /// True if only one of the methods reads it: it varies if it differs between cases of one method.
    pub of_method: bool,
    /// Value in a case; nothing if the case has none.
    pub get: fn(&CaseFacts<'_>) -> Option<ParameterValue>,
}

/// Number of parameters.
const COUNT: usize = 26;

/// Parameters that define a case, in the order of their columns.
pub static PARAMETERS: [Parameter; COUNT] = LIST;

/// Parameters in the order in which labels of cases name them.
#[must_use]
pub fn parameters_by_rank() -> [&'static Parameter; COUNT] {
    let mut ranked = PARAMETERS.each_ref();
    ranked.sort_by_key(|parameter| parameter.rank);
    ranked
}

/// Columns of the parameters.
pub(super) const PARAMETER_COLUMNS: [Column; COUNT] = {
    let mut columns = [text("", ""); COUNT];
    let mut at = 0;
    while at < COUNT {
        columns[at] = LIST[at].column;
        at += 1;
    }
    columns
};

fn word(choice: impl Choice) -> ParameterValue {
    Word(choice.word().to_owned())
}

const LIST: [Parameter; COUNT] = [
    Parameter {
        column: text("surface_file", "File of a measured surface, with enough of its path to be unique; null for a generated surface").or_null(),
        symbol: "surface",
        label: "surface",
        rank: 0,
        of_method: false,
        get: |case| case.surface_file.clone().map(Word),
    },
    Parameter {
        column: text("surface_dataset", "Dataset in that file; null for the only one, and for a generated surface").or_null(),
        symbol: "dataset",
        label: "dataset",
        rank: 1,
        of_method: false,
        get: |case| case.measured().map(|surface| &surface.dataset).filter(|name| !name.is_empty()).cloned().map(Word),
    },
    Parameter {
        column: text("detrend", "Levelling of a measured surface: \"mean\", \"plane\" or \"quadratic\" was subtracted; null for a generated surface")
        .or_null(),
        symbol: "detrend",
        label: "levelling",
        rank: 2,
        of_method: false,
        get: |case| case.measured().map(|surface| word(surface.detrend)),
    },
    Parameter {
        column: real("hurst", "1", "Hurst exponent H; null for a measured surface").or_null().from("Eq 10"),
        symbol: "H",
        label: "Hurst exponent H",
        rank: 4,
        of_method: false,
        get: |case| case.generated().map(|surface| Number(surface.hurst)),
    },
    Parameter {
        column: real("magnification", "1", "Magnification ζ, longest over shortest wavelength; null for a measured surface").or_null().from("Eq 10"),
        symbol: "ζ",
        label: "magnification ζ",
        rank: 3,
        of_method: false,
        get: |case| case.generated().map(|surface| Number(surface.magnification.into())),
    },
    Parameter {
        column: real("length_m", "m", "Side L of the square; null for a measured surface whose import failed").or_null().from("Eq 10"),
        symbol: "L",
        label: "L [m]",
        rank: 6,
        of_method: false,
        get: |case| case.length_m.map(Number),
    },
    Parameter {
        column: real(
        "rms_height_m",
        "m",
        "Rms height h_rms: target of a generated surface, or value of a measured one; null for a measured surface whose import failed",
    )
    .or_null(),
        symbol: "h",
        label: "h_{rms} [m]",
        rank: 5,
        of_method: false,
        get: |case| case.rms_height_m.map(Number),
    },
    Parameter {
        column: real(
        "points_per_shortest_wavelength",
        "1",
        "Grid points per shortest wavelength; for a measured surface, the S-filter cut-off in pixels",
    )
    .or_null(),
        symbol: "n",
        label: "points per shortest wavelength",
        rank: 7,
        of_method: false,
        get: |case| Some(Number(case.params.surface.points_per_shortest_wavelength.into())),
    },
    Parameter {
        column: text(
        "normalization",
        "Rule for the rms height: \"sample\" (heights rescaled) or \"spectrum\" (integral of the spectrum); null for a measured surface",
    )
    .or_null(),
        symbol: "normalization",
        label: "normalization",
        rank: 23,
        of_method: false,
        get: |case| case.generated().map(|surface| word(surface.normalization)),
    },
    Parameter {
        column: text("amplitudes", "Fourier amplitudes: \"fixed\" or \"gaussian\"; null for a measured surface").or_null(),
        symbol: "amplitudes",
        label: "amplitudes",
        rank: 24,
        of_method: false,
        get: |case| case.generated().map(|surface| word(surface.amplitudes)),
    },
    Parameter {
        column: real("contact_modulus_pa", "Pa", "Reduced modulus E*, 1/E* = sum of (1 - ν²)/E over both bodies").from("Eq 1"),
        symbol: "E*",
        label: "E^{*} [Pa]",
        rank: 8,
        of_method: false,
        get: |case| Some(Number(case.params.material.contact_modulus_pa)),
    },
    Parameter {
        column: real("work_of_adhesion_j_m2", "J/m^2", "Work of adhesion Δγ").from("Eq 1"),
        symbol: "Δγ",
        label: "Δγ [J/m^{2}]",
        rank: 9,
        of_method: false,
        get: |case| Some(Number(case.params.material.work_of_adhesion_j_m2)),
    },
    Parameter {
        column: real("interaction_range_m", "m", "Range of attraction ε").from("Eq 3"),
        symbol: "ε",
        label: "ε [m]",
        rank: 10,
        of_method: false,
        get: |case| Some(Number(case.params.material.interaction_range_m)),
    },
    Parameter {
        column: text(
        "interaction",
        "Elastic interaction between contacts: \"spots\", \"point\", \"reciprocal\" or \"none\"; null for boundary elements",
    )
    .or_null()
    .from("Eqs 6-8"),
        symbol: "interaction",
        label: "interaction",
        rank: 19,
        of_method: true,
        get: |case| case.asperities().map(|model| word(model.interaction)),
    },
    Parameter {
        column: text("boundary", "Boundary condition of the square: \"periodic\" or \"isolated\""),
        symbol: "boundary",
        label: "boundary",
        rank: 20,
        of_method: true,
        get: |case| Some(word(case.params.model.boundary)),
    },
    Parameter {
        column: text("coalescence", "Coalescence rule: \"cover\" (absorption), \"merge\" (equal-area merging) or \"none\"; null for boundary elements")
        .or_null()
        .from("Eq 8"),
        symbol: "coalescence",
        label: "coalescence",
        rank: 21,
        of_method: true,
        get: |case| case.asperities().map(|model| word(model.coalescence)),
    },
    Parameter {
        column: text(
        "jump_in",
        "Criterion for jump into contact: \"wu\" (at Wu's jump-in distance) or \"jkr\" (at zero penetration); null for boundary elements",
    )
    .or_null()
    .from("Eq 3"),
        symbol: "jump_in",
        label: "jump-in criterion",
        rank: 22,
        of_method: true,
        get: |case| case.asperities().map(|model| word(model.jump_in)),
    },
    Parameter {
        column: text("as_printed", "Uncorrected equations of the paper that are in use, joined by +; empty if none"),
        symbol: "as_printed",
        label: "uncorrected equations",
        rank: 25,
        of_method: false,
        get: |case| Some(Word(case.errata())),
    },
    Parameter {
        column: real(
        "approach_step",
        "1",
        "Maximum output step of the mean penetration, over h_rms; of boundary elements, step of the mean penetration",
    ),
        symbol: "step",
        label: "output step/h_{rms}",
        rank: 11,
        of_method: true,
        get: |case| Some(Number(case.approach_step())),
    },
    Parameter {
        column: text("method", "Method: \"asperities\" or \"boundary_elements\""),
        symbol: "method",
        label: "method",
        rank: 12,
        of_method: false,
        get: |case| Some(word(case.params.model.method)),
    },
    Parameter {
        column: real("element_points", "1", "Grid points of boundary elements along a side; null for asperities").or_null(),
        symbol: "N",
        label: "grid points along a side",
        rank: 13,
        of_method: true,
        get: |case| case.element_points.map(Number),
    },
    Parameter {
        column: text("attraction", "Attraction of boundary elements: \"bonded\" (JKR limit) or \"range\" (Morse); null for asperities").or_null(),
        symbol: "attraction",
        label: "attraction",
        rank: 14,
        of_method: true,
        get: |case| case.elements().map(|elements| word(elements.attraction)),
    },
    Parameter {
        column: real("attraction_range_m", "m", "Range ρ of the Morse law; null without one").or_null(),
        symbol: "ρ",
        label: "ρ [m]",
        rank: 15,
        of_method: true,
        get: |case| case.attraction_range_m.map(Number),
    },
    Parameter {
        column: text(
        "nucleation",
        "Gap at which a point of boundary elements comes into contact: \"touch\" or \"wu\"; null for asperities and with a range",
    )
    .or_null(),
        symbol: "nucleation",
        label: "nucleation",
        rank: 16,
        of_method: true,
        get: |case| case.bonded().map(|elements| word(elements.nucleation)),
    },
    Parameter {
        column: text(
        "opening",
        "Where contact of boundary elements opens: \"strength\", \"edges\" or \"anywhere\"; null for asperities and with a range",
    )
    .or_null(),
        symbol: "opening",
        label: "opening",
        rank: 17,
        of_method: true,
        get: |case| case.bonded().map(|elements| word(elements.opening)),
    },
    Parameter {
        column: real("precision", "1", "Tolerance of an equilibrium of boundary elements: rms residual over the maximum tension; null for asperities")
        .or_null(),
        symbol: "precision",
        label: "precision",
        rank: 18,
        of_method: true,
        get: |case| case.elements().map(|elements| Number(elements.precision)),
    },
];
