#[test]
fn tmp() {
    use crate::support::*;
    for z in [16,32,64] { for r in 0..3 { for p in [4,8,16] {
        let made = surface(&paper_spectrum(0.8, z), r, p);
        let f = hysteron::physics::summits::find_summits(made.heights_m.view(), LENGTH, p as f64).unwrap();
        eprintln!("zeta {z} real {r} points {p}: n {} unrefined {} rejected {}", f.list.len(), f.unrefined, f.rejected);
    }}}
}
