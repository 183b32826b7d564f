//! What does not depend on where one stands, how one is turned or on a mirror, and what closed systems keep through collisions.

use std::path::Path;

use pontoon::{
    Result,
    geometry::Shape,
    math::{Bivector, Matrix, Vector},
    model::{Dimension, Model, PairLoopKind},
    scene::Scene,
    simulation::Simulation,
    solid::{Dim, Kinematics, Role, SolidSpec},
};

use crate::common;

/// A tank of still water with a float that is thrown into motion and a flap hinged to the tank; lengths in m.
struct Harbour<const D: usize> {
    dp: f64,
    /// Inner size of the tank; its lower corner is the origin.
    tank: [f64; D],
    depth: f64,
    /// Size, place and velocity (m/s) of the float.
    float: [[f64; D]; 3],
    /// Its spin, rad/s.
    spin: &'static [f64],
    /// Size and place of the flap, and its hinge.
    flap: [[f64; D]; 3],
    /// How far it is moved: whole dp, but not as binary numbers are.
    shift: [f64; D],
}

const POND: Harbour<2> = Harbour {
    dp: 0.02,
    tank: [0.8, 0.5],
    depth: 0.3,
    float: [[0.16, 0.08], [0.3, 0.3], [0.3, 0.1]],
    spin: &[1.0],
    flap: [[0.08, 0.16], [0.6, 0.2], [0.6, 0.12]],
    shift: [3.0, -7.0],
};

const BASIN: Harbour<3> = Harbour {
    dp: 0.04,
    tank: [0.64, 0.48, 0.4],
    depth: 0.24,
    float: [[0.16, 0.24, 0.16], [0.2, 0.2, 0.24], [0.3, -0.2, 0.1]],
    spin: &[1.0, 2.0, 0.5],
    flap: [[0.16, 0.16, 0.16], [0.48, 0.28, 0.16], [0.48, 0.28, 0.08]],
    shift: [3.2, -6.4, 1.6],
};

/// Another look at the same: moved, turned by a quarter from x to y, or mirrored in x.
#[derive(Clone, Copy, Debug, PartialEq)]
enum View {
    Plain,
    Moved,
    Turned,
    Mirrored,
}

impl View {
    fn matrix<const D: usize>(self) -> Matrix<D> {
        let mut matrix = Matrix::identity();
        match self {
            View::Turned => {
                (matrix[(0, 0)], matrix[(0, 1)]) = (0.0, -1.0);
                (matrix[(1, 0)], matrix[(1, 1)]) = (1.0, 0.0);
            }
            View::Mirrored => matrix[(0, 0)] = -1.0,
            View::Plain | View::Moved => {}
        }
        matrix
    }

    /// A spin as it is seen: an axial vector, which a mirror turns the other way round.
    fn spin<const D: usize>(self, spin: &[f64]) -> Vec<f64> {
        let sense = if self == View::Mirrored { -1.0 } else { 1.0 };
        match D {
            2 => vec![sense * spin[0]],
            _ => (self.matrix::<3>() * Vector::<3>::from_column_slice(spin) * sense).as_slice().to_vec(),
        }
    }
}

