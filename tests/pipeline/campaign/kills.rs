//! Processes that are killed, and several at once.

use super::SMALL;
use crate::bench::{Bench, SPEC, code, files, stderr, stdout};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// How many runs are killed: `HYSTERON_KILLS` asks for more.
fn kills() -> u32 {
    std::env::var("HYSTERON_KILLS").ok().and_then(|count| count.parse().ok()).unwrap_or(12)
}

/// Files without those that a killed run left unfinished.
fn finished(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    files(folder).into_iter().filter(|(path, _)| !hysteron::store::commit::is_temporary(path)).collect()
}

#[test]
fn e2e_killed_at_any_time_a_run_goes_on_and_repeats_nothing() {
    let undisturbed = Bench::new(SPEC);
    let began = Instant::now();
    assert_eq!(code(&undisturbed.verb("run", &["--jobs", "2"])), 0);
    let whole = files(&undisturbed.out());
    let long = began.elapsed();
    let mut hit: BTreeMap<usize, u32> = BTreeMap::new();
    for number in 0..kills() {
        let bench = Bench::new(SPEC);
        let mut child = bench.command("run").args(["--jobs", "2"]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        // The golden ratio spreads the times evenly, however many there are.
        let share = (0.618_033_988_75 * f64::from(number + 1)).fract();
        std::thread::sleep(Duration::from_secs_f64(share * long.as_secs_f64()));
        child.kill().unwrap();
        child.wait().unwrap();
        let receipts = bench.receipts();
        *hit.entry(receipts.len()).or_default() += 1;
        let again = bench.verb("run", &["--jobs", "2"]);
        assert_eq!(code(&again), 0, "{}", stderr(&again));
        assert!(finished(&bench.out()) == whole, "killed after {share} of the time: other bytes");
        let after = bench.receipts();
        for (path, bytes) in &receipts {
            assert!(after[path] == *bytes, "{} was there, and its unit was done again", path.display());
        }
        assert_eq!(code(&bench.look("gc", &["--delete"])), 0);
        assert!(files(&bench.out()) == whole, "what the killed run left is gone");
    }
    eprintln!("killed runs by the receipts that they had: {hit:?}");
    assert!(hit.len() > 2, "the times hit several stages: {hit:?}");
}

#[test]
fn e2e_two_runs_at_once_are_harmless() {
    let alone = Bench::new(SPEC);
    assert_eq!(code(&alone.verb("run", &[])), 0);
    let bench = Bench::new(SPEC);
    let children: Vec<_> = (0..3).map(|_| bench.command("run").stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()).collect();
    for child in children {
        let ended = child.wait_with_output().unwrap();
        assert_eq!(code(&ended), 0, "{}", stderr(&ended));
    }
    assert!(files(&bench.out()) == files(&alone.out()));
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
    assert!(stdout(&bench.verb("run", &[])).contains("Nothing to do"));
}

#[test]
fn e2e_shards_and_jobs_change_no_byte() {
    let whole = Bench::new(SPEC);
    assert_eq!(code(&whole.verb("run", &["--jobs", "1"])), 0);
    let seven = Bench::new(SPEC);
    assert_eq!(code(&seven.verb("run", &["--jobs", "7"])), 0);
    assert!(files(&seven.out()) == files(&whole.out()));
    let parts = Bench::new(SPEC);
    // In another order than a whole run has them, and one of them twice.
    for shard in ["2/3", "0/3", "1/3", "0/3"] {
        let run = parts.verb("run", &["--until", "cycle", "--shard", shard]);
        assert_eq!(code(&run), 0, "{}", stderr(&run));
    }
    let run = parts.verb("run", &["--quick"]);
    assert!(stdout(&run).contains("cycle     0 of 4 computed, 4 done before"), "{}", stdout(&run));
    assert!(files(&parts.out()) == files(&whole.out()));
}

#[test]
fn e2e_a_shard_is_a_part_and_says_what_it_cannot_be() {
    let bench = Bench::new(SMALL);
    let report = bench.verb("run", &["--shard", "0/2"]);
    assert_eq!(code(&report), 2);
    assert!(stderr(&report).contains("--until cycle"), "{}", stderr(&report));
    for wrong in ["2/2", "0/0", "1", "a/b", "-1/2", "0/1000001", "0/18446744073709551615"] {
        let refused = bench.verb("cycle", &[&format!("--shard={wrong}")]);
        assert_eq!(code(&refused), 2, "{wrong}");
        assert!(stderr(&refused).contains("expected K/N, two integers with 0 <= K < N"), "{wrong}: {}", stderr(&refused));
    }
}
