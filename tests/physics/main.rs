//! The physics against laws, limits, independent values and regressions.
//!
//! Names: `law_` an exact relation of the model, `lim_` a limit in which the answer is known, `val_` a value made without the program
//! (`tests/reference`, `make.py` there), `reg_` a rule or a refusal that must stay, `e2e_` a surface through the whole chain.
//! Every tolerance is beside its reason. Nothing here is timed, and nothing is drawn from an entropy source.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod approximate_jkr;
mod artefacts;
mod boundary_elements;
mod common_spectrum;
mod coupled;
mod cut_off;
mod cycle;
mod estimates;
mod examples;
mod extremes;
mod fast;
mod golden;
mod grid_convergence;
mod homogeneity;
mod invariance;
mod isolated;
mod jkr;
mod kernel;
mod layout;
mod ledger;
mod machine;
mod measured;
mod merge;
mod pair;
mod path;
mod periodogram;
mod potential;
mod printed;
mod probe;
mod probe_by_both;
mod properties;
mod scan_filter;
mod self_affine;
mod shape;
mod spectrum;
mod summits;
mod synthesis;
mod texture;
mod theory;
mod union;
mod validity;
mod versions;

/// Values made without the program.
mod reference {
    use std::collections::HashMap;
    use std::path::Path;

    /// A table of `tests/reference`, its words and numbers by column.
    pub struct Table {
        columns: HashMap<String, usize>,
        rows: Vec<Vec<String>>,
    }

    /// A row of a table.
    pub struct Row<'t> {
        table: &'t Table,
        cells: &'t [String],
    }

    /// Reads `tests/reference/<name>.csv`: comments, a header, rows.
    pub fn table(name: &str) -> Table {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference").join(format!("{name}.csv"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let split = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let columns = split(lines.next().expect("a header")).into_iter().enumerate().map(|(k, name)| (name, k)).collect();
        let rows: Vec<_> = lines.map(split).collect();
        assert!(!rows.is_empty(), "{name} has no rows");
        Table { columns, rows }
    }

    impl Table {
        /// Its rows, in order.
        pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
            self.rows.iter().map(|cells| Row { table: self, cells })
        }
    }

    impl Row<'_> {
        /// The word in a column.
        pub fn word(&self, column: &str) -> &str {
            &self.cells[self.table.columns[column]]
        }

        /// The number in a column, as the nearest double.
        pub fn number(&self, column: &str) -> f64 {
            self.word(column).parse().unwrap()
        }
    }
}

/// What several files use.
mod support {
    use hysteron::model::{Amplitudes, Boundary, Coalescence, Interaction, JumpIn, KeptContacts, Material, Normalization, Slips};
    use hysteron::physics::asperities::contact::{Problem, Rules};
    use hysteron::physics::asperities::numerics::{Events, Numerics};
    use hysteron::physics::asperities::{Asperities, Cycle, Settings};
    use hysteron::physics::cycle::{Branch, Method, Step};
    use hysteron::physics::surface::SquareMap;
    use hysteron::physics::surface::edges::Edges;
    use hysteron::physics::surface::measured::Prepared;
    use hysteron::physics::surface::shape::Shape;
    use hysteron::physics::surface::spectrum::Spectrum;
    use hysteron::physics::surface::summits::{Summit, find_summits};
    use hysteron::physics::surface::synthesis::{Surface, realization_seed, synthesize};
    use proptest::test_runner::{Config, RngSeed};

    /// The paper's material.
    pub const PAPER: Material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
    /// The paper's side.
    pub const LENGTH: f64 = 1e-3;
    /// The paper's rms height.
    pub const RMS: f64 = 5e-6;
    /// The program's defaults.
    pub const DEFAULT: Rules = Rules {
        interaction: Interaction::Spots,
        boundary: Boundary::Periodic,
        coalescence: Coalescence::Cover,
        jump_in: JumpIn::Wu,
        allow_low_tabor: false,
        slips: Slips::NONE,
    };
    /// Interactions off and plain JKR: everything has a closed form.
    pub const ALONE: Rules = Rules { interaction: Interaction::None, coalescence: Coalescence::None, jump_in: JumpIn::Jkr, ..DEFAULT };

    /// Fails unless `got` is within `relative` of `want`; not a number fails.
    #[track_caller]
    pub fn close(what: &str, got: f64, want: f64, relative: f64) {
        near(what, got, want, relative * want.abs());
    }

    /// Fails unless `got` is within `absolute` of `want`; not a number fails.
    #[track_caller]
    pub fn near(what: &str, got: f64, want: f64, absolute: f64) {
        let off = (got - want).abs();
        assert!(off <= absolute, "{what}: got {got:e}, want {want:e}, off by {off:e}, allowed {absolute:e}");
    }

