//! Reading of a spec: from its text to the checked cases.
//!
//! The text is TOML. Every key has its row in one table (`keys.rs`): its type, its bounds, and where its
//! value goes. The walker refuses what no row names, and collects every fault with its place, so that one
//! reading of the answer mends the whole file.

mod auto;
mod cases;
mod coarser;
mod elements;
mod entries;
mod experiment;
mod fault;
mod figures;
mod files;
mod grid;
mod json_schema;
mod keys;
mod nearest;
mod number;
mod origin;
mod per_wavelength;
mod probe;
mod psd;
mod realizations;
mod reference;
mod scan_sides;
mod scans;
mod settings;
mod shape;
mod sides;
mod sweep;
mod top;
mod value;
mod values;
mod walk;
mod write;
mod written;
mod zip;

use std::collections::{BTreeMap, BTreeSet};
use std::io::Read as _;
use std::path::Path;

use serde::Serialize;

use crate::constants::{Constant, Constants};
pub use crate::model::CaseParams;
use crate::model::{Experiment, LoopOptions, Method};
pub use crate::physics::elements::PER_WAVELENGTH;
pub use crate::text::quoted;
pub use auto::Chooser;
pub use coarser::COARSER;
pub use elements::{
    FEWEST_PER_WAVELENGTH, MANY_RANGE_STEPS, MAX_ELEMENTS, MOST_MESH_NUMBER, MOST_PER_WAVELENGTH,
    automatic_range, mesh_number,
};
pub use fault::{Fault, Place, SpecErrors};
pub use figures::{FORMATS, Figures};
pub use json_schema::{SCHEMA_FILE, json_schema};
pub use keys::{
    GENERATED, MEASURED, NAMES, OF_ASPERITIES, OPTIONAL_TABLES, OTHER_GRIDS, OTHER_LOADS, REPLACED,
    WHERE_USED,
};
pub use per_wavelength::shortest_lengths;
pub use probe::{contact_radius_m, probe_refusal};
pub use realizations::{Realizations, Until};
pub use reference::reference;
pub use scan_sides::SideReader;
pub use values::{GridGoal, Values};

/// Limits of specs.
pub const CONSTANTS: Constants = Constants {
    subject: "Specs",
    module: "spec",
    rows: &[
        Constant::new("cases of a spec", &[MAX_CASES as f64], "", "Maximum, over all sweeps.", ""),
        Constant::new("realizations of a case", &[MAX_REALIZATIONS as f64], "", "Maximum.", ""),
        Constant::new(
            "tasks of a run",
            &[MAX_TASKS as f64],
            "",
            "Maximum: two for each surface, one for each cycle.",
            "",
        ),
        Constant::new(
            "grid points along a side",
            &[MAX_GRID as f64],
            "",
            "Maximum of a generated surface.",
            "",
        ),
        Constant::new("size of a spec", &[(MAX_BYTES >> 20) as f64], "MiB", "Maximum.", ""),
        Constant::new(
            "grid points of boundary elements",
            &[MAX_ELEMENTS as f64],
            "",
            "Maximum along a side.",
            "elements",
        ),
        Constant::new(
            "grid points per shortest wavelength",
            &[FEWEST_PER_WAVELENGTH, PER_WAVELENGTH],
            "",
            "Boundary elements: fewer than the first number are an error. `points = 0` gives at least the \
             second.",
            "elements",
        ),
        Constant::new(
            "mesh number `sqrt(Δγ dx/E*)/(2ρ)`",
            &[MOST_MESH_NUMBER],
            "",
            "Boundary elements with a range `ρ`: on a coarser grid contact edges are trapped, which is an \
             error.",
            "elements",
        ),
        Constant::new(
            "automatic range `ρ`",
            &[elements::RANGE],
            "`sqrt(Δγ dx/E*)`",
            "Boundary elements with `range_m = 0`.",
            "elements",
        ),
        Constant::new(
            "work of adhesion `Δγ/(E* dx)`",
            &[elements::LEAST_WORK],
            "",
            "Boundary elements: a smaller one is an error.",
            "elements",
        ),
        Constant::new(
            "gap at which the attraction ends",
            &[elements::END],
            "`ρ`",
            "Boundary elements with a range `ρ`.",
            "elements",
        ),
        Constant::new(
            "steps over that gap",
            &[MANY_RANGE_STEPS, elements::MOST_RANGE_STEPS],
            "",
            "Boundary elements with a range: `plan` announces more than the first number (`many_steps`), \
             more than the second are an error.",
            "elements",
        ),
    ],
};

