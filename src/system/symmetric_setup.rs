//! Set-up with symmetry planes: which side is computed, what contradicts the symmetry, and the locks of the bodies on a plane.

mod water;

use super::{
    Setup,
    setup::gravity_at,
    symmetry::{SymmetryPlane, SymmetryPlanes, TOLERANCE},
};
use crate::{
    error::{Error, ErrorCode, Result},
    geometry::world_bounds,
    math::{Bounds, Vector},
    solid::{ForceSpec, Kinematics, LineEnd, Role, SolidSpec, TimeFunction},
};

/// Largest difference between the depths of a boundary particle and of its image below the faces of their solid, dp.
const SHAPE_TOLERANCE: f64 = 0.05;

/// Times (s) at which laws are looked at.
fn times() -> impl Iterator<Item = f64> {
    (0..=400).map(|k| 0.17 * f64::from(k))
}

/// A plane with its axis, for messages.
#[derive(Clone, Copy)]
struct Named {
    axis: usize,
    plane: SymmetryPlane,
}

impl Named {
    /// The name of its axis.
    fn name(&self) -> &'static str {
        ["x", "y", "z"][self.axis]
    }

    /// As in "the symmetry plane x = 0.5".
    fn title(&self) -> String {
        format!("the symmetry plane {} = {}", self.name(), self.plane.at)
    }

    /// Distance (m) of `x` (m) from the plane, positive on the computed side.
    fn depth<const D: usize>(&self, x: &Vector<D>) -> f64 {
        self.plane.depth(x[self.axis])
    }

    /// The mirror image of `x` (m).
    fn image<const D: usize>(&self, x: &Vector<D>) -> Vector<D> {
        let mut image = *x;
        image[self.axis] = 2.0 * self.plane.at - x[self.axis];
        image
    }

    /// The least and the greatest depth (m) of a box.
    fn depths<const D: usize>(&self, bounds: &Bounds<D>) -> [f64; 2] {
        let ends = [self.depth(&bounds.min), self.depth(&bounds.max)];
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    }
}

impl<const D: usize> Setup<D> {
    /// The symmetry planes, each with the side that is computed.
    pub(crate) fn symmetry_planes(&self) -> SymmetryPlanes<D> {
        let plane = |axis: usize| {
            let at = self.symmetry[axis]?;
            let is_upper = self.water.iter().any(|r| r[axis] > at) || self.water.is_empty();
            Some(SymmetryPlane { at, is_upper })
        };
        SymmetryPlanes(std::array::from_fn(plane))
    }

    /// Leaves the water on the computed side of the symmetry planes only, and locks the bodies that a plane cuts to the motions that
    /// keep the symmetry. A second call changes nothing.
    ///
    /// # Errors
    /// `Scene` if something contradicts the symmetry: says what, and the remedy.
    pub(crate) fn apply_symmetry(&mut self) -> Result<()> {
        let planes = self.symmetry_planes();
        for (axis, plane) in planes.each() {
            let plane = Named { axis, plane };
            self.check_plane(&plane)?;
            for i in 0..self.solids.len() {
                self.check_solid(i, &plane)?;
            }
            self.check_ties(&plane)?;
            self.cut_water(&plane)?;
            self.lock_bodies(&plane);
        }
        if planes.any() && self.periodic.iter().any(Option::is_some) {
            return self.check_periodic();
        }
        Ok(())
    }

    /// Refuses a plane that is nowhere, on a periodic axis, or across gravity.
    fn check_plane(&self, plane: &Named) -> Result<()> {
        let (axis, name) = (plane.axis, plane.name());
        if !plane.plane.at.is_finite() {
            return Err(Error::scene(format!("a symmetry plane at {name} = {} m", plane.plane.at))
                .with_code(ErrorCode::OutOfRange)
                .help("give a coordinate, in metres"));
        }
        if self.periodic[axis].is_some() {
            let what = format!("{name} is periodic and has a symmetry plane");
            return Err(Error::scene(what)
                .with_code(ErrorCode::ConflictingKeys)
                .help(format!("leave  periodic.{name}  or  symmetry.{name}  out")));
        }
        let gravity = |t: f64| match self.gravity_law.is_empty() {
            true => self.model.gravity[axis],
            false => gravity_at::<D>(&self.gravity_law, t)[axis],
        };
        if let Some(t) = times().find(|&t| gravity(t) != 0.0) {
            let what =
                format!("gravity has a component of {} m/s² along {name}, normal to {}", gravity(t), plane.title());
            return Err(Error::scene(what).help("gravity must lie in the plane: turn it, or compute both sides"));
        }
        if self.driving.towed.as_ref().is_some_and(|frame| frame.axis == axis) {
            let what = format!("the frame is towed along {name}, normal to {}", plane.title());
            return Err(Error::scene(what)
                .with_code(ErrorCode::ConflictingKeys)
                .help("tow along the plane, or compute both sides"));
        }
        Ok(())
    }

