//! The field of one spot at another asperity, per pair: vectorised, against the printed formula with `sqrt` and `asin`.

use crate::paper::MATERIAL;
use crate::sums::contact;
use crate::watch::{heading, line, plain, race};
use hysteron::model::{Boundary, Interaction as Kind, Slips};
use hysteron::physics::asperities::field::{DirectSum, Interaction};
use hysteron::physics::cycle::Effort;
use std::f64::consts::PI;

pub fn run() {
    const SPOTS: usize = 2000;
    let contact = contact(SPOTS);
    let (spots, length) = (&contact.spots, contact.length_m);
    let field = DirectSum::new(contact.positions.clone(), length, &MATERIAL, Kind::Spots, Boundary::Isolated, Slips::default());
    let pull = (2.0 * PI * MATERIAL.work_of_adhesion_j_m2 / MATERIAL.contact_modulus_pa).sqrt();
    let printed = || {
        let at = |i: usize| {
            let [x, y] = contact.positions[i];
            let by = |j: usize| {
                let ([u, v], (a, radius)) = (contact.positions[j], contact.shapes[j]);
                let r = ((x - u) * (x - u) + (y - v) * (y - v)).sqrt();
                if r <= a {
                    return if r == 0.0 { 0.0 } else { a * a / radius - r * r / (2.0 * radius) - pull * a.sqrt() };
                }
                let angle = (a / r).asin();
                ((r * r - a * a).sqrt() * a + (2.0 * a * a - r * r) * angle) / (PI * radius) - 2.0 / PI * pull * a.sqrt() * angle
            };
            (0..SPOTS).map(by).sum::<f64>()
        };
        (0..SPOTS).map(at).sum::<f64>()
    };
    let mut found = Vec::new();
    let vectorised = || {
        field.displacements(spots, &spots.index, &mut found, &mut Effort::default());
        found.iter().sum::<f64>()
    };
    let (ours, theirs) = race(5, vectorised, printed);
    let pairs = (SPOTS * SPOTS) as f64;
    heading("pairs: one field of one pair", "over the printed formula");
    plain("printed, with sqrt and asin", theirs / pairs);
    line("as it is summed here", ours / pairs, ours / theirs);
}
