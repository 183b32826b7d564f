//! Prepares springs and ropes for drawing: straight lines between points of solids or of the ground.

use serde::Serialize;

use super::{outline::to_3d, run_data::DrawnSolid};
use crate::{
    scene::Scene,
    solid::{Lifetime, LineEnd, constraint::lifetime::end_in_events},
};

/// A spring or a rope.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Tie {
    /// The number of the solid at each end; `None` is the ground.
    pub solids: [Option<usize>; 2],
    /// The ends, m: in the local frame of the solid, or in the world.
    pub ends: [[f64; 3]; 2],
    /// The time from which it acts, s.
    pub since: f64,
    /// The time at which it ends or breaks, s; `None` if it does not.
    pub until: Option<f64>,
}

impl Tie {
    /// Returns whether it acts at time `t` (s).
    pub(crate) fn acts_at(&self, t: f64) -> bool {
        self.since <= t && self.until.is_none_or(|until| t < until)
    }
}

/// Returns the springs and ropes of `scene`, whose solids start as in `solids`. `events` are those of the run.
pub(crate) fn ties<const D: usize>(scene: &Scene, solids: &[DrawnSolid], events: &[String]) -> Vec<Tie> {
    let tie = |element: String, ends: [LineEnd<D>; 2], lifetime: Lifetime| Tie {
        solids: ends.map(|end| end.solid),
        ends: ends.map(|end| {
            let at = to_3d(&end.at);
            end.solid.and_then(|i| solids.get(i)).map_or(at, |solid| solid.start.to_local(&at.map(|x| x as f32)))
        }),
        since: lifetime.since,
        until: end_in_events(events, &element).or_else(|| lifetime.until.is_finite().then_some(lifetime.until)),
    };
    let springs = scene.spring.iter().map(|spring| {
        let spring = spring.build(&scene.solid);
        tie(format!("spring {:?}", spring.name), spring.ends, spring.lifetime)
    });
    let ropes = scene.rope.iter().map(|rope| {
        let rope = rope.build(&scene.solid);
        tie(format!("rope {:?}", rope.name), rope.ends, rope.lifetime)
    });
    springs.chain(ropes).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/report/ties.rs"]
mod tests;
