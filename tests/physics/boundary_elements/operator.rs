//! The elastic operator, the law and the gradient of the energy.

use super::{BONDED, problem};
use hysteron::physics::elements::events::work::{OnLoop, Work, least_between, work_between};
use hysteron::physics::elements::grid::half_space::{HalfSpace, Operator};
use hysteron::physics::elements::grid::medium::{Layer, Medium};
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::problem::Bonding;
use std::f64::consts::{PI, TAU};

/// A plane wave `u = cos q·x` needs the pressure `|q|/2 u`, in both directions and obliquely, on square and oblong grids. Rounding only.
#[test]
fn val_plane_wave_of_the_half_space() {
    for (rows, columns) in [(32, 32), (1, 64), (24, 40), (27, 33)] {
        let half_space = HalfSpace::new(rows, columns).unwrap();
        let mut waves = half_space.waves().unwrap();
        for (kx, ky) in [(0, 3), (2, 5), (5, 1), (3, 0)] {
            if kx >= rows {
                continue;
            }
            let (qx, qy) = (TAU * kx as f64 / rows as f64, TAU * f64::from(ky) / columns as f64);
            let q = qx.hypot(qy);
            let u: Vec<f64> = (0..rows * columns).map(|k| (qx * (k / columns) as f64 + qy * (k % columns) as f64).cos()).collect();
            let mut p = vec![0.0; u.len()];
            half_space.apply(Operator::Stiffness, &u, &mut p, &mut waves);
            let worst = u.iter().zip(&p).map(|(u, p)| (p - 0.5 * q * u).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-13, "pressure off by {worst:e} for ({kx}, {ky}) on {rows} x {columns}");
            let energy: f64 = 0.5 * u.iter().zip(&p).map(|(u, p)| u * p).sum::<f64>() / u.len() as f64;
            assert!((energy / (0.125 * q) - 1.0).abs() < 1e-12, "energy per area E* q u²/8, it is {energy}");
            let mut back = vec![0.0; u.len()];
            half_space.apply(Operator::Compliance, &p, &mut back, &mut waves);
            assert!(u.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-12), "the compliance inverts the stiffness");
        }
        assert_eq!(waves.transforms % 4, 0, "two transforms to an application");
    }
}

/// Near a limit point the slope of the load is unbounded, and the work is nowhere far from the exact one: `F = sqrt(Δ)` from 1e-8 to 0.3 before the end of a
/// step of 1. The trapezoid is off by 1/4 at most, and with a slope that is believed the work would be off by any factor.
#[test]
fn lim_work_at_a_limit_point() {
    for from in [1e-8, 1e-4, 1e-2, 0.03, 0.1, 0.3] {
        let at = |x: f64| OnLoop { mean_penetration: x, load: x.sqrt(), stiffness: 0.5 / x.sqrt() };
        let exact = ((from + 1.0_f64).powf(1.5) - f64::powf(from, 1.5)) / 1.5;
        let Work { straight, bend, across } = work_between(at(from), at(from + 1.0));
        let error = (straight + bend - exact).abs();
        assert!(error < 0.26 * exact, "{straight} + {bend}, exact {exact}");
        assert!(bend != 0.0 || error < across, "{across} bounds {error}");
    }
}

/// On a patch the pressure is that of the whole grid, whose displacement vanishes elsewhere: to rounding within half a side of all that is displaced,
/// and to a thousandth of the largest if the displacement falls to zero at the border.
#[test]
fn val_pressure_on_a_patch_is_that_of_the_grid() {
    for (rows, columns, side) in [(32, 32, 8), (48, 64, 16), (64, 64, 12)] {
        let whole = HalfSpace::new(rows, columns).unwrap();
        let patch = whole.patch(side, &whole.kernel().unwrap()).unwrap();
        assert!(patch.is_patch() && !whole.is_patch());
        let middle = side / 4..side - side / 4;
        let is_inner = |k: usize| middle.contains(&(k / side)) && middle.contains(&(k % side));
        let bump = |k: usize| (PI * (k as f64 + 0.5) / side as f64).sin().powi(2);
        let inner = |k: usize| if is_inner(k) { 1.0 + (1.7 * k as f64).sin() } else { 0.0 };
        for (inside, seen, tolerance) in [
            ((0..side * side).map(inner).collect::<Vec<f64>>(), &is_inner as &dyn Fn(usize) -> bool, 1e-13),
            ((0..side * side).map(|k| bump(k / side) * bump(k % side)).collect(), &|_| true, 1e-3),
        ] {
            let mut u = vec![0.0; rows * columns];
            let place = |k: usize| k / side * columns + k % side;
            inside.iter().enumerate().for_each(|(k, value)| u[place(k)] = *value);
            let (mut expected, mut found) = (u.clone(), inside.clone());
            whole.apply(Operator::Stiffness, &u, &mut expected, &mut whole.waves().unwrap());
            patch.apply(Operator::Stiffness, &inside, &mut found, &mut patch.waves().unwrap());
            let largest = expected.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
            let errors = found.iter().enumerate().filter(|(k, _)| seen(*k)).map(|(k, p)| (p - expected[place(k)]).abs());
            let worst = errors.fold(0.0, f64::max) / largest;
            assert!(worst < tolerance, "pressure off by {worst:e} of the largest on {rows} x {columns}, patch {side}");
        }
    }
}

