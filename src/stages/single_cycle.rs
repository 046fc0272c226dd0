//! Figures of a single cycle for the report.

use super::StageError;
use super::estimates::target;
use super::surface::scale;
use crate::campaign::{Campaign, CycleUnit, Standing};
use crate::figures::{Closer, ElementsLoop, closer, elements_loop};
use crate::model::{Boundary, Choice, GeneratedSurface, Method, MethodOptions, Normalization, SurfaceSource};
use crate::physics::surface::periodogram::{periodogram, windowed_periodogram};
use crate::physics::surface::spectrum::Spectrum;
use crate::physics::theory::curvature_density;
use crate::report::SingleCycle;
use crate::schema;
use crate::spec::CaseParams;
use crate::stats::{labels_with_unit, load_in_words, significant};
use crate::store::hdf5::{SurfaceHeader, read_surface};
use crate::store::parquet::read_table;
use crate::store::{Frame, read_loop_maps};
use std::f64::consts::TAU;

/// Maximum number of points along a side. For larger surfaces this section would need more memory than the
/// cycle.
const MAX_POINTS: u64 = 8192;

/// Points of a curve of a theory.
const POINTS: usize = 120;

/// A finished cycle with a load reversal.
pub(super) struct Chosen<'a> {
    pub(super) unit: &'a CycleUnit,
    pub(super) max_load: f64,
    /// Parameters of its case as text, with the load reversal in the unit of the spec.
    pub(super) parameters: String,
    /// True if a case with a larger mean Θ has no such cycle.
    has_larger: bool,
}

/// The first finished cycle of the case by a method with the largest mean Θ, at that load reversal;
/// `None` without one that `fits`.
pub(super) fn choose<'a>(
    campaign: &'a Campaign,
    standings: &[Standing],
    cases: &Frame,
    method: Method,
    fits: impl Fn(&CycleUnit) -> bool,
) -> Result<Option<Chosen<'a>>, StageError> {
    let done = || {
        campaign
            .cycles
            .iter()
            .zip(standings)
            .filter(|(_, standing)| **standing == Standing::Done)
            .map(|(unit, _)| unit)
    };
    let (ids, loads, losses) =
        (cases.text("case_id")?, cases.f64("max_load")?, cases.f64_or_null("loss_mean")?);
    let methods = cases.text("method")?;
    let mut rows: Vec<(usize, f64)> =
        losses.iter().enumerate().filter_map(|(row, loss)| loss.map(|loss| (row, loss))).collect();
    rows.retain(|(row, _)| methods[*row] == method.word());
    // Of equal means, the first row.
    rows.sort_by(|u, v| v.1.total_cmp(&u.1));
    let first = |row: usize| done().find(|unit| campaign.cases[unit.case].id == ids[row] && fits(unit));
    let found =
        rows.iter().enumerate().find_map(|(place, (row, _))| first(*row).map(|unit| (place, *row, unit)));
    let sides = cases.f64_or_null("length_m")?;
    Ok(found.map(|(place, row, unit)| {
        let file = campaign.label_of(&campaign.surfaces[unit.surface].params);
        let (case, unit_of_loads) = (&campaign.cases[unit.case].case.params, campaign.spec.load_unit());
        let modulus_pa = case.material.contact_modulus_pa;
        let load = load_in_words(loads[row], unit_of_loads, modulus_pa, sides[row]);
        let parameters = parameters(case, file.as_deref(), &load);
        Chosen { unit, max_load: loads[row], parameters, has_larger: place > 0 }
    }))
}

/// The cycles of the report: by boundary elements, then by the asperity model.
pub(super) fn look(
    campaign: &Campaign,
    standings: &[Standing],
    cases: &Frame,
) -> Result<Vec<SingleCycle>, StageError> {
    let elements = of_elements(campaign, standings, cases)?;
    Ok(elements.into_iter().chain(of_asperities(campaign, standings, cases)?).collect())
}

/// Loop and contact of the case by boundary elements with the largest mean Θ.
fn of_elements(
    campaign: &Campaign,
    standings: &[Standing],
    cases: &Frame,
) -> Result<Option<SingleCycle>, StageError> {
    let chosen = choose(campaign, standings, cases, Method::BoundaryElements, |_| true)?;
    let Some(Chosen { unit, max_load, parameters, has_larger }) = chosen else { return Ok(None) };
    let folder = campaign.cycle_dir(unit);
    let steps = read_table(&folder.join(format!("{}.parquet", schema::STEPS.name)), &schema::STEPS)?;
    let maps = read_loop_maps(&folder.join("maps.h5"), max_load)?;
    let (panels, map) = elements_loop(&ElementsLoop {
        max_load,
        parameters: &parameters,
        steps: &steps,
        maps: maps.as_ref(),
    })?;
    Ok(Some(SingleCycle {
        id: unit.id.clone(),
        realization: unit.realization,
        choice: choice(Some(Method::BoundaryElements), has_larger),
        files: "The table `events` of the cycle holds all events, the table `contacts` the regions of \
             contact, the file `maps.h5` gap and pressure.",
        parameters,
        panels,
        map,
    }))
}

