//! The chosen laws, as data; the one place where a name becomes a type.

use serde::{Deserialize, Serialize};

use crate::law::{
    diffusion::{Fourtakas, Molteni},
    shifting::Shift,
    viscosity::{Artificial, Laminar, Sps},
};

/// Which kernel weighs the neighbours. Scene word `model.kernel`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Kernel {
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

/// Which viscosity acts. Scene word `model.viscosity`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Viscosity {
    /// None: the ideal fluid.
    None,
    /// Monaghan's artificial viscosity.
    Artificial(Artificial),
    /// Laminar (Lo & Shao 2002; Morris 1997).
    Laminar(Laminar),
    /// Laminar with sub-particle-scale turbulence (Dalrymple & Rogers 2006).
    Sps(Sps),
}

/// Which density diffusion acts. Scene word `model.diffusion`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Diffusion {
    /// None.
    None,
    /// Molteni & Colagrossi (2009).
    Molteni(Molteni),
    /// Fourtakas et al. (2019): the hydrostatic part of the density difference is left alone.
    Fourtakas(Fourtakas),
}

/// Which particles are shifted. Scene word `model.shifting`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shifting {
    /// None (the paper's type 0).
    None,
    /// Those that see no solid at all (type 1).
    AwayFromSolids(Shift),
    /// Those that see no fixed solid (type 2).
    AwayFromFixed(Shift),
    /// All (type 3).
    Everywhere(Shift),
}

/// How a solid's skin acts on the water. Scene word `model.walls`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Walls {
    /// Dynamic boundary particles: they obey continuity, and their density never falls below ρ₀.
    Dbc,
}

/// Which scheme advances time. Scene word `time.scheme`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Verlet (leapfrog) with an Euler step every `euler_every` steps.
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

/// Everything that the equations need to know, every default filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Kernel.
    pub kernel: Kernel,
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
    /// Viscosity.
    pub viscosity: Viscosity,
    /// Density diffusion.
    pub diffusion: Diffusion,
    /// Particle shifting.
    pub shifting: Shifting,
    /// Walls.
    pub walls: Walls,
    /// Time scheme.
    pub scheme: Scheme,
    /// Courant number, –.
    pub cfl: f64,
    /// Longest time step allowed, s (infinite if none).
    pub dt_max: f64,
}