/// The work of the law is Δγ, its energy is the integral of the tension, and its slope the derivative (differences of 1e-6 are good to 1e-8).
#[test]
fn law_of_attraction_is_consistent() {
    for law in [Law::crack(0.02), Law::morse(0.02, 0.11)] {
        let work = law.work();
        assert!((law.bonded(0.0).energy / -work - 1.0).abs() < 1e-12);
        assert!(law.bonded(law.end_gap() * 1.01).energy.abs() < 1e-6 * work);
        let step = 1e-6;
        for k in -50..600 {
            let gap = (f64::from(k) + 0.37) * 0.003 * law.end_gap();
            let (low, here, high) = (law.bonded(gap - step), law.bonded(gap), law.bonded(gap + step));
            let strength = law.strength();
            assert!(((high.energy - low.energy) / (2.0 * step) - here.tension).abs() < 1e-5 * strength, "tension at {gap}");
            let kink = (gap - law.spring_gap()).abs() < 2.0 * step;
            assert!(kink || ((high.tension - low.tension) / (2.0 * step) - here.slope).abs() < 1e-4, "slope at {gap}");
            assert!(here.tension <= strength * (1.0 + 1e-4), "strength is the maximum");
            assert!(law.sealed(gap).energy >= here.energy - 1e-12, "opening a sealed point does not raise the energy");
            assert!(law.wall(gap).energy >= here.energy - 1e-12, "bonding a free point does not raise the energy");
        }
    }
}

/// Six ranges deep the repulsion of Morse's law becomes linear, without a step in energy, tension or slope: no overlap overflows.
#[test]
fn lim_deep_overlap_of_morse() {
    let (work, range) = (0.02, 0.11);
    let law = Law::morse(work, range);
    let (above, below) = (law.bonded(-6.0 * range + 1e-9), law.bonded(-6.0 * range - 1e-9));
    for (one, other) in [(above.energy, below.energy), (above.tension, below.tension), (above.slope, below.slope)] {
        // The slope changes by 2/range in relative terms over a distance.
        assert!((one / other - 1.0).abs() < 1e-7, "{one} and {other}");
    }
    for gap in [-7.0 * range, -1e3, -1e12] {
        let (here, deeper) = (law.bonded(gap), law.bonded(2.0 * gap));
        assert!(here.energy.is_finite() && here.slope == below.slope);
        let mean = 0.5 * (here.tension + deeper.tension);
        assert!(((deeper.energy - here.energy) / (gap * mean) - 1.0).abs() < 1e-12, "energy at {gap} and twice as deep");
    }
}

/// The least load of a step is between its ends where the load has a minimum there, to the square of a part of the step, and at an end otherwise.
#[test]
fn law_least_load_of_a_step() {
    let at = |x: f64| OnLoop { mean_penetration: x, load: (x - 0.3) * (x - 0.3) - 0.2, stiffness: 2.0 * (x - 0.3) };
    for (a, b) in [(0.0, 1.0), (1.2, -0.5)] {
        assert!((0.0..1e-3).contains(&(least_between(at(a), at(b)) + 0.2)), "from {a} to {b}");
    }
    assert_eq!(least_between(at(0.4), at(0.9)), at(0.4).load);
}

/// The law is that of the exact crack low-passed: far from its edge the tension at a gap is `4Δγ/(πg)` times what is left of the cut. With the kernel's
/// width going to 0 this is the only scale, so the strength is a fixed multiple of `sqrt(E*Δγ/dx)`: it does not depend on Δγ.
#[test]
fn law_of_the_crack_has_one_scale() {
    let (a, b) = (Law::crack(1e-4), Law::crack(1e-2));
    assert!((b.strength() / a.strength() - 10.0).abs() < 1e-9);
    assert!((b.contact_gap() / a.contact_gap() - 10.0).abs() < 1e-9);
    let strength = a.strength() / 1e-2;
    assert!((0.6..0.8).contains(&strength), "strength over sqrt(E*Δγ/dx) is {strength}");
    // The exact crack has σ = sqrt(E*Δγ/(π|x|)): at the distance of one spacing 0.564, so the strength lies above.
    assert!(strength > 1.0 / PI.sqrt());
}

