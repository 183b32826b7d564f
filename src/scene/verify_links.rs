//! Holds the words of joints, springs, ropes, forces and contacts against those of the solids.

use std::collections::BTreeSet;

use super::{
    ContactConfig, ForceConfig, JointConfig, JointKindConfig, LimitsConfig, MotionMode, MotorConfig, Scene,
    SolidConfig, SpringConfig, TimeFunctionConfig, TimeValueConfig,
    verify::{last_part, suggestion},
};
use crate::{error::Result, math::expression::Formula};

impl Scene {
    pub(super) fn verify_links(&self) -> Result<()> {
        fn names<T>(all: &[T], name: impl Fn(&T) -> &str) -> Vec<&str> {
            all.iter().map(name).collect()
        }
        self.names("joint", &names(&self.joint, |joint| &joint.name))?;
        self.names("spring", &names(&self.spring, |spring| &spring.name))?;
        self.names("rope", &names(&self.rope, |rope| &rope.name))?;
        self.names("force", &names(&self.force, |force| &force.name))?;
        self.joint.iter().enumerate().try_for_each(|(i, joint)| self.verify_joint(&format!("joint.{i}"), joint))?;
        self.spring
            .iter()
            .enumerate()
            .try_for_each(|(i, spring)| self.verify_spring(&format!("spring.{i}"), spring))?;
        for (i, rope) in self.rope.iter().enumerate() {
            let key = format!("rope.{i}");
            self.verify_ends(&key, &rope.between)?;
            self.require_dimension(&format!("{key}.from"), &rope.from)?;
            self.require_dimension(&format!("{key}.to"), &rope.to)?;
            self.require_positive(&format!("{key}.length"), rope.length)?;
        }
        self.force.iter().enumerate().try_for_each(|(i, force)| self.verify_force(&format!("force.{i}"), force))?;
        (0..self.contact.len()).try_for_each(|i| self.verify_contact(&format!("contact.{i}"), i))
    }

    /// Refuses contact number `i` if it says nothing, or two things.
    fn verify_contact(&self, key: &str, i: usize) -> Result<()> {
        let contact = &self.contact[i];
        self.verify_contact_ends(&format!("{key}.between"), contact)?;
        let plain = contact.friction.is_none() && contact.restitution.is_none();
        if contact.touch == Some(false) && !plain {
            let what = "what does not touch has neither friction nor restitution";
            return Err(self.error_at(&format!("{key}.touch"), what));
        }
        let pairs = self.contact_pairs(contact);
        // `touch = true` has a meaning after a rule for some of the same pairs.
        let rules =
            |earlier: &ContactConfig| contact.touch.is_some() && !self.contact_pairs(earlier).is_disjoint(&pairs);
        if contact.touch != Some(false) && plain && !self.contact[..i].iter().any(rules) {
            return Err(self.error_at(key, "this contact is as any other"));
        }
        self.require_range(&format!("{key}.friction"), contact.friction, 10.0)?;
        self.require_range(&format!("{key}.restitution"), contact.restitution, 1.0)
    }

    /// Refuses what is not one or two solids or groups that can touch.
    fn verify_contact_ends(&self, key: &str, contact: &ContactConfig) -> Result<()> {
        let between = &contact.between;
        if !(1..=2).contains(&between.len()) {
            let what = format!("between names two solids or groups, or one, not {}", between.len());
            let help = "write  between = [\"box\", \"tank\"]; one alone means its contacts with all others";
            return Err(self.error_with_help(key, what, help));
        }
        let groups: BTreeSet<&str> = self.solid.iter().filter_map(|solid| solid.group.as_deref()).collect();
        let known: Vec<&str> =
            self.solid.iter().map(|solid| solid.name.as_str()).chain(groups.iter().copied()).collect();
        if let Some(name) = between.iter().find(|name| !known.contains(&name.as_str())) {
            let what = format!("no solid or group is called \"{name}\"{}", suggestion(name, &known));
            return Err(self.error_with_help(key, what, format!("known: {}", known.join(", "))));
        }
        let of_group = between.iter().any(|name| groups.contains(name.as_str()));
        let twice = between.len() == 2 && between[0] == between[1];
        if twice && !of_group {
            let help = "name two; one alone means its contacts with all others";
            return Err(self.error_with_help(key, format!("\"{}\" is named twice", between[0]), help));
        }
        if (of_group || between.len() == 2) && self.contact_pairs(contact).is_empty() {
            let names = if twice { &between[..1] } else { &between[..] };
            let what = format!("of \"{}\" no two solids can touch", names.join("\" and \""));
            let help = "it takes two, of which one at least must be  free = { density = 500.0 }";
            return Err(self.error_with_help(key, what, help));
        }
        Ok(())
    }

