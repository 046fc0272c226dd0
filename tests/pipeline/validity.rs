//! How far to trust a row: the numbers, their limits, and the cautions.

use hysteron::schema::CASES;
use hysteron::stats::{CAUTIONS, CaseInput, LIMITS, Shown, Value, cases, fewer_surfaces, realizations, summary, warnings};
use hysteron::store::{ColumnData, Frame};

use crate::panels::replaced;
use crate::steps::{Step, case, cycle, write, write_counts};

const STEPS: [Step; 3] =
    [("loading", None, 0.0, 0.0, 0.0, 0.0), ("loading", None, 0.004, 0.08, 0.6, 5e-9), ("unloading", Some(0.004), 0.0, 0.0, 0.0, -4.7e-9)];

/// The table of cases of one case, some columns of whose surfaces are set: one realization for each list. The steps' own account gives a
/// loss of 3e-10 in both ways, so that there is no audit gap.
fn table(surfaces: &[&[(&str, Value)]], area: f64, change: impl Fn(&mut CaseInput)) -> Frame {
    let directory = tempfile::tempdir().unwrap();
    let mut input = case("c1", "", 0.8, 64.0, &[0.004]);
    input.planned_count = surfaces.len();
    change(&mut input);
    let mut cycles = Vec::new();
    for (at, columns) in surfaces.iter().enumerate() {
        let path = directory.path().join(format!("{at}.parquet"));
        let mut steps = STEPS;
        steps[1].3 = area;
        // Two loading steps and one back lose 1e-10, 1e-10 and 2e-10 in their events.
        steps[2].5 = -4.6e-9;
        write(&path, &steps);
        let mut one = cycle("c1", at as i64, &path, 2e-8);
        for (name, value) in *columns {
            one.surface.retain(|(known, _)| known != name);
            one.surface.push(((*name).to_owned(), value.clone()));
        }
        cycles.push(one);
    }
    let inputs = [input];
    cases(&realizations(&inputs, &cycles).unwrap(), &inputs).unwrap()
}

fn words(frame: &Frame) -> String {
    frame.text("caution").unwrap()[0].to_owned()
}

fn number(frame: &Frame, name: &str) -> Option<f64> {
    frame.f64_or_null(name).unwrap()[0]
}

#[test]
fn law_limits_are_columns_and_say_a_sentence() {
    for limit in LIMITS {
        assert!(CASES.column(limit.column).is_some(), "{}", limit.column);
        assert!(CAUTIONS.iter().any(|known| known.code == limit.caution && known.text.contains("{}")), "{}", limit.caution);
        assert!(!limit.is_passed(Some(limit.bound)) && !limit.is_passed(None));
        let beyond = if limit.bound == 0.0 { 1e-9 } else { limit.bound * if limit.at_least { 0.99 } else { 1.01 } };
        assert!(limit.is_passed(Some(beyond)), "{}", limit.caution);
    }
}

#[test]
fn val_each_limit_has_its_caution() {
    let none: &[&[(&str, Value)]] = &[&[], &[]];
    assert_eq!(words(&table(none, 0.3, |_| {})), "");
    assert_eq!(words(&table(none, 0.31, |_| {})), "area");
    let set = |name: &'static str, value: f64| words(&table(&[&[(name, value.into())], &[(name, value.into())]], 0.1, |_| {}));
    assert_eq!(set("conformity_realised", 0.99), "conformed");
    assert_eq!(set("persson_tosatti_realised", 1.99), "sticky");
    assert_eq!(set("tabor_min", 1.9), "tabor");
    assert_eq!(set("texture_aspect", 2.01), "texture");
    assert_eq!(set("filter_overshoot", 0.011), "overshoot");
    let few: Value = 99_usize.into();
    assert_eq!(words(&table(&[&[("summit_count", few.clone())], &[("summit_count", few)]], 0.1, |_| {})), "few_asperities");
    assert_eq!(words(&counted(&[[9, 0, 0], [10, 0, 0]])), "few_contacts");
    assert_eq!(words(&counted(&[[1, 0, 0], [19, 0, 0]])), "", "the limit is within the range, and the mean counts");
    // The continuous spectrum is shown beside; what was computed is what is judged.
    assert_eq!(set("conformity", 0.1), "");
}

