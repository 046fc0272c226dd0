//! Works that a publication of results cites: the program, and those whose models it computes.

/// When a work is cited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Use {
    Always,
    Asperities,
    BoundaryElements,
}

/// A work in BibTeX, and when it is cited.
struct Work {
    of: Use,
    bibtex: &'static str,
}

/// The program first, then its methods, then the models next to every result.
const WORKS: [Work; 9] = [
    Work {
        of: Use::Always,
        bibtex: r#"@software{hysteron,
  title   = {hysteron: adhesive hysteresis of rough surfaces},
  author  = {{The hysteron developers}},
  version = {VERSION},
  year    = {2026}
}"#,
    },
    Work {
        of: Use::Asperities,
        bibtex: r#"@article{violano2021,
  title   = {Roughness-induced adhesive hysteresis in self-affine fractal surfaces},
  author  = {Violano, G. and Afferrante, L.},
  journal = {Lubricants},
  volume  = {9},
  number  = {1},
  pages   = {7},
  year    = {2021},
  doi     = {10.3390/lubricants9010007}
}"#,
    },
    Work {
        of: Use::Always,
        bibtex: r#"@article{johnson1971,
  title   = {Surface energy and the contact of elastic solids},
  author  = {Johnson, K. L. and Kendall, K. and Roberts, A. D.},
  journal = {Proceedings of the Royal Society of London A},
  volume  = {324},
  pages   = {301--313},
  year    = {1971},
  doi     = {10.1098/rspa.1971.0141}
}"#,
    },
    Work {
        of: Use::BoundaryElements,
        bibtex: r#"@article{ciavarella2018,
  title   = {An approximate {JKR} solution for a general contact, including rough contacts},
  author  = {Ciavarella, M.},
  journal = {Journal of the Mechanics and Physics of Solids},
  volume  = {114},
  pages   = {209--218},
  year    = {2018},
  doi     = {10.1016/j.jmps.2018.02.005}
}"#,
    },
    Work {
        of: Use::BoundaryElements,
        bibtex: r#"@article{roache1994,
  title   = {Perspective: a method for uniform reporting of grid refinement studies},
  author  = {Roache, P. J.},
  journal = {Journal of Fluids Engineering},
  volume  = {116},
  pages   = {405--413},
  year    = {1994},
  doi     = {10.1115/1.2910291}
}"#,
    },
    Work {
        of: Use::Always,
        bibtex: r#"@article{deng2019,
  title   = {Depth-dependent hysteresis in adhesive elastic contacts at large surface roughness},
  author  = {Deng, W. and Kesari, H.},
  journal = {Scientific Reports},
  volume  = {9},
  pages   = {1639},
  year    = {2019},
  doi     = {10.1038/s41598-018-38212-z}
}"#,
    },
    Work {
        of: Use::Always,
        bibtex: r#"@article{persson2001,
  title   = {The effect of surface roughness on the adhesion of elastic solids},
  author  = {Persson, B. N. J. and Tosatti, E.},
  journal = {The Journal of Chemical Physics},
  volume  = {115},
  pages   = {5597--5610},
  year    = {2001},
  doi     = {10.1063/1.1398300}
}"#,
    },
    Work {
        of: Use::Always,
        bibtex: r#"@article{dalvi2019,
  title   = {Linking energy loss in soft adhesion to surface roughness},
  author  = {Dalvi, S. and Gujrati, A. and Khanal, S. R. and Pastewka, L. and
             Dhinojwala, A. and Jacobs, T. D. B.},
  journal = {Proceedings of the National Academy of Sciences},
  volume  = {116},
  pages   = {25484--25490},
  year    = {2019},
  doi     = {10.1073/pnas.1913126116}
}"#,
    },
    Work {
        of: Use::Always,
        bibtex: r#"@article{sanner2024,
  title   = {Why soft contacts are stickier when breaking than when making them},
  author  = {Sanner, A. and Kumar, N. and Dhinojwala, A. and Jacobs, T. D. B. and Pastewka, L.},
  journal = {Science Advances},
  volume  = {10},
  pages   = {eadl1277},
  year    = {2024},
  doi     = {10.1126/sciadv.adl1277}
}"#,
    },
];

/// Works in BibTeX that a run cites, with numbers of cases by the asperity model and by boundary elements.
/// The last four are the models whose estimates are next to every result.
#[must_use]
pub fn bibtex([asperities, elements]: [usize; 2]) -> String {
    let cited = |work: &&Work| match work.of {
        Use::Always => true,
        Use::Asperities => asperities > 0,
        Use::BoundaryElements => elements > 0,
    };
    let entries: Vec<&str> = WORKS.iter().filter(cited).map(|work| work.bibtex).collect();
    entries.join("\n").replace("VERSION", env!("CARGO_PKG_VERSION"))
}
