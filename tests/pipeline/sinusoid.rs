//! Works of adhesion of closing and of opening, against an exact loop.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::fs;

use hysteron::schema::REALIZATIONS;
use hysteron::store::parquet::read_table;

use crate::bench::{Bench, code, stderr};

/// Points along a side.
const POINTS: usize = 64;
/// Side of the square, which is the wavelength, amplitude of the height, and E\*.
const LENGTH: f64 = 1e-4;
const HEIGHT: f64 = 2e-6;
const MODULUS: f64 = 1e6;

/// Work of adhesion of Johnson's number `α = sqrt(2Δγλ/(π²E*h²))` \[J/m²\].
fn work_of_adhesion(alpha: f64) -> f64 {
    0.5 * (alpha * PI * HEIGHT).powi(2) * MODULUS / LENGTH
}

/// Works of closing and of opening \[J/m²\] by quadrature of Johnson's branch (Int. J. Solids Structures 32, 423, 1995): `P = sin²πa − α sqrt(tan πa)` in
/// `πE*h/λ` and the mean gap `ḡ = cos²πa + 2P ln sin πa` in h. Surfaces touch at ḡ = 1, jump onto the branch, and leave it where ḡ turns.
fn exact(alpha: f64) -> [f64; 2] {
    let state = |k: u32| {
        let a = PI * (0.002 + 0.49 * f64::from(k) / 1e5);
        let load = a.sin().powi(2) - alpha * a.tan().sqrt();
        [load, a.cos().powi(2) + 2.0 * load * a.sin().ln()]
    };
    let branch: Vec<[f64; 2]> = (0..100_000).map(state).collect();
    let off = (0..branch.len()).max_by(|a, b| branch[*a][1].total_cmp(&branch[*b][1])).unwrap();
    let (mut closing, mut opening) = (0.0, 0.0);
    for pair in branch[off..].windows(2).take_while(|pair| pair[1][0] < 0.0) {
        let work = -0.5 * (pair[0][0] + pair[1][0]) * (pair[0][1] - pair[1][1]);
        opening += work;
        closing += if pair[0][1] <= 1.0 { work } else { 0.0 };
    }
    [closing, opening].map(|work| work * PI * MODULUS * HEIGHT * HEIGHT / LENGTH)
}

/// A sinusoid of one wavelength from a file: opening to 1.5 %, and closing to the same energy, which is up to 3 % of it. The grid of 64 points has Θ to 1 %
/// (`val_loops_of_johnson`). Ridges are no asperities: their columns are null.
#[test]
fn val_works_of_a_sinusoid() {
    let mut scan = String::new();
    for row in 0..POINTS {
        let height = 1e9 * HEIGHT * (TAU * row as f64 / POINTS as f64).cos();
        writeln!(scan, "{}", vec![height.to_string(); POINTS].join(" ")).unwrap();
    }
    let alphas = [0.2, 0.3, 0.4];
    let bench = Bench::new("");
    let file = bench.folder.path().join("sinusoid.txt");
    fs::write(&file, scan).unwrap();
    let spec = format!(
        "name = \"sinusoid\"\n[surface]\nfile = {:?}\npixel_m = {}\nunit = \"nm\"\nperiodic = true\n[material]\ncontact_modulus_pa = {MODULUS}\n\
         [model]\nmethod = \"boundary_elements\"\n[boundary_elements]\npoints = {POINTS}\n[cycle]\nmax_load = [0.00314]\napproach_step = 0.005\n\
         [[sweep]]\nname = \"johnson\"\nmaterial.work_of_adhesion_j_m2 = {:?}\n",
        file.to_str().unwrap(),
        LENGTH / POINTS as f64,
        alphas.map(work_of_adhesion)
    );
    fs::write(bench.spec(), spec).unwrap();
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let table = read_table(&bench.out().join("statistics/realizations.parquet"), &REALIZATIONS).unwrap();
    let of = |name: &str| table.f64_or_null(name).unwrap();
    let (works, closing, opening) = (of("work_of_adhesion_j_m2"), of("work_closing_j_m2"), of("work_opening_j_m2"));
    assert_eq!(works.len(), alphas.len());
    for alpha in alphas {
        let row = works.iter().position(|work| (work.unwrap() / work_of_adhesion(alpha) - 1.0).abs() < 1e-9).unwrap();
        let ([close, open], found) = (exact(alpha), [closing[row].unwrap(), opening[row].unwrap()]);
        assert!((found[1] - open).abs() < 0.015 * open, "opening {} and exactly {open} at α = {alpha}", found[1]);
        assert!((found[0] - close).abs() < 0.015 * open, "closing {} and exactly {close} at α = {alpha}", found[0]);
        let loss = of("loss_j_m2")[row].unwrap();
        assert!((found[1] - found[0] - loss).abs() < 1e-9 * loss);
    }
    assert!(of("tabor_min").iter().chain(of("low_tabor_share")).all(Option::is_none));
}
