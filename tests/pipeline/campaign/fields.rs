//! Every key of the spec, and what it makes stale.

use hysteron::campaign::{Campaign, Standing};
use hysteron::keys::canonical;
use hysteron::model::{MeasuredSurface, SurfaceSource};
use hysteron::spec::Spec;
use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;

fn campaign(text: &str) -> Campaign {
    Campaign::new(Spec::parse(text, "x.toml").unwrap_or_else(|errors| panic!("{errors}\n{text}")), PathBuf::from("out"))
}

/// Keys by stage: surfaces, asperities, cycles, statistics, report.
fn keys(campaign: &Campaign) -> [Vec<String>; 5] {
    let statistics = campaign.statistics_key(&vec![Standing::Done; campaign.cycles.len()]);
    [
        campaign.surfaces.iter().map(|unit| unit.key.clone()).collect(),
        campaign.surfaces.iter().map(|unit| unit.asperities_key.clone()).collect(),
        campaign.cycles.iter().map(|unit| unit.key.clone()).collect(),
        vec![statistics.clone()],
        vec![campaign.report_key(&statistics)],
    ]
}

/// Another value for every key of a spec, and the first stage that reads it: 0 generate, 2 cycle, 3 aggregate, 4 report.
const OTHERS: [(&str, &str, usize); 32] = [
    ("name", "\"y\"", 3),
    ("figures", "{ format = [\"svg\"], width_mm = 88.0, font = \"DejaVu Sans\" }", 4),
    ("seed", "2022", 0),
    ("surface.length_m", "0.002", 0),
    ("surface.rms_height_m", "6e-6", 0),
    ("surface.hurst", "0.7", 0),
    ("surface.magnification", "12", 0),
    ("surface.points_per_shortest_wavelength", "12", 0),
    ("surface.normalization", "\"spectrum\"", 0),
    ("surface.amplitudes", "\"gaussian\"", 0),
    ("material.contact_modulus_pa", "2e6", 2),
    ("material.work_of_adhesion_j_m2", "0.05", 2),
    ("material.interaction_range_m", "2e-9", 2),
    ("model.method", "\"boundary_elements\"", 2),
    ("model.interaction", "\"point\"", 2),
    ("model.boundary", "\"isolated\"", 2),
    ("model.coalescence", "\"cover\"", 2),
    ("model.jump_in", "\"jkr\"", 2),
    ("model.as_printed", "[\"eq8\"]", 2),
    ("model.allow_low_tabor", "true", 2),
    // The asperity model reads none of these; the report shows the spec.
    ("boundary_elements.points", "128", 4),
    ("boundary_elements.attraction", "\"range\"", 4),
    ("boundary_elements.range_m", "1e-7", 4),
    ("boundary_elements.nucleation", "\"wu\"", 4),
    ("boundary_elements.opening", "\"anywhere\"", 4),
    ("boundary_elements.law", "\"corrected\"", 4),
    ("boundary_elements.approach_step", "0.02", 4),
    ("boundary_elements.halvings", "3", 4),
    ("boundary_elements.precision", "1e-5", 4),
    ("cycle.max_load", "[0.003]", 2),
    ("cycle.approach_step", "0.02", 2),
    ("cycle.contacts", "\"all\"", 2),
];

#[test]
fn law_every_key_reruns_exactly_the_stages_that_read_it() {
    let base = campaign("name = \"x\"\nrealizations = 2\n[surface]\nmagnification = 8\n").spec.to_toml();
    let before = keys(&campaign(&base));
    let mut table = String::new();
    let mut met = BTreeSet::new();
    let lines: Vec<&str> = base.lines().collect();
    for (place, line) in lines.iter().enumerate() {
        if let Some(name) = line.strip_prefix('[') {
            table = format!("{}.", name.trim_end_matches(']'));
        }
        let Some((name, _)) = line.split_once(" = ") else { continue };
        let name = format!("{table}{name}");
        if name == "realizations" {
            continue;
        }
        let (_, value, first) = OTHERS.iter().find(|(known, ..)| *known == name).unwrap_or_else(|| panic!("no other value for {name}"));
        let other = format!("{} = {value}", line.split_once(" = ").unwrap().0);
        assert_ne!(*line, other, "{name} has another value");
        let text: Vec<&str> = lines.iter().enumerate().map(|(k, line)| if k == place { other.as_str() } else { line }).collect();
        let after = keys(&campaign(&text.join("\n")));
        for (stage, (old, new)) in before.iter().zip(&after).enumerate() {
            let changed = old.iter().zip(new).all(|(a, b)| a != b);
            let kept = old == new;
            assert!(if stage >= *first { changed } else { kept }, "{name}: stage {stage}");
        }
        met.insert(name);
    }
    assert_eq!(met.len(), OTHERS.len(), "every key of the spec has been tried");
}

