//! From a draft to the cases: sweeps multiplied out, equal cases joined, and what no single value shows
//! checked.

use std::collections::{BTreeSet, HashSet};
use std::ops::Range;

use super::auto::Choices;
use super::cases::Cases;
use super::coarser::{self, Coarser, points_of};
use super::elements::check_elements;
use super::fault::Faults;
use super::figures::check_across;
use super::files::named;
use super::keys::{KEYS, find};
use super::number::short;
use super::origin::{Origin, written};
use super::probe::check_contact;
use super::scans::{check_measured, realizations as scan_realizations};
use super::shape::{blamed, check_spectrum};
use super::sides::Sides;
use super::sweep::SweepDraft;
use super::values::Values;
use super::walk::Draft;
use super::zip::AxisDraft;
use crate::model::{CaseParams, Detrend, FarField, GeneratedSurface, Method, SurfaceSource};

use super::{Axis, Case, MAX_CASES, MAX_GRID, MAX_TASKS, Realizations, Spec, Sweep, Value};

/// The sweep that a case without sweeps belongs to.
const BASE: &str = "base";

/// Multiplies the sweeps out. Nothing, with the faults added, if there are too many cases or the draft has no
/// name.
pub(super) fn expand(draft: Draft, faults: &mut Faults<'_>) -> Option<Spec> {
    let Draft { mut base, origins, sweeps, coarser: coarser_grids, .. } = draft;
    let read: Vec<&SweepDraft> = sweeps.iter().flatten().collect();
    if too_many(&read, faults) {
        return None;
    }
    let (mut cases, mut coarser) = (Cases::default(), Vec::new());
    let (mut choices, mut auto_cases) = (Choices::of(draft.auto_methods), Vec::new());
    let mut sides = Sides::of(draft.scan_sides_m);
    let mut add =
        |mut values: Values, origins: &[Origin], swept: &[usize], sweep: &str, faults: &mut Faults<'_>| {
            complete(&mut values, origins);
            sides.set(&mut values, &draft.files, draft.are_sides_read);
            let is_auto = choices.choose(&mut values);
            coarser::check_choice(&values, &coarser_grids, origins, faults);
            let first = coarser::first_grids(&mut values, origins, faults);
            let params = values.case();
            check(&params, &values, (origins, swept), faults);
            let grids = if values.goal.error.is_some() { &first } else { &coarser_grids };
            coarser.extend(on_coarser(grids, &values, (origins, swept), faults));
            let case = cases.add(&[sweep.to_owned()], params);
            auto_cases.extend(Some(case).filter(|_| is_auto));
            sides.note(case, written(find("cycle", "max_force_n"), origins));
        };
    // A sweep with a fault is no point.
    if sweeps.is_empty() || !read.is_empty() {
        each_point(&read, (&base, &origins), |values, origins, swept, sweep| {
            add(values, origins, swept, sweep, faults);
        });
    }
    cases.add_coarser(coarser);
    complete(&mut base, &origins);
    let files = named(draft.files, &cases.list, draft.experiment.as_ref(), faults);
    let at = draft.realizations_at.as_ref();
    let realizations = scan_realizations(&cases.list, draft.realizations, at, faults);
    bound_tasks(&cases.list, realizations, at.or(read.first().map(|sweep| &sweep.span)), faults);
    choices.check(draft.auto_at.as_ref(), faults);
    sides.check(draft.sides_at.as_ref(), faults);
    // A sweep with a fault has no name.
    if read.len() == sweeps.len() {
        check_across(&draft.across, &read, faults);
    }
    let mut sweeps: Vec<Sweep> = read.into_iter().map(sweep).collect();
    let auto_methods = choices.settle(&mut base, &mut sweeps);
    // Of cases that are all chosen the places are of no use.
    auto_cases.retain(|_| auto_methods.contains(&Method::Auto));
    let (scan_sides_m, unread) = sides.settle();
    Some(Spec {
        name: draft.name?,
        seed: draft.seed,
        realizations,
        figures: draft.figures,
        experiment: draft.experiment,
        cases: cases.list,
        base,
        coarser_points: points_of(&coarser_grids),
        sweeps,
        auto_methods,
        auto_cases,
        scan_sides_m,
        unread,
        files,
        absolute_files: BTreeSet::new(),
    })
}

