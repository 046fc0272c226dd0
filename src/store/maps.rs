//! Maps of gap and pressure in HDF5.

use super::attributes::{write_number, write_text};
use super::commit::{Written, commit};
use super::error::{Cause, StoreError};
use super::hdf5::{library, open, options_of};
use hdf5_metno::file::LibraryVersion;
use hdf5_metno::types::VarLenUnicode;
use hdf5_metno::{File, Group};
use ndarray::{Array2, ArrayView2};
use std::path::Path;

/// Version of the layout of a file of maps, raised whenever a dataset or attribute is renamed, removed, or
/// changes its meaning.
const MAPS_VERSION: u32 = 1;
/// Rows and columns of a chunk.
const CHUNK: usize = 256;
/// Compression level of deflate.
const LEVEL: u8 = 4;
/// Datasets of a map with their units.
pub const FIELDS: [(&str, &str); 2] = [("gap_m", "m"), ("pressure_pa", "Pa")];

/// Gap and pressure of one step on a square grid, rows along x.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactMap {
    /// Number of the step in the table `steps`.
    pub step: i64,
    /// `loading` or `unloading`.
    pub branch: &'static str,
    /// Load at the reversal, `F_max/(E* A0)`; NaN on loading, between reversals.
    pub max_load: f64,
    /// Mean penetration \[m\].
    pub approach_m: f64,
    /// Load \[N\].
    pub load_n: f64,
    /// Distance of two points of the map, in grid points of the file.
    pub stride: usize,
    /// Gap \[m\].
    pub gap_m: Vec<f32>,
    /// Pressure, compression positive \[Pa\].
    pub pressure_pa: Vec<f32>,
}

/// Identity of a file of maps.
#[derive(Debug, Clone, Copy)]
pub struct MapsHeader<'a> {
    /// Key of the cycle.
    pub key: &'a str,
    /// Identifier of the cycle.
    pub cycle_id: &'a str,
    /// Side of the square \[m\].
    pub length_m: f64,
    /// Grid points along a side.
    pub points: usize,
    /// Place of the first grid point along x and y, from the first point of the surface \[m\].
    pub first_m: f64,
    /// Gap below which a bonded point is in contact \[m\].
    pub contact_gap_m: f64,
}

/// Writes the maps of a cycle in place of `path`: one group for each step, with the datasets of [`FIELDS`].
///
/// # Errors
/// If a map has another number of points, or the file cannot be written whole.
pub fn write_maps(path: &Path, header: &MapsHeader<'_>, maps: &[ContactMap]) -> Result<Written, StoreError> {
    commit(
        "write the contact maps to",
        path,
        |temporary| library(|| write_all(temporary, header, maps)),
        |temporary| library(|| check_all(temporary, header, maps)),
    )
}

/// Maps at the ends of a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopMaps {
    /// Side of the square \[m\].
    pub length_m: f64,
    /// Gap below which a point is in contact \[m\].
    pub contact_gap_m: f64,
    /// Map at the load reversal.
    pub reversal: StoredMap,
    /// Map at the maximum tensile load; nothing if it is not stored.
    pub pull_off: Option<StoredMap>,
}

/// The maps at the load reversal `F_max/(E* A0)` and at the maximum tensile load of its unloading; nothing
/// without the first, and without the gap of contact.
///
/// # Errors
/// If the file cannot be read.
pub fn read_loop_maps(path: &Path, max_load: f64) -> Result<Option<LoopMaps>, StoreError> {
    let find = || -> Result<Option<LoopMaps>, Cause> {
        let file = open(path)?;
        // Files of the first builds lack it.
        let Ok(contact_gap_m) =
            file.attr("contact_gap_m").and_then(|attribute| attribute.read_scalar::<f64>())
        else {
            return Ok(None);
        };
        let (mut reversal, mut pull_off) = (None, None);
        let mut lowest = 0.0;
        for group in file.groups()? {
            let number = |name: &str| group.attr(name).and_then(|attribute| attribute.read_scalar::<f64>());
            if number("max_load")? != max_load {
                continue;
            }
            let load = number("load_n")?;
            if group.attr("branch")?.read_scalar::<VarLenUnicode>()?.as_str() == "loading" {
                reversal = Some(group);
            } else if load < lowest {
                (lowest, pull_off) = (load, Some(group));
            }
        }
        let Some(reversal) = reversal else { return Ok(None) };
        let length_m = file.attr("length_m")?.read_scalar()?;
        let pull_off = pull_off.as_ref().map(stored).transpose()?;
        Ok(Some(LoopMaps { length_m, contact_gap_m, reversal: stored(&reversal)?, pull_off }))
    };
    library(find).map_err(|cause| StoreError::new("read the contact maps from", path, cause))
}

