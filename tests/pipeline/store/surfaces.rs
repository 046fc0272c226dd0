//! Surfaces in HDF5.

use std::fs;
use std::path::{Path, PathBuf};

use crate::scan::read_heights;
use hdf5_metno::types::{FixedUnicode, IntSize, TypeDescriptor, VarLenArray, VarLenUnicode};
use hdf5_metno::{File, ObjectReference, ObjectReference1, ReferencedObject};
use hysteron::model::{Amplitudes, Detrend, FastAxis, Filter, Normalization, SpectrumEnd};
use hysteron::physics::surface::texture::Texture;
use hysteron::store::hdf5::{Generated, Measured, Quality, SpectrumFit, SurfaceHeader, read_header, read_surface, write_surface};
use ndarray::{Array2, s};
use tempfile::{TempDir, tempdir};

use super::{names, says};

fn header() -> SurfaceHeader {
    SurfaceHeader {
        length_m: 1e-3,
        realization: 4,
        periodic: true,
        key: "blake3:0123456789abcdef".to_owned(),
        rms_height_m: 5e-6,
        rms_slope: 0.13,
        rms_curvature_1_m: 2.371e4,
        nayak_parameter: 73.73,
        generated: Some(Generated {
            target_rms_height_m: 5.000_000_1e-6,
            hurst: 0.8,
            magnification: 64.0,
            seed: u64::MAX,
            points_per_shortest_wavelength: 8.0,
            normalization: Normalization::Spectrum,
            amplitudes: Amplitudes::Gaussian,
            longest_wavelength_m: Some(1e-4),
            roll_off_m: Some(2e-5),
            aspect_ratio: 2.5,
            angle_deg: -30.0,
            left_out_m: Some(1e-12),
        }),
        measured: None,
    }
}

fn heights(size: usize) -> Array2<f64> {
    Array2::from_shape_fn((size, size), |(row, column)| (row as f64 * 0.37).sin() * 1e-6 - column as f64 * 1e-9)
}

fn written(size: usize) -> (TempDir, PathBuf) {
    let directory = tempdir().unwrap();
    let path = directory.path().join("surface.h5");
    write_surface(&path, &header(), heights(size).view()).unwrap();
    (directory, path)
}

#[test]
fn e2e_a_surface_comes_back_bit_by_bit() {
    for size in [1, 2, 255, 256, 257, 600] {
        let (directory, path) = written(size);
        let (back, field) = read_surface(&path).unwrap();
        assert_eq!(back, header());
        assert_eq!(read_header(&path).unwrap(), header());
        assert_eq!(field, heights(size));
        assert_eq!(read_heights(&path, Some("height_m")).unwrap(), field);
        assert_eq!(names(directory.path()), ["surface.h5"]);
    }
}

#[test]
fn e2e_a_measured_surface_lacks_what_nobody_knows() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("surface.h5");
    let mut about = Measured {
        source: "a scan.x3p".to_owned(),
        source_blake3: "0".repeat(64),
        source_point_counts: [650, 300],
        source_spacings_m: [1e-7, 2e-7],
        missing_count: 3,
        detrend: Detrend::Quadratic,
        trend_m: 1e-7,
        filter: Filter::Gaussian,
        shortest_wavelength_m: 2e-6,
        noise_m: 3e-9,
        overshoot_m: 1e-10,
        fit: Some(SpectrumFit {
            hurst: 0.7,
            plateau_m4: 1e-30,
            roll_off_1_m: 1e5,
            rolls_off: Some(true),
            scatter: 0.1,
            long_cut_m: Some(2e-4),
            short_cut: Some((1e-7, SpectrumEnd::GaussianFilter)),
        }),
        texture: Some(Texture { slope_ratio: 1.2, direction_rad: 0.3, aspect_ratio_str: 0.7, decay_length: 0.04 }),
        quality: Some(Quality {
            outlier_count: 3,
            outlier_left_count: 1,
            outlier_effect: 0.5,
            line_axis: FastAxis::Columns,
            line_offset_m: Some(1e-8),
            line_jump_m: 0.0,
            tip_radius_m: None,
            tip_cutoff_m: None,
            noise_exponent: Some(-2.5),
            curvature_ratio: None,
        }),
    };
    for fit in [about.fit, None] {
        about.fit = fit;
        about.quality = about.quality.filter(|_| fit.is_some());
        let measured = Some(about.clone());
        let measured = SurfaceHeader { generated: None, measured, periodic: false, realization: 0, key: String::new(), ..header() };
        write_surface(&path, &measured, heights(8).view()).unwrap();
        assert_eq!(read_header(&path).unwrap(), measured);
    }
    let names = File::open(&path).unwrap().attr_names().unwrap();
    assert!(!names.iter().any(|name| name == "hurst" || name == "seed"), "{names:?}");
}

