//! The key of a unit of work: a hash of exactly what the unit reads.
//!
//! It is the hash of a canonical JSON of: the version of this scheme, the stage, a number of the stage's
//! meaning (raised by hand when the stage's results change), the parameters that the stage reads with every
//! default written out, and the keys of what it reads. Program version, host, threads and clock are no part
//! of it, so a new release does not make finished data stale in silence.

use serde_json::{Value, json};

/// Version of this scheme.
const SCHEME: u32 = 1;

/// Text whose hash is the key of a task.
#[must_use]
pub fn preimage(stage: &str, meaning: u32, reads: &Value) -> Value {
    json!({ "scheme": SCHEME, "stage": stage, "meaning": meaning, "reads": reads })
}

/// Key of a task from inputs that are canonical JSON: 64 hexadecimal digits.
#[must_use]
pub fn key_of_text(stage: &str, meaning: u32, reads: &str) -> String {
    let text =
        format!("{{\"meaning\":{meaning},\"reads\":{reads},\"scheme\":{SCHEME},\"stage\":\"{stage}\"}}");
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// BLAKE3 of a regular file's contents, 64 hexadecimal digits.
///
/// # Errors
/// Error of the system, or a file that is not regular.
pub fn digest_of_file(path: &std::path::Path) -> std::io::Result<String> {
    // What is no file, such as a pipe or a device, might not end.
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is no regular file"));
    }
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(std::fs::File::open(path)?)?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// First digits of a key, as used in ids.
#[must_use]
pub fn short(key: &str) -> &str {
    key.get(..8).unwrap_or(key)
}

/// JSON with sorted names and without white space.
#[must_use]
pub fn canonical(value: &Value) -> String {
    let mut text = String::new();
    append(value, &mut text);
    text
}

fn append(value: &Value, text: &mut String) {
    match value {
        Value::Array(items) => {
            text.push('[');
            for (k, item) in items.iter().enumerate() {
                if k > 0 {
                    text.push(',');
                }
                append(item, text);
            }
            text.push(']');
        }
        Value::Object(members) => {
            let mut names: Vec<&String> = members.keys().collect();
            names.sort();
            text.push('{');
            for (k, name) in names.into_iter().enumerate() {
                if k > 0 {
                    text.push(',');
                }
                text.push_str(&Value::from(name.as_str()).to_string());
                text.push(':');
                append(&members[name], text);
            }
            text.push('}');
        }
        plain => text.push_str(&plain.to_string()),
    }
}
