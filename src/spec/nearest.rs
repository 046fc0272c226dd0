//! The known word nearest to an unknown one.

use strsim::osa_distance;

/// The known word that was probably meant, if one is near enough to be worth saying.
pub(super) fn nearest<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Longer than any key with its table: no typing error, and the distance costs the product of the lengths.
    if unknown.chars().count() > 64 {
        return None;
    }
    let unknown = unknown.to_lowercase();
    let allowed = (unknown.chars().count() / 3).max(1);
    let mut best: Option<(usize, &str)> = None;
    for word in known {
        let distance = osa_distance(&unknown, &word.to_lowercase());
        // `length` for `length_m`, `points` for `points_per_shortest_wavelength`: half a key is a good hint,
        // but a weaker one.
        let begun = unknown.len() >= 3 && word.starts_with(&unknown);
        let rank = if distance <= allowed { distance } else { allowed + 1 };
        if (distance <= allowed || begun) && best.is_none_or(|(least, _)| rank < least) {
            best = Some((rank, word));
        }
    }
    best.map(|(_, word)| word)
}
