//! Size and units in the heading of a matrix of text.
//!
//! These are the words of Gwyddion, of SurfaceTopography, and of what SPIP and some interferometers write. Whatever else
//! stands in a heading is passed over.

use super::{Cause, units};

/// Entries of a heading that matter. Width is along a line, height from line to line.
#[derive(Default)]
pub(super) struct Heading {
    width: Option<Quantity>,
    height: Option<Quantity>,
    width_unit: Option<String>,
    height_unit: Option<String>,
    value_unit: Option<String>,
    pixel: Option<Quantity>,
    conversion: Option<Quantity>,
    values_in_line: Option<u64>,
    lines: Option<u64>,
    channel: Option<String>,
}

/// A number and what follows it.
struct Quantity {
    value: f64,
    unit: Option<String>,
}

/// Units and size of a heading.
pub(super) struct Meaning {
    /// Factor of the numbers of the file.
    pub(super) factor: f64,
    /// The unit of length that the file gives.
    pub(super) unit: Option<String>,
    /// Size along the lines' numbers and along a line \[m\].
    pub(super) size_m: Option<[f64; 2]>,
}

impl Heading {
    /// Takes in a line of the heading, without its comment sign.
    pub(super) fn line(&mut self, line: &str) -> Result<(), Cause> {
        let Some((key, value)) = line.split_once(['=', ':', '\u{ff1a}']) else {
            return Ok(());
        };
        let (key, value) = (key.trim(), value.trim());
        // Two entries may share a line, as in "h=305 w=75".
        if let ("h" | "w", Some((first, rest))) = (key, value.split_once(char::is_whitespace)) {
            self.entry(key, first)?;
            return self.line(rest);
        }
        self.entry(key, value)
    }

    fn entry(&mut self, key: &str, value: &str) -> Result<(), Cause> {
        let twice = || -> Cause { format!("{key:?} is said twice: a file may have one surface").into() };
        if SIZES.contains(&key.to_lowercase().as_str()) && has_decimal_comma(value) {
            return Err(format!(
                "its {key:?} of {value:?} has a decimal comma, which is not supported\nhelp: write a decimal point, or export in English"
            )
            .into());
        }
        let word = || Some(value.trim_matches(['[', ']', '(', ')', ' ']).to_owned()).filter(|word| !word.is_empty());
        match key.to_lowercase().as_str() {
            "width" | "breite" | "x-length" => put(&mut self.width, quantity(value)),
            "height" | "h\u{f6}he" | "y-length" => put(&mut self.height, quantity(value)),
            "pixel size" => put(&mut self.pixel, quantity(value)),
            "x-unit" | "unit x" => put(&mut self.width_unit, word()),
            "y-unit" | "unit y" => put(&mut self.height_unit, word()),
            "z-unit" | "value units" | "werteinheiten" | "werteinheit" | "data unit" | "unit data" => put(&mut self.value_unit, word()),
            "w" | "x-pixels" | "nx" => put(&mut self.values_in_line, value.parse().ok()),
            "h" | "y-pixels" | "ny" => put(&mut self.lines, value.parse().ok()),
            "channel" | "kanal" => put(&mut self.channel, word()),
            small if small.starts_with("height conversion factor") => {
                // The unit stands behind an arrow, as in "height conversion factor (-> m)".
                let unit = key.split_once("->").map_or("", |(_, unit)| unit);
                put(&mut self.conversion, quantity(&format!("{value} {unit}")))
            }
            _ => Some(()),
        }
        .ok_or_else(twice)
    }

    /// Units and size for points on a grid with these spacings along x and y, in the numbers of the file.
    pub(super) fn of_points(&self, spacing: [f64; 2], [x, y]: [u64; 2]) -> Result<Meaning, Cause> {
        let (factor, unit) = self.scale()?;
        let of_x = self.width_unit.as_ref().or(unit);
        let of_y = self.height_unit.as_ref().or(of_x);
        let along = |spacing: f64, points: u64, unit| size(Some(&Quantity { value: spacing * points as f64, unit: None }), unit);
        let size_m = along(spacing[0], x, of_x)?.zip(along(spacing[1], y, of_y)?).map(|(x, y)| [x, y]);
        Ok(Meaning { factor, unit: unit.cloned(), size_m })
    }

