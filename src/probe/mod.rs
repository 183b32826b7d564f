//! Probes measure a simulation and never change it.
//!
//! Each kind of probe has a file with its configuration, validation, plan, columns with units, and construction. The
//! registry `probe_kinds!` below has a line for each kind. The rest of the program uses [`ProbeConfig`], [`ProbeKind`]
//! and [`Probe`] and does not depend on any kind of probe. A new kind needs its file, its lines in this file and its
//! row in the documentation.
//!
//! Sums over the water are interpolations with the kernel W and the volumes V_b = m/ρ_b.

mod balance;
mod budget;
mod contact_force;
mod current;
mod definition;
mod elevation;
mod energy;
mod flow;
mod force;
mod front;
mod joint;
mod line;
mod mooring;
mod motion;
mod mounting;
mod open_boundary;
mod patch;
mod points;
mod pressure;
mod probe_row;
mod runup;
mod velocity;

pub use budget::EnergyBudgetProbe;
pub(crate) use budget::relative_residual;
pub(crate) use contact_force::ContactList;
pub use current::CurrentProbe;
pub(crate) use definition::{EnergyReading, ProbeDefinition, ProbeLocation, ProbeScope};
pub use elevation::{ElevationProbe, GaugeSurface};
pub use energy::EnergyProbe;
pub use flow::FlowProbe;
pub use force::ForceProbe;
pub use front::FrontProbe;
pub use joint::JointProbe;
pub use line::LineProbe;
pub use mooring::MooringProbe;
pub use motion::MotionProbe;
pub use open_boundary::OpenBoundaryProbe;
pub use patch::PatchProbe;
pub use pressure::PressureProbe;
pub use probe_row::ProbeRow;
pub(crate) use probe_row::column_at_place;
pub use runup::RunupProbe;
pub use velocity::VelocityProbe;
#[doc(hidden)]
pub use {
    balance::LoadBalancePlan,
    budget::EnergyBudgetPlan,
    contact_force::{ContactForcePlan, ContactListPlan},
    current::CurrentPlan,
    elevation::{ElevationPlan, GaugeConfig},
    energy::EnergyPlan,
    flow::{FlowPlan, SectionConfig},
    force::ForcePlan,
    front::FrontPlan,
    joint::JointPlan,
    line::{RopePlan, SpringPlan},
    mooring::MooringPlan,
    motion::MotionPlan,
    open_boundary::OpenBoundaryPlan,
    patch::{PatchConfig, PatchPlan},
    points::{PointRowConfig, PointsConfig},
    pressure::PressurePlan,
    runup::RunupPlan,
    velocity::VelocityPlan,
};

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, ErrorKind, Result},
    math::{Bounds, Vector},
    simulation::{Dimension, Simulation, find_by_name},
    solid::Dim,
    system::System,
};

/// Measures a simulation.
pub trait Probe<const D: usize>: Send {
    /// Returns the name of each column. A name ends in the unit, as in `fx_N`.
    fn columns(&self) -> Vec<String>;

    /// Returns the present value of each column. A value is NaN if the probe has nothing to measure, as at a dry place or on a
    /// removed solid.
    fn sample(&self, sim: &Simulation<D>) -> Vec<f64>;

    /// Adjusts the reading `now` to continue the reading `before`, for an angle that passes 180° or a volume that
    /// accumulates. The readings are `dt` (s) apart. The default implementation changes nothing.
    fn continue_from(&self, before: &[f64], now: &mut [f64], dt: f64) {
        let _ = (before, now, dt);
    }

    /// Whether the probe has angles that go on past half a turn. A run reads such a probe at every step, so that a body may turn
    /// farther between two rows. By default no.
    fn follows_angles(&self) -> bool {
        false
    }

    /// Returns the part of the simulation that the probe reads. While the water is on a device, the run fetches only the parts
    /// that are read.
    fn reads(&self) -> ProbeReads {
        ProbeReads::Water
    }

