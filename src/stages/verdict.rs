//! Verdict on each case before a run: regime, recommended method, grid, memory and time.

use super::cost::Cost;
use super::cycle::{Trial, cost, refusal};
use super::estimates::target;
use super::previews::{Known, Preview};
use crate::campaign::{Campaign, CaseUnit, CycleUnit};
use crate::model::Method;
use crate::physics::theory::flattening::{Flattening, flattening};
use crate::physics::theory::regime::{Regime, effective_adhesion};
use crate::spec::CaseParams;
use crate::store::Check;
use std::collections::HashMap;

/// Verdict on a case before a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Id of the case.
    pub case_id: String,
    /// True if the case is only a coarser grid of others.
    pub is_coarser_grid: bool,
    /// Its method.
    pub method: Method,
    /// Side of the square \[m\]; nothing for a surface that is not known yet.
    pub length_m: Option<f64>,
    /// Regime; nothing for a surface that is not known yet.
    pub regime: Option<Regime>,
    /// True if the file of a tabulated spectrum could not be read.
    pub is_table_missing: bool,
    /// `U_el/Δγ`; nothing without adhesion.
    pub persson_tosatti: Option<f64>,
    /// `U_1/Δγ` of the shortest octave; nothing without adhesion.
    pub conformity: Option<f64>,
    /// Work of adhesion \[J/m²\].
    pub work_of_adhesion_j_m2: f64,
    /// Effective work of adhesion of the flattened surface \[J/m²\], where `U_el < Δγ`.
    pub effective_adhesion_j_m2: Option<f64>,
    /// Grid, memory and time of a cycle; nothing for a surface that is not known yet.
    pub cost: Option<Cost>,
    /// Error by which the run would fail.
    pub error: Option<String>,
}

impl Verdict {
    /// The verdicts on two scans of a case as one: that of the longer cycle, with the largest memory and the
    /// fewest grid points per shortest wavelength of both.
    fn worse(self, other: Self) -> Self {
        let seconds = |of: &Self| of.cost.map_or(0.0, |cost| cost.seconds);
        let (longer, shorter) = if seconds(&other) > seconds(&self) { (other, self) } else { (self, other) };
        let both = longer.cost.zip(shorter.cost).map(|(long, short)| Cost {
            memory_bytes: long.memory_bytes.max(short.memory_bytes),
            per_wavelength: long.per_wavelength.min(short.per_wavelength),
            ..long
        });
        Self { cost: both.or(longer.cost), ..longer }
    }
}

/// Measured surfaces before a run, by their places in [`Campaign::surfaces`].
pub(super) type Previews = HashMap<usize, Preview>;

/// All measured surfaces of a campaign, read once.
pub(super) fn previews(campaign: &Campaign) -> Previews {
    let surfaces = campaign.surfaces.iter().enumerate();
    surfaces
        .filter_map(|(place, surface)| {
            Some((place, Preview::of(campaign, surface, surface.params.measured()?)))
        })
        .collect()
}

/// The verdicts on all cases.
pub(super) fn verdicts(campaign: &Campaign, previews: &Previews) -> Vec<Verdict> {
    let mut cycles: Vec<Vec<&CycleUnit>> = vec![Vec::new(); campaign.cases.len()];
    for cycle in &campaign.cycles {
        cycles[cycle.case].push(cycle);
    }
    let trial = Trial::default();
    let is_open = |cycle: &CycleUnit| !campaign.cycle_standing(cycle, Check::Sizes).is_settled();
    let of = |(unit, cycles): (&CaseUnit, Vec<&CycleUnit>)| {
        // Each scan has its own error; all generated surfaces of a case have one.
        let is_measured = unit.case.params.surface.measured().is_some();
        let checked = if is_measured { cycles.len() } else { cycles.len().min(1) };
        let error_of = |cycle: &CycleUnit| {
            let preview = previews.get(&cycle.surface);
            let of_generated =
                || Some(cycle).filter(|_| preview.is_none()).and_then(|of| trial.error(campaign, unit, of));
            error(&unit.case.params, preview).or_else(of_generated)
        };
        let open = cycles[..checked].iter().copied().filter(|cycle| is_open(cycle));
        let error = open.filter_map(error_of).next();
        let scans = cycles[..checked]
            .iter()
            .map(|cycle| verdict(unit, previews.get(&cycle.surface).and_then(Preview::known)));
        let verdict = scans.reduce(Verdict::worse).unwrap_or_else(|| verdict(unit, None));
        Verdict { error, ..verdict }
    };
    campaign.cases.iter().zip(cycles).map(of).collect()
}