    /// Refuses names that are none, or given twice.
    fn names(&self, kind: &str, names: &[&str]) -> Result<()> {
        names.iter().enumerate().try_for_each(|(i, name)| {
            let key = format!("{kind}.{i}.name");
            self.require_file_name(&key, name)?;
            match names[..i].contains(name) {
                true => Err(self.error_with_help(
                    &key,
                    format!("two {kind}s are called \"{name}\""),
                    "give each its own name",
                )),
                false => Ok(()),
            }
        })
    }

    /// Refuses ends that are not one or two solids, of which one is free.
    fn verify_ends(&self, key: &str, between: &[String]) -> Result<()> {
        let key = format!("{key}.between");
        if !(1..=2).contains(&between.len()) {
            return Err(self.error_at(&key, format!("between names one solid or two, not {}", between.len())));
        }
        between.iter().try_for_each(|name| self.require_solid(&key, name))?;
        if between.len() == 2 && between[0] == between[1] {
            return Err(self.error_at(&key, format!("\"{}\" is named twice", between[0])));
        }
        let free = |solid: &&SolidConfig| between.contains(&solid.name) && solid.free.is_some();
        if self.solid.iter().any(|solid| free(&solid)) {
            return Ok(());
        }
        let verb = if between.len() == 2 { "are" } else { "is" };
        let what = format!("\"{}\" {verb} not free: nothing here can move otherwise", between.join("\" and \""));
        Err(self.error_with_help(&key, what, "one of them at least must be  free = { density = 500.0 }"))
    }

    fn verify_joint(&self, key: &str, joint: &JointConfig) -> Result<()> {
        self.verify_ends(key, &joint.between)?;
        self.require_dimension(&format!("{key}.at"), &joint.at)?;
        let three = self.dimension == 3;
        let (hinge, slider) = (joint.kind == JointKindConfig::Hinge, joint.kind == JointKindConfig::Slider);
        if joint.kind == JointKindConfig::Ball && !three {
            let help = "in 2-D  kind = \"hinge\"  turns freely about its point";
            return Err(self.error_with_help(&format!("{key}.kind"), "a plane has no ball joint", help));
        }
        let (along, generic) = (slider || joint.kind == JointKindConfig::Tow, joint.kind == JointKindConfig::Generic);
        let needs = [("axis", &joint.axis, hinge && three, false), ("along", &joint.along, along, generic)];
        for (word, vector, needed, allowed) in needs {
            let key = format!("{key}.{word}");
            match vector {
                None if needed => return Err(self.error_at(&key, format!("{word} is missing: which way?"))),
                Some(_) if !(needed || allowed) => {
                    let help = "a slider, a tow and a generic joint have  along, a hinge in 3-D has  axis; no other joint has a direction";
                    return Err(self.error_with_help(&key, format!("{word} has no meaning here"), help));
                }
                Some(vector) => {
                    self.require_dimension(&key, vector)?;
                    if vector.iter().all(|x| x.abs() < 1e-12) {
                        return Err(self.error_at(&key, format!("{word} points nowhere")));
                    }
                }
                None => {}
            }
        }
        self.verify_limits(key, joint)?;
        match &joint.motor {
            Some(_) if !(hinge || slider) => {
                let help = "a hinge or a slider has a motor";
                Err(self.error_with_help(&format!("{key}.motor"), "this joint has no way to go", help))
            }
            Some(motor) => self.verify_motor(&format!("{key}.motor"), motor, hinge),
            None => Ok(()),
        }
    }