    /// Returns the boxes (m) in which a probe of the water reads it now, or `None` if it may read all water. Where several ranks have
    /// the water, the run fetches only the water that is read.
    fn water_ranges(&self, system: &System<D>) -> Option<Vec<Bounds<D>>> {
        let _ = system;
        None
    }

    /// Reads what later readings refer to, as the level at the start. The default implementation reads nothing.
    fn read_start(&mut self, system: &System<D>) {
        let _ = system;
    }
}

/// The part of a simulation that a probe reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProbeReads {
    /// Motions of the solids and the loads on them.
    Solids,
    /// The water too.
    Water,
    /// The water, and the force on each boundary particle.
    BoundaryForces,
}

/// The plan of a probe, with defaults filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ProbePlan {
    /// Stem of the file that the probe writes; unique within a scene.
    pub name: String,
    /// Kind of the probe.
    pub kind: ProbeKind,
    /// Simulated time from one reading to the next, s.
    pub every: f64,
    /// Whether a reading is the time mean since the previous reading.
    pub average: bool,
}

impl ProbePlan {
    /// Returns whether each reading in `column` is the time mean since the previous row.
    pub fn is_mean(&self, column: &str) -> bool {
        self.average && !self.kind.is_cumulative(column)
    }

    /// Returns the plan and the column of `series`, named as in `box.heave_m`, or `None` if none of `probes` has this name.
    pub(crate) fn of_series<'a>(probes: &'a [Self], series: &'a str) -> Option<(&'a Self, &'a str)> {
        let (name, column) = series.split_once('.')?;
        Some((probes.iter().find(|probe| probe.name == name)?, column))
    }
}

