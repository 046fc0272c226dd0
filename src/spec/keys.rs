//! The keys: what each takes, and where its value goes.

use super::{CaseParams, Value};
use crate::model::{Amplitudes, Boundary, Choice, Coalescence, Detrend, Interaction, JumpIn, KeptContacts, Missing, Normalization, Slip};

/// One key of a table.
pub(super) struct Key {
    /// Table and key, such as `surface.length_m`.
    pub(super) path: &'static str,
    /// The table.
    pub(super) table: &'static str,
    /// The key in its table.
    pub(super) name: &'static str,
    /// What it takes.
    pub(super) kind: Kind,
    /// Its value in a case.
    pub(super) get: fn(&CaseParams) -> Value,
    /// Puts a value of the right kind into a case.
    pub(super) set: fn(&mut CaseParams, &Value),
}

/// What a key takes.
pub(super) enum Kind {
    /// A real number.
    Number(Limits),
    /// A whole number from `low` to `high`. Below, the first sentence whose number is not exceeded tells why.
    Count { low: u32, high: u32, why: &'static [(i128, &'static str)], note: &'static str },
    /// True or false.
    Flag,
    /// One of some words.
    Word(fn() -> Vec<&'static str>),
    /// An array of real numbers, as many as stated.
    Numbers(Limits, usize),
    /// An array of words.
    Words(fn() -> Vec<&'static str>),
    /// A text of so many bytes at most, and what it is.
    Text(usize, &'static str),
    /// A unit of length, or no text where a file says it.
    Length(&'static str),
}

impl Kind {
    /// Whether one value of this kind is an array already.
    pub(super) fn is_list(&self) -> bool {
        matches!(self, Self::Numbers(..) | Self::Words(..))
    }
}

/// Bounds of a real number.
pub(super) struct Limits {
    /// The least value, or what it must exceed.
    pub(super) low: f64,
    /// `low` itself is not allowed.
    pub(super) above: bool,
    /// The greatest value.
    pub(super) high: f64,
    /// Symbol of the unit, with a space before it; empty if there is none.
    pub(super) unit: &'static str,
    /// Name of the unit.
    pub(super) unit_name: &'static str,
    /// A unit that is easily written instead: its size in the right one, and its name.
    pub(super) slip: Option<(f64, &'static str)>,
    /// What to know of values out of bounds.
    pub(super) note: &'static str,
}

impl Limits {
    /// Whether a value lies within.
    pub(super) fn hold(&self, value: f64) -> bool {
        value <= self.high && if self.above { value > self.low } else { value >= self.low }
    }
}

/// The words of a choice.
fn words<T: Choice>() -> Vec<&'static str> {
    T::WORDS.iter().map(|(word, _)| *word).collect()
}

macro_rules! key {
    ($table:ident . $name:ident, $kind:expr, $get:expr, $variant:ident($bound:ident) => $value:expr) => {
        Key {
            path: concat!(stringify!($table), ".", stringify!($name)),
            table: stringify!($table),
            name: stringify!($name),
            kind: $kind,
            get: |case| {
                let get: fn(&_) -> Value = $get;
                get(&case.$table.$name)
            },
            set: |case, value| {
                // The walker reads each value by the kind in the same row, so that it always fits.
                if let Value::$variant($bound) = value
                    && let Some(value) = $value
                {
                    case.$table.$name = value;
                }
            },
        }
    };
    ($table:ident . $name:ident: number $limits:expr) => {
        key!($table.$name, Kind::Number($limits), |x: &f64| Value::Number(*x), Number(x) => Some(*x))
    };
    ($table:ident . $name:ident: count $low:literal to $high:literal, $why:expr, $note:expr) => {
        key!($table.$name, Kind::Count { low: $low, high: $high, why: $why, note: $note },
            |n: &u32| Value::Count(*n), Count(n) => Some(*n))
    };
    ($table:ident . $name:ident: word $choice:ty) => {
        key!($table.$name, Kind::Word(words::<$choice>), |w: &$choice| Value::Word(w.word()),
            Word(w) => <$choice>::from_word(w))
    };
    ($table:ident . $name:ident: text $most:literal, $note:literal) => {
        key!($table.$name, Kind::Text($most, $note), |text: &String| Value::Text(text.clone()), Text(text) => Some(text.clone()))
    };
    ($table:ident . $name:ident: length $note:literal) => {
        key!($table.$name, Kind::Length($note), |text: &String| Value::Text(text.clone()), Text(text) => Some(text.clone()))
    };
    ($table:ident . $name:ident: flag) => {
        key!($table.$name, Kind::Flag, |flag: &bool| Value::Flag(*flag), Flag(flag) => Some(*flag))
    };
}

/// Every key of every table, in the order in which they are shown.
pub(super) static KEYS: &[Key] = &[
    key!(surface.length_m: number Limits {
        low: 1e-9, above: false, high: 1.0, unit: " m", unit_name: "metres", slip: Some((1e-6, "micrometres")), note: "",
    }),
    key!(surface.rms_height_m: number Limits {
        low: 1e-12, above: false, high: 0.1, unit: " m", unit_name: "metres", slip: Some((1e-6, "micrometres")), note: "",
    }),
    key!(surface.hurst: number Limits {
        low: 0.01, above: false, high: 1.0, unit: "", unit_name: "", slip: None,
        note: "H, Hurst exponent of a self-affine surface, 0.01 <= H <= 1; default 0.8",
    }),
    key!(surface.magnification: count 2 to 16384, &[],
        "ζ, magnification: longest over shortest wavelength of the roughness, 2 <= ζ <= 16384; default 128"),
    key!(surface.points_per_shortest_wavelength: count 4 to 64, &[
        (1, "1 point is below the Nyquist limit: the grid does not resolve the shortest wavelength"),
        (3, "2 or 3 points resolve the heights at the shortest wavelength; the derivatives at summits need at least 4"),
    ], "default 8"),
    key!(surface.normalization: word Normalization),
    key!(surface.amplitudes: word Amplitudes),
    key!(surface.file: text 4096, "the file of a measured surface, from the folder where the command is run"),
    key!(surface.dataset: text 256, "a dataset of the file"),
    key!(surface.periodic: flag),
    key!(surface.pixel_m: number Limits {
        low: 0.0, above: false, high: 0.1, unit: " m", unit_name: "metres", slip: Some((1e-6, "micrometres")),
        note: "pixel size; 0 if the file contains it",
    }),
    key!(surface.unit: length "the unit of the heights, for example \"nm\""),
    key!(surface.missing: word Missing),
    key!(surface.detrend: word Detrend),
    key!(material.contact_modulus_pa: number Limits {
        low: 1.0, above: false, high: 1e13, unit: " Pa", unit_name: "pascals", slip: Some((1e6, "megapascals")), note: "",
    }),
    key!(material.work_of_adhesion_j_m2: number Limits {
        low: 0.0, above: false, high: 1e3, unit: " J/m²", unit_name: "joules per square metre",
        slip: Some((1e-3, "millijoules per square metre")),
        note: "0 is the adhesionless limit: Hertzian asperities without dissipation",
    }),
    key!(material.interaction_range_m: number Limits {
        low: 1e-12, above: false, high: 1e-5, unit: " m", unit_name: "metres", slip: Some((1e-9, "nanometres")), note: "",
    }),
    key!(model.interaction: word Interaction),
    key!(model.boundary: word Boundary),
    key!(model.coalescence: word Coalescence),
    key!(model.jump_in: word JumpIn),
    key!(model.as_printed, Kind::Words(words::<Slip>),
        |slips: &Vec<Slip>| Value::Words(slips.iter().map(|slip| slip.word()).collect()),
        Words(w) => w.iter().map(|word| Slip::from_word(word)).collect::<Option<Vec<_>>>()),
    key!(model.allow_low_tabor: flag),
    key!(cycle.max_load, Kind::Numbers(Limits {
        low: 0.0, above: true, high: 0.2, unit: "", unit_name: "", slip: None,
        note: "F_max/(E* A0), maximum load, dimensionless; typical 0.004 to 0.015; near full contact above about 0.07",
    }, 64), |loads: &Vec<f64>| Value::Numbers(loads.clone()), Numbers(loads) => Some(loads.clone())),
    key!(cycle.approach_step: number Limits {
        low: 1e-5, above: false, high: 1.0, unit: "", unit_name: "", slip: None,
        note: "maximum output step of Δ/h_rms; default 0.01; 1e-5 gives about 500 000 steps per branch",
    }),
    key!(cycle.contacts: word KeptContacts),
];

/// The tables that hold the keys, in the order in which they are shown.
pub(super) const TABLES: [&str; 4] = ["surface", "material", "model", "cycle"];

/// Keys of `[surface]` that describe a measured surface.
pub const MEASURED: [&str; 7] = ["file", "dataset", "periodic", "pixel_m", "unit", "missing", "detrend"];
/// Keys of `[surface]` that describe a generated one.
pub(super) const GENERATED: [&str; 6] = ["length_m", "rms_height_m", "hurst", "magnification", "normalization", "amplitudes"];

/// The place in [`KEYS`] of a key of a table.
pub(super) fn find(table: &str, name: &str) -> Option<usize> {
    KEYS.iter().position(|key| key.table == table && key.name == name)
}

/// The names of the keys of a table.
pub(super) fn names(table: &str) -> impl Iterator<Item = &'static str> {
    KEYS.iter().filter(move |key| key.table == table).map(|key| key.name)
}
