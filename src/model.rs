//! The chosen laws as data; the one place where a name becomes a type.

pub use crate::sph::{boundary::Slip, density_diffusion::Diffusion, viscosity::Viscosity};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    interaction::{self, PairLoop},
    math::Vector,
    math::simd::{self, Level},
    neighbours::NeighbourLists,
    solid::{Dim, HasEngine},
    sph::{
        FluidProperties, Term, Units,
        boundary::Repulsion,
        continuity::Continuity,
        density_diffusion::Fourtakas,
        gradient_correction::CorrectedGradientTerm,
        kernel::{self, Kernel as _, SUPPORT_RATIO},
        particle_shifting::{Shift, ShiftTerm, ShiftingSuppressionTerm},
        pressure::{Pressure, Tensile},
        viscosity::{Artificial, Riemann, TermConsumer},
    },
};

/// The kernel. Scene key `model.kernel`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum KernelKind {
    /// Cubic spline (Monaghan & Lattanzio 1985), by default with Monaghan's (2000) tensile correction.
    Cubic {
        /// Whether the tensile correction is on.
        #[serde(default = "yes")]
        tensile: bool,
    },
    /// Wendland C2.
    Wendland,
}

fn yes() -> bool {
    true
}

/// The pressure gradient. Scene key `model.gradient`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum PressureGradient {
    /// The plain kernel gradient.
    #[default]
    Plain,
    /// Corrected for the arrangement of the neighbours (Bonet & Lok 1999) near the surface, to some 8 dp below it; with the Wendland
    /// kernel and without shifting.
    NearSurface,
    /// Corrected at every depth, which stirs still water; with the Wendland kernel and without shifting.
    Corrected,
}

/// Particle shifting. Scene key `model.shifting`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Shifting {
    /// None (the paper's type 0).
    None,
    /// Particles without any solid within the kernel support (type 1).
    AwayFromSolids(Shift),
    /// Particles without a fixed solid within the kernel support (type 2).
    AwayFromFixed(Shift),
    /// All particles (type 3).
    Everywhere(Shift),
}

impl Shifting {
    /// Whether water is not shifted beside a solid, which is `fixed` or not.
    pub(crate) fn suppressed_beside(self, fixed: bool) -> bool {
        match self {
            Self::AwayFromSolids(_) => true,
            Self::AwayFromFixed(_) => fixed,
            Self::None | Self::Everywhere(_) => false,
        }
    }
}

/// The pair loop. Scene key `model.sweep`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum PairLoopKind {
    /// SIMD in single precision where the processor supports it (x86-64 with AVX2, ARM); otherwise the reference.
    #[default]
    Fast,
    /// The reference in double precision.
    Reference,
}

impl PairLoopKind {
    /// The SIMD instructions that it uses, if any.
    pub fn instruction_set(self) -> Option<Level> {
        match self {
            Self::Fast => simd::best_instruction_set(),
            Self::Reference => None,
        }
    }
}

/// How boundary particles act on the water. Scene key `model.walls`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Walls {
    /// Dynamic boundary particles: they obey continuity, and their density does not fall below ρ₀.
    #[serde(rename = "dbc")]
    Dynamic,
    /// The same, and their density relaxes to that of the water's pressure extrapolated to them (Adami et al. 2012).
    #[serde(alias = "settling")]
    #[schemars(extend("also" = "settling"))]
    RelaxedAdami,
}

/// The time integration scheme. Scene key `time.scheme`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum TimeScheme {
    /// Verlet (leapfrog) with an Euler step every `euler_every` steps, or sooner under strong damping.
    Verlet {
        /// Steps from one Euler step to the next.
        #[serde(default = "fifty")]
        euler_every: u32,
    },
    /// Symplectic position Verlet: two force passes a step.
    Symplectic,
}

fn fifty() -> u32 {
    50
}

