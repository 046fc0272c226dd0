//! Coverage of the estimated discretization error by exact loops.

use super::{BONDED, johnson, probe, sphere};
use hysteron::physics::theory::grid_convergence::grid_error;

#[test]
fn val_print() {
    let start = std::time::Instant::now();
    for k in 0..9 {
        let alpha = 0.1 + 0.05 * k as f64;
        for n in [16, 32, 64, 128] {
            let [loss, least, ..] = johnson::computed(alpha, n, BONDED, None);
            println!("J {alpha:.2} {n} {loss:.4} {least:.4} {:?}", start.elapsed());
        }
    }
    for ratio in [7.0, 8.0, 9.0, 10.0, 11.0, 12.0] {
        for a0 in [3.0, 4.0, 6.0, 8.0, 12.0] {
            let (force, loss) = sphere::sphere((ratio * a0) as usize, a0);
            println!("S {ratio} {a0} {loss:.4} {force:.4} {:?}", start.elapsed());
        }
    }
    for alpha in [1.0, 1.5, 2.0, 3.0] {
        for per in [6.0, 12.0, 16.0, 24.0] {
            let (force, loss) = probe::wavy(alpha, per);
            println!("G {alpha} {per} {loss:.4} {force:.4} {:?}", start.elapsed());
        }
    }
    let _ = grid_error(&[1.0, 2.0], &[1.0, 1.0]);
}
