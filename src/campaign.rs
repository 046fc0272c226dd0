//! The grid of units that a spec asks for, and what of it is done.
//!
//! What is done is derived from the files and never stored: a file is done if it can be opened and carries the key that the unit has now.

use crate::keys::{key, short};
use crate::spec::{Case, ModelParams, Spec, SurfaceParams};
use crate::store::{StoreError, hdf5, parquet, read_halfway};
use serde_json::{Value, json};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// A stage's meaning: raised by hand when what it writes changes for the same parameters.
const GENERATE: u32 = 1;
const EXTRACT: u32 = 1;
const CYCLE: u32 = 11;
const AGGREGATE: u32 = 2;
const REPORT: u32 = 3;

/// The stages, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
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

    /// The verb of the command line.
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
    /// What it is made from.
    pub params: SurfaceParams,
    /// Number of the realisation.
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
    /// Surfaces, each once however many cases share it.
    pub surfaces: Vec<SurfaceUnit>,
    /// Cycles, by case and realisation. Cases that differ only in what stands beside a cycle share it: their units have one key and one id.
    pub cycles: Vec<CycleUnit>,
}

/// Whether a unit's files are there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Standing {
    /// Done, with the present key.
    Done,
    /// Not there.
    Missing,
    /// There, but written for other parameters or by a stage of another meaning.
    Stale,
    /// There, but cannot be read: why.
    Damaged(String),
    /// It was tried, and failed: why.
    Failed(String),
    /// It has begun, and can go on from where it was kept last.
    Interrupted,
}

impl Campaign {
    /// All units of a spec.
    #[must_use]
    pub fn new(spec: Spec, dir: PathBuf) -> Self {
        let mut campaign = Self { dir, cases: Vec::new(), surfaces: Vec::new(), cycles: Vec::new(), spec };
        let mut known: HashMap<String, usize> = HashMap::new();
        for case in &campaign.spec.cases {
            let surface = &case.params.surface;
            let name = format!("H{:.2}_z{}", surface.hurst, surface.magnification);
            let whole = key("case", 1, &plain(&case.params));
            let number = campaign.cases.len();
            campaign.cases.push(CaseUnit { id: format!("{name}-{}", short(&whole)), case: case.clone() });
            for realization in 0..campaign.spec.realizations {
                let own = key(
                    "generate",
                    GENERATE,
                    &json!({ "surface": plain(surface), "seed": campaign.spec.seed, "realization": realization }),
                );
                let place = *known.entry(own.clone()).or_insert_with(|| {
                    campaign.surfaces.push(SurfaceUnit {
                        id: format!("{name}_r{realization:02}-{}", short(&own)),
                        asperities_key: key("extract", EXTRACT, &json!({ "surface": own })),
                        key: own,
                        params: surface.clone(),
                        realization,
                    });
                    campaign.surfaces.len() - 1
                });
                let reads = json!({
                    "asperities": campaign.surfaces[place].asperities_key,
                    "material": plain(&case.params.material),
                    "model": plain(&read_by_cycle(&case.params.model)),
                    "cycle": plain(&case.params.cycle),
                });
                let own = key("cycle", CYCLE, &reads);
                let id = format!("{name}_r{realization:02}-{}", short(&own));
                campaign.cycles.push(CycleUnit { id, key: own, case: number, surface: place });
            }
        }
        campaign
    }

    /// The cycles to be computed: each once, however many cases share it.
    #[must_use]
    pub fn distinct_cycles(&self) -> Vec<CycleUnit> {
        let mut known = HashSet::new();
        self.cycles.iter().filter(|unit| known.insert(unit.key.as_str())).cloned().collect()
    }

    /// `surfaces/<id>.h5`.
    #[must_use]
    pub fn surface_path(&self, unit: &SurfaceUnit) -> PathBuf {
        self.dir.join("surfaces").join(format!("{}.h5", unit.id))
    }

    /// `asperities/<id>.parquet`.
    #[must_use]
    pub fn asperities_path(&self, unit: &SurfaceUnit) -> PathBuf {
        self.dir.join("asperities").join(format!("{}.parquet", unit.id))
    }

    /// `cycles/<id>/`.
    #[must_use]
    pub fn cycle_dir(&self, unit: &CycleUnit) -> PathBuf {
        self.dir.join("cycles").join(&unit.id)
    }

    /// Where the failure of a cycle is recorded.
    #[must_use]
    pub fn failure_path(&self, unit: &CycleUnit) -> PathBuf {
        self.cycle_dir(unit).join("failed.json")
    }

