//! Constraints between solids: joints, motors, springs, ropes, contact pairs, and the reactions that they transmit.

pub(crate) mod assembly;
mod events;
mod jacobian;
pub(crate) mod joint;
pub(crate) mod lifetime;
pub(crate) mod lines;
pub(crate) mod links;
mod motor;
mod moved;
mod reactions;
pub(crate) mod start_motion;
pub(in crate::solid) mod series;

pub use assembly::{JointReading, LineReading};
pub use jacobian::Mobility;
pub use joint::{FreeMode, JointKind, JointSpec};
pub use lifetime::{ConstraintChange, ConstraintEvent, Lifetime};
pub use lines::{LineEnd, RopeSpec, SpringParameters, SpringSpec};
pub use links::{Constraints, ContactPairs, ContactSpec, InitialHold, TimedRemoval};
pub use motor::{Motor, MotorCommand};
