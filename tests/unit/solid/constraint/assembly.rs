//! Constraints without water: forces, contact entries, holds, restart and refused constraints.

use std::f64::consts::PI;

use super::{Assembly, JointReading, LoadContext};
use crate::{
    error::Result,
    geometry::Shape,
    math::{Bivector, Pose, Vector, expression::Formula},
    solid::{
        Constraints, ContactSpec, Dim, Engine, ForceSpec, FreeBody, HasEngine, InitialHold, JointKind, JointSpec,
        Kinematics, Lifetime, LineEnd, Load, Motor, MotorCommand, PrescribedMotion, Role, RopeSpec, SolidSpec,
        SpringParameters, SpringSpec, TimeFunction,
    },
};

pub(in crate::solid) const G: f64 = 9.81;

/// Solids and their constraints without water.
pub(in crate::solid) struct DrySystem<const D: usize> {
    pub(in crate::solid) solids: Vec<SolidSpec<D>>,
    pub(in crate::solid) engine: Box<dyn Engine<D>>,
    pub(in crate::solid) assembly: Assembly<D>,
    pub(in crate::solid) t: f64,
    gravity: f64,
}

impl<const D: usize> DrySystem<D>
where
    Dim<D>: HasEngine<D>,
{
    pub(in crate::solid) fn new(solids: Vec<SolidSpec<D>>, links: Constraints<D>, gravity: f64) -> Self {
        Self::try_new(solids, links, gravity).unwrap()
    }

    fn try_new(solids: Vec<SolidSpec<D>>, links: Constraints<D>, gravity: f64) -> Result<Self> {
        let start: Vec<_> = solids.iter().map(SolidSpec::initial_kinematics).collect();
        let mut down = Vector::zeros();
        down[D - 1] = -gravity;
        let engine = Dim::<D>::engine(&solids, &start, &links, &down, 0.01)?;
        Ok(Self { assembly: Assembly::new(&links, start), solids, engine, t: 0.0, gravity })
    }

    pub(in crate::solid) fn now(&self) -> Vec<Kinematics<D>> {
        let one = |(i, solid): (usize, &SolidSpec<D>)| match &solid.role {
            Role::Fixed => solid.initial_kinematics(),
            Role::Driven(motion) => motion.kinematics(&solid.pose, self.t),
            Role::Free(_) => self.engine.kinematics(i),
        };
        self.solids.iter().enumerate().map(one).collect()
    }

    pub(in crate::solid) fn step(&mut self, dt: f64) {
        let before = self.now();
        let weight = |solid: &SolidSpec<D>| match &solid.role {
            Role::Free(body) => Load { force: point(0.0, -body.mass * self.gravity), torque: Bivector::zero() },
            _ => Load::zero(),
        };
        let loads: Vec<_> = self.solids.iter().map(weight).collect();
        let around = LoadContext { wet: vec![false; loads.len()], loads, sound_crossing_time: 0.0 };
        self.assembly.apply_loads(&mut *self.engine, &before, &around, [self.t, dt]);
        self.t += dt;
        let driven = |solid: &SolidSpec<D>| match &solid.role {
            Role::Driven(motion) => Some(motion.kinematics(&solid.pose, self.t)),
            _ => None,
        };
        let targets: Vec<_> = self.solids.iter().map(driven).collect();
        let idle = Load::zero();
        self.engine.step(dt, &vec![idle; targets.len()], &targets).unwrap();
        self.assembly.update_reactions(&*self.engine, [&before, &self.now()], dt, None);
        self.assembly.break_overloaded(&mut *self.engine, self.t);
    }

    pub(in crate::solid) fn run(&mut self, dt: f64, until: f64) {
        while self.t < until - 0.5 * dt {
            self.step(dt);
        }
    }

    /// The mean period of `sample` over `count` rising zero crossings.
    pub(in crate::solid) fn period(&mut self, dt: f64, count: usize, sample: impl Fn(&Self) -> f64) -> f64 {
        let (mut passages, mut before) = (Vec::new(), sample(self));
        while passages.len() <= count {
            assert!(self.t < 100.0, "no oscillation");
            self.step(dt);
            let now = sample(self);
            if before < 0.0 && now >= 0.0 {
                passages.push(self.t - dt * now / (now - before));
            }
            before = now;
        }
        (passages[count] - passages[0]) / count as f64
    }
}

pub(in crate::solid) fn point<const D: usize>(across: f64, up: f64) -> Vector<D> {
    Vector::from_fn(|i, _| {
        if i == 0 {
            across
        } else if i == D - 1 {
            up
        } else {
            0.0
        }
    })
}

