//! The parts of the report that say how far to trust it: where the loss goes, and what is beyond the limits of the model.

use super::StageError;
use super::page::escape;
use crate::schema::EVENT_KINDS;
use crate::stats::{CAUTIONS, LIMITS, Limit, Listed, Listing, labels, listing};
use crate::store::Frame;
use std::fmt::Write as _;

/// How a number is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shown {
    Plain,
    Percent,
}

/// The table "How far to trust it": heading, the column that is judged, and another one shown in brackets.
const TRUST: [(&str, &str, Option<&str>, Shown); 7] = [
    ("Tabor number: least (mean)", "tabor_min_min", Some("tabor_mean_mean"), Shown::Plain),
    ("share below 2", "low_tabor_share_mean", None, Shown::Percent),
    ("spots that touch (worst)", "touching_share_mean", Some("touching_share_max"), Shown::Percent),
    ("asperities covered (worst)", "covered_share_mean", Some("covered_share_max"), Shown::Percent),
    ("A/A<sub>0</sub>", "area_at_max_load_mean", None, Shown::Percent),
    ("conformity number (spectrum)", "conformity_realised_mean", Some("conformity_mean"), Shown::Plain),
    ("U<sub>el</sub>/Δγ (spectrum)", "persson_tosatti_realised_mean", Some("persson_tosatti_mean"), Shown::Plain),
];

/// The first cells of the heading of every table.
pub(super) const NAME_HEADS: &str = "<tr><th>case</th><th>F<sub>max</sub>/(E*A<sub>0</sub>)</th>";

/// The rows of the table `cases`, as the tables of the page list and name them.
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

    /// Whether a row carries a caution.
    fn has(&self, row: usize, word: &str) -> bool {
        self.words.get(row).is_some_and(|said| said.split('+').any(|part| part == word))
    }

    /// A cell, marked if the number of this column is beyond its limit.
    fn cell(&self, row: usize, column: &str, text: &str) -> String {
        // The caution decides, not the number: the Tabor number is a limit of one jump-in rule only.
        let beyond = limit_of(column).is_some_and(|limit| self.has(row, limit.caution));
        format!("<td{}>{text}</td>", if beyond { " class=\"beyond\"" } else { "" })
    }
}

/// Where the loss goes: shares of the branches and of the kinds of events. Kinds that lose nothing anywhere have no column.
pub(super) fn split(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    let mut kinds = Vec::new();
    for kind in EVENT_KINDS {
        let all = cases.frame.f64_or_null(&format!("dissipated_{kind}_mean"))?;
        if all.iter().flatten().any(|mean| *mean != 0.0) {
            kinds.push(kind);
        }
    }
    html.push_str(
        "<h2>Where the loss goes</h2>\n<p>Θ is the work around the loop. The sum over its events is a second account of it, and the audit gap is the \
         difference over Θ; both are over E*A<sub>0</sub>h<sub>rms</sub>. Shares are of that sum: by branch, and by the event that began each \
         relaxation. Covering has no potential, so its share may be negative.</p>\n<div class=\"wide\"><table>\n",
    );
    let _ = write!(
        html,
        "{NAME_HEADS}<th>Θ [10<sup>−3</sup>]</th><th>sum over events [10<sup>−3</sup>]</th><th>audit gap: worst (mean){}</th><th>loading</th><th>unloading</th>",
        bound("audit_gap_max", Shown::Percent)
    );
    for kind in &kinds {
        let _ = write!(html, "<th>{}</th>", kind.replace('_', " "));
    }
    html.push_str("</tr>\n");
    for listed in cases.rows() {
        let row = listed.row;
        let mean = |column: &str| cases.number(&format!("{column}_mean"), row);
        let whole = mean("dissipated")?;
        let _ = write!(html, "<tr>{}", cases.name(listed));
        for number in [mean("loss")?, whole] {
            let _ = write!(html, "<td>{}</td>", scaled(number, 1e-3));
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

/// What tells how far the model holds, with what is beyond its limit marked, and the cautions as sentences.
pub(super) fn trust(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    html.push_str(
        "<h2>How far to trust it</h2>\n<p>A summit model is outside its range where spots coalesce: a third of the contact area of a \
         boundary-element solution is then missing even without adhesion. It reproduces the model of the paper; see the limits in the README. \
         Numbers beyond their limit are bold. The conformity number is the elastic energy that flattens the shortest octave of the roughness over the \
         work of adhesion, and U<sub>el</sub>/Δγ that of all the roughness: of the modes that the surfaces have, and in brackets of the \
         continuous spectrum.</p>\n<div class=\"wide\"><table>\n",
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
    cautions(html, cases);
    Ok(())
}

/// Every caution that a row carries, with what it says and which rows carry it.
fn cautions(html: &mut String, cases: &Cases<'_>) {
    html.push_str("<h2>Cautions</h2>\n");
    let carried = |word: &str| cases.rows().iter().filter(|listed| cases.has(listed.row, word)).collect::<Vec<&Listed>>();
    let found: Vec<(&str, &str, Vec<&Listed>)> =
        CAUTIONS.iter().map(|(word, meaning)| (*word, *meaning, carried(word))).filter(|(_, _, rows)| !rows.is_empty()).collect();
    if found.is_empty() {
        html.push_str("<p>None.</p>\n");
        return;
    }
    html.push_str("<table>\n<tr><th>caution</th><th>what it says</th><th>case, at F<sub>max</sub>/(E*A<sub>0</sub>)</th></tr>\n");
    for (word, meaning, rows) in found {
        let place = if rows.len() == cases.rows().len() {
            "all".to_owned()
        } else {
            let name = |listed: &&Listed| format!("{} at {}", escape(&listed.label), cases.load(listed.row));
            rows.iter().map(name).collect::<Vec<_>>().join("<br>")
        };
        let _ = writeln!(html, "<tr><td>{word}</td><td>{}</td><td>{place}</td></tr>", escape(meaning));
    }
    html.push_str("</table>\n");
}

fn limit_of(column: &str) -> Option<&'static Limit> {
    LIMITS.iter().find(|limit| limit.column == column)
}

/// The limit of a column, as it stands below its heading; nothing if it has none.
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

/// What stands for a missing number.
const MISSING: &str = "–";

/// A number over the scale of its column; without the scale, and with a power of ten, where the scale cannot show it.
pub(super) fn scaled(number: Option<f64>, scale: f64) -> String {
    let own = number.filter(|number| *number != 0.0 && !(0.01..1e4).contains(&(number / scale).abs()));
    own.map_or_else(|| shown(number.map(|number| number / scale), Shown::Plain), power)
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
