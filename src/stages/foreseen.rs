//! Warnings before a run, from a spec and its measured surfaces.

use super::cycle::announced;
pub use super::outside::Outside;
use super::verdict::{Previews, Verdict, previews, verdicts};
use crate::campaign::Campaign;
use crate::model::Method;
use crate::stats::Limit;
use crate::store::hdf5::SurfaceHeader;

/// Ratio of energies of a verdict.
type Ratio = fn(&Verdict) -> Option<f64>;

/// Warnings of the artefacts of measured surfaces.
pub const ARTEFACTS: [&str; 4] = ["outliers", "lines", "noise", "tip"];

/// Properties of a campaign before any computation.
#[derive(Debug, Clone, PartialEq)]
pub struct Foreseen {
    /// One verdict for each case.
    pub verdicts: Vec<Verdict>,
    /// Warnings.
    pub warnings: Vec<Outside>,
}

impl Foreseen {
    /// The warning of a code.
    #[must_use]
    pub fn warning(&self, code: &str) -> Option<&Outside> {
        self.warnings.iter().find(|of| of.kind.code == code)
    }
}

/// Verdicts and warnings before a run: `U_el/Δγ` and `U_1/Δγ` of the target spectra and of
/// measured surfaces, grids of boundary elements, and the artefacts of measured surfaces. Cases without
/// adhesion have no `U_el/Δγ`.
#[must_use]
pub fn foreseen(campaign: &Campaign) -> Foreseen {
    let previews = previews(campaign);
    let verdicts = verdicts(campaign, &previews);
    let ratios: [(&str, Ratio); 2] =
        [("sticky", |of| of.persson_tosatti), ("conformed", |of| of.conformity.filter(|ratio| *ratio > 0.0))];
    let of = |(code, ratio): (&str, Ratio)| {
        // The limits are those of the asperity model.
        let asperities = verdicts.iter().filter(|of| of.method == Method::Asperities);
        Outside::of(code, asperities.filter_map(|of| Some((of.case_id.clone(), ratio(of)?))))
    };
    let costs: Vec<_> = verdicts.iter().map(|of| (of.cost, of.persson_tosatti)).collect();
    let warnings = ratios
        .into_iter()
        .filter_map(of)
        .chain(announced(campaign, &costs))
        .chain(artefacts(campaign, &previews))
        .collect();
    Foreseen { verdicts, warnings }
}

/// Cases with artefacts of their measured surfaces.
fn artefacts(campaign: &Campaign, previews: &Previews) -> Vec<Outside> {
    let surfaces = 0..campaign.surfaces.len();
    let known: Vec<(usize, &SurfaceHeader)> =
        surfaces.filter_map(|k| Some((k, &previews.get(&k)?.known()?.header))).collect();
    let of = |code: &str| {
        let column = Limit::of(code)?.of_one();
        let number = |header: &SurfaceHeader| {
            header
                .artefact_columns()
                .into_iter()
                .find(|(name, _)| *name == column)
                .and_then(|(_, value)| value)
        };
        let cases_of = |surface: usize| {
            let cycles = campaign.cycles.iter().filter(move |cycle| cycle.surface == surface);
            cycles.map(|cycle| campaign.cases[cycle.case].id.clone())
        };
        let values = known.iter().filter_map(|(surface, header)| Some((*surface, number(header)?)));
        Outside::of(
            code,
            values.flat_map(|(surface, value)| cases_of(surface).map(move |case| (case, value))),
        )
    };
    ARTEFACTS.into_iter().filter_map(of).collect()
}
