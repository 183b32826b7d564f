//! The names that most programs need: `use pontoon::prelude::*;`.

pub use crate::{
    error::{Error, Result},
    geometry::{Shape, WaterRegion, fill},
    math::{Bivector, Pose, Vector},
    model::Model,
    probe::Probe,
    scene::{BuiltScene, PlacementConfig, Scene, ShapeConfig, SolidConfig},
    simulation::{Setup, Simulation},
    solid::{FreeBody, Kinematics, Load, Role, SolidSpec},
    system::System,
};
