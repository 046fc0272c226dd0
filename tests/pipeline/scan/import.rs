//! A measured surface from its file to the loss of its contact, as a user takes it there.

use crate::bench::{Bench, code, paths, stderr, stdout};
use hysteron::model::{Amplitudes, Normalization};
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use hysteron::schema;
use hysteron::store::hdf5::{read_header, read_surface};
use hysteron::store::parquet::read_table;
use ndarray::{Array2, ArrayView1, s};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::make::{npy, npy_line};

/// A part of a rough surface, which does not continue periodically: heights in nanometres, points 12.5 nm apart.
pub fn part() -> Array2<f64> {
    cut(16, 96)
}

pub fn cut(magnification: u32, rows: usize) -> Array2<f64> {
    let spectrum = Spectrum {
        length_m: f64::from(magnification) * 1e-7,
        rms_height_m: 20e-9,
        hurst: 0.8,
        magnification,
        normalization: Normalization::Sample,
        amplitudes: Amplitudes::Fixed,
        shape: Shape::default(),
    };
    let surface = synthesize(&spectrum, &realization_seed(5, 0), 8 * magnification as usize);
    surface.heights_m.slice(s![..rows, ..rows + 4]).mapv(|h| 1e9 * h)
}

pub fn bytes(heights: &Array2<f64>) -> Vec<u8> {
    let data: Vec<u8> = heights.iter().flat_map(|h| h.to_le_bytes()).collect();
    npy(1, &npy_line("<f8", "False", &format!("({}, {})", heights.nrows(), heights.ncols())), &data)
}

/// Runs `import` in a folder.
pub fn import(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron")).arg("import").args(arguments).current_dir(folder).output().unwrap()
}

const TOLD: [&str; 4] = ["--pixel-m", "12.5e-9", "--unit", "nm"];

/// A spec on a surface in a file.
fn spec(surface: &str) -> String {
    format!(
        "name = \"measured\"\n[surface]\n{surface}\n[model]\nboundary = \"isolated\"\njump_in = \"jkr\"\n\
         [material]\ncontact_modulus_pa = 1e8\n[cycle]\nmax_load = [0.002]\napproach_step = 0.05\n"
    )
}

