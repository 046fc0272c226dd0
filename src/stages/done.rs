//! A unit that has been computed, and the receipt that says so.

use super::StageError;
use crate::campaign::owned::{COMPARE, COMPARISON, comparison_receipt};
use crate::campaign::{Campaign, Unit};
use crate::store::commit::Written;
use crate::store::{Kept, Made, RECEIPT_VERSION, Receipt, write_receipt};
use serde_json::{Map, Value};
use std::path::Path;
use std::time::{Instant, SystemTime};

/// Written files and counted effort of a task.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    pub(super) files: Vec<Written>,
    pub(super) effort: Map<String, Value>,
}

impl Outcome {
    /// Of files alone.
    pub(super) fn of(files: Vec<Written>) -> Self {
        Self { files, effort: Map::new() }
    }
}

/// A clock that runs while a unit is computed.
pub(super) struct Clock {
    began: SystemTime,
    since: Instant,
}

impl Clock {
    pub(super) fn start() -> Self {
        Self { began: SystemTime::now(), since: Instant::now() }
    }

    /// Writes the receipt of a unit whose files are in place.
    pub(super) fn receipt(
        &self,
        campaign: &Campaign,
        unit: &Unit<'_>,
        preimages: Map<String, Value>,
        outcome: &Outcome,
    ) -> Result<(), StageError> {
        let words = [unit.stage.word(), unit.id, unit.key].map(str::to_owned);
        Ok(write_receipt(
            &campaign.receipt_path(unit),
            &self.filled(&campaign.dir, words, preimages, outcome),
        )?)
    }

    /// Writes the receipt of the resolved spec, which belongs to no stage.
    pub(super) fn spec_receipt(&self, campaign: &Campaign, outcome: &Outcome) -> Result<(), StageError> {
        let words = ["spec", "campaign", ""].map(str::to_owned);
        Ok(write_receipt(
            &campaign.spec_receipt_path(),
            &self.filled(&campaign.dir, words, campaign.resolved_record(), outcome),
        )?)
    }

    /// Writes the receipt of a comparison into its folder.
    pub(super) fn comparison_receipt(&self, dir: &Path, files: Vec<Written>) -> Result<(), StageError> {
        let words = [COMPARE, COMPARISON, ""].map(str::to_owned);
        let path = comparison_receipt(dir);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|source| StageError::Folder { path: folder.to_owned(), source })?;
        }
        Ok(write_receipt(&path, &self.filled(dir, words, Map::new(), &Outcome::of(files)))?)
    }

    fn filled(
        &self,
        dir: &Path,
        [stage, id, key]: [String; 3],
        preimages: Map<String, Value>,
        outcome: &Outcome,
    ) -> Receipt {
        let files = outcome.files.iter().map(|written| Kept::of(written, dir)).collect();
        Receipt { receipt: RECEIPT_VERSION, stage, id, key, preimages, files, made: self.made(outcome) }
    }

    fn made(&self, outcome: &Outcome) -> Made {
        let commit = env!("HYSTERON_COMMIT");
        Made {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: (!commit.is_empty()).then(|| commit.to_owned()),
            toolchain: env!("HYSTERON_TOOLCHAIN").to_owned(),
            host: gethostname::gethostname().to_string_lossy().into_owned(),
            threads: rayon::current_num_threads(),
            began: humantime::format_rfc3339_seconds(self.began).to_string(),
            seconds: self.since.elapsed().as_secs_f64(),
            effort: outcome.effort.clone(),
        }
    }
}
