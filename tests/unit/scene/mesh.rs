//! Mesh files as programs write them: exact volumes, the notes, and the reasons of refusals.

use std::{
    f64::consts::PI,
    fs,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
};

use super::*;
use crate::geometry::{ContactGeometry, Shape};

/// Particle spacing of the tests, m.
const DP: f64 = 0.02;

/// Corners of a box from `min` to `max`, and its six sides, counter-clockwise seen from outside.
fn block(min: [f64; 3], max: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[usize; 4]>) {
    let at = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 1 { max[k] } else { min[k] });
    ((0..8).map(at).collect(), vec![[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
}

/// Triangles of a box.
fn facets(min: [f64; 3], max: [f64; 3]) -> Vec<[[f64; 3]; 3]> {
    let (points, sides) = block(min, max);
    sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|f| f.map(|i| points[i])).collect()
}

/// The box of the tests: 0.4 × 0.2 × 0.1 m, 0.008 m³.
fn hull() -> Vec<[[f64; 3]; 3]> {
    facets([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05])
}

fn solid(name: &str, facets: &[[[f64; 3]; 3]]) -> String {
    let facet = |f: &[[f64; 3]; 3]| {
        let corners = f.map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
        format!("facet normal nan nan nan\nouter loop\n{corners}endloop\nendfacet\n")
    };
    format!("solid {name}\n{}endsolid {name}\n", facets.iter().map(facet).collect::<String>())
}

fn binary(header: &str, count: usize, facets: &[[[f64; 3]; 3]]) -> Vec<u8> {
    let mut bytes = format!("{header:80}").into_bytes();
    bytes.extend((count as u32).to_le_bytes());
    for facet in facets {
        let numbers =
            [[f64::NAN; 3]].iter().chain(facet).flatten().flat_map(|x| (*x as f32).to_le_bytes()).collect::<Vec<_>>();
        bytes.extend(numbers.into_iter().chain([0, 0]));
    }
    bytes
}

/// Corners and four-sided facets.
type Quads = (Vec<[f64; 3]>, Vec<[usize; 4]>);

fn obj(solids: &[Quads]) -> String {
    let (mut text, mut first) = (String::new(), 1);
    for (points, sides) in solids {
        points.iter().for_each(|[x, y, z]| text += &format!("v {x} {y} {z}\n"));
        sides.iter().for_each(|s| text += &format!("f {}\n", s.map(|i| (i + first).to_string()).join(" ")));
        first += points.len();
    }
    text
}

fn options(completion: Completion) -> MeshOptions {
    MeshOptions { unit: 1.0, flip: false, completion, dp: DP }
}

/// Writes `bytes` into a file with this ending and reads it.
fn read_as(ending: &str, bytes: &[u8], options: &MeshOptions) -> Result<(Mesh, Vec<FileNote>)> {
    static NUMBER: AtomicUsize = AtomicUsize::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let path = std::env::temp_dir().join(format!("pontoon-mesh-{}-{number}.{ending}", std::process::id()));
    fs::write(&path, bytes).unwrap();
    let result = read(&path, options);
    fs::remove_file(&path).unwrap();
    result
}

/// Asserts the volume of the solid in a file, and returns its notes, joined.
fn assert_volume(ending: &str, bytes: &[u8], completion: Completion, volume: f64, bound: f64) -> String {
    let (mesh, notes) = read_as(ending, bytes, &options(completion)).unwrap();
    let found = mesh.volume_properties().volume;
    assert!((found - volume).abs() <= bound * volume, "{found} m³ in place of {volume}; {notes:?}");
    notes.iter().map(|note| note.what.clone()).collect::<Vec<_>>().join("; ")
}

fn plain(ending: &str, bytes: &[u8], volume: f64) -> String {
    // Ten sums and products: 1e-14.
    assert_volume(ending, bytes, Completion::default(), volume, 1e-14)
}

fn refusal(ending: &str, bytes: &[u8], completion: Completion) -> String {
    read_as(ending, bytes, &options(completion)).err().map(|e| e.to_string()).unwrap_or_default()
}

fn assert_parts(message: &str, parts: &[&str]) {
    parts.iter().for_each(|part| assert!(message.contains(part), "no \"{part}\" in: {message}"));
}

#[test]
fn all_solids_of_an_stl_file_count() {
    let other = facets([0.5, -0.1, -0.05], [0.7, 0.1, 0.05]);
    let two = solid("a b", &hull()) + &solid("", &other);
    // 0.008 and 0.004 m³.
    assert_parts(&plain("stl", two.as_bytes(), 0.012), &["its 2 solids are read as one"]);
    let headers = [binary("solid a", 12, &hull()), binary("b", 12, &other)].concat();
    let notes = assert_volume("stl", &headers, Completion::default(), 0.012, 1e-6);
    assert_parts(&notes, &["its 2 solids are read as one"]);
    // The faces of one body as a solid each, and two bodies that share a whole face.
    let faces: String = hull().chunks(2).map(|face| solid("face", face)).collect();
    plain("stl", faces.as_bytes(), 0.008);
    let beside = solid("a", &hull()) + &solid("b", &facets([0.2, -0.1, -0.05], [0.4, 0.1, 0.05]));
    assert_parts(&plain("stl", beside.as_bytes(), 0.012), &["lie back to back"]);
    // An L: the edge at the top has four facets, but each body is closed.
    let corner = solid("a", &hull()) + &solid("b", &facets([0.2, -0.1, 0.0], [0.4, 0.1, 0.05]));
    plain("stl", corner.as_bytes(), 0.010);
    let objects = obj(&[block([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05]), block([0.2, -0.1, 0.0], [0.4, 0.1, 0.05])]);
    plain("obj", objects.as_bytes(), 0.010);
    let twice = solid("a", &hull()) + &solid("a", &hull());
    assert_parts(&plain("stl", twice.as_bytes(), 0.008), &["12 facets repeat others"]);
}

#[test]
fn corners_that_nearly_meet_are_joined_and_counted() {
    // Shifts of up to 5e-8 m: 1.3e-7 of the size.
    let mut number = 0_u32;
    let mut near = |x: f64| {
        number = (number * 5 + 3) % 11;
        x + 1e-8 * (f64::from(number) - 5.0)
    };
    let moved = hull().iter().map(|f| f.map(|p| p.map(&mut near))).collect::<Vec<_>>();
    let places: std::collections::HashSet<String> = moved.iter().flatten().map(|p| format!("{p:?}")).collect();
    let text = solid("near", &moved);
    // Each of the six sides moves by at most 5e-8 m of 0.1 m: 2 × 5e-8 × (1/0.1 + 1/0.2 + 1/0.4) = 1.8e-6.
    let notes = assert_volume("stl", text.as_bytes(), Completion::default(), 0.008, 1.8e-6);
    assert_parts(&notes, &[&format!("{} corners are joined", places.len() - 8), "1e-6 of the size"]);
    // Corners 2e-5 m apart stay open: 5e-5 of the size.
    let apart = solid("apart", &hull()).replacen("0.2", "0.20002", 1);
    assert_parts(&refusal("stl", apart.as_bytes(), Completion::default()), &["the mesh is open"]);
}

#[test]
fn text_has_double_precision_and_binary_files_far_away_are_told() {
    let far = facets([451_234.3, 5_432_100.15, -0.05], [451_234.7, 5_432_100.35, 0.05]);
    // Coordinates of 5e6 m have steps of 9e-10 m, 5e-9 of 0.2 m.
    assert_volume("stl", solid("utm", &far).as_bytes(), Completion::default(), 0.008, 1e-8);
    let (_, notes) =
        read_as("stl", &binary("b", 12, &facets([1000.0; 3], [1000.5; 3])), &options(Completion::default())).unwrap();
    assert!(notes.iter().any(|note| note.is_warning && note.what.contains("single precision")), "{notes:?}");
    assert_eq!(assert_volume("stl", &binary("b", 12, &hull()), Completion::default(), 0.008, 1e-6), "");
}

#[test]
fn binary_files_that_begin_as_text_or_say_a_wrong_number_are_read_or_refused() {
    assert_volume("stl", &binary("Rhinoceros Binary STL", 12, &hull()), Completion::default(), 0.008, 1e-6);
    assert_volume("stl", &binary("ply <html> v 0 0 0", 12, &hull()), Completion::default(), 0.008, 1e-6);
    assert_volume("stl", &binary("solid facet vertex", 12, &hull()), Completion::default(), 0.008, 1e-6);
    let notes = assert_volume("stl", &binary("b", 7, &hull()), Completion::default(), 0.008, 1e-6);
    assert_parts(&notes, &["it says 7 facets, and has 12"]);
    let cut = binary("b", 12, &hull()[..11]);
    assert_parts(&refusal("stl", &cut, Completion::default()), &["cut short: it says 12 facets, and has 11"]);
    assert_parts(&refusal("stl", &binary("solid", 12, &hull())[..300], Completion::default()), &["cut short"]);
    let text = solid("a", &hull());
    assert_parts(&refusal("stl", &text.as_bytes()[..400], Completion::default()), &["cut short"]);
    let open = solid("a", &hull()[..11]).replace("endsolid a", "");
    assert_parts(&refusal("stl", open.as_bytes(), Completion::default()), &["no \"endsolid\"", "the mesh is open"]);
    let comma = text.replacen("-0.2", "-0,2", 1);
    assert_parts(&refusal("stl", comma.as_bytes(), Completion::default()), &["line 4", "comma in place of"]);
    let quad = text.replacen("endloop", "vertex 0 0 0\nendloop", 1);
    assert_parts(&refusal("stl", quad.as_bytes(), Completion::default()), &["line 8", "4 corners, not 3"]);
    plain("stl", text.replace('\n', "\r\n").to_uppercase().as_bytes(), 0.008);
    plain("stl", text.replace('\n', " ").replacen("solid a", "solid a\n", 1).as_bytes(), 0.008);
    // On one line, also with two solids and names of words of the format; with the line ends of old Macintosh computers.
    plain("stl", text.replace('\n', " ").as_bytes(), 0.008);
    plain("stl", text.replace('\n', "\r").as_bytes(), 0.008);
    let other = solid("solid facet of b", &facets([0.5, -0.1, -0.05], [0.7, 0.1, 0.05]));
    let two = plain("stl", (solid("a", &hull()) + &other).replace('\n', " ").as_bytes(), 0.012);
    assert_parts(&two, &["its 2 solids are read as one"]);
    let line = text.replace('\n', " ");
    assert_parts(&refusal("stl", &line.as_bytes()[..line.len() / 2], Completion::default()), &["cut short"]);
    let comma = line.replacen("-0.2", "-0,2", 1);
    assert_parts(&refusal("stl", comma.as_bytes(), Completion::default()), &["comma in place of"]);
    plain("obj", obj(&[block([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05])]).replace('\n', "\r").as_bytes(), 0.008);
}

#[test]
fn files_of_another_kind_are_named() {
    let named = |ending: &str, bytes: &[u8], parts: &[&str]| {
        assert_parts(&refusal(ending, bytes, Completion::default()), parts)
    };
    named(
        "stl",
        b"version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 12\n",
        &["git-LFS pointer", "git lfs pull"],
    );
    named("obj", b"version https://git-lfs.github.com/spec/v1\n", &["git-LFS pointer"]);
    named("stl", b"\n<!DOCTYPE html>\n<html><body>not found</body></html>", &["a web page"]);
    named("stl", b"<?xml version=\"1.0\"?><!DOCTYPE html PUBLIC \"\"><html>", &["a web page"]);
    named("stl", b"PK\x03\x04 and so on", &["zip archive"]);
    named("stl", b"\x1f\x8b\x08 and so on", &["compressed by gzip", "unpack it"]);
    named("stl.gz", b"\x1f\x8b\x08 and so on", &["neither .stl nor .obj", "unpack it"]);
    named("obj", &binary("box", 12, &hull()), &["not OBJ but binary STL", ".stl"]);
    named("stl", b"ISO-10303-21;\nHEADER;", &["STEP"]);
    named("obj", solid("a", &hull()).as_bytes(), &["STL as text", ".stl"]);
    named("stl", obj(&[block([0.0; 3], [1.0; 3])]).as_bytes(), &["not STL but OBJ", ".obj"]);
    named("stl", b"", &["cannot be read", "empty"]);
    let with_mark = [b"\xef\xbb\xbf", solid("a", &hull()).as_bytes()].concat();
    assert_parts(&plain("stl", &with_mark, 0.008), &["byte-order mark (BOM)"]);
    let wide: Vec<u8> =
        "\u{feff}".encode_utf16().chain(solid("a", &hull()).encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert_parts(&plain("stl", &wide, 0.008), &["UTF-16"]);
}

#[test]
fn obj_files_of_every_style_define_the_same_solid() {
    let text = obj(&[block([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05])]);
    plain("obj", text.as_bytes(), 0.008);
    let negative = text.replace("f 1 3 4 2", "f -8 -6 -5 -7").replace("f 5 6 8 7", "f -4/1 -3/2/1 -1//3 -2");
    plain("obj", negative.as_bytes(), 0.008);
    let continued = text.replace("f 1 3 4 2", "f 1 3 \\\r\n 4 2").replace('\n', "\r\n");
    plain("obj", continued.as_bytes(), 0.008);
    let coloured =
        text.replace("0.05\nv", "0.05 0.5 0.5 1.0\nv").replace("f 1 3", "g a b\no c\ns 1\nusemtl x\nl 1 2\np 3\nf 1 3");
    plain("obj", coloured.as_bytes(), 0.008);
    // Facets before their corners.
    let (corners, sides) = text.split_at(text.find('f').unwrap());
    plain("obj", format!("{sides}{corners}").as_bytes(), 0.008);
    let error = |from: &str, to: &str| refusal("obj", text.replacen(from, to, 1).as_bytes(), Completion::default());
    assert_parts(&error("f 1 3 4 2", "f 1 3 4 9"), &["line 9", "no corner 9", "only 8"]);
    assert_parts(&error("f 1 3 4 2", "f 1 3"), &["line 9", "three corners or more"]);
    assert_parts(&error("f 1 3 4 2", "fx 1 3"), &["line 9", "\"fx\" is no word of OBJ"]);
    assert_parts(&error("f 1 3 4 2", "cstype bspline"), &["curved surface"]);
}

#[test]
fn facets_of_many_corners_are_filled_although_they_are_concave() {
    // A star prism 0.1 m high: ten corners at radius 0.2 and 0.08 m; area 5 R r sin 36°.
    let corner = |i: u32| {
        let (y, x) = (PI * f64::from(i) / 5.0).sin_cos();
        let radius = if i.is_multiple_of(2) { 0.2 } else { 0.08 };
        (radius * x, radius * y)
    };
    let ring = |z: f64| (0..10).map(move |i| (corner(i), z)).map(|((x, y), z)| format!("v {x} {y} {z}\n"));
    let mut text: String = ring(0.0).chain(ring(0.1)).collect();
    text += "f 10 9 8 7 6 5 4 3 2 1\nf 11 12 13 14 15 16 17 18 19 20\n";
    (1..=10).for_each(|i| text += &format!("f {} {} {} {}\n", i, i % 10 + 1, i % 10 + 11, i + 10));
    let area = 5.0 * 0.2 * 0.08 * (PI / 5.0).sin();
    plain("obj", text.as_bytes(), 0.1 * area);
    // A point in a bay of the star is outside.
    let (mesh, _) = read_as("obj", text.as_bytes(), &options(Completion::default())).unwrap();
    let bay = Vector::from([0.12 * (PI / 5.0).cos(), 0.12 * (PI / 5.0).sin(), 0.05]);
    assert!(mesh.distance_and_normal(&bay).0 > 0.01);
}

#[test]
fn inverted_facets_are_reversed_unless_they_bound_a_hollow() {
    let reverse = |f: &[[f64; 3]; 3]| [f[1], f[0], f[2]];
    let all: Vec<_> = hull().iter().map(reverse).collect();
    assert_parts(&plain("stl", solid("a", &all).as_bytes(), 0.008), &["inside out"]);
    let mut some = hull();
    some[2..5].iter_mut().for_each(|f| *f = reverse(f));
    assert_parts(&plain("stl", solid("a", &some).as_bytes(), 0.008), &["3 of 12 facets are inverted"]);
    let inner = facets([-0.1, -0.05, -0.025], [0.1, 0.05, 0.025]);
    let inward: Vec<_> = inner.iter().map(reverse).collect();
    let hollow = |outer: &[[[f64; 3]; 3]], inner: &[[[f64; 3]; 3]]| solid("a", &[outer, inner].concat());
    // 0.008 less 0.001 m³.
    assert_eq!(plain("stl", hollow(&hull(), &inward).as_bytes(), 0.007), "");
    assert_parts(&plain("stl", hollow(&all, &inner).as_bytes(), 0.007), &["inside out"]);
    assert_parts(&refusal("stl", hollow(&hull(), &inner).as_bytes(), Completion::default()), &["count twice"]);
    let mut mixed = inward;
    mixed[3] = inner[3];
    assert_parts(&refusal("stl", hollow(&hull(), &mixed).as_bytes(), Completion::default()), &["both orientations"]);
}

#[test]
fn parts_that_overlap_are_refused_however_flush_they_are() {
    let first = ([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05]);
    let both = |min: [f64; 3], max: [f64; 3]| obj(&[block(first.0, first.1), block(min, max)]);
    let refused = |min: [f64; 3], max: [f64; 3]| {
        let message = refusal("obj", both(min, max).as_bytes(), Completion::default());
        assert_parts(&message, &["boolean union"]);
        message
    };
    // Flush on four sides; counted separately they would have 0.016 m³, together they fill 0.012 m³.
    assert_parts(&refused([0.0, -0.1, -0.05], [0.4, 0.1, 0.05]), &["share volume", "cover the same area"]);
    // Sides 1e-5 m apart: crossings are 1e-5 m deep at the rim, but the parts share half of their volume.
    refused([0.0, -0.100_01, -0.050_01], [0.4, 0.100_01, 0.050_01]);
    refused([0.0, -0.05, -0.05], [0.4, 0.05, 0.05]);
    refused([0.0, -0.05, -0.02], [0.4, 0.05, 0.02]);
    // Parts that touch do not overlap.
    plain("obj", both([0.2, -0.05, -0.05], [0.4, 0.05, 0.05]).as_bytes(), 0.010);
}

#[test]
fn shallow_crossings_are_tolerated_and_told() {
    // The second part enters the first by 1e-5 m: below 1e-3 dp = 2e-5 m and 1e-4 of 0.6 m.
    let part = |depth: f64| {
        obj(&[block([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05]), block([0.2 - depth, -0.05, -0.02], [0.4, 0.05, 0.02])])
    };
    let notes = assert_volume("obj", part(1e-5).as_bytes(), Completion::default(), 0.0088, 1e-4);
    assert_parts(&notes, &["passes through itself at", "1.0e-5 m at most", "tolerated"]);
    assert_parts(
        &refusal("obj", part(1e-4).as_bytes(), Completion::default()),
        &["by 1.0e-4 m at most", "2.0e-5 m is tolerated"],
    );
    // A whole end face lies in the other part: beside others inside its face, and over all of it.
    for (min, max, volume) in
        [([-0.05, -0.02], [0.05, 0.02], 0.0088), ([-0.1, -0.05], [0.1, 0.05], 0.012), ([-0.2, -0.1], [0.2, 0.1], 0.024)]
    {
        for depth in [2e-6, 1e-5, 1.9e-5] {
            let second = block([0.2 - depth, min[0], min[1]], [0.4, max[0], max[1]]);
            let both = obj(&[block([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05]), second]);
            assert_volume("obj", both.as_bytes(), Completion::default(), volume, 2e-4);
        }
    }
}

#[test]
fn double_sided_meshes_are_named() {
    let reversed = |facets: &[[[f64; 3]; 3]]| facets.iter().map(|&[a, b, c]| [c, b, a]).collect::<Vec<_>>();
    let open = &hull()[..10];
    for facets in [&hull()[..], open] {
        let both = solid("both", &[facets, &reversed(facets)[..]].concat());
        for thickness in [None, Some(0.01)] {
            let completion = Completion { thickness, ..Completion::default() };
            assert_parts(&refusal("stl", both.as_bytes(), completion), &["double-sided", "export one side"]);
        }
    }
    // The diagonals of reversed quads differ.
    let (points, sides) = block([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05]);
    let back = sides.iter().map(|&[a, b, c, d]| [d, c, b, a]).collect();
    let both = obj(&[(points.clone(), sides), (points, back)]);
    assert_parts(&refusal("obj", both.as_bytes(), Completion::default()), &["double-sided"]);
}

#[test]
fn facets_without_area_and_corners_on_edges_are_named() {
    let [a, b, _] = hull()[0];
    let middle = [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]));
    let surplus = solid("surplus", &[&hull()[..], &[[a, b, middle], [a, a, b]]].concat());
    assert_parts(&plain("stl", surplus.as_bytes(), 0.008), &["1 facet without area is removed"]);
    // The sides x = 0.2 and y = 0.1 meet on the edge from (0.2, 0.1, −0.05) to (0.2, 0.1, 0.05); one side has a corner in its middle.
    let (mut points, sides) = block([-0.2, -0.1, -0.05], [0.2, 0.1, 0.05]);
    points.push([0.2, 0.1, 0.0]);
    let others: Vec<_> = sides.into_iter().filter(|side| *side != [1, 3, 7, 5]).collect();
    let text = obj(&[(points, others)]) + "f 2 4 9\nf 2 9 6\nf 9 8 6\n";
    let message = refusal("obj", text.as_bytes(), Completion::default());
    assert_parts(&message, &["the mesh is open", "(0.2000, 0.1000, 0.0000) m lies on the edge of another facet"]);
    assert!(!message.contains("cap ="), "{message}");
}

