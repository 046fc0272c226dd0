//! Signs of a measured loop: penetration and compression are positive.

use crate::PhysicsError;
use crate::model::Compression;

/// Load at the load reversal over the range of the load below which its sign says nothing.
const CLEAR: f64 = 0.05;

/// A loop with the signs of this program.
#[derive(Debug, Clone, PartialEq)]
pub struct Oriented {
    /// Displacement \[m\], increasing on approach.
    pub displacement_m: Vec<f64>,
    /// Load \[N\], positive in compression.
    pub load_n: Vec<f64>,
    /// Signs by which the numbers of the file were multiplied: displacement, load.
    pub signs: [f64; 2],
}

/// Gives a loop the signs of this program.
///
/// The displacement increases from the beginning to the load reversal, the point farthest from both ends.
/// With [`Compression::Auto`] the load is positive there, relative to the first points.
///
/// # Errors
/// Columns of different length, and a load at the reversal that is too small to have a sign.
pub fn oriented(
    displacement_m: &[f64],
    load_n: &[f64],
    compression: Compression,
) -> Result<Oriented, PhysicsError> {
    if displacement_m.len() != load_n.len() || load_n.is_empty() {
        return Err(PhysicsError::ProbeLoop {
            problem: format!("{} displacements and {} loads", displacement_m.len(), load_n.len()),
            help: "give one load for each displacement",
        });
    }
    let ends = 0.5 * (displacement_m[0] + displacement_m[displacement_m.len() - 1]);
    let farthest = |sign: f64| displacement_m.iter().map(|way| sign * (way - ends)).fold(0.0, f64::max);
    let of_way = if farthest(1.0) >= farthest(-1.0) { 1.0 } else { -1.0 };
    let of_load = match compression {
        Compression::Positive => 1.0,
        Compression::Negative => -1.0,
        Compression::Auto => {
            let way = |row: &usize| of_way * displacement_m[*row];
            let turn = (0..load_n.len()).max_by(|u, v| way(u).total_cmp(&way(v))).unwrap_or_default();
            let first = &load_n[..(load_n.len() / 50).clamp(1, 50)];
            let load = load_n[turn] - first.iter().sum::<f64>() / first.len() as f64;
            if load.abs() < CLEAR * super::measured_loop::range(load_n) {
                return Err(PhysicsError::ProbeLoop {
                    problem: "the sign of compression is unclear: the load at the load reversal is near zero"
                        .to_owned(),
                    help: "state whether compression is \"positive\" or \"negative\" in the file",
                });
            }
            load.signum()
        }
    };
    let scaled = |values: &[f64], sign: f64| values.iter().map(|value| sign * value).collect();
    Ok(Oriented {
        displacement_m: scaled(displacement_m, of_way),
        load_n: scaled(load_n, of_load),
        signs: [of_way, of_load],
    })
}
