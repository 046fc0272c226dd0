//! Templates of specs, which `init` prints.

/// A template.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Template {
    Quickstart,
    Sweep,
    Scan,
    Full,
}

impl Template {
    /// All templates, each with its name and its purpose.
    pub(super) const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::Quickstart, "quickstart", "a soft and a stiff contact, generated surfaces: runs in seconds"),
        (Self::Sweep, "sweep", "parameter sweeps around a reference case"),
        (Self::Scan, "scan", "a measured surface"),
        (Self::Full, "full", "every key with its default"),
    ];

    /// The text of the spec.
    pub(super) fn text(self) -> &'static str {
        match self {
            Self::Quickstart => include_str!("templates/quickstart.toml"),
            Self::Sweep => include_str!("templates/sweep.toml"),
            Self::Scan => include_str!("templates/scan.toml"),
            Self::Full => include_str!("templates/full.toml"),
        }
    }
}