/// A boat of 0.4 × 0.2 × 0.1 m without its deck and without its side at y = 0.
fn half_boat() -> Vec<[[f64; 3]; 3]> {
    let all = facets([-0.2, 0.0, -0.1], [0.2, 0.1, 0.0]);
    let in_plane = |f: &[[f64; 3]; 3], axis: usize| f.iter().all(|p| p[axis] == 0.0);
    all.into_iter().filter(|f| !in_plane(f, 1) && !in_plane(f, 2)).collect()
}

#[test]
fn half_a_hull_without_deck_becomes_a_hull() {
    let both = Completion { mirror: [false, true, false], cap: Some(2), ..Completion::default() };
    let text = solid("half", &half_boat());
    assert_eq!(assert_volume("stl", text.as_bytes(), both, 0.008, 1e-14), "");
    // A centre line 1e-5 m from the plane is moved into it.
    let off = text.replace(" 0 ", " 0.00001 ");
    let notes = assert_volume("stl", off.as_bytes(), both, 0.008, 1e-14);
    assert_parts(&notes, &["moved into the plane y = 0, by 1.0e-5 m"]);
    // A closed half has a wall in the plane, which disappears.
    let closed = solid("half", &facets([-0.2, 0.0, -0.1], [0.2, 0.1, 0.0]));
    assert_volume(
        "stl",
        closed.as_bytes(),
        Completion { mirror: [false, true, false], ..Completion::default() },
        0.008,
        1e-14,
    );
    let mirror = Completion { mirror: [false, true, false], ..Completion::default() };
    assert_parts(&refusal("stl", text.as_bytes(), mirror), &["the mesh is open", "cap = \"z\""]);
    assert_parts(&refusal("stl", solid("a", &hull()).as_bytes(), mirror), &["reaches from y = -0.1000 to 0.1000"]);
    let away = text.replace(" 0 ", " 0.01 ");
    assert_parts(&refusal("stl", away.as_bytes(), mirror), &["1.000e-2 m from the plane y = 0"]);
    let cap_x = Completion { mirror: [false, true, false], cap: Some(0), ..Completion::default() };
    assert_parts(&refusal("stl", text.as_bytes(), cap_x), &["reaches from x = -0.2000 to 0.2000"]);
}

