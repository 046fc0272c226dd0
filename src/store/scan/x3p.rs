//! X3P (ISO 25178-72, before that ISO 5436-2): a zip archive of a description in XML and the numbers.
//!
//! Lengths are in metres, always. The first point of the data is followed by its neighbour along x, so that a
//! column of heights here is a line of the file.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Read};

use ndarray::Array2;
use roxmltree::{Document, Node, ParsingOptions};
use zip::ZipArchive;
use zip::read::ZipFile;
use zip::result::ZipError;

use crate::formats::{container, is_of_container};

use super::numbers::{Layout, Number, Order, field, points};
use super::{Cause, FirstIndex, Scan, Source};

/// The description.
const MAIN: &str = "main.xml";
/// Bytes that the description may have: some kilobytes is what it has.
const MOST_XML: u64 = 1 << 24;
/// Elements that it may have; those of instruments have some forty. They are read by a function that calls
/// itself for what is inside, and as many of them, one inside the other, leave room on the stack of a thread.
const MOST_ELEMENTS: usize = 256;
/// Nodes that it may have, remarks and the blanks between elements among them.
const MOST_NODES: u32 = 1 << 16;
/// Attributes that all of them may have together; those of instruments have one or two. The parser compares
/// the attributes of an element with one another.
const MOST_ATTRIBUTES: usize = 1024;
/// Compression ratio of deflate on zeros: a part of an archive is at most this many times larger than its
/// compressed size.
const MOST_PACKED: u64 = 1100;

/// An archive on the disk.
type Archive = ZipArchive<BufReader<File>>;

/// Reads the surface.
pub(super) fn read(source: Source) -> Result<Scan, Cause> {
    let length = source.length;
    let mut archive = ZipArchive::new(source.file).map_err(|error| damaged(&error))?;
    let names = Names::of(&archive)?;
    let text = description(&mut archive, &names)?;
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&text, options)
        .map_err(|error| format!("{MAIN} is damaged: {error}"))?;
    let about = About::of(document.root_element())?;
    // Of at most 2^28 points, so that nothing overflows.
    let count = about.shape[0] * about.shape[1];

    let mut data = part(&mut archive, &names, &about.data, count * about.kind.width() as u64, length)?;
    // Heights are left to the bit where there is nothing to turn them by.
    let turn = |value: f64| match (about.increment, about.offset) {
        (None, None) => value,
        (increment, offset) => value * increment.unwrap_or(1.0) + offset.unwrap_or(0.0),
    };
    let mut heights = field(&mut data, about.kind, Order::Little, about.shape, Layout::Columns, turn)?;
    ends(data, &about.data)?;
    if let Some(name) = &about.valid {
        let mut bits = part(&mut archive, &names, name, count.div_ceil(8), length)?;
        remove(&mut heights, &mut bits)?;
        ends(bits, name)?;
    }
    Ok(Scan {
        size_m: about.size_m,
        unit: Some("m".to_owned()),
        factor: about.increment.unwrap_or(1.0),
        ..Scan::bare(heights, FirstIndex::Y)
    })
}

/// Takes out the points whose bit is 0; the lowest bit of a byte comes first.
fn remove(heights: &mut Array2<f64>, bits: &mut impl Read) -> Result<(), Cause> {
    let mut byte = [0];
    for (at, height) in heights.view_mut().reversed_axes().iter_mut().enumerate() {
        if at % 8 == 0 {
            bits.read_exact(&mut byte)?;
        }
        if byte.iter().all(|byte| byte >> (at % 8) & 1 == 0) {
            *height = f64::NAN;
        }
    }
    Ok(())
}

fn damaged(error: &ZipError) -> Cause {
    format!("damaged zip archive: {error}").into()
}

/// The parts of an archive by their paths from the folder that has the description, which is the root or one
/// folder in it.
struct Names {
    parts: HashMap<String, usize>,
    folder: String,
}

