//! What looks after files: receipts, `verify`, `explain`, `gc`, `retry`, `status`.

use super::SMALL;
use crate::bench::{Bench, SPEC, code, files, stderr, stdout};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn e2e_every_file_with_one_bit_flipped_is_named_and_made_again() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let whole = files(&bench.out());
    let all = crate::bench::paths(&bench.out());
    assert!(all.len() > 25, "{}", all.len());
    for (number, victim) in all.iter().enumerate() {
        let bytes = fs::read(victim).unwrap();
        let mut broken = bytes.clone();
        // Somewhere else in each file, and another bit.
        let at = (number * 7919 + 13) % bytes.len();
        broken[at] ^= 1 << (number % 8);
        fs::write(victim, &broken).unwrap();
        let name = victim.strip_prefix(bench.out()).unwrap().display().to_string();
        let deep = bench.look("verify", &["--deep"]);
        if name == "campaign.toml" && code(&deep) == 2 {
            // The flip has made it no spec at all, which is said with line and caret.
            assert!(stderr(&deep).contains("campaign.toml"), "{}", stderr(&deep));
        } else {
            assert_eq!(code(&deep), 1, "{name}: {}", stdout(&deep));
            assert!(stdout(&deep).contains(&name), "{name}: {}", stdout(&deep));
        }
        let again = bench.verb("run", &[]);
        assert_eq!(code(&again), 0, "{name}: {}", stderr(&again));
        assert!(files(&bench.out()) == whole, "{name} is not as it was");
        assert_eq!(code(&bench.look("verify", &["--deep"])), 0, "{name}");
    }
}

#[test]
fn e2e_what_is_gone_is_made_again_and_nothing_else() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let (whole, receipts) = (files(&bench.out()), bench.receipts());
    let victim = whole.keys().find(|path| path.ends_with("events.parquet")).unwrap();
    fs::remove_file(bench.out().join(victim)).unwrap();
    let status = bench.look("status", &[]);
    assert!(stdout(&status).contains("1 missing") && stdout(&status).contains(&victim.display().to_string()), "{}", stdout(&status));
    assert!(stdout(&bench.look("verify", &[])).contains("is missing"));
    let run = json(&stdout(&bench.verb("run", &["--json"])));
    let computed: Vec<&Value> = run["stages"].as_array().unwrap().iter().map(|stage| &stage["computed_count"]).collect();
    assert_eq!(computed, [0, 0, 1, 0, 0], "one cycle, whose bytes are the same");
    assert_eq!(files(&bench.out()), whole);
    let renewed = bench.receipts().iter().filter(|(path, bytes)| receipts[*path] != **bytes).count();
    assert_eq!(renewed, 1);
}

#[test]
fn e2e_a_receipt_tells_what_when_and_with_what() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let receipts = bench.receipts();
    let of = |stage: &str| {
        let folder = format!("receipts/{stage}");
        receipts
            .iter()
            .find(|(path, _)| path.parent().unwrap().ends_with(&folder))
            .map(|(_, bytes)| json(std::str::from_utf8(bytes).unwrap()))
            .unwrap()
    };
    let cycle = of("cycle");
    assert_eq!(cycle["made"]["version"], env!("CARGO_PKG_VERSION"));
    assert!(cycle["made"]["toolchain"].as_str().unwrap().starts_with("rustc 1."));
    assert!(cycle["made"]["effort"]["pair_evaluation_count"].as_u64().unwrap() > 1000);
    let began = cycle["made"]["began"].as_str().unwrap();
    assert!(began.len() == 20 && began.ends_with('Z'), "{began}");
    for stage in ["generate", "extract", "cycle"] {
        assert!(cycle["preimages"][stage]["meaning"].as_u64().unwrap() > 0, "{stage}");
    }
    assert_eq!(cycle["files"].as_array().unwrap().len(), 6);
    assert_eq!(
        of("report")["files"].as_array().unwrap().len(),
        (2 * 6 + 10 + 1) * if cfg!(feature = "raster") { 3 } else { 1 } + 2,
        "panels in both units, pictures of a cycle and works of adhesion in the formats of the build, their table and the page"
    );
    // No data file tells any of that.
    let host = cycle["made"]["host"].as_str().unwrap();
    for (path, bytes) in files(&bench.out()) {
        let has = |word: &str| bytes.windows(word.len()).any(|part| part == word.as_bytes());
        assert!(!has(&began[..10]) && (host.len() < 5 || !has(host)), "{} tells when or where", path.display());
    }
}

