//! Springs in series with the contact: that of the machine, and that of the periodic cell.
//!
//! A spring of compliance c displaces all asperities alike, by `cF` with the total load F: a constant that is
//! added to the kernel of the interaction. Everything else stays as it is:
//!
//! ```text
//! δ_i = D + z_i − ŵ_i − cF                     D: displacement of the far end of the spring
//! Π   = Π_contact + ½cF²    dΠ/dD = F          since ½Σ F_i(ŵ_i + cF) contains ½cF²
//! ```
//!
//! The path is therefore that of the contact with the prescribed displacement D in place of Δ. Events,
//! jumps, relaxations and stability are those at fixed D. An equilibrium at fixed Δ is one at fixed D where
//! `dD/dΔ = 1 + c dF/dΔ > 0`: with the spring it ends earlier, never later. The mean penetration is
//! `Δ = D − cF`, and `∫F dΔ = ∫F dD − ½c[F²]`, along equilibria and at the jumps. Around a closed loop
//! `∮F dΔ = ∮F dD`.
//!
//! *Half-space.* The images of a periodic square and its balancing load displace a contact by
//! `−3.900265 F/(πE*L)`. A spring of this compliance removes that: the contacts near the middle of the square
//! are on a half-space. It belongs to the elastic body and not to the machine, and Δ contains it.
//!
//! *Load control* is the limit of a soft machine, `c → ∞`. A jump over `s` changes the load by `s/c`, and its
//! dissipated energy differs by `s²/(2c)` from that at fixed load. The compliance is [`SOFT_MACHINE`] times
//! that of the asperities which would carry the largest load, [`LOAD_OF_ONE`] `R_iΔγ` each: `1/(E*a_i)` for
//! one, with `a_i = (R_i²Δγ/E*)^⅓`. The spring is at most [`LONGEST_SPRING`] units of length long, so that
//! rounding of D stays below the tolerance of an equilibrium. The path does not end where the machine does,
//! but at the smallest load on it, which does not depend on c: there `dF/dΔ = 0`, or the contact jumps.
//!
//! A spring softer than that of the cell couples all contacts strongly. Local problems then hold all of them,
//! and each avalanche is followed by a global solve: no response is neglected. Since D changes by `1 + cK` of
//! Δ, with the stiffness K of the contact, increments may be longer by a power of two.

use super::problem::{Problem, Spring};
use crate::asperities::numerics::{Events, Numerics, Steps};
use crate::model::{Boundary, CELL_CONSTANT, Control, FarField, Interaction, Machine};

/// Compliance of the spring of load control, over the mean one of an asperity.
pub(super) const SOFT_MACHINE: f64 = 1000.0;

/// Load that one asperity carries, in `R_iΔγ`: several times its pull-off force.
pub(super) const LOAD_OF_ONE: f64 = 20.0;

/// Longest spring of load control at the largest load, in units of length.
pub(super) const LONGEST_SPRING: f64 = 2e4;

/// Number of increments into which the length of the spring at the largest load is divided at least.
pub(super) const INCREMENTS: f64 = 2000.0;

/// Number of output steps of length 1 into which it is divided.
pub(super) const OUTPUT_STEPS: f64 = 10.0;

impl Problem {
    /// Puts the contact on a machine, with the largest load of the cycle \[N\]; after the unit and the
    /// numerical choices, which it reads.
    #[must_use]
    pub fn on_machine(self, machine: &Machine, most_load_n: f64) -> Self {
        let cell = CELL_CONSTANT * self.material.compliance() / self.length_m;
        let has_images =
            self.rules.boundary == Boundary::Periodic && self.rules.interaction != Interaction::None;
        let far = if machine.far_field == FarField::HalfSpace && has_images { cell } else { 0.0 };
        let holds_load = machine.control == Control::Load && !self.is_adhesionless();
        let machine_m_n =
            if holds_load { self.soft_machine_m_n(most_load_n) } else { machine.compliance_m_n };
        let whole = far + machine_m_n;
        let is_soft = whole > (1.0 + 1e-9) * cell;
        let moves_as_one = whole > 0.0 && (is_soft || self.rules.interaction == Interaction::None);
        let length = whole * most_load_n;
        let longest = self.numerics.steps.accuracy * self.unit_m;
        let doublings = (length / (INCREMENTS * longest)).log2().ceil().clamp(0.0, 20.0) as u32;
        let spring = Spring {
            machine_m_n,
            holds_load,
            moves_as_one,
            doublings: if moves_as_one { doublings } else { 0 },
            output_m: machine_m_n * most_load_n / OUTPUT_STEPS,
        };
        let local_contacts = if moves_as_one { usize::MAX } else { self.numerics.events.local_contacts };
        let events = Events { local_contacts, ..self.numerics.events };
        let numerics = Numerics { events, ..self.numerics };
        Self { spring, numerics, field: self.field.with_uniform(whole), ..self }
    }

    /// Compliance of load control \[m/N\].
    fn soft_machine_m_n(&self, most_load_n: f64) -> f64 {
        let adhesion = self.material.adhesion_length_m();
        let radii = self.asperities.iter().map(|asperity| (asperity.radius_m().powi(2) * adhesion).cbrt());
        let mean = radii.sum::<f64>() / self.len() as f64;
        let radius =
            self.asperities.iter().map(|asperity| asperity.radius_m()).sum::<f64>() / self.len() as f64;
        let carrying = most_load_n / (LOAD_OF_ONE * radius * self.material.work_of_adhesion_j_m2);
        let soft = SOFT_MACHINE / (self.material.contact_modulus_pa * mean * carrying.max(1.0));
        soft.min(LONGEST_SPRING * self.unit_m / most_load_n.max(f64::MIN_POSITIVE))
    }

    /// Mean penetration of a state at the displacement D of the machine \[m\] with a load \[N\]: `D − cF`.
    #[must_use]
    pub fn mean_penetration_m(&self, machine_displacement_m: f64, load_n: f64) -> f64 {
        if self.spring.machine_m_n == 0.0 {
            return machine_displacement_m;
        }
        machine_displacement_m - self.spring.machine_m_n * load_n
    }

    /// Energy of the machine's spring at a load \[N\], `½cF²` \[J\].
    pub(crate) fn spring_energy_j(&self, load_n: f64) -> f64 {
        0.5 * self.spring.machine_m_n * load_n * load_n
    }

    /// Unit of the output steps of the machine's displacement \[m\].
    pub(crate) fn output_unit_m(&self) -> f64 {
        self.unit_m + self.spring.output_m
    }

    /// Limits of the increments: with a soft spring there are more halvings from a longer increment.
    pub(crate) fn increments(&self) -> Steps {
        let (steps, more) = (self.numerics.steps, self.spring.doublings);
        Steps {
            max_halvings: steps.max_halvings + more,
            strict_halvings: steps.strict_halvings + more,
            ..steps
        }
    }

    /// Longest increment over that without a spring.
    pub(crate) fn increment_growth(&self) -> f64 {
        f64::from(self.spring.doublings).exp2()
    }
}
