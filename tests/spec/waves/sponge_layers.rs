//! Damping zones: growth of the damping rate along the zone, and its default strength.

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

fn scene(keys: &str) -> Result<Scene, Error> {
    Scene::parse(&format!("{TANK}{keys}\n"), Path::new(""), &[])
}

fn zone(keys: &str) -> Result<SpongeLayer<2>, Error> {
    Ok(scene(keys)?.build::<2>()?.setup.sponge_layers[0])
}

#[test]
fn the_damping_rate_grows_as_a_power_of_the_distance_into_the_zone() {
    for power in [0.5, 1.0, 2.0, 3.0] {
        let zone = zone(&format!("strength = 3.0\npower = {power:?}")).unwrap();
        let rate = |x: f64| zone.rate(&Vector::from([x, 0.3]));
        assert_eq!([1.0, 2.0, 4.0, 9.0].map(rate), [0.0, 0.0, 3.0, 3.0], "zero before the zone and constant beyond it");
        assert!((rate(2.5) - 3.0 * 0.25_f64.powf(power)).abs() < 1e-12, "{power}: {}", rate(2.5));
    }
    assert_eq!(zone("").unwrap().power, 2.0);
}

#[test]
fn the_default_strength_damps_a_long_wave_equally_for_every_power() {
    for power in [1.0, 2.0, 4.0] {
        let keys = format!("power = {power:?}");
        let zone = zone(&keys).unwrap();
        // Kinetic energy is half of the energy of a wave. Over the way through the zone and back its height decays with the exponent
        // ∫ rate dx / speed.
        let dx = 0.001;
        let lost: f64 = (0..2000).map(|i| zone.rate(&Vector::from([2.0 + (f64::from(i) + 0.5) * dx, 0.0])) * dx).sum();
        let lost = lost / (9.81_f64 * 0.4).sqrt();
        // The midpoint rule with two thousand parts has an error of 1e-7 for the integral of s⁴.
        assert!((lost - 4.0).abs() < 1e-5, "power {power}: e^-{lost}");
        let values = scene(&keys).unwrap().resolve().unwrap();
        let strength = values.iter().find(|value| value.key == "damping.0.strength").expect("a listed value");
        assert_eq!(strength.value.parse::<f64>().ok(), Some(zone.strength), "{strength}");
    }
}

#[test]
fn a_power_that_is_not_positive_or_not_finite_is_refused() {
    let why = [
        ("0.0", "power must be a positive number"),
        ("-1.0", "power must be a positive number"),
        ("nan", "nan is not a finite number"),
    ];
    for (power, why) in why {
        let message = zone(&format!("power = {power}")).map(|_| ()).unwrap_err().to_string();
        assert!(message.contains(why), "{message}");
    }
}
