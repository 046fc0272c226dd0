//! Morse's law in single precision, without branches, so that the compiler can evaluate it at many points at
//! once.

/// Overlap in ranges up to which the law is evaluated here.
const MAX_OVERLAP: f32 = 5.0;
/// Changes of the gap in ranges for which the series of [`excess`] is exact to single precision.
const MAX_CHANGE: f32 = 1.0;
/// Gap in ranges from which on the exponential is constant, and negligible.
const MAX_GAP: f32 = 80.0;
/// Coefficients `1/n!` of [`excess`], from the last to the first.
const SERIES: [f32; 10] = [
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
];

/// Morse's law.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Smooth {
    /// Work of adhesion \[E* dx\].
    pub(crate) work: f32,
    /// Inverse of the range \[1/dx\].
    pub(crate) inverse_range: f32,
}

/// Effect of a change of the gap.
pub(crate) struct Effect {
    /// Tension, less that at the first gap \[E*\].
    pub(crate) tension: f32,
    /// Slope of the tension after it \[E*/dx\].
    pub(crate) slope: f32,
    /// Change of the energy beyond that of first order \[E* dx\].
    pub(crate) beyond: f32,
    /// False if the values do not hold: deep inside the wall, or if the change is too long.
    pub(crate) holds: bool,
}

impl Smooth {
    /// Change of the gap by `step` from `before`, with the tension relative to that at
    /// `first`, from which the gap has changed by `moved` in all \[dx\].
    #[inline(always)]
    pub(crate) fn change(&self, first: f32, before: f32, moved: f32, step: f32) -> Effect {
        let [first, before, moved, step] = [first, before, moved, step].map(|gap| gap * self.inverse_range);
        let (e0, e1) = (decay(first), decay(before));
        let curved = excess(step);
        let shrinks = curved - step;
        let e2 = e1 + e1 * shrinks;
        // From `first` on, without a difference of large values where the change is small.
        let since = e0 * (excess(moved) - moved);
        let [near, far] = [since * (1.0 - 2.0 * e0 - since), e2 * (1.0 - e2) - e0 * (1.0 - e0)];
        let tension = if moved.abs() <= MAX_CHANGE { near } else { far };
        let stress = 2.0 * self.work * self.inverse_range;
        Effect {
            tension: stress * tension,
            slope: stress * self.inverse_range * e2 * (2.0 * e2 - 1.0),
            beyond: self.work * e1 * (2.0 * (e1 - 1.0) * curved + e1 * shrinks * shrinks),
            holds: first.min(before).min(first + moved) > -MAX_OVERLAP && step.abs() <= MAX_CHANGE,
        }
    }
}

/// `e^(−x)`, to two units in the last place for `x` between −80 and 80: by `2^n e^r` with `|r| ≤ ln 2/2`
/// (Cephes, `expf`).
#[inline(always)]
fn decay(x: f32) -> f32 {
    // Adding and subtracting 1.5 · 2²³ rounds to an integer, which is then in the lowest bits.
    const ROUND: f32 = 12_582_912.0;
    let x = -x.clamp(-MAX_GAP, MAX_GAP);
    let shifted = x * std::f32::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = (x - n * 0.693_359_4) + n * 2.121_944_4e-4;
    let p = ((((1.987_569_1e-4 * r + 1.398_2e-3) * r + 8.333_452e-3) * r + 4.166_579_6e-2) * r
        + 1.666_666_5e-1)
        * r
        + 0.5;
    let power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(0x3f80_0000));
    (p * r * r + r + 1.0) * power
}

/// `e^(−t) − 1 + t`, which is of second order, for `|t| ≤ 1`.
#[inline(always)]
fn excess(t: f32) -> f32 {
    let minus = -t;
    let mut sum = 0.0;
    for coefficient in SERIES {
        sum = sum * minus + coefficient;
    }
    sum * t * t
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Energy, tension and slope of Morse's law in double precision.
    fn morse(work: f64, range: f64, gap: f64) -> [f64; 3] {
        let e = (-gap / range).exp();
        [
            work * e * (e - 2.0),
            2.0 * work / range * e * (1.0 - e),
            2.0 * work / (range * range) * e * (2.0 * e - 1.0),
        ]
    }

    /// Changes of the gap everywhere: relative to the values at the smaller gap, 1e-6 and the rounding of the
    /// gap in ranges (24 bits). The energy beyond first order is relative to `t² Δγ e (1 + e)`; its value in
    /// double precision is a difference, known to 1e-15.
    #[test]
    fn law_morse_in_single_precision() {
        let (work, range) = (0.02, 0.11);
        let smooth = Smooth { work: work as f32, inverse_range: 1.0 / range as f32 };
        let mut count = 0;
        for (i, j, earlier) in
            (0..400).flat_map(|i| (-20..=20).flat_map(move |j| [(i, j, 0.0), (i, j, 0.2), (i, j, 1.5)]))
        {
            let gaps = [earlier, f64::from(i) * 0.25 - 3.0, f64::from(j) / 20.0]
                .map(|gap| f64::from((gap * range) as f32));
            let [earlier, before, step] = gaps;
            let first = before - earlier;
            let [[_, tension_at_first, _], [energy, tension_before, _], after] =
                [first, before, before + step].map(|gap| morse(work, range, gap));
            let found = smooth.change(first as f32, before as f32, (earlier + step) as f32, step as f32);
            let nearest = before.min(before + step) / range;
            let e = (-nearest).exp();
            let (scale, tolerance) = (work * e * (1.0 + e), 1e-6 + 1.2e-7 * nearest.abs());
            let tension = f64::from(found.tension) - (after[1] - tension_at_first);
            let slope = f64::from(found.slope) - after[2];
            let beyond = f64::from(found.beyond) - (after[0] - energy - tension_before * step);
            assert!(found.holds);
            let path = ((earlier + step) / range).abs().min(1.0);
            let largest = scale.max(work * (-first / range).exp() * (1.0 + (-first / range).exp()));
            assert!(
                tension.abs() < tolerance * 2.0 * path * largest / range + 1e-15 * work / range,
                "{gaps:?}: {tension}"
            );
            assert!(slope.abs() < tolerance * 4.0 * scale / (range * range) + 1e-30, "{gaps:?}: {slope}");
            assert!(
                beyond.abs() < tolerance * (step / range).powi(2) * scale + 2e-15 * (scale + work),
                "{gaps:?}: {beyond}"
            );
            count += 1;
        }
        assert_eq!(count, 49_200);
        assert!(!smooth.change(0.0, -0.6, -0.6, 0.0).holds && !smooth.change(0.0, 0.0, 0.12, 0.12).holds);
        assert!(smooth.change(1e30, 1e30, 0.0, 0.0).tension == 0.0);
    }
}
