//! Contact entries for groups of solids: the pairs that they cover, their precedence, and refused entries.

use std::path::Path;

use pontoon::{
    Result,
    scene::Scene,
    simulation::Simulation,
    solid::{Constraints, ContactSpec},
};

use crate::common;

/// A tank (solid 0) with three floats (1 to 3), a steel beam (4) above them and a steel post (5).
const SCENE: &str = r#"
dimension = 2
dp        = 0.05
until     = 1.0

[[water]]
fill = { box = { min = [0.0, 0.0], max = [2.0, 0.3] } }

[[solid]]
name  = "tank"
group = "walls"
fixed = true
shape = { tank = { size = [2.0, 1.0] } }

[[solid]]
name  = "a"
group = "floats"
shape = { box = { size = [0.2, 0.2] } }
at    = { x = 0.3, draft = "equilibrium" }
free  = { density = 500.0 }

[[solid]]
name  = "b"
group = "floats"
shape = { box = { size = [0.2, 0.2] } }
at    = { x = 0.8, draft = "equilibrium" }
free  = { density = 500.0 }

[[solid]]
name  = "c"
group = "floats"
shape = { box = { size = [0.2, 0.2] } }
at    = { x = 1.3, draft = "equilibrium" }
free  = { density = 500.0 }

[[solid]]
name  = "beam"
group = "steel"
shape = { box = { size = [0.4, 0.2] } }
at    = { x = 1.0, y = 0.7 }
free  = { density = 800.0 }

[[solid]]
name  = "post"
group = "steel"
fixed = true
shape = { box = { size = [0.1, 0.5] } }
at    = { x = 1.75, bottom = 0.0 }
"#;

const IGNORED: &str = "[[contact]]\nbetween = [\"floats\", \"floats\"]\ntouch = false\n";

fn scene(more: &str) -> Result<Scene> {
    Scene::parse(&format!("{SCENE}\n{more}"), Path::new(""), &[])
}

fn constraints(more: &str) -> Result<Constraints<2>> {
    Ok(scene(more)?.build::<2>()?.setup.constraints)
}

fn friction(constraints: &Constraints<2>, a: usize, b: usize) -> Option<f64> {
    constraints.contacts.find(a, b).and_then(|pair| pair.friction)
}

#[test]
fn floats_of_a_group_without_contact_may_overlap_one_another_but_not_the_tank() -> Result<()> {
    let constraints = constraints(IGNORED)?;
    assert!(!constraints.can_touch(1, 2) && !constraints.can_touch(3, 1) && !constraints.can_touch(2, 3));
    assert!((1..4).all(|float| constraints.can_touch(0, float)
        && constraints.can_touch(float, 4)
        && constraints.can_touch(5, float)));
    assert_eq!(constraints.contacts.len(), 3, "each pair once");
    // The floats may also overlap at the start.
    let overlapping = |words: &str| -> Result<Simulation<2>> {
        let text = format!("{}\n{words}", SCENE.replacen("x = 0.8", "x = 0.35", 1));
        common::scene_simulation::<2>(&text)
    };
    assert!(overlapping("").err().is_some_and(|e| e.to_string().contains("inside")));
    overlapping(IGNORED)?;
    let scene = scene(IGNORED)?;
    assert!(Scene::parse(&scene.to_toml()?, Path::new(""), &[])? == scene, "{}", scene.to_toml()?);
    Ok(())
}