/// All parameters of the equations, with every default filled in.
///
/// ```
/// use pontoon::model::{Model, Slip, TimeScheme};
///
/// // Water 0.5 m deep at a spacing of 0.01 m in 2-D.
/// let model = Model::water(2, 0.01, 0.5).slip(Slip::None).scheme(TimeScheme::Symplectic).cfl(0.3);
/// assert!((model.h - 0.017).abs() < 1e-15);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Model {
    /// Kernel.
    pub kernel: KernelKind,
    /// Smoothing length h, m.
    pub h: f64,
    /// Particle spacing dp, m.
    pub dp: f64,
    /// Reference density ρ₀, kg/m³.
    pub rho0: f64,
    /// Speed of sound c₀, m/s.
    pub c0: f64,
    /// Exponent γ of the equation of state, –.
    pub gamma: f64,
    /// Acceleration of gravity, m/s²: `D` components.
    pub gravity: Vec<f64>,
    /// The pressure's gradient.
    #[serde(default)]
    pub gradient: PressureGradient,
    /// Viscosity.
    pub viscosity: Viscosity,
    /// Density diffusion.
    pub diffusion: Diffusion,
    /// Particle shifting.
    pub shifting: Shifting,
    /// Walls.
    pub walls: Walls,
    /// How water slips along solids.
    pub slip: Slip,
    /// The pair loop.
    #[serde(default)]
    pub pair_loop: PairLoopKind,
    /// Time scheme.
    pub scheme: TimeScheme,
    /// Courant number, –.
    pub cfl: f64,
    /// Longest time step allowed, s (infinite if none).
    pub dt_max: f64,
}

/// Default of c₀ over √(g·depth), –.
pub(crate) const C0_FACTOR: f64 = 10.0;

/// Depth of the water over dp beyond which scenes with free bodies get [`Model::deep_water`], –.
pub(crate) const DEEP: f64 = 100.0;

/// Defaults of h over dp in 2-D and 3-D where a paddle makes waves, –.
pub(crate) const WAVES_H_OVER_DP: [f64; 2] = [2.4, 1.8];

/// The same in 2-D scenes with free bodies, –.
pub(crate) const BODIES_IN_WAVES_H_OVER_DP: f64 = 2.0;

/// Depth over dp at which α = 0.02 gives the viscosity that deep water gets, –: a body of ten rows in water as deep as itself.
const VISCOUS_ROWS: f64 = 10.0;

/// Default of h over dp in deep 2-D water, –.
const DEEP_H_OVER_DP: f64 = 2.1;

impl Model {
    /// Water `depth` (m) deep at spacing `dp` (m) in `dimension` 2 or 3, with the choices of a scene that names
    /// none, without free bodies or waves by name: Wendland, h = 1.7 dp (1.5 dp in 3-D), c₀ = 10 √(g·depth), Riemann
    /// dissipation, Fourtakas' δ = 0.1, no shifting, walls relaxed Adami with free slip, symplectic at CFL 0.4. The methods
    /// below change one choice each.
    pub fn water(dimension: usize, dp: f64, depth: f64) -> Self {
        const G: f64 = 9.81;
        let mut gravity = vec![0.0; dimension];
        if let Some(down) = gravity.last_mut() {
            *down = -G;
        }
        Self {
            kernel: KernelKind::Wendland,
            h: dp * if dimension == 3 { 1.5 } else { 1.7 },
            dp,
            rho0: 1000.0,
            c0: C0_FACTOR * (G * depth).sqrt(),
            gamma: 7.0,
            gravity,
            gradient: PressureGradient::Plain,
            viscosity: Viscosity::Riemann(Riemann::default()),
            diffusion: Diffusion::Fourtakas(Fourtakas::default()),
            shifting: Shifting::None,
            walls: Walls::RelaxedAdami,
            slip: Slip::Free,
            pair_loop: PairLoopKind::Fast,
            scheme: TimeScheme::Symplectic,
            cfl: 0.4,
            dt_max: f64::INFINITY,
        }
    }

    /// The same model with the defaults of scenes in which a paddle or a face makes waves by name: gradients corrected near the surface,
    /// Riemann dissipation with a threshold, and h = 2.4 dp (1.8 dp in 3-D).
    pub fn for_waves(self) -> Self {
        let viscosity = Viscosity::Riemann(Riemann { threshold: Some(Riemann::WAVES_THRESHOLD), ..Riemann::default() });
        Self { gradient: PressureGradient::NearSurface, viscosity, ..self.h_over_dp(WAVES_H_OVER_DP) }
    }

    /// As [`Self::for_waves`], with free bodies: in 2-D h = 2 dp. A wider kernel takes more from the added mass and adds more to the
    /// damping in roll.
    pub fn for_bodies_in_waves(self) -> Self {
        self.for_waves().h_over_dp([BODIES_IN_WAVES_H_OVER_DP, WAVES_H_OVER_DP[1]])
    }

    /// The same model with the defaults of scenes with free bodies, without waves by name: artificial viscosity, α = 0.02. With the
    /// Riemann dissipation a box of ten rows rolls 3 % too fast.
    pub fn for_free_bodies(self) -> Self {
        Self { viscosity: Viscosity::Artificial(Artificial::default()), ..self }
    }