#[test]
fn e2e_a_field_in_any_layout_is_written_the_same() {
    let (_one, first) = written(300);
    let directory = tempdir().unwrap();
    let path = directory.path().join("surface.h5");
    let turned = heights(300).reversed_axes().as_standard_layout().into_owned();
    write_surface(&path, &header(), turned.t()).unwrap();
    assert_eq!(fs::read(&first).unwrap(), fs::read(&path).unwrap());
    let mut wide = Array2::zeros((300, 450));
    wide.slice_mut(s![.., ..300]).assign(&heights(300));
    write_surface(&path, &header(), wide.slice(s![.., ..300])).unwrap();
    assert_eq!(fs::read(&first).unwrap(), fs::read(&path).unwrap());
}

#[test]
fn e2e_equal_surfaces_are_equal_bytes() {
    let (_one, first) = written(600);
    let bytes = fs::read(&first).unwrap();
    // Times in HDF5 have whole seconds.
    std::thread::sleep(std::time::Duration::from_millis(1100));
    let (_other, second) = written(600);
    assert_eq!(bytes, fs::read(&second).unwrap());
    let together: Vec<_> = std::thread::scope(|scope| {
        let work = || {
            let (_directory, path) = written(600);
            fs::read(path).unwrap()
        };
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(together.iter().all(|other| *other == bytes));
}

#[test]
fn val_the_file_is_as_the_contract_says() {
    let (_directory, path) = written(600);
    let file = File::open(&path).unwrap();
    let data = file.dataset("height_m").unwrap();
    assert_eq!(data.shape(), [600, 600]);
    assert_eq!(data.chunk(), None);
    assert!(data.filters().is_empty());
    assert_eq!(data.attr("unit").unwrap().read_scalar::<VarLenUnicode>().unwrap().as_str(), "m");
    assert_eq!(file.attr("normalization").unwrap().read_scalar::<VarLenUnicode>().unwrap().as_str(), "spectrum");
    for name in ["x_m", "y_m"] {
        let axis = file.dataset(name).unwrap().read_1d::<f64>().unwrap();
        assert_eq!((axis.len(), axis[0]), (600, 0.0));
        // Points are length_m / N apart, and the last one is that far from the next period.
        assert!((axis[599] + 1e-3 / 600.0 - 1e-3).abs() < 1e-18, "{}", axis[599]);
    }
    let labels = data.attr("DIMENSION_LABELS").unwrap().read_1d::<VarLenUnicode>().unwrap();
    assert_eq!(labels.iter().map(|label| label.as_str()).collect::<Vec<_>>(), ["x_m", "y_m"]);
    let scales = data.attr("DIMENSION_LIST").unwrap().read_1d::<VarLenArray<ObjectReference1>>().unwrap();
    for (scales, name) in scales.iter().zip(["x_m", "y_m"]) {
        let [scale] = scales.as_slice() else { panic!("{} scales", scales.len()) };
        let ReferencedObject::Dataset(axis) = scale.dereference(&file).unwrap() else { panic!("{name}") };
        assert_eq!(axis.name(), format!("/{name}"));
    }
    let mut names = file.attr_names().unwrap();
    names.sort();
    assert_eq!(
        names,
        [
            "amplitudes",
            "angle_deg",
            "aspect_ratio",
            "hurst",
            "key",
            "length_m",
            "longest_wavelength_m",
            "magnification",
            "nayak_parameter",
            "normalization",
            "periodic",
            "points_per_shortest_wavelength",
            "realization",
            "rms_curvature_1_m",
            "rms_height_m",
            "rms_slope",
            "roll_off_m",
            "schema_version",
            "seed",
            "tabulated_left_out_m",
            "target_rms_height_m",
        ]
    );
    assert_eq!(file.attr("rms_height_m").unwrap().read_scalar::<f64>().unwrap(), 5e-6);
    // A number, which NetCDF keeps.
    assert_eq!(file.attr("periodic").unwrap().dtype().unwrap().to_descriptor().unwrap(), TypeDescriptor::Unsigned(IntSize::U1));
    assert_eq!(file.attr("periodic").unwrap().read_scalar::<u8>().unwrap(), 1);
}

#[test]
fn e2e_what_is_no_surface_is_not_written() {
    let (directory, path) = written(4);
    let before = fs::read(&path).unwrap();
    let refusal = |header: &SurfaceHeader, field: &Array2<f64>| {
        let message = write_surface(&path, header, field.view()).unwrap_err().to_string();
        says(&message, &path, &["cannot write the surface to"]);
        message
    };
    assert!(refusal(&header(), &Array2::zeros((3, 4))).contains("3 by 4 heights, and must be square"));
    assert!(refusal(&header(), &Array2::zeros((0, 0))).contains("0 by 0 heights"));
    let mut holed = heights(4);
    holed[(2, 1)] = f64::NAN;
    assert!(refusal(&header(), &holed).contains("its height in row 2, column 1 is NaN, and must be finite"));
    let endless = SurfaceHeader { rms_slope: f64::INFINITY, ..header() };
    assert!(refusal(&endless, &heights(4)).contains("rms_slope is inf, must be finite"));
    let nul = SurfaceHeader { key: "a\0b".to_owned(), ..header() };
    assert!(refusal(&nul, &heights(4)).contains("its key \"a\\0b\" cannot be stored"));
    let long = SurfaceHeader { key: "µ".repeat(200), ..header() };
    assert!(refusal(&long, &heights(4)).contains("it may have 256 bytes"));
    assert_eq!(fs::read(&path).unwrap(), before);
    assert_eq!(names(directory.path()), ["surface.h5"]);
    let absent = directory.path().join("absent/surface.h5");
    let message = write_surface(&absent, &header(), heights(4).view()).unwrap_err().to_string();
    says(&message, &absent, &["absent does not exist"]);
}

#[test]
fn e2e_truncated_surfaces_are_refused() {
    let (directory, path) = written(40);
    let whole = fs::read(&path).unwrap();
    let short = directory.path().join("short.h5");
    let step = whole.len().div_ceil(250);
    for length in (0..whole.len()).step_by(step).chain(whole.len() - 8..whole.len()) {
        fs::write(&short, &whole[..length]).unwrap();
        let message = read_surface(&short).unwrap_err().to_string();
        says(&message, &short, &["cannot read the surface from"]);
        assert!(read_header(&short).is_err() && read_heights(&short, Some("height_m")).is_err(), "{length}");
    }
}

/// A changed byte gives an error or a surface, never the end of the program.
#[test]
fn e2e_no_changed_byte_ends_the_program() {
    let (directory, path) = written(4);
    let whole = fs::read(&path).unwrap();
    let other = directory.path().join("other.h5");
    for at in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[at] ^= [0x01, 0x80, 0xff][at % 3];
        fs::write(&other, &bytes).unwrap();
        let _ = read_surface(&other);
    }
}

/// Texts and references lie in a heap without a checksum; a changed byte there could make the library loop for ever, so it is not read.
#[test]
fn law_the_heap_of_texts_is_not_read() {
    let (directory, path) = written(4);
    let whole = fs::read(&path).unwrap();
    let heap = whole.windows(4).position(|bytes| bytes == b"GCOL").unwrap();
    let text = "blake3:0123456789abcdef".as_bytes();
    assert!(whole[heap..].windows(text.len()).any(|bytes| bytes == text));
    let other = directory.path().join("other.h5");
    for at in heap..heap + 512 {
        let mut bytes = whole.clone();
        bytes[at] = !bytes[at];
        fs::write(&other, &bytes).unwrap();
        assert_eq!(read_surface(&other).unwrap(), (header(), heights(4)), "byte {at}");
    }
}

/// Heights other than those that were written are an error, and a boolean of HDF5 is read as the number is.
#[test]
fn e2e_heights_are_compared_with_their_checksum() {
    let (_directory, path) = written(5);
    let change = |act: &dyn Fn(&File)| {
        act(&File::open_rw(&path).unwrap());
        read_surface(&path).map_err(|error| error.to_string())
    };
    let as_before = change(&|file| {
        file.delete_attr("periodic").unwrap();
        file.new_attr::<bool>().create("periodic").unwrap().write_scalar(&true).unwrap();
    });
    assert_eq!(as_before.unwrap(), (header(), heights(5)));
    let other = heights(5)[(1, 2)] + 1e-9;
    let refused =
        change(&|file| file.dataset("height_m").unwrap().write_slice(Array2::from_elem((1, 1), other).view(), s![1..2, 2..3]).unwrap());
    let refused = refused.unwrap_err();
    assert!(refused.contains("its dataset \"height_m\" differs from its checksum\nhelp: restore the file"), "{refused}");
    let (_, changed) = change(&|file| file.group("header").unwrap().delete_attr("height_blake3").unwrap()).unwrap();
    assert_eq!(changed[(1, 2)], other);
}

/// Files of earlier versions: texts of fixed length in the root, no coordinates.
#[test]
fn e2e_a_surface_without_coordinates_is_read() {
    let (_directory, path) = written(5);
    let file = File::open_rw(&path).unwrap();
    for name in ["x_m", "y_m", "header"] {
        file.unlink(name).unwrap();
    }
    for name in ["DIMENSION_LIST", "DIMENSION_LABELS"] {
        file.dataset("height_m").unwrap().delete_attr(name).unwrap();
    }
    for (name, text) in [("key", header().key.as_str()), ("normalization", "spectrum"), ("amplitudes", "gaussian")] {
        file.delete_attr(name).unwrap();
        let text: FixedUnicode<32> = text.parse().unwrap();
        file.new_attr::<FixedUnicode<32>>().create(name).unwrap().write_scalar(&text).unwrap();
    }
    file.close().unwrap();
    assert_eq!(read_surface(&path).unwrap(), (header(), heights(5)));
}

fn foreign(path: &Path, change: impl FnOnce(&File)) {
    let _ = fs::remove_file(path);
    write_surface(path, &header(), heights(4).view()).unwrap();
    change(&File::open_rw(path).unwrap());
}

#[test]
fn e2e_another_files_faults_are_named() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("surface.h5");
    let refusal = |change: &dyn Fn(&File)| {
        foreign(&path, change);
        let message = read_surface(&path).unwrap_err().to_string();
        says(&message, &path, &["cannot read the surface from"]);
        message
    };
    assert!(refusal(&|file| file.delete_attr("schema_version").unwrap()).contains("no attribute \"schema_version\""));
    assert!(
        refusal(&|file| file.attr("schema_version").unwrap().write_scalar(&9_u32).unwrap())
            .contains("unsupported layout version 9; this program reads version 1")
    );
    assert!(refusal(&|file| file.delete_attr("length_m").unwrap()).contains("its attribute \"length_m\" cannot be read"));
    assert!(
        refusal(&|file| file.attr("hurst").unwrap().write_scalar(&f64::NAN).unwrap())
            .contains("its attribute \"hurst\" cannot be read: it is NaN")
    );
    let word = |file: &File| {
        let word: FixedUnicode<16> = "guess".parse().unwrap();
        file.group("header").unwrap().attr("normalization").unwrap().write_scalar(&word).unwrap();
    };
    assert!(refusal(&word).contains("unknown value \"guess\"\nhelp: expected one of sample, spectrum"));
    assert!(refusal(&|file| file.unlink("height_m").unwrap()).contains("height_m"));
    let other_field = |shape: Vec<usize>| {
        move |file: &File| {
            file.unlink("height_m").unwrap();
            file.new_dataset::<f64>().shape(shape.clone()).chunk(vec![1; shape.len()]).create("height_m").map(drop).unwrap();
        }
    };
    assert!(refusal(&other_field(vec![4])).contains("its dataset \"height_m\" is not two-dimensional"));
    assert!(refusal(&other_field(vec![4, 5])).contains("4 by 5 heights, and must be square"));
    assert!(refusal(&other_field(vec![1 << 28, 1 << 28])).contains("which a file of its size cannot hold"));
    assert!(refusal(&|file| file.dataset("height_m").unwrap().write_scalar_at()).contains("NaN in row 0, column 0"));
}

