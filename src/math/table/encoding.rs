//! Characters of a text file: UTF-8, UTF-16 with or without a byte order mark, or Windows-1252.

use std::path::Path;

use crate::error::{Error, Result};

/// Number of bytes that are examined for zeros.
const EXAMINED: usize = 4096;

/// First bytes of files that are no text tables, with the kind of file and the remedy.
const FOREIGN: [(&[u8], &str, &str); 7] = [
    (b"PK\x03\x04", "a zip archive, such as an Excel workbook", "save the sheet as CSV"),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook of the old format", "save the sheet as CSV"),
    (b"\x1f\x8b", "compressed by gzip", "unpack it"),
    (
        b"\x89HDF",
        "an HDF5 file, such as a MATLAB file of version 7.3",
        "write the columns as text, with a row of names",
    ),
    (b"MATLAB 5.0", "a binary MATLAB file", "write it with  save name.txt x -ascii"),
    (b"\x93NUMPY", "a NumPy array", "write it with  numpy.savetxt"),
    (b"version https://git-lfs", "a pointer of Git LFS and not the file itself", "fetch the file with  git lfs pull"),
];

/// Returns the text in `bytes`, with `\n` at the ends of its lines, and a remark if it is not plain UTF-8.
///
/// # Errors
/// `Scene` if the bytes are no text: names the kind of file.
pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<(String, Option<String>)> {
    let refuse = |what: &str, help: &str| {
        Err(Error::scene(format!("{} is not a table: it is {what}", path.display())).help(help))
    };
    if let Some((_, what, help)) = FOREIGN.into_iter().find(|(start, ..)| bytes.starts_with(start)) {
        return refuse(what, help);
    }
    let (text, remark) = match bytes {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => {
            return refuse("text in UTF-32", "save it in UTF-8");
        }
        [0xef, 0xbb, 0xbf, rest @ ..] => (utf8(rest).0, Some("UTF-8 with a byte order mark")),
        [0xff, 0xfe, rest @ ..] => (utf16(rest, u16::from_le_bytes), Some("UTF-16")),
        [0xfe, 0xff, rest @ ..] => (utf16(rest, u16::from_be_bytes), Some("UTF-16")),
        _ => match zeros(bytes) {
            (0, 0) => utf8(bytes),
            (0, _) => (utf16(bytes, u16::from_le_bytes), Some("UTF-16")),
            (_, 0) => (utf16(bytes, u16::from_be_bytes), Some("UTF-16")),
            _ => return refuse("binary", "write the columns as text, with a row of names"),
        },
    };
    let start = text.trim_start();
    if start.starts_with('<') && ["<!doctype html", "<html", "<?xml"].iter().any(|tag| begins_with(start, tag)) {
        return refuse("a web page or an XML file", "download the file itself, not the page that shows it");
    }
    let text = if text.contains('\r') { text.replace("\r\n", "\n").replace('\r', "\n") } else { text };
    Ok((text, remark.map(String::from)))
}

/// Returns whether `text` begins with `start`, in letters of any case.
fn begins_with(text: &str, start: &str) -> bool {
    text.get(..start.len()).is_some_and(|head| head.eq_ignore_ascii_case(start))
}

/// Returns the number of zeros among the first bytes at even and at odd places.
fn zeros(bytes: &[u8]) -> (usize, usize) {
    let head = bytes.iter().take(EXAMINED).enumerate().filter(|(_, byte)| **byte == 0);
    head.fold((0, 0), |(even, odd), (i, _)| if i % 2 == 0 { (even + 1, odd) } else { (even, odd + 1) })
}

/// Returns the text of UTF-8, or of Windows-1252 if the bytes are not UTF-8.
fn utf8(bytes: &[u8]) -> (String, Option<&'static str>) {
    match std::str::from_utf8(bytes) {
        Ok(text) => (text.into(), None),
        // Only the letters of Latin-1: numbers and separators are ASCII in both.
        Err(_) => (bytes.iter().map(|&byte| char::from(byte)).collect(), Some("characters of Windows-1252")),
    }
}

/// Returns the text of UTF-16 with this order of bytes.
fn utf16(bytes: &[u8], order: fn([u8; 2]) -> u16) -> String {
    let units = bytes.chunks_exact(2).map(|pair| order([pair[0], pair[1]]));
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}