    /// Whether the plane cuts the solid.
    fn is_cut(&self, solid: &SolidSpec<D>, plane: &Named) -> bool {
        let bounds = world_bounds(&solid.shape, &solid.initial_kinematics().pose);
        plane.depths(&bounds)[0] < -TOLERANCE * self.model.dp
    }

    /// Refuses solid number `i` if it lies beyond the plane, ends at it, or is cut by it and not symmetric.
    fn check_solid(&self, i: usize, plane: &Named) -> Result<()> {
        let (solid, dp) = (&self.solids[i], self.model.dp);
        let pose = solid.initial_kinematics().pose;
        let [least, most] = plane.depths(&world_bounds(&solid.shape, &pose));
        let (name, title) = (&solid.name, plane.title());
        if most <= TOLERANCE * dp {
            return Err(Error::scene(format!("solid {name:?} lies beyond {title}, where nothing is computed"))
                .help("leave it out: the mirror images of the solids on the side with the water stand there"));
        }
        let width = self.model.support_radius() + self.model.boundary_layers() as f64 * dp;
        if least >= 0.5 * dp {
            return Ok(());
        }
        if least > -TOLERANCE * dp {
            let what = format!("solid {name:?} ends at {title}, {least:.2e} m before it");
            let help = match solid.role {
                Role::Free(_) => {
                    "give the whole body, with its middle on the plane; of a body of its own the face lies \
                                  dp/2 or more before the plane"
                        .into()
                }
                _ => format!(
                    "let it reach {width:.4} m or more beyond the plane, where its mirror image stands; or let it end dp/2 \
                     or more before the plane"
                ),
            };
            return Err(Error::scene(what).help(help));
        }
        self.check_shape(solid, plane, width)?;
        self.check_motion(solid, plane)
    }

    /// Refuses a solid that `plane` cuts if its shape is not symmetric. The whole shape of a free solid counts, and of any other
    /// solid the part within `width` (m) of the plane.
    fn check_shape(&self, solid: &SolidSpec<D>, plane: &Named, width: f64) -> Result<()> {
        let (pose, dp) = (solid.initial_kinematics().pose, self.model.dp);
        let planes = SymmetryPlanes::<D>(std::array::from_fn(|axis| (axis == plane.axis).then_some(plane.plane)));
        let is_free = matches!(solid.role, Role::Free(_));
        for point in solid.shape.boundary_points(dp, self.model.boundary_layers()) {
            let x = pose.point(&point.r);
            let depth = plane.depth(&x);
            if depth < 0.0 || !(is_free || depth < self.model.support_radius()) {
                continue;
            }
            let image = pose.local(&planes.mirrored(1 << plane.axis, &x));
            let [own, other] = [&point.r, &image].map(|r| solid.shape.signed_distance(r));
            if (own - other).abs() > SHAPE_TOLERANCE * dp {
                let place: Vec<f64> = x.iter().map(|x| (x * 1e6).round() / 1e6).collect();
                let what = format!(
                    "solid {:?} is not symmetric about {}: {place:?} lies {:.4} m below its faces, and the mirror image {:.4} m",
                    solid.name,
                    plane.title(),
                    -own,
                    -other
                );
                return Err(Error::scene(what).help(match is_free {
                    true => "place its middle on the plane, with its own plane of symmetry there".into(),
                    false => format!("let it reach {width:.4} m or more beyond the plane, unchanged"),
                }));
            }
        }
        Ok(())
    }

    /// Refuses motions of a solid that `plane` cuts which lead out of the symmetry.
    fn check_motion(&self, solid: &SolidSpec<D>, plane: &Named) -> Result<()> {
        let contradicts = |now: &Kinematics<D>| {
            let turns = now.spin.axial().into_iter().enumerate();
            let turns = turns.filter(|(i, _)| D == 2 || *i != plane.axis).map(|(_, turn)| turn);
            now.velocity[plane.axis] != 0.0 || turns.fold(0.0, |most: f64, turn| most.max(turn.abs())) > 1e-12
        };
        let (title, name) = (plane.title(), &solid.name);
        let allowed = match D {
            2 => "it may move along the plane and not turn",
            _ => "it may move along the plane and turn about its normal",
        };
        match &solid.role {
            Role::Fixed => Ok(()),
            Role::Driven(motion) => match times().find(|&t| contradicts(&motion.kinematics(&solid.pose, t))) {
                Some(t) => Err(Error::scene(format!(
                    "solid {name:?}, which {title} cuts, leaves the symmetry at t = {t:.2} s"
                ))
                .help(format!("{allowed}; or compute both sides"))),
                None => Ok(()),
            },
            Role::Free(_) => {
                let start = solid.initial_kinematics();
                let off = plane.depth(&start.centre);
                if off.abs() > 0.01 * self.model.dp {
                    return Err(Error::scene(format!("the centre of mass of {name:?} lies {off:.2e} m off {title}"))
                        .help(
                            "a body that the plane cuts has its centre of mass on it: correct its place or its centre",
                        ));
                }
                match contradicts(&start) {
                    true => Err(Error::scene(format!(
                        "{name:?}, which {title} cuts, starts with a motion out of the symmetry"
                    ))
                    .help(allowed)),
                    false => Ok(()),
                }
            }
        }
    }