/// Puts a NaN where no writer of this program would.
trait Spoil {
    fn write_scalar_at(&self);
}

impl Spoil for hdf5_metno::Dataset {
    fn write_scalar_at(&self) {
        self.write_slice(Array2::from_elem((1, 1), f64::NAN).view(), s![0..1, 0..1]).unwrap();
    }
}

#[test]
fn e2e_a_measured_field_of_another_type_is_read() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("scan.h5");
    let file = File::create(&path).unwrap();
    let field = Array2::from_shape_fn((3, 5), |(row, column)| row as f32 - column as f32);
    file.new_dataset_builder().with_data(field.view()).create("scan/z").unwrap();
    let packed = Array2::<i32>::zeros((500, 400));
    file.new_dataset_builder().with_data(packed.view()).chunk((500, 400)).deflate(9).create("flat").unwrap();
    file.close().unwrap();
    assert_eq!(read_heights(&path, Some("scan/z")).unwrap(), field.mapv(f64::from));
    assert_eq!(read_heights(&path, Some("flat")).unwrap(), Array2::<f64>::zeros((500, 400)));
    assert_eq!(read_heights(&path, None).unwrap(), Array2::<f64>::zeros((500, 400)), "the only field in the root");
    let message = read_heights(&path, Some("nothing")).unwrap_err().to_string();
    says(&message, &path, &["no dataset \"nothing\"", "flat"]);
    says(&read_surface(&path).unwrap_err().to_string(), &path, &["not a surface file of hysteron"]);
    says(&read_surface(directory.path()).unwrap_err().to_string(), directory.path(), &["it is a directory"]);
    let absent = directory.path().join("absent.h5");
    says(&read_surface(&absent).unwrap_err().to_string(), &absent, &["No such file"]);
}