#[test]
fn e2e_explain_names_the_field_and_who_reads_it() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let other = bench.folder.path().join("other.toml");
    let unit_of = |text: &str, stage: usize| {
        fs::write(&other, text).unwrap();
        let status = bench.look("explain", &["statistics", "--spec", other.to_str().unwrap()]);
        assert_eq!(code(&status), 0, "{}", stderr(&status));
        let mut plan = bench.command("plan");
        plan.args(["--json"]);
        let answer = std::process::Command::new(env!("CARGO_BIN_EXE_hysteron"))
            .arg("plan")
            .arg(&other)
            .arg("--out")
            .arg(bench.out())
            .arg("--json")
            .output()
            .unwrap();
        json(&stdout(&answer))["stages"][stage]["units"][1]["id"].as_str().unwrap().to_owned()
    };
    // Spec, stage of the unit, what is said of it.
    let tried = [
        (
            SMALL.replace("[cycle]", "[material]\nwork_of_adhesion_j_m2 = 0.05\n[cycle]"),
            2,
            "material.work_of_adhesion_j_m2  requested 0.05, existing 0.07 (read by cycle)",
        ),
        (SMALL.replace("[cycle]", "hurst = 0.7\n[cycle]"), 2, "surface.hurst  requested 0.7, existing 0.8 (read by generate)"),
        (SMALL.replace("[cycle]", "hurst = 0.7\n[cycle]"), 0, "surface.hurst  requested 0.7, existing 0.8 (read by generate)"),
    ];
    for (text, stage, said) in tried {
        let id = unit_of(&text, stage);
        let answer = bench.look("explain", &[&id, "--spec", other.to_str().unwrap()]);
        assert!(stdout(&answer).contains(said), "{}", stdout(&answer));
        assert!(stdout(&answer).contains("is planned"), "{}", stdout(&answer));
        let as_json = json(&stdout(&bench.look("explain", &[&id, "--spec", other.to_str().unwrap(), "--json"])));
        assert_eq!(as_json[0]["differences"].as_array().unwrap().len(), 1);
    }
    // What is done, what no spec names, and what nobody knows.
    let own = files(&bench.out()).into_keys().find(|path| path.ends_with("steps.parquet")).unwrap();
    let id = own.parent().unwrap().file_name().unwrap().to_str().unwrap().to_owned();
    assert!(stdout(&bench.look("explain", &[&id])).contains("is done"));
    fs::write(&other, SMALL.replace("0.001", "0.002")).unwrap();
    let orphan = stdout(&bench.look("explain", &[&id, "--spec", other.to_str().unwrap()]));
    assert!(orphan.contains("is orphan") && orphan.contains("cycle.max_load"), "{orphan}");
    let unknown = bench.look("explain", &["H0.80_z6_r00-00000000"]);
    assert_eq!(code(&unknown), 1);
    assert!(stderr(&unknown).contains("\nhelp: name "), "{}", stderr(&unknown));
}

