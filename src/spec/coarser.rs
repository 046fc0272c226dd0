//! Coarser grids of boundary elements, on which the loops of a case are repeated for its discretization
//! error.
//!
//! `boundary_elements.points = [64, 128, 256]` outside of sweeps lists them: the finest grid gives the
//! result. Each coarser grid is a case of its own, in the sweep [`COARSER`] alone, with the same surfaces.

use std::ops::Range;

use toml::de::DeValue;

use super::fault::Faults;
use super::keys::{KEYS, find};
use super::written::Written;
use super::{Case, CaseParams, Value, value};
use crate::model::MethodOptions;

/// Sweep of cases that are only coarser grids of others. No sweep of a spec can have this name.
pub const COARSER: &str = "coarser grids";

/// The key that takes a list of grids.
pub(super) const KEY: &str = "boundary_elements.points";

/// Largest number of grids in a list.
pub(super) const MOST: usize = 6;

/// A coarser grid of a list, and where it is written.
pub(super) type Coarser = (u32, Range<usize>);

impl Case {
    /// True if the case is only a coarser grid of others.
    #[must_use]
    pub fn is_coarser_grid(&self) -> bool {
        self.sweeps == [COARSER]
    }
}

impl CaseParams {
    /// The parameters of a case by boundary elements without its number of grid points; nothing for other
    /// methods.
    #[must_use]
    pub fn on_any_grid(&self) -> Option<Self> {
        let mut params = self.clone();
        let MethodOptions::Elements(options) = &mut params.method else { return None };
        options.points = None;
        Some(params)
    }
}

/// Reads a list of grids: the finest one, and the coarser ones ascending.
pub(super) fn grids(list: &Written<'_>, faults: &mut Faults<'_>) -> Option<(Value, Vec<Coarser>)> {
    let (DeValue::Array(elements), Some(place)) = (list.get_ref(), key()) else { return None };
    if elements.is_empty() || elements.len() > MOST {
        let message = if elements.is_empty() {
            format!("`{KEY}` is empty: it lists the grids of each case")
        } else {
            format!("`{KEY}` lists {} grids: at most {MOST} are allowed", elements.len())
        };
        faults.add(&list.span(), message, example());
        return None;
    }
    let read = |element: &Written<'_>| match value::read(&KEYS[place], element, faults)? {
        Value::Count(0) => {
            let message = format!("`{KEY}` cannot have 0 in a list: it chooses the grid");
            faults.add(&element.span(), message, example());
            None
        }
        Value::Count(points) => Some((points, element.span())),
        _ => None,
    };
    let read: Vec<Option<Coarser>> = elements.iter().map(read).collect();
    let mut grids = read.into_iter().collect::<Option<Vec<Coarser>>>()?;
    let unsorted = grids.iter().zip(&grids[1..]).find(|(before, after)| before.0 >= after.0);
    if let Some(((before, _), (points, span))) = unsorted {
        let mut sorted = points_of(&grids);
        sorted.sort_unstable();
        sorted.dedup();
        let message = if before == points {
            format!("`{KEY}` lists {points} twice")
        } else {
            format!("`{KEY}` lists {points} after {before}: grids must ascend, the finest last")
        };
        faults.add(span, message, format!("write points = {sorted:?}"));
        return None;
    }
    let (finest, _) = grids.pop()?;
    Some((Value::Count(finest), grids))
}

fn example() -> String {
    "write a number, or a list such as points = [64, 128, 256]".to_owned()
}

/// The numbers of a list of grids.
pub(super) fn points_of(grids: &[Coarser]) -> Vec<u32> {
    grids.iter().map(|(points, _)| *points).collect()
}

/// Place of the key among all keys.
pub(super) fn key() -> Option<usize> {
    KEY.split_once('.').and_then(|(table, name)| find(table, name))
}
