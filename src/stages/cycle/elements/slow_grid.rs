//! Grids of boundary elements whose Fourier transforms are slow.

use super::super::super::outside::Outside;
use crate::campaign::{Campaign, CaseUnit};
use crate::stats::Caution;

/// Largest prime factor of a number of points whose Fourier transforms are fast.
const LARGEST_FACTOR: u32 = 7;
/// Largest prime factor that causes no warning.
const TOLERATED_FACTOR: u32 = 13;

const SLOW: Caution = Caution {
    code: "slow_grid",
    label: "slow grid",
    text: "the number of grid points along a side has the prime factor {}",
    consequence: "Fourier transforms of such a grid take up to three times as long.",
    action: "Use the next larger number of points with factors of 2, 3, 5 and 7 only.",
};

/// Cases of boundary elements with a number of grid points along a side that has a large prime factor.
pub(super) fn slow_grids(campaign: &Campaign) -> Option<Outside> {
    let points = |unit: &CaseUnit| {
        unit.case.params.elements()?.points.filter(|points| largest_factor(*points) > TOLERATED_FACTOR)
    };
    let slow = campaign.cases.iter().filter_map(|unit| Some((unit.id.clone(), points(unit)?)));
    let (cases, mut points): (Vec<String>, Vec<u32>) = slow.unzip();
    points.sort_unstable();
    points.dedup();
    let named: Vec<String> = points
        .iter()
        .map(|points| {
            format!(
                "{points} = {} x {}, next: {}",
                points / largest_factor(*points),
                largest_factor(*points),
                next_fast(*points)
            )
        })
        .collect();
    let factors = || points.iter().map(|points| f64::from(largest_factor(*points)));
    let range = [factors().reduce(f64::min)?, factors().reduce(f64::max)?];
    let shown = factors().map(|factor| factor.to_string()).collect::<Vec<_>>().join(", ");
    let measured =
        format!("{} ({}; limit {TOLERATED_FACTOR})", SLOW.text.replace("{}", &shown), named.join("; "));
    Some(Outside { kind: SLOW, limit: f64::from(TOLERATED_FACTOR), range, measured, cases })
}

/// Largest prime factor; 1 of 0 and 1.
fn largest_factor(number: u32) -> u32 {
    let (mut rest, mut factor, mut largest) = (number, 2, 1);
    while rest > 1 && factor * factor <= rest {
        if rest.is_multiple_of(factor) {
            (rest, largest) = (rest / factor, factor);
        } else {
            factor += 1;
        }
    }
    largest.max(rest.max(1))
}

/// Smallest number from this one on with factors of 2, 3, 5 and 7 only.
fn next_fast(number: u32) -> u32 {
    (number..).find(|number| largest_factor(*number) <= LARGEST_FACTOR).unwrap_or(number)
}
