//! Files of measured surfaces and of tabulated spectra: checksums and formats.
//!
//! Tasks are keyed by the content of a file, not by its name. A resolved spec
//! (`campaign.toml`) has the checksums in its table `[files]`, so that the status of a finished run is known
//! without the files. Its relative names start at its own folder; those of other specs start at the working
//! directory or at the folder of the spec.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::ffi::OsString;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::de::DeValue;

use super::cases::Cases;
use super::entries::{entries, shown};
use super::fault::Faults;
use super::written::{Written, wrong_type};
use super::{Axis, Case, Spec, SpecErrors, Value, psd};
use crate::formats::{Found, Refusal, recognize};
use crate::keys::digest_of_file;
use crate::model::{Experiment, SurfaceSource};
use crate::paths::whole;

/// Reads the table `[files]`.
pub(super) fn files(
    written: &Written<'_>,
    span: &Range<usize>,
    faults: &mut Faults<'_>,
) -> BTreeMap<String, (String, Range<usize>)> {
    let mut found = BTreeMap::new();
    let DeValue::Table(table) = written.get_ref() else {
        wrong_type(
            "files",
            "a table",
            written.get_ref(),
            span,
            "write [files] on a line of its own".to_owned(),
            faults,
        );
        return found;
    };
    for (name, span, value) in entries(table) {
        match value.get_ref() {
            DeValue::String(digest)
                if digest.len() == 64 && digest.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f')) =>
            {
                found.insert(name.to_owned(), (digest.to_string(), span));
            }
            _ => {
                let help =
                    "write the 64 hexadecimal digits that `b3sum` prints, or remove the line".to_owned();
                faults.add(
                    &span,
                    "an entry of [files] must be the BLAKE3 checksum of a file".to_owned(),
                    help,
                );
            }
        }
    }
    found
}

/// Refuses the hash of a file that no case names, and gives the others; none after a fault, since of a sweep
/// with a fault the cases are unknown.
pub(super) fn named(
    files: BTreeMap<String, (String, Range<usize>)>,
    cases: &[Case],
    experiment: Option<&Experiment>,
    faults: &mut Faults<'_>,
) -> BTreeMap<String, String> {
    if faults.count() > 0 {
        return BTreeMap::new();
    }
    let loops = experiment.into_iter().flat_map(|of| &of.loops).map(String::as_str);
    let of_cases = cases.iter().flat_map(|case| case.params.surface.files()).map(String::as_str);
    let wanted: HashSet<&str> = of_cases.chain(loops).collect();
    for (name, (_, span)) in files.iter().filter(|(name, _)| !wanted.contains(name.as_str())) {
        let message = format!("[files] has a checksum of \"{}\", which is not used by any case", shown(name));
        faults.add(
            span,
            message,
            "remove the line, or name the file as surface.file, .files or .spectrum exactly as it is written \
             here"
                .to_owned(),
        );
    }
    files.into_iter().map(|(name, (digest, _))| (name, digest)).collect()
}

/// A file that a case names: a scan with its dataset, or else the table of a spectrum.
type Source<'a> = (&'a str, Option<&'a str>);

/// Files of some cases.
fn sources(cases: &[Case]) -> impl Iterator<Item = Source<'_>> {
    cases.iter().flat_map(|case| {
        let surface = &case.params.surface;
        let dataset = surface.measured().map(|scan| scan.dataset.as_str());
        surface.files().iter().map(move |file| (file.as_str(), dataset))
    })
}

/// Place of the name of a file in the text, not in a comment.
fn place(name: &str, text: &str) -> usize {
    let is_in_comment = |at: usize| {
        let line = &text[text[..at].rfind('\n').map_or(0, |end| end + 1)..at];
        line.trim_start().starts_with('#') || line.contains(" #")
    };
    text.match_indices(name).map(|(at, _)| at).find(|at| !is_in_comment(*at)).unwrap_or_default()
}