/// Defines [`ProbeConfig`] and [`ProbeKind`]. Each line defines a kind of probe by its key, its configuration and its
/// plan. Messages list the keys in this order. A probe without a plan writes a list, not a series.
macro_rules! probe_kinds {
    ($($(#[$meta:meta])* $key:ident: $config:ty $(=> $variant:ident($plan:ident))?;)*) => {
        /// A `[[probe]]` section. It has exactly one of the keys that select the kind of probe.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        #[non_exhaustive]
        pub struct ProbeConfig {
            /// Stem of the file that the probe writes.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub name: Option<String>,
            /// Simulated time between readings, s.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub every: Option<f64>,
            /// Whether a reading is the time mean since the previous reading.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub average: Option<bool>,
            /// The solid that a gauge or a point goes with; places are in the frame of the solid then.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub on: Option<String>,
            $(
                $(#[$meta])*
                #[serde(skip_serializing_if = "Option::is_none")]
                pub $key: Option<$config>,
            )*
        }

        /// A kind of probe, with its plan.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[non_exhaustive]
        pub enum ProbeKind {
            $($(
                #[doc = concat!("Scene key `", stringify!($key), "`.")]
                $variant($plan),
            )?)*
        }

        /// The keys of all kinds.
        const KEYS: &[&str] = &[$(stringify!($key)),*];

        /// Returns a valid line of a scene file for the kind of probe with this key, or `None` if the key is unknown.
        pub(crate) fn example(key: &str) -> Option<&'static str> {
            $($(
                if key == stringify!($key) {
                    return Some(<$plan as ProbeDefinition>::EXAMPLE);
                }
            )?)*
            (key == "contacts").then_some(contact_force::LIST_EXAMPLE)
        }

        impl ProbeConfig {
            /// Returns the keys of all kinds that are set: exactly one key if the section is valid.
            pub(crate) fn keys(&self) -> Vec<&'static str> {
                let given = [$((stringify!($key), self.$key.is_some())),*];
                given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key).collect()
            }

            /// Returns the kind of the probe, or `None` if it writes a list.
            fn kind(&self) -> Option<ProbeKind> {
                $($(
                    if let Some(config) = &self.$key {
                        return Some(ProbeKind::$variant($plan::from_config(config)));
                    }
                )?)*
                None
            }

            /// Whether a probe of the kind that is set can go with a solid.
            fn is_mountable(&self) -> bool {
                $($(
                    if self.$key.is_some() {
                        return $plan::MOUNTABLE;
                    }
                )?)*
                false
            }

            /// Returns the default file stem, from the object that the probe measures, if its kind has a default stem.
            fn default_name(&self) -> Option<String> {
                $($(
                    if let Some(config) = &self.$key {
                        return $plan::default_name(config);
                    }
                )?)*
                None
            }

            /// Checks the configuration of the kind that is set.
            fn verify_kind(&self, key: &str, scene: &dyn ProbeScope) -> Result<()> {
                $($(
                    if let Some(config) = &self.$key {
                        $plan::verify(config, &format!("{key}.{}", stringify!($key)), scene)?;
                    }
                )?)*
                Ok(())
            }
        }

        impl ProbeKind {
            /// Returns the key of the kind in a scene file.
            pub fn key(&self) -> &'static str {
                match self { $($(Self::$variant(_) => stringify!($key),)?)* }
            }

            /// Name of the table of this kind in a report.
            pub fn label(&self) -> &'static str {
                match self { $($(Self::$variant(_) => $plan::LABEL,)?)* }
            }

            /// Lets the probe go with a solid: see [`ProbeDefinition::mount`].
            fn mount(&mut self, on: &str) {
                match self { $($(Self::$variant(plan) => plan.mount(on),)?)* }
            }

            /// Returns the place of measurement: see [`ProbeDefinition::location`].
            pub(crate) fn location(&self) -> Option<ProbeLocation<'_>> {
                match self { $($(Self::$variant(plan) => plan.location(),)?)* }
            }

            /// Returns the columns for a statistic: see [`ProbeDefinition::series`].
            pub(crate) fn series(&self, dimension: usize) -> Vec<(String, Option<Vec<f64>>)> {
                match self { $($(Self::$variant(plan) => plan.series(dimension),)?)* }
            }

            /// Returns the kind of energy in the last column: see [`ProbeDefinition::energy_reading`].
            pub(crate) fn energy_reading(&self) -> Option<EnergyReading> {
                match self { $($(Self::$variant(plan) => plan.energy_reading(),)?)* }
            }

            /// Returns whether `column` adds up over the run: see [`ProbeDefinition::is_cumulative`].
            fn is_cumulative(&self, column: &str) -> bool {
                match self { $($(Self::$variant(plan) => plan.is_cumulative(column),)?)* }
            }

            /// Enables the records of the simulation that the probe reads. They begin anew.
            pub fn enable_records<const D: usize>(&self, sim: &mut Simulation<D>)
            where
                Dim<D>: Dimension<D>,
            {
                match self { $($(Self::$variant(plan) => plan.enable_records(sim),)?)* }
            }

            /// Builds the probe. It reads NaN where it needs records that are not enabled.
            ///
            /// # Errors
            /// `Scene` or `Usage` if the system lacks an object that the probe names.
            pub fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
                let mut probe = self.build_unread(system)?;
                probe.read_start(system);
                Ok(probe)
            }

            /// As [`ProbeKind::build`]; the probe has not read the water.
            pub(crate) fn build_unread<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
                match self { $($(Self::$variant(plan) => plan.build(system),)?)* }
            }
        }
    };
}

