//! From words to ties: joints, springs, ropes, forces and contacts of the solids that were built.

use std::collections::BTreeSet;

use super::{
    ContactConfig, ForceConfig, ForceFrame, JointConfig, JointKindConfig, LimitsConfig, MotionMode, MotorConfig, Scene,
    SolidConfig, TimeValueConfig, build_solids::CoordinateUnit, geometry::vector,
};
use crate::{
    error::{Error, Result},
    solid::{
        Constraints, ContactSpec, ForceSpec, FreeMode, InitialHold, JointKind, JointSpec, LineEnd, Motor, RopeSpec,
        SolidSpec, SpringSpec, TimeFunction,
        constraint::links::{check_force, check_rope, check_spring},
    },
};

impl Scene {
    /// The ties of `solids`, which are in the order of the scene.
    pub(super) fn build_constraints<const D: usize>(&self, solids: &[SolidSpec<D>]) -> Result<Constraints<D>> {
        let number = |name: &String| self.solid.iter().position(|solid| solid.name == *name);
        let ends = |between: &[String], from: &[f64], to: &[f64]| {
            [(0, from), (1, to)].map(|(k, at)| LineEnd { solid: between.get(k).and_then(number), at: vector(at) })
        };
        let place = |kind: &str, i: usize| {
            let key = format!("{kind}.{i}");
            move |e: Error| self.origin.with_location(e, &key)
        };
        let mut links = Constraints::default();
        for (i, words) in self.joint.iter().enumerate() {
            // One solid moves against the world.
            let between = match &words.between[..] {
                [one] => [None, number(one)],
                two => [0, 1].map(|k| two.get(k).and_then(number)),
            };
            links.joints.push(self.joint_spec(&format!("joint.{i}"), words, between)?);
            links.check_joint(i, solids).map_err(place("joint", i))?;
        }
        for (i, words) in self.spring.iter().enumerate() {
            let spring = SpringSpec {
                name: words.name.clone(),
                ends: ends(&words.between, &words.from, &words.to),
                stiffness: words.stiffness,
                damping: words.damping.unwrap_or_default(),
                rest_length: words.length,
                tension_only: words.tension_only.unwrap_or_default(),
            };
            check_spring(&spring, solids).map_err(place("spring", i))?;
            links.springs.push(spring);
        }
        for (i, words) in self.rope.iter().enumerate() {
            let (name, ends) = (words.name.clone(), ends(&words.between, &words.from, &words.to));
            let rope = RopeSpec { name, ends, max_length: words.length };
            check_rope(&rope, solids).map_err(place("rope", i))?;
            links.ropes.push(rope);
        }
        for (i, words) in self.force.iter().enumerate() {
            let force = self.force_spec(&format!("force.{i}"), words, number(&words.on).unwrap_or_default())?;
            check_force(&force, solids).map_err(place("force", i))?;
            links.forces.push(force);
        }
        for words in &self.contact {
            let touch = words.touch.unwrap_or(true);
            let (friction, restitution) = (words.friction, words.restitution);
            let spec = |between| ContactSpec { between, can_touch: touch, friction, restitution };
            links.contacts.extend(self.contact_pairs(words).into_iter().map(spec));
        }
        let release =
            |(solid, words): (usize, &SolidConfig)| Some(InitialHold { solid, until: words.free.as_ref()?.release? });
        links.holds = self.solid.iter().enumerate().filter_map(release).collect();
        Ok(links)
    }

    /// The pairs of solids, one at least of them free, that a contact is about: numbers, the lower first.
    pub(super) fn contact_pairs(&self, contact: &ContactConfig) -> BTreeSet<[usize; 2]> {
        let numbers = |named: &dyn Fn(&SolidConfig) -> bool| -> Vec<usize> {
            (0..self.solid.len()).filter(|&i| named(&self.solid[i])).collect()
        };
        let meant = |name: &String| numbers(&|solid| solid.name == *name || solid.group.as_ref() == Some(name));
        let [firsts, seconds] = match &contact.between[..] {
            [one] => [meant(one), numbers(&|_| true)],
            [one, other] => [meant(one), meant(other)],
            _ => return BTreeSet::new(),
        };
        let free = |i: usize| self.solid[i].free.is_some();
        let all = firsts.iter().flat_map(|&a| seconds.iter().map(move |&b| [a.min(b), a.max(b)]));
        all.filter(|&[a, b]| a != b && (free(a) || free(b))).collect()
    }

