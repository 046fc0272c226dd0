//! Maps of the explorer of the report as text, one letter for each cell.

use super::StageError;
use crate::stats::significant;
use crate::store::read_maps;
use ndarray::ArrayView2;
use serde_json::{Value, json};
use std::path::Path;

/// Letters of the 64 levels of a map.
pub(super) const LETTERS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/// Cells along a side of the heights and of a map, at most.
const GROUND: usize = 64;
const CELLS: usize = 96;
/// Maximum number of maps of a cycle with `CELLS` cells along a side, and the cells along a side of more
/// maps.
const MOST_LARGE: usize = 8;
const FEWER_CELLS: usize = 64;

/// A number with five digits.
pub(super) fn rounded(number: f64) -> f64 {
    significant(number, 5).parse().unwrap_or(number)
}

/// Cells of a map, each with the value at its middle.
fn cells<T: Copy>(of: ArrayView2<'_, T>, most: usize, level: impl Fn(T) -> f64) -> String {
    let (rows, columns) = of.dim();
    let count = most.min(rows).min(columns);
    let at = |k: usize, points: usize| (2 * k + 1) * points / (2 * count);
    let letter = |value: T| LETTERS.as_bytes()[level(value).round().clamp(0.0, 63.0) as usize] as char;
    (0..count)
        .flat_map(|i| (0..count).map(move |j| (i, j)))
        .map(|(i, j)| letter(of[[at(i, rows), at(j, columns)]]))
        .collect()
}

/// The heights from the lowest to the highest. Measured surfaces may lack points.
pub(super) fn ground(heights_m: ArrayView2<'_, f64>) -> String {
    let known = heights_m.iter().copied().filter(|height| height.is_finite());
    let (low, high) =
        known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
    cells(heights_m, GROUND, |height| 63.0 * (height - low) / (high - low))
}

/// Adds the stored maps of boundary elements to the loops: place of the step, pressure and gap with their
/// ranges. Levels follow the square root.
pub(super) fn stored_maps(path: &Path, loops: &mut Value) -> Result<(), StageError> {
    if !path.is_file() {
        return Ok(());
    }
    let maps = read_maps(path)?;
    let side = if maps.len() > MOST_LARGE { FEWER_CELLS } else { CELLS };
    for of in loops.as_array_mut().into_iter().flatten() {
        let steps: Vec<i64> = of["s"].as_array().into_iter().flatten().filter_map(Value::as_i64).collect();
        let mut own = Vec::new();
        for map in &maps {
            let Some(k) = steps.iter().position(|step| *step == map.step) else { continue };
            let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::MIN_POSITIVE, f64::max);
            let high = largest(&mut map.pressure_pa.iter().map(|pressure| f64::from(*pressure)));
            let low = largest(&mut map.pressure_pa.iter().map(|pressure| -f64::from(*pressure)));
            let gap = largest(&mut map.gap_m.iter().map(|gap| f64::from(*gap)));
            let pressure = |value: f32| match f64::from(value) {
                value if value > 0.0 => 32.0 + 31.0 * (value / high).sqrt(),
                value => 32.0 - 32.0 * (-value / low).sqrt(),
            };
            own.push(json!({
                "k": k,
                "low_pa": rounded(-low),
                "high_pa": rounded(high),
                "gap_m": rounded(gap),
                "pressure": cells(map.pressure_pa.view(), side, pressure),
                "gap": cells(map.gap_m.view(), side, |value| 63.0 * (f64::from(value).max(0.0) / gap).sqrt()),
            }));
        }
        of["maps"] = Value::Array(own);
    }
    Ok(())
}
