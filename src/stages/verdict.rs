//! Verdict on each case before a run: regime, recommended method, grid, memory and time.

use super::cost::{Cost, LONG, of_asperities, of_elements};
use super::cycle::{Lattice, Square, checked, checked_lattice, enough_memory};
use super::estimates::target;
use super::outside::{Outside, interval};
use super::previews::{Known, Preview};
use super::surface::Scale;
use super::trial::Trial;
use crate::campaign::{Campaign, CaseUnit, CycleUnit, Standing};
use crate::model::Method;
use crate::physics::theory::flattening::{Flattening, flattening};
use crate::physics::theory::regime::{Regime, effective_adhesion};
use crate::spec::{CaseParams, FEWEST_PER_WAVELENGTH};
use crate::stats::{Caution, significant};
use crate::store::Check;
use std::collections::HashMap;

/// Verdict on a case before a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Id of the case.
    pub case_id: String,
    /// Its method.
    pub method: Method,
    /// Regime; nothing for a surface that is not known yet.
    pub regime: Option<Regime>,
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

/// Measured surfaces before a run, by their places in [`Campaign::surfaces`].
pub(super) type Previews = HashMap<usize, Preview>;

/// All measured surfaces of a campaign, read once.
pub(super) fn previews(campaign: &Campaign) -> Previews {
    let measured = campaign.surfaces.iter().enumerate().filter(|(_, surface)| surface.params.is_measured());
    measured.map(|(place, surface)| (place, Preview::of(campaign, surface))).collect()
}

/// The verdicts on all cases.
pub(super) fn verdicts(campaign: &Campaign, previews: &Previews) -> Vec<Verdict> {
    let mut surfaces = vec![None; campaign.cases.len()];
    for cycle in &campaign.cycles {
        surfaces[cycle.case].get_or_insert(cycle);
    }
    let trial = Trial::default();
    let of = |(unit, cycle): (&CaseUnit, Option<&CycleUnit>)| {
        let preview = cycle.and_then(|cycle| previews.get(&cycle.surface));
        let is_open = || {
            let standing = cycle.map(|cycle| campaign.cycle_standing(cycle, Check::Sizes));
            !matches!(standing, Some(Standing::Done | Standing::Failed(_)))
        };
        let of_generated = || cycle.filter(|_| preview.is_none()).and_then(|cycle| trial.error(campaign, unit, cycle));
        let error = Some(()).filter(|()| is_open()).and_then(|()| error(&unit.case.params, preview).or_else(of_generated));
        Verdict { error, ..verdict(unit, preview.and_then(Preview::known)) }
    };
    campaign.cases.iter().zip(surfaces).map(of).collect()
}

/// The verdict on a case without its error.
fn verdict(unit: &CaseUnit, known: Option<&Known>) -> Verdict {
    let params = &unit.case.params;
    let adhesion = params.material.work_of_adhesion_j_m2;
    let energies = energies(params, known);
    let ratio = |of: fn(&Flattening, f64) -> f64| energies.as_ref().filter(|_| adhesion > 0.0).map(|(energy, _)| of(energy, adhesion));
    let [whole, octave] = [ratio(Flattening::persson_tosatti), ratio(Flattening::conformity)];
    Verdict {
        case_id: unit.id.clone(),
        method: params.model.method,
        regime: energies.map(|(energy, slope)| Regime::expected(&energy, adhesion, params.cycle.largest_load(), slope)),
        persson_tosatti: whole,
        conformity: octave,
        work_of_adhesion_j_m2: adhesion,
        effective_adhesion_j_m2: energies.and_then(|(energy, slope)| effective_adhesion(adhesion, slope, energy.whole_j_m2)),
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
        let (problem, help) = error.split_once("\nhelp: ").unwrap_or((error, "write \"asperities\" or \"boundary_elements\""));
        (problem.to_owned(), help.to_owned())
    };
    let preview = Preview::of_scan(&params.surface, u64::MAX, usize::MAX);
    let known = match &preview {
        Preview::Known(known) => known,
        Preview::Refused(error) => return Err(refused(error)),
        Preview::Large => return Err(refused("it is not a file")),
    };
    if let Some(Err(error)) = &known.details {
        return Err(refused(error));
    }
    let mut by_asperities = params.clone();
    by_asperities.model.method = Method::Asperities;
    let Some((energy, slope)) = energies(params, Some(known)) else { return Ok(Method::Asperities) };
    let fails = || error(&by_asperities, Some(&preview)).is_some();
    let method = Regime::expected(&energy, params.material.work_of_adhesion_j_m2, params.cycle.largest_load(), slope).method();
    Ok(if method == Method::Asperities && fails() { Method::BoundaryElements } else { method })
}

