//! A cycle: its tables, theories, and the points of its loop whose contact spots are shown.

use super::FigureError;
use crate::store::Frame;

/// One cycle with theories.
#[derive(Debug, Clone, Copy)]
pub struct Closer<'a> {
    /// Load reversal of the loop, `F/(E* A0)`.
    pub max_load: f64,
    /// The parameters of the case, for the captions.
    pub parameters: &'a str,
    /// Steps.
    pub steps: &'a Frame,
    /// Events.
    pub events: &'a Frame,
    /// Contact spots at the steps that were kept.
    pub contacts: &'a Frame,
    /// Asperities of the surface.
    pub asperities: &'a Frame,
    /// `E* A0 h_rms` \[J\].
    pub energy_j: f64,
    /// Rms height \[m\].
    pub rms_height_m: f64,
    /// Side of the square \[m\].
    pub length_m: f64,
    /// True if the square has periodic images.
    pub periodic: bool,
    /// Pull-off force of a JKR asperity over its radius, `(3/2)πΔγ` \[N/m\].
    pub pull_off_n_m: f64,
    /// Spectrum that the surface has: wavenumber q/qL and `C qL²/h_rms²`.
    pub found: &'a [(f64, f64)],
    /// Target spectrum (Eq 10) at the realised rms height, likewise; nothing for a measured surface.
    pub asked: &'a [(f64, f64)],
    /// Realised density over that of Eq 10 at the target rms height; nothing for a measured surface.
    pub asked_factor: Option<f64>,
    /// Unit of curvature, `sqrt(m4/3)` \[1/m\], of the moments that the surface has.
    pub curvature_1_m: f64,
    /// Nayak's density of the curvature of summits, both in that unit.
    pub nayak: &'a [(f64, f64)],
    /// Summits per area: found, and Nayak's for the moments of the surface \[1/m²\].
    pub densities_1_m2: [f64; 2],
}

/// The four points of a loop whose spots are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Landmark {
    /// On loading, at half the maximum load.
    Half,
    /// Load reversal.
    Turning,
    /// On unloading, at zero load.
    NoLoad,
    /// Maximum tensile load.
    PullOff,
}

impl Landmark {
    /// Name in figures.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Half => "loading, at F_{max}/2",
            Self::Turning => "at F_{max}",
            Self::NoLoad => "unloading, at zero load",
            Self::PullOff => "at pull-off",
        }
    }
}

/// A landmark whose spots were kept, and its step.
pub(super) type Kept = (Landmark, i64);

impl Closer<'_> {
    /// The landmarks whose spots were kept.
    pub(super) fn landmarks(&self) -> Result<Vec<Kept>, FigureError> {
        let mut kept = self.contacts.i64("step")?;
        kept.dedup();
        let (branches, of, loads) =
            (self.steps.text("branch")?, self.steps.f64_or_null("max_load")?, self.steps.f64("load")?);
        let load =
            |step: &i64| usize::try_from(*step).ok().and_then(|k| loads.get(k).copied()).unwrap_or(f64::NAN);
        let on = |branch: &str, max_load: Option<f64>| -> Vec<i64> {
            let fits = |step: &&i64| {
                let k = usize::try_from(**step).unwrap_or(usize::MAX);
                branches.get(k) == Some(&branch) && of.get(k) == Some(&max_load)
            };
            kept.iter().filter(fits).copied().collect()
        };
        let (loading, unloading) = (on("loading", None), on("unloading", Some(self.max_load)));
        let nearest = |wanted: f64| {
            loading
                .iter()
                .min_by(|u, v| (load(u) - wanted).abs().total_cmp(&(load(v) - wanted).abs()))
                .copied()
        };
        let reversal =
            self.steps.f64_or_null("reversal_load")?.iter().position(|load| *load == Some(self.max_load));
        let found = [
            (Landmark::Half, nearest(0.5 * self.max_load)),
            (
                Landmark::Turning,
                loading.iter().find(|step| usize::try_from(**step).ok() == reversal).copied(),
            ),
            (Landmark::NoLoad, unloading.iter().find(|step| load(step) <= 0.0).copied()),
            (
                Landmark::PullOff,
                unloading
                    .iter()
                    .min_by(|u, v| load(u).total_cmp(&load(v)))
                    .filter(|step| load(step) < 0.0)
                    .copied(),
            ),
        ];
        Ok(found.into_iter().filter_map(|(landmark, step)| step.map(|step| (landmark, step))).collect())
    }
}

/// The step of a landmark.
pub(super) fn step_of(kept: &[Kept], wanted: Landmark) -> Option<i64> {
    kept.iter().find(|(landmark, _)| *landmark == wanted).map(|(_, step)| *step)
}
