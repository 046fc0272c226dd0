//! `import` of several scans, or of a container with several: their surfaces, limits and common spectrum.

use super::super::outputs::may_be_written;
use super::super::{FAILED_CASES, Fault, failed, make_folder, say};
use super::inputs::{Input, Left, inputs};
use super::range::Range;
use super::several_text::{Shown, answer, text};
use super::taken::Taken;
use super::{ImportArguments, check_options};
use crate::keys::digest_of_file;
use crate::lengths::SAME_SIZE;
use crate::model::MeasuredSurface;
use crate::stages::{Examined, Imported, Sample, SampleScan, StageError, measure, scans_table};
use crate::store::commit::commit_bytes;
use crate::store::hdf5::write_surface;
use crate::store::parquet::write_table;
use crate::text::shown;
use std::path::{Path, PathBuf};

/// Imports all scans that can be read, and names the others.
pub(super) fn import(asked: &ImportArguments) -> Result<u8, Fault> {
    check_options(asked, &asked.files[0])?;
    // It is removed in the end.
    let work = tempfile::tempdir().map_err(failed)?;
    let folder = asked.out.clone().unwrap_or_else(|| named_after(&asked.files[0]));
    let (found, mut left, notes) = inputs(asked, &work)?;
    let mut taken = Vec::new();
    let (mut digests, mut differing) = (Vec::<(String, String)>::new(), Vec::new());
    for input in &found {
        match read(input, &mut digests) {
            Ok(Some((imported, examined))) => {
                let out = unused(&folder, input, &taken);
                differing.extend(difference(input, &imported));
                taken.push(Taken { label: input.label.clone(), imported, examined, out });
            }
            Ok(None) => {}
            Err(why) => left.push(why),
        }
    }
    if taken.is_empty() {
        return Err(nothing(&asked.files, &left));
    }
    let name = sample_name(&asked.files[0]);
    let sample = Sample::of(&name, taken.iter().enumerate().map(scan).collect());
    let written = if asked.dry_run { None } else { Some(write(asked, &folder, &taken, &sample)?) };
    let ranges: Vec<Range<'_>> = taken.iter().map(|of| Range::of(&of.examined)).collect();
    let result = Shown {
        name: &name,
        taken: &taken,
        ranges: &ranges,
        left: &left,
        notes: &notes,
        differing: &differing,
        sample: &sample,
        written: written.as_deref(),
    };
    if asked.json {
        say(&format!("{:#}\n", answer(&result)))?;
    } else {
        say(&text(&result))?;
    }
    Ok(if left.iter().any(|of| of.is_failure) { FAILED_CASES } else { 0 })
}

/// One scan with its asperities. A copy of another one is left out.
fn read(input: &Input, digests: &mut Vec<(String, String)>) -> Result<Option<(Imported, Examined)>, Left> {
    let failed = |why: String| Left { label: input.label.clone(), why, is_failure: true };
    let digest = digest_of_file(&input.path).map_err(|error| failed(error.to_string()))?;
    // Datasets of one file are different scans.
    let content = format!("{digest} {}", input.params.dataset);
    if let Some((_, first)) = digests.iter().find(|(known, _)| *known == content) {
        let why = format!("same content as {first}: left out");
        return Err(Left { label: input.label.clone(), why, is_failure: false });
    }
    let named = |error: StageError| failed(reason(&error, &input.path, &input.label));
    let imported = measured(input, &digest).map_err(named)?;
    let examined =
        Examined::of_measured(&imported.header, imported.prepared.heights_m.view()).map_err(named)?;
    digests.push((content, input.label.clone()));
    Ok(Some((imported, examined)))
}

/// Reads a scan. Size and unit of the metadata of a container are used where the file does not state them.
fn measured(input: &Input, digest: &str) -> Result<Imported, StageError> {
    let first = measure(&input.params, digest, "");
    match &input.stated {
        Some(stated) if first.is_err() => {
            let params = MeasuredSurface { ..stated.clone() };
            measure(&params, digest, "").or(first)
        }
        _ => first,
    }
}

