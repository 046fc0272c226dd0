//! Planning: what a spec asks for, and what of it is done.

use crate::watch::{heading, line, plain, race};
use hysteron::campaign::{Campaign, Stage};
use hysteron::spec::Spec;
use hysteron::store::{Check, Made, RECEIPT_VERSION, Receipt, write_receipt};
use std::fs::{create_dir_all, metadata};
use std::hint::black_box;
use std::path::Path;

fn campaign(realizations: usize, dir: &Path) -> Campaign {
    let values = (1..=50).map(|k| format!("{}e-3", k + 20)).collect::<Vec<_>>().join(", ");
    let text = format!(
        "name = \"many\"\nrealizations = {realizations}\n[surface]\nmagnification = 8\n[[sweep]]\nname = \"s\"\n\
         material.work_of_adhesion_j_m2 = [{values}]\n"
    );
    Campaign::new(Spec::parse(&text, "many.toml").unwrap(), dir.to_owned())
}

pub fn run() {
    heading("planning: a spec and how its units stand", "over asking for as many files");
    let folder = tempfile::tempdir().unwrap();
    let compare = |what: &str, realizations: usize| {
        let units = realizations * 52;
        let absent = folder.path().join("absent");
        let (ours, theirs) = race(
            3,
            || drop(black_box(campaign(realizations, folder.path()).survey(Check::Sizes))),
            || (0..units).for_each(|_| drop(black_box(metadata(&absent)))),
        );
        plain(&format!("{units} questions"), theirs);
        line(what, ours, ours / theirs);
    };
    compare("104 000 units, none done", 2000);
    let small = campaign(40, folder.path());
    for stage in [Stage::Generate, Stage::Extract, Stage::Cycle] {
        create_dir_all(small.receipts_dir(stage)).unwrap();
    }
    for unit in
        small.surfaces.iter().flat_map(|unit| [unit.surface(), unit.asperities()]).chain(small.cycles.iter().map(|unit| unit.cycle()))
    {
        let made = Made {
            version: String::new(),
            commit: None,
            toolchain: String::new(),
            host: String::new(),
            threads: 1,
            began: String::new(),
            seconds: 0.0,
            effort: serde_json::Map::new(),
        };
        let [stage, id, key] = [unit.stage.word(), unit.id, unit.key].map(str::to_owned);
        let preimages = small.cycle_preimages(&small.cycles[0]);
        let receipt = Receipt { receipt: RECEIPT_VERSION, stage, id, key, preimages, files: Vec::new(), made };
        write_receipt(&small.receipt_path(&unit), &receipt).unwrap();
    }
    compare("2080 units, all with receipts", 40);
}
