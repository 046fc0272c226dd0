//! Units of the panels of a sweep.

use super::FigureError;
use super::sweep::Sweep;
use crate::store::Frame;

/// Units of the panels of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Units {
    /// Over the reduced modulus, the nominal area and the rms height.
    Dimensionless,
    /// SI: of a probe newtons and joules, of flat surfaces per nominal area.
    Si,
}

impl Units {
    /// All.
    pub const ALL: [Self; 2] = [Self::Dimensionless, Self::Si];

    /// Ending of the names of the panels.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Self::Dimensionless => "",
            Self::Si => "_SI",
        }
    }
}

/// A quantity of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Load,
    Area,
    Penetration,
    PullOff,
    Loss,
}

/// Factors of the dimensionless quantities of cases, by the rows of the table `cases`.
pub(super) struct Scales<'a> {
    units: Units,
    /// True if all cases of the sweep have a probe.
    of_probe: bool,
    modulus_pa: &'a [Option<f64>],
    nominal_area_m2: &'a [Option<f64>],
    rms_height_m: &'a [Option<f64>],
}

impl<'a> Scales<'a> {
    pub(super) fn of(cases: &'a Frame, sweep: &Sweep, units: Units) -> Result<Self, FigureError> {
        let radius = cases.f64_or_null("probe_radius_m")?;
        Ok(Self {
            units,
            of_probe: sweep.members.iter().all(|member| radius.get(member.row).is_some_and(Option::is_some)),
            modulus_pa: cases.f64_or_null("contact_modulus_pa")?,
            nominal_area_m2: cases.f64_or_null("nominal_area_m2_mean")?,
            rms_height_m: cases.f64_or_null("rms_height_m")?,
        })
    }

    /// Label of an axis.
    pub(super) fn label(&self, of: Quantity) -> &'static str {
        match (self.units, of, self.of_probe) {
            (Units::Dimensionless, Quantity::Load, _) => "F/(E^{*}A_{0})",
            (Units::Dimensionless, Quantity::Penetration, _) => "Δ/h_{rms}",
            (Units::Dimensionless, Quantity::PullOff, _) => "F_{po}/(E^{*}A_{0})",
            (Units::Dimensionless, Quantity::Loss, _) => "Θ/(E^{*}A_{0}h_{rms})",
            (Units::Dimensionless, Quantity::Area, _) | (Units::Si, Quantity::Area, false) => "A/A_{0}",
            (Units::Si, Quantity::Area, true) => "A [m²]",
            (Units::Si, Quantity::Penetration, _) => "Δ [nm]",
            (Units::Si, Quantity::Load, false) => "F/A_{0} [kPa]",
            (Units::Si, Quantity::Load, true) => "F [N]",
            (Units::Si, Quantity::PullOff, false) => "F_{po}/A_{0} [kPa]",
            (Units::Si, Quantity::PullOff, true) => "F_{po} [N]",
            (Units::Si, Quantity::Loss, false) => "Θ/A_{0} [mJ/m²]",
            (Units::Si, Quantity::Loss, true) => "Θ [J]",
        }
    }

    /// Factor of the dimensionless values of a row; nothing if the row lacks a scale.
    pub(super) fn factor(&self, of: Quantity, row: usize) -> Option<f64> {
        let of_row = |column: &[Option<f64>]| column.get(row).copied().flatten();
        if self.units == Units::Dimensionless {
            return Some(1.0);
        }
        // Milli, kilo and nano of the labels per area.
        let (area, milli, kilo) =
            if self.of_probe { (of_row(self.nominal_area_m2)?, 1.0, 1.0) } else { (1.0, 1e3, 1e-3) };
        match of {
            Quantity::Area => Some(area),
            Quantity::Penetration => Some(1e9 * of_row(self.rms_height_m)?),
            Quantity::Load | Quantity::PullOff => Some(of_row(self.modulus_pa)? * area * kilo),
            Quantity::Loss => Some(of_row(self.modulus_pa)? * area * of_row(self.rms_height_m)? * milli),
        }
    }
}
