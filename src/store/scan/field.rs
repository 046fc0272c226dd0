//! A height field as a self-describing format stores it, and its meaning by the attributes of the field and
//! its axes.
//!
//! The rules are the same for NetCDF-3, NetCDF-4 and HDF5: packed and missing values by the CF conventions,
//! units as `unit` or `units`, sizes from the coordinates along the axes, from the attribute
//! `length` of SurfaceTopography, or from attributes such as `pixel_size_m` of the field, its groups or the
//! root of the file.

use ndarray::Array2;

use super::attributes::Attributes;
use super::numbers::Number;
use super::packing::Packing;
use super::stated::{self, Pixel};
use super::{Cause, FirstIndex, Scan, units};
use crate::lengths::{SAME_SIZE, metres};

/// Deviation of a coordinate from even spacing, as a fraction of the spacing; single precision over 4096
/// points gives 2e-4.
const UNEVEN: f64 = 1e-2;

/// A two-dimensional variable or dataset.
pub(crate) struct Field {
    /// Numbers in the order of the file.
    pub(crate) values: Array2<f64>,
    /// Kind of these numbers in the file.
    pub(crate) kind: Number,
    /// Attributes of the field, then of its groups from the inside to the root.
    pub(crate) levels: Vec<Attributes>,
    /// Axes of the first and of the second index.
    pub(crate) axes: [Axis; 2],
    /// Other than 0 where a point is missing, in the order of the file.
    pub(crate) mask: Option<Array2<f64>>,
    /// Axis of the first index, where the names of the axes do not state it.
    pub(crate) first: FirstIndex,
    /// True for NetCDF, which has fill values by default.
    pub(crate) netcdf: bool,
    /// Unit of the heights where no attribute states it, by the format.
    pub(crate) unit: Option<&'static str>,
}

/// An axis of a field.
#[derive(Default)]
pub(crate) struct Axis {
    /// Name, if it has one.
    pub(crate) name: String,
    /// Attributes of the coordinates.
    pub(crate) attributes: Attributes,
    /// Coordinates of the points.
    pub(crate) coordinates: Option<Vec<f64>>,
}

impl Axis {
    /// True for x, false for y; nothing if neither the attributes nor the name state it.
    fn is_x(&self) -> Option<bool> {
        match self.attributes.text("axis").map(str::to_ascii_lowercase).as_deref() {
            Some("x") => return Some(true),
            Some("y") => return Some(false),
            _ => {}
        }
        let standard = self.attributes.text("standard_name").unwrap_or_default();
        let name = self.name.to_ascii_lowercase();
        for text in [standard, &name] {
            if text.contains("x_coordinate")
                || ["longitude", "lon", "easting", "column", "columns", "cols"].contains(&text)
            {
                return Some(true);
            }
            if text.contains("y_coordinate")
                || ["latitude", "lat", "northing", "row", "rows", "line", "lines"].contains(&text)
            {
                return Some(false);
            }
        }
        let mut signs = name.chars();
        let first = signs.next();
        if signs.next().is_some_and(char::is_alphabetic) {
            return ["xpos", "xaxis", "ypos", "yaxis"]
                .iter()
                .find(|known| name.starts_with(*known))
                .map(|known| known.starts_with('x'));
        }
        first.filter(|sign| matches!(sign, 'x' | 'y')).map(|sign| sign == 'x')
    }

    /// Spacing of evenly spaced coordinates.
    fn spacing(&self, points: usize) -> Option<f64> {
        let at = self.coordinates.as_ref().filter(|at| at.len() == points && points > 1)?;
        let (first, last) = (*at.first()?, *at.last()?);
        let spacing = (last - first) / (points - 1) as f64;
        let even = |(place, value): (usize, &f64)| {
            (value - first - spacing * place as f64).abs() <= UNEVEN * spacing.abs()
        };
        (spacing.is_finite() && spacing.abs() > 0.0 && at.iter().enumerate().all(even))
            .then_some(spacing.abs())
    }

    /// Pixel size along this axis by its coordinates or by its attribute `length`; an error if that is no
    /// length.
    fn pixel(&self, points: usize, otherwise: Option<&str>) -> Result<Option<Pixel>, Cause> {
        let unit = self.attributes.unit().or(otherwise);
        let spacing = self.spacing(points);
        let length =
            self.attributes.numbers("length").and_then(|(values, kind)| Some((*values.first()?, kind)));
        let Some((length, kind)) = length else {
            let known = unit.map(metres);
            // Degrees, for example, are no lengths.
            let pixel = |value| Pixel { value, extent: value * points as f64, metres: known.flatten() };
            return Ok(spacing.filter(|_| known != Some(None)).map(pixel));
        };
        let what = format!("the size along {:?} is", self.name);
        let metres = unit.map(|unit| units::length(&what, unit)).transpose()?;
        if !(length > 0.0 && length.is_finite()) {
            return Err(format!("{what} {length} {}, and must be positive", unit.unwrap_or_default()).into());
        }
        let stated = length / points as f64;
        // Coordinates in double precision are more precise than a length in single precision.
        Ok(Some(match spacing {
            Some(value) if kind == Number::F32 && (value / stated - 1.0).abs() < SAME_SIZE => {
                Pixel { value, extent: value * points as f64, metres }
            }
            _ => Pixel { value: stated, extent: length, metres },
        }))
    }
}