/// Values, origins, swept keys and name of every point of the sweeps; without sweeps those of the base.
fn each_point(
    sweeps: &[&SweepDraft],
    (base, of_base): (&Values, &[Origin]),
    mut add: impl FnMut(Values, &[Origin], &[usize], &str),
) {
    if sweeps.is_empty() {
        add(base.clone(), of_base, &[], BASE);
    }
    for sweep in sweeps {
        let swept: Vec<usize> = sweep.axes.iter().map(|axis| axis.key).collect();
        for point in points(sweep) {
            let (mut values, mut origins) = (base.clone(), of_base.to_vec());
            for grid in swept.iter().filter(|key| coarser::LISTS.contains(&KEYS[**key].path)) {
                coarser::clear_others(*grid, &coarser::LISTS, &mut values, &mut origins);
            }
            for (group, at) in sweep.together.iter().zip(point) {
                for axis in group.iter().map(|place| &sweep.axes[*place]) {
                    let value = &axis.values[at];
                    (KEYS[axis.key].set)(&mut values, value.get_ref());
                    origins[axis.key] = Origin::Written(value.span());
                }
            }
            add(values, &origins, &swept, &sweep.name);
        }
    }
}

/// True if the sweeps make more cases than allowed, found without making them.
fn too_many(sweeps: &[&SweepDraft], faults: &mut Faults<'_>) -> bool {
    let mut total: u128 = 0;
    let mut first_beyond: Option<&Range<usize>> = None;
    for sweep in sweeps {
        let count = sweep.counts().fold(1_u128, |count, values| count.saturating_mul(values as u128));
        total = total.saturating_add(count);
        if total > u128::from(MAX_CASES) {
            first_beyond = first_beyond.or(Some(&sweep.span));
        }
    }
    if let Some(span) = first_beyond {
        let message = format!("the sweeps make {total} cases: at most {MAX_CASES} are allowed");
        let help = "arrays in one sweep multiply; sweep fewer keys, or use several sweeps".to_owned();
        faults.add(span, message, help);
    }
    first_beyond.is_some()
}

/// Refuses a number of tasks above the maximum: the data of all tasks must fit into memory.
fn bound_tasks(
    cases: &[Case],
    realizations: Realizations,
    at: Option<&Range<usize>>,
    faults: &mut Faults<'_>,
) {
    let most = realizations.most();
    let mut surfaces: HashSet<String> = HashSet::new();
    let mut tasks = 0;
    for Case { params: CaseParams { surface, .. }, .. } in cases {
        let count = u64::from(surface.scan_count().unwrap_or(most));
        tasks += count * if surfaces.insert(format!("{surface:?}")) { 3 } else { 1 };
    }
    if tasks > MAX_TASKS {
        let message = format!(
            "{} cases x {most} realizations make {tasks} tasks (cycles, and two for each surface): at most \
             {MAX_TASKS} are allowed",
            cases.len()
        );
        faults.add(
            at.unwrap_or(&(0..0)),
            message,
            "reduce `realizations`, or split the sweeps into several specs".to_owned(),
        );
    }
}

/// Every point of the grid of a sweep: the place of the value of each group of axes. The last group runs
/// fastest. One empty point if there is no axis.
fn points(sweep: &SweepDraft) -> impl Iterator<Item = Vec<usize>> {
    let counts: Vec<usize> = sweep.counts().collect();
    (0..counts.iter().product()).map(move |number: usize| {
        let mut rest = number;
        let mut point: Vec<usize> = Vec::with_capacity(counts.len());
        for count in counts.iter().rev() {
            point.push(rest % count);
            rest /= count;
        }
        point.reverse();
        point
    })
}

/// Sets the defaults that depend on another value: of a periodic surface the mean alone is removed, since a
/// plane breaks its periodicity; a probe is on a half-space.
fn complete(values: &mut Values, origins: &[Origin]) {
    let unwritten = |key: usize| matches!(origins[key], Origin::Default);
    if values.measured.periodic && find("surface", "detrend").is_some_and(unwritten) {
        values.measured.detrend = Detrend::Mean;
    }
    let is_on_half_space = values.radius_m.is_some() && values.thickness_m.is_none();
    if is_on_half_space && find("machine", "compliance").is_some_and(unwritten) {
        values.machine.far_field = FarField::HalfSpace;
    }
}

