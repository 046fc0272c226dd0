//! One bump from every format ends at one place: x along the first index, y along the second.

use std::fs;
use std::path::{Path, PathBuf};

use hdf5_metno::File;
use hysteron::formats::recognize;
use hysteron::store::hdf5::read_surface;
use hysteron::store::hdf5_scan::read_scan;
use hysteron::store::scan::{Asked, Found, Scan, read};
use ndarray::Array2;
use zip::CompressionMethod::Deflated;

use super::import::import;
use super::make::{Cdf, Said, Variable, archive, big, little, main_xml, npy, npy_line};
use crate::bench::{code, stderr, stdout};

/// Pixel size along x and y \[m\], as the X3P of [`main_xml`] has it.
const PIXELS: [f64; 2] = [1.25e-7, 2.5e-7];
/// Points along x and y, and the place of the maximum.
const POINTS: [usize; 2] = [48, 32];
const TOP: [usize; 2] = [12, 24];

/// A bump on a plane that is rough \[m\].
fn bump() -> Array2<f64> {
    Array2::from_shape_fn(POINTS, |(i, j)| {
        let [x, y] = [(i as f64 - TOP[0] as f64) / 5.0, (j as f64 - TOP[1] as f64) / 4.0];
        1e-8 * (-x * x - y * y).exp() + 1e-10 * (0.9 * i as f64).sin() * (0.7 * j as f64).cos()
    })
}

fn netcdf(first: [(&'static str, usize, f64); 2], heights: &Array2<f64>) -> Vec<u8> {
    let axis = |(name, points, pixel): (&'static str, usize, f64), place| Variable {
        name,
        dimensions: vec![place],
        attributes: vec![("units", Said::Text("m"))],
        kind: 6,
        data: big(&(0..points).map(|at| at as f64 * pixel).collect::<Vec<_>>()),
    };
    let field = Variable { name: "z", dimensions: vec![0, 1], attributes: vec![("units", Said::Text("m"))], kind: 6, data: big(heights) };
    let dimensions = first.map(|(name, points, _)| (name, points as u32)).to_vec();
    Cdf { version: 2, records: 0, dimensions, variables: vec![axis(first[0], 0), field, axis(first[1], 1)] }.bytes()
}

fn hdf5(path: &Path, heights: &Array2<f64>, axes: Option<[&str; 2]>) {
    let file = File::create(path).unwrap();
    let data = file.new_dataset::<f64>().shape(heights.dim()).create("z").unwrap();
    data.write(heights.as_standard_layout().view()).unwrap();
    if let Some(names) = axes {
        for (name, points) in names.into_iter().zip([heights.nrows(), heights.ncols()]) {
            let pixel = if name == "x" { PIXELS[0] } else { PIXELS[1] };
            let at: Vec<f64> = (0..points).map(|at| at as f64 * pixel).collect();
            file.new_dataset::<f64>().shape(points).create(name).unwrap().write(&at).unwrap();
        }
    }
    file.close().unwrap();
}

/// The bump in every format, each with the options that it needs.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<&'static str>)> {
    let heights = bump();
    let line = |row: ndarray::ArrayView1<'_, f64>| row.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let matrix: Vec<String> = heights.columns().into_iter().map(line).collect();
    let places: Vec<String> =
        heights.indexed_iter().map(|((i, j), z)| format!("{} {} {z}", i as f64 * PIXELS[0], j as f64 * PIXELS[1])).collect();
    let column: Vec<String> = heights.t().iter().map(ToString::to_string).collect();
    let image = little(heights.t());
    let shape = format!("({}, {})", POINTS[1], POINTS[0]);
    let [nx, ny] = POINTS.map(|points| points.to_string());
    let x3p = archive(
        &[("main.xml", main_xml([&nx, &ny, "1"], "<DataType>D</DataType>", "").as_bytes()), ("bindata/data.bin", &little(heights.t()))],
        Deflated,
    );
    let [x, y] = [("x", POINTS[0], PIXELS[0]), ("y", POINTS[1], PIXELS[1])];
    let turned = heights.t().to_owned();
    let told = vec!["--unit", "m", "--size", "6um x 8um"];
    let mut all = Vec::new();
    let mut add = |name: &str, bytes: Vec<u8>, options: Vec<&'static str>| {
        fs::write(folder.join(name), bytes).unwrap();
        all.push((folder.join(name), options));
    };
    add("matrix.txt", matrix.join("\n").into_bytes(), told.clone());
    add("column.txt", column.join("\n").into_bytes(), [told.clone(), vec!["--width", "48"]].concat());
    add("points.txt", places.join("\n").into_bytes(), vec!["--unit", "m"]);
    add("image.npy", npy(1, &npy_line("<f8", "False", &shape), &image), told.clone());
    add("bump.x3p", x3p, vec![]);
    add("first_x.nc", netcdf([x, y], &heights), vec![]);
    add("first_y.nc", netcdf([y, x], &turned), vec![]);
    for (name, field, axes) in
        [("bare.h5", &heights, None), ("first_x.h5", &heights, Some(["x", "y"])), ("first_y.h5", &turned, Some(["y", "x"]))]
    {
        hdf5(&folder.join(name), field, axes);
        all.push((folder.join(name), if axes.is_some() { vec!["--unit", "m"] } else { told.clone() }));
    }
    // An image in HDF5 without names of its axes is exchanged by its user.
    hdf5(&folder.join("image.h5"), &turned, None);
    all.push((folder.join("image.h5"), [told, vec!["--transpose"]].concat()));
    all
}

