//! Contact skins: bodies touch at the skin distance outside their faces, at rest and in a collision.

use std::path::Path;

use pontoon::{
    Result,
    geometry::Shape,
    math::{Pose, Vector},
    scene::Scene,
    solid::{Constraints, Dim, Engine, FreeBody, HasEngine, Kinematics, Load, Role, SolidSpec},
};

use crate::common;

const G: f64 = 9.81;

/// Thickness of a skin, m.
const SKIN: f64 = 5e-3;

/// A solid with its centre at `height` (m) above the origin.
fn at_height<const D: usize>(name: &str, shape: Shape<D>, height: f64, role: Role<D>, skin: f64) -> SolidSpec<D> {
    let place = Vector::from_fn(|i, _| if i == D - 1 { height } else { 0.0 });
    common::solid(name, shape, Pose::at(place), role).contact_skin(skin)
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

/// The engine of `solids` under gravity `g` (m/s²) at dp = 0.01 m, which allows 0.5 mm of initial overlap.
fn engine<const D: usize>(solids: &[SolidSpec<D>], g: f64) -> Result<Box<dyn Engine<D>>>
where
    Dim<D>: HasEngine<D>,
{
    let start: Vec<Kinematics<D>> = solids.iter().map(SolidSpec::initial_kinematics).collect();
    let gravity = Vector::from_fn(|i, _| if i == D - 1 { -g } else { 0.0 });
    Dim::<D>::engine(solids, &start, &Constraints::default(), &gravity, 0.01)
}

/// The engine after half a second under gravity in steps of 0.1 ms.
fn settled<const D: usize>(solids: &[SolidSpec<D>]) -> Box<dyn Engine<D>>
where
    Dim<D>: HasEngine<D>,
{
    let mut engine = engine(solids, G).unwrap();
    let (loads, none) = (vec![Load::zero(); solids.len()], vec![None; solids.len()]);
    (0..5000).for_each(|_| engine.step(1e-4, &loads, &none).unwrap());
    engine
}

fn assert_boxes_rest_at_skins<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // The boxes start 0.2 mm above the contact of the skins.
    let (low, high) = (0.05 + SKIN, 0.15 + 3.0 * SKIN);
    let solids = [floor::<D>(0.0), free("lower", cube(), low + 2e-4, SKIN), free("upper", cube(), high + 4e-4, SKIN)];
    let engine = settled(&solids);
    // A contact of 500 Hz sinks g/(2πf)² = 1 µm under one body. The bound of 50 µm covers the landing and is a hundredth of a skin.
    for (i, height) in [(1, low), (2, high)] {
        let sinks = height - engine.kinematics(i).pose.position[D - 1];
        assert!((-1e-9..50e-6).contains(&sinks), "{}-D: body {i} sinks {sinks} m", D);
    }
    let contacts = engine.contacts();
    assert_eq!(contacts.iter().map(|contact| contact.between).collect::<Vec<_>>(), [[0, 1], [1, 2]]);
    // Each contact carries the weight above it. Its position is on the bare floor, or midway between two skins.
    let weights = [mass(&solids[1]) + mass(&solids[2]), mass(&solids[2])].map(|mass| mass * G);
    for ((contact, weight), place) in contacts.iter().zip(weights).zip([0.0, 0.1 + 2.0 * SKIN]) {
        assert!((contact.normal_force / weight - 1.0).abs() < 1e-3, "{contact:?} for {weight} N");
        assert!((contact.at[D - 1] - place).abs() < 1e-4, "{contact:?} at {place} m");
    }
}

#[test]
fn boxes_with_skins_of_5_mm_rest_10_mm_apart_and_5_mm_above_a_bare_floor() {
    assert_boxes_rest_at_skins::<2>();
    assert_boxes_rest_at_skins::<3>();
}

