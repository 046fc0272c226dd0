//! Stage report: the figures of all sweeps and the HTML report.

use super::contact_maps::contact_maps;
use super::done::{Clock, Outcome};
use super::error::incomplete;
use super::experiment::beside;
use super::explorer::explorer;
use super::grids::grids;
use super::runner::{Context, Single, run_single};
use super::single_cycle::look;
use super::works::works;
use super::{StageError, Tally};
use crate::campaign::{Campaign, CaseUnit, REPORT_PAGE, STATISTICS, Stage, Standing, Unit};
use crate::figures::{
    Drawing, Panel, Spectra, Tables, Units, file, method_ratios, panels, sensitivity, spectra, table,
};
use crate::report::{
    self, Failure, Grids, MeasuredLoops, MethodFigures, Report, ScanSpectra, SingleCycle, Works,
};
use crate::schema;
use crate::spec::Figures;
use crate::store::hdf5::{SurfaceHeader, read_header};
use crate::store::{Check, Frame, commit, parquet};
use std::cmp::Reverse;
use std::collections::HashSet;

/// Tables that the report reads.
struct Statistics {
    cases: Frame,
    curves: Frame,
    realizations: Frame,
    methods: Frame,
    avalanches: Frame,
}

impl Statistics {
    fn read(campaign: &Campaign) -> Result<Self, StageError> {
        let read =
            |table: &'static schema::Table| parquet::read_table(&campaign.statistics_path(table.name), table);
        Ok(Self {
            cases: read(&schema::CASES)?,
            curves: read(&schema::CURVES)?,
            realizations: read(&schema::REALIZATIONS)?,
            methods: read(&schema::METHODS)?,
            avalanches: read(&schema::AVALANCHES)?,
        })
    }
}

/// Figures of the report.
struct Drawings {
    /// Panels, each with the name of its sweep.
    panels: Vec<(String, Panel)>,
    cycles: Vec<SingleCycle>,
    methods: MethodFigures,
    sensitivity: Option<Drawing>,
    measured_loops: Option<MeasuredLoops>,
    scan_spectra: Option<ScanSpectra>,
    works: Option<Works>,
    grids: Option<Grids>,
}

impl Drawings {
    fn of(campaign: &Campaign, standings: &[Standing], statistics: &Statistics) -> Result<Self, StageError> {
        let Statistics { cases, curves, realizations, methods, avalanches } = statistics;
        let all_loads = campaign.spec.figures.has_all_loads();
        let tables = Tables { cases, curves, realizations, avalanches: Some(avalanches), all_loads };
        let mut drawn = Vec::new();
        for sweep in sweeps(campaign).into_iter().chain(across(campaign)) {
            for units in Units::ALL {
                drawn.extend(panels(&tables, &sweep, units)?.into_iter().map(|panel| (sweep.clone(), panel)));
            }
        }
        Ok(Self {
            panels: drawn,
            cycles: look(campaign, standings, cases)?,
            methods: MethodFigures {
                ratios: method_ratios(methods)?,
                maps: contact_maps(campaign, standings, methods)?,
            },
            sensitivity: sensitivity(cases, realizations)?,
            measured_loops: beside(campaign, standings, cases)?,
            scan_spectra: scan_spectra(campaign)?,
            works: works(campaign, cases)?,
            grids: grids(campaign, cases, failures(campaign, standings, true))?,
        })
    }

    /// Every figure: stem of its file, and drawing.
    fn figures(&self) -> impl Iterator<Item = (&str, &str)> {
        let cycle = self.cycles.iter().flat_map(|cycle| &cycle.panels);
        let map = self.cycles.iter().filter_map(|cycle| cycle.map.as_ref());
        let others = map
            .chain(&self.methods.maps)
            .chain(&self.sensitivity)
            .map(|drawing| (drawing.stem, drawing.svg.as_str()));
        let measured = self.measured_loops.iter().map(|of| &of.panel).chain(self.spectra());
        let panels =
            self.panels.iter().map(|(_, panel)| panel).chain(cycle).chain(measured).chain(self.tables());
        panels.map(drawing).chain(others).chain(self.methods.ratios.as_ref().map(drawing))
    }

