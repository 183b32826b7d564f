//! What a page carries besides words: numbers as bytes, deflated and written in the 64 signs of a text.

use std::io::Write;

use base64::{Engine as _, prelude::BASE64_STANDARD};
use flate2::{Compression, write::DeflateEncoder};

/// Numbers as bytes, little-endian.
#[derive(Clone, Debug, Default)]
pub struct BinaryData(Vec<u8>);

impl BinaryData {
    /// Adds single-precision numbers; where they begin, in bytes.
    pub fn push_floats(&mut self, numbers: impl IntoIterator<Item = f32>) -> usize {
        let begin = self.0.len();
        self.0.extend(numbers.into_iter().flat_map(f32::to_le_bytes));
        begin
    }

    /// Adds whole numbers, first all low bytes, then all high ones, which are alike and pack well; where they begin.
    pub fn push_byte_planes(&mut self, numbers: &[u16]) -> usize {
        let begin = self.0.len();
        self.0.extend(numbers.iter().map(|n| *n as u8));
        self.0.extend(numbers.iter().map(|n| (n >> 8) as u8));
        begin
    }

    /// Bytes so far.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// All of it, deflated (without a header) and in base 64.
    pub fn to_base64(&self) -> String {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
        // Memory takes every byte.
        let packed = encoder.write_all(&self.0).and_then(|()| encoder.finish()).unwrap_or_default();
        BASE64_STANDARD.encode(packed)
    }
}

/// Differences as whole numbers that are small where the differences are: 0, −1, 1, −2, 2 … become 0, 1, 2, 3, 4 ….
pub fn zigzag(now: u16, before: u16) -> u16 {
    let d = now.wrapping_sub(before) as i16;
    ((d << 1) ^ (d >> 15)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_differences_are_small_numbers_and_come_back() {
        assert_eq!([zigzag(5, 5), zigzag(4, 5), zigzag(6, 5), zigzag(3, 5)], [0, 1, 2, 3]);
        for (now, before) in [(0, u16::MAX), (u16::MAX, 0), (40_000, 3), (3, 40_000)] {
            let z = zigzag(now, before);
            // As the page undoes it.
            let back = before.wrapping_add((z >> 1) ^ (z & 1).wrapping_neg());
            assert_eq!(back, now);
        }
    }
}