fn assert_ball_rests_at_skins<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // The skins of floor and ball add up.
    let height = 0.05 + SKIN + 2.0 * SKIN;
    let solids = [floor::<D>(SKIN), free("ball", Shape::Ball { radius: 0.05 }, height + 2e-4, 2.0 * SKIN)];
    let sinks = height - settled(&solids).kinematics(1).pose.position[D - 1];
    assert!((-1e-9..50e-6).contains(&sinks), "{}-D: it sinks {sinks} m", D);
}

#[test]
fn skins_of_different_thickness_add_up_under_a_ball() {
    assert_ball_rests_at_skins::<2>();
    assert_ball_rests_at_skins::<3>();
}

fn assert_rebound_at_skins<const D: usize>()
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
    // The cube rebounds within one and a half steps before the skins touch.
    let gap = nearest - (0.05 + 2.0 * SKIN);
    assert!((-1e-12..=1.6 * dt).contains(&gap), "{}-D: {gap} m before the skins", D);
    let velocity = engine.kinematics(1).velocity[D - 1];
    assert!((velocity - 1.0).abs() < 1e-9, "Newton's law of restitution to round-off: {velocity}");
}

#[test]
fn a_collision_rebounds_at_the_skins() {
    assert_rebound_at_skins::<2>();
    assert_rebound_at_skins::<3>();
}

fn assert_overlap_refused<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let at = |height: f64| [floor::<D>(SKIN), free("cube", cube(), height, SKIN)];
    let message = engine(&at(0.058), G).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(message.contains("\"cube\" starts 0.00200 m inside \"floor\", contact skins counted"), "{message}");
    // A twentieth of dp of overlap is allowed, with and without skins.
    assert!(engine(&at(0.0596), G).is_ok());
    let bare = at(0.049).map(|solid| solid.contact_skin(0.0));
    let message = engine(&bare, G).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(message.contains("\"cube\" starts 0.00100 m inside \"floor\"") && !message.contains("skin"), "{message}");
    // The same limit applies to solids added during a run.
    let there = engine(&at(0.06), G).unwrap();
    let late = free("late", cube(), 0.16, SKIN);
    let (who, depth) = there.deepest_overlap(&late, &late.initial_kinematics()).unwrap().unwrap();
    assert!(who == 1 && (depth - 2.0 * SKIN).abs() < 1e-6, "{who}: {depth} m");
    let late = free("late", cube(), 0.1701, SKIN);
    assert_eq!(there.deepest_overlap(&late, &late.initial_kinematics()).unwrap(), None);
}

#[test]
fn an_initial_overlap_of_skins_is_refused_with_the_names_of_the_solids() {
    assert_overlap_refused::<2>();
    assert_overlap_refused::<3>();
}

/// A floating box with the key `skin` in a tank.
fn scene(skin: &str) -> String {
    format!(
        r#"
dimension = 2
dp = 0.02
until = 0.01

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
fn a_skin_is_at_most_half_of_the_smallest_extent_and_is_a_listed_value() -> Result<()> {
    let built = |skin: &str| -> Result<Scene> {
        let scene = Scene::parse(&scene(skin), Path::new(""), &[])?;
        scene.build::<2>().map(|_| scene)
    };
    let values = built("contact_skin = 0.05")?.resolve()?;
    assert!(
        values.iter().any(|value| value.key == "solid.box.contact_skin" && value.value == "0.05"),
        "the value is listed"
    );
    assert!(
        !built("")?.resolve()?.iter().any(|value| value.key.ends_with("skin")),
        "without a skin no value is listed"
    );
    for skin in ["-0.001", "0.051"] {
        let error = built(&format!("contact_skin = {skin}")).err().unwrap_or_else(|| panic!("{skin} passes"));
        let (text, help) = (error.to_string(), error.help.clone().unwrap_or_default());
        assert!(text.contains("\"box\": its contact skin is"), "{text}");
        assert!(help.contains("0.0500 m, half of its smallest extent"), "{help}");
    }
    Ok(())
}
