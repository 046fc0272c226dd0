//! Templates of specs, which `init` prints.

/// A template.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Template {
    Quickstart,
    Sweep,
    Scan,
    Spectrum,
    Probe,
    Loop,
    Full,
}

impl Template {
    /// All templates, each with its name and its purpose.
    pub(super) const ALL: [(Self, &'static str, &'static str); 7] = [
        (Self::Quickstart, "quickstart", "a soft and a stiff contact, generated surfaces: runs in seconds"),
        (Self::Sweep, "sweep", "parameter sweeps around a reference case"),
        (Self::Scan, "scan", "a measured surface"),
        (Self::Spectrum, "spectrum", "a tabulated power spectral density, with an example psd.csv"),
        (Self::Probe, "probe", "a spherical probe, in newtons and metres: runs in seconds"),
        (Self::Loop, "loop", "a measured loop next to a simulated one, with an example loop.csv"),
        (Self::Full, "full", "every key with its default"),
    ];

    /// Name and text of a file that the spec names.
    pub(super) fn example(self) -> Option<(&'static str, &'static str)> {
        match self {
            Self::Spectrum => Some(("psd.csv", include_str!("templates/psd.csv"))),
            Self::Loop => Some(("loop.csv", include_str!("../../data/examples/probe_loop.csv"))),
            _ => None,
        }
    }

    /// The text of the spec.
    pub(super) fn text(self) -> &'static str {
        match self {
            Self::Quickstart => include_str!("templates/quickstart.toml"),
            Self::Sweep => include_str!("templates/sweep.toml"),
            Self::Scan => include_str!("templates/scan.toml"),
            Self::Spectrum => include_str!("templates/spectrum.toml"),
            Self::Probe => include_str!("templates/probe.toml"),
            Self::Loop => include_str!("templates/loop.toml"),
            Self::Full => include_str!("templates/full.toml"),
        }
    }
}
