//! Height fields in HDF5 files of other programs, NetCDF-4 among them.

use std::path::Path;

use hdf5_metno::types::{
    FixedAscii, FixedUnicode, FloatSize, IntSize, TypeDescriptor, VarLenArray, VarLenAscii, VarLenUnicode,
};
use hdf5_metno::{
    Container, Dataset, File, Group, IndexType, IterationOrder, LinkType, Location, LocationType,
    ObjectReference1, ReferencedObject,
};

use super::dataset::{HEIGHTS, check_storage, dataset, fields, is_topostats, only_field, points};
use super::error::{Cause, StoreError};
use super::hdf5::{check_bytes, library, open, values};
use super::heaps;
use super::scan::attributes::{Attributes, Value, decoded};
use super::scan::field::{Axis, Field};
use super::scan::numbers::Number;
use super::scan::{Asked, FirstIndex, MOST_POINTS, Scan};

/// A file cannot hold more than this many times its size: what deflate reaches on zeros.
const MOST_PACKED: u64 = 1100;
/// Attributes of an object, or members of a group, that are read; files with more have them for other
/// purposes.
const MOST_ENTRIES: usize = 256;
/// Numbers that an attribute may have to be kept: sizes are one or two.
const MOST_NUMBERS: usize = 16;
/// Bytes of a text that is kept.
const LONGEST_TEXT: usize = 1024;
/// Points of an axis whose coordinates are read.
const MOST_COORDINATES: usize = 1 << 20;
/// Beginning of the attribute `NAME` of a NetCDF dimension without coordinates.
const NO_COORDINATES: &str = "This is a netCDF dimension but not a netCDF variable";

/// Reads a height field from any HDF5 file, a measured one for instance, where missing points may be no
/// numbers. Without a name it is the only field in the root. Sizes and units are those of its attributes.
///
/// # Errors
/// If the file cannot be read, or has no two-dimensional dataset of numbers by that name.
pub fn read_scan(path: &Path, asked: &Asked<'_>) -> Result<Scan, StoreError> {
    library(|| {
        asked.of_text("HDF5")?;
        heaps::check(path)?;
        let file = open(path)?;
        let name = asked.field.map_or_else(|| only_field(&file), |name| Ok(name.to_owned()))?;
        let Some(data) = dataset(&file, &name)? else {
            return Err(format!(
                "no dataset {name:?}\nhelp: the root contains {}",
                file.member_names()?.join(", ")
            )
            .into());
        };
        field(path, &file, &name, &data)?.scan()
    })
    .map_err(|cause| StoreError::new("read the surface from", path, cause))
}

/// Names of the fields in the root of an HDF5 file, and the number of links that were visited to find them.
///
/// # Errors
/// If the file cannot be read.
pub fn search(path: &Path) -> Result<(Vec<String>, u64), StoreError> {
    library(|| {
        heaps::check(path)?;
        fields(&open(path)?).map(|found| (found.names, found.visits))
    })
    .map_err(|cause| StoreError::new("read the surface from", path, cause))
}