/// A folder with a scan and its import, and the answer of the import.
fn imported() -> (tempfile::TempDir, Value) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scan.npy"), bytes(&part())).unwrap();
    let output = import(folder.path(), &[&["scan.npy", "--json"], &TOLD[..]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let answer = serde_json::from_str(&stdout(&output)).unwrap();
    (folder, answer)
}

#[test]
fn e2e_a_scan_is_taken_and_told() {
    let (folder, answer) = imported();
    let (header, heights) = read_surface(&folder.path().join("scan.h5")).unwrap();
    // The middle square of 96 by 100 points.
    assert_eq!((heights.dim(), header.periodic), ((96, 96), false));
    assert!((header.length_m / (96.0 * 12.5e-9) - 1.0).abs() < 1e-12);
    let measured = header.measured.unwrap();
    assert_eq!((measured.source.as_str(), measured.missing_count), ("scan.npy", 0));
    assert_eq!(measured.source_blake3, blake3::hash(&bytes(&part())).to_hex().to_string());
    // The moments are those of the heights that were written.
    let rms = heights.mapv(|h| h * h).mean().unwrap().sqrt();
    assert!((header.rms_height_m / rms - 1.0).abs() < 1e-9);
    for (name, value) in [
        ("height_factor_m", 1e-9),
        ("length_m", header.length_m),
        ("rms_height_m", header.rms_height_m),
        ("rms_slope", header.rms_slope),
        ("nayak_parameter", header.nayak_parameter),
    ] {
        // The last digit is that of the reader of JSON.
        assert!((answer[name].as_f64().unwrap() / value - 1.0).abs() < 1e-14, "{name}");
    }
    // H, of a part large enough to have a spectrum, its shortest waves 38 to its side. Six such parts gave 0.82 ± 0.08: rings of long waves have few modes.
    fs::write(folder.path().join("large.npy"), bytes(&cut(64, 304))).unwrap();
    let large = import(folder.path(), &[&["large.npy", "--json"], &TOLD[..]].concat());
    let large: Value = serde_json::from_str(&stdout(&large)).unwrap();
    let hurst = large["self_affine"]["hurst"].as_f64().unwrap();
    assert!((hurst - 0.8).abs() < 0.2, "{hurst}");
    assert!(answer["spectrum"].as_array().unwrap().len() > 10 && answer["summit_count"].as_u64().unwrap() > 5);
}

#[test]
fn e2e_an_import_overwrites_nothing() {
    let (folder, _) = imported();
    // In words, in eighty columns; nothing is written over, and a dry run writes nothing.
    let before = fs::read(folder.path().join("scan.h5")).unwrap();
    let refused = import(folder.path(), &[&["scan.npy"], &TOLD[..]].concat());
    assert!(code(&refused) == 1 && stderr(&refused).contains("the file exists\nhelp: use another --out, or --force"));
    let dry = import(folder.path(), &[&["scan.npy", "--dry-run", "--out", "other.h5"], &TOLD[..]].concat());
    assert!(code(&dry) == 0 && stdout(&dry).lines().all(|line| line.chars().count() <= 80), "{}", stdout(&dry));
    assert!(stdout(&dry).contains("  height factor 1e-9 m per number of the file\n"), "{}", stdout(&dry));
    assert!(!folder.path().join("other.h5").exists());
    assert_eq!(fs::read(folder.path().join("scan.h5")).unwrap(), before);
    // What was written is taken again without being told anything.
    let again = import(folder.path(), &["scan.h5", "--out", "again.h5"]);
    assert_eq!(code(&again), 0, "{}", stderr(&again));
    assert!(stdout(&again).contains("  height factor 1 (surface of this program, in metres)\n"), "{}", stdout(&again));
    // A factor in the file and its unit are one factor.
    let line = |row: ArrayView1<'_, f64>| row.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let lines: Vec<String> = part().rows().into_iter().map(line).collect();
    let text = format!("# height conversion factor (-> m): 2e-9\n# pixel size: 10 nm\n{}\n", lines.join("\n"));
    fs::write(folder.path().join("factor.txt"), text).unwrap();
    let factor = import(folder.path(), &["factor.txt", "--json", "--dry-run"]);
    assert_eq!(code(&factor), 0, "{}", stderr(&factor));
    let factor: Value = serde_json::from_str(&stdout(&factor)).unwrap();
    assert_eq!(factor["height_factor_m"], 2e-9);
    let second = read_header(&folder.path().join("again.h5")).unwrap();
    assert_eq!(second, read_header(&folder.path().join("scan.h5")).unwrap(), "it is taken as it is");
    // The scan itself is never written over, by whatever name, and what is no file is not either.
    fs::copy(folder.path().join("scan.h5"), folder.path().join("raw.h5")).unwrap();
    for arguments in [["raw.h5", "--out", "raw.h5", "--force"], ["raw.h5", "--out", "./raw.h5", "--force"]] {
        let output = import(folder.path(), &arguments);
        assert!(code(&output) == 1 && stderr(&output).contains("it is the source itself"), "{}", stderr(&output));
    }
    assert_eq!(fs::read(folder.path().join("raw.h5")).unwrap(), before);
    assert_eq!(code(&import(folder.path(), &["raw.h5"])), 0);
    assert!(folder.path().join("raw_taken.h5").exists());
    fs::create_dir(folder.path().join("folder")).unwrap();
    let output = import(folder.path(), &["raw.h5", "--out", "folder", "--force"]);
    assert!(code(&output) == 1 && stderr(&output).contains("it is not a regular file"), "{}", stderr(&output));
    // Units that cannot be right are doubted.
    let steep = import(folder.path(), &["scan.npy", "--dry-run", "--pixel-m", "1e-9", "--unit", "um"]);
    assert!(stdout(&steep).contains("warning: an rms slope of "), "{}", stdout(&steep));
}

/// The spec that `import` prints runs, inside the range of the model; one a hundred times softer is outside.
#[test]
fn e2e_the_printed_spec_is_inside_the_range() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scan.npy"), bytes(&part())).unwrap();
    let told = import(folder.path(), &[&["scan.npy"], &TOLD[..]].concat());
    assert_eq!(code(&told), 0, "{}", stderr(&told));
    let text = stdout(&told);
    assert!(text.contains("model range   U_el/Δγ ≥ 2 and U_1/Δγ ≥ 1, that is E*/Δγ ≥ "), "{text}");
    let printed = &text[text.find("name = ").unwrap()..];
    let table: toml::Table = printed.parse().unwrap();
    let modulus = table["material"]["contact_modulus_pa"].as_float().unwrap();
    let adhesion = table["material"]["work_of_adhesion_j_m2"].as_float().unwrap();
    let as_json = import(folder.path(), &[&["scan.npy", "--json", "--dry-run"], &TOLD[..]].concat());
    let answer: Value = serde_json::from_str(&stdout(&as_json)).unwrap();
    let number = |name: &str| answer[name].as_f64().unwrap();
    assert!(modulus / adhesion >= 1.5 * number("least_modulus_over_adhesion_1_m"), "{text}");
    // Cauchy and Schwarz: U_el is at most E* h_rms h'_rms/4.
    assert!(number("flattening_m") < 0.25 * number("rms_height_m") * number("rms_slope"));
    fs::write(folder.path().join("spec.toml"), printed).unwrap();
    let run = |more: &[&str], out: &str| {
        let arguments = [&["run", "spec.toml", "--until", "aggregate", "--out", out], more].concat();
        let output = Command::new(env!("CARGO_BIN_EXE_hysteron")).args(arguments).current_dir(folder.path()).output().unwrap();
        let cases = read_table(&folder.path().join(out).join("statistics/cases.parquet"), &schema::CASES).unwrap();
        let ratio = cases.f64_or_null("persson_tosatti_realised_mean").unwrap()[0].unwrap();
        (code(&output), cases.text("caution").unwrap()[0].to_owned(), ratio)
    };
    let (status, carried, ratio) = run(&[], "inside");
    assert!(status == 0 && !carried.contains("sticky") && !carried.contains("conformed"), "{status} {carried}");
    assert!((ratio * adhesion / (modulus * number("flattening_m")) - 1.0).abs() < 1e-9);
    let soft = format!("material.contact_modulus_pa={}", 0.01 * modulus);
    assert!(run(&["--set", &soft], "outside").1.starts_with("sticky"));
}

