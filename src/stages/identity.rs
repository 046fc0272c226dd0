//! Columns that identify a cycle in each of its tables.

use crate::campaign::{Campaign, CycleUnit};
use crate::schema::Table;
use crate::store::{Frame, FrameBuilder};
use std::iter::repeat_n;

/// Identity of a cycle: the same in every row of its tables.
#[derive(Debug, Clone, Copy)]
pub(super) struct Identity<'a> {
    cycle_id: &'a str,
    case_id: &'a str,
    realization: u32,
}

impl<'a> Identity<'a> {
    pub(super) fn of(campaign: &'a Campaign, unit: &'a CycleUnit) -> Self {
        let realization = campaign.surfaces[unit.surface].realization;
        Self { cycle_id: &unit.id, case_id: &unit.table_case_id, realization }
    }

    /// Begins a table with these columns and `rows` rows.
    pub(super) fn begin(&self, table: &'static Table, rows: usize) -> FrameBuilder {
        Frame::of(table)
            .text("cycle_id", repeat_n(self.cycle_id, rows))
            .text("case_id", repeat_n(self.case_id, rows))
            .i64("realization", repeat_n(i64::from(self.realization), rows))
    }
}
