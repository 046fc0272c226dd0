//! Whole cycles, pinned: a change of the solver that moves a result shows here first.
//!
//! With `HYSTERON_DIGESTS=1` and `--nocapture` the tests print the results, the effort and the BLAKE3 digest of every cycle instead, to compare two builds on one
//! machine byte by byte.

use crate::support::{DEFAULT, LENGTH, PAPER, RMS, close, local_contacts, loop_of, paper_summits, run};
use hysteron::model::{Boundary, Coalescence, Interaction, JumpIn, KeptContacts, Material};
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::cycle::{Effort, Step, StepNumerics};

/// Magnification, realization, rules, work of adhesion \[J/m²\], contacts in a local problem.
type Setup = (u32, u64, Rules, f64, usize);

/// Number of events, A/A0 at the load reversal, F_po/(E* A0) and Θ/(E* A0 h_rms).
type Pinned = (usize, f64, f64, f64);

fn setups() -> Vec<(&'static str, Setup, Pinned)> {
    let merge = Rules { coalescence: Coalescence::Merge, ..DEFAULT };
    let alone = Rules { interaction: Interaction::None, ..DEFAULT };
    let point = Rules { interaction: Interaction::Point, ..DEFAULT };
    let isolated = Rules { boundary: Boundary::Isolated, ..DEFAULT };
    let jkr = Rules { jump_in: JumpIn::Jkr, ..DEFAULT };
    vec![
        ("cover, zeta 16", (16, 0, DEFAULT, 0.07, 24), (94, 3.677862353902e-1, 1.183319520591e-3, 1.568550451691e-3)),
        ("cover, zeta 32", (32, 1, DEFAULT, 0.07, 24), (331, 3.684944499056e-1, 7.631831802552e-4, 1.965984358049e-3)),
        ("cover, local problems of 3", (16, 1, DEFAULT, 0.07, 3), (96, 4.059902235198e-1, 8.520992689760e-4, 1.708811397486e-3)),
        (
            "cover, all contacts in one problem",
            (16, 1, DEFAULT, 0.07, usize::MAX),
            (96, 4.059902235198e-1, 8.499241918691e-4, 1.709325219638e-3),
        ),
        ("cover, weak adhesion", (16, 0, DEFAULT, 1e-3, 24), (82, 1.557304951904e-1, 1.271672677095e-6, 1.085014019364e-6)),
        ("merge", (16, 0, merge, 0.07, 24), (190, 5.358706353571e-1, 1.206946639277e-3, 1.701111080275e-3)),
        (
            "merge, all contacts in one problem",
            (16, 0, merge, 0.07, usize::MAX),
            (190, 5.363802144553e-1, 1.206946774961e-3, 1.693247791592e-3),
        ),
        ("no interaction", (16, 0, alone, 0.07, 24), (96, 3.485415168642e-1, 1.209450779577e-3, 1.539783230413e-3)),
        ("point loads", (16, 0, point, 0.07, 24), (94, 3.677670707883e-1, 1.198677882806e-3, 1.547530271542e-3)),
        ("isolated", (16, 0, isolated, 0.07, 24), (90, 3.855806283037e-1, 1.031359464757e-3, 1.680509426219e-3)),
        ("jump-in of JKR", (16, 0, jkr, 0.07, 24), (94, 3.677862353902e-1, 1.183319520591e-3, 1.609925127142e-3)),
    ]
}

/// The pinned results as a text, which a [version](crate::versions) of the method has.
pub fn pinned() -> String {
    setups().into_iter().map(|(what, _, pinned)| format!("{what} {pinned:?}\n")).collect()
}

#[test]
fn reg_whole_cycles() {
    for (what, (zeta, realization, rules, adhesion, patch), (events, area, pull_off, loss)) in setups() {
        let material = Material { work_of_adhesion_j_m2: adhesion, ..PAPER };
        let problem =
            Problem::new(&paper_summits(zeta, realization), LENGTH, RMS, material, rules).unwrap().with_numerics(local_contacts(patch));
        let cycle = run(&problem, &[0.0071], 0.04, KeptContacts::Turning);
        let (load_unit, found) = (problem.load_unit_n(), loop_of(&cycle, 0));
        let (found_area, found_pull_off, found_loss) =
            (found.area / (LENGTH * LENGTH), found.pull_off / load_unit, found.loss / (load_unit * RMS));
        if std::env::var_os("HYSTERON_DIGESTS").is_some() {
            let turning: Vec<_> =
                cycle.turning.iter().map(|(step, state)| (step, state.mean_penetration_m, &state.radius, &state.barred)).collect();
            // The effort is no result.
            let steps: Vec<_> = cycle
                .steps
                .iter()
                .map(|step| Step { numerics: StepNumerics { effort: Effort::default(), ..step.numerics.clone() }, ..step.clone() })
                .collect();
            let bytes = postcard::to_stdvec(&(&steps, &cycle.contacts, &cycle.events, &cycle.merged, turning)).unwrap();
            let digest = blake3::hash(&bytes).to_hex();
            eprintln!("{what}: {} {found_area:.12e} {found_pull_off:.12e} {found_loss:.12e} {digest}", cycle.events.len());
            continue;
        }
        // The order of sums differs between processors in the last digits only; a change of one event moves the last result by 1e-4 and more.
        assert_eq!(cycle.events.len(), events, "{what}: number of events");
        close(&format!("{what}: area"), found_area, area, 1e-7);
        close(&format!("{what}: pull-off force"), found_pull_off, pull_off, 1e-7);
        close(&format!("{what}: dissipated energy"), found_loss, loss, 1e-7);
    }
}

/// Effort of three cycles: iterations, products of the tangent with a vector, and pair fields in 1000.
#[test]
fn reg_effort_of_whole_cycles() {
    for (at, iterations, products, pairs) in [(0, 2596, 7013, 1678), (1, 9110, 11883, 11297), (5, 2949, 5584, 560)] {
        let (what, (zeta, realization, rules, adhesion, patch), _) = setups().swap_remove(at);
        let material = Material { work_of_adhesion_j_m2: adhesion, ..PAPER };
        let problem =
            Problem::new(&paper_summits(zeta, realization), LENGTH, RMS, material, rules).unwrap().with_numerics(local_contacts(patch));
        let cycle = run(&problem, &[0.0071], 0.04, KeptContacts::Turning);
        let sum = |of: fn(&Effort) -> u64| cycle.steps.iter().map(|step| of(&step.numerics.effort)).sum::<u64>() as f64;
        if std::env::var_os("HYSTERON_DIGESTS").is_some() {
            let [iterations, products] = [sum(|effort| effort.iterations), sum(|effort| effort.products)];
            eprintln!("effort of {what}: {iterations} {products} {:.0}", 1e-3 * sum(|effort| effort.pairs));
            continue;
        }
        // Rounding on another processor changes a few iterations; a change of the method changes more.
        close(&format!("{what}: iterations"), sum(|effort| effort.iterations), f64::from(iterations), 0.02);
        close(&format!("{what}: products"), sum(|effort| effort.products), f64::from(products), 0.02);
        // Fields of a local problem that are evaluated twice for one state are 3 % and more.
        close(&format!("{what}: pair fields"), 1e-3 * sum(|effort| effort.pairs), f64::from(pairs), 0.02);
    }
}
