//! Texts that nobody would write.

use hysteron::spec::Spec;

use super::{accepted, errors_in};

/// Numbers that only look random: the same ones in every run.
struct Lcg(u64);

impl Lcg {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % bound.max(1)
    }
}

const SPLICES: &[&str] = &[
    "",
    "\n",
    "\t",
    "\r",
    "\u{feff}",
    "ζ",
    "漢",
    "e\u{301}",
    "\0",
    "\u{1b}",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ".",
    ",",
    "#",
    "\"",
    "'",
    "\"\"\"",
    "'''",
    "\\u0000",
    "nan",
    "-inf",
    "1e999",
    "-0.0",
    "0x",
    "0",
    "-1",
    "9223372036854775808",
    "true",
    "2021-01-07",
    "[]",
    "[[]]",
    "{}",
    "[[sweep]]\n",
    "[sweep]\n",
    "name = \"s\"\n",
    "surface.hurst = [0.1, 0.2]\n",
    "surface.magnification = [3, 4, 5]\n",
    "cycle.max_load = [[0.1], []]\n",
    "model.as_printed = [\"a2\"]\n",
    "file = 1\n",
];

#[test]
fn law_no_text_makes_the_reader_panic() {
    let seeds: Vec<String> = accepted().into_iter().filter(|(name, _)| name != "ten_thousand.toml").map(|(_, text)| text).collect();
    let mut random = Lcg(2021);
    let (mut good, mut bad) = (0, 0);
    for round in 0..6000 {
        let mut text: Vec<char> = seeds[round % seeds.len()].chars().collect();
        for _ in 0..=random.below(4) {
            let at = random.below(text.len() + 1);
            let until = (at + random.below(8)).min(text.len());
            match random.below(4) {
                0 => drop(text.drain(at..until)),
                1 => drop(text.splice(at..until, SPLICES[random.below(SPLICES.len())].chars())),
                2 => drop(text.splice(at..at, SPLICES[random.below(SPLICES.len())].chars())),
                _ => {
                    let piece: Vec<char> = text[at..(at + random.below(60)).min(text.len())].to_vec();
                    let to = random.below(text.len() + 1);
                    drop(text.splice(to..to, piece));
                }
            }
        }
        let text: String = text.into_iter().collect();
        match Spec::parse(&text, "x.toml") {
            Ok(spec) => {
                good += 1;
                assert_eq!(Spec::parse(&spec.to_toml(), "again.toml").as_ref(), Ok(&spec), "{text}");
            }
            Err(errors) => {
                bad += 1;
                assert!(!errors.faults().is_empty(), "{text}");
                let rendered = errors.to_string();
                assert_eq!(errors_in(&rendered), errors.faults().len(), "{rendered}");
                assert!(!rendered.contains('\u{1b}') && !rendered.contains('\0'), "{rendered:?}");
            }
        }
    }
    assert!(good > 500 && bad > 500, "{good} good, {bad} bad");
}
