//! File formats of measured surfaces, recognised by the first bytes and then by the extension.

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Bytes that are enough to recognise a format.
const FIRST: u64 = 512;

/// A format of measured surfaces that is read. HDF5 is apart, since it can hold anything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// One array of NumPy.
    Npy,
    /// The classic NetCDF formats: CDF-1, CDF-2 and CDF-5.
    NetCdf3,
    /// ISO 25178-72, a zip archive.
    X3p,
    /// Numbers as text: a matrix, or lines of x, y and z.
    Text,
}

impl Format {
    /// Name of the format.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Npy => "npy",
            Self::NetCdf3 => "NetCDF-3",
            Self::X3p => "X3P",
            Self::Text => "text",
        }
    }
}

/// A format that is recognised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// HDF5, including NetCDF-4.
    Hdf5,
    /// A format that is read.
    Scan(Format),
    /// A format that is known by name and not read.
    Foreign(Foreign),
}

/// A known format that is not read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Foreign {
    /// Name of the format, with the programs or instruments that write it.
    pub name: &'static str,
    way: Way,
}

/// Conversion of a format to one that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// The Python package SurfaceTopography reads it.
    Python,
    /// Python text, with a unit that cannot be written as NetCDF.
    PythonText,
    /// Gwyddion reads it.
    Gwyddion,
    /// A video of JPK, frames of which the Python package AFMReader reads.
    JpkVideo,
    /// An archive of NumPy arrays.
    Npz,
    /// A compressed file: the command that decompresses it.
    Unpack(&'static str),
    /// A sentence.
    Said(&'static str),
}

/// Why a file is not read, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// Description of the file.
    pub problem: String,
    /// Recommended action.
    pub help: String,
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}\nhelp: {}", self.problem, self.help)
    }
}

const fn python(name: &'static str) -> Foreign {
    Foreign { name, way: Way::Python }
}

const fn gwyddion(name: &'static str) -> Foreign {
    Foreign { name, way: Way::Gwyddion }
}

const fn said(name: &'static str, help: &'static str) -> Foreign {
    Foreign { name, way: Way::Said(help) }
}

const SUR: Foreign = Foreign { name: "SUR (Digital Surf)", way: Way::PythonText };
const NANOSCOPE: Foreign = python("Nanoscope (Bruker, Digital Instruments)");
const NID: Foreign = python("NID (Nanosurf)");
const SDF: Foreign = python("SDF (ISO 25178-71)");
const BCR: Foreign = python("BCR (Image Metrology)");
const GWY: Foreign = python("GWY (Gwyddion)");
const OPD: Foreign = python("OPD (Wyko, Veeco)");
const OPDX: Foreign = python("OPDx (Bruker Vision64)");
const VK: Foreign = python("VK (Keyence)");
const METROPRO: Foreign = python("MetroPro DAT (Zygo)");
const TIFF: Foreign = python("TIFF (Park Systems, Olympus and others)");
const MNT: Foreign = python("MNT (Digital Surf Mountains)");
const OLE: Foreign = python("an OLE document, such as MNT (Digital Surf Mountains)");
const MATLAB: Foreign = python("MAT (MATLAB)");
const EXCEL: Foreign =
    said("an Excel workbook", "save the heights as CSV or tab-separated text, one line per row of points");
const IMAGE: Foreign =
    said("a picture", "a picture holds colours and not heights: export the heights of the scan itself");

/// First bytes of formats that are not read.
const MAGIC: [(&[u8], Foreign); 48] = [
    (b"DIGITAL SURF", SUR),
    (b"DSCOMPRESSED", SUR),
    (b"\\*", NANOSCOPE),
    (b"WSxM file", python("WSxM (STP, TOP)")),
    (b"[DataSet]", NID),
    (b"fileType ", python("MI (Agilent, Keysight)")),
    (b"aBCR-", SDF),
    (b"bBCR-", SDF),
    (b"aISO-", SDF),
    (b"bISO-", SDF),
    (b"fileformat", BCR),
    (b"GWYP", GWY),
    (b"GWYO", GWY),
    (b"Gwyddion Simple Field", gwyddion("GSF (Gwyddion simple field)")),
    (b"Gwyddion XYZ Field", gwyddion("GXYZF (Gwyddion XYZ field)")),
    (b"AliconaImaging", python("AL3D (Alicona)")),
    (b"\x01\x00Directory", OPD),
    (b"VCA DATA", OPDX),
    (b"FRTM_GLIDER", python("FRT (FRT MicroProf)")),
    (b"KPK0", python("ZON (Keyence)")),
    (b"VK3_", VK),
    (b"VK4_", VK),
    (b"VK6", VK),
    (b"VK7", VK),
    (b"OLYMPUSRAWFORMAT", python("OIR (Olympus)")),
    (b"Zeta-Instruments", python("ZMG (KLA Zeta)")),
    (b"OmniSurf3D", python("OS3D (Digital Metrology)")),
    (b"Binary TrueMap Data File", python("TMD (TrueMap)")),
    (b"\x88\x1b\x03\x6f", METROPRO),
    (b"\x88\x1b\x03\x70", METROPRO),
    (b"\x88\x1b\x03\x71", METROPRO),
    (b"\x01\xb0\x93\xff", python("MDT (NT-MDT)")),
    (b"MATLAB ", MATLAB),
    (b":NANONIS_VERSION:", gwyddion("SXM (Nanonis)")),
    (b"DSAA", gwyddion("GRD (Surfer grid)")),
    (b"DSBB", gwyddion("GRD (Surfer grid)")),
    (b"II*\0", TIFF),
    (b"MM\0*", TIFF),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", OLE),
    (b"\x1f\x8b", Foreign { name: "gzip", way: Way::Unpack("gunzip --keep") }),
    (b"BZh", Foreign { name: "bzip2", way: Way::Unpack("bunzip2 --keep") }),
    (b"\xfd7zXZ\0", Foreign { name: "xz", way: Way::Unpack("unxz --keep") }),
    (b"\x28\xb5\x2f\xfd", Foreign { name: "zstd", way: Way::Unpack("unzstd") }),
    (b"7z\xbc\xaf\x27\x1c", Foreign { name: "7-Zip", way: Way::Unpack("7z x") }),
    (b"\x89PNG", IMAGE),
    (b"\xff\xd8\xff", IMAGE),
    (b"%PDF", IMAGE),
    (
        b"ncols",
        said(
            "an ESRI ASCII grid",
            "delete its heading lines and give cellsize as pixel_m (--pixel-m) and the unit of its heights \
             (--unit)",
        ),
    ),
];