/// Tasks of the plain law have the keys that they had before there was another one.
#[test]
fn law_the_default_law_is_no_input() {
    let law = |line: &str| {
        let text = format!("name = \"x\"\nsurface.magnification = 8\nmodel.method = \"boundary_elements\"\n{line}");
        let campaign = campaign(&text);
        campaign.cycle_preimages(&campaign.cycles[0])["cycle"].pointer("/reads/boundary_elements/law").cloned()
    };
    assert_eq!([law(""), law("boundary_elements.law = \"plain\"")], [None, None]);
    assert_eq!(law("boundary_elements.law = \"corrected\""), Some("corrected".into()));
}

#[test]
fn law_a_measured_surface_is_known_by_what_its_file_holds_and_what_is_done_to_it() {
    let text = |lines: &str, digest: char| {
        let digest: String = std::iter::repeat_n(digest, 64).collect();
        format!(
            "name = \"x\"\nrealizations = 2\n[surface]\nfile = \"a/scan.x3p\"\n{lines}\n[model]\nboundary = \"isolated\"\n[files]\n\"a/scan.x3p\" = \"{digest}\"\n"
        )
    };
    let base = campaign(&text("", '0'));
    assert_eq!((base.surfaces.len(), base.counts[0]), (1, 1), "a measured surface is one surface");
    assert!(base.surfaces[0].id.starts_with("scan_r00-"), "{}", base.surfaces[0].id);
    let first = |campaign: &Campaign| keys(campaign)[0][0].clone();
    let mut seen = BTreeSet::from([first(&base)]);
    let others = [
        "dataset = \"b\"",
        "periodic = true",
        "pixel_m = 1e-9",
        "size_m = 1e-6",
        "size_y_m = 1e-6",
        "skip_lines = 1",
        "width = 8",
        "transpose = true",
        "unit = \"nm\"",
        "missing = \"fill\"",
        "detrend = \"mean\"",
        "filter = \"sharp\"",
    ];
    for line in others.into_iter().chain(["points_per_shortest_wavelength = 16"]) {
        let other = campaign(&text(line, '0'));
        assert!(seen.insert(first(&other)), "{line}: a surface of its own");
        // The spec that is written out asks for the same.
        assert_eq!(keys(&campaign(&other.spec.to_toml())), keys(&other), "{line}");
    }
    assert!(seen.insert(first(&campaign(&text("", '1')))), "another file");
    let other_seed = campaign(&text("", '0').replace("realizations = 2", "seed = 5"));
    assert_eq!(keys(&other_seed)[2], keys(&base)[2], "a measured surface reads no seed");
    let moved = campaign(&text("", '0').replace("a/scan", "b/scan"));
    assert_eq!(first(&moved), first(&base), "the same file at another place");
    // One sweep over files, another over generated surfaces.
    let both = "name = \"x\"\n[model]\nboundary = \"isolated\"\n[[sweep]]\nname = \"files\"\nsurface.file = [\"a.h5\", \"b.h5\"]\n\
                [[sweep]]\nname = \"made\"\nsurface.hurst = [0.7, 0.8]\n";
    let both = campaign(both);
    assert_eq!((both.cases.len(), both.counts.clone()), (4, vec![1, 1, 6, 6]));
    assert_eq!(keys(&campaign(&both.spec.to_toml())), keys(&both));
}

