//! Datasets of HDF5, opened only where the path to them and their values lie in the file itself.
//!
//! Virtual datasets, raw data in external storage and links to other files are refused before anything is read
//! through them. Results are keyed by the content of the file that is named, so a value from another file could change
//! without a trace; and another file can be a pipe that never ends, or a virtual dataset that contains itself.

use hdf5_metno::plist::dataset_create::Layout;
use hdf5_metno::{Dataset, File, Group, IndexType, IterationOrder, LinkType};

use super::error::Cause;

/// Groups at most that are searched for links to other files; a file with more has its soft links refused.
const MOST_GROUPS: usize = 4096;
/// Help for heights in another file.
const HELP: &str = "copy the heights into one file, as an ordinary dataset (h5repack, or h5py: f[\"heights\"] = g[\"heights\"][...])";

/// A dataset that is not in the file alone.
#[derive(Debug, thiserror::Error)]
#[error("its dataset {path:?} {why}\nhelp: {HELP}")]
pub(super) struct Outside {
    path: String,
    why: &'static str,
}

/// Opens a dataset by its path from the root; nothing if there is no dataset at that path.
///
/// # Errors
/// If the path or the values leave the file.
pub(super) fn dataset(file: &File, path: &str) -> Result<Option<Dataset>, Cause> {
    let parts: Vec<&str> = path.split('/').filter(|part| !part.is_empty() && *part != ".").collect();
    let mut group = Group::clone(file);
    for (at, part) in parts.iter().enumerate() {
        match link(&group, part)? {
            None => return Ok(None),
            Some(LinkType::External) => return Err(outside(path, "is reached through a link to another file")),
            // The library follows a soft link wherever it leads. It stays inside if the file has no link that leaves it.
            Some(LinkType::Soft) if links_outside(file)? => {
                return Err(outside(path, "is reached through a soft link, in a file with links to other files"));
            }
            Some(LinkType::Soft) => return own(&group, &parts[at..].join("/"), path),
            Some(LinkType::Hard) if at + 1 == parts.len() => return own(&group, part, path),
            Some(LinkType::Hard) => match group.group(part) {
                Ok(next) => group = next,
                Err(_) => return Ok(None),
            },
        }
    }
    Ok(None)
}

/// The kind of a link in a group, without following it.
fn link(group: &Group, name: &str) -> Result<Option<LinkType>, Cause> {
    let kind = |other: &str, info: hdf5_metno::LinkInfo| Ok((other == name).then_some(info.link_type));
    Ok(group.find_link(IndexType::Name, IterationOrder::Native, kind)?)
}

/// Opens a dataset, which reads none of its values, and checks where these are stored.
fn own(group: &Group, name: &str, path: &str) -> Result<Option<Dataset>, Cause> {
    let Ok(data) = group.dataset(name) else { return Ok(None) };
    let created = data.create_plist()?;
    if created.get_layout()? == Layout::Virtual {
        return Err(outside(path, "is a virtual dataset, whose values are in other datasets"));
    }
    if !created.get_external()?.is_empty() {
        return Err(outside(path, "has its values in external storage, which is another file"));
    }
    Ok(Some(data))
}

/// True if any link of the file leads to another file, or there are too many groups to tell.
fn links_outside(file: &File) -> Result<bool, Cause> {
    let mut known = vec![file.loc_info()?.token];
    let mut open = vec![Group::clone(file)];
    while let Some(group) = open.pop() {
        for (name, info) in group.links(IndexType::Name, IterationOrder::Native)? {
            match info.link_type {
                LinkType::External => return Ok(true),
                LinkType::Soft => {}
                LinkType::Hard => {
                    let Ok(inner) = group.group(&name) else { continue };
                    let token = inner.loc_info()?.token;
                    if !known.contains(&token) {
                        known.push(token);
                        open.push(inner);
                    }
                }
            }
        }
        if known.len() > MOST_GROUPS {
            return Ok(true);
        }
    }
    Ok(false)
}

fn outside(path: &str, why: &'static str) -> Cause {
    Outside { path: path.to_owned(), why }.into()
}