/// Reports a fault of a file at its name in the text.
fn blame(name: &str, text: &str, message: String, help: String, faults: &mut Faults<'_>) {
    let at = if faults.is_full() { 0 } else { place(name, text) };
    faults.add(&(at..at + name.len().min(text.len() - at)), message, help);
}

/// The spec with the hashes of all files that it names, and of no others. Files that are only in the spec's
/// `folder` are named with it.
pub(super) fn digested(mut spec: Spec, text: &str, file: &str, folder: &Path) -> Result<Spec, SpecErrors> {
    let known = std::mem::take(&mut spec.files);
    let mut faults = Faults::new(text, file);
    let mut seen = HashSet::new();
    let mut moved: BTreeMap<String, String> = BTreeMap::new();
    for (name, dataset) in sources(&spec.cases) {
        if !seen.insert((name, dataset)) {
            continue;
        }
        let checked = match known.get(name) {
            Some(digest) => Ok((of_resolved(name, folder, digest), digest.clone())),
            None => located(name, folder).and_then(|found| {
                let digest = look(&found, folder, dataset, spec.files.get(&found))?;
                Ok((found, digest))
            }),
        };
        match checked {
            Ok((found, digest)) => {
                if Path::new(name).is_absolute() {
                    spec.absolute_files.insert(found.clone());
                }
                if found != name {
                    moved.insert(name.to_owned(), found.clone());
                }
                spec.files.insert(found, digest);
            }
            Err(Refusal { problem, help }) => {
                let kind = if dataset.is_some() { "measured surface" } else { "spectrum" };
                let message = format!("the {kind} \"{name}\" cannot be read: {problem}");
                blame(name, text, message, help, &mut faults);
            }
        }
    }
    tabulate(&mut spec, &moved, text, &mut faults);
    refuse_copies(&spec, &moved, text, &mut faults);
    loops(&mut spec, &known, folder, (text, &mut faults), &mut moved);
    rename(&mut spec, &moved);
    join_copies(&mut spec);
    faults.finish(Some(spec))
}

/// Reads the tables of all spectra that have the contents of their checksums. A file that is missing or has
/// changed is found out by the task that needs it.
fn tabulate(spec: &mut Spec, moved: &BTreeMap<String, String>, text: &str, faults: &mut Faults<'_>) {
    let mut known: HashMap<String, Result<Arc<psd::Read>, Refusal>> = HashMap::new();
    for case in &mut spec.cases {
        let SurfaceSource::Generated(surface) = &mut case.params.surface else { continue };
        if !surface.is_tabulated() {
            continue;
        }
        let name = surface.tabulated.file.clone();
        let path = Path::new(moved.get(&name).unwrap_or(&name));
        let digest = spec.files.get(moved.get(&name).unwrap_or(&name));
        if digest.is_none() || digest_of_file(path).ok().as_ref() != digest {
            continue;
        }
        let of = format!("{:?}", surface.tabulated);
        let is_new = !known.contains_key(&of);
        let read = known.entry(of).or_insert_with(|| psd::read(path, &surface.tabulated).map(Arc::new));
        let covered = read.clone().and_then(|read| {
            let table = surface.with_table(Arc::clone(&read.table), &read.reading);
            psd::uncovered(&table).map_or(Ok(table), Err)
        });
        match covered {
            Ok(covered) => *surface = covered,
            Err(Refusal { problem, help }) if is_new || read.is_ok() => {
                let message = format!("the spectrum \"{name}\" cannot be used: {problem}");
                blame(&name, text, message, help, faults);
            }
            Err(_) => {}
        }
    }
}

