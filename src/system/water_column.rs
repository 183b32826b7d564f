//! One quantity of all water particles, as a state stores it. Where each rank has its own water, no rank needs to have the quantity of
//! all: the ranks write it together, a piece at a time, or each its own.

use std::borrow::Cow;

use bytemuck::Pod;
use serde::{Deserialize, Deserializer, Serialize, Serializer, ser::SerializeSeq as _};

use crate::neighbours::{Division, IndexRanges};

/// A quantity of the water in the order of the particles.
pub(super) enum WaterColumn<'a, T: Clone> {
    /// Of all particles, or of those that were written.
    Read(Cow<'a, [T]>),
    /// Of this rank's particles alone, which are these of all, if it has any.
    Own(&'a [T], Option<&'a IndexRanges>),
    /// Of all particles, of which each rank has its own. All ranks write it at the same time: the first all of it, the others nothing.
    Shared(&'a [T], &'a Division),
}

impl<'a, T: Clone> WaterColumn<'a, T> {
    /// The quantity as it was read.
    pub(super) fn as_slice(&self) -> &[T] {
        match self {
            Self::Read(all) => all,
            Self::Own(all, _) | Self::Shared(all, _) => all,
        }
    }

    /// The quantity as it was read.
    pub(super) fn into_vec(self) -> Vec<T> {
        match self {
            Self::Read(all) => all.into_owned(),
            Self::Own(all, _) | Self::Shared(all, _) => all.to_vec(),
        }
    }
}

impl<T: Pod + Serialize> Serialize for WaterColumn<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Read(all) => all.serialize(serializer),
            Self::Own(all, own) => {
                let mut sequence = serializer.serialize_seq(Some(own.map_or(0, IndexRanges::len)))?;
                let mut own = own.iter().flat_map(|own| own.iter());
                own.try_for_each(|i| sequence.serialize_element(&all[i as usize]))?;
                sequence.end()
            }
            Self::Shared(all, division) => {
                let count = if division.ranks.rank() == 0 { all.len() } else { 0 };
                let mut sequence = serializer.serialize_seq(Some(count))?;
                let mut outcome = Ok(());
                division.collect(all, |piece| {
                    // The exchange goes on after an error: the others know of none.
                    let write =
                        |sequence: &mut S::SerializeSeq| piece.iter().try_for_each(|x| sequence.serialize_element(x));
                    if outcome.is_ok() {
                        outcome = write(&mut sequence);
                    }
                });
                outcome?;
                sequence.end()
            }
        }
    }
}

impl<'de, T: Clone + Deserialize<'de>> Deserialize<'de> for WaterColumn<'_, T> {
    fn deserialize<R: Deserializer<'de>>(deserializer: R) -> Result<Self, R::Error> {
        Vec::deserialize(deserializer).map(|all| Self::Read(Cow::Owned(all)))
    }
}
