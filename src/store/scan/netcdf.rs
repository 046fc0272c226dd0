//! Classic NetCDF, in the layout of the Python package SurfaceTopography.
//!
//! Heights stand in a variable `heights` over the dimensions x and y. The size, whether the surface is periodic, and
//! the unit of it all are attributes `length`, `periodic` and `unit` of the variables x and y. Missing points have a
//! byte other than 0 in a variable `mask`, or the value that the attributes of the heights give for them.

use std::io::{Seek, SeekFrom};

use ndarray::Array2;

use super::netcdf_header::{Header, Variable, padding};
use super::numbers::{Number, Order, points, room, shaped, stream};
use super::{Cause, Scan, Source, units};

/// The variable with the heights, unless another one is asked for.
const HEIGHTS: &str = "heights";
/// The variable that says which points are missing.
const MASK: &str = "mask";
/// Fill values of NetCDF.
const NEVER_WRITTEN: f64 = f64::from_bits(0x479e_0000_0000_0000);

/// Reads a variable as heights.
pub(super) fn read(mut source: Source, variable: Option<&str>) -> Result<Scan, Cause> {
    let header = Header::read(&mut source)?;
    let name = variable.unwrap_or(HEIGHTS);
    let variable = header.variable(name)?;
    let axes = header.axes(variable)?;
    // Each dimension is described by the variable of its name.
    let [along_x, along_y] = axes.map(|axis| header.variables.iter().find(|other| other.name == axis && other.dimensions.len() == 1));

    let mut heights = header.field(&mut source, variable)?;
    header.check_whole(source.length)?;
    let missing = Missing::of(variable);
    let scale = variable.number("scale_factor").unwrap_or(1.0);
    let offset = variable.number("add_offset").unwrap_or(0.0);
    // The package has one unit for sizes and heights. Each one's own comes first, for files in which they differ.
    let lateral = [along_x, along_y].into_iter().flatten().find_map(unit_of);
    let unit = unit_of(variable).or(lateral).map(ToOwned::to_owned);
    let metres = unit.as_deref().map_or(Ok(1.0), |unit| units::length("the heights are", unit))?;
    for height in &mut heights {
        *height = if missing.is(*height) {
            f64::NAN
        } else if variable.number("add_offset").is_some() {
            (*height * scale + offset) * metres
        } else {
            *height * scale * metres
        };
    }
    if let Some(mask) = header.variables.iter().find(|other| name == HEIGHTS && other.name == MASK) {
        if mask.dimensions != variable.dimensions {
            return Err(format!("variable {MASK:?} has other dimensions than variable {name:?}").into());
        }
        heights.zip_mut_with(&header.field(&mut source, mask)?, |height, missing| {
            if missing.abs() > 0.0 {
                *height = f64::NAN;
            }
        });
    }

    let size = [along_x, along_y].map(|axis| size(axis?, unit.as_deref()));
    let size_m = match size {
        [Some(x), Some(y)] => Some([x?, y?]),
        _ => None,
    };
    let said: Vec<_> = [along_x, along_y].into_iter().flatten().filter_map(|axis| axis.number("periodic")).collect();
    let periodic = (!said.is_empty()).then(|| said.iter().all(|periodic| periodic.abs() > 0.0));
    Ok(Scan { heights, size_m, unit, factor: scale * metres, periodic, spacing: None })
}

fn unit_of(variable: &Variable) -> Option<&str> {
    variable.text("unit").or_else(|| variable.text("units"))
}

/// Size along an axis \[m\].
fn size(axis: &Variable, otherwise: Option<&str>) -> Option<Result<f64, Cause>> {
    let length = axis.number("length")?;
    let unit = unit_of(axis).or(otherwise)?;
    let what = format!("the size along {:?} is", axis.name);
    Some(units::length(&what, unit).and_then(|metres| {
        let size = length * metres;
        if size.is_finite() && size > 0.0 { Ok(size) } else { Err(format!("{what} {length} {unit}, and must be positive").into()) }
    }))
}

/// Which values stand for missing points.
struct Missing {
    value: Option<f64>,
}

