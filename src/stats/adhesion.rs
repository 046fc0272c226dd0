//! Works of adhesion of a loop: of closing and of opening.
//!
//! The reference is the state of zero load on the unloading path. The work of closing is the energy that the
//! surfaces give from separation, by way of the load reversal, to that state; the work of opening is the
//! energy that it takes from there to separation:
//!
//! `w_close A0 = −(∫_loading F dΔ + ∫_(F>0, unloading) F dΔ)`, `w_open A0 = ∫_(F<0, unloading) F dΔ`,
//!
//! with the normal load F \[N\], positive in compression, the mean penetration Δ \[m\] and the nominal area
//! A0 \[m²\]. Their difference is `Θ/A0` exactly. Both are equal without dissipation, and equal to `Δγ A/A0`
//! for flat surfaces. Without hysteresis in compression, they are the areas under the tensile parts of the
//! two branches.

use super::cycle::Branch;

/// Energies of closing and of opening \[J\], from the work up to the load reversal \[J\] and the steps after
/// it.
///
/// Between two steps the load is linear in Δ. Without tension the energy of opening is 0. Nothing without
/// steps.
pub(super) fn closing_and_opening_j(at_reversal_j: f64, unloading: &Branch) -> Option<[f64; 2]> {
    let last_j = *unloading.work_j.last()?;
    let to_zero_j = work_to_zero_load_j(unloading).unwrap_or(last_j);
    Some([-(at_reversal_j + to_zero_j), last_j - to_zero_j])
}

/// Work from the load reversal to zero load \[J\]; nothing if the load stays positive.
fn work_to_zero_load_j(unloading: &Branch) -> Option<f64> {
    let Branch { load_n, approach_m, work_j, .. } = unloading;
    let after = load_n.iter().position(|load| *load < 0.0)?;
    // The branch begins after the reversal, whose work is 0.
    let Some(before) = after.checked_sub(1) else { return Some(0.0) };
    let (load, next) = (load_n[before], load_n[after]);
    let to_zero_m = (approach_m[after] - approach_m[before]) * load / (load - next);
    Some(work_j[before] + 0.5 * load * to_zero_m)
}

#[cfg(test)]
mod tests {
    use super::{Branch, closing_and_opening_j};

    /// A branch with loads that are linear in Δ between these points, and its exact work.
    fn unloading(points: &[(f64, f64)]) -> Branch {
        let mut work = 0.0;
        let mut branch = Branch::default();
        for (k, (approach, load)) in points.iter().enumerate() {
            if let Some((before, of_before)) = k.checked_sub(1).map(|at| points[at]) {
                work += 0.5 * (load + of_before) * (approach - before);
            }
            branch.approach_m.push(*approach);
            branch.load_n.push(*load);
            branch.work_j.push(work);
        }
        branch
    }

    #[test]
    fn val_triangles_of_compression_and_tension() {
        // From Δ = 2, F = 2 to F = 0 at Δ = 0, and to F = -1 at Δ = -1, where it opens.
        let branch = unloading(&[(2.0, 2.0), (0.5, 0.5), (-0.5, -0.5), (-1.0, -1.0)]);
        // Loading took 1.6 J: closing gave 2 - 1.6, opening takes 1/2.
        let [closing, opening] = closing_and_opening_j(1.6, &branch).unwrap_or([f64::NAN; 2]);
        assert!((closing - 0.4).abs() < 1e-15 && (opening - 0.5).abs() < 1e-15, "{closing} {opening}");
    }

    #[test]
    fn lim_without_tension_nothing_opens() {
        let branch = unloading(&[(2.0, 2.0), (0.0, 0.0)]);
        let [closing, opening] = closing_and_opening_j(2.0, &branch).unwrap_or([f64::NAN; 2]);
        assert!(closing.abs() < 1e-15 && opening == 0.0);
    }
}
