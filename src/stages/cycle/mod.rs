//! cycle: load and unload one case on one surface, and write every step.

mod apparent;
mod asperities;
mod constants;
mod deng_kesari;
mod elements;
mod estimates;
mod method;
mod not_reached;
mod tables;

pub(super) use asperities::Trial;
pub(super) use constants::{CONSTANTS, ESTIMATES};
pub(super) use elements::{Square, announced};
pub use method::unload_again;
pub(super) use method::{cost, lattice, refusal};

use super::done::Outcome;
use super::failure::in_the_way;
use super::identity::Identity;
use super::runner::{Context, Tasks};
use super::{StageError, Watch};
use crate::campaign::{Campaign, CycleUnit, Stage, Standing, SurfaceUnit, Unit};
use crate::model::Method as Kind;
use crate::physics::LoopPosition;
use crate::physics::cycle::{Cycle, Effort, Method};
use crate::physics::surface::summits::Summit;
use crate::physics::theory::approximate_jkr::CurvePoint;
use crate::spec::CaseParams;
use crate::store::commit::Written;
use crate::store::{Frame, parquet, read_halfway, write_halfway};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Minimum time between two checkpoints.
pub(super) const KEPT_FOR: Duration = Duration::from_secs(60);

/// Tasks of the stage cycle: one for each different cycle.
pub(super) struct Cycles<'a> {
    context: Context<'a>,
    units: Vec<CycleUnit>,
}

impl<'a> Cycles<'a> {
    pub(super) fn of(context: Context<'a>) -> Self {
        Self { context, units: context.campaign.distinct_cycles() }
    }

    fn surface(&self, of: &CycleUnit) -> &'a SurfaceUnit {
        &self.context.campaign.surfaces[of.surface]
    }
}

impl Tasks for Cycles<'_> {
    type Of = CycleUnit;

    const STAGE: Stage = Stage::Cycle;

    fn selected(&self) -> Vec<&CycleUnit> {
        self.units.iter().filter(|unit| self.context.task.shard.holds(unit.surface)).collect()
    }

    fn unit<'a>(&self, of: &'a CycleUnit) -> Unit<'a> {
        of.cycle()
    }

    fn key_inputs(&self, of: &CycleUnit) -> Map<String, Value> {
        self.context.campaign.cycle_preimages(of)
    }

    fn standing(&self, of: &CycleUnit) -> Standing {
        self.context.campaign.cycle_standing(of, self.context.task.check)
    }

    /// A failed cycle would fail again; it is tried if that is requested.
    fn is_given_up(&self, of: &CycleUnit, standing: &Standing) -> bool {
        let Context { campaign, task, .. } = self.context;
        let is_retried = || {
            task.retried.contains(&of.id) && campaign.failed_at(of).is_none_or(|stage| stage == Stage::Cycle)
        };
        matches!(standing, Standing::Failed(_)) && !is_retried()
    }

    fn input(&self, of: &CycleUnit) -> Option<(String, Standing)> {
        let surface = self.surface(of);
        Some((
            surface.id.clone(),
            self.context.campaign.standing(&surface.asperities(), self.context.task.check),
        ))
    }

    fn duration_rank(&self, of: &CycleUnit) -> (bool, u32) {
        let (method, surface) =
            (&self.context.campaign.cases[of.case].case.params.method, &self.surface(of).params);
        (method.kind() > Kind::Asperities, surface.generated().map_or(0, |surface| surface.magnification))
    }

    fn compute(&self, of: &CycleUnit) -> Result<Outcome, StageError> {
        in_the_way(self.context.campaign, &of.cycle()).and_then(|()| {
            let Context { campaign, watch, .. } = self.context;
            compute(CycleTask { campaign, unit: of, watch })
        })
    }

    fn cycles<'a>(&'a self, of: &'a CycleUnit) -> Vec<&'a CycleUnit> {
        vec![of]
    }

    fn clean_up(&self, of: &CycleUnit) {
        for left in [self.context.campaign.failure_path(of), self.context.campaign.halfway_path(of)] {
            let _ = std::fs::remove_file(left);
        }
    }
}

/// A cycle that is computed.
#[derive(Clone, Copy)]
struct CycleTask<'a> {
    campaign: &'a Campaign,
    unit: &'a CycleUnit,
    watch: &'a dyn Watch,
}

/// Result of a method: a cycle, further files of this method, the units of the dimensionless columns, and the
/// input of the estimates.
struct Computed {
    method: &'static str,
    /// Name and number of the unknowns.
    size: (&'static str, u64),
    cycle: Cycle<()>,
    tables: Vec<Frame>,
    files: Vec<Written>,
    load_unit_n: f64,
    area_m2: f64,
    rms_height_m: f64,
    summits: Vec<Summit>,
    /// Curve of the same surface without adhesion; empty for asperities.
    adhesionless: Vec<CurvePoint>,
    /// Grid points per cut-off wavelength; nothing for asperities.
    per_wavelength: Option<f64>,
}

impl<'a> CycleTask<'a> {
    fn params(self) -> &'a CaseParams {
        &self.campaign.cases[self.unit.case].case.params
    }

