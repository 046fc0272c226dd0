//! Numbers and names in tables that people read.

use hysteron::stats::{CaseInput, Shown, by_sweep, cases, column_exponent, labels, listing, realizations, significant, summary};
use hysteron::store::Frame;
use hysteron::text::counted;

use crate::panels::replaced;
use crate::steps::{case, cycle, realistic};

#[test]
fn law_labels_have_four_digits_unless_more_tell_them_apart() {
    assert_eq!(labels(&[0.05500000000000001, 0.1, 0.30000000000000004]), ["0.055", "0.1", "0.3"]);
    assert_eq!(labels(&[0.12341, 0.12342]), ["0.12341", "0.12342"]);
    assert_eq!(labels(&[5e-10, 512.0, 0.0071, -0.0]), ["5e-10", "512", "0.0071", "0"]);
    // The next double is another label, at whatever cost.
    let next = f64::from_bits(0.055_f64.to_bits() + 1);
    assert_eq!(labels(&[0.055, next]), ["0.055", "0.05500000000000001"]);
    let many: Vec<f64> = (0..1000).map(|k| 1.0 + f64::from(k) * 1e-7).collect();
    let mut texts = labels(&many);
    texts.sort_unstable();
    texts.dedup();
    assert_eq!(texts.len(), many.len());
    assert_eq!((significant(f64::NAN, 4).as_str(), significant(123_456.0, 3).as_str()), ("NaN", "123000"));
}

#[test]
fn law_one_is_no_plural() {
    assert_eq!([0, 1, 2].map(|count| counted(count, "spot")), ["0 spots", "1 spot", "2 spots"]);
}

/// The reference case, which three sweeps share, and the others of these.
fn sensitivity() -> Vec<CaseInput> {
    let with = |id: &str, sweep: &str, name: &str, value: &str| {
        let mut input = case(id, sweep, 0.8, 128.0, &[0.0071]);
        for (known, own) in &mut input.parameters {
            if known == name {
                *own = value.into();
            }
        }
        input
    };
    let all = vec![
        with("H0.80_z128-0a", "boundary", "boundary", "isolated"),
        with("H0.80_z128-0b", "coalescence", "coalescence", "merge"),
        with("H0.80_z128-0c", "coalescence", "coalescence", "none"),
        with("H0.80_z128-0d", "coalescence+boundary+normalization", "", ""),
        with("H0.80_z128-0e", "normalization", "normalization", "spectrum"),
    ];
    all.into_iter().map(|input| CaseInput { planned_count: 3, ..input }).collect()
}

/// The table of these cases, of `count` surfaces; the loss of a case is that of the first plus a tenth for each.
fn table(inputs: &[CaseInput], count: i32) -> Frame {
    let directory = tempfile::tempdir().unwrap();
    let mut cycles = Vec::new();
    for (at, input) in inputs.iter().enumerate() {
        for realization in 0..count {
            let path = directory.path().join(format!("{at}-{realization}.parquet"));
            let factor = 1.0 + 0.1 * f64::from(realization);
            realistic(&path, &input.max_loads, 0.1 * factor, 5e-4 * factor, 5e-4 * factor * (1.0 + 0.1 * at as f64), 2.5);
            cycles.push(cycle(&input.case_id, i64::from(realization), &path, 2e-8));
        }
    }
    cases(&realizations(inputs, &cycles).unwrap(), inputs).unwrap()
}

#[test]
fn law_every_sweep_lists_its_cases_by_what_varies_the_reference_first() {
    let text = summary(&table(&sensitivity(), 3), None, None, Shown::All).unwrap();
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(!text.contains("H0.80") && !text.contains("coalescence+"), "{text}");
    let block = |sweep: &str| -> Vec<&str> {
        let lines = text.lines().skip_while(move |line| !line.starts_with(sweep)).skip(1).take_while(|line| !line.is_empty());
        lines
            .filter(|line| !line.starts_with(' ') && !line.starts_with("Verdict: "))
            .map(|line| line.split_whitespace().next().unwrap())
            .collect()
    };
    assert_eq!(block("boundary "), ["periodic*", "isolated"], "{text}");
    assert_eq!(block("coalescence "), ["cover*", "merge", "coalescence=none"], "{text}");
    assert_eq!(block("normalization"), ["sample*", "spectrum"], "{text}");
    // The loss of "isolated" is 1.0 to the 1.3 of the reference case, all else is the same.
    let change = text.lines().skip_while(|line| !line.starts_with("isolated")).find(|line| line.starts_with("  change [%]")).unwrap();
    let numbers: Vec<&str> = change.split_whitespace().skip(2).collect();
    assert_eq!(numbers, ["0.0", "0.0", "-23.1", "-23.1"], "{text}");
    assert!(text.contains("*: reference case"));
    // Of fewer surfaces than the spec asks for, means differ by the surfaces too.
    let partial = summary(&table(&sensitivity(), 2), None, None, Shown::All).unwrap();
    assert!(partial.contains("cover*") && !partial.contains("change [%]"), "{partial}");
}