/// The case of the asperity model with the largest mean Θ; `None` without a finished cycle, or if all
/// surfaces are too large.
fn of_asperities(
    campaign: &Campaign,
    standings: &[Standing],
    cases: &Frame,
) -> Result<Option<SingleCycle>, StageError> {
    let grid = |surface: &GeneratedSurface| surface.grid() <= MAX_POINTS;
    let fits = |unit: &CycleUnit| campaign.surfaces[unit.surface].params.generated().is_none_or(grid);
    let chosen = choose(campaign, standings, cases, Method::Asperities, fits)?;
    let Some(Chosen { unit, max_load, parameters, has_larger }) = chosen else { return Ok(None) };
    let has_elements = cases.text("method")?.iter().any(|method| *method != Method::Asperities.word());
    let choice = choice(has_elements.then_some(Method::Asperities), has_larger);
    let case = &campaign.cases[unit.case].case.params;
    let surface = &campaign.surfaces[unit.surface];
    let (header, heights) = read_surface(&campaign.surface_path(surface))?;
    let asperities = read_table(&campaign.asperities_path(surface), &schema::ASPERITIES)?;
    let table = |table: &'static schema::Table| {
        read_table(&campaign.cycle_dir(unit).join(format!("{}.parquet", table.name)), table)
    };
    let (steps, events, contacts) =
        (table(&schema::STEPS)?, table(&schema::EVENTS)?, table(&schema::CONTACTS)?);
    let (realised, scale) = (header.moments(), scale(campaign, surface)?);
    let (lowest, variance) = (TAU / header.length_m, header.rms_height_m.powi(2));
    let spectrum_of = if header.periodic { periodogram } else { windowed_periodogram };
    let highest = highest_whole_ring(&header);
    let found: Vec<(f64, f64)> = spectrum_of(heights.view(), header.length_m)?
        .iter()
        .filter(|ring| ring.wavenumber_1_m < highest * lowest)
        .map(|ring| (ring.wavenumber_1_m / lowest, ring.density_m4 * lowest * lowest / variance))
        .collect();
    let nayak: Vec<(f64, f64)> =
        (0..=POINTS).map(|k| 8.0 * k as f64 / POINTS as f64).map(|t| (t, curvature_density(-t))).collect();
    let area = header.length_m * header.length_m;
    let target = target(case);
    let of = Closer {
        max_load,
        parameters: &parameters,
        steps: &steps,
        events: &events,
        contacts: &contacts,
        asperities: &asperities,
        energy_j: case.material.contact_modulus_pa * area * scale.rms_height_m,
        rms_height_m: scale.rms_height_m,
        length_m: header.length_m,
        periodic: case.boundary() == Boundary::Periodic,
        pull_off_n_m: case.material.pull_off_line_load(),
        found: &found,
        asked: &target.as_ref().map(asked).unwrap_or_default(),
        asked_factor: target.as_ref().map(|target| variance / eq10_variance(target)),
        curvature_1_m: realised.curvature_unit_1_m(),
        nayak: &nayak,
        densities_1_m2: [asperities.row_count() as f64 / area, realised.summit_density_1_m2()],
    };
    let (panels, map) = closer(&of, heights.view())?;
    let realization = surface.realization;
    let files = "The table `events` of the cycle holds all events, the table `contacts` the contact spots.";
    Ok(Some(SingleCycle { id: unit.id.clone(), realization, choice, files, parameters, panels, map }))
}

/// The chosen case in words, with its method where a run has boundary elements.
fn choice(method: Option<Method>, has_larger: bool) -> String {
    let has_larger = has_larger && method != Some(Method::BoundaryElements);
    let method = method.map_or_else(String::new, |method| format!(" by {}", method.name()));
    let size = if has_larger {
        format!(" on surfaces of at most {MAX_POINTS} × {MAX_POINTS} points")
    } else {
        String::new()
    };
    format!("The case{method} with the largest mean Θ/(E*A_{{0}}h_{{rms}}){size}")
}

