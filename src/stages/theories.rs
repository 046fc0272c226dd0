//! Part of the report: comparison with analytical models.

use super::StageError;
use super::trust::{Cases, ENERGIES, NAME_HEADS, scaled};
use std::fmt::Write as _;

/// Heading, and column of the table `cases` without its `_mean`.
const LOSSES: [(&str, &str); 7] = [
    ("Θ, this simulation", "loss"),
    ("Θ<sub>DK</sub>, target spectrum", "loss_dk"),
    ("Θ<sub>DK</sub>, realised spectrum", "loss_dk_realised"),
    ("Σθ over contacting asperities", "loss_touched"),
    ("Δγ A", "loss_dalvi"),
    ("2kU<sub>el</sub>A, pinning", "loss_pinning"),
    ("Θ, JKR from adhesionless curve", "loss_jkr_curve"),
];

const AREAS: [(&str, &str); 4] = [
    ("A/A<sub>0</sub>, this simulation", "area_at_max_load"),
    ("A/A<sub>0</sub>, JKR from adhesionless curve", "area_jkr_curve"),
    ("A/A<sub>0</sub>, Persson, adhesionless", "area_adhesionless"),
    ("2F/(E*A<sub>0</sub>h′), adhesionless", "area_adhesionless_small"),
];

const NUMBERS: [(&str, &str); 3] = [
    ("U<sub>el</sub>/Δγ", "persson_tosatti_realised"),
    ("U<sub>el</sub>/(2Δγ)", "sticky_line"),
    ("Fuller–Tabor parameter", "fuller_tabor"),
];

/// Dissipated energies, contact areas and adhesion parameters of analytical models.
pub(super) fn theories(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    html.push_str(
        "<h2>Comparison with analytical models</h2>\n<p>Dissipated energies are over E*A<sub>0</sub>h<sub>rms</sub>, at the simulated contact area.</p>\n<ul>\n\
         <li>Θ<sub>DK</sub>, Deng and Kesari (Eqs A1–A4, corrected): mean dissipated energy of one asperity times Nayak's summit density and the contact area.</li>\n\
         <li>Σθ: sum over contacting asperities without elastic interaction, with jump into contact at zero penetration.</li>\n\
         <li>Δγ A: work of adhesion times contact area, an empirical relation near full contact (Dalvi et al. 2019).</li>\n\
         <li>2kU<sub>el</sub>A with k = 1.35: crack-front pinning in a connected, weakly rough contact (Sanner et al. 2024; prefactor of hysteron), empty for kU<sub>el</sub> ≥ Δγ/2.</li>\n\
         <li>JKR from adhesionless curve: load and area of adhesive contact from those without adhesion on the same surface (Ciavarella 2018); boundary elements only.</li>\n\
         <li>Adhesionless areas: Persson's theory, and the small-load limit of boundary-element results, with the realised rms slope h′.</li>\n\
         <li>U<sub>el</sub>/Δγ (Persson and Tosatti) or U<sub>el</sub>/(2Δγ) (Wang and Müser) below 1, or a Fuller–Tabor parameter below about 10: adhesion is strong.</li>\n</ul>\n\
         <div class=\"wide\"><table>\n",
    );
    html.push_str(NAME_HEADS);
    let mut columns = Vec::new();
    for (heading, column) in LOSSES.iter().chain(&AREAS).chain(&NUMBERS) {
        let scale = if ENERGIES.contains(column) { cases.scale(&ENERGIES)? } else { cases.scale(&[*column])? };
        let _ = write!(html, "<th>{heading}{}</th>", scale.head());
        columns.push((*column, scale));
    }
    html.push_str("</tr>\n");
    for listed in cases.rows() {
        let _ = write!(html, "<tr>{}", cases.name(listed));
        for (column, scale) in &columns {
            let mean = cases.number(&format!("{column}_mean"), listed.row)?;
            let _ = write!(html, "<td>{}</td>", scaled(mean, *scale));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    Ok(())
}
