//! Checks of the shape of a generated surface's spectrum: roll-off, longest wavelength and table.

use std::ops::Range;

use super::fault::Faults;
use super::keys::{OF_TABLE, REPLACED, find};
use super::number::short;
use super::origin::{Origin, written};
use crate::model::GeneratedSurface;

/// The later written of some values of the surface; nothing if one of them has a fault of its own.
pub(super) fn blamed(keys: &[&str], origins: &[Origin]) -> Option<Range<usize>> {
    let places: Vec<usize> = keys.iter().filter_map(|name| find("surface", name)).collect();
    if places.iter().any(|place| matches!(origins[*place], Origin::Faulty)) {
        return None;
    }
    places.into_iter().filter_map(|place| written(Some(place), origins)).max_by_key(|span| span.start)
}

/// Checks a generated surface's spectrum; `swept` are the keys of the sweep.
pub(super) fn check_spectrum(
    surface: &GeneratedSurface,
    (origins, swept): (&[Origin], &[usize]),
    faults: &mut Faults<'_>,
) {
    let shortest = surface.length_m / f64::from(surface.magnification);
    let longest = surface.longest_wavelength_m.unwrap_or(surface.length_m);
    let band = ["longest_wavelength_m", "length_m", "magnification"];
    if (longest > surface.length_m || longest < 2.0 * shortest)
        && let Some(span) = blamed(&band, origins)
    {
        let message = format!(
            "`surface.longest_wavelength_m` cannot be {} m: it must be from {} m, two shortest wavelengths, \
             to {} m, the side of the square",
            short(longest),
            short(2.0 * shortest),
            short(surface.length_m)
        );
        let help = "the shortest wavelength is length_m/magnification".to_owned();
        faults.add(&span, message, help);
    }
    if let Some(roll_off) = surface.roll_off_m
        && (roll_off >= longest || roll_off <= shortest)
        && let Some(span) = blamed(&["roll_off_m", band[0], band[1], band[2]], origins)
    {
        let message = format!(
            "`surface.roll_off_m` cannot be {} m: it must be between the shortest wavelength, {} m, and the \
             longest, {} m",
            short(roll_off),
            short(shortest),
            short(longest)
        );
        let help = "a plateau needs a square that is larger than roll_off_m; 0 for no roll-off".to_owned();
        faults.add(&span, message, help);
    }
    check_table(surface, (origins, swept), faults);
}

/// Refuses keys that a tabulated spectrum replaces, and keys of a table without one.
fn check_table(surface: &GeneratedSurface, (origins, swept): (&[Origin], &[usize]), faults: &mut Faults<'_>) {
    let of_sweep = |name: &str| find("surface", name).is_some_and(|key| swept.contains(&key));
    if matches!(find("surface", "spectrum").map(|place| &origins[place]), Some(Origin::Faulty)) {
        return;
    }
    let (names, help) = if surface.is_tabulated() {
        (REPLACED.as_slice(), "remove one of the two keys: the table has its own rms height and shape")
    } else {
        (OF_TABLE, "add surface.spectrum, the file of the table, or remove the key")
    };
    for name in names {
        // If one of the two is in the base and the other in a sweep, the spec has both kinds of spectrum.
        if (!surface.is_tabulated() || of_sweep(name) == of_sweep("spectrum"))
            && let Some(span) = written(find("surface", name), origins)
            && (surface.is_tabulated() || of_sweep(name) || swept.is_empty())
        {
            let message = if surface.is_tabulated() {
                format!("`surface.{name}` describes a power law, and `surface.spectrum` names a table")
            } else {
                format!("`surface.{name}` describes a table, and `surface.spectrum` names none")
            };
            faults.add(&span, message, help.to_owned());
        }
    }
}