/// A dataset with everything that the file states of it.
fn field(path: &Path, file: &File, name: &str, data: &Dataset) -> Result<Field, Cause> {
    let shape = data.get_shape()?;
    let count = |place: usize| shape.get(place).copied().unwrap_or_default();
    let Some(places) = points(&shape) else {
        let kind = if shape.len() < 2 {
            "is not two-dimensional".to_owned()
        } else {
            format!("has {} dimensions instead of 2", shape.len())
        };
        return Err(format!("its dataset {name:?} {kind}").into());
    };
    let extent = places.map(count);
    check_bytes(path, data, extent, MOST_PACKED).map_err(|cause| format!("its dataset {name:?} {cause}"))?;
    let [rows, columns] = extent;
    if (rows as u64).saturating_mul(columns as u64) > MOST_POINTS {
        return Err(
            format!("dataset {name:?} has {rows} by {columns} values, more than the limit of 2^28").into()
        );
    }
    let kind = number(data, name)?;
    let groups = groups(file, name);
    let own = attributes(data);
    let netcdf = own.iter().any(|(name, _)| name == "DIMENSION_LIST" || name.starts_with("_Netcdf4"))
        || data.attr("DIMENSION_LIST").is_ok();
    let image = is_topostats(file) || own.text("CLASS") == Some("IMAGE");
    let levels = std::iter::once(own).chain(groups.iter().map(stated)).collect();
    let place = name.rfind('/').map_or("", |end| name.get(..=end).unwrap_or_default());
    let mask = match dataset(file, &format!("{place}{}", HEIGHTS[1]))? {
        Some(mask) if name.get(place.len()..) == Some(HEIGHTS[0]) && mask.get_shape()? == shape => {
            Some(values(&mask, extent)?)
        }
        _ => None,
    };
    let axes = match scales(data).filter(|scales| scales.len() == shape.len()) {
        Some(scales) => {
            [0, 1].map(|at| match (places.get(at).and_then(|place| scales.get(*place)), extent.get(at)) {
                (Some(Some(scale)), Some(points)) => axis(scale, *points),
                _ => Axis::default(),
            })
        }
        None => beside(file, place, extent),
    };
    Ok(Field {
        values: values(data, extent)?,
        kind,
        levels,
        axes,
        mask,
        first: if image { FirstIndex::Y } else { FirstIndex::X },
        netcdf,
        unit: is_topostats(file).then_some("nm"),
    })
}

/// Kind of the numbers of a dataset.
fn number(data: &Dataset, name: &str) -> Result<Number, Cause> {
    let kind = data.dtype()?;
    match kind.to_descriptor() {
        Ok(TypeDescriptor::Integer(size)) => Ok(signed(size)),
        Ok(TypeDescriptor::Unsigned(size)) => Ok(unsigned(size)),
        Ok(TypeDescriptor::Float(FloatSize::U4)) => Ok(Number::F32),
        // Half and quadruple precision, which the library converts.
        Ok(TypeDescriptor::Float(_)) | Err(_) => Ok(Number::F64),
        Ok(other) => Err(format!(
            "its dataset {name:?} has values of the type {other}\nhelp: heights must be real numbers"
        )
        .into()),
    }
}

const fn signed(size: IntSize) -> Number {
    match size {
        IntSize::U1 => Number::I8,
        IntSize::U2 => Number::I16,
        IntSize::U4 => Number::I32,
        IntSize::U8 => Number::I64,
    }
}

const fn unsigned(size: IntSize) -> Number {
    match size {
        IntSize::U1 => Number::U8,
        IntSize::U2 => Number::U16,
        IntSize::U4 => Number::U32,
        IntSize::U8 => Number::U64,
    }
}

/// The groups of a dataset from the inside to the root.
fn groups(file: &File, name: &str) -> Vec<Group> {
    let parts: Vec<&str> = name.split('/').filter(|part| !part.is_empty() && *part != ".").collect();
    let mut groups = vec![Group::clone(file)];
    for part in parts.iter().rev().skip(1).rev() {
        match groups.last().map(|group| group.group(part)) {
            Some(Ok(inner)) => groups.push(inner),
            _ => break,
        }
    }
    groups.reverse();
    groups
}

/// Attributes of a group, and its datasets of one value, in which some programs keep what others keep in
/// attributes.
fn stated(group: &Group) -> Attributes {
    let mut found = attributes(group);
    if group.len() as usize > MOST_ENTRIES {
        return found;
    }
    for (name, info) in group.links(IndexType::Name, IterationOrder::Native).unwrap_or_default() {
        let is_dataset = info.link_type == LinkType::Hard
            && group.loc_type_by_name(&name).is_ok_and(|kind| kind == LocationType::Dataset);
        let Some(data) = is_dataset.then(|| group.dataset(&name).ok()).flatten() else { continue };
        if data.size() == 1 && check_storage(&data, &name).is_ok() {
            found.extend(name, value(&data));
        }
    }
    found
}

/// Attributes of an object that are text or numbers.
fn attributes(of: &Location) -> Attributes {
    let mut found = Attributes::default();
    for name in of.attr_names().unwrap_or_default().into_iter().take(MOST_ENTRIES) {
        if let Ok(attribute) = of.attr(&name) {
            found.extend(name, value(&attribute));
        }
    }
    found
}

