//! Zones in which waves go to rest: how their strength grows on the way, and which it is where nobody says it.

use std::path::Path;

use pontoon::{Error, math::Vector, scene::Scene, system::SpongeLayer};

const TANK: &str = r#"
dimension = 2
dp = 0.05
until = 1.0
[[water]]
fill = { box = { min = [0.0, 0.0], max = [4.0, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [4.0, 0.8] } }
[[damping]]
from = [2.0, 0.0]
to = [4.0, 0.0]
"#;

fn scene(words: &str) -> Result<Scene, Error> {
    Scene::parse(&format!("{TANK}{words}\n"), Path::new(""), &[])
}

fn zone(words: &str) -> Result<SpongeLayer<2>, Error> {
    Ok(scene(words)?.build::<2>()?.setup.sponge_layers[0])
}

#[test]
fn the_strength_grows_as_the_power_of_the_way() {
    for power in [0.5, 1.0, 2.0, 3.0] {
        let zone = zone(&format!("strength = 3.0\npower = {power:?}")).unwrap();
        let rate = |x: f64| zone.rate(&Vector::from([x, 0.3]));
        assert_eq!([1.0, 2.0, 4.0, 9.0].map(rate), [0.0, 0.0, 3.0, 3.0], "before it, and beyond it");
        assert!((rate(2.5) - 3.0 * 0.25_f64.powf(power)).abs() < 1e-12, "{power}: {}", rate(2.5));
    }
    assert_eq!(zone("").unwrap().power, 2.0);
}

#[test]
fn a_strength_that_nobody_says_leaves_the_same_of_a_long_wave_whatever_the_power() {
    for power in [1.0, 2.0, 4.0] {
        let words = format!("power = {power:?}");
        let zone = zone(&words).unwrap();
        // Water's motion is half of a wave's energy, so on its way there and back its height loses the integral of the rate over its speed.
        let dx = 0.001;
        let lost: f64 = (0..2000).map(|i| zone.rate(&Vector::from([2.0 + (f64::from(i) + 0.5) * dx, 0.0])) * dx).sum();
        let lost = lost / (9.81_f64 * 0.4).sqrt();
        // Midpoints of two thousand parts miss the integral of s⁴ by 1e-7.
        assert!((lost - 4.0).abs() < 1e-5, "power {power}: e^-{lost}");
        let told = scene(&words).unwrap().resolve().unwrap();
        let told = told.iter().find(|value| value.key == "damping.0.strength").expect("a value in force");
        assert_eq!(told.value.parse::<f64>().ok(), Some(zone.strength), "{told}");
    }
}

#[test]
fn a_power_that_is_none_is_refused() {
    let why = [
        ("0.0", "power must be a positive number"),
        ("-1.0", "power must be a positive number"),
        ("nan", "nan is not a finite number"),
    ];
    for (power, why) in why {
        let said = zone(&format!("power = {power}")).map(|_| ()).unwrap_err().to_string();
        assert!(said.contains(why), "{said}");
    }
}