    /// Panels of works of adhesion and of grids.
    fn tables(&self) -> impl Iterator<Item = &Panel> {
        let grids = self.grids.iter().flat_map(|of| &of.panels);
        self.works.iter().flat_map(|of| &of.panels).chain(grids)
    }

    /// Panels of the spectra of scans.
    fn spectra(&self) -> impl Iterator<Item = &Panel> {
        self.scan_spectra.iter().flat_map(|of| &of.panels)
    }

    /// All panels with the names of their sweeps; those of the single cycle have none.
    fn all_panels(&self) -> Vec<(String, Panel)> {
        let measured = self.measured_loops.iter().map(|of| &of.panel).chain(self.spectra());
        let single = self.cycles.iter().flat_map(|cycle| &cycle.panels).chain(measured).chain(self.tables());
        let cycle = single.map(|panel| (String::new(), panel.clone()));
        self.panels.iter().cloned().chain(cycle).collect()
    }
}

/// Writes the figures and the page, once the tables over realizations are up to date.
pub(super) fn run(context: Context<'_>, cycles_check: Check) -> Result<Tally, StageError> {
    let (campaign, check) = (context.campaign, context.task.check);
    let clock = Clock::start();
    let standings = campaign.cycle_standings(cycles_check);
    let statistics = campaign.statistics_key(&standings);
    let key = campaign.report_key(&statistics);
    let single = Single {
        unit: Unit { stage: Stage::Report, id: REPORT_PAGE, key: &key },
        name: "report.html",
        clock,
    };
    let ready = || {
        let standing =
            campaign.standing(&Unit { stage: Stage::Aggregate, id: STATISTICS, key: &statistics }, check);
        incomplete(campaign, Stage::Report, &[("statistics".to_owned(), standing)])
    };
    let compute = || Ok((write(campaign, &standings, &key)?, campaign.report_preimages(&statistics)));
    run_single(single, context, check, ready, compute)
}

/// Stem of the file and drawing of a panel.
fn drawing(panel: &Panel) -> (&str, &str) {
    (&panel.stem, &panel.svg)
}

/// Writes the figures, their table and the page.
fn write(campaign: &Campaign, standings: &[Standing], key: &str) -> Result<Outcome, StageError> {
    let statistics = Statistics::read(campaign)?;
    let drawings = Drawings::of(campaign, standings, &statistics)?;
    let mut figures = Vec::new();
    for (stem, svg) in drawings.figures() {
        figures.extend(pictures(stem, svg, &campaign.spec.figures)?);
    }
    if let Some(path) = campaign.foreign_figure(&figures) {
        return Err(StageError::Foreign { path });
    }
    let earlier = campaign.earlier_figures(&figures);
    let mut files = Vec::new();
    for (place, bytes) in &figures {
        files.push(commit::commit_bytes("write a figure", &campaign.dir.join(place), bytes)?);
    }
    let page = page(campaign, standings, key, &statistics, &drawings)?;
    let panels = table(&drawings.all_panels())?;
    files.push(parquet::write_table(
        &campaign.statistics_path("panels"),
        &panels,
        &[("key", key.to_owned())],
    )?);
    files.push(commit::commit_bytes("write the report", &campaign.dir.join("report.html"), page.as_bytes())?);
    Ok(Outcome { files, effort: earlier })
}

fn page(
    campaign: &Campaign,
    standings: &[Standing],
    key: &str,
    statistics: &Statistics,
    drawings: &Drawings,
) -> Result<String, StageError> {
    Ok(report::page(&Report {
        name: &campaign.spec.name,
        key,
        case_counts: campaign.case_counts(),
        seed: campaign.spec.seed,
        realizations_text: &campaign.realizations_in_words(),
        failures: &failures(campaign, standings, false),
        cycle_count: campaign.distinct_cycles().iter().filter(|unit| !campaign.is_coarser_grid(unit)).count(),
        cases: &statistics.cases,
        realizations: &statistics.realizations,
        methods: &statistics.methods,
        is_in_si: is_in_si(campaign),
        formats: &campaign.spec.figures.written(),
        sensitivity: drawings.sensitivity.as_ref(),
        method_figures: &drawings.methods,
        scans: &scans(campaign)?,
        measured_loops: drawings.measured_loops.as_ref(),
        scan_spectra: drawings.scan_spectra.as_ref(),
        works: drawings.works.as_ref(),
        grids: drawings.grids.as_ref(),
        sweeps: &sweeps(campaign).into_iter().chain(across(campaign)).collect::<Vec<_>>(),
        drawings: &drawings.panels,
        cycles: &drawings.cycles,
        explorer: explorer(campaign, standings, &statistics.cases, &statistics.methods)?.as_deref(),
        spec: &campaign.labelled_toml(),
    })?)
}