impl Names {
    fn of(archive: &Archive) -> Result<Self, Cause> {
        let twice = |name: &str| -> Cause {
            format!("the zip archive has two parts named {name:?}\nhelp: save the scan again").into()
        };
        let mut parts = HashMap::new();
        for (place, name) in archive.file_names().enumerate() {
            let name = plain(&name.map_err(|error| damaged(&error))?);
            if parts.insert(name.clone(), place).is_some() {
                return Err(twice(&name));
            }
        }
        // The library keeps the last one of parts with equal names.
        if archive.has_duplicate_names() {
            return Err("the zip archive has two parts of one name\nhelp: save the scan again".into());
        }
        if parts.contains_key(MAIN) {
            return Ok(Self { parts, folder: String::new() });
        }
        let in_folder =
            |name: &str| matches!(name.split_once('/'), Some((folder, MAIN)) if folder != "__MACOSX");
        let found: Vec<String> = parts.keys().filter(|name| in_folder(name)).cloned().collect();
        match &found[..] {
            [one] => Ok(Self { folder: one.trim_end_matches(MAIN).to_owned(), parts }),
            [] if parts.keys().any(|name| is_of_container(name.as_bytes())) => Err(container().into()),
            [] => Err(format!("zip archive without {MAIN}: not an X3P file").into()),
            many => Err(format!(
                "zip archive with {} X3P folders instead of one\nhelp: unpack it, and zip one of the folders",
                many.len()
            )
            .into()),
        }
    }

    /// The place of a part, by its path from the description.
    fn place(&self, name: &str) -> Option<usize> {
        self.parts.get(&format!("{}{}", self.folder, plain(name))).copied()
    }
}

/// A path in an archive as it should be: not everyone writes them so.
fn plain(name: &str) -> String {
    let name = name.trim().replace('\\', "/");
    name.trim_start_matches("./").trim_start_matches('/').to_owned()
}

/// Upper bound on the number of attributes of a text: signs of equality before a quotation mark.
fn attributes(text: &str) -> usize {
    text.split('=').skip(1).filter(|rest| rest.trim_start().starts_with(['"', '\''])).count()
}

/// The description as text.
fn description(archive: &mut Archive, names: &Names) -> Result<String, Cause> {
    let place = names.place(MAIN).ok_or_else(|| format!("it has no {MAIN}"))?;
    let main = archive.by_index(place).map_err(|error| damaged(&error))?;
    let mut bytes = Vec::new();
    main.take(MOST_XML + 1).read_to_end(&mut bytes).map_err(|error| format!("{MAIN} is damaged: {error}"))?;
    if bytes.len() as u64 > MOST_XML {
        return Err(format!("{MAIN} has more than {MOST_XML} bytes").into());
    }
    let text = String::from_utf8(bytes).map_err(|_| format!("{MAIN} is not in UTF-8"))?;
    let opens = |pair: &&[u8]| matches!(pair, [b'<', next] if !matches!(next, b'/' | b'!' | b'?'));
    if text.as_bytes().windows(2).filter(opens).count() > MOST_ELEMENTS {
        return Err(format!("{MAIN} has more than {MOST_ELEMENTS} elements").into());
    }
    if attributes(&text) > MOST_ATTRIBUTES {
        return Err(format!("{MAIN} has more than {MOST_ATTRIBUTES} attributes").into());
    }
    Ok(text.strip_prefix('\u{feff}').map(ToOwned::to_owned).unwrap_or(text))
}

/// A part of the archive, which must have a size of `bytes`.
fn part<'a>(
    archive: &'a mut Archive,
    names: &Names,
    name: &str,
    bytes: u64,
    length: u64,
) -> Result<ZipFile<'a, BufReader<File>>, Cause> {
    let place = names.place(name).ok_or_else(|| format!("{MAIN} names {name:?}, which is missing"))?;
    let file = archive.by_index(place).map_err(|error| damaged(&error))?;
    if file.size() != bytes {
        return Err(format!("{name:?} has {} bytes instead of {bytes} as in {MAIN}", file.size()).into());
    }
    if bytes > file.compressed_size().min(length).saturating_mul(MOST_PACKED) {
        return Err(format!("{name:?} claims {bytes} bytes, which a file of its size cannot hold").into());
    }
    Ok(file)
}

/// Makes sure that a part ends here, at which its checksum is compared too.
fn ends(mut part: impl Read, name: &str) -> Result<(), Cause> {
    let more = part.read(&mut [0]).map_err(|error| format!("{name:?} is damaged: {error}"))?;
    if more == 0 {
        Ok(())
    } else {
        Err(format!("{name:?} has more bytes than its entry in the archive states").into())
    }
}

