//! Warnings of the rows of the table `cases`: codes, limits and conditions.

use super::rows::Value;
use super::{CaseInput, Given};
use crate::model::{BRIDGED, LARGE_AREA, SEPARATE, SPHERE_SHARE};

/// A warning that a row of the table `cases` may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Caution {
    /// Its code in the column `caution`.
    pub code: &'static str,
    /// Short name.
    pub label: &'static str,
    /// Statement of the measured value, which replaces `{}`.
    pub text: &'static str,
    /// Consequence for the results.
    pub consequence: &'static str,
    /// Recommended action.
    pub action: &'static str,
}

const fn warning(
    code: &'static str,
    label: &'static str,
    text: &'static str,
    consequence: &'static str,
    action: &'static str,
) -> Caution {
    Caution { code, label, text, consequence, action }
}

/// All warnings by severity, which is the order of their codes in the column `caution`: results outside the
/// model, then results that depend on a rule of the model, then incomplete or inaccurate results, then small
/// samples.
pub const CAUTIONS: [Caution; 29] = [
    warning(
        "sticky",
        "near full contact",
        "U_el/Δγ = {}",
        "The true contact may be near full contact, outside the range of an asperity model.",
        "Set `model.method` to `\"boundary_elements\"` or `\"auto\"`.",
    ),
    warning(
        "area",
        "large contact area",
        "A/A₀ = {}",
        "The asperity model is outside its range and underestimates the area.",
        "Reduce `max_load`.",
    ),
    warning(
        "conformed",
        "conformal contact",
        "U_el/Δγ of the shortest octave = {}",
        "The half-space conforms to the shortest wavelengths, so results depend on ζ.",
        "Use a smaller ζ, or a larger S-filter cut-off.",
    ),
    warning(
        "covered",
        "coalescence",
        "{} of asperities are absorbed by larger contacts",
        "The contact area depends on the coalescence rule.",
        "Compare `coalescence = \"cover\"` and `\"merge\"`.",
    ),
    warning(
        "absorption",
        "energy of coalescence",
        "absorption and merging, net of their reversal, are {} of Θ",
        "This part of Θ is an artefact of the coalescence rule.",
        "Compare `coalescence = \"cover\"` and `\"merge\"`; quote the difference.",
    ),
    warning(
        "touching",
        "overlap",
        "{} of contact spots overlap a neighbour",
        "Area and pull-off force are outside the validated range.",
        "Use a smaller `max_load`, or `coalescence = \"merge\"`, which merges overlapping contacts.",
    ),
    warning(
        "tabor",
        "low Tabor parameter",
        "minimum Tabor parameter μ = {}",
        "Wu's criterion for jump into contact is invalid.",
        "Use `jump_in = \"jkr\"`, or a smaller `interaction_range_m`.",
    ),
    warning(
        "overshoot",
        "filter overshoot",
        "filtered heights exceed the measured heights nearby by {} of the rms height, beyond the noise",
        "The sharp low-pass filter rings at steps, so the highest asperities do not exist on the measured \
         surface.",
        "Use `surface.filter = \"gaussian\"`, and `hysteron import --filter gaussian` for an imported file.",
    ),
    warning(
        "coarse",
        "coarse grid",
        "boundary elements have {} grid points per shortest wavelength (12 per JKR radius of a probe count \
         as 16)",
        "Dissipated energy and pull-off force depend on the grid.",
        "Increase `boundary_elements.points`; a list of grids estimates the error.",
    ),
    warning(
        "full_contact",
        "full contact",
        "A/A₀ = {} at F_max",
        "F_po follows from the strength Δγ/ε, the range ε of `interaction_range_m`, and not from the \
         roughness.",
        "Reduce `max_load` below full contact, or quote F_po with ε.",
    ),
    warning(
        "extent",
        "large contact of the probe",
        "contact reaches {} of the side from the apex of the probe",
        "Beyond 0.3 of the side the surface is not that of the sphere.",
        "Use a larger square (`surface.length_m`), a smaller load or a smaller probe.",
    ),
    warning(
        "coarse_steps",
        "long steps",
        "shortest step of boundary elements Δ/h_rms = {} (limit 0.05)",
        "Events are not located: Θ and F_po may be wrong by 4 to 25 %.",
        "Reduce `boundary_elements.approach_step`, or increase `boundary_elements.halvings`.",
    ),
    warning(
        "texture",
        "anisotropic texture",
        "texture aspect ratio = {}",
        "Asperities are not spheres, and expected ratios, Θ_DK and Nayak's density hold for isotropic \
         surfaces only.",
        "Use `method = \"boundary_elements\"`; quote the loop only.",
    ),
    warning(
        "left_out",
        "roughness below the shortest wavelength",
        "U_el/Δγ of the wavelengths of the table below the shortest one is above 5 %",
        "They are left out: the adhesion of the simulated surface is too strong.",
        "Use a larger `magnification`, so that more of the table is simulated.",
    ),
    warning(
        "outliers",
        "outliers of the scan",
        "{} of the points of the scan are isolated spikes or dips beyond 6 robust standard deviations of \
         their neighbours",
        "Each one makes an asperity or a pit, raises h_rms and lowers the contact area.",
        "Replace them with `surface.outliers = true` (`--outliers`), or check that they are real.",
    ),
    warning(
        "lines",
        "offsets of scan lines",
        "rms offset between scan lines, over h_rms = {}",
        "The offsets add ridges along the lines and raise the rms slope and the pull-off force.",
        "Remove them with `surface.align_rows = true` (`--align-rows`).",
    ),
    warning(
        "noise",
        "noise of the scan",
        "rms height removed by the S-filter, with the spectrum of noise, over h_rms = {}",
        "Noise above the S-filter cut-off remains in the surface and sharpens its asperities.",
        "Use a larger cut-off (`points_per_shortest_wavelength`, `--points`), or a scan with less noise.",
    ),
    warning(
        "tip",
        "rounded by a tip",
        "curvature of the sharpest summits over that of the sharpest valleys = {}",
        "The scan looks as if a blunt tip had traced it: asperities are too round, and the pull-off force is \
         too large.",
        "State the tip radius with `surface.tip_radius_m` (`--tip-radius`), which removes unreliable \
         wavelengths, or use a sharper tip.",
    ),
    warning(
        "failed",
        "failed",
        "{} failed",
        "Failures depend on the surface, so the means may be biased.",
        "Read the reasons with `hysteron status`.",
    ),
    warning(
        "not_reached",
        "load not reached",
        "{} have no result at a load reversal",
        "The means are of the realizations that reached it.",
        "Read the reasons in the column `failure` of the table `cycles`, and reduce `max_load` or follow \
         their help.",
    ),
    warning(
        "incomplete",
        "incomplete",
        "{} realizations finished",
        "The means are of the finished realizations only.",
        "Rerun the spec with `hysteron run`.",
    ),
    warning(
        GRID_ERROR,
        "grid error too large",
        "grid error of Θ {}, above the requested `boundary_elements.error`",
        "The mean dissipated energy depends on the grid by more than requested.",
        "Increase `boundary_elements.max_points`, or accept the larger error.",
    ),
    warning(
        "unconverged",
        "not converged",
        "output steps with a residual above the tolerance",
        "These steps are not in equilibrium to the tolerance.",
        "Check `residual_m` in the table `steps`, or reduce `max_load`.",
    ),
    warning(
        "unresolved",
        "energy not resolved",
        "resolution of Θ is {} of its magnitude",
        "A negative Θ and its Θ/Θ_DK are null, and the means are of the other loops.",
        "Do not quote Θ; boundary elements: reduce `boundary_elements.approach_step`.",
    ),
    warning(
        "audit",
        "energy balance",
        "loop area and event energies differ by {} of Θ",
        "The partition of Θ over events, branches and kinds has this error.",
        "Quote the loop area `loss`; `interaction = \"point\"` has an exact balance. Boundary elements: \
         reduce `boundary_elements.approach_step`.",
    ),
    warning(
        "few_contacts",
        "few contacts",
        "mean number of contacts at F_max = {}",
        "Single contacts determine the result, and its standard deviation is large.",
        "Use a larger ζ, a larger scan or a larger `max_load`, or more `realizations`.",
    ),
    warning(
        "few_asperities",
        "few asperities",
        "number of asperities per surface = {}",
        "The surface is too small a sample for the statistics of Nayak and of Deng and Kesari.",
        "Use a larger ζ or a larger scan, or more `realizations`.",
    ),
    warning(
        "single",
        "single realization",
        "one realization finished",
        "There is no standard deviation and no confidence interval.",
        "Increase `realizations`; for measured surfaces, compare several scans.",
    ),
    warning(
        "imprecise",
        "confidence interval too wide",
        "half-width of the 95 % confidence interval of the mean above the requested `until_relative_ci`",
        "The mean is less precise than requested.",
        "Increase `max` of `realizations`, or accept the wider interval.",
    ),
];

