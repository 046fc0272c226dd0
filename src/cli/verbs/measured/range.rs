//! Range of the asperity model on a measured surface.

use crate::model::{FLATTENED, Material};
use crate::spec::CaseParams;
use crate::stages::Examined;
use crate::stats::{Limit, significant};

/// Range of the asperity model on a surface: the elastic energies that flatten its roughness are proportional
/// to E*.
pub(super) struct Range<'a> {
    /// `U_el/E*` \[m\], of all roughness.
    pub(super) whole_m: f64,
    /// `U_1/E*` \[m\], of the shortest octave; 0 where that is unknown.
    pub(super) octave_m: f64,
    /// Shortest wavelength of this octave \[m\].
    pub(super) shortest_m: f64,
    examined: &'a Examined,
}

/// Work of adhesion of the printed spec \[J/m²\].
const ADHESION_J_M2: f64 = 0.05;

/// Modulus of the printed spec over the smallest one inside the range, at least.
const MARGIN: f64 = 1.5;

/// Limit of a warning.
fn limit(code: &str) -> f64 {
    Limit::of(code).map_or(f64::NAN, |limit| limit.bound)
}

/// Limits of `U_el/Δγ` and `U_1/Δγ`.
fn limits() -> [f64; 2] {
    ["sticky", "conformed"].map(limit)
}

impl<'a> Range<'a> {
    /// Of a surface with its asperities and estimates.
    pub(super) fn of(examined: &'a Examined) -> Self {
        let (unit, shortest_m) =
            (examined.estimates.flattening.energies(1.0), examined.estimates.shortest_wavelength_m);
        Self { whole_m: unit.whole_j_m2, octave_m: unit.octave_j_m2, shortest_m, examined }
    }

    /// The ratios `U_el/Δγ` and `U_1/Δγ` of a material.
    fn ratios(&self, modulus_pa: f64, adhesion_j_m2: f64) -> [f64; 2] {
        [self.whole_m, self.octave_m].map(|length| modulus_pa * length / adhesion_j_m2)
    }

    /// Smallest `E*/Δγ` inside the range \[1/m\]: both ratios are at their limits or above.
    pub(super) fn least_1_m(&self) -> f64 {
        let [whole, octave] = limits();
        let of_octave = if self.octave_m > 0.0 { octave / self.octave_m } else { 0.0 };
        of_octave.max(whole / self.whole_m)
    }

    /// A round modulus inside the range for [`ADHESION_J_M2`] \[Pa\]; the largest of a spec if that is
    /// smaller.
    fn modulus_pa(&self) -> f64 {
        let least = MARGIN * self.least_1_m() * ADHESION_J_M2;
        let decade = 10_f64.powf(least.log10().floor());
        let round =
            [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * decade).find(|modulus| *modulus >= least);
        round.unwrap_or(f64::INFINITY).clamp(1.0, 1e13)
    }

    /// The condition as a paragraph.
    pub(super) fn text(&self) -> String {
        let [whole, octave] = limits();
        let octave = if self.octave_m > 0.0 { format!(" and U_1/Δγ ≥ {octave}") } else { String::new() };
        format!(
            "U_el/Δγ ≥ {whole}{octave}, that is E*/Δγ ≥ {:.2e} 1/m. U_el = E* x {:.3e} m is the \
             energy per area that flattens all roughness, U_1 = E* x {:.3e} m that of its shortest octave \
             (wavelengths up to {:.3e} m). A softer or more adhesive contact is outside the range of the \
             asperity model: use method = \"boundary_elements\" or \"auto\". Below E*/Δγ = {:.2e} 1/m \
             adhesion flattens the whole surface.",
            self.least_1_m(),
            self.whole_m,
            self.octave_m,
            2.0 * self.shortest_m,
            FLATTENED / self.whole_m
        )
    }

    /// Material and model of the printed spec.
    pub(super) fn spec(&self, periodic: bool) -> String {
        let modulus = self.modulus_pa();
        let [whole, octave] = self.ratios(modulus, ADHESION_J_M2).map(|ratio| significant(ratio, 2));
        let [at_least, and] = limits();
        let ratios = format!("# U_el/Δγ = {whole} (limit ≥ {at_least}), U_1/Δγ = {octave} (limit ≥ {and})");
        let mut text = format!(
            "[material]      {ratios}\ncontact_modulus_pa = {modulus:e}\nwork_of_adhesion_j_m2 = \
             {ADHESION_J_M2}\n"
        );
        let range_m = CaseParams::default().material.interaction_range_m;
        let material = Material {
            contact_modulus_pa: modulus,
            work_of_adhesion_j_m2: ADHESION_J_M2,
            interaction_range_m: range_m,
        };
        let least = limit("tabor");
        let jump_in = self.examined.least_tabor(&material).filter(|tabor| *tabor < least).map(|tabor| {
            format!(
                "jump_in = \"jkr\"      # Tabor parameter μ ≥ {}; \"wu\" requires {least}\n",
                significant(tabor, 2)
            )
        });
        let boundary = (!periodic).then(|| "boundary = \"isolated\"\n".to_owned());
        let model: Vec<String> = [boundary, jump_in].into_iter().flatten().collect();
        if !model.is_empty() {
            text += &format!("[model]\n{}", model.concat());
        }
        text
    }
}
