//! Warnings of boundary elements before a run.

use super::super::super::cost::Cost;
use super::super::super::outside::{Outside, in_words, interval};
use super::ElementsCase;
use super::cost::{LONG, cost};
use super::lattice::Lattice;
use super::slow_grid::slow_grids;
use crate::campaign::{Campaign, CaseUnit};
use crate::spec::{FEWEST_PER_WAVELENGTH, MANY_RANGE_STEPS};
use crate::stats::{Caution, MANY_STEPS, significant};

const LONG_LOOP: Caution = Caution {
    code: "long_loop",
    label: "long loop",
    text: "one loop takes about {}",
    consequence: "A run has no result before the end of a loop.",
    action: "Use a smaller grid.",
};

/// A case of boundary elements with the cost of its cycles and its `U_el/Δγ`.
struct Costly<'a> {
    unit: &'a CaseUnit,
    of: ElementsCase<'a>,
    cost: Cost,
    ratio: Option<f64>,
}

/// Warnings of boundary elements; `costs` are those of the cases with their `U_el/Δγ`, in their order.
pub(in crate::stages) fn announced(
    campaign: &Campaign,
    costs: &[(Option<Cost>, Option<f64>)],
) -> Vec<Outside> {
    let costly = campaign.cases.iter().zip(costs).filter_map(|(unit, (cost, ratio))| {
        let params = &unit.case.params;
        Some(Costly {
            unit,
            of: ElementsCase { params, options: params.elements()? },
            cost: (*cost)?,
            ratio: *ratio,
        })
    });
    let all: Vec<Costly<'_>> = costly.collect();
    let found = [coarse(&all), many_steps(campaign), slow_grids(campaign), long_loops(&all)];
    found.into_iter().flatten().collect()
}

/// Cases with fewer grid points per shortest wavelength than recommended.
fn coarse(all: &[Costly<'_>]) -> Option<Outside> {
    let shown = all.iter().filter(|of| !of.unit.case.is_coarser_grid());
    Outside::of("coarse", shown.map(|of| (of.unit.id.clone(), of.cost.per_wavelength)))
}

/// Cases with a generated surface whose attraction acts over many steps.
fn many_steps(campaign: &Campaign) -> Option<Outside> {
    let steps = |unit: &CaseUnit| {
        let params = &unit.case.params;
        let (of, surface) =
            (ElementsCase { params, options: params.elements()? }, params.surface.generated()?);
        of.range_steps(&Lattice::of_generated(of, surface), surface.rms_height_m)
            .filter(|steps| *steps > MANY_RANGE_STEPS)
    };
    let many = campaign.cases.iter().filter_map(|unit| Some((unit.id.clone(), steps(unit)?.round())));
    let (cases, values): (Vec<String>, Vec<f64>) = many.unzip();
    let range = [values.iter().copied().reduce(f64::min)?, values.iter().copied().reduce(f64::max)?];
    let measured =
        format!("{} (limit ≤ {MANY_RANGE_STEPS})", MANY_STEPS.text.replace("{}", &interval(range)));
    Some(Outside { kind: MANY_STEPS, limit: MANY_RANGE_STEPS, range, measured, cases })
}

/// Cases with a loop of more than ten minutes.
fn long_loops(all: &[Costly<'_>]) -> Option<Outside> {
    let long: Vec<&Costly<'_>> = all.iter().filter(|of| of.cost.seconds > LONG).collect();
    let longest = long.iter().max_by(|a, b| a.cost.seconds.total_cmp(&b.cost.seconds))?;
    let minutes = || long.iter().map(|of| of.cost.seconds / 60.0);
    let range = [minutes().reduce(f64::min)?, minutes().reduce(f64::max)?];
    let cost_of_all = longest.cost;
    let smaller = (1..).map(|half| cost_of_all.points >> half).take_while(|points| *points >= 16);
    let enough = |points: u64| cost_of_all.per_wavelength * points as f64 / cost_of_all.points as f64;
    let seconds = |points: u64| {
        let lattice = Lattice {
            points: points as usize,
            per_wavelength: enough(points),
            range_m: None,
            is_mirrored: false,
        };
        cost(&lattice, longest.of.params, longest.ratio, 0.0).seconds
    };
    let advice = smaller
        .take_while(|points| enough(*points) >= FEWEST_PER_WAVELENGTH)
        .map(|points| (points, seconds(points)));
    let fast = advice.clone().find(|(_, seconds)| *seconds <= LONG).or_else(|| advice.last());
    let help = fast.map_or_else(
        || "smaller grids have less than 4 points per shortest wavelength".to_owned(),
        |(points, seconds)| {
            let per_wavelength = significant(enough(points), 2);
            format!(
                "points = {points}: {per_wavelength} points per shortest wavelength, about {}",
                in_words(seconds)
            )
        },
    );
    let shown =
        format!("{} min (accuracy: a factor of 3; limit 10 min; {help})", interval(range.map(two_digits)));
    let measured = LONG_LOOP.text.replace("{}", &shown);
    let cases = long.iter().map(|of| of.unit.id.clone()).collect();
    Some(Outside { kind: LONG_LOOP, limit: LONG / 60.0, range, measured, cases })
}

/// A number rounded to two digits.
fn two_digits(value: f64) -> f64 {
    significant(value, 2).parse().unwrap_or(value)
}
