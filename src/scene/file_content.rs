//! Recognises files whose content is not that of their name, and decodes text files.

use std::path::Path;

use crate::error::{Error, Result};

/// The text of a file, and its encoding if it is not UTF-8 without a byte-order mark.
pub(crate) struct Text {
    pub(crate) text: String,
    pub(crate) encoding: Option<&'static str>,
}

/// Beginnings of packed files, with the name of the format. Letters are compared without case.
const PACKED: [(&[u8], &str); 3] =
    [(b"\x1f\x8b", "a file compressed by gzip"), (b"7z\xbc\xaf", "a 7-Zip archive"), (b"rar!", "a RAR archive")];

/// Beginnings of other foreign files, likewise.
const BEGINNINGS: [(&[u8], &str); 18] = [
    (b"pk\x03\x04", "a zip archive, as are .3mf and .usdz"),
    (b"%pdf", "a PDF document"),
    (b"\x89png", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"gif8", "a GIF picture"),
    (b"iso-10303-21", "a STEP file: exact surfaces, no triangles"),
    (b"ply", "a PLY mesh"),
    (b"gltf", "a glTF model"),
    (b"off\n", "an OFF mesh"),
    (b"off\r", "an OFF mesh"),
    (b"kaydara fbx", "an FBX model"),
    (b"# vtk datafile", "a VTK file"),
    (b"$meshformat", "a Gmsh mesh"),
    (b"ac10", "a DWG drawing"),
    (b"3d geometry file format", "a Rhino model"),
    (b"{", "JSON, such as an error of a server"),
    (b"<?xml", "XML"),
    (b"<collada", "a COLLADA model"),
];

/// Refuses a file that is a git-LFS pointer, a web page, or another known format than `wanted`.
///
/// # Errors
/// `Scene` with the kind of the content and the remedy.
pub(crate) fn check(path: &Path, bytes: &[u8], wanted: &str) -> Result<()> {
    let refuse = |what: &str, help: String| {
        Err(Error::scene(format!("{} cannot be read: it is not {wanted} but {what}", path.display())).help(help))
    };
    // The header of binary STL may contain any text.
    let count = bytes.get(80..84).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    if count.is_some_and(|count| bytes.len() as u64 == 84 + 50 * u64::from(count)) {
        match wanted {
            "STL" => return Ok(()),
            "OBJ" => return refuse("binary STL", "let the name end in .stl".into()),
            _ => {}
        }
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let begun = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    let start = bytes[begun..].iter().take(512).map(u8::to_ascii_lowercase).collect::<Vec<_>>();
    let contains = |word: &[u8]| start.windows(word.len()).any(|w| w == word);
    if bytes.is_empty() {
        return refuse("an empty file", "export or download it again".into());
    }
    if start.starts_with(b"version https://git-lfs") {
        let help = "the pointer stands for the file: fetch it with  git lfs pull";
        return refuse("a git-LFS pointer", help.into());
    }
    let html = start.starts_with(b"<!doctype html") || start.starts_with(b"<html") || start.starts_with(b"<head");
    if html || start.starts_with(b"<") && contains(b"<html") {
        return refuse(
            "a web page (HTML)",
            "download the file itself: the page has a link \"raw\" or \"download\"".into(),
        );
    }
    if let Some((_, name)) = PACKED.iter().find(|(begin, _)| start.starts_with(begin)) {
        return refuse(name, format!("unpack it, and give the {wanted} file in it"));
    }
    if wanted == "SVG" {
        return match BEGINNINGS.iter().find(|(begin, _)| begin[0] != b'<' && start.starts_with(begin)) {
            Some((_, name)) => refuse(name, "give a plain SVG file".into()),
            None => Ok(()),
        };
    }
    if contains(b"<svg") {
        return refuse("an SVG drawing", "a drawing is a polygon of a 2-D scene; a mesh is STL or OBJ".into());
    }
    if let Some((_, name)) = BEGINNINGS.iter().find(|(begin, _)| start.starts_with(begin)) {
        return refuse(name, format!("export it as {wanted} from the program that made it"));
    }
    let is_stl = start.starts_with(b"solid") && contains(b"facet") && contains(b"vertex");
    if wanted == "OBJ" && is_stl {
        return refuse("STL as text", "let the name end in .stl".into());
    }
    let line = |words: [&str; 3]| {
        let text = String::from_utf8_lossy(&start);
        let mut lines = text.lines().map(str::trim_start);
        lines.any(|line| words.iter().any(|word| line.starts_with(word)))
    };
    if wanted == "STL" && !start.starts_with(b"solid") && !start.contains(&0) && line(["v ", "mtllib ", "o "]) {
        return refuse("OBJ", "let the name end in .obj".into());
    }
    Ok(())
}

/// Returns the text of the file: UTF-8 or UTF-16 with a byte-order mark, or ASCII; other bytes are replaced.
pub(crate) fn decode(bytes: &[u8]) -> Text {
    let wide = |from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| from([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => Text {
            text: String::from_utf8_lossy(rest).into_owned(),
            encoding: Some("UTF-8 with a byte-order mark (BOM)"),
        },
        [0xff, 0xfe, ..] => {
            Text { text: wide(u16::from_le_bytes), encoding: Some("UTF-16 with a byte-order mark (BOM)") }
        }
        [0xfe, 0xff, ..] => {
            Text { text: wide(u16::from_be_bytes), encoding: Some("UTF-16 with a byte-order mark (BOM)") }
        }
        _ => Text { text: String::from_utf8_lossy(bytes).into_owned(), encoding: None },
    }
}
