//! STL files: text in double precision, or binary in single precision, each with one or more solids. The normals in the
//! file are not used.

use std::{path::Path, str::SplitAsciiWhitespace};

use super::{MeshFile, coordinate, damaged, text};
use crate::error::{Error, Result};

/// Bytes before the facets of a binary solid: 80 of a header, and their number.
const HEADER: usize = 84;

/// Bytes of a binary facet: normal and corners, and two of attributes.
const FACET: usize = 50;

/// Returns the content of an STL file.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<MeshFile> {
    let begun = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let begun = begun.iter().position(|b| !b.is_ascii_whitespace()).map_or(&[][..], |i| &begun[i..]);
    let named = begun.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // A binary file may begin with the keyword of the text format; its number of facets contains a zero byte.
    let wide = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    if wide || named && !bytes.iter().take(HEADER + FACET).any(|b| *b == 0) {
        return parse_text(path, bytes);
    }
    if bytes.len() < HEADER {
        return Err(damaged(path, "it is neither STL as text, which begins with \"solid\", nor as long as binary STL"));
    }
    parse_binary(path, bytes)
}

fn parse_binary(path: &Path, bytes: &[u8]) -> Result<MeshFile> {
    let mut file = MeshFile { single: true, ..MeshFile::default() };
    let (mut rest, mut part) = (bytes, 0);
    while let Some((count, facets)) = counted(rest) {
        if facets.len() / FACET < count {
            let there = facets.len() / FACET;
            return Err(damaged(path, format!("it is cut short: it says {count} facets, and has {there}")));
        }
        let (own, after) = facets.split_at(FACET * count);
        // Files of several solids, each with its header, follow one another.
        let follows = counted(after).is_some_and(|(count, facets)| count > 0 && facets.len() >= FACET * count);
        let own = if after.is_empty() || follows {
            own
        } else if after.len() % FACET == 0 && part == 0 {
            file.notes.push(format!("it says {count} facets, and has {}, which are read", facets.len() / FACET));
            facets
        } else {
            file.notes.push(format!("{} bytes after its last facet are not read", after.len()));
            own
        };
        for facet in own.chunks_exact(FACET) {
            let number = |i: usize| f32::from_le_bytes([facet[i], facet[i + 1], facet[i + 2], facet[i + 3]]);
            let corners = [12, 24, 36].map(|i| [0, 4, 8].map(|j| f64::from(number(i + j))));
            if corners.iter().flatten().any(|x| !x.is_finite()) {
                let number = file.surface.facets.len() + 1;
                return Err(damaged(path, format!("a corner of facet {number} is not a finite number")));
            }
            file.push(path, corners, part)?;
        }
        part += 1;
        rest = if follows { after } else { &[] };
    }
    if part > 1 {
        file.notes.push(format!("its {part} solids are read as one"));
    }
    Ok(file)
}

/// Returns the number of facets that the header of a binary solid gives, and the bytes after the header.
fn counted(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let count = bytes.get(80..HEADER)?.try_into().ok()?;
    Some((u32::from_le_bytes(count) as usize, &bytes[HEADER..]))
}

/// Skips the name of a solid, up to the next facet of the line. Returns whether there is one.
fn skip_to_facet(words: &mut SplitAsciiWhitespace) -> bool {
    let mut ahead = words.clone();
    while let Some(word) = ahead.next() {
        let is_facet = word.eq_ignore_ascii_case("facet");
        if is_facet && ahead.clone().next().is_some_and(|next| next.eq_ignore_ascii_case("normal")) {
            return true;
        }
        *words = ahead.clone();
    }
    false
}

fn parse_text(path: &Path, bytes: &[u8]) -> Result<MeshFile> {
    let (text, notes) = text(path, bytes)?;
    let mut file = MeshFile { notes, ..MeshFile::default() };
    let (mut solids, mut ended) = (0, false);
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let last = text.lines().count();
    for (line, text) in text.lines().enumerate().map(|(i, text)| (i + 1, text)) {
        let mut words = text.split_ascii_whitespace();
        let cut = |rest: &SplitAsciiWhitespace, error: Error| match line == last && rest.clone().next().is_none() {
            true => damaged(path, format!("it is cut short: it ends within line {line}")),
            false => error,
        };
        while let Some(word) = words.next() {
            match word.to_ascii_lowercase().as_str() {
                // A name follows.
                "solid" => {
                    (solids, ended) = (solids + 1, false);
                    skip_to_facet(&mut words);
                }
                "endsolid" => {
                    ended = !skip_to_facet(&mut words);
                    solids += u32::from(!ended);
                }
                // The normal is not used.
                "facet" => {
                    let _ = words.by_ref().take(4).count();
                    corners.clear();
                }
                "outer" => {
                    let _ = words.next();
                }
                "vertex" => {
                    let mut next = || coordinate(path, line, words.next()).map_err(|e| cut(&words, e));
                    corners.push([next()?, next()?, next()?]);
                }
                "endloop" => match corners[..] {
                    [a, b, c] => {
                        file.push(path, [a, b, c], solids)?;
                        corners.clear();
                    }
                    _ => {
                        let why = format!("line {line}: a facet has {} corners, not 3", corners.len());
                        return Err(damaged(path, why));
                    }
                },
                "endfacet" => {}
                // An extension of some programs.
                "color" => {
                    skip_to_facet(&mut words);
                }
                _ => return Err(cut(&words, damaged(path, format!("line {line}: \"{word}\" is no word of STL")))),
            }
        }
    }
    if !corners.is_empty() {
        return Err(damaged(path, "it is cut short: it ends within a facet"));
    }
    if !ended {
        file.notes.push("it has no \"endsolid\" at its end, so it may be cut short".into());
    }
    if solids > 1 {
        file.notes.push(format!("its {solids} solids are read as one"));
    }
    Ok(file)
}
