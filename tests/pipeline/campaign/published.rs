//! Damaged files: no command publishes them.

use super::SMALL;
use crate::bench::{Bench, code, files, stderr};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn program(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron")).args(arguments).output().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Turns a bit at several places of a file and calls a check after each, then restores the file.
fn flipped(path: &Path, check: &dyn Fn(usize)) {
    let whole = fs::read(path).unwrap();
    for part in [3, 5, 6, 8] {
        let at = whole.len() * part / 9;
        let mut bytes = whole.clone();
        bytes[at] ^= 64;
        fs::write(path, &bytes).unwrap();
        check(at);
    }
    fs::write(path, whole).unwrap();
}

#[test]
fn e2e_no_flipped_bit_is_exported() {
    let bench = Bench::new(&format!("{SMALL}[figures]\nformat = [\"svg\"]\n"));
    assert_eq!(code(&bench.verb("run", &["-q"])), 0);
    let other = bench.folder.path().join("other");
    let run = Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .arg("run")
        .arg(bench.spec())
        .args(["--set", "surface.hurst=0.7", "-q", "--out", text(&other)])
        .output()
        .unwrap();
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let out = bench.out();
    let file = |end: &str| out.join(files(&out).into_keys().find(|path| path.ends_with(end) || text(path).ends_with(end)).unwrap());
    let (surface, cases, realizations, steps) =
        (file(".h5"), out.join("statistics/cases.parquet"), out.join("statistics/realizations.parquet"), file("steps.parquet"));
    let name = |path: &Path| path.strip_prefix(&out).unwrap().display().to_string();
    let [film, tables, compared] = ["film", "tables", "compared"].map(|name| bench.folder.path().join(name));
    let (dir, other) = (text(&out), text(&other));
    let commands: Vec<(&Path, Vec<&str>)> = vec![
        (&surface, vec!["export", "netcdf", text(&surface), "--out", text(&film)]),
        (&surface, vec!["export", "tamaas", text(&surface), "--out", text(&film)]),
        (&surface, vec!["export", "ro-crate", dir]),
        (&cases, vec!["export", "csv", dir, "--out", text(&tables)]),
        (&steps, vec!["export", "csv", "--cycles", dir, "--out", text(&tables)]),
        (&realizations, vec!["compare", dir, other, "--out", text(&compared)]),
        (&cases, vec!["compare", other, dir, "--out", text(&compared)]),
        (&realizations, vec!["findings", dir]),
        (&cases, vec!["report", dir]),
    ];
    for (path, command) in &commands {
        flipped(path, &|at| {
            let refused = program(command);
            assert_eq!(code(&refused), 1, "{command:?}, byte {at}");
            let said = stderr(&refused);
            assert!(said.contains(&name(path)), "{command:?}, byte {at}: {said}");
            assert!(said.contains("\nhelp: ") && said.contains("hysteron verify"), "{command:?}: {said}");
        });
    }
    for path in [film, tables, compared, out.join("ro-crate-metadata.json")] {
        assert!(!path.exists(), "{}", path.display());
    }
    let show = |id: &str| program(&["show", dir, id]);
    let id = hysteron::store::parquet::read_table(&cases, &hysteron::schema::CASES).unwrap().text("case_id").unwrap()[0].to_owned();
    assert_eq!(code(&show(&id)), 0);
    flipped(&cases, &|at| assert!(code(&show(&id)) == 1 && stderr(&show(&id)).contains("statistics/cases.parquet"), "byte {at}"));
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
}

/// Without the receipts of its run a surface is compared with its own checksum.
#[test]
fn e2e_a_copied_surface_knows_its_heights() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["-q", "--until", "generate"])), 0);
    let surface = files(&bench.out()).into_iter().find(|(path, _)| path.extension().is_some_and(|end| end == "h5")).unwrap().1;
    let copy: PathBuf = bench.folder.path().join("copy.h5");
    let film = bench.folder.path().join("film.nc");
    fs::write(&copy, &surface).unwrap();
    let refusals = |command: &[&str]| {
        let refused = std::cell::Cell::new(0);
        flipped(&copy, &|_| {
            let output = program(command);
            refused.set(refused.get() + i32::from(code(&output) == 1 && stderr(&output).contains("differs from its checksum")));
        });
        refused.get()
    };
    // Heights take up four fifths of the file: at least three of the four places are among them.
    assert!(refusals(&["export", "netcdf", text(&copy), "--out", text(&film)]) >= 3);
    assert!(refusals(&["import", text(&copy), "-n"]) >= 3);
    assert!(!film.exists());
}
