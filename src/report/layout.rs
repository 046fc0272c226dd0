//! Common parts of HTML pages: document, style, text markup and grids of figures.

use crate::figures::{Drawing, Panel, Units};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::cell::Cell;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Letters of a part of a label on one line.
const LONGEST_PART: usize = 18;

/// Name of the metadata with the key of the report.
const KEY: &str = "hysteron-key";

/// A page with the style of the report alone; it is reloaded every `reload` seconds.
pub(super) fn styled(title: &str, reload: Option<u32>, body: &Markup) -> String {
    let meta = html! {
        meta name="hysteron-page" content="progress";
        @if let Some(seconds) = reload { meta http-equiv="refresh" content=(seconds); }
    };
    page(title, &meta, &html! { main { (body) } })
}

/// A whole page; `key` is the key of the report.
pub(super) fn document(title: &str, key: Option<&str>, body: &Markup) -> String {
    let meta = html! { @if let Some(key) = key { meta name=(KEY) content=(key); } };
    page(title, &meta, &html! { main { (body) } script { (PreEscaped(SCRIPT)) } })
}

/// A page with its metadata.
fn page(title: &str, meta: &Markup, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE) "\n"
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width";
                (meta)
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            "\n"
            body { "\n" (body) }
        }
        "\n"
    };
    page.into_string()
}

/// A block that ends its line.
pub(super) fn line(block: &Markup) -> Markup {
    html! { (block) "\n" }
}

/// Heading of a section.
pub(super) fn heading(title: &str) -> Markup {
    html! { h2 id=(anchor(title)) { (title) } "\n" }
}

/// The identifier of a heading: `Model validity` becomes `model-validity`.
pub(super) fn anchor(title: &str) -> String {
    let parts = title.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty());
    parts.map(str::to_lowercase).collect::<Vec<_>>().join("-")
}

/// Numbers of the figures, in their order, and the formats of their files.
#[derive(Debug)]
pub(super) struct Numbers<'a> {
    last: Cell<usize>,
    formats: &'a [&'static str],
}

impl<'a> Numbers<'a> {
    pub(super) fn of(formats: &'a [&'static str]) -> Self {
        Self { last: Cell::new(0), formats }
    }

    fn next(&self) -> usize {
        self.last.set(self.last.get() + 1);
        self.last.get()
    }

    /// Links to the files of a figure.
    fn links(&self, stem: &str) -> Markup {
        html! {
            @for (place, format) in self.formats.iter().enumerate() {
                @if place > 0 { " · " }
                a href={ "figures/" (stem) "." (format) } { (format.to_uppercase()) }
            }
        }
    }
}

/// Rows of a wide table under a heading.
pub(super) struct Group {
    pub(super) heading: String,
    /// Cells of each row.
    pub(super) rows: Vec<Markup>,
}

/// A wide table: cells of the head, and the cells of each row.
pub(super) fn wide(name: &str, head: &Markup, rows: &[Markup]) -> Markup {
    grouped(name, head, &[Group { heading: String::new(), rows: rows.to_vec() }])
}

/// A wide table with headings between its rows. Groups without rows are left out.
pub(super) fn grouped(name: &str, head: &Markup, groups: &[Group]) -> Markup {
    html! {
        div.wide role="region" aria-label={ "Table " (name) } tabindex="0" data-name=(name) {
            table {
                "\n" thead { tr { (head) } } "\n"
                @for group in groups.iter().filter(|group| !group.rows.is_empty()) {
                    tbody data-heading=[Some(&group.heading).filter(|heading| !heading.is_empty())] {
                        "\n"
                        @if !group.heading.is_empty() {
                            tr.group { th colspan="99" scope="rowgroup" { (group.heading) } } "\n"
                        }
                        @for row in &group.rows { tr { (row) } "\n" }
                    }
                }
            }
        }
        "\n"
    }
}

/// Marks of [`prose`]: start, end and element.
const MARKS: [(&str, &str, &str); 3] = [("_{", "}", "sub"), ("^{", "}", "sup"), ("`", "`", "code")];

/// Text with the markup of the figures, `_{subscript}` and `^{superscript}`, and with code between backticks.
pub(super) fn prose(text: &str) -> Markup {
    let first = MARKS
        .iter()
        .filter_map(|mark| text.split_once(mark.0).map(|parts| (parts, mark)))
        .min_by_key(|((before, _), _)| before.len());
    let parts = first.and_then(|((before, rest), mark)| {
        rest.split_once(mark.1).map(|(inside, after)| (before, inside, after, mark.2))
    });
    let Some((before, inside, after, element)) = parts else { return html! { (text) } };
    html! {
        (before)
        @match element {
            "sub" => sub { (inside) },
            "sup" => sup { (inside) },
            _ => code { (inside) },
        }
        (prose(after))
    }
}