/// The cases of a case on coarser grids, with shifted copies of the coarsest one; none where a sweep sets the
/// grid, and for asperities.
fn on_coarser(
    grids: &[Coarser],
    values: &Values,
    (origins, swept): (&[Origin], &[usize]),
    faults: &mut Faults<'_>,
) -> Vec<CaseParams> {
    let [points, number] = coarser::LISTS.map(coarser::place);
    let key = if values.elements.per_wavelength.is_some() { number } else { points };
    let is_swept = [points, number].iter().flatten().any(|key| swept.contains(key));
    let Some(key) = key.filter(|_| !is_swept) else { return Vec::new() };
    let mut found = Vec::new();
    // A case with a fault has no others.
    let grids = if faults.count() == 0 { grids } else { &[] };
    for (points, span) in grids {
        let (mut values, mut origins) = (values.clone(), origins.to_vec());
        (KEYS[key].set)(&mut values, &Value::Count(*points));
        origins[key] = Origin::Written(span.clone());
        let params = values.case();
        if let Some(options) = params.elements() {
            check_elements(&params, options, &values, &origins, faults);
            found.push(params);
        }
    }
    let copies = found.first().map(|coarsest| coarser::copies(coarsest, values.goal.shifted_copies));
    found.extend(copies.into_iter().flatten());
    found
}

/// Checks what depends on two values of a case.
fn check(case: &CaseParams, values: &Values, written: (&[Origin], &[usize]), faults: &mut Faults<'_>) {
    check_contact(case, values, written.0, faults);
    if let Some(options) = case.elements() {
        check_elements(case, options, values, written.0, faults);
    }
    match &case.surface {
        SurfaceSource::Generated(surface) => {
            check_generated(surface, written.0, faults);
            check_spectrum(surface, written, faults);
        }
        SurfaceSource::Measured(surface) => check_measured(case, surface, written, faults),
    }
}

/// Checks the requirements of a generated surface.
fn check_generated(surface: &GeneratedSurface, origins: &[Origin], faults: &mut Faults<'_>) {
    if !surface.is_tabulated()
        && surface.rms_height_m >= surface.length_m
        && let Some(span) = blamed(&["rms_height_m", "length_m"], origins)
    {
        let (height, length) = (short(surface.rms_height_m), short(surface.length_m));
        let message =
            format!("`surface.rms_height_m`, {height} m, must be less than `surface.length_m`, {length} m");
        faults.add(&span, message, "both are in metres".to_owned());
    }
    let grid = surface.grid();
    let (zeta, points) = (surface.magnification, surface.points_per_shortest_wavelength);
    let made = || format!("{zeta} times {points} points make a grid of {grid} x {grid} points");
    let keys = ["magnification", "points_per_shortest_wavelength"];
    if grid > u64::from(MAX_GRID)
        && let Some(span) = blamed(&keys, origins)
    {
        let message = format!("{}: at most {MAX_GRID} x {MAX_GRID} are allowed", made());
        let help = "reduce `magnification` or `points_per_shortest_wavelength`".to_owned();
        faults.add(&span, message, help);
    } else if !grid.is_multiple_of(2)
        && let Some(span) = blamed(&keys, origins)
    {
        let message = format!("{}: their number along a side must be even", made());
        let help =
            "choose an even product of `magnification` and `points_per_shortest_wavelength`".to_owned();
        faults.add(&span, message, help);
    }
}

/// A sweep as written in the spec.
fn sweep(draft: &SweepDraft) -> Sweep {
    let axis = |axis: &AxisDraft| Axis {
        key: KEYS[axis.key].path,
        values: axis.values.iter().map(|value| value.get_ref().clone()).collect(),
    };
    let path = |place: &usize| KEYS[draft.axes[*place].key].path;
    let zip = draft.together.iter().filter(|group| group.len() > 1);
    Sweep {
        name: draft.name.clone(),
        zip: zip.map(|group| group.iter().map(path).collect()).collect(),
        axes: draft.axes.iter().map(axis).collect(),
    }
}