    /// Configuration of random cases: `usual` of them or `PROPTEST_CASES`, the same ones in every run.
    pub fn random(usual: u32) -> Config {
        let config = Config::default();
        let cases = if std::env::var_os("PROPTEST_CASES").is_some() { config.cases } else { usual };
        Config { cases, rng_seed: RngSeed::Fixed(2021), failure_persistence: None, ..config }
    }

    /// SplitMix64 (Steele, Lea & Flood 2014): a few fixed pseudorandom numbers in `[0, 1)`, not the program's generator.
    pub struct Dice(pub u64);

    impl Dice {
        pub fn roll(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// Numerics with local problems of so many contacts.
    pub fn local_contacts(local_contacts: usize) -> Numerics {
        Numerics { events: Events { local_contacts, ..Events::DEFAULT }, ..Numerics::DEFAULT }
    }

    /// The paper's surface at another magnification.
    pub fn paper_spectrum(hurst: f64, magnification: u32) -> Spectrum {
        Spectrum {
            length_m: LENGTH,
            rms_height_m: RMS,
            hurst,
            magnification,
            normalization: Normalization::Sample,
            amplitudes: Amplitudes::Fixed,
            shape: Shape::default(),
        }
    }

    /// A realised surface with `points` grid points per shortest wavelength.
    pub fn surface(spectrum: &Spectrum, realization: u64, points: usize) -> Surface {
        synthesize(spectrum, &realization_seed(2021, realization), points * spectrum.magnification as usize)
    }

    /// Summits of the paper's surface at H = 0.8 and 8 points per shortest wavelength.
    pub fn paper_summits(magnification: u32, realization: u64) -> Vec<Summit> {
        let surface = surface(&paper_spectrum(0.8, magnification), realization, 8);
        find_summits(surface.heights_m.view(), LENGTH, 8.0).unwrap().list
    }

    /// A hand-made asperity.
    pub fn asperity(x_m: f64, y_m: f64, height_m: f64, radius_m: f64) -> Summit {
        let k = 1.0 / radius_m;
        Summit { x_m, y_m, height_m, curvature_1_m: k, curvature_min_1_m: k, curvature_max_1_m: k, grid_row: 0, grid_col: 0, refined: true }
    }

    /// A prepared surface with its edges.
    pub fn square(prepared: &Prepared, edges: Edges) -> SquareMap<'_> {
        SquareMap { heights_m: prepared.heights_m.view(), length_m: prepared.length_m, edges }
    }

    /// A whole cycle of the paper's material to the given loads.
    pub fn paper_cycle(summits: &[Summit], rules: Rules, max_loads: &[f64], approach_step: f64) -> Cycle {
        let problem = Problem::new(summits, LENGTH, RMS, PAPER, rules).unwrap();
        run(&problem, max_loads, approach_step, KeptContacts::None)
    }

    /// A whole cycle.
    pub fn run(problem: &Problem, max_loads: &[f64], approach_step: f64, contacts: KeptContacts) -> Cycle {
        let settings = Settings { max_loads: max_loads.to_vec(), approach_step, contacts, rest_every: None };
        Asperities { problem: problem.clone(), settings }.run().unwrap()
    }

    /// What a loop of one turning point comes to.
    #[derive(Debug, Clone, Copy)]
    pub struct Loop {
        /// `∮F dΔ` \[J\].
        pub loss: f64,
        /// Energy lost in the events \[J\].
        pub events: f64,
        /// Greatest tension \[N\].
        pub pull_off: f64,
        /// Area at the turning point \[m²\].
        pub area: f64,
    }

    /// The steps of the unloading from the k-th turning point.
    pub fn unloading(cycle: &Cycle, k: usize) -> Vec<&Step> {
        let first = cycle
            .steps
            .iter()
            .enumerate()
            .filter(|(_, s)| s.branch == Branch::Unloading && s.mean_penetration_m == turning(cycle, k).mean_penetration_m);
        let start = first.map(|(i, _)| i).next().unwrap();
        let max_load = cycle.steps[start].max_load;
        cycle.steps[start..].iter().take_while(|s| s.max_load == max_load).collect()
    }

    /// The k-th turning step.
    pub fn turning(cycle: &Cycle, k: usize) -> &Step {
        &cycle.steps[cycle.turning[k].0]
    }

    /// Sums a loop up.
    pub fn loop_of(cycle: &Cycle, k: usize) -> Loop {
        let back = unloading(cycle, k);
        let lost = |steps: &mut dyn Iterator<Item = &Step>| steps.map(|s| s.dissipated_j).sum::<f64>();
        Loop {
            loss: turning(cycle, k).work_j + back.last().unwrap().work_j,
            events: lost(&mut cycle.steps[..=cycle.turning[k].0].iter()) + lost(&mut back.iter().copied()),
            pull_off: -back.iter().map(|s| s.least_load_n).fold(0.0, f64::min),
            area: turning(cycle, k).area_m2,
        }
    }
}
