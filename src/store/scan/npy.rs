//! One array of NumPy: a line of Python that says what follows, and the numbers.

use std::io::Read;

use super::numbers::{Layout, Number, Order, field, points};
use super::{CUT, Cause, FirstIndex, Scan, Source};

/// Bytes that the line may have; NumPy itself reads 10 000.
const LONGEST_LINE: u64 = 1 << 16;
/// The kinds of numbers that are heights, as an error lists them.
const KINDS: &str = "f4, f8, i1, i2, i4, i8, u1, u2, u4, u8, with < or > before them";

/// Reads the array.
pub(super) fn read(mut source: Source) -> Result<Scan, Cause> {
    let (line, start) = line(&mut source)?;
    let about = Line { rest: &line }.parse().map_err(|cause| format!("the header is damaged: {cause}"))?;
    let [rows, columns] = about.shape[..] else {
        let many = about.shape.len();
        return Err(format!("{many} dimension{} instead of 2", if many == 1 { "" } else { "s" }).into());
    };
    let (kind, order) = number(&about.descr)?;
    // Fewer than 2^28 points of 8 bytes at most: nothing overflows.
    let says = start + points(rows, columns)? * kind.width() as u64;
    if says != source.length {
        let length = source.length;
        return Err(format!(
            "the file has {length} bytes, but {rows} by {columns} numbers of type {:?} need {says}",
            about.descr
        )
        .into());
    }
    // A row is a scan line along x, as in images: C order of rows and columns is Fortran order of x and y.
    let layout = if about.layout == Layout::Rows { Layout::Columns } else { Layout::Rows };
    let heights = field(&mut source.file, kind, order, [columns, rows], layout, |value| value)?;
    Ok(Scan::bare(heights, FirstIndex::Y))
}

/// The line, and where the numbers begin.
fn line(source: &mut Source) -> Result<(String, u64), Cause> {
    let mut fixed = [0; 8];
    source.file.read_exact(&mut fixed).map_err(|_| CUT)?;
    let [0x93, b'N', b'U', b'M', b'P', b'Y', version, _] = fixed else {
        return Err("not a NumPy file: wrong signature".into());
    };
    let width = match version {
        1 => 2,
        2 | 3 => 4,
        other => {
            return Err(format!(
                "unsupported version {other} of the npy format\nhelp: use version 1, 2 or 3"
            )
            .into());
        }
    };
    let mut length = Vec::new();
    source.file.by_ref().take(width).read_to_end(&mut length)?;
    let length = length.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte));
    let start = fixed.len() as u64 + width + length;
    if start > source.length {
        return Err(format!(
            "the file ends within the header of {length} bytes\nhelp: copy or download the file again"
        )
        .into());
    }
    if length > LONGEST_LINE {
        return Err(format!("the header has {length} bytes (limit {LONGEST_LINE})").into());
    }
    let mut line = Vec::new();
    source.file.by_ref().take(length).read_to_end(&mut line)?;
    Ok((String::from_utf8(line).map_err(|_| "the header is not UTF-8 text")?, start))
}

/// The kind of number that a word like `<f8` stands for.
fn number(descr: &str) -> Result<(Number, Order), Cause> {
    let (sign, word) = descr.split_at_checked(1).unwrap_or(("", descr));
    let kind = match word {
        "f4" => Number::F32,
        "f8" => Number::F64,
        "i1" => Number::I8,
        "i2" => Number::I16,
        "i4" => Number::I32,
        "i8" => Number::I64,
        "u1" => Number::U8,
        "u2" => Number::U16,
        "u4" => Number::U32,
        "u8" => Number::U64,
        _ => return Err(format!("unsupported number type {descr:?}\nhelp: use one of {KINDS}").into()),
    };
    match sign {
        "<" => Ok((kind, Order::Little)),
        ">" => Ok((kind, Order::Big)),
        "|" if kind.width() == 1 => Ok((kind, Order::Little)),
        _ => Err(format!("unsupported number type {descr:?}\nhelp: use one of {KINDS}").into()),
    }
}

/// Content of the line.
struct About {
    descr: String,
    layout: Layout,
    shape: Vec<u64>,
}

/// A dictionary of Python as NumPy writes it, what of it has not been read yet.
struct Line<'a> {
    rest: &'a str,
}

impl Line<'_> {
    fn parse(mut self) -> Result<About, Cause> {
        let (mut descr, mut layout, mut shape) = (None, None, None);
        self.expect('{')?;
        while !self.eat('}') {
            let key = self.quoted()?;
            self.expect(':')?;
            match key.as_str() {
                "descr" if self.rest.trim_start().starts_with(['[', '(']) => {
                    return Err(
                        "structured array with named fields\nhelp: save a two-dimensional array of numbers"
                            .into(),
                    );
                }
                "descr" => descr = Some(self.quoted()?),
                "fortran_order" => layout = Some(self.layout()?),
                "shape" => shape = Some(self.shape()?),
                other => {
                    return Err(format!(
                        "unknown entry {other:?} in the header\nhelp: expected descr, fortran_order, shape"
                    )
                    .into());
                }
            }
            if !self.eat(',') {
                self.expect('}')?;
                break;
            }
        }
        if !self.rest.trim().is_empty() {
            return Err("unexpected text after the dictionary".into());
        }
        match (descr, layout, shape) {
            (Some(descr), Some(layout), Some(shape)) => Ok(About { descr, layout, shape }),
            _ => Err("it lacks one of descr, fortran_order and shape".into()),
        }
    }

    fn eat(&mut self, sign: char) -> bool {
        let after = self.rest.trim_start().strip_prefix(sign);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    fn expect(&mut self, sign: char) -> Result<(), Cause> {
        if self.eat(sign) { Ok(()) } else { Err(format!("{sign:?} is missing").into()) }
    }

    fn quoted(&mut self) -> Result<String, Cause> {
        let quote = if self.eat('"') { '"' } else { '\'' };
        if quote == '\'' {
            self.expect(quote)?;
        }
        let (word, rest) = self.rest.split_once(quote).ok_or("a quotation has no end")?;
        self.rest = rest;
        Ok(word.to_owned())
    }

    fn layout(&mut self) -> Result<Layout, Cause> {
        for (word, layout) in [("False", Layout::Rows), ("True", Layout::Columns)] {
            if let Some(rest) = self.rest.trim_start().strip_prefix(word) {
                self.rest = rest;
                return Ok(layout);
            }
        }
        Err("fortran_order is neither True nor False".into())
    }

    fn shape(&mut self) -> Result<Vec<u64>, Cause> {
        let mut shape = Vec::new();
        self.expect('(')?;
        while !self.eat(')') {
            let text = self.rest.trim_start();
            let (digits, rest) =
                text.split_at(text.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(text.len()));
            shape.push(
                digits
                    .parse()
                    .map_err(|_| format!("the shape has {digits:?} instead of a number of points"))?,
            );
            // Python 2 put an L behind long numbers.
            self.rest = rest.strip_prefix('L').unwrap_or(rest);
            if !self.eat(',') {
                self.expect(')')?;
                break;
            }
        }
        Ok(shape)
    }
}