impl Missing {
    fn of(variable: &Variable) -> Self {
        let said = variable.number("_FillValue").or_else(|| variable.number("missing_value"));
        Self {
            value: match variable.kind {
                // The attribute can be wider than the numbers that are compared with it.
                Some(Number::F32) => Some(said.map_or(NEVER_WRITTEN, |value| f64::from(value as f32))),
                Some(Number::F64) => Some(said.unwrap_or(NEVER_WRITTEN)),
                _ => said,
            },
        }
    }

    fn is(&self, value: f64) -> bool {
        value.is_nan() || self.value == Some(value)
    }
}

impl Header {
    fn variable(&self, name: &str) -> Result<&Variable, Cause> {
        self.variables.iter().find(|variable| variable.name == name).ok_or_else(|| {
            let fields: Vec<_> = self.variables.iter().filter(|other| other.dimensions.len() == 2).take(9).collect();
            let names: Vec<_> = fields.iter().map(|field| format!("{:?}", field.name)).collect();
            let there = if names.is_empty() { "no two-dimensional one".to_owned() } else { names.join(", ") };
            format!("no variable {name:?}\nhelp: use one of {there}").into()
        })
    }

    /// Names of the two dimensions of a field.
    fn axes(&self, variable: &Variable) -> Result<[&str; 2], Cause> {
        let names: Vec<_> = variable.dimensions.iter().filter_map(|place| Some(self.dimensions.get(*place)?.name.as_str())).collect();
        names.try_into().map_err(|names: Vec<_>| format!("variable {:?} has {} dimensions instead of 2", variable.name, names.len()).into())
    }

    /// True if a variable has a part of itself in every record.
    fn grows(&self, variable: &Variable) -> bool {
        variable.dimensions.first().and_then(|place| self.dimensions.get(*place)).is_some_and(|dimension| dimension.length == 0)
    }

    /// Bytes of a variable, or of its part in one record.
    fn bytes(&self, variable: &Variable) -> Option<u64> {
        let width = variable.kind.map_or(1, |kind| kind.width() as u64);
        let own = variable.dimensions.iter().skip(usize::from(self.grows(variable)));
        own.filter_map(|place| self.dimensions.get(*place)).try_fold(width, |bytes, dimension| bytes.checked_mul(dimension.length))
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
            if parts == 0 { Some(0) } else { last.checked_add(self.bytes(variable)?)?.checked_add(variable.begin) }
        };
        match self.variables.iter().find(|variable| end(variable).is_none_or(|end| end > length)) {
            None => Ok(()),
            Some(cut) => Err(format!("the file ends within variable {:?}; it was probably truncated", cut.name).into()),
        }
    }

    /// The numbers of a two-dimensional variable.
    fn field(&self, source: &mut Source, variable: &Variable) -> Result<Array2<f64>, Cause> {
        let name = &variable.name;
        let kind = variable.kind.ok_or_else(|| format!("variable {name:?} is text"))?;
        let lengths: Vec<_> = variable.dimensions.iter().filter_map(|place| Some(self.dimensions.get(*place)?.length)).collect();
        let [first, columns] = lengths[..] else {
            return Err(format!("variable {name:?} is not two-dimensional").into());
        };
        let grows = self.grows(variable);
        let rows = if grows { self.records } else { first };
        let count = points(rows, columns)?;
        let row = columns * kind.width() as u64;
        let step = if grows { self.record() } else { Some(row) };
        let end = step.and_then(|step| step.checked_mul(rows - 1)?.checked_add(row)?.checked_add(variable.begin));
        let (Some(step), Some(_)) = (step, end.filter(|end| *end <= source.length)) else {
            return Err(format!("variable {name:?} claims {rows} by {columns} values, more than {} bytes can hold", source.length).into());
        };
        let mut values = room(count)?;
        source.file.seek(SeekFrom::Start(variable.begin))?;
        if step == row {
            stream(&mut source.file, kind, Order::Big, count, |value| values.push(value))?;
        } else {
            for _ in 0..rows {
                stream(&mut source.file, kind, Order::Big, columns, |value| values.push(value))?;
                source.file.seek_relative(i64::try_from(step)? - i64::try_from(row)?)?;
            }
        }
        shaped([rows, columns], values)
    }
}
