//! Table of the works of adhesion that models predict over the cut-off wavelength.

use super::surface::scale;
use super::{StageError, spectra};
use crate::campaign::{Campaign, Standing};
use crate::model::Material;
use crate::physics::theory::cut_off::LongWaves;
use crate::physics::theory::regime::effective_adhesion;
use crate::physics::theory::works::{PINNING_BAND, dalvi_closing, pinning_works};
use crate::schema::CUTOFF;
use crate::stats::Sample;
use crate::store::Frame;
use rayon::prelude::*;

/// One cut-off wavelength of a case.
struct Row {
    case_id: String,
    material: Material,
    count: usize,
    of: LongWaves,
    energy_j_m2: f64,
    energy_sd_j_m2: Option<f64>,
    below_j_m2: f64,
}

impl Row {
    /// Ratio `U_el/Δγ`; nothing without adhesion.
    fn ratio(&self) -> Option<f64> {
        let adhesion = self.material.work_of_adhesion_j_m2;
        (adhesion > 0.0).then(|| self.energy_j_m2 / adhesion)
    }

    fn persson_tosatti(&self) -> Option<f64> {
        effective_adhesion(self.material.work_of_adhesion_j_m2, self.of.rms_slope, self.energy_j_m2)
    }

    fn dalvi(&self) -> Option<f64> {
        dalvi_closing(self.material.work_of_adhesion_j_m2, self.energy_j_m2)
    }

    /// Work of a branch, closing or opening, with one of the prefactors of the band.
    fn pinning(&self, branch: usize, prefactor: usize) -> Option<f64> {
        let works =
            pinning_works(self.material.work_of_adhesion_j_m2, self.energy_j_m2, PINNING_BAND[prefactor]);
        works.map(|works| works[branch])
    }
}

/// The table, for all cases with a known surface.
pub(super) fn table(campaign: &Campaign, standings: &[Standing]) -> Result<Frame, StageError> {
    let mut rows = Vec::new();
    let is_shown = |case: &usize| !campaign.cases[*case].case.is_coarser_grid();
    for case in (0..campaign.cases.len()).filter(is_shown) {
        rows.extend(of_case(campaign, standings, case)?);
    }
    let each = |value: &dyn Fn(&Row) -> Option<f64>| -> Vec<Option<f64>> {
        rows.iter().map(|row| value(row).filter(|value| value.is_finite())).collect()
    };
    Ok(Frame::of(&CUTOFF)
        .text("case_id", rows.iter().map(|row| row.case_id.as_str()))
        .f64("cut_off_m", rows.iter().map(|row| row.of.cut_off_m))
        .count("surface_count", rows.iter().map(|row| row.count))
        .f64("rms_height_m", rows.iter().map(|row| row.of.rms_height_m))
        .f64("rms_slope", rows.iter().map(|row| row.of.rms_slope))
        .f64("work_of_adhesion_j_m2", rows.iter().map(|row| row.material.work_of_adhesion_j_m2))
        .f64("flattening_j_m2", rows.iter().map(|row| row.energy_j_m2))
        .f64("flattening_sd_j_m2", each(&|row| row.energy_sd_j_m2))
        .f64("flattening_below_j_m2", rows.iter().map(|row| row.below_j_m2))
        .f64("flattening_ratio", each(&Row::ratio))
        .f64("work_persson_tosatti_j_m2", each(&Row::persson_tosatti))
        .f64("work_dalvi_closing_j_m2", each(&Row::dalvi))
        .f64("loss_dalvi_j_m2", each(&|row| row.dalvi().map(|_| row.material.work_of_adhesion_j_m2)))
        .f64("work_pinning_closing_low_j_m2", each(&|row| row.pinning(0, 1)))
        .f64("work_pinning_closing_high_j_m2", each(&|row| row.pinning(0, 0)))
        .f64("work_pinning_opening_low_j_m2", each(&|row| row.pinning(1, 0)))
        .f64("work_pinning_opening_high_j_m2", each(&|row| row.pinning(1, 1)))
        .build()?)
}

/// Ratio of sides that are the same but for rounding.
const SAME: f64 = 1.0 + 1e-6;

/// The rows of a case: means over the surfaces of its finished and failed cycles. None if its scans differ in
/// size.
fn of_case(campaign: &Campaign, standings: &[Standing], case: usize) -> Result<Vec<Row>, StageError> {
    let surfaces: Vec<_> = campaign
        .cycles
        .iter()
        .zip(standings)
        .filter(|(cycle, standing)| cycle.case == case && standing.is_settled())
        .map(|(cycle, _)| &campaign.surfaces[cycle.surface])
        .collect();
    let all: Vec<Vec<LongWaves>> =
        surfaces.par_iter().map(|unit| spectra::read(campaign, unit)).collect::<Result<_, _>>()?;
    // Scans of different size have no wavelengths in common from the longest on.
    let longest = || all.iter().filter_map(|waves| waves.first()).map(|of| of.cut_off_m);
    let ends = longest().reduce(f64::min).zip(longest().reduce(f64::max));
    if ends.is_some_and(|(least, most)| most > SAME * least) {
        return Ok(Vec::new());
    }
    let unit = &campaign.cases[case];
    let Some(known) = surfaces.iter().zip(&all).find(|(_, waves)| !waves.is_empty()) else {
        return Ok(Vec::new());
    };
    let of_case = unit.case.params.material;
    // Only a tabulated spectrum has roughness below the grid.
    let of_table = known.0.params.generated().and_then(|_| scale(campaign, known.0).ok());
    let material = of_table.map_or(of_case, |scale| scale.material(&of_case));
    let mut cut_offs: Vec<f64> = all.iter().flatten().map(|of| of.cut_off_m).collect();
    cut_offs.sort_by(|a, b| b.total_cmp(a));
    cut_offs.dedup();
    Ok(cut_offs.into_iter().map(|cut_off_m| row(&unit.id, material, &all, cut_off_m)).collect())
}

/// The row of a cut-off wavelength, over the surfaces that have it.
fn row(case_id: &str, material: Material, all: &[Vec<LongWaves>], cut_off_m: f64) -> Row {
    let found: Vec<(&LongWaves, &LongWaves)> = all
        .iter()
        .filter_map(|waves| waves.iter().find(|of| of.cut_off_m == cut_off_m).zip(waves.last()))
        .collect();
    let mean = |value: &dyn Fn(&LongWaves) -> f64| {
        found.iter().map(|(of, _)| value(of)).sum::<f64>() / found.len() as f64
    };
    let energy = |of: &LongWaves| of.energy_j_m2(material.contact_modulus_pa);
    let energies: Vec<f64> = found.iter().map(|(of, _)| energy(of)).collect();
    let below: f64 = found.iter().map(|(of, whole)| energy(whole) - energy(of)).sum();
    Row {
        case_id: case_id.to_owned(),
        material,
        count: found.len(),
        of: LongWaves {
            cut_off_m,
            rms_height_m: mean(&|of| of.rms_height_m),
            rms_slope: mean(&|of| of.rms_slope),
            flattening_m: mean(&|of| of.flattening_m),
        },
        energy_j_m2: mean(&energy),
        energy_sd_j_m2: Sample::of(&energies).sd,
        below_j_m2: below / found.len() as f64,
    }
}
