//! Works that a run cites.

use crate::bench::{Bench, SPEC, code, stderr, stdout};
use hysteron::citation::bibtex;

/// Every entry has a key of its own, and all but the program a DOI; a work of one method is cited with that method only.
#[test]
fn law_works_are_cited_with_their_method() {
    let keys = |counts| {
        let text = bibtex(counts);
        let keys: Vec<String> = text.split('@').skip(1).map(|entry| entry.split(['{', ',']).nth(1).unwrap().to_owned()).collect();
        assert_eq!(text.matches("  doi     = {10.").count(), keys.len() - 1, "{text}");
        assert_eq!(text.matches('{').count(), text.matches('}').count());
        keys
    };
    let models = ["deng2019", "persson2001", "dalvi2019", "sanner2024"];
    assert_eq!(keys([1, 0]), [&["hysteron", "violano2021", "johnson1971"][..], &models].concat());
    assert_eq!(keys([0, 1]), [&["hysteron", "johnson1971", "ciavarella2018", "roache1994"][..], &models].concat());
    assert_eq!(keys([1, 1]).len(), 9);
}

#[test]
fn e2e_a_run_says_what_it_cites() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let cited = bench.look("cite", &[]);
    assert_eq!(code(&cited), 0, "{}", stderr(&cited));
    assert_eq!(stdout(&cited).trim_end(), bibtex([2, 0]));
    assert!(stdout(&cited).contains(&format!("version = {{{}}}", env!("CARGO_PKG_VERSION"))));
    let page = std::fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(page.contains("@article{violano2021,"), "the report cites the same");
    // Results come before the parameters and the spec.
    let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text}"));
    assert!(at(">Results</h2>") < at(">Sweep zeta</h2>") && at(">Sweep zeta</h2>") < at(">Parameters</h2>"));
    let json: serde_json::Value = serde_json::from_str(&stdout(&bench.look("cite", &["--json"]))).unwrap();
    assert_eq!(json["bibtex"], bibtex([2, 0]));
}
