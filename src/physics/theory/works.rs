//! Works of adhesion of closing and of opening that models predict from the energy of flattening.
//!
//! With the work of adhesion Δγ and the elastic energy per area `U_el` of flattening the roughness, both in
//! J/m². [`super::regime::effective_adhesion`] has Persson and Tosatti's `Δγ (1 + h'²/2) − U_el`, which holds
//! for both branches of a reversible contact.

/// Prefactors k of crack-front pinning, the smallest and the largest: `Δγ ∓ k U_el`.
///
/// The form is from Sanner, Kumar, Dhinojwala, Jacobs and Pastewka, Sci. Adv. 10:eadl1277 (2024). Their k is
/// about 3; it could not be confirmed at the source that this is half of the difference of both works, as it
/// is here. Our simulations of elastic lines in weak random fields have 1.2 to 1.5. Boundary elements on one
/// surface have a difference of 2.34 `U_el`, which is k = 1.17.
pub const PINNING_BAND: [f64; 2] = [1.2, 3.0];

/// Works of adhesion of an advancing (closing) and of a receding (opening) contact line, `Δγ − k U_el` and
/// `Δγ + k U_el` \[J/m²\].
///
/// Δγ and `U_el` in J/m²; k is dimensionless, see [`PINNING_BAND`]. `None` for `k U_el ≥ Δγ/2`: pinning is
/// collective only where the roughness is weak.
#[must_use]
pub fn pinning_works(
    work_of_adhesion_j_m2: f64,
    elastic_energy_j_m2: f64,
    prefactor: f64,
) -> Option<[f64; 2]> {
    let shift = prefactor * elastic_energy_j_m2;
    (shift < 0.5 * work_of_adhesion_j_m2)
        .then_some([work_of_adhesion_j_m2 - shift, work_of_adhesion_j_m2 + shift])
}

/// Work of adhesion of closing of conformal contact, `Δγ − U_el` \[J/m²\], with Δγ and `U_el` in J/m².
///
/// The energy of flattening is not recovered on opening, which dissipates `Θ = Δγ A`
/// ([`super::dalvi_loss`]). `None` for `U_el ≥ Δγ`. Dalvi et al., PNAS 116:25484 (2019).
#[must_use]
pub fn dalvi_closing(work_of_adhesion_j_m2: f64, elastic_energy_j_m2: f64) -> Option<f64> {
    (elastic_energy_j_m2 < work_of_adhesion_j_m2).then_some(work_of_adhesion_j_m2 - elastic_energy_j_m2)
}
