//! Whole cycles with coalescence `cover` and `merge`: means over six surfaces, effort, and the time in direct evaluations of all contacts, of which a plain
//! iteration of some hundred steps would take many thousands. `cargo bench -- cycle cover 64 128` names rule and
//! magnifications.

use crate::paper::{MATERIAL, spectrum};
use crate::watch::{cpu, once};
use hysteron::model::{Boundary, Coalescence, Interaction as Kind, JumpIn, KeptContacts, Slips};
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::field::{DirectSum, Interaction};
use hysteron::physics::asperities::{Asperities, Cycle, Settings};
use hysteron::physics::cycle::{Branch, Effort, Method};
use hysteron::physics::surface::summits::find_summits;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};

const SURFACES: u64 = 6;

pub fn run() {
    let named: Vec<u32> = std::env::args().filter_map(|word| word.parse().ok()).collect();
    let mut rules = vec![("cover", Coalescence::Cover), ("merge", Coalescence::Merge)];
    let is_named = |name: &str| std::env::args().any(|word| word == name);
    if rules.iter().any(|(name, _)| is_named(name)) {
        rules.retain(|(name, _)| is_named(name));
    }
    let magnifications = if named.is_empty() { vec![32, 64] } else { named };
    println!(
        "\ncycle: to 0.0071, 0.01 h_rms a step; {SURFACES} surfaces of seed 2021; A/A0, F_po/(E* A0) and loop area/(E* A0 h_rms) in 1e-3"
    );
    println!(
        "{:>4} {:>6} {:>7} {:>9} {:>9} {:>9} {:>10} {:>9} {:>9} {:>8} {:>9}",
        "zeta", "rule", "events", "A", "F_po", "loop", "iterations", "products", "pairs/1e6", "seconds", "direct"
    );
    for zeta in magnifications {
        for (name, rule) in rules.iter().copied() {
            let mut sum = Sum::default();
            for realization in 0..SURFACES {
                sum.add(zeta, realization, rule);
            }
            sum.print(zeta, name);
        }
    }
}

/// Sums over surfaces.
#[derive(Default)]
struct Sum {
    events: usize,
    frozen: u64,
    area: f64,
    pull_off: f64,
    loss: f64,
    effort: Effort,
    seconds: f64,
    evaluations: f64,
}

impl Sum {
    fn add(&mut self, zeta: u32, realization: u64, coalescence: Coalescence) {
        let rules = Rules {
            interaction: Kind::Spots,
            boundary: Boundary::Periodic,
            coalescence,
            jump_in: JumpIn::Wu,
            allow_low_tabor: false,
            slips: Slips::default(),
        };
        let spectrum = spectrum(zeta);
        let surface = synthesize(&spectrum, &realization_seed(2021, realization), 8 * zeta as usize);
        let summits = find_summits(surface.heights_m.view(), spectrum.length_m, 8.0).unwrap().list;
        let problem = Problem::new(&summits, spectrum.length_m, spectrum.rms_height_m, MATERIAL, rules).unwrap();
        let settings = Settings { max_loads: vec![0.0071], approach_step: 0.01, contacts: KeptContacts::None, rest_every: None };
        let method = Asperities { problem, settings };
        let mut done = None;
        let seconds = cpu(|| done = Some(method.run()));
        match done {
            Some(Ok(done)) => self.count(&done, seconds, &method.problem),
            Some(Err(error)) => println!("{zeta:>4} {coalescence:?}, surface {realization}: {error}"),
            None => {}
        }
    }

    fn count(&mut self, done: &Cycle, seconds: f64, problem: &Problem) {
        let turn = &done.steps[done.turning[0].0];
        let unit = problem.load_unit_n();
        self.events += done.events.len();
        self.area += turn.area_m2 / (problem.length_m * problem.length_m);
        self.pull_off -=
            done.steps.iter().filter(|step| step.branch == Branch::Unloading).map(|step| step.least_load_n).fold(0.0, f64::min) / unit;
        let work = |branch| done.steps.iter().rfind(|step| step.branch == branch).map_or(0.0, |step| step.work_j);
        self.loss += (work(Branch::Loading) + work(Branch::Unloading)) / (unit * problem.rms_height_m);
        for step in &done.steps {
            self.effort += step.numerics.effort;
            self.frozen += step.counts.held as u64;
        }
        self.seconds += seconds;
        self.evaluations += seconds / evaluation(turn.counts.contacts);
    }

    fn print(&self, zeta: u32, name: &str) {
        let count = SURFACES as f64;
        let Effort { iterations, products, pairs, .. } = self.effort;
        println!(
            "{zeta:>4} {name:>6} {:>7.0} {:>9.3} {:>9.5} {:>9.5} {:>10} {:>9} {:>9} {:>8.2} {:>9.0}{}",
            self.events as f64 / count,
            1e3 * self.area / count,
            1e3 * self.pull_off / count,
            1e3 * self.loss / count,
            iterations / SURFACES,
            products / SURFACES,
            pairs / SURFACES / 1_000_000,
            self.seconds / count,
            self.evaluations / count,
            if self.frozen > 0 { format!("  frozen {}", self.frozen) } else { String::new() },
        );
    }
}

/// Time of one direct evaluation of so many contacts \[s\].
fn evaluation(contacts: usize) -> f64 {
    let contact = crate::sums::contact(contacts);
    let direct = DirectSum::new(contact.positions.clone(), contact.length_m, &MATERIAL, Kind::Spots, Boundary::Periodic, Slips::default())
        .with_table();
    let mut found = Vec::new();
    let mut evaluate = || direct.displacements(&contact.spots, &contact.spots.index, &mut found, &mut Effort::default());
    (0..20).map(|_| once(&mut evaluate)).fold(f64::INFINITY, f64::min)
}
