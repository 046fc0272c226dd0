//! Heartbeat of a process that computes in an output folder: a small file in `running/`, rewritten every few
//! seconds and removed at the end.
//!
//! The process holds a lock (`flock`) on its file, which the system releases when the process ends in any
//! way. Where a file system has no such locks or does not share them between machines, the age of the file
//! decides. No process waits for a heartbeat, and nothing is refused because of one.

use super::commit::writing;
use serde::{Deserialize, Serialize};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Folder of the heartbeats below an output folder.
const FOLDER: &str = "running";

/// Age from which on a file without a lock belongs to a process that has ended.
const FRESH: Duration = Duration::from_secs(60);

/// Attempts to read a file that is being rewritten, and to lock one that is being looked at; and the time
/// between two.
const ATTEMPTS: usize = 5;
const BETWEEN: Duration = Duration::from_millis(10);

/// Largest heartbeat that is read \[bytes\].
const MOST_BYTES: u64 = 1 << 20;

/// State of a process.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Heartbeat {
    /// The machine.
    pub host: String,
    /// The process.
    pub process_id: u32,
    /// Start of the process, as in `2026-01-31T12:00:00Z`.
    pub began: String,
    /// Time of this state.
    pub updated: String,
    /// Time between these two \[s\].
    pub elapsed_s: f64,
    /// First and last stage.
    pub stages: [String; 2],
    /// Part of the surfaces: number and count.
    pub shard: [usize; 2],
    /// Stage that is running.
    pub stage: String,
    /// Number of its finished tasks.
    pub done_count: usize,
    /// Number of its tasks.
    pub task_count: usize,
    /// Finished fraction of its work, parts of running tasks included.
    pub fraction: f64,
    /// Estimated time to the end of the stage \[s\].
    pub left_s: Option<f64>,
    /// Tasks that are running.
    pub tasks: Vec<RunningTask>,
}

/// A task that is running.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RunningTask {
    /// The task.
    pub id: String,
    /// Time since its start \[s\].
    pub elapsed_s: f64,
    /// Finished fraction, which follows load and contact area.
    pub fraction: f64,
    /// Estimated time to its end \[s\].
    pub left_s: Option<f64>,
    /// Number of finished steps of a cycle.
    pub step_count: Option<usize>,
    /// Branch of a cycle: "loading" or "unloading".
    pub branch: Option<String>,
    /// Load of a cycle, F/(E* A0).
    pub load: Option<f64>,
    /// Largest load of a cycle.
    pub max_load: Option<f64>,
}

/// The heartbeat of this process. It is removed when this is dropped.
#[derive(Debug)]
pub struct Pulse {
    file: File,
    path: PathBuf,
    length: usize,
}

impl Pulse {
    /// Begins in an output folder; nothing where no file can be written there. `announce` receives the path
    /// before the file is there; an interrupt waits for both.
    #[must_use]
    pub fn begin(dir: &Path, announce: impl FnOnce(&Path)) -> Option<Self> {
        let _writing = writing();
        let folder = dir.join(FOLDER);
        remove_ended(&folder);
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
        let path = folder.join(format!("hysteron-{}-{now:x}.json", std::process::id()));
        announce(&path);
        // Another process may just remove the folder.
        let create = |_| {
            std::fs::create_dir_all(&folder).ok()?;
            OpenOptions::new().write(true).create_new(true).open(&path).ok()
        };
        let file = (0..ATTEMPTS).find_map(create)?;
        for _ in 0..ATTEMPTS {
            match file.try_lock() {
                // A reader looks at it just now.
                Err(TryLockError::WouldBlock) => std::thread::sleep(BETWEEN),
                // Without locks the age decides.
                Ok(()) | Err(TryLockError::Error(_)) => break,
            }
        }
        Some(Self { file, path, length: 0 })
    }

    /// Writes a state. In one piece and in place, since the lock is on the file; a shorter state is filled
    /// with spaces. A full disk ends the run elsewhere.
    pub fn beat(&mut self, state: &Heartbeat) {
        let Ok(mut text) = serde_json::to_string(state) else { return };
        text.extend(std::iter::repeat_n(' ', self.length.saturating_sub(text.len())));
        text.push('\n');
        let _ = self.file.seek(SeekFrom::Start(0)).and_then(|_| self.file.write_all(text.as_bytes()));
        self.length = text.len() - 1;
    }
}

impl Drop for Pulse {
    fn drop(&mut self) {
        remove(&self.path);
    }
}

/// Removes the heartbeat of a process, and the folder with the last one.
pub fn remove(path: &Path) {
    let _ = std::fs::remove_file(path);
    if let Some(folder) = path.parent() {
        let _ = std::fs::remove_dir(folder);
    }
}

/// Processes that compute in an output folder, and processes that have ended without removing their
/// heartbeats.
#[must_use]
pub fn processes(dir: &Path) -> [Vec<Heartbeat>; 2] {
    let mut found = all(&dir.join(FOLDER));
    found.sort_by(|(_, a, _), (_, b, _)| (&a.began, a.process_id).cmp(&(&b.began, b.process_id)));
    let of = |wanted: bool| {
        found.iter().filter(|(_, _, lives)| *lives == wanted).map(|(_, beat, _)| beat.clone()).collect()
    };
    [of(true), of(false)]
}

/// Removes the heartbeats of ended processes, and heartbeats that a power cut left without content.
fn remove_ended(folder: &Path) {
    for path in own(folder) {
        let ended = read(&path).map_or_else(|| lives(&path, None) == Some(false), |(_, lives)| !lives);
        if ended {
            let _ = std::fs::remove_file(path);
        }
    }
}

/// The files of a folder that have the name of a heartbeat.
fn own(folder: &Path) -> Vec<PathBuf> {
    let is_own = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.starts_with("hysteron-")
            && name.ends_with(".json")
            && path.metadata().is_ok_and(|of| of.is_file() && of.len() <= MOST_BYTES)
    };
    std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .filter(is_own)
        .collect()
}

/// The heartbeats of a folder, each with its path and whether its process lives. Other files are not looked
/// at.
fn all(folder: &Path) -> Vec<(PathBuf, Heartbeat, bool)> {
    own(folder).into_iter().filter_map(|path| read(&path).map(|(beat, lives)| (path, beat, lives))).collect()
}

/// A heartbeat, and whether its process lives; nothing for a file that is none.
fn read(path: &Path) -> Option<(Heartbeat, bool)> {
    let parsed = || serde_json::from_slice(&std::fs::read(path).ok()?).ok();
    let again = || {
        std::thread::sleep(BETWEEN);
        parsed()
    };
    let beat: Heartbeat = parsed().or_else(|| (1..ATTEMPTS).find_map(|_| again()))?;
    let lives = lives(path, Some(&beat.host))?;
    Some((beat, lives))
}

/// True if the process of a heartbeat lives, by the lock on its file, or by the age of the file; nothing for
/// a file that cannot be opened.
fn lives(path: &Path, host: Option<&str>) -> Option<bool> {
    let file = File::open(path).ok()?;
    let age = file
        .metadata()
        .and_then(|of| of.modified())
        .ok()
        .and_then(|at| at.elapsed().ok())
        .unwrap_or_default();
    Some(match file.try_lock_shared() {
        Err(TryLockError::WouldBlock) => true,
        Err(TryLockError::Error(_)) => age < FRESH,
        // On this machine, the process has ended. The locks of another one may not be seen here.
        Ok(()) => {
            age < FRESH && host.is_some_and(|host| *host != *gethostname::gethostname().to_string_lossy())
        }
    })
}
