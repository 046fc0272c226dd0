//! Stage report: the figures of all sweeps and the HTML report.

use super::closer::{self, Look};
use super::done::{Clock, Outcome};
use super::methods::{BothFigures, contact_maps, side_by_side};
use super::page::{escape, grid, head};
use super::reading;
use super::scans::scans;
use super::theories::theories;
use super::trust::{Cases, split, trust};
use super::{StageError, Tally, Watch, incomplete};
use crate::campaign::{Campaign, CaseUnit, REPORT_PAGE, STATISTICS, Stage, Standing, Unit};
use crate::figures::{Panel, Tables, method_ratios, panels, pdf, png, table};
use crate::schema;
use crate::stats::summary;
use crate::store::Frame;
use crate::store::commit::Written;
use crate::store::{Check, commit, parquet};
use crate::text::counted;
use std::fmt::Write as _;
use std::path::Path;

pub(super) fn run(campaign: &Campaign, (cycles_check, check): (Check, Check), watch: &dyn Watch) -> Result<Tally, StageError> {
    let clock = Clock::start();
    let standings = campaign.cycle_standings(cycles_check);
    let statistics = campaign.statistics_key(&standings);
    let key = campaign.report_key(&statistics);
    let unit = Unit { stage: Stage::Report, id: REPORT_PAGE, key: &key };
    let mut tally = Tally { planned: 1, ..Tally::default() };
    if campaign.standing(&unit, check) == Standing::Done {
        tally.before = 1;
        watch.begin(Stage::Report, 1, 1);
        watch.end(Stage::Report);
        return Ok(tally);
    }
    let standing = campaign.standing(&Unit { stage: Stage::Aggregate, id: STATISTICS, key: &statistics }, check);
    if let Some(error) = incomplete(campaign, Stage::Report, &[("statistics".to_owned(), standing)]) {
        return Err(error);
    }
    watch.begin(Stage::Report, 0, 1);
    let cases = parquet::read_table(&campaign.statistics_path("cases"), &schema::CASES)?;
    let curves = parquet::read_table(&campaign.statistics_path("curves"), &schema::CURVES)?;
    let realizations = parquet::read_table(&campaign.statistics_path("realizations"), &schema::REALIZATIONS)?;
    let methods = parquet::read_table(&campaign.statistics_path("methods"), &schema::METHODS)?;
    let tables = Tables { cases: &cases, curves: &curves, realizations: &realizations };
    let (mut drawings, mut files) = (Vec::new(), Vec::new());
    for sweep in sweeps(campaign) {
        for panel in panels(&tables, &sweep)? {
            drawings.push((sweep.clone(), panel));
        }
    }
    let look = closer::look(campaign, &standings, &cases)?;
    let close = look.iter().flat_map(|look| &look.panels);
    for panel in drawings.iter().map(|(_, panel)| panel).chain(close.clone()) {
        files.extend(write_picture(&campaign.dir, &panel.stem, &panel.svg)?);
    }
    if let Some(map) = look.as_ref().and_then(|look| look.map.as_ref()) {
        files.extend(write_picture(&campaign.dir, "closer_map", map)?);
    }
    let both = BothFigures { ratios: method_ratios(&methods)?, maps: contact_maps(campaign, &standings, &methods)? };
    if let Some(maps) = &both.maps {
        files.extend(write_picture(&campaign.dir, "contact_maps", &maps.svg)?);
    }
    if let Some(ratios) = &both.ratios {
        files.extend(write_picture(&campaign.dir, &ratios.stem, &ratios.svg)?);
    }
    let compared = (&methods, &both);
    let page = page(campaign, &key, (&Cases::of(&cases, &realizations)?, compared), &drawings, look.as_ref())?;
    drawings.extend(close.map(|panel| (String::new(), panel.clone())).collect::<Vec<_>>());
    files.push(parquet::write_table(&campaign.statistics_path("panels"), &table(&drawings)?, &[("key", key.clone())])?);
    files.push(commit::commit_bytes("write the report", &campaign.dir.join("report.html"), page.as_bytes())?);
    clock.receipt(campaign, &unit, campaign.report_preimages(&statistics), &Outcome::of(files))?;
    watch.progress(Stage::Report, 1.0);
    watch.finished(Stage::Report, "report.html");
    watch.end(Stage::Report);
    tally.computed = 1;
    Ok(tally)
}

/// A figure in `figures/` of a folder, in all formats.
pub(super) fn write_picture(dir: &Path, stem: &str, svg: &str) -> Result<[Written; 3], StageError> {
    let write =
        |ending: &str, bytes: &[u8]| commit::commit_bytes("write a figure", &dir.join("figures").join(format!("{stem}.{ending}")), bytes);
    Ok([write("svg", svg.as_bytes())?, write("png", &png(svg)?)?, write("pdf", &pdf(svg)?)?])
}

fn sweeps(campaign: &Campaign) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in campaign.cases.iter().flat_map(|unit| &unit.case.sweeps) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// The methods of a run in sentences.
fn models(campaign: &Campaign) -> String {
    let by_elements = |unit: &&CaseUnit| unit.case.params.by_elements();
    let count = campaign.cases.iter().filter(by_elements).count();
    let mut text = String::new();
    if count < campaign.cases.len() {
        text += "Interacting asperities of Johnson, Kendall and Roberts (JKR) after Violano and Afferrante, Lubricants 9(1):7 (2021), with corrected equations.";
    }
    if count > 0 {
        text += if text.is_empty() { "" } else { " " };
        text += "Adhesive boundary elements: the rough surface on a grid, loaded and unloaded under displacement control.";
    }
    text
}

fn page(
    campaign: &Campaign,
    key: &str,
    (cases, (methods, both)): (&Cases<'_>, (&Frame, &BothFigures)),
    drawings: &[(String, Panel)],
    look: Option<&Look>,
) -> Result<String, StageError> {
    let name = escape(&campaign.spec.name);
    let mut html = head(&format!("{name}: adhesive hysteresis"), &format!("<meta name=\"hysteron-key\" content=\"{key}\">\n"));
    // Writing to a string cannot fail.
    let _ = write!(
        html,
        "<h1>{name}</h1>\n<p>Adhesive hysteresis of rough surfaces: {}, {} each. {} E*: reduced modulus; A<sub>0</sub>: nominal area; \
         h<sub>rms</sub>: root-mean-square height; Δγ: work of adhesion; Δ: mean penetration; F: normal load, positive in compression.</p>\n<pre>{}</pre>\n",
        counted(campaign.cases.len(), "case"),
        campaign.realizations_in_words(),
        models(campaign),
        escape(&summary(cases.frame)?)
    );
    reading::results(&mut html, cases)?;
    side_by_side(&mut html, cases, methods, both)?;
    scans(&mut html, campaign)?;
    let sweeps = sweeps(campaign);
    for (number, sweep) in sweeps.iter().enumerate() {
        let title = if sweep.is_empty() { "Figures".to_owned() } else { format!("Sweep {}", escape(sweep)) };
        let _ = writeln!(html, "<h2>{title}</h2>");
        grid(&mut html, number + 1, drawings.iter().filter(|(of, _)| of == sweep).map(|(_, panel)| panel));
    }
    if let Some(look) = look {
        closer::section(&mut html, sweeps.len() + 1, look);
    }
    theories(&mut html, cases)?;
    split(&mut html, cases)?;
    trust(&mut html, cases)?;
    reading::usage(&mut html);
    let spec = escape(&campaign.spec.to_toml());
    let _ = write!(html, "<h2>Spec with all defaults</h2>\n<pre>{spec}</pre>\n</body>\n</html>\n");
    Ok(html)
}
