//! Data of the explorer of the report: loops, events, contact spots and maps of one cycle for each case.

use super::StageError;
use super::explorer_maps::{LETTERS, ground, rounded, stored_maps};
use crate::campaign::{Campaign, CaseUnit, CycleUnit, Standing};
use crate::constants::Constant;
use crate::model::Boundary;
use crate::physics::RegionChange;
use crate::schema::{self, EVENT_COLOURS, EventKind, SpotStatus, Table};
use crate::stats::{Listing, listing, significant};
use crate::store::hdf5::read_surface;
use crate::store::parquet::read_table;
use crate::store::{Frame, FrameError};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Cycles, at most.
const MOST_CYCLES: usize = 12;
/// Points of a surface along a side, at most.
const MOST_POINTS: u64 = 8192;
/// Contact spots of all stored steps of a loop, at most: of more, evenly spaced steps are shown.
const MOST_SPOTS: usize = 40_000;

/// Limits of the loop explorer.
pub(super) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "cycles in the loop explorer",
        &[MOST_CYCLES as f64],
        "",
        "Maximum: one for each of the first cases.",
        "",
    ),
    Constant::new(
        "grid points along a side",
        &[MOST_POINTS as f64],
        "",
        "Maximum of a surface in the loop explorer.",
        "",
    ),
    Constant::new(
        "contact spots of a loop",
        &[MOST_SPOTS as f64],
        "",
        "Maximum of all stored steps. With more, evenly spaced steps are shown.",
        "",
    ),
];

/// Kinds of events of both methods, by their numbers in the data: word and name.
fn kinds() -> Vec<(&'static str, &'static str)> {
    let of_regions = RegionChange::ALL.map(|change| (change.word(), change.name()));
    EventKind::ALL.map(|kind| (kind.word(), kind.name())).into_iter().chain(of_regions).collect()
}

/// The data as JSON; nothing without a finished cycle.
pub(super) fn explorer(
    campaign: &Campaign,
    standings: &[Standing],
    cases: &Frame,
    methods: &Frame,
) -> Result<Option<String>, StageError> {
    let pairs = Pairs::of(methods)?;
    let picked = pick(campaign, standings, &pairs);
    let list = listing(cases)?;
    let mut all = Vec::new();
    for unit in &picked {
        let mut of = cycle(campaign, unit)?;
        of["name"] = json!(name(campaign, unit, cases, &list)?);
        if let Some(place) = picked.iter().position(|other| pairs.holds(campaign, unit, other)) {
            of["other"] = json!(place);
        }
        all.push(of);
    }
    if all.is_empty() {
        return Ok(None);
    }
    // No text of the data ends the element that holds it.
    let names: Vec<_> = kinds().into_iter().map(|(_, name)| name).collect();
    let statuses = SpotStatus::ALL.map(SpotStatus::word);
    let data = json!({
        "cycles": all, "names": names, "colours": EVENT_COLOURS, "statuses": statuses, "letters": LETTERS,
    });
    Ok(Some(data.to_string().replace('<', "\\u003c")))
}

/// Cases of the two methods with otherwise equal parameters, for each surface that both have finished.
struct Pairs<'a> {
    cases: [Vec<&'a str>; 2],
    surfaces: Vec<&'a str>,
}

impl<'a> Pairs<'a> {
    fn of(methods: &'a Frame) -> Result<Self, FrameError> {
        let cases = [methods.text("asperities_case_id")?, methods.text("elements_case_id")?];
        Ok(Self { cases, surfaces: methods.text("surface_id")? })
    }

    /// Surface of the first pair with this case.
    fn surface(&self, case: &str) -> Option<&str> {
        (0..self.surfaces.len())
            .find(|row| self.cases.iter().any(|ids| ids[*row] == case))
            .map(|row| self.surfaces[row])
    }

    /// True if two cycles are one case by both methods on one surface.
    fn holds(&self, campaign: &Campaign, one: &CycleUnit, other: &CycleUnit) -> bool {
        let surface = &campaign.surfaces[one.surface].id;
        let [first, second] = [one, other].map(|unit| campaign.cases[unit.case].id.as_str());
        let of_row = |row: usize| {
            let pair = [self.cases[0][row], self.cases[1][row]];
            self.surfaces[row] == surface && (pair == [first, second] || pair == [second, first])
        };
        one.surface == other.surface && (0..self.surfaces.len()).any(of_row)
    }
}

