//! Sizes and units that files state in attributes of the field, its groups or the root.
//!
//! A name such as `pixel_size_m`, `scanSizeX` or `length` is a quantity (size of the scan, or distance of its
//! points), an axis if it is one of two, and a unit if it ends with one.

use super::attributes::{Attributes, Value};
use crate::lengths::{metres, quantity};

/// Attributes with the unit of the heights.
const HEIGHT_UNITS: [&str; 8] =
    ["unit", "units", "z_unit", "z_units", "height_unit", "height_units", "unit_z", "units_z"];
/// Attributes with the unit of sizes, besides those named after the size itself.
const SIZE_UNITS: [&str; 8] = [
    "length_unit",
    "length_units",
    "lateral_unit",
    "lateral_units",
    "xy_unit",
    "xy_units",
    "pixel_unit",
    "pixel_units",
];
/// Names of the size of a scan, without axis and unit.
const SIZES: [&str; 13] = [
    "length",
    "size",
    "side",
    "scan_size",
    "scan_length",
    "physical_size",
    "physical_sizes",
    "system_size",
    "image_size",
    "field_size",
    "lateral_size",
    "sizes",
    "lengths",
];
/// Names of the distance of points, without axis and unit.
const PIXELS: [&str; 15] = [
    "pixel",
    "pixel_size",
    "pixelsize",
    "pixel_spacing",
    "pixel_pitch",
    "spacing",
    "pitch",
    "grid_spacing",
    "grid_size",
    "lateral_spacing",
    "sampling",
    "sample_spacing",
    "point_spacing",
    "d",
    "lateral_resolution",
];
/// Attribute of TopoStats: nanometres per pixel.
const TOPOSTATS: &str = "pixel_to_nm_scaling";

/// Distance of two points, and the extent of all.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pixel {
    /// Distance in the unit of the file.
    pub(super) value: f64,
    /// Points times distance in the unit of the file, to the last digit where the file states it.
    pub(super) extent: f64,
    /// That unit \[m\], if it is known.
    pub(super) metres: Option<f64>,
}

impl Pixel {
    /// In metres, or in the numbers of the file where their unit is unknown.
    pub(super) fn size(&self) -> f64 {
        self.value * self.metres.unwrap_or(1.0)
    }
}

/// Unit of the heights.
pub(super) fn unit_of_heights(level: &Attributes) -> Option<&str> {
    HEIGHT_UNITS.iter().find_map(|name| {
        level.iter().find_map(|(other, value)| match value {
            Value::Text(text) if !text.is_empty() && plain(other) == *name => Some(text.as_str()),
            _ => None,
        })
    })
}

/// A name in lower case with its words apart: `pixelSizeX` is `pixel_size_x`.
fn plain(name: &str) -> String {
    let mut words = String::new();
    let mut small = false;
    for sign in name.chars() {
        if sign.is_uppercase() && small {
            words.push('_');
        }
        small = sign.is_lowercase();
        match sign {
            ' ' | '-' | '.' | '(' | '[' | '/' => words.push('_'),
            ')' | ']' => {}
            _ => words.extend(sign.to_lowercase()),
        }
    }
    words.split('_').filter(|word| !word.is_empty()).collect::<Vec<_>>().join("_")
}

/// An axis in a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Along {
    Both,
    X,
    Y,
}

/// A name of a size or of a distance of points.
struct Name {
    /// True for the distance of points.
    pixel: bool,
    along: Along,
    metres: Option<f64>,
}

