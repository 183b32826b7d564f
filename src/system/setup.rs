//! What a simulation starts from.

use super::{
    Current, Driving, OpenBoundary, SpongeLayer, TowedFrame, open_boundary,
    periodic::{self, Periodic},
    step_check::ParticleLimits,
};
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result},
    geometry::{Shape, WaterRegion, fill_around},
    math::{Bounds, Pose, Vector, in_dimension},
    model::Model,
    solid::{
        Constraints, ContactSpec, ForceSpec, InitialHold, JointSpec, MooringPointSpec, MooringSpec, Role, RopeSpec,
        SolidSpec, SpringSpec, TimeFunction,
    },
};

/// What a simulation starts from.
///
/// ```
/// use pontoon::prelude::*;
///
/// // A raft in a tank, 2 m long, of water 0.4 m deep at a spacing of 0.05 m.
/// let (dp, depth) = (0.05, 0.4);
/// let tank = SolidSpec::fixed("tank", Shape::Tank { size: [2.0, 0.8].into(), thickness: 4.0 * dp });
/// let raft = SolidSpec::free("raft", Shape::Box { size: [0.4, 0.2].into() }, 500.0).at([1.0, depth]);
/// let setup = Setup::<2>::new(Model::water(2, dp, depth)).solid(tank).solid(raft).fill_box([0.0, 0.0], [2.0, depth])?;
/// let simulation = Simulation::new(setup)?;
/// assert_eq!(simulation.system().solids().len(), 2);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Setup<const D: usize> {
    /// The model.
    pub model: Model,
    /// Components of gravity as functions of time, m/s², in place of the model's; empty if it is constant.
    pub gravity_law: Vec<TimeFunction>,
    /// Places of the water particles, m.
    pub water: Vec<Vector<D>>,
    /// Height of the still surface above each of them, m.
    pub surface_levels: Vec<f64>,
    /// Velocity of each of them, m/s; empty if all are at rest.
    pub velocity: Vec<Vector<D>>,
    /// Pressure of each particle beyond that of water at rest, Pa; empty if none is set.
    pub pressure: Vec<f64>,
    /// The solids.
    pub solids: Vec<SolidSpec<D>>,
    /// What ties them.
    pub constraints: Constraints<D>,
    /// Where particles may be; by default everything at the start, with its own largest extent around it.
    pub domain: Option<Bounds<D>>,
    /// Which sides are periodic.
    pub periodic: Periodic<D>,
    /// Coordinate of the symmetry plane normal to each axis, m. The program computes the water on one side: the side with all the
    /// water or, if both sides have water, the side of greater coordinates. Solids that a plane cuts are given whole.
    pub symmetry: [Option<f64>; D],
    /// The valid range of a water particle.
    pub limits: ParticleLimits,
    /// Where water loses its motion.
    pub sponge_layers: Vec<SpongeLayer<D>>,
    /// Where water enters and leaves. Water beyond a face is its buffer at the start: it is filled [`Setup::buffer_length`] deep.
    pub open_boundaries: Vec<OpenBoundary<D>>,
    /// What drives water and bodies beside gravity.
    pub driving: Driving,
}

impl<const D: usize> Setup<D> {
    /// Neither water nor solids.
    pub fn new(model: Model) -> Self {
        Self {
            model,
            gravity_law: Vec::new(),
            water: Vec::new(),
            surface_levels: Vec::new(),
            velocity: Vec::new(),
            pressure: Vec::new(),
            solids: Vec::new(),
            constraints: Constraints::default(),
            domain: None,
            periodic: [None; D],
            symmetry: [None; D],
            limits: ParticleLimits::default(),
            sponge_layers: Vec::new(),
            open_boundaries: Vec::new(),
            driving: Driving::default(),
        }
    }

    /// The same setup with gravity by these functions of time (m/s²), one along each axis. Water starts at rest under gravity of
    /// time 0.
    pub fn gravity_law<F: Into<TimeFunction>>(self, law: impl IntoIterator<Item = F>) -> Self {
        Self { gravity_law: law.into_iter().map(Into::into).collect(), ..self }
    }

    /// The same setup with more water particles at rest at `places` (m), below a still surface at the height `level` (m).
    pub fn water(mut self, places: impl IntoIterator<Item = Vector<D>>, level: f64) -> Self {
        self.water.extend(places);
        self.surface_levels.resize(self.water.len(), level);
        self
    }

