// The build script copies the pages and turns links between files into links between modules.
#![doc = include_str!(concat!(env!("OUT_DIR"), "/guide/index.md"))]

macro_rules! pages {
    ($($name:ident),+ $(,)?) => {
        $(
            #[doc = include_str!(concat!(env!("OUT_DIR"), "/guide/", stringify!($name), ".md"))]
            pub mod $name {}
        )+
    };
}

pages!(
    tutorial,
    howto_scan,
    howto_probe,
    howto_spectrum,
    howto_loop,
    howto_sweep,
    howto_cluster,
    howto_data,
    howto_recover,
    model,
    boundary_elements,
    numerics,
    validity,
    reproduction,
    reference_spec,
    reference_cli,
    reference_limits,
    tables,
    report,
    python,
    performance,
    architecture,
    elements_numerics,
    contributing,
    glossary,
);
