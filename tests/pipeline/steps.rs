//! Tables of steps and events made by hand, and cases around them, for the tests of statistics and figures.

use std::path::{Path, PathBuf};

use hysteron::physics::cycle::soundness::LoopEnergy;
use hysteron::schema::{EVENTS, EventCounts, STEPS, Table};
use hysteron::stats::{CaseInput, CycleInput, Given, Value};
use hysteron::store::parquet::{read_table, write_table};
use hysteron::store::{Frame, FrameBuilder};

/// One step: branch, max_load, load, area, penetration, work_j.
pub type Step = (&'static str, Option<f64>, f64, f64, f64, f64);

/// E* A0 of every synthetic case \[N\].
pub const FORCE_N: f64 = 1.0;
/// E* A0 h_rms of every synthetic case \[J\].
pub const ENERGY_J: f64 = 5e-6;

/// One event: step, branch, max_load, kind ("KIND by CAUSE" if another one causes it), avalanche, then [load before, load after, area before, area after, energy lost].
pub type Event = (i64, &'static str, Option<f64>, &'static str, i64, [f64; 5]);

/// Cases and their cycles, and the folder of their tables.
pub struct Bench {
    pub directory: tempfile::TempDir,
    pub cases: Vec<CaseInput>,
    pub cycles: Vec<CycleInput>,
}

/// Where the events of a table of steps are.
pub fn events_path(steps: &Path) -> PathBuf {
    steps.with_extension("events.parquet")
}

/// A table of a cycle with the columns that identify it.
fn named(table: &'static Table, rows: usize) -> FrameBuilder {
    Frame::of(table).text("cycle_id", vec!["a-cycle"; rows]).text("case_id", vec!["a-case"; rows]).i64("realization", vec![0; rows])
}

/// Writes the table of events that belongs to a table of steps.
pub fn write_events(steps: &Path, events: &[Event]) {
    let reals = |at: usize| events.iter().map(move |event| event.5[at]);
    let words = |event: &Event| event.3.split_once(" by ").unwrap_or((event.3, event.3));
    let frame = named(&EVENTS, events.len())
        .i64("step", events.iter().map(|event| event.0))
        .text("branch", events.iter().map(|event| event.1))
        .f64("max_load", events.iter().map(|event| event.2))
        .text("kind", events.iter().map(|event| words(event).0))
        .i64("asperity_id", vec![7; events.len()])
        .f64("approach_m", events.iter().map(|event| 1e-8 * event.0 as f64))
        .i64("avalanche_id", events.iter().map(|event| event.4))
        .f64("load_before_n", reals(0))
        .f64("load_after_n", reals(1))
        .f64("area_before_m2", reals(2))
        .f64("area_after_m2", reals(3))
        .f64("energy_lost_j", reals(4))
        .text("method", vec!["asperities"; events.len()])
        .text("status", vec!["contact"; events.len()])
        .text("cause", events.iter().map(|event| words(event).1))
        .build()
        .unwrap();
    write_table(&events_path(steps), &frame, &[]).unwrap();
}

/// Writes a table of steps, and beside it one of events without rows.
pub fn write(path: &Path, steps: &[Step]) {
    write_counts(path, steps, [19, 1, 1]);
}

/// The same with the numbers of contacts, of absorbed asperities, and of contacts that overlap a neighbour.
pub fn write_counts(path: &Path, steps: &[Step], [contacts, covered, touching]: [usize; 3]) {
    let reals = |value: fn(&Step) -> f64| steps.iter().map(value).collect::<Vec<f64>>();
    let zeros = || vec![0_usize; steps.len()];
    // A load reverses at the first loading step that reaches it.
    let mut reversals = vec![None; steps.len()];
    for load in steps.iter().filter_map(|step| step.1) {
        if let Some(at) = steps.iter().position(|step| step.1.is_none() && step.2 >= load * (1.0 - 1e-6)) {
            reversals[at] = Some(load);
        }
    }
    let frame = named(&STEPS, steps.len())
        .count("step", 0..steps.len())
        .text("branch", steps.iter().map(|step| step.0))
        .f64("max_load", steps.iter().map(|step| step.1))
        .f64("approach_m", reals(|step| step.4 * 5e-6))
        .f64("load_n", reals(|step| step.2 * FORCE_N))
        .f64("least_load_n", reals(|step| step.2 * FORCE_N))
        .f64("area_m2", reals(|step| step.3 * 1e-6))
        .f64("area_union_m2", reals(|step| step.3 * 0.9e-6))
        .count("contact_count", vec![contacts; steps.len()])
        .count("covered_count", vec![covered; steps.len()])
        .counts(vec![EventCounts::default(); steps.len()])
        .count("held_count", (0..steps.len()).map(|row| usize::from(row == 1)))
        .count("touching_count", vec![touching; steps.len()])
        .f64("dissipated_j", reals(|step| if step.0 == "loading" { 1e-10 } else { 2e-10 }))
        .f64("work_j", reals(|step| step.5))
        .f64("residual_m", vec![1e-15; steps.len()])
        .f64("drift_m", vec![0.0; steps.len()])
        .f64("stability", vec![1.0; steps.len()])
        .bool("converged", (0..steps.len()).map(|row| row != 3))
        .count("iteration_count", zeros())
        .count("pair_evaluation_count", zeros())
        .count("product_count", zeros())
        .count("transform_count", zeros())
        .f64("load", reals(|step| step.2))
        .f64("area", reals(|step| step.3))
        .f64("penetration", reals(|step| step.4))
        .text("method", vec!["asperities"; steps.len()])
        .f64("residual", vec![None; steps.len()])
        .f64("stiffness_n_m", vec![None; steps.len()])
        .f64("stiffness", vec![None; steps.len()])
        .f64("reversal_load", reversals)
        .f64("machine_displacement_m", vec![None; steps.len()])
        .build()
        .unwrap();
    write_table(path, &frame, &[]).unwrap();
    write_events(path, &[]);
}

fn given(columns: &[(&str, Value)]) -> Given {
    columns.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect()
}

/// A case with the paper's material.
pub fn case(id: &str, sweep: &str, hurst: f64, magnification: f64, max_loads: &[f64]) -> CaseInput {
    CaseInput {
        case_id: id.to_owned(),
        sweep: sweep.to_owned(),
        family: None,
        is_coarser_grid: false,
        is_shifted_copy: false,
        parameters: given(&[
            ("hurst", hurst.into()),
            ("magnification", magnification.into()),
            ("length_m", 1e-3.into()),
            ("rms_height_m", 5e-6.into()),
            ("points_per_shortest_wavelength", 8.0.into()),
            ("normalization", "sample".into()),
            ("amplitudes", "fixed".into()),
            ("contact_modulus_pa", 1e6.into()),
            ("work_of_adhesion_j_m2", 0.07.into()),
            ("interaction_range_m", 1e-9.into()),
            ("interaction", "spots".into()),
            ("boundary", "periodic".into()),
            ("machine_compliance_m_n", 0.0.into()),
            ("far_field", "cell".into()),
            ("control", "displacement".into()),
            ("coalescence", "cover".into()),
            ("jump_in", "wu".into()),
            ("as_printed", "".into()),
            ("approach_step", 0.01.into()),
            ("method", "asperities".into()),
        ]),
        max_loads: max_loads.to_vec(),
        load_unit: "1",
        precision: None,
        grid_error_goal: None,
        planned_count: 6,
        failed_count: 0,
        surfaces: Vec::new(),
    }
}

/// Columns of a load reversal.
fn at_load(steps: &Path, load: f64) -> Given {
    let mut columns = given(&[("area_adhesionless", (5.0 * load).into()), ("area_adhesionless_small", (6.0 * load).into())]);
    columns.extend(resolution_j(steps, load).map(|resolution_j| ("resolution_j".to_owned(), resolution_j.into())));
    columns
}

/// Resolution of Θ by the rule of the stage `cycle`; nothing for a load that does not reverse.
fn resolution_j(steps: &Path, max_load: f64) -> Option<f64> {
    let frame = read_table(steps, &STEPS).unwrap();
    let (works, lost) = (frame.f64("work_j").unwrap(), frame.f64("dissipated_j").unwrap());
    let (loads, reversals) = (frame.f64_or_null("max_load").unwrap(), frame.f64_or_null("reversal_load").unwrap());
    let turning = reversals.iter().position(|load| *load == Some(max_load))?;
    let unloading: Vec<usize> = (0..works.len()).filter(|row| loads[*row] == Some(max_load)).collect();
    let loss_j = works[turning] + works[*unloading.last()?];
    let events_j = (0..=turning).chain(unloading.iter().copied()).map(|row| lost[row]).sum();
    let on_unloading = unloading.iter().map(|row| works[turning] + works[*row]);
    let work_j = works[..=turning].iter().copied().chain(on_unloading).map(f64::abs).fold(0.0, f64::max);
    Some(LoopEnergy { loss_j, events_j, work_j }.resolution_j())
}

/// A finished cycle of a case.
pub fn cycle(case_id: &str, realization: i64, steps: &Path, dk_per_area_j: f64) -> CycleInput {
    CycleInput {
        case_id: case_id.to_owned(),
        realization,
        cycle_id: format!("{case_id}-cycle-{realization}"),
        surface_id: format!("surface-{realization}"),
        steps: steps.to_owned(),
        events: events_path(steps),
        energy_scale_j: ENERGY_J,
        loss_dk_per_area_j: Some(dk_per_area_j),
        loss_dk_realised_per_area_j: Some(0.93 * dk_per_area_j),
        loss_dk_probe_per_area_j: None,
        loss_dk_probe_realised_per_area_j: None,
        loss_dalvi_per_area_j: 3.0 * dk_per_area_j,
        loss_pinning_per_area_j: None,
        at_max_load: [0.002, 0.004, 0.0071, 0.012, 0.015].map(|load| (load, at_load(steps, load))).to_vec(),
        surface: given(&[
            ("nominal_area_m2", 1e-6.into()),
            ("summit_count", Value::Whole(4000)),
            ("summit_density_1_m2", 4e9.into()),
            ("nayak_density_1_m2", 4.1e9.into()),
            ("tabor_min", 20.0.into()),
            ("tabor_median", 60.0.into()),
            ("tabor_max", 400.0.into()),
            ("tabor_mean", 70.0.into()),
            ("low_tabor_share", 0.0.into()),
            ("conformity", 1.5.into()),
            ("conformity_realised", 1.25.into()),
            ("persson_tosatti", 8.0.into()),
            ("persson_tosatti_realised", 6.0.into()),
            ("rms_slope", 0.3.into()),
            ("rms_curvature_1_m", 1e5.into()),
            ("nayak_parameter", 10.0.into()),
        ]),
    }
}

/// A cycle that looks like one of the paper's: a rising, sawtoothed loading branch, and from each turning point an unloading branch with
/// the given pull-off and loss.
pub fn realistic(path: &Path, max_loads: &[f64], area: f64, pull_off: f64, loss: f64, depth: f64) {
    let greatest = max_loads.iter().copied().fold(0.0, f64::max);
    let mut steps: Vec<Step> = vec![("loading", None, 0.0, 0.0, 0.0, 0.0)];
    let at = |load: f64| {
        let share = load / greatest;
        (area * share.powf(0.92), depth * share.powf(0.42))
    };
    for row in 1..=200 {
        let wanted = greatest * (f64::from(row) / 200.0).powf(1.6);
        let previous = greatest * (f64::from(row - 1) / 200.0).powf(1.6);
        for turning in max_loads.iter().filter(|load| previous < **load && **load <= wanted) {
            let (area, depth) = at(*turning);
            steps.push(("loading", None, *turning, area, depth, loss * 3.0 * ENERGY_J * (turning / greatest)));
        }
        let (area, depth) = at(wanted);
        let tooth = 0.03 * pull_off * f64::from(row % 7) - if row < 12 { 0.25 * pull_off } else { 0.0 };
        steps.push(("loading", None, wanted - tooth, area, depth, 0.0));
    }
    for turning in max_loads {
        let (area, depth) = at(*turning);
        let share = turning / greatest;
        for row in (0..160).rev() {
            let rest = f64::from(row) / 160.0;
            let load = (turning + pull_off) * rest.powf(1.7) - pull_off * (rest / 0.02).min(1.0);
            let spread = area * (0.04 + 0.96 * rest.powf(1.05)) * (rest / 0.02).min(1.0);
            let work = -loss * 2.0 * ENERGY_J * share;
            steps.push(("unloading", Some(*turning), load, spread, depth * (rest.powf(0.45) * 1.2 - 0.2), work));
        }
    }
    write(path, &steps);
}
