//! Damaged files: cut at every length, changed at any byte.

use std::fs::{self, File};
use std::io::{Seek, SeekFrom, Write};

use hysteron::store::scan::{Asked, Format, read};
use ndarray::Array2;
use zip::CompressionMethod::{Deflated, Stored};

use super::make::{archive, little, main_xml, npy, npy_line};
use super::netcdf::surface;
use super::scan_at;

/// A good file of each kind.
pub fn good() -> Vec<(&'static str, Format, Vec<u8>)> {
    let heights = Array2::from_shape_fn((3, 4), |(row, column)| (row * 4 + column) as f64 / 3.0);
    let data = little(&heights);
    let link = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>";
    let xml = main_xml(["3", "4", "1"], "<DataType>D</DataType>", link);
    let parts = [("main.xml", xml.as_bytes()), ("bindata/data.bin", &data), ("bindata/valid.bin", &[255, 15])];
    let text = "# Channel: Main\n# Width: 10 µm\n# Height: 10 µm\n# Value units: nm\n1.0\tnan\t2e-3\n--\t\t5\n";
    vec![
        ("npy 1", Format::Npy, npy(1, &npy_line("<f8", "False", "(3, 4)"), &data)),
        ("npy 3", Format::Npy, npy(3, &npy_line("<f8", "True", "(3, 4)"), &data)),
        ("CDF-1", Format::NetCdf3, surface(1).bytes()),
        ("CDF-2", Format::NetCdf3, surface(2).bytes()),
        ("CDF-5", Format::NetCdf3, surface(5).bytes()),
        ("X3P, stored", Format::X3p, archive(&parts, Stored)),
        ("X3P, deflated", Format::X3p, archive(&parts, Deflated)),
        ("text", Format::Text, text.as_bytes().to_vec()),
        ("text, headed", Format::Text, b"h=2 w=2\npixel size=3e-7 m\nheight conversion factor (-> m)=3e-8\n1;2\n3;4\n".to_vec()),
    ]
}

#[test]
fn law_what_is_cut_short_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan");
    for (name, format, bytes) in good() {
        assert!(scan_at(&path, &bytes, format, None).is_ok(), "{name}");
        for length in 0..bytes.len() {
            let result = scan_at(&path, &bytes[..length], format, None);
            // Text can end anywhere; all others know how long they are.
            assert!(format == Format::Text || result.is_err(), "{name} cut at {length} of {}", bytes.len());
        }
    }
}

#[test]
fn law_no_byte_ends_the_program() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move |below: usize| {
        // xorshift64*
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % below
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan");
    for (name, format, good) in good() {
        fs::write(&path, &good).unwrap();
        let mut file = File::options().write(true).open(&path).unwrap();
        let mut put = |place: usize, byte: u8| {
            file.seek(SeekFrom::Start(place as u64)).unwrap();
            file.write_all(&[byte]).unwrap();
        };
        let mut fine = 0;
        for _ in 0..20_000 {
            let place = random(good.len());
            let byte = match random(4) {
                0 => 0xff,
                1 => good[place] ^ 1 << random(8),
                _ => random(256) as u8,
            };
            put(place, byte);
            let result = read(&path, format, &Asked::default());
            if let Err(error) = &result {
                let message = error.to_string();
                assert!(!message.contains("does not foresee"), "{name}: {message}");
            }
            put(place, good[place]);
            fine += usize::from(result.is_ok());
        }
        // Many bytes are only values.
        assert!(fine > 0, "{name}");
    }
}
