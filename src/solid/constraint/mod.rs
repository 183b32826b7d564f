//! Constraints between solids: joints, motors, springs, ropes, contact pairs, and the reactions that they transmit.

pub(crate) mod assembly;
mod jacobian;
pub(crate) mod joint;
pub(crate) mod lines;
pub(crate) mod links;
mod motor;
mod reactions;

pub use assembly::{JointReading, LineReading};
pub use jacobian::Mobility;
pub use joint::{FreeMode, JointKind, JointSpec};
pub use lines::{LineEnd, RopeSpec, SpringParameters, SpringSpec};
pub use links::{Constraints, ContactPairs, ContactSpec, InitialHold};
pub use motor::{Motor, MotorCommand};
