//! Cases with a warning before a run.

use crate::stats::{CAUTIONS, Caution, Limit, measured_text, significant};

/// Cases with a warning.
#[derive(Debug, Clone, PartialEq)]
pub struct Outside {
    /// The warning.
    pub kind: Caution,
    /// Its limit.
    pub limit: f64,
    /// Smallest and largest value over these cases.
    pub range: [f64; 2],
    /// Measured values and limit as text.
    pub measured: String,
    /// Ids of the cases.
    pub cases: Vec<String>,
}

impl Outside {
    /// Cases whose values are beyond the limit of a warning; nothing without any.
    pub(super) fn of(code: &str, values: impl Iterator<Item = (String, f64)>) -> Option<Self> {
        let (limit, kind) = (Limit::of(code)?, CAUTIONS.into_iter().find(|kind| kind.code == code)?);
        let (cases, values): (Vec<String>, Vec<f64>) =
            values.filter(|(_, value)| limit.is_passed(Some(*value))).unzip();
        let range = [values.iter().copied().reduce(f64::min)?, values.iter().copied().reduce(f64::max)?];
        let of_target = ["sticky", "conformed"].contains(&code);
        let measured = if of_target {
            format!(
                "{} (target spectrum or scan; limit ≥ {})",
                kind.text.replace("{}", &interval(range)),
                limit.bound
            )
        } else {
            measured_text(&kind, limit, &values)
        };
        Some(Self { kind, limit: limit.bound, range, measured, cases })
    }
}

/// The interval of values as text.
pub(super) fn interval(range: [f64; 2]) -> String {
    let [low, high] = range.map(|value| significant(value, 3));
    if low == high { low } else { format!("{low} to {high}") }
}

/// A time as text.
#[must_use]
pub fn in_words(seconds: f64) -> String {
    match seconds {
        _ if seconds < 1.0 => "1 s".to_owned(),
        _ if seconds < 100.0 => format!("{} s", significant(seconds, 1)),
        _ if seconds < 6000.0 => format!("{} min", significant(seconds / 60.0, 2)),
        _ => format!("{} h", significant(seconds / 3600.0, 2)),
    }
}
