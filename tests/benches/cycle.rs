//! A whole cycle at ζ = 64, in direct evaluations of its contacts: what a plain iteration of some hundred steps would take many thousands of.

use crate::paper::{MATERIAL, spectrum};
use crate::watch::{heading, line, once, plain};
use hysteron::model::{Boundary, Coalescence, Interaction as Kind, JumpIn, KeptContacts, Slips};
use hysteron::physics::contact::{Problem, Rules};
use hysteron::physics::cycle::{Settings, run as cycle};
use hysteron::physics::half_space::{DirectSum, Effort, Interaction};
use hysteron::physics::surface::summits::find_summits;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};

pub fn run() {
    let spectrum = spectrum(64);
    let rules = Rules {
        interaction: Kind::Spots,
        boundary: Boundary::Periodic,
        coalescence: Coalescence::Cover,
        jump_in: JumpIn::Wu,
        allow_low_tabor: false,
        slips: Slips::default(),
    };
    let surface = synthesize(&spectrum, &realization_seed(2021, 0), 512);
    let summits = find_summits(surface.heights_m.view(), spectrum.length_m, 8.0).unwrap().list;
    let problem = Problem::new(&summits, spectrum.length_m, spectrum.rms_height_m, MATERIAL, rules).unwrap();
    let settings = Settings { max_loads: vec![0.0071], approach_step: 0.01, contacts: KeptContacts::None, rest_every: None };
    let mut done = None;
    let whole = once(|| done = Some(cycle(&problem, &settings, &|_| {}).unwrap()));
    let done = done.unwrap();
    // One evaluation of as many spots as there are at the turning point.
    let contact = crate::sums::contact(done.steps[done.turning[0].0].contact_count);
    let direct = DirectSum::new(contact.positions.clone(), contact.length_m, &MATERIAL, Kind::Spots, Boundary::Periodic, Slips::default())
        .with_table();
    let mut found = Vec::new();
    let mut evaluate = || direct.displacements(&contact.spots, &contact.spots.index, &mut found, &mut Effort::default());
    let evaluation = (0..20).map(|_| once(&mut evaluate)).fold(f64::INFINITY, f64::min);
    heading("cycle: zeta = 64 to 0.0071, 0.01 h_rms a step", "in direct evaluations");
    plain(&format!("{} spots, all pairs once", contact.spots.index.len()), evaluation);
    line(&format!("{} steps, {} events", done.steps.len(), done.events.len()), whole, whole / evaluation);
    let pairs: u64 = done.steps.iter().map(|step| step.effort.pairs).sum();
    let iterations: u64 = done.steps.iter().map(|step| step.effort.iterations).sum();
    println!("{:>36}  {pairs} pairs, {iterations} iterations", "effort");
}
