//! Wind on the dry part of free solids:  F = ½ ρ C_d A |U − V| (U − V)  at the centroid of the area A that is above the still
//! water and projected along U − V, with V the velocity of the centre of mass @faltinsen1990. Parts in the lee of others do not count.

use crate::{
    geometry::{Shape, Silhouette},
    math::{Bivector, Vector},
    solid::{Kinematics, Lifetime, Load, TimeFunction},
};

/// Density of air, kg/m³.
pub(crate) const AIR_DENSITY: f64 = 1.225;

/// A wind on free solids.
///
/// ```
/// use pontoon::{geometry::Shape, solid::WindSpec};
///
/// // 10 m/s along x on solid number 1, a box, over water at the level 0.4 m.
/// let wind = WindSpec::<2>::new([10.0, 0.0], 0.4).drag(1.2).on(1, &Shape::Box { size: [0.4, 0.2].into() });
/// assert_eq!(wind.drag, 1.2);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct WindSpec<const D: usize> {
    /// Components of its velocity, m/s.
    pub velocity: Vec<TimeFunction>,
    /// Height of the still water, m, for the solids that are added; −∞ without water.
    pub level: f64,
    /// Drag coefficient C_d, –.
    pub drag: f64,
    /// Density of the air, kg/m³.
    pub density: f64,
    pub(crate) targets: Vec<WindTarget<D>>,
}

/// A solid in the wind.
#[derive(Clone, Debug)]
pub(crate) struct WindTarget<const D: usize> {
    pub(crate) solid: usize,
    silhouette: Silhouette<D>,
    /// Height of the still water at its place, m; −∞ without water.
    level: f64,
    pub(crate) lifetime: Lifetime,
}

impl<const D: usize> WindSpec<D> {
    /// A wind of this velocity (m/s), one component along each axis, over still water at the height `level` (m), with the drag
    /// coefficient 1, on no solid.
    pub fn new<F: Into<TimeFunction>>(velocity: impl IntoIterator<Item = F>, level: f64) -> Self {
        let velocity = velocity.into_iter().map(Into::into).collect();
        Self { velocity, level, drag: 1.0, density: AIR_DENSITY, targets: Vec::new() }
    }

    /// The same wind with this drag coefficient (–).
    pub fn drag(self, drag: f64) -> Self {
        Self { drag, ..self }
    }

    /// The same wind, on free solid number `solid` of this `shape` too.
    pub fn on(self, solid: usize, shape: &Shape<D>) -> Self {
        self.during(solid, shape, Lifetime::default())
    }

    /// The same wind, on a solid during a lifetime.
    pub(crate) fn during(mut self, solid: usize, shape: &Shape<D>, lifetime: Lifetime) -> Self {
        self.targets.push(WindTarget { solid, silhouette: Silhouette::new(shape), level: self.level, lifetime });
        self
    }

    /// The load about its centre on each solid at time `t` (s), where they are `now`.
    pub(super) fn loads_at(&self, now: &[Kinematics<D>], t: f64) -> impl Iterator<Item = (usize, Load<D>)> {
        let velocity: Vector<D> =
            Vector::from_fn(|i, _| self.velocity.get(i).map_or(0.0, |component| component.value_and_rate(t).0));
        self.targets.iter().filter(move |target| target.lifetime.contains(t)).map(move |target| {
            let now = &now[target.solid];
            let relative = velocity - now.velocity;
            let speed = relative.norm();
            if speed == 0.0 {
                return (target.solid, Load::zero());
            }
            let (area, at) = target.silhouette.projected_area(&now.pose, target.level, &(relative / speed));
            let force = relative * (0.5 * self.density * self.drag * area * speed);
            (target.solid, Load { force, torque: Bivector::torque(&(at - now.centre), &force) })
        })
    }
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../tests/unit/solid/wind.rs"]
mod tests;
