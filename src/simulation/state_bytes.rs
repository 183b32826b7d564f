//! The bytes of a state: in memory, and to a file.

use std::io::{self, Write};

use serde::{Serialize, de::DeserializeOwned};

use crate::error::{Error, ErrorKind, Result};

/// What is written to the end of a state, also after an error of the file: other ranks know of none, and go on with the exchange.
pub(super) struct ToTheEnd<'a> {
    pub(super) out: &'a mut dyn Write,
    pub(super) failure: Option<io::Error>,
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

/// The bytes of a state.
pub(super) fn bytes_of(state: &impl Serialize) -> Result<Vec<u8>> {
    let cannot = |e: postcard::Error| Error::new(ErrorKind::Restart, format!("cannot write the state: {e}"));
    let length = postcard::experimental::serialized_size(state).map_err(cannot)?;
    postcard::to_extend(state, Vec::with_capacity(length)).map_err(cannot)
}

/// The state of these bytes.
pub(super) fn read<T: DeserializeOwned>(bytes: &[u8]) -> Result<T> {
    postcard::from_bytes(bytes)
        .map_err(|e| Error::new(ErrorKind::Restart, format!("the checkpoint's state is damaged: {e}")))
}
