//! Probes measure a simulation and never change it.
//!
//! Each probe has a file: its configuration, validation, plan, columns with units, and construction. The registry `probe_kinds!` below
//! has a line for each. The rest of the program asks [`ProbeConfig`], [`ProbeKind`] and [`Probe`], and names no kind of probe.
//! A new probe needs its file, its lines here and its row in the documentation.
//!
//! Sums over the water are interpolations with the kernel W and the volumes V_b = m/ρ_b.

mod balance;
mod budget;
mod contact_force;
mod elevation;
mod energy;
mod flow;
mod force;
mod front;
mod joint;
mod line;
mod motion;
mod patch;
mod points;
mod pressure;
mod probe_row;
mod runup;
mod velocity;

pub use budget::EnergyBudgetProbe;
pub(crate) use budget::relative_residual;
pub(crate) use contact_force::ContactList;
pub use elevation::{ElevationProbe, GaugeSurface};
pub use energy::EnergyProbe;
pub use flow::FlowProbe;
pub use force::ForceProbe;
pub use front::FrontProbe;
pub use joint::JointProbe;
pub use line::LineProbe;
pub use motion::MotionProbe;
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
    elevation::{ElevationPlan, GaugeConfig},
    energy::EnergyPlan,
    flow::{FlowPlan, SectionConfig},
    force::ForcePlan,
    front::FrontPlan,
    joint::JointPlan,
    line::{RopePlan, SpringPlan},
    motion::MotionPlan,
    patch::{PatchConfig, PatchPlan},
    points::{PointRowConfig, PointsConfig},
    pressure::PressurePlan,
    runup::RunupPlan,
    velocity::VelocityPlan,
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, ErrorKind, Result},
    math::{BoxConfig, Vector},
    model::Dimension,
    simulation::{Simulation, find_by_name},
    solid::Dim,
    system::System,
};

/// Measures a simulation.
pub trait Probe<const D: usize>: Send {
    /// A name for each number, ending in its unit, as in `fx_N`.
    fn columns(&self) -> Vec<String>;

    /// A number for each column, now. NaN where there is nothing to measure, as in a dry place.
    fn sample(&self, sim: &Simulation<D>) -> Vec<f64>;

    /// Makes the reading `now` continue the reading `before`, for an angle that passes 180° or a volume that adds up.
    /// `dt` (s) lies between them. By default it changes nothing.
    fn continue_from(&self, before: &[f64], now: &mut [f64], dt: f64) {
        let _ = (before, now, dt);
    }

    /// Number of last columns that are sums since the start. No mean over time is taken of them.
    fn cumulative_columns(&self) -> usize {
        0
    }
}

/// A kind of probe, implemented by its resolved plan.
pub(crate) trait ProbeDefinition: Sized {
    /// The value of its key in a `[[probe]]` section.
    type Config;

    /// Name of its table in a report.
    const LABEL: &'static str;

    /// A valid line of a scene file, for the documentation and for error messages.
    const EXAMPLE: &'static str;

    /// Checks `config` at `key` against its scene.
    ///
    /// # Errors
    /// `Scene`, with the key.
    fn verify(config: &Self::Config, key: &str, scene: &dyn ProbeScope) -> Result<()>;

    /// The plan, with defaults filled in.
    fn from_config(config: &Self::Config) -> Self;

    /// Stem of the file of a probe without a name; `None` for the key with a number.
    fn default_name(_config: &Self::Config) -> Option<String> {
        None
    }

    /// Where it measures, if that is a fixed place.
    fn location(&self) -> Option<ProbeLocation<'_>> {
        None
    }

    /// The columns that the name of the probe alone means in a statistic, each with its place (m) if it has one.
    fn series(&self, _dimension: usize) -> Vec<(String, Option<Vec<f64>>)> {
        Vec::new()
    }

    /// The energy that its rows end with.
    fn energy_reading(&self) -> Option<EnergyReading> {
        None
    }

    /// Enables the records of the simulation that it reads.
    fn enable_records<const D: usize>(&self, _sim: &mut Simulation<D>)
    where
        Dim<D>: Dimension<D>,
    {
    }

    /// Builds the probe.
    ///
    /// # Errors
    /// `Scene` or `Usage` if what it names is not in the system.
    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>>;
}