impl<const D: usize> Harbour<D>
where
    Dim<D>: Dimension<D>,
{
    fn place(&self, view: View, x: [f64; D]) -> Vector<D> {
        let shift = if view == View::Moved { self.shift } else { [0.0; D] };
        view.matrix() * Vector::from(x) + Vector::from(shift)
    }

    fn words(&self, view: View) -> String {
        let Self { dp, tank, depth, .. } = *self;
        let along = |v: [f64; D]| format!("{:?}", (view.matrix() * Vector::from(v)).as_slice());
        let turned = match (view == View::Turned, D) {
            (false, _) => "",
            (true, 2) => ", angle_deg = 90",
            (true, _) => ", turn_deg = [0, 0, 90]",
        };
        let at = |x: [f64; D]| {
            let place = self.place(view, x);
            let each = ["x", "y", "z"].iter().zip(place.iter()).map(|(axis, x)| format!("{axis} = {x:?}"));
            format!("at = {{ {}{turned} }}", each.collect::<Vec<_>>().join(", "))
        };
        let mut far = tank;
        far[D - 1] = depth;
        let ends = [self.place(view, [0.0; D]), self.place(view, far)];
        let mut corner = [0.0; D];
        if view == View::Mirrored {
            corner[0] = tank[0];
        }
        let mut down = [0.0; D];
        down[D - 1] = -9.81;
        // Scenes know still water under a level on their last axis alone; along another one the pressure is said.
        let aside = view == View::Turned && D == 2;
        let head = if aside { format!("pressure = \"9810*({depth} + x)\"") } else { String::new() };
        let mut axis = [0.0; D];
        axis[1] = 1.0;
        let axis = if D == 3 { format!("axis = {}", along(axis)) } else { String::new() };
        let spin = view.spin::<D>(self.spin);
        let spin = if D == 2 { format!("{:?}", spin[0]) } else { format!("{spin:?}") };
        let hinge = self.place(view, self.flap[2]);
        format!(
            "dimension = {D}\ndp = {dp}\nuntil = 0.3\ngravity = {}\nmodel.c0 = {}\n\
             [[water]]\nfill = {{ box = {{ min = {:?}, max = {:?} }} }}\n{head}\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = {tank:?} }} }}\n{}\n\
             [[solid]]\nname = \"float\"\nshape = {{ box = {{ size = {:?} }} }}\n{}\n\
             free = {{ density = 500, velocity = {}, spin = {} }}\n\
             [[solid]]\nname = \"flap\"\nshape = {{ box = {{ size = {:?} }} }}\n{}\nfree = {{ density = 700 }}\n\
             [[joint]]\nname = \"hinge\"\nkind = \"hinge\"\nbetween = [\"tank\", \"flap\"]\nat = {:?}\n{axis}\n",
            along(down),
            10.0 * (9.81 * depth).sqrt(),
            ends[0].inf(&ends[1]).as_slice(),
            ends[0].sup(&ends[1]).as_slice(),
            at(corner),
            self.float[0],
            at(self.float[1]),
            along(self.float[2]),
            spin,
            self.flap[0],
            at(self.flap[1]),
            hinge.as_slice(),
        )
    }

    /// Float and flap after 0.3 s.
    fn run(&self, view: View) -> Result<[Kinematics<D>; 2]> {
        let scene = Scene::parse(&self.words(view), Path::new(""), &[])?;
        let mut sim = Simulation::new(scene.build::<D>()?.setup)?;
        while sim.time() < 0.3 {
            sim.step_to(0.3)?;
        }
        Ok([1, 2].map(|i| sim.system().solids()[i].kinematics))
    }

    /// By how much places (m) and velocities (m/s; of a turn at 0.1 m) differ from what they are `plainly`.
    fn differs(&self, view: View, plainly: &[Kinematics<D>; 2]) -> Result<[f64; 2]> {
        let mut most = [0.0_f64; 2];
        for (a, b) in plainly.iter().zip(&self.run(view)?) {
            let spins = view.spin::<D>(&a.spin.axial()).into_iter().zip(b.spin.axial());
            let spin = spins.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let place = self.place(view, a.centre.into());
            most[0] = most[0].max((place - b.centre).norm());
            most[1] = most[1].max((view.matrix() * a.velocity - b.velocity).norm()).max(0.1 * spin);
        }
        Ok(most)
    }

    /// Holds it to 1e-6 m and 1e-5 m/s in the `views`: bodies that have gone some centimetres at some tenths of a metre a second.
    fn holds(&self, views: &[View]) -> Result<()> {
        let plainly = self.run(View::Plain)?;
        for &view in views {
            // What is the nearest of particles as near as one another hangs on the last bit of their places, and what a boundary particle
            // starts with hangs on it, in double precision too. Found: 6e-8 m in 2-D and 4e-7 m in 3-D at most.
            let [place, speed] = self.differs(view, &plainly)?;
            assert!(place < 1e-6 && speed < 1e-5, "{D}-D, {view:?}: {place:e} m, {speed:e} m/s");
        }
        Ok(())
    }
}

#[test]
fn a_harbour_moved_or_mirrored_goes_the_same_ways() -> Result<()> {
    POND.holds(&[View::Moved, View::Mirrored])
}