    /// The same model with the defaults for free bodies in water `depth` (m) deep: none changes up to 100 dp. Beyond, α becomes
    /// 0.02 √(10 dp/depth), so that artificial viscosity, which goes with α c₀ h, does not grow with the depth. In 2-D h
    /// becomes 2.1 dp: the arrangement of the particles resists slow bodies in proportion to the pressure, and less with a wider
    /// kernel.
    pub fn deep_water(mut self, depth: f64) -> Self {
        if depth <= DEEP * self.dp {
            return self;
        }
        if let Viscosity::Artificial(law) = &mut self.viscosity {
            law.alpha *= (VISCOUS_ROWS * self.dp / depth).sqrt();
        }
        let in_3d = self.h / self.dp;
        self.h_over_dp([DEEP_H_OVER_DP, in_3d])
    }

    /// The same model with these h over dp (–) in 2-D and in 3-D.
    fn h_over_dp(self, [in_2d, in_3d]: [f64; 2]) -> Self {
        let ratio = if self.gravity.len() == 2 { in_2d } else { in_3d };
        Self { h: ratio * self.dp, ..self }
    }

    /// The same model with this kernel.
    pub fn kernel(self, kernel: KernelKind) -> Self {
        Self { kernel, ..self }
    }

    /// The same model with this smoothing length (m).
    pub fn h(self, h: f64) -> Self {
        Self { h, ..self }
    }

    /// The same model with this reference density (kg/m³).
    pub fn rho0(self, rho0: f64) -> Self {
        Self { rho0, ..self }
    }

    /// The same model with this speed of sound (m/s).
    pub fn c0(self, c0: f64) -> Self {
        Self { c0, ..self }
    }

    /// The same model with this exponent of the equation of state (–).
    pub fn gamma(self, gamma: f64) -> Self {
        Self { gamma, ..self }
    }

    /// The same model with this acceleration of gravity (m/s²), one component along each axis.
    pub fn gravity(self, gravity: impl Into<Vec<f64>>) -> Self {
        Self { gravity: gravity.into(), ..self }
    }

    /// The same model with this pressure gradient.
    pub fn gradient(self, gradient: PressureGradient) -> Self {
        Self { gradient, ..self }
    }

    /// The same model with this viscosity.
    pub fn viscosity(self, viscosity: Viscosity) -> Self {
        Self { viscosity, ..self }
    }

    /// The same model with this density diffusion.
    pub fn diffusion(self, diffusion: Diffusion) -> Self {
        Self { diffusion, ..self }
    }

    /// The same model with this particle shifting.
    pub fn shifting(self, shifting: Shifting) -> Self {
        Self { shifting, ..self }
    }

    /// The same model with these walls.
    pub fn walls(self, walls: Walls) -> Self {
        Self { walls, ..self }
    }

    /// The same model with this condition along the faces of solids.
    pub fn slip(self, slip: Slip) -> Self {
        Self { slip, ..self }
    }

    /// The same model with this pair loop.
    pub fn pair_loop(self, pair_loop: PairLoopKind) -> Self {
        Self { pair_loop, ..self }
    }

    /// The same model with this time integration scheme.
    pub fn scheme(self, scheme: TimeScheme) -> Self {
        Self { scheme, ..self }
    }

    /// The same model with this Courant number (–).
    pub fn cfl(self, cfl: f64) -> Self {
        Self { cfl, ..self }
    }

    /// The same model with time steps of this length (s) at most.
    pub fn dt_max(self, dt_max: f64) -> Self {
        Self { dt_max, ..self }
    }

    /// The kernel's support radius 2h, m.
    pub fn support_radius(&self) -> f64 {
        SUPPORT_RATIO * self.h
    }

    /// Layers of boundary particles, dp apart, that fill the kernel's support.
    pub(crate) fn boundary_layers(&self) -> usize {
        // A support of 3.0 dp needs three layers, also where rounding makes it 3 + 1e-16.
        (self.support_radius() / self.dp - 1e-9).ceil().max(1.0) as usize
    }

    /// The constants that the laws share.
    pub fn fluid_properties<const D: usize>(&self) -> FluidProperties<D> {
        FluidProperties {
            h: self.h,
            dp: self.dp,
            rho0: self.rho0,
            c0: self.c0,
            gamma: self.gamma,
            gravity: Vector::from_fn(|i, _| self.gravity.get(i).copied().unwrap_or(0.0)),
        }
    }

    /// Kernel value W (1/mᴰ) at squared distance `r2` (m²) in `dimension` 2 or 3.
    pub(crate) fn kernel_value(&self, r2: f64, dimension: usize) -> f64 {
        match self.kernel {
            KernelKind::Cubic { .. } => kernel::Cubic::new(self.h, dimension).w(r2),
            KernelKind::Wendland => kernel::Wendland::new(self.h, dimension).w(r2),
        }
    }

