//! The field of one spot at another asperity.

use crate::reference::table;
use crate::support::{LENGTH, close, near};
use hysteron::physics::asperities::field::spot_field::{Spot, SpotColumns, dimensionless_field, spot_field};
use hysteron::physics::jkr::Asperity;
use std::f64::consts::{FRAC_PI_2, PI};

/// Spots of the paper's size: contact radius, radius of curvature, `sqrt(2πΔγ/E*)`.
fn spots() -> [(f64, f64, f64); 3] {
    let pull = (2.0 * PI * 0.07 / 1e6f64).sqrt();
    [(4e-6, 2.5e-5, pull), (1.5e-5, 2.5e-5, pull), (2e-5, 1e-4, pull)]
}

/// Eqs 6 and 7 as printed: cancels far away.
fn as_printed(u: f64) -> (f64, f64) {
    ((u * u - 1.0).sqrt() + (2.0 - u * u) * (1.0 / u).asin(), (1.0 / u).asin())
}

#[test]
fn val_both_parts_agree_with_many_digits() {
    for row in table("pair_field").rows() {
        let u = row.number("r_over_a");
        let (indentation, adhesion) = dimensionless_field(u);
        // The polynomials are good to 3e-16; the rest are roundings, doubled by the square root near u = 1.
        close("indentation", indentation, row.number("g1"), 1e-14);
        close("adhesion", adhesion, row.number("asin_inv_u"), 1e-14);
        // With a = 1 the distance is u itself, and the two parts come one at a time.
        close("field without adhesion", spot_field(u, 1.0, 1.0, 0.0).0, row.number("g1") / PI, if u > 1.0 { 1e-14 } else { 1.0 });
        if u > 1.0 {
            let (value, slope) = spot_field(u, 1.0, f64::INFINITY, 1.0);
            close("field of adhesion", value, -2.0 / PI * row.number("asin_inv_u"), 1e-14);
            let want = -2.0 / PI * (0.5 * row.number("asin_inv_u") + row.number("inv_sqrt_u2_minus_1"));
            // r² is formed and its root taken again: at u − 1 = 1e-12 that rounding is 1e-4 of u − 1.
            close("slope of adhesion", slope, want, 1e-14 + 4e-16 / (u - 1.0));
        }
    }
}

#[test]
fn val_the_closed_form_holds_where_it_does_not_cancel() {
    for k in 0..40 {
        let u = 1.0 + 0.05 * f64::from(k);
        let (indentation, adhesion) = as_printed(u);
        // Up to u = 3 the printed terms are at most 8 times the result.
        close("indentation", dimensionless_field(u).0, indentation, 3e-15 * u * u);
        close("adhesion", dimensionless_field(u).1, adhesion, 3e-15);
        for (a, radius, pull) in spots() {
            let want = a * a / (PI * radius) * indentation - 2.0 / PI * pull * a.sqrt() * adhesion;
            let terms = a * a / radius + pull * a.sqrt();
            // u·a is rounded, and asin has an infinite slope at u = 1: 1.5e-8 is the root of that rounding.
            near("field", spot_field(u * a, a, radius, pull).0, want, terms * if k == 0 { 3e-8 } else { 2e-14 });
        }
    }
}

#[test]
fn law_the_field_is_continuous_at_the_edge() {
    for (a, radius, pull) in spots() {
        let edge = a * a / (2.0 * radius) - pull * a.sqrt();
        let scale = a * a / radius + pull * a.sqrt();
        near("at the edge", spot_field(a, a, radius, pull).0, edge, 1e-14 * scale);
        for h in [1e-2, 1e-4, 1e-6, 1e-9] {
            // Inside the slope is finite, a/R; outside it is that of −(2/π) pull √a asin(1/(1 + h)), a root of h.
            let inside = spot_field(a * (1.0 - h), a, radius, pull).0;
            near("from inside", inside, edge + a * a / radius * (h - 0.5 * h * h), 1e-14 * scale);
            let outside = spot_field(a * (1.0 + h), a, radius, pull).0;
            let root = 2.0 / PI * pull * a.sqrt() * (2.0 * h).sqrt();
            near("from outside", outside, edge + root, scale * (2.0 * h + 1e-12));
        }
    }
    let (indentation, adhesion) = dimensionless_field(1.0);
    // As good as against the many digits.
    close("indentation", indentation, FRAC_PI_2, 1e-14);
    close("adhesion", adhesion, FRAC_PI_2, 1e-14);
}