/// Checks the files of measured loops and takes their checksums. A loop of a resolved spec may be missing.
fn loops(
    spec: &mut Spec,
    known: &BTreeMap<String, String>,
    folder: &Path,
    (text, faults): (&str, &mut Faults<'_>),
    moved: &mut BTreeMap<String, String>,
) {
    let Some(Experiment { loops, options }) = spec.experiment.clone() else { return };
    for name in &loops {
        let read = |found: &String| {
            let path = Path::new(found);
            match super::experiment::fault(path, &options) {
                Some((problem, help)) => Err(Refusal { problem, help }),
                None => digest_of_file(path).map_err(|error| Refusal {
                    problem: error.to_string(),
                    help: "check the file".to_owned(),
                }),
            }
        };
        let checked = match known.get(name) {
            Some(digest) => Ok((of_resolved(name, folder, digest), digest.clone())),
            None => located(name, folder).and_then(|found| Ok((found.clone(), read(&found)?))),
        };
        match checked {
            Ok((found, digest)) => {
                if Path::new(name).is_absolute() {
                    spec.absolute_files.insert(found.clone());
                }
                if found != *name {
                    moved.insert(name.clone(), found.clone());
                }
                spec.files.insert(found, digest);
            }
            Err(Refusal { problem, help }) => {
                let message = format!("the measured loop \"{name}\" cannot be read: {problem}");
                blame(name, text, message, help, faults);
            }
        }
    }
}

/// Refuses two files of one content among the scans of a case: a copy is no further realization.
fn refuse_copies(spec: &Spec, moved: &BTreeMap<String, String>, text: &str, faults: &mut Faults<'_>) {
    let mut told = HashSet::new();
    for case in &spec.cases {
        let mut known: HashMap<&String, &String> = HashMap::new();
        let names = case.params.surface.measured().map_or(&[][..], |surface| &surface.files);
        for name in names {
            let Some(digest) = spec.files.get(moved.get(name).unwrap_or(name)) else { continue };
            let first = *known.entry(digest).or_insert(name);
            if first != name && told.insert(name) {
                let message = format!("\"{name}\" has the same content as \"{first}\"");
                let help = "remove one of them from `surface.files`: each scan is one realization".to_owned();
                blame(name, text, message, help, faults);
            }
        }
    }
}

/// Joins cases that differ only in the folder of a file with the same name and content.
fn join_copies(spec: &mut Spec) {
    let mut names: HashMap<(String, Option<OsString>), String> = HashMap::new();
    let (mut cases, mut moved) = (Cases::default(), Vec::new());
    for Case { sweeps, mut params } in std::mem::take(&mut spec.cases) {
        for file in files_of(&mut params.surface) {
            let Some(digest) = spec.files.get(file) else { continue };
            let name = Path::new(&file).file_name().map(ToOwned::to_owned);
            let first = names.entry((digest.clone(), name)).or_insert_with(|| file.clone());
            file.clone_from(first);
        }
        moved.push(cases.add(&sweeps, params));
    }
    spec.cases = cases.list;
    let unread = spec.unread.iter_mut().map(|point| &mut point.case);
    for place in spec.auto_cases.iter_mut().chain(unread) {
        *place = moved.get(*place).copied().unwrap_or(*place);
    }
}

/// The names of the files of a surface.
fn files_of(surface: &mut SurfaceSource) -> &mut [String] {
    match surface {
        SurfaceSource::Measured(surface) => surface.names_mut(),
        SurfaceSource::Generated(surface) if surface.is_tabulated() => {
            std::slice::from_mut(&mut surface.tabulated.file)
        }
        SurfaceSource::Generated(_) => &mut [],
    }
}

/// Gives files other names in all places of a spec.
pub(super) fn rename(spec: &mut Spec, moved: &BTreeMap<String, String>) {
    let own = spec.cases.iter_mut().flat_map(|case| files_of(&mut case.params.surface));
    let base = &mut spec.base;
    let own = own.chain([&mut base.measured.file, &mut base.generated.tabulated.file]);
    let own = own.chain(&mut base.measured.files);
    let names_files =
        |axis: &&mut Axis| ["surface.file", "surface.files", "surface.spectrum"].contains(&axis.key);
    let axes = spec.sweeps.iter_mut().flat_map(|sweep| &mut sweep.axes).filter(names_files);
    let swept = axes.flat_map(|axis| &mut axis.values).flat_map(|value| match value {
        Value::Text(name) => std::slice::from_mut(name),
        Value::Texts(names) => names.as_mut_slice(),
        _ => &mut [],
    });
    let loops = spec.experiment.iter_mut().flat_map(|of| &mut of.loops);
    for name in own.chain(swept).chain(loops) {
        if let Some(found) = moved.get(name) {
            name.clone_from(found);
        }
    }
}

/// The name by which a file is found: its own from the working directory, or with the spec's folder before it
/// if it is only there.
fn located(name: &str, folder: &Path) -> Result<String, Refusal> {
    let (here, beside) = (Path::new(name), folder.join(name));
    if here.is_absolute() || folder.as_os_str().is_empty() || !beside.exists() {
        return Ok(name.to_owned());
    }
    if !here.exists() {
        // A folder whose name is not Unicode cannot be written into a spec.
        return Ok(beside.to_str().map_or_else(|| name.to_owned(), str::to_owned));
    }
    if same(here, &beside) {
        return Ok(name.to_owned());
    }
    let problem =
        "two different files have this name, in the working directory and in the folder of the spec"
            .to_owned();
    Err(Refusal {
        problem,
        help: format!("write {}, or the absolute path of the other one", beside.display()),
    })
}

/// True if two paths lead to one file, or to files of one content.
fn same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) if a == b => true,
        _ => matches!((digest_of_file(a), digest_of_file(b)), (Ok(a), Ok(b)) if a == b),
    }
}