#[test]
fn a_contact_of_two_groups_covers_every_pair_across_them_that_can_touch() -> Result<()> {
    let of = |between: &str| constraints(&format!("[[contact]]\nbetween = [{between}]\nfriction = 0.1"));
    let both = of("\"floats\", \"steel\"")?;
    assert_eq!(both.contacts.len(), 6);
    assert!((1..4).all(|float| friction(&both, float, 4) == Some(0.1) && friction(&both, 5, float) == Some(0.1)));
    assert!(both.contacts.find(4, 5).is_none() && both.contacts.find(1, 2).is_none());
    // The beam with all five other solids, and the post with the three floats.
    let all = of("\"steel\"")?;
    assert_eq!((all.contacts.len(), friction(&all, 4, 5), friction(&all, 0, 5)), (8, Some(0.1), None));
    assert_eq!(of("\"a\", \"floats\"")?.contacts.len(), 2, "one solid of a group and the others of that group");
    assert_eq!(of("\"post\", \"floats\"")?.contacts.len(), 3);
    assert_eq!(of("\"walls\", \"steel\"")?.contacts.len(), 1, "tank and post never touch");
    Ok(())
}

#[test]
fn the_later_of_two_contacts_of_a_pair_applies() -> Result<()> {
    let own = "[[contact]]\nbetween = [\"b\", \"a\"]\nfriction = 0.4\n";
    let refined = constraints(&format!("{IGNORED}{own}"))?;
    assert!(refined.can_touch(1, 2) && !refined.can_touch(1, 3));
    assert_eq!((refined.contacts.len(), friction(&refined, 1, 2)), (3, Some(0.4)));
    let ruled = constraints(&format!("{own}{IGNORED}"))?;
    assert!(!ruled.can_touch(1, 2) && friction(&ruled, 1, 2).is_none());
    let usual = constraints(&format!("{IGNORED}[[contact]]\nbetween = [\"a\", \"b\"]\ntouch = true"))?;
    assert!(usual.can_touch(1, 2) && !usual.can_touch(2, 3));
    // The Rust interface follows the same rule.
    let mut contacts: Constraints<2> = Constraints::default();
    contacts.contacts.extend([ContactSpec::new([1, 0]).without_contact(), ContactSpec::new([0, 1])]);
    assert!(contacts.can_touch(0, 1) && contacts.contacts.len() == 1);
    Ok(())
}

#[test]
fn half_a_million_ignored_pairs_are_found_without_a_linear_search() {
    let pairs = (0..1000).flat_map(|a| (0..a).map(move |b| [a, b]));
    let mut links: Constraints<2> = Constraints::default();
    links.contacts.extend(pairs.clone().map(|pair| ContactSpec::new(pair).without_contact()));
    // A linear search for each of the half million pairs would take minutes.
    assert!(pairs.into_iter().all(|[a, b]| !links.can_touch(a, b)));
}

/// The error message of the scene with `from` replaced by `to` and the sections `more`.
fn error_message(from: &str, to: &str, more: &str) -> String {
    assert!(SCENE.contains(from), "\"{from}\" is not in the scene");
    let text = format!("{}\n{more}", SCENE.replacen(from, to, 1));
    let built = Scene::parse(&text, Path::new(""), &[]).and_then(|scene| scene.build::<2>().map(|_| ()));
    built.expect_err("this scene is wrong").to_string()
}

#[test]
fn wrong_contact_entries_are_refused_with_a_remedy() {
    let cases: [(&str, &[&str]); 9] = [
        ("between = [\"a\", \"b\", \"c\"]", &["not 3", "one alone means its contacts with all others", "contact.0"]),
        ("between = []", &["two solids or groups, or one, not 0"]),
        ("between = [\"flots\", \"tank\"]", &["no solid or group is called \"flots\"; did you mean \"floats\"?"]),
        ("between = [\"a\", \"a\"]", &["\"a\" is named twice"]),
        ("between = [\"tank\", \"post\"]", &["of \"tank\" and \"post\" no two solids can touch", "free = {"]),
        ("between = [\"walls\", \"post\"]", &["of \"walls\" and \"post\" no two solids can touch"]),
        ("between = [\"walls\", \"walls\"]", &["of \"walls\" no two solids can touch", "it takes two"]),
        ("between = [\"floats\"]\ntouch = true", &["this contact is as any other"]),
        ("between = [\"floats\"]\nfriction = 0.1\ntouch = false", &["has neither friction nor restitution"]),
    ];
    for (words, expected) in cases {
        let rest = if words.contains('\n') { "" } else { "\nfriction = 0.1" };
        let message = error_message("until", "until", &format!("[[contact]]\n{words}{rest}"));
        for part in expected {
            assert!(message.contains(part), "{words}: \"{part}\" is not in\n{message}");
        }
    }
    let group = "group = \"floats\"";
    let two = error_message(group, "group = \"two words\"", "");
    assert!(two.contains("\"two words\" cannot be a name") && two.contains("one word of letters"), "{two}");
    let taken = error_message(group, "group = \"c\"", "");
    assert!(taken.contains("a solid is called \"c\", too") && taken.contains("a name of its own"), "{taken}");
}

