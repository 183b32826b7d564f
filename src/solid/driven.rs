//! Prescribed motions (stub: helper "solid" writes this file).
use crate::{
    error::Result,
    series::Series,
    solid::Kinematics,
    space::{Pose, Vector},
};

/// How a driven coordinate moves in time.
#[derive(Clone, Debug)]
pub enum Law {
    Table(Series),
    Formula(Formula),
}
/// A formula in t.
#[derive(Clone, Debug)]
pub struct Formula(String);
impl Formula {
    pub fn parse(text: &str) -> Result<Self> {
        Ok(Self(text.into()))
    }
}
/// A prescribed motion.
#[derive(Clone, Debug)]
pub struct Motion<const D: usize> {
    law: Law,
    direction: Vector<D>,
}
impl<const D: usize> Motion<D> {
    pub fn slide(direction: Vector<D>, law: Law) -> Self {
        Self { law, direction }
    }
    pub fn hinge(centre: Vector<D>, _axis: &[f64], law: Law) -> Self {
        Self { law, direction: centre }
    }
    pub fn kinematics(&self, _start: &Pose<D>, _t: f64) -> Kinematics<D> {
        unimplemented!("{:?}{:?}", self.law, self.direction)
    }
}
