//! The grid of units that a spec asks for, and what of it is done.
//!
//! What is done is derived from receipts and files and never stored: see [`Standing`].

mod audit;
mod compare;
mod hashed;
mod leftover;
mod lost;
mod shard;
mod standing;

pub use audit::Audit;
pub use compare::{Difference, Explanation};
pub use leftover::Leftover;
pub use shard::Shard;
pub use standing::{Standing, Survey};

use crate::keys::{canonical, key, key_of_text, preimage, short};
use crate::spec::{Case, CaseParams, MEASURED, Spec, SurfaceParams};
use hashed::Hashed;
use serde_json::{Map, Value, json};
use std::collections::{HashMap, HashSet};
use std::path::{Component, Path, PathBuf};

/// A stage's meaning: raised by hand when what it writes changes for the same parameters.
const GENERATE: u32 = 2;
const EXTRACT: u32 = 2;
const CYCLE: u32 = 14;
const AGGREGATE: u32 = 9;
const REPORT: u32 = 12;

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
    /// Parameters of the surface.
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
    /// Id in the tables of its cycles: that of the case without the errata that only analytical estimates read.
    pub cycle_case_id: String,
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
    /// Cycles, by case and realisation. Cases that differ only in what stands beside a cycle share it: their units have one key and one id.
    pub cycles: Vec<CycleUnit>,
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
    /// All units of a spec; of one that asks for a precision, those that it begins with.
    #[must_use]
    pub fn new(spec: Spec, dir: PathBuf) -> Self {
        // A measured surface is one surface.
        let count = |case: &Case| if case.params.surface.is_measured() { 1 } else { spec.realizations.least() };
        let counts = spec.cases.iter().map(count).collect();
        Self::with_counts(spec, dir, counts)
    }

    /// The units of a spec with so many realizations of each case.
    #[must_use]
    pub fn with_counts(spec: Spec, dir: PathBuf, counts: Vec<u32>) -> Self {
        let mut campaign = Self { dir, cases: Vec::new(), surfaces: Vec::new(), cycles: Vec::new(), counts, spec };
        let hashed = Hashed::all(&campaign.spec, &campaign.counts);
        // Of each kind of surface, the places of its realizations.
        let mut places: Vec<Vec<usize>> = vec![Vec::new(); hashed.surfaces.len()];
        // Files of different names with the same content have the same cycles: one key, one id.
        let mut ids: HashMap<String, String> = HashMap::new();
        for (number, (case, of)) in campaign.spec.cases.iter().zip(hashed.cases).enumerate() {
            let [id, cycle_case_id] = [&of.whole, &of.in_cycle].map(|key| format!("{}-{}", of.name, short(key)));
            campaign.cases.push(CaseUnit { id, cycle_case_id, case: case.clone() });
            let (known, surfaces) = (&mut places[of.surface], &hashed.surfaces[of.surface]);
            for (realization, cycle) in of.cycles.into_iter().enumerate() {
                if known.len() == realization {
                    let (key, asperities_key) = surfaces[realization].clone();
                    known.push(campaign.surfaces.len());
                    campaign.surfaces.push(SurfaceUnit {
                        id: format!("{}_r{realization:02}-{}", of.name, short(&key)),
                        asperities_key,
                        key,
                        params: case.params.surface.clone(),
                        realization: realization as u32,
                    });
                }
                let id = || format!("{}_r{realization:02}-{}", of.name, short(&cycle));
                let id = ids.entry(cycle.clone()).or_insert_with(id).clone();
                campaign.cycles.push(CycleUnit { id, key: cycle, case: number, surface: known[realization] });
            }
        }
        let surfaces = campaign.surfaces.iter_mut().map(|unit| (&mut unit.id, unit.key.as_str())).collect();
        tell_apart(surfaces);
        tell_apart(campaign.cycles.iter_mut().map(|unit| (&mut unit.id, unit.key.as_str())).collect());
        campaign
    }

    /// Number of realizations of the cases, as in "6 realizations" or "6 to 14 realizations".
    #[must_use]
    pub fn realizations_in_words(&self) -> String {
        match (self.counts.iter().min(), self.counts.iter().max()) {
            (Some(1), Some(1)) => "1 realization".to_owned(),
            (Some(least), Some(most)) if least < most => format!("{least} to {most} realizations"),
            (least, _) => format!("{} realizations", least.copied().unwrap_or_default()),
        }
    }

    /// What the file of a measured surface is called in tables: its name, and as many of the folders that it lies in as tell it from the others.
    #[must_use]
    pub fn file_label(&self, file: &str) -> String {
        let last = |of: &str, count: usize| -> PathBuf {
            let parts: Vec<Component<'_>> = Path::new(of).components().collect();
            parts[parts.len().saturating_sub(count)..].iter().collect()
        };
        let others = || self.spec.files.keys().filter(|other| *other != file);
        let most = Path::new(file).components().count().max(1);
        let count = (1..most).find(|count| others().all(|other| last(other, *count) != last(file, *count))).unwrap_or(most);
        last(file, count).to_string_lossy().into_owned()
    }

    /// The cycles to be computed: each once, however many cases share it.
    #[must_use]
    pub fn distinct_cycles(&self) -> Vec<CycleUnit> {
        self.distinct().0.into_iter().map(|place| self.cycles[place].clone()).collect()
    }

    /// The places of the different cycles among [`Self::cycles`]; and for each of these, which of the different ones it is.
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

    /// Path of the failure record of a cycle.
    #[must_use]
    pub fn failure_path(&self, unit: &CycleUnit) -> PathBuf {
        self.cycle_dir(unit).join("failed.json")
    }

    /// Path of the checkpoint of a cycle.
    #[must_use]
    pub fn halfway_path(&self, unit: &CycleUnit) -> PathBuf {
        self.cycle_dir(unit).join("halfway.bin")
    }

    /// `statistics/<table>.parquet`.
    #[must_use]
    pub fn statistics_path(&self, table: &str) -> PathBuf {
        self.dir.join("statistics").join(format!("{table}.parquet"))
    }

    /// Path of the provenance record of a task.
    #[must_use]
    pub fn receipt_path(&self, unit: &Unit<'_>) -> PathBuf {
        self.receipts_dir(unit.stage).join(format!("{}.json", unit.id))
    }

    /// Path of the provenance record of the resolved spec.
    #[must_use]
    pub fn spec_receipt_path(&self) -> PathBuf {
        self.dir.join("receipts").join("campaign.json")
    }

    /// `receipts/<stage>/`.
    #[must_use]
    pub fn receipts_dir(&self, stage: Stage) -> PathBuf {
        self.dir.join("receipts").join(stage.word())
    }

    /// What the key of the tables over realisations is made of: the cycles that are in them, and those that failed with their error messages; and the name,
    /// which their description has.
    fn statistics_reads(&self, cycles: &[Standing]) -> Value {
        let words = |(unit, standing): (&CycleUnit, &Standing)| match self.failure_in_tables(standing) {
            Some(failure) => json!([unit.key, state(standing), failure]),
            None => json!([unit.key, state(standing)]),
        };
        let cycles: Vec<Value> = self.cycles.iter().zip(cycles).map(words).collect();
        json!({ "name": self.spec.name, "cases": self.statistics_cases(), "cycles": cycles })
    }

    fn statistics_cases(&self) -> Value {
        let label = |case: &Case| case.params.surface.is_measured().then(|| self.file_label(&case.params.surface.file));
        let words = |unit: &CaseUnit| match label(&unit.case) {
            Some(label) => json!([unit.id, unit.case.sweeps, label]),
            None => json!([unit.id, unit.case.sweeps]),
        };
        self.cases.iter().map(words).collect()
    }

    /// Key of the tables over realisations, where the cycles stand so.
    #[must_use]
    pub fn statistics_key(&self, cycles: &[Standing]) -> String {
        // As many words as there are cycles: written as canonical JSON at once.
        let mut reads = format!("{{\"cases\":{},\"cycles\":[", canonical(&self.statistics_cases()));
        for (k, (unit, standing)) in self.cycles.iter().zip(cycles).enumerate() {
            let comma = if k > 0 { "," } else { "" };
            let failure = self.failure_in_tables(standing).map(|failure| format!(",{}", canonical(&json!(failure)))).unwrap_or_default();
            for part in [comma, "[\"", &unit.key, "\",\"", state(standing), "\"", &failure, "]"] {
                reads.push_str(part);
            }
        }
        reads = format!("{reads}],\"name\":\"{}\"}}", self.spec.name);
        key_of_text(Stage::Aggregate.word(), AGGREGATE, &reads)
    }

    /// What the report reads: the tables, and the spec as it is written out, which it shows.
    fn report_reads(&self, statistics_key: &str) -> Value {
        let spec = blake3::hash(self.spec.to_toml().as_bytes()).to_hex().to_string();
        json!({ "name": self.spec.name, "spec": spec, "statistics": statistics_key })
    }

    /// Key of the report.
    #[must_use]
    pub fn report_key(&self, statistics_key: &str) -> String {
        key(Stage::Report.word(), REPORT, &self.report_reads(statistics_key))
    }

    /// Key inputs of the tasks of a surface, by stage, up to and including `stage`.
    #[must_use]
    pub fn surface_preimages(&self, unit: &SurfaceUnit, stage: Stage) -> Map<String, Value> {
        let reads = json!({ "surface": surface_reads(&self.spec, &unit.params), "seed": seed_of(&self.spec, &unit.params), "realization": unit.realization });
        let mut preimages = Map::new();
        enter(&mut preimages, Stage::Generate, GENERATE, &reads);
        if stage >= Stage::Extract {
            enter(&mut preimages, Stage::Extract, EXTRACT, &json!({ "surface": unit.key }));
        }
        preimages
    }

    /// Key inputs of a cycle and of the tasks that it depends on.
    #[must_use]
    pub fn cycle_preimages(&self, unit: &CycleUnit) -> Map<String, Value> {
        let (surface, params) = (&self.surfaces[unit.surface], &self.cases[unit.case].case.params);
        let mut preimages = self.surface_preimages(surface, Stage::Extract);
        let mut reads = cycle_reads(params);
        reads["asperities"] = surface.asperities_key.as_str().into();
        enter(&mut preimages, Stage::Cycle, CYCLE, &reads);
        preimages
    }

    /// Key inputs of the tables over realizations.
    #[must_use]
    pub fn statistics_preimages(&self, cycles: &[Standing]) -> Map<String, Value> {
        let mut preimages = Map::new();
        enter(&mut preimages, Stage::Aggregate, AGGREGATE, &self.statistics_reads(cycles));
        preimages
    }

    /// Key inputs of the report.
    #[must_use]
    pub fn report_preimages(&self, statistics_key: &str) -> Map<String, Value> {
        let mut preimages = Map::new();
        enter(&mut preimages, Stage::Report, REPORT, &self.report_reads(statistics_key));
        preimages
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

fn enter(preimages: &mut Map<String, Value>, stage: Stage, meaning: u32, reads: &Value) {
    preimages.insert(stage.word().to_owned(), preimage(stage.word(), meaning, reads));
}

/// What of a cycle's standing the tables over realizations depend on, beside the error message.
fn state(standing: &Standing) -> &'static str {
    match standing {
        Standing::Done => "done",
        Standing::Failed(_) => "failed",
        _ => "open",
    }
}

