//! Files in formats that are not read: named, with the way to one that is.

use crate::bench::{Bench, code, stderr};
use hysteron::formats::{Format, Found, recognize};
use std::fs;
use std::path::Path;

use super::import::import;
use super::make::archive;

const PYTHON: &str = "from SurfaceTopography.IO import open_topography";

/// Name of a file, its first bytes, and words of its refusal.
const FOREIGN: [(&str, &[u8], &str); 38] = [
    ("a.sur", b"DIGITAL SURF\0\0", "SUR (Digital Surf)"),
    ("a.dat", b"DSCOMPRESSED\0", "SUR (Digital Surf)"),
    ("a.001", b"\\*File list\r\n\\Version: 0x0\r\n", "Nanoscope"),
    ("a.di", b"\\*Force file list\r\n", "Nanoscope"),
    ("a.ibw", b"\x05\0\0\0", "IBW"),
    ("a.plu", b"Mon Jan 1\0\0\0", "PLU (Sensofar)"),
    ("a.opd", b"\x01\0Directory\0", "OPD (Wyko"),
    ("a.OPDx", b"VCA DATA\x01\0\0\x55", "OPDx (Bruker"),
    ("a.gwy", b"GWYPGwyContainer\0", "GWY (Gwyddion)"),
    ("a.al3d", b"AliconaImaging\0\r\n", "AL3D (Alicona)"),
    ("a.mnt", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "MNT (Digital Surf Mountains)"),
    ("a.bin", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "OLE document"),
    ("a.nid", b"[DataSet]\r\nVersion=2\r\n", "NID (Nanosurf)"),
    ("a.mi", b"fileType      Image\r\n", "MI (Agilent"),
    ("a.sdf", b"aBCR-1.0\r\nManufacID = x\r\n", "SDF (ISO 25178-71)"),
    ("b.sdf", b"bISO-1.0\0", "SDF (ISO 25178-71)"),
    ("a.bcrf", b"fileformat = bcrf\r\n", "BCR"),
    ("a.stp", b"WSxM file copyright UAM\r\n", "WSxM"),
    ("a.top", b"WSxM file copyright Nanotec Electronica\r\n", "WSxM"),
    ("a.frt", b"FRTM_GLIDERV1.00\0", "FRT"),
    ("a.tif", b"II*\0\x08\0\0\0", "TIFF"),
    ("a.tiff", b"MM\0*\0\0\0\x08", "TIFF"),
    ("a.lext", b"II*\0\x08\0\0\0", "LEXT (Olympus)"),
    ("a.jpk", b"MM\0*\0\0\0\x08", "JPK"),
    ("a.oir", b"OLYMPUSRAWFORMAT\0", "OIR (Olympus)"),
    ("a.vk4", b"VK4_\0\0\0\0", "VK (Keyence)"),
    ("a.zon", b"KPK0\0\0", "ZON (Keyence)"),
    ("b.dat", b"\x88\x1b\x03\x71\0\x03", "MetroPro"),
    ("a.mdt", b"\x01\xb0\x93\xff\0", "MDT (NT-MDT)"),
    ("a.mat", b"MATLAB 5.0 MAT-file, Platform", "MAT (MATLAB)"),
    ("a.nms", b"\0\0\0\0\x01", "NMS (NanoFocus)"),
    ("a.tmd", b"Binary TrueMap Data File v2.0\r\n", "TMD"),
    ("a.zmg", b"Zeta-Instruments\0", "ZMG"),
    ("a.os3d", b"OmniSurf3D\x01\0", "OS3D"),
    ("a.hgt", b"\0\x01\0\x02", "HGT"),
    ("a.ezd", b"[DataSet]\n", "NID (Nanosurf)"),
    ("a.spm", b"\0\0\x01", "Nanoscope"),
    ("a.apx", b"\0\0\x01", "PLU (Sensofar)"),
];

