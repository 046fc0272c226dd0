//! The keys of all units of a spec.

use super::Stage;
use super::key_inputs::{
    Canonical, Form, case_members, cycle, extract, generate, of_surface, of_whole_case, read_by_cycle,
    seed_of,
};
use crate::model::SurfaceSource;
use crate::spec::{Case, CaseParams, Spec};
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
        let mut kinds: HashMap<Canonical, usize> = HashMap::new();
        // For each kind, its seed and its largest number of realizations.
        let mut most: Vec<(u64, u32)> = Vec::new();
        let of_case: Vec<usize> = spec
            .cases
            .iter()
            .zip(counts)
            .map(|(case, count)| {
                let kind = *kinds
                    .entry(Canonical::of(&of_surface(spec, &case.params.surface)))
                    .or_insert(most.len());
                most.resize(most.len().max(kind + 1), (seed_of(spec, &case.params.surface), 0));
                most[kind].1 = most[kind].1.max(*count);
                kind
            })
            .collect();
        let mut shared: Vec<(&Canonical, usize)> =
            kinds.iter().map(|(inputs, kind)| (inputs, *kind)).collect();
        shared.sort_by_key(|(_, kind)| *kind);
        let surfaces: Vec<Vec<(String, String)>> = shared
            .par_iter()
            .zip(&most)
            .map(|((surface, _), (seed, count))| {
                let keys = |realization: u32| {
                    let surface = generate(*surface, *seed, realization).key(Stage::Generate);
                    let asperities = extract::<Canonical>(&surface).key(Stage::Extract);
                    (surface, asperities)
                };
                (0..*count).into_par_iter().map(keys).collect()
            })
            .collect();
        let hash = |((case, kind), count): ((&Case, &usize), &u32)| {
            let params = &case.params;
            // The inputs that the realizations share are rendered once.
            let members = case_members::<Canonical>(params);
            let key = |(_, asperities): &(String, String)| cycle(&members, asperities).key(Stage::Cycle);
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
    Canonical::of(&of_whole_case(spec, params)).case_key()
}

/// The readable part of ids: of a measured surface and of a tabulated spectrum the name of the file,
/// without its
/// folder and its ending.
fn readable(params: &SurfaceSource) -> String {
    let (file, end) = match params {
        SurfaceSource::Generated(surface) if !surface.is_tabulated() => {
            return format!("H{:.2}_z{}", surface.hurst, surface.magnification);
        }
        SurfaceSource::Generated(surface) => {
            (&surface.tabulated.file, format!("_z{}", surface.magnification))
        }
        SurfaceSource::Measured(surface) => (&surface.file, String::new()),
    };
    let stem =
        Path::new(file).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let name: String = stem.chars().map(plain).take(32).collect();
    if name.is_empty() { format!("surface{end}") } else { format!("{name}{end}") }
}
