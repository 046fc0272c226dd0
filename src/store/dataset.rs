//! Datasets of HDF5, opened only where the path to them and their values lie in the file itself.
//!
//! Virtual datasets, raw data in external storage and links to other files are refused before anything is
//! read through them. Results are keyed by the content of the file that is named, so a value from another
//! file could change without a trace; and another file can be a pipe that never ends, or a virtual dataset
//! that contains itself.

use hdf5_metno::plist::dataset_create::Layout;
use hdf5_metno::{Dataset, File, Group, IndexType, IterationOrder, LinkType, LocationType};

use super::error::Cause;

/// Groups at most that are searched for links to other files; a file with more has its soft links refused.
const MOST_GROUPS: usize = 4096;
/// Refusals of links.
const EXTERNAL: &str = "is reached through a link to another file";
const SOFT: &str = "is reached through a soft link, in a file with links to other files";
/// Help for heights in another file.
const HELP: &str = "copy the heights into one file, as an ordinary dataset (h5repack, or h5py: \
     f[\"heights\"] = g[\"heights\"][...])";

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
            Some(LinkType::External) => return Err(outside(path, EXTERNAL)),
            Some(LinkType::Soft) => return soft(&group, &parts[at..].join("/"), path, links_outside(file)?),
            Some(LinkType::Hard) if at + 1 == parts.len() => return own(&group, part, path),
            Some(LinkType::Hard) => match group.group(part) {
                Ok(next) => group = next,
                Err(_) => return Ok(None),
            },
        }
    }
    Ok(None)
}

/// Fields in the root of a file.
pub(super) struct Fields {
    /// Names of the datasets with two dimensions, besides those with a single point.
    pub(super) names: Vec<String>,
    /// Refusal of a dataset that is not in the file alone.
    pub(super) outside: Option<Cause>,
    /// Links that were visited.
    pub(super) visits: u64,
}

/// Searches the root of a file for fields. Every link is visited once, however many there are.
pub(super) fn fields(file: &File) -> Result<Fields, Cause> {
    let mut found = Fields { names: Vec::new(), outside: None, visits: 0 };
    let mut leaves = None;
    for (name, info) in file.links(IndexType::Name, IterationOrder::Native)? {
        found.visits += 1;
        let opened = match info.link_type {
            LinkType::Hard
                if file.loc_type_by_name(&name).is_ok_and(|kind| kind != LocationType::Dataset) =>
            {
                continue;
            }
            LinkType::Hard => own(file, &name, &name),
            LinkType::External => Err(outside(&name, EXTERNAL)),
            LinkType::Soft => match leaves {
                Some(leaves) => soft(file, &name, &name, leaves),
                None => soft(file, &name, &name, *leaves.insert(links_outside(file)?)),
            },
        };
        match opened {
            Ok(Some(data)) if points(&data.get_shape()?).is_some() => found.names.push(name),
            Ok(_) => {}
            Err(cause) => found.outside = Some(cause),
        }
    }
    Ok(found)
}

/// Places of the two dimensions of a field; nothing without two. Dimensions of a single point, such as a
/// time, do not count beyond two.
pub(super) fn points(shape: &[usize]) -> Option<[usize; 2]> {
    let mut places: Vec<usize> = (0..shape.len()).collect();
    while let Some(single) =
        places.iter().position(|place| shape.get(*place) == Some(&1)).filter(|_| places.len() > 2)
    {
        places.remove(single);
    }
    places.try_into().ok()
}

/// Opens what a soft link leads to, if no link of the file leaves it.
fn soft(group: &Group, name: &str, path: &str, leaves: bool) -> Result<Option<Dataset>, Cause> {
    // The library follows a soft link wherever it leads. It stays inside if the file has no link that leaves
    // it.
    if leaves { Err(outside(path, SOFT)) } else { own(group, name, path) }
}

/// The kind of a link in a group, without following it.
fn link(group: &Group, name: &str) -> Result<Option<LinkType>, Cause> {
    let kind = |other: &str, info: hdf5_metno::LinkInfo| Ok((other == name).then_some(info.link_type));
    Ok(group.find_link(IndexType::Name, IterationOrder::Native, kind)?)
}

/// Opens a dataset, which reads none of its values, and checks where these are stored.
fn own(group: &Group, name: &str, path: &str) -> Result<Option<Dataset>, Cause> {
    let Ok(data) = group.dataset(name) else { return Ok(None) };
    check_storage(&data, path)?;
    Ok(Some(data))
}

/// Checks that the values of a dataset are in the file.
pub(super) fn check_storage(data: &Dataset, path: &str) -> Result<(), Cause> {
    let created = data.create_plist()?;
    if created.get_layout()? == Layout::Virtual {
        return Err(outside(path, "is a virtual dataset, whose values are in other datasets"));
    }
    if !created.get_external()?.is_empty() {
        return Err(outside(path, "has its values in external storage, which is another file"));
    }
    Ok(())
}

/// True if any link of the file leads to another file, or there are too many groups for a complete check.
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
                    if known.len() > MOST_GROUPS {
                        return Ok(true);
                    }
                }
            }
        }
    }
    Ok(false)
}

fn outside(path: &str, why: &'static str) -> Cause {
    Outside { path: path.to_owned(), why }.into()
}

/// The height field of SurfaceTopography, and its mask.
pub(super) const HEIGHTS: [&str; 2] = ["heights", "mask"];

/// Members or attributes of the root by which TopoStats marks its files, whose `image` has lines along x and
/// heights in nanometres.
const TOPOSTATS: [&str; 2] = ["topostats_file_version", "topostats_version"];

/// The name of the one two-dimensional dataset in the root. What leaves the file does not count, unless there
/// is nothing else.
pub(super) fn only_field(file: &File) -> Result<String, Cause> {
    let found = fields(file)?;
    let has = |name: &str| found.names.iter().any(|other| other == name);
    match (&found.names[..], found.outside) {
        ([name], _) => Ok(name.clone()),
        ([], Some(cause)) => Err(cause),
        ([], None) => Err(
            "no two-dimensional dataset in the root\nhelp: select one of another group as \"group/dataset\""
                .into(),
        ),
        (_, _) if has("image") && is_topostats(file) => Ok("image".to_owned()),
        (many, _) if many.iter().all(|name| HEIGHTS.contains(&name.as_str())) => Ok(HEIGHTS[0].to_owned()),
        (many, _) => Err(format!(
            "several two-dimensional datasets: {}\nhelp: select one with surface.dataset (--dataset)",
            many.join(", ")
        )
        .into()),
    }
}

pub(super) fn is_topostats(file: &File) -> bool {
    TOPOSTATS.iter().any(|name| file.link_exists(name) || file.attr(name).is_ok())
}
