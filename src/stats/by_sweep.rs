//! Rows of the table `cases` by sweep: a heading with what is constant in the sweep, and labels with what
//! varies in it.

use super::StatsError;
use super::listed::{Listing, sweeps};
use super::varying::{Varying, varying};
use crate::store::Frame;

/// Names of sweeps that a heading lists; of more, it gives the number of the others.
const MOST_NAMED: usize = 3;

/// The rows of the cases that belong to the same sweeps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OfSweeps {
    /// Names of the sweeps, and the parameters that have one value in them and others elsewhere.
    pub heading: String,
    /// Rows of the table `cases`, each with the parameters that vary in these sweeps.
    pub rows: Vec<(usize, String)>,
}

/// The rows of a listing by their sweeps, in the order of the listing; empty for a run with one sweep.
///
/// With a reference case, headings and labels have the parameters that differ from it.
///
/// # Errors
/// If the table lacks a column.
pub fn by_sweep(cases: &Frame, listing: &Listing) -> Result<Vec<OfSweeps>, StatsError> {
    if sweeps(cases)?.len() < 2 {
        return Ok(Vec::new());
    }
    let joined = cases.text("sweep")?;
    let all: Vec<usize> = (0..joined.len()).collect();
    let differing = varying(cases, &all)?;
    let reference = listing.rows.iter().find(|listed| listed.is_reference).map(|listed| listed.row);
    let is_shown = |of: &Varying, row: usize| {
        !of.is_absent(row) && reference.is_none_or(|reference| of.text(row) != of.text(reference))
    };
    let mut found: Vec<(&str, OfSweeps)> = Vec::new();
    for listed in &listing.rows {
        let own = joined[listed.row];
        let members: Vec<usize> =
            all.iter().copied().filter(|row| own.split('+').any(|name| has(joined[*row], name))).collect();
        let is_constant = |of: &Varying| members.iter().all(|row| of.text(*row) == of.text(listed.row));
        let assigned = |of: &mut dyn Iterator<Item = &Varying>| -> Vec<String> {
            of.map(|of| of.assigned(listed.row)).collect()
        };
        let constants = || differing.iter().filter(|of| is_constant(of) && is_shown(of, listed.row));
        let free = || differing.iter().filter(|of| !is_constant(of) && !of.is_absent(listed.row));
        // Like the reference case in all that varies here: all that varies.
        let short = assigned(&mut free().filter(|of| is_shown(of, listed.row)));
        let label = if short.is_empty() { assigned(&mut free()) } else { short }.join(", ");
        let is_own = !label.is_empty() && !listed.is_reference;
        let row = (listed.row, if is_own { label } else { listed.label.clone() });
        match found.iter_mut().find(|(known, _)| *known == own) {
            Some((_, of)) => of.rows.push(row),
            None => found.push((
                own,
                OfSweeps { heading: heading(own, &assigned(&mut constants())), rows: vec![row] },
            )),
        }
    }
    Ok(found.into_iter().map(|(_, of)| of).collect())
}

/// True if a name is among joined ones.
fn has(joined: &str, name: &str) -> bool {
    joined.split('+').any(|one| one == name)
}

fn heading(joined: &str, constants: &[String]) -> String {
    let names: Vec<&str> = joined.split('+').collect();
    let shown = names.iter().take(MOST_NAMED).copied().collect::<Vec<_>>().join(", ");
    let more = names.len().saturating_sub(MOST_NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let plural = if names.len() > 1 { "Sweeps" } else { "Sweep" };
    let constants = if constants.is_empty() { String::new() } else { format!(": {}", constants.join(", ")) };
    format!("{plural} {shown}{more}{constants}")
}
