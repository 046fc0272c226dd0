//! The keys: what each takes, and where its value goes.

use super::{Value, Values};
use crate::model::{
    Amplitudes, AttractionKind, Boundary, Choice, Coalescence, Control, Detrend, FarField, FastAxis, Filter,
    FrontLaw, Interaction, JumpIn, KeptContacts, Method, Missing, Normalization, Nucleation, Opening, Slip,
    SpectrumConvention, SpectrumKind,
};

/// One key of a table.
pub(super) struct Key {
    /// Table and key, such as `surface.length_m`.
    pub(super) path: &'static str,
    /// The table.
    pub(super) table: &'static str,
    /// The key in its table.
    pub(super) name: &'static str,
    /// Symbol of the quantity; empty if it has none.
    pub(super) symbol: &'static str,
    /// Meaning, for the reference page and for editors.
    pub(super) meaning: &'static str,
    /// Kind of its values.
    pub(super) kind: Kind,
    /// Its value.
    pub(super) get: fn(&Values) -> Value,
    /// Sets a value of the right kind.
    pub(super) set: fn(&mut Values, &Value),
}

/// The words of a choice, each with its meaning.
pub(super) type Words = &'static [(&'static str, &'static str)];

/// Kind of the values of a key.
pub(super) enum Kind {
    /// A real number.
    Number(Limits),
    /// A whole number from `low` to `high`. For a smaller number, the reason is the first sentence of `why`
    /// whose number is not exceeded.
    Count { low: u32, high: u32, why: &'static [(i128, &'static str)], note: &'static str },
    /// True or false.
    Flag,
    /// One of some words.
    Word(Words),
    /// An array of real numbers, as many as stated.
    Numbers(Limits, usize),
    /// An array of words.
    Words(Words),
    /// A text: maximum number of bytes, and its meaning.
    Text(usize, &'static str),
    /// An array of texts on one line: maximum number of elements and of bytes, and their meaning.
    Texts(usize, usize, &'static str),
    /// A unit of length, or an empty text if the file states it.
    Length(&'static str),
}

impl Key {
    /// The stage that reads it first.
    pub(super) fn stage(&self) -> &'static str {
        if self.table == "surface" { "generate" } else { "cycle" }
    }
}

impl Kind {
    /// True if one value of this kind is an array already.
    pub(super) fn is_list(&self) -> bool {
        matches!(self, Self::Numbers(..) | Self::Words(..) | Self::Texts(..))
    }
}

/// Bounds of a real number.
pub(super) struct Limits {
    /// Smallest value, or exclusive lower bound.
    pub(super) low: f64,
    /// `low` itself is not allowed.
    pub(super) above: bool,
    /// Largest value.
    pub(super) high: f64,
    /// Symbol of the unit, with a space before it; empty if there is none.
    pub(super) unit: &'static str,
    /// Name of the unit.
    pub(super) unit_name: &'static str,
    /// A unit that is easily written instead: its size in the right one, and its name.
    pub(super) slip: Option<(f64, &'static str)>,
    /// Help for values out of bounds.
    pub(super) note: &'static str,
}

impl Limits {
    /// True if a value lies within.
    pub(super) fn hold(&self, value: f64) -> bool {
        value <= self.high && if self.above { value > self.low } else { value >= self.low }
    }
}

/// The words of a choice.
pub(super) fn words(choice: &[(&'static str, &'static str)]) -> Vec<&'static str> {
    choice.iter().map(|(word, _)| *word).collect()
}

macro_rules! key {
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal;
        number $limits:expr) => {
        key!($table.$name in $($place).+, $symbol, $meaning;
            Kind::Number($limits), |x: &f64| Value::Number(*x), Number(x) => Some(*x))
    };
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal;
        optional number $limits:expr) => {
        key!($table.$name in $($place).+, $symbol, $meaning; Kind::Number($limits),
            |x: &Option<f64>| Value::Number(x.unwrap_or_default()),
            Number(x) => Some(Some(*x).filter(|x| *x > 0.0)))
    };
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal;
        count $low:literal to $high:literal, $why:expr, $note:expr) => {
        key!($table.$name in $($place).+, $symbol, $meaning;
            Kind::Count { low: $low, high: $high, why: $why, note: $note },
            |n: &u32| Value::Count(*n), Count(n) => Some(*n))
    };
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal;
        optional count to $high:literal, $note:expr) => {
        key!($table.$name in $($place).+, $symbol, $meaning;
            Kind::Count { low: 0, high: $high, why: &[], note: $note },
            |n: &Option<u32>| Value::Count(n.unwrap_or_default()),
            Count(n) => Some(Some(*n).filter(|n| *n > 0)))
    };
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal; word $choice:ty) => {
        key!($table.$name in $($place).+, $symbol, $meaning; Kind::Word(<$choice>::MEANINGS),
            |w: &$choice| Value::Word(w.word()), Word(w) => <$choice>::from_word(w))
    };
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal;
        text $most:literal, $note:literal) => {
        key!($table.$name in $($place).+, $symbol, $meaning; Kind::Text($most, $note),
            |text: &String| Value::Text(text.clone()), Text(text) => Some(text.clone()))
    };
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal;
        length $note:literal) => {
        key!($table.$name in $($place).+, $symbol, $meaning; Kind::Length($note),
            |text: &String| Value::Text(text.clone()), Text(text) => Some(text.clone()))
    };
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal; flag) => {
        key!($table.$name in $($place).+, $symbol, $meaning;
            Kind::Flag, |flag: &bool| Value::Flag(*flag), Flag(flag) => Some(*flag))
    };
    ($table:ident.$name:ident in $($place:ident).+, $symbol:literal, $meaning:literal;
        $kind:expr, $get:expr, $variant:ident($bound:ident) => $value:expr) => {
        Key {
            path: concat!(stringify!($table), ".", stringify!($name)),
            table: stringify!($table),
            name: stringify!($name),
            symbol: $symbol,
            meaning: $meaning,
            kind: $kind,
            get: |values| {
                let get: fn(&_) -> Value = $get;
                get(&values.$($place).+)
            },
            set: |values, value| {
                // The walker reads each value by the kind in the same row, so that it always fits.
                if let Value::$variant($bound) = value
                    && let Some(value) = $value
                {
                    values.$($place).+ = value;
                }
            },
        }
    };
}

