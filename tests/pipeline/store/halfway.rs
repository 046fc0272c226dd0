//! A unit on its way: only its own and only whole.

use hysteron::store::{read_halfway, write_halfway};
use std::fs;

#[test]
fn law_a_unit_on_its_way_is_read_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("halfway.bin");
    let key = "0123456789abcdef".repeat(4);
    assert_eq!(read_halfway(&path, &key), None);
    let bytes: Vec<u8> = (0..=255).cycle().take(300).collect();
    write_halfway(&path, &key, &bytes).unwrap();
    assert_eq!(read_halfway(&path, &key), Some(bytes));
    // Of another unit, cut short, or with one bit that is another, it is no unit's.
    assert_eq!(read_halfway(&path, &"f".repeat(64)), None);
    let whole = fs::read(&path).unwrap();
    for length in 0..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        assert_eq!(read_halfway(&path, &key), None, "{length} bytes");
    }
    for bit in (0..8 * whole.len()).step_by(3) {
        let mut flipped = whole.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        fs::write(&path, &flipped).unwrap();
        assert_eq!(read_halfway(&path, &key), None, "bit {bit}");
    }
    // Written by version 0.1.0, whose hash was of the bytes alone: another layout may decode into a wrong state.
    let bytes: Vec<u8> = (0..=255).collect();
    let earlier = [key.as_bytes(), blake3::hash(&bytes).to_hex().as_bytes(), &bytes].concat();
    fs::write(&path, earlier).unwrap();
    assert_eq!(read_halfway(&path, &key), None);
    write_halfway(&path, &key, &[]).unwrap();
    assert_eq!(read_halfway(&path, &key), Some(Vec::new()));
}