/// Maximum number of cases that one spec may make.
pub const MAX_CASES: u32 = 10_000;

/// Maximum number of realisations of each surface.
pub const MAX_REALIZATIONS: u32 = 10_000;

/// Maximum number of tasks of one campaign: two for each surface, one for each cycle.
pub const MAX_TASKS: u64 = 10_000_000;

/// Maximum number of grid points along one side of a surface: 8 GiB of heights.
pub const MAX_GRID: u32 = 32_768;

/// Largest size of a spec's text \[bytes\].
pub const MAX_BYTES: u64 = 4 << 20;

/// A campaign: what is computed, and how often.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Spec {
    /// Name of the campaign, and of its folder.
    pub name: String,
    /// Seed of the whole campaign.
    pub seed: u64,
    /// Realisations of each surface.
    pub realizations: Realizations,
    /// Files of the figures.
    pub figures: Figures,
    /// Measured loops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub experiment: Option<Experiment>,
    /// The cases: each different one once, in the order of their first occurrence in the sweeps.
    pub cases: Vec<Case>,
    /// Parameters that the sweeps override; a case of its own only without a sweep.
    pub base: Values,
    /// Coarser grids of boundary elements of the base, ascending: the loops of every case whose sweep does
    /// not set the grid are repeated on them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub coarser_points: Vec<u32>,
    /// The sweeps as written, each value checked.
    pub sweeps: Vec<Sweep>,
    /// Methods chosen for the points with `method = "auto"`, in their order, if they differ; `auto` where a
    /// scan decides and has not been read.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub auto_methods: Vec<Method>,
    /// Places in [`Self::cases`] of these points, until all are chosen.
    #[serde(skip)]
    auto_cases: Vec<usize>,
    /// Sides of the scans with a load in newtons \[m\]: one of all points with such a load, or of each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub scan_sides_m: Vec<f64>,
    /// Points whose scans have not been read for their sides.
    #[serde(skip)]
    unread: Vec<sides::Unread>,
    /// BLAKE3 of the files of measured surfaces and loops, by the names by which they were found.
    pub files: BTreeMap<String, String>,
    /// Files that the spec names by absolute paths.
    #[serde(skip)]
    pub absolute_files: BTreeSet<String>,
}

/// One point of the campaign.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Case {
    /// Names of all sweeps in which this case occurs, in their order; `base` alone when the spec has no
    /// sweep, and [`COARSER`] alone for a case that is only a coarser grid of others or its shifted copy.
    pub sweeps: Vec<String>,
    /// Parameters of the case.
    pub params: CaseParams,
}

/// One `[[sweep]]`: its axes multiply, the last one runs fastest. Axes of one group of `zip` advance together
/// in the place of the first one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sweep {
    /// Name, unique in the spec.
    pub name: String,
    /// Groups of keys that advance together.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub zip: Vec<Vec<&'static str>>,
    /// Overridden keys, in the order written.
    pub axes: Vec<Axis>,
}

/// One key that a sweep overrides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Axis {
    /// Table and key, such as `surface.magnification`.
    pub key: &'static str,
    /// The values that it takes; one, if it is overridden and not swept.
    pub values: Vec<Value>,
}

