//! `export psd`: the common spectrum of a run as the table of `surface.spectrum` of another spec.

use super::outputs::{may_be_written, undamaged};
use super::place::folder_of;
use super::{Fault, failed, say};
use crate::cli::PsdArguments;
use crate::schema::SPECTRUM;
use crate::stages::psd_csv;
use crate::store::commit::commit_bytes;
use crate::store::parquet::read_table;
use crate::text::shown;
use std::f64::consts::TAU;

pub(super) fn export(asked: &PsdArguments) -> Result<u8, Fault> {
    let dir = folder_of(&asked.dir)?;
    let path = dir.join(SPECTRUM.file);
    if !path.is_file() {
        return Err(failed(format!(
            "cannot export a common spectrum of {}: it has no {}\nhelp: a run of a spec with surface.files \
             has one; `hysteron import FILE …` writes psd.csv without a run",
            shown(&dir),
            SPECTRUM.file
        )));
    }
    undamaged("export the common spectrum of", &dir, SPECTRUM.file)?;
    may_be_written("the spectrum", &asked.out, &path, asked.force)?;
    let frame = read_table(&path, &SPECTRUM).map_err(failed)?;
    let ids = frame.text("case_id").map_err(failed)?;
    let mut cases = ids.clone();
    cases.dedup();
    let case = match (&asked.case, &cases[..]) {
        (Some(case), _) if cases.contains(&case.as_str()) => case.as_str(),
        (None, [only]) => only,
        (case, _) => {
            let problem = case.as_ref().map_or_else(
                || format!("{} cases have one", cases.len()),
                |case| format!("the case {case:?} has none"),
            );
            return Err(failed(format!(
                "cannot export a common spectrum of {}: {problem}\nhelp: give one as --case: {}",
                shown(&dir),
                cases.join(", ")
            )));
        }
    };
    let column = |name: &str| frame.f64(name).map_err(failed);
    let (wavenumbers, densities) = (column("wavenumber_1_m")?, column("density_m4")?);
    let rows = (0..ids.len()).filter(|row| ids[*row] == case).map(|row| [wavenumbers[row], densities[row]]);
    commit_bytes("write the spectrum to", &asked.out, psd_csv(rows).as_bytes()).map_err(failed)?;
    let name = crate::spec::quoted(&asked.out.to_string_lossy());
    let band = [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| {
        (0..ids.len()).filter(|row| ids[*row] == case).map(|row| wavenumbers[row]).reduce(pick)
    });
    say(&format!("Written: {}\n\n{}", asked.out.display(), surface_spec(&name, band)))?;
    Ok(0)
}

/// Largest magnification of a printed spec.
const MOST_MAGNIFIED: f64 = 64.0;

/// Table `[surface]` of a spec with a spectrum of this quoted name between two wavenumbers \[1/m\]: the side
/// and the magnification stay within it.
pub(super) fn surface_spec(name: &str, band_1_m: [Option<f64>; 2]) -> String {
    let mut text = format!("[surface]\nspectrum = {name}\nspectrum_convention = \"plain\"\n");
    if let [Some(low), Some(high)] = band_1_m {
        // Below the longest wavelength by more than the rounding of the printed side.
        let length_m = 0.999 * TAU / low;
        let magnification = (length_m * high / TAU).floor().min(MOST_MAGNIFIED);
        if magnification >= 2.0 {
            text += &format!("length_m = {length_m:.4e}\nmagnification = {magnification}\n");
        }
    }
    text
}