#[test]
fn reg_an_anisotropic_surface_has_no_expected_ratio() {
    let of = |aspect: f64| table(&[&[("persson_tosatti_realised", 10.0.into()), ("texture_aspect", aspect.into())]], 0.1, |_| {});
    assert!(number(&of(1.99), "area_model_ratio").is_some());
    let ridges = of(2.5);
    assert_eq!((number(&ridges, "area_model_ratio"), number(&ridges, "texture_aspect_mean")), (None, Some(2.5)));
    // A ratio of lengths is no fraction: its limit has no percent sign.
    let found = warnings(&ridges).unwrap();
    assert!(found.iter().any(|warning| warning.measured == "texture aspect ratio = 2.5 (limit ≤ 2)"), "{found:?}");
}

/// The table of one case with these numbers of contacts, of absorbed asperities and of overlapping contacts, one list per surface.
fn counted(surfaces: &[[usize; 3]]) -> Frame {
    let directory = tempfile::tempdir().unwrap();
    let mut input = case("c1", "", 0.8, 64.0, &[0.004]);
    input.planned_count = surfaces.len();
    let of = |(at, counts): (usize, &[usize; 3])| {
        let path = directory.path().join(format!("{at}.parquet"));
        let mut steps = STEPS;
        steps[2].5 = -4.6e-9;
        write_counts(&path, &steps, *counts);
        cycle("c1", at as i64, &path, 2e-8)
    };
    let cycles: Vec<_> = surfaces.iter().enumerate().map(of).collect();
    let inputs = [input];
    cases(&realizations(&inputs, &cycles).unwrap(), &inputs).unwrap()
}

#[test]
fn val_fractions_of_contacts_are_weighted_by_contacts() {
    // One contact that overlaps, of 1 and of 99: 2 of 100. The mean of the fractions is 0.505.
    let frame = counted(&[[1, 1, 1], [99, 0, 1]]);
    let near = |name: &str, wanted: f64| assert!((number(&frame, name).unwrap() - wanted).abs() < 1e-14, "{name}");
    near("touching_share_mean", 0.02);
    near("touching_share_max", 1.0);
    near("covered_share_mean", 1.0 / 101.0);
    near("covered_share_max", 0.5);
    near("contact_count_at_max_load_mean", 50.0);
    near("contact_count_at_max_load_min", 1.0);
    near("touching_count_at_max_load_mean", 1.0);
    assert_eq!(words(&frame), "", "2 % overlap");
    let none = counted(&[[0, 0, 0], [0, 0, 0]]);
    assert_eq!((number(&none, "touching_share_mean"), number(&none, "contact_count_at_max_load_mean")), (None, Some(0.0)));
    let found = warnings(&counted(&[[20, 0, 10], [20, 0, 0]])).unwrap();
    assert_eq!(found[0].measured, "25\u{a0}% of contact spots overlap a neighbour (limit 10\u{a0}%)");
    assert!(found[0].kind.action.contains("smaller `max_load`") && found[0].kind.action.contains("\"merge\""));
}