/// The value of a key.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A real number.
    Number(f64),
    /// A whole number.
    Count(u32),
    /// True or false.
    Flag(bool),
    /// One of the words of a choice.
    Word(&'static str),
    /// A text, such as the name of a file.
    Text(String),
    /// Real numbers, ascending, each once.
    Numbers(Vec<f64>),
    /// Words of a choice, in the order of the choice, each once.
    Words(Vec<&'static str>),
    /// Texts, such as the names of files, in the order written.
    Texts(Vec<String>),
}

impl Spec {
    /// Reads a spec from its text; `file` is the name of the file in error messages.
    ///
    /// # Errors
    /// Every fault of the text, each with its place.
    pub fn parse(text: &str, file: &str) -> Result<Self, SpecErrors> {
        Self::parse_with(text, file, &[])
    }

    /// Reads a spec from its text. `settings` such as `surface.hurst=0.7` replace values outside its sweeps.
    ///
    /// # Errors
    /// Every fault of the first faulty setting, or else of the text with the settings.
    pub fn parse_with(text: &str, file: &str, settings: &[String]) -> Result<Self, SpecErrors> {
        let spec = Self::parse_known(text, file, settings, &Known::default())?;
        scan_sides::of_scans(&spec, (text, file, settings), UNREAD.side_m)?;
        Ok(spec)
    }

    /// Reads a spec from its text, with the results of its scans.
    fn parse_known(text: &str, file: &str, settings: &[String], known: &Known) -> Result<Self, SpecErrors> {
        let mut faults = fault::Faults::new(text, file);
        let mut draft = walk::document(text, &mut faults);
        if let Some(draft) = &mut draft {
            faults = faults.with(settings::apply(settings, draft)?);
            if !known.methods.is_empty() {
                draft.auto_methods.clone_from(&known.methods);
            }
            if !known.sides_m.is_empty() {
                draft.scan_sides_m.clone_from(&known.sides_m);
                draft.are_sides_read = true;
            }
        }
        let spec = draft.and_then(|draft| grid::expand(draft, &mut faults));
        faults.finish(spec).map_err(|errors| errors.with(settings))
    }

    /// Reads a spec from a file, and looks at the files of measured surfaces that it names. A relative name
    /// is looked for in the working directory, then in the folder of the spec; a name of which the spec has
    /// the checksum, the other way round. The returned spec has the name by which the file was found.
    ///
    /// # Errors
    /// Why the file cannot be read, or every fault of its text, or which of the files that it names cannot be
    /// read.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SpecErrors> {
        Self::read_with(path, &[])
    }

    /// Reads a spec from a file as [`Self::read`], with settings as [`Self::parse_with`].
    ///
    /// # Errors
    /// As these two.
    pub fn read_with(path: impl AsRef<Path>, settings: &[String]) -> Result<Self, SpecErrors> {
        Self::read_choosing(path, settings, &UNREAD)
    }

    /// Reads a spec from a file as [`Self::read_with`]. The reader reads the scan of a case with
    /// `method = "auto"`, or with a load in newtons and no size in the spec.
    ///
    /// # Errors
    /// As [`Self::read_with`], and errors of the reader.
    pub fn read_choosing(
        path: impl AsRef<Path>,
        settings: &[String],
        reader: &ScanReader<'_>,
    ) -> Result<Self, SpecErrors> {
        let path = path.as_ref();
        let (file, text) = (path.display().to_string(), text_of(path)?);
        let folder = path.parent().unwrap_or(Path::new(""));
        let with_settings = |errors: SpecErrors| errors.with(settings);
        let read = |known: &Known| {
            let spec = Self::parse_known(&text, &file, settings, known)?;
            files::digested(spec, &text, &file, folder).map_err(with_settings)
        };
        let mut known = Known::default();
        let mut spec = read(&known)?;
        if !spec.unread.is_empty() {
            known.sides_m = scan_sides::of_scans(&spec, (&text, &file, settings), reader.side_m)?;
            spec = read(&known)?;
        }
        if spec.auto_methods.contains(&Method::Auto) {
            known.methods = auto::chosen(&spec, &text, &file, reader.method).map_err(with_settings)?;
            spec = read(&known)?;
        }
        Ok(spec)
    }

    /// The spec with other names of the files of measured surfaces; files that are not in `names` keep their
    /// names.
    #[must_use]
    pub fn with_file_names(&self, names: &BTreeMap<String, String>) -> Self {
        let mut spec = self.clone();
        files::rename(&mut spec, names);
        let renamed = |name: &String| names.get(name).unwrap_or(name).clone();
        spec.files = self.files.iter().map(|(name, digest)| (renamed(name), digest.clone())).collect();
        spec.absolute_files = self.absolute_files.iter().map(renamed).collect();
        spec
    }

    /// Evaluation of the measured loops: the modulus of the table `[material]` unless the experiment has one.
    #[must_use]
    pub fn loop_options(&self) -> Option<LoopOptions> {
        let options = &self.experiment.as_ref()?.options;
        let probe_radius_m = self.probe_radius_m();
        let of_material = Some(self.base.material.contact_modulus_pa);
        let contact_modulus_pa =
            options.contact_modulus_pa.or(of_material).filter(|_| probe_radius_m.is_some());
        Some(LoopOptions { probe_radius_m, contact_modulus_pa, ..options.clone() })
    }

    /// Unit in which the spec gives its load reversals: `N`, `Pa`, or `1` for loads over `E* A0`.
    ///
    /// A spec with sweeps in another unit than the rest has `1`.
    #[must_use]
    pub fn load_unit(&self) -> &'static str {
        let units = [
            ("N", "cycle.max_force_n", !self.base.max_force_n.is_empty()),
            ("Pa", "cycle.max_pressure_pa", !self.base.max_pressure_pa.is_empty()),
        ];
        let swept = |key: &str| self.sweeps.iter().any(|sweep| sweep.axes.iter().any(|axis| axis.key == key));
        let in_unit = |(unit, _, is_base): &(&'static str, &str, bool)| is_base.then_some(*unit);
        let others = |of: &str| {
            units.iter().any(|(unit, key, _)| *unit != of && swept(key)) || swept("cycle.max_load")
        };
        units.iter().find_map(in_unit).filter(|unit| !others(unit)).unwrap_or("1")
    }

    /// Radius of the probe of the measured loops \[m\].
    fn probe_radius_m(&self) -> Option<f64> {
        self.experiment.as_ref()?.options.probe_radius_m.or(self.base.radius_m)
    }

    /// The spec with every default written out: reading it again gives an equal spec.
    #[must_use]
    pub fn to_toml(&self) -> String {
        write::toml(self)
    }
}