fn scan(path: &Path, options: &[&str]) -> Scan {
    let width = options.iter().position(|option| *option == "--width").map(|_| 48);
    let asked = Asked { width, ..Asked::default() };
    let scan = match recognize(path).unwrap().unwrap() {
        Found::Hdf5 => read_scan(path, &asked).unwrap(),
        Found::Scan(format) => read(path, format, &asked).unwrap(),
        Found::Foreign(foreign) => panic!("{}", foreign.name),
    };
    if options.contains(&"--transpose") { scan.transposed(path).unwrap() } else { scan }
}

#[test]
fn law_a_bump_from_every_format_is_at_one_place() {
    let folder = tempfile::tempdir().unwrap();
    let heights = bump();
    for (path, options) in files(folder.path()) {
        let found = scan(&path, &options);
        assert_eq!(found.heights.dim(), heights.dim(), "{}", path.display());
        let top = found.heights.indexed_iter().max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap().0;
        assert_eq!([top.0, top.1], TOP, "{}", path.display());
        assert!(found.heights.iter().zip(&heights).all(|(found, height)| (found - height).abs() <= 1e-22), "{}", path.display());
    }
}

#[test]
fn e2e_a_bump_from_every_format_is_imported_alike() {
    let folder = tempfile::tempdir().unwrap();
    let mut first: Option<(Array2<f64>, f64)> = None;
    for (path, options) in files(folder.path()) {
        let name = path.file_name().unwrap().to_str().unwrap();
        let output = import(folder.path(), &[&[name, "--out", "out.h5", "--force", "--points", "4"], &options[..]].concat());
        assert_eq!(code(&output), 0, "{name}: {}", stderr(&output));
        assert!(stdout(&output).contains("48 x 32 points along x and y, 1.2500e-7 m by 2.5000e-7 m"), "{name}: {}", stdout(&output));
        let (header, heights) = read_surface(&folder.path().join("out.h5")).unwrap();
        let (of_first, length) = first.get_or_insert_with(|| (heights.clone(), header.length_m));
        // Sizes that are sums of coordinates differ in their last digits, and interpolated heights with them.
        assert!((header.length_m / *length - 1.0).abs() < 1e-12, "{name}");
        let largest = heights.iter().zip(of_first.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(largest < 1e-18, "{name}: {largest}");
    }
}
