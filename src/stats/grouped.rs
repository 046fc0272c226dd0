//! Groups of rows with equal keys, by Polars.

use polars::prelude::{
    Column, DataFrame, GroupsIndicator, IdxSize, IntoColumn, NamedFrom, PolarsResult, Series,
    SortMultipleOptions,
};

/// Column of the numbers of the rows.
const ROW: &str = "row";

/// Rows with equal keys. The columns are the keys and the columns of the order within a group; rows with an
/// equal order keep theirs. The groups are in the order of their first rows.
pub(super) fn grouped(
    mut columns: Vec<Column>,
    keys: &[&str],
    order: &[&str],
) -> PolarsResult<Vec<Vec<usize>>> {
    let count = columns.first().map_or(0, Column::len);
    columns.push(Series::new(ROW.into(), (0..count as IdxSize).collect::<Vec<IdxSize>>()).into_column());
    let options = SortMultipleOptions::default().with_maintain_order(true);
    let sorted = DataFrame::new_infer_height(columns)?.sort(order.iter().copied(), options)?;
    let rows: Vec<usize> =
        sorted.column(ROW)?.idx()?.iter().map(|row| row.unwrap_or_default() as usize).collect();
    let groups = sorted.group_by_stable(keys.iter().copied())?.into_groups();
    let of_group = |group: Vec<IdxSize>| group.into_iter().map(|place| rows[place as usize]).collect();
    Ok(groups
        .iter()
        .map(|group| {
            of_group(match group {
                GroupsIndicator::Idx((_, places)) => places.to_vec(),
                GroupsIndicator::Slice([first, len]) => (first..first + len).collect(),
            })
        })
        .collect())
}
