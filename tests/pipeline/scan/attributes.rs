//! Attributes of NetCDF and HDF5: one meaning in every format.

use std::path::Path;

use hdf5_metno::types::{FixedAscii, VarLenArray, VarLenUnicode};
use hdf5_metno::{File, H5Type, Location, ObjectReference as _, ObjectReference1};
use hysteron::store::hdf5_scan::{read_scan, search};
use hysteron::store::scan::{Asked, FirstIndex, Format, Scan};
use ndarray::{Array2, array};

use super::make::{Cdf, Said, Variable, big};
use super::{same, scan_of};

fn number<T: H5Type>(place: &Location, name: &str, value: T) {
    place.new_attr::<T>().create(name).unwrap().write_scalar(&value).unwrap();
}

fn pair(place: &Location, name: &str, values: [f64; 2]) {
    place.new_attr::<f64>().shape(2).create(name).unwrap().write(&values).unwrap();
}

fn word(place: &Location, name: &str, text: &str) {
    place.new_attr::<VarLenUnicode>().create(name).unwrap().write_scalar(&text.parse::<VarLenUnicode>().unwrap()).unwrap();
}

fn fixed(place: &Location, name: &str, text: &str) {
    place.new_attr::<FixedAscii<8>>().create(name).unwrap().write_scalar(&FixedAscii::<8>::from_ascii(text).unwrap()).unwrap();
}

/// A scan from an HDF5 file that `fill` makes around the dataset `z` of 3 by 2 numbers.
fn hdf5<T: H5Type + Clone>(numbers: &Array2<T>, fill: impl FnOnce(&File, &hdf5_metno::Dataset)) -> Scan {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.h5");
    let file = File::create(&path).unwrap();
    let data = file.new_dataset::<T>().shape(numbers.dim()).create("z").unwrap();
    data.write(numbers).unwrap();
    fill(&file, &data);
    // The file stays open as long as one of its datasets is.
    drop(data);
    file.close().unwrap();
    read_at(&path, None)
}

fn read_at(path: &Path, field: Option<&str>) -> Scan {
    read_scan(path, &Asked { field, ..Asked::default() }).unwrap()
}

/// Attaches coordinates to a dimension, as NetCDF-4 does.
fn scales(file: &File, data: &hdf5_metno::Dataset, axes: [(&str, &[f64], &str); 2]) {
    let mut lists = Vec::new();
    for (name, at, unit) in axes {
        let scale = file.new_dataset::<f64>().shape(at.len()).create(name).unwrap();
        scale.write(at).unwrap();
        word(&scale, "units", unit);
        fixed(&scale, "NAME", name);
        lists.push(VarLenArray::from_slice(&[ObjectReference1::create(file, name).unwrap()]));
    }
    data.new_attr::<VarLenArray<ObjectReference1>>().shape(2).create("DIMENSION_LIST").unwrap().write(&lists).unwrap();
}

#[track_caller]
fn has_size(scan: &Scan, size: [f64; 2]) {
    let found = scan.size_m.expect("no size");
    // A sum of coordinates and a product of a pixel size and a number of points differ by rounding.
    assert!(found.iter().zip(size).all(|(found, size)| (found / size - 1.0).abs() < 1e-12), "{found:?} and {size:?}");
}

