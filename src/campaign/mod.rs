//! Tasks of a spec, and their status.
//!
//! The status of tasks is derived from receipts and files and never stored: see [`Standing`].

mod audit;
mod changes;
mod compare;
mod hashed;
mod key_inputs;
mod layout;
mod leftover;
mod lost;
pub mod owned;
mod shard;
mod sources;
mod standing;

pub use audit::Audit;
pub use changes::Reasons;
pub use compare::{Difference, Explanation};
pub(crate) use key_inputs::{ELEMENTS_VERSION, asperities_version};
pub use leftover::Leftover;
pub use shard::Shard;
pub use sources::with_recorded_files;
pub use standing::{Standing, Survey};

use crate::keys::short;
use crate::model::SurfaceSource;
use crate::spec::{Case, Spec};
use hashed::Hashed;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::PathBuf;

/// The stages, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Surfaces.
    Generate,
    /// Asperity tables.
    Extract,
    /// Loading and unloading.
    Cycle,
    /// Tables over realizations.
    Aggregate,
    /// Figures and a page.
    Report,
}

impl Stage {
    /// All stages.
    pub const ALL: [Self; 5] = [Self::Generate, Self::Extract, Self::Cycle, Self::Aggregate, Self::Report];

    /// Name of the command.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Generate => "generate",
            Self::Extract => "extract",
            Self::Cycle => "cycle",
            Self::Aggregate => "aggregate",
            Self::Report => "report",
        }
    }

    /// Version of the stage in its keys. It is raised by hand if the stage writes something else for the same
    /// parameters.
    fn version(self) -> u32 {
        match self {
            Self::Generate => 2,
            // 3: estimates of the surface.
            Self::Extract => 3,
            // 18: status and cause of each event, estimates of the cycle.
            Self::Cycle => 18,
            // 15: events of all cycles in one table.
            Self::Aggregate => 15,
            Self::Report => 18,
        }
    }
}

/// One surface of one realisation, with its asperities.
#[derive(Debug, Clone)]
pub struct SurfaceUnit {
    /// Readable first, then the key's first digits.
    pub id: String,
    /// Key of the surface.
    pub key: String,
    /// Key of the asperity table.
    pub asperities_key: String,
    /// Parameters of the surface.
    pub params: SurfaceSource,
    /// Number of the realisation, which is 0 of a scan: it is the same surface in each case.
    pub realization: u32,
}

/// One cycle: a case on one surface.
#[derive(Debug, Clone)]
pub struct CycleUnit {
    /// Readable first, then the key's first digits.
    pub id: String,
    /// Key of its tables.
    pub key: String,
    /// Which case, by place in [`Campaign::cases`].
    pub case: usize,
    /// Which surface, by place in [`Campaign::surfaces`].
    pub surface: usize,
    /// Number of the realization in its case.
    pub realization: u32,
    /// Case in the tables of the cycle: without the errata that only analytical estimates read, and of
    /// several scans that of this scan alone.
    pub table_case_id: String,
}

/// A case with its identity.
#[derive(Debug, Clone)]
pub struct CaseUnit {
    /// Readable first, then a hash of all its parameters.
    pub id: String,
    /// The case.
    pub case: Case,
}

/// A spec in its folder: all units, by stage.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// The spec.
    pub spec: Spec,
    /// The output folder.
    pub dir: PathBuf,
    /// Cases.
    pub cases: Vec<CaseUnit>,
    /// Number of realizations of each case, as far as known.
    pub counts: Vec<u32>,
    /// Surfaces, each once however many cases share it.
    pub surfaces: Vec<SurfaceUnit>,
    /// Cycles, by case and realization. Cases with the same input of the cycle share it: their tasks have one
    /// key and one id.
    pub cycles: Vec<CycleUnit>,
    /// Labels of the files of measured surfaces, by their names in the spec.
    labels: BTreeMap<String, String>,
}

/// Identity of a task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unit<'a> {
    /// Stage.
    pub stage: Stage,
    /// Id.
    pub id: &'a str,
    /// Key.
    pub key: &'a str,
}

impl SurfaceUnit {
    /// The surface.
    #[must_use]
    pub fn surface(&self) -> Unit<'_> {
        Unit { stage: Stage::Generate, id: &self.id, key: &self.key }
    }

    /// Asperities.
    #[must_use]
    pub fn asperities(&self) -> Unit<'_> {
        Unit { stage: Stage::Extract, id: &self.id, key: &self.asperities_key }
    }
}

impl CycleUnit {
    /// The cycle.
    #[must_use]
    pub fn cycle(&self) -> Unit<'_> {
        Unit { stage: Stage::Cycle, id: &self.id, key: &self.key }
    }
}

/// The id of the tables over realizations.
pub const STATISTICS: &str = "statistics";
/// The id of the page.
pub const REPORT_PAGE: &str = "report";

impl Campaign {
    /// All tasks of a spec. With a target precision: the tasks of the initial realizations.
    #[must_use]
    pub fn new(spec: Spec, dir: PathBuf) -> Self {
        // Each scan of a measured surface is one surface.
        let count = |case: &Case| case.params.surface.scan_count().unwrap_or(spec.realizations.least());
        let counts = spec.cases.iter().map(count).collect();
        Self::with_counts(spec, dir, counts)
    }

    /// Numbers of cases by the asperity model and by boundary elements.
    #[must_use]
    pub fn case_counts(&self) -> [usize; 2] {
        let elements = self.shown_cases().filter(|unit| unit.case.params.elements().is_some()).count();
        [self.shown_cases().count() - elements, elements]
    }

