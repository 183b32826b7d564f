//! Constraints between solids: joints, motors, springs, ropes, contact pairs, and the reactions that they transmit.

pub(crate) mod assembly;
mod jacobian;
pub(crate) mod joint; //NARROW
pub(crate) mod lines; //NARROW
pub(crate) mod links; //NARROW
mod motor;
mod reactions;

pub use assembly::JointReading;
pub use assembly::LineReading;
pub use jacobian::Mobility;
pub use joint::FreeMode;
pub use joint::JointKind;
pub use joint::JointSpec;
pub use lines::LineEnd;
pub use lines::RopeSpec;
pub use lines::SpringParameters;
pub use lines::SpringSpec;
pub use links::Constraints;
pub use links::ContactSpec;
pub use links::InitialHold;
pub use motor::Motor;
pub use motor::MotorCommand;
pub use links::ContactPairs;
