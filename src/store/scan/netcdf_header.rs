//! The header of a classic NetCDF file: its dimensions, its variables, and what they say of themselves.

use std::io::Read;

use super::attributes::{Attributes, Value, decoded};
use super::numbers::{Number, Order};
use super::{CUT, Cause, Source};

/// Bytes that a name may have; NetCDF itself allows 256.
const LONGEST_NAME: u64 = 1024;
/// Bytes that an attribute may have to be kept: units and sizes are short, and the rest is passed over.
const LONGEST_ATTRIBUTE: u64 = 4096;
/// Dimensions, variables or attributes that a file may have of each.
const MOST_ENTRIES: u64 = 1 << 16;
/// Dimensions that a variable may have.
const MOST_DIMENSIONS: u64 = 1024;
/// Value in place of the number of records while a file is being written.
const STREAMING: u64 = u32::MAX as u64;

/// Content of the header.
#[derive(Default)]
pub(super) struct Header {
    /// Number of records.
    pub(super) records: u64,
    /// Dimensions, to which variables point by their place.
    pub(super) dimensions: Vec<Dimension>,
    /// Variables, in any order.
    pub(super) variables: Vec<Variable>,
    /// Attributes of the file.
    pub(super) attributes: Attributes,
}

/// A dimension.
pub(super) struct Dimension {
    pub(super) name: String,
    /// Points along it; 0 for the one that grows with the records.
    pub(super) length: u64,
}

/// A variable.
pub(super) struct Variable {
    pub(super) name: String,
    /// Places of its dimensions, every one of which exists.
    pub(super) dimensions: Vec<usize>,
    pub(super) attributes: Attributes,
    /// Kind of its numbers; none for text.
    pub(super) kind: Option<Number>,
    /// Offset of its first number.
    pub(super) begin: u64,
}

impl Header {
    /// Reads the header.
    pub(super) fn read(source: &mut Source) -> Result<Self, Cause> {
        let left = source.length;
        let mut bytes = Bytes { source, left, counts: 4, places: 4 };
        match bytes.fixed()? {
            [b'C', b'D', b'F', 1] => {}
            [b'C', b'D', b'F', 2] => bytes.places = 8,
            [b'C', b'D', b'F', 5] => (bytes.counts, bytes.places) = (8, 8),
            _ => return Err("it does not begin as a classic NetCDF file does".into()),
        }
        let mut header = Self { records: bytes.count()?, ..Self::default() };
        if header.records == if bytes.counts == 8 { u64::MAX } else { STREAMING } {
            return Err(
                "the file was not closed by the program that wrote it: the number of records is missing"
                    .into(),
            );
        }
        for _ in 0..bytes.list(10, "dimensions")? {
            header.dimensions.push(Dimension { name: bytes.name()?, length: bytes.count()? });
        }
        header.attributes = bytes.attributes()?;
        for _ in 0..bytes.list(11, "variables")? {
            let variable = bytes.variable(header.dimensions.len())?;
            header.variables.push(variable);
        }
        Ok(header)
    }
}

/// Remainder of a file; reads beyond its end are errors.
struct Bytes<'a> {
    source: &'a mut Source,
    left: u64,
    /// Bytes of a count.
    counts: u64,
    /// Bytes of a place in the file.
    places: u64,
}

