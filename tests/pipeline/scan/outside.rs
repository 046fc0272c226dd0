//! HDF5 files whose heights are in another file.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::scan::read_heights;
use hdf5_metno::File;
use hdf5_metno::plist::dataset_create::Layout;
use hysteron::store::hdf5::{SurfaceHeader, check_inside, read_header, read_surface, write_surface};
use ndarray::{Array2, s};

/// Points along a side.
const N: usize = 24;

fn heights() -> Array2<f64> {
    Array2::from_shape_fn((N, N), |(i, j)| 1e-7 * ((0.7 * i as f64).sin() + (0.4 * j as f64).cos()))
}

/// An ordinary file with the heights, as `h` and as `group/h`.
fn good(path: &Path) {
    let file = File::create(path).unwrap();
    for name in ["h", "group/h"] {
        let data = file.new_dataset::<f64>().shape((N, N)).create(name).unwrap();
        data.write(&heights()).unwrap();
    }
    file.close().unwrap();
}

/// A file with a virtual dataset `h` of the `h` of another file.
fn virtual_dataset(path: &Path, source: &str) {
    let file = File::create(path).unwrap();
    file.new_dataset::<f64>().shape((N, N)).virtual_map(source, "/h", (N, N), (.., ..), (N, N), (.., ..)).create("h").unwrap();
    file.close().unwrap();
}

fn external(path: &Path, storage: &str) {
    let file = File::create(path).unwrap();
    file.new_dataset::<f64>().no_chunk().shape((N, N)).external(storage, 0, 8 * N * N).create("h").unwrap();
    file.close().unwrap();
}

/// Files whose heights are elsewhere, each with words of its refusal.
fn outside(folder: &Path) -> Vec<(PathBuf, &'static str, &'static str)> {
    let at = |name: &str| folder.join(name);
    let text = |name: &str| at(name).to_str().unwrap().to_owned();
    good(&at("good.h5"));
    fs::write(at("raw.bin"), heights().iter().flat_map(|h| h.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    external(&at("external.h5"), &text("raw.bin"));
    virtual_dataset(&at("virtual.h5"), "good.h5");
    virtual_dataset(&at("itself.h5"), "itself.h5");
    virtual_dataset(&at("same.h5"), ".");
    let file = File::create(at("link.h5")).unwrap();
    file.link_external("good.h5", "/h", "h").unwrap();
    file.close().unwrap();
    let file = File::create(at("group.h5")).unwrap();
    file.link_external("good.h5", "/group", "of").unwrap();
    file.close().unwrap();
    let file = File::create(at("soft.h5")).unwrap();
    file.link_external("good.h5", "/", "elsewhere").unwrap();
    file.link_soft("/elsewhere/h", "h").unwrap();
    file.close().unwrap();
    let (storage, link, own) = ("external storage", "link to another file", "virtual dataset");
    let files = [
        ("external.h5", "h", storage),
        ("virtual.h5", "h", own),
        ("itself.h5", "h", own),
        ("same.h5", "h", own),
        ("link.h5", "h", link),
        ("group.h5", "of/h", link),
        ("soft.h5", "h", "soft link, in a file with links to other files"),
    ];
    files.into_iter().map(|(name, dataset, words)| (at(name), dataset, words)).collect()
}

#[test]
fn law_heights_in_another_file_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (path, dataset, words) in outside(folder.path()) {
        // By name, and as the only field of the root where the name is in the root.
        let names = if dataset.contains('/') { vec![Some(dataset)] } else { vec![Some(dataset), None] };
        for name in names {
            let said = read_heights(&path, name).unwrap_err().to_string();
            assert!(said.contains(words) && said.contains("\nhelp: copy the heights into one file"), "{}: {said}", path.display());
            assert!(check_inside(&path, name).unwrap_err().contains(words), "{}", path.display());
        }
    }
}

#[test]
fn law_heights_in_the_file_itself_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.h5");
    good(&path);
    let file = File::open_rw(&path).unwrap();
    file.link_soft("/group/h", "soft").unwrap();
    file.link_soft("/group", "softgroup").unwrap();
    file.link_hard("/group", "group/loop").unwrap();
    file.new_dataset::<f64>().shape((N, N)).chunk((8, 8)).create("chunked").unwrap().write(&heights()).unwrap();
    let data = file.new_dataset::<f64>().shape((4, N)).layout(Layout::Compact).create("compact").unwrap();
    data.write(&heights().slice(s![..4, ..]).to_owned()).unwrap();
    drop(data);
    file.close().unwrap();
    for name in ["h", "/h", "group/h", "//group//./h", "soft", "softgroup/h", "group/loop/loop/h", "chunked"] {
        assert_eq!(read_heights(&path, Some(name)).unwrap(), heights(), "{name}");
        assert_eq!(check_inside(&path, Some(name)), Ok(()), "{name}");
    }
    assert_eq!(read_heights(&path, Some("compact")).unwrap(), heights().slice(s![..4, ..]));
    for name in ["none", "group", "h/h", "", "/", "group/none"] {
        let said = read_heights(&path, Some(name)).unwrap_err().to_string();
        assert!(said.contains("no dataset"), "{name}: {said}");
    }
    // A link to another file beside the only field does not count, and soft links then do.
    let path = folder.path().join("beside.h5");
    let file = File::create(&path).unwrap();
    file.new_dataset::<f64>().shape((N, N)).create("h").unwrap().write(&heights()).unwrap();
    file.link_external("scan.h5", "/h", "a").unwrap();
    file.link_soft("/h", "soft").unwrap();
    file.close().unwrap();
    assert_eq!(read_heights(&path, None).unwrap(), heights());
    assert!(read_heights(&path, Some("soft")).unwrap_err().to_string().contains("soft link"));
}

