//! The bytes of the state of a simulation.

use std::io::{self, Write};

use serde::Serialize;

use crate::error::{Error, ErrorKind, Result};

/// A writer that takes a state to its end even after an error of the file, because other ranks do not know of the error and
/// continue the exchange.
struct ToTheEnd<'a> {
    out: &'a mut dyn Write,
    failure: Option<io::Error>,
}

impl Write for ToTheEnd<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.failure.is_none() {
            self.failure = self.out.write_all(bytes).err();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.failure.is_none() {
            self.failure = self.out.flush().err();
        }
        Ok(())
    }
}

/// Writes a `state` to `out`, to the end also after an error.
pub(super) fn write_to_the_end(state: &impl Serialize, out: &mut dyn Write) -> io::Result<()> {
    let mut out = ToTheEnd { out, failure: None };
    let written = postcard::to_io(state, &mut out).map(drop).map_err(io::Error::other);
    out.failure.map_or(written, Err)
}

/// The bytes of a state.
pub(super) fn bytes_of(state: &impl Serialize) -> Result<Vec<u8>> {
    let cannot = |e: postcard::Error| Error::new(ErrorKind::Restart, format!("cannot write the state: {e}"));
    let length = postcard::experimental::serialized_size(state).map_err(cannot)?;
    postcard::to_extend(state, Vec::with_capacity(length)).map_err(cannot)
}

/// The state of these bytes.
pub(super) fn read<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> Result<T> {
    postcard::from_bytes(bytes)
        .map_err(|e| Error::new(ErrorKind::Restart, format!("the checkpoint's state is damaged: {e}")))
}