#[test]
fn e2e_a_scan_goes_through_all_stages() {
    let bench = Bench::new("");
    let scan = bench.folder.path().join("a scan.npy");
    fs::write(&scan, bytes(&part())).unwrap();
    let surface = |file: &Path| format!("file = {:?}\npixel_m = 12.5e-9\nunit = \"nm\"", file.to_str().unwrap());
    fs::write(bench.spec(), spec(&surface(&scan))).unwrap();
    let output = bench.verb("run", &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    assert_eq!(cases.text_or_null("surface_file").unwrap(), [Some("a scan.npy".to_owned())]);
    assert_eq!(cases.f64_or_null("hurst").unwrap(), [None]);
    assert_eq!(cases.f64_or_null("loss_dk_mean").unwrap(), [None]);
    assert!(cases.f64_or_null("loss_dk_realised_mean").unwrap()[0].unwrap() > 0.0);
    assert_eq!(cases.i64("planned_count").unwrap(), [1], "a measured surface is one surface");
    let header = read_header(&paths(&bench.out().join("surfaces"))[0]).unwrap();
    assert_eq!(cases.f64("rms_height_m").unwrap(), [header.rms_height_m]);
    assert_eq!(cases.f64("length_m").unwrap(), [header.length_m]);
    // Energy by the areas of the loop is that of its events.
    let loss = cases.f64_or_null("loss_mean").unwrap()[0].unwrap();
    assert!(loss > 0.0 && cases.f64_or_null("audit_gap_mean").unwrap()[0].unwrap() < 0.05);
    assert!(fs::read_to_string(bench.out().join("report.html")).unwrap().contains(">Measured surfaces</h2>"));
    // What flattens the roughness is summed over the modes that the surface has.
    let realizations = read_table(&bench.out().join("statistics/realizations.parquet"), &schema::REALIZATIONS).unwrap();
    let energy = |column: &str| realizations.f64_or_null(column).unwrap()[0];
    assert!(energy("persson_tosatti").is_none());
    assert!(
        energy("persson_tosatti_realised").unwrap() > energy("conformity_realised").unwrap()
            && energy("conformity_realised").unwrap() > 0.0
    );
    assert!(stdout(&bench.look("status", &[])).contains("Nothing is left to do."));
    // Its units are known by what the file holds: another name computes nothing, and a finished run does not need the file.
    let renamed = bench.folder.path().join("renamed").join("a scan.npy");
    fs::create_dir(renamed.parent().unwrap()).unwrap();
    fs::rename(&scan, &renamed).unwrap();
    assert!(stdout(&bench.look("status", &[])).contains("Nothing is left to do."));
    fs::write(bench.spec(), spec(&surface(&renamed))).unwrap();
    let planned = stdout(&bench.verb("plan", &[]));
    assert!(planned.contains("generate  1 done") && planned.contains("cycle     1 done"), "{planned}");
    // What was made of another file is left over when it is not asked for any more.
    let stale = bench.out().join("surfaces").join("scan_r00-0123abcd.h5");
    fs::copy(&paths(&bench.out().join("surfaces"))[0], &stale).unwrap();
    assert!(stdout(&bench.look("gc", &[])).contains("scan_r00-0123abcd.h5"));
    fs::remove_file(stale).unwrap();
    // Other heights do.
    fs::write(&renamed, bytes(&part().mapv(|h| 1.1 * h))).unwrap();
    let planned = stdout(&bench.verb("plan", &[]));
    assert!(planned.contains("generate  1 planned") && planned.contains("cycle     1 planned"), "{planned}");
    // A file that is not what [files] says is not taken for it.
    let text = fs::read_to_string(bench.out().join("campaign.toml")).unwrap().replace(scan.to_str().unwrap(), renamed.to_str().unwrap());
    fs::write(bench.spec(), text).unwrap();
    fs::remove_dir_all(bench.out()).unwrap();
    let output = bench.verb("run", &[]);
    assert!(code(&output) == 1 && stderr(&output).contains("the file differs from its checksum in [files]"), "{}", stderr(&output));
    // And one that is not there is told with its place in the spec.
    fs::write(bench.spec(), spec("file = \"no such scan.npy\"")).unwrap();
    let output = bench.verb("plan", &[]);
    assert_eq!(code(&output), 2);
    for words in ["the measured surface \"no such scan.npy\" cannot be read", "spec.toml:3:", "^", "(working directory)"] {
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
}

#[test]
fn e2e_what_is_no_surface_is_refused_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let fine = part();
    let mut holed = fine.clone();
    holed[[50, 50]] = f64::NAN;
    let lying = npy(1, &npy_line("<f8", "False", "(40000, 40000)"), &[0; 800]);
    let endless = npy(1, &npy_line("<f8", "False", "(0, 96)"), &[]);
    let cases: [(&str, Vec<u8>, &[&str], &str); 12] = [
        ("holed", bytes(&holed), &TOLD, "the number of missing points"),
        ("constant", bytes(&Array2::from_elem((64, 64), 5.0)), &TOLD, "its heights are constant"),
        ("tilted", bytes(&Array2::from_shape_fn((64, 64), |(i, j)| (i + 2 * j) as f64)), &TOLD, "nothing is left after levelling"),
        ("line", bytes(&Array2::zeros((1, 500))), &TOLD, "16 or more"),
        ("empty", endless, &TOLD, "zero|no points|empty|0 by"),
        ("lying", lying, &TOLD, "40000"),
        ("sizeless", bytes(&fine), &["--unit", "nm"], "no pixel size in the file"),
        ("unitless", bytes(&fine), &["--pixel-m", "1e-9"], "no unit of the heights in the file"),
        ("volts", bytes(&fine), &["--pixel-m", "1e-9", "--unit", "V"], "is not a unit of length\nhelp: use one of "),
        ("point", bytes(&fine), &["--pixel-m", "0", "--unit", "nm"], "--pixel-m is 0\nhelp: give a positive number of metres"),
        (
            "periodic",
            bytes(&fine),
            &["--pixel-m", "1e-9", "--unit", "nm", "--periodic"],
            "expected the number of columns for a periodic surface",
        ),
        ("noise", b"\x7fELF\x02\x01\x01".to_vec(), &[], "unknown file format"),
    ];
    for (name, bytes, arguments, words) in cases {
        fs::write(folder.path().join(name), bytes).unwrap();
        let output = import(folder.path(), &[&[name], arguments].concat());
        let said = stderr(&output);
        assert_eq!(code(&output), 1, "{name}: {said}");
        assert!(said.starts_with("error: cannot ") && said.lines().skip(1).all(|line| line.starts_with("help: ")), "{name}: {said}");
        assert!(words.split('|').any(|words| said.contains(words)), "{name}: {said}");
        assert!(!folder.path().join(name).with_extension("h5").exists(), "{name}");
    }
    let filled = import(folder.path(), &[&["holed", "--fill", "--dry-run"], &TOLD[..]].concat());
    assert!(stdout(&filled).contains("1 point, interpolated"), "{}", stdout(&filled));
}

/// A lying header and a zip bomb, with less memory than they ask for.
#[cfg(target_os = "linux")]
#[test]
fn e2e_no_file_fills_the_memory() {
    use super::make::{archive, main_xml};
    let folder = tempfile::tempdir().unwrap();
    let bomb = vec![0; 64 << 20];
    let xml = main_xml(["8", "8", "1"], "<DataType>D</DataType>", "");
    let parts = [("main.xml", xml.as_bytes()), ("bindata/data.bin", &bomb[..])];
    fs::write(folder.path().join("bomb.x3p"), archive(&parts, zip::CompressionMethod::Deflated)).unwrap();
    let xml = main_xml(["31623", "31623", "1"], "<DataType>D</DataType>", "");
    let parts = [("main.xml", xml.as_bytes()), ("bindata/data.bin", &bomb[..1000])];
    fs::write(folder.path().join("billion.x3p"), archive(&parts, zip::CompressionMethod::Deflated)).unwrap();
    fs::write(folder.path().join("billion.npy"), npy(1, &npy_line("<f8", "False", "(31623, 31623)"), &[0; 64])).unwrap();
    for name in ["bomb.x3p", "billion.x3p", "billion.npy"] {
        // Address space for the program and its threads, and far less than a billion heights.
        let script = "ulimit -v 2000000; exec \"$0\" import \"$1\" --unit m --pixel-m 1e-9";
        let output =
            Command::new("sh").args(["-c", script, env!("CARGO_BIN_EXE_hysteron"), name]).current_dir(folder.path()).output().unwrap();
        let said = stderr(&output);
        assert!(output.status.code() == Some(1) && said.starts_with("error: cannot "), "{name}: {:?} {said}", output.status);
        assert!(!said.contains("memory"), "{name}: {said}");
    }
}

#[test]
fn e2e_a_scan_that_cannot_be_taken_fails_alone() {
    let folder = tempfile::tempdir().unwrap();
    let there = |name: &str| folder.path().join(name).display().to_string();
    let mut holed = part();
    holed[[50, 50]] = f64::NAN;
    fs::write(there("holed.npy"), bytes(&holed)).unwrap();
    fs::write(there("words.csv"), "1.0,height\n1.0,2.0\n").unwrap();
    fs::write(there("scan.npy"), bytes(&part())).unwrap();
    let [bad, worse, good] = ["holed.npy", "words.csv", "scan.npy"].map(there);
    let text = spec(&format!("unit = \"nm\"\npixel_m = 12.5e-9\nfile = {bad:?}"));
    let bench = Bench::new(&format!("{text}[[sweep]]\nname = \"scans\"\nsurface.file = [{bad:?}, {worse:?}, {good:?}]\n"));
    for _ in 0..2 {
        let run = bench.verb("run", &[]);
        assert_eq!(code(&run), 3, "{}", stderr(&run));
        assert!(stdout(&run).contains("2 cycles failed"), "{}", stdout(&run));
        assert!(stdout(&run).contains("0/1") && stdout(&run).contains("1/1"), "{}", stdout(&run));
    }
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    assert_eq!(cases.row_count(), 3);
    let status = bench.look("status", &[]);
    assert!(
        stdout(&status).contains("2 failed") && stdout(&status).contains("missing points") && stdout(&status).contains("is not a number"),
        "{}",
        stdout(&status)
    );
    assert!(stdout(&status).contains("All other tasks are done. 2 cycles failed. "), "{}", stdout(&status));
    let retried = bench.look("retry", &[]);
    assert!(code(&retried) == 3 && stderr(&retried).matches(" failed: ").count() == 2, "{}", stderr(&retried));
    // The files are put right: they are other ones, and computed.
    fs::write(there("holed.npy"), bytes(&cut(8, 60))).unwrap();
    let rows: Vec<String> = part().rows().into_iter().map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>().join(",")).collect();
    fs::write(there("words.csv"), format!("# heights\n{}\n", rows.join("\n"))).unwrap();
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    assert!(bench.out().join("report.html").is_file());
}

/// Two scans of one name are told apart by the folders that they lie in.
#[test]
fn e2e_files_of_one_name_have_labels_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let paths = ["old", "new"].map(|name| {
        let place = folder.path().join(name);
        fs::create_dir(&place).unwrap();
        place.join("scan.npy").display().to_string()
    });
    fs::write(&paths[0], bytes(&part())).unwrap();
    fs::write(&paths[1], bytes(&cut(8, 60))).unwrap();
    let text = spec(&format!("unit = \"nm\"\npixel_m = 12.5e-9\nfile = {:?}", paths[0]));
    let bench = Bench::new(&format!("{text}[[sweep]]\nname = \"scans\"\nsurface.file = [{:?}, {:?}]\n", paths[0], paths[1]));
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    assert!(stdout(&run).contains("old/scan.npy") && stdout(&run).contains("new/scan.npy"), "{}", stdout(&run));
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    let mut labels = cases.text("surface_file").unwrap();
    labels.sort_unstable();
    assert_eq!(labels, ["new/scan.npy", "old/scan.npy"]);
}
