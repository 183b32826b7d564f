//! Encodes numbers for a page: bytes, compressed with DEFLATE and written in base 64.

use std::io::Write;

use flate2::{Compression, write::DeflateEncoder};

/// The digits of base 64 (RFC 4648).
const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Numbers as bytes, little-endian.
#[derive(Clone, Debug, Default)]
pub(crate) struct BinaryData(Vec<u8>);

impl BinaryData {
    /// Appends single-precision numbers, and returns the position of the first number in bytes.
    pub(crate) fn push_floats(&mut self, numbers: impl IntoIterator<Item = f32>) -> usize {
        let begin = self.0.len();
        self.0.extend(numbers.into_iter().flat_map(f32::to_le_bytes));
        begin
    }

    /// Appends integers: first all low bytes, then all high bytes, which are similar and compress well. Returns the
    /// position of the first byte.
    pub(crate) fn push_byte_planes(&mut self, numbers: &[u16]) -> usize {
        let begin = self.0.len();
        self.0.extend(numbers.iter().map(|n| *n as u8));
        self.0.extend(numbers.iter().map(|n| (n >> 8) as u8));
        begin
    }

    /// Returns the number of bytes.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Removes all bytes from position `length` on.
    pub(crate) fn truncate(&mut self, length: usize) {
        self.0.truncate(length);
    }

    /// Returns all bytes, compressed with DEFLATE (without a header) and in base 64.
    pub(crate) fn to_base64(&self) -> String {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
        // A write to memory cannot fail.
        let packed = encoder.write_all(&self.0).and_then(|()| encoder.finish()).unwrap_or_default();
        base64(&packed)
    }
}

/// Returns `bytes` in base 64 with padding.
fn base64(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, i| bits << 8 | usize::from(group.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            text.push(if i <= group.len() { char::from(DIGITS[bits >> (18 - 6 * i) & 63]) } else { '=' });
        }
    }
    text
}

/// Returns the difference as an integer that is small for small differences: 0, −1, 1, −2, 2 … become 0, 1, 2, 3, 4 ….
pub(crate) fn zigzag(now: u16, before: u16) -> u16 {
    let d = now.wrapping_sub(before) as i16;
    ((d << 1) ^ (d >> 15)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_64_is_that_of_the_standard() {
        for (bytes, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("fooba", "Zm9vYmE=")]
        {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0, 0x80, 0xff, 0xfb, 0x3f]), "AID/+z8=");
    }

    #[test]
    fn small_differences_are_small_numbers_and_come_back() {
        assert_eq!([zigzag(5, 5), zigzag(4, 5), zigzag(6, 5), zigzag(3, 5)], [0, 1, 2, 3]);
        for (now, before) in [(0, u16::MAX), (u16::MAX, 0), (40_000, 3), (3, 40_000)] {
            let z = zigzag(now, before);
            // The scripts of the page use the same inverse.
            let back = before.wrapping_add((z >> 1) ^ (z & 1).wrapping_neg());
            assert_eq!(back, now);
        }
    }
}
