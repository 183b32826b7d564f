//! Contact skins: bodies touch that far outside their faces, at rest and in a blow, and the page shows it.

use std::{fs, path::Path};

use pontoon::{
    Result,
    geometry::Shape,
    math::{Pose, Vector},
    report::{self, ColourField, PictureOptions},
    run::{self, Progress, RunOptions},
    scene::Scene,
    solid::{Constraints, Dim, Engine, FreeBody, HasEngine, Kinematics, Load, Role, SolidSpec},
};
use serde_json::Value;
use tiny_skia::Pixmap;

use crate::rig;

const G: f64 = 9.81;

/// Thickness of a skin, m.
const SKIN: f64 = 5e-3;

/// A solid with its centre this high above the origin, m.
fn at_height<const D: usize>(name: &str, shape: Shape<D>, height: f64, role: Role<D>, skin: f64) -> SolidSpec<D> {
    let place = Vector::from_fn(|i, _| if i == D - 1 { height } else { 0.0 });
    rig::solid(name, shape, Pose::at(place), role).contact_skin(skin)
}

/// A fixed block a metre wide with its top at height 0.
fn floor<const D: usize>(skin: f64) -> SolidSpec<D> {
    at_height("floor", Shape::Box { size: Vector::repeat(1.0) }, -0.5, Role::Fixed, skin)
}

/// A free body of 500 kg/m³.
fn free<const D: usize>(name: &str, shape: Shape<D>, height: f64, skin: f64) -> SolidSpec<D> {
    let role = Role::Free(FreeBody::from_density(&shape, 500.0));
    at_height(name, shape, height, role, skin)
}

/// A cube 0.1 m wide.
fn cube<const D: usize>() -> Shape<D> {
    Shape::Box { size: Vector::repeat(0.1) }
}

fn mass<const D: usize>(solid: &SolidSpec<D>) -> f64 {
    if let Role::Free(body) = &solid.role { body.mass } else { f64::INFINITY }
}

/// The engine of `solids` under gravity `g` (m/s²), at dp = 0.01 m: 0.5 mm of overlap is let pass.
fn engine<const D: usize>(solids: &[SolidSpec<D>], g: f64) -> Result<Box<dyn Engine<D>>>
where
    Dim<D>: HasEngine<D>,
{
    let start: Vec<Kinematics<D>> = solids.iter().map(SolidSpec::initial_kinematics).collect();
    let gravity = Vector::from_fn(|i, _| if i == D - 1 { -g } else { 0.0 });
    Dim::<D>::engine(solids, &start, &Constraints::default(), &gravity, 0.01)
}

/// Half a second under gravity in steps of 0.1 ms.
fn settled<const D: usize>(solids: &[SolidSpec<D>]) -> Box<dyn Engine<D>>
where
    Dim<D>: HasEngine<D>,
{
    let mut engine = engine(solids, G).unwrap();
    let (loads, none) = (vec![Load::zero(); solids.len()], vec![None; solids.len()]);
    (0..5000).for_each(|_| engine.step(1e-4, &loads, &none).unwrap());
    engine
}

fn stands_off<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // Let go 0.2 mm above where the skins meet.
    let (low, high) = (0.05 + SKIN, 0.15 + 3.0 * SKIN);
    let solids = [floor::<D>(0.0), free("lower", cube(), low + 2e-4, SKIN), free("upper", cube(), high + 4e-4, SKIN)];
    let engine = settled(&solids);
    // A contact of 500 Hz sinks g/(2πf)² = 1 µm under one body; 50 µm leave room for the landing and are a hundredth of a skin.
    for (i, height) in [(1, low), (2, high)] {
        let sinks = height - engine.kinematics(i).pose.position[D - 1];
        assert!((-1e-9..50e-6).contains(&sinks), "{}-D: body {i} sinks {sinks} m", D);
    }
    let contacts = engine.contacts();
    assert_eq!(contacts.iter().map(|contact| contact.between).collect::<Vec<_>>(), [[0, 1], [1, 2]]);
    // Each bears what is above it; where it does is where the skins meet: on the bare floor, and in the middle between two skins.
    let weights = [mass(&solids[1]) + mass(&solids[2]), mass(&solids[2])].map(|mass| mass * G);
    for ((contact, weight), place) in contacts.iter().zip(weights).zip([0.0, 0.1 + 2.0 * SKIN]) {
        assert!((contact.normal_force / weight - 1.0).abs() < 1e-3, "{contact:?} for {weight} N");
        assert!((contact.at[D - 1] - place).abs() < 1e-4, "{contact:?} at {place} m");
    }
}

