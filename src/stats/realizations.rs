//! One row per case, realization and load reversal.

use super::adhesion::closing_and_opening_j;
use super::cycle::{Branch, Cycle, fault};
use super::events::{Events, Lost};
use super::rows::{Rows, Value};
use super::{CaseInput, CycleInput, Given, StatsError};
use crate::schema::{EVENT_KINDS, EventKind, REALIZATIONS};
use crate::store::Frame;

/// Reduces each cycle to one row per load reversal. Rows are ordered by case, load reversal and realization,
/// independently of the order of the inputs.
///
/// The dissipated energy is `Θ = ∮F dΔ`: the work up to the load reversal, and the work of the unloading
/// branch, which is negative where load falls with Δ. The dissipated energy of its events is given in parts:
/// up to the load reversal, which is only a part of the loading path if loading continued, and while
/// unloading; and by the kind of event. The pull-off force is minus the smallest load of the unloading
/// branch; it is zero without tension.
///
/// # Errors
/// If a table of steps cannot be read or holds no such branch, if a cycle names an unknown case, or if a
/// required column was not given.
pub fn realizations(cases: &[CaseInput], cycles: &[CycleInput]) -> Result<Frame, StatsError> {
    let mut ordered: Vec<(&str, f64, i64, Given, &CaseInput, &CycleInput)> = Vec::new();
    for input in cycles {
        let case = case_of(cases, input)?;
        let cycle = Cycle::read(&input.steps)?;
        let events = Events::read(&input.events)?;
        for (max_load, unloading) in &cycle.unloading {
            let turning = cycle.turning_row(input, *max_load)?;
            let mut results = reduce(&cycle.loading, turning, unloading, *max_load, input)?;
            let step = cycle.loading.step.get(turning).copied().unwrap_or_default();
            let lost = events.lost(step, *max_load);
            results.push(("absorption_share".to_owned(), absorption_share(&lost, &results).into()));
            results.extend(parts(&lost, input));
            results.extend(input.at(*max_load).cloned().unwrap_or_default());
            ordered.push((&case.case_id, *max_load, input.realization, results, case, input));
        }
    }
    ordered.sort_by(|a, b| a.0.cmp(b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut rows = Rows::of(&REALIZATIONS);
    for (_, _, _, results, case, input) in &ordered {
        // Of several scans each has its own file and size.
        rows.push(&[&identity(case), results, &input.surface, &case.parameters]);
    }
    rows.build()
}

/// Results of the steps of one cycle at each of its load reversals, ascending.
///
/// # Errors
/// If the table of steps cannot be read or holds no such branch.
pub fn results(input: &CycleInput) -> Result<Vec<(f64, Given)>, StatsError> {
    let cycle = Cycle::read(&input.steps)?;
    let of = |(max_load, unloading): &(f64, Branch)| {
        let turning = cycle.turning_row(input, *max_load)?;
        Ok((*max_load, reduce(&cycle.loading, turning, unloading, *max_load, input)?))
    };
    cycle.unloading.iter().map(of).collect()
}

/// The case that a cycle names.
pub(super) fn case_of<'a>(cases: &'a [CaseInput], input: &CycleInput) -> Result<&'a CaseInput, StatsError> {
    let unknown =
        || StatsError::UnknownCase { case_id: input.case_id.clone(), realization: input.realization };
    cases.iter().find(|case| case.case_id == input.case_id).ok_or_else(unknown)
}

/// The columns that name a case.
pub(super) fn identity(case: &CaseInput) -> Given {
    vec![
        ("case_id".to_owned(), case.case_id.as_str().into()),
        ("sweep".to_owned(), case.sweep.as_str().into()),
    ]
}

/// The columns of what the events of a loop lost.
fn parts(lost: &Lost, input: &CycleInput) -> Given {
    let branches = [("loading", lost.loading), ("unloading", lost.unloading)];
    let kinds = EVENT_KINDS.iter().copied().zip(lost.kinds);
    let both = |(part, energy_j): (&str, f64)| {
        [
            (format!("dissipated_{part}"), (energy_j / input.energy_scale_j).into()),
            (format!("dissipated_{part}_j"), energy_j.into()),
        ]
    };
    branches.into_iter().chain(kinds).flat_map(both).collect()
}

/// Coalescence energy over Θ, `|E_cover + E_uncover + E_merge + E_split|/|Θ|`; null for Θ = 0.
///
/// Energies that cancel along the loop, such as those of merging and of the later splitting, do not count.
/// The energies of all events sum to Θ. So the share is between 0 and 1, up to the energy-balance error, if
/// neither the events of coalescence nor the other ones gain energy in sum.
fn absorption_share(lost: &Lost, results: &Given) -> Option<f64> {
    let loss = results.iter().find(|(name, _)| name == "loss_j").and_then(|(_, value)| value.number())?;
    let kinds = EventKind::ALL.into_iter().zip(lost.kinds).filter(|(kind, _)| kind.group().is_coalescence());
    (loss != 0.0).then(|| (kinds.map(|(_, energy)| energy).sum::<f64>() / loss).abs())
}