#[test]
fn a_quarter_of_a_hull_becomes_a_hull() {
    // 0.4 × 0.2 × 0.1 m: the part at x > 0 and y > 0, without deck and without its sides in the planes of symmetry.
    let all = facets([0.0, 0.0, -0.1], [0.2, 0.1, 0.0]);
    let in_plane = |f: &[[f64; 3]; 3]| (0..3).any(|axis| f.iter().all(|p| p[axis] == 0.0));
    let open: Vec<_> = all.iter().copied().filter(|f| !in_plane(f)).collect();
    let quarter = Completion { mirror: [true, true, false], cap: Some(2), ..Completion::default() };
    assert_eq!(assert_volume("stl", solid("quarter", &open).as_bytes(), quarter, 0.008, 1e-14), "");
    // A closed quarter has walls in both planes, which disappear.
    let closed = Completion { cap: None, ..quarter };
    assert_volume("stl", solid("quarter", &all).as_bytes(), closed, 0.008, 1e-14);
    // An eighth, by three planes.
    let eighth = Completion { mirror: [true; 3], ..Completion::default() };
    assert_volume("stl", solid("eighth", &open).as_bytes(), eighth, 0.016, 1e-14);
    // One plane leaves the edges in the other open.
    let half = Completion { mirror: [true, false, false], ..quarter };
    assert_parts(
        &refusal("stl", solid("quarter", &open).as_bytes(), half),
        &["cap = \"z\" closes open edges in a plane"],
    );
}

