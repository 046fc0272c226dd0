//! Paths of the files of a run.

use super::{Campaign, CycleUnit, Stage, SurfaceUnit, Unit};
use std::path::PathBuf;

impl Campaign {
    /// `surfaces/<id>.h5`.
    #[must_use]
    pub fn surface_path(&self, unit: &SurfaceUnit) -> PathBuf {
        self.dir.join("surfaces").join(format!("{}.h5", unit.id))
    }

    /// `asperities/<id>.parquet`.
    #[must_use]
    pub fn asperities_path(&self, unit: &SurfaceUnit) -> PathBuf {
        self.dir.join("asperities").join(format!("{}.parquet", unit.id))
    }

    /// `estimates/<id>.parquet`.
    #[must_use]
    pub fn estimates_path(&self, unit: &SurfaceUnit) -> PathBuf {
        self.dir.join("estimates").join(format!("{}.parquet", unit.id))
    }

    /// `spectra/<id>.parquet`.
    #[must_use]
    pub fn spectra_path(&self, unit: &SurfaceUnit) -> PathBuf {
        self.dir.join("spectra").join(format!("{}.parquet", unit.id))
    }

    /// `cycles/<id>/`.
    #[must_use]
    pub fn cycle_dir(&self, unit: &CycleUnit) -> PathBuf {
        self.dir.join("cycles").join(&unit.id)
    }

    /// Path of the failure record of a cycle.
    #[must_use]
    pub fn failure_path(&self, unit: &CycleUnit) -> PathBuf {
        self.cycle_dir(unit).join("failed.json")
    }

    /// Path of the record of loads that a finished cycle has not reached.
    #[must_use]
    pub fn not_reached_path(&self, unit: &CycleUnit) -> PathBuf {
        self.cycle_dir(unit).join("not_reached.json")
    }

    /// Path of the checkpoint of a cycle.
    #[must_use]
    pub fn halfway_path(&self, unit: &CycleUnit) -> PathBuf {
        self.cycle_dir(unit).join("halfway.bin")
    }

    /// `statistics/<table>.parquet`.
    #[must_use]
    pub fn statistics_path(&self, table: &str) -> PathBuf {
        self.dir.join("statistics").join(format!("{table}.parquet"))
    }

    /// Path of the provenance record of a task.
    #[must_use]
    pub fn receipt_path(&self, unit: &Unit<'_>) -> PathBuf {
        self.receipts_dir(unit.stage).join(format!("{}.json", unit.id))
    }

    /// Path of the provenance record of the resolved spec.
    #[must_use]
    pub fn spec_receipt_path(&self) -> PathBuf {
        self.dir.join("receipts").join("campaign.json")
    }

    /// `receipts/<stage>/`.
    #[must_use]
    pub fn receipts_dir(&self, stage: Stage) -> PathBuf {
        self.dir.join("receipts").join(stage.word())
    }
}
