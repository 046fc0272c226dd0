//! Coarser grids of boundary elements, on which the loops of a case are repeated for its discretization
//! error.
//!
//! `boundary_elements.points = [64, 128, 256]` outside of sweeps lists them, or `points_per_wavelength = [4,
//! 8, 16]`: the finest grid gives the result. Each coarser grid is a case of its own, in the sweep
//! [`COARSER`] alone, with the same surfaces. `boundary_elements.error` begins with three grids and adds
//! finer ones, see [`Spec::refined`]. With `boundary_elements.shifted_copies` the coarsest grid is repeated
//! with shifted points, as further cases of that sweep.

use std::ops::Range;

use toml::de::DeValue;

use super::cases::Cases;
use super::elements::latest;
use super::fault::Faults;
use super::keys::{KEYS, Key, find};
use super::number::short;
use super::origin::{Origin, written};
use super::per_wavelength::AUTOMATIC;
use super::probe::exclude;
use super::written::Written;
use super::{Case, CaseParams, Spec, Value, Values, value};
use crate::model::{Method, MethodOptions};

/// Sweep of cases that are only coarser grids of others. No sweep of a spec can have this name.
pub const COARSER: &str = "coarser grids";

/// The keys that take a list of grids.
pub(super) const LISTS: [&str; 2] = ["boundary_elements.points", "boundary_elements.points_per_wavelength"];

/// The keys that choose the grid, of which a case has one.
pub(super) const CHOICES: [&str; 3] = [LISTS[0], LISTS[1], ERROR];

/// The key of a required grid error.
pub(super) const ERROR: &str = "boundary_elements.error";

/// The key of the number of shifted copies.
const COPIES: &str = "boundary_elements.shifted_copies";

/// The keys that hold for all cases.
pub(super) const FOR_ALL: [&str; 3] = [ERROR, "boundary_elements.max_points", COPIES];

/// Points per shortest wavelength of the first grids for a required grid error.
const FIRST: [u32; 3] = [4, 8, 16];

/// Smallest grid error that can be required: that of the estimate.
const SMALLEST: f64 = 0.005;

/// Fewest points per shortest wavelength.
const FEWEST: u32 = FIRST[0];

/// Largest number of grids in a list.
pub(super) const MOST: usize = 6;

/// A coarser grid of a list, and where it is written.
pub(super) type Coarser = (u32, Range<usize>);

impl Case {
    /// True if the case is only a coarser grid of others, or a shifted copy of it.
    #[must_use]
    pub fn is_coarser_grid(&self) -> bool {
        self.sweeps == [COARSER]
    }

    /// True if the case is a shifted copy of a coarser grid.
    #[must_use]
    pub fn is_shifted_copy(&self) -> bool {
        self.params.elements().is_some_and(|options| options.shift != 0.0)
    }

    /// Words for a case that is only a coarser grid of others or its shifted copy.
    #[must_use]
    pub fn kind_of_grid(&self) -> &'static str {
        if self.is_shifted_copy() { "shifted copy" } else { "coarser grid" }
    }
}

impl CaseParams {
    /// The parameters with twice the grid points of boundary elements.
    #[must_use]
    pub fn on_finer_grid(&self) -> Self {
        let mut params = self.clone();
        if let MethodOptions::Elements(options) = &mut params.method {
            match &mut options.points {
                Some(points) => *points *= 2,
                None => {
                    let number = options.per_wavelength.unwrap_or(AUTOMATIC);
                    options.per_wavelength = Some(2 * number);
                }
            }
        }
        params
    }

    /// The parameters on a grid of boundary elements that is shifted by a part of its spacing.
    pub(super) fn shifted(&self, shift: f64) -> Self {
        let mut params = self.clone();
        if let MethodOptions::Elements(options) = &mut params.method {
            options.shift = shift;
        }
        params
    }

    /// The parameters of a case by boundary elements without its number of grid points and their shift;
    /// nothing for other methods.
    #[must_use]
    pub fn on_any_grid(&self) -> Option<Self> {
        let mut params = self.clone();
        let MethodOptions::Elements(options) = &mut params.method else { return None };
        (options.points, options.per_wavelength, options.shift) = (None, None, 0.0);
        Some(params)
    }
}

