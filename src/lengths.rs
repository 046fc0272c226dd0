//! Units of length.

/// The units of length that are understood, as an error lists them.
pub const LENGTHS: &str = "km, m, mm, µm or um, nm, pm, Å or A, in, mil";

/// The units of length as a regular expression of JSON Schema: abbreviations, and any longer word for one that is written out.
pub const LENGTH_PATTERN: &str =
    "^\\s*(km|m|mm|[\u{b5}\u{3bc}]m|um|nm|pm|[\u{c5}\u{212b}]|A\u{30a}?|in|mil|[A-Za-z\u{e5}\u{f6}]{3,})?\\s*$";

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
