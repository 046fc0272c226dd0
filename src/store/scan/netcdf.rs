//! Classic NetCDF, in the layout of the Python package SurfaceTopography.
//!
//! Heights are in a variable `heights` over the dimensions x and y, or in the only two-dimensional variable.
//! Points are missing where a variable `mask` is not 0. The meaning of all attributes is that of [`Field`].

use std::io::{Seek, SeekFrom};

use ndarray::Array2;

use super::field::{Axis, Field};
use super::netcdf_header::{Header, Variable, padding};
use super::numbers::{Order, points, room, shaped, stream};
use super::{Cause, FirstIndex, Scan, Source};

/// Default variable with the heights.
const HEIGHTS: &str = "heights";
/// Variable that marks missing points.
const MASK: &str = "mask";
/// Points of an axis whose coordinates are read.
const MOST_COORDINATES: u64 = 1 << 20;

/// True for heights along one dimension.
pub(super) fn is_line(mut source: Source) -> Result<bool, Cause> {
    let header = Header::read(&mut source)?;
    let heights = header.variables.iter().find(|variable| variable.name == HEIGHTS);
    Ok(heights.is_some_and(|heights| heights.dimensions.len() == 1))
}

/// Reads a variable as heights.
pub(super) fn read(mut source: Source, variable: Option<&str>) -> Result<Scan, Cause> {
    let header = Header::read(&mut source)?;
    let name = variable.map_or_else(|| header.heights(), Ok)?;
    let variable = header.variable(name)?;
    let kind = variable.kind.ok_or_else(|| format!("variable {name:?} is text"))?;
    let axes = header.axes(variable)?;
    let values = header.field(&mut source, variable)?;
    header.check_whole(source.length)?;
    let mask = match header.variables.iter().find(|other| name == HEIGHTS && other.name == MASK) {
        Some(mask) if mask.dimensions != variable.dimensions => {
            return Err(format!("variable {MASK:?} has other dimensions than variable {name:?}").into());
        }
        Some(mask) => Some(header.field(&mut source, mask)?),
        None => None,
    };
    let mut along = Vec::new();
    for axis in axes {
        along.push(header.axis(&mut source, axis)?);
    }
    let [first, second] = along.try_into().map_err(|_| "not two axes")?;
    let levels = vec![variable.attributes.clone(), header.attributes];
    Field {
        values,
        kind,
        levels,
        axes: [first, second],
        mask,
        first: FirstIndex::X,
        netcdf: true,
        unit: None,
    }
    .scan()
}

impl Header {
    fn variable(&self, name: &str) -> Result<&Variable, Cause> {
        self.variables.iter().find(|variable| variable.name == name).ok_or_else(|| {
            let fields: Vec<_> =
                self.variables.iter().filter(|other| other.dimensions.len() == 2).take(9).collect();
            let names: Vec<_> = fields.iter().map(|field| format!("{:?}", field.name)).collect();
            let there = if names.is_empty() { "no two-dimensional one".to_owned() } else { names.join(", ") };
            format!("no variable {name:?}\nhelp: use one of {there}").into()
        })
    }

    /// Name of the height field: `heights`, or the only field of numbers.
    fn heights(&self) -> Result<&str, Cause> {
        let fields: Vec<_> =
            self.variables.iter().filter(|other| other.kind.is_some() && self.axes(other).is_ok()).collect();
        match fields[..] {
            [only] => Ok(&only.name),
            _ => Ok(HEIGHTS),
        }
    }

    /// Points along a dimension.
    fn points(&self, place: usize) -> u64 {
        self.dimensions
            .get(place)
            .map_or(0, |dimension| if dimension.length == 0 { self.records } else { dimension.length })
    }

    /// Places of the two dimensions of a field; those with a single point, such as a time, do not count
    /// beyond two.
    fn axes(&self, variable: &Variable) -> Result<[usize; 2], Cause> {
        let count = variable.dimensions.len();
        let mut places = variable.dimensions.clone();
        while let Some(single) =
            places.iter().position(|place| self.points(*place) == 1).filter(|_| places.len() > 2)
        {
            places.remove(single);
        }
        places
            .try_into()
            .map_err(|_| format!("variable {:?} has {count} dimensions instead of 2", variable.name).into())
    }

