//! Parameters of a case, each stated once.

use super::parameter::ParameterValue::{self, Number, Word};
use super::parameter::{CaseFacts, Parameter, parameter};
use super::{Column, real, text};
use crate::model::{Choice, GeneratedSurface};

/// Number of parameters.
const COUNT: usize = 45;

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

/// The generated surface of a power law.
fn power_law<'a>(case: &CaseFacts<'a>) -> Option<&'a GeneratedSurface> {
    case.params.surface.generated().filter(|surface| !surface.is_tabulated())
}

fn word(choice: impl Choice) -> ParameterValue {
    Word(choice.word().to_owned())
}

const LIST: [Parameter; COUNT] = [
    parameter(
        text(
            "surface_file",
            "File of a measured surface, with enough of its path to be unique; null for a \
             generated surface",
        )
        .or_null(),
        ["surface", "surface"],
        0,
        |case| case.surface_file.clone().filter(|_| case.params.surface.measured().is_some()).map(Word),
    ),
    parameter(
        text("surface_dataset", "Dataset in that file; null for the only one, and for a generated surface")
            .or_null(),
        ["dataset", "dataset"],
        1,
        |case| {
            case.params
                .surface
                .measured()
                .map(|surface| &surface.dataset)
                .filter(|name| !name.is_empty())
                .cloned()
                .map(Word)
        },
    ),
    parameter(
        text(
            "detrend",
            "Levelling of a measured surface: \"mean\", \"plane\" or \"quadratic\" was subtracted; null for \
             a generated surface",
        )
        .or_null(),
        ["detrend", "levelling"],
        2,
        |case| case.params.surface.measured().map(|surface| word(surface.detrend)),
    ),
    parameter(
        text(
            "filter",
            "Low-pass filter (S-filter) of a measured surface: \"gaussian\" or \"sharp\"; null \
             for a generated surface",
        )
        .or_null(),
        ["S-filter", "S-filter"],
        2,
        |case| case.params.surface.measured().map(|surface| word(surface.filter)),
    ),
    parameter(
        text(
            "outliers",
            "Outliers of a measured surface: \"replaced\" or \"kept\"; null for a generated \
             surface",
        )
        .or_null(),
        ["outliers", "outliers"],
        27,
        |case| {
            case.params
                .surface
                .measured()
                .map(|surface| Word(if surface.outliers { "replaced" } else { "kept" }.to_owned()))
        },
    ),
    parameter(
        text(
            "align_rows",
            "Scan lines of a measured surface whose offsets were removed: \"rows\", \"columns\" or \"auto\"; \
             \"none\" without alignment; null for a generated surface",
        )
        .or_null(),
        ["align_rows", "alignment of scan lines"],
        28,
        |case| {
            case.params.surface.measured().map(|surface| {
                if surface.align_rows { word(surface.fast_axis) } else { Word("none".to_owned()) }
            })
        },
    ),
    parameter(
        real(
            "tip_radius_m",
            "m",
            "Radius R_tip of the tip that measured the surface; null for a generated \
             surface and without one",
        )
        .or_null(),
        ["R_tip", "R_{tip} [m]"],
        29,
        |case| {
            case.params
                .surface
                .measured()
                .map(|surface| surface.tip_radius_m)
                .filter(|radius| *radius > 0.0)
                .map(Number)
        },
    ),
    parameter(
        real("hurst", "1", "Hurst exponent H; null for a measured surface").or_null().from("Eq 10"),
        ["H", "Hurst exponent H"],
        4,
        |case| power_law(case).map(|surface| Number(surface.hurst)),
    ),
    parameter(
        real(
            "magnification",
            "1",
            "Magnification ζ, longest over shortest wavelength; null for a measured surface",
        )
        .or_null()
        .from("Eq 10"),
        ["ζ", "magnification ζ"],
        3,
        |case| case.params.surface.generated().map(|surface| Number(surface.magnification.into())),
    ),
    parameter(
        real("length_m", "m", "Side L of the square; null for a measured surface whose import failed")
            .or_null()
            .from("Eq 10"),
        ["L", "L [m]"],
        6,
        |case| case.length_m.map(Number),
    ),
    parameter(
        real(
            "rms_height_m",
            "m",
            "Rms height h_rms: target of a generated surface, or value of a measured one; null for a \
             measured surface whose import failed",
        )
        .or_null(),
        ["h", "h_{rms} [m]"],
        5,
        |case| case.rms_height_m.map(Number),
    ),
    parameter(
        real(
            "points_per_shortest_wavelength",
            "1",
            "Grid points per shortest wavelength; for a measured surface, the S-filter cut-off in pixels",
        )
        .or_null(),
        ["n", "points per shortest wavelength"],
        7,
        |case| Some(Number(case.params.surface.points_per_shortest_wavelength().into())),
    ),
    parameter(
        text(
            "normalization",
            "Rule for the rms height: \"sample\" (heights rescaled) or \"spectrum\" (integral of the \
             spectrum); null for a measured surface",
        )
        .or_null(),
        ["normalization", "normalization"],
        23,
        |case| case.params.surface.generated().map(|surface| word(surface.normalization)),
    ),
    parameter(
        text("amplitudes", "Fourier amplitudes: \"fixed\" or \"gaussian\"; null for a measured surface")
            .or_null(),
        ["amplitudes", "amplitudes"],
        24,
        |case| case.params.surface.generated().map(|surface| word(surface.amplitudes)),
    ),
    parameter(
        real("contact_modulus_pa", "Pa", "Reduced modulus E*, 1/E* = sum of (1 - ν²)/E over both bodies")
            .from("Eq 1"),
        ["E*", "E^{*} [Pa]"],
        8,
        |case| Some(Number(case.params.material.contact_modulus_pa)),
    ),
    parameter(
        real("work_of_adhesion_j_m2", "J/m^2", "Work of adhesion Δγ").from("Eq 1"),
        ["Δγ", "Δγ [J/m^{2}]"],
        9,
        |case| Some(Number(case.params.material.work_of_adhesion_j_m2)),
    ),
    parameter(
        real("interaction_range_m", "m", "Range of attraction ε").from("Eq 3"),
        ["ε", "ε [m]"],
        10,
        |case| Some(Number(case.params.material.interaction_range_m)),
    ),
    parameter(
        text(
            "interaction",
            "Elastic interaction between contacts: \"spots\", \"point\" or \"none\"; null for boundary \
             elements",
        )
        .or_null()
        .from("Eqs 6-8"),
        ["interaction", "interaction"],
        19,
        |case| case.params.asperities().map(|model| word(model.interaction)),
    )
    .of_method(),
    parameter(
        text(
            "boundary",
            "Boundary condition of the square: \"periodic\" or \"isolated\"; of boundary elements always \
             \"periodic\": unless on a probe, mirror images continue a scan that is not periodic",
        ),
        ["boundary", "boundary"],
        20,
        |case| Some(word(case.params.boundary())),
    )
    .of_method(),
    parameter(
        text(
            "coalescence",
            "Coalescence rule: \"cover\" (absorption), \"merge\" (equal-area merging) or \"none\"; null for \
             boundary elements",
        )
        .or_null()
        .from("Eq 8"),
        ["coalescence", "coalescence"],
        21,
        |case| case.params.asperities().map(|model| word(model.coalescence)),
    )
    .of_method(),
    parameter(
        text(
            "jump_in",
            "Criterion for jump into contact: \"wu\" (at Wu's jump-in distance) or \"jkr\" (at zero \
             penetration); null for boundary elements",
        )
        .or_null()
        .from("Eq 3"),
        ["jump_in", "jump-in criterion"],
        22,
        |case| case.params.asperities().map(|model| word(model.jump_in)),
    )
    .of_method(),
    parameter(
        text("as_printed", "Uncorrected equations of the paper that are in use, joined by +; empty if none"),
        ["as_printed", "uncorrected equations"],
        25,
        |case| {
            Some(Word(case.params.as_printed.iter().map(|slip| slip.word()).collect::<Vec<_>>().join("+")))
        },
    ),
    parameter(
        real(
            "approach_step",
            "1",
            "Maximum output step of the mean penetration, over h_rms; of boundary elements, step of the mean \
             penetration",
        ),
        ["step", "output step/h_{rms}"],
        11,
        |case| Some(Number(case.params.method.approach_step())),
    )
    .of_method(),
    parameter(
        text("method", "Method: \"asperities\" or \"boundary_elements\""),
        ["method", "method"],
        12,
        |case| Some(word(case.params.method.kind())),
    ),
    parameter(
        real("element_points", "1", "Grid points of boundary elements along a side; null for asperities")
            .or_null(),
        ["N", "grid points along a side"],
        13,
        |case| case.element_points.map(Number),
    )
    .of_method(),
    parameter(
        text(
            "attraction",
            "Attraction of boundary elements: \"bonded\" (JKR limit) or \"range\" (Morse); null for \
             asperities",
        )
        .or_null(),
        ["attraction", "attraction"],
        14,
        |case| case.params.elements().map(|elements| word(elements.attraction.kind())),
    )
    .of_method(),
    parameter(
        real("attraction_range_m", "m", "Range ρ of the Morse law; null without one").or_null(),
        ["ρ", "ρ [m]"],
        15,
        |case| case.attraction_range_m.map(Number),
    )
    .of_method(),
    parameter(
        text(
            "nucleation",
            "Gap at which a point of boundary elements comes into contact: \"touch\" or \"wu\"; null for \
             asperities and with a range",
        )
        .or_null(),
        ["nucleation", "nucleation"],
        16,
        |case| case.params.elements()?.attraction.bonded().map(|bonded| word(bonded.0)),
    )
    .of_method(),
    parameter(
        text(
            "opening",
            "Where contact of boundary elements opens: \"strength\", \"edges\" or \"anywhere\"; null for \
             asperities and with a range",
        )
        .or_null(),
        ["opening", "opening"],
        17,
        |case| case.params.elements()?.attraction.bonded().map(|bonded| word(bonded.1)),
    )
    .of_method(),
    parameter(
        text(
            "front_law",
            "Law of the edges of contact of boundary elements: \"plain\" or \"corrected\"; null for \
             asperities and with a range",
        )
        .or_null(),
        ["law", "law"],
        43,
        |case| case.params.elements()?.attraction.law().map(word),
    )
    .of_method(),
    parameter(
        real(
            "halvings",
            "1",
            "Most halvings of a step of boundary elements that has an event; null for \
             asperities",
        )
        .or_null(),
        ["halvings", "halvings of a step"],
        26,
        |case| case.params.elements().map(|elements| Number(f64::from(elements.halvings))),
    )
    .of_method(),
    parameter(
        real(
            "precision",
            "1",
            "Tolerance of an equilibrium of boundary elements: rms residual over the maximum tension; null \
             for asperities",
        )
        .or_null(),
        ["precision", "precision"],
        18,
        |case| case.params.elements().map(|elements| Number(elements.precision)),
    )
    .of_method(),
    parameter(
        real("probe_radius_m", "m", "Radius R of the spherical probe; null for a flat surface").or_null(),
        ["R", "R [m]"],
        30,
        |case| case.params.probe.map(|probe| Number(probe.radius_m)),
    ),
    parameter(
        real("machine_compliance_m_n", "m/N", "Compliance c of the machine; 0 for a stiff one"),
        ["c", "c [m/N]"],
        31,
        |case| Some(Number(case.params.machine.compliance_m_n)),
    ),
    parameter(
        text(
            "far_field",
            "Elastic body at a distance from the contact: \"cell\" (periodic images) or \"half_space\" (one \
             contact)",
        ),
        ["far field", "far field"],
        32,
        |case| Some(word(case.params.machine.far_field)),
    ),
    parameter(
        text("control", "Quantity that the machine controls: \"displacement\" or \"load\""),
        ["control", "control"],
        33,
        |case| Some(word(case.params.machine.control)),
    ),
    parameter(
        real("layer_thickness_m", "m", "Thickness h of the layer on a rigid base; null for a half-space")
            .or_null(),
        ["t", "layer thickness [m]"],
        34,
        |case| case.params.substrate.map(|layer| Number(layer.thickness_m)),
    ),
    parameter(
        real("poisson_ratio", "1", "Poisson's ratio ν of the layer; null for a half-space").or_null(),
        ["ν", "Poisson's ratio ν"],
        35,
        |case| case.params.substrate.map(|layer| Number(layer.poisson_ratio)),
    )
    .of_method(),
    parameter(
        text(
            "spectrum_file",
            "File of a tabulated spectrum, with enough of its path to be unique; null without one",
        )
        .or_null(),
        ["spectrum", "spectrum"],
        36,
        |case| case.surface_file.clone().filter(|_| case.params.surface.generated().is_some()).map(Word),
    ),
    parameter(
        text(
            "spectrum_reading",
            "Quantity, convention and conversion of a tabulated spectrum to ∫ C d²q = h_rms²; null without \
             one",
        )
        .or_null(),
        ["reading", "reading of the spectrum"],
        37,
        |case| {
            let surface = case.params.surface.generated()?;
            Some(surface.tabulated.reading.clone()).filter(|reading| !reading.is_empty()).map(Word)
        },
    ),
    parameter(
        real("longest_wavelength_m", "m", "Longest wavelength of a generated surface; null for the side L")
            .or_null(),
        ["λ_long", "λ_{long} [m]"],
        38,
        |case| case.params.surface.generated()?.longest_wavelength_m.map(Number),
    ),
    parameter(
        real("roll_off_m", "m", "Roll-off wavelength λ_r of a generated surface; null without one").or_null(),
        ["λ_r", "λ_{r} [m]"],
        39,
        |case| case.params.surface.generated()?.roll_off_m.map(Number),
    ),
    parameter(
        real(
            "aspect_ratio",
            "1",
            "Aspect ratio r of a generated surface: wavelengths along the lay over those across it; null for \
             a measured surface",
        )
        .or_null(),
        ["r", "aspect ratio"],
        40,
        |case| case.params.surface.generated().map(|surface| Number(surface.aspect_ratio)),
    ),
    parameter(
        real(
            "angle_deg",
            "deg",
            "Direction of the lay of a generated surface, from the x axis towards the y axis; null for an \
             isotropic one",
        )
        .or_null(),
        ["angle", "angle of the lay [°]"],
        41,
        |case| {
            let surface = case.params.surface.generated()?;
            (surface.aspect_ratio > 1.0).then_some(Number(surface.angle_deg))
        },
    )
    .of_method(),
    parameter(
        real(
            "left_out_ratio",
            "1",
            "U_el/Δγ of the wavelengths of a tabulated spectrum below the shortest one: up to 0.05, cycles \
             have the work of adhesion Δγ - U_el; null without a table or adhesion",
        )
        .or_null()
        .from("Persson and Tosatti 2001"),
        ["U_<", "U_{el}/Δγ below the shortest wavelength"],
        42,
        |case| case.params.left_out_ratio().map(Number),
    ),
];
