//! Drawings as programs write them: exact sizes, transforms, hidden paths and references.

use std::{
    f64::consts::PI,
    fs,
    sync::atomic::{AtomicUsize, Ordering},
};

use super::*;

/// Largest distance of an outline from its curves, m.
const TOLERANCE: f64 = 1e-4;

/// Writes a drawing and returns its outline (m), and the notes about it.
fn outline_of(svg: &str, id: Option<&str>, unit: Option<LengthUnit>) -> Result<(Vec<[f64; 2]>, Vec<FileNote>)> {
    static NUMBER: AtomicUsize = AtomicUsize::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let path = std::env::temp_dir().join(format!("pontoon-svg-{}-{number}.svg", std::process::id()));
    fs::write(&path, svg).unwrap();
    let result = outline(&path, &DrawingOptions { id, scale: 1.0, unit, tolerance: TOLERANCE });
    fs::remove_file(&path).unwrap();
    result
}

/// Returns the extent (m) of the outline in a drawing along x and y, and the notes.
fn extent(svg: &str, id: Option<&str>, unit: Option<LengthUnit>) -> Result<([f64; 2], String)> {
    let (points, notes) = outline_of(svg, id, unit)?;
    let range = |i: usize| {
        let values = || points.iter().map(|p| p[i]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    Ok(([range(0), range(1)], notes.into_iter().map(|note| note.what).collect::<Vec<_>>().join("; ")))
}

/// Asserts an extent of 200 × 100 mm, and returns the notes.
fn assert_200_by_100(svg: &str, id: Option<&str>, unit: Option<LengthUnit>) -> String {
    let ([x, y], notes) = extent(svg, id, unit).unwrap_or_else(|e| panic!("{e}: {svg}"));
    // Numbers in the drawings have six digits.
    assert!((x - 0.2).abs() < 1e-6 && (y - 0.1).abs() < 1e-6, "{x} × {y} m: {svg}");
    notes
}

fn refusal(svg: &str, id: Option<&str>) -> String {
    extent(svg, id, None).err().map(|e| e.to_string()).unwrap_or_default()
}

/// A rectangle of 200 × 100 units.
const RECTANGLE: &str = "<path id='hull' d='M 10,10 h 200 v 100 h -200 z'/>";

fn drawing(attributes: &str, content: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' {attributes}>{content}</svg>"
    )
}

#[test]
fn a_drawing_with_units_has_its_own_size() {
    let mm = Some(LengthUnit::Mm);
    let path = |x: f64, y: f64| format!("<path d='M 0,0 h {x} v {y} h -{x} z'/>");
    let cases = [
        ("width='540mm' height='120mm' viewBox='0 0 540 120'", 200.0, 100.0),
        ("width='54cm' height='12cm' viewBox='0 0 540 120'", 200.0, 100.0),
        ("width='601.51996mm' height='473.16891mm' viewBox='0 0 2273.4613 1788.355'", 755.906, 377.953),
        ("width='10in' height='5in' viewBox='0 0 1000 500'", 787.4016, 393.7008),
        // 96 px, 72 pt and 6 pc are an inch.
        ("width='1000px' height='500px' viewBox='0 0 1000 500'", 755.9055, 377.9528),
        ("width='720pt' viewBox='0 0 720 500'", 566.9291, 283.4646),
        ("height='60pc' viewBox='0 0 600 600'", 472.4409, 236.2205),
        ("width='54CM' height='120Mm' viewBox='0 0 540 120'", 200.0, 100.0),
        // Without a viewBox the unit is the px.
        ("width='300mm' height='200mm'", 755.9055, 377.9528),
        // The smaller of both scales holds, unless the aspect ratio is free.
        ("width='540mm' height='240mm' viewBox='0 0 540 120'", 200.0, 100.0),
        ("width='540mm' height='240mm' viewBox='0 0 540 120' preserveAspectRatio='none'", 200.0, 50.0),
        ("width='540mm' height='240mm' viewBox='0 0 540 120' preserveAspectRatio='xMidYMid slice'", 100.0, 50.0),
    ];
    for (attributes, x, y) in cases {
        let svg = drawing(attributes, &path(x, y));
        let (with, without) = (assert_200_by_100(&svg, None, mm), assert_200_by_100(&svg, None, None));
        let agrees = x == 200.0 && y == 100.0;
        assert_eq!(with.is_empty(), agrees, "{with}");
        assert!(without.contains("the drawing gives its size"), "{without}");
    }
}

#[test]
fn unit_is_the_size_of_a_drawing_without_its_own() {
    for attributes in [
        "",
        "viewBox='0 0 540 120'",
        "width='540' height='120' viewBox='0 0 540 120'",
        "width='100%' viewBox='0 0 9 9'",
    ] {
        let svg = drawing(attributes, RECTANGLE);
        assert_eq!(assert_200_by_100(&svg, None, Some(LengthUnit::Mm)), "");
        let ([x, _], notes) = extent(&svg, None, None).unwrap();
        assert!((x - 200.0).abs() < 1e-9 && notes.contains("does not give its size"), "{x}: {notes}");
    }
    assert!(refusal(&drawing("width='wide'", RECTANGLE), None).contains("\"wide\" is not a length"));
    assert!(refusal(&drawing("width='5mm' viewBox='0 0 0 0'", RECTANGLE), None).contains("viewBox"));
}

#[test]
fn transforms_of_styles_and_attributes_apply() {
    let size = "width='540mm' height='120mm' viewBox='0 0 540 120'";
    let half = "d='M 50,60 h 100 v 50 h -100 z'";
    let upright = "d='M 50,60 h 50 v 100 h -50 z'";
    for (style, d) in [
        ("style='transform:translate(10px,5px) scale(2)'", half),
        ("style='fill:red; transform : scale( 200% ) !important'", half),
        ("style='transform:scaleX(2) scaleY(2)'", half),
        ("style='transform:matrix(2,0,0,2,10,5)'", half),
        ("style='transform:scale(2) rotate(90deg)'", upright),
        ("style='transform:rotate(0.25turn) scale(2) /* twice */'", upright),
        ("style='transform:rotate(1.5707963267948966rad) scale(2,2); transform-origin: 3px 4px'", upright),
        ("transform='scale(2)'", half),
        ("transform='scale(2) rotate(90 7 8)'", upright),
        // The style takes precedence.
        ("transform='scale(7)' style='transform:scale(2)'", half),
        ("class='big other'", half),
    ] {
        let sheet = "<style>/* sizes */ .st0{fill:none} path.big, #none { transform: scale(2) }</style>";
        let svg = drawing(size, &format!("{sheet}<path {style} {d}/>"));
        assert_eq!(assert_200_by_100(&svg, None, Some(LengthUnit::Mm)), "");
        let group = drawing(size, &format!("{sheet}<g {style}><path {d}/></g>").replace("path.big", "g.big"));
        assert_200_by_100(&group, None, None);
    }
    for style in [
        "transform:scale3d(2,2,2)",
        "transform:translate(10%)",
        "scale:2",
        "transform:scale(2);transform-origin:center",
    ] {
        let message = refusal(&drawing(size, &format!("<path style='{style}' {half}/>")), None);
        assert!(message.contains("is not read"), "{style}: {message}");
        // A path beside it can be chosen.
        let two = drawing(size, &format!("<path style='{style}' {half}/>{RECTANGLE}"));
        assert_200_by_100(&two, Some("hull"), None);
    }
    let sheet = "<style>g > path { transform: scale(2) }</style>";
    assert!(refusal(&drawing(size, &format!("{sheet}{RECTANGLE}")), None).contains("\"g > path\", which is not read"));
    // Rules under a condition.
    for rule in ["path { transform: scale(.5) }", ".a { fill: red } .b { display: none }"] {
        let message = refusal(&drawing(size, &format!("<style>@media all {{ {rule} }}</style>{RECTANGLE}")), None);
        assert!(message.contains("\"@media all\", which is not read"), "{rule}: {message}");
    }
    let sheet = "<style>@media print { path { fill: none } } path.big { transform: scale(2) }</style>";
    assert_200_by_100(&drawing(size, &format!("{sheet}<path class='big' {half}/>")), None, None);
}

/// A start without a line and a second "close" draw nothing: exporters leave them behind. A line after "close" is a second outline.
#[test]
fn parts_of_a_path_that_draw_nothing_are_no_outline() {
    for rest in ["", " z", " M 3,3", " m 0,0 z", " Z M 5,5 m 1,1"] {
        let path = format!("<path d='M 10,10 h 200 v 100 h -200 z{rest}'/>");
        assert_200_by_100(&drawing("", &path), None, Some(LengthUnit::Mm));
    }
    for (d, word) in [
        ("M 0,0 h 200 v 100 z l 5,5 h 3 z", "it has 2 outlines"),
        ("M 0,0 h 200 v 100 h -200 z m 10,10 h 9 v 9 z", "it has 2 outlines"),
        ("M 0,0 h 200 v 100", "it is not closed"),
        ("M 3,3", "it draws no line"),
        ("M 3,3 z", "it draws no line"),
    ] {
        let refused = refusal(&drawing("", &format!("<path d='{d}'/>")), None);
        assert!(refused.contains(word), "{d}: {refused}");
    }
}

/// The weaker of two declarations applies if it is marked as important.
#[test]
fn important_declarations_take_precedence() {
    let size = "width='540mm' height='120mm' viewBox='0 0 540 120'";
    let half = "d='M 50,60 h 100 v 50 h -100 z'";
    for (sheet, attributes) in [
        ("path { transform: scale(2) !important }", format!("style='transform:scale(7)' {half}")),
        (".a { transform: scale(2) ! important } #p { transform: scale(7) }", format!("id='p' class='a' {half}")),
        ("path { transform: scale(7) !important }", format!("style='transform:scale(2) !important' {half}")),
        ("path { transform: scale(2) !IMPORTANT }", format!("transform='scale(7)' {half}")),
    ] {
        let svg = drawing(size, &format!("<style>{sheet}</style><path {attributes}/>"));
        assert_200_by_100(&svg, None, None);
    }
    let hidden =
        "<style>.a { display: none !important }</style><path class='a' style='display:inline' d='M 0,0 h 1 v 1 z'/>";
    assert_200_by_100(&drawing(size, &format!("{hidden}{RECTANGLE}")), None, None);
}

/// The origin of a transform is a corner of the shape's own box if `transform-box` says so. Without a turn or a factor, it has no effect.
#[test]
fn a_transform_about_the_box_of_a_shape_is_refused() {
    let half = "d='M 50,60 h 100 v 50 h -100 z'";
    let with = |style: &str| drawing("", &format!("<path style='{style}' {half}/>"));
    let refused = refusal(&with("transform-box: fill-box; transform: scale(2)"), None);
    assert!(refused.contains("transform-box \"fill-box\" is not read"), "{refused}");
    assert_200_by_100(&with("transform-box: view-box; transform: scale(2)"), None, Some(LengthUnit::Mm));
    let moved =
        drawing("", &RECTANGLE.replace(" d=", " style='transform-box: fill-box; transform: translate(5px)' d="));
    assert_200_by_100(&moved, None, Some(LengthUnit::Mm));
}

#[test]
fn an_unknown_id_proposes_the_nearest_one() {
    let svg = drawing("width='540mm' height='120mm' viewBox='0 0 540 120'", RECTANGLE);
    assert!(refusal(&svg, Some("Hull")).contains("with the id \"Hull\"; did you mean \"hull\"?"));
}

#[test]
fn hidden_paths_and_definitions_do_not_count() {
    let size = "width='540mm' height='120mm' viewBox='0 0 540 120'";
    let other = "<path id='other' d='M 0,0 h 1 v 1 z'/>";
    for hidden in [
        other.replace("/>", " display='none'/>"),
        other.replace("/>", " style='fill:none;display:none'/>"),
        other.replace("/>", " visibility='hidden'/>"),
        format!("<g style='display:none'><g style='display:inline'>{other}</g></g>"),
        format!("<g visibility='hidden'>{other}</g>"),
        format!("<style>.off{{display:none}}</style><g class='off'>{other}</g>"),
        format!("<defs>{other}</defs>"),
        format!("<clipPath id='c'>{other}</clipPath>"),
        format!("<symbol id='s'>{other}</symbol>"),
        format!("<mask id='m'>{other}</mask>"),
    ] {
        assert_200_by_100(&drawing(size, &format!("{hidden}{RECTANGLE}")), None, None);
        let message = refusal(&drawing(size, &format!("{hidden}{RECTANGLE}")), Some("other"));
        assert!(message.contains("is hidden, a definition"), "{message}");
    }
    // A visible path in a hidden group.
    let shown = format!("<g visibility='hidden'>{}</g>", RECTANGLE.replace("/>", " visibility='visible'/>"));
    assert_200_by_100(&drawing(size, &shown), None, None);
}

#[test]
fn references_draw_the_path_to_which_they_refer() {
    let size = "width='540mm' height='120mm' viewBox='0 0 540 120'";
    let half = "<defs><path id='hull' d='M 10,10 h 100 v 50 h -100 z'/></defs>";
    for svg in [
        format!("{half}<use id='copy' xlink:href='#hull' x='5' transform='scale(2)'/>"),
        format!("{half}<use id='copy' href='#hull' style='transform:scale(2)'/>"),
        format!("{half}<use id='copy' href='#hull' x='3mm' y='10px' style='transform:scale(2)'/>"),
        format!("<symbol id='s'>{half}</symbol><g transform='scale(2)'><use id='copy' href='#hull'/></g>"),
        format!("{half}<symbol id='s'><use href='#hull'/></symbol><use id='copy' href='#s' transform='scale(2)'/>"),
    ] {
        for id in [None, Some("hull"), Some("copy")] {
            assert_200_by_100(&drawing(size, &svg), id, None);
        }
    }
    assert!(refusal(&drawing(size, "<use href='#hul'/>"), None).contains("refers to \"hul\""));
    assert!(refusal(&drawing(size, "<use href='other.svg#a'/>"), None).contains("which is not in this drawing"));
    // References in a circle and groups without end are refused.
    let circle = "<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>";
    assert!(refusal(&drawing(size, circle), None).contains("too many or too deep"));
    let deep = "<g>".repeat(5000) + RECTANGLE + &"</g>".repeat(5000);
    assert!(refusal(&drawing(size, &deep), None).contains("too deep"));
    let nested = format!("<svg x='1' width='10' viewBox='0 0 1 1'>{RECTANGLE}</svg>");
    assert!(refusal(&drawing(size, &nested), None).contains("a <svg> with its own size"));
}

#[test]
fn basic_shapes_are_outlines_of_their_exact_size() {
    let size = "width='540mm' height='120mm' viewBox='0 0 540 120'";
    let (rectangle, ellipse) = (0.2 * 0.1, PI * 0.1 * 0.05);
    // Quarters of ellipses of 20 × 10 mm at the corners.
    let rounded = rectangle - (4.0 - PI) * 0.02 * 0.01;
    for (shape, area) in [
        ("<polyline points='10,10 210,10 210,110 10,110 10,10'/>", rectangle),
        ("<rect x='10' y='10' width='200' height='100'/>", rectangle),
        ("<rect style='width: 200px; height: 100px' rx='0' ry='5'/>", rectangle),
        ("<style>.hull { width: 200px }</style><rect class='hull' width='1' height='100'/>", rectangle),
        ("<rect width='200' height='100' rx='20' ry='10'/>", rounded),
        ("<rect width='100' height='100' transform='scale(2 1)' rx='10'/>", rounded),
        ("<rect width='200' height='100' rx='900' ry='900'/>", ellipse),
        ("<ellipse cx='120' cy='60' rx='100' ry='50'/>", ellipse),
        ("<circle cx='5' r='50' transform='scale(2 1)'/>", ellipse),
        ("<defs><ellipse id='hull' rx='100' ry='50'/></defs><use href='#hull' x='150'/>", ellipse),
    ] {
        let svg = drawing(size, shape);
        let ([x, y], _) = extent(&svg, None, None).unwrap_or_else(|e| panic!("{e}: {svg}"));
        // Chords end on the curve and leave it by the tolerance at most; the curve is accurate to 10⁻⁶ of the radius.
        assert!((0.2 - 2.0 * TOLERANCE..0.2 + 1e-6).contains(&x), "{x} m: {svg}");
        assert!((0.1 - 2.0 * TOLERANCE..0.1 + 1e-6).contains(&y), "{y} m: {svg}");
        let (points, _) = outline_of(&svg, None, None).unwrap();
        let pairs = points.iter().zip(points.iter().cycle().skip(1));
        let found = 0.5 * pairs.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>();
        // The perimeter is at most 0.6 m.
        assert!((found - area).abs() < 0.6 * TOLERANCE, "{found} m², not {area}: {svg}");
        assert!(area == rectangle || found < area + 1e-6, "chords lie within: {svg}");
    }
}

#[test]
fn files_of_another_kind_are_named() {
    assert!(refusal("version https://git-lfs.github.com/spec/v1\n", None).contains("git-LFS pointer"));
    assert!(refusal("<!doctype html><html></html>", None).contains("a web page"));
    assert!(refusal("<html><svg/></html>", None).contains("a web page"));
    assert!(refusal("\u{1f}\u{8b}", None).contains("SVG"));
    let marked = format!("\u{feff}{}", drawing("", RECTANGLE));
    assert_200_by_100(&marked, None, Some(LengthUnit::Mm));
}

#[test]
fn points_that_are_not_pairs_of_numbers_are_refused() {
    let shape = |name: &str, points: &str| drawing("", &format!("<{name} points='{points}'/>"));
    // 200 × 100 units of 1 mm; commas, spaces and signs separate.
    for points in [
        "0,0 200,0 200,100 0,100",
        " 0 0,200,0 200 100 0 100 ",
        "-100-50 100-50 100,50-100,50",
        "0,0,2e2,0\n2e2,1e2\t0,1e2",
    ] {
        assert_200_by_100(&shape("polygon", points), None, Some(LengthUnit::Mm));
    }
    for name in ["polygon", "polyline"] {
        let odd = refusal(&shape(name, "0,0 200,0 200,100 0,100 0"), None);
        assert!(odd.contains(&format!("<{name}> are 9 numbers, an x without a y")), "{odd}");
        for points in ["0,0 200,0 200,100 0,100 junk", "0,0 200,0 200,100 0,1oo 0,0", "0,0 200,0 200;100 0,100"] {
            let junk = refusal(&shape(name, points), None);
            assert!(
                junk.contains(&format!("the points of its <{name}> have one that cannot be read")),
                "{points}: {junk}"
            );
        }
    }
}

#[test]
fn outlines_that_are_clipped_or_masked_are_refused() {
    let definitions =
        "<clipPath id='c'><rect width='10' height='10'/></clipPath><mask id='m'><rect width='10' height='10'/></mask>";
    let with = |content: &str| drawing("", &format!("{definitions}{content}"));
    let cut = RECTANGLE.replacen("id='hull'", "id='hull' clip-path='url(#c)'", 1);
    let masked = RECTANGLE.replacen("id='hull'", "id='hull' style='mask: url(#m)'", 1);
    for (content, word) in [
        (cut.clone(), "clip-path"),
        (masked, "mask"),
        (format!("<g clip-path='url(#c)'>{RECTANGLE}</g>"), "clip-path"),
        (format!("<defs>{RECTANGLE}</defs><use href='#hull' mask='url(#m)'/>"), "mask"),
    ] {
        let refused = refusal(&with(&content), None);
        assert!(refused.contains(word) && refused.contains("is not applied"), "{content}: {refused}");
    }
    // One that is not chosen, and the value "none".
    let other = format!("{cut}<path id='own' d='M 10,10 h 200 v 100 h -200 z' clip-path='none'/>");
    assert_200_by_100(&with(&other), Some("own"), Some(LengthUnit::Mm));
}

#[test]
fn arcs_follow_their_ellipse_whatever_the_unit_of_the_drawing() {
    // A disc of 0.5 m in units of 1 m and of 0.5 m; a half disc with a square on its left.
    for (unit, data) in [
        (1.0, "M0.5 0A0.5 0.5 0 1 1-0.5 0A0.5 0.5 0 1 1 0.5 0Z"),
        (0.5, "M1 0a1 1 0 1 1-2 0a1 1 0 1 1 2 0z"),
        (0.5, "M1 0a1 1 0 0 1-1 1h-1v-1h1v-1A1 1 0 0 1 1 0z"),
    ] {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{data}'/></svg>");
        let path = std::env::temp_dir().join(format!("pontoon-arc-{}-{}.svg", std::process::id(), data.len()));
        fs::write(&path, &svg).unwrap();
        let tolerance = 1e-6;
        let result = outline(&path, &DrawingOptions { id: None, scale: unit, unit: None, tolerance });
        fs::remove_file(&path).unwrap();
        let points = result.unwrap().0;
        let off = |[x, y]: &[f64; 2]| (x.hypot(*y) - 0.5).abs();
        let on_arcs = points.iter().filter(|[x, _]| !data.contains('h') || *x > 1e-9);
        let worst = on_arcs.map(off).fold(0.0, f64::max);
        // The tolerance, and 10⁻⁶ of the radius for the curves.
        assert!(worst < 2e-6, "{worst} m: {data}");
    }
}