    /// Refuses forces, contacts and constraints that contradict the symmetry.
    fn check_ties(&self, plane: &Named) -> Result<()> {
        let (title, axis) = (plane.title(), plane.axis);
        let is_free = |i: usize| matches!(self.solids[i].role, Role::Free(_));
        let cut: Vec<bool> = self.solids.iter().map(|solid| self.is_cut(solid, plane)).collect();
        let acts =
            |law: &[TimeFunction]| law.get(axis).is_some_and(|law| times().any(|t| law.value_and_rate(t).0 != 0.0));
        for force in &self.constraints.forces {
            if cut[force.solid] && acts(&force.force) {
                let what = format!("force {:?} pushes {:?} out of {title}", force.name, self.solids[force.solid].name);
                return Err(Error::scene(what).help("leave out its component along the normal of the plane"));
            }
        }
        for wind in &self.constraints.winds {
            if let Some(target) = wind.targets.iter().find(|target| cut[target.solid] && acts(&wind.velocity)) {
                let what = format!("the wind pushes {:?} out of {title}", self.solids[target.solid].name);
                return Err(Error::scene(what).help("let the wind blow along the plane, or compute both sides"));
            }
        }
        if let Some(line) = self.constraints.moorings.iter().find(|line| line.acts_on_water) {
            let what =
                format!("mooring {:?} acts on the water, and {title} mirrors the water, but not the line", line.name);
            return Err(Error::scene(what).help("write  acts_on_water = false, or compute both sides of the plane"));
        }
        self.check_lines(plane, &cut)?;
        self.check_moments(plane, &cut)?;
        let links = self.constraints.joints.iter().map(|joint| (&joint.name, joint.between));
        let springs = self.constraints.springs.iter().map(|spring| (&spring.name, spring.ends.map(|end| end.solid)));
        let ropes = self.constraints.ropes.iter().map(|rope| (&rope.name, rope.ends.map(|end| end.solid)));
        for (name, between) in links.chain(springs).chain(ropes) {
            let [Some(a), Some(b)] = between else { continue };
            if cut[a] != cut[b] && (is_free(a) && cut[a] || is_free(b) && cut[b]) {
                let what = format!(
                    "{name:?} ties {:?} and {:?}, of which {title} cuts one: its mirror image is missing",
                    self.solids[a].name, self.solids[b].name
                );
                return Err(Error::scene(what).help(
                    "tie a body that the plane cuts to others that it cuts, or to points of the world on both sides",
                ));
            }
        }
        for i in (0..cut.len()).filter(|&i| cut[i] && is_free(i)) {
            if let Some(j) = (0..cut.len()).find(|&j| !cut[j] && self.constraints.can_touch(i, j)) {
                let [name, other] = [i, j].map(|k| &self.solids[k].name);
                let what = format!(
                    "{name:?}, which {title} cuts, may touch {other:?}, whose mirror image does not push it from the other side"
                );
                let help = format!("exclude it:  [[contact]]  between = [{name:?}, {other:?}]  touch = false");
                return Err(Error::scene(what).help(help));
            }
        }
        Ok(())
    }

