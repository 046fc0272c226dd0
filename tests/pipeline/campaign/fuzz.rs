//! Bytes that no program of ours has written: whatever they are, the answer is a content or a sentence.

use super::SMALL;
use crate::bench::{Bench, code, paths};
use crate::scan::read_heights;
use hysteron::schema;
use hysteron::spec::Spec;
use hysteron::store::{Found, hdf5, parquet, read_receipt};
use rand::{Rng as _, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use std::fs;
use std::path::{Path, PathBuf};

/// Inputs of each kind: `HYSTERON_FUZZ` asks for more.
fn inputs(usual: usize) -> usize {
    std::env::var("HYSTERON_FUZZ").ok().and_then(|count| count.parse().ok()).unwrap_or(usual)
}

/// What stands for much in a text.
const WORDS: [&str; 14] = [
    "[[sweep]]",
    "\n",
    " = ",
    "1e308",
    "-1",
    "nan",
    "\"\"",
    "[",
    "]",
    "{",
    "999999999999999999999",
    "\u{feff}",
    "'''",
    "surface.magnification = [64, 128]\n",
];

/// Some bytes with one to eight changes: bits, bytes, pieces that are cut out, doubled or moved, numbers and words put in.
fn mutated(seed: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..random.random_range(1..=8) {
        if bytes.is_empty() {
            return bytes;
        }
        let at = random.random_range(0..bytes.len());
        let piece = at..(at + random.random_range(1..=64)).min(bytes.len());
        match random.random_range(0..8) {
            0 => bytes[at] ^= 1 << random.random_range(0..8),
            1 => bytes[at] = random.random(),
            2 => bytes.truncate(at),
            3 => drop(bytes.drain(piece)),
            4 => {
                let copy = bytes[piece].to_vec();
                let to = random.random_range(0..=bytes.len());
                bytes.splice(to..to, copy);
            }
            5 => bytes[piece].fill(if random.random() { 0xff } else { 0 }),
            6 => {
                let word = WORDS[random.random_range(0..WORDS.len())];
                bytes.splice(at..at, word.bytes());
            }
            _ => {
                let mut number = [0; 8];
                random.fill_bytes(&mut number);
                let end = (at + 8).min(bytes.len());
                bytes[at..end].copy_from_slice(&number[..end - at]);
            }
        }
    }
    bytes
}

#[test]
fn law_no_text_ends_the_parser() {
    let mut corpus: Vec<String> = ["tests/specs", "pipelines"]
        .iter()
        .flat_map(|folder| paths(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)))
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| fs::read_to_string(path).unwrap())
        .filter(|text| text.len() < 10_000)
        .collect();
    corpus.push(Spec::parse(SMALL, "x.toml").unwrap().to_toml());
    corpus.sort();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let (mut read, mut refused) = (0, 0);
    for number in 0..inputs(4000) {
        let bytes = mutated(corpus[number % corpus.len()].as_bytes(), &mut random);
        match Spec::parse(&String::from_utf8_lossy(&bytes), "x.toml") {
            Ok(spec) => {
                read += 1;
                assert_eq!(Spec::parse(&spec.to_toml(), "x.toml").unwrap(), spec, "what is read is written and read the same");
            }
            Err(errors) => {
                refused += 1;
                assert!(!errors.to_string().is_empty());
            }
        }
    }
    eprintln!("{read} read, {refused} refused");
    assert!(read > 0 && refused > 0);
}

#[test]
fn law_no_bytes_end_a_reader() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let all = paths(&bench.out());
    let of = |ending: &str| -> Vec<PathBuf> { all.iter().filter(|path| path.to_string_lossy().ends_with(ending)).cloned().collect() };
    // All but the one that stands in no run, as it is of several, and those of boundary elements, of measured loops and of several scans.
    let here = |table: &&'static schema::Table| {
        table.file.contains('/')
            && !["adhesionless", "measured_loops", "measured_steps", "scans", "scan_spectra", "spectrum"].contains(&table.name)
    };
    let known: Vec<&'static schema::Table> = schema::TABLES.iter().copied().filter(here).collect();
    let tables: Vec<(PathBuf, &'static schema::Table)> = known
        .iter()
        .filter_map(|table| {
            let (start, end) = table.file.split_once("<id>").unwrap_or((table.file, ""));
            let is_one = |path: &&PathBuf| {
                let place = path.strip_prefix(bench.out()).unwrap().to_string_lossy();
                place.starts_with(start) && place.ends_with(end)
            };
            all.iter().find(is_one).map(|path| (path.clone(), *table))
        })
        .collect();
    assert_eq!(tables.len(), known.len());
    assert_eq!(known.len(), schema::TABLES.len() - 7);
    let victim = bench.folder.path().join("victim");
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let mut whole = 0;
    let mut attempt = |source: &Path, random: &mut ChaCha8Rng, read: &dyn Fn(&Path) -> Result<(), String>| {
        fs::write(&victim, mutated(&fs::read(source).unwrap(), random)).unwrap();
        match read(&victim) {
            Ok(()) => whole += 1,
            Err(why) => assert!(!why.is_empty()),
        }
    };
    let (receipts, surfaces) = (of(".json"), of(".h5"));
    for number in 0..inputs(400) {
        let (path, table) = &tables[number % tables.len()];
        attempt(path, &mut random, &|path| parquet::read_table(path, table).map(drop).map_err(|error| error.to_string()));
        attempt(&surfaces[0], &mut random, &|path| hdf5::read_surface(path).map(drop).map_err(|error| error.to_string()));
        attempt(&surfaces[0], &mut random, &|path| read_heights(path, Some("height_m")).map(drop).map_err(|error| error.to_string()));
        let receipt = &receipts[number % receipts.len()];
        attempt(receipt, &mut random, &|path| match read_receipt(path) {
            Found::Whole(_) => panic!("a receipt was changed, and read as one"),
            Found::Nothing => Err("nothing".to_owned()),
            Found::Damaged(why) => Err(why),
        });
    }
    eprintln!("{whole} of {} were read", 4 * inputs(400));
}
