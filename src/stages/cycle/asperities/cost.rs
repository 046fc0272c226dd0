//! Memory and time of a cycle of the asperity model, estimated before it begins.

use super::super::super::cost::Cost;
use super::super::super::previews::Known;
use crate::model::{AsperityOptions, Coalescence, SurfaceSource};
use crate::spec::CaseParams;

/// Time of one cycle of the asperity model with merging at ζ = 64 and `F_max/(E* A0)` = 0.0071 \[s\], and its
/// exponent in ζ.
pub(in super::super) const OF_ASPERITIES: [f64; 2] = [1.4, 2.7];
/// Number of contact spots of such a cycle, and its exponent in ζ.
const CONTACTS: [f64; 2] = [335.0, 1.63];
/// Memory of a contact spot, of a grid point of a surface, and of the program \[bytes\].
const BYTES: [f64; 3] = [75e3, 11.2, 8e7];

/// Memory and time of a cycle on a generated surface, or on a measured one that is known.
pub(in super::super) fn cost(
    params: &CaseParams,
    options: &AsperityOptions,
    known: Option<&Known>,
) -> Option<Cost> {
    let (points, wavelengths) = match &params.surface {
        SurfaceSource::Generated(surface) => (surface.grid() as f64, f64::from(surface.magnification)),
        SurfaceSource::Measured(_) => {
            let header = &known?.header;
            let measured = header.measured.as_ref()?;
            let spacing_m = measured.source_spacings_m[0].min(measured.source_spacings_m[1]);
            ((header.length_m / spacing_m).round(), header.length_m / measured.shortest_wavelength_m)
        }
    };
    let load = params.cycle.largest_load() / 0.0071;
    let of_zeta = |[factor, exponent]: [f64; 2]| factor * (wavelengths / 64.0).powf(exponent) * load;
    let faster = if options.coalescence == Coalescence::Merge { 1.0 } else { 2.0 };
    let [spot, point, program] = BYTES;
    Some(Cost {
        points: points as u64,
        per_wavelength: points / wavelengths,
        is_mirrored: false,
        memory_bytes: program + point * points * points + spot * of_zeta(CONTACTS),
        seconds: of_zeta(OF_ASPERITIES) / faster,
    })
}
