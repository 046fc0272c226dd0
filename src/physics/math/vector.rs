//! Operations on vectors.

/// Scalar product `Σ a_i b_i`, in eight partial sums.
#[multiversion::multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut strands = [0.0; 8];
    let (a_whole, a_rest) = a.as_chunks::<8>();
    let (b_whole, b_rest) = b.as_chunks::<8>();
    for (ca, cb) in a_whole.iter().zip(b_whole) {
        for k in 0..8 {
            strands[k] += ca[k] * cb[k];
        }
    }
    for (k, (x, y)) in a_rest.iter().zip(b_rest).enumerate() {
        strands[k] += x * y;
    }
    strands.iter().sum()
}

/// Scalar product of single-precision with double-precision components, in sixteen partial sums.
#[multiversion::multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(crate) fn mixed_dot(a: &[f32], b: &[f64]) -> f64 {
    let mut strands = [0.0; 16];
    let (a_whole, a_rest) = a.as_chunks::<16>();
    let (b_whole, b_rest) = b.as_chunks::<16>();
    for (ca, cb) in a_whole.iter().zip(b_whole) {
        for k in 0..16 {
            strands[k] += f64::from(ca[k]) * cb[k];
        }
    }
    for (k, (x, y)) in a_rest.iter().zip(b_rest).enumerate() {
        strands[k] += f64::from(*x) * y;
    }
    strands.iter().sum()
}