/// One finished cycle of each case: where both methods have finished a surface, on that one.
fn pick<'a>(campaign: &'a Campaign, standings: &[Standing], pairs: &Pairs<'_>) -> Vec<&'a CycleUnit> {
    let finished = |unit: &CycleUnit| {
        campaign.surfaces[unit.surface].params.generated().is_none_or(|surface| surface.grid() <= MOST_POINTS)
    };
    let done: Vec<&CycleUnit> = campaign
        .cycles
        .iter()
        .zip(standings)
        .filter(|(_, of)| **of == Standing::Done)
        .map(|(unit, _)| unit)
        .collect();
    let mut picked: Vec<&CycleUnit> = Vec::new();
    let shown = |(_, case): &(usize, &CaseUnit)| !case.case.is_coarser_grid();
    for (place, case) in campaign.cases.iter().enumerate().filter(shown) {
        let of_case = || done.iter().filter(|unit| unit.case == place && finished(unit));
        let paired = pairs
            .surface(&case.id)
            .and_then(|id| of_case().find(|unit| campaign.surfaces[unit.surface].id == id));
        let Some(unit) = paired.or_else(|| of_case().next()) else { continue };
        if picked.iter().all(|other| other.id != unit.id) && picked.len() < MOST_CYCLES {
            picked.push(unit);
        }
    }
    picked
}

/// Name of a cycle: the label of its case, the method where both are there, and the realization.
fn name(campaign: &Campaign, unit: &CycleUnit, cases: &Frame, list: &Listing) -> Result<String, StageError> {
    let (ids, case) = (cases.text("case_id")?, &campaign.cases[unit.case]);
    let label =
        list.rows.iter().find(|listed| ids[listed.row] == case.id).map_or("", |listed| listed.label.as_str());
    let label = if label.is_empty() { case.id.as_str() } else { label };
    Ok(format!("{label}, realization {}", unit.realization))
}

/// File of the maps of a cycle.
const MAPS: &str = "maps.h5";

/// Tables of a cycle.
struct Tables {
    steps: Frame,
    events: Frame,
    contacts: Frame,
    merged: Option<Frame>,
}

fn cycle(campaign: &Campaign, unit: &CycleUnit) -> Result<Value, StageError> {
    let (surface, params) = (&campaign.surfaces[unit.surface], &campaign.cases[unit.case].case.params);
    let folder = campaign.cycle_dir(unit);
    let table = |table: &'static Table| read_table(&folder.join(format!("{}.parquet", table.name)), table);
    // Files that one of the methods alone writes say what there is to be shown.
    let is_there = |file: &str| folder.join(file).is_file();
    let merged = is_there("merged.parquet").then(|| table(&schema::MERGED)).transpose()?;
    let tables = Tables {
        steps: table(&schema::STEPS)?,
        events: table(&schema::EVENTS)?,
        contacts: table(&schema::CONTACTS)?,
        merged,
    };
    let (header, heights) = read_surface(&campaign.surface_path(surface))?;
    let mut of = json!({ "id": unit.id, "length_m": header.length_m });
    let force = params.material.contact_modulus_pa * header.length_m.powi(2);
    let energy = force * header.rms_height_m;
    if params.probe.is_some() {
        of["probe"] = json!({ "unit_n": force, "unit_m": header.rms_height_m });
    }
    let mut spots = Spots::default();
    if is_there(MAPS) {
        of["loops"] = loops(&tables, &spots, energy, header.length_m)?;
        stored_maps(&folder.join(MAPS), &mut of["loops"])?;
        return Ok(of);
    }
    spots.find(
        &tables,
        &read_table(&campaign.asperities_path(surface), &schema::ASPERITIES)?,
        header.length_m,
    )?;
    of["loops"] = loops(&tables, &spots, energy, header.length_m)?;
    of["ground"] = json!(ground(heights.view()));
    of["periodic"] = json!(params.boundary() == Boundary::Periodic);
    of["ids"] = json!(spots.ids.keys().map(|key| key.1).collect::<Vec<_>>());
    of["x"] = json!(spots.at.iter().map(|at| at.0).collect::<Vec<_>>());
    of["y"] = json!(spots.at.iter().map(|at| at.1).collect::<Vec<_>>());
    of["merged"] = Value::Object(spots.merged);
    Ok(of)
}

