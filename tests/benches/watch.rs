//! Seconds, and how they are shown.

use std::hint::black_box;
use std::time::Instant;

/// The least of some times that each of two things takes, in turns, so that what else the machine does falls on both \[s\].
pub fn race<A, B>(rounds: usize, mut one: impl FnMut() -> A, mut other: impl FnMut() -> B) -> (f64, f64) {
    let mut least = (f64::INFINITY, f64::INFINITY);
    for _ in 0..rounds {
        least.0 = least.0.min(once(&mut one));
        least.1 = least.1.min(once(&mut other));
    }
    least
}

/// What one call takes \[s\].
pub fn once<T>(mut work: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}

/// Processor time of the program during one call \[s\], in steps of 10 ms; where the system does not tell, the time of the call.
pub fn cpu<T>(mut work: impl FnMut() -> T) -> f64 {
    // The 14th and 15th of its fields, behind the name in brackets, are hundredths of a second for programs and for the system.
    let spent = || -> Option<f64> {
        let text = std::fs::read_to_string("/proc/self/stat").ok()?;
        let fields = text.rsplit_once(')')?.1.split_whitespace();
        fields.skip(11).take(2).map(|field| Some(0.01 * field.parse::<f64>().ok()?)).sum()
    };
    let (start, before) = (Instant::now(), spent());
    black_box(work());
    match (before, spent()) {
        (Some(before), Some(after)) => after - before,
        _ => start.elapsed().as_secs_f64(),
    }
}

/// A heading, and what times are compared with.
pub fn heading(title: &str, against: &str) {
    println!("\n{title}\n{:>36}  {:>10}  {against}", "", "time");
}

/// One line: what, its time \[s\] and its ratio to the time of something plain.
pub fn line(what: &str, seconds: f64, ratio: f64) {
    println!("{what:>36}  {:>10}  {ratio:.3}", shown(seconds));
}

/// A line without a ratio.
pub fn plain(what: &str, seconds: f64) {
    println!("{what:>36}  {:>10}  1", shown(seconds));
}

fn shown(seconds: f64) -> String {
    match seconds {
        s if s < 1e-6 => format!("{:.2} ns", 1e9 * s),
        s if s < 1e-3 => format!("{:.2} us", 1e6 * s),
        s if s < 1.0 => format!("{:.2} ms", 1e3 * s),
        s => format!("{s:.2} s"),
    }
}
