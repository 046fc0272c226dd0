//! Realizations that are added until a mean is known well enough.

use crate::bench::{Bench, code, files, stderr, stdout};
use hysteron::schema;
use hysteron::store::parquet::read_table;

fn spec(realizations: &str) -> String {
    format!(
        "name = \"adaptive\"\nseed = 7\nrealizations = {realizations}\n[surface]\nmagnification = 6\n[cycle]\nmax_load = [0.001, 0.002]\n\
         approach_step = 0.05\n[[sweep]]\nname = \"hurst\"\nsurface.hurst = [0.6, 0.8]\n"
    )
}

/// Half the 95 % interval of the mean loss over that, the number of realizations, and of the planned ones, by case and load.
fn known(bench: &Bench) -> Vec<(String, f64, i64, i64)> {
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    let (ids, done, planned) = (cases.text("case_id").unwrap(), cases.i64("done_count").unwrap(), cases.i64("planned_count").unwrap());
    let (mean, high) = (cases.f64("loss_mean").unwrap(), cases.f64("loss_ci95_high").unwrap());
    (0..ids.len()).map(|k| (ids[k].to_owned(), (high[k] - mean[k]) / mean[k], done[k], planned[k])).collect()
}

#[test]
fn e2e_realizations_are_added_until_the_mean_is_known() {
    let wanted = 0.25;
    let until = spec(&format!("{{ until_relative_ci = {wanted}, of = \"loss\", min = 3, max = 40 }}"));
    let bench = Bench::new(&until);
    let first = bench.verb("run", &["--jobs", "1"]);
    assert_eq!(code(&first), 0, "{}", stderr(&first));
    let rows = known(&bench);
    assert_eq!(rows.len(), 4, "two cases at two loads");
    let mut added = 0;
    for (case, share, done, planned) in &rows {
        assert_eq!(done, planned, "{case}");
        assert!(*share <= wanted && (3..40).contains(done), "{case}: {share} after {done}");
        added += done - 3;
    }
    assert!(added > 0, "three were enough of all: the test asks for too little");
    // No more than are needed: what was there before the last ones were added was not enough at one of the loads.
    let written = files(&bench.out());
    let again = bench.verb("run", &[]);
    assert!(stdout(&again).contains("Nothing to do"), "{}", stdout(&again));
    assert!(stdout(&bench.look("status", &[])).contains("Nothing is left to do"));
    assert!(files(&bench.out()) == written);

    // The same bytes with more threads, and from a campaign that was begun with a fixed number.
    let other = Bench::new(&spec("4"));
    assert_eq!(code(&other.verb("run", &["--until", "cycle"])), 0);
    std::fs::write(other.spec(), &until).unwrap();
    assert_eq!(code(&other.verb("run", &["--jobs", "3"])), 0);
    // One more of a case that three were enough for has been made by the other spec, and is in no table.
    let same = |name: &str| files(&other.out()).get(std::path::Path::new(name)) == written.get(std::path::Path::new(name));
    for table in ["realizations", "cases", "curves", "avalanches", "panels"] {
        assert!(same(&format!("statistics/{table}.parquet")), "{table}");
    }
    assert!(same("report.html") && same("campaign.toml"));
}

#[test]
fn e2e_no_more_realizations_than_allowed() {
    let bench = Bench::new(&spec("{ until_relative_ci = 0.001, min = 2, max = 5 }"));
    let ended = bench.verb("run", &[]);
    assert_eq!(code(&ended), 0, "{}", stderr(&ended));
    assert!(known(&bench).iter().all(|(_, share, done, planned)| *share > 0.001 && (*done, *planned) == (5, 5)));
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    assert!(cases.text("caution").unwrap().iter().all(|words| words.split('+').any(|word| word == "imprecise")));
}

/// A finished cycle whose table cannot be read stops no command: it is computed again, and the number of realizations remains.
#[test]
fn e2e_a_damaged_table_of_a_sampled_run_is_repaired() {
    let bench = Bench::new(&spec("{ until_relative_ci = 0.001, min = 2, max = 3 }"));
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let before = files(&bench.out());
    let place = before.keys().find(|path| path.ends_with("steps.parquet")).unwrap();
    Bench::damage(&bench.out().join(place));
    assert_eq!(code(&bench.look("status", &[])), 0, "{}", stderr(&bench.look("status", &[])));
    assert_eq!(code(&bench.look("verify", &["--deep"])), 1);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let after = files(&bench.out());
    assert!(before == after, "other files");
}