/// Number of an asperity or a merged contact. Those of merged contacts go on during each unloading from that
/// of its load reversal, so that its load belongs to them (bits of F_max).
type Key = (Option<u64>, i64);
/// Both parts and the centre \[m\] of each merged contact.
type Parts = BTreeMap<Key, ([i64; 2], (f64, f64))>;

/// Contact spots of a cycle.
#[derive(Default)]
struct Spots {
    /// Asperities and merged contacts, and their places in the data.
    ids: BTreeMap<Key, usize>,
    /// Centres in 10⁻⁴ of the side of the square.
    at: Vec<(i64, i64)>,
    /// Places of the two parts of each merged contact.
    merged: Map<String, Value>,
}

impl Spots {
    /// The asperities and merged contacts that have an event or are stored in contact.
    fn find(&mut self, tables: &Tables, asperities: &Frame, length_m: f64) -> Result<(), FrameError> {
        let merged = tables.merged.as_ref().map(parts).transpose()?.unwrap_or_default();
        let key = |branch: Option<u64>, id: i64| {
            if merged.contains_key(&(branch, id)) { (branch, id) } else { (None, id) }
        };
        let mut used: BTreeSet<Key> = BTreeSet::new();
        for table in [&tables.events, &tables.contacts] {
            let rows = table.f64_or_null("max_load")?.iter().zip(table.i64_or_null("asperity_id")?);
            used.extend(rows.filter_map(|(load, id)| id.map(|id| key(load.map(f64::to_bits), id))));
        }
        used.extend(merged.iter().flat_map(|((branch, _), (of, _))| of.map(|part| key(*branch, part))));
        let (x, y) = (asperities.f64("x_m")?, asperities.f64("y_m")?);
        for spot in used {
            let own =
                || usize::try_from(spot.1).ok().and_then(|id| x.get(id).copied().zip(y.get(id).copied()));
            if let Some((x, y)) = merged.get(&spot).map(|(_, at)| *at).or_else(own) {
                self.ids.insert(spot, self.at.len());
                self.at.push(((x / length_m * 1e4).round() as i64, (y / length_m * 1e4).round() as i64));
            }
        }
        for (spot, (of, _)) in &merged {
            if let Some(place) = self.ids.get(spot) {
                let of: Vec<usize> =
                    of.iter().filter_map(|part| self.ids.get(&key(spot.0, *part)).copied()).collect();
                self.merged.insert(place.to_string(), json!(of));
            }
        }
        Ok(())
    }

    /// Place of a spot in the data, on loading or on the unloading from a load.
    fn place(&self, max_load: Option<f64>, id: Option<i64>) -> Option<usize> {
        let found = |branch| self.ids.get(&(branch, id?)).copied();
        found(max_load.map(f64::to_bits)).or_else(|| found(None))
    }
}

fn parts(merged: &Frame) -> Result<Parts, FrameError> {
    let [ids, first, second] =
        [merged.i64("asperity_id")?, merged.i64("first_id")?, merged.i64("second_id")?];
    let (x, y, of) = (merged.f64("x_m")?, merged.f64("y_m")?, merged.f64_or_null("max_load")?);
    let key = |row: usize| (of[row].map(f64::to_bits), ids[row]);
    Ok((0..ids.len()).map(|row| (key(row), ([first[row], second[row]], (x[row], y[row])))).collect())
}