    /// V₀ ∂W (1/m²) of the squared distance (m²), normalised as in the pair loop.
    pub(crate) fn kernel_slope<const D: usize>(&self) -> Box<dyn Fn(f64) -> f64 + Send + Sync> {
        fn slope<K: kernel::Kernel + 'static, const D: usize>(
            kernel: K,
            medium: &FluidProperties<D>,
        ) -> Box<dyn Fn(f64) -> f64 + Send + Sync> {
            let kernel = kernel.normalised_on_lattice(medium);
            Box::new(move |r2| kernel.slope(r2))
        }
        let medium = self.fluid_properties::<D>();
        match self.kernel {
            KernelKind::Cubic { .. } => slope(kernel::Cubic::new(self.h, D), &medium),
            KernelKind::Wendland => slope(kernel::Wendland::new(self.h, D), &medium),
        }
    }

    /// Least stiffness of the lattice on which water starts, –: [`kernel::lattice::lattice_stiffness`].
    pub(crate) fn lattice_stiffness<const D: usize>(&self) -> f64 {
        match self.kernel {
            KernelKind::Cubic { .. } => {
                kernel::lattice::lattice_stiffness(kernel::Cubic::new(self.h, D), &self.fluid_properties::<D>())
            }
            KernelKind::Wendland => {
                kernel::lattice::lattice_stiffness(kernel::Wendland::new(self.h, D), &self.fluid_properties::<D>())
            }
        }
    }

    /// The choices that cannot be combined, if any.
    pub fn conflict(&self) -> Option<&'static str> {
        let alone = matches!(self.kernel, KernelKind::Wendland) && self.shifting == Shifting::None;
        let clash = "corrected gradients are made for the Wendland kernel without shifting";
        (self.gradient != PressureGradient::Plain && !alone).then_some(clash)
    }

    /// The shifting parameters, if any.
    pub(crate) fn shift(&self) -> Option<Shift> {
        match self.shifting {
            Shifting::None => None,
            Shifting::AwayFromSolids(s) | Shifting::AwayFromFixed(s) | Shifting::Everywhere(s) => Some(s),
        }
    }

    /// The units in which the pair loop computes, and its instructions; SI and `None` for the reference.
    fn units<const D: usize>(&self) -> (Units, Option<Level>) {
        let level = self.pair_loop.instruction_set();
        (level.map_or(Units::SI, |_| self.single_precision_units::<D>()), level)
    }

    /// The units in which single precision computes: that of integer positions, and the time in which sound crosses h.
    pub(crate) fn single_precision_units<const D: usize>(&self) -> Units {
        Units { length: NeighbourLists::<D>::length_unit(self.support_radius()), time: self.h / self.c0 }
    }

    /// A pair loop of your own terms under the Wendland kernel, for [`Simulation::with_pair_loop`]: `terms` gets the fluid
    /// properties in the units of the pair loop, and those units, and returns the terms between water particles and those
    /// between water and solids. The choices of this model that name terms do not apply. See `examples/own_law.rs`.
    ///
    /// [`Simulation::with_pair_loop`]: crate::simulation::Simulation::with_pair_loop
    pub fn custom_pair_loop<T: Term<D> + 'static, W: Term<D> + 'static, const D: usize>(
        &self,
        terms: impl FnOnce(&FluidProperties<D>, &Units) -> (T, W),
    ) -> Box<dyn PairLoop<D>> {
        let (units, level) = self.units::<D>();
        let properties = self.fluid_properties::<D>().in_units(&units);
        let (fluid, wall) = terms(&properties, &units);
        interaction::compile(kernel::Wendland::new(properties.h, D), fluid, wall, &properties, units, level)
    }

    /// The traces of the terms that this model names, and the units in which they compute; under gravity in any
    /// direction if it `changes`.
    #[cfg(feature = "gpu")]
    pub fn pair_traces<const D: usize>(&self, changes: bool) -> Option<(interaction::PairTraces, Units)> {
        let units = self.single_precision_units::<D>();
        let mut terms = self.build_pair_loop_in::<D>(units, None);
        if changes {
            terms.set_gravity(&FluidProperties { gravity: Vector::repeat(1.0), ..self.fluid_properties::<D>() });
        }
        Some((terms.traces()?, units))
    }

    /// The pair loop with the terms that this model names, and no others.
    fn build_pair_loop<const D: usize>(&self) -> Box<dyn PairLoop<D>> {
        let (units, level) = self.units::<D>();
        self.build_pair_loop_in(units, level)
    }

    /// The same in these units and with these instructions.
    fn build_pair_loop_in<const D: usize>(&self, units: Units, level: Option<Level>) -> Box<dyn PairLoop<D>> {
        let make = PairLoopBuilder {
            model: self,
            properties: self.fluid_properties::<D>().in_units(&units),
            units,
            instruction_set: level,
        };
        let FluidProperties { h, dp, .. } = make.properties;
        let plain = (Pressure, Continuity);
        match self.kernel {
            KernelKind::Wendland => match self.gradient {
                PressureGradient::Plain => make.with_shifting(kernel::Wendland::new(h, D), plain),
                PressureGradient::NearSurface | PressureGradient::Corrected => make.with_viscosity(
                    kernel::Wendland::new(h, D),
                    ((Pressure, CorrectedGradientTerm), Continuity),
                    plain,
                ),
            },
            KernelKind::Cubic { tensile } => {
                let kernel = kernel::Cubic::new(h, D);
                let w_dp: f64 = kernel.normalised_on_lattice(&make.properties).w(dp * dp);
                // A correction of 0 adds an exact 0, and the pair loop is compiled once for both.
                let inv_w_dp = if tensile { 1.0 / w_dp } else { 0.0 };
                make.with_shifting(kernel, ((Pressure, Tensile { inv_w_dp }), Continuity))
            }
        }
    }
}