/// Reads a list of grids of a key: the finest one, and the coarser ones ascending.
pub(super) fn grids(key: &Key, list: &Written<'_>, faults: &mut Faults<'_>) -> Option<(Value, Vec<Coarser>)> {
    let DeValue::Array(elements) = list.get_ref() else { return None };
    let path = key.path;
    if elements.is_empty() || elements.len() > MOST {
        let message = if elements.is_empty() {
            format!("`{path}` is empty: it lists the grids of each case")
        } else {
            format!("`{path}` lists {} grids: at most {MOST} are allowed", elements.len())
        };
        faults.add(&list.span(), message, example(key));
        return None;
    }
    let read = |element: &Written<'_>| match value::read(key, element, faults)? {
        Value::Count(0) => {
            let message = format!("`{path}` cannot have 0 in a list: it chooses the grid");
            faults.add(&element.span(), message, example(key));
            None
        }
        Value::Count(few) if few < fewest(key) => {
            too_few(&element.span(), few, faults);
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
            format!("`{path}` lists {points} twice")
        } else {
            format!("`{path}` lists {points} after {before}: grids must ascend, the finest last")
        };
        faults.add(span, message, format!("write {} = {sorted:?}", key.name));
        return None;
    }
    let (finest, _) = grids.pop()?;
    Some((Value::Count(finest), grids))
}

/// Smallest number in a list of grids of a key.
pub(super) fn fewest(key: &Key) -> u32 {
    if key.path == LISTS[1] { FEWEST } else { 1 }
}

fn example(key: &Key) -> String {
    let list = if key.path == LISTS[0] { "[64, 128, 256]" } else { "[4, 8, 16]" };
    format!("write a number, or a list such as {} = {list}", key.name)
}

/// The numbers of a list of grids.
pub(super) fn points_of(grids: &[Coarser]) -> Vec<u32> {
    grids.iter().map(|(points, _)| *points).collect()
}

/// Place of a key of [`CHOICES`] among all keys.
pub(super) fn place(path: &str) -> Option<usize> {
    path.split_once('.').and_then(|(table, name)| find(table, name))
}

/// Clears the other choices of a grid, where one of them is replaced.
pub(super) fn clear_others(chosen: usize, others: &[&str], values: &mut Values, origins: &mut [Origin]) {
    let default = Values::default();
    for other in others.iter().filter_map(|path| place(path)).filter(|other| *other != chosen) {
        let key = &KEYS[other];
        (key.set)(values, &(key.get)(&default));
        origins[other] = Origin::Default;
    }
}

/// Refuses a key of a sweep that holds for all cases; true if it is one.
pub(super) fn refuses_sweep(key: &Key, at: &Range<usize>, faults: &mut Faults<'_>) -> bool {
    let refuses = FOR_ALL.contains(&key.path);
    if refuses {
        let message = format!("`{}` cannot be swept: it holds for all cases", key.path);
        faults.add(at, message, "move it out of the [[sweep]]".to_owned());
    }
    refuses
}

/// Checks the keys that choose the grid, with the coarser ones of a list.
pub(super) fn check_choice(values: &Values, listed: &[Coarser], origins: &[Origin], faults: &mut Faults<'_>) {
    check_copies(values, listed, origins, faults);
    let [points, number, error] = CHOICES;
    for pair in [[points, number], [points, error], [number, error]] {
        exclude(pair, "each of them chooses the grids: give one", origins, faults);
    }
    let at = |path: &str| written(place(path), origins);
    if let (Some(few @ 1..FEWEST), Some(span)) = (values.elements.per_wavelength, at(number)) {
        too_few(&span, few, faults);
    }
    if let (Some(small), Some(span)) = (values.goal.error.filter(|of| *of < SMALLEST), at(ERROR)) {
        let message = format!("`{ERROR}` is {}: the smallest estimate is {SMALLEST}", short(small));
        faults.add(&span, message, "write a larger error, such as 0.05 for 5 %".to_owned());
    }
}

/// Refuses a number of points per shortest wavelength below [`FEWEST`].
fn too_few(at: &Range<usize>, few: u32, faults: &mut Faults<'_>) {
    let message = format!("`{}` is {few}: at least {FEWEST} are needed", LISTS[1]);
    faults.add(at, message, format!("{FEWEST} resolve the waves, 8 and more the events"));
}