/// A JKR fit of one of two surfaces: the number of surfaces is in the table, and in the summary below the mean.
#[test]
fn law_means_of_fewer_surfaces_say_how_many() {
    let works = |retraction: Value| [("work_approach_j_m2", 0.02.into()), ("work_retraction_j_m2", retraction)];
    let of_probe = |input: &mut CaseInput| {
        input.parameters.retain(|(name, _)| name != "probe_radius_m");
        input.parameters.push(("probe_radius_m".to_owned(), 2e-5.into()));
    };
    let frame = table(&[&works(0.04.into()), &works(Value::Missing)], 0.1, of_probe);
    let count = |name: &str| frame.i64_or_null(name).unwrap()[0];
    assert_eq!((count("work_approach_j_m2_count"), count("work_retraction_j_m2_count")), (Some(2), Some(1)));
    assert_eq!(count("work_loss_j_m2_count"), None);
    let [approach, retraction] = ["work_approach_j_m2", "work_retraction_j_m2"].map(|name| fewer_surfaces(&frame, name, 0).unwrap());
    assert_eq!((approach, retraction, fewer_surfaces(&frame, "loss", 0).unwrap()), (None, Some([1, 2]), None));
    let text = summary(&frame, None, None, Shown::All).unwrap();
    let line = text.lines().find(|line| line.starts_with("  surfaces")).unwrap();
    assert!(line.ends_with(" 1/2") && line.matches('/').count() == 1, "{text}");
    assert!(
        text.contains("surfaces: those in the mean, of the finished ones") && text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
    let both = table(&[&works(0.04.into()), &works(0.05.into())], 0.1, of_probe);
    assert!(!summary(&both, None, None, Shown::All).unwrap().contains("surfaces"));
}

#[test]
fn law_surfaces_of_failed_cycles_count_where_the_surface_alone_decides() {
    let ratio = |value: f64| vec![("persson_tosatti_realised".to_owned(), value.into()), ("summit_count".to_owned(), 20_usize.into())];
    // Both failed: no result, and yet the warnings of the surfaces.
    let failed = table(&[], 0.1, |input| {
        (input.planned_count, input.failed_count) = (2, 2);
        input.surfaces = vec![ratio(0.5), ratio(1.5)];
    });
    assert_eq!(words(&failed), "sticky+failed+incomplete+few_asperities");
    assert_eq!((number(&failed, "persson_tosatti_realised_mean"), number(&failed, "persson_tosatti_realised_min")), (Some(1.0), Some(0.5)));
    assert_eq!((number(&failed, "summit_count_mean"), number(&failed, "loss_mean")), (Some(20.0), None));
    // One of two: the mean is over both surfaces.
    let one = table(&[&[("persson_tosatti_realised", 3.5.into())]], 0.1, |input| {
        (input.planned_count, input.failed_count) = (2, 1);
        input.surfaces = vec![ratio(0.5), ratio(3.5)];
    });
    assert_eq!(number(&one, "persson_tosatti_realised_mean"), Some(2.0));
}

#[test]
fn law_codes_are_ordered_by_severity() {
    let codes: Vec<&str> = CAUTIONS.iter().map(|known| known.code).collect();
    assert_eq!(codes[..3], ["sticky", "area", "conformed"]);
    let all: &[(&str, Value)] = &[("conformity_realised", 0.1.into()), ("persson_tosatti_realised", 0.1.into()), ("tabor_min", 1.0.into())];
    let carried = words(&table(&[all], 0.5, |_| {}));
    assert_eq!(carried, "sticky+area+conformed+tabor+single");
    let limits: Vec<usize> = LIMITS.iter().map(|limit| codes.iter().position(|code| *code == limit.caution).unwrap()).collect();
    assert!(limits.is_sorted());
}

#[test]
fn law_the_tabor_number_matters_to_wu_alone() {
    let low: &[(&str, Value)] = &[("tabor_min", 0.5.into())];
    let jkr = |input: &mut CaseInput| {
        input.parameters.retain(|(name, _)| name != "jump_in");
        input.parameters.push(("jump_in".to_owned(), "jkr".into()));
    };
    assert_eq!(words(&table(&[low, low], 0.1, jkr)), "");
}

#[test]
fn val_means_and_worst_by_hand() {
    let one: &[(&str, Value)] =
        &[("tabor_min", 3.0.into()), ("tabor_mean", 10.0.into()), ("low_tabor_share", 0.1.into()), ("conformity_realised", 2.0.into())];
    let two: &[(&str, Value)] =
        &[("tabor_min", 1.0.into()), ("tabor_mean", 20.0.into()), ("low_tabor_share", 0.3.into()), ("conformity_realised", 0.5.into())];
    let frame = table(&[one, two], 0.1, |_| {});
    for (name, wanted) in [
        ("tabor_min_min", 1.0),
        ("tabor_min_mean", 2.0),
        ("tabor_mean_mean", 15.0),
        ("tabor_mean_min", 10.0),
        ("low_tabor_share_mean", 0.2),
        ("low_tabor_share_max", 0.3),
        ("conformity_realised_mean", 1.25),
        ("conformity_realised_min", 0.5),
        ("touching_share_mean", 1.0 / 19.0),
        ("covered_share_max", 0.05),
        ("persson_tosatti_mean", 8.0),
    ] {
        assert!((number(&frame, name).unwrap() - wanted).abs() < 1e-14, "{name}");
    }
    assert!(number(&frame, "audit_gap_max").unwrap() < 1e-6);
    // One asperity below the limit is enough; a mean conformity above its limit is not passed.
    assert_eq!(words(&frame), "tabor");
}

#[test]
fn law_what_is_missing_is_null_and_no_caution() {
    let known: &[(&str, Value)] = &[("conformity_realised", 3.0.into()), ("conformity", Value::Missing)];
    let unknown: &[(&str, Value)] = &[("conformity_realised", Value::Missing), ("conformity", Value::Missing)];
    let some = table(&[known, unknown], 0.1, |_| {});
    assert_eq!((number(&some, "conformity_realised_mean"), number(&some, "conformity_realised_min")), (Some(3.0), Some(3.0)));
    let nowhere = table(&[unknown, unknown], 0.1, |_| {});
    for name in ["conformity_mean", "conformity_min", "conformity_realised_mean", "conformity_realised_min"] {
        assert_eq!(number(&nowhere, name), None, "{name}");
    }
    assert_eq!(words(&nowhere), "");
    let failed = table(&[], 0.1, |input| {
        input.planned_count = 2;
        input.failed_count = 2;
    });
    assert_eq!((words(&failed).as_str(), number(&failed, "audit_gap_max")), ("failed+incomplete", None));
}

#[test]
fn law_no_caution_is_lost_at_the_edge_of_a_terminal() {
    let all: &[(&str, Value)] = &[("tabor_min", 1.0.into()), ("conformity_realised", 0.1.into()), ("persson_tosatti_realised", 0.1.into())];
    let frame = table(&[all], 0.5, |input| {
        input.planned_count = 9;
        input.failed_count = 1;
    });
    let carried = words(&frame);
    assert!(carried.split('+').count() >= 7, "{carried}");
    let text = summary(&frame, None, None, Shown::All).unwrap();
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    for word in carried.split('+') {
        assert_eq!(text.matches(&format!("warning[{word}]: ")).count(), 1, "{word} in {text}");
    }
}

#[test]
fn law_a_warning_has_measured_value_limit_consequence_and_action() {
    let half: &[(&str, Value)] = &[("persson_tosatti_realised", 0.5.into()), ("tabor_min", 1.25.into())];
    let found = warnings(&table(&[half, half], 0.32, |_| {})).unwrap();
    let texts: Vec<(&str, &str, &str)> = found.iter().map(|of| (of.kind.code, of.kind.label, of.measured.as_str())).collect();
    assert_eq!(
        texts,
        [
            ("sticky", "near full contact", "U_el/Δγ = 0.5 (limit ≥ 2)"),
            ("area", "large contact area", "A/A₀ = 32\u{a0}% (limit 30\u{a0}%)"),
            ("tabor", "low Tabor parameter", "minimum Tabor parameter μ = 1.25 (limit ≥ 2)"),
        ]
    );
    for kind in CAUTIONS {
        assert!(kind.consequence.ends_with('.') && kind.action.ends_with('.') && kind.action.contains(' '), "{}", kind.code);
    }
    // Counts: over the cases, each once.
    let failed = warnings(&table(&[half], 0.1, |input| {
        input.planned_count = 3;
        input.failed_count = 1;
    }))
    .unwrap();
    let measured = |code: &str| failed.iter().find(|of| of.kind.code == code).unwrap().measured.as_str();
    assert_eq!((measured("failed"), measured("incomplete")), ("1 of 3 realizations failed", "1 of 3 realizations finished"));
    let twice = warnings(&table(&[half], 0.1, |input| {
        input.max_loads = vec![0.004, 0.005];
        (input.planned_count, input.failed_count) = (3, 2);
    }))
    .unwrap();
    let twice = twice.iter().find(|of| of.kind.code == "failed").unwrap();
    assert_eq!((twice.rows.len(), twice.measured.as_str()), (2, "2 of 3 realizations failed"));
}

/// The same table with other codes in the column `caution`.
fn with_codes(frame: &Frame, codes: &[&str]) -> Frame {
    let mut builder = Frame::of(frame.table());
    for column in frame.table().columns {
        let data = match frame.column(column.name).unwrap() {
            ColumnData::Text(_) if column.name == "caution" => {
                ColumnData::Text(codes.iter().map(|code| Some((*code).to_owned())).collect())
            }
            other => other.clone(),
        };
        builder = builder.with(column.name, data);
    }
    builder.build().unwrap()
}

#[test]
fn law_the_values_of_several_rows_are_an_interval_and_few_rows_are_named() {
    let frame = table(&[&[], &[]], 0.1, |input| input.max_loads = vec![0.004, 0.005, 0.006]);
    let frame =
        [0.76, 0.87, 0.05].iter().enumerate().fold(frame, |frame, (row, value)| replaced(&frame, "touching_share_mean", row, *value));
    let frame = with_codes(&frame, &["touching", "touching", ""]);
    let found = warnings(&frame).unwrap();
    assert_eq!((found.len(), found[0].rows.as_slice()), (1, &[0, 1][..]));
    assert_eq!(found[0].measured, "76 to 87\u{a0}% of contact spots overlap a neighbour (limit 10\u{a0}%)");
    let text = summary(&frame, None, None, Shown::All).unwrap();
    assert!(text.contains("F_max = 0.004") && text.contains("F_max = 0.005") && !text.contains("F_max = 0.006"), "{text}");
    let all = summary(&with_codes(&frame, &["touching"; 3]), None, None, Shown::All).unwrap();
    assert!(all.contains("warning[touching]: overlap: 5 to 87 % of contact spots overlap") && !all.contains("F_max = 0.004"), "{all}");
}
