//! Units of length, and when two statements of one length agree.

/// Relative difference up to which two statements of one size agree.
pub const SAME_SIZE: f64 = 1e-3;

/// The units of length that are understood, as an error lists them.
pub const LENGTHS: &str = "km, m, mm, µm or um, nm, pm, Å or A, in, mil";

/// The units of length as a regular expression of JSON Schema: abbreviations, and any longer word for one
/// that is written out.
pub const LENGTH_PATTERN: &str = "^\\s*(km|m|mm|[\u{b5}\u{3bc}]m|um|nm|pm|[\u{c5}\u{212b}]|A\u{30a}?|in|mil|\
    [A-Za-z\u{e5}\u{f6}]{3,})?\\s*$";

/// Length of a unit \[m\]; nothing for an unknown unit.
#[must_use]
pub fn metres(unit: &str) -> Option<f64> {
    let unit = unit.trim();
    Some(match unit {
        "km" => 1e3,
        "m" => 1.0,
        "mm" => 1e-3,
        // The micro sign, and the Greek letter that looks the same.
        "\u{b5}m" | "\u{3bc}m" | "um" => 1e-6,
        "nm" => 1e-9,
        "pm" => 1e-12,
        // The letter, the sign of the unit, and the letter with a ring put on.
        "\u{c5}" | "\u{212b}" | "A\u{30a}" | "A" => 1e-10,
        "in" => 0.0254,
        "mil" => 2.54e-5,
        _ => return spelt_out(&unit.to_ascii_lowercase()),
    })
}

/// A number and the unit behind it, as in "10 µm"; nothing if the text does not begin with a number.
///
/// A comma is a decimal comma, except before exactly three digits, where it may separate thousands.
#[must_use]
pub fn quantity(text: &str) -> Option<(f64, Option<&str>)> {
    let text = text.trim();
    let digits = |sign: char| sign.is_ascii_digit() || "+-.,".contains(sign);
    let mut end = text.find(|sign: char| !digits(sign)).unwrap_or(text.len());
    // An exponent: e, a sign or none, and digits; the E of a unit is none.
    if let Some(exponent) = text.get(end..).and_then(|rest| rest.strip_prefix(['e', 'E'])) {
        let signs = exponent.len() - exponent.trim_start_matches(['+', '-']).len();
        let count = exponent.bytes().skip(signs).take_while(u8::is_ascii_digit).count();
        if signs <= 1 && count > 0 {
            end += 1 + signs + count;
        }
    }
    let (number, unit) = text.split_at_checked(end)?;
    let number = match number.split_once(',') {
        Some((_, rest)) if rest.len() == 3 && rest.bytes().all(|byte| byte.is_ascii_digit()) => return None,
        Some(_) if number.contains('.') => return None,
        _ => number.replace(',', "."),
    };
    let unit = unit.trim_matches(['[', ']', '(', ')', ' ', '\t']);
    let value: f64 = number.parse().ok()?;
    value.is_finite().then_some((value, Some(unit).filter(|unit| !unit.is_empty())))
}

/// The sizes of a scan \[m\] along x and y: "5um", "5e-6" (metres) or "5um x 3um"; one number holds for x
/// alone.
#[must_use]
pub fn sizes(text: &str) -> Option<Vec<f64>> {
    let parts: Vec<&str> = text.split(['x', 'X', '\u{d7}', '*']).collect();
    if parts.len() > 2 {
        return None;
    }
    let read: Vec<_> = parts.iter().map(|part| quantity(part)).collect::<Option<_>>()?;
    // "5 x 3 um": the unit behind the last number holds for both.
    let last = read.last().and_then(|(_, unit)| *unit);
    let in_metres = |(value, unit): (f64, Option<&str>)| {
        unit.or(last).map_or(Some(value), |unit| Some(value * metres(unit)?))
    };
    read.into_iter().map(in_metres).collect()
}

/// Units whose names are written out, which some instruments do.
fn spelt_out(unit: &str) -> Option<f64> {
    let one = unit.strip_suffix('s').unwrap_or(unit);
    if let Some(prefix) = one.strip_suffix("meter").or_else(|| one.strip_suffix("metre")) {
        return Some(match prefix {
            "kilo" => 1e3,
            "" => 1.0,
            "milli" => 1e-3,
            "micro" => 1e-6,
            "nano" => 1e-9,
            "pico" => 1e-12,
            _ => return None,
        });
    }
    match one {
        "micron" => Some(1e-6),
        "angstrom" | "\u{e5}ngstr\u{f6}m" => Some(1e-10),
        "inch" | "inche" => Some(0.0254),
        _ => None,
    }
}
