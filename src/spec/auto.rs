//! `method = "auto"`: the choice between the methods, and its record in a resolved spec.
//!
//! A case with a generated surface is chosen from the target spectrum when the spec is read. One with a
//! measured surface needs the scan, which [`super::Spec::read_choosing`] gives. Where all cases have one
//! choice, the resolved spec has its word in place of `auto`; else it lists the choices.

use std::ops::Range;

use toml::de::DeValue;

use super::fault::Faults;

use super::values::Values;
use super::written::{Written, array};
use super::{Axis, Spec, SpecErrors, Sweep, Value};
use crate::model::{AsperityOptions, CaseParams, Choice as _, GeneratedSurface, JumpIn, Method};
use crate::physics::jkr::{Asperity, MIN_TABOR};
use crate::physics::theory::flattening::flattening;
use crate::physics::theory::regime::Regime;

/// Chooses the method of a case with a measured surface, or gives the problem and the help.
pub type Chooser<'a> = &'a dyn Fn(&CaseParams) -> Result<Method, (String, String)>;

/// Methods that `auto_methods` lists.
pub(super) const METHODS: [&str; 2] = ["asperities", "boundary_elements"];

/// The choices of a spec, in the order of its points.
#[derive(Default)]
pub(super) struct Choices {
    /// Choices that the spec lists.
    given: Vec<Method>,
    /// Choice of each point with `method = "auto"`; `auto` itself where a scan decides.
    made: Vec<Method>,
}

impl Choices {
    /// With the choices that the spec lists; none if there is no list.
    pub(super) fn of(given: Vec<Method>) -> Self {
        Self { given, made: Vec::new() }
    }

    /// Sets the method of a point; true if it was `auto`, which stays until a scan is read.
    pub(super) fn choose(&mut self, values: &mut Values) -> bool {
        if values.method != Method::Auto {
            return false;
        }
        let method = self.given.get(self.made.len()).copied().unwrap_or_else(|| of_target(&values.case()));
        self.made.push(method);
        values.method = method;
        true
    }

    /// Checks the number of listed choices.
    pub(super) fn check(&self, at: Option<&Range<usize>>, faults: &mut Faults<'_>) {
        if !self.given.is_empty() && self.given.len() != self.made.len() {
            let message = format!(
                "`auto_methods` lists {} methods, and {} cases have method = \"auto\"",
                self.given.len(),
                self.made.len()
            );
            faults.add(
                at.unwrap_or(&(0..0)),
                message,
                "remove the line `auto_methods`: the methods are chosen again".to_owned(),
            );
        }
    }

    /// The record of the choices: replaces `auto` in the base and in the sweeps if there is one choice for
    /// all, and else lists them.
    pub(super) fn settle(self, base: &mut Values, sweeps: &mut [Sweep]) -> Vec<Method> {
        let Some(first) = self.made.first().copied() else { return Vec::new() };
        let twice = |axis: &Axis| axis.key == KEY && axis.values.len() > 1;
        let is_one = first != Method::Auto && self.made.iter().all(|method| *method == first);
        if !is_one || sweeps.iter().any(|sweep| sweep.axes.iter().any(twice)) {
            return self.made;
        }
        let replaced = |value: &mut Value| {
            if *value == Value::Word(Method::Auto.word()) {
                *value = Value::Word(first.word());
            }
        };
        sweeps
            .iter_mut()
            .flat_map(|sweep| &mut sweep.axes)
            .filter(|axis| axis.key == KEY)
            .flat_map(|axis| &mut axis.values)
            .for_each(replaced);
        if base.method == Method::Auto {
            base.method = first;
        }
        Vec::new()
    }
}

/// Curvature of the sharpest asperity of a surface, estimated, over its rms curvature.
const SHARPEST: f64 = 3.0;
/// The key whose value is chosen.
const KEY: &str = "model.method";

/// The method of a generated surface by its target spectrum; `auto` for a measured one, and for a table that
/// has not been read.
fn of_target(params: &CaseParams) -> Method {
    let known = params.surface.generated().filter(|surface| surface.has_spectrum());
    let Some(spectrum) = known.map(GeneratedSurface::spectrum) else { return Method::Auto };
    let energy = flattening(&spectrum, params.material.contact_modulus_pa);
    let adhesion = params.material.work_of_adhesion_j_m2;
    let moments = spectrum.moments();
    let method =
        Regime::expected(&energy, adhesion, params.cycle.largest_load(), moments.rms_slope()).method();
    let by_wu = |options: &AsperityOptions| options.jump_in == JumpIn::Wu && !options.allow_low_tabor;
    let needs_range = adhesion > 0.0 && params.asperities().is_some_and(by_wu);
    let sharpest = || Asperity::new(1.0 / (SHARPEST * moments.rms_curvature_1_m()), &params.material);
    let is_low = |asperity: Asperity| asperity.tabor(params.material.interaction_range_m) < MIN_TABOR;
    let is_out_of_range = || needs_range && sharpest().is_ok_and(is_low);
    if method == Method::Asperities && is_out_of_range() { Method::BoundaryElements } else { method }
}

/// Reads the list `auto_methods`.
pub(super) fn methods(value: &Written<'_>, faults: &mut Faults<'_>) -> Vec<Method> {
    let Some(elements) = array("auto_methods", "strings", value, faults) else { return Vec::new() };
    let mut found = Vec::with_capacity(elements.len());
    for element in elements {
        let method = match element.get_ref() {
            DeValue::String(word) if METHODS.contains(&word.as_ref()) => Method::from_word(word),
            _ => None,
        };
        if method.is_none() {
            let help = "remove the line: the program writes it into campaign.toml".to_owned();
            faults.add(
                &element.span(),
                "`auto_methods` must list \"asperities\" or \"boundary_elements\"".to_owned(),
                help,
            );
        }
        found.extend(method);
    }
    found
}

/// The choices of a spec whose scans decide, read by `chooser`.
pub(super) fn chosen(
    spec: &Spec,
    text: &str,
    file: &str,
    chooser: Chooser<'_>,
) -> Result<Vec<Method>, SpecErrors> {
    let mut faults = Faults::new(text, file);
    let mut methods = Vec::with_capacity(spec.auto_methods.len());
    let mut known: Vec<(usize, Method)> = Vec::new();
    for (place, method) in spec.auto_methods.iter().enumerate() {
        let case = spec.auto_cases.get(place).copied().unwrap_or_default();
        let before = known.iter().find(|(of, _)| *of == case).map(|(_, method)| *method);
        let Some(unit) = spec.cases.get(case).filter(|_| *method == Method::Auto && before.is_none()) else {
            methods.push(before.unwrap_or(*method));
            continue;
        };
        // A tabulated spectrum has been read with the spec.
        let of_table = Some(of_target(&unit.params)).filter(|method| *method != Method::Auto);
        match of_table.map_or_else(|| chooser(&unit.params), Ok) {
            Ok(method) => {
                known.push((case, method));
                methods.push(method);
            }
            Err((problem, help)) => {
                let at = text.find("\"auto\"").map_or(0..0, |at| at..at + 6);
                let file = unit.params.surface.files().join("\", \"");
                faults.add(
                    &at,
                    format!("`model.method` = \"auto\" cannot be chosen from the scan \"{file}\": {problem}"),
                    help,
                );
                known.push((case, Method::Auto));
                methods.push(Method::Auto);
            }
        }
    }
    faults.finish(Some(methods))
}
