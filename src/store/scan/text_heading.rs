//! Size and units in the heading of a text.
//!
//! These are the words of Gwyddion, of SurfaceTopography, of SPIP, and of several interferometers and
//! profilers. All other entries of a heading are passed over.

use super::text_cells::{Separator, is_value};
use super::text_columns::Column;
use super::{Cause, units};
use crate::lengths::quantity;

/// Entries of a heading that matter. Width is along a line, height from line to line.
#[derive(Default)]
pub(super) struct Heading {
    width: Option<Quantity>,
    height: Option<Quantity>,
    width_unit: Option<String>,
    height_unit: Option<String>,
    value_unit: Option<String>,
    pixel: [Option<Quantity>; 2],
    conversion: Option<Quantity>,
    values_in_line: Option<u64>,
    lines: Option<u64>,
    channel: Option<String>,
}

/// A number and what follows it.
#[derive(Debug, Clone, PartialEq)]
struct Quantity {
    value: f64,
    unit: Option<String>,
}

impl Quantity {
    /// The number at the beginning of a text; nothing for a remark.
    fn of(text: &str) -> Option<Self> {
        quantity(text).map(|(value, unit)| Self { value, unit: unit.map(ToOwned::to_owned) })
    }

    fn times(&self, points: u64) -> Self {
        Self { value: self.value * points as f64, unit: self.unit.clone() }
    }
}

/// Units and size of a heading.
pub(super) struct Meaning {
    /// Factor of the numbers of the file.
    pub(super) factor: f64,
    /// The unit of length that the file gives.
    pub(super) unit: Option<String>,
    /// Size along x and along y \[m\].
    pub(super) size_m: Option<[f64; 2]>,
}

impl Heading {
    /// Takes in a line of the heading, without its comment sign.
    pub(super) fn line(&mut self, line: &str) -> Result<(), Cause> {
        let mut rest = line;
        while let Some((key, value)) = rest.split_once(['=', ':', '\u{ff1a}']) {
            let (key, value) = (key.trim(), value.trim());
            // Two entries may share a line, as in "h=305 w=75".
            let ("h" | "w", Some((first, next))) = (key, value.split_once(char::is_whitespace)) else {
                return self.entry(key, value);
            };
            self.entry(key, first)?;
            rest = next;
        }
        Ok(())
    }

    /// Takes in a line of words, as in `"Pitch X","500","nm"`: a name, and numbers or a word behind it.
    pub(super) fn words(&mut self, line: &str) -> Result<(), Cause> {
        let separator = Separator::of_words(line);
        let cells: Vec<&str> = separator.cells(line).into_iter().filter(|cell| !cell.is_empty()).collect();
        let names = match separator {
            Separator::Blank => cells.iter().take_while(|cell| !is_value(cell)).count(),
            Separator::Sign(_) => 1,
        };
        let names = if names == cells.len() { 1 } else { names };
        match cells.split_at_checked(names) {
            Some((key, value)) if !value.is_empty() => self.entry(&key.join(" "), &value.join(" ")),
            _ => Ok(()),
        }
    }

