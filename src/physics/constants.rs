//! Tolerances and limits of the program, as rows of tables.
//!
//! Each module lists its own constants next to their use. The reference page `reference_limits.md` is written
//! from these lists.

/// A tolerance or limit that no key of a spec changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant {
    /// Quantity.
    pub name: &'static str,
    /// Value, or several values in the order of the meaning.
    pub values: &'static [f64],
    /// Unit of the values; empty for numbers and ratios.
    pub unit: &'static str,
    /// Effect, and the order of several values.
    pub meaning: &'static str,
    /// Module with the constant, below the module of the list.
    pub module: &'static str,
}

/// The constants of a module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Subject, as a heading.
    pub subject: &'static str,
    /// Path of the module.
    pub module: &'static str,
    /// Its constants.
    pub rows: &'static [Constant],
}

impl Constant {
    /// A constant of a submodule.
    #[must_use]
    pub const fn new(
        name: &'static str,
        values: &'static [f64],
        unit: &'static str,
        meaning: &'static str,
        module: &'static str,
    ) -> Self {
        Self { name, values, unit, meaning, module }
    }

    /// Its values as text.
    #[must_use]
    pub fn text(&self) -> String {
        self.values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(", ")
    }
}

/// A number as in the guide, to five digits: 1e-8, 0.05, 24, 20 000, 1e6.
#[must_use]
pub fn number(value: f64) -> String {
    let value = format!("{value:.4e}").parse().unwrap_or(value);
    let size = f64::abs(value);
    if size != 0.0 && !(1e-3..1e6).contains(&size) {
        return format!("{value:e}");
    }
    let text = format!("{value}");
    match text.strip_suffix("000") {
        Some(thousands) if size >= 1e4 && value.fract() == 0.0 => format!("{thousands} 000"),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use crate::constants::number;

    #[test]
    fn val_numbers_are_written_as_in_the_guide() {
        let cases = [
            (1e-8, "1e-8"),
            (5e-4, "5e-4"),
            (0.02, "0.02"),
            (1.0 / 3.0, "0.33333"),
            (32_768.0, "32768"),
            (24.0, "24"),
            (8192.0, "8192"),
            (20_000.0, "20 000"),
            (1e6, "1e6"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }
}
