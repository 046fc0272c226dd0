//! Files: a surface and a table of contacts, against the same bytes written plainly.

use crate::paper::spectrum;
use crate::watch::{heading, line, plain, race};
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use hysteron::schema::CONTACTS;
use hysteron::store::hdf5::{SurfaceHeader, write_surface};
use hysteron::store::parquet::write_table;
use hysteron::store::{Frame, FrameBuilder};
use std::fs::write;

/// Rows of the table: the spots of some hundred steps at ζ = 256.
const ROWS: usize = 400_000;

fn contacts(spots: &[f64]) -> FrameBuilder {
    Frame::of(&CONTACTS)
        .text("cycle_id", vec!["H0.80_z256_r00-0123abcd"; ROWS])
        .text("case_id", vec!["H0.80_z256-0123abcd"; ROWS])
        .i64("realization", vec![0; ROWS])
        .i64("step", (0..ROWS).map(|k| (k / 2000) as i64))
        .text("branch", (0..ROWS).map(|k| if k < ROWS / 2 { "loading" } else { "unloading" }))
        .f64("max_load", (0..ROWS).map(|k| (k >= ROWS / 2).then_some(0.0071)))
        .i64("asperity_id", (0..ROWS).map(|k| (k % 2000) as i64))
        .text("state", (0..ROWS).map(|k| if k % 5 == 0 { "covered" } else { "contact" }))
        .f64("contact_radius_m", spots.iter().copied())
        .f64("load_n", spots.iter().map(|a| 2.0 * a))
        .f64("penetration_m", spots.iter().map(|a| 3.0 * a))
        .f64("interaction_m", spots.iter().map(|a| 5.0 * a))
}

pub fn run() {
    heading("tables: written, and committed whole", "over plain bytes");
    let folder = tempfile::tempdir().unwrap();
    let (kept, bare) = (folder.path().join("kept"), folder.path().join("bare"));
    let spectrum = spectrum(256);
    let surface = synthesize(&spectrum, &realization_seed(2021, 0), 2048);
    let header = SurfaceHeader {
        length_m: spectrum.length_m,
        realization: 0,
        periodic: true,
        key: "none".to_owned(),
        rms_height_m: surface.moments.rms_height_m(),
        rms_slope: surface.moments.rms_slope(),
        rms_curvature_1_m: surface.moments.rms_curvature_1_m(),
        nayak_parameter: surface.moments.nayak_parameter(),
        generated: None,
        measured: None,
    };
    let bytes: Vec<u8> = surface.heights_m.iter().flat_map(|height| height.to_ne_bytes()).collect();
    let compare = |what: &str, bytes: &[u8], work: &mut dyn FnMut()| {
        let (ours, theirs) = race(5, work, || write(&bare, bytes).unwrap());
        plain(&format!("{} MB of bytes", bytes.len() / 1_000_000), theirs);
        line(what, ours, ours / theirs);
    };
    compare("2048 x 2048 heights as HDF5", &bytes, &mut || write_surface(&kept, &header, surface.heights_m.view()).map(drop).unwrap());
    let spots: Vec<f64> = surface.heights_m.iter().take(ROWS).map(|height| height.abs()).collect();
    let frame = contacts(&spots).build().unwrap();
    let bytes: Vec<u8> = (0..6).flat_map(|_| spots.iter().flat_map(|a| a.to_ne_bytes())).collect();
    compare(&format!("{ROWS} contacts as Parquet"), &bytes, &mut || write_table(&kept, &frame, &[]).map(drop).unwrap());
}