/// Resolution of Θ over |Θ|; nothing for Θ = 0. The energy balance of boundary elements is exact, so that its
/// error is one of Θ.
fn uncertainty([loss_j, imbalance_j]: [f64; 2], max_load: f64, input: &CycleInput) -> Option<f64> {
    let number = |given: &Given, name: &str| {
        given.iter().find(|(known, _)| known == name).and_then(|(_, value)| value.number())
    };
    let resolution_j = input.at(max_load).and_then(|given| number(given, "resolution_j"))?;
    let error_j = number(&input.surface, "elements_per_wavelength").map_or(0.0, |_| imbalance_j);
    (loss_j != 0.0).then(|| resolution_j.max(error_j) / loss_j.abs())
}

/// Pull-off force \[N\]. With adhesion one of 0 is lost in the load.
fn pull_off_n(unloading: &Branch, input: &CycleInput) -> Option<f64> {
    // `+ 0.0` removes the minus sign of a negative zero.
    let tension = -unloading.least_load_n.iter().copied().fold(0.0, f64::min) + 0.0;
    let is_adhesive = input.loss_dalvi_per_area_j > 0.0;
    (tension > 0.0 || !is_adhesive).then_some(tension)
}

/// Energy-balance error over |Θ|; without adhesion, energy of the events of loading over the work.
fn audit_gap([loss_j, imbalance_j]: [f64; 2], on_loading_j: f64, work_j: f64) -> Option<f64> {
    let (imbalance_j, compared_j) =
        if loss_j == 0.0 { (on_loading_j.abs(), work_j) } else { (imbalance_j, loss_j.abs()) };
    (compared_j > 0.0).then(|| imbalance_j / compared_j)
}

/// Deng and Kesari's Θ of a probe over the unit of energies, from the moments of the continuous spectrum and
/// of the surface: for the contact area of the smooth probe less that after its jump into contact. Nothing
/// without a probe.
fn dk_of_probe(max_load: f64, input: &CycleInput) -> Option<[Option<f64>; 2]> {
    let given = input.at(max_load)?;
    let area = |name: &str| given.iter().find(|(known, _)| known == name)?.1.number();
    let swept = (area("area_jkr_probe")? - area("area_jkr_jump_in")?).max(0.0);
    let of = [input.loss_dk_probe_per_area_j, input.loss_dk_probe_realised_per_area_j];
    Some(of.map(|of| of.map(|loss_j| loss_j * swept / input.energy_scale_j)))
}

