//! The values at the top of a spec: its name, its seed, how often.

use toml::de::DeValue;

use super::fault::Faults;
use super::number::integer;
use super::written::{Written, wrong_type};

/// Seed of a spec that states none.
pub(super) const DEFAULT_SEED: u64 = 2021;

/// The seed of the campaign.
pub(super) fn seed(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<u64> {
    let found = integer("seed", value, faults)?;
    let seed = u64::try_from(found).ok();
    if seed.is_none() {
        let message = format!("`seed` cannot be {found}: it must be from 0 to {}", i64::MAX);
        let help = "every such number gives other surfaces, and one number the same again".to_owned();
        faults.add(&value.span(), message, help);
    }
    seed
}

/// A name that can name a folder on every system.
pub(super) fn name(of: &str, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<String> {
    let span = value.span();
    let DeValue::String(found) = value.get_ref() else {
        let help = "write it in quotes".to_owned();
        wrong_type(of, "a string", value.get_ref(), &span, help, faults);
        return None;
    };
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if (1..=64).contains(&found.len()) && found.chars().all(allowed) {
        return Some(found.to_string());
    }
    let message = format!("`{of}` cannot be {}: it names a folder or a table row", faults.written(&span));
    faults.add(&span, message, "use 1 to 64 letters A-Z or a-z, digits, - and _".to_owned());
    None
}
