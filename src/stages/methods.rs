//! Part of the report: both methods on the same surfaces.

use super::StageError;
use super::page::escape;
use super::trust::{Cases, ENERGIES, Shown, scaled, shown};
use crate::stats::{labels, method_pairs, names_of_pairs};
use crate::store::Frame;
use std::fmt::Write as _;

/// Heading and column of the compared quantities, in the order of [`method_pairs`].
const QUANTITIES: [(&str, &str); 3] = [
    ("A/A<sub>0</sub>", "area_at_max_load"),
    ("F<sub>po</sub>/(E*A<sub>0</sub>)", "pull_off_load"),
    ("Θ/(E*A<sub>0</sub>h<sub>rms</sub>)", "loss"),
];

/// A table of the means of both methods and their ratios; empty without cases of the same surfaces by both methods.
pub(super) fn side_by_side(html: &mut String, cases: &Cases<'_>, methods: &Frame) -> Result<(), StageError> {
    let pairs = method_pairs(methods)?;
    if pairs.is_empty() {
        return Ok(());
    }
    // Writing to a string cannot fail.
    let _ = write!(
        html,
        "<h2>Asperity model and boundary elements</h2>\n<p>Means over the surfaces that both methods have finished, and the ratio of the asperity model to \
         boundary elements on the same surface: mean ± standard deviation. The table <code>statistics/methods.parquet</code> holds each surface and the 95 % \
         confidence intervals.</p>\n<div class=\"wide\"><table>\n<tr><th>case</th><th>F<sub>max</sub>/(E*A<sub>0</sub>)</th><th>surfaces</th>"
    );
    let mut scales = Vec::new();
    for (heading, column) in QUANTITIES {
        let scale = if ENERGIES.contains(&column) { cases.scale(&ENERGIES)? } else { cases.scale(&[column])? };
        let head = scale.head();
        let _ = write!(html, "<th>{heading}{head}, asperities</th><th>{heading}{head}, boundary elements</th><th>ratio</th>");
        scales.push(scale);
    }
    html.push_str("</tr>\n");
    let names = names_of_pairs(cases.frame, &pairs)?;
    let loads = labels(&pairs.iter().map(|pair| pair.max_load).collect::<Vec<f64>>());
    for ((pair, name), load) in pairs.iter().zip(&names).zip(&loads) {
        let _ = write!(html, "<tr><td>{}</td><td>{load}</td><td>{}</td>", escape(name), pair.count);
        for ([asperities, elements, ratio, sd], scale) in pair.quantities.into_iter().zip(&scales) {
            let sd = sd.map(|sd| format!(" ± {}", shown(Some(sd), Shown::Plain))).unwrap_or_default();
            let _ = write!(
                html,
                "<td>{}</td><td>{}</td><td>{}{sd}</td>",
                scaled(asperities, *scale),
                scaled(elements, *scale),
                shown(ratio, Shown::Plain)
            );
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    Ok(())
}