/// Gap and pressure of a stored step, rows along x.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredMap {
    /// Number of the step in the table `steps`.
    pub step: i64,
    /// Gap \[m\].
    pub gap_m: Array2<f32>,
    /// Pressure, compression positive \[Pa\].
    pub pressure_pa: Array2<f32>,
}

/// All maps of a file, by step.
///
/// # Errors
/// If the file cannot be read.
pub fn read_maps(path: &Path) -> Result<Vec<StoredMap>, StoreError> {
    let read = || -> Result<Vec<StoredMap>, Cause> {
        let mut maps = Vec::new();
        for group in open(path)?.groups()? {
            maps.push(stored(&group)?);
        }
        maps.sort_by_key(|map| map.step);
        Ok(maps)
    };
    library(read).map_err(|cause| StoreError::new("read the contact maps from", path, cause))
}

/// The map of a group.
fn stored(group: &Group) -> Result<StoredMap, Cause> {
    let step = group.attr("step")?.read_scalar::<i64>()?;
    let [gap_m, pressure_pa] =
        [FIELDS[0].0, FIELDS[1].0].map(|name| group.dataset(name).and_then(|data| data.read_2d()));
    Ok(StoredMap { step, gap_m: gap_m?, pressure_pa: pressure_pa? })
}

/// Name of the group of a step.
fn group_name(map: &ContactMap) -> String {
    format!("step_{:06}", map.step)
}

fn fields(map: &ContactMap) -> [(&'static str, &'static str, &[f32]); 2] {
    let [gap, pressure] = FIELDS;
    [(gap.0, gap.1, &map.gap_m), (pressure.0, pressure.1, &map.pressure_pa)]
}

fn write_all(path: &Path, header: &MapsHeader<'_>, maps: &[ContactMap]) -> Result<(), Cause> {
    // Chunks of format 1.8: some readers do not support the index of chunks of later formats.
    let file = options_of(LibraryVersion::V18).create(path)?;
    write_number(&file, "schema_version", MAPS_VERSION)?;
    write_text(&file, "key", header.key)?;
    write_text(&file, "cycle_id", header.cycle_id)?;
    write_number(&file, "length_m", header.length_m)?;
    write_number(&file, "points", header.points as u64)?;
    write_number(&file, "contact_gap_m", header.contact_gap_m)?;
    if header.first_m != 0.0 {
        write_number(&file, "first_m", header.first_m)?;
    }
    for map in maps {
        let group = file.create_group_builder().obj_track_times(false).create(group_name(map).as_str())?;
        write_number(&group, "step", map.step)?;
        write_text(&group, "branch", map.branch)?;
        write_number(&group, "max_load", map.max_load)?;
        write_number(&group, "approach_m", map.approach_m)?;
        write_number(&group, "load_n", map.load_n)?;
        write_number(&group, "stride", map.stride as u64)?;
        for (name, unit, values) in fields(map) {
            write_field(&file, &group, header.points.div_ceil(map.stride), name, unit, values)?;
        }
    }
    file.flush()?;
    Ok(file.close()?)
}

fn write_field(
    file: &File,
    group: &Group,
    points: usize,
    name: &str,
    unit: &str,
    values: &[f32],
) -> Result<(), Cause> {
    let field = ArrayView2::from_shape((points, points), values)?;
    let chunk = CHUNK.min(points);
    let data = group
        .new_dataset::<f32>()
        .shape((points, points))
        .chunk((chunk, chunk))
        .shuffle()
        .deflate(LEVEL)
        .fletcher32()
        .create(name)?;
    write_text(&data, "unit", unit)?;
    data.write(field)?;
    // While the dataset is open: closing it writes what is buffered, and reports no error.
    Ok(file.flush()?)
}

fn check_all(path: &Path, header: &MapsHeader<'_>, maps: &[ContactMap]) -> Result<(), Cause> {
    let file = open(path)?;
    for map in maps {
        for (name, _, values) in fields(map) {
            let data = file.dataset(&format!("{}/{name}", group_name(map)))?;
            let same = data.get_shape()? == [header.points.div_ceil(map.stride); 2]
                && data.read_raw::<f32>()? == values;
            if !same {
                return Err("the content read back differs from the content written".into());
            }
        }
    }
    Ok(())
}
