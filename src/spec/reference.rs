//! The reference page of the keys of a spec, from the table of keys.

use super::figures::{DEFAULT_FONT, LONGEST_FONT, WIDTH};
use super::keys::{KEYS, Key, Kind, Limits, MEASURED, TABLES};
use super::number::short;
use super::realizations::{DEFAULT, DEFAULT_BOUNDS, LEAST, PRECISION};
use super::top::DEFAULT_SEED;
use super::write::value;
use super::{MAX_CASES, MAX_REALIZATIONS, Value, Values};
use crate::lengths::LENGTHS;
use crate::model::{Choice, Goal};
use crate::text::paragraph;

const HEAD: &str = "\
# Spec keys

Written by `hysteron schema --write` from `src/spec/keys.rs`; do not edit.

This page lists every key of a spec with its type, unit, range and default. Only `name` is required.
A spec is a TOML file. [Parameter sweeps](howto_sweep.md) explains how sweeps combine, and the
[glossary](glossary.md) defines the terms. An empty cell means that there is no symbol, unit or
range. The last column names the stage that reads a key first: a changed value makes the tasks of
this stage and of later stages pending.

Editors that read JSON Schema complete and check a spec. For the extension Even Better TOML
(Taplo), begin the file with the path or the address of `schemas/spec.v1.json`:

```toml
#:schema ../schemas/spec.v1.json
```

`hysteron schema spec.v1.json` prints the schema.
";

const SWEEP: &str = "
```toml
[[sweep]]
name = \"adhesion\"
material.work_of_adhesion_j_m2 = [0.01, 0.02, 0.05]
```

- A value replaces the value of the section for all cases of the sweep.
- An array of values gives one case for each value.
- Arrays in one sweep multiply. Several sweeps add up. Equal cases are computed once.
- `zip = [\"surface.magnification\", \"boundary_elements.points\"]` names keys whose arrays advance
  together: the first values make one case, the second values the next. The arrays have equally many
  values. Several groups are an array of arrays.
- A key that holds an array (`max_load`, `as_printed`) is swept with an array of arrays.
";

const FILES: &str = "
## `auto_methods`

The program writes this line to `campaign.toml` of a run in which `method = \"auto\"` chose different
methods: one for each case, in the order of the sweeps. Leave it out of your own specs.

## `scan_sides_m`

The program writes this line to `campaign.toml` of a run with `max_force_n` on a measured surface:
the side of the square \\[m\\], read from the scan. It has one number, or one for each case in the
order of the sweeps. Leave it out of your own specs.

## `[files]`

The program writes this section to `campaign.toml` of a run: the BLAKE3 checksum of each measured
file, 64 hexadecimal digits. Leave it out of your own specs.
";

/// The page in Markdown.
#[must_use]
pub fn reference() -> String {
    let mut page = format!("{HEAD}{}", top());
    for name in TABLES {
        page += &section(name);
    }
    let cases = paragraph("- ", &format!("The sweeps of a spec make at most {MAX_CASES} cases."));
    page += &experiment();
    page + "\n## `[[sweep]]`\n\n" + &overridden() + "\n" + SWEEP + &cases + "\n" + FILES
}

/// The tables whose keys a sweep overrides, as a paragraph.
fn overridden() -> String {
    let tables = TABLES.map(|name| format!("`[{name}]`"));
    let (last, others) = tables.split_last().map_or(("", &tables[..0]), |(last, others)| (last, others));
    let list = format!("{} and {last}", others.join(", "));
    paragraph(
        "",
        &format!("A sweep has a `name` (as above, unique in the spec) and overrides keys of {list}:"),
    )
}

/// The keys outside of the tables.
fn top() -> String {
    let seed = i64::MAX;
    let (least, most) = DEFAULT_BOUNDS;
    let goals: String = Goal::MEANINGS.iter().map(|(word, meaning)| entry(word, meaning)).collect();
    let text = format!(
        "
## Top level

| key | type | range | default |
|---|---|---|---|
| `name` | string | 1 to 64 of A–Z, a–z, 0–9, `-`, `_` | required |
| `seed` | integer | 0 to {seed} | `{DEFAULT_SEED}` |
| `realizations` | integer or table | 1 to {MAX_REALIZATIONS} | `{DEFAULT}` |
| `realizations.until_relative_ci` | float | {} | required in the table |
| `realizations.of` | string | | `\"{}\"` |
| `realizations.min` | integer | {LEAST} to {MAX_REALIZATIONS} | `{least}` |
| `realizations.max` | integer | `min` to {MAX_REALIZATIONS} | `{most}` |
| `figures.format` | string or array of strings | | `[\"svg\", \"png\", \"pdf\"]` |
| `figures.width_mm` | float | {} | `88` |
| `figures.font` | string | 1 to {LONGEST_FONT} bytes | `\"{DEFAULT_FONT}\"` |
| `figures.loads` | string | `\"largest\"`, `\"all\"` | `\"largest\"` |
| `figures.across` | array of strings | at least two sweeps | none |

- `name`: Name of the run and of its default output directory.
- `seed`: Seed of all generated surfaces. The same seed gives the same surfaces.
- `realizations`: Number of surfaces of each case. A table chooses it automatically:
  `realizations = {{ until_relative_ci = 0.05, of = \"loss\" }}`. A scan is one realization.
- `realizations.until_relative_ci`: Realizations are added until the half-width of the 95 %
  confidence interval of the mean is below this fraction of the mean, at every load.
- `realizations.of`: Quantity whose mean is considered.
",
        range(&PRECISION),
        Goal::Loss.word(),
        range(&WIDTH)
    );
    text + &goals
        + "- `realizations.min`, `realizations.max`: Minimum and maximum number of realizations.\n\
           - `figures.format`: File formats of the figures. PNG and PDF need a build with\n  \
           `--features raster`.\n\
           - `figures.width_mm`: Width in millimetres of a panel in PNG and PDF files. Labels next to a\n  \
           panel add to it.\n\
           - `figures.font`: Font family of the SVG files. PNG and PDF files have DejaVu Sans.\n\
           - `figures.loads`: Loads in the figures of sweeps of other parameters. Tables have all loads.\n\
           - `figures.across`: Names of sweeps with figures of all of their cases together, such as\n  \
           `[\"coarse\", \"fine\"]`. Several groups are an array of arrays.\n"
}

