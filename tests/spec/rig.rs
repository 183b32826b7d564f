//! What the tests share: models, lattices, tanks, and folders.

use std::{fs, path::PathBuf};

use pontoon::{
    geometry::Shape,
    math::{Pose, Vector},
    model::{Dimension, Model},
    simulation::{Setup, Simulation},
    solid::{Dim, Role, SolidSpec},
};

/// Lattice points of spacing `dp` filling the box from `min` to `min + size`, cell centres.
pub fn lattice<const D: usize>(min: [f64; D], size: [f64; D], dp: f64) -> Vec<Vector<D>> {
    let n: [usize; D] = std::array::from_fn(|i| (size[i] / dp).round() as usize);
    (0..n.iter().product())
        .map(|mut index| {
            Vector::from_fn(|i, _| {
                let at = index % n[i];
                index /= n[i];
                min[i] + (at as f64 + 0.5) * dp
            })
        })
        .collect()
}

/// A fixed open tank with its inner lower corner at the origin.
pub fn tank<const D: usize>(size: [f64; D], dp: f64) -> SolidSpec<D> {
    let shape = Shape::Tank { size: Vector::from(size), thickness: 4.0 * dp };
    SolidSpec::fixed("tank", shape).friction(0.0)
}

/// A free homogeneous body of `density` (kg/m³).
pub fn float<const D: usize>(shape: Shape<D>, at: [f64; D], density: f64) -> SolidSpec<D> {
    SolidSpec::free("float", shape, density).at(at).friction(0.0)
}

/// A frictionless solid.
pub fn solid<const D: usize>(name: &str, shape: Shape<D>, pose: Pose<D>, role: Role<D>) -> SolidSpec<D> {
    let mut solid = SolidSpec::fixed(name, shape).at(pose).friction(0.0);
    solid.role = role;
    solid
}

/// A simulation of `water`, still below `level`, and `solids`.
pub fn simulation<const D: usize>(
    model: Model,
    water: Vec<Vector<D>>,
    level: f64,
    solids: Vec<SolidSpec<D>>,
) -> Simulation<D>
where
    Dim<D>: Dimension<D>,
{
    Simulation::new(Setup::new(model).water(water, level).solids(solids)).expect("a sound setup")
}

/// Momentum of the water, kg m/s.
pub fn water_momentum<const D: usize>(sim: &Simulation<D>) -> Vector<D> {
    sim.system().fluid().v.iter().fold(Vector::<D>::zeros(), |sum, v| sum + v) * sim.system().particle_mass()
}

/// A repeatable sequence of numbers in 0…1 (a linear congruence).
pub struct Dice(pub u64);

impl Dice {
    /// The next number.
    pub fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A point in the unit box.
    pub fn point<const D: usize>(&mut self) -> Vector<D> {
        Vector::from_fn(|_, _| self.roll())
    }
}

/// A folder for the files of one test, empty at first and gone with this.
pub struct Home(pub PathBuf);

impl Home {
    /// The folder of the test `name`, a name that no other test has.
    pub fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("pontoon-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    /// The same, with a `scene.toml` of that text in it.
    pub fn with(name: &str, scene: &str) -> Self {
        let home = Self::new(name);
        fs::write(home.0.join("scene.toml"), scene).unwrap();
        home
    }
}

impl Drop for Home {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