    fn joint_spec<const D: usize>(
        &self,
        key: &str,
        words: &JointConfig,
        between: [Option<usize>; 2],
    ) -> Result<JointSpec<D>> {
        let kind = match words.kind {
            JointKindConfig::Hinge => JointKind::Hinge,
            JointKindConfig::Slider => JointKind::Slider,
            JointKindConfig::Fixed => JointKind::Fixed,
            JointKindConfig::Ball => JointKind::Ball,
            JointKindConfig::Tow => JointKind::Tow,
            JointKindConfig::Generic => JointKind::Generic,
        };
        let axis = vector(words.axis.as_ref().or(words.along.as_ref()).map_or(&[], |x| x));
        let mut joint = JointSpec::new(&words.name, kind, between, vector(&words.at), axis);
        joint.contacts_enabled = words.contacts.unwrap_or_default();
        let stops = [(&words.limits, 1.0), (&words.limits_deg, 1f64.to_radians())];
        let stop = |mode: Option<&MotionMode>| {
            stops.iter().find_map(|(limits, unit)| match (limits, mode) {
                (Some(LimitsConfig::One(pair)), None) => Some([pair[0] * unit, pair[1] * unit]),
                (Some(LimitsConfig::Each(all)), Some(mode)) => {
                    all.get(mode).map(|pair| [pair[0] * unit, pair[1] * unit])
                }
                _ => None,
            })
        };
        joint.limits = stop(None);
        let number = |mode: &MotionMode| Some(FreeMode { mode: mode.index(D)?, limits: stop(Some(mode)) });
        joint.free_modes = words.free.iter().flatten().filter_map(number).collect();
        joint.motor = words.motor.as_ref().map(|motor| self.motor(&format!("{key}.motor"), motor)).transpose()?;
        Ok(joint)
    }

    fn motor(&self, key: &str, words: &MotorConfig) -> Result<Motor> {
        let mut motor = Motor { max_force: words.strongest.unwrap_or(f64::INFINITY), ..Motor::default() };
        for (word, value) in words.time_values() {
            let unit = match word {
                "position_deg" => CoordinateUnit::Degrees,
                "position" | "velocity" => CoordinateUnit::Radians,
                _ => CoordinateUnit::Metres,
            };
            let law = self.time_function(&format!("{key}.{word}"), &value.0, unit)?;
            match word {
                "force" | "torque" => motor.force = law,
                "position" | "position_deg" => motor.position = law,
                "velocity" => motor.velocity = Some(law),
                "stiffness" => motor.stiffness = law,
                _ => motor.damping = law,
            }
        }
        Ok(motor)
    }

    fn force_spec<const D: usize>(&self, key: &str, words: &ForceConfig, solid: usize) -> Result<ForceSpec<D>> {
        let laws = |word: &str, values: &[TimeValueConfig]| -> Result<Vec<TimeFunction>> {
            values
                .iter()
                .map(|value| self.time_function(&format!("{key}.{word}"), &value.0, CoordinateUnit::Metres))
                .collect()
        };
        Ok(ForceSpec {
            name: words.name.clone(),
            solid,
            at: words.at.as_ref().map(|at| vector(at)),
            force: laws("force", words.force.as_ref().map_or(&[], |values| values.components()))?,
            torque: laws("torque", words.torque.as_ref().map_or(&[], |values| values.components()))?,
            rotates_with_solid: words.frame == Some(ForceFrame::Body),
        })
    }
}