/// The parameters of a case with a load reversal as text: `ζ = 64, H = 0.8, …`.
pub(super) fn parameters(case: &CaseParams, file: Option<&str>, load: &str) -> String {
    let material = &case.material;
    let with_unit = |symbol: &str, column: &str, value: f64| {
        labels_with_unit(column, &[value])
            .into_iter()
            .map(|text| format!("{symbol} = {text}"))
            .collect::<String>()
    };
    let mut parts = match &case.surface {
        SurfaceSource::Measured(_) => vec![file.unwrap_or_default().to_owned()],
        SurfaceSource::Generated(surface) => {
            let law = if surface.is_tabulated() {
                vec![file.unwrap_or_default().to_owned()]
            } else {
                vec![
                    format!("H = {}", significant(surface.hurst, 4)),
                    with_unit("h_rms", "rms_height_m", surface.rms_height_m),
                ]
            };
            let zeta = vec![format!("ζ = {}", surface.magnification)];
            [zeta, law, vec![with_unit("L", "length_m", surface.length_m)], of_shape(surface)].concat()
        }
    };
    parts.push(with_unit("E*", "contact_modulus_pa", material.contact_modulus_pa));
    parts.push(with_unit("Δγ", "work_of_adhesion_j_m2", material.work_of_adhesion_j_m2));
    let choices = match &case.method {
        MethodOptions::Asperities(model) => {
            vec![
                ("interaction", model.interaction.word()),
                ("boundary", model.boundary.word()),
                ("coalescence", model.coalescence.word()),
            ]
        }
        method => vec![("method", method.kind().word())],
    };
    parts.extend(choices.iter().map(|(key, word)| format!("{key} = \"{word}\"")));
    parts.push(load.to_owned());
    parts.join(", ")
}

/// Parameters of the shape of a spectrum that is no plain power law.
fn of_shape(surface: &GeneratedSurface) -> Vec<String> {
    let length = |symbol: &str, value: Option<f64>| {
        let labels = value.map(|value| labels_with_unit("length_m", &[value])).unwrap_or_default();
        labels.into_iter().map(|text| format!("{symbol} = {text}")).collect::<Vec<_>>()
    };
    let mut parts = length("λ_r", surface.roll_off_m);
    parts.extend(length("λ_long", surface.longest_wavelength_m));
    if surface.aspect_ratio != 1.0 {
        parts.push(format!("r = {}", significant(surface.aspect_ratio, 4)));
        parts.push(format!("lay at {}°", significant(surface.angle_deg, 4)));
    }
    parts
}

/// The wavenumber q/qL up to which rings of the spectrum have all their modes below the cut-off: the mean of
/// a ring that it divides has modes without amplitude.
fn highest_whole_ring(header: &SurfaceHeader) -> f64 {
    match &header.measured {
        Some(measured) if measured.shortest_wavelength_m > 0.0 => {
            header.length_m / measured.shortest_wavelength_m
        }
        Some(_) => f64::INFINITY,
        // Ring j has the modes from 2^((j - 1/2)/4) to 2^((j + 1/2)/4), four rings to a doubling.
        None => (((4.0 * header.generated.as_ref().map_or(1.0, |of| of.magnification).log2() - 0.5).floor()
            + 0.5)
            / 4.0)
            .exp2(),
    }
}

/// A target spectrum at the realised rms height: `C qL²/h_rms²` over q/qL, from the longest to the shortest
/// waves, such that the sum over the lattice of modes is 1, as it is for the surface. Of an anisotropic
/// spectrum it is the mean over directions.
fn asked(target: &Spectrum) -> Vec<(f64, f64)> {
    let [longest, shortest] = target.band_1_m();
    if !target.shape.is_plain() {
        let lowest = target.lowest_wavenumber();
        let unit = lowest * lowest / eq10_variance(target);
        let at = |k: usize| longest * (shortest / longest).powf((k as f64 + 0.5) / (POINTS as f64 + 1.0));
        // The mean over a narrow ring.
        let mean = |q: f64| {
            let [low, high] = [0.999, 1.001].map(|factor| factor * q);
            target.integral(0.0, low, high) / (std::f64::consts::PI * (high * high - low * low))
        };
        return (0..=POINTS).map(at).map(|q| (q / lowest, unit * mean(q))).collect();
    }
    // `C qL²` of Eq 10 at qL [m²].
    let unit = target.prefactor() * target.lowest_wavenumber().powi(2) / eq10_variance(target);
    let at = |k: usize| f64::from(target.magnification).powf(k as f64 / POINTS as f64);
    (0..=POINTS).map(at).map(|q| (q, unit * q.powf(-2.0 * (target.hurst + 1.0)))).collect()
}

/// The sum of Eq 10 over the lattice of modes \[m²\]. It exceeds the integral, which defines the rms height.
fn eq10_variance(target: &Spectrum) -> f64 {
    Spectrum { normalization: Normalization::Spectrum, ..target.clone() }.lattice_moments().m0_m2
}
