//! Scripts and descriptions of a campaign for other programs, in readable text.
//!
//! The program is no scheduler. The one seam is a shard: some surfaces and all that is done with them, which
//! may be run at any time, anywhere, twice at once.

pub mod ro_crate;
pub mod slurm;
pub mod snakemake;

use crate::campaign::{Campaign, Stage, Standing, Survey};
use crate::constants::{Constant, Constants};

/// Limits of parts of a run on a cluster.
pub const CONSTANTS: Constants = Constants {
    subject: "Clusters",
    module: "engines",
    rows: &[
        Constant::new(
            "parts of a run, default",
            &[MOST_SHARDS as f64],
            "",
            "Maximum. Otherwise one for each surface.",
            "",
        ),
        Constant::new(
            "signal before a time limit",
            &[slurm::LEAD_S as f64],
            "s",
            "A quarter of a shorter limit than four times this.",
            "slurm",
        ),
        Constant::new(
            "early signal",
            &[slurm::EARLY_S as f64],
            "s",
            "Slurm may signal earlier by this.",
            "slurm",
        ),
    ],
};

/// Default maximum number of shards: a scheduler takes about a second for each.
const MOST_SHARDS: usize = 1000;

/// Default number of shards of a campaign: one for each surface.
#[must_use]
pub fn usual_shards(campaign: &Campaign) -> usize {
    campaign.surfaces.len().clamp(1, MOST_SHARDS)
}

/// The shards that have units of a stage which are not done; failed cases are not open. Stages beyond the
/// cycles have no shards.
#[must_use]
pub fn open_shards(campaign: &Campaign, survey: &Survey, stage: Stage, count: usize) -> Vec<usize> {
    let mut open = vec![false; count];
    let mut enter = |surface: usize, standing: &Standing| {
        if !standing.is_settled() {
            open[surface % count] = true;
        }
    };
    match stage {
        Stage::Generate => {
            survey.surfaces.iter().enumerate().for_each(|(surface, standing)| enter(surface, standing));
        }
        Stage::Extract => {
            survey.asperities.iter().enumerate().for_each(|(surface, standing)| enter(surface, standing));
        }
        Stage::Cycle => survey
            .cycles
            .iter()
            .for_each(|(place, standing)| enter(campaign.cycles[*place].surface, standing)),
        Stage::Aggregate | Stage::Report => {}
    }
    (0..count).filter(|shard| open[*shard]).collect()
}