#[test]
fn law_ids_stay_when_a_campaign_grows() {
    let text = |sweep: &str, realizations: u32| {
        format!(
            "name = \"x\"\nrealizations = {realizations}\n[surface]\nmagnification = 8\n[[sweep]]\nname = \"s\"\nsurface.hurst = [{sweep}]\n"
        )
    };
    let ids = |campaign: &Campaign| {
        let surfaces = campaign.surfaces.iter().map(|unit| unit.id.clone());
        surfaces
            .chain(campaign.cycles.iter().map(|unit| unit.id.clone()))
            .chain(campaign.cases.iter().map(|unit| unit.id.clone()))
            .collect::<BTreeSet<_>>()
    };
    let small = ids(&campaign(&text("0.5, 0.8", 2)));
    // Values before and between, and more realizations: nothing is known by its place.
    let large = ids(&campaign(&text("0.45, 0.5, 0.6, 0.8, 0.9", 5)));
    assert_eq!(small.len(), 10);
    assert!(small.is_subset(&large));
    assert_eq!(large.len(), 5 * (5 + 5 + 1));
}

#[test]
fn law_two_units_never_share_an_id() {
    let text = |values: &[String]| {
        format!(
            "name = \"x\"\nrealizations = 1\n[surface]\nmagnification = 6\n[[sweep]]\nname = \"s\"\nmaterial.work_of_adhesion_j_m2 = [{}]\n",
            values.join(", ")
        )
    };
    // Eight digits of a key: among some ten thousands of values two share them.
    let mut known: HashMap<String, String> = HashMap::new();
    let pair = (1..100).find_map(|block: u32| {
        let values: Vec<String> = (0..5000).map(|k| format!("{}e-8", 5000 * block + k)).collect();
        let cycles = campaign(&text(&values)).cycles;
        values
            .into_iter()
            .zip(cycles)
            .find_map(|(value, unit)| known.insert(unit.key[..8].to_owned(), value.clone()).map(|other| [other, value]))
    });
    let pair = pair.unwrap();
    let both = campaign(&text(&pair));
    let ids: BTreeSet<&str> = both.cycles.iter().map(|unit| unit.id.as_str()).collect();
    assert_eq!(ids.len(), 2, "{ids:?}");
    assert!(both.cycles.iter().all(|unit| unit.id.ends_with(&unit.key[..16])), "{ids:?}");
    let alone = campaign(&text(&pair[..1]));
    assert!(alone.cycles[0].id.ends_with(&format!("-{}", &alone.cycles[0].key[..8])));
}

#[test]
fn law_what_failed_is_another_table_than_what_was_not_tried() {
    let mut one = campaign("name = \"x\"\n[surface]\nmagnification = 8\n");
    let failed = Standing::Failed("no equilibrium".to_owned());
    let why = Standing::Failed("a \"quoted\" reason\nhelp: nothing".to_owned());
    let keys: BTreeSet<String> = [Standing::Done, Standing::Planned, failed, why.clone()]
        .map(|standing| {
            let preimages = one.statistics_preimages(std::slice::from_ref(&standing));
            let key = one.statistics_key(&[standing]);
            assert_eq!(key, blake3::hash(canonical(&preimages["aggregate"]).as_bytes()).to_hex().to_string());
            key
        })
        .into();
    assert_eq!(keys.len(), 4, "the table cycles holds the error message");
    assert_eq!(one.failure_in_tables(&one.cycles[0], &why).as_deref(), Some("a \"quoted\" reason"));
    // A table holds no path of the machine.
    let scan = MeasuredSurface { file: "/data/here/a scan.npy".to_owned(), ..MeasuredSurface::default() };
    one.surfaces[0].params = SurfaceSource::Measured(Box::new(scan));
    let unread = Standing::Failed("cannot import the surface /data/here/a scan.npy: it is empty".to_owned());
    assert_eq!(one.failure_in_tables(&one.cycles[0], &unread).as_deref(), Some("cannot import the surface a scan.npy: it is empty"));
}
