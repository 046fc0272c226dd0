//! The part of the report that says what measured surfaces are.

use super::StageError;
use super::page::escape;
use crate::campaign::Campaign;
use crate::store::hdf5::read_header;
use std::fmt::Write as _;

/// A table of the measured surfaces of a campaign, if it has any.
pub(super) fn scans(html: &mut String, campaign: &Campaign) -> Result<(), StageError> {
    let mut rows = String::new();
    for unit in campaign.surfaces.iter().filter(|unit| unit.params.is_measured()) {
        let path = campaign.surface_path(unit);
        // Of one that could not be taken, the failure is told elsewhere.
        if !path.is_file() {
            continue;
        }
        let header = read_header(&path)?;
        let Some(of) = &header.measured else { continue };
        let [a, b] = of.source_point_counts;
        let fit = of.fit.map_or_else(|| "–".to_owned(), |fit| format!("{:.2} (±{:.2} decades)", fit.hurst, fit.scatter));
        // Writing to a string cannot fail.
        let _ = writeln!(
            rows,
            "<tr><td>{}</td><td>{a} × {b}</td><td>{:.0} %</td><td>{:.3e}</td><td>{:.3e}</td><td>{:.3}</td><td>{:.3e}</td><td>{:.3e}</td><td>{:.3e}</td><td>{}</td><td>{fit}</td></tr>",
            escape(&of.source),
            100.0 * (1.0 - of.dropped(header.length_m)),
            header.length_m,
            header.rms_height_m,
            header.rms_slope,
            of.shortest_wavelength_m,
            of.noise_m,
            of.trend_m,
            of.missing_count
        );
    }
    if !rows.is_empty() {
        let _ = write!(
            html,
            "<h2>Measured surfaces</h2>\n<p>Each is one realization, so that its results have no spread. The fraction of its area in the central square, of which all results are. Lengths in metres: the side of the square that was taken, rms height and slope \
             of what is left of its heights, the wavelength below which waves were taken off and their rms height, the rms height of the trend that was taken off; missing \
             points that were filled in; and the Hurst exponent of the self-affine spectrum that fits, which beyond 0 to 1 says that none does.</p>\n\
             <div class=\"wide\"><table>\n<tr><th>file</th><th>points</th><th>kept</th><th>L</th><th>h<sub>rms</sub></th><th>slope</th><th>cut-off</th><th>below it</th><th>trend</th>\
             <th>missing</th><th>H</th></tr>\n{rows}</table></div>\n"
        );
    }
    Ok(())
}
