//! `[[contact]]`: rules for pairs of solids that touch.

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::solid::SolidConfig;
use crate::{
    error::{ErrorCode, Result, suggestion},
    scene::context::Context,
    solid::ContactSpec,
};

/// A section `[[contact]]`: how solids touch, pair by pair; of several of the same pair the last counts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ContactConfig {
    /// The two, each a solid or a group of them; or one, for its contacts with all others.
    pub between: Vec<String>,
    /// `false`: they pass through one another.
    pub touch: Option<bool>,
    /// Coulomb friction coefficient, –.
    pub friction: Option<f64>,
    /// Restitution coefficient, –.
    pub restitution: Option<f64>,
}

impl ContactConfig {
    /// The contact of two solids or groups, or of one with all others.
    pub fn new<const N: usize>(between: [&str; N]) -> Self {
        Self { between: between.map(String::from).to_vec(), ..Self::default() }
    }

    /// Returns the same contact with its own Coulomb friction coefficient (–).
    pub fn friction(self, friction: f64) -> Self {
        Self { friction: Some(friction), ..self }
    }

    /// Returns the same contact with its own restitution coefficient (–).
    pub fn restitution(self, restitution: f64) -> Self {
        Self { restitution: Some(restitution), ..self }
    }

    /// Returns the same pair without contact: its solids pass through one another.
    pub fn without_contact(self) -> Self {
        Self { touch: Some(false), ..self }
    }

    /// Refuses a rule that changes nothing or contradicts itself; `earlier` are the rules before it.
    fn verify(&self, ctx: &Context, key: &str, solids: &[SolidConfig], earlier: &[ContactConfig]) -> Result<()> {
        self.verify_between(ctx, &format!("{key}.between"), solids)?;
        let plain = self.friction.is_none() && self.restitution.is_none();
        if self.touch == Some(false) && !plain {
            let what = "what does not touch has neither friction nor restitution";
            return Err(ctx.error_at(&format!("{key}.touch"), what));
        }
        let pairs = self.pairs(solids);
        // `touch = true` has a meaning after a rule for some of the same pairs.
        let rules = |rule: &ContactConfig| self.touch.is_some() && !rule.pairs(solids).is_disjoint(&pairs);
        if self.touch != Some(false) && plain && !earlier.iter().any(rules) {
            return Err(ctx.error_at(key, "this contact is as any other"));
        }
        ctx.require_range(&format!("{key}.friction"), self.friction, 10.0)?;
        ctx.require_range(&format!("{key}.restitution"), self.restitution, 1.0)
    }

    /// Refuses names that are not one or two solids or groups that can touch.
    fn verify_between(&self, ctx: &Context, key: &str, solids: &[SolidConfig]) -> Result<()> {
        let between = &self.between;
        if !(1..=2).contains(&between.len()) {
            let what = format!("between names two solids or groups, or one, not {}", between.len());
            let help = "write  between = [\"box\", \"tank\"]; one alone means its contacts with all others";
            return Err(ctx.error_with_help(key, what, help));
        }
        let groups: BTreeSet<&str> = solids.iter().filter_map(|solid| solid.group.as_deref()).collect();
        let known: Vec<&str> = solids.iter().map(|solid| solid.name.as_str()).chain(groups.iter().copied()).collect();
        if let Some(name) = between.iter().find(|name| !known.contains(&name.as_str())) {
            let what = format!("no solid or group is called \"{name}\"{}", suggestion(name, known.iter().copied()));
            return Err(ctx
                .error_with_help(key, what, format!("known: {}", known.join(", ")))
                .with_code(ErrorCode::UnknownName));
        }
        let of_group = between.iter().any(|name| groups.contains(name.as_str()));
        let twice = between.len() == 2 && between[0] == between[1];
        if twice && !of_group {
            let help = "name two; one alone means its contacts with all others";
            return Err(ctx.error_with_help(key, format!("\"{}\" is named twice", between[0]), help));
        }
        if (of_group || between.len() == 2) && self.pairs(solids).is_empty() {
            let names = if twice { &between[..1] } else { &between[..] };
            let what = format!("of \"{}\" no two solids can touch", names.join("\" and \""));
            let help = "it takes two, of which one at least must be  free = { density = 500.0 }";
            return Err(ctx.error_with_help(key, what, help));
        }
        Ok(())
    }

    /// The pairs of solids, one at least of them free, to which the rule applies: numbers, the lower first.
    pub(crate) fn pairs(&self, solids: &[SolidConfig]) -> BTreeSet<[usize; 2]> {
        let numbers = |named: &dyn Fn(&SolidConfig) -> bool| -> Vec<usize> {
            (0..solids.len()).filter(|&i| named(&solids[i])).collect()
        };
        let meant = |name: &String| numbers(&|solid| solid.name == *name || solid.group.as_ref() == Some(name));
        let [firsts, seconds] = match &self.between[..] {
            [one] => [meant(one), numbers(&|_| true)],
            [one, other] => [meant(one), meant(other)],
            _ => return BTreeSet::new(),
        };
        let free = |i: usize| solids[i].free.is_some();
        let all = firsts.iter().flat_map(|&a| seconds.iter().map(move |&b| [a.min(b), a.max(b)]));
        all.filter(|&[a, b]| a != b && (free(a) || free(b))).collect()
    }

    /// A specification for each pair.
    pub(crate) fn build(&self, solids: &[SolidConfig]) -> Vec<ContactSpec> {
        let touch = self.touch.unwrap_or(true);
        let (friction, restitution) = (self.friction, self.restitution);
        let spec = |between| ContactSpec { between, can_touch: touch, friction, restitution };
        self.pairs(solids).into_iter().map(spec).collect()
    }
}

/// Refuses rules that change nothing or contradict themselves.
pub(crate) fn verify(ctx: &Context, contacts: &[ContactConfig], solids: &[SolidConfig]) -> Result<()> {
    let verify =
        |(i, contact): (usize, &ContactConfig)| contact.verify(ctx, &format!("contact.{i}"), solids, &contacts[..i]);
    contacts.iter().enumerate().try_for_each(verify)
}
