//! Inputs of the keys of all tasks.
//!
//! One description of the inputs of each stage makes both forms: canonical JSON text, which is hashed, and
//! the JSON value that receipts show.

use super::{Campaign, CycleUnit, Stage, Standing, SurfaceUnit};
use crate::keys::{canonical, key_of_text, preimage};
use crate::model::{
    Choice, Control, FrontLaw, GeneratedSurface, MeasuredSurface, MethodOptions, SurfaceSource,
    TabulatedSpectrum,
};
use crate::physics::asperities::Asperities;
use crate::physics::cycle::Method;
use crate::physics::elements::Elements;
use crate::spec::{Case, CaseParams, OPTIONAL_TABLES, REPLACED, Spec};
use serde_json::{Map, Value, json};

/// Version of the evaluation of measured loops.
const LOOP_VERSION: u32 = 1;

/// Form of key inputs.
pub(super) trait Form: Clone {
    /// The form of a value.
    fn of(value: &Value) -> Self;

    /// A list.
    fn list(items: Vec<Self>) -> Self;

    /// An object.
    fn object(members: Vec<(&str, Self)>) -> Self;

    /// A word.
    fn word(word: &str) -> Self {
        Self::of(&Value::from(word))
    }
}

impl Form for Value {
    fn of(value: &Value) -> Self {
        value.clone()
    }

    fn list(items: Vec<Self>) -> Self {
        Self::Array(items)
    }

    fn object(members: Vec<(&str, Self)>) -> Self {
        members.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }
}

/// Canonical JSON: sorted names, no white space. It is rendered once for all tasks that share an input.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Canonical(String);

impl Form for Canonical {
    fn of(value: &Value) -> Self {
        Self(canonical(value))
    }

    fn list(items: Vec<Self>) -> Self {
        let items: Vec<String> = items.into_iter().map(|item| item.0).collect();
        Self(format!("[{}]", items.join(",")))
    }

    fn object(mut members: Vec<(&str, Self)>) -> Self {
        members.sort_by_key(|(name, _)| *name);
        let members: Vec<String> =
            members.into_iter().map(|(name, value)| format!("\"{name}\":{}", value.0)).collect();
        Self(format!("{{{}}}", members.join(",")))
    }
}

impl Canonical {
    /// Key of a task with these inputs.
    pub(super) fn key(&self, stage: Stage) -> String {
        key_of_text(stage.word(), stage.version(), &self.0)
    }

    /// Key of the parameters of a case.
    pub(super) fn case_key(&self) -> String {
        key_of_text("case", 1, &self.0)
    }
}

/// Inputs of a surface, from the inputs shared by all realizations.
pub(super) fn generate<F: Form>(surface: &F, seed: u64, realization: u32) -> F {
    F::object(vec![
        ("surface", surface.clone()),
        ("seed", F::of(&seed.into())),
        ("realization", F::of(&realization.into())),
    ])
}

/// Inputs of a table of asperities.
pub(super) fn extract<F: Form>(surface_key: &str) -> F {
    F::object(vec![("surface", F::word(surface_key))])
}

/// Inputs of the cycles of a case, without the asperities.
pub(super) fn case_members<F: Form>(params: &CaseParams) -> Vec<(&'static str, F)> {
    of_case(params).into_iter().map(|(name, value)| (name, F::of(&value))).collect()
}

