//! RO-Crate 1.2: a run described for a repository of research data.

use crate::campaign::Campaign;
use crate::schema::TABLES;
use crate::store::{Kept, Receipt};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Address of the program: `documentation` of Cargo.toml.
const ADDRESS: &str = "https://docs.rs/hysteron";

/// The type of a file by its ending.
const TYPES: [(&str, &str); 6] = [
    (".parquet", "application/vnd.apache.parquet"),
    (".h5", "application/x-hdf5"),
    (".svg", "image/svg+xml"),
    (".html", "text/html"),
    (".json", "application/json"),
    (".toml", "application/toml"),
];

/// The address of a licence: itself, or the page of an SPDX identifier.
///
/// # Errors
/// If it is neither: problem and help.
pub fn licence(text: &str) -> Result<String, String> {
    let lower = text.to_ascii_lowercase();
    let strange = |c: char| {
        c.is_whitespace()
            || c.is_control()
            || matches!(c, '<' | '>' | '"' | '\\' | '^' | '`' | '{' | '|' | '}')
    };
    if ["https://", "http://"]
        .iter()
        .any(|scheme| lower.strip_prefix(scheme).is_some_and(|rest| rest.starts_with(char::is_alphanumeric)))
    {
        if !text.contains(strange) {
            return Ok(text.to_owned());
        }
    } else if text.starts_with(|c: char| c.is_ascii_alphanumeric())
        && text.len() <= 64
        && text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '+'))
    {
        return Ok(format!("https://spdx.org/licenses/{text}"));
    }
    Err(format!(
        "--license {text:?} is no address and no SPDX identifier\nhelp: write an http(s) address, or an \
         identifier such as CC-BY-4.0"
    ))
}

/// Identity of the publisher within the crate.
const PUBLISHER: &str = "#publisher";

/// Receipts by version of the program and stage.
type Made<'a> = BTreeMap<(String, String), Vec<&'a Receipt>>;

/// Facts of a publication that the run does not hold.
#[derive(Debug, Clone, Copy, Default)]
pub struct Publication<'a> {
    /// Day (`2026-01-31`).
    pub day: &'a str,
    /// Address of the licence.
    pub licence: Option<&'a str>,
    /// Name or address of the publishing organization.
    pub publisher: Option<&'a str>,
}

/// `ro-crate-metadata.json` of a folder with these receipts.
#[must_use]
pub fn metadata(campaign: &Campaign, receipts: &[Receipt], publication: &Publication<'_>) -> String {
    let mut made = Made::new();
    for receipt in receipts {
        let version = receipt
            .made
            .commit
            .as_ref()
            .map_or_else(|| receipt.made.version.clone(), |at| format!("{} ({at})", receipt.made.version));
        made.entry((version, receipt.stage.clone())).or_default().push(receipt);
    }
    let files: Vec<Value> = receipts.iter().flat_map(|receipt| &receipt.files).map(file).collect();
    let actions: Vec<Value> = made.iter().map(action).collect();
    let ids = |of: &[Value]| of.iter().map(|entity| json!({ "@id": entity["@id"] })).collect::<Vec<_>>();
    let mut root = json!({
        "@id": "./",
        "@type": "Dataset",
        "name": format!("{}: adhesive hysteresis of rough surfaces", campaign.spec.name),
        "description": "Loading and unloading of self-affine rough surfaces with interacting JKR asperities, \
                        computed with hysteron; the spec is campaign.toml, the columns of the tables are \
                        described in datapackage.json.",
        "datePublished": publication.day,
        "hasPart": one_or_list(ids(&files)),
        "mentions": one_or_list(ids(&actions)),
    });
    if let Some(licence) = publication.licence {
        root["license"] = json!({ "@id": licence });
    }
    let publisher = publication.publisher.map(organization);
    if let Some(publisher) = &publisher {
        root["publisher"] = json!({ "@id": publisher["@id"] });
    }
    let mut graph = vec![
        json!({
            "@id": "ro-crate-metadata.json",
            "@type": "CreativeWork",
            "conformsTo": { "@id": "https://w3id.org/ro/crate/1.2" },
            "about": { "@id": "./" },
        }),
        root,
    ];
    graph.extend(publication.licence.map(|licence| {
        let name = licence.rsplit('/').find(|part| !part.is_empty()).unwrap_or(licence);
        let description = format!("Licence of all files of this crate: {licence}");
        json!({ "@id": licence, "@type": "CreativeWork", "name": name, "description": description })
    }));
    graph.extend(publisher);
    graph.extend(files);
    graph.extend(programs(&made));
    graph.extend(actions);
    format!("{:#}\n", json!({ "@context": "https://w3id.org/ro/crate/1.2/context", "@graph": graph }))
}