#[test]
fn boxes_with_skins_of_5_mm_rest_10_mm_apart_and_5_mm_above_a_bare_floor() {
    stands_off::<2>();
    stands_off::<3>();
}

fn rolls_off<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // The floor's skin and the ball's own.
    let height = 0.05 + SKIN + 2.0 * SKIN;
    let solids = [floor::<D>(SKIN), free("ball", Shape::Ball { radius: 0.05 }, height + 2e-4, 2.0 * SKIN)];
    let sinks = height - settled(&solids).kinematics(1).pose.position[D - 1];
    assert!((-1e-9..50e-6).contains(&sinks), "{}-D: it sinks {sinks} m", D);
}

#[test]
fn skins_of_unlike_thickness_add_up_under_a_ball() {
    rolls_off::<2>();
    rolls_off::<3>();
}

fn turns_back<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let mut solids = [floor::<D>(SKIN), free("cube", cube(), 0.1, SKIN)];
    solids.iter_mut().for_each(|solid| solid.restitution = 1.0);
    if let Role::Free(body) = &mut solids[1].role {
        body.velocity[D - 1] = -1.0;
    }
    let mut engine = engine(&solids, 0.0).unwrap();
    let (dt, mut nearest) = (1e-4, f64::INFINITY);
    for _ in 0..1000 {
        engine.step(dt, &[Load::zero(); 2], &[None, None]).unwrap();
        nearest = engine.kinematics(1).pose.position[D - 1].min(nearest);
    }
    // It turns back where the next step and a half would take it into the skins, to where it came from.
    let gap = nearest - (0.05 + 2.0 * SKIN);
    assert!((-1e-12..=1.6 * dt).contains(&gap), "{}-D: {gap} m before the skins", D);
    let velocity = engine.kinematics(1).velocity[D - 1];
    assert!((velocity - 1.0).abs() < 1e-9, "Newton's law to round-off: {velocity}");
}

#[test]
fn a_blow_turns_back_at_the_skins() {
    turns_back::<2>();
    turns_back::<3>();
}

fn refused<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let near = |height: f64| [floor::<D>(SKIN), free("cube", cube(), height, SKIN)];
    let message = engine(&near(0.058), G).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(message.contains("\"cube\" starts 0.00200 m inside \"floor\", contact skins counted"), "{message}");
    // A twentieth of dp is let pass, with skins as without.
    assert!(engine(&near(0.0596), G).is_ok());
    let bare = near(0.049).map(|solid| solid.contact_skin(0.0));
    let message = engine(&bare, G).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(message.contains("\"cube\" starts 0.00100 m inside \"floor\"") && !message.contains("skin"), "{message}");
    // What comes later is held to the same.
    let there = engine(&near(0.06), G).unwrap();
    let late = free("late", cube(), 0.16, SKIN);
    let (who, depth) = there.deepest_overlap(&late, &late.initial_kinematics()).unwrap().unwrap();
    assert!(who == 1 && (depth - 2.0 * SKIN).abs() < 1e-6, "{who}: {depth} m");
    let late = free("late", cube(), 0.1701, SKIN);
    assert_eq!(there.deepest_overlap(&late, &late.initial_kinematics()).unwrap(), None);
}

#[test]
fn a_start_within_the_skins_is_refused_by_name() {
    refused::<2>();
    refused::<3>();
}

/// A box with such a skin afloat in a tank.
fn scene(skin: &str) -> String {
    format!(
        r#"
dimension = 2
dp = 0.02
until = 0.01
frames = {{ every = 0.01 }}

[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [0.6, 0.2] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [0.6, 0.4] }} }}

