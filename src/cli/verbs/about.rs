//! Schemas, templates of specs, manual pages and completion scripts.

use super::outputs::{may_replace, written};
use super::{Fault, failed, make_folder, say};
use crate::cli::templates::Template;
use crate::cli::{Arguments, GUIDE, generated};
use crate::text::shown;
use clap::CommandFactory;
use clap_complete::Shell;
use std::path::{Path, PathBuf};

/// Prints a template, or the list of them. A file that the template names is written into the working
/// directory, unless there is one of this name.
pub(super) fn init(template: Template, list: bool) -> Result<u8, Fault> {
    let line = |(_, name, purpose): &(Template, &str, &str)| format!("{name:12} {purpose}\n");
    let text = if list { Template::ALL.iter().map(line).collect() } else { template.text().to_owned() };
    if let Some((name, content)) = template.example().filter(|_| !list) {
        if Path::new(name).exists() {
            eprintln!("{name} exists and was not replaced");
        } else {
            written("write the example", &[(PathBuf::from(name), content.as_bytes().to_vec())])?;
            eprintln!("Written: {name}");
        }
    }
    say(&text)?;
    Ok(0)
}

pub(super) fn completions(shell: Shell) -> Result<u8, Fault> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "hysteron", &mut script);
    say(&String::from_utf8_lossy(&script))?;
    Ok(0)
}

/// Prints the schemas or one generated file, or writes all of them.
pub(super) fn schemas(file: Option<&str>, write: bool, force: bool) -> Result<u8, Fault> {
    let files = generated();
    if write {
        // Only a clone has pages to renew.
        let is_clone = Path::new(GUIDE).is_dir();
        let wanted = files.into_iter().filter(|(path, _)| !path.starts_with(GUIDE) || is_clone);
        let files: Vec<(PathBuf, Vec<u8>)> =
            wanted.map(|(path, content)| (path, content.into_bytes())).collect();
        may_replace("a schema", &files, force || is_clone)?;
        files.iter().try_for_each(|(path, _)| make_folder(path.parent().unwrap_or(path)))?;
        written("write a schema", &files)?;
        return Ok(0);
    }
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let chosen = |path: &Path| {
        file.map_or_else(|| path.extension().is_some_and(|end| end == "json"), |file| name(path) == file)
    };
    let chosen: Vec<_> =
        files.iter().filter(|(path, _)| chosen(path)).map(|(_, content)| content.as_str()).collect();
    if chosen.is_empty() {
        let names: Vec<String> = files.iter().map(|(path, _)| name(path)).collect();
        return Err(failed(format!(
            "unknown file {}\nhelp: one of {}",
            file.unwrap_or_default(),
            names.join(", ")
        )));
    }
    // A single file is printed with its own bytes.
    say(&if file.is_some() {
        chosen.concat()
    } else {
        chosen.iter().map(|content| format!("{content}\n")).collect()
    })?;
    Ok(0)
}

/// Beginning of a manual page of the program.
const PAGE_MARK: &str = "\n.TH hysteron";

/// The manual pages of the program and of all commands, in a folder.
fn pages(folder: &Path) -> std::io::Result<Vec<(PathBuf, Vec<u8>)>> {
    fn enter(
        command: &clap::Command,
        folder: &Path,
        pages: &mut Vec<(PathBuf, Vec<u8>)>,
    ) -> std::io::Result<()> {
        for inner in command.get_subcommands().filter(|inner| !inner.is_hide_set()) {
            enter(inner, folder, pages)?;
        }
        let page = clap_mangen::Man::new(command.clone());
        let mut text = Vec::new();
        page.render(&mut text)?;
        pages.push((folder.join(page.get_filename()), text));
        Ok(())
    }
    let mut all = Arguments::command().disable_help_subcommand(true);
    all.build();
    let mut pages = Vec::new();
    enter(&all, folder, &mut pages)?;
    Ok(pages)
}

/// The page of the program or of a command, or all of them in a folder.
pub(super) fn man(verb: Option<&str>, folder: Option<&Path>, force: bool) -> Result<u8, Fault> {
    let refused = |error: std::io::Error| failed(format!("cannot write the manual: {error}"));
    if let Some(folder) = folder {
        let pages = pages(folder).map_err(refused)?;
        let is_own = |path: &Path| std::fs::read_to_string(path).is_ok_and(|text| text.contains(PAGE_MARK));
        let others: Vec<_> = pages.iter().filter(|(path, _)| !is_own(path)).cloned().collect();
        may_replace("a page", &others, force)?;
        make_folder(folder)?;
        written("write a page", &pages)?;
        say(&format!("Written: {}\n", shown(folder)))?;
        return Ok(0);
    }
    let mut all = Arguments::command();
    all.build();
    let of = match verb {
        None => all,
        Some(verb) => {
            let verbs: Vec<&str> = all.get_subcommands().map(clap::Command::get_name).collect();
            let allowed = verbs.join(", ");
            let found = all.find_subcommand(verb).cloned();
            found.ok_or_else(|| failed(format!("unknown command {verb}\nhelp: name one of {allowed}")))?
        }
    };
    let mut page = Vec::new();
    clap_mangen::Man::new(of).render(&mut page).map_err(refused)?;
    say(&String::from_utf8_lossy(&page))?;
    Ok(0)
}