/// The parameters of a case without the errata that only analytical estimates read.
fn read_by_cycle(params: &CaseParams) -> CaseParams {
    let mut params = params.clone();
    params.model.as_printed.retain(|slip| slip.in_contact());
    params
}

/// Inputs of a cycle in its key, besides the asperities. Those of the asperity model are the same as before there was another method.
fn cycle_reads(params: &CaseParams) -> Value {
    let params = read_by_cycle(params);
    let [material, mut model, mut cycle] = [plain(&params.material), plain(&params.model), plain(&params.cycle)];
    if params.by_elements() {
        model = json!({ "method": model["method"] });
        remove(&mut cycle, "approach_step");
        return json!({ "material": material, "model": model, "boundary_elements": plain(&params.boundary_elements), "cycle": cycle });
    }
    remove(&mut model, "method");
    json!({ "material": material, "model": model, "cycle": cycle })
}

/// Parameters of a case in its identity. Those of the asperity model are the same as before there was another method.
fn case_reads(spec: &Spec, params: &CaseParams) -> Value {
    let mut reads = plain(params);
    reads["surface"] = surface_reads(spec, &params.surface);
    if !params.by_elements() {
        remove(&mut reads, "boundary_elements");
        remove(&mut reads["model"], "method");
    }
    reads
}