/// The loops of all load reversals: loading up to the reversal, and unloading from it.
fn loops(tables: &Tables, spots: &Spots, energy_j: f64, length_m: f64) -> Result<Value, FrameError> {
    let steps = &tables.steps;
    let (numbers, branches, of) = (steps.i64("step")?, steps.text("branch")?, steps.f64_or_null("max_load")?);
    let (load, penetration, area, count) =
        (steps.f64("load")?, steps.f64("penetration")?, steps.f64("area")?, steps.i64("contact_count")?);
    let reversed = steps.f64_or_null("reversal_load")?;
    let mut reversals: Vec<f64> = of.iter().flatten().copied().collect();
    reversals.sort_by(f64::total_cmp);
    reversals.dedup();
    let mut all = Vec::new();
    for max_load in reversals {
        let Some(reversal) = reversed.iter().position(|load| *load == Some(max_load)) else { continue };
        let loading: Vec<usize> = (0..=reversal).filter(|row| branches[*row] == "loading").collect();
        let down =
            (0..numbers.len()).filter(|row| branches[*row] == "unloading" && of[*row] == Some(max_load));
        let rows: Vec<usize> = loading.iter().copied().chain(down).collect();
        let places: BTreeMap<i64, usize> =
            rows.iter().enumerate().map(|(k, row)| (numbers[*row], k)).collect();
        let column = |values: &[f64]| rows.iter().map(|row| rounded(values[*row])).collect::<Vec<f64>>();
        all.push(json!({
            "load": max_load,
            "up": loading.len(),
            "s": rows.iter().map(|row| numbers[*row]).collect::<Vec<_>>(),
            "f": column(&load),
            "d": column(&penetration),
            "a": column(&area),
            "n": rows.iter().map(|row| count[*row]).collect::<Vec<_>>(),
            "events": events(&tables.events, spots, &places, energy_j)?,
            "frames": frames(&tables.contacts, spots, &places, length_m)?,
        }));
    }
    Ok(Value::Array(all))
}

/// Events of a loop: place of the step, kind, spot or -1, avalanche, dissipated energy over `E* A0 h_rms`,
/// status or null.
fn events(
    events: &Frame,
    spots: &Spots,
    places: &BTreeMap<i64, usize>,
    energy_j: f64,
) -> Result<Value, FrameError> {
    let numbered = kinds();
    let (steps, kinds, ids) = (events.i64("step")?, events.text("kind")?, events.i64_or_null("asperity_id")?);
    let statuses = events.text_or_null("status")?;
    let (avalanches, energies, of) =
        (events.i64("avalanche_id")?, events.f64_or_null("energy_lost_j")?, events.f64_or_null("max_load")?);
    let mut rows: Vec<(usize, Value)> = Vec::new();
    for row in 0..steps.len() {
        let (Some(k), Some(kind)) =
            (places.get(&steps[row]), numbered.iter().position(|(word, _)| *word == kinds[row]))
        else {
            continue;
        };
        let spot = spots.place(of[row], ids[row]).map_or(-1, |spot| spot as i64);
        let energy =
            significant(energies[row].unwrap_or_default() / energy_j, 3).parse::<f64>().unwrap_or_default();
        let status =
            SpotStatus::ALL.iter().position(|status| Some(status.word()) == statuses[row].as_deref());
        rows.push((*k, json!([k, kind, spot, avalanches[row], energy, status])));
    }
    rows.sort_by_key(|(k, _)| *k);
    Ok(rows.into_iter().map(|(_, row)| row).collect())
}

/// Contact spots of the stored steps of a loop: spot, and radius in 10⁻⁵ of the side, negative for a tensile
/// load.
fn frames(
    contacts: &Frame,
    spots: &Spots,
    places: &BTreeMap<i64, usize>,
    length_m: f64,
) -> Result<Value, FrameError> {
    let (steps, states, ids) =
        (contacts.i64("step")?, contacts.text("state")?, contacts.i64_or_null("asperity_id")?);
    let (radii, loads, of) = (
        contacts.f64_or_null("contact_radius_m")?,
        contacts.f64_or_null("load_n")?,
        contacts.f64_or_null("max_load")?,
    );
    let mut frames: BTreeMap<usize, Vec<i64>> = BTreeMap::new();
    for row in (0..steps.len()).filter(|row| states[*row] == "contact") {
        let (Some(k), Some(spot)) = (places.get(&steps[row]), spots.place(of[row], ids[row])) else {
            continue;
        };
        let radius = ((radii[row].unwrap_or_default() / length_m * 1e5).round() as i64).max(1);
        frames
            .entry(*k)
            .or_default()
            .extend([spot as i64, if loads[row].unwrap_or_default() < 0.0 { -radius } else { radius }]);
    }
    let every = (frames.values().map(Vec::len).sum::<usize>() / 2).div_ceil(MOST_SPOTS).max(1);
    let kept = frames.into_iter().enumerate().filter(|(place, _)| place % every == 0);
    Ok(Value::Object(kept.map(|(_, (k, frame))| (k.to_string(), json!(frame))).collect()))
}