impl Name {
    fn of(name: &str) -> Option<Self> {
        let name = plain(name);
        if name == TOPOSTATS {
            return Some(Self { pixel: true, along: Along::Both, metres: Some(1e-9) });
        }
        let mut words: Vec<&str> = name.split('_').collect();
        // "x" and "y" are not units; "a", "in" and "m" are units if they are the last word.
        let unit = words.last().and_then(|word| metres(word)).filter(|_| words.len() > 1);
        if unit.is_some() {
            words.pop();
        }
        let mut along = Along::Both;
        let axis = |word: &str| match word {
            "x" | "dx" | "lx" => Some(Along::X),
            "y" | "dy" | "ly" => Some(Along::Y),
            _ => None,
        };
        if let Some(found) = words.iter().position(|word| axis(word).is_some()) {
            let word = words.remove(found);
            along = axis(word)?;
            match word {
                "dx" | "dy" => words.insert(found, "d"),
                "lx" | "ly" => words.insert(found, "length"),
                _ => {}
            }
        }
        let stem = words.join("_");
        let pixel = PIXELS.contains(&stem.as_str()) && (stem != "d" || along != Along::Both);
        (pixel || SIZES.contains(&stem.as_str())).then_some(Self { pixel, along, metres: unit })
    }
}

/// A size, or a distance of points.
struct Entry {
    name: String,
    of: Name,
    values: Vec<f64>,
}

/// Every distance of points along x and y that the attributes state, the innermost first. `counts` are the
/// points along x and y.
pub(super) fn pixels(levels: &[Attributes], counts: [usize; 2]) -> Vec<(String, [Pixel; 2])> {
    let counts = counts.map(|count| count as f64);
    let mut found = Vec::new();
    for level in levels {
        let entries: Vec<Entry> =
            level.iter().filter_map(|(name, value)| entry(level, name, value, counts)).collect();
        for pixel in [true, false] {
            let one = |entry: &Entry, at: usize| {
                let stated = *entry.values.get(at).or(entry.values.first())?;
                let count = *counts.get(at)?;
                let (value, extent) = if pixel { (stated, stated * count) } else { (stated / count, stated) };
                Some(Pixel { value, extent, metres: entry.of.metres })
            };
            let of = |along| {
                entries.iter().filter(move |entry| entry.of.pixel == pixel && entry.of.along == along)
            };
            for entry in of(Along::Both) {
                found.extend(one(entry, 0).zip(one(entry, 1)).map(|(x, y)| (entry.name.clone(), [x, y])));
            }
            for (x, y) in of(Along::X).zip(of(Along::Y)) {
                found.extend(
                    one(x, 0)
                        .zip(one(y, 1))
                        .map(|(along_x, along_y)| (format!("{} and {}", x.name, y.name), [along_x, along_y])),
                );
            }
        }
    }
    found
}

/// An attribute as a size, if it is one.
fn entry(level: &Attributes, name: &str, value: &Value, counts: [f64; 2]) -> Option<Entry> {
    let mut of = Name::of(name)?;
    let values = match value {
        Value::Numbers(values, kind) => {
            // Integers equal to the numbers of points are these numbers.
            let points =
                !kind.is_float() && values.iter().all(|value| counts.contains(value)) && of.metres.is_none();
            values.iter().copied().filter(|_| !points).collect()
        }
        Value::Text(text) => {
            let (value, unit) = quantity(text)?;
            of.metres = match unit {
                Some(unit) => Some(metres(unit)?),
                None => of.metres,
            };
            vec![value]
        }
    };
    if of.metres.is_none() {
        of.metres = unit_beside(level, name);
    }
    let fits = matches!(values.len(), 1 | 2) && values.iter().all(|value| *value > 0.0 && value.is_finite());
    fits.then(|| Entry { name: name.to_owned(), of, values })
}

/// Unit of a size \[m\] in a further attribute such as `length_unit`.
fn unit_beside(level: &Attributes, name: &str) -> Option<f64> {
    let own = ["unit", "units"].map(|word| format!("{}_{word}", plain(name)));
    let known = |other: &str| own.iter().any(|name| name == other) || SIZE_UNITS.contains(&other);
    level.iter().find_map(|(other, value)| match value {
        Value::Text(text) if known(&plain(other)) => metres(text),
        _ => None,
    })
}
