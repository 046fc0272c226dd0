//! Bounds and words.

use hysteron::model::{
    Amplitudes, AttractionKind, Boundary, Choice, Coalescence, Interaction, JumpIn, KeptContacts, Method, Normalization, Nucleation,
    Opening, Slip, SpectrumConvention, SpectrumKind,
};
use hysteron::spec::Spec;

use super::refused;

/// Every bound of every number: the least and the greatest that are allowed, and the next beyond.
#[test]
fn val_bounds_are_where_the_message_says() {
    // Table, key, refused below, allowed, allowed, refused above; what else must be written for the two to be a case.
    let bounds = [
        ("surface", "length_m", "9.99e-10", "1e-9", "1", "1.0000001", "rms_height_m = 1e-12"),
        ("surface", "rms_height_m", "9.99e-13", "1e-12", "0.1", "0.1000001", "length_m = 1"),
        ("surface", "hurst", "0.00999", "0.01", "1.0", "1.0000001", ""),
        ("surface", "magnification", "1", "2", "4096", "4097", ""),
        ("surface", "magnification", "1", "2", "8192", "16385", "points_per_shortest_wavelength = 4"),
        ("surface", "points_per_shortest_wavelength", "3", "4", "64", "65", ""),
        ("surface", "longest_wavelength_m", "-1e-300", "0", "1", "1.0000001", "length_m = 1"),
        ("surface", "aspect_ratio", "0.999", "1", "100", "100.0001", ""),
        ("surface", "angle_deg", "-180.001", "-180", "180", "180.001", ""),
        ("material", "contact_modulus_pa", "0.999", "1", "1e13", "1.0001e13", ""),
        ("material", "work_of_adhesion_j_m2", "-1e-300", "0", "1e3", "1000.001", ""),
        ("material", "interaction_range_m", "9.99e-13", "1e-12", "1e-5", "1.001e-5", ""),
        ("boundary_elements", "points", "-1", "0", "4096", "4097", ""),
        ("boundary_elements", "range_m", "-1e-300", "0", "1e-3", "1.001e-3", ""),
        ("boundary_elements", "approach_step", "9.99e-4", "1e-3", "0.2", "0.2000001", ""),
        ("boundary_elements", "halvings", "-1", "0", "10", "11", ""),
        ("boundary_elements", "precision", "9.99e-11", "1e-10", "1e-3", "1.001e-3", ""),
        ("cycle", "max_load", "[0.0]", "[1e-300]", "[0.2]", "[0.2000001]", ""),
        ("cycle", "approach_step", "9.99e-6", "1e-5", "1", "1.0000001", ""),
    ];
    for (table, key, below, least, greatest, above, also) in bounds {
        let text = |value: &str| format!("name = \"x\"\n[{table}]\n{also}\n{key} = {value}\n");
        for value in [least, greatest] {
            assert_eq!(Spec::parse(&text(value), "x").map_err(|errors| errors.to_string()).map(|_| ()), Ok(()));
        }
        for value in [below, above] {
            let rendered = refused(&text(value));
            assert!(rendered.contains("--> x.toml:4:"), "{rendered}");
        }
        // A sweep holds the same bounds.
        let swept = format!("name = \"x\"\n[{table}]\n{also}\n[[sweep]]\nname = \"s\"\n{table}.{key} = [{below}]\n");
        assert!(refused(&swept).contains("--> x.toml:6:"));
    }
}

fn words<T: Choice>(key: &'static str) -> Vec<(&'static str, &'static str)> {
    T::WORDS.iter().map(|(word, _)| (key, *word)).collect()
}

/// Every word of every choice, with its key; the words of a list are marked by the key.
fn all_words() -> Vec<(&'static str, &'static str)> {
    [
        words::<Normalization>("surface.normalization"),
        words::<Amplitudes>("surface.amplitudes"),
        words::<SpectrumKind>("surface.spectrum_kind"),
        words::<SpectrumConvention>("surface.spectrum_convention"),
        words::<Method>("model.method"),
        words::<Interaction>("model.interaction"),
        words::<Boundary>("model.boundary"),
        words::<Coalescence>("model.coalescence"),
        words::<JumpIn>("model.jump_in"),
        words::<Slip>("model.as_printed"),
        words::<KeptContacts>("cycle.contacts"),
        words::<AttractionKind>("boundary_elements.attraction"),
        words::<Nucleation>("boundary_elements.nucleation"),
        words::<Opening>("boundary_elements.opening"),
    ]
    .concat()
}

#[test]
fn law_every_word_is_taken() {
    for (key, word) in all_words() {
        let value = if key == "model.as_printed" { format!("[\"{word}\"]") } else { format!("\"{word}\"") };
        let method = if key.starts_with("boundary_elements.") { "model.method = \"boundary_elements\"\n" } else { "" };
        let file = if key.starts_with("surface.spectrum_") { "surface.spectrum = \"a.csv\"\n" } else { "" };
        let text = format!("name = \"x\"\n{method}{file}{key} = {value}\n");
        let spec = Spec::parse(&text, "x.toml").unwrap_or_else(|errors| panic!("{errors}"));
        let json = serde_json::to_value(&spec.cases[0].params).unwrap();
        let found = json.pointer(&format!("/{}", key.replace('.', "/"))).unwrap();
        // The choice between the methods: at the default parameters they are near full contact.
        let wanted = if value == "\"auto\"" && key == "model.method" { "\"boundary_elements\"".to_owned() } else { value };
        assert_eq!(found.to_string(), wanted, "{key}");
    }
}

#[test]
fn law_slips_are_sorted_and_stand_once() {
    let can: Vec<&str> = Slip::WORDS.iter().map(|(word, _)| *word).collect();
    let quoted: Vec<String> = can.iter().rev().chain(&can).map(|word| format!("\"{word}\"")).collect();
    let text = format!("name = \"x\"\nmodel.as_printed = [{}]\n", quoted.join(", "));
    let slips = Spec::parse(&text, "x.toml").unwrap().cases.remove(0).params.as_printed;
    assert_eq!(slips.iter().map(|slip| slip.word()).collect::<Vec<_>>(), can);
    assert!(slips.is_sorted());
}
