//! Versions of the methods: pinned results change with a new version, and with it the keys of all cycles.

use crate::{boundary_elements, golden};
use hysteron::physics::asperities::Asperities;
use hysteron::physics::cycle::Method;
use hysteron::physics::elements::Elements;

/// Method, version and BLAKE3 of the pinned results that it has. A new version gets a new row; no row changes.
const PINNED: [(&str, u32, &str); 4] = [
    (Asperities::NAME, 9, "d550b67c24db5f530f5abf562a629f816d270ee18e1eb4bac50de8926ef07b63"),
    (Elements::NAME, 11, "ca942a590f05217ca9fa99b9fdef940f002a8ece276c4e9e4de1e6a59b45f408"),
    // The plain law, whose loops are pinned, is that of version 11.
    (Elements::NAME, 12, "ca942a590f05217ca9fa99b9fdef940f002a8ece276c4e9e4de1e6a59b45f408"),
    (Elements::NAME, 13, "ca942a590f05217ca9fa99b9fdef940f002a8ece276c4e9e4de1e6a59b45f408"),
];

#[test]
fn reg_pinned_results_belong_to_a_version() {
    let all = [
        (Asperities::NAME, Asperities::VERSIONS, golden::pinned()),
        (Elements::NAME, Elements::VERSIONS, boundary_elements::golden::pinned()),
    ];
    for (name, versions, pinned) in all {
        assert!(versions.windows(2).all(|pair| pair[0].0 < pair[1].0) && versions.iter().all(|(_, change)| !change.is_empty()), "{name}");
        let digest = blake3::hash(pinned.as_bytes()).to_hex().to_string();
        let (version, _) = versions[versions.len() - 1];
        let row = PINNED.iter().find(|(of, number, _)| (*of, *number) == (name, version));
        let Some((.., known)) = row else { panic!("{name}: version {version} has no row; its results have the digest {digest}") };
        assert_eq!(digest, *known, "{name}: pinned results of version {version} have changed: a new result is a new version");
    }
}
