//! Checks the `[[probe]]` sections against the rest of the scene.

use std::collections::HashSet;

use super::{
    BoxConfig, ContactConfig, JointConfig, ProbeConfig, Scene,
    context::Context,
    section::{open_boundary, solid::require_solid},
};
use crate::{
    error::{Error, ErrorCode, Result, suggestion},
    probe::{ProbePlan, ProbeScope},
};

impl Scene {
    /// Refuses a `[[probe]]` section that is wrong.
    pub(super) fn verify_probes(&self) -> Result<()> {
        for (i, probe) in self.probe.iter().enumerate() {
            let key = format!("probe.{i}");
            probe.verify(&key, self)?;
            if let Some(name) = &probe.name {
                self.context().require_file_name(&format!("{key}.name"), name)?;
            }
        }
        let names = self.probe_names();
        let mut seen = HashSet::new();
        match names.iter().position(|name| !seen.insert(name)) {
            Some(i) => Err(self.context().error_with_help(
                &format!("probe.{i}"),
                format!("two probes are called \"{}\"", names[i]),
                "give each its own:  name = \"...\"",
            )),
            None => Ok(()),
        }
    }

    /// Stem of the file of each probe.
    pub(super) fn probe_names(&self) -> Vec<String> {
        ProbeConfig::names(&self.probe)
    }

    /// Plans of the probes that write a series.
    pub(super) fn probe_plans(&self) -> Vec<ProbePlan> {
        self.probe.iter().filter_map(|probe| probe.to_plan(self.until)).collect()
    }
}

impl ProbeScope for Scene {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn is_free(&self, name: &str) -> bool {
        self.solid.iter().any(|solid| solid.name == name && solid.free.is_some())
    }

    fn error_at(&self, key: &str, what: &str) -> Error {
        self.context().error_at(key, what)
    }

    fn error_with_help(&self, key: &str, what: &str, help: &str) -> Error {
        self.context().error_with_help(key, what, help)
    }

    fn require_solid(&self, key: &str, name: &str) -> Result<()> {
        require_solid(&self.context(), &self.solid, key, name)
    }

    fn require_constraint(&self, key: &str, kind: &str, name: &str) -> Result<()> {
        let known: Vec<String> = match kind {
            "joint" => self.joint.iter().map(|joint| joint.name.clone()).collect(),
            "mooring" => self.mooring.iter().map(|mooring| mooring.name.clone()).collect(),
            "open boundary" => open_boundary::names(&self.inflow, &self.outflow),
            "spring" => self.spring.iter().map(|spring| spring.name.clone()).collect(),
            _ => self.rope.iter().map(|rope| rope.name.clone()).collect(),
        };
        require_known(&self.context(), (key, kind), name, &known)
    }

    fn has_current(&self) -> bool {
        self.current.is_some()
    }

    fn require_contact(&self, key: &str, [a, b]: &[String; 2]) -> Result<()> {
        let refuse = |why: String, help: &str| {
            Err(self.context().error_with_help(key, format!("\"{a}\" and \"{b}\" never touch: {why}"), help))
        };
        if a == b {
            return refuse("they are one solid".into(), "name two");
        }
        let both = |named: &[String]| named.contains(a) && named.contains(b);
        let jointed = |joint: &&JointConfig| both(&joint.between) && joint.contacts != Some(true);
        if let Some(joint) = self.joint.iter().find(jointed) {
            return refuse(format!("joint \"{}\" holds them", joint.name), "write  contacts = true  in that joint");
        }
        let number = |name: &String| self.solid.iter().position(|solid| solid.name == *name).unwrap_or_default();
        let (i, j) = (number(a), number(b));
        if self.solid[i].free.is_none() && self.solid[j].free.is_none() {
            return refuse("neither is free".into(), "one of them at least must be  free = { density = 500.0 }");
        }
        let own = |(_, contact): &(usize, &ContactConfig)| contact.pairs(&self.solid).contains(&[i.min(j), i.max(j)]);
        match self.contact.iter().enumerate().rfind(own).filter(|(_, contact)| contact.touch == Some(false)) {
            Some((k, _)) => {
                let help = "remove it, or say otherwise of these two in a [[contact]] after it";
                refuse(format!("contact.{k} says  touch = false"), help)
            }
            None => Ok(()),
        }
    }

    fn require_vector(&self, key: &str, x: &[f64]) -> Result<()> {
        self.context().require_dimension(key, x)
    }

    fn require_positive(&self, key: &str, x: Option<f64>) -> Result<()> {
        self.context().require_positive(key, x)
    }

    fn require_box(&self, key: &str, corners: &BoxConfig) -> Result<()> {
        corners.verify(&self.context(), key)
    }
}

/// Requires that `name` is one of the `known` names of the `kind` of object.
fn require_known(ctx: &Context, (key, kind): (&str, &str), name: &str, known: &[String]) -> Result<()> {
    if known.iter().any(|known| known == name) {
        return Ok(());
    }
    let what = format!("no {kind} is called \"{name}\"{}", suggestion(name, known.iter().map(String::as_str)));
    let help = match known.is_empty() {
        true => format!("the scene has no {kind}"),
        false => format!("known: {}", known.join(", ")),
    };
    Err(ctx.error_with_help(key, what, help).with_code(ErrorCode::UnknownName))
}