#[test]
fn law_inside_the_surface_conforms_to_the_asperity() {
    // ŵ + r²/(2R) is constant: the spot's own rigid shape; the constant is its penetration (Eq 2).
    for (a, radius, pull) in spots() {
        for share in [1e-6, 0.1, 0.5, 0.999] {
            let r = share * a;
            let (value, slope) = spot_field(r, a, radius, pull);
            let scale = a * a / radius + pull * a.sqrt();
            near("shape", value + r * r / (2.0 * radius), a * a / radius - pull * a.sqrt(), 1e-14 * scale);
            near("slope", slope, 2.0 * a / radius - pull / (2.0 * a.sqrt()), 1e-14 * scale / a);
        }
    }
}

#[test]
fn law_the_slope_is_the_derivative_to_the_radius() {
    for (a, radius, pull) in spots() {
        for u in [1.05, 1.3, 2.0, 5.0, 50.0, 1e4] {
            let r = u * a;
            let field = |b: f64| spot_field(r, b, radius, pull).0;
            let slope = spot_field(r, a, radius, pull).1;
            // Fourth order with a step of 2e-3 of the distance to the singular edge: (2e-3)⁴ × 24/30 × its derivatives, 1e-10;
            // rounding over the step, 1e-13/(u − 1) of the value.
            let h = 2e-3 * a * (u - 1.0).min(1.0);
            let rule = (field(a - 2.0 * h) - 8.0 * field(a - h) + 8.0 * field(a + h) - field(a + 2.0 * h)) / (12.0 * h);
            let terms = (4.0 * a / (PI * radius) + pull / a.sqrt() / (u * u - 1.0).sqrt().min(1.0)) / u;
            near("slope", rule, slope, 1e-9 * terms);
        }
    }
}

#[test]
fn lim_far_away_a_spot_is_a_point_load() {
    for (a, radius, pull) in spots() {
        // F/E* by Eq 1: both its terms, whose fields approach the point load's at different rates.
        let hertz = 4.0 * a.powi(3) / (3.0 * radius);
        let punch = 2.0 * pull * a.powf(1.5);
        for x in [0.1, 1e-2, 1e-3, 1e-6] {
            let r = a / x;
            let got = spot_field(r, a, radius, pull).0 * PI * r;
            // (1 + x²/10 + 9x⁴/280 …) and (1 + x²/6 + 3x⁴/40 …): the first terms left out, with a tenth for the rest; and rounding.
            let want = hertz * (1.0 + x * x / 10.0) - punch * (1.0 + x * x / 6.0);
            let next = 1.1 * x.powi(4) * (hertz * 9.0 / 280.0 + punch * 3.0 / 40.0);
            near("F/(pi E r)", got, want, next + 1e-14 * (hertz + punch));
        }
        let material = hysteron::model::Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
        let jkr = Asperity::new(radius, &material).unwrap();
        near("load of the far field", 1e6 * (hertz - punch), jkr.load(a), 1e-14 * 1e6 * (hertz + punch));
    }
}

#[test]
fn reg_columns_hold_what_they_are_set_to() {
    let mut columns = SpotColumns::default();
    assert!(columns.is_empty());
    let spot = Spot { x: 0.1 * LENGTH, y: 0.2 * LENGTH, a: 1e-5, radius: 1e-4, load: 1e-6, load_slope: 1.0 };
    columns.set([spot, spot].into_iter());
    assert_eq!(columns.len(), 2);
    // Set again, not added to.
    columns.set(std::iter::once(spot));
    assert_eq!(columns.len(), 1);
    assert!(!columns.is_empty());
}