    /// Follows the cycle from its last checkpoint, if there is one.
    fn follow<M: Method>(self, method: &M) -> Result<Cycle<M::State>, StageError> {
        let progress = Progress::of(self.watch, &self.unit.id);
        let mut checkpoints = Checkpoints::of(self.campaign, self.unit, self.watch);
        let checkpoint = checkpoints.read();
        let outcome = method.run_from(checkpoint, &mut |at| checkpoints.keep(at), &|at| progress.reached(at));
        progress.end();
        Ok(outcome?)
    }
}

/// Computes a cycle and writes its tables.
fn compute(task: CycleTask<'_>) -> Result<Outcome, StageError> {
    let CycleTask { campaign, unit, watch } = task;
    let path = campaign.cycle_dir(unit);
    std::fs::create_dir_all(&path).map_err(|source| StageError::Folder { path, source })?;
    let mut computed = method::run(&task)?;
    let max_loads = &task.params().cycle.max_load;
    let of_all = tables::Tables { of: Identity::of(campaign, unit), computed: &computed, max_loads };
    let mut files = write_tables(
        campaign,
        unit,
        &[of_all.contacts()?, of_all.events()?, of_all.steps()?, estimates::table(task, &computed)?],
    )?;
    files.extend(write_tables(campaign, unit, &computed.tables)?);
    files.append(&mut computed.files);
    let unreached = std::mem::take(&mut computed.cycle.unreached);
    let unreached: Vec<_> = unreached
        .into_iter()
        .map(|(at, error)| (max_loads[at], StageError::from(error).to_string()))
        .collect();
    files.extend(not_reached::record(campaign, unit, &unreached, watch)?);
    Ok(Outcome { files, effort: effort(&computed) })
}

/// Writes the tables of a cycle.
fn write_tables(campaign: &Campaign, unit: &CycleUnit, tables: &[Frame]) -> Result<Vec<Written>, StageError> {
    let (dir, keys) = (campaign.cycle_dir(unit), [("key", unit.key.clone())]);
    let write = |frame: &Frame| {
        Ok(parquet::write_table(&dir.join(format!("{}.parquet", frame.table().name)), frame, &keys)?)
    };
    tables.iter().map(write).collect()
}

/// Effort of a cycle, for its provenance record.
fn effort(computed: &Computed) -> Map<String, Value> {
    let Computed { cycle, size: (name, size), .. } = computed;
    let all = cycle.steps.iter().fold(Effort::default(), |mut sum, step| {
        sum += step.numerics.effort;
        sum
    });
    let counts = [
        (*name, *size),
        ("step_count", cycle.steps.len() as u64),
        ("event_count", cycle.events.len() as u64),
        ("iteration_count", all.iterations),
        ("pair_evaluation_count", all.pairs),
        ("product_count", all.products),
        ("transform_count", all.transforms),
    ];
    counts.into_iter().map(|(name, count)| (name.to_owned(), count.into())).collect()
}

/// Progress of a cycle, of which the watch is given the increments.
struct Progress<'a> {
    watch: &'a dyn Watch,
    id: &'a str,
    reached: Mutex<f64>,
}

impl<'a> Progress<'a> {
    fn of(watch: &'a dyn Watch, id: &'a str) -> Self {
        Self { watch, id, reached: Mutex::new(0.0) }
    }

    /// Reports the position on the loop.
    fn reached(&self, at: LoopPosition) {
        self.watch.position(self.id, &at);
        self.done(at.done);
    }

    /// Reports the finished part of the cycle, from 0 to 1.
    fn done(&self, done: f64) {
        let mut reached = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        let done = done.max(*reached);
        self.watch.progress(Stage::Cycle, done - *reached);
        *reached = done;
    }

    /// Reports the rest: a failed case leaves the bar as a finished one does.
    fn end(&self) {
        self.done(1.0);
    }
}

/// Checkpoints of a cycle.
struct Checkpoints<'a> {
    path: PathBuf,
    key: &'a str,
    id: &'a str,
    watch: &'a dyn Watch,
    kept_at: Instant,
}

impl<'a> Checkpoints<'a> {
    fn of(campaign: &Campaign, unit: &'a CycleUnit, watch: &'a dyn Watch) -> Self {
        Self {
            path: campaign.halfway_path(unit),
            key: &unit.key,
            id: &unit.id,
            watch,
            kept_at: Instant::now(),
        }
    }

    /// The last checkpoint; nothing if there is none of this cycle.
    fn read<T: DeserializeOwned>(&self) -> Option<T> {
        read_halfway(&self.path, self.key).and_then(|bytes| postcard::from_bytes(&bytes).ok())
    }

    /// Writes a checkpoint if the last one is old enough.
    fn keep<T: Serialize>(&mut self, state: &T) {
        if self.kept_at.elapsed() < KEPT_FOR {
            return;
        }
        self.kept_at = Instant::now();
        let kept = serialized(state).map_err(|error| error.to_string());
        if let Err(why) = kept
            .and_then(|bytes| write_halfway(&self.path, self.key, &bytes).map_err(|error| error.to_string()))
        {
            self.watch.notice(&format!(
                "{}: {why}; continuing without checkpoint, an interrupted cycle restarts",
                self.id
            ));
        }
    }
}

/// Bytes of a value, in memory of exactly their number.
fn serialized<T: Serialize>(value: &T) -> Result<Vec<u8>, postcard::Error> {
    let bytes = Vec::with_capacity(postcard::experimental::serialized_size(value)?);
    postcard::to_extend(value, bytes)
}
