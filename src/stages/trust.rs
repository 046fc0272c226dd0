//! Parts of the report: energy budget, model validity and warnings.

use super::StageError;
use super::page::escape;
use crate::schema::EVENT_KINDS;
use crate::stats::{LIMITS, Limit, Listed, Listing, Warning, column_exponent, decimals, labels, listing, warnings};
use crate::store::Frame;
use std::fmt::Write as _;

/// How a number is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shown {
    Plain,
    Percent,
}

/// The table of model validity: heading, the column that is compared with a limit, and the column shown in brackets.
const TRUST: [(&str, &str, Option<&str>, Shown); 9] = [
    ("Tabor parameter μ: minimum (mean)", "tabor_min_min", Some("tabor_mean_mean"), Shown::Plain),
    ("asperities with μ &lt; 2", "low_tabor_share_mean", None, Shown::Percent),
    ("asperities per surface: mean (minimum)", "summit_count_mean", Some("summit_count_min"), Shown::Plain),
    ("contacts at F<sub>max</sub>: mean (minimum)", "contact_count_at_max_load_mean", Some("contact_count_at_max_load_min"), Shown::Plain),
    ("overlapping contacts: pooled (maximum)", "touching_share_mean", Some("touching_share_max"), Shown::Percent),
    ("absorbed asperities: pooled (maximum)", "covered_share_mean", Some("covered_share_max"), Shown::Percent),
    ("A/A<sub>0</sub>", "area_at_max_load_mean", None, Shown::Percent),
    ("U<sub>el</sub>/Δγ of the shortest octave: realised (target)", "conformity_realised_mean", Some("conformity_mean"), Shown::Plain),
    ("U<sub>el</sub>/Δγ: realised (target)", "persson_tosatti_realised_mean", Some("persson_tosatti_mean"), Shown::Plain),
];

/// The first cells of the heading of every table.
pub(super) const NAME_HEADS: &str = "<tr><th>case</th><th>F<sub>max</sub>/(E*A<sub>0</sub>)</th>";

/// The rows of the table `cases`, in the order and with the labels of the report.
pub(super) struct Cases<'a> {
    pub(super) frame: &'a Frame,
    pub(super) realizations: &'a Frame,
    loads: Vec<String>,
    words: Vec<&'a str>,
    listing: Listing,
}

impl<'a> Cases<'a> {
    pub(super) fn of(frame: &'a Frame, realizations: &'a Frame) -> Result<Self, StageError> {
        let (loads, words) = (labels(&frame.f64("max_load")?), frame.text("caution")?);
        Ok(Self { frame, realizations, loads, words, listing: listing(frame)? })
    }

    /// The rows in the order of the tables.
    pub(super) fn rows(&self) -> &[Listed] {
        &self.listing.rows
    }

    /// The parameters of the reference case that vary, if there is such a case.
    pub(super) fn reference(&self) -> Option<&str> {
        self.listing.reference.as_deref()
    }

    /// The scale of the means of these columns, which share it.
    pub(super) fn scale(&self, columns: &[&str]) -> Result<Scale, StageError> {
        let mut means = Vec::new();
        for column in columns {
            means.extend(self.frame.f64_or_null(&format!("{column}_mean"))?.iter().flatten().copied());
        }
        Ok(Scale::of(&means))
    }

    pub(super) fn number(&self, column: &str, row: usize) -> Result<Option<f64>, StageError> {
        Ok(self.frame.f64_or_null(column)?.get(row).copied().flatten())
    }

    /// The first two cells of a row.
    pub(super) fn name(&self, listed: &Listed) -> String {
        format!("<td>{}</td><td>{}</td>", escape(&listed.label), self.load(listed.row))
    }

    fn load(&self, row: usize) -> &str {
        self.loads.get(row).map_or("", String::as_str)
    }

    /// True if a row has a warning.
    fn has(&self, row: usize, word: &str) -> bool {
        self.words.get(row).is_some_and(|said| said.split('+').any(|part| part == word))
    }

    /// A cell, marked where the number of this column is beyond its limit.
    fn cell(&self, row: usize, column: &str, text: &str) -> String {
        // The warning decides, not the number: the limit of the Tabor parameter applies to one criterion only.
        let beyond = limit_of(column).is_some_and(|limit| self.has(row, limit.caution));
        format!("<td{}>{text}</td>", if beyond { " class=\"beyond\"" } else { "" })
    }
}

