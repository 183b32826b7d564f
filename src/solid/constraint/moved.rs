//! Constraints of solids that have moved from the poses for which their points are given.

use super::{
    jacobian::kinematics_of_end,
    lines::{LineEnd, start_length},
    links::Constraints,
};
use crate::{math::Vector, solid::Kinematics};

impl<const D: usize> Constraints<D> {
    /// The same constraints between solids that start as `to`. Their points and axes are given for the solids as `from`, and have moved
    /// with them. Lines keep their lengths, and joints the place from which their coordinates count.
    pub(crate) fn moved(&self, from: &[Kinematics<D>], to: &[Kinematics<D>]) -> Self {
        let has_moved = |solid: Option<usize>| solid.is_some_and(|i| from[i].pose != to[i].pose);
        let place = |solid: Option<usize>, x: &Vector<D>| match solid.filter(|_| has_moved(solid)) {
            Some(i) => to[i].pose.point(&from[i].pose.local(x)),
            None => *x,
        };
        let ends = |ends: &mut [LineEnd<D>; 2]| ends.iter_mut().for_each(|end| end.at = place(end.solid, &end.at));
        let mut made = self.clone();
        for joint in made.joints.iter_mut().filter(|joint| joint.between.into_iter().any(has_moved)) {
            joint.moved_frames = Some(joint.frames(from));
            joint.at = place(joint.between[1], &joint.at);
            let [before, after] = [from, to].map(|solids| kinematics_of_end(joint.between[0], solids).pose.rotation);
            joint.axis = after * before.transpose() * joint.axis;
        }
        // A line that begins later takes its length then.
        for spring in &mut made.springs {
            let given = spring.lifetime.has_begun(0.0).then(|| start_length(&spring.ends));
            spring.rest_length = spring.rest_length.or(given);
            ends(&mut spring.ends);
        }
        for rope in &mut made.ropes {
            let given = rope.lifetime.has_begun(0.0).then(|| start_length(&rope.ends));
            rope.max_length = rope.max_length.or(given);
            ends(&mut rope.ends);
        }
        made.moorings.iter_mut().for_each(|mooring| ends(&mut mooring.ends));
        for force in &mut made.forces {
            force.at = force.at.map(|at| place(Some(force.solid), &at));
        }
        made
    }
}