probe_kinds! {
    /// Motion of the solid with this name.
    motion: String => Motion(MotionPlan);
    /// Force and torque on the solid with this name.
    force: String => Force(ForcePlan);
    /// Reaction and motion of the joint with this name.
    joint: String => Joint(JointPlan);
    /// Length and tension of the spring with this name.
    spring: String => Spring(SpringPlan);
    /// Length and tension of the rope with this name.
    rope: String => Rope(RopePlan);
    /// Tension and touchdown of the mooring line with this name.
    mooring: String => Mooring(MooringPlan);
    /// Surface elevation at one place or at a row of places.
    elevation: GaugeConfig => Elevation(ElevationPlan);
    /// Velocity at a point or a row of points, m.
    velocity: PointsConfig => Velocity(VelocityPlan);
    /// Pressure at a point or a row of points, m.
    pressure: PointsConfig => Pressure(PressurePlan);
    /// Flow through a section.
    flow: SectionConfig => Flow(FlowPlan);
    /// Run-up of the water on the solid with this name.
    runup: String => Runup(RunupPlan);
    /// Force and pressure on a part of a solid's face.
    patch: PatchConfig => Patch(PatchPlan);
    /// The leading edge of the water along x.
    #[schemars(extend("const" = true))]
    front: bool => Front(FrontPlan);
    /// Energies of water and bodies.
    #[schemars(extend("const" = true))]
    energy: bool => Energy(EnergyPlan);
    /// All loads on the free solid with this name, by kind.
    balance: String => Balance(LoadBalancePlan);
    /// Contact force between the two solids with these names.
    contact: [String; 2] => Contact(ContactForcePlan);
    /// Contact forces of all pairs of solids that touch, as a list.
    #[schemars(extend("const" = true))]
    contacts: bool;
    /// Energy budget since the start: sources, sinks and residual.
    #[schemars(extend("const" = true))]
    budget: bool => Budget(EnergyBudgetPlan);
    /// Water that has passed through the open boundary with this name.
    face: String => Face(OpenBoundaryPlan);
    /// Discharge of the current and the force that holds it.
    #[schemars(extend("const" = true))]
    current: bool => Current(CurrentPlan);
}

impl ProbeConfig {
    /// Returns a probe of the motion of the solid called `solid`.
    pub fn motion(solid: impl Into<String>) -> Self {
        Self { motion: Some(solid.into()), ..Self::default() }
    }

    /// Force and torque on the solid with this name.
    pub fn force(solid: impl Into<String>) -> Self {
        Self { force: Some(solid.into()), ..Self::default() }
    }

    /// Returns a probe of the reaction and motion of the joint called `joint`.
    pub fn joint(joint: impl Into<String>) -> Self {
        Self { joint: Some(joint.into()), ..Self::default() }
    }

    /// Length and tension of the spring with this name.
    pub fn spring(spring: impl Into<String>) -> Self {
        Self { spring: Some(spring.into()), ..Self::default() }
    }

    /// Returns the plan of the probe in a run that ends at `until` (s), or `None` if the probe writes a list.
    pub(crate) fn to_plan(&self, until: f64) -> Option<ProbePlan> {
        let (name, every) = (self.name.clone().unwrap_or_default(), self.every.unwrap_or(until));
        let mut kind = self.kind()?;
        if let Some(on) = &self.on {
            kind.mount(on);
        }
        Some(ProbePlan { name, kind, every, average: self.average.unwrap_or_default() })
    }

    /// Returns the plan of the list of contacts, or `None` if the probe writes a series.
    pub(crate) fn to_contact_list(&self, until: f64) -> Option<ContactListPlan> {
        let (name, every) = (self.name.clone().unwrap_or_default(), self.every.unwrap_or(until));
        self.contacts.map(|_| ContactListPlan { name, every })
    }

    /// Checks the section at `key`, except its name.
    ///
    /// # Errors
    /// `Scene` if the section names no kind or several kinds, or an object that the scene does not have.
    pub(crate) fn verify(&self, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_positive(&format!("{key}.every"), self.every)?;
        let named = self.keys();
        if named.len() != 1 {
            let named = if named.is_empty() { "nothing".into() } else { named.join(" and ") };
            let what = format!("a probe looks at one thing; this one at {named}");
            let help = format!("one of {}; a [[probe]] section for each", KEYS.join(", "));
            return Err(scene.error_with_help(key, &what, &help));
        }
        if let Some(on) = &self.on {
            let key = format!("{key}.on");
            if !self.is_mountable() {
                let what = format!("a probe of {} does not go with a solid", named[0]);
                let help = "on  belongs to  elevation, velocity and pressure";
                return Err(scene.error_with_help(&key, &what, help));
            }
            scene.require_solid(&key, on)?;
        }
        self.verify_kind(key, scene)?;
        contact_force::verify_list(self, key, scene)
    }

