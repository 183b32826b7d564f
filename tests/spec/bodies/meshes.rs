//! Mesh and SVG files of a scene: the same solid from every format, refused files, contact choices, and a floating mesh.

use std::{fs, path::Path};

use pontoon::{
    Error,
    geometry::{ContactGeometry, Mesh, Shape},
    math::Vector,
    scene::Scene,
    simulation::Simulation,
    solid::Role,
};
use proptest::prelude::*;

use crate::common::{TestFolder, run_to};

/// Corners (m) of an asymmetric wedge and its facets, with indices from 0.
const CORNERS: [[f64; 3]; 5] =
    [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.5, 0.25, 0.0], [0.0, 0.25, 0.0], [0.125, 0.125, 0.375]];
const FACETS: [[usize; 3]; 6] = [[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];

fn folder(name: &str) -> TestFolder {
    TestFolder::new(&format!("meshes-{name}"))
}

fn text_stl(facets: &[[usize; 3]]) -> String {
    let facet = |f: &[usize; 3]| {
        let corner = |i: usize| format!("vertex {} {} {}\n", CORNERS[i][0], CORNERS[i][1], CORNERS[i][2]);
        format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", f.map(corner).concat())
    };
    format!("solid a wedge\n{}endsolid\n", facets.iter().map(facet).collect::<String>())
}

fn binary_stl(facets: &[[usize; 3]], header: &str) -> Vec<u8> {
    let mut bytes = format!("{header:80}").into_bytes();
    bytes.extend((facets.len() as u32).to_le_bytes());
    for facet in facets {
        let numbers = [[0.0; 3]].into_iter().chain(facet.map(|i| CORNERS[i])).flatten();
        bytes.extend(numbers.flat_map(|x| (x as f32).to_le_bytes()).chain([0, 0]));
    }
    bytes
}

fn obj() -> String {
    let corners: String = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    // The bottom is one facet of four corners. One facet counts from the end, and one has texture and normal.
    format!("{corners}o wedge\nf 1 4 3 2\nf 1 2 5\nf 2 3 5\ng stern\nf -3 -2 -1\nvn 0 0 1\nf 4//1 1//1 5//1\n")
}

/// A 3-D scene with one floating solid of this shape.
fn scene(shape: &str, folder: &Path) -> Result<Scene, Error> {
    let text = format!(
        "dimension = 3\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 0.5] }} }}\n\
         [[solid]]\nname = \"body\"\nshape = {shape}\nat = {{ x = 0.3, y = 0.3, draft = \"equilibrium\" }}\nfree = {{ density = 500.0 }}\n"
    );
    Scene::parse(&text, folder, &[])
}

/// The shape of that solid.
fn shape(words: &str, folder: &Path) -> Result<Shape<3>, Error> {
    Ok(scene(words, folder)?.build::<3>()?.setup.solids.remove(0).shape)
}

fn mesh(words: &str, folder: &Path) -> Result<Mesh, Error> {
    match shape(&format!("{{ mesh = {{ {words} }} }}"), folder)? {
        Shape::Mesh { mesh, .. } => Ok(Mesh::clone(&mesh)),
        other => panic!("{other:?}"),
    }
}

fn refusal(words: &str, folder: &Path) -> String {
    mesh(words, folder).err().map(|e| e.to_string()).unwrap_or_default()
}

#[test]
fn text_stl_binary_stl_and_obj_define_the_same_solid() {
    let folder = folder("formats");
    fs::write(folder.join("text.stl"), text_stl(&FACETS)).unwrap();
    fs::write(folder.join("capitals.STL"), text_stl(&FACETS).to_uppercase().replace('\n', "\r\n")).unwrap();
    fs::write(folder.join("nameless.stl"), text_stl(&FACETS).replacen("solid a wedge", "solid", 1)).unwrap();
    fs::write(folder.join("binary.stl"), binary_stl(&FACETS, "made by hand")).unwrap();
    fs::write(folder.join("text_header.stl"), binary_stl(&FACETS, "solid, says the header of this binary file"))
        .unwrap();
    fs::write(folder.join("mesh.obj"), obj()).unwrap();
    let first = mesh("file = \"text.stl\"", &folder).unwrap();
    let volume = first.volume_properties();
    // A pyramid: a third of base times height, with its centroid at a quarter of the height.
    assert!((volume.volume - 0.5 * 0.25 * 0.375 / 3.0).abs() < 1e-16);
    assert!((volume.centroid - Vector::from([0.21875, 0.125, 0.09375])).norm() < 1e-15);
    for file in ["capitals.STL", "nameless.stl", "binary.stl", "text_header.stl"] {
        assert_eq!(mesh(&format!("file = \"{file}\""), &folder).unwrap(), first, "{file}");
    }
    let other = mesh("file = \"mesh.obj\"", &folder).unwrap();
    assert_eq!((other.points().len(), other.facets().len()), (5, 6));
    assert!((other.volume_properties().second_moment - volume.second_moment).norm() < 1e-15 * volume.volume);
    // Millimetres times 2000: twice the size.
    let large = mesh("file = \"text.stl\", unit = \"mm\", scale = 2000.0", &folder).unwrap();
    assert!((large.volume_properties().volume - 8.0 * volume.volume).abs() < 1e-15);
}

#[test]
fn mesh_files_without_a_closed_solid_are_refused_with_the_reason() {
    let folder = folder("refused");
    let write = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).unwrap();
    write("open.stl", text_stl(&FACETS[1..]).as_bytes());
    write("inside_out.stl", text_stl(&FACETS.map(|[a, b, c]| [b, a, c])).as_bytes());
    write("mesh.ply", b"ply");
    write("cut.stl", &binary_stl(&FACETS, "cut short")[..200]);
    write("too_many.stl", &[&binary_stl(&FACETS, "two thousand million facets")[..80], &[0xff; 4], &[0; 600]].concat());
    write("nan.stl", text_stl(&FACETS).replacen("0.375", "nan", 1).as_bytes());
    write("empty.stl", b"");
    write("line.stl", &[b"solid x\n".to_vec(), b"0 ".repeat(1 << 20)].concat());
    write("few.obj", b"v 0 0 0\nf 1 2 3\n");
    let assert_refused = |keys: &str, parts: &[&str]| {
        let message = refusal(keys, &folder);
        parts.iter().for_each(|part| assert!(message.contains(part), "no \"{part}\" in: {message}"));
    };
    assert_refused(
        "file = \"open.stl\"",
        &["the mesh is open: 3 edges", "(0.0000, 0.0000, 0.0000)", "scene.toml:8", "fill the holes"],
    );
    // A surface that is inside out has one possible inside.
    assert!(mesh("file = \"inside_out.stl\"", &folder).is_ok());
    assert!(mesh("file = \"inside_out.stl\", flip = true", &folder).is_ok());
    assert_refused("file = \"open.stl\", thickness = -0.1", &["thickness"]);
    assert_refused("file = \"open.stl\", mirror = \"w\"", &["mirror", "known: x, y, z"]);
    assert_refused("file = \"open.stl\", mirror = [\"x\", \"w\"]", &["mirror", "known: x, y, z"]);
    assert_refused("file = \"open.stl\", mirror = 1", &["mirror", "a list of axes"]);
    assert_refused("file = \"mesh.ply\"", &["neither .stl nor .obj"]);
    assert_refused("file = \"cut.stl\"", &["cut.stl cannot be read"]);
    assert_refused("file = \"too_many.stl\"", &["too_many.stl cannot be read"]);
    assert_refused("file = \"nan.stl\"", &["nan.stl cannot be read"]);
    assert_refused("file = \"empty.stl\"", &["empty.stl cannot be read"]);
    assert_refused("file = \"line.stl\"", &["line 2: \"0\" is no word of STL"]);
    assert_refused("file = \"few.obj\"", &["few.obj cannot be read"]);
    assert_refused("file = \"opn.stl\"", &["did you mean \"open.stl\"?"]);
    assert_refused("file = \"../open.stl\"", &["leads out of the scene's folder"]);
    assert_refused("file = \"open.stl\", scale = -1.0", &["scale"]);
    assert_refused("file = \"open.stl\", unit = \"furlong\"", &["furlong", "mm"]);
    let flat = "dimension = 2\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.5] } }\n\
                [[solid]]\nname = \"body\"\nfixed = true\nshape = { mesh = { file = \"open.stl\" } }\n";
    let error = Scene::parse(flat, &folder, &[]).and_then(|scene| scene.build::<2>().map(|_| ())).unwrap_err();
    assert!(error.to_string().contains("needs a 3-D scene"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_of_a_mesh_file_cause_no_panic(
        changes in prop::collection::vec((0usize..400, 0usize..20, prop::collection::vec(any::<u8>(), 0..8)), 1..4),
        kind in 0usize..3,
    ) {
        let (mut bytes, name) = match kind {
            0 => (text_stl(&FACETS).into_bytes(), "any.stl"),
            1 => (binary_stl(&FACETS, "any"), "any.stl"),
            _ => (obj().into_bytes(), "any.obj"),
        };
        for (at, length, with) in changes {
            let at = at.min(bytes.len());
            let end = (at + length).min(bytes.len());
            bytes.splice(at..end, with);
        }
        let folder = folder("any");
        fs::write(folder.join(name), bytes).unwrap();
        // The result is a mesh or an error that names the file.
        let message = refusal(&format!("file = \"{name}\""), &folder);
        prop_assert!(message.is_empty() || message.contains(name) || message.contains("dp") || message.contains("float"), "{message}");
    }
}

/// The polygon of an SVG drawing at dp 0.01, with the keys `more` after its file.
fn polygon(folder: &Path, svg: &str, more: &str) -> Result<Shape<2>, Error> {
    fs::write(folder.join("drawing.svg"), svg).unwrap();
    let text = format!(
        "dimension = 2\ndp = 0.01\nuntil = 1.0\n[[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [4.0, 0.5] }} }}\n\
         [[solid]]\nname = \"body\"\nfixed = true\nshape = {{ polygon = {{ file = \"drawing.svg\"{more} }} }}\nat = {{ x = 2.0, bottom = 0.1 }}\n"
    );
    Ok(Scene::parse(&text, folder, &[])?.build::<2>()?.setup.solids.remove(0).shape)
}

#[test]
fn the_curves_of_a_drawing_enclose_their_area_with_y_upwards() {
    let folder = folder("drawing");
    // A half disc of radius 300 mm with its round side down on the screen, drawn clockwise, in a translated and scaled layer.
    let svg = "<svg xmlns='http://www.w3.org/2000/svg'><g transform='translate(10 20) scale(2)'>\
               <path id='hull' d='M 0,0 h 300 a 150,150 0 0 1 -300,0 z'/></g></svg>";
    let shape = polygon(&folder, svg, ", unit = \"mm\"").unwrap();
    let volume = shape.volume_properties();
    let (area, exact) = (volume.volume, 0.5 * std::f64::consts::PI * 0.3 * 0.3);
    // Chords within 0.01 dp of an arc 0.94 m long lack two thirds of that area: 6e-5 m², 0.05 %.
    assert!(area < exact && area > exact - 1e-4 * 0.95, "{area} for {exact}");
    let bounds = shape.bounds();
    // Screen y from 20 to 320 is −0.020 to −0.320 m: the round side is below.
    assert!((bounds.max[1] + 0.020).abs() < 1e-12 && (bounds.min[1] + 0.320).abs() < 1e-4, "{bounds:?}");
    assert!((bounds.min[0] - 0.010).abs() < 1e-4 && (bounds.max[0] - 0.610).abs() < 1e-4, "{bounds:?}");
    assert!(volume.centroid[1] > -0.02 - 0.15, "the centroid is nearer to the flat side, which is above");
    let Shape::Polygon { points } = shape else { panic!("no polygon") };
    assert!((30..300).contains(&points.len()), "{} points", points.len());
}

#[test]
fn drawings_without_exactly_one_closed_outline_are_refused_with_the_reason() {
    let folder = folder("drawings");
    let assert_message = |svg: &str, more: &str, part: &str| {
        let message = polygon(&folder, svg, more).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(message.contains(part), "no \"{part}\" in: {message}");
    };
    let two = "<svg><path id='a' d='M0,0 L1,0 1,1 z'/><polygon id='b' points='0,0 0.5,0 0.5,0.5'/></svg>";
    assert_message(two, "", "there are 2 paths and basic shapes in this drawing: 1 <path>, 1 <polygon>");
    assert_message(two, ", id = \"c\"", "no path or basic shape with the id \"c\"");
    assert_message(two, ", id = \"b\"", "");
    assert_message("<svg><text>hull</text></svg>", "", "no path or basic shape in this drawing");
    // A frame around the hull is no reason to guess which of them is meant.
    let framed = "<svg><rect width='9' height='9'/><path id='a' d='M0,0 L1,0 1,1 z'/></svg>";
    assert_message(framed, "", "1 <path>, 1 <rect>");
    assert_message(framed, ", id = \"a\"", "");
    assert_message("<svg><line x2='1'/></svg>", "", "it is not closed");
    assert_message("<svg><polyline points='0,0 1,0 1,1'/></svg>", "", "it is not closed");
    assert_message("<svg><rect width='1'/></svg>", "", "its height is not positive");
    assert_message("<svg><rect width='1' height='1' rx='-1'/></svg>", "", "negative radius");
    assert_message("<svg><circle r='50%'/></svg>", "", "its r \"50%\" is not a number");
    assert_message("<svg><ellipse rx='0'/></svg>", "", "its radii are not positive");
    assert_message("<svg><path d='M0,0 L1,0 1,1'/></svg>", "", "it is not closed");
    assert_message("<svg><path d='M0,0 L1,0 1,1 z M2,0 L3,0 3,1 z'/></svg>", "", "it has 2 outlines");
    assert_message("<svg><path d='M0,0 L1,0 1e300,1 z'/></svg>", "", "far too large");
    assert_message("<svg><path d='nonsense'/></svg>", "", "the outline cannot be read");
    assert_message("svg", "", "this is no SVG");
    assert_message("<svg><path d='M0,0 L1,1 1,0 0,1 z'/></svg>", "", "crosses itself");
    assert_message(two, ", id = \"b\", scale = 0.0", "scale");
}

/// A ball of 20 rings of 40 points and two poles as OBJ text.
fn ball_obj(radius: f64) -> String {
    let (n, ring) = (20, 40);
    let mut text = String::new();
    for i in 1..=n {
        let (across, up) = (std::f64::consts::PI * f64::from(i) / f64::from(n + 1)).sin_cos();
        for j in 0..ring {
            let (y, x) = (std::f64::consts::TAU * f64::from(j) / f64::from(ring)).sin_cos();
            text += &format!("v {} {} {}\n", radius * across * x, radius * across * y, radius * up);
        }
    }
    text += &format!("v 0 0 {radius}\nv 0 0 -{radius}\n");
    for j in 0..ring {
        let k = (j + 1) % ring;
        text += &format!("f {} {} {}\n", n * ring + 1, j + 1, k + 1);
        text += &format!("f {} {} {}\n", n * ring + 2, (n - 1) * ring + k + 1, (n - 1) * ring + j + 1);
        for i in 0..n - 1 {
            let (a, b) = (i * ring + 1, (i + 1) * ring + 1);
            text += &format!("f {} {} {} {}\n", a + j, b + j, b + k, a + k);
        }
    }
    text
}

#[test]
fn a_mesh_ball_floats_at_the_draft_of_archimedes() {
    let folder = folder("ball");
    fs::write(folder.join("ball.obj"), ball_obj(0.12)).unwrap();
    let dp = 0.03;
    let text = format!(
        "dimension = 3\ndp = {dp}\nuntil = 0.6\n[[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.6, 0.6, 0.3] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [0.6, 0.6, 0.5] }} }}\n\
         [[solid]]\nname = \"ball\"\nshape = {{ mesh = {{ file = \"ball.obj\" }} }}\n\
         at = {{ x = 0.3, y = 0.3, draft = \"equilibrium\" }}\nfree = {{ density = 500.0 }}\n"
    );
    let built = Scene::parse(&text, &folder, &[]).unwrap().build::<3>().unwrap();
    let start = built.setup.solids[1].pose.position[2];
    // Half of the ball is under water, so its centre is in the surface, to the 1e-14 of the bisection.
    assert!((start - 0.3).abs() < 1e-12, "{start}");
    assert!(matches!(built.setup.solids[1].role, Role::Free(_)));
    let mut sim = Simulation::new(built.setup).unwrap();
    let mut most: f64 = 0.0;
    while sim.time() < 0.6 {
        sim.step().unwrap();
        most = most.max((sim.system().solids()[1].kinematics.pose.position[2] - start).abs());
    }
    // The bound of 0.5 dp is that of the ball in the scene buoyancy-3d; a ball does not fit the lattice.
    assert!(most < 0.5 * dp, "{} dp off", most / dp);
}

#[test]
fn a_mesh_in_millimetres_or_less_than_dp_large_is_refused_with_the_probable_unit() {
    let folder = folder("units");
    fs::write(folder.join("m.stl"), text_stl(&FACETS)).unwrap();
    fs::write(
        folder.join("mm.stl"),
        text_stl(&FACETS).replace("0.5", "500").replace("0.25", "250").replace("0.375", "375"),
    )
    .unwrap();
    let message = refusal("file = \"mm.stl\"", &folder);
    // 500 in water of 1 m: 0.5 m is the largest size that fits.
    assert!(
        message.contains("unit is probably mm, and its size 0.5000 m") && message.contains("scene.toml:8"),
        "{message}"
    );
    assert!(mesh("file = \"mm.stl\", unit = \"mm\"", &folder).is_ok());
    let message = refusal("file = \"m.stl\", unit = \"mm\"", &folder);
    assert!(message.contains("less than dp") && message.contains("its size 0.5000 m"), "{message}");
    // The outline of a prism is from the file, its length is not.
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"><rect width=\"500\" height=\"250\"/></svg>";
    fs::write(folder.join("mm.svg"), svg).unwrap();
    let prism = |words: &str| shape(&format!("{{ prism = {{ file = \"mm.svg\", {words} }} }}"), &folder);
    let message = prism("length = 0.25").expect_err("a prism of 500 m").to_string();
    assert!(message.contains("mm.svg makes solid \"body\" 500.0000 m large"), "{message}");
    assert!(message.contains("unit is probably mm, and its size 0.5000 m"), "{message}");
    assert!(prism("length = 0.25, unit = \"mm\"").is_ok());
    let compound = "{ compound = [{ shape = { prism = { file = \"mm.svg\", length = 0.25 } } }] }";
    assert!(shape(compound, &folder).is_err_and(|e| e.to_string().contains("unit is probably mm")));
}

#[test]
fn notes_about_mesh_and_drawing_files_are_findings_of_an_inspection() {
    let folder = folder("notes");
    let joined = text_stl(&FACETS).replacen("vertex 0.5 0 0", "vertex 0.50000001 0 0", 1);
    fs::write(folder.join("near.stl"), joined).unwrap();
    fs::write(
        folder.join("scene.toml"),
        "dimension = 3\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = { box = { min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 0.5] } }\n\
         [[solid]]\nname = \"body\"\nshape = { mesh = { file = \"near.stl\" } }\nat = { x = 0.3, y = 0.3, z = 0.0 }\nfixed = true\n",
    )
    .unwrap();
    let report = pontoon::run::inspect(&folder.join("scene.toml"), &Default::default()).unwrap().report().unwrap();
    let finding = report.preflight.findings.iter().find(|finding| finding.topic == "mesh").unwrap();
    assert!(finding.what.starts_with("near.stl: 1 corner is joined"), "{}", finding.what);
}

#[test]
fn the_contact_geometry_of_a_mesh_is_a_choice() {
    let folder = folder("touch");
    fs::write(folder.join("text.stl"), text_stl(&FACETS)).unwrap();
    for (word, contact) in [
        ("hull", ContactGeometry::Hull),
        ("none", ContactGeometry::None),
        ("decomposition", ContactGeometry::Decomposition),
    ] {
        let words = format!("{{ mesh = {{ file = \"text.stl\", contact = \"{word}\" }} }}");
        assert!(matches!(shape(&words, &folder), Ok(Shape::Mesh { contact: c, .. }) if c == contact), "{word}");
    }
}

#[test]
fn a_shape_without_convex_parts_is_refused_with_its_size() {
    let text = "dimension = 3\ndp = 0.05\nuntil = 1.0\n\
                [[water]]\nfill = { box = { min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 0.5] } }\n\
                [[solid]]\nname = \"mast\"\nat = { x = 0.5, y = 0.5, bottom = 0.7 }\nfree = { density = 500.0 }\n\
                shape = { prism = { points = [[0, 0], [0.1, 0], [0.1, 0.05], [0, 0.05]], length = 200 } }\n";
    let scene = Scene::parse(text, Path::new(""), &[]).unwrap();
    let error = Simulation::new(scene.build::<3>().unwrap().setup).err().expect("a mast of 200 m");
    let message = scene.with_location(error).to_string();
    ["[0.1, 0.05, 200] m", "solid.mast.shape", "less slender"].iter().for_each(|part| {
        assert!(message.contains(part), "{part} is not in {message}");
    });
}

#[test]
fn a_body_that_starts_inside_a_fixed_mesh_is_refused() {
    let folder = folder("inside");
    fs::write(folder.join("text.stl"), text_stl(&FACETS)).unwrap();
    // The pyramid is 2 m × 1 m wide and 1.5 m high and the box 0.1 m, so the box is far from the surface.
    let start = |contact: &str, x: f64| {
        let text = format!(
            "dimension = 3\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 0.5] }} }}\n\
             [[solid]]\nname = \"rock\"\nfixed = true\nat = {{ x = 2.0, y = 0.0, z = 0.0 }}\n\
             shape = {{ mesh = {{ file = \"text.stl\", scale = 4.0, contact = \"{contact}\" }} }}\n\
             [[solid]]\nname = \"box\"\nshape = {{ box = {{ size = [0.1, 0.1, 0.1] }} }}\n\
             at = {{ x = {x}, y = 0.5, z = 0.4 }}\nfree = {{ density = 500.0 }}\n"
        );
        let setup = Scene::parse(&text, &folder, &[]).unwrap().build::<3>().unwrap().setup;
        Simulation::new(setup).err().map(|e| e.to_string()).unwrap_or_default()
    };
    for contact in ["fitting", "surface", "hull"] {
        let message = start(contact, 2.75);
        assert!(message.contains("\"box\" starts 0.") && message.contains("m inside \"rock\""), "{contact}: {message}");
        assert_eq!(start(contact, 4.0), "", "{contact}: beside the mesh");
    }
    assert_eq!(start("none", 2.75), "");
}

#[test]
fn adding_a_body_inside_a_fixed_mesh_or_a_mesh_around_a_body_is_refused() {
    let folder = folder("added");
    fs::write(folder.join("text.stl"), text_stl(&FACETS)).unwrap();
    // The rock is 2 m × 1 m × 1.5 m, the bodies are 0.1 m.
    let text = "dimension = 3\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = { box = { min = [0.0, 0.0, 0.0], max = [0.5, 0.5, 0.3] } }\n\
                [[solid]]\nname = \"rock\"\nfixed = true\nat = { x = 2.0, y = 0.0, z = 0.0 }\n\
                shape = { mesh = { file = \"text.stl\", scale = 4.0 } }\n\
                [[solid]]\nname = \"float\"\nshape = { box = { size = [0.1, 0.1, 0.1] } }\nat = { x = 4.6, y = 0.5, z = 0.4 }\n\
                free = { density = 500.0 }\n";
    let setup = Scene::parse(text, &folder, &[]).unwrap().build::<3>().unwrap().setup;
    let (rock, float) = (setup.solids[0].clone(), setup.solids[1].clone());
    let mut sim = Simulation::new(setup).unwrap();
    let mut add = |spec: &pontoon::solid::SolidSpec<3>, name: &str, x: f64| {
        let mut spec = spec.clone();
        spec.name = name.into();
        spec.pose.position[0] = x;
        sim.add_solid(spec).err().map(|e| e.to_string()).unwrap_or_default()
    };
    let message = add(&float, "box", 2.75);
    assert!(message.contains("\"box\" would come 0.") && message.contains("m inside \"rock\""), "{message}");
    // A rock that contains the float.
    let message = add(&rock, "boulder", 3.85);
    assert!(message.contains("\"boulder\" would come 0.") && message.contains("m inside \"float\""), "{message}");
    assert_eq!(add(&float, "box", 4.3), "", "beside both, and the refusals changed nothing");
}

#[test]
fn a_body_that_displaces_all_water_is_named_in_the_error() {
    let text = "dimension = 2\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.5] } }\n\
                [[solid]]\nname = \"barge\"\nshape = { box = { size = [1.2, 0.8] } }\nat = { x = 0.5, bottom = -0.1 }\n\
                free = { density = 500.0 }\n";
    let scene = Scene::parse(text, Path::new("."), &[]).unwrap();
    let message = scene.build::<2>().map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("\"barge\" is 1.2000 m long along x and the water 1.0000 m"), "{message}");
    assert!(message.contains("make it smaller"), "{message}");
}

#[test]
fn still_water_stays_above_a_mesh_bed_of_a_broken_number_of_layers() {
    // The bed is 3.33 dp thick. Particles sank 2.2 dp into holes beside its edges; above a box none does.
    let (size, top, dp) = ([0.6, 0.3], 0.1, 0.03);
    let corners = [[0.0; 2], [size[0], 0.0], [0.0, size[1]], size];
    let corner = |z: f64| corners.map(|[x, y]| format!("v {x} {y} {z}\n")).concat();
    let facets =
        "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 6\n";
    let folder = folder("bed");
    fs::write(folder.join("bed.obj"), corner(0.0) + &corner(top) + facets).unwrap();
    let text = format!(
        "dimension = 3\ndp = {dp}\nuntil = 0.5\n[[water]]\nfill = {{ box = {{ min = [0, 0, 0], max = [0.6, 0.3, 0.36] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [0.6, 0.3, 0.5] }} }}\n\
         [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ mesh = {{ file = \"bed.obj\" }} }}\n"
    );
    let mut sim = Simulation::new(Scene::parse(&text, &folder, &[]).unwrap().build::<3>().unwrap().setup).unwrap();
    run_to(&mut sim, 0.5).unwrap();
    let deepest = sim.system().fluid().r.iter().map(|r| (top - r[2]) / dp).fold(f64::NEG_INFINITY, f64::max);
    assert!(deepest < 0.5, "a particle is {deepest} dp below the bed's face");
}
