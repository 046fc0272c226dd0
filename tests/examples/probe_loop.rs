//! Invented loop of a spherical probe, as `data/examples/probe_loop.csv` has it.
//!
//! `cargo run --no-default-features --example probe_loop > data/examples/probe_loop.csv`

#![allow(clippy::print_stdout)]

use hysteron::model::Material;
use hysteron::physics::PhysicsError;
use hysteron::physics::jkr::Asperity;
use std::fmt::Write as _;

/// Radius of the probe R \[m\].
pub const RADIUS_M: f64 = 2e-5;
/// Reduced modulus E* \[Pa\].
pub const MODULUS_PA: f64 = 1e6;
/// Works of adhesion on approach and on retraction \[J/m²\].
pub const WORKS_J_M2: [f64; 2] = [0.02, 0.045];
/// Stiffness of the cantilever \[N/m\].
pub const STIFFNESS_N_M: f64 = 30.0;
/// Range of the displacement of the piezo \[m\], from its start to the load reversal.
const RANGE_M: [f64; 2] = [-2e-6, 3e-6];
/// Points of each branch.
const POINTS: u32 = 300;
/// Standard deviations of the noise: force \[N\] and contact radius \[m\].
const NOISE: [f64; 2] = [2e-8, 2e-8];

const HEADING: &str = "\
# INVENTED DATA, not a measurement: a JKR loop with noise, written by tests/examples/probe_loop.rs.
# Sphere R = 20 um on a half-space of E* = 1 MPa; work of adhesion 20 mJ/m2 on approach and
# 45 mJ/m2 on retraction; cantilever of 30 N/m; the contact edge is pinned after the load reversal.
time_s,piezo_um,force_nN,contact_radius_um
";

/// Pseudorandom normal numbers: SplitMix64 (Steele, Lea and Flood 2014), twelve of them summed.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// One branch of the loop.
struct Path {
    sphere: Asperity,
    /// Displacement of the piezo at which the contact ends, and contact radius there \[m\].
    end: (f64, f64),
}

impl Path {
    fn new(work: f64) -> Result<Self, PhysicsError> {
        let material = Material { contact_modulus_pa: MODULUS_PA, work_of_adhesion_j_m2: work, interaction_range_m: 1e-9 };
        let sphere = Asperity::new(RADIUS_M, &material)?;
        let way = |a: f64| sphere.penetration(a) + sphere.load(a) / STIFFNESS_N_M;
        // The displacement has one minimum above the jump-off radius of a stiff machine.
        let fine = (0..=20_000).map(|k| sphere.jump_off_radius() * (1.0 + 1e-4 * f64::from(k)));
        let least = fine.min_by(|u, v| way(*u).total_cmp(&way(*v))).unwrap_or_default();
        Ok(Self { end: (way(least), least), sphere })
    }

    /// Contact radius at a displacement of the piezo, by bisection.
    fn radius(&self, piezo: f64) -> f64 {
        let (mut low, mut high) = (self.end.1, RADIUS_M);
        for _ in 0..100 {
            let a = 0.5 * (low + high);
            if self.sphere.penetration(a) + self.sphere.load(a) / STIFFNESS_N_M < piezo {
                low = a;
            } else {
                high = a;
            }
        }
        0.5 * (low + high)
    }
}

/// Force on a contact of constant radius at a displacement of the piezo: F = 2E*(aδ − a³/(3R)), piezo = δ + F/k.
fn pinned(a: f64, piezo: f64) -> f64 {
    let (slope, offset) = (2.0 * MODULUS_PA * a, 2.0 * MODULUS_PA * a.powi(3) / (3.0 * RADIUS_M));
    slope * (piezo + offset / STIFFNESS_N_M) / (1.0 + slope / STIFFNESS_N_M) - offset
}

/// The text of the file.
///
/// # Errors
/// The errors of [`Asperity::new`].
pub fn run() -> Result<String, PhysicsError> {
    let [approach, retraction] = WORKS_J_M2.map(Path::new);
    let (approach, retraction) = (approach?, retraction?);
    let [low, high] = RANGE_M;
    let turn = approach.radius(high);
    let mut noise = Noise(60);
    let mut text = HEADING.to_owned();
    for k in 0..2 * POINTS - 1 {
        let is_back = k >= POINTS;
        let step = if is_back { 2 * POINTS - 2 - k } else { k };
        let piezo = low + (high - low) * f64::from(step) / f64::from(POINTS - 1);
        // Without load the tip touches where the piezo is at 0.
        let (a, force) = if !is_back {
            let a = if piezo < 0.0 { 0.0 } else { approach.radius(piezo) };
            (a, approach.sphere.load(a))
        } else if piezo <= retraction.end.0 {
            (0.0, 0.0)
        } else {
            let a = retraction.radius(piezo);
            if a < turn { (a, retraction.sphere.load(a)) } else { (turn, pinned(turn, piezo)) }
        };
        let time = 0.01 * f64::from(k);
        let measured = force + NOISE[0] * noise.normal() + 1.5e-8 + 4e-9 * time;
        let seen = if a > 0.0 { format!("{:.3}", 1e6 * (a + NOISE[1] * noise.normal())) } else { String::new() };
        let _ = writeln!(text, "{time:.2},{:.4},{:.1},{seen}", 1e6 * piezo, 1e9 * measured);
    }
    Ok(text)
}

fn main() -> Result<(), PhysicsError> {
    print!("{}", run()?);
    Ok(())
}