/// The axis normal to the plane of x and up, with rotation from up to x. In 2-D it is zero, which is the same motion.
pub(in crate::solid) fn across<const D: usize>() -> Vector<D> {
    Vector::from_fn(|i, _| if D == 3 && i == 1 { -1.0 } else { 0.0 })
}

/// A homogeneous free bar of 0.1 m and `length` (m) around `at` with 1000 kg/m³, horizontal if `lies`, else vertical.
pub(in crate::solid) fn bar<const D: usize>(name: &str, length: f64, at: Vector<D>, lies: bool) -> SolidSpec<D> {
    let long = if lies { 0 } else { D - 1 };
    let shape = Shape::Box { size: Vector::from_fn(|i, _| if i == long { length } else { 0.1 }) };
    let role = Role::Free(FreeBody::from_density(&shape, 1000.0));
    SolidSpec {
        name: name.into(),
        shape,
        pose: Pose::at(at),
        role,
        friction: 0.5,
        restitution: 0.0,
        contact_skin: 0.0,
        dry: None,
        ballast: Vec::new(),
    }
}

pub(in crate::solid) fn body<const D: usize>(solid: &SolidSpec<D>) -> FreeBody<D> {
    match &solid.role {
        Role::Free(body) => *body,
        _ => panic!("not free"),
    }
}

/// Inertia about the axis across, through the centre of mass.
pub(in crate::solid) fn inertia<const D: usize>(solid: &SolidSpec<D>) -> f64 {
    if D == 2 { body(solid).inertia[(0, 0)] } else { body(solid).inertia[(1, 1)] }
}

pub(in crate::solid) fn hinge<const D: usize>(between: [Option<usize>; 2], at: Vector<D>) -> JointSpec<D> {
    JointSpec::new("hinge", JointKind::Hinge, between, at, across())
}

pub(in crate::solid) fn slider<const D: usize>(
    between: [Option<usize>; 2],
    at: Vector<D>,
    along: Vector<D>,
) -> JointSpec<D> {
    JointSpec::new("slider", JointKind::Slider, between, at, along)
}

pub(in crate::solid) fn joined<const D: usize>(joint: JointSpec<D>) -> Constraints<D> {
    Constraints { joints: vec![joint], ..Constraints::default() }
}

#[test]
fn a_body_frame_force_rotates_with_the_body_and_a_world_frame_force_does_not() {
    let run = |turns: bool, at: Option<Vector<2>>| {
        let solids = vec![bar::<2>("boat", 0.4, point(0.0, 0.0), true)];
        let force = vec![TimeFunction::constant(12.0), TimeFunction::constant(0.0)];
        let thrust = ForceSpec {
            name: "thrust".into(),
            solid: 0,
            at,
            force,
            torque: vec![],
            rotates_with_solid: turns,
            lifetime: Lifetime::default(),
        };
        let mut air = DrySystem::new(solids, Constraints { forces: vec![thrust], ..Constraints::default() }, 0.0);
        air.engine.set_velocity(0, &Vector::zeros(), &Bivector::from_axial(&[PI]));
        air.run(1e-4, 1.0);
        (air.now()[0], body(&air.solids[0]), inertia(&air.solids[0]))
    };
    let (wind, boat, inertia) = run(false, None);
    assert!((wind.velocity - Vector::from([12.0 / boat.mass, 0.0])).norm() < 1e-12);
    // Turned by half a turn in 1 s: ∫ (cos πt, sin πt) dt = (0, 2/π).
    let (thrust, ..) = run(true, None);
    assert!((thrust.velocity - Vector::from([0.0, 12.0 / boat.mass * 2.0 / PI])).norm() < 1e-4, "{thrust:?}");
    // An eccentric force that rotates with the body causes a constant torque.
    let (beside, ..) = run(true, Some(Vector::from([0.0, 0.05])));
    assert!((beside.spin.axial()[0] - PI + 12.0 * 0.05 / inertia).abs() < 1e-9, "{beside:?}");
}

/// A thruster at the stern of a boat that starts turned by 90° pushes along the boat, which is along y, and not along x.
#[test]
fn a_body_frame_force_is_along_the_axes_of_a_body_that_starts_turned() {
    let boat = bar::<2>("boat", 0.4, point(0.0, 0.0), true).at(Pose::rotated(Vector::zeros(), &[0.5 * PI]));
    let thrust = ForceSpec::<2>::new("thrust", 0).force([12.0, 0.0]).rotating_with_solid();
    let (mass, links) =
        (boat.initial_body().unwrap().mass, Constraints { forces: vec![thrust], ..Constraints::default() });
    let mut air = DrySystem::new(vec![boat], links, 0.0);
    air.run(1e-3, 1.0);
    let velocity = air.now()[0].velocity;
    assert!((velocity - Vector::from([0.0, 12.0 / mass])).norm() < 1e-9, "{velocity:?}");
}