#[test]
fn a_group_in_place_of_a_single_solid_is_refused() {
    let rope = "[[rope]]\nname = \"tie\"\nbetween = [\"tank\", \"floats\"]\nfrom = [0.0, 0.6]\nto = [0.3, 0.3]";
    for (words, key) in [
        ("[[joint]]\nname = \"pin\"\nkind = \"hinge\"\nbetween = [\"floats\"]\nat = [0.3, 0.3]", "joint.0.between"),
        (rope.replace("rope", "spring").replace("to =", "stiffness = 10.0\nto =").as_str(), "spring.0.between"),
        (rope, "rope.0.between"),
        ("[[force]]\nname = \"wind\"\non = \"floats\"\nforce = [1.0, 0.0]", "force.0.on"),
        ("[[probe]]\nmotion = \"floats\"", "probe.0.motion"),
    ] {
        let message = error_message("until", "until", words);
        for part in ["\"floats\" is a group, and here a single solid is meant", "of this one: a, b, c", key] {
            assert!(message.contains(part), "{words}: \"{part}\" is not in\n{message}");
        }
    }
}

#[test]
fn a_probe_of_an_impossible_contact_is_refused_with_the_reason() -> Result<()> {
    let probe = "[[probe]]\ncontact = [\"a\", \"b\"]\n";
    let pin = "[[joint]]\nname = \"pin\"\nkind = \"hinge\"\nbetween = [\"a\", \"b\"]\nat = [0.55, 0.3]\n";
    let cases: [(&str, &str, &[&str]); 4] = [
        (IGNORED, probe, &["never touch: contact.0 says  touch = false", "probe.0.contact"]),
        (pin, probe, &["\"a\" and \"b\" never touch: joint \"pin\" holds them", "contacts = true"]),
        ("", "[[probe]]\ncontact = [\"a\", \"a\"]", &["they are one solid"]),
        ("", "[[probe]]\ncontact = [\"tank\", \"post\"]", &["neither is free"]),
    ];
    for (words, probe, expected) in cases {
        let message = error_message("until", "until", &format!("{words}{probe}"));
        for part in expected {
            assert!(message.contains(part), "\"{part}\" is not in\n{message}");
        }
    }
    constraints(&format!("{pin}contacts = true\n{probe}"))?;
    constraints(&format!("{IGNORED}[[contact]]\nbetween = [\"a\", \"b\"]\nfriction = 0.2\n{probe}"))?;
    Ok(())
}

#[test]
fn a_joint_limit_beyond_a_full_turn_and_a_mass_that_is_not_positive_are_refused() {
    let hinge =
        "[[joint]]\nname = \"pin\"\nkind = \"hinge\"\nbetween = [\"a\"]\nat = [0.3, 0.3]\nlimits_deg = [-400, 400]";
    let turn = error_message("until", "until", hinge);
    assert!(turn.contains("from -400 to 400 degrees") && turn.contains("less than 360"), "{turn}");
    assert!(turn.contains("joint.0.limits_deg"), "{turn}");
    for mass in ["0", "-1"] {
        let message = error_message("density = 500.0", &format!("mass = {mass}"), "");
        assert!(message.contains(&format!("mass must be a positive number, not {mass}")), "{message}");
        assert!(message.contains("write  free = { mass = 10.0 }"), "{message}");
    }
}
