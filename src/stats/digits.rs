//! Numbers in labels: the smallest number of digits that distinguishes them.

/// Significant digits of a label, unless more are needed to distinguish two values.
const DIGITS: usize = 4;

/// Digits that distinguish any two different doubles.
const ALL_DIGITS: usize = 17;

/// SI prefixes with their powers of ten.
const PREFIXES: [(i32, &str); 8] =
    [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G")];

/// A number with at most `digits` significant digits and no zeros at its end: `0.055`, `5e-10`.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    let size = rounded.abs();
    if rounded == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e6).contains(&size) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// Magnitudes that three digits show readably: `0.0100` to `99999`.
const READABLE: (f64, f64) = (0.01, 1e5);

/// The common power of ten of a column of numbers, a multiple of three. The median decides; the power moves
/// towards the smallest or the largest number as long as that makes more of the column readable.
#[must_use]
pub fn column_exponent(values: impl IntoIterator<Item = f64>) -> i32 {
    let mut sizes: Vec<f64> =
        values.into_iter().map(f64::abs).filter(|size| *size > 0.0 && size.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let (Some(median), Some(smallest), Some(largest)) =
        (sizes.get(sizes.len() / 2), sizes.first(), sizes.last())
    else {
        return 0;
    };
    // A median of 0.1 to 100 units; numbers of 0.01 to 1000 need no factor.
    let of_median = if (0.01..1e3).contains(median) {
        0
    } else {
        ((median.log10() + 1.0) / 3.0 + 1e-9).floor() as i32 * 3
    };
    let over = |exponent: i32, size: f64| size / 10f64.powi(exponent);
    let mut exponent = of_median;
    while over(exponent, *smallest) < READABLE.0 && over(exponent - 3, *largest) < READABLE.1 {
        exponent -= 3;
    }
    while over(exponent, *largest) >= READABLE.1 && over(exponent + 3, *smallest) >= READABLE.0 {
        exponent += 3;
    }
    exponent
}

/// Decimals of a number with `digits` significant digits; none for a number of more digits before its point.
#[must_use]
pub fn decimals(value: f64, digits: usize) -> usize {
    let text = format!("{:.*e}", digits.saturating_sub(1), value.abs());
    let power: i32 = text.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or_default();
    let wanted = i32::try_from(digits).unwrap_or(i32::MAX).saturating_sub(1).saturating_sub(power);
    if value == 0.0 { 0 } else { usize::try_from(wanted).unwrap_or_default() }
}

/// A power of ten as text: `10⁻³`.
#[must_use]
pub fn power_of_ten(exponent: i32) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised =
        |c: char| c.to_digit(10).and_then(|digit| RAISED.get(digit as usize).copied()).unwrap_or('⁻');
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

/// Numbers as labels: four significant digits each, more where two different numbers would have one label.
#[must_use]
pub fn labels(values: &[f64]) -> Vec<String> {
    let mut ordered = values.to_vec();
    ordered.sort_by(f64::total_cmp);
    ordered.dedup();
    // Rounding keeps the order, so that only neighbours can coincide.
    let apart = |digits: &usize| {
        let texts: Vec<String> = ordered.iter().map(|value| significant(*value, *digits)).collect();
        texts.windows(2).all(|pair| pair.first() != pair.last())
    };
    let digits = (DIGITS..ALL_DIGITS).find(apart).unwrap_or(ALL_DIGITS);
    values.iter().map(|value| significant(*value, digits)).collect()
}

/// Values of a column as labels with its unit, all with one SI prefix: `0.5 nm`, `1 MPa`, `0.055 J/m²`. The
/// unit follows from the column's name.
#[must_use]
pub fn labels_with_unit(column: &str, values: &[f64]) -> Vec<String> {
    let (unit, prefixed) = match column {
        name if name.ends_with("_m_n") => return labels(values),
        name if name.ends_with("_n") => ("N", true),
        name if name.ends_with("_j_m2") => ("J/m²", false),
        name if name.ends_with("_pa") => ("Pa", true),
        name if name.ends_with("_m") => ("m", true),
        _ => return labels(values),
    };
    let least =
        values.iter().map(|value| value.abs()).filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min);
    // The smallest value is written as 0.1 to 100 units.
    let wanted = if prefixed && least.is_finite() {
        ((least.log10() + 1.0) / 3.0 + 1e-9).floor() as i32 * 3
    } else {
        0
    };
    let nearest = PREFIXES.iter().min_by_key(|(power, _)| (power - wanted).abs()).copied();
    let (power, prefix) = nearest.unwrap_or((0, ""));
    let scaled: Vec<f64> = values.iter().map(|value| value / 10f64.powi(power)).collect();
    labels(&scaled).into_iter().map(|text| format!("{text} {prefix}{unit}")).collect()
}