    /// The factor that takes the heights to metres, where their unit is known, and that unit.
    fn scale(&self) -> Result<(f64, Option<&String>), Cause> {
        let conversion = self.conversion.as_ref();
        let unit = conversion.map_or(self.value_unit.as_ref(), |conversion| conversion.unit.as_ref());
        let metres = unit.map_or(Ok(1.0), |unit| units::length("its heights are", unit))?;
        let factor = metres * conversion.map_or(1.0, |conversion| conversion.value);
        if !factor.is_finite() || factor.abs() < f64::MIN_POSITIVE {
            return Err(format!("its heading says that its heights are to be multiplied by {factor}").into());
        }
        Ok((factor, unit))
    }

    /// Units and size for a matrix of this extent.
    pub(super) fn meaning(&self, [rows, columns]: [u64; 2]) -> Result<Meaning, Cause> {
        for (said, found, what) in [(self.lines, rows, "lines"), (self.values_in_line, columns, "values in a line")] {
            if let Some(said) = said.filter(|said| *said != found) {
                return Err(format!("its heading says that it has {said} {what}, and it has {found}").into());
            }
        }
        let (factor, unit) = self.scale()?;
        // A unit that is said once for both directions, or for the heights alone, holds for all.
        let lateral = self.width_unit.as_ref().or(unit);
        let across = self.height_unit.as_ref().or(lateral);
        let pixel =
            |points: u64| Some(Quantity { value: self.pixel.as_ref()?.value * points as f64, unit: self.pixel.as_ref()?.unit.clone() });
        let (by_lines, by_values) = (pixel(rows), pixel(columns));
        let height = size(self.height.as_ref().or(by_lines.as_ref()), across)?;
        let width = size(self.width.as_ref().or(by_values.as_ref()), lateral)?;
        Ok(Meaning { factor, unit: unit.cloned(), size_m: height.zip(width).map(|(height, width)| [height, width]) })
    }
}

/// Entries that are a number with a unit.
const SIZES: [&str; 7] = ["width", "breite", "x-length", "height", "h\u{f6}he", "y-length", "pixel size"];

/// True if a text begins with a number that has a comma in it.
fn has_decimal_comma(text: &str) -> bool {
    let rest = text.trim_start_matches(|sign: char| sign.is_ascii_digit() || matches!(sign, '+' | '-'));
    rest.len() < text.len() && rest.strip_prefix(',').is_some_and(|rest| rest.starts_with(|sign: char| sign.is_ascii_digit()))
}

/// Puts an entry in its place; nothing, if the place is taken.
fn put<T>(place: &mut Option<T>, entry: Option<T>) -> Option<()> {
    if entry.is_some() && place.is_some() {
        return None;
    }
    *place = entry.or_else(|| place.take());
    Some(())
}

/// A number and its unit, as in "10 µm"; nothing, if it begins with no number, as in a remark.
fn quantity(text: &str) -> Option<Quantity> {
    let end = text.find(|sign: char| !(sign.is_ascii_digit() || "+-.eE".contains(sign))).unwrap_or(text.len());
    let (number, unit) = text.split_at_checked(end)?;
    let unit = unit.trim_matches(['[', ']', '(', ')', ' ']);
    Some(Quantity { value: number.parse().ok()?, unit: Some(unit.to_owned()).filter(|unit| !unit.is_empty()) })
}

/// A size \[m\], if it is said with a unit.
fn size(said: Option<&Quantity>, otherwise: Option<&String>) -> Result<Option<f64>, Cause> {
    let Some(said) = said else {
        return Ok(None);
    };
    let Some(unit) = said.unit.as_ref().or(otherwise) else {
        return Ok(None);
    };
    let size = said.value * units::length("its size is", unit)?;
    if size.is_finite() && size > 0.0 {
        Ok(Some(size))
    } else {
        Err(format!("its heading says a size of {} {unit}, which must be positive", said.value).into())
    }
}