/// Shifted copies of a case on the coarsest grid: by k/(n + 1) of its spacing, k = 1 to n.
pub(super) fn copies(coarsest: &CaseParams, count: u32) -> Vec<CaseParams> {
    (1..=count).map(|k| coarsest.shifted(f64::from(k) / f64::from(count + 1))).collect()
}

/// Checks the requirements of shifted copies on the grids and on the surface.
fn check_copies(values: &Values, listed: &[Coarser], origins: &[Origin], faults: &mut Faults<'_>) {
    let [points, number, error] = CHOICES;
    let span = written(place(COPIES), origins).filter(|_| values.goal.shifted_copies > 0);
    // A faulty choice of the grids is refused by itself.
    let is_known = latest(&[COPIES, points, number, error], origins).is_some();
    let Some(span) = span.filter(|_| is_known) else { return };
    let mut refuse = |problem: &str, help: &str| {
        faults.add(&span, format!("`{COPIES}` needs {problem}"), help.to_owned());
    };
    if listed.is_empty() && values.goal.error.is_none() {
        refuse(
            "a list of grids: the coarsest one is shifted",
            "add points = [64, 128, 256], or error = 0.05",
        );
    }
    if values.method != Method::BoundaryElements {
        return;
    }
    if values.measured.is_named() && !values.measured.periodic {
        refuse(
            "periodic surfaces: mirror images cannot be shifted",
            "remove the key, or use surface.periodic = true with a periodic scan",
        );
    }
    if values.radius_m.is_some() {
        refuse("surfaces without a probe, which is not periodic", "remove the key, or probe.radius_m");
    }
}

/// Sets the finest of the first grids of a case for a required grid error, and gives the coarser ones: those
/// of [`FIRST`] up to the maximum. The grids of a scan are known after it is read.
pub(super) fn first_grids(values: &mut Values, origins: &[Origin], faults: &mut Faults<'_>) -> Vec<Coarser> {
    let (Some(span), Method::BoundaryElements) = (written(place(ERROR), origins), values.method) else {
        return Vec::new();
    };
    // Refused by the check of the choice. An error of 0 is none.
    if values.goal.error.is_none() || LISTS.iter().any(|path| written(place(path), origins).is_some()) {
        return Vec::new();
    }
    let points = |number: u32, values: &mut Values| {
        values.elements.per_wavelength = Some(number);
        values.case().elements().and_then(|options| options.points)
    };
    let mut grids: Vec<(u32, Option<u32>)> =
        FIRST.iter().map(|number| (*number, points(*number, values))).collect();
    let needed = grids[1].1;
    grids.retain(|(_, points)| points.is_none_or(|points| points <= values.goal.max_points));
    grids.dedup_by_key(|(number, points)| points.unwrap_or(*number));
    if let [_] | [] = grids[..] {
        let (most, needed) = (values.goal.max_points, needed.unwrap_or_default());
        let message = format!(
            "a grid error needs two grids, with 4 and 8 points per shortest wavelength: {needed} points a \
             side, and `boundary_elements.max_points` is {most}"
        );
        faults.add(&span, message, "increase boundary_elements.max_points, or use a smaller ζ".to_owned());
    }
    let finest = grids.pop();
    values.elements.per_wavelength = finest.map(|(number, _)| number);
    grids.into_iter().map(|(number, _)| (number, span.clone())).collect()
}

impl Spec {
    /// The spec with twice the grid points in some of its cases, by their places; their present grids are
    /// coarser ones. Other cases keep their places.
    #[must_use]
    pub fn refined(&self, places: &[usize]) -> Self {
        let (coarser, shown): (Vec<Case>, Vec<Case>) =
            self.cases.iter().cloned().partition(Case::is_coarser_grid);
        let (mut cases, mut all) = (Cases::default(), Vec::new());
        for (place, mut case) in shown.into_iter().enumerate() {
            let family = case.params.on_any_grid();
            let own = coarser.iter().filter(|of| family.is_some() && of.params.on_any_grid() == family);
            all.extend(own.map(|of| of.params.clone()));
            if places.contains(&place) {
                let finer = case.params.on_finer_grid();
                all.push(std::mem::replace(&mut case.params, finer));
            }
            cases.add(&case.sweeps, case.params);
        }
        cases.add_coarser(all);
        Self { cases: cases.list, ..self.clone() }
    }
}
