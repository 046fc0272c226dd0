//! Tables in memory: every mistake is named before anything is written.

use hysteron::schema::{CONTACTS, STEPS, TABLES};
use hysteron::store::{ColumnData, Frame, FrameBuilder};

use super::sample;

fn contacts() -> FrameBuilder {
    Frame::of(&CONTACTS)
        .text("cycle_id", ["a-cycle"; 2])
        .text("case_id", ["a-case"; 2])
        .i64("realization", [0, 0])
        .count("step", [0, 7])
        .text("branch", ["loading", "unloading"])
        .f64("max_load", [None, Some(0.0071)])
        .i64("asperity_id", [3_i64, 4])
        .text("state", vec!["contact".to_owned(), "covered".to_owned()])
        .f64("contact_radius_m", [1e-6, 0.0])
        .f64("load_n", vec![-1e-9, 0.0])
        .f64("penetration_m", [1e-9, -1e-9])
        .text("method", vec!["asperities"; 2])
        .f64("centroid_x_m", vec![None; 2])
        .f64("centroid_y_m", vec![None; 2])
        .f64("area_m2", vec![None; 2])
        .f64("perimeter_m", vec![None; 2])
        .i64("summit_count", vec![None; 2])
}

#[test]
fn law_a_frame_gives_back_its_columns() {
    let frame = contacts().f64("interaction_m", [2e-9, 3e-9]).build().unwrap();
    assert_eq!(frame.row_count(), 2);
    assert_eq!(frame.table(), &CONTACTS);
    assert_eq!(frame.i64("step").unwrap(), [0, 7]);
    assert_eq!(frame.text("state").unwrap(), ["contact", "covered"]);
    assert_eq!(frame.f64("load_n").unwrap(), [-1e-9, 0.0]);
    assert_eq!(frame.f64_or_null("max_load").unwrap(), [None, Some(0.0071)]);
    assert_eq!(frame.columns().count(), CONTACTS.columns.len());
}

#[test]
fn law_a_frame_names_what_is_asked_wrongly() {
    let frame = contacts().f64("interaction_m", [2e-9, 3e-9]).build().unwrap();
    let message = |result: Result<(), hysteron::store::FrameError>| result.unwrap_err().to_string();
    assert_eq!(
        message(frame.f64("max_load").map(drop)),
        "the table contacts has missing values in the column \"max_load\", where none were expected"
    );
    assert_eq!(message(frame.i64("load_n").map(drop)), "the table contacts holds f64 in the column \"load_n\", not i64");
    assert!(
        message(frame.bool("loud_n").map(drop))
            .starts_with("the table contacts has no column \"loud_n\"\nhelp: use one of cycle_id, case_id,")
    );
}

#[test]
fn law_a_frame_that_does_not_fit_is_refused() {
    let refusal = |builder: FrameBuilder| builder.build().unwrap_err().to_string();
    let full = || contacts().f64("interaction_m", [2e-9, 3e-9]);
    assert_eq!(refusal(contacts()), "the table contacts was not given: interaction_m");
    assert!(refusal(full().f64("interaction", [1.0, 2.0])).contains("has no column \"interaction\"\nhelp: use one of cycle_id"));
    assert!(refusal(full().f64("load_n", [1.0, 2.0])).contains("was given the column \"load_n\" twice"));
    assert!(refusal(contacts().i64("interaction_m", [1, 2])).contains("holds f64 in the column \"interaction_m\", not i64"));
    assert!(refusal(contacts().f64("interaction_m", [1.0])).contains("different length: 1 values in \"interaction_m\", 2 in \"cycle_id\""));
    let whole = sample(&CONTACTS, 2);
    let holed = whole.columns().fold(Frame::of(&CONTACTS), |builder, (column, data)| match column.name {
        "load_n" => builder.f64("load_n", [Some(1.0), None]),
        name => builder.with(name, data.clone()),
    });
    assert!(refusal(holed).contains("lacks a value in the column \"load_n\", row 1"));
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let message = refusal(contacts().f64("interaction_m", [value, 1.0]));
        assert!(message.contains("column \"interaction_m\", row 0: every number must be finite, and a missing one is null"), "{message}");
    }
    // The first mistake is the one that is told.
    assert!(refusal(contacts().f64("a", [1.0]).f64("b", [1.0])).contains("\"a\""));
}

#[test]
fn law_columns_may_come_in_any_order() {
    for table in TABLES {
        let frame = sample(table, 9);
        let columns: Vec<_> = frame.columns().map(|(column, data)| (column.name, data.clone())).collect();
        let reversed = columns.into_iter().rev().fold(Frame::of(table), |builder, (name, data)| builder.with(name, data));
        assert_eq!(reversed.build().unwrap(), frame);
    }
}

#[test]
fn law_an_empty_table_is_a_table() {
    let frame = sample(&STEPS, 0);
    assert_eq!(frame.row_count(), 0);
    assert!(frame.columns().all(|(_, data)| data.is_empty()));
    assert_eq!(ColumnData::Bool(vec![None]).len(), 1);
}
