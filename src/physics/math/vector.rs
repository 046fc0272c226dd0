//! Operations on vectors.

/// Scalar product `Σ a_i b_i`, in eight partial sums.
#[multiversion::multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    in_strands::<8, _>(a, b)
}

/// Scalar product in `N` partial sums, for inlining into a function compiled for the machine's vectors.
#[inline(always)]
pub(crate) fn in_strands<const N: usize, A: Copy + Into<f64>>(a: &[A], b: &[f64]) -> f64 {
    let mut strands = [0.0; N];
    let (a_whole, a_rest) = a.as_chunks::<N>();
    let (b_whole, b_rest) = b.as_chunks::<N>();
    for (ca, cb) in a_whole.iter().zip(b_whole) {
        for k in 0..N {
            strands[k] += ca[k].into() * cb[k];
        }
    }
    for (k, (x, y)) in a_rest.iter().zip(b_rest).enumerate() {
        strands[k] += (*x).into() * y;
    }
    strands.iter().sum()
}

/// Shortest periodic equivalent of a component of the vector between two points on a square.
///
/// It avoids rounding, which would be a function call.
#[inline]
pub(crate) fn nearest_image(way: f64, side: f64) -> f64 {
    if way > 0.5 * side {
        way - side
    } else if way < -0.5 * side {
        way + side
    } else {
        way
    }
}
