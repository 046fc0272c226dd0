//! The program about itself: manual pages, and what shells complete it with.

use super::{Fault, failed, make_folder, say};
use crate::cli::Arguments;
use clap::CommandFactory;
use clap_complete::Shell;
use std::path::Path;

pub(super) fn completions(shell: Shell) -> Result<u8, Fault> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "hysteron", &mut script);
    say(&String::from_utf8_lossy(&script))?;
    Ok(0)
}

/// The page of the program, or those of it and of every verb in a folder.
pub(super) fn man(folder: Option<&Path>) -> Result<u8, Fault> {
    let refused = |error: std::io::Error| failed(format!("cannot write the manual: {error}"));
    if let Some(folder) = folder {
        make_folder(folder)?;
        clap_mangen::generate_to(Arguments::command(), folder).map_err(refused)?;
        say(&format!("Written: {}\n", folder.display()))?;
        return Ok(0);
    }
    let mut page = Vec::new();
    clap_mangen::Man::new(Arguments::command()).render(&mut page).map_err(refused)?;
    say(&String::from_utf8_lossy(&page))?;
    Ok(0)
}