    /// The same setup with more water at rest in the box from corner `min` to corner `max` (m), less the solids given
    /// so far. The still surface is the top of the box.
    ///
    /// # Errors
    /// As [`crate::geometry::fill()`].
    pub fn fill_box(self, min: impl Into<Vector<D>>, max: impl Into<Vector<D>>) -> Result<Self> {
        let (min, max) = (min.into(), max.into());
        let shape = Shape::Box { size: max - min };
        self.fill(&[WaterRegion { shape, pose: Pose::at(0.5 * (min + max)) }], max[D - 1])
    }

    /// The same setup with more water at rest in `regions`, less the solids given so far, below a still surface at the height `level`
    /// (m).
    ///
    /// # Errors
    /// As [`crate::geometry::fill()`].
    pub fn fill(self, regions: &[WaterRegion<D>], level: f64) -> Result<Self> {
        let filled =
            in_dimension((self, regions.to_vec()), |given| fill_2d(given, level), |given| fill_3d(given, level));
        filled.unwrap_or_else(|| Err(Error::new(ErrorKind::Usage, format!("water has 2 or 3 dimensions, not {D}"))))
    }

    fn with_filled(self, regions: &[WaterRegion<D>], level: f64) -> Result<Self> {
        let poses: Vec<Pose<D>> = self.solids.iter().map(|solid| solid.initial_kinematics().pose).collect();
        let rests = |solid: &SolidSpec<D>| !matches!(solid.role, Role::Free(_));
        let solids = self.solids.iter().zip(&poses).map(|(solid, pose)| (&solid.shape, pose, rests(solid)));
        let places = fill_around(regions, &solids.collect::<Vec<_>>(), self.model.dp)?.r;
        Ok(self.water(places, level))
    }

    /// The same setup with the velocity `field` (m/s) at the place (m) of each water particle given so far.
    pub fn velocity(mut self, field: impl Fn(&Vector<D>) -> Vector<D>) -> Self {
        self.velocity = self.water.iter().map(field).collect();
        self
    }

    /// The same setup with the pressure `field` (Pa), beyond that of water at rest, at the place (m) of each water particle given so far.
    pub fn pressure(mut self, field: impl Fn(&Vector<D>) -> f64) -> Self {
        self.pressure = self.water.iter().map(field).collect();
        self
    }

    /// The same setup with one more solid. Solids are numbered from 0 in the order in which they are added.
    pub fn solid(mut self, solid: SolidSpec<D>) -> Self {
        self.solids.push(solid);
        self
    }

    /// The same setup with more solids.
    pub fn solids(mut self, solids: impl IntoIterator<Item = SolidSpec<D>>) -> Self {
        self.solids.extend(solids);
        self
    }

    /// The same setup with one more joint.
    pub fn joint(mut self, joint: JointSpec<D>) -> Self {
        self.constraints.joints.push(joint);
        self
    }

    /// The same setup with one more spring or mooring line.
    pub fn spring(mut self, spring: SpringSpec<D>) -> Self {
        self.constraints.springs.push(spring);
        self
    }

    /// The same setup with one more rope.
    pub fn rope(mut self, rope: RopeSpec<D>) -> Self {
        self.constraints.ropes.push(rope);
        self
    }

    /// The same setup with one more point in which mooring lines meet.
    pub fn mooring_point(mut self, point: MooringPointSpec<D>) -> Self {
        self.constraints.mooring_points.push(point);
        self
    }

    /// The same setup with one more mooring line with mass.
    pub fn mooring(mut self, mooring: MooringSpec<D>) -> Self {
        self.constraints.moorings.push(mooring);
        self
    }

    /// The same setup with one more prescribed force.
    pub fn force(mut self, force: ForceSpec<D>) -> Self {
        self.constraints.forces.push(force);
        self
    }

    /// The same setup with contact properties of one more pair of solids.
    pub fn contact(mut self, contact: ContactSpec) -> Self {
        self.constraints.contacts.extend([contact]);
        self
    }

    /// The same setup with free solid number `solid` held at rest until the time `until` (s).
    pub fn hold(mut self, solid: usize, until: f64) -> Self {
        self.constraints.holds.push(InitialHold { solid, until });
        self
    }

    /// The same setup, whose particles may be between the corners `min` and `max` (m).
    pub fn domain(self, min: impl Into<Vector<D>>, max: impl Into<Vector<D>>) -> Self {
        Self { domain: Some(Bounds { min: min.into(), max: max.into() }), ..self }
    }

    /// The same setup, periodic along axis number `axis` from `min` to `max` (m).
    ///
    /// # Panics
    /// If `axis` is not less than the dimension.
    pub fn periodic(mut self, axis: usize, min: f64, max: f64) -> Self {
        self.periodic[axis] = Some([min, max]);
        self
    }

