//! The parts of the report that say how far to trust it: where the loss goes, and what is beyond the limits of the model.

use super::StageError;
use super::page::escape;
use crate::schema::EVENT_KINDS;
use crate::stats::{CAUTIONS, LIMITS, Limit};
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

/// The rows of the table `cases`, as the tables of the page name them.
pub(super) struct Cases<'a> {
    frame: &'a Frame,
    ids: Vec<&'a str>,
    loads: Vec<f64>,
    words: Vec<&'a str>,
}

impl<'a> Cases<'a> {
    pub(super) fn of(frame: &'a Frame) -> Result<Self, StageError> {
        Ok(Self { frame, ids: frame.text("case_id")?, loads: frame.f64("max_load")?, words: frame.text("caution")? })
    }

    pub(super) fn number(&self, column: &str, row: usize) -> Result<Option<f64>, StageError> {
        Ok(self.frame.f64_or_null(column)?.get(row).copied().flatten())
    }

    /// The first two cells of a row.
    pub(super) fn name(&self, row: usize) -> String {
        let id = self.ids.get(row).copied().unwrap_or_default();
        let load = self.loads.get(row).copied().unwrap_or_default();
        format!("<td>{}</td><td>{load}</td>", escape(id))
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

    pub(super) fn rows(&self) -> std::ops::Range<usize> {
        0..self.ids.len()
    }
}

/// Where the loss goes: shares of the branches and of the kinds of events. Kinds that lose nothing anywhere have no column.
pub(super) fn split(html: &mut String, cases: &Frame) -> Result<(), StageError> {
    let cases = Cases::of(cases)?;
    let mut kinds = Vec::new();
    for kind in EVENT_KINDS {
        let all = cases.frame.f64_or_null(&format!("dissipated_{kind}_mean"))?;
        if all.iter().flatten().any(|mean| *mean != 0.0) {
            kinds.push(kind);
        }
    }
    html.push_str(
        "<h2>Where the loss goes</h2>\n<p>Θ is the work around the loop. The sum over its events is a second account of it, and the audit gap is the \
         difference over Θ; both are over E*A<sub>0</sub>h<sub>rms</sub>, in 1e-3. Shares are of that sum: by branch, and by the event that began each \
         relaxation. Covering has no potential, so its share may be negative.</p>\n<div class=\"wide\"><table>\n<tr><th>case</th><th>max load</th>\
         <th>Θ</th><th>sum over events</th>",
    );
    let _ = write!(html, "<th>audit gap: worst (mean){}</th><th>loading</th><th>unloading</th>", bound("audit_gap_max", Shown::Percent));
    for kind in &kinds {
        let _ = write!(html, "<th>{}</th>", kind.replace('_', " "));
    }
    html.push_str("</tr>\n");
    for row in cases.rows() {
        let mean = |column: &str| cases.number(&format!("{column}_mean"), row);
        let whole = mean("dissipated")?;
        let _ = write!(html, "<tr>{}", cases.name(row));
        let thousandths = |number: Option<f64>| number.map_or_else(|| MISSING.to_owned(), |number| format!("{:.3}", 1e3 * number));
        for text in [thousandths(mean("loss")?), thousandths(whole)] {
            let _ = write!(html, "<td>{text}</td>");
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
pub(super) fn trust(html: &mut String, cases: &Frame) -> Result<(), StageError> {
    let cases = Cases::of(cases)?;
    html.push_str(
        "<h2>How far to trust it</h2>\n<p>A summit model is outside its range where spots coalesce: a third of the contact area of a \
         boundary-element solution is then missing even without adhesion. It reproduces the model of the paper; see the limits in the README. \
         Numbers beyond their limit are bold. The conformity number is the elastic energy that flattens the shortest octave of the roughness over the \
         work of adhesion, and U<sub>el</sub>/Δγ that of all the roughness: of the modes that the surfaces have, and in brackets of the \
         continuous spectrum.</p>\n<div class=\"wide\"><table>\n<tr><th>case</th><th>max load</th>",
    );
    for (heading, column, _, as_what) in TRUST {
        let _ = write!(html, "<th>{heading}{}</th>", bound(column, as_what));
    }
    html.push_str("</tr>\n");
    for row in cases.rows() {
        let _ = write!(html, "<tr>{}", cases.name(row));
        for (_, column, aside, as_what) in TRUST {
            let aside = aside.map(|column| cases.number(column, row)).transpose()?.flatten();
            html.push_str(&cases.cell(row, column, &with_aside(cases.number(column, row)?, aside, as_what)));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    cautions(html, &cases);
    Ok(())
}

/// Every caution that a row carries, with what it says and which rows carry it.
fn cautions(html: &mut String, cases: &Cases<'_>) {
    html.push_str("<h2>Cautions</h2>\n");
    let carried = |word: &str| cases.rows().filter(|row| cases.has(*row, word)).collect::<Vec<usize>>();
    let found: Vec<(&str, &str, Vec<usize>)> =
        CAUTIONS.iter().map(|(word, meaning)| (*word, *meaning, carried(word))).filter(|(_, _, rows)| !rows.is_empty()).collect();
    if found.is_empty() {
        html.push_str("<p>None.</p>\n");
        return;
    }
    html.push_str("<table>\n<tr><th>caution</th><th>what it says</th><th>case and max load</th></tr>\n");
    for (word, meaning, rows) in found {
        let place = if rows.len() == cases.ids.len() {
            "all".to_owned()
        } else {
            let name = |row: &usize| cases.ids.get(*row).zip(cases.loads.get(*row)).map(|(id, load)| format!("{} at {load}", escape(id)));
            rows.iter().filter_map(name).collect::<Vec<_>>().join("<br>")
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

/// A number with three digits, or a dash where it is missing.
pub(super) fn shown(number: Option<f64>, as_what: Shown) -> String {
    let Some(number) = number else {
        return MISSING.to_owned();
    };
    let text = match (as_what, number.abs()) {
        (Shown::Percent, size) if (100.0 * size).fract() == 0.0 => format!("{:.0}\u{a0}%", 100.0 * number),
        (Shown::Percent, _) => format!("{:.1}\u{a0}%", 100.0 * number),
        (Shown::Plain, size) if size >= 100.0 || size.fract() == 0.0 => format!("{number:.0}"),
        (Shown::Plain, size) if size >= 10.0 => format!("{number:.1}"),
        (Shown::Plain, size) if size >= 1.0 => format!("{number:.2}"),
        (Shown::Plain, size) if size >= 0.01 => format!("{number:.3}"),
        (Shown::Plain, _) => format!("{number:.1e}"),
    };
    // A minus sign that is as wide as a digit.
    text.replace('-', "−")
}
