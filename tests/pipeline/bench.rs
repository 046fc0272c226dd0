//! The program itself in a folder of its own, for the tests that run it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use tempfile::TempDir;

/// Two magnifications, two realizations, two loads: a second of work.
pub const SPEC: &str = r#"
name = "tiny"
seed = 7
realizations = 2
[cycle]
max_load = [0.001, 0.002]
approach_step = 0.05
[[sweep]]
name = "zeta"
surface.magnification = [6, 8]
"#;

/// A folder with a spec in it.
pub struct Bench {
    pub folder: TempDir,
}

impl Bench {
    pub fn new(spec: &str) -> Self {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("spec.toml"), spec).unwrap();
        Self { folder }
    }

    pub fn out(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    pub fn spec(&self) -> PathBuf {
        self.folder.path().join("spec.toml")
    }

    /// A verb on the spec.
    pub fn command(&self, verb: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
        command.arg(verb).arg(self.spec()).arg("--out").arg(self.out());
        command
    }

    /// Runs a verb on the spec, with more arguments.
    pub fn verb(&self, verb: &str, more: &[&str]) -> Output {
        output(self.command(verb).args(more))
    }

    /// Runs a verb on the output folder, with more arguments.
    pub fn look(&self, verb: &str, more: &[&str]) -> Output {
        output(Command::new(env!("CARGO_BIN_EXE_hysteron")).arg(verb).arg(self.out()).args(more))
    }

    /// Changes the end of a Parquet file, so that it cannot be read and has its length.
    pub fn damage(path: &Path) {
        let mut bytes = fs::read(path).unwrap();
        let end = bytes.len() - 4;
        bytes[end..].fill(0);
        fs::write(path, bytes).unwrap();
    }

    /// Receipts by path, with their bytes.
    pub fn receipts(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let folder = self.out().join("receipts");
        let all = if folder.exists() { paths(&folder) } else { Vec::new() };
        all.into_iter()
            .filter(|path| path.extension().is_some_and(|e| e == "json"))
            .map(|path| (path.clone(), fs::read(&path).unwrap()))
            .collect()
    }
}

/// Runs a command. After ten minutes it is killed, so that a program that hangs fails its test by name, and not the gate without one.
fn output(command: &mut Command) -> Output {
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let id = child.id().to_string();
    let (running, ended) = channel::<()>();
    let watch = std::thread::spawn(move || {
        if ended.recv_timeout(Duration::from_secs(600)) == Err(RecvTimeoutError::Timeout) {
            Command::new("kill").args(["-KILL", &id]).status().unwrap();
        }
    });
    let output = child.wait_with_output().unwrap();
    drop(running);
    watch.join().unwrap();
    output
}

/// Reports a test that is skipped because a tool is missing; fails if `HYSTERON_REQUIRE`, names with commas between them, holds the tool.
pub fn skip(tool: &str, why: &str) {
    let required = std::env::var("HYSTERON_REQUIRE").unwrap_or_default();
    assert!(!required.split(',').any(|name| name == tool), "{tool} is required: {why}");
    eprintln!("skipped: {tool}: {why}");
}

pub fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// All files below a folder.
pub fn paths(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        // A folder may vanish while a run is looked at.
        for entry in fs::read_dir(next).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.push(path);
            }
        }
    }
    found
}

/// The same by path, with their bytes; but for receipts, which tell when and by whom.
pub fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let all = paths(folder).into_iter().map(|path| (path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap()));
    all.filter(|(path, _)| !path.starts_with("receipts")).collect()
}