    /// Refuses modes that a joint cannot leave free, and end stops that are not of what it leaves free.
    fn verify_limits(&self, key: &str, joint: &JointConfig) -> Result<()> {
        let generic = joint.kind == JointKindConfig::Generic;
        let free = joint.free.as_deref().unwrap_or_default();
        self.verify_modes(&format!("{key}.free"), free)?;
        if generic && free.is_empty() {
            return Err(self.error_with_help(key, "free is missing: what does it leave?", "free = [\"x\", \"turn\"]"));
        }
        if !generic && joint.free.is_some() {
            let help = "the other kinds say what they leave free; a list has  kind = \"generic\"";
            return Err(self.error_with_help(&format!("{key}.free"), "free has no meaning here", help));
        }
        let hinge = joint.kind == JointKindConfig::Hinge;
        let way = hinge || joint.kind == JointKindConfig::Slider;
        let mut seen: Vec<MotionMode> = Vec::new();
        for (word, limits) in [("limits", &joint.limits), ("limits_deg", &joint.limits_deg)] {
            let Some(limits) = limits else { continue };
            let key = format!("{key}.{word}");
            match limits {
                LimitsConfig::One(_) if generic => {
                    let help = "name the motion: limits = { x = [-0.1, 0.2] }, limits_deg = { turn = [-10.0, 10.0] }";
                    return Err(self.error_with_help(&key, "which motion is limited?", help));
                }
                LimitsConfig::One(pair) if way => self.verify_stop(&key, pair)?,
                LimitsConfig::Each(all) if generic => {
                    for (mode, pair) in all {
                        let far = mode.index(self.dimension).is_some_and(|number| number < self.dimension);
                        if !free.contains(mode) || (word == "limits_deg" && far) || seen.contains(mode) {
                            let help = "each motion in  free  may have one pair, a turn's in rad or in degrees";
                            return Err(self.error_with_help(
                                &key,
                                "limits of what is not free, or twice the same",
                                help,
                            ));
                        }
                        seen.push(*mode);
                        self.verify_stop(&key, pair)?;
                    }
                }
                LimitsConfig::Each(_) if way => {
                    return Err(self.error_with_help(&key, "this joint has one way to go", "limits = [-0.1, 0.2]"));
                }
                _ => {
                    let help = "a hinge, a slider or a generic joint has limits";
                    return Err(self.error_with_help(&key, "this joint has no way to go", help));
                }
            }
        }
        match (&joint.limits, &joint.limits_deg) {
            (Some(_), Some(_)) if !generic => {
                Err(self.error_at(&format!("{key}.limits_deg"), "limits and limits_deg say the same twice"))
            }
            (_, Some(_)) if !(hinge || generic) => {
                Err(self.error_at(&format!("{key}.limits_deg"), "only turns have limits in degrees"))
            }
            _ => Ok(()),
        }
    }

    /// Refuses end stops that do not have the start between them, or all of a turn.
    fn verify_stop(&self, key: &str, pair: &[f64]) -> Result<()> {
        match pair {
            [min, max] if *min <= 0.0 && 0.0 <= *max && min < max => {
                if last_part(key) != "limits_deg" || max - min < 360.0 {
                    return Ok(());
                }
                let help = "from stop to stop a turn is less than 360, as in  [-170.0, 170.0]        # degrees";
                Err(self.error_with_help(
                    key,
                    format!("from {min} to {max} degrees it would turn all the way round"),
                    help,
                ))
            }
            _ => {
                let what = format!("{pair:?} does not reach from 0 or less to 0 or more; 0 is where it starts");
                Err(self.error_at(key, what))
            }
        }
    }

    fn verify_motor(&self, key: &str, motor: &MotorConfig, hinge: bool) -> Result<()> {
        let foreign: &[&str] = if hinge { &["force"] } else { &["torque", "position_deg"] };
        if let Some((word, _)) = motor.time_values().find(|(word, _)| foreign.contains(word)) {
            let help = "a hinge has a torque, N m, and angles in rad or degrees; a slider a force, N, and metres";
            return Err(self.error_with_help(&format!("{key}.{word}"), format!("{word} has no meaning here"), help));
        }
        let position = motor.position.is_some() || motor.position_deg.is_some();
        let drives = [&motor.force, &motor.torque, &motor.stiffness, &motor.damping];
        if drives.iter().all(|law| law.is_none()) {
            return Err(
                self.error_at(key, "this motor has no force: give a force or torque, a stiffness, or a damping")
            );
        }
        if motor.position.is_some() && motor.position_deg.is_some() {
            return Err(self.error_at(&format!("{key}.position_deg"), "position and position_deg say the same twice"));
        }
        if position && motor.stiffness.is_none() {
            let what = "a position needs a stiffness with which it is held";
            return Err(self.error_at(&format!("{key}.stiffness"), what));
        }
        if motor.velocity.is_some() && motor.damping.is_none() {
            let what = "a velocity needs a damping with which it is held";
            return Err(self.error_at(&format!("{key}.damping"), what));
        }
        self.require_positive(&format!("{key}.strongest"), motor.strongest)?;
        motor.time_values().try_for_each(|(word, value)| self.verify_time_value(&format!("{key}.{word}"), value))?;
        for (word, value) in [("stiffness", &motor.stiffness), ("damping", &motor.damping)] {
            if let Some(x) = value.as_ref().and_then(TimeValueConfig::number).filter(|x| *x < 0.0) {
                let what = format!("{word} is {x}: below 0 it would drive what it should hold");
                return Err(self.error_at(&format!("{key}.{word}"), what));
            }
        }
        Ok(())
    }

