//! Tabulated spectra before a run: reading, moments and the part below the shortest wavelength.

use crate::campaign::Campaign;
use crate::model::GeneratedSurface;
use crate::stats::{MOST_LEFT_OUT, significant};
use crate::text::{visible, wrapped};
use std::f64::consts::TAU;

/// A paragraph for each surface with a tabulated spectrum, empty without one.
pub(super) fn text(campaign: &Campaign) -> String {
    let mut text = String::new();
    let mut known: Vec<(&GeneratedSurface, Vec<f64>)> = Vec::new();
    for params in campaign.cases.iter().map(|unit| &unit.case.params) {
        let tabulated = |surface: &&GeneratedSurface| surface.tabulated.table.is_some();
        let Some(surface) = params.surface.generated().filter(tabulated) else { continue };
        let place = known.iter().position(|(of, _)| *of == surface).unwrap_or(known.len());
        if place == known.len() {
            known.push((surface, Vec::new()));
        }
        known[place].1.extend(params.left_out_ratio());
    }
    for (surface, ratios) in known {
        let label =
            campaign.label_of(&crate::model::SurfaceSource::Generated(surface.clone())).unwrap_or_default();
        text += &wrapped(&format!("{:10}{}", "spectrum", paragraph(surface, &label, &ratios)), "          ");
    }
    text
}

fn paragraph(surface: &GeneratedSurface, label: &str, ratios: &[f64]) -> String {
    let spectrum = surface.spectrum();
    let (moments, energy) = (spectrum.moments(), surface.flattening_m());
    let [longest, shortest] = spectrum.band_1_m().map(|wavenumber| significant(TAU / wavenumber, 4));
    let mut text = format!(
        "{}: {}. Wavelengths from {shortest} to {longest} m have h_rms = {} m, h'_rms = {}, Laplacian \
         {} 1/m, U_el = E* x {} m.",
        visible(label),
        surface.tabulated.reading,
        significant(moments.rms_height_m(), 4),
        significant(moments.rms_slope(), 4),
        significant(moments.rms_curvature_1_m(), 4),
        significant(energy, 4),
    );
    let [low, high] = [f64::min, f64::max].map(|choose| ratios.iter().copied().reduce(choose));
    if let (Some(low), Some(high)) = (low, high) {
        let percent = |ratio: f64| significant(100.0 * ratio, 2);
        let range = if low == high { percent(low) } else { format!("{} to {}", percent(low), percent(high)) };
        let limit = percent(MOST_LEFT_OUT);
        let effect = if high <= MOST_LEFT_OUT {
            format!("it is subtracted from Δγ (limit {limit} %)")
        } else if low > MOST_LEFT_OUT {
            format!("above {limit} % it is not subtracted from Δγ: warning left_out")
        } else {
            format!("it is subtracted from Δγ up to {limit} %, above it causes the warning left_out")
        };
        text += &format!(" Shorter ones of the table have U_el/Δγ = {range} %: {effect}.");
    }
    text
}
