//! Attributes of HDF5 files: numbers, words and texts.

use super::error::Cause;
use crate::model::Choice;
use hdf5_metno::types::{FixedUnicode, TypeDescriptor, VarLenUnicode};
use hdf5_metno::{File, H5Type, Location};

/// Group with a copy of every text attribute of the root, as strings of fixed length, and the checksum of the
/// heights. Files of earlier versions have these strings in the root.
pub(super) const COPIES: &str = "header";
/// Bytes that a word may have: a key is the longest.
const LONGEST_WORD: usize = 256;

pub(super) fn write_number<T: H5Type>(place: &Location, name: &str, value: T) -> Result<(), Cause> {
    Ok(place.new_attr::<T>().create(name)?.write_scalar(&value)?)
}

pub(super) fn write_finite(place: &Location, name: &str, value: f64) -> Result<(), Cause> {
    if value.is_finite() {
        write_number(place, name, value)
    } else {
        Err(format!("{name} is {value}, must be finite").into())
    }
}

/// Writes a text as an attribute of variable length, which h5py reads as `str`. It must not contain the
/// character 0.
pub(super) fn write_text(place: &Location, name: &str, value: &str) -> Result<(), Cause> {
    let text: VarLenUnicode = value.parse()?;
    Ok(place.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text)?)
}

/// Writes a word as an attribute of the root, and a copy of it as a string of fixed length.
///
/// HDF5 keeps strings of variable length in a heap without a checksum, and a single changed byte in the heap
/// can make the library loop for ever. This program therefore reads only the copies.
pub(super) fn write_word(file: &File, name: &str, value: &str) -> Result<(), Cause> {
    if value.len() > LONGEST_WORD || value.contains('\0') {
        return Err(format!(
            "its {name} {value:?} cannot be stored: it may have {LONGEST_WORD} bytes, none of them 0"
        )
        .into());
    }
    write_copy(file, name, value)?;
    write_text(file, name, value)
}

/// Writes a word as a string of fixed length.
pub(super) fn write_copy(file: &File, name: &str, value: &str) -> Result<(), Cause> {
    let word: FixedUnicode<LONGEST_WORD> = value.parse()?;
    // HDF5 has no string of length 0; an empty word is one zero byte.
    let stored = TypeDescriptor::FixedUnicode(value.len().max(1));
    Ok(file.group(COPIES)?.new_attr_builder().empty_as(&stored).create(name)?.write_scalar(&word)?)
}

pub(super) fn number<T: H5Type>(place: &Location, name: &str) -> Result<T, Cause> {
    let read = || place.attr(name)?.read_scalar::<T>();
    read().map_err(|error| bad_attribute(name, &error))
}

fn bad_attribute(name: &str, why: &dyn std::fmt::Display) -> Cause {
    format!("its attribute {name:?} cannot be read: {why}").into()
}

pub(super) fn finite(place: &Location, name: &str) -> Result<f64, Cause> {
    let value: f64 = number(place, name)?;
    if value.is_finite() { Ok(value) } else { Err(bad_attribute(name, &format!("it is {value}"))) }
}

/// A truth value, from a number or, in files of earlier versions, from a boolean of HDF5.
pub(super) fn truth(place: &Location, name: &str) -> Result<bool, Cause> {
    match number::<i8>(place, name)? {
        0 => Ok(false),
        1 => Ok(true),
        other => Err(bad_attribute(name, &format!("it is {other}, neither true nor false"))),
    }
}

pub(super) fn word(place: &Location, name: &str) -> Result<String, Cause> {
    let value: FixedUnicode<LONGEST_WORD> = number(place, name)?;
    // The library does not look whether the bytes are text.
    String::from_utf8(value.as_bytes().to_vec()).map_err(|error| bad_attribute(name, &error))
}

pub(super) fn choice<T: Choice>(place: &Location, name: &str) -> Result<T, Cause> {
    let value = word(place, name)?;
    T::from_word(&value).ok_or_else(|| {
        let allowed: Vec<_> = T::WORDS.iter().map(|(word, _)| *word).collect();
        bad_attribute(name, &format!("unknown value {value:?}\nhelp: expected one of {}", allowed.join(", ")))
    })
}
