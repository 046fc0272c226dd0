//! Checks of measured surfaces: their files, their treatment and the number of their realizations.

use std::ops::Range;

use super::fault::Faults;
use super::keys::{GENERATED, NAMES, find};
use super::origin::{Origin, written};
use super::shape::blamed;
use super::{Case, Realizations};
use crate::model::{Boundary, CaseParams, Choice as _, Detrend, MeasuredSurface};

/// Checks the requirements of a measured surface on the other values of its case.
pub(super) fn check_measured(
    case: &CaseParams,
    surface: &MeasuredSurface,
    (origins, swept): (&[Origin], &[usize]),
    faults: &mut Faults<'_>,
) {
    let of_sweep = |name: &str| find("surface", name).is_some_and(|key| swept.contains(&key));
    let key = if surface.files.is_empty() { "file" } else { "files" };
    if !surface.file.is_empty()
        && !surface.files.is_empty()
        && let Some(span) = blamed(&NAMES, origins)
    {
        let message = "`surface.file` and `surface.files` both name the scans".to_owned();
        let help = "remove one of them: `files` has several scans of one sample, `file` has one".to_owned();
        faults.add(&span, message, help);
    }
    for name in GENERATED {
        // If one of the two is in the base and the other in a sweep, the spec has both kinds of surface.
        if of_sweep(name) == of_sweep(key)
            && let Some(span) = written(find("surface", name), origins)
        {
            let message = format!(
                "`surface.{name}` describes a generated surface, and `surface.{key}` names a measured one"
            );
            faults.add(&span, message, "remove one of the two keys".to_owned());
        }
    }
    if surface.periodic
        && surface.detrend != Detrend::Mean
        && let Some(span) = written(find("surface", "detrend"), origins)
    {
        let word = surface.detrend.word();
        let message = format!(
            "`surface.detrend` is \"{word}\", and `surface.periodic` is true: the removed shape is not \
             periodic"
        );
        let help =
            "write detrend = \"mean\" (the default of a periodic surface), or periodic = false".to_owned();
        faults.add(&span, message, help);
    }
    if !surface.periodic && case.asperities().is_some_and(|options| options.boundary == Boundary::Periodic) {
        let boundary = written(find("model", "boundary"), origins);
        let of_surface = |name: &str| written(find("surface", name), origins);
        if let Some(span) = boundary.or_else(|| of_surface("periodic")).or_else(|| of_surface(key)) {
            let message = "a non-periodic measured surface requires model.boundary = \"isolated\"".to_owned();
            let help = "write model.boundary = \"isolated\", or surface.periodic = true for a periodic scan"
                .to_owned();
            faults.add(&span, message, help);
        }
    }
}

/// Number of realizations of a spec. Where all surfaces are measured and one has several scans, it is the
/// largest number of scans; another one in the text is refused.
pub(super) fn realizations(
    cases: &[Case],
    stated: Realizations,
    at: Option<&Range<usize>>,
    faults: &mut Faults<'_>,
) -> Realizations {
    let counts: Option<Vec<u32>> = cases.iter().map(|case| case.params.surface.scan_count()).collect();
    let most = counts.and_then(|counts| counts.into_iter().max()).filter(|count| *count > 1);
    let Some(count) = most else { return stated };
    if let Some(at) = at.filter(|_| stated != Realizations::Exactly(count)) {
        let message =
            format!("`realizations` differs from the number of scans: `surface.files` names {count} files");
        faults.add(at, message, "remove `realizations`: each scan is one realization".to_owned());
    }
    Realizations::Exactly(count)
}
