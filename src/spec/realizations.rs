//! Number of realizations: fixed, or as many as the precision of a mean requires.

use std::fmt;

use serde::Serialize;
use toml::de::DeValue;

use super::MAX_REALIZATIONS;
use super::entries::{entries, shown};
use super::fault::Faults;
use super::keys::Limits;
use super::nearest::nearest;
use super::number::{integer, number};
use super::value::word;
use super::written::{Written, wrong_type};
use crate::model::{Choice, Goal};

/// Number of realizations of each surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Realizations {
    /// Fixed number.
    Exactly(u32),
    /// Number that a target precision requires, case by case.
    Until(Until),
}

/// Realizations are added until the 95 % confidence interval of a mean is narrow enough at every load
/// reversal of the case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Until {
    /// Half the interval over the mean.
    pub until_relative_ci: f64,
    /// Of what.
    pub of: Goal,
    /// With how many it begins.
    pub min: u32,
    /// Maximum number.
    pub max: u32,
}

impl Realizations {
    /// Minimum number.
    #[must_use]
    pub fn least(self) -> u32 {
        match self {
            Self::Exactly(count) => count,
            Self::Until(until) => until.min,
        }
    }

    /// Maximum number.
    #[must_use]
    pub fn most(self) -> u32 {
        match self {
            Self::Exactly(count) => count,
            Self::Until(until) => until.max,
        }
    }

    /// Target precision, if the spec has one.
    #[must_use]
    pub fn until(self) -> Option<Until> {
        match self {
            Self::Exactly(_) => None,
            Self::Until(until) => Some(until),
        }
    }
}

/// As a spec has it.
impl fmt::Display for Realizations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exactly(count) => write!(f, "{count}"),
            Self::Until(Until { until_relative_ci, of, min, max }) => {
                write!(
                    f,
                    "{{ until_relative_ci = {until_relative_ci:?}, of = \"{}\", min = {min}, max = {max} }}",
                    of.word()
                )
            }
        }
    }
}

/// Realizations of a spec that does not state their number.
pub(super) const DEFAULT: u32 = 6;

/// Fewest and most realizations of a spec that states a precision alone.
pub(super) const DEFAULT_BOUNDS: (u32, u32) = (6, 200);

/// Fewest realizations of a spec that states a precision: two are the fewest that have a standard deviation.
pub(super) const LEAST: u32 = 2;

/// Keys of the table.
const TAKES: [&str; 4] = ["until_relative_ci", "of", "min", "max"];

/// Bounds of the relative half-width of a confidence interval.
pub(super) const PRECISION: Limits = Limits {
    low: 1e-3,
    above: false,
    high: 1.0,
    unit: "",
    unit_name: "",
    slip: None,
    note: "half-width of the 95 % confidence interval over the mean; 0.05 takes about 100 surfaces at a \
         standard deviation of 25 %",
};

/// A number of realizations, or a table that says until when. Keys that the table lacks keep their values
/// before.
pub(super) fn realizations(
    value: &Written<'_>,
    before: Realizations,
    faults: &mut Faults<'_>,
) -> Option<Realizations> {
    match value.get_ref() {
        DeValue::Table(_) => until(value, before.until(), faults).map(Realizations::Until),
        DeValue::Integer(_) => count("realizations", 1, value, faults).map(Realizations::Exactly),
        other => {
            let help = "write a number, or { until_relative_ci = 0.05, of = \"loss\" }".to_owned();
            wrong_type("realizations", "an integer or a table", other, &value.span(), help, faults);
            None
        }
    }
}

fn count(path: &str, least: u32, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<u32> {
    let found = integer(path, value, faults)?;
    let count = u32::try_from(found).ok().filter(|count| (least..=MAX_REALIZATIONS).contains(count));
    if count.is_none() {
        let message = format!("`{path}` cannot be {found}: it must be from {least} to {MAX_REALIZATIONS}");
        let help = if least > 1 {
            "a standard deviation requires at least two realizations"
        } else {
            "the number of surfaces of each case"
        };
        faults.add(&value.span(), message, help.to_owned());
    }
    count
}

fn until(value: &Written<'_>, known: Option<Until>, faults: &mut Faults<'_>) -> Option<Until> {
    let DeValue::Table(table) = value.get_ref() else { return None };
    let before = faults.count();
    let mut precision = known.map(|known| known.until_relative_ci);
    let mut of = known.map_or(Goal::Loss, |known| known.of);
    let (mut min, mut max) = known.map_or(DEFAULT_BOUNDS, |known| (known.min, known.max));
    let mut limits = value.span();
    for (name, span, written) in entries(table) {
        match name {
            "until_relative_ci" => {
                precision = number("realizations.until_relative_ci", &PRECISION, written, faults);
            }
            "of" => {
                let words: Vec<&'static str> = Goal::WORDS.iter().map(|(word, _)| *word).collect();
                of = word("realizations.of", &words, written, faults).and_then(Goal::from_word).unwrap_or(of);
            }
            "min" => min = count("realizations.min", LEAST, written, faults).unwrap_or(min),
            "max" => {
                limits = written.span();
                max = count("realizations.max", LEAST, written, faults).unwrap_or(max);
            }
            unknown => {
                let listed = format!("keys of `realizations`: {}", TAKES.join(", "));
                let help = nearest(unknown, TAKES)
                    .map_or_else(|| listed.clone(), |near| format!("did you mean `{near}`? {listed}"));
                faults.add(&span, format!("unknown key `{}` in `realizations`", shown(unknown)), help);
            }
        }
    }
    if known.is_none() && !table.contains_key("until_relative_ci") {
        let help = "add until_relative_ci = 0.05, or write the number of realizations alone".to_owned();
        faults.add(&value.span(), "`realizations` has no `until_relative_ci`".to_owned(), help);
    }
    if faults.count() == before && min > max {
        faults.add(
            &limits,
            format!("`realizations.max` cannot be {max}: it must be at least `min`, which is {min}"),
            "raise `max`, or lower `min`".to_owned(),
        );
    }
    (faults.count() == before).then_some(Until { until_relative_ci: precision?, of, min, max })
}
