//! A value for each key of a spec, and the case that follows from them.

use super::Value;
use super::keys::{KEYS, Key, OPTIONAL_TABLES, OTHER_GRIDS, OTHER_LOADS, TABLES};
use super::per_wavelength::with_points;
use crate::model::{
    AsperityOptions, Attraction, AttractionKind, CaseParams, Control, ElementOptions, FrontLaw,
    GeneratedSurface, LoadingPath, Machine, Material, MeasuredSurface, Method, MethodOptions, Nucleation,
    Opening, Probe, Slip, Substrate, SurfaceSource,
};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// A value for each key: those of both kinds of surface, of all methods and of all attractions.
#[derive(Debug, Clone, PartialEq)]
pub struct Values {
    /// Keys of a generated surface.
    pub generated: GeneratedSurface,
    /// Keys of a measured surface, which has a file.
    pub measured: MeasuredSurface,
    /// `[material]`.
    pub material: Material,
    /// `model.method`.
    pub method: Method,
    /// `model.as_printed`.
    pub as_printed: Vec<Slip>,
    /// Keys of the asperity model.
    pub asperities: AsperityOptions,
    /// Keys of boundary elements but those of the attraction.
    pub elements: ElementOptions,
    /// `boundary_elements.error`, `max_points` and `shifted_copies`.
    pub goal: GridGoal,
    /// `boundary_elements.attraction`.
    pub attraction: AttractionKind,
    /// `boundary_elements.range_m`.
    pub range_m: Option<f64>,
    /// `boundary_elements.nucleation`.
    pub nucleation: Nucleation,
    /// `boundary_elements.opening`.
    pub opening: Opening,
    /// `boundary_elements.law`.
    pub law: FrontLaw,
    /// `[cycle]` but the step of the asperity model and the loads in other units.
    pub cycle: LoadingPath,
    /// `probe.radius_m`.
    pub radius_m: Option<f64>,
    /// `substrate.thickness_m`.
    pub thickness_m: Option<f64>,
    /// `substrate.poisson_ratio`.
    pub poisson_ratio: f64,
    /// `[machine]` but its stiffness.
    pub machine: Machine,
    /// `machine.stiffness_n_m`.
    pub stiffness_n_m: Option<f64>,
    /// `cycle.max_force_n`.
    pub max_force_n: Vec<f64>,
    /// `cycle.max_pressure_pa`.
    pub max_pressure_pa: Vec<f64>,
    /// Side of the square of a scan \[m\], where its file has been read for loads in newtons.
    pub side_m: Option<f64>,
}

/// Grid error that a spec requires, and its estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridGoal {
    /// Relative grid error of the mean dissipated energy.
    pub error: Option<f64>,
    /// Largest number of grid points along a side.
    pub max_points: u32,
    /// Shifted copies of the coarsest grid.
    pub shifted_copies: u32,
}

impl Default for GridGoal {
    fn default() -> Self {
        Self { error: None, max_points: 1024, shifted_copies: 0 }
    }
}

impl Default for Values {
    fn default() -> Self {
        Self {
            generated: GeneratedSurface::default(),
            measured: MeasuredSurface::default(),
            material: Material::default(),
            method: Method::Asperities,
            as_printed: Vec::new(),
            asperities: AsperityOptions::default(),
            elements: ElementOptions::default(),
            goal: GridGoal::default(),
            attraction: AttractionKind::Bonded,
            range_m: None,
            nucleation: Nucleation::Touch,
            opening: Opening::Strength,
            law: FrontLaw::Plain,
            cycle: LoadingPath::default(),
            radius_m: None,
            thickness_m: None,
            poisson_ratio: 0.5,
            machine: Machine::default(),
            stiffness_n_m: None,
            max_force_n: Vec::new(),
            max_pressure_pa: Vec::new(),
            side_m: None,
        }
    }
}

impl Values {
    /// The case of these values: what its surface, its method and its attraction do not read is left out, so
    /// that cases which differ in nothing else are one case. `method = "auto"` has the options of the
    /// asperity model.
    #[must_use]
    pub fn case(&self) -> CaseParams {
        let surface = if !self.measured.is_named() {
            SurfaceSource::Generated(generated(&self.generated))
        } else {
            let points_per_shortest_wavelength = self.generated.points_per_shortest_wavelength;
            let default = MeasuredSurface::default().fast_axis;
            let fast_axis = if self.measured.align_rows { self.measured.fast_axis } else { default };
            SurfaceSource::Measured(Box::new(MeasuredSurface {
                points_per_shortest_wavelength,
                fast_axis,
                ..self.measured.clone()
            }))
        };
        let (mut as_printed, is_by_elements) =
            (self.as_printed.clone(), self.method == Method::BoundaryElements);
        let method = if is_by_elements {
            as_printed.retain(|slip| !slip.in_contact());
            MethodOptions::Elements(ElementOptions { attraction: self.attraction(), ..self.elements.clone() })
        } else {
            MethodOptions::Asperities(self.asperities.clone())
        };
        let poisson_ratio = self.poisson_ratio;
        let substrate = self.thickness_m.map(|thickness_m| Substrate { thickness_m, poisson_ratio });
        // Under control of the load the spring of the machine does not act.
        let is_spring = self.machine.control == Control::Displacement;
        let spring_m_n = self.stiffness_n_m.map_or(self.machine.compliance_m_n, f64::recip);
        let compliance_m_n = if is_spring { spring_m_n } else { 0.0 };
        with_points(CaseParams {
            surface,
            probe: self.radius_m.map(|radius_m| Probe { radius_m }),
            material: self.material,
            substrate,
            machine: Machine { compliance_m_n, ..self.machine },
            method,
            as_printed,
            cycle: LoadingPath { max_load: self.max_loads(), ..self.cycle.clone() },
        })
    }

