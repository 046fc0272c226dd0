//! The one way in which a file comes into being.

use std::fs;
use std::path::Path;

use hysteron::schema::EVENTS;
use hysteron::store::commit::{TEMPORARY_PREFIX, TEMPORARY_SUFFIX, commit, commit_bytes, is_temporary};
use hysteron::store::parquet::write_table;
use tempfile::tempdir;

use super::{names, sample, says};

#[test]
fn e2e_bytes_are_put_in_place_of_what_was_there() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("campaign.toml");
    for bytes in [&b"one"[..], b"another", b""] {
        commit_bytes("write the spec to", &path, bytes).unwrap();
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
    assert_eq!(names(directory.path()), ["campaign.toml"]);
}

#[test]
fn e2e_a_failure_at_any_point_leaves_what_was_there_and_nothing_else() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.txt");
    fs::write(&path, "before").unwrap();
    let half = |temporary: &Path| Ok(fs::write(temporary, "half")?);
    let ends = [
        commit("write", &path, |_| Err("the writer gave up".into()), |_| Ok(())),
        commit("write", &path, half, |_| Err("the check failed".into())),
        commit("write", &path, |temporary| Ok(fs::remove_file(temporary)?), |_| Ok(())),
    ];
    for (end, part) in ends.into_iter().zip(["the writer gave up", "the check failed", "No such file"]) {
        says(&end.unwrap_err().to_string(), &path, &["cannot write", part]);
    }
    assert_eq!(fs::read_to_string(&path).unwrap(), "before");
    assert_eq!(names(directory.path()), ["a.txt"]);
}

#[test]
fn e2e_a_panic_of_the_writer_leaves_no_temporary_file() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.txt");
    let inside = std::panic::AssertUnwindSafe(|| commit("write", &path, |_| panic!("on purpose"), |_| Ok(())));
    assert!(std::panic::catch_unwind(inside).is_err());
    assert!(names(directory.path()).is_empty());
}

#[test]
fn law_temporary_files_are_known_by_their_names() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("events.parquet");
    let see = |temporary: &Path| {
        assert!(is_temporary(temporary));
        assert_eq!(temporary.parent(), Some(directory.path()));
        Ok(fs::write(temporary, "x")?)
    };
    commit("write", &path, see, |temporary| {
        assert!(is_temporary(temporary));
        Ok(())
    })
    .unwrap();
    assert!(is_temporary(Path::new(&format!("a/{TEMPORARY_PREFIX}1{TEMPORARY_SUFFIX}"))));
    assert!(!is_temporary(&path) && !is_temporary(Path::new("/")));
}

#[test]
#[cfg(unix)]
fn e2e_a_committed_file_is_an_ordinary_file() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempdir().unwrap();
    let (plain, committed) = (directory.path().join("plain"), directory.path().join("committed"));
    fs::write(&plain, "x").unwrap();
    commit_bytes("write", &committed, b"x").unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&plain), mode(&committed));
}

#[test]
fn e2e_impossible_places_are_named() {
    let directory = tempdir().unwrap();
    let frame = sample(&EVENTS, 3);
    let file = directory.path().join("file");
    fs::write(&file, "x").unwrap();
    let folder = directory.path().join("folder.parquet");
    fs::create_dir(&folder).unwrap();
    for (path, part) in [
        (directory.path().join("absent/events.parquet"), "absent does not exist"),
        (file.join("events.parquet"), "file is not a directory"),
        (folder, "a directory of this name exists"),
        (Path::new("/").to_owned(), "not a path of a file"),
    ] {
        let message = write_table(&path, &frame, &[]).unwrap_err().to_string();
        says(&message, &path, &["cannot write the table events to", part]);
    }
    assert_eq!(names(directory.path()), ["file", "folder.parquet"]);
}

/// `/proc` takes files from nobody, root included, to whom permissions mean nothing.
#[test]
#[cfg(target_os = "linux")]
fn e2e_a_directory_that_takes_no_files_is_named() {
    let path = Path::new("/proc/events.parquet");
    let message = write_table(path, &sample(&EVENTS, 3), &[]).unwrap_err().to_string();
    says(&message, path, &["cannot write the table events to"]);
}