    fn entry(&mut self, key: &str, value: &str) -> Result<(), Cause> {
        let twice = || -> Cause { format!("{key:?} is said twice: a file may have one surface").into() };
        let small = key.to_lowercase().replace(['-', '_', '"'], " ");
        let small = small.split_whitespace().collect::<Vec<_>>().join(" ");
        let small = small.as_str();
        if is_size(small) && has_ambiguous_comma(value) {
            return Err(format!(
                "its {key:?} of {value:?} has a comma that may be a decimal comma or separate \
                 thousands\nhelp: write a decimal point, or export in English"
            )
            .into());
        }
        let word = || {
            Some(value.trim_matches(['[', ']', '(', ')', ' ', '"']).to_owned())
                .filter(|word| !word.is_empty())
        };
        let [pixel_x, pixel_y] = &mut self.pixel;
        match small {
            "width" | "breite" => put(&mut self.width, Quantity::of(value)),
            "height" | "h\u{f6}he" => put(&mut self.height, Quantity::of(value)),
            "size" | "scan size" | "scan range" | "image size" | "scan area" => self.both(value),
            "pixel size" | "pixelsize" | "pitch" | "spacing" | "pixel pitch" | "grid spacing"
            | "xy calibration" | "lateral sampling" => put(pixel_x, Quantity::of(value)),
            "unit" | "units" | "z unit" | "z units" | "unit z" | "height unit" | "height units"
            | "value units" | "value unit" | "werteinheiten" | "werteinheit" | "data unit" | "unit data" => {
                put(&mut self.value_unit, word())
            }
            "xy unit" | "lateral unit" | "lateral units" | "x unit" | "unit x" => {
                put(&mut self.width_unit, word())
            }
            "y unit" | "unit y" => put(&mut self.height_unit, word()),
            "w" | "nx" | "ncols" | "horizontal" | "columns" | "samples/line" | "points per line"
            | "number of columns" => put(&mut self.values_in_line, value.parse().ok()),
            "h" | "ny" | "nrows" | "vertical" | "rows" | "lines" | "number of lines" | "number of rows" => {
                put(&mut self.lines, value.parse().ok())
            }
            "channel" | "kanal" => put(&mut self.channel, word()),
            _ if small.starts_with("height conversion factor") => {
                // The unit follows an arrow, as in "height conversion factor (-> m)".
                let unit = key.split_once("->").map_or("", |(_, unit)| unit);
                put(&mut self.conversion, Quantity::of(&format!("{value} {unit}")))
            }
            _ => match along(small) {
                Some((true, Of::Size)) => put(&mut self.width, Quantity::of(value)),
                Some((false, Of::Size)) => put(&mut self.height, Quantity::of(value)),
                Some((true, Of::Pixel)) => put(pixel_x, Quantity::of(value)),
                Some((false, Of::Pixel)) => put(pixel_y, Quantity::of(value)),
                Some((true, Of::Count)) => put(&mut self.values_in_line, value.parse().ok()),
                Some((false, Of::Count)) => put(&mut self.lines, value.parse().ok()),
                None => Some(()),
            },
        }
        .ok_or_else(twice)
    }

    /// Takes in two numbers of points, as in `"Size","24","24"`, or one or two sizes.
    fn both(&mut self, value: &str) -> Option<()> {
        let words: Vec<&str> =
            value.split([' ', 'x', '\u{d7}', '*']).filter(|part| !part.is_empty()).collect();
        if let [Ok(columns), Ok(rows)] =
            words.iter().map(|word| word.parse()).collect::<Vec<Result<u64, _>>>()[..]
        {
            put(&mut self.values_in_line, Some(columns))?;
            return put(&mut self.lines, Some(rows));
        }
        let parts: Vec<Quantity> = value.split(['x', '\u{d7}', '*']).filter_map(Quantity::of).collect();
        let (Some(first), Some(last)) = (parts.first(), parts.last()) else { return Some(()) };
        let first = Quantity { value: first.value, unit: first.unit.clone().or_else(|| last.unit.clone()) };
        // A number alone may count anything.
        first.unit.as_ref().map_or(Some(()), |_| {
            put(&mut self.width, Some(first.clone()))?;
            put(&mut self.height, Some(last.clone()))
        })
    }

    /// Takes in the units of columns of points.
    pub(super) fn units_of_points(&mut self, x: &Column, y: &Column, z: &Column) {
        for (place, column) in
            [(&mut self.width_unit, x), (&mut self.height_unit, y), (&mut self.value_unit, z)]
        {
            *place = column.unit.clone().or_else(|| place.take());
        }
    }

    /// Takes in the unit of columns of heights, if they have one.
    pub(super) fn unit_of_heights(&mut self, columns: &[Column]) {
        let mut units = columns.iter().filter_map(|column| column.unit.as_ref());
        if let Some(unit) = units.next().filter(|first| units.all(|other| other == *first)) {
            self.value_unit.get_or_insert_with(|| unit.clone());
        }
    }

    /// Numbers in a line, if the heading states them.
    pub(super) fn width(&self) -> Option<u64> {
        self.values_in_line
    }

