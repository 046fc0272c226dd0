//! The part of the report that puts theories beside the results.

use super::StageError;
use super::trust::{Cases, NAME_HEADS, scaled};
use std::fmt::Write as _;

/// Heading, and column of the table `cases` without its `_mean`.
const LOSSES: [(&str, &str); 5] = [
    ("Θ here [10<sup>−3</sup>]", "loss"),
    ("Deng–Kesari, spectrum [10<sup>−3</sup>]", "loss_dk"),
    ("Deng–Kesari, realised [10<sup>−3</sup>]", "loss_dk_realised"),
    ("Σθ of those that touched [10<sup>−3</sup>]", "loss_touched"),
    ("Δγ A (Dalvi) [10<sup>−3</sup>]", "loss_dalvi"),
];

const AREAS: [(&str, &str); 3] = [
    ("A/A<sub>0</sub> here", "area_at_max_load"),
    ("Persson, no adhesion", "area_adhesionless"),
    ("2F/(E*A<sub>0</sub>h′)", "area_adhesionless_small"),
];

const NUMBERS: [(&str, &str); 2] = [("U<sub>el</sub>/Δγ", "persson_tosatti_realised"), ("Fuller–Tabor", "fuller_tabor")];

/// Losses, areas and numbers of stickiness, each beside what was computed.
pub(super) fn theories(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    html.push_str(
        "<h2>Theories beside it</h2>\n<p>Losses are over E*A<sub>0</sub>h<sub>rms</sub>, at the contact area that was computed here. Deng and Kesari \
         (Eqs A1–A4, corrected) multiply the mean loss of one asperity by Nayak's density and the contact area; the sum over the asperities that touched is what \
         they would lose without acting on one another, jumping in at zero penetration; Δγ A is what Dalvi and others found in nearly full contact. Areas without \
         adhesion are of Persson's theory and of boundary elements at small loads, of the realised gradient h′. U<sub>el</sub>/Δγ (Persson and Tosatti) below 1 and a \
         Fuller–Tabor number below some 10 mean that the surface sticks. The bearing-area model and the criterion of Pastewka and Robbins are left out, since their \
         formulae could not be confirmed at their sources.</p>\n<div class=\"wide\"><table>\n",
    );
    html.push_str(NAME_HEADS);
    for (heading, _) in LOSSES.iter().chain(&AREAS).chain(&NUMBERS) {
        let _ = write!(html, "<th>{heading}</th>");
    }
    html.push_str("</tr>\n");
    for listed in cases.rows() {
        let _ = write!(html, "<tr>{}", cases.name(listed));
        for (scale, columns) in [(1e-3, &LOSSES[..]), (1.0, &AREAS), (1.0, &NUMBERS)] {
            for (_, column) in columns {
                let mean = cases.number(&format!("{column}_mean"), listed.row)?;
                let _ = write!(html, "<td>{}</td>", scaled(mean, scale));
            }
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    Ok(())
}