/// Symbols of plain text with the markup of their subscripts.
const SYMBOLS: [(&str, &str); 10] = [
    ("F_po", "F_{po}"),
    ("F_max", "F_{max}"),
    ("h_rms", "h_{rms}"),
    ("U_el", "U_{el}"),
    ("λ_c", "λ_{c}"),
    ("λ_r", "λ_{r}"),
    ("Θ_DK", "Θ_{DK}"),
    ("R_tip", "R_{tip}"),
    ("A_0", "A_{0}"),
    ("A₀", "A_{0}"),
];

/// Plain text with the subscripts of symbols.
pub(super) fn plain(text: &str) -> Markup {
    prose(&SYMBOLS.into_iter().fold(text.to_owned(), |text, (plain, marked)| text.replace(plain, marked)))
}

/// Spaces at which a line of a label must not break: inside a short part, else before the value of a part.
pub(super) fn unbroken(label: &str) -> String {
    let part = |part: &str| match part.rsplit_once("= ") {
        _ if part.chars().count() <= LONGEST_PART => part.replace(' ', "\u{a0}"),
        Some((name, value)) => format!("{name}=\u{a0}{}", value.replace(' ', "\u{a0}")),
        None => part.to_owned(),
    };
    label.split(", ").map(part).collect::<Vec<_>>().join(", ")
}

/// Panels in a grid, each with number, caption and links to its files.
pub(super) fn grid<'a>(numbers: &Numbers<'_>, panels: impl IntoIterator<Item = &'a Panel>) -> Markup {
    numbered(numbers, numbers.next(), panels)
}

/// The panels of a sweep in both units, with one number; a switch of the page chooses the units.
pub(super) fn grids(numbers: &Numbers<'_>, panels: &[&Panel]) -> Markup {
    let number = numbers.next();
    html! {
        @for (units, class) in [(Units::Dimensionless, "dimensionless"), (Units::Si, "si")] {
            div class=(class) {
                (numbered(numbers, number, panels.iter().copied().filter(|panel| panel.units == units)))
            }
        }
    }
}

/// Switch between the units of the report.
pub(super) fn switch(is_si: bool) -> Markup {
    html! {
        p.switch.screen {
            "Units of figures and results: "
            label { input type="radio" name="units" value="dimensionless" checked[!is_si]; " dimensionless" }
            " "
            label { input type="radio" name="units" value="si" checked[is_si]; " SI" }
        } "\n"
    }
}

fn numbered<'a>(numbers: &Numbers<'_>, number: usize, panels: impl IntoIterator<Item = &'a Panel>) -> Markup {
    let label = |name: &str| {
        let is_letter = name.starts_with(|c: char| c.is_ascii_uppercase());
        if is_letter { name.to_owned() } else { format!(", {}", name.replace('_', " ")) }
    };
    html! {
        div.panels {
            "\n"
            @for Panel { stem, name, units, caption, svg, .. } in panels {
                @let name = name.trim_end_matches(units.ending());
                figure {
                    (PreEscaped(svg))
                    figcaption {
                        b { "Fig. " (number) (label(name)) "." } " " (plain(caption)) " "
                        (numbers.links(stem))
                    }
                }
                "\n"
            }
        }
        "\n"
    }
}

/// A single wide figure with number, caption and links to its files.
pub(super) fn figure(numbers: &Numbers<'_>, drawing: &Drawing) -> Markup {
    html! {
        figure.map {
            (PreEscaped(&drawing.svg))
            figcaption {
                b { "Fig. " (numbers.next()) "." } " " (plain(&drawing.caption)) " "
                (numbers.links(drawing.stem))
            }
        } "\n"
    }
}

/// Colours of the cases and dashes of the branches, for all figures of a sweep.
pub(super) fn legend(cases: &[(String, String)]) -> Markup {
    let dash = |dashes: &str| {
        html! {
            svg viewBox="0 0 32 8" aria-hidden="true" { path d="M0 4h32" stroke-dasharray=(dashes) {} }
        }
    };
    html! {
        ul.legend {
            "\n"
            @for (label, colour) in cases {
                li data-colour=(colour) { i style={ "background:" (colour) } {} (prose(label)) } "\n"
            }
            li { (dash("7 4")) "loading" } "\n"
            li { (dash("none")) "unloading" } "\n"
        }
        "\n"
    }
}
