//! Common parts of HTML pages: head, style and grids of figures.

use crate::figures::Panel;
use std::fmt::Write as _;

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

/// The page up to the start of its body; `more` is further content of its head.
pub(super) fn head(title: &str, more: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         {more}<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
    )
}

/// Panels in a grid, each with number, caption and links to its files.
pub(super) fn grid<'a>(html: &mut String, number: usize, panels: impl IntoIterator<Item = &'a Panel>) {
    html.push_str("<div class=\"panels\">\n");
    for Panel { stem, name, caption, svg, .. } in panels {
        let name = if name.chars().count() > 1 { format!(", {name}") } else { name.clone() };
        let links = ["SVG", "PNG", "PDF"].map(|format| format!("<a href=\"figures/{stem}.{}\">{format}</a>", format.to_lowercase()));
        // Writing to a string cannot fail.
        let _ = writeln!(
            html,
            "<figure>{svg}<figcaption><b>Fig. {number}{name}.</b> {} {}</figcaption></figure>",
            escape(caption),
            links.join(" · ")
        );
    }
    html.push_str("</div>\n");
}

/// Text escaped for HTML.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