#[test]
fn reg_the_table_of_results() {
    insta::assert_snapshot!("results", summary(&table(&sensitivity(), 3), None, None, Shown::All).unwrap());
}

#[test]
fn law_rows_and_sweeps_have_the_order_of_the_spec() {
    let with = |id: &str, sweep: &str, zeta: f64, hurst: f64| CaseInput { planned_count: 2, ..case(id, sweep, hurst, zeta, &[0.0071]) };
    // Neither the ids nor the values ascend.
    let inputs =
        [with("c", "rough", 64.0, 0.8), with("a", "rough", 512.0, 0.8), with("b", "rough", 128.0, 0.8), with("d", "hurst", 64.0, 0.7)];
    let frame = table(&inputs, 2);
    assert_eq!(frame.text("case_id").unwrap(), ["c", "a", "b", "d"]);
    let text = summary(&frame, None, None, Shown::All).unwrap();
    let places: Vec<_> = ["\nrough ", "ζ=64", "ζ=512", "ζ=128", "\nhurst "].iter().map(|label| text.find(label).unwrap()).collect();
    assert!(places.is_sorted(), "{text}");
}

#[test]
fn law_headings_of_sweeps_have_what_is_constant_in_them() {
    let with = |id: &str, sweep: &str, zeta: f64, hurst: f64| CaseInput { planned_count: 2, ..case(id, sweep, hurst, zeta, &[0.0071]) };
    let grouped = |inputs: &[CaseInput]| -> Vec<(String, Vec<String>)> {
        let frame = table(inputs, 2);
        let found = by_sweep(&frame, &listing(&frame).unwrap()).unwrap();
        found.into_iter().map(|of| (of.heading, of.rows.into_iter().map(|(_, label)| label).collect())).collect()
    };
    let two = |heading: &str, labels: [&str; 2]| (heading.to_owned(), labels.map(str::to_owned).to_vec());
    let inputs =
        [with("a", "smooth", 64.0, 0.9), with("b", "smooth", 128.0, 0.9), with("c", "rough", 64.0, 0.7), with("d", "rough", 128.0, 0.7)];
    assert_eq!(grouped(&inputs), [two("Sweep smooth: H = 0.9", ["ζ = 64", "ζ = 128"]), two("Sweep rough: H = 0.7", ["ζ = 64", "ζ = 128"])]);
    // With a reference case: what differs from it.
    let inputs = [with("a", "zeta+hurst", 64.0, 0.8), with("b", "zeta", 128.0, 0.8), with("c", "hurst", 64.0, 0.7)];
    let one = |heading: &str, label: &str| (heading.to_owned(), vec![label.to_owned()]);
    assert_eq!(grouped(&inputs), [one("Sweeps zeta, hurst", "reference"), one("Sweep zeta", "ζ = 128"), one("Sweep hurst", "H = 0.7")]);
    assert!(grouped(&inputs[..1]).len() == 1 && grouped(&[with("a", "one", 64.0, 0.8)]).is_empty());
}

#[test]
fn law_a_campaign_without_a_shared_case_has_no_reference() {
    let mut inputs = sensitivity();
    inputs.iter_mut().for_each(|input| input.sweep = "all".to_owned());
    let text = summary(&table(&inputs, 2), None, None, Shown::All).unwrap();
    assert!(!text.contains("reference") && !text.contains("change [%]"), "{text}");
    assert!(text.contains("\nisolated, cover, sample\n") && text.contains("\nperiodic, cover, spectrum\n"), "{text}");
}

