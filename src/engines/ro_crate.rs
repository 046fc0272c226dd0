//! RO-Crate 1.2: a run described for a repository of research data.

use crate::campaign::Campaign;
use crate::store::{Kept, Receipt};
use serde_json::{Value, json};
use std::collections::BTreeMap;

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
    let strange = |c: char| c.is_whitespace() || c.is_control() || matches!(c, '<' | '>' | '"' | '\\' | '^' | '`' | '{' | '|' | '}');
    if ["https://", "http://"].iter().any(|scheme| lower.strip_prefix(scheme).is_some_and(|rest| rest.starts_with(char::is_alphanumeric))) {
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
        "--license {text:?} is no address and no SPDX identifier\nhelp: write an http(s) address, or an identifier such as CC-BY-4.0"
    ))
}

/// Receipts by version of the program and stage.
type Made<'a> = BTreeMap<(String, String), Vec<&'a Receipt>>;

/// `ro-crate-metadata.json` of a folder with these receipts, published on a day (`2026-01-31`), under a licence if one is given.
#[must_use]
pub fn metadata(campaign: &Campaign, receipts: &[Receipt], day: &str, licence: Option<&str>) -> String {
    let mut made = Made::new();
    for receipt in receipts {
        let version =
            receipt.made.commit.as_ref().map_or_else(|| receipt.made.version.clone(), |at| format!("{} ({at})", receipt.made.version));
        made.entry((version, receipt.stage.clone())).or_default().push(receipt);
    }
    let files: Vec<Value> = receipts.iter().flat_map(|receipt| &receipt.files).map(file).collect();
    let actions: Vec<Value> = made.iter().map(action).collect();
    let ids = |of: &[Value]| of.iter().map(|entity| json!({ "@id": entity["@id"] })).collect::<Vec<_>>();
    let mut root = json!({
        "@id": "./",
        "@type": "Dataset",
        "name": format!("{}: adhesive hysteresis of rough surfaces", campaign.spec.name),
        "description": "Loading and unloading of self-affine rough surfaces with interacting JKR asperities, computed with hysteron; \
                        the spec is campaign.toml, the columns of the tables are described in datapackage.json.",
        "datePublished": day,
        "hasPart": ids(&files),
        "mentions": ids(&actions),
    });
    if let Some(licence) = licence {
        root["license"] = json!({ "@id": licence });
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
    graph.extend(licence.map(|licence| json!({ "@id": licence, "@type": "CreativeWork", "name": licence })));
    graph.extend(files);
    graph.extend(programs(&made));
    graph.extend(actions);
    format!("{:#}\n", json!({ "@context": "https://w3id.org/ro/crate/1.2/context", "@graph": graph }))
}

/// A file of a receipt.
fn file(file: &Kept) -> Value {
    let kind = TYPES.iter().find(|(ending, _)| file.path.ends_with(ending)).map_or("application/octet-stream", |(_, kind)| kind);
    json!({
        "@id": file.path,
        "@type": "File",
        "name": file.path,
        "contentSize": file.size_bytes.to_string(),
        "encodingFormat": kind,
        "identifier": format!("blake3:{}", file.blake3),
    })
}

/// Versions of the program.
fn programs(made: &Made<'_>) -> Vec<Value> {
    let mut versions: Vec<&str> = made.keys().map(|(version, _)| version.as_str()).collect();
    versions.dedup();
    let entity =
        |version: &str| json!({ "@id": program(version), "@type": "SoftwareApplication", "name": "hysteron", "softwareVersion": version });
    versions.into_iter().map(entity).collect()
}

/// Creation of the files of a stage by a version of the program.
fn action(((version, stage), of): (&(String, String), &Vec<&Receipt>)) -> Value {
    let results: Vec<Value> = of.iter().flat_map(|receipt| &receipt.files).map(|file| json!({ "@id": file.path })).collect();
    let begun = of.iter().map(|receipt| receipt.made.began.as_str()).min().unwrap_or_default();
    json!({
        "@id": format!("#{stage}-{}", program(version).trim_start_matches('#')),
        "@type": "CreateAction",
        "name": stage,
        "startTime": begun,
        "instrument": { "@id": program(version) },
        "object": { "@id": "campaign.toml" },
        "result": results,
    })
}

/// The identity of a version of the program within the crate.
fn program(version: &str) -> String {
    let plain: String = version.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect();
    format!("#hysteron-{}", plain.trim_end_matches('-'))
}