/// Speed (m/s) after 1 s of a box of friction 0.5 on a plane of friction 0.5 with a slope of 20 degrees.
fn slides(contact: Option<ContactSpec>) -> f64 {
    let slope = 20f64.to_radians();
    let tilt = |x: f64, y: f64| Pose {
        position: Pose::rotated(Vector::zeros(), &[slope]).point(&[x, y].into()),
        ..Pose::rotated(Vector::zeros(), &[slope])
    };
    let plane =
        SolidSpec { pose: tilt(0.0, -0.05), role: Role::Fixed, ..bar::<2>("plane", 8.0, Vector::zeros(), true) };
    let stone = SolidSpec { pose: tilt(0.0, 0.05), ..bar("stone", 0.2, Vector::zeros(), true) };
    let links = Constraints { contacts: contact.into_iter().collect(), ..Constraints::default() };
    let mut air = DrySystem::new(vec![plane, stone], links, G);
    air.run(1e-4, 1.0);
    air.now()[1].velocity.norm()
}

#[test]
fn the_friction_of_a_contact_entry_determines_sticking_and_sliding() {
    let pair =
        |friction: f64| ContactSpec { between: [1, 0], can_touch: true, friction: Some(friction), restitution: None };
    let (limit, slope) = (20f64.to_radians().tan(), 20f64.to_radians());
    assert!(slides(None) < 1e-6, "tan 20° is below the mean of both frictions, 0.5");
    assert!(slides(Some(pair(1.02 * limit))) < 1e-3, "sticks");
    // Just above, and without friction: v = g t (sin − μ cos).
    for friction in [0.98 * limit, 0.5 * limit, 0.0] {
        let exact = G * (slope.sin() - friction * slope.cos());
        let found = slides(Some(pair(friction)));
        assert!((found - exact).abs() < 1e-2 * exact + 1e-3, "{friction}: {found}, exact {exact}");
    }
    let apart = ContactSpec { can_touch: false, ..pair(0.0) };
    assert!((slides(Some(apart)) / G - 1.0).abs() < 1e-9, "falls through");
}

#[test]
fn a_held_body_is_at_rest_until_its_release() {
    let solids = vec![bar::<2>("stone", 0.2, point(0.0, 0.0), true)];
    let mut air = DrySystem::new(
        solids,
        Constraints { holds: vec![InitialHold { solid: 0, until: 0.5 }], ..Constraints::default() },
        G,
    );
    air.engine.push(0, &Vector::from([50.0, 0.0]), &Vector::from([0.0, 0.3]));
    air.run(1e-3, 0.4999);
    assert_eq!((air.now()[0].velocity, air.now()[0].centre), (Vector::zeros(), Vector::zeros()));
    assert!((air.assembly.next_event(0.4999) - 1e-4).abs() < 1e-12, "no step passes the release");
    air.run(1e-3, 1.5);
    assert!((air.now()[0].velocity - Vector::from([0.0, -G])).norm() < 1e-2, "{:?}", air.now()[0]);
}

