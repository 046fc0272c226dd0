//! Definitions of all tables and columns: name, kind, unit, null, description, source.
//!
//! The writer, the checks of the reader, `schemas/*.json` and `schemas/README.md` are derived from it. This
//! module is independent of file formats.

mod avalanches;
mod cases;
mod comparison;
mod curves;
mod cutoff;
mod cycles;
mod estimates;
mod event_kinds;
mod grid_errors;
mod measured;
mod methods;
mod parameter;
mod parameters;
mod pooled_events;
mod probe_results;
mod realizations;
mod render;
mod run;
mod spectra;

pub use crate::physics::{EventCounts, EventGroup, EventKind, SpotStatus};
pub use avalanches::AVALANCHES;
pub use cases::CASES;
pub use comparison::COMPARISON;
pub use curves::{CURVES, PANELS};
pub use cutoff::{CUTOFF, SPECTRA};
pub use cycles::CYCLES;
pub use estimates::{
    DENG_KESARI, DENG_KESARI_PROBE, DENG_KESARI_PROBE_REALISED, DENG_KESARI_REALISED, ESTIMATES, OF_CYCLE,
    OF_LOAD, OF_SURFACE, SURFACE_ESTIMATES,
};
pub use event_kinds::{EVENT_COLOURS, EVENT_KINDS, event_kind};
pub use grid_errors::GRIDS;
pub use measured::{MEASURED_LOOPS, MEASURED_STEPS};
pub use methods::METHODS;
pub use parameter::{CaseFacts, Parameter, ParameterValue};
pub use parameters::{PARAMETERS, parameters_by_rank};
pub use pooled_events::POOLED_EVENTS;
pub use realizations::REALIZATIONS;
pub use render::{
    DIRECTORY, OWN_KEYS, SchemaFile, files, metadata_json, readme_markdown, schema_file_name, schema_json,
};
pub use run::{ADHESIONLESS, ASPERITIES, CONTACTS, EVENTS, MERGED, STEPS, TURNING};
pub use spectra::{SCAN_SPECTRA, SCANS, SPECTRUM};

/// Kind of the values of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A finite real number in double precision.
    F64,
    /// A whole number: an identity, a position or a count.
    I64,
    /// True or false.
    Bool,
    /// A word, from few different ones.
    Text,
}

impl Kind {
    /// The word of this kind in the schema files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::I64 => "i64",
            Self::Bool => "bool",
            Self::Text => "text",
        }
    }
}

/// One column of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Its name, ending in its SI unit if it has one.
    pub name: &'static str,
    /// Kind of its values.
    pub kind: Kind,
    /// SI unit, as UDUNITS, pint and astropy read it: "m", "J/m^2"; "1" if dimensionless or counted; empty
    /// for identities, words and truth values, which have none.
    pub unit: &'static str,
    /// True if a value may be missing. Missing is null, never 0.
    pub nullable: bool,
    /// Description in one sentence.
    pub doc: &'static str,
    /// The equation or publication that it comes from; empty if it needs none.
    pub source: &'static str,
}

/// One kind of table.
#[derive(Debug, PartialEq, Eq)]
pub struct Table {
    /// Its name.
    pub name: &'static str,
    /// Raised whenever a column is renamed, removed, or changes its meaning.
    pub version: u32,
    /// Path below the directory of a run; `<id>` stands for a unit's identity.
    pub file: &'static str,
    /// Description of a row.
    pub doc: &'static str,
    /// Its columns, in order.
    pub columns: &'static [Column],
}

impl Table {
    /// The column of this name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&'static Column> {
        self.columns.iter().find(|column| column.name == name)
    }
}

const CYCLE_ID: Column = text("cycle_id", "Identifier of the cycle: name of its directory below cycles/");
const REALIZATION: Column = index(
    "realization",
    "Number of the realization, from 0: surfaces of the same parameters that differ in the random numbers",
);
const SURFACE_ID: Column =
    text("surface_id", "Identifier of the surface: name of its file below surfaces/, without extension");
const ASPERITIES_ID: Column = text(
    "asperities_id",
    "Identifier of the asperity table: name of its file below asperities/, without extension; equal to \
     surface_id",
);

/// Every table that the program writes.
pub static TABLES: &[&Table] = &[
    &ASPERITIES,
    &SURFACE_ESTIMATES,
    &STEPS,
    &CONTACTS,
    &TURNING,
    &MERGED,
    &EVENTS,
    &ADHESIONLESS,
    &ESTIMATES,
    &REALIZATIONS,
    &CASES,
    &CURVES,
    &AVALANCHES,
    &POOLED_EVENTS,
    &CYCLES,
    &METHODS,
    &GRIDS,
    &PANELS,
    &COMPARISON,
    &MEASURED_LOOPS,
    &MEASURED_STEPS,
    &SCANS,
    &SCAN_SPECTRA,
    &SPECTRUM,
    &SPECTRA,
    &CUTOFF,
];

impl Column {
    /// This column, with values that may be missing.
    const fn or_null(self) -> Self {
        Self { nullable: true, ..self }
    }

    /// This column, with its equation or publication.
    const fn from(self, source: &'static str) -> Self {
        Self { source, ..self }
    }
}

const fn column(name: &'static str, kind: Kind, unit: &'static str, doc: &'static str) -> Column {
    Column { name, kind, unit, nullable: false, doc, source: "" }
}

/// A real number with a unit.
const fn real(name: &'static str, unit: &'static str, doc: &'static str) -> Column {
    column(name, Kind::F64, unit, doc)
}

/// A count.
const fn count(name: &'static str, doc: &'static str) -> Column {
    column(name, Kind::I64, "1", doc)
}

/// A whole number that names or orders something.
const fn index(name: &'static str, doc: &'static str) -> Column {
    column(name, Kind::I64, "", doc)
}

/// True or false.
const fn flag(name: &'static str, doc: &'static str) -> Column {
    column(name, Kind::Bool, "", doc)
}

/// A word.
const fn text(name: &'static str, doc: &'static str) -> Column {
    column(name, Kind::Text, "", doc)
}

/// Several lists of columns as one, so that columns which tables share are written once.
const fn join<const N: usize>(parts: &[&[Column]]) -> [Column; N] {
    let mut all = [text("", ""); N];
    let mut filled = 0;
    let mut part = 0;
    while part < parts.len() {
        let mut at = 0;
        while at < parts[part].len() {
            all[filled] = parts[part][at];
            filled += 1;
            at += 1;
        }
        part += 1;
    }
    all
}
