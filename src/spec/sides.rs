//! Sides of measured surfaces, by which loads in newtons are divided.
//!
//! A load in newtons is `F/(E* A0)` with the area `A0` of the square of its case. The square of a scan is
//! known from the file, unless the spec states both sizes. [`super::Spec::read_choosing`] reads the files,
//! and the resolved spec lists the sides: one of each point, or one of all.

use std::collections::BTreeMap;
use std::ops::Range;

use super::fault::Faults;
use super::keys::Limits;
use super::number::number;
use super::values::Values;
use super::written::{Written, array};

/// The list in a resolved spec.
pub(super) const KEY: &str = "scan_sides_m";

/// Bounds of a side.
pub(super) const LIMITS: Limits = Limits {
    low: 0.0,
    above: true,
    high: 1e3,
    unit: " m",
    unit_name: "metres",
    slip: None,
    note: "remove the line: the program writes it into campaign.toml",
};

/// A point whose scan must be read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Unread {
    /// Its place in the cases.
    pub(super) case: usize,
    /// Place of its loads in the text.
    pub(super) at: Range<usize>,
}

/// The sides of the points of a spec that need a scan.
#[derive(Default)]
pub(super) struct Sides {
    /// Sides that are known.
    given: Vec<f64>,
    /// Number of points so far.
    count: usize,
    /// True if the side of the last point is not known.
    is_unread: bool,
    /// Points whose side is not known.
    unread: Vec<Unread>,
}

impl Sides {
    /// With the sides that are known; none if no scan has been read.
    pub(super) fn of(given: Vec<f64>) -> Self {
        Self { given, ..Self::default() }
    }

    /// Sets the side of a point, if it is known. Sides of a list hold for the files whose checksums the spec
    /// has.
    pub(super) fn set<T>(&mut self, values: &mut Values, files: &BTreeMap<String, T>, is_read: bool) {
        self.is_unread = false;
        if !values.needs_side() {
            return;
        }
        let is_known = is_read || values.measured.names().iter().all(|name| files.contains_key(name));
        let side = match self.given.as_slice() {
            [only] => Some(*only),
            many => many.get(self.count).copied(),
        };
        values.side_m = side.filter(|_| is_known);
        self.count += 1;
        self.is_unread = values.side_m.is_none();
    }

    /// Notes the case of the point that was set, and the place of its loads, if its scan must be read.
    pub(super) fn note(&mut self, case: usize, at: Option<Range<usize>>) {
        let point = Unread { case, at: at.unwrap_or(0..0) };
        self.unread.extend(Some(point).filter(|_| self.is_unread));
    }

    /// Checks the number of listed sides.
    pub(super) fn check(&self, at: Option<&Range<usize>>, faults: &mut Faults<'_>) {
        let (given, count) = (self.given.len(), self.count);
        if given > 1 && given != count || given == 1 && count == 0 {
            let message = format!("`{KEY}` lists {given} sides, and {count} cases have a force on a scan");
            let help = format!("remove the line `{KEY}`: the scans are read again");
            faults.add(at.unwrap_or(&(0..0)), message, help);
        }
    }

    /// The record of the sides: one if all are equal.
    pub(super) fn settle(self) -> (Vec<f64>, Vec<Unread>) {
        let sides = if self.unread.is_empty() { collapsed(self.given) } else { Vec::new() };
        (sides, self.unread)
    }
}

/// One side in place of equal ones.
pub(super) fn collapsed(mut sides: Vec<f64>) -> Vec<f64> {
    if sides.windows(2).all(|pair| pair[0] == pair[1]) {
        sides.truncate(1);
    }
    sides
}

/// Reads the list of sides.
pub(super) fn sides(value: &Written<'_>, faults: &mut Faults<'_>) -> Vec<f64> {
    let elements = array(KEY, "numbers", value, faults).into_iter().flat_map(|array| array.iter());
    elements.filter_map(|element| number(KEY, &LIMITS, element, faults)).collect()
}
