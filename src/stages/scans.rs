//! Part of the report: measured surfaces.

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
        // A failed import is reported elsewhere.
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
            "<h2>Measured surfaces</h2>\n<p>Each measured surface is one realization, without a standard deviation. Area kept: fraction of the scan in the \
             central square of side L. h<sub>rms</sub> and rms slope: after levelling and S-filter. Removed: rms heights below the S-filter cut-off and of \
             the form subtracted by levelling. Filled: missing points interpolated (harmonic in-fill). H: Hurst exponent of the self-affine fit, with its \
             standard deviation; outside 0 to 1 the spectrum is not self-affine.</p>\n\
             <div class=\"wide\"><table>\n<tr><th>file</th><th>points</th><th>area kept</th><th>L [m]</th><th>h<sub>rms</sub> [m]</th><th>rms slope</th>\
             <th>cut-off [m]</th><th>removed by S-filter [m]</th><th>removed by levelling [m]</th><th>filled</th><th>H</th></tr>\n{rows}</table></div>\n"
        );
    }
    Ok(())
}