    /// Tasks of a spec with the given number of realizations of each case.
    #[must_use]
    pub fn with_counts(spec: Spec, dir: PathBuf, counts: Vec<u32>) -> Self {
        let labels = sources::labels(&spec);
        let mut campaign =
            Self { dir, cases: Vec::new(), surfaces: Vec::new(), cycles: Vec::new(), labels, counts, spec };
        let hashed = Hashed::all(&campaign.spec, &campaign.counts);
        // Of each key of a surface, its place: cases share surfaces, and scans.
        let mut places: HashMap<&str, usize> = HashMap::new();
        // Files of different names with the same content have the same cycles: one key, one id.
        let mut ids: HashMap<&str, String> = HashMap::new();
        for (number, (case, of)) in campaign.spec.cases.iter().zip(&hashed.cases).enumerate() {
            let id = format!("{}-{}", of.name, short(&of.whole));
            campaign.cases.push(CaseUnit { id, case: case.clone() });
            for (place, cycle) in of.cycles.iter().enumerate() {
                let surface = &hashed.surfaces[of.surface][place];
                let params = &case.params.surface;
                let (realization, (name, in_cycle)) =
                    (place as u32, &of.in_cycles[place.min(of.in_cycles.len() - 1)]);
                let number_of_surface = if params.measured().is_some() { 0 } else { realization };
                let of_surface = *places.entry(surface.key.as_str()).or_insert_with(|| {
                    campaign.surfaces.push(SurfaceUnit {
                        id: format!("{name}_r{number_of_surface:02}-{}", short(&surface.key)),
                        asperities_key: surface.asperities_key.clone(),
                        key: surface.key.clone(),
                        params: params.of_realization(realization),
                        realization: number_of_surface,
                    });
                    campaign.surfaces.len() - 1
                });
                let id = || format!("{name}_r{number_of_surface:02}-{}", short(cycle));
                let id = ids.entry(cycle).or_insert_with(id).clone();
                campaign.cycles.push(CycleUnit {
                    id,
                    key: cycle.clone(),
                    case: number,
                    surface: of_surface,
                    realization,
                    table_case_id: format!("{name}-{}", short(in_cycle)),
                });
            }
        }
        let surfaces = campaign.surfaces.iter_mut().map(|unit| (&mut unit.id, unit.key.as_str())).collect();
        tell_apart(surfaces);
        tell_apart(campaign.cycles.iter_mut().map(|unit| (&mut unit.id, unit.key.as_str())).collect());
        campaign
    }

    /// Cases that are not only coarser grids of others.
    pub fn shown_cases(&self) -> impl Iterator<Item = &CaseUnit> {
        self.cases.iter().filter(|unit| !unit.case.is_coarser_grid())
    }

    /// True if a cycle is only a coarser grid of other cases.
    #[must_use]
    pub fn is_coarser_grid(&self, unit: &CycleUnit) -> bool {
        self.cases[unit.case].case.is_coarser_grid()
    }

    /// Name of a cycle in messages: its id, and the grid of a coarser one or of a shifted copy.
    #[must_use]
    pub fn name_of(&self, unit: &CycleUnit) -> String {
        let case = &self.cases[unit.case].case;
        let grid = case.params.elements().filter(|_| case.is_coarser_grid());
        grid.map_or_else(
            || unit.id.clone(),
            |of| format!("{} ({} of {})", unit.id, case.kind_of_grid(), of.grid_in_words()),
        )
    }

    /// Number of realizations of the cases, as in "6 realizations" or "6 to 14 realizations".
    #[must_use]
    pub fn realizations_in_words(&self) -> String {
        let shown = || self.cases.iter().zip(&self.counts).filter(|(unit, _)| !unit.case.is_coarser_grid());
        let counts = || shown().map(|(_, count)| count);
        match (counts().min(), counts().max()) {
            (Some(1), Some(1)) => "1 realization".to_owned(),
            (Some(least), Some(most)) if least < most => format!("{least} to {most} realizations"),
            (least, _) => format!("{} realizations", least.copied().unwrap_or_default()),
        }
    }

    /// The cycles to be computed: each once, however many cases share it.
    #[must_use]
    pub fn distinct_cycles(&self) -> Vec<CycleUnit> {
        self.distinct().0.into_iter().map(|place| self.cycles[place].clone()).collect()
    }

    /// The places of the different cycles among [`Self::cycles`]; and for each of these, which of the
    /// different ones it is.
    fn distinct(&self) -> (Vec<usize>, Vec<usize>) {
        let mut known: HashMap<&str, usize> = HashMap::with_capacity(self.cycles.len());
        let mut firsts = Vec::new();
        let which = self.cycles.iter().enumerate().map(|(place, unit)| {
            *known.entry(unit.key.as_str()).or_insert_with(|| {
                firsts.push(place);
                firsts.len() - 1
            })
        });
        let which = which.collect();
        (firsts, which)
    }
}

/// Ids end in the first digits of keys; where two keys share these, both ids end in as many again.
fn tell_apart(mut units: Vec<(&mut String, &str)>) {
    let mut first: HashMap<&str, &str> = HashMap::with_capacity(units.len());
    let mut shared: HashSet<String> = HashSet::new();
    for (id, key) in &units {
        if *first.entry(id.as_str()).or_insert(key) != *key {
            shared.insert((*id).clone());
        }
    }
    for (id, key) in units.iter_mut().filter(|(id, _)| shared.contains(*id)) {
        let more = key.get(short(key).len()..2 * short(key).len()).unwrap_or_default();
        id.push_str(more);
    }
}