/// Grid, memory and time of a cycle.
fn cost(params: &CaseParams, known: Option<&Known>, ratio: Option<f64>) -> Option<Cost> {
    let surface = &params.surface;
    if params.by_elements() {
        let (lattice, rms_height_m) = match known {
            Some(known) => (Lattice::of_measured(params, Square::of(params, &known.header)), known.header.rms_height_m),
            None if surface.is_measured() => return None,
            None => (Lattice::of_generated(params), surface.rms_height_m),
        };
        let cost = of_elements(params, lattice.points, ratio, (lattice.range_m, rms_height_m));
        let shortest = known.and_then(Known::found).map_or(1.0, |found| found.estimates.per_shortest_wavelength(1.0));
        return Some(Cost { per_wavelength: shortest * lattice.per_wavelength, is_mirrored: lattice.is_mirrored, ..cost });
    }
    let (points, wavelengths) = match known {
        Some(Known { header, .. }) => {
            let measured = header.measured.as_ref()?;
            (
                header.length_m / measured.source_spacings_m[0].min(measured.source_spacings_m[1]),
                header.length_m / measured.shortest_wavelength_m,
            )
        }
        None if surface.is_measured() => return None,
        None => (surface.grid() as f64, f64::from(surface.magnification)),
    };
    Some(of_asperities(params, points.round(), wavelengths))
}

/// The error by which the cycles of a case fail, as far as it is known before them.
fn error(params: &CaseParams, preview: Option<&Preview>) -> Option<String> {
    let of_memory = |points: usize| enough_memory(points, params.cycle.max_load.len()).err().map(|error| error.to_string());
    let known = match preview {
        None if params.by_elements() && !params.surface.is_measured() => return of_memory(Lattice::of_generated(params).points),
        None | Some(Preview::Large) => return None,
        Some(Preview::Refused(error)) => return Some(error.clone()),
        Some(Preview::Known(known)) => known,
    };
    let details = known.details.as_ref();
    let of_asperities = || {
        let scale = Scale { length_m: known.header.length_m, rms_height_m: known.header.rms_height_m };
        details?.as_ref().ok().and_then(|details| checked(params, scale, &details.found.list).err())
    };
    let of_elements = || checked_lattice(params, &known.header, known.header.rms_height_m).err();
    let refused = || if params.by_elements() { of_elements() } else { of_asperities() };
    details.and_then(|details| details.as_ref().err().cloned()).or_else(|| refused().map(|error| error.to_string()))
}

const LONG_LOOP: Caution = Caution {
    code: "long_loop",
    label: "long loop",
    text: "one loop takes about {}",
    consequence: "A run has no result before the end of a loop.",
    action: "Use a smaller grid.",
};

/// Cases of boundary elements with a loop of more than ten minutes.
pub(super) fn long_loops(campaign: &Campaign, verdicts: &[Verdict]) -> Option<Outside> {
    let is_long = |of: &&Verdict| of.method == Method::BoundaryElements && of.cost.is_some_and(|cost| cost.seconds > LONG);
    let long: Vec<(&Verdict, Cost)> = verdicts.iter().filter(is_long).filter_map(|of| Some((of, of.cost?))).collect();
    let (longest, cost) = long.iter().max_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds))?;
    let minutes = || long.iter().map(|(_, cost)| cost.seconds / 60.0);
    let range = [minutes().reduce(f64::min)?, minutes().reduce(f64::max)?];
    let params = campaign.cases.iter().find(|unit| unit.id == longest.case_id).map(|unit| &unit.case.params)?;
    let smaller = (1..).map(|half| cost.points >> half).take_while(|points| *points >= 16);
    let enough = |points: u64| cost.per_wavelength * points as f64 / cost.points as f64;
    let advice = smaller
        .take_while(|points| enough(*points) >= FEWEST_PER_WAVELENGTH)
        .map(|points| (points, of_elements(params, points as usize, longest.persson_tosatti, (None, 1.0)).seconds));
    let fast = advice.clone().find(|(_, seconds)| *seconds <= LONG).or_else(|| advice.last());
    let help = fast.map_or_else(
        || "smaller grids have less than 4 points per shortest wavelength".to_owned(),
        |(points, seconds)| {
            let per_wavelength = significant(enough(points), 2);
            format!("points = {points}: {} points per shortest wavelength, about {}", per_wavelength, in_words(seconds))
        },
    );
    let shown = format!("{} min (accuracy: a factor of 3; limit 10 min; {help})", interval(range.map(two_digits)));
    let measured = LONG_LOOP.text.replace("{}", &shown);
    let cases = long.iter().map(|(of, _)| of.case_id.clone()).collect();
    Some(Outside { kind: LONG_LOOP, limit: LONG / 60.0, range, measured, cases })
}

/// A number rounded to two digits.
fn two_digits(value: f64) -> f64 {
    significant(value, 2).parse().unwrap_or(value)
}

/// A time as text.
#[must_use]
pub fn in_words(seconds: f64) -> String {
    match seconds {
        _ if seconds < 1.0 => "1 s".to_owned(),
        _ if seconds < 100.0 => format!("{} s", significant(seconds, 1)),
        _ if seconds < 6000.0 => format!("{} min", significant(seconds / 60.0, 2)),
        _ => format!("{} h", significant(seconds / 3600.0, 2)),
    }
}
