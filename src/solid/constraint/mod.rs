//! Constraints between solids: joints, motors, springs, ropes, contact pairs, and the reactions that they transmit.

pub(crate) mod assembly;
mod jacobian;
pub(crate) mod joint; //NARROW
pub(crate) mod lines; //NARROW
pub(crate) mod links; //NARROW
mod motor;
mod reactions;

pub(crate) use assembly::JointReading; //NARROW
pub(crate) use assembly::LineReading; //NARROW
pub(crate) use jacobian::Mobility; //NARROW
pub(crate) use joint::FreeMode; //NARROW
pub(crate) use joint::JointKind; //NARROW
pub(crate) use joint::JointSpec; //NARROW
pub(crate) use lines::LineEnd; //NARROW
pub(crate) use lines::RopeSpec; //NARROW
pub(crate) use lines::SpringParameters; //NARROW
pub(crate) use lines::SpringSpec; //NARROW
pub use links::Constraints;
pub use links::ContactSpec;
pub(crate) use links::InitialHold; //NARROW
pub use motor::Motor;
pub(crate) use motor::MotorCommand; //NARROW
