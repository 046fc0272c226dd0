//! Reader of specs.
#![no_main]

use hysteron::spec::Spec;

libfuzzer_sys::fuzz_target!(|text: &str| {
    match Spec::parse(text, "x.toml") {
        // A spec that is read is written and read again as the same one.
        Ok(spec) => assert_eq!(Spec::parse(&spec.to_toml(), "x.toml").as_ref(), Ok(&spec)),
        Err(errors) => assert!(!errors.faults().is_empty() && !errors.to_string().contains('\u{1b}')),
    }
});
