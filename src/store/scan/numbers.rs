//! Binary numbers, and fields of them.

use std::io::Read;

use ndarray::Array2;

use super::{Cause, MOST_POINTS};

/// Bytes that are read at once, a multiple of every width.
const AT_ONCE: usize = 1 << 16;

/// A kind of number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
    F32,
    F64,
}

impl Number {
    /// Bytes that one takes.
    pub(crate) const fn width(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// True for floating-point numbers.
    pub(crate) const fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// Default fill value of NetCDF (`NC_FILL_*` of netcdf.h), which marks numbers that were never written;
    /// bytes have none.
    pub(super) const fn never_written(self) -> Option<f64> {
        Some(match self {
            Self::I8 | Self::U8 => return None,
            Self::I16 => -32_767.0,
            Self::U16 => 65_535.0,
            Self::I32 => -2_147_483_647.0,
            Self::U32 => 4_294_967_295.0,
            Self::I64 => -9_223_372_036_854_775_806.0,
            Self::U64 => 18_446_744_073_709_551_614.0,
            // 15 * 2^119, in single and in double precision.
            Self::F32 | Self::F64 => f64::from_bits(0x479e_0000_0000_0000),
        })
    }

    /// The value of one whose bytes are these.
    pub(super) fn value(self, bytes: &[u8], order: Order) -> f64 {
        let push = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        let bits = match order {
            Order::Little => bytes.iter().rev().fold(0, push),
            Order::Big => bytes.iter().fold(0, push),
        };
        // The high bytes of a narrow number are zero: what is cut off here is nothing.
        match self {
            Self::I8 => f64::from(bits as u8 as i8),
            Self::I16 => f64::from(bits as u16 as i16),
            Self::I32 => f64::from(bits as u32 as i32),
            Self::I64 => bits as i64 as f64,
            Self::U8 | Self::U16 | Self::U32 | Self::U64 => bits as f64,
            Self::F32 => f64::from(f32::from_bits(bits as u32)),
            Self::F64 => f64::from_bits(bits),
        }
    }
}

/// Which byte of a number comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

/// Which index runs fastest in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    /// The column, as in C.
    Rows,
    /// The row, as in Fortran.
    Columns,
}

/// Number of points of a field of this extent, if a scan can have as many.
pub(super) fn points(rows: u64, columns: u64) -> Result<u64, Cause> {
    match rows.checked_mul(columns) {
        Some(0) => {
            Err(format!("it says that it has {rows} by {columns} points, so that it holds no surface").into())
        }
        Some(count) if count <= MOST_POINTS => Ok(count),
        _ => Err(format!(
            "it says that it has {rows} by {columns} points, and a surface may have {MOST_POINTS}"
        )
        .into()),
    }
}

/// Memory for `count` heights, or an error instead of an abort of the program.
pub(in crate::store) fn room(count: u64) -> Result<Vec<f64>, Cause> {
    let mut values = Vec::new();
    usize::try_from(count)
        .ok()
        .and_then(|count| values.try_reserve_exact(count).ok())
        .map(|()| values)
        .ok_or_else(|| format!("its {count} heights do not fit into the memory of this machine").into())
}

/// Passes `count` numbers to `each`, in the order of the file.
pub(super) fn stream(
    from: &mut impl Read,
    kind: Number,
    order: Order,
    count: u64,
    mut each: impl FnMut(f64),
) -> Result<(), Cause> {
    let width = kind.width();
    let mut buffer = [0; AT_ONCE];
    let mut left = count * width as u64;
    while left > 0 {
        let now = usize::try_from(left).unwrap_or(AT_ONCE).min(AT_ONCE);
        let Some(part) = buffer.get_mut(..now) else { break };
        from.read_exact(part)?;
        part.chunks_exact(width).for_each(|bytes| each(kind.value(bytes, order)));
        left -= now as u64;
    }
    Ok(())
}

/// Reads a field of checked extent, rows by columns, whichever index runs fastest in the file.
pub(super) fn field(
    from: &mut impl Read,
    kind: Number,
    order: Order,
    [rows, columns]: [u64; 2],
    layout: Layout,
    turn: impl Fn(f64) -> f64,
) -> Result<Array2<f64>, Cause> {
    let count = points(rows, columns)?;
    let mut values = room(count)?;
    match layout {
        Layout::Rows => stream(from, kind, order, count, |value| values.push(turn(value)))?,
        Layout::Columns => {
            values.resize(count as usize, 0.0);
            let (step, mut place) = (columns as usize, 0);
            stream(from, kind, order, count, |value| {
                if let Some(height) = values.get_mut(place) {
                    *height = turn(value);
                }
                place += step;
                // The row below the last one is the top of the next column.
                if place >= count as usize {
                    place = place - count as usize + 1;
                }
            })?;
        }
    }
    shaped([rows, columns], values)
}

/// A field with its rows and columns exchanged.
pub(super) fn turned(field: Array2<f64>) -> Result<Array2<f64>, Cause> {
    let [rows, columns] = [field.ncols(), field.nrows()];
    let mut values = room(field.len() as u64)?;
    values.extend(field.t().iter().copied());
    shaped([rows as u64, columns as u64], values)
}

/// Heights as a field.
pub(super) fn shaped([rows, columns]: [u64; 2], values: Vec<f64>) -> Result<Array2<f64>, Cause> {
    Ok(Array2::from_shape_vec((rows as usize, columns as usize), values)?)
}