#[test]
fn e2e_gc_takes_only_what_no_spec_names() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let whole = files(&bench.out());
    assert!(stdout(&bench.look("gc", &[])).contains("Nothing is left over"));
    // The campaign shrinks to one magnification; somebody's own file lies beside.
    let first = bench.folder.path().join("first.toml");
    fs::copy(bench.spec(), &first).unwrap();
    fs::write(bench.spec(), SPEC.replace("[6, 8]", "[6]")).unwrap();
    // Names that end like ids, but are none: a date has eight digits too.
    fs::write(bench.out().join("surfaces/notes-20240131.h5"), "mine").unwrap();
    fs::create_dir(bench.out().join("cycles/H0.80-deadbeef")).unwrap();
    fs::write(bench.out().join("surfaces/.hysteron-torn.tmp"), "torn").unwrap();
    assert_eq!(code(&bench.verb("run", &[])), 0);
    // The report has one figure of works of adhesion less.
    let formats = if cfg!(feature = "raster") { 3 } else { 1 };
    let kept = stdout(&bench.look("gc", &["--keep", first.to_str().unwrap()]));
    assert!(
        kept.contains(&format!("{} left over", 1 + formats)) && kept.contains(".hysteron-torn.tmp") && kept.contains("works_2"),
        "{kept}"
    );
    let before = files(&bench.out());
    let dry = stdout(&bench.look("gc", &[]));
    assert!(dry.contains("nothing was deleted"), "{dry}");
    assert_eq!(files(&bench.out()), before, "dry by default");
    let answer = json(&stdout(&bench.look("gc", &["--delete", "--json"])));
    assert_eq!(
        answer["leftovers"].as_array().unwrap().len(),
        17 + formats,
        "of two surfaces each four files and a folder with their three receipts; a figure of their case, and a torn file"
    );
    let after = files(&bench.out());
    assert!(after.contains_key(Path::new("surfaces/notes-20240131.h5")) && bench.out().join("cycles/H0.80-deadbeef").is_dir());
    assert!(after.keys().all(|path| !path.to_string_lossy().contains("_z8_")), "nothing of the other magnification is left");
    let verified = bench.look("verify", &["--deep"]);
    assert!(stdout(&verified).contains("1 file is named by no receipt:\n  surfaces/notes-20240131.h5\n"), "{}", stdout(&verified));
    assert!(stdout(&bench.verb("run", &[])).contains("Nothing to do"));
    // What was taken is made again, the same.
    fs::remove_file(bench.out().join("surfaces/notes-20240131.h5")).unwrap();
    fs::copy(&first, bench.spec()).unwrap();
    assert_eq!(code(&bench.verb("run", &[])), 0);
    assert!(files(&bench.out()) == whole);
}

#[test]
fn e2e_a_failed_case_waits_for_retry() {
    // At a range of 1 µm the Tabor numbers lie below 2, where Wu's rule does not hold.
    let bench = Bench::new(&SMALL.replace("[cycle]", "[[sweep]]\nname = \"s\"\nmaterial.interaction_range_m = [1e-9, 1e-6]\n[cycle]"));
    // A table after a sweep belongs to the spec all the same.
    let first = bench.verb("run", &[]);
    assert_eq!(code(&first), 3, "{}", stderr(&first));
    let again = bench.verb("run", &["--json"]);
    assert_eq!(code(&again), 3);
    let answer = json(&stdout(&again));
    assert_eq!((&answer["stages"][2]["computed_count"], &answer["stages"][2]["failed_count"]), (&0.into(), &2.into()));
    assert!(!stderr(&again).contains("Tabor"), "it was not tried again");
    let record = files(&bench.out()).into_iter().find(|(path, _)| path.ends_with("failed.json")).unwrap();
    let record = json(std::str::from_utf8(&record.1).unwrap());
    let command = record["again"].as_str().unwrap();
    let id = command.rsplit(' ').next().unwrap();
    assert!(command.starts_with("hysteron retry "), "{command}");
    let retry = bench.look("retry", &[id]);
    assert_eq!(code(&retry), 3);
    assert_eq!(stderr(&retry).matches(" failed: ").count(), 1, "only the one that was named: {}", stderr(&retry));
    assert_eq!(stderr(&bench.look("retry", &[])).matches(" failed: ").count(), 2);
    let strange = bench.look("retry", &["H0.80_z6_r00-00000000"]);
    assert_eq!(code(&strange), 1);
    assert!(stderr(&strange).contains(id), "{}", stderr(&strange));
    let status = stdout(&bench.look("status", &["--watch"]));
    assert!(status.contains("All other tasks are done. 2 cycles failed. "), "it ends though failed cases are left: {status}");
    assert!(!status.contains("Nothing is left") && status.contains(&format!("  {id} failed: ")), "{status}");
}