/// Dissipated energies of models at a contact area over A0 in the unit of energies, and the ratio of that of
/// the loop to Deng and Kesari's, of a probe with its own radius.
fn models(area: f64, loss: Option<f64>, max_load: f64, input: &CycleInput) -> [(&'static str, Value); 7] {
    let per_area = |loss_j: f64| loss_j * area / input.energy_scale_j;
    let loss_dk = input.loss_dk_per_area_j.map(per_area);
    let of_probe = dk_of_probe(max_load, input);
    let compared = of_probe.map_or(loss_dk, |[of_target, _]| of_target).filter(|dk| *dk != 0.0);
    [
        ("loss_dk", loss_dk.into()),
        ("loss_dk_realised", input.loss_dk_realised_per_area_j.map(per_area).into()),
        ("loss_dk_probe", of_probe.and_then(|of| of[0]).into()),
        ("loss_dk_probe_realised", of_probe.and_then(|of| of[1]).into()),
        ("loss_pinning", input.loss_pinning_per_area_j.map(per_area).into()),
        ("loss_dalvi", per_area(input.loss_dalvi_per_area_j).into()),
        ("loss_ratio_dk", loss.zip(compared).map(|(loss, dk)| loss / dk).into()),
    ]
}

fn reduce(
    loading: &Branch,
    turning: usize,
    unloading: &Branch,
    max_load: f64,
    input: &CycleInput,
) -> Result<Given, StatsError> {
    let lacking = |what: &str| fault(&input.steps, format!("lack {what} at the turning point {max_load}"));
    let at = |values: &[f64]| values.get(turning).copied().ok_or_else(|| lacking("a number"));
    let count_at = |values: &[i64]| values.get(turning).copied().unwrap_or_default();
    let work_back = unloading.work_j.last().ok_or_else(|| lacking("an unloading branch"))?;
    let at_reversal = at(&loading.work_j)?;
    let loss_j = at_reversal + work_back;
    let on_unloading = unloading.work_j.iter().map(|work| at_reversal + work);
    let works = loading.work_j.iter().take(turning + 1).copied().chain(on_unloading);
    let work_j = works.map(f64::abs).fold(0.0, f64::max);
    let loss = loss_j / input.energy_scale_j;
    let area = at(&loading.area)?;
    let discs = at(&loading.area_m2)?;
    let union = loading.area_union_m2.get(turning).copied().flatten();
    let on_loading: f64 = loading.dissipated_j.iter().take(turning + 1).sum();
    // Without adhesion the events of loading are undone on unloading, and nothing but rounding remains.
    let dissipated_j =
        if loss_j == 0.0 { 0.0 } else { on_loading + unloading.dissipated_j.iter().sum::<f64>() };
    let energies = [loss_j, (loss_j - dissipated_j).abs()];
    // The resolution of a negative energy is at least its magnitude: it is no result.
    let is_resolved = loss_j >= 0.0;
    let converged = loading.converged.iter().take(turning + 1).chain(&unloading.converged);
    let (contacts, covered) = (count_at(&loading.contact_count), count_at(&loading.covered_count));
    let pull_off = pull_off_n(unloading, input);
    let held: i64 = loading.held_count.iter().take(turning + 1).chain(&unloading.held_count).sum();
    let load_unit = at(&loading.load)? / at(&loading.load_n)?;
    // Sum and union of the discs are both in m²: A0 need not be known.
    let union = union.map(|union| if discs > 0.0 { union * area / discs } else { 0.0 });
    let share = |part: i64, of: i64| (of > 0).then(|| part as f64 / of as f64);
    let columns: [(&str, Value); 23] = [
        ("realization", input.realization.into()),
        ("cycle_id", input.cycle_id.as_str().into()),
        ("surface_id", input.surface_id.as_str().into()),
        ("asperities_id", input.surface_id.as_str().into()),
        ("max_load", max_load.into()),
        // The turning step has the unit of load, as the quotient of its two columns.
        ("pull_off_load", pull_off.map(|pull_off| pull_off * load_unit).into()),
        ("area_at_max_load", area.into()),
        ("area_union_at_max_load", union.into()),
        ("penetration_at_max_load", at(&loading.penetration)?.into()),
        ("loss", is_resolved.then_some(loss).into()),
        ("loss_j", is_resolved.then_some(loss_j).into()),
        ("dissipated", (dissipated_j / input.energy_scale_j).into()),
        ("dissipated_j", dissipated_j.into()),
        ("audit_gap", audit_gap(energies, on_loading, work_j).into()),
        ("loss_uncertainty", uncertainty(energies, max_load, input).into()),
        ("contact_count_at_max_load", contacts.into()),
        ("touching_count_at_max_load", count_at(&loading.touching_count).into()),
        ("covered_count_at_max_load", covered.into()),
        ("step_count", (turning + 1 + unloading.step.len()).into()),
        ("unconverged_count", converged.filter(|converged| !**converged).count().into()),
        ("held_count", held.into()),
        ("touching_share", share(count_at(&loading.touching_count), contacts).into()),
        ("covered_share", share(covered, contacts + covered).into()),
    ];
    let forces = [pull_off, Some(max_load / load_unit)];
    let works = closing_and_opening_j(at_reversal, unloading);
    let of_models = models(area, is_resolved.then_some(loss), max_load, input);
    let in_si = in_si(forces, is_resolved.then_some(loss_j), works, input);
    let columns = columns.into_iter().chain(of_models).chain(in_si);
    Ok(columns.map(|(name, value)| (name.to_owned(), value)).collect())
}

/// Results in SI units, per nominal area and over the work of adhesion, from the pull-off force and the
/// load at the load reversal \[N\], the dissipated energy and the energies of closing and opening \[J\].
fn in_si(
    [pull_off_n, max_load_n]: [Option<f64>; 2],
    loss_j: Option<f64>,
    works: Option<[f64; 2]>,
    input: &CycleInput,
) -> [(&'static str, Value); 10] {
    let area_m2 = input.surface.iter().find(|(name, _)| name == "nominal_area_m2");
    let area_m2 = area_m2.and_then(|(_, value)| value.number());
    let per_m2 = |energy_j: f64| area_m2.map(|area_m2| energy_j / area_m2);
    let works = works.filter(|_| loss_j.is_some());
    let adhesion_j = Some(input.loss_dalvi_per_area_j).filter(|adhesion_j| *adhesion_j > 0.0);
    [
        ("max_load_n", max_load_n.into()),
        ("max_load_pa", max_load_n.and_then(per_m2).into()),
        ("pull_off_load_n", pull_off_n.into()),
        ("pull_off_pressure_pa", pull_off_n.and_then(per_m2).into()),
        ("loss_j_m2", loss_j.and_then(per_m2).into()),
        ("loss_over_adhesion", loss_j.zip(adhesion_j).map(|(loss, adhesion)| loss / adhesion).into()),
        ("work_closing_j", works.map(|works| works[0]).into()),
        ("work_opening_j", works.map(|works| works[1]).into()),
        ("work_closing_j_m2", works.and_then(|works| per_m2(works[0])).into()),
        ("work_opening_j_m2", works.and_then(|works| per_m2(works[1])).into()),
    ]
}