/// Load and residual are derivatives of the energy: differences of the total energy by the approach and by single displacements agree to 1e-6.
#[test]
fn law_load_and_residual_are_derivatives_of_the_energy() {
    let n = 24;
    let wave = |row: usize, column: usize| 0.3 * ((TAU * row as f64 / n as f64).cos() + (TAU * 2.0 * column as f64 / n as f64).sin());
    let problem = problem(n, n, wave, Law::crack(0.03), BONDED);
    let mut state = problem.apart(0.5).unwrap();
    let half_space = HalfSpace::new(n, n).unwrap();
    let mut waves = half_space.waves().unwrap();
    for k in 0..n * n {
        state.displacement[k] = 0.05 * (TAU * (3 * (k / n) + k % n) as f64 / n as f64).sin();
        state.bonds[k] = [Bonding::Free, Bonding::Bonded, Bonding::Sealed][k % 3];
    }
    half_space.apply(Operator::Stiffness, &state.displacement.clone(), &mut state.pressure, &mut waves);
    let step = 1e-6;
    let energy = |approach: f64| {
        let mut moved = state.clone();
        moved.mean_penetration = approach;
        problem.totals(&moved).energy
    };
    let slope = (energy(0.5 + step) - energy(0.5 - step)) / (2.0 * step);
    let load = problem.totals(&state).load;
    assert!((slope / load - 1.0).abs() < 1e-6, "load {load}, slope of the energy {slope}");
}

/// The work of a load that is a cubic of the approach is exact, with the slopes at both ends, on a step in either direction. Where the load jumps the
/// curvature stays, but where the slope changes by more than the load, as at a limit point.
#[test]
fn law_work_of_a_cubic_is_exact() {
    let load = |x: f64| 1.0 + x * (0.3 + x * (-2.0 + 0.1 * x));
    let at = |x: f64| OnLoop { mean_penetration: x, load: load(x), stiffness: 0.3 + x * (-4.0 + 0.3 * x) };
    let integral = |x: f64| x * (1.0 + x * (0.15 + x * (-2.0 / 3.0 + 0.025 * x)));
    for (a, b) in [(0.2, 1.1), (1.3, -0.4)] {
        let Work { straight, bend, .. } = work_between(at(a), at(b));
        assert!((straight + bend - (integral(b) - integral(a))).abs() < 1e-14, "{straight} {bend}");
        let jumped = work_between(at(a), OnLoop { load: load(b) + 10.0, ..at(b) });
        assert_eq!(jumped.bend, bend);
        assert!(jumped.across > 0.0);
        let steep = work_between(OnLoop { stiffness: 100.0, ..at(a) }, OnLoop { stiffness: 50.0, ..at(b) });
        assert_eq!(steep.bend, 0.0);
    }
}

/// The displacement of a bonded layer over that of a half-space, `S(qh)` at q = ¼, ½, 1, 2: by the layer of ContactMechanics 1.8.3,
/// `PeriodicFFTElasticHalfSpace((16, 16), 1.0, (8π, 8π), thickness=h, poisson=ν).surface_stiffness`, to its nine printed digits, with the uniform
/// compression `(1 − ν)²/(h (1 − 2ν))` of E*. That program has no incompressible layer; for ν = ½ and thin layers `S = 2s³/3` to second order.
#[test]
fn val_layer() {
    let cases = [
        (0.0, 1.5, [0.187331590, 0.370789980, 0.681400255, 0.953820618], 0.666666667),
        (0.3, 1.5, [0.154315197, 0.311886324, 0.607562100, 0.931826966], 0.816666667),
        (0.45, 0.4, [0.016883868, 0.035769169, 0.084494046, 0.223617214], 7.5625),
    ];
    for (poisson_ratio, thickness, shares, stiffness) in cases {
        let layer = Layer { thickness, poisson_ratio };
        for (q, share) in [0.25, 0.5, 1.0, 2.0].into_iter().zip(shares) {
            assert!((layer.share(q * thickness) - share).abs() < 1e-9, "ν = {poisson_ratio}, q = {q}: {}", layer.share(q * thickness));
            let medium = Medium { layer: Some(layer), series_compliance: 0.0, wall_compliance: 0.0 };
            assert!((medium.stiffness(q) - 0.5 * q / share).abs() < 1e-6 * q / share);
        }
        assert!((layer.compression() * stiffness - 1.0).abs() < 1e-8);
    }
    let incompressible = Layer { thickness: 1.0, poisson_ratio: 0.5 };
    for s in [1e-4, 1e-3, 1e-2] {
        assert!((incompressible.share(s) / (2.0 / 3.0 * s * s * s) - 1.0).abs() < 2.0 * s * s, "{}", incompressible.share(s));
    }
    assert_eq!(incompressible.compression(), 0.0);
    // A deep layer is a half-space, without a step where the exponentials end.
    assert!((incompressible.share(21.99) - 1.0).abs() < 1e-12 && incompressible.share(1e3) == 1.0);
    let deep = Medium { layer: Some(Layer { thickness: 1e6, poisson_ratio: 0.3 }), series_compliance: 2.0, wall_compliance: 0.0 };
    assert_eq!(deep.stiffness(0.1), 0.05);
    assert_eq!(deep.mean_compliance(), 2.0 + 1e6 * 0.4 / 0.49);
}
