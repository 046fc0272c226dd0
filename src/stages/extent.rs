//! Size and grid of the surfaces of a case: common to all realizations, or those of one of several scans.

use super::StageError;
use super::cycle::lattice;
use super::surface_row::SurfaceRow;
use crate::campaign::{Campaign, CycleUnit, SurfaceUnit};
use crate::schema::{CaseFacts, PARAMETERS};
use crate::spec::CaseParams;
use crate::stats::Given;

/// Parameters of a case that follow from its surface.
#[derive(Clone, Default)]
pub(super) struct Extent {
    pub(super) length_m: Option<f64>,
    pub(super) rms_height_m: Option<f64>,
    pub(super) element_points: Option<f64>,
    pub(super) attraction_range_m: Option<f64>,
}

/// Columns of the parameters of [`Extent`], and the file.
const OWN: [&str; 5] = ["surface_file", "length_m", "rms_height_m", "element_points", "attraction_range_m"];

impl Extent {
    /// Of a scan that was imported.
    pub(super) fn of_scan(
        campaign: &Campaign,
        of: &SurfaceUnit,
        params: &CaseParams,
    ) -> Result<Self, StageError> {
        let row = SurfaceRow::read(campaign, of)?;
        let square = row.square(params)?;
        let lattice = lattice(params, Some(square));
        Ok(Self {
            length_m: Some(square.length_m),
            rms_height_m: Some(row.rms_height_m()?),
            element_points: lattice.map(|lattice| lattice.points as f64),
            attraction_range_m: lattice.and_then(|lattice| lattice.range_m),
        })
    }

    /// Columns of the parameters of a case with this extent.
    pub(super) fn parameters(
        self,
        params: &CaseParams,
        surface_file: Option<String>,
        is_wanted: impl Fn(&str) -> bool,
    ) -> Given {
        let Self { length_m, rms_height_m, element_points, attraction_range_m } = self;
        let facts =
            CaseFacts { params, surface_file, length_m, rms_height_m, element_points, attraction_range_m };
        let wanted = PARAMETERS.iter().filter(|parameter| is_wanted(parameter.column.name));
        let column =
            |name: &str, value: Option<crate::schema::ParameterValue>| (name.to_owned(), value.into());
        wanted.map(|parameter| column(parameter.column.name, (parameter.get)(&facts))).collect()
    }
}

/// The values that all scans have in common; nothing where they differ.
pub(super) fn common(scans: &[Extent]) -> Extent {
    let same = |of: fn(&Extent) -> Option<f64>| {
        let first = scans.first().and_then(of)?;
        scans.iter().all(|scan| of(scan) == Some(first)).then_some(first)
    };
    Extent {
        length_m: same(|scan| scan.length_m),
        rms_height_m: same(|scan| scan.rms_height_m),
        element_points: same(|scan| scan.element_points),
        attraction_range_m: same(|scan| scan.attraction_range_m),
    }
}

/// True if the case of a cycle has a list of scans.
fn has_scans(campaign: &Campaign, unit: &CycleUnit) -> bool {
    campaign.cases[unit.case].case.params.surface.measured().is_some_and(|of| !of.files.is_empty())
}

/// Columns of one of several scans that replace those of its case: its file, size and grid.
pub(super) fn own_columns(campaign: &Campaign, unit: &CycleUnit) -> Result<Given, StageError> {
    if !has_scans(campaign, unit) {
        return Ok(Given::new());
    }
    let (params, surface) = (&campaign.cases[unit.case].case.params, &campaign.surfaces[unit.surface]);
    let extent = Extent::of_scan(campaign, surface, params)?;
    Ok(extent.parameters(params, campaign.label_of(&surface.params), |name| OWN.contains(&name)))
}

/// The file of one of several scans, in place of the list of its case.
pub(super) fn own_file(campaign: &Campaign, unit: &CycleUnit) -> Given {
    let file = campaign.label_of(&campaign.surfaces[unit.surface].params);
    let file = file.filter(|_| has_scans(campaign, unit));
    file.into_iter().map(|file| ("surface_file".to_owned(), file.as_str().into())).collect()
}
