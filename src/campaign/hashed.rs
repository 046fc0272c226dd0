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
    /// Of each kind of surface, those of its realizations.
    pub(super) surfaces: Vec<Vec<HashedSurface>>,
    pub(super) cases: Vec<HashedCase>,
}

/// The keys of a surface.
pub(super) struct HashedSurface {
    pub(super) key: String,
    /// Of its asperities.
    pub(super) asperities_key: String,
}

/// The keys of a case.
pub(super) struct HashedCase {
    /// The readable part of its ids.
    pub(super) name: String,
    /// Of all its parameters.
    pub(super) whole: String,
    /// Name and key in the tables of its cycles, of the parameters that these read: one for all, or one for
    /// each of several scans.
    pub(super) in_cycles: Vec<(String, String)>,
    /// Which kind of surface it has.
    pub(super) surface: usize,
    /// Of its cycles.
    pub(super) cycles: Vec<String>,
}

impl Hashed {
    pub(super) fn all(spec: &Spec, counts: &[u32]) -> Self {
        let mut kinds: HashMap<Canonical, usize> = HashMap::new();
        // For each kind, a surface of it and its largest number of realizations.
        let mut most: Vec<(&SurfaceSource, u32)> = Vec::new();
        let of_case: Vec<usize> = spec
            .cases
            .iter()
            .zip(counts)
            .map(|(case, count)| {
                let surface = &case.params.surface;
                let kind = *kinds.entry(Canonical::of(&of_surface(spec, surface))).or_insert(most.len());
                most.resize(most.len().max(kind + 1), (surface, 0));
                most[kind].1 = most[kind].1.max(*count);
                kind
            })
            .collect();
        let mut shared: Vec<(&Canonical, usize)> =
            kinds.iter().map(|(inputs, kind)| (inputs, *kind)).collect();
        shared.sort_by_key(|(_, kind)| *kind);
        let surfaces: Vec<Vec<HashedSurface>> = shared
            .par_iter()
            .zip(&most)
            .map(|((inputs, _), (surface, count))| realizations(spec, surface, inputs, *count))
            .collect();
        let hash = |((case, kind), count): ((&Case, &usize), &u32)| {
            let params = &case.params;
            // The inputs that the realizations share are rendered once.
            let members = case_members::<Canonical>(params);
            let key = |of: &HashedSurface| cycle(&members, &of.asperities_key).key(Stage::Cycle);
            HashedCase {
                name: readable(&params.surface),
                whole: case_key(spec, params),
                in_cycles: in_cycles(spec, params),
                surface: *kind,
                cycles: surfaces[*kind].par_iter().take(*count as usize).map(key).collect(),
            }
        };
        let cases = spec.cases.par_iter().zip(&of_case).zip(counts).map(hash).collect();
        Self { surfaces, cases }
    }
}

/// The keys of the realizations of a surface. Each of several scans has those of the scan alone.
fn realizations(spec: &Spec, surface: &SurfaceSource, inputs: &Canonical, count: u32) -> Vec<HashedSurface> {
    let seed = seed_of(spec, surface);
    let keys = |realization: u32| {
        let key = if has_scans(surface) {
            let scan = Canonical::of(&of_surface(spec, &surface.of_realization(realization)));
            generate(&scan, seed, 0).key(Stage::Generate)
        } else {
            generate(inputs, seed, realization).key(Stage::Generate)
        };
        HashedSurface { asperities_key: extract::<Canonical>(&key).key(Stage::Extract), key }
    };
    (0..count).into_par_iter().map(keys).collect()
}

/// True for a measured surface with a list of scans.
fn has_scans(surface: &SurfaceSource) -> bool {
    surface.measured().is_some_and(|surface| !surface.files.is_empty())
}

/// Name and key of a case in the tables of its cycles, for each scan of a list or for all realizations.
fn in_cycles(spec: &Spec, params: &CaseParams) -> Vec<(String, String)> {
    let scans = if has_scans(&params.surface) { params.surface.files().len() as u32 } else { 1 };
    let one = |scan: u32| {
        let surface = params.surface.of_realization(scan);
        let name = readable(&surface);
        (name, case_key(spec, &read_by_cycle(&CaseParams { surface, ..params.clone() })))
    };
    (0..scans).map(one).collect()
}

/// Key of the parameters of a case.
fn case_key(spec: &Spec, params: &CaseParams) -> String {
    Canonical::of(&of_whole_case(spec, params)).case_key()
}

/// The readable part of ids: of a measured surface and of a tabulated spectrum the name of the file, without
/// its folder and its ending; of several scans the name of the first with their number.
fn readable(params: &SurfaceSource) -> String {
    let (file, end) = match params {
        SurfaceSource::Generated(surface) if !surface.is_tabulated() => {
            return format!("H{:.2}_z{}", surface.hurst, surface.magnification);
        }
        SurfaceSource::Generated(surface) => {
            (&surface.tabulated.file, format!("_z{}", surface.magnification))
        }
        SurfaceSource::Measured(surface) => {
            let count = surface.files.len();
            let end = if count > 1 { format!("_x{count}") } else { String::new() };
            (surface.names().first().unwrap_or(&surface.file), end)
        }
    };
    let stem =
        Path::new(file).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let name: String = stem.chars().map(plain).take(32).collect();
    if name.is_empty() { format!("surface{end}") } else { format!("{name}{end}") }
}