/// A scene, as the validation of a probe sees it. Keys are as in `probe.0.flow.from`.
pub(crate) trait ProbeScope {
    /// 2 or 3.
    fn dimension(&self) -> usize;

    /// Whether the solid called `name` is free.
    fn is_free(&self, name: &str) -> bool;

    /// An error about `key`, with an example of it.
    fn error_at(&self, key: &str, what: &str) -> Error;

    /// An error about `key`, with advice.
    fn error_with_help(&self, key: &str, what: &str, help: &str) -> Error;

    /// Requires a solid called `name`.
    ///
    /// # Errors
    /// `Scene` if there is none.
    fn require_solid(&self, key: &str, name: &str) -> Result<()>;

    /// Requires a joint, spring or rope (`kind`) called `name`.
    ///
    /// # Errors
    /// `Scene` if there is none.
    fn require_constraint(&self, key: &str, kind: &str, name: &str) -> Result<()>;

    /// Requires that two solids can touch.
    ///
    /// # Errors
    /// `Scene` if they never touch.
    fn require_contact(&self, key: &str, between: &[String; 2]) -> Result<()>;

    /// Requires a vector with a finite number for each dimension.
    ///
    /// # Errors
    /// `Scene` if it is none.
    fn require_vector(&self, key: &str, x: &[f64]) -> Result<()>;

    /// Requires a positive number, if one is given.
    ///
    /// # Errors
    /// `Scene` if it is not positive.
    fn require_positive(&self, key: &str, x: Option<f64>) -> Result<()>;

    /// Requires a box with a volume.
    ///
    /// # Errors
    /// `Scene` if it has none.
    fn require_box(&self, key: &str, corners: &BoxConfig) -> Result<()>;
}

/// Where a probe measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ProbeLocation<'a> {
    /// At points, m.
    Points(&'a [Vec<f64>]),
    /// On vertical lines at horizontal places, m.
    Columns(&'a [Vec<f64>]),
    /// Over a section between two points, m.
    Section([&'a [f64]; 2]),
}

/// The energy that the rows of a probe end with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EnergyReading {
    /// The residual of the energy budget.
    Budget,
    /// The total energy.
    Total,
}

/// One probe, with defaults filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ProbePlan {
    /// Stem of the file it writes; unique within a scene.
    pub name: String,
    /// Its kind.
    pub kind: ProbeKind,
    /// Simulated time from one reading to the next, s.
    pub every: f64,
    /// Whether a reading is the mean since the one before.
    pub average: bool,
}

/// Defines [`ProbeConfig`] and [`ProbeKind`] from a line for each probe: its key, its configuration, and its plan. The order is that
/// of the keys in messages. A key without a plan writes a list, not a series.
macro_rules! probe_kinds {
    ($($(#[$meta:meta])* $key:ident: $config:ty $(=> $variant:ident($plan:ident))?;)*) => {
        /// One `[[probe]]`: exactly one of the words that say what it looks at.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        #[non_exhaustive]
        pub struct ProbeConfig {
            /// Stem of the file it writes.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub name: Option<String>,
            /// Simulated time between readings, s.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub every: Option<f64>,
            /// Whether a reading is the mean since the one before.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub average: Option<bool>,
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

        /// A valid line of a scene file for the kind of probe with this key.
        pub(crate) fn example(key: &str) -> Option<&'static str> {
            $($(
                if key == stringify!($key) {
                    return Some(<$plan as ProbeDefinition>::EXAMPLE);
                }
            )?)*
            (key == "contacts").then_some(contact_force::LIST_EXAMPLE)
        }

        impl ProbeConfig {
            /// The keys of the kinds that it names: one, if it is valid.
            pub(crate) fn keys(&self) -> Vec<&'static str> {
                let given = [$((stringify!($key), self.$key.is_some())),*];
                given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key).collect()
            }

            /// Its kind; `None` for a list.
            fn kind(&self) -> Option<ProbeKind> {
                $($(
                    if let Some(config) = &self.$key {
                        return Some(ProbeKind::$variant($plan::from_config(config)));
                    }
                )?)*
                None
            }

            /// Stem of its file by what it measures, if it has no name of its own.
            fn default_name(&self) -> Option<String> {
                $($(
                    if let Some(config) = &self.$key {
                        return $plan::default_name(config);
                    }
                )?)*
                None
            }

            /// Checks the configuration of its kind.
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
            /// Its key in a scene file.
            pub fn key(&self) -> &'static str {
                match self { $($(Self::$variant(_) => stringify!($key),)?)* }
            }

            /// Name of its table in a report.
            pub fn label(&self) -> &'static str {
                match self { $($(Self::$variant(_) => $plan::LABEL,)?)* }
            }

            /// As [`ProbeDefinition::location`].
            pub(crate) fn location(&self) -> Option<ProbeLocation<'_>> {
                match self { $($(Self::$variant(plan) => plan.location(),)?)* }
            }

            /// As [`ProbeDefinition::series`].
            pub(crate) fn series(&self, dimension: usize) -> Vec<(String, Option<Vec<f64>>)> {
                match self { $($(Self::$variant(plan) => plan.series(dimension),)?)* }
            }

            /// As [`ProbeDefinition::energy_reading`].
            pub(crate) fn energy_reading(&self) -> Option<EnergyReading> {
                match self { $($(Self::$variant(plan) => plan.energy_reading(),)?)* }
            }

            /// As [`ProbeDefinition::enable_records`].
            pub(crate) fn enable_records<const D: usize>(&self, sim: &mut Simulation<D>)
            where
                Dim<D>: Dimension<D>,
            {
                match self { $($(Self::$variant(plan) => plan.enable_records(sim),)?)* }
            }

            /// Builds the probe.
            ///
            /// # Errors
            /// `Scene` or `Usage` if what it names is not in the system.
            pub(crate) fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
                match self { $($(Self::$variant(plan) => plan.build(system),)?)* }
            }
        }
    };
}

