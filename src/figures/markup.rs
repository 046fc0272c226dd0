//! Subscripts and superscripts in labels: `h_{rms}`, `10^{-3}`. Unicode has no full set of such letters, and
//! fonts lack those it has.

/// Size of shifted letters over that of the others.
const SMALL: f64 = 0.72;

/// Turns the markup inside an SVG document's texts into shifted spans.
pub fn render(svg: &str) -> String {
    let mut out = String::with_capacity(svg.len() + 512);
    for (index, piece) in svg.split('<').enumerate() {
        // Text is between two tags; the part before `>` is a tag.
        let (tag, text) = piece.split_once('>').unwrap_or((piece, ""));
        if index > 0 {
            out.push('<');
        }
        out.push_str(tag);
        if piece.len() > tag.len() {
            out.push('>');
        }
        push_text(&mut out, text, font_size(tag));
    }
    out
}

/// An SVG document with a description for readers who do not see it.
pub fn described(svg: &str, description: &str) -> String {
    let escaped =
        description.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;");
    svg.replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{escaped}\" "), 1)
}

/// The size that a text's tag states. Spans need it: shares of a size mean different things to different
/// viewers.
fn font_size(tag: &str) -> f64 {
    let stated = tag.split_once("font-size=\"").and_then(|(_, after)| after.split_once('"'));
    stated.and_then(|(size, _)| size.parse().ok()).unwrap_or(14.0)
}

fn push_text(out: &mut String, text: &str, size: f64) {
    let mut rest = text;
    // Shift of the text below the base line; SVG does not reset it.
    let mut shifted = 0.0;
    while let Some((before, mark, inside, after)) = next_mark(rest) {
        shifted = push_plain(out, before, shifted);
        let wanted = if mark == '_' { 0.22 * size } else { -0.32 * size };
        out.push_str(&format!(
            "<tspan dy=\"{:.2}\" font-size=\"{:.2}\">{inside}</tspan>",
            wanted - shifted,
            SMALL * size
        ));
        shifted = wanted;
        rest = after;
    }
    push_plain(out, rest, shifted);
}

/// Appends text on the base line, and returns the shift of the base line afterwards.
fn push_plain(out: &mut String, text: &str, shifted: f64) -> f64 {
    if text.is_empty() {
        return shifted;
    }
    if shifted == 0.0 {
        out.push_str(text);
    } else {
        out.push_str(&format!("<tspan dy=\"{:.2}\">{text}</tspan>", -shifted));
    }
    0.0
}

/// About the width in pixels of a text in a sans-serif face: 0.6 em per letter, shifted letters smaller.
pub fn width(text: &str, size: u32) -> f64 {
    let mut letters = 0.0;
    let mut rest = text;
    while let Some((before, _, inside, after)) = next_mark(rest) {
        letters += before.chars().count() as f64 + SMALL * inside.chars().count() as f64;
        rest = after;
    }
    (letters + rest.chars().count() as f64) * 0.6 * f64::from(size)
}

/// The text before the first mark, its sign, what it shifts, and the text after it.
fn next_mark(text: &str) -> Option<(&str, char, &str, &str)> {
    let start = [text.find("_{"), text.find("^{")].into_iter().flatten().min()?;
    let (before, marked) = text.split_at(start);
    let end = marked.find('}')?;
    let mark = marked.chars().next()?;
    Some((before, mark, marked.get(2..end)?, marked.get(end + 1..)?))
}