/// The name by which a file of a resolved spec is found: from the folder of the spec, or else from the
/// working directory. Of two different files, the one with the checksum `digest` is meant. A file that is in
/// neither place has the name that it would have in the first.
fn of_resolved(name: &str, folder: &Path, digest: &str) -> String {
    let (here, beside) = (Path::new(name), folder.join(name));
    let from_here = here.exists()
        && (!beside.exists()
            || !same(here, &beside) && digest_of_file(here).is_ok_and(|found| found == digest));
    if here.is_absolute() || from_here {
        return name.to_owned();
    }
    tidy(&beside).to_str().map_or_else(|| name.to_owned(), str::to_owned)
}

/// A path without detours, from the working directory if it leads into it.
fn tidy(path: &Path) -> PathBuf {
    let whole = whole(path);
    let here = std::env::current_dir().and_then(|here| here.canonicalize());
    here.ok().and_then(|here| whole.strip_prefix(here).ok().map(Path::to_owned)).unwrap_or(whole)
}

/// The hash of a file in a format that is read, `hashed` if it is known. The format comes first: a file in
/// another one is not read to its end.
fn look(
    name: &str,
    folder: &Path,
    dataset: Option<&str>,
    hashed: Option<&String>,
) -> Result<String, Refusal> {
    let path = Path::new(name);
    let unreadable = |error: std::io::Error| {
        let help = match std::env::current_dir() {
            Ok(here) if path.is_relative() => {
                let beside = if folder.as_os_str().is_empty() {
                    String::new()
                } else {
                    format!(" and in {} (folder of the spec)", folder.display())
                };
                format!("it was looked for in {} (working directory){beside}", here.display())
            }
            _ => "use a file format that `hysteron import` reads".to_owned(),
        };
        Refusal { problem: error.to_string(), help }
    };
    if let Some(dataset) = dataset
        && recognize(path).map_err(unreadable)?? == Found::Hdf5
    {
        inside(path, dataset)?;
    }
    hashed.cloned().map_or_else(|| digest_of_file(path).map_err(unreadable), Ok)
}

/// Checks that the heights of an HDF5 file lie in the file, of which alone the hash is taken.
#[cfg(feature = "store")]
fn inside(path: &Path, dataset: &str) -> Result<(), Refusal> {
    let checked = crate::store::hdf5::check_inside(path, (!dataset.is_empty()).then_some(dataset));
    checked.map_err(|why| {
        let (problem, help) = why.split_once("\nhelp: ").unwrap_or((why.as_str(), ""));
        Refusal { problem: problem.to_owned(), help: help.to_owned() }
    })
}

/// Without the library for HDF5 no such file is read.
#[cfg(not(feature = "store"))]
fn inside(_: &Path, _: &str) -> Result<(), Refusal> {
    Ok(())
}