/// Value of an attribute or of a small dataset, if it is a text or a few numbers.
fn value(of: &Container) -> Option<Value> {
    let size = of.size();
    if size == 0 || size > MOST_NUMBERS {
        return None;
    }
    let numbers = |kind: Number| of.read_raw::<f64>().ok().map(|values| Value::Numbers(values, kind));
    let text = |bytes: &[u8]| Value::Text(decoded(bytes).trim_matches(['\0', ' ']).to_owned());
    match of.dtype().ok()?.to_descriptor().ok()? {
        TypeDescriptor::Integer(size) => numbers(signed(size)),
        TypeDescriptor::Unsigned(size) => numbers(unsigned(size)),
        TypeDescriptor::Float(FloatSize::U4) => numbers(Number::F32),
        TypeDescriptor::Float(_) => numbers(Number::F64),
        TypeDescriptor::Boolean => {
            let flags = of.read_raw::<i8>().ok()?;
            Some(Value::Numbers(flags.into_iter().map(f64::from).collect(), Number::I8))
        }
        TypeDescriptor::FixedAscii(length) if length <= LONGEST_TEXT => {
            of.read_raw::<FixedAscii<LONGEST_TEXT>>().ok()?.first().map(|found| text(found.as_bytes()))
        }
        TypeDescriptor::FixedUnicode(length) if length <= LONGEST_TEXT => {
            of.read_raw::<FixedUnicode<LONGEST_TEXT>>().ok()?.first().map(|found| text(found.as_bytes()))
        }
        TypeDescriptor::VarLenAscii => {
            of.read_raw::<VarLenAscii>().ok()?.first().map(|found| text(found.as_bytes()))
        }
        TypeDescriptor::VarLenUnicode => {
            of.read_raw::<VarLenUnicode>().ok()?.first().map(|found| text(found.as_bytes()))
        }
        _ => None,
    }
}

/// Axes of a field without dimension scales: the datasets `x` and `y` of its group, if the numbers of their
/// points fit.
fn beside(file: &File, place: &str, extent: [usize; 2]) -> [Axis; 2] {
    let beside = |names: [&str; 2]| names.map(|name| dataset(file, &format!("{place}{name}")).ok().flatten());
    let found = [["x", "y"], ["X", "Y"], ["x_m", "y_m"]]
        .into_iter()
        .map(beside)
        .find(|found| found.iter().all(Option::is_some));
    let Some([Some(x), Some(y)]) = found else { return [Axis::default(), Axis::default()] };
    match [x.size(), y.size()] {
        sizes if sizes == extent => [axis(&x, x.size()), axis(&y, y.size())],
        [columns, rows] if [rows, columns] == extent => [axis(&y, rows), axis(&x, columns)],
        _ => [Axis::default(), Axis::default()],
    }
}

/// The first dimension scale of each dimension.
fn scales(data: &Dataset) -> Option<Vec<Option<Dataset>>> {
    let lists = data.attr("DIMENSION_LIST").ok()?.read_raw::<VarLenArray<ObjectReference1>>().ok()?;
    let scale = |list: VarLenArray<ObjectReference1>| match data.dereference(list.as_slice().first()?).ok()? {
        ReferencedObject::Dataset(scale) => check_storage(&scale, "scale").is_ok().then_some(scale),
        _ => None,
    };
    Some(lists.into_iter().map(scale).collect())
}

/// An axis by its dataset of coordinates.
fn axis(scale: &Dataset, points: usize) -> Axis {
    let attributes = attributes(scale);
    let label = attributes.text("NAME").unwrap_or_default();
    let none = label.starts_with(NO_COORDINATES);
    let path = scale.name();
    let name = match path.rsplit('/').next() {
        Some(name) if !name.is_empty() => name.to_owned(),
        _ if none => String::new(),
        _ => label.to_owned(),
    };
    let readable = !none
        && scale.ndim() == 1
        && scale.size() == points
        && points <= MOST_COORDINATES
        && number(scale, &name).is_ok();
    let coordinates = readable.then(|| scale.read_raw::<f64>().ok()).flatten();
    Axis { name, attributes, coordinates }
}
