//! Units of the panels of a sweep.

use super::FigureError;
use super::sweep::{Member, Sweep, Tables};
use std::collections::HashMap;

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

/// Scales of the results of cases, by the rows of the table `cases`.
pub(super) struct Scales<'a> {
    units: Units,
    /// True if all cases of the sweep have a probe.
    of_probe: bool,
    modulus_pa: &'a [Option<f64>],
    /// Nominal areas \[m²\] and rms heights \[m\] of the surfaces of each row; nothing where they differ.
    area_m2: Vec<Option<f64>>,
    rms_height_m: Vec<Option<f64>>,
    /// True if penetrations are in micrometres: a surface of the sweep has that rms height.
    is_in_um: bool,
}

impl<'a> Scales<'a> {
    pub(super) fn of(tables: &Tables<'a>, sweep: &Sweep, units: Units) -> Result<Self, FigureError> {
        let radius = tables.cases.f64_or_null("probe_radius_m")?;
        let of_si = |column| if units == Units::Si { common(tables, column) } else { Ok(Vec::new()) };
        let rms_height_m = of_si("rms_height_m")?;
        let height = |member: &Member| rms_height_m.get(member.row).copied().flatten();
        Ok(Self {
            is_in_um: sweep.members.iter().filter_map(height).any(|height| height >= 1e-6),
            units,
            of_probe: sweep.members.iter().all(|member| radius.get(member.row).is_some_and(Option::is_some)),
            modulus_pa: tables.cases.f64_or_null("contact_modulus_pa")?,
            area_m2: of_si("nominal_area_m2")?,
            rms_height_m,
        })
    }

    pub(super) fn units(&self) -> Units {
        self.units
    }

    /// Column of the tables `cases`, without its ending, and `realizations` that has a dimensionless result
    /// in the units of the panel, if there is one, and the factor of its values.
    pub(super) fn column(&self, result: &str) -> Option<(&'static str, f64)> {
        if self.units == Units::Dimensionless {
            return None;
        }
        let named = match (result, self.of_probe) {
            ("pull_off_load", true) => ("pull_off_load_n", 1.0),
            ("pull_off_load", false) => ("pull_off_pressure_pa", 1e-3),
            ("loss", true) => ("loss_j", 1.0),
            ("loss", false) => ("loss_j_m2", 1e3),
            _ => return None,
        };
        Some(named)
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
            (Units::Si, Quantity::Penetration, _) if self.is_in_um => "Δ [µm]",
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
        let of_row = |values: &[Option<f64>]| values.get(row).copied().flatten();
        if self.units == Units::Dimensionless {
            return Some(1.0);
        }
        let length = if self.is_in_um { 1e6 } else { 1e9 };
        // Milli and kilo of the labels per area.
        let (area, milli, kilo) =
            if self.of_probe { (of_row(&self.area_m2)?, 1.0, 1.0) } else { (1.0, 1e3, 1e-3) };
        match of {
            Quantity::Area => Some(area),
            Quantity::Penetration => Some(length * of_row(&self.rms_height_m)?),
            Quantity::Load | Quantity::PullOff => Some(of_row(self.modulus_pa)? * area * kilo),
            Quantity::Loss => Some(of_row(self.modulus_pa)? * area * of_row(&self.rms_height_m)? * milli),
        }
    }
}

/// Value that all realizations of each row of the table `cases` have in a column; nothing where they differ.
fn common(tables: &Tables<'_>, column: &str) -> Result<Vec<Option<f64>>, FigureError> {
    let (ids, known) = (tables.cases.text("case_id")?, tables.realizations.text("case_id")?);
    let values = tables.realizations.f64_or_null(column)?;
    let mut of_case: HashMap<&str, Option<f64>> = HashMap::new();
    for (id, value) in known.iter().zip(values) {
        let shared = of_case.entry(id).or_insert(*value);
        let is_same = shared.zip(*value).is_some_and(|(shared, value)| (value / shared - 1.0).abs() < SAME);
        if !is_same {
            *shared = None;
        }
    }
    Ok(ids.iter().map(|id| of_case.get(id).copied().flatten()).collect())
}

/// Relative difference of equal lengths: rounding.
const SAME: f64 = 1e-9;