    /// Refuses a line that pulls a free body on the plane to one side, unless there is a mirror image of the line.
    fn check_lines(&self, plane: &Named, cut: &[bool]) -> Result<()> {
        let springs = self.constraints.springs.iter().map(|s| {
            let numbers =
                vec![s.stiffness, s.damping, s.rest_length.unwrap_or(-1.0), f64::from(u8::from(s.tension_only))];
            ("spring", &s.name, s.ends, numbers, s.lifetime)
        });
        let ropes = self
            .constraints
            .ropes
            .iter()
            .map(|r| ("rope", &r.name, r.ends, vec![r.max_length.unwrap_or(-1.0)], r.lifetime));
        let moorings = self.constraints.moorings.iter().map(|m| {
            (
                "mooring",
                &m.name,
                m.ends,
                vec![m.length, m.line.diameter, m.line.mass_per_length, m.line.stiffness],
                m.lifetime,
            )
        });
        let lines: Vec<_> = springs.chain(ropes).chain(moorings).collect();
        let is_held = |end: &LineEnd<D>| {
            end.solid.is_some_and(|solid| cut[solid] && matches!(self.solids[solid].role, Role::Free(_)))
        };
        // Lengths between mirrored points differ by round-off.
        let is_alike = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-9 * b.abs());
        for (kind, name, ends, numbers, lifetime) in &lines {
            let on_plane = ends.iter().all(|end| self.is_on(plane, &end.at));
            if on_plane || !ends.iter().any(is_held) {
                continue;
            }
            let images = ends.map(|end| LineEnd { at: plane.image(&end.at), ..end });
            let is_image = |other: &[LineEnd<D>; 2]| {
                let meets = |(a, b): (&LineEnd<D>, &LineEnd<D>)| {
                    a.solid == b.solid && (a.at - b.at).norm() <= TOLERANCE * self.model.dp
                };
                other.iter().zip(&images).all(meets) || other.iter().rev().zip(&images).all(meets)
            };
            let has_image = lines.iter().any(|(other, _, ends, values, life)| {
                other == kind && is_alike(values, numbers) && life == lifetime && is_image(ends)
            });
            if !has_image {
                let what = format!("{kind} {name:?} pulls a body that {} cuts to one side", plane.title());
                return Err(Error::scene(what).help(format!(
                    "give its mirror image too, alike and from {:?} to {:?}, or compute both sides",
                    images[0].at.as_slice(),
                    images[1].at.as_slice()
                )));
            }
        }
        Ok(())
    }

    /// Refuses forces and torques that turn a body on the plane, unless there is a mirror image of the force.
    fn check_moments(&self, plane: &Named, cut: &[bool]) -> Result<()> {
        let values = |laws: &[TimeFunction]| -> Vec<Vec<f64>> {
            times().map(|t| laws.iter().map(|law| law.value_and_rate(t).0).collect()).collect()
        };
        let acts = |law: &TimeFunction| times().any(|t| law.value_and_rate(t).0 != 0.0);
        let forces = &self.constraints.forces;
        for force in forces.iter().filter(|force| cut[force.solid]) {
            let body = &self.solids[force.solid].name;
            let turns = force.torque.iter().enumerate().filter(|(i, _)| D == 2 || *i != plane.axis);
            if turns.map(|(_, law)| law).any(acts) {
                let what = format!("force {:?} turns {body:?} out of {}", force.name, plane.title());
                return Err(Error::scene(what).help("leave out its torque, or compute both sides"));
            }
            let Some(at) = force.at.filter(|at| !self.is_on(plane, at) && force.force.iter().any(acts)) else {
                continue;
            };
            let image = plane.image(&at);
            let is_image = |other: &&ForceSpec<D>| {
                let there = other.at.is_some_and(|at| (at - image).norm() <= TOLERANCE * self.model.dp);
                there
                    && other.solid == force.solid
                    && other.lifetime == force.lifetime
                    && values(&other.force) == values(&force.force)
            };
            if !forces.iter().any(|other| is_image(&other)) {
                let what = format!(
                    "force {:?} acts on {body:?} beside {}, which cuts the body: it would turn it",
                    force.name,
                    plane.title()
                );
                return Err(Error::scene(what)
                    .help(format!("give its mirror image at {:?} too, or compute both sides", image.as_slice())));
            }
        }
        Ok(())
    }

    /// Whether `x` (m) lies on the plane.
    fn is_on(&self, plane: &Named, x: &Vector<D>) -> bool {
        plane.depth(x).abs() <= TOLERANCE * self.model.dp
    }

    /// Locks the bodies that `plane` cuts.
    fn lock_bodies(&mut self, plane: &Named) {
        let cut: Vec<bool> = self.solids.iter().map(|solid| self.is_cut(solid, plane)).collect();
        for (solid, _) in self.solids.iter_mut().zip(cut).filter(|(_, cut)| *cut) {
            if let Role::Free(body) = &mut solid.role {
                body.locked_translations[plane.axis] = true;
                for turn in (0..3).filter(|turn| if D == 2 { *turn == 0 } else { *turn != plane.axis }) {
                    body.locked_rotations[turn] = true;
                }
            }
        }
    }

    /// Refuses free solids beside periodic sides and planes, whose copies and images would be combined.
    fn check_periodic(&self) -> Result<()> {
        let free = self.solids.iter().find(|solid| matches!(solid.role, Role::Free(_)));
        free.map_or(Ok(()), |solid| {
            let what = format!("free solid {:?} in a scene with periodic sides and a symmetry plane", solid.name);
            Err(Error::scene(what)
                .with_code(ErrorCode::ConflictingKeys)
                .help("put a symmetry plane in place of the periodic sides, or compute both sides of the plane"))
        })
    }
}