    /// Returns the file stems of `probes`. A stem is the name, the default name, or the key. From the second unnamed probe
    /// with the same key on, the key has a number.
    pub(crate) fn names(probes: &[Self]) -> Vec<String> {
        let mut nameless = BTreeMap::<&str, usize>::new();
        let name = |probe: &Self| {
            if let Some(name) = &probe.name {
                return name.clone();
            }
            let key = probe.keys().first().copied().unwrap_or("probe");
            let number = *nameless.entry(key).and_modify(|number| *number += 1).or_insert(1);
            probe.default_name().unwrap_or_else(|| match number {
                1 => key.to_string(),
                number => format!("{key}_{number}"),
            })
        };
        probes.iter().map(name).collect()
    }
}

/// Refuses `key = false`.
fn require_true(given: bool, key: &str, scene: &dyn ProbeScope) -> Result<()> {
    if given {
        return Ok(());
    }
    let word = key.rsplit('.').next().unwrap_or(key);
    Err(scene.error_with_help(key, &format!("{word} = false watches nothing"), "remove it"))
}

/// Returns the names of the axes. The last axis points up.
const fn axes<const D: usize>() -> &'static [&'static str] {
    match D {
        2 => &["x", "y"],
        _ => &["x", "y", "z"],
    }
}

/// Returns the index of the solid called `name`.
///
/// # Errors
/// `Scene` if there is no such solid; the message contains the nearest name or all names.
pub fn find_solid<const D: usize>(system: &System<D>, name: &str) -> Result<usize> {
    find_by_name("solid", name, system.solids().iter().map(|s| s.spec.name.as_str()))
}

/// Returns the point whose first `count` components are the numbers `at`; the other components are 0.
///
/// # Errors
/// `Usage` if `at` does not have `count` numbers or a number is not finite.
fn point<const D: usize>(at: &[f64], count: usize) -> Result<Vector<D>> {
    if at.len() != count || at.iter().any(|x| !x.is_finite()) {
        let what = format!("a probe's place needs {count} finite coordinates (m); got {at:?}");
        return Err(Error::new(ErrorKind::Usage, what));
    }
    let mut x = Vector::<D>::zeros();
    for (xi, &a) in x.iter_mut().zip(at) {
        *xi = a;
    }
    Ok(x)
}

/// Returns the row of a probe of a solid that was removed.
fn empty_row<const D: usize>(probe: &impl Probe<D>) -> Vec<f64> {
    vec![f64::NAN; probe.columns().len()]
}

/// Least share of the kernel's weight that the water fills where a quantity has a value: half of that at a flat wall. Less is spray.
const WET: f64 = 0.25;

/// Share of the kernel's weight in solids, from which on a point lies in a corner: it is half at a flat wall.
const CORNER: f64 = 0.6;

/// Least share that the water fills in a corner: half of that at the corner of a box in 3-D.
const WET_CORNER: f64 = 0.06;

/// Returns the mean of a quantity of the water at the point `x` (m), weighted by V_b W and normalised (Shepard). The
/// mean is exact for a constant and of second order inside the water. Returns `None` if the water fills less than a
/// quarter of the kernel's weight, as in air; in a corner, less than half of what the solids leave.
fn interpolate<const D: usize, const C: usize>(
    system: &System<D>,
    x: &Vector<D>,
    quantity: impl Fn(usize, &Vector<D>) -> [f64; C],
) -> Option<[f64; C]> {
    let (mass, rho) = (system.particle_mass(), system.water_and_buffers().rho);
    let (mut sum, mut weight) = ([0.0; C], 0.0);
    system.visit_water_and_buffers_near(x, &mut |b, r, w| {
        let share = mass / rho[b] * w;
        weight += share;
        for (s, q) in sum.iter_mut().zip(quantity(b, r)) {
            *s += share * q;
        }
    });
    let least = || {
        let (volume, mut solid) = (system.model().dp.powi(D as i32), 0.0);
        system.visit_boundary_near(x, &mut |_, _, w| solid += volume * w);
        if solid < CORNER { WET } else { 0.5 * (1.0 - solid) }
    };
    (weight >= WET || weight > 0.0 && weight >= least().max(WET_CORNER)).then(|| sum.map(|s| s / weight))
}
