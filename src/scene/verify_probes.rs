//! Holds the words of `[[probe]]` against one another and against the rest of the scene, and names them.

use std::collections::{HashMap, HashSet};

use super::{
    ContactConfig, GaugeConfig, JointConfig, PatchConfig, PointRowConfig, PointsConfig, ProbeConfig, Scene,
    SectionConfig,
    context::{quoted_list, suggestion},
    section::solid::require_solid,
};
use crate::error::Result;

/// Most places of a row.
const MOST_PLACES: usize = 1000;

/// The least way (m) between two of them: their columns are called after places to a micrometre.
const LEAST_SPACING: f64 = 1e-6;

impl Scene {
    pub(super) fn verify_probes(&self) -> Result<()> {
        for (i, probe) in self.probe.iter().enumerate() {
            let key = format!("probe.{i}");
            self.context().require_positive(&format!("{key}.every"), probe.every)?;
            if probe.named_kinds().len() != 1 {
                let what = format!("a probe looks at one thing; this one at {}", quoted_list(&probe.named_kinds()));
                let help = "one of motion, force, balance, contact, contacts, joint, spring, rope, elevation, velocity, pressure, \
                     flow, runup, patch, front, energy, budget; a [[probe]] section for each";
                return Err(self.context().error_with_help(&key, what, help));
            }
            self.require_probe_solids(&key, probe)?;
            self.require_constraint(&key, probe)?;
            if let Some(between) = &probe.contact {
                self.may_touch(&format!("{key}.contact"), between)?;
            }
            self.verify_places(&key, probe)?;
            let whole = [
                ("front", probe.front),
                ("energy", probe.energy),
                ("budget", probe.budget),
                ("contacts", probe.contacts),
            ];
            for (word, given) in whole {
                if given == Some(false) {
                    let what = format!("{word} = false watches nothing");
                    return Err(self.context().error_with_help(&format!("{key}.{word}"), what, "remove it"));
                }
            }
            if probe.contacts.is_some() && probe.average.is_some() {
                let help = "remove it; the mean of one pair is that of  contact = [\"crate\", \"raft\"]";
                return Err(self.context().error_with_help(
                    &format!("{key}.average"),
                    "a list of contacts takes no means",
                    help,
                ));
            }
            if let Some(name) = &probe.name {
                self.context().require_file_name(&format!("{key}.name"), name)?;
            }
        }
        let names: Vec<String> = self.probe_names();
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

    /// Refuses a probe of a joint, spring or rope that there is not.
    fn require_constraint(&self, key: &str, probe: &ProbeConfig) -> Result<()> {
        let joints = self.joint.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>();
        let springs = self.spring.iter().map(|spring| spring.name.as_str()).collect();
        let ropes = self.rope.iter().map(|rope| rope.name.as_str()).collect();
        let ties = [("joint", &probe.joint, joints), ("spring", &probe.spring, springs), ("rope", &probe.rope, ropes)];
        for (word, name, known) in ties {
            let Some(name) = name.as_ref().filter(|name| !known.contains(&name.as_str())) else { continue };
            let what = format!("no {word} is called \"{name}\"{}", suggestion(name, &known));
            let help = match known.is_empty() {
                true => format!("the scene has no {word}"),
                false => format!("known: {}", known.join(", ")),
            };
            return Err(self.context().error_with_help(&format!("{key}.{word}"), what, help));
        }
        Ok(())
    }

    fn require_probe_solids(&self, key: &str, probe: &ProbeConfig) -> Result<()> {
        let patched = probe.patch.as_ref().map(|patch| &patch.solid);
        let named = [
            ("motion", probe.motion.as_ref()),
            ("force", probe.force.as_ref()),
            ("balance", probe.balance.as_ref()),
            ("runup", probe.runup.as_ref()),
            ("patch.solid", patched),
        ];
        let touching = probe.contact.iter().flatten().map(|name| ("contact", Some(name)));
        for (word, name) in named.into_iter().chain(touching) {
            if let Some(name) = name {
                require_solid(&self.context(), &self.solid, &format!("{key}.{word}"), name)?;
            }
        }
        let free = |name: &String| self.solid.iter().any(|solid| solid.name == *name && solid.free.is_some());
        match probe.balance.as_ref().filter(|name| !free(name)) {
            Some(name) => {
                let what = format!("\"{name}\" is not free: what it weighs and carries is not known");
                let help = format!("the water's load on any solid is  force = \"{name}\"");
                Err(self.context().error_with_help(&format!("{key}.balance"), what, help))
            }
            None => Ok(()),
        }
    }

    /// Refuses two solids that never touch.
    fn may_touch(&self, key: &str, [a, b]: &[String; 2]) -> Result<()> {
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

    fn verify_places(&self, key: &str, probe: &ProbeConfig) -> Result<()> {
        for (word, at) in [("velocity", &probe.velocity), ("pressure", &probe.pressure)] {
            match at {
                Some(PointsConfig::At(at)) => self.context().require_dimension(&format!("{key}.{word}"), at)?,
                Some(PointsConfig::Row(row)) => self.verify_row(&format!("{key}.{word}"), row, self.dimension)?,
                None => {}
            }
        }
        if let Some(gauge) = &probe.elevation {
            self.verify_gauge(&format!("{key}.elevation"), gauge)?;
        }
        if let Some(section) = &probe.flow {
            self.verify_section(&format!("{key}.flow"), section)?;
        }
        match &probe.patch {
            Some(PatchConfig { corners, .. }) => corners.verify(&self.context(), &format!("{key}.patch.box")),
            None => Ok(()),
        }
    }

    fn verify_gauge(&self, key: &str, gauge: &GaugeConfig) -> Result<()> {
        let single = gauge.x.is_some() || gauge.y.is_some();
        match gauge.row() {
            Some(_) if single => {
                let help = "write  elevation = { x = 1.16 }  or  elevation = { from = 1.0, to = 3.0, count = 5 }";
                Err(self.context().error_with_help(
                    key,
                    "a gauge stands at one place or is a row of them, not both",
                    help,
                ))
            }
            Some(row) => self.verify_row(key, &row, self.dimension - 1),
            None if gauge.x.is_none() || gauge.y.is_some() != (self.dimension == 3) => {
                let help = "write  elevation = { x = 1.16 } in 2-D, elevation = { x = 1.16, y = 0.3 } in 3-D";
                Err(self.context().error_with_help(key, "a gauge stands at x in 2-D, at x and y in 3-D", help))
            }
            None => Ok(()),
        }
    }

    /// A row of places that have so many coordinates.
    fn verify_row(&self, key: &str, row: &PointRowConfig, coordinates: usize) -> Result<()> {
        for (word, at) in [("from", &row.from), ("to", &row.to)] {
            if at.len() != coordinates || at.iter().any(|x| !x.is_finite()) {
                let what = format!("{word} has {} numbers: a place here has {coordinates}", at.len());
                let example = vec!["0.0"; coordinates].join(", ");
                return Err(self.context().error_with_help(
                    &format!("{key}.{word}"),
                    what,
                    format!("write  {word} = [{example}]"),
                ));
            }
        }
        let help = "write  count = 5  or  spacing = 0.1";
        if row.count.is_some() == row.spacing.is_some() {
            return Err(self.context().error_with_help(key, "a row has either a count or a spacing", help));
        }
        self.context().require_positive(&format!("{key}.spacing"), row.spacing)?;
        let (count, length) = (row.point_count(), row.length());
        if !(2..=MOST_PLACES).contains(&count) {
            let what = format!("a row has 2 to {MOST_PLACES} places, this one has {count}");
            return Err(self.context().error_with_help(key, what, help));
        }
        if length < LEAST_SPACING * (count - 1) as f64 {
            return Err(self.context().error_with_help(key, format!("{count} places do not fit on {length} m"), help));
        }
        Ok(())
    }

    fn verify_section(&self, key: &str, SectionConfig { from, to }: &SectionConfig) -> Result<()> {
        self.context().require_dimension(&format!("{key}.from"), from)?;
        self.context().require_dimension(&format!("{key}.to"), to)?;
        let flat = from.iter().zip(to).filter(|(a, b)| a == b).count();
        match self.dimension {
            2 if flat == 2 => Err(self.context().error_at(key, "a section from a point to itself has no length")),
            3 if flat != 1 => {
                let what = "a section in 3-D is a rectangle: its corners have one coordinate in common, and only one";
                let help = "write  flow = { from = [1.0, 0.0, 0.3], to = [1.0, 0.5, 0.6] }";
                Err(self.context().error_with_help(key, what, help))
            }
            _ => Ok(()),
        }
    }

    /// Stem of each probe's file: its name, or else the solid's name for a motion, `solid_force` for a force (as for run-up
    /// and patch), and the kind with a number from the second on.
    pub(super) fn probe_names(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        // How many of each kind before have no name of their own.
        let mut nameless: HashMap<&str, usize> = HashMap::new();
        for probe in &self.probe {
            let kind = probe.named_kinds().first().copied().unwrap_or("probe");
            let before = nameless.entry(kind).or_default();
            let alike = *before;
            *before += usize::from(probe.name.is_none());
            let ties = [&probe.joint, &probe.spring, &probe.rope];
            let patched = probe.patch.as_ref().map(|patch| &patch.solid);
            let pair = probe.contact.as_ref().map(|[a, b]| format!("{a}_{b}"));
            let of_solid =
                probe.force.as_ref().or(probe.balance.as_ref()).or(probe.runup.as_ref()).or(patched).or(pair.as_ref());
            let own = match (&probe.name, &probe.motion, of_solid) {
                (Some(name), ..) => name.clone(),
                (None, Some(solid), _) => solid.clone(),
                (None, None, Some(solid)) => format!("{solid}_{kind}"),
                _ => match ties.into_iter().flatten().next() {
                    Some(tie) => tie.clone(),
                    None if alike == 0 => kind.to_string(),
                    None => format!("{kind}_{}", alike + 1),
                },
            };
            names.push(own);
        }
        names
    }
}