/// Dimensions for which the pair loop is compiled.
pub trait HasPairLoop<const D: usize>: HasEngine<D> {
    /// The pair loop with the terms that `model` names, and no others.
    fn pair_loop(model: &Model) -> Box<dyn PairLoop<D>>;
}

#[cfg(feature = "dim2")]
impl HasPairLoop<2> for Dim<2> {
    fn pair_loop(model: &Model) -> Box<dyn PairLoop<2>> {
        model.build_pair_loop()
    }
}

#[cfg(feature = "dim3")]
impl HasPairLoop<3> for Dim<3> {
    fn pair_loop(model: &Model) -> Box<dyn PairLoop<3>> {
        model.build_pair_loop()
    }
}

/// Builds a pair loop choice by choice, in its units.
struct PairLoopBuilder<'a, const D: usize> {
    model: &'a Model,
    properties: FluidProperties<D>,
    units: Units,
    instruction_set: Option<Level>,
}

impl<const D: usize> PairLoopBuilder<'_, D> {
    fn with_shifting<K: kernel::Kernel + 'static, P: Term<D> + 'static>(
        &self,
        kernel: K,
        base: P,
    ) -> Box<dyn PairLoop<D>> {
        match self.model.shifting {
            Shifting::None => self.with_viscosity(kernel, base, base),
            _ => self.with_viscosity(kernel, (base, ShiftTerm), ((base, ShiftTerm), ShiftingSuppressionTerm)),
        }
    }

    fn with_viscosity<K: kernel::Kernel + 'static, T: Term<D> + 'static, W: Term<D> + 'static>(
        &self,
        kernel: K,
        base: T,
        wall: W,
    ) -> Box<dyn PairLoop<D>> {
        let wall = (wall, Repulsion::new(kernel, &self.properties));
        let Model { viscosity, slip, .. } = *self.model;
        let next = Diffusive { builder: self, kernel, fluid: base, wall };
        viscosity.terms(
            &self.properties,
            &self.units,
            slip.wall_viscosity_factor(),
            || kernel.viscous_sum(&self.properties),
            next,
        )
    }
}

/// A pair loop that lacks its viscosity.
struct Diffusive<'a, K, T, W, const D: usize> {
    builder: &'a PairLoopBuilder<'a, D>,
    kernel: K,
    fluid: T,
    wall: W,
}

impl<K: kernel::Kernel + 'static, T: Term<D> + 'static, W: Term<D> + 'static, const D: usize> TermConsumer<D>
    for Diffusive<'_, K, T, W, D>
{
    type Output = Box<dyn PairLoop<D>>;

    fn with_terms<V: Term<D> + 'static, X: Term<D> + 'static>(self, fluid: V, wall: X) -> Self::Output {
        let Self { builder: PairLoopBuilder { model, properties, units, instruction_set }, kernel, .. } = self;
        let (fluid, wall) = ((self.fluid, fluid), (self.wall, wall));
        match model.diffusion.term(properties) {
            None => interaction::compile(kernel, fluid, wall, properties, *units, *instruction_set),
            Some(term) => interaction::compile(kernel, (fluid, term), wall, properties, *units, *instruction_set),
        }
    }
}