/// Every key of every table, in the order in which they are shown.
pub(super) static KEYS: &[Key] = &[
    key!(surface.length_m in generated.length_m, "L", "Side of the nominal square."; number Limits {
        low: 1e-9, above: false, high: 1.0, unit: " m", unit_name: "metres",
        slip: Some((1e-6, "micrometres")), note: "",
    }),
    key!(surface.rms_height_m in generated.rms_height_m, "h_rms", "Root-mean-square (rms) height of a \
         generated surface."; number Limits {
        low: 1e-12, above: false, high: 0.1, unit: " m", unit_name: "metres",
        slip: Some((1e-6, "micrometres")), note: "",
    }),
    key!(surface.hurst in generated.hurst, "H", "Hurst exponent of the self-affine power spectral density \
         C(q) ∝ q^(−2(H+1))."; number Limits {
        low: 0.01, above: false, high: 1.0, unit: "", unit_name: "", slip: None,
        note: "H, Hurst exponent of a self-affine surface, 0.01 <= H <= 1; default 0.8",
    }),
    key!(surface.magnification in generated.magnification, "ζ", "Magnification: longest over shortest \
         wavelength of the roughness."; count 2 to 16384, &[],
        "ζ, magnification: longest over shortest wavelength of the roughness, 2 <= ζ <= 16384; default 128"),
    key!(surface.points_per_shortest_wavelength in generated.points_per_shortest_wavelength, "", "Grid \
         points per shortest wavelength: ζ times as many along a side. For a measured surface, low-pass \
         (S-filter) cut-off wavelength in pixels."; count 4 to 64, &[
        (1, "1 point is below the Nyquist limit: the grid does not resolve the shortest wavelength"),
        (3, "2 or 3 points resolve the heights at the shortest wavelength; the derivatives at summits need \
             at least 4"),
    ], "default 8"),
    key!(surface.normalization in generated.normalization, "", "Definition of the rms height.";
        word Normalization),
    key!(surface.amplitudes in generated.amplitudes, "", "Amplitudes of the Fourier components.";
        word Amplitudes),
    key!(surface.longest_wavelength_m in generated.longest_wavelength_m, "λ_long", "Longest wavelength of a \
         generated surface. 0: the side L. The magnification remains L over the shortest \
         wavelength."; optional number Limits {
        low: 0.0, above: false, high: 1.0, unit: " m", unit_name: "metres",
        slip: Some((1e-6, "micrometres")),
        note: "λ_long, longest wavelength; 0 for the side L",
    }),
    key!(surface.roll_off_m in generated.roll_off_m, "λ_r", "Roll-off wavelength of a generated surface: \
         C(q) = C(2π/λ_r) for all longer wavelengths. 0: none."; optional number Limits {
        low: 0.0, above: false, high: 1.0, unit: " m", unit_name: "metres",
        slip: Some((1e-6, "micrometres")),
        note: "λ_r, roll-off wavelength; 0 for a power law up to the longest wavelength",
    }),
    key!(surface.aspect_ratio in generated.aspect_ratio, "r", "Aspect ratio of the roughness of a generated \
         surface: C(q) = C_iso(q') with q'² = r q_∥² + q_⊥²/r. Wavelengths along the lay are r times those \
         across it."; number Limits {
        low: 1.0, above: false, high: 100.0, unit: "", unit_name: "", slip: None,
        note: "r, aspect ratio; 1 for an isotropic surface (default). For r < 1 turn angle_deg by 90",
    }),
    key!(surface.angle_deg in generated.angle_deg, "", "Direction of the lay with `aspect_ratio` above 1: \
         angle from the x axis towards the y axis."; number Limits {
        low: -180.0, above: false, high: 180.0, unit: " °", unit_name: "degrees", slip: None,
        note: "angle of the lay in degrees, -180 to 180; default 0",
    }),
    key!(surface.spectrum in generated.tabulated.file, "", "CSV file of a tabulated spectrum: wavenumber q = \
         2π/λ and density C. It is used as it is, without `rms_height_m`, `hurst`, `normalization` and \
         `roll_off_m`."; text 4096, "the file of a spectrum, from the working directory or the folder of the \
         spec"),
    key!(surface.spectrum_kind in generated.tabulated.kind, "", "Quantity C in the table of the spectrum.";
        word SpectrumKind),
    key!(surface.spectrum_convention in generated.tabulated.convention, "", "Normalization of C in the table \
         of the spectrum."; word SpectrumConvention),
    key!(surface.spectrum_unit in generated.tabulated.unit, "", "Unit of length of both columns of the \
         spectrum: \"um\" for q in 1/µm and C in µm⁴ or µm³. Empty: the heading states it.";
        length "the unit of length of q and C, for example \"um\""),
    key!(surface.spectrum_series in generated.tabulated.series, "", "Data series of a table of \
         contact.engineering with several. Empty: there is one."; text 256, "the name of a data series in \
         the table of the spectrum"),
    key!(surface.file in measured.file, "", "File of a measured surface. With this key, the surface is \
         imported and not generated.";
        text 4096, "the file of a measured surface, from the working directory or the folder of the spec"),
    key!(surface.files in measured.files, "", "Files of several scans of one sample, instead of `file`: the \
         scans are the realizations of one case, and all other keys hold for each of them."; Kind::Texts(
        1000, 4096, "the files of scans, from the working directory or the folder of the spec",
    ), |files: &Vec<String>| Value::Texts(files.clone()), Texts(files) => Some(files.clone())),
    key!(surface.dataset in measured.dataset, "", "Field of the file, if it has several: a dataset of HDF5, \
         a variable of NetCDF."; text 256, "a dataset of the file"),
    key!(surface.periodic in measured.periodic, "", "True if the measured surface is periodic."; flag),
    key!(surface.pixel_m in measured.pixel_m, "", "Pixel size of the measured surface. 0: the file \
         states it."; number Limits {
        low: 0.0, above: false, high: 0.1, unit: " m", unit_name: "metres", slip: Some((1e-6, "micrometres")),
        note: "pixel size; 0 if the file contains it",
    }),
    key!(surface.size_m in measured.size_m, "", "Size of the measured scan along x, instead of `pixel_m`. 0: \
         the file states it."; number Limits {
        low: 0.0, above: false, high: 100.0, unit: " m", unit_name: "metres",
        slip: Some((1e-6, "micrometres")),
        note: "size of the scan along x; 0 if the file contains it",
    }),
    key!(surface.size_y_m in measured.size_y_m, "", "Size of the measured scan along y, with `size_m`. 0: \
         square pixels."; number Limits {
        low: 0.0, above: false, high: 100.0, unit: " m", unit_name: "metres",
        slip: Some((1e-6, "micrometres")),
        note: "size of the scan along y; 0 for square pixels",
    }),
    key!(surface.unit in measured.unit, "", "Unit of the measured heights. Empty: the file states it.";
        length "the unit of the heights, for example \"nm\""),
    key!(surface.skip_lines in measured.skip_lines, "", "Lines at the beginning of a text that are skipped.";
        count 0 to 1000000, &[], "lines to skip; default 0"),
    key!(surface.width in measured.width, "", "Points per scan line of a text with one column. 0: the lines \
         of the text are scan lines."; count 0 to 1000000, &[],
        "points per scan line; 0 if the lines of the text are scan lines"),
    key!(surface.transpose in measured.transpose, "", "If true, x and y of the measured surface are \
         exchanged."; flag),
    key!(surface.missing in measured.missing, "", "Treatment of missing points of a measured surface.";
        word Missing),
    key!(surface.detrend in measured.detrend, "", "Form removed from a measured surface (levelling, \
         F-operator). The default of a periodic surface is `mean`."; word Detrend),
    key!(surface.filter in measured.filter, "", "Low-pass filter (S-filter) of a measured surface. Its \
         cut-off wavelength is `points_per_shortest_wavelength` pixels."; word Filter),
    key!(surface.outliers in measured.outliers, "", "If true, isolated outliers of a measured surface are \
         replaced by their surroundings: points and groups of up to four points beyond 6 robust standard \
         deviations of their neighbours. If false, they cause a warning."; flag),
    key!(surface.align_rows in measured.align_rows, "", "If true, the offsets of scan lines of a measured \
         surface are removed (median of differences). If false, offsets cause a warning."; flag),
    key!(surface.fast_axis in measured.fast_axis, "", "Direction of the scan lines, with `align_rows = \
         true`."; word FastAxis),
    key!(surface.tip_radius_m in measured.tip_radius_m, "R_tip", "Radius of the tip that measured the \
         surface. Wavelengths below its reliability cut-off are removed. 0: no tip, or \
         unknown."; number Limits {
        low: 0.0, above: false, high: 1e-2, unit: " m", unit_name: "metres", slip: Some((1e-9, "nanometres")),
        note: "R_tip, tip radius; 0 if there is no tip, or its radius is unknown",
    }),
    key!(material.contact_modulus_pa in material.contact_modulus_pa, "E*", "Reduced modulus: `1/E* = (1 − \
         ν1²)/E1 + (1 − ν2²)/E2`; `E/(1 − ν²)` against a rigid surface."; number Limits {
        low: 1.0, above: false, high: 1e13, unit: " Pa", unit_name: "pascals",
        slip: Some((1e6, "megapascals")), note: "",
    }),
    key!(material.work_of_adhesion_j_m2 in material.work_of_adhesion_j_m2, "Δγ", "Work of adhesion. 0: \
         Hertzian asperities without dissipation."; number Limits {
        low: 0.0, above: false, high: 1e3, unit: " J/m²", unit_name: "joules per square metre",
        slip: Some((1e-3, "millijoules per square metre")),
        note: "0 is the adhesionless limit: Hertzian asperities without dissipation",
    }),
    key!(material.interaction_range_m in material.interaction_range_m, "ε", "Range of adhesion. It enters \
         the Tabor parameter, the jump-in criterion of Wu and, with `opening = \"strength\"`, the strength \
         inside contacts of boundary elements."; number Limits {
        low: 1e-12, above: false, high: 1e-5, unit: " m", unit_name: "metres",
        slip: Some((1e-9, "nanometres")), note: "",
    }),
    key!(model.method in method, "", "Method of the cycle. Boundary elements read none of the other keys of \
         this table, and refuse `boundary = \"isolated\"` for periodic surfaces."; word Method),
    key!(model.interaction in asperities.interaction, "", "Elastic interaction between contact spots.";
        word Interaction),
    key!(model.boundary in asperities.boundary, "", "Surroundings of the nominal square."; word Boundary),
    key!(model.coalescence in asperities.coalescence, "", "Rule for contact spots that grow together.";
        word Coalescence),
    key!(model.jump_in in asperities.jump_in, "", "Criterion for the jump of a free asperity into contact.";
        word JumpIn),
    key!(model.as_printed in as_printed, "", "Errata of the paper that are restored: equations used as \
         printed."; Kind::Words(Slip::MEANINGS),
        |slips: &Vec<Slip>| Value::Words(slips.iter().map(|slip| slip.word()).collect()),
        Words(w) => w.iter().map(|word| Slip::from_word(word)).collect::<Option<Vec<_>>>()),
    key!(model.allow_low_tabor in asperities.allow_low_tabor, "", "With `jump_in = \"wu\"`, a Tabor \
         parameter below 2 is an error. If true, it is a warning."; flag),
    key!(boundary_elements.points in elements.points, "", "Grid points along a side. 0: the smallest power \
         of two with 16 points per shortest wavelength, at most 4096. Outside of sweeps a list such as \
         [64, 128, 256] takes the finest grid, and repeats each loop on the coarser ones for the \
         discretization error."; optional count to 4096,
        "grid points along a side; 0 for 16 points per shortest wavelength; at most 4096"),
    key!(boundary_elements.points_per_wavelength in elements.per_wavelength, "", "Grid points per shortest \
         wavelength of the roughness, or of the filter cut-off of a scan, instead of `points`: the grid of \
         each case is the smallest power of two with as many, at most 4096. 12 points per JKR radius of a \
         probe count as 16. Outside of sweeps a list such as [4, 8, 16] is a list of grids. 0: \
         `points` holds."; optional count to 256,
        "grid points per shortest wavelength, 4 to 256, instead of points; 0: not used"),
    key!(boundary_elements.error in goal.error, "", "Relative grid error of the mean dissipated energy, \
         instead of `points`: grids are doubled from 4, 8 and 16 points per shortest wavelength on until the \
         estimated error of each case is at most this, or `max_points` is reached. 0: no such \
         goal."; optional number Limits {
        low: 0.0, above: false, high: 1.0, unit: "", unit_name: "", slip: None,
        note: "relative grid error of Θ, 0.005 to 1; 0.05 is 5 %",
    }),
    key!(boundary_elements.max_points in goal.max_points, "", "Maximum number of grid points along a side \
         with `error`."; count 16 to 4096, &[],
        "grid points along a side, at most, with error; default 1024"),
    key!(boundary_elements.shifted_copies in goal.shifted_copies, "", "Copies of the coarsest grid of a \
         list, or of `error`, with its points shifted by parts of its spacing. The scatter of their results \
         is part of the grid error. For periodic surfaces without a probe."; count 0 to 8, &[],
        "shifted copies of the coarsest grid, for the grid error; default 0, useful 3"),
    key!(boundary_elements.attraction in attraction, "", "Attraction between the surfaces.";
        word AttractionKind),
    key!(boundary_elements.range_m in range_m, "ρ", "Range of the Morse law with `attraction = \"range\"`. \
         0: 0.8 sqrt(Δγ dx/E*) at the grid spacing dx."; optional number Limits {
        low: 0.0, above: false, high: 1e-3, unit: " m", unit_name: "metres", slip: Some((1e-9, "nanometres")),
        note: "ρ, range of the Morse law; 0 for 0.8 sqrt(Δγ dx/E*)",
    }),
    key!(boundary_elements.nucleation in nucleation, "", "Gap at which a point comes into contact, with \
         `attraction = \"bonded\"`."; word Nucleation),
    key!(boundary_elements.opening in opening, "", "Where contact opens, with `attraction = \"bonded\"`.";
        word Opening),
    key!(boundary_elements.law in law, "", "Law of the edges of contact, with `attraction = \"bonded\"`. \
         \"corrected\" reduces the errors of first order in the grid spacing, for 1.2 to 1.8 times the \
         transforms.";
        word FrontLaw),
    key!(boundary_elements.approach_step in elements.approach_step, "", "Step of the mean penetration, as a \
         fraction of h_rms. A sixth of it where adhesion is weak (U_el > 15 Δγ), a thirtieth at U_el > 150 \
         Δγ. Steps in which an event leaves its energy uncertain are halved, see `halvings`."; number Limits {
        low: 1e-3, above: false, high: 0.2, unit: "", unit_name: "", slip: None,
        note: "step of Δ/h_rms of boundary elements; default 0.03",
    }),
    key!(boundary_elements.halvings in elements.halvings, "", "Most halvings of a step in which an event \
         leaves its energy uncertain. 0: steps of one length, except near F_max; events are not located \
         within them."; count 0 to 10, &[],
        "most halvings of a step; 0 for steps of one length; default 6"),
    key!(boundary_elements.precision in elements.precision, "", "Tolerance of an equilibrium: rms residual \
         of the pressure over the maximum tension. A sixth of it where adhesion is weak (U_el > 15 Δγ), a \
         tenth at U_el > 150 Δγ."; number Limits {
        low: 1e-10, above: false, high: 1e-3, unit: "", unit_name: "", slip: None,
        note: "rms residual over the maximum tension; default 1e-4. Above 1e-3 steps end before their \
             events: Θ is up to 50 % too large",
    }),
    key!(cycle.max_load in cycle.max_load, "F_max/(E* A0)", "Load reversals. One loading path passes all of \
         them, and one unloading path starts at each."; Kind::Numbers(Limits {
        low: 0.0, above: true, high: 0.2, unit: "", unit_name: "", slip: None,
        note: "F_max/(E* A0), maximum load, dimensionless; typical 0.004 to 0.015; near full contact above \
             about 0.07",
    }, 64), |loads: &Vec<f64>| Value::Numbers(loads.clone()), Numbers(loads) => Some(loads.clone())),
    key!(cycle.approach_step in asperities.approach_step, "", "Interval of the mean penetration between \
         output steps of the asperity model, as a fraction of h_rms."; number Limits {
        low: 1e-5, above: false, high: 1.0, unit: "", unit_name: "", slip: None,
        note: "maximum output step of Δ/h_rms; default 0.01; 1e-5 gives about 500 000 steps per branch",
    }),
    key!(cycle.contacts in cycle.contacts, "", "Steps at which contact spots are stored."; word KeptContacts),
    key!(cycle.max_force_n in max_force_n, "F_max", "Load reversals in newtons, instead of `max_load`. The \
         size of a scan is read from its file."; Kind::Numbers(Limits {
        low: 0.0, above: true, high: 1e6, unit: " N", unit_name: "newtons",
        slip: Some((1e-6, "micronewtons")), note: "F_max, maximum load",
    }, 64), |loads: &Vec<f64>| Value::Numbers(loads.clone()), Numbers(loads) => Some(loads.clone())),
    key!(cycle.max_pressure_pa in max_pressure_pa, "F_max/A0", "Load reversals as nominal pressures, instead \
         of `max_load`."; Kind::Numbers(Limits {
        low: 0.0, above: true, high: 1e13, unit: " Pa", unit_name: "pascals",
        slip: Some((1e3, "kilopascals")), note: "F_max/A0, maximum nominal pressure",
    }, 64), |loads: &Vec<f64>| Value::Numbers(loads.clone()), Numbers(loads) => Some(loads.clone())),
    key!(probe.radius_m in radius_m, "R", "Radius of a spherical probe that carries the roughness, with its \
         apex in the middle of the square. 0: a flat surface."; optional number Limits {
        low: 0.0, above: false, high: 10.0, unit: " m", unit_name: "metres",
        slip: Some((1e-6, "micrometres")), note: "R, radius of the probe; 0 for a flat surface",
    }),
    key!(machine.compliance_m_n in machine.compliance_m_n, "c", "Compliance of the machine: the controlled \
         displacement is Δ + cF. Not read with `control = \"load\"`."; number Limits {
        low: 0.0, above: false, high: 1e9, unit: " m/N", unit_name: "metres per newton", slip: None,
        note: "c, compliance of the machine; 0 for a stiff one",
    }),
    key!(machine.stiffness_n_m in stiffness_n_m, "1/c", "Stiffness of the machine, instead of \
         `compliance_m_n`. Not read with `control = \"load\"`."; optional number Limits {
        low: 1e-9, above: false, high: 1e15, unit: " N/m", unit_name: "newtons per metre", slip: None,
        note: "1/c, stiffness of the machine, for example that of a cantilever",
    }),
    key!(machine.compliance in machine.far_field, "", "Elastic body at a distance from the contact. The \
         default with a probe on a half-space is `half_space`, else `cell`."; word FarField),
    key!(machine.control in machine.control, "", "Quantity that the machine controls."; word Control),
    key!(substrate.thickness_m in thickness_m, "h", "Thickness of a layer of the elastic material, bonded to \
         a rigid base; for boundary elements. 0: a half-space."; optional number Limits {
        low: 0.0, above: false, high: 10.0, unit: " m", unit_name: "metres",
        slip: Some((1e-6, "micrometres")), note: "h, thickness of the layer; 0 for a half-space",
    }),
    key!(substrate.poisson_ratio in poisson_ratio, "ν", "Poisson's ratio of the layer."; number Limits {
        low: 0.0, above: false, high: 0.5, unit: "", unit_name: "", slip: None,
        note: "ν, Poisson's ratio, 0 <= ν <= 0.5; default 0.5",
    }),
];