/// HDF5 in the layout of JPK: datasets with a column for each frame.
const JPK_VIDEO: Foreign = Foreign { name: "h5-jpk (Bruker JPK video)", way: Way::JpkVideo };
/// Surfaces of contact.engineering or of SurfaceTopography in a zip archive.
const CONTAINER: Foreign = said(
    "a container of contact.engineering (zip archive with several measurements)",
    "`hysteron import FILE` writes its scans as surfaces, and prints a spec with surface.files",
);

/// Extensions of formats that are not read and have no first bytes of their own, or share them with others.
const EXTENSIONS: [(&str, Foreign); 22] = [
    ("ibw", python("IBW (Igor, Asylum Research)")),
    ("plu", python("PLU (Sensofar)")),
    ("apx", python("PLU (Sensofar)")),
    ("plux", python("PLUX (Sensofar)")),
    ("nms", python("NMS (NanoFocus)")),
    ("jpk", python("JPK (Bruker JPK)")),
    ("lext", python("LEXT (Olympus)")),
    ("hgt", python("HGT (SRTM)")),
    ("mnt", MNT),
    ("xls", EXCEL),
    ("sur", SUR),
    ("di", NANOSCOPE),
    ("spm", NANOSCOPE),
    ("opd", OPD),
    ("opdx", OPDX),
    ("gwy", GWY),
    ("nid", NID),
    ("ezd", NID),
    ("sdf", SDF),
    ("vk3", VK),
    ("vk4", VK),
    ("mat", MATLAB),
];

/// Recognises a format by the first bytes of a file, of which 512 are enough; nothing if it is unknown.
#[must_use]
pub fn detect(first_bytes: &[u8]) -> Option<Found> {
    // Control characters other than tabs and the ends of lines and pages are not text. UTF-16 has its zeros.
    let binary = |byte: &u8| *byte < 0x20 && !matches!(byte, b'\t' | b'\n' | b'\r' | 0x0c);
    let begins =
        |magic: &[u8]| first_bytes.get(..magic.len()).is_some_and(|first| first.eq_ignore_ascii_case(magic));
    if let Some((_, foreign)) = MAGIC.iter().find(|(magic, _)| begins(magic)) {
        return Some(Found::Foreign(*foreign));
    }
    match first_bytes {
        [0x89, b'H', b'D', b'F', b'\r', b'\n', 0x1a, b'\n', ..] => Some(Found::Hdf5),
        [0x93, b'N', b'U', b'M', b'P', b'Y', ..] => Some(Found::Scan(Format::Npy)),
        [b'C', b'D', b'F', 1 | 2 | 5, ..] => Some(Found::Scan(Format::NetCdf3)),
        [b'P', b'K', 3, 4, ..] => Some(archive(first_bytes)),
        [] => None,
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => {
            Some(Found::Foreign(said("text in UTF-16", "save it as UTF-8")))
        }
        bytes if bytes.iter().any(binary) => None,
        _ => Some(Found::Scan(Format::Text)),
    }
}

/// A zip archive, recognised by the name of its first part, at byte 30.
fn archive(first_bytes: &[u8]) -> Found {
    let name = first_bytes.get(30..).unwrap_or_default();
    let length = usize::from(first_bytes.get(26).copied().unwrap_or_default());
    let name = name.get(..length).unwrap_or(name);
    if name.ends_with(b".npy") {
        Found::Foreign(Foreign { name: "npz (NumPy archive)", way: Way::Npz })
    } else if name.starts_with(b"[Content_Types].xml") || name.starts_with(b"xl/") {
        Found::Foreign(EXCEL)
    } else if is_of_container(name) {
        Found::Foreign(CONTAINER)
    } else {
        Found::Scan(Format::X3p)
    }
}