/// Content of the description.
struct About {
    /// Points along x and along y.
    shape: [u64; 2],
    size_m: Option<[f64; 2]>,
    kind: Number,
    increment: Option<f64>,
    offset: Option<f64>,
    /// Path of the numbers.
    data: String,
    /// Path of the validity mask.
    valid: Option<String>,
}

impl About {
    fn of(root: Node<'_, '_>) -> Result<Self, Cause> {
        let axes = inside(root, &["Record1", "Axes"]).ok_or_else(|| format!("{MAIN} describes no axes"))?;
        let matrix = inside(root, &["Record3", "MatrixDimension"])
            .ok_or_else(|| format!("no matrix in {MAIN}: profiles and point clouds are not supported"))?;
        let [rows, columns, layers] = ["SizeX", "SizeY", "SizeZ"].map(|name| whole(matrix, name));
        let (shape, layers) = ([rows?, columns?], layers?);
        points(shape[0], shape[1])?;
        if layers != 1 {
            return Err(format!("{layers} layers instead of 1").into());
        }
        if inside(root, &["Record3", "DataList"]).is_some() {
            return Err(
                "heights stored in XML are not supported\nhelp: save the scan with binary data".into()
            );
        }
        let link = |name| word(inside(root, &["Record3", "DataLink"])?, name);
        let data = link("PointDataLink")
            .ok_or_else(|| format!("{MAIN} has no link to the heights (PointDataLink)"))?;
        let height = inside(axes, &["CZ"]).ok_or_else(|| format!("{MAIN} describes no axis CZ"))?;
        let kind = match word(height, "DataType").as_deref() {
            Some("I") => Number::I16,
            Some("L") => Number::I32,
            Some("F") => Number::F32,
            Some("D") => Number::F64,
            other => {
                return Err(format!(
                    "unsupported data type {:?} of the heights\nhelp: expected I, L, F or D",
                    other.unwrap_or("")
                )
                .into());
            }
        };
        let (increment, offset) = (number(height, "Increment")?, number(height, "Offset")?);
        let [x, y] = [("CX", shape[0]), ("CY", shape[1])].map(|(name, points)| size(axes, name, points));
        let size_m = x?.zip(y?).map(|(x, y)| [x, y]);
        Ok(Self { shape, size_m, kind, increment, offset, data, valid: link("ValidPointsLink") })
    }
}

/// Size along an axis \[m\], if it is said how far apart the points are.
fn size(axes: Node<'_, '_>, name: &str, points: u64) -> Result<Option<f64>, Cause> {
    let axis = inside(axes, &[name]).ok_or_else(|| format!("{MAIN} describes no axis {name}"))?;
    match word(axis, "AxisType").as_deref() {
        None | Some("I") => {}
        Some("A") => {
            return Err(format!(
                "the points along axis {name} are not evenly spaced, which is not supported"
            )
            .into());
        }
        Some(other) => {
            return Err(
                format!("unsupported type {other:?} of axis {name}\nhelp: expected I (incremental)").into()
            );
        }
    }
    let Some(increment) = number(axis, "Increment")? else {
        return Ok(None);
    };
    let size = increment * points as f64;
    if size.is_finite() && size > 0.0 {
        Ok(Some(size))
    } else {
        Err(format!("the points along axis {name} are {increment} m apart, which must be positive").into())
    }
}

/// The node that these names lead to, whatever namespace they are in.
fn inside<'a, 'input>(node: Node<'a, 'input>, names: &[&str]) -> Option<Node<'a, 'input>> {
    names.iter().try_fold(node, |node, name| {
        node.children().find(|child| child.is_element() && child.tag_name().name() == *name)
    })
}

/// The text of a node inside another, if it is there and not empty.
fn word(node: Node<'_, '_>, name: &str) -> Option<String> {
    let text = inside(node, &[name])?.text()?.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

fn number(node: Node<'_, '_>, name: &str) -> Result<Option<f64>, Cause> {
    let Some(text) = word(node, name) else {
        return Ok(None);
    };
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(Some(number)),
        _ => Err(format!("{name} of {} is {text:?} instead of a number", node.tag_name().name()).into()),
    }
}

fn whole(node: Node<'_, '_>, name: &str) -> Result<u64, Cause> {
    let text = word(node, name).ok_or_else(|| format!("{MAIN} has no {name}"))?;
    text.parse().map_err(|_| format!("{name} is {text:?} instead of a number of points").into())
}
