//! Joins the joints, lines, forces, winds, contact rules, holds and removals of a scene.

use super::{
    Scene,
    context::Context,
    section::{mooring::MooringPointConfig, solid::SolidConfig},
};
use crate::{
    error::Result,
    solid::{
        Constraints, InitialHold, SolidSpec, TimedRemoval,
        constraint::links::{check_force, check_rope, check_spring},
        mooring::{check_mooring, check_mooring_points},
    },
};

/// Returns the joints, force elements and contact rules of `solids`, which must be in the order of the scene, over still water
/// with the level (m) at the place of each, if water is there.
pub(super) fn build_constraints<const D: usize>(
    scene: &Scene,
    ctx: &Context,
    solids: &[SolidSpec<D>],
    levels: &[Option<f64>],
) -> Result<Constraints<D>> {
    let number = |name: &String| scene.solid.iter().position(|solid| solid.name == *name);
    let mut constraints = Constraints::default();
    for (i, joint) in scene.joint.iter().enumerate() {
        let key = format!("joint.{i}");
        // A joint with one solid connects it to the world.
        let between = match &joint.between[..] {
            [one] => [None, number(one)],
            two => [0, 1].map(|k| two.get(k).and_then(number)),
        };
        constraints.joints.push(joint.build(ctx, &key, between, &scene.solid)?);
        constraints.check_joint(i, solids).map_err(|e| ctx.with_location(e, &key))?;
    }
    for (i, spring) in scene.spring.iter().enumerate() {
        let spring = spring.build(&scene.solid);
        check_spring(&spring, solids).map_err(|e| ctx.with_location(e, &format!("spring.{i}")))?;
        constraints.springs.push(spring);
    }
    for (i, rope) in scene.rope.iter().enumerate() {
        let rope = rope.build(&scene.solid);
        check_rope(&rope, solids).map_err(|e| ctx.with_location(e, &format!("rope.{i}")))?;
        constraints.ropes.push(rope);
    }
    for (i, mooring) in scene.mooring.iter().enumerate() {
        let key = format!("mooring.{i}");
        let mooring = mooring.build(ctx, &key, &scene.mooring_scope())?;
        check_mooring(&mooring, solids).map_err(|e| ctx.with_location(e, &key))?;
        constraints.moorings.push(mooring);
    }
    constraints.mooring_points = scene.mooring_point.iter().map(MooringPointConfig::build).collect();
    check_mooring_points(&constraints.mooring_points, &constraints.moorings)
        .map_err(|e| ctx.with_location(e, "mooring_point"))?;
    for (i, force) in scene.force.iter().enumerate() {
        let key = format!("force.{i}");
        let force = force.build(ctx, &key, &scene.solid)?;
        check_force(&force, solids).map_err(|e| ctx.with_location(e, &key))?;
        constraints.forces.push(force);
    }
    for (i, wind) in scene.wind.iter().enumerate() {
        constraints.winds.push(wind.build(ctx, &format!("wind.{i}"), &scene.solid, solids, levels)?);
    }
    constraints.contacts = scene.contact.iter().flat_map(|contact| contact.build(&scene.solid)).collect();
    let hold = |(solid, body): (usize, &SolidConfig)| Some(InitialHold { solid, until: body.free.as_ref()?.release? });
    constraints.holds = scene.solid.iter().enumerate().filter_map(hold).collect();
    let removal = |(solid, body): (usize, &SolidConfig)| Some(TimedRemoval { solid, at: body.until? });
    constraints.removals = scene.solid.iter().enumerate().filter_map(removal).collect();
    for removal in &constraints.removals {
        let key = format!("solid.{}.until", removal.solid);
        constraints.check_removal(removal, solids).map_err(|e| ctx.with_location(e, &key))?;
    }
    Ok(constraints)
}
