//! Files that a command writes for the user: existing ones are replaced on request only, and none is written
//! into a run.

use super::{Fault, failed};
use crate::campaign::owned::{damage, run_around};
use crate::schema::COMPARISON;
use crate::store::commit;
use crate::text::{shell_path, shown};
use std::path::{Path, PathBuf};

/// Refuses to write over the source, over anything that is not a file, into a run, and over an existing file
/// without `force`.
pub(super) fn may_be_written(what: &str, out: &Path, source: &Path, force: bool) -> Result<(), Fault> {
    let refused =
        |why: &str, help: &str| failed(format!("cannot write {what} to {}: {why}\nhelp: {help}", shown(out)));
    let same = |a: &Path, b: &Path| matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    if same(source, out) {
        return Err(refused("it is the source itself", "use another --out"));
    }
    if let Some(run) = run_around(out) {
        return Err(refused(
            &format!("only `hysteron run` writes there, in {}", shown(&run)),
            "use another --out",
        ));
    }
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.exists()) {
        let help = format!("create the folder (mkdir -p {}), or use another --out", shell_path(folder));
        return Err(refused(&format!("the folder {} does not exist", shown(folder)), &help));
    }
    match std::fs::symlink_metadata(out) {
        Err(_) => Ok(()),
        Ok(_) if std::fs::metadata(out).is_ok_and(|there| !there.is_file()) => {
            Err(refused("it is not a regular file", "use another --out"))
        }
        Ok(_) if force => Ok(()),
        Ok(_) => Err(refused("the file exists", "use another --out, or --force")),
    }
}

/// Refuses to write files over others with other content, unless `force` is set.
pub(super) fn may_replace(what: &str, files: &[(PathBuf, Vec<u8>)], force: bool) -> Result<(), Fault> {
    let differs = |(path, bytes): &&(PathBuf, Vec<u8>)| {
        std::fs::symlink_metadata(path).is_ok()
            && !(path.is_file() && std::fs::read(path).is_ok_and(|present| present == *bytes))
    };
    match files.iter().find(differs).filter(|_| !force) {
        None => Ok(()),
        Some((path, _)) => Err(failed(format!(
            "cannot write {what} to {}: the file exists and has another content\nhelp: move the file, or \
             replace it with --force",
            shown(path)
        ))),
    }
}

/// Writes files.
pub(super) fn written(action: &str, files: &[(PathBuf, Vec<u8>)]) -> Result<(), Fault> {
    files
        .iter()
        .try_for_each(|(path, bytes)| commit::commit_bytes(action, path, bytes).map(drop).map_err(failed))
}

/// Refuses a file of a run or comparison that is not as it was written. `action` is what was tried, as in
/// "export the tables of".
pub(super) fn undamaged(action: &str, dir: &Path, place: &str) -> Result<(), Fault> {
    damage(dir, place).map_or(Ok(()), |why| {
        let (dir, path) = (shown(dir), shell_path(dir));
        let help = if place == COMPARISON.file {
            "help: repeat `hysteron compare` with --force".to_owned()
        } else {
            format!(
                "help: `hysteron verify {path} --deep` lists all faults, `hysteron run {path}` repairs them"
            )
        };
        Err(failed(format!("cannot {action} {dir}: {why}\n{help}")))
    })
}

/// As [`undamaged`], for a surface in the folder of a run.
pub(super) fn undamaged_surface(surface: &Path) -> Result<(), Fault> {
    // As it was named, if that is no link.
    let is_named = surface.parent().and_then(Path::parent).is_some_and(|dir| !dir.as_os_str().is_empty())
        && !surface.is_symlink();
    let whole = if is_named {
        surface.to_owned()
    } else {
        surface.canonicalize().unwrap_or_else(|_| surface.to_owned())
    };
    let folder = whole.parent().filter(|folder| folder.file_name().is_some_and(|name| name == "surfaces"));
    let (Some(dir), Some(name)) = (folder.and_then(Path::parent), whole.file_name()) else { return Ok(()) };
    undamaged("export a surface of", dir, &format!("surfaces/{}", name.to_string_lossy()))
}