    /// Units and size for points on a grid with these spacings along x and y, in the numbers of the file.
    pub(super) fn of_points(&self, spacing: [f64; 2], [x, y]: [u64; 2]) -> Result<Meaning, Cause> {
        let (factor, unit) = self.scale()?;
        let of_x = self.width_unit.as_ref().or(unit);
        let of_y = self.height_unit.as_ref().or(of_x);
        let along = |spacing: f64, points: u64, unit| {
            size(Some(&Quantity { value: spacing * points as f64, unit: None }), unit)
        };
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

    /// Units and size of a matrix with the given numbers of lines and of values in a line.
    pub(super) fn meaning(&self, [lines, values]: [u64; 2]) -> Result<Meaning, Cause> {
        for (said, found, what) in
            [(self.lines, lines, "lines"), (self.values_in_line, values, "values in a line")]
        {
            if let Some(said) = said.filter(|said| *said != found) {
                return Err(format!("its heading says that it has {said} {what}, and it has {found}").into());
            }
        }
        let (factor, unit) = self.scale()?;
        // A unit that is said once for both directions, or for the heights alone, holds for all.
        let lateral = self.width_unit.as_ref().or(unit);
        let across = self.height_unit.as_ref().or(lateral);
        // So does a pixel size.
        let [along_x, along_y] = &self.pixel;
        let by_values = along_x.as_ref().or(along_y.as_ref()).map(|pixel| pixel.times(values));
        let by_lines = along_y.as_ref().or(along_x.as_ref()).map(|pixel| pixel.times(lines));
        let height = size(self.height.as_ref().or(by_lines.as_ref()), across)?;
        let width = size(self.width.as_ref().or(by_values.as_ref()), lateral)?;
        Ok(Meaning {
            factor,
            unit: unit.cloned(),
            size_m: width.zip(height).map(|(width, height)| [width, height]),
        })
    }
}

/// Quantity of an entry for one of the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Of {
    Size,
    Pixel,
    Count,
}

/// Axis (true for x) and quantity of an entry such as "pitch x" or "x-length".
fn along(small: &str) -> Option<(bool, Of)> {
    let x_first = |word: &str| match word {
        "x" => Some(true),
        "y" => Some(false),
        _ => None,
    };
    let (x, what) = match small {
        "dx" => (true, "spacing"),
        "dy" => (false, "spacing"),
        _ => {
            let (first, last) = (small.split_once(' '), small.rsplit_once(' '));
            let front = first.and_then(|(word, rest)| Some((x_first(word)?, rest)));
            front.or_else(|| last.and_then(|(rest, word)| Some((x_first(word)?, rest))))?
        }
    };
    let of = match what {
        "length" | "size" | "range" | "scan size" | "scan range" | "scan length" | "width" => Of::Size,
        "pitch" | "spacing" | "step" | "step size" | "increment" | "pixel size" | "pixel pitch" | "delta"
        | "sampling" => Of::Pixel,
        "pixels" | "points" | "pixel count" | "number of points" | "number of pixels" => Of::Count,
        _ => return None,
    };
    Some((x, of))
}

/// True for an entry that is a number with a unit.
fn is_size(small: &str) -> bool {
    let both = ["width", "breite", "height", "h\u{f6}he", "pixel size", "pitch", "spacing", "scan size"];
    both.contains(&small) || along(small).is_some_and(|(_, of)| of != Of::Count)
}

/// True if a text begins with a number with a comma before three digits.
fn has_ambiguous_comma(text: &str) -> bool {
    let rest = text.trim_start_matches(|sign: char| sign.is_ascii_digit() || matches!(sign, '+' | '-'));
    let Some(rest) = rest.strip_prefix(',').filter(|_| rest.len() < text.len()) else { return false };
    rest.bytes().take_while(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b',')).count() >= 3
        && quantity(text).is_none()
}

/// Puts an entry in its place; nothing, if another entry has the place.
fn put<T: PartialEq>(place: &mut Option<T>, entry: Option<T>) -> Option<()> {
    if entry.is_some() && place.is_some() {
        return None;
    }
    *place = entry.or_else(|| place.take());
    Some(())
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