#[test]
fn law_one_case_is_named_by_its_surface() {
    let text = summary(&table(&[case("H0.80_z128-0a", "", 0.8, 128.0, &[0.0071])], 2), None, None, Shown::All).unwrap();
    assert!(text.contains("ζ=128, H=0.8") && !text.contains("H0.80"), "{text}");
}

#[test]
fn law_no_number_vanishes_in_the_scale_of_its_column() {
    let whole = table(&[case("a", "", 0.8, 128.0, &[0.0071])], 3);
    let row = |columns: &[(&str, f64)]| {
        let frame = columns.iter().fold(whole.clone(), |frame, (name, value)| replaced(&frame, name, 0, *value));
        let text = summary(&frame, None, None, Shown::All).unwrap();
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        text
    };
    let text = row(&[("loss_mean", -1.84e-11), ("loss_sd", 2.96e-11), ("loss_ratio_dk_mean", 51245.0), ("loss_ratio_dk_sd", 67298.0)]);
    assert!(text.contains("Θ [10⁻¹²]") && text.contains(" -18.4±29.6"), "{text}");
    // The head of this column has no room for a factor.
    assert!(text.contains(" Θ/Θ_DK\n") && text.contains(" 5.1e4±6.7e4"), "{text}");
    let text = row(&[("loss_mean", 5.43e-12), ("loss_sd", 2.11e-12), ("area_at_max_load_mean", 1.24e-5), ("area_at_max_load_sd", 2e-6)]);
    assert!(text.contains(" 5.43±2.11") && text.contains(" A [10⁻⁶]") && text.contains(" 12.4±2.0"), "{text}");
    // A mean that the digits of its standard deviation hide.
    let text = row(&[("loss_mean", 1e-7), ("loss_sd", 2e-4)]);
    assert!(text.contains(" Θ ") && text.contains("1.0e-7±2.0e-4"), "{text}");
    let text = row(&[("loss_mean", 0.0), ("loss_sd", 0.0)]);
    assert!(text.contains("0±0"), "{text}");
}

#[test]
fn law_all_numbers_of_a_column_have_one_notation() {
    let inputs = [1e-3, 1e-2, 0.1].map(|work| {
        let mut input = case(&format!("w{work}"), "adhesion", 0.8, 8.0, &[0.0071]);
        input.parameters.iter_mut().filter(|(name, _)| name == "work_of_adhesion_j_m2").for_each(|(_, value)| *value = work.into());
        input
    });
    let whole = table(&inputs, 3);
    let text = |losses: [f64; 3]| {
        let frame = losses
            .iter()
            .enumerate()
            .fold(whole.clone(), |frame, (row, loss)| replaced(&replaced(&frame, "loss_mean", row, *loss), "loss_sd", row, 0.1 * loss));
        let text = summary(&frame, None, None, Shown::All).unwrap();
        let head = text.lines().find(|line| line.starts_with("adhesion")).unwrap().to_owned();
        let cells =
            text.lines().filter(|line| line.starts_with("Δγ")).take(3).map(|line| line.split_whitespace().rev().nth(1).unwrap().to_owned());
        (head, cells.collect::<Vec<_>>())
    };
    let (head, cells) = text([4.6e-7, 8.9e-6, 1.53e-3]);
    assert!(head.contains("Θ [10⁻⁶]"), "{head}");
    assert_eq!(cells, ["0.460±0.046", "8.90±0.89", "1530±153"]);
    // No power of ten suits ten decades.
    let (head, cells) = text([4.6e-12, 8.9e-6, 0.0153]);
    assert!(head.contains("Θ  ") && !head.contains("Θ ["), "{head}");
    assert_eq!(cells, ["4.6e-12±5e-13", "8.9e-6±8.9e-7", "1.5e-2±1.5e-3"]);
}

#[test]
fn val_the_power_of_ten_of_a_column() {
    for (values, exponent) in [
        (&[0.198, 0.277][..], 0),
        (&[10.9, 2.3], 0),
        (&[0.857e-3, 0.987e-3], -3),
        (&[4.25e-6, 4.25e-6], -6),
        (&[4.25e-6, 4.25e-6, 0.857e-3, 0.857e-3, 0.987e-3], -6),
        (&[5.1e4], 3),
        (&[-1.84e-11, 0.0], -12),
        (&[0.0], 0),
        (&[], 0),
    ] {
        assert_eq!(column_exponent(values.iter().copied()), exponent, "{values:?}");
    }
}
