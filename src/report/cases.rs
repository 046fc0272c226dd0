//! Rows of the table `cases`, with the labels and scales of the report.

use super::layout::{Group, grouped, prose, unbroken, wide};
use super::numbers::Scale;
use crate::model::{Choice as _, Method};
use crate::stats::{Listed, Listing, OfSweeps, StatsError, by_sweep, listing, loads};
use crate::store::Frame;
use maud::{Markup, html};

/// Columns of energies over `E* A0 h_rms`, which share one scale in all tables.
const ENERGIES: [&str; 10] = [
    "loss",
    "loss_dk",
    "loss_dk_realised",
    "loss_dk_probe",
    "loss_dk_probe_realised",
    "loss_touched",
    "loss_dalvi",
    "loss_pinning",
    "loss_jkr_curve",
    "dissipated",
];

/// The rows of the table `cases`, in the order and with the labels of the report.
pub(super) struct Cases<'a> {
    pub(super) frame: &'a Frame,
    pub(super) realizations: &'a Frame,
    load_symbol: &'static str,
    loads: Vec<String>,
    words: Vec<&'a str>,
    listing: Listing,
    /// The rows by sweep; empty for one sweep.
    sweeps: Vec<OfSweeps>,
}

impl<'a> Cases<'a> {
    pub(super) fn of(frame: &'a Frame, realizations: &'a Frame) -> Result<Self, StatsError> {
        let (loads, words) = (loads(frame)?, frame.text("caution")?);
        let load_symbol = loads.symbol;
        let loads = loads.all_labels();
        let mut listing = listing(frame)?;
        let sweeps = by_sweep(frame, &listing)?;
        let place = |row: usize| sweeps.iter().position(|of| of.rows.iter().any(|(own, _)| *own == row));
        listing.rows.sort_by_key(|listed| place(listed.row));
        Ok(Self { frame, realizations, load_symbol, loads, words, listing, sweeps })
    }

    /// The rows in the order of the tables.
    pub(super) fn rows(&self) -> &[Listed] {
        &self.listing.rows
    }

    /// The parameters of the reference case that vary, if there is such a case.
    pub(super) fn reference(&self) -> Option<&str> {
        self.listing.reference.as_deref()
    }

    /// The scale of the means of a column; all energies share one.
    pub(super) fn scale(&self, column: &str) -> Result<Scale, StatsError> {
        let columns = if ENERGIES.contains(&column) { ENERGIES.as_slice() } else { &[column] };
        let mut means = Vec::new();
        for column in columns {
            means.extend(self.frame.f64_or_null(&format!("{column}_mean"))?.iter().flatten().copied());
        }
        Ok(Scale::of(&means))
    }

    pub(super) fn number(&self, column: &str, row: usize) -> Result<Option<f64>, StatsError> {
        Ok(self.frame.f64_or_null(column)?.get(row).copied().flatten())
    }

    /// True if a row is of the asperity model.
    pub(super) fn has_spots(&self) -> Result<bool, StatsError> {
        Ok(self.frame.text("method")?.iter().any(|method| *method == Method::Asperities.word()))
    }

    /// Symbol of the normal load at load reversal, with the markup of the figures.
    pub(super) fn load_symbol(&self) -> &'static str {
        self.load_symbol
    }

    /// The first cells of the heading of every table.
    pub(super) fn name_heads(&self) -> Markup {
        html! { th { "case" } th { (prose(self.load_symbol())) } }
    }

    /// True if a row has a probe.
    pub(super) fn has_probe(&self) -> Result<bool, StatsError> {
        Ok(self.frame.f64_or_null("probe_radius_m")?.iter().any(Option::is_some))
    }

    /// The first two cells of a row: parameters that vary in its sweep, and load.
    pub(super) fn name(&self, listed: &Listed) -> Markup {
        let mut rows = self.sweeps.iter().flat_map(|of| &of.rows);
        let within = rows.find(|(row, _)| *row == listed.row).map(|(_, label)| label);
        html! { td { (unbroken(within.unwrap_or(&listed.label))) } td { (unbroken(self.load(listed.row))) } }
    }

    /// A wide table with a row for each row of the table `cases`, under the headings of their sweeps.
    pub(super) fn wide(&self, name: &str, head: &Markup, rows: Vec<(usize, Markup)>) -> Markup {
        if self.sweeps.is_empty() {
            return wide(name, head, &rows.into_iter().map(|(_, cells)| cells).collect::<Vec<_>>());
        }
        let group = |of: &OfSweeps| {
            let own = |row: usize| of.rows.iter().any(|(known, _)| *known == row);
            let rows = rows.iter().filter(|(row, _)| own(*row)).map(|(_, cells)| cells.clone());
            Group { heading: of.heading.clone(), rows: rows.collect() }
        };
        grouped(name, head, &self.sweeps.iter().map(group).collect::<Vec<_>>())
    }

    pub(super) fn load(&self, row: usize) -> &str {
        self.loads.get(row).map_or("", String::as_str)
    }

    /// True if a row has a warning.
    pub(super) fn has(&self, row: usize, word: &str) -> bool {
        self.words.get(row).is_some_and(|said| said.split('+').any(|part| part == word))
    }
}
