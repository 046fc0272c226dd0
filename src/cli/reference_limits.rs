//! The reference page of tolerances and limits, from the constants of the program.

use super::verbs::IMPORT;
use crate::constants::{Constant, Constants, number};
use crate::stats::{CAUTIONS, Caution, Limit, condition};
use crate::text::paragraph;
use crate::{engines, spec, stages};

const HEAD: &str = "\
# Tolerances and limits

Written by `hysteron schema --write` from the constants of the program; do not edit.

This page lists the limits of warnings, and the tolerances and limits that no key of a spec changes.
[Numerical method](numerics.md) and [Boundary elements](boundary_elements.md) describe where they
act, [Spec keys](reference_spec.md) has the ranges of keys.

| symbol | unit | meaning |
|---|---|---|
| `h_rms` | m | rms height |
| `d` | m | mean magnitude of the jump-off penetration over all asperities |
| `dx` | m | grid spacing of boundary elements |
| `ρ` | m | range of attraction of Morse's law |
| `Δγ`, `E*` | J/m², Pa | work of adhesion, reduced modulus |
| `Θ`, `W` | J | dissipated energy, largest work along the loop |
| `δ_in`, `δ_off` | m | jump-in and jump-off penetration |
| `a`, `R` | m | contact radius, radius of curvature of an asperity |
";

const WARNINGS: &str = "
## Warnings

[Validity](validity.md#warnings) explains the warnings. They are ordered by severity, as in the
column `caution` of `cases`. The limit itself is within the range.

| code | column of `cases` | warning if |
|---|---|---|
";

/// The page in Markdown.
pub(super) fn page() -> String {
    let mut page = format!("{HEAD}{WARNINGS}");
    page.extend(CAUTIONS.iter().map(row));
    page.push('\n');
    for caution in CAUTIONS {
        page += &paragraph(
            "- ",
            &format!("`{}`, {}: {} {}", caution.code, caution.label, caution.consequence, caution.action),
        );
        page.push('\n');
    }
    page.extend(constants().iter().map(section));
    page
}

/// Every tolerance and limit of the program, by module.
#[must_use]
pub fn constants() -> Vec<Constants> {
    let others = [IMPORT, spec::CONSTANTS, engines::CONSTANTS];
    stages::constants().chain(others).collect()
}

/// A warning as a row; a condition that is no limit of a column has no column.
fn row(caution: &Caution) -> String {
    match Limit::of(caution.code) {
        Some(limit) => {
            let sign = if limit.at_least { '<' } else { '>' };
            format!("| `{}` | `{}` | {sign} {} |\n", caution.code, limit.column, number(limit.bound))
        }
        None => format!("| `{}` | | {} |\n", caution.code, condition(caution.code).unwrap_or(caution.label)),
    }
}

/// The constants of a module: a table, then their effects.
fn section(of: &Constants) -> String {
    let mut text = format!(
        "\n## {}\n\nModule `{}`.\n\n| quantity | value | unit | file |\n|---|---|---|---|\n",
        of.subject, of.module
    );
    for constant in of.rows {
        text += &format!(
            "| {} | {} | {} | {} |\n",
            constant.name,
            constant.text(),
            constant.unit,
            file(constant)
        );
    }
    text.push('\n');
    for constant in of.rows {
        text += &paragraph("- ", &format!("*{}*: {}", constant.name, constant.meaning));
        text.push('\n');
    }
    text
}

/// The submodule of a constant.
fn file(constant: &Constant) -> String {
    if constant.module.is_empty() { String::new() } else { format!("`{}`", constant.module) }
}