    /// Loads `F/(E* A0)` at the load reversals, from newtons or pascals if they are given in these.
    fn max_loads(&self) -> Vec<f64> {
        let modulus_pa = self.material.contact_modulus_pa;
        let over = |loads: &[f64], unit: f64| loads.iter().map(|load| load / unit).collect();
        match self.length_m() {
            Some(length_m) if !self.max_force_n.is_empty() => {
                over(&self.max_force_n, modulus_pa * length_m * length_m)
            }
            _ if !self.max_pressure_pa.is_empty() => over(&self.max_pressure_pa, modulus_pa),
            _ => self.cycle.max_load.clone(),
        }
    }

    /// Side of the nominal square \[m\]; of a measured surface nothing unless the spec states it or the file
    /// has been read.
    pub(super) fn length_m(&self) -> Option<f64> {
        if !self.measured.is_named() {
            return Some(self.generated.length_m);
        }
        let MeasuredSurface { size_m, size_y_m, .. } = self.measured;
        let stated = if size_y_m > 0.0 { size_m.min(size_y_m) } else { size_m };
        self.side_m.or(Some(stated).filter(|side| *side > 0.0))
    }

    /// True if loads in newtons need the size of a scan that the spec does not state.
    pub(super) fn needs_side(&self) -> bool {
        let has_sizes = self.measured.size_m > 0.0 && self.measured.size_y_m > 0.0;
        self.measured.is_named() && !self.max_force_n.is_empty() && !has_sizes
    }

    fn attraction(&self) -> Attraction {
        match self.attraction {
            AttractionKind::Bonded => {
                Attraction::Bonded { nucleation: self.nucleation, opening: self.opening, law: self.law }
            }
            AttractionKind::Range => Attraction::Range { range_m: self.range_m },
        }
    }
}

/// A generated surface without the values that its spectrum does not read.
fn generated(of: &GeneratedSurface) -> GeneratedSurface {
    let mut surface = of.clone();
    let default = GeneratedSurface::default();
    if surface.aspect_ratio == default.aspect_ratio {
        surface.angle_deg = default.angle_deg;
    }
    if surface.is_tabulated() {
        let GeneratedSurface { rms_height_m, hurst, normalization, roll_off_m, .. } = default;
        surface = GeneratedSurface { rms_height_m, hurst, normalization, roll_off_m, ..surface };
    }
    surface
}

impl From<&CaseParams> for Values {
    /// The values of a case, with the defaults of all keys that it does not read.
    fn from(case: &CaseParams) -> Self {
        let mut values = Self {
            material: case.material,
            method: case.method.kind(),
            as_printed: case.as_printed.clone(),
            cycle: case.cycle.clone(),
            radius_m: case.probe.map(|probe| probe.radius_m),
            thickness_m: case.substrate.map(|layer| layer.thickness_m),
            machine: case.machine,
            ..Self::default()
        };
        if let Some(layer) = case.substrate {
            values.poisson_ratio = layer.poisson_ratio;
        }
        match &case.surface {
            SurfaceSource::Generated(surface) => values.generated = surface.clone(),
            SurfaceSource::Measured(surface) => {
                values.measured = MeasuredSurface::clone(surface);
                values.generated.points_per_shortest_wavelength = surface.points_per_shortest_wavelength;
            }
        }
        match &case.method {
            MethodOptions::Asperities(options) => values.asperities = options.clone(),
            MethodOptions::Elements(options) => values.elements = options.clone(),
        }
        values.attraction = values.elements.attraction.kind();
        match values.elements.attraction {
            Attraction::Bonded { nucleation, opening, law } => {
                (values.nucleation, values.opening, values.law) = (nucleation, opening, law);
            }
            Attraction::Range { range_m } => values.range_m = range_m,
        }
        values
    }
}

impl Serialize for Values {
    /// The tables of a spec with every key; tables that a spec need not have and loads in other units where
    /// they say something. A shifted grid has its shift.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let default = Self::default();
        let says = |key: &Key| (key.get)(self) != (key.get)(&default);
        let keys = |table: &'static str| KEYS.iter().filter(move |key| key.table == table);
        let is_optional = |key: &Key| {
            OTHER_LOADS.contains(&key.name) || OTHER_GRIDS.contains(&key.name) || key.name == "files"
        };
        let is_shown = |key: &&Key| !is_optional(key) || says(key);
        let values = |table| {
            let shown = keys(table).filter(is_shown);
            let of_keys = shown.map(|key| (key.name, (key.get)(self)));
            let shift = self.elements.shift;
            let of_copy =
                (table == "boundary_elements" && shift != 0.0).then_some(("shift", Value::Number(shift)));
            of_keys.chain(of_copy).collect::<BTreeMap<&str, Value>>()
        };
        let is_table = |table: &&'static str| !OPTIONAL_TABLES.contains(table) || keys(table).any(says);
        serializer.collect_map(TABLES.into_iter().filter(is_table).map(|table| (table, values(table))))
    }
}

impl Serialize for CaseParams {
    /// As [`Values`], with the defaults of the keys that the case does not read.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Values::from(self).serialize(serializer)
    }
}