/// True for a part of a container of contact.engineering: its metadata, or a measurement as NetCDF.
pub(crate) fn is_of_container(name: &[u8]) -> bool {
    [&b"meta.yml"[..], b"index.json", b"meta.json", b"metadata.json"].contains(&name)
        || name.ends_with(b".nc")
}

/// Refusal of a container of contact.engineering, whose parts may come in any order.
#[cfg(feature = "store")]
#[must_use]
pub(crate) fn container() -> String {
    match CONTAINER.way {
        Way::Said(help) => format!("{}\nhelp: {help}", CONTAINER.name),
        _ => CONTAINER.name.to_owned(),
    }
}

/// True for a regular file. What is not, such as a pipe or a device, might not end.
///
/// # Errors
/// Error of the system, for instance of a missing file.
pub fn is_regular(path: &Path) -> io::Result<bool> {
    Ok(std::fs::metadata(path)?.is_file())
}

/// Recognises the format of a file without reading more than its beginning.
///
/// # Errors
/// Error of the system, or a file that is not regular. The inner error is a file in a format that is not
/// read.
pub fn recognize(path: &Path) -> io::Result<Result<Found, Refusal>> {
    if !is_regular(path)? {
        return Err(io::Error::other("not a regular file"));
    }
    let mut first = Vec::new();
    File::open(path)?.take(FIRST).read_to_end(&mut first)?;
    let found = detect(&first);
    let shared = found.is_none() || [TIFF, OLE].into_iter().any(|of| found == Some(Found::Foreign(of)));
    let extension = path.extension().filter(|_| shared && !first.is_empty());
    let is_video = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("h5-jpk"));
    if found == Some(Found::Hdf5) && is_video {
        return Ok(Err(JPK_VIDEO.refusal(path)));
    }
    let named =
        extension.and_then(|ending| EXTENSIONS.iter().find(|(known, _)| ending.eq_ignore_ascii_case(known)));
    Ok(match named.map(|(_, foreign)| Found::Foreign(*foreign)).or(found) {
        Some(Found::Foreign(foreign)) => Err(foreign.refusal(path)),
        Some(found) => Ok(found),
        None => Err(unknown(&first)),
    })
}

/// The refusal of a file in no known format.
fn unknown(first_bytes: &[u8]) -> Refusal {
    let what = match first_bytes {
        [] => "the file is empty",
        bytes if bytes.iter().all(|byte| *byte == 0) => "unknown file format: the file begins with zeros",
        _ => "unknown file format",
    };
    let help = "formats that are read: HDF5, NetCDF, X3P, npy, text; SurfaceTopography (Python) and Gwyddion \
         convert others";
    Refusal { problem: what.to_owned(), help: help.to_owned() }
}

impl Foreign {
    fn refusal(self, path: &Path) -> Refusal {
        let (file, nc) = (quoted(path), quoted(&path.with_extension("nc")));
        let help = match self.way {
            Way::Python => format!(
                "convert it in Python (pip install SurfaceTopography) and import the result:\n    \
                 from SurfaceTopography.IO import open_topography\n    \
                 open_topography({file}).topography().to_netcdf({nc})"
            ),
            // NetCDF-3 holds ASCII alone, and a unit in UTF-8, which SUR has no place for, is none; a text
            // holds it.
            Way::PythonText => format!(
                "convert it in Python (pip install SurfaceTopography) and import the result:\n    \
                 from SurfaceTopography.IO import open_topography\n    \
                 open_topography({file}).topography().to_matrix({})",
                quoted(&path.with_extension("txt"))
            ),
            Way::JpkVideo => format!(
                "save a frame in Python (pip install AFMReader) and import the result with --unit nm:\n    \
                 import numpy\n    from AFMReader.h5_jpk import load_h5jpk\n    \
                 frames, pixel_nm, _ = load_h5jpk({file}, channel=\"height_trace\", flip_image=False)\n    \
                 numpy.save({}, frames[0]); print(\"--pixel-m\", 1e-9 * pixel_nm)",
                quoted(&path.with_extension("npy"))
            ),
            Way::Gwyddion => {
                "open it in Gwyddion and save it as text (ASCII data matrix, with the heading)".to_owned()
            }
            Way::Npz => format!(
                "save one of its arrays as npy in Python:\n    import numpy\n    \
                 numpy.save({}, numpy.load({file})[\"NAME\"])",
                quoted(&path.with_extension("npy"))
            ),
            Way::Unpack(command) => format!("decompress it first: {command} {}", in_shell(path)),
            Way::Said(help) => help.to_owned(),
        };
        Refusal { problem: format!("unsupported file format: {}", self.name), help }
    }
}

/// A path as a string literal of Python.
fn quoted(path: &Path) -> String {
    crate::text::quoted(&path.to_string_lossy())
}

/// A path as one word of a shell, which no character can end.
fn in_shell(path: &Path) -> String {
    let text: String =
        path.to_string_lossy().chars().map(|sign| if sign.is_control() { '?' } else { sign }).collect();
    format!("'{}'", text.replace('\'', "'\\''"))
}
