//! Methods paragraph of the report, to be adapted for a publication.

use super::layout::heading;
use crate::stats::{StatsError, labels_with_unit, loads, significant};
use crate::store::{ColumnData, Frame};
use maud::{Markup, html};

/// Parts of a study.
pub(super) struct Study<'a> {
    /// Numbers of cases by the asperity model and by boundary elements.
    pub(super) case_counts: [usize; 2],
    /// Number of realizations in words.
    pub(super) realizations_text: &'a str,
    pub(super) seed: u64,
    /// True if surfaces are measured.
    pub(super) is_measured: bool,
}

/// A paragraph that describes surfaces, methods, material and statistics of a run.
pub(super) fn methods(cases: &Frame, study: &Study<'_>) -> Result<Markup, StatsError> {
    let program = concat!("hysteron ", env!("CARGO_PKG_VERSION"));
    let of = Values { cases };
    let mut text = unfinished(cases)?;
    text += &surfaces(&of, study)?;
    let [asperities, elements] = study.case_counts;
    if asperities > 0 {
        text += &of.asperities(program)?;
    }
    if elements > 0 {
        text += &of.elements(program)?;
    }
    text += &of.probe_and_machine()?;
    text += &of.material()?;
    text += "The dissipated energy Θ is the area of the force–penetration loop. ";
    // Of one surface there is neither a mean nor an interval.
    text += if cases.i64("done_count")?.iter().any(|count| *count > 1) {
        "Values are means over surfaces with 95 % confidence intervals (Student)."
    } else {
        "Values are those of one surface."
    };
    Ok(html! { (heading("Methods paragraph")) pre.text.copy { (text) } "\n" })
}

/// Sentences on the surfaces.
fn surfaces(of: &Values<'_>, study: &Study<'_>) -> Result<String, StatsError> {
    let mut text = String::new();
    let (realizations, seed) = (study.realizations_text, study.seed);
    let scale = match of.words("normalization")?.as_str() {
        "sample" => ", each scaled to the stated rms height",
        "spectrum" => ", whose rms height is that of the spectrum on average",
        _ => "",
    };
    if let (Some(zeta), Some(hurst)) = (of.range("magnification")?, of.range("hurst")?) {
        text += &format!(
            "Self-affine rough surfaces with Hurst exponent H = {hurst} and magnification ζ = {zeta} were \
             generated from their power spectrum ({realizations} per case, seed {seed}){scale}. "
        );
    }
    if !of.words("spectrum_file")?.is_empty() {
        text += &format!(
            "Rough surfaces were generated from a tabulated power spectrum ({realizations} per case, seed \
             {seed}){scale}. "
        );
    }
    if study.is_measured {
        text += "Measured surfaces were levelled, filtered and cropped as listed in this report. ";
    }
    Ok(text)
}

/// Values of the parameters in all cases.
struct Values<'a> {
    cases: &'a Frame,
}