/// The publisher, by its name or by its address, for example a ROR identifier.
fn organization(publisher: &str) -> Value {
    let is_address = ["https://", "http://"].iter().any(|scheme| publisher.starts_with(scheme));
    if is_address {
        return json!({ "@id": publisher, "@type": "Organization", "name": publisher, "url": publisher });
    }
    json!({ "@id": PUBLISHER, "@type": "Organization", "name": publisher })
}

/// A file of a receipt.
fn file(file: &Kept) -> Value {
    let kind = TYPES
        .iter()
        .find(|(ending, _)| file.path.ends_with(ending))
        .map_or("application/octet-stream", |(_, kind)| kind);
    json!({
        "@id": file.path,
        "@type": "File",
        "name": file.path,
        "description": description(&file.path),
        "contentSize": file.size_bytes.to_string(),
        "encodingFormat": kind,
        "identifier": format!("blake3:{}", file.blake3),
    })
}

/// Content of a file of a run, by its place.
fn description(path: &str) -> &'static str {
    let fits = |pattern: &str| match pattern.split_once("<id>") {
        Some((before, after)) => path.starts_with(before) && path.ends_with(after),
        None => path == pattern,
    };
    if let Some(table) = TABLES.iter().find(|table| fits(table.file)) {
        return table.doc;
    }
    const OTHERS: [(&str, &str); 8] = [
        ("campaign.toml", "Spec of the run with all defaults written out"),
        ("datapackage.json", "Description of all tables and surfaces (Data Package standard)"),
        ("report.html", "Report with results, figures and model validity"),
        ("surfaces/<id>.h5", "Height field of a surface, with its parameters as attributes"),
        ("cycles/<id>/maps.h5", "Maps of gap and pressure of a cycle"),
        ("cycles/<id>", "File of a cycle"),
        ("schemas/<id>", "Columns of a table: type, unit and definition (Table Schema)"),
        ("figures/<id>", "Figure of the report"),
    ];
    OTHERS.iter().find(|(pattern, _)| fits(pattern)).map_or("File of the run", |(_, description)| description)
}

/// Versions of the program.
fn programs(made: &Made<'_>) -> Vec<Value> {
    let mut versions: Vec<&str> = made.keys().map(|(version, _)| version.as_str()).collect();
    versions.dedup();
    let entity = |version: &str| {
        json!({
            "@id": program(version),
            "@type": "SoftwareApplication",
            "name": "hysteron",
            "url": ADDRESS,
            "version": version,
            "softwareVersion": version,
        })
    };
    versions.into_iter().map(entity).collect()
}

/// Creation of the files of a stage by a version of the program.
fn action(((version, stage), of): (&(String, String), &Vec<&Receipt>)) -> Value {
    let results =
        of.iter().flat_map(|receipt| &receipt.files).map(|file| json!({ "@id": file.path })).collect();
    let begun = of.iter().map(|receipt| receipt.made.began.as_str()).min().unwrap_or_default();
    json!({
        "@id": format!("#{stage}-{}", program(version).trim_start_matches('#')),
        "@type": "CreateAction",
        "name": stage,
        "startTime": begun,
        "instrument": { "@id": program(version) },
        "object": { "@id": "campaign.toml" },
        "result": one_or_list(results),
    })
}

/// A list of one is no list in the form of JSON-LD that crates have.
fn one_or_list(mut values: Vec<Value>) -> Value {
    if values.len() == 1 { values.remove(0) } else { json!(values) }
}

/// The identity of a version of the program within the crate.
fn program(version: &str) -> String {
    let plain: String =
        version.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect();
    format!("#hysteron-{}", plain.trim_end_matches('-'))
}

#[cfg(test)]
mod tests {
    use super::ADDRESS;

    #[test]
    fn law_the_address_is_that_of_the_package() {
        let package = include_str!("../../Cargo.toml");
        assert!(package.contains(&format!("documentation = \"{ADDRESS}\"\n")));
    }
}
