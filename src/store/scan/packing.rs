//! Packed and missing values by the CF conventions and the NetCDF Users Guide.

use super::Cause;
use super::attributes::Attributes;
use super::numbers::Number;

/// Attributes that name values of missing points.
const FILLS: [&str; 2] = ["_FillValue", "missing_value"];

/// Rule that turns stored numbers into values; the attributes are those of the variable itself.
pub(super) struct Packing {
    /// `scale_factor`; 1 where it is absent.
    pub(super) scale: f64,
    offset: Option<f64>,
    /// Stored numbers that mark missing points.
    missing: Vec<f64>,
    /// Smallest and largest valid number.
    valid: [f64; 2],
    /// True if `valid` refers to unpacked values.
    unpacked: bool,
}

impl Packing {
    /// Packing of a variable of this kind. `defaults` is true for NetCDF, where numbers that were never
    /// written have a value of their own.
    pub(super) fn of(attributes: &Attributes, kind: Number, defaults: bool) -> Result<Self, Cause> {
        let scale = attributes.number("scale_factor");
        let offset = attributes.number("add_offset");
        if scale.is_some_and(|scale| !scale.is_finite() || scale.abs() < f64::MIN_POSITIVE)
            || offset.is_some_and(|by| !by.is_finite())
        {
            let [scale, offset] = [scale.unwrap_or(1.0), offset.unwrap_or(0.0)];
            return Err(
                format!("its heights have the scale_factor {scale} and the add_offset {offset}").into()
            );
        }
        let stored = |value: f64| if kind == Number::F32 { f64::from(value as f32) } else { value };
        let named = FILLS.iter().filter_map(|name| attributes.numbers(name)).flat_map(|(values, _)| values);
        let mut missing: Vec<f64> = named.map(|value| stored(*value)).collect();
        if missing.is_empty() {
            missing.extend(kind.never_written().filter(|_| defaults || kind.is_float()));
        }
        let (valid, wide) = Self::valid(attributes);
        // By the Users Guide, a range in floating point of packed integers is that of the unpacked values.
        let unpacked = wide && !kind.is_float() && (scale.is_some() || offset.is_some());
        Ok(Self { scale: scale.unwrap_or(1.0), offset, missing, valid, unpacked })
    }

    /// Valid range, and whether it is in floating point.
    fn valid(attributes: &Attributes) -> ([f64; 2], bool) {
        if let Some(([low, high], kind)) = attributes.numbers("valid_range") {
            return ([*low, *high], kind.is_float());
        }
        let bound = |name: &str| {
            attributes.numbers(name).and_then(|(values, kind)| Some((*values.first()?, kind.is_float())))
        };
        let (low, high) = (bound("valid_min"), bound("valid_max"));
        let wide = [low, high].into_iter().flatten().any(|(_, float)| float);
        (
            [
                low.map_or(f64::NEG_INFINITY, |(value, _)| value),
                high.map_or(f64::INFINITY, |(value, _)| value),
            ],
            wide,
        )
    }

    /// Value of a stored number; NaN where the point is missing.
    pub(super) fn value(&self, stored: f64) -> f64 {
        let value = match self.offset {
            Some(offset) => stored * self.scale + offset,
            None => stored * self.scale,
        };
        let [low, high] = self.valid;
        let compared = if self.unpacked { value } else { stored };
        // Infinite numbers remain here; the caller treats them as missing points.
        let invalid = compared < low || compared > high;
        if stored.is_nan() || invalid || self.missing.contains(&stored) { f64::NAN } else { value }
    }
}