/// The verdict on a case without its error.
fn verdict(unit: &CaseUnit, known: Option<&Known>) -> Verdict {
    let params = &unit.case.params;
    let adhesion = params.material.work_of_adhesion_j_m2;
    let energies = energies(params, known);
    let ratio = |of: fn(&Flattening, f64) -> f64| {
        energies.as_ref().filter(|_| adhesion > 0.0).map(|(energy, _)| of(energy, adhesion))
    };
    let of_generated = || params.surface.generated().map(|surface| surface.length_m);
    let [whole, octave] = [ratio(Flattening::persson_tosatti), ratio(Flattening::conformity)];
    Verdict {
        case_id: unit.id.clone(),
        is_coarser_grid: unit.case.is_coarser_grid(),
        method: params.method.kind(),
        length_m: known.map(|known| known.header.length_m).or_else(of_generated),
        regime: energies
            .map(|(energy, slope)| Regime::expected(&energy, adhesion, params.cycle.largest_load(), slope)),
        is_table_missing: params.surface.generated().is_some_and(|surface| !surface.has_spectrum()),
        persson_tosatti: whole,
        conformity: octave,
        work_of_adhesion_j_m2: adhesion,
        effective_adhesion_j_m2: energies
            .and_then(|(energy, slope)| effective_adhesion(adhesion, slope, energy.whole_j_m2)),
        cost: cost(params, known, whole),
        error: None,
    }
}

/// Energies of flattening and rms gradient: of the target spectrum, or of the measured surface.
fn energies(params: &CaseParams, known: Option<&Known>) -> Option<(Flattening, f64)> {
    let modulus = params.material.contact_modulus_pa;
    if let Some(asked) = target(params) {
        return Some((flattening(&asked, modulus), asked.moments().rms_slope()));
    }
    let estimates = known?.found()?.estimates;
    Some((estimates.flattening.energies(modulus), estimates.roughness.rms_slope))
}

/// The method of `method = "auto"` for a case with a measured surface.
///
/// # Errors
/// The problem and the help if the scan cannot be read.
pub fn chosen_method(params: &CaseParams) -> Result<Method, (String, String)> {
    let refused = |error: &str| {
        let (problem, help) =
            error.split_once("\nhelp: ").unwrap_or((error, "write \"asperities\" or \"boundary_elements\""));
        (problem.to_owned(), help.to_owned())
    };
    let Some(surface) = params.surface.measured() else { return Ok(params.method.kind()) };
    // Boundary elements for all scans if one requires them.
    let mut method = Method::Asperities;
    for scan in 0..surface.names().len() as u32 {
        let scan = CaseParams { surface: params.surface.of_realization(scan), ..params.clone() };
        method = method.max(chosen_for_scan(&scan, refused)?);
    }
    Ok(method)
}

/// The method for one scan.
fn chosen_for_scan(
    params: &CaseParams,
    refused: impl Fn(&str) -> (String, String),
) -> Result<Method, (String, String)> {
    let Some(surface) = params.surface.measured() else { return Ok(params.method.kind()) };
    let preview = Preview::of_scan(surface, u64::MAX, usize::MAX);
    let known = match &preview {
        Preview::Known(known) => known,
        Preview::Refused(error) => return Err(refused(error)),
        Preview::Large => return Err(refused("it is not a file")),
    };
    if let Some(Err(error)) = &known.details {
        return Err(refused(error));
    }
    let Some((energy, slope)) = energies(params, Some(known)) else { return Ok(Method::Asperities) };
    let fails = || error(params, Some(&preview)).is_some();
    let method =
        Regime::expected(&energy, params.material.work_of_adhesion_j_m2, params.cycle.largest_load(), slope)
            .method();
    Ok(if method == Method::Asperities && fails() { Method::BoundaryElements } else { method })
}

/// The error by which the cycles of a case fail, as far as it is known before them.
fn error(params: &CaseParams, preview: Option<&Preview>) -> Option<String> {
    let known = match preview {
        None => None,
        Some(Preview::Large) => return None,
        Some(Preview::Refused(error)) => return Some(error.clone()),
        Some(Preview::Known(known)) => Some(&**known),
    };
    let of_surface = known.and_then(|known| known.details.as_ref()?.as_ref().err().cloned());
    of_surface.or_else(|| refusal(params, known).map(|error| error.to_string()))
}