#[test]
fn e2e_looking_writes_nothing() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "extract"])), 0);
    let before: Vec<_> =
        crate::bench::paths(&bench.out()).into_iter().map(|path| (fs::metadata(&path).unwrap().modified().unwrap(), path)).collect();
    for (verb, more) in
        [("status", &[][..]), ("verify", &["--deep"]), ("gc", &[]), ("explain", &["statistics"]), ("explain", &["report", "--json"])]
    {
        let looked = bench.look(verb, more);
        assert_eq!(code(&looked), 0, "{verb}: {}", stderr(&looked));
    }
    assert_eq!(code(&bench.verb("plan", &["--json"])), 0);
    let after: Vec<_> =
        crate::bench::paths(&bench.out()).into_iter().map(|path| (fs::metadata(&path).unwrap().modified().unwrap(), path)).collect();
    assert_eq!(after, before);
}

#[test]
fn e2e_a_receipt_belongs_to_its_place_and_names_files_of_its_folder_only() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "generate"])), 0);
    let (path, bytes) = bench.receipts().into_iter().find(|(path, _)| path.parent().unwrap().ends_with("generate")).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let (body, _) = text.rsplit_once(",\n  \"seal\": \"").unwrap();
    let own = format!("surfaces/{}.h5", path.file_stem().unwrap().to_str().unwrap());
    // Whoever can compute the seal can write a receipt; it is believed no more for that.
    let sealed = |body: &str| format!("{body},\n  \"seal\": \"{}\"\n}}\n", blake3::hash(body.as_bytes()).to_hex());
    assert_eq!(sealed(body), text);
    fs::write(bench.folder.path().join("outside"), "x").unwrap();
    for other in ["../outside", "/etc/passwd", "", "surfaces/../../outside"] {
        fs::write(&path, sealed(&body.replace(&own, other))).unwrap();
        let verified = bench.look("verify", &["--deep"]);
        assert_eq!(code(&verified), 1, "{other}: {}", stdout(&verified));
        assert!(stdout(&verified).contains("is not a file of the directory"), "{other}: {}", stdout(&verified));
    }
    fs::write(&path, sealed(&body.replace("\"generate\",\n  \"id\"", "\"extract\",\n  \"id\""))).unwrap();
    assert!(stdout(&bench.look("verify", &[])).contains("provenance record of another stage, \"extract\""));
    fs::write(&path, &text).unwrap();
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
    fs::copy(&path, path.with_file_name("copy.json")).unwrap();
    assert!(stdout(&bench.look("verify", &[])).contains("provenance record of another task"), "a copy by another name is none");
}

#[test]
fn e2e_output_that_nobody_takes() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "extract"])), 0);
    let program = env!("CARGO_BIN_EXE_hysteron");
    let shell = |line: String| std::process::Command::new("sh").args(["-c", &line]).output().unwrap();
    let out = bench.out().display().to_string();
    // One who has read enough is no fault, and ends what would go on; a full disk is one.
    let head = shell(format!("timeout 60 '{program}' status '{out}' --watch | head -1"));
    assert!(stdout(&head).starts_with("small in "), "{}", stdout(&head));
    if Path::new("/dev/full").exists() {
        let full = shell(format!("'{program}' status '{out}' --json > /dev/full"));
        assert_eq!(code(&full), 1);
        assert!(stderr(&full).contains("cannot write to standard output"), "{}", stderr(&full));
    }
}
