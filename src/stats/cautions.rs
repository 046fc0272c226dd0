//! What speaks against trusting a row of the table `cases`.

use super::rows::Value;
use super::{CaseInput, Given};

/// The words of the column `caution`, in the order in which they are joined, each with what it says.
pub const CAUTIONS: [(&str, &str); 14] = [
    ("incomplete", "fewer realizations are in the means than the spec asks for"),
    ("failed", "a realization failed"),
    ("imprecise", "the mean is not known as well as the spec asks: there are as many realizations as it allows, or too many failed"),
    ("single", "one realization: no spread"),
    ("unconverged", "a step's residual stayed above the tolerance"),
    ("audit", "the loop's work and the sum over its events differ by more than 1 % in a realization"),
    (
        "absorption",
        "absorption and release: contacts that meet and part (cover, uncover, merge, split events) make up more than 10 % of the dissipated energy in a \
         realization; that part of Θ is an artefact of the coalescence rule",
    ),
    (
        "unresolved",
        "dissipated energy not resolved: Θ is less than ten times the numerical resolution of the loop in a realization, 1e-7 of the work of loading",
    ),
    ("touching", "more than a tenth of the contact spots touch another one, on average"),
    ("covered", "more than a tenth of the asperities in contact are covered, on average"),
    ("tabor", "an asperity's Tabor number is below 2, where Wu's jump-in does not hold"),
    ("area", "more than three tenths of the nominal area are in contact, on average: an asperity model is outside its range"),
    (
        "conformed",
        "flattening the shortest octave of the roughness costs less elastic energy than adhesion gains: the half-space conforms to the \
         summits, and does not bridge them",
    ),
    (
        "sticky",
        "flattening all the roughness costs less than twice what adhesion gains (Persson and Tosatti): the true contact may be near full \
         contact, and an asperity model is outside its range",
    ),
];

/// A number of the table `cases` with the bound beyond which the row carries a caution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Its word in [`CAUTIONS`].
    pub caution: &'static str,
    /// The column.
    pub column: &'static str,
    /// The bound; the number itself is still within it.
    pub bound: f64,
    /// Whether the number is to be at least the bound; else at most.
    pub at_least: bool,
}

impl Limit {
    const fn at_most(caution: &'static str, column: &'static str, bound: f64) -> Self {
        Self { caution, column, bound, at_least: false }
    }

    const fn at_least(caution: &'static str, column: &'static str, bound: f64) -> Self {
        Self { caution, column, bound, at_least: true }
    }

    /// Whether a number is beyond the bound. One that is missing is not.
    #[must_use]
    pub fn is_passed(&self, number: Option<f64>) -> bool {
        number.is_some_and(|number| if self.at_least { number < self.bound } else { number > self.bound })
    }
}

/// What is compared with a bound. The Tabor parameter matters to Wu's jump-in alone, and only with adhesion.
pub const LIMITS: [Limit; 9] = [
    Limit::at_most("audit", "audit_gap_max", 0.01),
    Limit::at_most("absorption", "absorption_share_max", 0.1),
    Limit::at_most("unresolved", "loss_uncertainty_max", 0.1),
    Limit::at_most("touching", "touching_share_mean", 0.1),
    Limit::at_most("covered", "covered_share_mean", 0.1),
    Limit::at_least("tabor", "tabor_min_min", 2.0),
    Limit::at_most("area", "area_at_max_load_mean", 0.3),
    Limit::at_least("conformed", "conformity_realised_mean", 1.0),
    Limit::at_least("sticky", "persson_tosatti_realised_mean", 2.0),
];

/// The cautions of a row whose other columns are given, joined by `+`.
pub(super) fn caution(row: &Given, case: &CaseInput, done_count: usize, unconverged: bool) -> String {
    let is = |column: &str, value: Value| case.parameters.iter().any(|(name, known)| name == column && *known == value);
    let wu = is("jump_in", Value::from("wu")) && !is("work_of_adhesion_j_m2", Value::from(0.0));
    let number = |column: &str| match row.iter().find(|(name, _)| name == column) {
        Some((_, Value::Real(number))) => Some(*number),
        _ => None,
    };
    let passed = |word: &str| LIMITS.iter().any(|limit| limit.caution == word && limit.is_passed(number(limit.column)));
    let holds = |word: &str| match word {
        "incomplete" => done_count < case.planned_count,
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
    let words: Vec<&str> = CAUTIONS.iter().map(|(word, _)| *word).filter(|word| holds(word)).collect();
    words.join("+")
}
