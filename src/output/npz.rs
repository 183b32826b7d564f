//! Series as NumPy's `.npz`: an array for each, in a zip that is not packed. `numpy.load` reads it.

use std::{
    io::{Cursor, Write},
    path::Path,
};

use zip::{CompressionMethod, ZipWriter, result::ZipError, write::SimpleFileOptions};

use super::{require_parent_folder, write_atomically};
use crate::error::{Error, ErrorKind, Result};

/// Headers of arrays end at a multiple of so many bytes.
const ALIGNED: usize = 64;

/// Writes the `arrays` with their names to the file at `path`, which may be there.
///
/// # Errors
/// `File` if it cannot be written, or two arrays have the same name.
pub fn write<'a>(path: &Path, arrays: impl IntoIterator<Item = (String, &'a [f64])>) -> Result<()> {
    require_parent_folder(path)?;
    let bytes = npz_bytes(arrays).map_err(|why| Error::new(ErrorKind::File, format!("{}: {why}", path.display())))?;
    write_atomically(path, &bytes)
}

fn npz_bytes<'a>(arrays: impl IntoIterator<Item = (String, &'a [f64])>) -> std::result::Result<Vec<u8>, ZipError> {
    let mut file = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, numbers) in arrays {
        file.start_file(format!("{name}.npy"), options)?;
        file.write_all(&npy_bytes(numbers))?;
    }
    Ok(file.finish()?.into_inner())
}

/// An array in NumPy's own format, version 1.0.
fn npy_bytes(numbers: &[f64]) -> Vec<u8> {
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", numbers.len());
    // Magic word, version and length take ten bytes; the header ends with a line.
    let size = (10 + header.len() + 1).next_multiple_of(ALIGNED) - 10;
    header += &" ".repeat(size - 1 - header.len());
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((size as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.push(b'\n');
    bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_is_what_numpy_writes() {
        let bytes = npy_bytes(&[1.0, -2.5]);
        assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
        let size = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        assert_eq!((10 + size) % 64, 0, "numbers begin at a multiple of 64 bytes");
        let header = String::from_utf8_lossy(&bytes[10..10 + size]).into_owned();
        assert_eq!(header.trim_end(), "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }");
        assert!(header.ends_with('\n'));
        assert_eq!(&bytes[10 + size..], [1.0_f64.to_le_bytes(), (-2.5_f64).to_le_bytes()].concat());
    }

    #[test]
    fn two_arrays_of_one_name_are_refused() {
        assert!(npz_bytes([("a".to_string(), &[1.0][..]), ("a".to_string(), &[2.0][..])]).is_err());
        assert!(npz_bytes([("a".to_string(), &[1.0][..]), ("b".to_string(), &[][..])]).is_ok());
    }
}