[[solid]]
name = "box"
shape = {{ box = {{ size = [0.2, 0.1] }} }}
at = {{ x = 0.3, draft = "equilibrium" }}
free = {{ density = 500.0 }}
{skin}
"#
    )
}

#[test]
fn a_skin_is_half_of_the_smallest_extent_at_most_and_inspect_lists_it() -> Result<()> {
    let built = |skin: &str| -> Result<Scene> {
        let scene = Scene::parse(&scene(skin), Path::new(""), &[])?;
        scene.build::<2>().map(|_| scene)
    };
    let values = built("contact_skin = 0.05")?.resolve()?;
    assert!(
        values.iter().any(|value| value.key == "solid.box.contact_skin" && value.value == "0.05"),
        "it is in force"
    );
    assert!(!built("")?.resolve()?.iter().any(|value| value.key.ends_with("skin")), "none is none");
    for skin in ["-0.001", "0.051"] {
        let error = built(&format!("contact_skin = {skin}")).err().unwrap_or_else(|| panic!("{skin} passes"));
        let (text, help) = (error.to_string(), error.help.clone().unwrap_or_default());
        assert!(text.contains("\"box\": its contact skin is"), "{text}");
        assert!(help.contains("0.0500 m, half of its smallest extent"), "{help}");
    }
    Ok(())
}

#[test]
fn the_page_and_the_picture_show_the_skin_outside_the_face() {
    let home = std::env::temp_dir().join(format!("pontoon-skins-{}", std::process::id()));
    let _ = fs::remove_dir_all(&home);
    fs::create_dir_all(&home).unwrap();
    let ran = |name: &str, skin: &str| {
        fs::write(home.join("scene.toml"), scene(skin)).unwrap();
        let options = RunOptions { out: Some(home.join(name)), threads: Some(1), ..RunOptions::default() };
        run::run(&home.join("scene.toml"), &options, &mut |_: &Progress| true).unwrap().folder
    };
    let (padded, bare) = (ran("padded", "contact_skin = 0.02"), ran("bare", ""));
    let page = fs::read_to_string(report::write(&padded).unwrap().path).unwrap();
    let (_, told) = page.split_once("id=\"told\">").unwrap();
    let told: Value = serde_json::from_str(told.split_once("</script>").unwrap().0).unwrap();
    let rim = |solid: usize| told.pointer(&format!("/runs/0/stage/solids/{solid}/rim/lines")).unwrap().clone();
    assert_eq!(rim(0), Value::Array(vec![]), "the tank has none");
    let line = rim(1)[0].clone();
    assert!(line["closed"] == true, "{line}");
    for point in line["points"].as_array().unwrap() {
        let beyond = [(0, 0.1), (1, 0.05)].map(|(i, half)| (point[i].as_f64().unwrap().abs() - half).max(0.0));
        let off = beyond[0].hypot(beyond[1]) - 0.02;
        assert!(off.abs() < 1e-12, "{point} is {off} m off the skin of a box of 0.2 × 0.1 m");
    }
    let picture = |folder: &Path| {
        let shot = PictureOptions {
            times: vec![0.0],
            field: ColourField::Pressure,
            range: Some([0.0, 2000.0]),
            width: 600,
            column_titles: vec![],
        };
        let out = folder.join("now.png");
        report::write_picture(&[folder.to_owned()], &shot, &out).unwrap();
        Pixmap::load_png(out).unwrap()
    };
    let (with, without) = (picture(&padded), picture(&bare));
    assert_eq!((with.width(), with.height()), (without.width(), without.height()));
    let unlike = with.pixels().iter().zip(without.pixels()).filter(|(a, b)| a != b).count();
    // The dashes of a line of some 0.7 m where a metre has about 600 pixels: half of them at least; and nothing but a thin line.
    assert!((100..2000).contains(&unlike), "{unlike} pixels of dashes");
    let _ = fs::remove_dir_all(&home);
}