impl Values<'_> {
    /// Range of a column with its unit; nothing if all values are null.
    fn range(&self, column: &str) -> Result<Option<String>, StatsError> {
        let values: Vec<f64> = match self.cases.column(column)? {
            ColumnData::I64(all) => all.iter().flatten().map(|value| *value as f64).collect(),
            _ => self.cases.f64_or_null(column)?.iter().flatten().copied().collect(),
        };
        Ok(ends(&values).map(|[low, high]| {
            let texts = labels_with_unit(column, &[low, high]);
            if low == high { texts[..1].concat() } else { texts.join(" to ") }
        }))
    }

    /// Words of a column in their order, joined; empty if all are null.
    fn words(&self, column: &str) -> Result<String, StatsError> {
        let mut words: Vec<String> = Vec::new();
        for word in self.cases.text_or_null(column)?.iter().flatten().filter(|word| !word.is_empty()) {
            if !words.contains(word) {
                words.push(word.clone());
            }
        }
        Ok(words.join(" or "))
    }

    fn asperities(&self, program: &str) -> Result<String, StatsError> {
        let interaction = match self.words("interaction")?.as_str() {
            "none" => "JKR asperities without elastic interaction",
            _ => "elastically interacting JKR asperities",
        };
        let coalescence = match self.words("coalescence")?.as_str() {
            "merge" => "overlapping contacts merged at equal area".to_owned(),
            "cover" => "overlapping contacts absorbed by the larger one".to_owned(),
            "none" => "overlap of contacts not corrected".to_owned(),
            several => format!("treatment of overlapping contacts: {several}"),
        };
        Ok(format!(
            "Loading–unloading cycles of {interaction} were computed with {program} after Violano and \
             Afferrante (2021), with corrected equations, {coalescence}. "
        ))
    }

    fn elements(&self, program: &str) -> Result<String, StatsError> {
        let grid = self.range("element_points")?.unwrap_or_default();
        let mut text = format!(
            "Adhesive boundary-element cycles were computed with {program} on grids of {grid} points a side"
        );
        if let Some(waves) = self.per_wavelength()? {
            text += &format!(", {waves} per shortest wavelength");
        }
        text += &match self.words("attraction")?.as_str() {
            "bonded" => ", in the limit of short-ranged adhesion (JKR)".to_owned(),
            "range" => {
                format!(
                    ", with a Morse law of the range {}",
                    self.range("attraction_range_m")?.unwrap_or_default()
                )
            }
            _ => ", in part with short-ranged adhesion (JKR), in part with a Morse law".to_owned(),
        };
        text += &match self.words("front_law")?.as_str() {
            "" => ". ".to_owned(),
            law => format!("; law of the contact front: {law}. "),
        };
        let errors: Vec<f64> = self.cases.f64_or_null("loss_grid_error")?.iter().flatten().copied().collect();
        text += &match ends(&errors) {
            None => "The error of Θ by the grid was not estimated. ".to_owned(),
            Some([low, high]) => {
                let [low, high] = [low, high].map(|error| significant(100.0 * error, 2));
                let range = if low == high { high } else { format!("{low} to {high}") };
                format!(
                    "The error of Θ by the grid, estimated from coarser grids (Roache 1994), is {range} %. "
                )
            }
        };
        Ok(text)
    }

    /// Grid points per shortest wavelength of the surfaces by boundary elements.
    fn per_wavelength(&self) -> Result<Option<String>, StatsError> {
        let values = self.cases.f64_or_null("elements_per_wavelength_mean")?;
        let values: Vec<f64> = values.iter().flatten().copied().collect();
        Ok(ends(&values).map(|[low, high]| {
            let [low, high] = [low, high].map(|value| significant(value, 2));
            if low == high { low } else { format!("{low} to {high}") }
        }))
    }

    /// Sentences on a probe, a layer, the machine and its control; empty for a periodic cell.
    fn probe_and_machine(&self) -> Result<String, StatsError> {
        let mut text = String::new();
        if let Some(radius) = self.range("probe_radius_m")? {
            text += &format!("The rough surface is that of a spherical probe of the radius {radius}. ");
        }
        if let (Some(layer), Some(ratio)) = (self.range("layer_thickness_m")?, self.range("poisson_ratio")?) {
            text += &format!(
                "The elastic body is a layer of the thickness {layer}, bonded to a rigid base, with \
                 Poisson's ratio {ratio}. "
            );
        }
        let compliance = self.cases.f64_or_null("machine_compliance_m_n")?;
        let compliance: Vec<f64> =
            compliance.iter().flatten().copied().filter(|value| *value > 0.0).collect();
        text += &match (self.words("control")?.as_str(), ends(&compliance)) {
            ("load", _) => "The load was prescribed. ".to_owned(),
            ("displacement", None) => "The displacement was prescribed. ".to_owned(),
            ("displacement", Some([low, high])) => {
                let [low, high] = [low, high].map(|value| significant(value, 3));
                let range = if low == high { high } else { format!("{low} to {high}") };
                format!("The displacement was prescribed behind a machine compliance of {range} m/N. ")
            }
            _ => "The displacement or the load was prescribed. ".to_owned(),
        };
        Ok(text)
    }

    fn material(&self) -> Result<String, StatsError> {
        let mut values = Vec::new();
        for (words, column) in [
            ("the reduced modulus was E* = ", "contact_modulus_pa"),
            ("the work of adhesion Δγ = ", "work_of_adhesion_j_m2"),
            ("the rms height h_rms = ", "rms_height_m"),
            ("the side of the nominal area L = ", "length_m"),
        ] {
            values.extend(self.range(column)?.map(|range| format!("{words}{range}")));
        }
        let loads = loads(self.cases)?;
        let symbol = loads.symbol.replace("_{0}", "₀").replace("_{max}", "_max");
        if let Some([low, high]) = ends(&loads.values) {
            let row = |value: f64| loads.values.iter().position(|load| *load == value);
            let texts = loads.labels([row(low), row(high)].into_iter().flatten());
            let range = if low == high { texts[..1].concat() } else { texts.join(" to ") };
            values.push(format!("the maximum load {symbol} = {range}"));
        }
        let mut text = values.join(", ");
        if let Some(first) = text.get_mut(..1) {
            first.make_ascii_uppercase();
        }
        Ok(if text.is_empty() { text } else { text + ". " })
    }
}

/// The smallest and the largest of some values.
fn ends(values: &[f64]) -> Option<[f64; 2]> {
    let [low, high] =
        [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick));
    low.zip(high).map(|(low, high)| [low, high])
}

/// A sentence on planned cycles without a result; empty if all have one.
fn unfinished(cases: &Frame) -> Result<String, StatsError> {
    let (ids, done, planned) =
        (cases.text("case_id")?, cases.i64("done_count")?, cases.i64("planned_count")?);
    let firsts: Vec<usize> =
        (0..ids.len()).filter(|row| ids.iter().position(|id| id == &ids[*row]) == Some(*row)).collect();
    let sum = |counts: &[i64]| firsts.iter().map(|row| counts[*row]).sum::<i64>();
    let (done, planned) = (sum(&done), sum(&planned));
    Ok(if done < planned {
        format!("Results exist for {done} of {planned} planned cycles. ")
    } else {
        String::new()
    })
}