probe_kinds! {
    /// Motion of the solid of this name.
    motion: String => Motion(MotionPlan);
    /// Force and torque on the solid of this name.
    force: String => Force(ForcePlan);
    /// What the joint of this name carries, and how it moves.
    joint: String => Joint(JointPlan);
    /// Length and tension of the spring of this name.
    spring: String => Spring(SpringPlan);
    /// Length and tension of the rope of this name.
    rope: String => Rope(RopePlan);
    /// Surface elevation at a place, or at a row of them.
    elevation: GaugeConfig => Elevation(ElevationPlan);
    /// Velocity at a point or a row of points, m.
    velocity: PointsConfig => Velocity(VelocityPlan);
    /// Pressure at a point or a row of points, m.
    pressure: PointsConfig => Pressure(PressurePlan);
    /// Flow through a section.
    flow: SectionConfig => Flow(FlowPlan);
    /// How far water runs up the solid of this name.
    runup: String => Runup(RunupPlan);
    /// Force and pressure on a part of a solid's face.
    patch: PatchConfig => Patch(PatchPlan);
    /// The leading edge of the water along x.
    #[schemars(extend("const" = true))]
    front: bool => Front(FrontPlan);
    /// Energies of water and bodies.
    #[schemars(extend("const" = true))]
    energy: bool => Energy(EnergyPlan);
    /// All loads on the free solid of this name, by kind.
    balance: String => Balance(LoadBalancePlan);
    /// How the two solids of these names press on each other.
    contact: [String; 2] => Contact(ContactForcePlan);
    /// How all that touch press on each other, as a list.
    #[schemars(extend("const" = true))]
    contacts: bool;
    /// Where energy came from and went.
    #[schemars(extend("const" = true))]
    budget: bool => Budget(EnergyBudgetPlan);
}

impl ProbeConfig {
    /// The motion of the solid of this name.
    pub fn motion(solid: impl Into<String>) -> Self {
        Self { motion: Some(solid.into()), ..Self::default() }
    }

    /// Force and torque on the solid of this name.
    pub fn force(solid: impl Into<String>) -> Self {
        Self { force: Some(solid.into()), ..Self::default() }
    }