#[test]
fn a_cap_leaves_the_inside_of_a_ring_open() {
    // Panels of a square ring, 0.4 m outside and 0.2 m inside, 0.1 m deep: bottom and walls, no top.
    let ring = |half: f64, z: f64| [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]];
    let (outer, inner) = ([ring(0.2, -0.1), ring(0.2, 0.0)], [ring(0.1, -0.1), ring(0.1, 0.0)]);
    let mut panels = Vec::new();
    for (i, j) in (0..4).map(|i| (i, (i + 1) % 4)) {
        let quads = [
            [outer[0][i], outer[0][j], outer[1][j], outer[1][i]],
            [inner[0][j], inner[0][i], inner[1][i], inner[1][j]],
            [outer[0][j], outer[0][i], inner[0][i], inner[0][j]],
        ];
        panels.extend(quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]));
    }
    let cap = Completion { cap: Some(2), ..Completion::default() };
    // (0.16 − 0.04) m² × 0.1 m.
    assert_volume("stl", solid("ring", &panels).as_bytes(), cap, 0.012, 1e-14);
    assert_parts(&assert_volume("stl", solid("a", &hull()).as_bytes(), cap, 0.008, 1e-14), &["has no open edge"]);
}

#[test]
fn a_sheet_becomes_a_plate_of_its_thickness() {
    let plate = |thickness: f64| Completion { thickness: Some(thickness), ..Completion::default() };
    let sheet = "v 0 0 0\nv 0.5 0 0\nv 0.5 0.3 0\nv 0 0.3 0\nf 1 2 3 4\n";
    // 0.15 m² × 0.01 m.
    assert_volume("obj", sheet.as_bytes(), plate(0.01), 0.0015, 1e-13);
    // An angle of two sheets: each side of the plate is offset by half the thickness, so the middle line counts.
    let angle = "v 0 0 0\nv 0.5 0 0\nv 0.5 0.3 0\nv 0 0.3 0\nv 0 0 0.2\nv 0 0.3 0.2\nf 1 2 3 4\nf 1 4 6 5\n";
    assert_volume("obj", angle.as_bytes(), plate(0.01), 0.7 * 0.3 * 0.01, 1e-12);
    // A closed surface becomes a hollow: 0.41 × 0.21 × 0.11 less 0.39 × 0.19 × 0.09 m³.
    let hollow = 0.41 * 0.21 * 0.11 - 0.39 * 0.19 * 0.09;
    let notes = assert_volume("stl", solid("a", &hull()).as_bytes(), plate(0.01), hollow, 1e-12);
    assert_parts(&notes, &["the mesh is closed: thickness = 0.01", "hollow shell", "8.000e-3 m³"]);
    let message = refusal("stl", solid("a", &hull()).as_bytes(), plate(20.0));
    assert_parts(
        &message,
        &["thickness = 20 makes a plate thicker than the mesh is large, 0.4000 m", "thickness is in m"],
    );
    let message = refusal("stl", solid("a", &hull()[..10]).as_bytes(), plate(0.15));
    assert_parts(&message, &["thickness = 0.15 is in m, and the mesh is 0.4000 m large"]);
    assert_parts(&refusal("obj", sheet.as_bytes(), Completion::default()), &["the mesh is open", "thickness = 0.01"]);
    assert_parts(&refusal("obj", angle.as_bytes(), Completion::default()), &["thickness = 0.01"]);
}

