//! The keys of a spec's units: what of a case changes which.

use hysteron::campaign::{Campaign, Stage, Standing};
use hysteron::keys::canonical;
use hysteron::spec::Spec;
use serde_json::{Map, Value};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// The campaign of one case, with lines of `[model]` of its own.
fn campaign(model: &str) -> Campaign {
    let text = format!("name = \"x\"\nrealizations = 2\n[surface]\nmagnification = 8\n[model]\n{model}\n");
    Campaign::new(Spec::parse(&text, "x.toml").unwrap_or_else(|errors| panic!("{errors}")), PathBuf::from("out"))
}

/// Keys of the surfaces, of the cycles, and of the statistics when all is done.
fn keys(campaign: &Campaign) -> (Vec<&str>, Vec<&str>, String) {
    let surfaces = campaign.surfaces.iter().flat_map(|unit| [unit.key.as_str(), unit.asperities_key.as_str()]).collect();
    let cycles = campaign.cycles.iter().map(|unit| unit.key.as_str()).collect();
    (surfaces, cycles, campaign.statistics_key(&vec![Standing::Done; campaign.cycles.len()]))
}

#[test]
fn law_a_slip_changes_the_keys_of_what_reads_it() {
    let base = campaign("");
    let (surfaces, cycles, statistics) = keys(&base);
    assert_eq!(keys(&campaign("as_printed = []")), keys(&base), "what is said is what is meant");
    // Line, whether the cycle reads it.
    let lines = [
        ("as_printed = [\"eq8\"]", true),
        ("as_printed = [\"eq9\"]", true),
        ("as_printed = [\"a2\"]", false),
        ("as_printed = [\"a3\"]", false),
        ("boundary = \"isolated\"", true),
        ("coalescence = \"none\"", true),
    ];
    let mut seen = BTreeSet::from([statistics]);
    for (line, in_cycle) in lines {
        let other = campaign(line);
        let (of_surfaces, of_cycles, of_statistics) = keys(&other);
        assert_eq!(of_surfaces, surfaces, "{line}");
        assert!(of_cycles.iter().zip(&cycles).all(|(a, b)| (a != b) == in_cycle), "{line}");
        assert!(seen.insert(of_statistics), "{line}: statistics of its own");
    }
    // Of two slips together the cycle reads one.
    assert_eq!(keys(&campaign("as_printed = [\"a3\", \"eq9\"]")).1, keys(&campaign("as_printed = [\"eq9\"]")).1);
}

#[test]
fn law_a_key_is_the_hash_of_what_a_receipt_says_of_it() {
    let campaign = campaign("");
    let hash = |preimages: &Map<String, Value>, stage: &str| blake3::hash(canonical(&preimages[stage]).as_bytes()).to_hex().to_string();
    for unit in &campaign.surfaces {
        let preimages = campaign.surface_preimages(unit, Stage::Extract);
        assert_eq!((hash(&preimages, "generate"), hash(&preimages, "extract")), (unit.key.clone(), unit.asperities_key.clone()));
    }
    for unit in &campaign.cycles {
        assert_eq!(hash(&campaign.cycle_preimages(unit), "cycle"), unit.key);
    }
    let standings = [Standing::Done, Standing::Failed("why".to_owned())];
    let statistics = campaign.statistics_key(&standings);
    assert_eq!(hash(&campaign.statistics_preimages(&standings), "aggregate"), statistics);
    assert_eq!(hash(&campaign.report_preimages(&statistics), "report"), campaign.report_key(&statistics));
}

#[test]
fn law_cases_that_differ_beside_the_cycle_share_it() {
    let text = "name = \"x\"\nrealizations = 3\n[surface]\nmagnification = 8\n[[sweep]]\nname = \"s\"\n\
                model.as_printed = [[], [\"a2\"], [\"a3\"], [\"eq8\"], [\"eq8\", \"a2\"]]\n";
    let campaign = Campaign::new(Spec::parse(text, "x.toml").unwrap(), PathBuf::from("out"));
    assert_eq!((campaign.cases.len(), campaign.cycles.len()), (5, 15), "every case has its cycles");
    let distinct = campaign.distinct_cycles();
    assert_eq!(distinct.len(), 6, "of which there are two for each surface");
    let folders = |units: &[hysteron::campaign::CycleUnit]| units.iter().map(|unit| campaign.cycle_dir(unit)).collect::<BTreeSet<_>>();
    assert_eq!(folders(&distinct), folders(&campaign.cycles));
    assert_eq!(campaign.cases.iter().map(|case| &case.id).collect::<BTreeSet<_>>().len(), 5);
}

#[test]
fn reg_ids_of_the_asperity_model() {
    // Cases of runs before there was another method: their files are still those of the same spec. The id of a cycle changes with the version of
    // its stage and method.
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/paper.toml");
    let text = std::fs::read_to_string(path).unwrap().replace("normalization = \"spectrum\"", "normalization = \"sample\"");
    let campaign = Campaign::new(Spec::parse(&text, "paper.toml").unwrap(), PathBuf::from("out"));
    let cases: Vec<&str> = campaign.cases.iter().map(|case| case.id.as_str()).collect();
    assert_eq!(cases[..3], ["H0.80_z128-6adbcc12", "H0.80_z64-f3e3216c", "H0.80_z128-ff1e5233"]);
    assert_eq!(campaign.cycles[0].id, "H0.80_z128_r00-42d64930");
}

#[test]
fn law_a_cycle_reads_the_keys_of_its_method() {
    let base = campaign("method = \"boundary_elements\"");
    let asperities = campaign("");
    assert_eq!(keys(&base).0, keys(&asperities).0, "the same surfaces");
    assert!(keys(&base).1.iter().zip(keys(&asperities).1).all(|(a, b)| *a != b), "other cycles");
    let with = |lines: &str| campaign(&format!("method = \"boundary_elements\"\n{lines}"));
    for unread in ["coalescence = \"merge\"", "interaction = \"none\"", "jump_in = \"jkr\"", "[cycle]\napproach_step = 0.02"] {
        assert_eq!(keys(&with(unread)), keys(&base), "{unread}");
    }
    let mut seen = BTreeSet::from([keys(&base).1.concat()]);
    let read = [
        "points = 256",
        "attraction = \"range\"",
        "nucleation = \"wu\"",
        "opening = \"anywhere\"",
        "approach_step = 0.05",
        "halvings = 3",
        "precision = 1e-3",
    ];
    for line in read {
        let other = with(&format!("[boundary_elements]\n{line}"));
        assert_eq!(keys(&other).0, keys(&base).0, "{line}");
        assert!(seen.insert(keys(&other).1.concat()), "{line}: a cycle of its own");
    }
    let preimage = &with("").cycle_preimages(&base.cycles[0])["cycle"];
    assert_eq!(preimage["reads"]["boundary_elements"]["nucleation"], "touch", "explained field by field");
}