    /// Reaction and motion of the joint of this name.
    pub fn joint(joint: impl Into<String>) -> Self {
        Self { joint: Some(joint.into()), ..Self::default() }
    }

    /// Length and tension of the spring of this name.
    pub fn spring(spring: impl Into<String>) -> Self {
        Self { spring: Some(spring.into()), ..Self::default() }
    }

    /// The plan of the probe in a run that ends at `until` (s); `None` for a list.
    pub(crate) fn to_plan(&self, until: f64) -> Option<ProbePlan> {
        let (name, every) = (self.name.clone().unwrap_or_default(), self.every.unwrap_or(until));
        self.kind().map(|kind| ProbePlan { name, kind, every, average: self.average.unwrap_or_default() })
    }

    /// The plan of the list of contacts; `None` for a probe that writes a series.
    pub(crate) fn to_contact_list(&self, until: f64) -> Option<ContactListPlan> {
        let (name, every) = (self.name.clone().unwrap_or_default(), self.every.unwrap_or(until));
        self.contacts.map(|_| ContactListPlan { name, every })
    }

    /// Checks the section at `key`, its name apart.
    ///
    /// # Errors
    /// `Scene` if it names no kind, several, or what its scene does not have.
    pub(crate) fn verify(&self, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_positive(&format!("{key}.every"), self.every)?;
        let named = self.keys();
        if named.len() != 1 {
            let named = if named.is_empty() { "nothing".into() } else { named.join(" and ") };
            let what = format!("a probe looks at one thing; this one at {named}");
            let help = format!("one of {}; a [[probe]] section for each", KEYS.join(", "));
            return Err(scene.error_with_help(key, &what, &help));
        }
        self.verify_kind(key, scene)?;
        contact_force::verify_list(self, key, scene)
    }

    /// Stems of the files of `probes`: the name, the default name, or the key with a number from the second on.
    pub(crate) fn names(probes: &[Self]) -> Vec<String> {
        let nameless = |probe: &&Self| probe.name.is_none();
        let name = |(i, probe): (usize, &Self)| {
            let key = probe.keys().first().copied().unwrap_or("probe");
            let alike = || {
                probes[..i].iter().filter(nameless).filter(|other| other.keys().first() == probe.keys().first()).count()
            };
            let numbered = || match alike() {
                0 => key.to_string(),
                before => format!("{key}_{}", before + 1),
            };
            probe.name.clone().or_else(|| probe.default_name()).unwrap_or_else(numbered)
        };
        probes.iter().enumerate().map(name).collect()
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

/// Names of the axes: the last is up.
const fn axes<const D: usize>() -> &'static [&'static str] {
    match D {
        2 => &["x", "y"],
        _ => &["x", "y", "z"],
    }
}

/// The number of the solid called `name`.
///
/// # Errors
/// `Scene` if there is none: says the nearest name, or all of them.
pub fn find_solid<const D: usize>(system: &System<D>, name: &str) -> Result<usize> {
    find_by_name("solid", name, system.solids().iter().map(|s| s.spec.name.as_str()))
}

/// A point of `D` components from as many numbers.
///
/// # Errors
/// `Usage` if their count is another or one of them is not finite.
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

/// Mean of a quantity of the water at the point `x` (m), weighed by V_b W and normalised (Shepard):
/// exact for a constant, second order inside the water. `None` where the water fills less than a quarter of
/// the kernel's weight, as in air.
fn interpolate<const D: usize, const C: usize>(
    system: &System<D>,
    x: &Vector<D>,
    quantity: impl Fn(usize, &Vector<D>) -> [f64; C],
) -> Option<[f64; C]> {
    let (mass, rho) = (system.particle_mass(), system.fluid().rho);
    let (mut sum, mut weight) = ([0.0; C], 0.0);
    system.visit_fluid_near(x, &mut |b, r, w| {
        let share = mass / rho[b] * w;
        weight += share;
        for (s, q) in sum.iter_mut().zip(quantity(b, r)) {
            *s += share * q;
        }
    });
    (weight >= 0.25).then(|| sum.map(|s| s / weight))
}
