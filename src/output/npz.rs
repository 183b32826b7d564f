//! Series in NumPy's format `.npz`: a zip file without compression, with one array for each series. `numpy.load` reads
//! it.

use std::{
    io::{Cursor, Write},
    path::Path,
};

use zip::{CompressionMethod, ZipWriter, result::ZipError, write::SimpleFileOptions};

use super::{require_parent_folder, write_atomically};
use crate::error::{Error, ErrorKind, Result};

/// The length of an array header is a multiple of this number of bytes.
const ALIGNED: usize = 64;

/// Writes the `arrays` with their names to the file at `path`, and replaces an existing file.
///
/// # Errors
/// `File` if the file cannot be written, or two arrays have the same name.
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

/// Returns an array in NumPy's format, version 1.0.
fn npy_bytes(numbers: &[f64]) -> Vec<u8> {
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", numbers.len());
    // Magic bytes, version and length take ten bytes; the header ends with a newline.
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
#[path = "../../tests/unit/output/npz.rs"]
mod tests;