#[test]
fn law_own_surfaces_have_their_heights_inside() {
    let folder = tempfile::tempdir().unwrap();
    let (path, raw) = (folder.path().join("own.h5"), folder.path().join("raw.bin"));
    let header = SurfaceHeader {
        length_m: 1e-3,
        realization: 0,
        periodic: true,
        key: "k".to_owned(),
        rms_height_m: 1e-6,
        rms_slope: 0.1,
        rms_curvature_1_m: 1e4,
        nayak_parameter: 5.0,
        generated: None,
        measured: None,
    };
    write_surface(&path, &header, heights().view()).unwrap();
    assert_eq!((read_header(&path).unwrap(), check_inside(&path, None)), (header, Ok(())));
    fs::write(&raw, vec![0; 8 * N * N]).unwrap();
    let file = File::open_rw(&path).unwrap();
    file.unlink("height_m").unwrap();
    file.new_dataset::<f64>().no_chunk().shape((N, N)).external(raw.to_str().unwrap(), 0, 8 * N * N).create("height_m").unwrap();
    file.close().unwrap();
    for said in
        [read_surface(&path).unwrap_err().to_string(), read_header(&path).unwrap_err().to_string(), check_inside(&path, None).unwrap_err()]
    {
        assert!(said.contains("external storage"), "{said}");
    }
}

/// Runs the program, which is to end within a minute; it would wait for ever for a pipe.
fn ends(command: &mut Command) -> Output {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let since = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if since.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("it waits");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.wait_with_output().unwrap()
}

/// `import`, `plan` and `run` refuse them, and do not wait for a pipe.
#[cfg(all(unix, feature = "stats"))]
#[test]
fn e2e_no_command_follows_heights_to_another_file() {
    use crate::bench::{Bench, code, stderr};
    let bench = Bench::new("");
    let mut files = outside(bench.folder.path());
    let pipe = bench.folder.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    external(&bench.folder.path().join("pipe.h5"), pipe.to_str().unwrap());
    let file = File::create(bench.folder.path().join("pipelink.h5")).unwrap();
    file.link_external(pipe.to_str().unwrap(), "/h", "h").unwrap();
    file.close().unwrap();
    files.push((bench.folder.path().join("pipe.h5"), "h", "external storage"));
    files.push((bench.folder.path().join("pipelink.h5"), "h", "link to another file"));
    for (path, dataset, words) in files {
        let mut import = Command::new(env!("CARGO_BIN_EXE_hysteron"));
        import.arg("import").arg(&path).args(["--dataset", dataset, "--pixel-m", "1e-7", "--unit", "m", "--dry-run"]);
        let output = ends(&mut import);
        assert!(code(&output) == 1 && stderr(&output).contains(words), "{}: {}", path.display(), stderr(&output));
        let text = format!(
            "name = \"x\"\n[surface]\nfile = {path:?}\ndataset = {dataset:?}\npixel_m = 1e-7\nunit = \"m\"\n[model]\nboundary = \"isolated\"\n"
        );
        fs::write(bench.spec(), text).unwrap();
        for verb in ["plan", "run"] {
            let output = ends(&mut bench.command(verb));
            assert_eq!(code(&output), 2, "{verb} {}: {}", path.display(), stderr(&output));
            let said = stderr(&output);
            assert!(
                said.contains(words) && said.contains("spec.toml:3:") && said.contains("copy the heights into one file"),
                "{verb}: {said}"
            );
        }
    }
    assert!(!bench.out().exists(), "nothing is begun");
}