/// The tables that hold the keys, in the order in which they are shown.
pub(super) const TABLES: [&str; 8] =
    ["surface", "material", "model", "boundary_elements", "cycle", "probe", "machine", "substrate"];

/// Tables that a spec need not have: without them the surface is flat, the half-space deep and the machine
/// stiff.
pub const OPTIONAL_TABLES: [&str; 3] = ["probe", "machine", "substrate"];
/// Keys of `[cycle]` for loads in other units, which are converted.
pub const OTHER_LOADS: [&str; 2] = ["max_force_n", "max_pressure_pa"];

/// Keys of `[boundary_elements]` that choose the grid instead of its points, or serve its error.
pub const OTHER_GRIDS: [&str; 4] = ["points_per_wavelength", "error", "max_points", "shifted_copies"];

/// Keys of `[model]` that the asperity model alone reads.
pub const OF_ASPERITIES: [&str; 5] = ["interaction", "boundary", "coalescence", "jump_in", "allow_low_tabor"];

/// Keys of `[surface]` that describe a measured surface.
pub const MEASURED: [&str; 18] = [
    "file",
    "dataset",
    "periodic",
    "pixel_m",
    "size_m",
    "size_y_m",
    "unit",
    "skip_lines",
    "width",
    "transpose",
    "missing",
    "detrend",
    "filter",
    "outliers",
    "align_rows",
    "fast_axis",
    "tip_radius_m",
    "files",
];
/// Keys of `[surface]` that describe a generated one.
pub const GENERATED: [&str; 15] = [
    "length_m",
    "rms_height_m",
    "hurst",
    "magnification",
    "normalization",
    "amplitudes",
    "longest_wavelength_m",
    "roll_off_m",
    "aspect_ratio",
    "angle_deg",
    "spectrum",
    "spectrum_kind",
    "spectrum_convention",
    "spectrum_unit",
    "spectrum_series",
];
/// Keys of `[surface]` that a tabulated spectrum replaces.
pub const REPLACED: [&str; 4] = ["rms_height_m", "hurst", "normalization", "roll_off_m"];
/// Keys that a resolved spec has only where they are not at their default: those after `amplitudes`.
pub const WHERE_USED: &[&str] = GENERATED.split_at(6).1;
/// Keys of `[surface]` that name the scans of a measured surface: a resolved spec has the one that is used.
pub const NAMES: [&str; 2] = ["file", "files"];
/// Keys of `[surface]` that describe the table of a spectrum: those after `spectrum`.
pub(super) const OF_TABLE: &[&str] = WHERE_USED.split_at(5).1;

/// The place in [`KEYS`] of a key of a table.
pub(super) fn find(table: &str, name: &str) -> Option<usize> {
    KEYS.iter().position(|key| key.table == table && key.name == name)
}

/// The names of the keys of a table.
pub(super) fn names(table: &str) -> impl Iterator<Item = &'static str> {
    KEYS.iter().filter(move |key| key.table == table).map(|key| key.name)
}
