//! Shared helpers of the specifications: lattices, solids, simulations, means, random numbers and folders.

use std::{
    fs,
    ops::Deref,
    path::{Path, PathBuf},
};

use pontoon::{
    Result,
    geometry::Shape,
    math::{Pose, Vector},
    model::Model,
    preflight::Preflight,
    run::{InspectOptions, inspect_scene},
    scene::Scene,
    simulation::{Dimension, Setup, Simulation},
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

/// A simulation of `water`, hydrostatic below `level`, and `solids`.
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

/// The simulation of the scene with this TOML text.
pub fn scene_simulation<const D: usize>(text: &str) -> Result<Simulation<D>>
where
    Dim<D>: Dimension<D>,
{
    Simulation::new(Scene::parse(text, Path::new(""), &[])?.build::<D>()?.setup)
}

/// The simulation of the scene `docs/measurements/NAME.toml` with these values set.
pub fn measurement<const D: usize>(name: &str, sets: &[(&str, &str)]) -> Result<Simulation<D>>
where
    Dim<D>: Dimension<D>,
{
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/measurements/{name}.toml"));
    let sets: Vec<_> = sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    Simulation::new(Scene::read(&scene, &sets)?.build::<D>()?.setup)
}

/// Makes `n` steps.
pub fn steps<const D: usize>(sim: &mut Simulation<D>, n: usize)
where
    Dim<D>: Dimension<D>,
{
    for _ in 0..n {
        sim.step().expect("a sound run");
    }
}

/// Runs until time `until` (s).
pub fn run_to<const D: usize>(sim: &mut Simulation<D>, until: f64) -> Result<()> {
    while sim.time() < until {
        sim.step_to(until)?;
    }
    Ok(())
}

/// Runs until time `until` (s) and returns the time means, from `from` (s) on, of the values that `sample` returns.
pub fn time_mean<const D: usize, const N: usize>(
    sim: &mut Simulation<D>,
    from: f64,
    until: f64,
    sample: impl Fn(&Simulation<D>) -> [f64; N],
) -> Result<[f64; N]>
where
    Dim<D>: Dimension<D>,
{
    let (mut sums, mut weight) = ([0.0; N], 0.0);
    while sim.time() < until {
        sim.step_to(until)?;
        if sim.time() > from {
            sums.iter_mut().zip(sample(sim)).for_each(|(sum, x)| *sum += x * sim.dt());
            weight += sim.dt();
        }
    }
    Ok(sums.map(|sum| sum / weight))
}

/// The result of `f` in a pool of `n` threads.
pub fn on_threads<T: Send>(n: usize, f: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("a thread pool").install(f)
}

/// Kinetic, potential and compression energy of the water, J (J/m in 2-D).
pub fn water_energy<const D: usize>(sim: &Simulation<D>) -> f64 {
    let (system, fluid) = (sim.system(), sim.system().fluid());
    let energy =
        |i: usize| 0.5 * fluid.v[i].norm_squared() + 9.81 * fluid.r[i][D - 1] + system.compression_energy(fluid.rho[i]);
    (0..fluid.len()).map(energy).sum::<f64>() * system.particle_mass()
}

/// Momentum of the water, kg m/s.
pub fn water_momentum<const D: usize>(sim: &Simulation<D>) -> Vector<D> {
    sim.system().fluid().v.iter().fold(Vector::<D>::zeros(), |sum, v| sum + v) * sim.system().particle_mass()
}

/// A reproducible sequence of numbers in 0…1 (a linear congruential generator).
pub struct Random(pub u64);

impl Random {
    /// The next number.
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A point in the unit box.
    pub fn point<const D: usize>(&mut self) -> Vector<D> {
        Vector::from_fn(|_, _| self.number())
    }
}

/// A folder for the files of one test, empty at first and removed with this value.
pub struct TestFolder(PathBuf);

impl TestFolder {
    /// The folder of the test `name`, which must be unique.
    pub fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("pontoon-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    /// The folder of the test `name` with a `scene.toml` of this text.
    pub fn with_scene(name: &str, scene: &str) -> Self {
        let folder = Self::new(name);
        fs::write(folder.join("scene.toml"), scene).unwrap();
        folder
    }
}

impl Deref for TestFolder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Drop for TestFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Returns the preflight report of a sound scene.
pub fn preflight_report(scene: &Scene) -> Preflight {
    let inspection = inspect_scene(scene, &InspectOptions::default()).expect("a sound scene");
    inspection.report().expect("a scene of a size that a test can run").preflight
}
