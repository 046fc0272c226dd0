//! Units of force, time and area in headings of measured loops.

use crate::lengths::metres;

/// Units of force that are understood, as an error lists them.
pub(super) const FORCES: &str = "kN, N, mN, µN or uN, nN, pN";
/// Units of area, as an error lists them.
pub(super) const AREAS: &str = "m2, mm2, µm2 or um2, nm2";

/// Size of a unit of force \[N\].
pub(super) fn newtons(unit: &str) -> Option<f64> {
    Some(match unit.trim() {
        "kN" => 1e3,
        "N" | "n" | "newton" | "newtons" | "Newton" => 1.0,
        "mN" => 1e-3,
        "\u{b5}N" | "\u{3bc}N" | "uN" | "microN" => 1e-6,
        "nN" => 1e-9,
        "pN" => 1e-12,
        _ => return None,
    })
}

/// Size of a unit of area \[m²\].
pub(super) fn square_metres(unit: &str) -> Option<f64> {
    let unit = unit.trim();
    let length = ["^2", "²", "2"].into_iter().find_map(|power| unit.strip_suffix(power))?;
    metres(length).map(|length| length * length)
}

/// Size of a unit of time \[s\].
pub(super) fn seconds(unit: &str) -> Option<f64> {
    Some(match unit.trim() {
        "s" | "sec" | "seconds" => 1.0,
        "ms" => 1e-3,
        "\u{b5}s" | "\u{3bc}s" | "us" => 1e-6,
        "min" => 60.0,
        _ => return None,
    })
}

/// True for any unit that a heading may have, read or not.
pub(super) fn is_unit(unit: &str) -> bool {
    newtons(unit).is_some()
        || metres(unit).is_some()
        || square_metres(unit).is_some()
        || seconds(unit).is_some()
        || ["V", "mV", "1", "-", "deg", "Hz", "Pa", "kPa", "MPa", "N/m", "%"].contains(&unit.trim())
}