impl Bytes<'_> {
    fn spend(&mut self, count: u64) -> Result<(), Cause> {
        self.left = self.left.checked_sub(count).ok_or(CUT)?;
        Ok(())
    }

    fn take(&mut self, count: u64) -> Result<Vec<u8>, Cause> {
        self.spend(count)?;
        let mut bytes = Vec::new();
        self.source.file.by_ref().take(count).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn skip(&mut self, count: u64) -> Result<(), Cause> {
        self.spend(count)?;
        Ok(self.source.file.seek_relative(i64::try_from(count)?)?)
    }

    fn fixed(&mut self) -> Result<[u8; 4], Cause> {
        self.spend(4)?;
        let mut bytes = [0; 4];
        self.source.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    fn word(&mut self) -> Result<u64, Cause> {
        Ok(u64::from(u32::from_be_bytes(self.fixed()?)))
    }

    fn wide(&mut self, bytes: u64) -> Result<u64, Cause> {
        let high = if bytes == 8 { self.word()? << 32 } else { 0 };
        Ok(high | self.word()?)
    }

    fn count(&mut self) -> Result<u64, Cause> {
        self.wide(self.counts)
    }

    /// Number of entries of a list that begins here.
    fn list(&mut self, tag: u64, what: &str) -> Result<u64, Cause> {
        let (found, count) = (self.word()?, self.count()?);
        if found != tag && (found, count) != (0, 0) {
            return Err(format!("the header is damaged: no list of {what}").into());
        }
        if count > MOST_ENTRIES {
            Err(format!("it says that it has {count} {what}, and may have {MOST_ENTRIES}").into())
        } else {
            Ok(count)
        }
    }

    fn name(&mut self) -> Result<String, Cause> {
        let length = self.count()?;
        if length > LONGEST_NAME {
            return Err(format!("a name in the header has {length} bytes (limit {LONGEST_NAME})").into());
        }
        let name = self.take(length)?;
        self.skip(padding(length))?;
        Ok(String::from_utf8(name).map_err(|_| "a name in the header is not UTF-8 text")?)
    }

    fn attributes(&mut self) -> Result<Attributes, Cause> {
        let mut kept = Attributes::default();
        for _ in 0..self.list(12, "attributes")? {
            let name = self.name()?;
            let (kind, count) = (self.kind()?, self.count()?);
            let length = count.checked_mul(kind.map_or(1, |kind| kind.width() as u64)).ok_or(CUT)?;
            if length > LONGEST_ATTRIBUTE {
                self.skip(length.checked_add(padding(length)).ok_or(CUT)?)?;
                continue;
            }
            let bytes = self.take(length)?;
            self.skip(padding(length))?;
            let value = match kind {
                None => Value::Text(decoded(&bytes).trim_matches(['\0', ' ']).to_owned()),
                Some(kind) => Value::Numbers(
                    bytes.chunks_exact(kind.width()).map(|one| kind.value(one, Order::Big)).collect(),
                    kind,
                ),
            };
            kept.push(name, value);
        }
        Ok(kept)
    }

    /// A kind of number; none for text.
    fn kind(&mut self) -> Result<Option<Number>, Cause> {
        Ok(Some(match self.word()? {
            1 => Number::I8,
            2 => return Ok(None),
            3 => Number::I16,
            4 => Number::I32,
            5 => Number::F32,
            6 => Number::F64,
            // The five that came with CDF-5.
            7 => Number::U8,
            8 => Number::U16,
            9 => Number::U32,
            10 => Number::I64,
            11 => Number::U64,
            other => return Err(format!("unknown number type {other} in the header").into()),
        }))
    }

    fn variable(&mut self, dimensions: usize) -> Result<Variable, Cause> {
        let name = self.name()?;
        let count = self.count()?;
        if count > MOST_DIMENSIONS {
            return Err(format!("variable {name:?} has {count} dimensions (limit {MOST_DIMENSIONS})").into());
        }
        let mut places = Vec::new();
        for _ in 0..count {
            let place = usize::try_from(self.count()?)?;
            if place >= dimensions {
                return Err(format!("variable {name:?} has the dimension {place} of {dimensions}").into());
            }
            places.push(place);
        }
        let attributes = self.attributes()?;
        let kind = self.kind()?;
        // Size of the variable. It is not used: for a large variable, the field is too small for the right
        // value.
        self.count()?;
        Ok(Variable { name, dimensions: places, attributes, kind, begin: self.wide(self.places)? })
    }
}

/// Bytes between something of this length and the next thing.
pub(super) const fn padding(length: u64) -> u64 {
    length.wrapping_neg() % 4
}