fn heights() -> Array2<f64> {
    array![[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]
}

#[test]
fn law_hdf5_attributes_of_the_field_its_groups_and_the_root_are_read() {
    let unit = |fill: &dyn Fn(&File, &hdf5_metno::Dataset)| hdf5(&heights(), fill);
    for name in ["unit", "units", "z_unit", "heightUnit"] {
        for scan in [unit(&|_, data| word(data, name, "nm")), unit(&|file, _| fixed(file, name, "nm"))] {
            assert_eq!((scan.unit.as_deref(), scan.factor, scan.first), (Some("nm"), 1e-9, FirstIndex::X), "{name}");
            same(&scan.heights, &(heights() * 1e-9));
        }
    }
    // The unit of the field comes first, and what is no length further out does not count.
    let scan = hdf5(&heights(), |file, data| {
        word(file, "unit", "SI");
        word(data, "unit", "um");
    });
    assert_eq!(scan.unit.as_deref(), Some("um"));
    assert_eq!(hdf5(&heights(), |file, _| word(file, "units", "SI")).unit, None);
    type Fill<'a> = &'a dyn Fn(&File, &hdf5_metno::Dataset);
    let with_size: [(Fill<'_>, [f64; 2]); 9] = [
        (&|file, _| number(file, "length_m", 6e-6), [6e-6, 6e-6]),
        (&|file, _| pair(file, "length_m", [6e-6, 3e-6]), [6e-6, 3e-6]),
        (&|_, data| number(data, "pixel_size_m", 2e-6), [6e-6, 4e-6]),
        (&|_, data| pair(data, "pixel_size_nm", [100.0, 50.0]), [300e-9, 100e-9]),
        (&|file, _| word(file, "pixelSize", "0.5 um"), [1.5e-6, 1e-6]),
        (
            &|file, _| {
                number(file, "scan_size", 2.0_f32);
                word(file, "scan_size_unit", "mm");
            },
            [2e-3, 2e-3],
        ),
        (
            &|file, _| {
                number(file, "dx", 0.5);
                number(file, "dy", 0.25);
                word(file, "lateral_unit", "um");
            },
            [1.5e-6, 0.5e-6],
        ),
        (&|file, _| number(file, "pixel_to_nm_scaling", 2.0), [6e-9, 4e-9]),
        // A size without a unit of its own is in the unit of the heights.
        (&|file, _| pair(file, "system_size", [3.0, 2.0]), [3e-9, 2e-9]),
    ];
    for (fill, size) in with_size {
        let scan = hdf5(&heights(), |file, data| {
            word(data, "unit", "nm");
            fill(file, data);
        });
        has_size(&scan, size);
    }
    // Without any unit, positions are in the unit that is stated with the heights.
    let scan = hdf5(&heights(), |file, _| pair(file, "system_size", [3.0, 2.0]));
    assert_eq!((scan.size_m, scan.spacing), (None, Some([1.0, 1.0])));
    // Numbers of points are no size, and contradictions are no size.
    assert_eq!(hdf5(&heights(), |_, data| number(data, "size", 3_i32)).spacing, None);
    let scan = hdf5(&heights(), |file, data| {
        number(file, "length_m", 6e-6);
        number(data, "pixel_size_m", 1e-6);
    });
    assert!(scan.size_m.is_none() && scan.notes[0].contains("pixel_size_m and length_m of the file contradict"), "{:?}", scan.notes);
}

#[test]
fn law_coordinates_give_axes_and_sizes() {
    let [x, y] = [[0.0, 0.5, 1.0], [7.0, 7.25, 7.5]];
    for (axes, first) in
        [([("x", &x[..], "um"), ("y", &y[..2], "um")], FirstIndex::X), ([("y", &x[..], "um"), ("x", &y[..2], "um")], FirstIndex::Y)]
    {
        let scan = hdf5(&heights(), |file, data| {
            word(data, "units", "nm");
            scales(file, data, axes);
        });
        assert_eq!((scan.first, scan.unit.as_deref()), (first, Some("nm")));
        if first == FirstIndex::X {
            same(&scan.heights, &(heights() * 1e-9));
            has_size(&scan, [1.5e-6, 0.5e-6]);
        } else {
            same(&scan.heights, &(heights() * 1e-9).t().to_owned());
            has_size(&scan, [0.5e-6, 1.5e-6]);
        }
    }
    // Coordinates in degrees, or not evenly spaced, are no size.
    for (at, unit) in [([0.0, 0.5, 1.0], "degrees"), ([0.0, 0.5, 2.0], "um")] {
        let scan = hdf5(&heights(), |file, data| scales(file, data, [("lon", &at, unit), ("lat", &[0.0, 0.5], unit)]));
        assert_eq!((scan.size_m, scan.spacing, scan.first), (None, None, FirstIndex::X));
    }
    // Datasets x and y beside a field of other numbers of points.
    let scan = hdf5(&heights(), |file, data| {
        word(data, "unit", "nm");
        for (name, at) in [("y", &x[..]), ("x", &y[..2])] {
            file.new_dataset::<f64>().shape(at.len()).create(name).unwrap().write(at).unwrap();
        }
    });
    assert_eq!(scan.first, FirstIndex::Y);
    has_size(&scan, [0.5e-9, 1.5e-9]);
}

/// Attributes, numbers and heights of a packed field.
type Packed = (Vec<(&'static str, Said)>, [f64; 6], [f64; 6]);

/// Packed numbers with every kind of missing point: attributes, numbers of a field of 3 by 2, and its heights in metres.
fn packed() -> Vec<Packed> {
    use Said::{Double, Int};
    let nan = f64::NAN;
    let numbers = [1.0, 2.0, -1.0, 40.0, 100.0, -100.0];
    vec![
        (vec![("scale_factor", Double(0.5)), ("add_offset", Double(3.0))], numbers, [3.5, 4.0, 2.5, 23.0, 53.0, -47.0]),
        (vec![("_FillValue", Int(-100))], numbers, [1.0, 2.0, -1.0, 40.0, 100.0, nan]),
        (vec![("missing_value", Int(40)), ("_FillValue", Int(-100))], numbers, [1.0, 2.0, -1.0, nan, 100.0, nan]),
        (vec![("valid_min", Int(0))], numbers, [1.0, 2.0, nan, 40.0, 100.0, nan]),
        (vec![("valid_max", Int(40)), ("scale_factor", Double(0.5))], numbers, [0.5, 1.0, -0.5, 20.0, nan, -50.0]),
        // A range in floating point of packed integers is one of unpacked values.
        (vec![("valid_max", Double(20.0)), ("scale_factor", Double(0.5))], numbers, [0.5, 1.0, -0.5, 20.0, nan, -50.0]),
        // NetCDF has a value for integers that were never written.
        (vec![], [1.0, 2.0, 3.0, 4.0, 5.0, -32_767.0], [1.0, 2.0, 3.0, 4.0, 5.0, nan]),
    ]
}

#[test]
fn val_packed_numbers_mean_the_same_in_netcdf_and_hdf5() {
    for (attributes, numbers, expected) in packed() {
        let expected = Array2::from_shape_vec((3, 2), expected.to_vec()).unwrap() * 1e-9;
        let shorts = Array2::from_shape_vec((3, 2), numbers.iter().map(|value| *value as i16).collect()).unwrap();
        let axis = |name, place, points: usize| Variable {
            name,
            dimensions: vec![place],
            attributes: vec![("units", Said::Text("um"))],
            kind: 6,
            data: big(&(0..points).map(|at| 0.5 * at as f64).collect::<Vec<_>>()),
        };
        let field = Variable {
            name: "z",
            dimensions: vec![0, 1],
            attributes: [attributes.clone(), vec![("units", Said::Text("nm"))]].concat(),
            kind: 3,
            data: shorts.iter().flat_map(|value| value.to_be_bytes()).collect(),
        };
        let cdf =
            Cdf { version: 2, records: 0, dimensions: vec![("x", 3), ("y", 2)], variables: vec![axis("x", 0, 3), field, axis("y", 1, 2)] };
        let classic = scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap();
        let newer = hdf5(&shorts, |file, data| {
            for (name, said) in &attributes {
                match said {
                    Said::Int(value) => number(data, name, *value as i16),
                    Said::Double(value) => number(data, name, *value),
                    Said::Text(text) => word(data, name, text),
                }
            }
            word(data, "units", "nm");
            scales(file, data, [("x", &[0.0, 0.5, 1.0], "um"), ("y", &[0.0, 0.5], "um")]);
        });
        for scan in [classic, newer] {
            for (found, expected) in scan.heights.iter().zip(&expected) {
                // Two roundings, of the scale and of the unit.
                assert!(
                    (found - expected).abs() <= 1e-15 * expected.abs() || found.is_nan() && expected.is_nan(),
                    "{found} and {expected}"
                );
            }
            has_size(&scan, [1.5e-6, 1e-6]);
            assert_eq!(scan.unit.as_deref(), Some("nm"));
        }
    }
}

#[test]
fn law_a_dimension_of_one_point_does_not_count() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.nc");
    let file = File::create(&path).unwrap();
    let data = file.new_dataset::<f64>().shape((1, 3, 2)).create("surface").unwrap();
    data.write(&heights().into_shape_with_order((1, 3, 2)).unwrap()).unwrap();
    file.new_dataset::<f64>().shape((2, 3, 2)).create("frames").unwrap();
    drop(data);
    file.close().unwrap();
    same(&read_at(&path, None).heights, &heights());
    let message = read_scan(&path, &Asked { field: Some("frames"), ..Asked::default() }).unwrap_err().to_string();
    assert!(message.contains("\"frames\" has 3 dimensions instead of 2"), "{message}");
}

#[test]
fn law_a_file_of_topostats_is_an_image_in_nanometres() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.topostats");
    let file = File::create(&path).unwrap();
    for name in ["image", "image_original"] {
        file.new_dataset::<f64>().shape((3, 2)).create(name).unwrap().write(&heights()).unwrap();
    }
    file.new_dataset::<f64>().create("pixel_to_nm_scaling").unwrap().write_scalar(&2.0).unwrap();
    let version: VarLenUnicode = "0.2".parse().unwrap();
    file.new_dataset::<VarLenUnicode>().create("topostats_file_version").unwrap().write_scalar(&version).unwrap();
    file.close().unwrap();
    let scan = read_at(&path, None);
    assert_eq!((scan.unit.as_deref(), scan.first), (Some("nm"), FirstIndex::Y));
    has_size(&scan, [4e-9, 6e-9]);
    same(&scan.heights, &(heights() * 1e-9).t().to_owned());
}

/// Groups are searched once each, and not once for each other one: a file of 3000 groups is read by 3000 visits.
#[test]
fn law_groups_are_visited_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("many.h5");
    let file = File::create(&path).unwrap();
    for at in 0..3000 {
        file.create_group(&format!("g{at}")).unwrap();
    }
    file.new_dataset::<f64>().shape((3, 2)).create("z").unwrap();
    file.close().unwrap();
    assert_eq!(search(&path).unwrap(), (vec!["z".to_owned()], 3001));
}