#[test]
fn val_every_known_format_is_named_with_its_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let refusal = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        (path.clone(), recognize(&path).unwrap().expect_err(name))
    };
    for (name, bytes, words) in FOREIGN {
        let (path, refusal) = refusal(name, bytes);
        assert!(refusal.problem.contains(words), "{name}: {refusal}");
        let (file, nc) = (path.display(), path.with_extension("nc"));
        // A unit in UTF-8 cannot be written as NetCDF-3.
        let second = if words.starts_with("SUR") {
            format!("\n    open_topography(\"{file}\").topography().to_matrix(\"{}\")", path.with_extension("txt").display())
        } else {
            format!("\n    open_topography(\"{file}\").topography().to_netcdf(\"{}\")", nc.display())
        };
        assert!(refusal.help.contains(PYTHON) && refusal.help.ends_with(&second), "{name}: {refusal}");
    }
    let npz = archive(&[("heights.npy", b"1"), ("x.npy", b"2")], zip::CompressionMethod::Stored);
    let container = archive(&[("index.json", b"{}"), ("a.nc", b"2")], zip::CompressionMethod::Stored);
    let xlsx = archive(&[("[Content_Types].xml", b"1")], zip::CompressionMethod::Deflated);
    for (name, bytes, problem, help) in [
        ("a.npz", &npz[..], "npz (NumPy archive)", "numpy.load("),
        ("a.xlsx", &xlsx[..], "an Excel workbook", "save the heights as CSV"),
        ("a.zip", &container[..], "a container of contact.engineering", "hysteron import FILE"),
        ("a.h5-jpk", b"\x89HDF\r\n\x1a\n", "h5-jpk (Bruker JPK video)", "load_h5jpk("),
        ("it's.txt.gz", b"\x1f\x8b\x08", "gzip", "it'\\''s.txt.gz'"),
        ("a.asc", b"ncols 100\nnrows 100\n", "ESRI ASCII grid", "--pixel-m"),
        ("b.asc", b"NCOLS 100\n", "ESRI ASCII grid", "--pixel-m"),
        ("a.sxm", b":NANONIS_VERSION:\n2\n", "SXM (Nanonis)", "Gwyddion"),
        ("a.gsf", b"Gwyddion Simple Field 1.0\nXRes = 4\n", "GSF", "Gwyddion"),
        ("a.png", b"\x89PNG\r\n\x1a\n", "a picture", "heights"),
        ("a.txt", b"\xff\xfe1\0", "UTF-16", "save it as UTF-8"),
        ("a.npy", b"", "the file is empty", "formats that are read"),
        ("zeros.npy", &[0; 600], "begins with zeros", "formats that are read"),
        ("a.gwyx", b"\x7fELF\x02", "unknown file format", "SurfaceTopography (Python)"),
    ] {
        let (_, refusal) = refusal(name, bytes);
        assert!(refusal.problem.contains(problem) && refusal.help.contains(help), "{name}: {refusal}");
    }
    // An extension alone does not make a text or an array something else.
    for (name, bytes, found) in [("b.di", &b"1 2\n3 4\n"[..], Format::Text), ("c.sur", b"\x93NUMPY\x01\0", Format::Npy)] {
        fs::write(folder.path().join(name), bytes).unwrap();
        assert_eq!(recognize(&folder.path().join(name)).unwrap(), Ok(Found::Scan(found)));
    }
}

/// The name of a file cannot end the text of Python that it stands in.
#[cfg(unix)]
#[test]
fn law_names_of_files_are_quoted() {
    let folder = tempfile::tempdir().unwrap();
    let name = "a\"); import os; (\"\\\n.gwy";
    fs::write(folder.path().join(name), b"GWYP").unwrap();
    let refusal = recognize(&folder.path().join(name)).unwrap().unwrap_err();
    assert!(refusal.help.contains("a\\\"); import os; (\\\"\\\\\\u000a.gwy\").topography()"), "{refusal}");
    assert_eq!(refusal.help.lines().count(), 3, "{refusal}");
}

#[test]
fn e2e_commands_name_the_format() {
    let bench = Bench::new("name = \"x\"\n[surface]\nfile = \"none\"\n");
    let path = bench.folder.path().join("a.gwy");
    fs::write(&path, b"GWYPGwyContainer\0").unwrap();
    let output = import(bench.folder.path(), &["a.gwy", "--pixel-m", "1e-9", "--unit", "nm"]);
    assert_eq!(code(&output), 1);
    let lines: Vec<String> = stderr(&output).lines().map(ToOwned::to_owned).collect();
    assert_eq!(
        lines,
        [
            "error: cannot import a.gwy: unsupported file format: GWY (Gwyddion)",
            "help: convert it in Python (pip install SurfaceTopography) and import the result:",
            "    from SurfaceTopography.IO import open_topography",
            "    open_topography(\"a.gwy\").topography().to_netcdf(\"a.nc\")",
        ]
    );
    let text = format!("name = \"x\"\n[surface]\nfile = {path:?}\n[model]\nboundary = \"isolated\"\n");
    fs::write(bench.spec(), text).unwrap();
    for verb in ["plan", "run"] {
        let output = bench.verb(verb, &[]);
        let said = stderr(&output);
        assert!(code(&output) == 2 && said.contains("GWY (Gwyddion)") && said.contains(PYTHON) && said.contains("spec.toml:3:"), "{said}");
    }
    assert!(!bench.out().exists());
}

/// A file of which nothing is read but its beginning is refused whatever its length.
#[cfg(target_os = "linux")]
#[test]
fn e2e_a_sparse_file_is_refused_at_once() {
    let bench = Bench::new("");
    let path = bench.folder.path().join("zeros.npy");
    let file = fs::File::create(&path).unwrap();
    // More than can be hashed within the time that a test has: a petabyte at 10 GB/s takes a day.
    let length = [1_u64 << 50, 1 << 43, 20 << 30].into_iter().find(|length| file.set_len(*length).is_ok()).unwrap();
    drop(file);
    let output = import(bench.folder.path(), &["zeros.npy", "--pixel-m", "1e-9", "--unit", "nm"]);
    assert!(code(&output) == 1 && stderr(&output).contains("begins with zeros"), "{length}: {}", stderr(&output));
    let text = format!("name = \"x\"\n[surface]\nfile = {path:?}\n[model]\nboundary = \"isolated\"\n");
    fs::write(bench.spec(), &text).unwrap();
    for verb in ["plan", "run"] {
        let output = bench.verb(verb, &[]);
        assert!(code(&output) == 2 && stderr(&output).contains("begins with zeros"), "{}", stderr(&output));
    }
    // With a hash in [files] too, which spares `plan` the file.
    let text = format!("{text}[files]\n{path:?} = \"{}\"\n", "0".repeat(64));
    fs::write(bench.spec(), text).unwrap();
    let output = bench.verb("run", &[]);
    assert!(code(&output) == 3 && stderr(&output).contains("begins with zeros"), "{}", stderr(&output));
    assert!(Path::new(&path).exists());
}