#[test]
fn parts_that_touch_have_the_surface_of_their_union() {
    // Two halves of a box of 0.5 × 0.4 × 0.4 m, whose quads share the plane x = 0 with other diagonals; apart by 1 nm; overlapping
    // by 1 nm. 0.08 m³; the outer surface is 2 (0.4 × 0.4) + 4 (0.5 × 0.4) = 1.12 m².
    let whole = Shape::Box { size: Vector::from([0.5, 0.4, 0.4]) };
    for shift in [0.0, 1e-9, -1e-9] {
        let turned = |(points, sides): Quads| (points, sides.into_iter().map(|[a, b, c, d]| [b, c, d, a]).collect());
        let halves =
            [block([-0.25, -0.2, -0.2], [0.0, 0.2, 0.2]), turned(block([shift, -0.2, -0.2], [0.25, 0.2, 0.2]))];
        let (mesh, notes) = read_as("obj", obj(&halves).as_bytes(), &options(Completion::default())).unwrap();
        assert!(notes.iter().any(|note| note.what.contains("back to back")), "{notes:?}");
        assert!((mesh.surface_area() - 1.12).abs() < 1e-8, "{} m²", mesh.surface_area());
        assert_same_distances(mesh, &whole);
    }
}

#[test]
fn a_part_that_touches_a_part_of_a_face_hides_it() {
    // A keel of 0.1 × 0.2 m below a box of 0.5 × 0.2 m, 0.4 m long: as a polygon of the same section, midway along it. The
    // distance to the ends is 0.2 m or more than the nearest side's.
    let parts = [block([-0.25, -0.2, 0.0], [0.25, 0.2, 0.2]), block([-0.03, -0.2, -0.2], [0.07, 0.2, 0.0])];
    let (mesh, _) = read_as("obj", obj(&parts).as_bytes(), &options(Completion::default())).unwrap();
    // Ends: 2 (0.1 + 0.02); perimeter of the section: 2 (0.5 + 0.4).
    assert!((mesh.surface_area() - (0.24 + 1.8 * 0.4)).abs() < 1e-12, "{} m²", mesh.surface_area());
    let outline =
        [[-0.25, 0.0], [-0.03, 0.0], [-0.03, -0.2], [0.07, -0.2], [0.07, 0.0], [0.25, 0.0], [0.25, 0.2], [-0.25, 0.2]];
    let section = Shape::<2>::Polygon { points: outline.map(Vector::from).to_vec() };
    for i in 0..60 {
        for j in 0..60 {
            let (x, z) = (0.01 * f64::from(i) - 0.2951, 0.01 * f64::from(j) - 0.2951);
            let exact = section.signed_distance(&Vector::from([x, z]));
            let (found, _) = mesh.distance_and_normal(&Vector::from([x, 0.0, z]));
            assert!((found - exact).abs() < 1e-12, "{found}, not {exact} m, at {x}, {z}");
        }
    }
}

/// Asserts that a mesh has the distances, normals and particles of `whole` to within 2 nm.
fn assert_same_distances(mesh: Mesh, whole: &Shape<3>) {
    let drawn = Shape::Mesh { mesh: Arc::new(mesh), contact: ContactGeometry::default() };
    for i in 0..14_i32 {
        for j in 0..14_i32 {
            for x in [-0.31, -0.13, -0.011, -1e-7, 0.0, 1e-7, 0.004, 0.17, 0.26] {
                let x = Vector::from([x, 0.047 * f64::from(i) - 0.3, 0.047 * f64::from(j) - 0.3]);
                let (found, exact) = (drawn.signed_distance(&x), whole.signed_distance(&x));
                assert!((found - exact).abs() < 2e-9, "{found}, not {exact} m, at {x:?}");
            }
        }
    }
    let dp = 0.05;
    let count = |shape: &Shape<3>| shape.boundary_points(dp, 3).len() as f64;
    // Filled: 10 × 8 × 8 cells but 4 × 2 × 2 in the middle.
    assert!((count(&drawn) / count(whole) - 1.0).abs() < 0.01, "{} particles, not {}", count(&drawn), count(whole));
}