fn restores<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let make = || {
        let mut solids: Vec<SolidSpec<D>> =
            (0..4).map(|i| bar(&format!("link{i}"), 0.3, point(0.15 + 0.3 * f64::from(i), 0.0), true)).collect();
        let motion =
            PrescribedMotion::slide(point(0.0, 1.0), TimeFunction::Formula(Formula::parse("0.05*sin(3*t)").unwrap()));
        solids.push(SolidSpec { role: Role::Driven(motion), ..bar("cart", 0.3, point(1.35, 0.0), true) });
        let mut joints: Vec<_> =
            (0..4).map(|i| hinge([Some(i), Some(i + 1)], point(0.3 * (i + 1) as f64, 0.0))).collect();
        joints[1].motor = Some(Motor {
            force: TimeFunction::Formula(Formula::parse("sin(5*t)").unwrap()),
            ..Motor::default().damping(3.0)
        });
        joints[2].limits = Some([-0.3, 0.3]);
        for (i, joint) in joints.iter_mut().enumerate() {
            joint.name = format!("hinge{i}");
        }
        let line = |a: Option<usize>, x: f64, y: f64| {
            [LineEnd { solid: Some(0), at: point(0.1, 0.0) }, LineEnd { solid: a, at: point(x, y) }]
        };
        let spring = SpringSpec {
            name: "spring".into(),
            ends: line(None, 0.1, 1.0),
            stiffness: 200.0,
            damping: 5.0,
            rest_length: None,
            tension_only: true,
            lifetime: Lifetime::default(),
        };
        let rope = RopeSpec {
            name: "rope".into(),
            ends: line(None, 0.1, 0.3),
            max_length: None,
            lifetime: Lifetime::default(),
        };
        DrySystem::new(
            solids,
            Constraints { joints, springs: vec![spring], ropes: vec![rope], ..Constraints::default() },
            G,
        )
    };
    let mut whole = make();
    whole.run(5e-4, 0.3);
    let drive =
        MotorCommand { force: 1.0, position: 0.1, velocity: 0.0, stiffness: 10.0, damping: 1.0, max_force: 5.0 };
    whole.assembly.set_motor(0, Some(drive));
    *whole.assembly.spring_parameters(0) = SpringParameters { stiffness: 300.0, damping: 1.0, rest_length: 0.9 };
    whole.run(5e-4, 0.4);
    let (saved, state, t) = (whole.engine.save().unwrap(), whole.assembly.save(), whole.t);
    let mut other = make();
    other.engine.restore(&saved).unwrap();
    assert!(other.assembly.matches(&state));
    other.assembly.restore(state);
    other.t = t;
    whole.run(5e-4, 0.8);
    other.run(5e-4, 0.8);
    assert_eq!(whole.now(), other.now());
    let readings = |air: &DrySystem<D>| (0..4).map(|i| air.assembly.joint_reading(i)).collect::<Vec<JointReading<D>>>();
    assert_eq!(readings(&whole), readings(&other));
    assert_eq!(whole.engine.save().unwrap(), other.engine.save().unwrap());
    assert!(readings(&whole)[1].absorbed_energy != 0.0 && whole.assembly.rope_reading(0).tension > 0.0);
    // No hinge of the chain opens by more than 10 µm.
    for i in 0..4 {
        let ends = whole.assembly.joints[i].end_kinematics(&whole.now());
        let gap = ends[0].pose.point(&point(0.15, 0.0)) - ends[1].pose.point(&point(-0.15, 0.0));
        assert!(gap.norm() < 1e-5, "{D}-D, hinge {i}: {}", gap.norm());
    }
    // Given back to no motor, hinge 0 has no force of one, and takes no more energy.
    let taken = readings(&whole)[0].absorbed_energy;
    assert!(taken != 0.0 && readings(&whole)[0].motor_force != 0.0);
    whole.assembly.set_motor(0, None);
    whole.run(5e-4, 0.85);
    assert_eq!((readings(&whole)[0].motor_force, readings(&whole)[0].absorbed_energy), (0.0, taken));
}

#[test]
fn restored_constraints_reach_the_same_bits() {
    restores::<2>();
    restores::<3>();
}

#[test]
fn invalid_constraints_are_refused_with_the_reason() {
    let solids = || {
        let fixed = SolidSpec { role: Role::Fixed, ..bar::<2>("wall", 0.2, point(0.0, 1.0), true) };
        vec![bar("box", 0.2, point(0.0, 0.0), true), fixed]
    };
    let message = |links: Constraints<2>| DrySystem::try_new(solids(), links, G).map(|_| ()).unwrap_err().to_string();
    let joint = |joint: JointSpec<2>| message(joined(joint));
    let at = Vector::zeros();
    assert!(joint(hinge([None, Some(1)], at)).contains("\"wall\" is not free"));
    assert!(joint(hinge([Some(0), Some(0)], at)).contains("to itself"));
    assert!(joint(hinge([None, Some(7)], at)).contains("not there"));
    assert!(joint(slider([None, Some(0)], at, Vector::zeros())).contains("has no axis"));
    assert!(joint(hinge([None, Some(0)], at).limits(0.1, 0.5)).contains("has limits 0.1 to 0.5"));
    assert!(
        joint(JointSpec { kind: JointKind::Fixed, ..hinge([None, Some(0)], at).limits(-0.1, 0.5) })
            .contains("no coordinate")
    );
    let twice =
        Constraints { joints: vec![hinge([None, Some(0)], at), hinge([None, Some(0)], at)], ..Constraints::default() };
    assert!(message(twice).contains("sits where joint \"hinge\""));
    let ends = [LineEnd { solid: Some(0), at }, LineEnd { solid: None, at: point(0.0, 1.0) }];
    let spring = |stiffness: f64, damping: f64| {
        let spring = SpringSpec {
            name: "s".into(),
            ends,
            stiffness,
            damping,
            rest_length: None,
            tension_only: false,
            lifetime: Lifetime::default(),
        };
        message(Constraints { springs: vec![spring], ..Constraints::default() })
    };
    assert!(spring(-1.0, 0.0).contains("stiffness of -1") && spring(1.0, -2.0).contains("damping of -2"));
    assert!(spring(0.0, 0.0).contains("neither stiff nor damped"));
    let rope = RopeSpec { name: "r".into(), ends, max_length: Some(0.9), lifetime: Lifetime::default() };
    assert!(message(Constraints { ropes: vec![rope], ..Constraints::default() }).contains("start 1 m apart"));
}