    /// The axis of a dimension, which the variable of its name describes.
    fn axis(&self, source: &mut Source, place: usize) -> Result<Axis, Cause> {
        let Some(dimension) = self.dimensions.get(place) else { return Ok(Axis::default()) };
        let of =
            self.variables.iter().find(|other| other.name == dimension.name && other.dimensions == [place]);
        let coordinates = match of {
            Some(of) if of.kind.is_some() && self.points(place) <= MOST_COORDINATES => {
                Some(self.numbers(source, of, [self.points(place), 1])?)
            }
            _ => None,
        };
        let attributes = of.map(|of| of.attributes.clone()).unwrap_or_default();
        Ok(Axis { name: dimension.name.clone(), attributes, coordinates })
    }

    /// True if a variable has a part of itself in every record.
    fn grows(&self, variable: &Variable) -> bool {
        variable
            .dimensions
            .first()
            .and_then(|place| self.dimensions.get(*place))
            .is_some_and(|dimension| dimension.length == 0)
    }

    /// Bytes of a variable, or of its part in one record.
    fn bytes(&self, variable: &Variable) -> Option<u64> {
        let width = variable.kind.map_or(1, |kind| kind.width() as u64);
        let own = variable.dimensions.iter().skip(usize::from(self.grows(variable)));
        own.filter_map(|place| self.dimensions.get(*place))
            .try_fold(width, |bytes, dimension| bytes.checked_mul(dimension.length))
    }

    /// Bytes from one record to the next.
    fn record(&self) -> Option<u64> {
        let growing: Vec<_> = self.variables.iter().filter(|variable| self.grows(variable)).collect();
        match growing[..] {
            // A single one is not padded, by the format's own exception.
            [only] => self.bytes(only),
            _ => growing.iter().try_fold(0_u64, |sum, variable| {
                let bytes = self.bytes(variable)?;
                sum.checked_add(bytes.checked_add(padding(bytes))?)
            }),
        }
    }

    /// Makes sure that no variable ends behind the end of the file, which was cut short if one does.
    fn check_whole(&self, length: u64) -> Result<(), Cause> {
        let end = |variable: &Variable| {
            let parts = if self.grows(variable) { self.records } else { 1 };
            let last = if parts > 1 { self.record()?.checked_mul(parts - 1)? } else { 0 };
            if parts == 0 {
                Some(0)
            } else {
                last.checked_add(self.bytes(variable)?)?.checked_add(variable.begin)
            }
        };
        match self.variables.iter().find(|variable| end(variable).is_none_or(|end| end > length)) {
            None => Ok(()),
            Some(cut) => {
                let problem = "it was probably truncated\nhelp: copy or download the file again";
                Err(format!("the file ends within variable {:?}; {problem}", cut.name).into())
            }
        }
    }

    /// The numbers of a field.
    fn field(&self, source: &mut Source, variable: &Variable) -> Result<Array2<f64>, Cause> {
        let [rows, columns] = self.axes(variable)?.map(|place| self.points(place));
        points(rows, columns)?;
        let values = self.numbers(source, variable, [rows, columns])?;
        shaped([rows, columns], values)
    }

    /// The numbers of a variable of this extent.
    fn numbers(
        &self,
        source: &mut Source,
        variable: &Variable,
        [rows, columns]: [u64; 2],
    ) -> Result<Vec<f64>, Cause> {
        let name = &variable.name;
        let kind = variable.kind.ok_or_else(|| format!("variable {name:?} is text"))?;
        let count = rows.checked_mul(columns).ok_or("its extent is too large")?;
        // A variable that grows has a part of itself in every record.
        let parts = if self.grows(variable) { self.records } else { 1 };
        let each = count.checked_div(parts).unwrap_or(0);
        let part = each.checked_mul(kind.width() as u64);
        let step = if parts > 1 { self.record() } else { part };
        let end = step.zip(part).and_then(|(step, part)| {
            step.checked_mul(parts.saturating_sub(1))?.checked_add(part)?.checked_add(variable.begin)
        });
        let (Some(step), Some(part), Some(_)) = (step, part, end.filter(|end| *end <= source.length)) else {
            return Err(format!(
                "variable {name:?} claims {rows} by {columns} values, more than {} bytes can hold",
                source.length
            )
            .into());
        };
        let mut values = room(count)?;
        source.file.seek(SeekFrom::Start(variable.begin))?;
        if step == part {
            stream(&mut source.file, kind, Order::Big, count, |value| values.push(value))?;
        } else {
            for _ in 0..parts {
                stream(&mut source.file, kind, Order::Big, each, |value| values.push(value))?;
                source.file.seek_relative(i64::try_from(step)? - i64::try_from(part)?)?;
            }
        }
        Ok(values)
    }
}