/// A size in the metadata of a container that differs from that of the file, as a warning.
fn difference(input: &Input, imported: &Imported) -> Option<String> {
    let MeasuredSurface { size_m, size_y_m, transpose, .. } = input.stated.as_ref()?;
    let of = imported.header.measured.as_ref().filter(|_| imported.height_factor_m.is_some())?;
    let along = |k: usize| of.source_point_counts[k] as f64 * of.source_spacings_m[k];
    let [x, y] = if *transpose { [along(1), along(0)] } else { [along(0), along(1)] };
    let differs = |stated: f64, own: f64| stated > 0.0 && (stated / own - 1.0).abs() > SAME_SIZE;
    (differs(*size_m, x) || differs(*size_y_m, y)).then(|| {
        format!(
            "{}: a size of {size_m:.4e} m x {size_y_m:.4e} m in index.json, of {x:.4e} m x {y:.4e} m in the \
             file: that of the file is used. Check size and unit, and give --size if the file is wrong",
            input.label
        )
    })
}

/// The reason of an error without the path of a file that was unpacked.
fn reason(error: &StageError, path: &Path, label: &str) -> String {
    let why = if let StageError::Measured { why, .. } = error { why.clone() } else { error.to_string() };
    why.replace(&shown(path), label)
}

/// The error of files of which none was read.
fn nothing(files: &[PathBuf], left: &[Left]) -> Fault {
    let names: Vec<String> = files.iter().map(|file| shown(file)).collect();
    let parts = || left.iter().map(|of| of.why.split_once("\nhelp: ").unwrap_or((&of.why, "")));
    let reason = |(of, (why, _)): (&Left, (&str, &str))| format!("\n  {}: {why}", of.label);
    let reasons: String = left.iter().zip(parts()).map(reason).collect();
    let help = parts().map(|(_, help)| help).find(|help| !help.is_empty());
    failed(format!(
        "cannot import {}: no scan was read{reasons}\nhelp: {}",
        names.join(", "),
        help.unwrap_or("import one of the files alone for its options")
    ))
}

fn scan((place, taken): (usize, &Taken)) -> SampleScan {
    let Taken { imported, examined, .. } = taken;
    SampleScan {
        realization: place,
        surface_id: taken.out.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        file: taken.label.clone(),
        header: imported.header.clone(),
        spectrum: imported.spectrum(),
        flattening_m: examined.estimates.flattening.energies(1.0).whole_j_m2,
    }
}

/// `<name of the first file>_scans` in the present folder.
fn named_after(file: &Path) -> PathBuf {
    let mut name = file.file_stem().unwrap_or(file.as_os_str()).to_owned();
    name.push("_scans");
    PathBuf::from(name)
}

/// Name of a sample in a spec.
fn sample_name(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let plain: String = stem.chars().filter(char::is_ascii_alphanumeric).take(32).collect();
    format!("of_{plain}")
}

/// The file of a surface in the folder, with a number where two scans have one name.
fn unused(folder: &Path, input: &Input, taken: &[Taken]) -> PathBuf {
    let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '-' | '.') { c } else { '_' };
    let stem: String = input.stem.chars().map(plain).take(60).collect();
    let named = |end: &str| folder.join(format!("{stem}{end}.h5"));
    let is_free = |path: &PathBuf| taken.iter().all(|of| of.out != *path);
    let numbered = (2..).map(|number| named(&format!("_{number}")));
    std::iter::once(named("")).chain(numbered).find(is_free).unwrap_or_else(|| named(""))
}

/// Writes surfaces, their table and the common spectrum; gives the paths of the last two.
fn write(
    asked: &ImportArguments,
    folder: &Path,
    taken: &[Taken],
    sample: &Sample,
) -> Result<Vec<PathBuf>, Fault> {
    let others = [folder.join("scans.parquet"), folder.join("psd.csv")];
    if !folder.exists() {
        may_be_written("the surfaces", folder, &asked.files[0], asked.force)?;
    } else if !folder.is_dir() {
        return Err(failed(format!(
            "cannot write the surfaces to {}: it is a file\nhelp: give the name of a folder as --out",
            shown(folder)
        )));
    }
    make_folder(folder)?;
    for path in taken.iter().map(|of| &of.out).chain(&others) {
        for source in &asked.files {
            may_be_written("the surfaces", path, source, asked.force)?;
        }
    }
    for of in taken {
        write_surface(&of.out, &of.imported.header, of.imported.prepared.heights_m.view()).map_err(failed)?;
    }
    let table = scans_table(std::slice::from_ref(sample)).map_err(failed)?;
    write_table(&others[0], &table, &[("sample", sample.case_id.clone())]).map_err(failed)?;
    commit_bytes("write the common spectrum to", &others[1], sample.csv().as_bytes()).map_err(failed)?;
    Ok(others.to_vec())
}
