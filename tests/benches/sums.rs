//! One evaluation of all displacements, by near pairs and a mesh against the direct sum.

use crate::paper::MATERIAL;
use crate::watch::{heading, line, once, plain};
use hysteron::model::{Boundary, Interaction as Kind, Slips};
use hysteron::physics::asperities::field::spot_field::Spot;
use hysteron::physics::asperities::field::{DirectSum, FastSum, Interaction, Spots, Tangent};
use hysteron::physics::cycle::Effort;
use hysteron::physics::jkr::Asperity;

/// Spots at random places.
pub struct Contact {
    pub positions: Vec<[f64; 2]>,
    /// Their radii and those of their asperities \[m\].
    pub shapes: Vec<(f64, f64)>,
    pub spots: Spots,
    pub length_m: f64,
}

/// So many spots that cover a third of the square, their radii spread over a factor of three as those of a rough surface.
pub fn contact(count: usize) -> Contact {
    let length_m = 1e-3;
    let mut seed = count as u64;
    // Weyl's sequence of the golden ratio, scrambled: even places that are the same in every run.
    let mut roll = || {
        seed = seed.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let positions: Vec<[f64; 2]> = (0..count).map(|_| [length_m * roll(), length_m * roll()]).collect();
    let spacing = length_m / (count as f64).sqrt();
    let shapes: Vec<(f64, f64)> = (0..count).map(|_| (spacing * (0.15 + 0.35 * roll()), spacing * (1.0 + 3.0 * roll()))).collect();
    let mut spots = Spots { index: (0..count).collect(), ..Spots::default() };
    spots.columns.set(positions.iter().zip(&shapes).map(|([x, y], (a, radius))| {
        let jkr = Asperity::new(*radius, &MATERIAL).unwrap();
        Spot { x: *x, y: *y, a: *a, radius: *radius, load: jkr.load(*a), load_slope: jkr.load_slope(*a) }
    }));
    Contact { positions, shapes, spots, length_m }
}

/// Contacts of one evaluation, and the most that are summed directly.
const COUNTS: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];
const MOST: usize = 10_000;

pub fn run() {
    heading("sums: displacements of n spots at all of them, with the tangent", "over 1000, per spot");
    let mut all = Vec::new();
    for count in COUNTS {
        let contact = contact(count);
        let (spots, positions) = (&contact.spots, contact.positions.clone());
        let fast = FastSum::new(positions.clone(), contact.length_m, &MATERIAL, Kind::Spots, Boundary::Periodic, Slips::default(), 1e-10);
        let (mut found, mut tangent, mut effort) = (Vec::new(), Tangent::default(), Effort::default());
        let places = once(|| fast.linearise(spots, &mut found, &mut tangent, &mut effort));
        let rounds = if count < 100_000 { 5 } else { 1 };
        let least = |mut work: Box<dyn FnMut() + '_>| (0..rounds).map(|_| once(&mut work)).fold(f64::INFINITY, f64::min);
        let again = least(Box::new(|| fast.linearise(spots, &mut found, &mut tangent, &mut effort)));
        let (x, mut y) = (vec![1.0; count], vec![0.0; count]);
        let product = least(Box::new(|| tangent.product(&x, &mut y)));
        all.push((count as f64, again));
        let unit = all[0].1 / 1000.0 * count as f64;
        if count == COUNTS[0] {
            plain(&format!("{count} spots"), again);
        } else {
            line(&format!("{count} spots"), again, again / unit);
        }
        line("finding the pairs first", places, places / unit);
        line("a product of the tangent", product, product / unit);
        if count <= MOST {
            let direct =
                DirectSum::new(positions, contact.length_m, &MATERIAL, Kind::Spots, Boundary::Periodic, Slips::default()).with_table();
            let time = once(|| direct.displacements(spots, &spots.index, &mut found, &mut effort));
            line("the direct sum", time, time / unit);
        }
    }
    // The exponent of n in the time, by least squares.
    let mean = |of: fn(&(f64, f64)) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
    let (x, y) = (mean(|p| p.0.ln()), mean(|p| p.1.ln()));
    let slope = all.iter().map(|p| (p.0.ln() - x) * (p.1.ln() - y)).sum::<f64>() / all.iter().map(|p| (p.0.ln() - x).powi(2)).sum::<f64>();
    println!("{:>36}  {slope:.2}", "exponent of n");
}
