//! Point interaction has a potential, and so a symmetric response.

use crate::support::{ALONE, LENGTH, PAPER, asperity, near};
use hysteron::model::{Interaction, KeptContacts};
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Settings};
use hysteron::physics::cycle::Contact;
use hysteron::physics::surface::summits::Summit;

/// Unit of height: its 1e-10 is the tolerance of an equilibrium, 1e-17 m.
const UNIT: f64 = 1e-7;

/// Contacts at an approach \[m\] during loading.
fn contacts(summits: &[Summit], rules: Rules, approach: f64) -> Vec<Contact> {
    let problem = Problem::new(summits, LENGTH, UNIT, PAPER, rules).unwrap();
    let settings = Settings { max_loads: Vec::new(), approach_step: 1.0, contacts: KeptContacts::Turning, rest_every: None };
    let cycle = Asperities { problem, settings }.run_to(approach).unwrap();
    let turning = cycle.turning[0].0;
    let found: Vec<Contact> = cycle.contacts.into_iter().filter(|contact| contact.step == turning).collect();
    assert_eq!(found.len(), summits.len(), "all in contact");
    found
}

/// Largest `|∂F_i/∂D_j − ∂F_j/∂D_i|` over `∂F_0/∂D_0` of three unequal contacts, two of which reach half way to one another.
fn asymmetry(interaction: Interaction) -> f64 {
    let places = [(6.0e-4, 3.0e-4, 0.0, 3.0e-5), (6.13e-4, 3.05e-4, -1e-7, 1.5e-5), (5.8e-4, 2.9e-4, -2e-7, 4e-5)];
    let step = 1e-10;
    let loads = |j: usize, step: f64| -> Vec<f64> {
        let summits: Vec<Summit> =
            places.iter().enumerate().map(|(i, (x, y, z, r))| asperity(*x, *y, z + if i == j { step } else { 0.0 }, *r)).collect();
        // Heights are measured from the highest summit, here the first.
        let approach = 1e-6 + if j == 0 { step } else { 0.0 };
        contacts(&summits, Rules { interaction, ..ALONE }, approach).iter().map(|contact| contact.load_n).collect()
    };
    let columns: Vec<Vec<f64>> = (0..3)
        .map(|j| {
            let (up, down) = (loads(j, step), loads(j, -step));
            up.iter().zip(&down).map(|(u, d)| (u - d) / (2.0 * step)).collect()
        })
        .collect();
    let off = |i: usize, j: usize| (columns[j][i] - columns[i][j]).abs() / columns[0][0];
    off(0, 1).max(off(0, 2)).max(off(1, 2))
}

#[test]
fn law_the_response_to_point_loads_is_symmetric() {
    // ∂F_i/∂D_j = ∂²Π/∂D_i∂D_j. Equilibria are met to 1e-17 m: 1e-7 of the step. The third differences are (1e-10/1e-7)² of the first.
    near("point", asymmetry(Interaction::Point), 0.0, 3e-6);
    // The field of contact spots has no potential, as the measure of what the test sees.
    assert!(asymmetry(Interaction::Spots) > 1e-3, "{}", asymmetry(Interaction::Spots));
}