impl Field {
    /// Heights along x and y, with size and unit.
    pub(crate) fn scan(mut self) -> Result<Scan, Cause> {
        let own = self.levels.first().cloned().unwrap_or_default();
        let packing = Packing::of(&own, self.kind, self.netcdf)?;
        let unit = self.unit_of_heights(&own);
        let factor = unit.as_deref().map_or(Ok(1.0), |unit| units::length("the heights are", unit))?;
        self.values.mapv_inplace(|stored| packing.value(stored) * factor);
        if let Some(mask) = &self.mask {
            self.values.zip_mut_with(mask, |height, missing| {
                if missing.abs() > 0.0 {
                    *height = f64::NAN;
                }
            });
        }
        let x_first = self.x_is_first();
        let (mut pixels, notes) = self.pixels(unit.as_deref(), x_first)?;
        let periodic = self.periodic();
        if !x_first {
            pixels = pixels.map(|[first, second]| [second, first]);
        }
        let size = |pixel: Pixel| Some(pixel.extent * pixel.metres?);
        let size_m = pixels.and_then(|[x, y]| Some([size(x)?, size(y)?]));
        let spacing = pixels.filter(|_| size_m.is_none()).map(|pixels| pixels.map(|pixel| pixel.value));
        let heights = if x_first { self.values } else { super::numbers::turned(self.values)? };
        let first = if x_first { FirstIndex::X } else { FirstIndex::Y };
        Ok(Scan { heights, size_m, unit, factor: packing.scale * factor, periodic, spacing, first, notes })
    }

    /// Unit of the heights: stated by the field, by an axis in the layout of SurfaceTopography, by a group,
    /// or by the format.
    fn unit_of_heights(&self, own: &Attributes) -> Option<String> {
        if let Some(unit) = stated::unit_of_heights(own) {
            return Some(unit.to_owned());
        }
        // SurfaceTopography has one unit for sizes and heights, as the attribute `unit` of x; `units` holds
        // for the coordinates alone.
        let lateral = || self.axes.iter().find_map(|axis| axis.attributes.text("unit"));
        let outer = || {
            self.levels.iter().skip(1).filter_map(stated::unit_of_heights).find(|unit| metres(unit).is_some())
        };
        lateral().or_else(outer).or(self.unit).map(ToOwned::to_owned)
    }

    /// True if the first index runs along x.
    fn x_is_first(&self) -> bool {
        match self.axes.each_ref().map(Axis::is_x) {
            [Some(first), other] if other != Some(first) => first,
            [None, Some(second)] => !second,
            _ => self.first == FirstIndex::X,
        }
    }

    /// Pixel sizes along the first and the second index, and notes on statements that are not used.
    fn pixels(&self, unit: Option<&str>, x_first: bool) -> Result<(Option<[Pixel; 2]>, Vec<String>), Cause> {
        let counts = [self.values.nrows(), self.values.ncols()];
        let [first, second] = [0, 1].map(|at| {
            self.axes.get(at).map_or(Ok(None), |axis| axis.pixel(*counts.get(at).unwrap_or(&0), unit))
        });
        let mut all = Vec::new();
        if let (Some(first), Some(second)) = (first?, second?) {
            all.push(("the coordinates".to_owned(), [first, second]));
        }
        let along = |[a, b]: [usize; 2]| if x_first { [a, b] } else { [b, a] };
        for (name, [x, y]) in stated::pixels(&self.levels, along(counts)) {
            all.push((name, if x_first { [x, y] } else { [y, x] }));
        }
        // One unit, if only one is stated, holds for heights and sizes.
        let known = unit.and_then(metres);
        for (_, pixels) in &mut all {
            for pixel in pixels.iter_mut() {
                pixel.metres = pixel.metres.or(known);
            }
        }
        let Some((name, chosen)) = all.first().cloned() else { return Ok((None, Vec::new())) };
        let differs = |other: &[Pixel; 2]| {
            chosen.iter().zip(other).any(|(a, b)| (a.size() / b.size() - 1.0).abs() > SAME_SIZE)
        };
        match all.iter().find(|(_, other)| differs(other)) {
            None => Ok((Some(chosen), Vec::new())),
            Some((other, pixels)) => Ok((
                None,
                vec![format!(
                    "sizes: {name} and {other} of the file contradict each other (pixels of {:e} and {:e}), \
                     so that neither is used",
                    chosen.first().map_or(0.0, Pixel::size),
                    pixels.first().map_or(0.0, Pixel::size)
                )],
            )),
        }
    }

    /// True if all axes that state it are periodic.
    fn periodic(&self) -> Option<bool> {
        let stated: Vec<_> = self.axes.iter().filter_map(|axis| axis.attributes.number("periodic")).collect();
        (!stated.is_empty()).then(|| stated.iter().all(|periodic| periodic.abs() > 0.0))
    }
}