    fn verify_spring(&self, key: &str, spring: &SpringConfig) -> Result<()> {
        self.verify_ends(key, &spring.between)?;
        self.require_dimension(&format!("{key}.from"), &spring.from)?;
        self.require_dimension(&format!("{key}.to"), &spring.to)?;
        self.require_positive(&format!("{key}.stiffness"), Some(spring.stiffness))?;
        for (word, x) in [("damping", spring.damping), ("length", spring.length)] {
            if let Some(x) = x.filter(|x| *x < 0.0) {
                return Err(self.error_at(&format!("{key}.{word}"), format!("{word} is 0 or more, not {x}")));
            }
        }
        Ok(())
    }

    fn verify_force(&self, key: &str, force: &ForceConfig) -> Result<()> {
        self.require_solid(&format!("{key}.on"), &force.on)?;
        if !self.solid.iter().any(|solid| solid.name == force.on && solid.free.is_some()) {
            let what = format!("\"{}\" is not free: a force does not move it", force.on);
            return Err(self.error_with_help(&format!("{key}.on"), what, "a force acts on a free solid"));
        }
        if let Some(at) = &force.at {
            self.require_dimension(&format!("{key}.at"), at)?;
        }
        if force.force.is_none() && force.torque.is_none() {
            return Err(self.error_at(key, "neither a force nor a torque is given"));
        }
        let turns = if self.dimension == 3 { 3 } else { 1 };
        for (word, values, count) in [("force", &force.force, self.dimension), ("torque", &force.torque, turns)] {
            let Some(values) = values else { continue };
            let key = format!("{key}.{word}");
            let values = values.components();
            if values.len() != count {
                let what = format!("{word} has {} components, and a {}-D scene {count}", values.len(), self.dimension);
                return Err(self.error_at(&key, what));
            }
            values.iter().try_for_each(|value| self.verify_time_value(&key, value))?;
        }
        Ok(())
    }

    fn verify_time_value(&self, key: &str, value: &TimeValueConfig) -> Result<()> {
        self.verify_time_function(key, &value.0)?;
        match &value.0.formula {
            Some(text) => Formula::parse(text).map(|_| ()).map_err(|e| self.origin.with_location(e, key)),
            None => Ok(()),
        }
    }

    /// Refuses a law that is not either a formula or a column of a file.
    pub(super) fn verify_time_function(&self, key: &str, law: &TimeFunctionConfig) -> Result<()> {
        match (&law.formula, &law.file) {
            (Some(_), None) if law.column.is_none() && law.scale.is_none() && law.time.is_none() => Ok(()),
            (Some(_), None) => Err(self.error_at(key, "column, time and scale belong to a file, not to a formula")),
            (None, Some(_)) if law.column.is_some() => Ok(()),
            (None, Some(_)) => Err(self.error_at(key, "which column of the file?")),
            _ => Err(self.error_at(key, "a law is either a formula or a file with a column")),
        }
    }

    /// Refuses a number that is given and not from 0 to `most`.
    pub(super) fn require_range(&self, key: &str, x: Option<f64>, most: f64) -> Result<()> {
        match x.filter(|x| !(0.0..=most).contains(x)) {
            Some(x) => {
                let word = last_part(key);
                let help = format!("{word} is a number from 0 to {most}");
                Err(self.error_with_help(key, format!("{word} cannot be {x}"), help))
            }
            None => Ok(()),
        }
    }
}