/// Code of the warning of a grid error above the required one.
pub(super) const GRID_ERROR: &str = "grid_error";

/// Warning of a plan, and of no finished case.
pub const MANY_STEPS: Caution = warning(
    "many_steps",
    "many steps",
    "attraction of a range acts over {} steps",
    "A cycle takes many times as long as with a range below h_rms.",
    "Reduce `boundary_elements.range_m`, or increase `boundary_elements.approach_step`.",
);

/// A column of the table `cases` with the limit beyond which the row has a warning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Its code in [`CAUTIONS`].
    pub caution: &'static str,
    /// The column.
    pub column: &'static str,
    /// The limit; the limit itself is within the range.
    pub bound: f64,
    /// True for a minimum, false for a maximum. Maxima below 1 are fractions, written in percent; other
    /// limits are ratios or numbers.
    pub at_least: bool,
}

impl Limit {
    const fn at_most(caution: &'static str, column: &'static str, bound: f64) -> Self {
        Self { caution, column, bound, at_least: false }
    }

    const fn at_least(caution: &'static str, column: &'static str, bound: f64) -> Self {
        Self { caution, column, bound, at_least: true }
    }

    /// The limit of a warning that has one.
    #[must_use]
    pub fn of(code: &str) -> Option<Self> {
        LIMITS.into_iter().find(|limit| limit.caution == code)
    }

