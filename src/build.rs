//! Before the program is compiled: what it is compiled from and with, for the receipts of its units.

use std::path::Path;
use std::process::Command;

fn main() -> std::io::Result<()> {
    // Of `src` all but the Python package, which is a crate of its own.
    for entry in
        std::fs::read_dir("src").into_iter().flatten().flatten().filter(|entry| entry.file_name() != "python")
    {
        println!("cargo:rerun-if-changed={}", entry.path().display());
    }
    for path in [".git/HEAD", ".git/logs/HEAD", ".cargo_vcs_info.json"] {
        // A file that is not there would have this run every time.
        if Path::new(path).exists() {
            println!("cargo:rerun-if-changed={path}");
        }
    }
    println!("cargo:rustc-env=HYSTERON_COMMIT={}", commit().unwrap_or_default());
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let version =
        said(Command::new(compiler).arg("--version")).unwrap_or_else(|| "an unknown compiler".to_owned());
    let target = std::env::var("TARGET").unwrap_or_default();
    println!("cargo:rustc-env=HYSTERON_TOOLCHAIN={version}, {target}");
    println!("cargo:rerun-if-changed={TABLES}");
    guide(&Path::new(&std::env::var("OUT_DIR").unwrap_or_default()).join("guide"))
}

/// The page of the tables, which is not in the folder of the guide.
const TABLES: &str = "schemas/README.md";

/// Copies the pages of the guide with the links that they need as modules:
/// `model.md` becomes `../model/index.html`.
fn guide(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for entry in std::fs::read_dir("src/guide")? {
        let name = entry?.file_name();
        let above = if name == "index.md" { "" } else { "../" };
        std::fs::write(
            folder.join(&name),
            linked(&std::fs::read_to_string(Path::new("src/guide").join(&name))?, above),
        )?;
    }
    std::fs::write(folder.join("tables.md"), std::fs::read_to_string(TABLES)?)
}

fn linked(page: &str, above: &str) -> String {
    let mut parts = page.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |linked, part| linked + "](" + &to_module(part, above))
}

/// The text after the beginning of a link's target.
fn to_module(part: &str, above: &str) -> String {
    let Some((target, rest)) = part.split_once(')') else { return part.to_owned() };
    match target.split_once(".md") {
        Some(("../../schemas/README", anchor)) => format!("{above}tables/index.html{anchor}){rest}"),
        Some(("index", anchor)) => format!("{above}index.html{anchor}){rest}"),
        Some((page, anchor)) if !page.contains(['/', ':']) => {
            format!("{above}{page}/index.html{anchor}){rest}")
        }
        _ => part.to_owned(),
    }
}

/// The commit of this checkout, with a plus where files have been changed since; that of a released package;
/// or none.
fn commit() -> Option<String> {
    if Path::new(".git").exists() {
        let commit = said(Command::new("git").args(["rev-parse", "--short=12", "HEAD"]))?;
        let changed = said(Command::new("git").args(["status", "--porcelain", "--untracked-files=no"]))?;
        return Some(if changed.is_empty() { commit } else { format!("{commit}+") });
    }
    let text = std::fs::read_to_string(".cargo_vcs_info.json").ok()?;
    let hash = text.split_once("\"sha1\": \"")?.1;
    Some(hash.get(..12)?.to_owned())
}

fn said(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}
