//! Status of cycles whose results decide on further ones.

use super::StageError;
use crate::campaign::{Campaign, Standing, SurfaceUnit};
use crate::store::Check;
use rayon::prelude::*;

/// A result of finished cycles by the sizes of their files, and by their contents if a file cannot be read.
pub(super) fn by_sizes_first<T>(of: impl Fn(Check) -> Result<T, StageError>) -> Result<T, StageError> {
    of(Check::Sizes).or_else(|_| of(Check::Contents))
}

/// Status of all cycles. With the check of contents, those of damaged surfaces are not finished.
pub(super) fn standings_by(campaign: &Campaign, check: Check) -> Vec<Standing> {
    let mut standings = campaign.cycle_standings(check);
    if check == Check::Contents {
        let is_whole = |unit: &SurfaceUnit| {
            [unit.surface(), unit.asperities()]
                .iter()
                .all(|of| campaign.standing(of, check) == Standing::Done)
        };
        let whole: Vec<bool> = campaign.surfaces.par_iter().map(is_whole).collect();
        let done = campaign.cycles.iter().zip(&mut standings).filter(|(_, of)| **of == Standing::Done);
        for (_, standing) in done.filter(|(unit, _)| !whole[unit.surface]) {
            *standing = Standing::Planned;
        }
    }
    standings
}