/// The table of measured loops.
fn experiment() -> String {
    use super::experiment::{MEANINGS, MODULUS, RADIUS, STIFFNESS, WORDS};
    let mut section = "\n## `[experiment]`\n\nMeasured loops for comparison with the simulated ones:\n\
         [My loop next to the simulated one](howto_loop.md).\n\n| key | type | unit | range | default \
         |\n|---|---|---|---|---|\n"
        .to_owned();
    let mut meanings = String::new();
    for (name, kind, meaning) in MEANINGS {
        let default = if name == "loops" { "required" } else { "" };
        section += &format!("| `experiment.{name}` | {kind} | | | {default} |\n");
        meanings += &(paragraph("- ", &format!("`experiment.{name}`: {meaning}")) + "\n");
    }
    for (name, words) in WORDS {
        section += &format!("| `experiment.{name}` | string | | | `\"{}\"` |\n", words[0].0);
        meanings += &format!("- `experiment.{name}`:\n");
        meanings.extend(words.iter().map(|(word, meaning)| entry(word, meaning)));
    }
    let numbers =
        [("probe_radius_m", RADIUS), ("contact_modulus_pa", MODULUS), ("machine_stiffness_n_m", STIFFNESS)];
    for (name, limits) in numbers {
        section +=
            &format!("| `experiment.{name}` | float | {} | {} | |\n", limits.unit.trim(), range(&limits));
        meanings += &(paragraph("- ", &format!("`experiment.{name}`: {}.", limits.note)) + "\n");
    }
    section + "\n" + &meanings
}

/// A table of the spec: an overview, then the meaning of each key.
fn section(table: &str) -> String {
    let mut section = format!(
        "\n## `[{table}]`\n\n| key | symbol | type | unit | range | default | stage \
         |\n|---|---|---|---|---|---|---|\n"
    );
    let keys = || KEYS.iter().filter(|key| key.table == table);
    for key in keys() {
        let (kind, unit, range) = described(&key.kind);
        let symbol = if key.symbol.is_empty() { String::new() } else { format!("`{}`", key.symbol) };
        let cells = [
            format!("`{}`", key.path),
            symbol,
            kind.to_owned(),
            unit.to_owned(),
            range,
            default(key),
            key.stage().to_owned(),
        ];
        section += &format!("| {} |\n", cells.join(" | "));
    }
    section.push('\n');
    for key in keys() {
        let more = match &key.kind {
            Kind::Numbers(_, most) => format!(" Up to {most} values, each once."),
            Kind::Texts(most, ..) => format!(" Up to {most}, each once."),
            Kind::Length(_) => format!(" Units: {LENGTHS}."),
            _ => String::new(),
        };
        section += &paragraph("- ", &format!("`{}`: {}{more}", key.name, key.meaning));
        section.push('\n');
        if let Kind::Word(choice) | Kind::Words(choice) = &key.kind {
            section.extend(choice.iter().map(|(word, meaning)| entry(word, meaning)));
        }
    }
    if table == "surface" {
        let names: Vec<String> = MEASURED.iter().map(|name| format!("`{name}`")).collect();
        section.push('\n');
        section += &paragraph("", &format!("Keys of a measured surface: {}.", names.join(", ")));
        section.push('\n');
    }
    section
}

/// One word of a choice as an entry of an inner list.
fn entry(word: &str, meaning: &str) -> String {
    paragraph("  - ", &format!("`\"{word}\"`: {meaning}")) + "\n"
}

/// Type, unit and range.
pub(super) fn described(kind: &Kind) -> (&'static str, &'static str, String) {
    match kind {
        Kind::Number(limits) => ("float", limits.unit.trim(), range(limits)),
        Kind::Numbers(limits, _) => ("array of floats", limits.unit.trim(), range(limits)),
        Kind::Count { low, high, .. } => ("integer", "", format!("{low} to {high}")),
        Kind::Flag => ("boolean", "", String::new()),
        Kind::Word(_) | Kind::Text(..) | Kind::Length(_) => ("string", "", String::new()),
        Kind::Words(_) | Kind::Texts(..) => ("array of strings", "", String::new()),
    }
}

fn range(limits: &Limits) -> String {
    let (low, high) = (short(limits.low), short(limits.high));
    if limits.above { format!("> {low} to {high}") } else { format!("{low} to {high}") }
}

/// The default as TOML; nothing for an empty text.
fn default(key: &Key) -> String {
    match (key.get)(&Values::default()) {
        Value::Text(text) if text.is_empty() => String::new(),
        Value::Texts(texts) if texts.is_empty() => String::new(),
        Value::Number(number) => format!("`{}`", short(number)),
        known => format!("`{}`", value(&known)),
    }
}