    /// True for a fraction, which is written in percent.
    #[must_use]
    pub fn is_fraction(&self) -> bool {
        !self.at_least && self.bound < 1.0
    }

    /// Column of a surface or cycle, of which the column of the limit is a statistic.
    #[must_use]
    pub fn of_one(&self) -> &'static str {
        ["_mean", "_min", "_max"]
            .into_iter()
            .find_map(|end| self.column.strip_suffix(end))
            .unwrap_or(self.column)
    }

    /// True if a number is beyond the limit. A missing number is not.
    #[must_use]
    pub fn is_passed(&self, number: Option<f64>) -> bool {
        number.is_some_and(|number| if self.at_least { number < self.bound } else { number > self.bound })
    }
}

/// All limits. The limit of the Tabor parameter applies to Wu's criterion only, and only with adhesion.
pub const LIMITS: [Limit; 19] = [
    Limit::at_least("sticky", "persson_tosatti_realised_mean", SEPARATE),
    Limit::at_most("area", "area_at_max_load_mean", LARGE_AREA),
    Limit::at_least("conformed", "conformity_realised_mean", BRIDGED),
    Limit::at_most("covered", "covered_share_mean", 0.1),
    Limit::at_most("absorption", "absorption_share_max", 0.1),
    Limit::at_most("touching", "touching_share_mean", 0.1),
    Limit::at_least("tabor", "tabor_min_min", 2.0),
    Limit::at_most("overshoot", "filter_overshoot_max", 0.01),
    Limit::at_least("coarse", "elements_per_wavelength_min", 16.0),
    Limit::at_most("extent", "probe_extent_max", SPHERE_SHARE),
    Limit::at_most("texture", "texture_aspect_max", 2.0),
    Limit::at_most("outliers", "outlier_share_max", 0.0),
    Limit::at_most("lines", "line_jump_share_max", 0.01),
    Limit::at_most("noise", "noise_share_max", 0.1),
    Limit::at_least("tip", "curvature_ratio_min", 0.33),
    Limit::at_most("unresolved", "loss_uncertainty_max", 0.1),
    Limit::at_most("audit", "audit_gap_max", 0.01),
    Limit::at_least("few_contacts", "contact_count_at_max_load_mean", 10.0),
    Limit::at_least("few_asperities", "summit_count_mean", 100.0),
];

