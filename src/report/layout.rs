//! Common parts of HTML pages: document, style, text markup and grids of figures.

use crate::figures::Panel;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a;background:#fff}\
h1,h2{line-height:1.2}pre{overflow-x:auto;background:#f4f4f2;padding:1rem;font-size:.85rem}\
.panels{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(24rem,100%),1fr));gap:1rem}\
figure{margin:0}figcaption{font-size:.8rem}.panels svg,.map svg{width:100%;height:auto;background:#fff}.map{max-width:48rem}table{border-collapse:collapse;font-size:.9rem}\
td,th{padding:.2rem .7rem;border-bottom:1px solid #ccc;text-align:left;vertical-align:top}\
.wide{overflow-x:auto}.wide table{font-size:.82rem}.wide td{white-space:nowrap}.wide td,.wide th{padding:.2rem .45rem}\
.wide :is(td,th):nth-child(n+2){text-align:right}.clear{font-weight:700}.beyond{font-weight:700;color:#b3261e}\
@media(prefers-color-scheme:dark){body{color:#e6e6e6;background:#161616}pre{background:#242424}.beyond{color:#ff8a80}}\
@media print{body{max-width:none;margin:0;font-size:11pt}.wide{overflow:visible}.wide table{font-size:6.5pt}\
.wide td{white-space:normal}.panels{grid-template-columns:1fr 1fr}.panels>figure,.map,tr{break-inside:avoid}}";

/// Name of the metadata with the key of the report.
const KEY: &str = "hysteron-key";

/// A whole page; `key` is the key of the report.
pub(super) fn document(title: &str, key: Option<&str>, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE) "\n"
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width";
                @if let Some(key) = key { meta name=(KEY) content=(key); }
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
    html! { h2 { (title) } "\n" }
}

/// A wide table: cells of the head, and the cells of each row.
pub(super) fn wide(head: &Markup, rows: &[Markup]) -> Markup {
    html! { div.wide { table { "\n" tr { (head) } "\n" @for row in rows { tr { (row) } "\n" } } } "\n" }
}

/// Marks of [`prose`]: start, end and element.
const MARKS: [(&str, &str, &str); 3] = [("_{", "}", "sub"), ("^{", "}", "sup"), ("`", "`", "code")];

/// Text with the markup of the figures, `_{subscript}` and `^{superscript}`, and with code between backticks.
pub(super) fn prose(text: &str) -> Markup {
    let first =
        MARKS.iter().filter_map(|mark| text.split_once(mark.0).map(|parts| (parts, mark))).min_by_key(|((before, _), _)| before.len());
    let parts = first.and_then(|((before, rest), mark)| rest.split_once(mark.1).map(|(inside, after)| (before, inside, after, mark.2)));
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

/// Links to the files of a figure.
fn links(stem: &str) -> Markup {
    html! {
        @for (place, format) in ["SVG", "PNG", "PDF"].into_iter().enumerate() {
            @if place > 0 { " · " }
            a href={ "figures/" (stem) "." (format.to_lowercase()) } { (format) }
        }
    }
}

/// Panels in a grid, each with number, caption and links to its files.
pub(super) fn grid<'a>(number: usize, panels: impl IntoIterator<Item = &'a Panel>) -> Markup {
    let label = |name: &str| if name.chars().count() > 1 { format!(", {name}") } else { name.to_owned() };
    html! {
        div.panels {
            "\n"
            @for Panel { stem, name, caption, svg, .. } in panels {
                figure {
                    (PreEscaped(svg))
                    figcaption { b { "Fig. " (number) (label(name)) "." } " " (caption) " " (links(stem)) }
                }
                "\n"
            }
        }
        "\n"
    }
}

/// A single wide figure with caption and links to its files.
pub(super) fn figure(stem: &str, svg: &str, caption: &str) -> Markup {
    html! { figure.map { (PreEscaped(svg)) figcaption { (caption) " " (links(stem)) } } "\n" }
}