/// The energy budget: fractions by branch and by kind of event. Kinds without dissipated energy in all cases have no column.
pub(super) fn split(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    let mut kinds = Vec::new();
    for kind in EVENT_KINDS {
        let all = cases.frame.f64_or_null(&format!("dissipated_{kind}_mean"))?;
        if all.iter().flatten().any(|mean| *mean != 0.0) {
            kinds.push(kind);
        }
    }
    html.push_str(
        "<h2>Energy budget</h2>\n<p>Θ is the area of the loop. The energies of all events sum to the same value if the energy balance is exact; the \
         energy-balance error is the difference over Θ. Both are over E*A<sub>0</sub>h<sub>rms</sub>. The percentages are fractions of the sum over events: by \
         branch, and by the kind of event that triggers each relaxation. Absorption and release have no potential, so their fractions may be \
         negative.</p>\n<div class=\"wide\"><table>\n",
    );
    let scale = cases.scale(&ENERGIES)?;
    let factor = scale.head();
    let _ = write!(
        html,
        "{NAME_HEADS}<th>Θ{factor}</th><th>sum over events{factor}</th><th>energy-balance error: maximum (mean){}</th><th>loading</th><th>unloading</th>",
        bound("audit_gap_max", Shown::Percent)
    );
    for kind in &kinds {
        let _ = write!(html, "<th>{}</th>", kind_name(kind));
    }
    html.push_str("</tr>\n");
    for listed in cases.rows() {
        let row = listed.row;
        let mean = |column: &str| cases.number(&format!("{column}_mean"), row);
        let whole = mean("dissipated")?;
        let _ = write!(html, "<tr>{}", cases.name(listed));
        for number in [mean("loss")?, whole] {
            let _ = write!(html, "<td>{}</td>", scaled(number, scale));
        }
        let gap = with_aside(cases.number("audit_gap_max", row)?, mean("audit_gap")?, Shown::Percent);
        html.push_str(&cases.cell(row, "audit_gap_max", &gap));
        for part in ["loading", "unloading"].iter().chain(&kinds) {
            let share = mean(&format!("dissipated_{part}"))?.zip(whole.filter(|whole| *whole != 0.0)).map(|(part, whole)| part / whole);
            let _ = write!(html, "<td>{}</td>", shown(share, Shown::Percent));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    Ok(())
}

/// The name of a kind of event.
fn kind_name(kind: &str) -> &str {
    match kind {
        "jump_in" => "jump into contact",
        "jump_off" => "jump out of contact",
        "cover" => "absorption",
        "uncover" => "release",
        "snap" => "snap-through",
        "merge" => "merging",
        "split" => "splitting",
        _ => kind,
    }
}

/// The indicators of model validity with their limits, and the warnings.
pub(super) fn trust(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    html.push_str(
        "<h2 id=\"validity\">Model validity</h2>\n<p>An asperity model is outside its range where contacts coalesce: it then underestimates the contact area \
         of a boundary-element solution by a third, even without adhesion. Numbers beyond their limit are bold. U<sub>el</sub> is the elastic energy per area \
         that flattens the roughness, Δγ the work of adhesion: for the realised spectrum of the surfaces, and in brackets for the target \
         spectrum.</p>\n<div class=\"wide\"><table>\n",
    );
    html.push_str(NAME_HEADS);
    for (heading, column, _, as_what) in TRUST {
        let _ = write!(html, "<th>{heading}{}</th>", bound(column, as_what));
    }
    html.push_str("</tr>\n");
    for listed in cases.rows() {
        let row = listed.row;
        let _ = write!(html, "<tr>{}", cases.name(listed));
        for (_, column, aside, as_what) in TRUST {
            let aside = aside.map(|column| cases.number(column, row)).transpose()?.flatten();
            html.push_str(&cases.cell(row, column, &with_aside(cases.number(column, row)?, aside, as_what)));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    section(html, cases)
}

/// Every warning with its measured values, consequence, action and rows.
fn section(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    html.push_str("<h2>Warnings</h2>\n");
    let found = warnings(cases.frame)?;
    if found.is_empty() {
        html.push_str("<p>None.</p>\n");
        return Ok(());
    }
    html.push_str("<table>\n<tr><th>warning (code)</th><th>measured</th><th>consequence and action</th><th>cases, at F<sub>max</sub>/(E*A<sub>0</sub>)</th></tr>\n");
    for Warning { kind, measured, rows } in found {
        let place = if rows.len() == cases.rows().len() {
            "all".to_owned()
        } else {
            let name = |listed: &Listed| format!("{} at {}", escape(&listed.label), cases.load(listed.row));
            cases.rows().iter().filter(|listed| rows.contains(&listed.row)).map(name).collect::<Vec<_>>().join("<br>")
        };
        let _ = writeln!(
            html,
            "<tr><td>{} ({})</td><td>{}</td><td>{} {}</td><td>{place}</td></tr>",
            kind.label,
            kind.code,
            with_code(&measured),
            with_code(kind.consequence),
            with_code(kind.action)
        );
    }
    html.push_str("</table>\n");
    Ok(())
}

/// Text for HTML, with code between backticks.
fn with_code(text: &str) -> String {
    let part = |(k, part): (usize, &str)| if k % 2 == 1 { format!("<code>{part}</code>") } else { part.to_owned() };
    escape(text).split('`').enumerate().map(part).collect()
}

fn limit_of(column: &str) -> Option<&'static Limit> {
    LIMITS.iter().find(|limit| limit.column == column)
}

/// The limit of a column, below its heading; empty without a limit.
fn bound(column: &str, as_what: Shown) -> String {
    let said = |limit: &Limit| format!("<br>{}\u{a0}{}", if limit.at_least { "≥" } else { "≤" }, shown(Some(limit.bound), as_what));
    limit_of(column).map_or_else(String::new, said)
}

/// A number, and another one in brackets if there is one.
fn with_aside(number: Option<f64>, aside: Option<f64>, as_what: Shown) -> String {
    match aside {
        Some(_) => format!("{} ({})", shown(number, as_what), shown(aside, as_what)),
        None => shown(number, as_what),
    }
}

/// Sign of a missing number.
const MISSING: &str = "–";

/// Columns of energies over `E* A0 h_rms`, which share one scale in all tables.
pub(super) const ENERGIES: [&str; 8] =
    ["loss", "loss_dk", "loss_dk_realised", "loss_touched", "loss_dalvi", "loss_pinning", "loss_jkr_curve", "dissipated"];

/// The common power of ten of the numbers of a column; none where they differ by too much, and each has its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale(Option<i32>);

impl Scale {
    fn of(means: &[f64]) -> Self {
        let exponent = column_exponent(means.iter().copied());
        let is_readable = |mean: &f64| *mean == 0.0 || (1e-3..1e5).contains(&(mean.abs() / 10f64.powi(exponent)));
        Self(means.iter().all(is_readable).then_some(exponent))
    }

    /// The factor for the head of the column; empty where there is none.
    pub(super) fn head(self) -> String {
        let of = |exponent: i32| format!(" [10<sup>{exponent}</sup>]").replace('-', "−");
        self.0.filter(|exponent| *exponent != 0).map(of).unwrap_or_default()
    }
}

/// A number over the scale of its column, with three significant digits.
pub(super) fn scaled(number: Option<f64>, scale: Scale) -> String {
    let Some(number) = number else { return MISSING.to_owned() };
    let Some(exponent) = scale.0 else { return if number == 0.0 { "0".to_owned() } else { power(number) } };
    let over = number / 10f64.powi(exponent);
    // The limits of an interval may be far smaller than all means.
    let places = decimals(over, 3).min(5);
    let text = format!("{over:.places$}");
    if text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.')) { "0".to_owned() } else { text.replace('-', "−") }
}

/// A number as a digit or two and a power of ten.
fn power(number: f64) -> String {
    let text = format!("{number:.1e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{digits}×10<sup>{exponent}</sup>").replace('-', "−")
}

/// A number with three digits, or a dash where it is missing; a small or large one with a power of ten.
pub(super) fn shown(number: Option<f64>, as_what: Shown) -> String {
    let Some(number) = number else {
        return MISSING.to_owned();
    };
    let text = match (as_what, number.abs()) {
        (Shown::Percent, size) if (100.0 * size).fract() == 0.0 => format!("{:.0}\u{a0}%", 100.0 * number + 0.0),
        (Shown::Percent, size) if size < 5e-4 => "0.0\u{a0}%".to_owned(),
        (Shown::Percent, _) => format!("{:.1}\u{a0}%", 100.0 * number),
        (Shown::Plain, 0.0) => "0".to_owned(),
        (Shown::Plain, size) if !(0.01..1e5).contains(&size) => return power(number),
        (Shown::Plain, size) if size >= 100.0 || size.fract() == 0.0 => format!("{number:.0}"),
        (Shown::Plain, size) if size >= 10.0 => format!("{number:.1}"),
        (Shown::Plain, size) if size >= 1.0 => format!("{number:.2}"),
        (Shown::Plain, _) => format!("{number:.3}"),
    };
    // A minus sign that is as wide as a digit.
    text.replace('-', "−")
}
