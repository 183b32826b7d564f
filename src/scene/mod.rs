//! What the user says: the words of a scene, read, checked and made into a simulation.

pub mod plan;

pub use plan::{CheckWords, FrameWords, Plan, ProbeKind, ProbeWords, Score};
