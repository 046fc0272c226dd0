//! The keys of all units of a spec.

use super::{CYCLE, EXTRACT, GENERATE, Stage, case_reads, cycle_reads, read_by_cycle, seed_of, surface_reads};
use crate::keys::{canonical, key_of_text};
use crate::spec::{Case, CaseParams, Spec, SurfaceParams};
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::Path;

/// The keys of all units, each of which is hashed once, in parallel.
pub(super) struct Hashed {
    /// Of each kind of surface, the keys of its realizations and of their asperities.
    pub(super) surfaces: Vec<Vec<(String, String)>>,
    pub(super) cases: Vec<HashedCase>,
}

/// The keys of a case.
pub(super) struct HashedCase {
    /// The readable part of its ids.
    pub(super) name: String,
    /// Of all its parameters.
    pub(super) whole: String,
    /// Of the parameters that its cycles read.
    pub(super) in_cycle: String,
    /// Which kind of surface it has.
    pub(super) surface: usize,
    /// Of its cycles.
    pub(super) cycles: Vec<String>,
}

impl Hashed {
    pub(super) fn all(spec: &Spec, counts: &[u32]) -> Self {
        let mut kinds: HashMap<String, usize> = HashMap::new();
        // Of each kind, its seed and its greatest number of realizations.
        let mut most: Vec<(u64, u32)> = Vec::new();
        let of_case: Vec<usize> = spec
            .cases
            .iter()
            .zip(counts)
            .map(|(case, count)| {
                let kind = *kinds.entry(canonical(&surface_reads(spec, &case.params.surface))).or_insert(most.len());
                most.resize(most.len().max(kind + 1), (seed_of(spec, &case.params.surface), 0));
                most[kind].1 = most[kind].1.max(*count);
                kind
            })
            .collect();
        let mut texts: Vec<&str> = vec![""; most.len()];
        kinds.iter().for_each(|(text, kind)| texts[*kind] = text);
        let surfaces: Vec<Vec<(String, String)>> = texts
            .par_iter()
            .zip(&most)
            .map(|(surface, (seed, count))| {
                let keys = |realization: u32| {
                    let reads = format!("{{\"realization\":{realization},\"seed\":{seed},\"surface\":{surface}}}");
                    let surface = key_of_text(Stage::Generate.word(), GENERATE, &reads);
                    let asperities = key_of_text(Stage::Extract.word(), EXTRACT, &format!("{{\"surface\":\"{surface}\"}}"));
                    (surface, asperities)
                };
                (0..*count).into_par_iter().map(keys).collect()
            })
            .collect();
        let hash = |((case, kind), count): ((&Case, &usize), &u32)| {
            let params = &case.params;
            // Whatever the realizations have in common is put into words once.
            let rest = canonical(&cycle_reads(params));
            // "asperities" is the first of the sorted names.
            let key = |(_, asperities): &(String, String)| {
                key_of_text(Stage::Cycle.word(), CYCLE, &format!("{{\"asperities\":\"{asperities}\",{}", rest.trim_start_matches('{')))
            };
            HashedCase {
                name: readable(&params.surface),
                whole: case_key(spec, params),
                in_cycle: case_key(spec, &read_by_cycle(params)),
                surface: *kind,
                cycles: surfaces[*kind].par_iter().take(*count as usize).map(key).collect(),
            }
        };
        let cases = spec.cases.par_iter().zip(&of_case).zip(counts).map(hash).collect();
        Self { surfaces, cases }
    }
}

/// Key of the parameters of a case.
fn case_key(spec: &Spec, params: &CaseParams) -> String {
    key_of_text("case", 1, &canonical(&case_reads(spec, params)))
}

/// The readable part of ids: of a measured surface the name of its file, without its folder and its ending.
fn readable(params: &SurfaceParams) -> String {
    if !params.is_measured() {
        return format!("H{:.2}_z{}", params.hurst, params.magnification);
    }
    let stem = Path::new(&params.file).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let name: String = stem.chars().map(plain).take(32).collect();
    if name.is_empty() { "surface".to_owned() } else { name }
}
