//! Numbers of the report: digits, powers of ten and percentages.

use crate::stats::{column_exponent, decimals};
use maud::{Markup, html};

/// Format of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shown {
    Plain,
    Percent,
}

/// Sign of a missing number.
const MISSING: &str = "–";

/// The common power of ten of the numbers of a column; none where they differ by too much, and each has its
/// own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale(Option<i32>);

impl Scale {
    pub(super) fn of(means: &[f64]) -> Self {
        let exponent = column_exponent(means.iter().copied());
        let is_readable =
            |mean: &f64| *mean == 0.0 || (1e-3..1e5).contains(&(mean.abs() / 10f64.powi(exponent)));
        Self(means.iter().all(is_readable).then_some(exponent))
    }

    /// The factor for the head of the column; empty where there is none.
    pub(super) fn head(self) -> Markup {
        html! {
            @if let Some(exponent) = self.0.filter(|exponent| *exponent != 0) {
                " [10" sup { (minus(&exponent.to_string())) } "]"
            }
        }
    }
}

/// Text with minus signs as wide as a digit.
pub(super) fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// A number over the scale of its column, with three significant digits.
pub(super) fn scaled(number: Option<f64>, scale: Scale) -> Markup {
    let Some(number) = number else { return html! { (MISSING) } };
    let Some(exponent) = scale.0 else {
        return if number == 0.0 {
            html! { "0" }
        } else {
            power(number)
        };
    };
    let over = number / 10f64.powi(exponent);
    // The limits of an interval may be far smaller than all means.
    let places = decimals(over, 3).min(5);
    let text = format!("{over:.places$}");
    let is_zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    html! { (if is_zero { "0".to_owned() } else { minus(&text) }) }
}

/// A number over the scale of its column with the half-width of its interval: as many decimals as two digits
/// of the half-width have.
pub(super) fn with_half_width(number: Option<f64>, half: Option<f64>, scale: Scale) -> Markup {
    let known = number.zip(half.filter(|half| half.is_finite() && *half > 0.0)).zip(scale.0);
    let Some(((number, half), exponent)) = known else { return scaled(number, scale) };
    let [number, half] = [number, half].map(|value| value / 10f64.powi(exponent));
    let places = decimals(half, 2).min(5);
    html! { (minus(&format!("{number:.places$}"))) " " small { "±\u{a0}" (format!("{half:.places$}")) } }
}

/// A number as two digits and a power of ten.
fn power(number: f64) -> Markup {
    let text = format!("{number:.1e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    html! { (minus(digits)) "×10" sup { (minus(exponent)) } }
}

/// A number with three digits, or a dash where it is missing; a small or large one with a power of ten.
pub(super) fn shown(number: Option<f64>, format: Shown) -> Markup {
    let Some(number) = number else { return html! { (MISSING) } };
    let text = match (format, number.abs()) {
        (Shown::Percent, size) if (100.0 * size).fract() == 0.0 => {
            format!("{:.0}\u{a0}%", 100.0 * number + 0.0)
        }
        (Shown::Percent, size) if size < 5e-4 => "0.0\u{a0}%".to_owned(),
        (Shown::Percent, _) => format!("{:.1}\u{a0}%", 100.0 * number),
        (Shown::Plain, 0.0) => "0".to_owned(),
        (Shown::Plain, size) if !(0.01..1e5).contains(&size) => return power(number),
        (Shown::Plain, size) if size >= 100.0 || size.fract() == 0.0 => format!("{number:.0}"),
        (Shown::Plain, size) if size >= 10.0 => format!("{number:.1}"),
        (Shown::Plain, size) if size >= 1.0 => format!("{number:.2}"),
        (Shown::Plain, _) => format!("{number:.3}"),
    };
    html! { (minus(&text)) }
}

/// A number, and another one in parentheses if there is one.
pub(super) fn with_aside(number: Option<f64>, aside: Option<f64>, format: Shown) -> Markup {
    html! { (shown(number, format)) @if aside.is_some() { " (" (shown(aside, format)) ")" } }
}