/// Inputs of a cycle, from the inputs shared by all cycles of the case.
pub(super) fn cycle<F: Form>(members: &[(&'static str, F)], asperities_key: &str) -> F {
    F::object([members, &[("asperities", F::word(asperities_key))]].concat())
}

impl Campaign {
    /// Inputs of the tables over realizations: the cases with their labels, the cycles with their status and
    /// error messages, and the name of the run.
    fn statistics_inputs<F: Form>(&self, cycles: &[Standing]) -> F {
        let label = |case: &Case| self.label_of(&case.params.surface);
        let cases = self.cases.iter().map(|unit| match label(&unit.case) {
            Some(label) => F::of(&json!([unit.id, unit.case.sweeps, label])),
            None => F::of(&json!([unit.id, unit.case.sweeps])),
        });
        let cycle = |(unit, standing): (&CycleUnit, &Standing)| {
            let failure = self.failure_in_tables(unit, standing);
            let words = [unit.key.as_str(), state(standing)].into_iter().chain(failure.as_deref());
            F::list(words.map(F::word).collect())
        };
        let cycles = self.cycles.iter().zip(cycles).map(cycle);
        let mut members = vec![
            ("name", F::word(&self.spec.name)),
            ("cases", F::list(cases.collect())),
            ("cycles", F::list(cycles.collect())),
        ];
        members.extend(self.spec.base.goal.error.map(|error| ("grid_error", F::of(&json!(error)))));
        members.extend(self.loops_of_key().map(|loops| ("loops", F::of(&loops))));
        F::object(members)
    }

    /// Measured loops: labels and checksums of the files, and how they are read.
    fn loops_of_key(&self) -> Option<Value> {
        let (experiment, options) = (self.spec.experiment.as_ref()?, self.spec.loop_options()?);
        let one = |name: &String| json!([self.file_label(name), self.spec.files.get(name)]);
        let files: Vec<Value> = experiment.loops.iter().map(one).collect();
        Some(json!({ "version": LOOP_VERSION, "files": files, "options": options }))
    }

    /// Inputs of the report: the tables, the spec with all defaults as it shows it, and formats that this
    /// build does not write.
    fn report_inputs<F: Form>(&self, statistics_key: &str) -> F {
        let spec = blake3::hash(self.labelled_toml().as_bytes()).to_hex().to_string();
        let mut inputs = vec![
            ("name", F::word(&self.spec.name)),
            ("spec", F::word(&spec)),
            ("statistics", F::word(statistics_key)),
        ];
        let left_out = self.spec.figures.left_out();
        if !left_out.is_empty() {
            inputs.push(("figure_formats_left_out", F::word(&left_out.join(" "))));
        }
        F::object(inputs)
    }

    /// Key of the tables over realizations, with this status of the cycles.
    #[must_use]
    pub fn statistics_key(&self, cycles: &[Standing]) -> String {
        self.statistics_inputs::<Canonical>(cycles).key(Stage::Aggregate)
    }

    /// Key of the report.
    #[must_use]
    pub fn report_key(&self, statistics_key: &str) -> String {
        self.report_inputs::<Canonical>(statistics_key).key(Stage::Report)
    }

    /// Key inputs of the tasks of a surface, by stage, up to and including `stage`.
    #[must_use]
    pub fn surface_preimages(&self, unit: &SurfaceUnit, stage: Stage) -> Map<String, Value> {
        let surface = of_surface(&self.spec, &unit.params);
        let mut shown =
            shown(Stage::Generate, &generate(&surface, seed_of(&self.spec, &unit.params), unit.realization));
        if stage >= Stage::Extract {
            shown.extend(self::shown(Stage::Extract, &extract(&unit.key)));
        }
        shown
    }

    /// Key inputs of a cycle and of the tasks that it depends on.
    #[must_use]
    pub fn cycle_preimages(&self, unit: &CycleUnit) -> Map<String, Value> {
        let (surface, params) = (&self.surfaces[unit.surface], &self.cases[unit.case].case.params);
        let mut shown = self.surface_preimages(surface, Stage::Extract);
        shown.extend(self::shown(Stage::Cycle, &cycle(&case_members(params), &surface.asperities_key)));
        shown
    }

    /// Key inputs of the tables over realizations.
    #[must_use]
    pub fn statistics_preimages(&self, cycles: &[Standing]) -> Map<String, Value> {
        shown(Stage::Aggregate, &self.statistics_inputs(cycles))
    }

    /// Key inputs of the report.
    #[must_use]
    pub fn report_preimages(&self, statistics_key: &str) -> Map<String, Value> {
        shown(Stage::Report, &self.report_inputs(statistics_key))
    }
}

/// Key inputs of a stage by its word, as receipts show them.
fn shown(stage: Stage, inputs: &Value) -> Map<String, Value> {
    Map::from_iter([(stage.word().to_owned(), preimage(stage.word(), stage.version(), inputs))])
}

/// Word for the status of a cycle in the key of the tables over realizations.
fn state(standing: &Standing) -> &'static str {
    match standing {
        Standing::Done => "done",
        Standing::Failed(_) => "failed",
        _ => "open",
    }
}

/// The parameters of a case without the errata that only analytical estimates read.
pub(super) fn read_by_cycle(params: &CaseParams) -> CaseParams {
    let mut params = params.clone();
    params.as_printed.retain(|slip| slip.in_contact());
    params
}

/// Version of the reading of measured surfaces in their keys: order of the points, attributes. Generated
/// surfaces have none.
const READING_VERSION: u32 = 2;

/// Version of the cycles by boundary elements of one load on a periodic surface with the plain law, whose
/// results later versions have not changed.
pub(crate) const ELEMENTS_VERSION: u32 = 10;

/// Version of all other cycles with the plain law, as above.
const PLAIN_VERSION: u32 = 11;

/// Version of all other cycles with the corrected law, as above.
const CORRECTED_VERSION: u32 = 12;

/// Present version of the asperity model.
pub(crate) const fn asperities_version() -> u32 {
    present(Asperities::VERSIONS)
}

/// The present version of a method.
const fn present(versions: &[(u32, &str)]) -> u32 {
    versions[versions.len() - 1].0
}

/// Inputs of a cycle in its key, besides the asperities.
fn of_case(params: &CaseParams) -> Vec<(&'static str, Value)> {
    let mut tables = plain(&read_by_cycle(params));
    let mut take = |name: &'static str| (name, tables[name].take());
    let [material, mut model, mut elements, mut cycle] =
        ["material", "model", "boundary_elements", "cycle"].map(&mut take);
    remove_plain_law(&mut elements.1);
    let further = OPTIONAL_TABLES.map(&mut take).into_iter().filter(|(_, table)| !table.is_null());
    let of_method = match &params.method {
        MethodOptions::Asperities(_) => {
            model.1["method_version"] = json!(asperities_version());
            vec![material, model, cycle]
        }
        MethodOptions::Elements(options) => {
            let is_first = params.surface.is_periodic() && params.cycle.max_load.len() == 1;
            let is_soft = params.machine.control == Control::Load || params.machine.compliance_m_n > 0.0;
            let version = match options.attraction.law() {
                _ if is_soft && params.has_images() => present(Elements::VERSIONS),
                Some(FrontLaw::Corrected) => CORRECTED_VERSION,
                _ if is_first => ELEMENTS_VERSION,
                _ => PLAIN_VERSION,
            };
            model.1 = json!({ "method": model.1["method"], "method_version": version });
            remove(&mut cycle.1, "approach_step");
            vec![material, model, elements, cycle]
        }
    };
    of_method.into_iter().chain(further).collect()
}

/// Parameters of a case in its identity. Those of the asperity model are the same as before there was another
/// method.
pub(super) fn of_whole_case(spec: &Spec, params: &CaseParams) -> Value {
    let mut reads = plain(params);
    reads["surface"] = of_surface(spec, &params.surface);
    remove_plain_law(&mut reads["boundary_elements"]);
    if params.asperities().is_some() {
        remove(&mut reads, "boundary_elements");
        remove(&mut reads["model"], "method");
    }
    reads
}

/// The law of boundary elements is an input where it is not the default.
fn remove_plain_law(elements: &mut Value) {
    if elements["law"] == FrontLaw::Plain.word() {
        remove(elements, "law");
    }
}

fn remove(value: &mut Value, name: &str) {
    if let Some(members) = value.as_object_mut() {
        members.remove(name);
    }
}

/// Version of the header of a measured surface in its key: 2 with texture and the cut-offs of the fit.
const MEASURED_HEADER_VERSION: u32 = 2;

/// Seed in the key of a surface; a measured one has none.
pub(super) fn seed_of(spec: &Spec, params: &SurfaceSource) -> u64 {
    params.generated().map_or(0, |_| spec.seed)
}

/// Version of the import of measured surfaces and of the search for their asperities. It is part of their
/// keys, in addition to the versions of the stages.
const MEASURED_VERSION: u32 = 2;

/// Inputs of a surface in its key: parameters of a generated one, contents of the file and preprocessing of a
/// measured one.
pub(super) fn of_surface(spec: &Spec, params: &SurfaceSource) -> Value {
    let surface = match params {
        SurfaceSource::Generated(surface) if surface.is_tabulated() => return of_tabulated(spec, surface),
        SurfaceSource::Generated(surface) => return plain(surface),
        SurfaceSource::Measured(surface) => surface,
    };
    let MeasuredSurface {
        file, dataset, periodic, pixel_m, size_m, size_y_m, unit, skip_lines, width, ..
    } = &**surface;
    let MeasuredSurface { transpose, missing, detrend, filter, points_per_shortest_wavelength, .. } =
        &**surface;
    let blake3 = if surface.files.is_empty() {
        json!(spec.files.get(file))
    } else {
        json!(surface.files.iter().map(|file| spec.files.get(file)).collect::<Vec<_>>())
    };
    let mut reads = json!({
        "reading_version": READING_VERSION, "blake3": blake3, "dataset": dataset,
        "periodic": periodic, "pixel_m": pixel_m, "size_m": size_m, "size_y_m": size_y_m, "unit": unit,
        "skip_lines": skip_lines, "width": width, "transpose": transpose, "missing": missing,
        "detrend": detrend, "filter": filter,
        "points_per_shortest_wavelength": points_per_shortest_wavelength, "method_version": MEASURED_VERSION,
        "header_version": MEASURED_HEADER_VERSION,
    });
    corrections(surface).into_iter().for_each(|(name, value)| reads[name] = value);
    reads
}

/// Version of the reading and conversion of tabulated spectra in their keys.
const TABLE_VERSION: u32 = 1;

/// Inputs of a surface with a tabulated spectrum: the content of its file, and what is read with it.
fn of_tabulated(spec: &Spec, surface: &GeneratedSurface) -> Value {
    let TabulatedSpectrum { file, kind, convention, unit, series, .. } = &surface.tabulated;
    let mut reads = plain(surface);
    REPLACED.iter().for_each(|name| remove(&mut reads, name));
    let of_table = [
        ("blake3", json!(spec.files.get(file))),
        ("spectrum_kind", json!(kind)),
        ("spectrum_convention", json!(convention)),
        ("spectrum_unit", json!(unit)),
        ("spectrum_series", json!(series)),
        ("table_version", json!(TABLE_VERSION)),
    ];
    of_table.into_iter().for_each(|(name, value)| reads[name] = value);
    reads
}

/// Corrections of a measured surface in its key; only corrections that are applied.
fn corrections(params: &MeasuredSurface) -> Vec<(&'static str, Value)> {
    let MeasuredSurface { outliers, align_rows, fast_axis, tip_radius_m, .. } = params;
    let made = [
        (*outliers, "outliers", json!(outliers)),
        (*align_rows, "align_rows", json!(align_rows)),
        (*align_rows, "fast_axis", json!(fast_axis)),
        (*tip_radius_m > 0.0, "tip_radius_m", json!(tip_radius_m)),
    ];
    made.into_iter().filter_map(|(is_made, name, value)| is_made.then_some((name, value))).collect()
}

/// A parameter set as JSON; a number that JSON cannot hold is refused by the spec long before.
fn plain(value: &impl serde::Serialize) -> Value {
    serde_json::to_value(value).unwrap_or(Value::Null)
}
