//! Checkpoints of another version of the program, and columns of events by their names.

use super::SMALL;
use crate::bench::{Bench, code, files, stderr};
use hysteron::campaign::{Campaign, CycleUnit};
use hysteron::model::Slips;
use hysteron::physics::EventKind;
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Checkpoint, Settings};
use hysteron::physics::cycle::Method;
use hysteron::physics::surface::summits::Summit;
use hysteron::schema::{ASPERITIES, EVENT_KINDS, EVENTS, STEPS};
use hysteron::spec::Spec;
use hysteron::store::parquet::read_table;
use hysteron::store::{CHECKPOINT_VERSION, write_halfway};
use std::collections::{BTreeMap, BTreeSet};

/// A checkpoint of a cycle, as a cycle of more asperities has them.
fn checkpoint(campaign: &Campaign, unit: &CycleUnit) -> Vec<u8> {
    let params = &campaign.cases[unit.case].case.params;
    let frame = read_table(&campaign.asperities_path(&campaign.surfaces[unit.surface]), &ASPERITIES).unwrap();
    let column = |name: &str| frame.f64(name).unwrap();
    let (x, y, z) = (column("x_m"), column("y_m"), column("height_m"));
    let (mean, min, max) = (column("curvature_1_m"), column("curvature_min_1_m"), column("curvature_max_1_m"));
    let summit = |i: usize| Summit {
        x_m: x[i],
        y_m: y[i],
        height_m: z[i],
        curvature_1_m: mean[i],
        curvature_min_1_m: min[i],
        curvature_max_1_m: max[i],
        grid_row: 0,
        grid_col: 0,
        refined: true,
    };
    let summits: Vec<Summit> = (0..frame.row_count()).map(summit).collect();
    let (model, surface) = (params.asperities().unwrap(), params.surface.generated().unwrap());
    let rules = Rules {
        interaction: model.interaction,
        boundary: model.boundary,
        coalescence: model.coalescence,
        jump_in: model.jump_in,
        allow_low_tabor: model.allow_low_tabor,
        slips: Slips::NONE,
    };
    let problem = Problem::new(&summits, surface.length_m, surface.rms_height_m, params.material, rules).unwrap();
    let (max_loads, approach_step) = (params.cycle.max_load.clone(), model.approach_step);
    let settings = Settings { max_loads, approach_step, contacts: params.cycle.contacts, rest_every: Some(0.1) };
    let mut kept = Vec::new();
    let mut keep = |checkpoint: &Checkpoint| kept.push(postcard::to_stdvec(checkpoint).unwrap());
    Asperities { problem, settings }.run_from(None, &mut keep, &|_| {}).unwrap();
    kept.swap_remove(kept.len() / 2)
}

#[test]
fn e2e_a_checkpoint_of_another_version_restarts_the_task() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
    let whole = files(&bench.out());
    let campaign = Campaign::new(Spec::read(bench.spec()).unwrap(), bench.out());
    let unit = &campaign.cycles[0];
    let (path, bytes) = (campaign.halfway_path(unit), checkpoint(&campaign, unit));
    let again = |what: &str| {
        std::fs::remove_file(campaign.cycle_dir(unit).join("steps.parquet")).unwrap();
        let run = bench.verb("run", &["--until", "cycle"]);
        assert_eq!(code(&run), 0, "{what}: {}", stderr(&run));
        assert!(!path.exists(), "{what}: a finished task leaves no checkpoint");
        files(&bench.out()) == whole
    };
    // Continued from the checkpoint, the path is predicted again at that place: the last digits differ.
    write_halfway(&path, &unit.key, &bytes).unwrap();
    assert!(!again("this version"), "the checkpoint is not used");
    // The hash of version 0.1.0 is that of the bytes, those of later versions include the version.
    let earlier = blake3::hash(&bytes);
    let others = [0, CHECKPOINT_VERSION - 1, CHECKPOINT_VERSION + 1]
        .map(|version| blake3::Hasher::new().update(&[version]).update(&bytes).finalize());
    for hash in [earlier].into_iter().chain(others) {
        std::fs::write(&path, [unit.key.as_bytes(), hash.to_hex().as_bytes(), &bytes].concat()).unwrap();
        assert!(again("another version"), "{hash}: a checkpoint of another version is used");
    }
}

/// The counts of a step are by position, the columns by name.
#[test]
fn law_kinds_of_events_have_one_order() {
    assert_eq!(EventKind::ALL.map(EventKind::word), EVENT_KINDS);
    let spec = SMALL.replace("[0.001]", "[0.004]").replace("magnification = 6", "magnification = 16");
    let bench = Bench::new(&(spec + "[[sweep]]\nname = \"coalescence\"\nmodel.coalescence = [\"cover\", \"merge\"]\n"));
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
    let mut seen = BTreeSet::new();
    for cycle in std::fs::read_dir(bench.out().join("cycles")).unwrap() {
        let folder = cycle.unwrap().path();
        let [steps, events] = [&STEPS, &EVENTS].map(|table| read_table(&folder.join(format!("{}.parquet", table.name)), table).unwrap());
        let mut listed: BTreeMap<(i64, &str), i64> = BTreeMap::new();
        for (step, kind) in events.i64("step").unwrap().iter().zip(events.text("kind").unwrap()) {
            *listed.entry((*step, kind)).or_default() += 1;
        }
        for kind in EVENT_KINDS {
            for (step, counted) in steps.i64("step").unwrap().iter().zip(steps.i64(&format!("{kind}_count")).unwrap()) {
                assert_eq!(counted, listed.get(&(*step, kind)).copied().unwrap_or(0), "{kind} at step {step} in {}", folder.display());
            }
        }
        seen.extend(listed.keys().map(|(_, kind)| (*kind).to_owned()));
    }
    let wanted = ["cover", "jump_in", "jump_off", "merge", "split", "uncover"];
    assert!(wanted.iter().all(|kind| seen.contains(*kind)), "{seen:?}");
}