/// Condition of a warning that has no limit of a column.
#[must_use]
pub fn condition(code: &str) -> Option<&'static str> {
    match code {
        "failed" => Some("`failed_count` > 0"),
        "not_reached" => Some("`not_reached_count` > 0"),
        "left_out" => Some("`left_out_ratio` > 0.05"),
        "full_contact" => Some("`area_at_max_load_mean` = 1, boundary elements"),
        "coarse_steps" => Some("`approach_step`/2^`halvings` > 0.05, boundary elements"),
        "incomplete" => Some("finished realizations < `planned_count`"),
        "unconverged" => Some("`unconverged_count` of `realizations` > 0"),
        "single" => Some("`done_count` = 1"),
        "imprecise" => Some("half-width of the interval > the requested share of the mean"),
        GRID_ERROR => Some("`loss_grid_error` > the requested `boundary_elements.error`, or null"),
        _ => None,
    }
}

/// Warnings of the asperity model, which boundary elements do not have.
const OF_ASPERITIES: [&str; 9] = [
    "sticky",
    "area",
    "conformed",
    "covered",
    "absorption",
    "touching",
    "texture",
    "few_contacts",
    "few_asperities",
];

/// Largest share of the work of adhesion for the roughness of a table below the shortest wavelength.
pub const MOST_LEFT_OUT: f64 = 0.05;

/// Shortest step of boundary elements, of the rms height, above which events are not located.
pub const LONGEST_STEP: f64 = 0.05;

/// Step of the case after all its halvings, of the rms height.
fn shortest_step(case: &CaseInput) -> f64 {
    let number = |column: &str| {
        case.parameters.iter().find(|(name, _)| name == column).and_then(|(_, value)| value.number())
    };
    number("approach_step").unwrap_or_default() / number("halvings").unwrap_or_default().exp2()
}

/// The codes of a row with a further one, in the order of [`CAUTIONS`].
pub(super) fn with_code(codes: &str, further: &str) -> String {
    let has = |code: &&str| *code == further || codes.split('+').any(|known| known == *code);
    CAUTIONS.iter().map(|known| known.code).filter(has).collect::<Vec<_>>().join("+")
}

/// Codes of the warnings of a row whose other columns are given, joined by `+`. The counts are those of the
/// realizations with a result in the row and at any load of its case; the flags say that a step of one is
/// unconverged, and that one is in full contact.
pub(super) fn caution(
    row: &Given,
    case: &CaseInput,
    [done_count, finished_count]: [usize; 2],
    [unconverged, is_full]: [bool; 2],
) -> String {
    let is = |column: &str, value: Value| {
        case.parameters.iter().any(|(name, known)| name == column && *known == value)
    };
    let by_elements = is("method", Value::from("boundary_elements"));
    let wu = (is("jump_in", Value::from("wu")) || is("nucleation", Value::from("wu")))
        && !is("work_of_adhesion_j_m2", Value::from(0.0));
    let number = |column: &str| match row.iter().find(|(name, _)| name == column) {
        Some((_, Value::Real(number))) => Some(*number),
        _ => None,
    };
    let parameter = |column: &str| {
        case.parameters.iter().find(|(name, _)| name == column).and_then(|(_, value)| value.number())
    };
    let passed = |word: &str| {
        LIMITS.iter().any(|limit| limit.caution == word && limit.is_passed(number(limit.column)))
    };
    let holds = |word: &str| match word {
        _ if by_elements && OF_ASPERITIES.contains(&word) => false,
        "left_out" => parameter("left_out_ratio").is_some_and(|ratio| ratio > MOST_LEFT_OUT),
        "full_contact" => by_elements && is_full,
        "coarse_steps" => by_elements && shortest_step(case) > LONGEST_STEP,
        "incomplete" => finished_count < case.planned_count,
        "not_reached" => done_count < finished_count,
        "failed" => case.failed_count > 0,
        "imprecise" => case.precision.as_ref().is_some_and(|(name, share)| {
            let [mean, high] = ["mean", "ci95_high"].map(|end| number(&format!("{name}_{end}")));
            mean.zip(high).is_none_or(|(mean, high)| high - mean > share * mean.abs())
        }),
        "single" => done_count == 1,
        "unconverged" => unconverged,
        "tabor" => wu && passed(word),
        _ => passed(word),
    };
    let codes: Vec<&str> = CAUTIONS.iter().map(|known| known.code).filter(|code| holds(code)).collect();
    codes.join("+")
}