/// Results of the scans of a spec, as far as they are read.
#[derive(Default)]
struct Known {
    /// Choices of `method = "auto"`.
    methods: Vec<Method>,
    /// Sides of the squares \[m\].
    sides_m: Vec<f64>,
}

/// Readers of the scans of a spec.
pub struct ScanReader<'a> {
    /// Chooses the method.
    pub method: Chooser<'a>,
    /// Reads the side of the square.
    pub side_m: SideReader<'a>,
}

/// Reads no scan.
const UNREAD: ScanReader<'static> = ScanReader {
    method: &|_| Err(("it is not read here".to_owned(), "write the method".to_owned())),
    side_m: &|_| {
        Err(("it is not read here".to_owned(), "give surface.size_m and surface.size_y_m".to_owned()))
    },
};

/// The text of a spec.
fn text_of(path: &Path) -> Result<String, SpecErrors> {
    let file = path.display().to_string();
    // Windows answers "access denied" for a folder; the question is cheap and the answer is the same
    // everywhere.
    if path.is_dir() {
        return Err(SpecErrors::unreadable(&file, "it is a directory, not a TOML file"));
    }
    let mut bytes = Vec::new();
    // One byte above the maximum shows that a file is too long, also where a pipe has no length.
    let read =
        std::fs::File::open(path).and_then(|opened| opened.take(MAX_BYTES + 1).read_to_end(&mut bytes));
    match read {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            Err(SpecErrors::unreadable(&file, "no such file"))
        }
        Err(error) => Err(SpecErrors::unreadable(&file, &error.to_string())),
        Ok(length) if length as u64 > MAX_BYTES => {
            Err(SpecErrors::unreadable(&file, &format!("it is longer than {} MiB", MAX_BYTES >> 20)))
        }
        Ok(_) => String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            SpecErrors::not_utf8(error.as_bytes(), valid, &file)
        }),
    }
}
