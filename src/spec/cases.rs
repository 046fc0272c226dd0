//! The different cases of a spec.

use super::{COARSER, Case, CaseParams};
use std::collections::HashMap;

/// The different cases, in the order of their first appearance.
#[derive(Default)]
pub(super) struct Cases {
    pub(super) list: Vec<Case>,
    places: HashMap<String, usize>,
}

impl Cases {
    /// Adds cases that are only coarser grids of others.
    pub(super) fn add_coarser(&mut self, all: Vec<CaseParams>) {
        for params in all {
            self.add(&[COARSER.to_owned()], params);
        }
    }

    /// Adds a case, or the names of its sweeps to an equal one; gives its place.
    pub(super) fn add(&mut self, sweeps: &[String], params: CaseParams) -> usize {
        // Every value is finite and none is a zero with a sign, so that equal cases are written alike, and
        // only they.
        let place = *self.places.entry(format!("{params:?}")).or_insert(self.list.len());
        if place == self.list.len() {
            self.list.push(Case { sweeps: Vec::new(), params });
        }
        let known = &mut self.list[place].sweeps;
        for sweep in sweeps {
            if !known.contains(sweep) {
                known.push(sweep.clone());
            }
        }
        // A case of the spec is more than a coarser grid of another one.
        if known.len() > 1 {
            known.retain(|name| name != COARSER);
        }
        place
    }
}
