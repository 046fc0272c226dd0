//! A measured surface of a case: its files and their treatment.

use super::{Detrend, FastAxis, Filter, Missing};

/// A measured surface and its treatment.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSurface {
    /// Its file; empty with several.
    pub file: String,
    /// Files of several scans, which are the realizations of one case; empty with one.
    pub files: Vec<String>,
    /// Which of the file's fields it is; empty for the only one.
    pub dataset: String,
    /// True if it continues periodically.
    pub periodic: bool,
    /// Distance of its points \[m\], if the file does not state it; else 0.
    pub pixel_m: f64,
    /// Size of the scan along x \[m\], where the file does not state it; else 0.
    pub size_m: f64,
    /// Size of the scan along y \[m\]; 0 for square pixels.
    pub size_y_m: f64,
    /// Unit of its heights, if the file does not state it.
    pub unit: String,
    /// Lines of a text that are not read.
    pub skip_lines: u32,
    /// Points of a scan line of a text whose lines are none; else 0.
    pub width: u32,
    /// True to exchange x and y.
    pub transpose: bool,
    /// Treatment of missing points.
    pub missing: Missing,
    /// Shape that is removed from its heights by least squares; the mean alone if it is periodic.
    pub detrend: Detrend,
    /// Low-pass filter.
    pub filter: Filter,
    /// Cut-off wavelength of the filter in pixels.
    pub points_per_shortest_wavelength: u32,
    /// True if outliers are replaced.
    pub outliers: bool,
    /// True if the offsets of scan lines are removed.
    pub align_rows: bool,
    /// Direction of the scan lines.
    pub fast_axis: FastAxis,
    /// Radius of the tip that measured it \[m\]; 0 if it is unknown or sharp.
    pub tip_radius_m: f64,
}

impl MeasuredSurface {
    /// True if a file or several are named.
    #[must_use]
    pub fn is_named(&self) -> bool {
        !self.file.is_empty() || !self.files.is_empty()
    }

    /// Names of the files: one, or those of the realizations in their order.
    #[must_use]
    pub fn names(&self) -> &[String] {
        if self.files.is_empty() { std::slice::from_ref(&self.file) } else { &self.files }
    }

    /// Names of the files, to be changed.
    pub fn names_mut(&mut self) -> &mut [String] {
        if self.files.is_empty() { std::slice::from_mut(&mut self.file) } else { &mut self.files }
    }

    /// The scan of one realization: the same treatment of one file. It is the surface itself if it has one
    /// file.
    #[must_use]
    pub fn scan(&self, realization: u32) -> Self {
        let Some(file) = self.files.get(realization as usize) else { return self.clone() };
        Self { file: file.clone(), files: Vec::new(), ..self.clone() }
    }
}

impl Default for MeasuredSurface {
    fn default() -> Self {
        Self {
            file: String::new(),
            files: Vec::new(),
            dataset: String::new(),
            periodic: false,
            pixel_m: 0.0,
            size_m: 0.0,
            size_y_m: 0.0,
            unit: String::new(),
            skip_lines: 0,
            width: 0,
            transpose: false,
            missing: Missing::Refuse,
            detrend: Detrend::Plane,
            filter: Filter::Gaussian,
            points_per_shortest_wavelength: 8,
            outliers: false,
            align_rows: false,
            fast_axis: FastAxis::Auto,
            tip_radius_m: 0.0,
        }
    }
}
