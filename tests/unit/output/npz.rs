//! Unit tests of `src/output/npz.rs`.

use super::*;

#[test]
fn an_array_has_the_npy_format_of_numpy() {
    let bytes = npy_bytes(&[1.0, -2.5]);
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let size = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!((10 + size) % 64, 0, "the data begin at a multiple of 64 bytes");
    let header = String::from_utf8_lossy(&bytes[10..10 + size]).into_owned();
    assert_eq!(header.trim_end(), "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }");
    assert!(header.ends_with('\n'));
    assert_eq!(&bytes[10 + size..], [1.0_f64.to_le_bytes(), (-2.5_f64).to_le_bytes()].concat());
}

#[test]
fn two_arrays_of_the_same_name_are_refused() {
    assert!(npz_bytes([("a".to_string(), &[1.0][..]), ("a".to_string(), &[2.0][..])]).is_err());
    assert!(npz_bytes([("a".to_string(), &[1.0][..]), ("b".to_string(), &[][..])]).is_ok());
}
