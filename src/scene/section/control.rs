//! `[[control]]`: numbers of motors and forces that may be changed while a run with a live page goes on.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    force_element::ForceConfig,
    joint::{JointConfig, JointKindConfig},
};
use crate::{
    error::{ErrorCode, Result, nearest_name, suggestion},
    plan::{ControlPlan, ControlTarget, MotorQuantity},
    scene::{context::Context, untagged::TimeValueConfig},
};

/// What a control may name.
const HELP: &str = "a control names a number of a motor or a component of a force, as in  key = \"joint.hinge.motor.velocity\"  \
    or  key = \"force.wind.force.0\"";

/// A section `[[control]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ControlConfig {
    /// The key that may be changed.
    pub key: String,
    /// Least value, in the unit of the key.
    pub min: f64,
    /// Greatest value, in the unit of the key.
    pub max: f64,
}

impl ControlConfig {
    /// The number at `key` may be changed from `min` to `max`.
    pub fn new(key: impl Into<String>, min: f64, max: f64) -> Self {
        Self { key: key.into(), min, max }
    }

    /// Returns the control, with what it changes.
    ///
    /// # Errors
    /// `Scene` for a key that is no number of a motor or force, and for a range without the number of the scene.
    pub(crate) fn build(
        &self,
        ctx: &Context,
        key: &str,
        joints: &[JointConfig],
        forces: &[ForceConfig],
    ) -> Result<ControlPlan> {
        let parts: Vec<&str> = self.key.split('.').collect();
        let (target, unit, value) = match parts[..] {
            ["joint", name, "motor", word] => self.motor(ctx, key, joints, (name, word))?,
            ["force", name, part @ ("force" | "torque"), number] => {
                self.load(ctx, key, forces, [name, part, number])?
            }
            _ => {
                let what = format!("\"{}\" cannot be changed during a run", self.key);
                return Err(ctx.error_with_help(&format!("{key}.key"), what, HELP));
            }
        };
        let Self { min, max, .. } = *self;
        if !(min < max && min.is_finite() && max.is_finite()) {
            let what = format!("nothing lies between min = {min} and max = {max}");
            return Err(ctx.error_at(&format!("{key}.max"), what).with_code(ErrorCode::OutOfRange));
        }
        if !(min..=max).contains(&value) {
            let what = format!("{} is {value}, which is not from min = {min} to max = {max}", self.key);
            return Err(ctx.error_at(&format!("{key}.min"), what).with_code(ErrorCode::OutOfRange));
        }
        let never_negative =
            matches!(target, ControlTarget::Motor { quantity: MotorQuantity::Stiffness | MotorQuantity::Damping, .. });
        if never_negative && min < 0.0 {
            let what = "a stiffness or damping below 0 would drive what it should hold";
            return Err(ctx.error_at(&format!("{key}.min"), what).with_code(ErrorCode::OutOfRange));
        }
        Ok(ControlPlan { key: self.key.clone(), unit: unit.into(), min, max, target })
    }

    /// Returns the control of a motor: what it changes, its unit and its value at the start.
    fn motor(
        &self,
        ctx: &Context,
        key: &str,
        joints: &[JointConfig],
        (name, word): (&str, &str),
    ) -> Result<(ControlTarget, &'static str, f64)> {
        let key = &format!("{key}.key");
        let names = joints.iter().filter(|joint| joint.motor.is_some()).map(|joint| joint.name.as_str());
        let Some((joint, motor)) =
            joints.iter().filter(|joint| joint.name == name).find_map(|joint| Some((joint, joint.motor.as_ref()?)))
        else {
            let what = format!("no joint with a motor is called \"{name}\"{}", suggestion(name, names));
            return Err(ctx.error_with_help(key, what, HELP).with_code(ErrorCode::UnknownName));
        };
        let hinge = joint.kind == JointKindConfig::Hinge;
        let quantity = MotorQuantity::ALL.into_iter().find(|(known, quantity, _)| {
            let foreign =
                if hinge { *known == "force" } else { *known == "torque" || *quantity == MotorQuantity::Degrees };
            *known == word && !foreign
        });
        let Some((_, quantity, units)) = quantity else {
            let words = MotorQuantity::ALL.map(|(known, ..)| known);
            let near = nearest_name(word, words).map_or(String::new(), |near| format!(": did you mean \"{near}\"?"));
            let what = format!("this motor has no number \"{word}\"{near}");
            return Err(ctx.error_with_help(key, what, HELP).with_code(ErrorCode::UnknownName));
        };
        let mut value = None;
        for (known, law) in motor.time_values() {
            let number = self.require_number(ctx, key, known, law)?;
            value = if known == word { Some(number) } else { value };
        }
        let Some(value) = value else {
            let help = format!("give the motor a value from which it is changed, such as  {word} = 0.0");
            return Err(ctx.error_with_help(key, format!("the scene has no {}", self.key), help));
        };
        let target = ControlTarget::Motor { joint: name.into(), quantity };
        Ok((target, units[usize::from(hinge)], value))
    }

    /// Returns the control of a component of a force or torque: what it changes, its unit and its value at the start.
    fn load(
        &self,
        ctx: &Context,
        key: &str,
        forces: &[ForceConfig],
        [name, part, number]: [&str; 3],
    ) -> Result<(ControlTarget, &'static str, f64)> {
        let key = &format!("{key}.key");
        let Some(force) = forces.iter().find(|force| force.name == name) else {
            let names = forces.iter().map(|force| force.name.as_str());
            let what = format!("no force is called \"{name}\"{}", suggestion(name, names));
            return Err(ctx.error_with_help(key, what, HELP).with_code(ErrorCode::UnknownName));
        };
        let torque = part == "torque";
        let given = if torque { &force.torque } else { &force.force };
        let laws = given.as_ref().map_or(&[][..], |vector| vector.components());
        let component = number.parse().ok().filter(|number: &usize| *number < laws.len());
        let Some(component) = component else {
            let what = format!("\"{}\" is no component: the {part} of \"{name}\" has {}", self.key, laws.len());
            return Err(ctx.error_with_help(key, what, HELP).with_code(ErrorCode::UnknownName));
        };
        for vector in [&force.force, &force.torque].into_iter().flatten() {
            vector.components().iter().try_for_each(|law| self.require_number(ctx, key, part, law).map(|_| ()))?;
        }
        let value = self.require_number(ctx, key, part, &laws[component])?;
        let target = ControlTarget::Force { force: name.into(), torque, component };
        Ok((target, if torque { "N m" } else { "N" }, value))
    }

    /// Refuses a formula or table beside what may be changed.
    fn require_number(&self, ctx: &Context, key: &str, word: &str, law: &TimeValueConfig) -> Result<f64> {
        law.number().ok_or_else(|| {
            let what =
                format!("{} cannot be changed during a run: {word} beside it changes with time by itself", self.key);
            ctx.error_with_help(key, what, "all numbers of a motor or force with a control are constant")
        })
    }
}