    /// The same setup with a symmetry plane normal to axis number `axis` at the coordinate `at` (m): see [`Setup::symmetry`].
    ///
    /// # Panics
    /// If `axis` is not less than the dimension.
    pub fn symmetry_plane(mut self, axis: usize, at: f64) -> Self {
        self.symmetry[axis] = Some(at);
        self
    }

    /// The same setup with this valid range of a water particle.
    pub fn limits(self, limits: ParticleLimits) -> Self {
        Self { limits, ..self }
    }

    /// The same setup with one more sponge layer.
    pub fn sponge_layer(mut self, layer: SpongeLayer<D>) -> Self {
        self.sponge_layers.push(layer);
        self
    }

    /// The same setup with one more open boundary.
    pub fn open_boundary(mut self, face: OpenBoundary<D>) -> Self {
        self.open_boundaries.push(face);
        self
    }

    /// The same setup with a current along a periodic axis, which a body force holds.
    pub fn current(mut self, current: Current) -> Self {
        self.driving.current = Some(current);
        self
    }

    /// The same setup in a frame that moves. Places and velocities are relative to it.
    pub fn towed(mut self, frame: TowedFrame) -> Self {
        self.driving.towed = Some(frame);
        self
    }

    /// Length (m) of the buffers beyond open boundaries. Walls beside a face reach as far beyond it.
    pub fn buffer_length(&self) -> f64 {
        open_boundary::buffer_length(&self.model)
    }

    /// Acceleration of gravity at the start, m/s².
    pub(crate) fn initial_gravity(&self) -> Vector<D> {
        match self.gravity_law.is_empty() {
            true => self.model.fluid_properties::<D>().gravity,
            false => gravity_at(&self.gravity_law, 0.0),
        }
    }

    /// Refuses a setup whose constants have no meaning.
    pub(crate) fn check(&self) -> Result<()> {
        let m = &self.model;
        let positive = [
            ("dp", m.dp),
            ("h", m.h),
            ("rho0", m.rho0),
            ("c0", m.c0),
            ("gamma", m.gamma),
            ("cfl", m.cfl),
            ("dt_max", m.dt_max),
        ];
        for (name, value) in positive {
            let finite = value.is_finite() || name == "dt_max";
            if !(value > 0.0 && finite) {
                return Err(Error::scene(format!("{name} must be a positive number, not {value}"))
                    .with_code(ErrorCode::OutOfRange));
            }
        }
        if m.support_radius() <= m.dp {
            return Err(Error::scene(format!("h must exceed dp/2 for particles to see one another, and is {} m", m.h)));
        }
        if m.gravity.len() != D || m.gravity.iter().any(|g| !g.is_finite()) {
            return Err(Error::scene(format!("gravity needs {D} finite components")));
        }
        let law = &self.gravity_law;
        if !(law.is_empty() || law.len() == D && law.iter().all(|law| law.value_and_rate(0.0).0.is_finite())) {
            return Err(Error::scene(format!("gravity by functions of time needs {D} components, finite at t = 0")));
        }
        if self.surface_levels.len() != self.water.len() {
            return Err(Error::scene("every water particle needs the level of its surface"));
        }
        let each = |n: usize| n == 0 || n == self.water.len();
        if !each(self.velocity.len()) || !each(self.pressure.len()) {
            return Err(Error::scene("velocities and pressures are given for every water particle or for none"));
        }
        if let Some(i) = self.water.iter().position(|r| r.iter().any(|x| !x.is_finite())) {
            return Err(Error::scene(format!("water particle {i} has no finite place")));
        }
        self.sponge_layers.iter().try_for_each(SpongeLayer::check)?;
        self.driving.check(&self.periodic)?;
        (0..self.open_boundaries.len()).try_for_each(|i| open_boundary::check(self, i, 0.0))?;
        self.constraints.check(&self.solids)?;
        let has_planes = self.symmetry.iter().any(Option::is_some);
        periodic::check(&self.periodic, has_planes, m, &self.solids, &self.constraints)
    }
}

#[inline(never)]
fn fill_2d((setup, regions): (Setup<2>, Vec<WaterRegion<2>>), level: f64) -> Result<Setup<2>> {
    setup.with_filled(&regions, level)
}

#[inline(never)]
fn fill_3d((setup, regions): (Setup<3>, Vec<WaterRegion<3>>), level: f64) -> Result<Setup<3>> {
    setup.with_filled(&regions, level)
}

/// The acceleration of gravity (m/s²) by the components of `law` at time `t` (s).
pub(super) fn gravity_at<const D: usize>(law: &[TimeFunction], t: f64) -> Vector<D> {
    Vector::from_fn(|i, _| law.get(i).map_or(0.0, |component| component.value_and_rate(t).0))
}