#[test]
fn a_harbour_in_space_moved_mirrored_or_turned_about_the_vertical_goes_the_same_ways() -> Result<()> {
    BASIN.holds(&[View::Moved, View::Mirrored, View::Turned])
}

#[test]
fn a_harbour_turned_with_its_gravity_goes_the_same_ways() -> Result<()> {
    // Boundary particles start with the pressure of the water beside them, carried on along the last axis alone, and settle within
    // 20 ms: the start is not quite the same. A hundredth of dp; found: 5e-6 m.
    let [place, _] = POND.differs(View::Turned, &POND.run(View::Plain)?)?;
    assert!(place < 0.01 * POND.dp, "{place:e} m");
    Ok(())
}

/// Momentum that water and two bodies lose while these collide in free space, over the sum of the sizes of the bodies' at the start.
fn lost<const D: usize>(sweep: PairLoopKind) -> f64
where
    Dim<D>: Dimension<D>,
{
    let dp = 0.04;
    let mut model = Model::water(D, dp, 0.3);
    (model.gravity, model.pair_loop, model.c0) = (vec![0.0; D], sweep, 34.0);
    let along = |x: f64, others: f64| Vector::<D>::from_fn(|i, _| if i == 0 { x } else { others });
    let (low, size) = (along(-8.0 * dp, -5.0 * dp), along(16.0 * dp, 10.0 * dp));
    let mut water = common::lattice(low.into(), size.into(), dp);
    // Cubes of 4 dp with half a dp between them, which is dry.
    let places = [along(-2.0 * dp, 0.0), along(2.5 * dp, 0.0)];
    water.retain(|r| places.iter().all(|at| (r - at).amax() > 2.01 * dp));
    let cube = Shape::Box { size: Vector::repeat(4.0 * dp) };
    let mut solids: Vec<SolidSpec<D>> =
        places.iter().map(|at| common::float(cube.clone(), (*at).into(), 900.0)).collect();
    solids[1].name = "second".into();
    solids.iter_mut().for_each(|solid| (solid.friction, solid.restitution) = (0.3, 0.6));
    let mut sim = common::simulation(model, water, -1.0, solids);
    let spin = |axial: [f64; 3]| Bivector::from_axial(&axial[..if D == 2 { 1 } else { 3 }]);
    sim.set_velocity(0, &along(3.0, 0.2), &spin([2.0, 1.0, 0.5]));
    sim.set_velocity(1, &along(-2.0, 0.0), &spin([-1.0, 1.0, 0.0]));
    sim.update_rates();
    let parts = |sim: &Simulation<D>| {
        [0, 1].map(|i| {
            let solid = &sim.system().solids()[i];
            let Role::Free(body) = &solid.spec.role else { panic!("a free body") };
            solid.kinematics.velocity * body.mass + sim.pending_impulse(i)
        })
    };
    let whole = |sim: &Simulation<D>| common::water_momentum(sim) + parts(sim).iter().sum::<Vector<D>>();
    let (start, scale) = (whole(&sim), parts(&sim).iter().map(|part| part.norm()).sum::<f64>());
    let mut met = 0;
    for _ in 0..150 {
        sim.step().expect("a sound run");
        met += sim.contacts().len();
    }
    assert!(met > 0, "they met");
    assert!(common::water_momentum(&sim).norm() > 0.01 * scale, "and gave the water some of it");
    (whole(&sim) - start).norm() / scale
}

#[test]
fn bodies_that_collide_under_water_in_free_space_and_their_water_keep_their_momentum() {
    // The project's bound; found: 3e-15.
    let off = lost::<3>(PairLoopKind::Reference);
    assert!(off < 1e-10, "{off:e}");
    // Forces of the fast sweep flip their signs bit for bit, but their sums are rounded to single precision: `stability.md`'s bound for
    // it, a hundredfold of the round-off found there. Here 3e-8 and 4e-9.
    let off = [lost::<2>(PairLoopKind::Fast), lost::<3>(PairLoopKind::Fast)];
    assert!(off[0].max(off[1]) < 1e-6, "{off:?}");
}