    /// Where a cycle on its way is kept.
    #[must_use]
    pub fn halfway_path(&self, unit: &CycleUnit) -> PathBuf {
        self.cycle_dir(unit).join("halfway.bin")
    }

    /// `statistics/<table>.parquet`.
    #[must_use]
    pub fn statistics_path(&self, table: &str) -> PathBuf {
        self.dir.join("statistics").join(format!("{table}.parquet"))
    }

    /// Key of the tables over realisations: of the cycles that are in them.
    #[must_use]
    pub fn statistics_key(&self, finished: &[bool]) -> String {
        let cycles: Vec<Value> = self.cycles.iter().zip(finished).map(|(unit, done)| json!([unit.key, done])).collect();
        let cases: Vec<Value> = self.cases.iter().map(|unit| json!([unit.id, unit.case.sweeps])).collect();
        key("aggregate", AGGREGATE, &json!({ "cases": cases, "cycles": cycles }))
    }

    /// Key of the report.
    #[must_use]
    pub fn report_key(&self, statistics_key: &str) -> String {
        key("report", REPORT, &json!({ "name": self.spec.name, "statistics": statistics_key }))
    }

    /// Whether a surface is there.
    #[must_use]
    pub fn surface_standing(&self, unit: &SurfaceUnit) -> Standing {
        standing(&self.surface_path(unit), &unit.key, |path| hdf5::read_header(path).map(|header| Some(header.key)))
    }

    /// Whether an asperity table is there.
    #[must_use]
    pub fn asperities_standing(&self, unit: &SurfaceUnit) -> Standing {
        standing(&self.asperities_path(unit), &unit.asperities_key, parquet::read_key)
    }

    /// Whether all tables of a cycle are there.
    #[must_use]
    pub fn cycle_standing(&self, unit: &CycleUnit) -> Standing {
        let dir = self.cycle_dir(unit);
        let worst = ["steps", "contacts", "turning", "events"]
            .iter()
            .map(|table| standing(&dir.join(format!("{table}.parquet")), &unit.key, parquet::read_key))
            .find(|standing| *standing != Standing::Done);
        match worst {
            None => Standing::Done,
            Some(Standing::Missing) => match self.failure(unit) {
                Some(why) => Standing::Failed(why),
                None if read_halfway(&self.halfway_path(unit), &unit.key).is_some() => Standing::Interrupted,
                None => Standing::Missing,
            },
            Some(other) => other,
        }
    }

    /// The recorded failure of a cycle with the present key.
    fn failure(&self, unit: &CycleUnit) -> Option<String> {
        let text = std::fs::read_to_string(self.failure_path(unit)).ok()?;
        let record: Value = serde_json::from_str(&text).ok()?;
        (record.get("key")?.as_str()? == unit.key).then(|| record.get("error").and_then(Value::as_str).map(str::to_owned))?
    }

    /// Whether the tables over realisations are there, with this key.
    #[must_use]
    pub fn statistics_standing(&self, key: &str) -> Standing {
        ["realizations", "cases", "curves", "avalanches"]
            .iter()
            .map(|table| standing(&self.statistics_path(table), key, parquet::read_key))
            .find(|standing| *standing != Standing::Done)
            .unwrap_or(Standing::Done)
    }

    /// Whether the report is there, with this key.
    #[must_use]
    pub fn report_standing(&self, key: &str) -> Standing {
        match std::fs::read_to_string(self.dir.join("report.html")) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Standing::Missing,
            Err(error) => Standing::Damaged(error.to_string()),
            Ok(text) if text.contains(key) => Standing::Done,
            Ok(_) => Standing::Stale,
        }
    }
}

/// Of the model's choices what a cycle reads: all but the slips of the estimate beside it.
fn read_by_cycle(model: &ModelParams) -> ModelParams {
    let mut model = model.clone();
    model.as_printed.retain(|slip| slip.in_contact());
    model
}

/// A parameter set as JSON; a number that JSON cannot hold is refused by the spec long before.
fn plain(value: &impl serde::Serialize) -> Value {
    serde_json::to_value(value).unwrap_or(Value::Null)
}

fn standing(path: &Path, key: &str, read: impl Fn(&Path) -> Result<Option<String>, StoreError>) -> Standing {
    if !path.exists() {
        return Standing::Missing;
    }
    match read(path) {
        Ok(Some(found)) if found == key => Standing::Done,
        Ok(_) => Standing::Stale,
        Err(error) => Standing::Damaged(error.to_string()),
    }
}