fn remove(value: &mut Value, name: &str) {
    if let Some(members) = value.as_object_mut() {
        members.remove(name);
    }
}

/// The seed that a surface reads: a measured one reads none.
fn seed_of(spec: &Spec, params: &SurfaceParams) -> u64 {
    if params.is_measured() { 0 } else { spec.seed }
}

/// What a surface is made from: of a measured one the contents of its file, and what is done to it.
fn surface_reads(spec: &Spec, params: &SurfaceParams) -> Value {
    let SurfaceParams { file, dataset, periodic, pixel_m, unit, missing, detrend, points_per_shortest_wavelength, .. } = params;
    if params.is_measured() {
        return json!({
            "blake3": spec.files.get(file), "dataset": dataset, "periodic": periodic, "pixel_m": pixel_m, "unit": unit, "missing": missing, "detrend": detrend,
            "points_per_shortest_wavelength": points_per_shortest_wavelength,
        });
    }
    let mut reads = plain(params);
    if let Some(members) = reads.as_object_mut() {
        members.retain(|name, _| !MEASURED.contains(&name.as_str()));
    }
    reads
}

/// A parameter set as JSON; a number that JSON cannot hold is refused by the spec long before.
fn plain(value: &impl serde::Serialize) -> Value {
    serde_json::to_value(value).unwrap_or(Value::Null)
}