/// True if the spec has a probe, or loads in newtons or pascals.
fn is_in_si(campaign: &Campaign) -> bool {
    let base = &campaign.spec.base;
    let has_probe = campaign.cases.iter().any(|unit| unit.case.params.probe.is_some());
    has_probe || !base.max_force_n.is_empty() || !base.max_pressure_pa.is_empty()
}

/// Spectra of the scans of `surface.files`, and their panels.
fn scan_spectra(campaign: &Campaign) -> Result<Option<ScanSpectra>, StageError> {
    let is_list =
        |unit: &CaseUnit| unit.case.params.surface.measured().is_some_and(|of| !of.files.is_empty());
    if !campaign.cases.iter().any(is_list) {
        return Ok(None);
    }
    let read =
        |table: &'static schema::Table| parquet::read_table(&campaign.statistics_path(table.name), table);
    let (common, of_scans, scans) =
        (read(&schema::SPECTRUM)?, read(&schema::SCAN_SPECTRA)?, read(&schema::SCANS)?);
    let panels = spectra(&Spectra { common: &common, of_scans: &of_scans, scans: &scans })?;
    Ok(Some(ScanSpectra { scans, panels }))
}

/// The words of a text without its numbers.
fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().filter(|word| !word.bytes().any(|byte| byte.is_ascii_digit())).collect()
}

/// Failed cycles of the cases, or of their coarser grids, by reason, the most frequent reason first.
fn failures(campaign: &Campaign, standings: &[Standing], of_coarser_grids: bool) -> Vec<Failure> {
    let mut found: Vec<Failure> = Vec::new();
    let mut seen = HashSet::new();
    let cycles = campaign.cycles.iter().zip(standings);
    for (unit, standing) in cycles.filter(|(unit, _)| campaign.is_coarser_grid(unit) == of_coarser_grids) {
        let Some([problem, help]) = campaign.failure_texts(unit, standing).filter(|_| seen.insert(&unit.key))
        else {
            continue;
        };
        // Reasons that differ in their numbers alone are one.
        match found.iter_mut().find(|of| of.help == help && words(&of.problem) == words(&problem)) {
            Some(of) => of.count += 1,
            None => found.push(Failure { example: campaign.name_of(unit), count: 1, problem, help }),
        }
    }
    found.sort_by_key(|of| Reverse(of.count));
    found
}

/// Files of the measured surfaces. A failed import is reported elsewhere.
fn scans(campaign: &Campaign) -> Result<Vec<SurfaceHeader>, StageError> {
    let measured = campaign.surfaces.iter().filter(|unit| unit.params.measured().is_some());
    let paths = measured.map(|unit| campaign.surface_path(unit)).filter(|path| path.is_file());
    Ok(paths.map(|path| read_header(&path)).collect::<Result<_, _>>()?)
}

/// A figure in its formats: places below the folder of the report, and contents.
pub(super) fn pictures(stem: &str, svg: &str, files: &Figures) -> Result<Vec<(String, Vec<u8>)>, StageError> {
    let one =
        |format| Ok((format!("figures/{stem}.{format}"), file(format, svg, files.width_mm, &files.font)?));
    files.written().into_iter().map(one).collect()
}

/// Groups of sweeps with common figures, the names joined by `+`.
fn across(campaign: &Campaign) -> impl Iterator<Item = String> {
    campaign.spec.figures.across.iter().map(|group| group.join("+"))
}

/// Names of the sweeps, in their order.
fn sweeps(campaign: &Campaign) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in campaign.shown_cases().flat_map(|unit| &unit.case.sweeps) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}
