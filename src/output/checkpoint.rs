//! Checkpoints: each contains all data that a run needs to continue bit for bit.
//!
//! The file begins with the magic bytes, the format number, the lengths of the data before and after compression, and a
//! hash. The hash (FNV-1a) covers both lengths and the compressed data. The data, compressed by zstd, are the
//! information on the run (postcard) and the bytes of the simulation. The reader detects and rejects a file that was
//! truncated or changed.
//!
//! A folder keeps the last two checkpoints, [`LAST`] and [`PREVIOUS`]: if the process is killed while it writes, at
//! least one file is complete.

use std::{
    fs,
    io::{self, BufWriter, Read, Seek, SeekFrom, Write},
    path::Path,
};

use serde::{Deserialize, Serialize};

use super::{IntervalMean, cannot_write, commit_partial, partial_path, sync_folder, write_partial};
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result},
    plan::ControlChange,
};

/// File name of the last checkpoint in the run's folder.
pub(crate) const LAST: &str = "checkpoint.bin";

/// File name of the checkpoint before the last.
pub(crate) const PREVIOUS: &str = "checkpoint.previous.bin";

/// File name of the partial checkpoint that remains if a run is killed while it writes a checkpoint.
pub(crate) const PART: &str = "checkpoint.bin.part";

const MAGIC: &[u8; 8] = b"PONTOON\n";
const FORMAT: u32 = 12;

/// The format before, without [`Checkpoint::files`].
const FORMAT_WITHOUT_FILES: u32 = 11;

/// Length of what precedes the packed data: magic word, format, two lengths and the hash.
const HEADER: usize = 8 + 4 + 16 + 8;

/// Bytes that gather before they are packed.
const BUFFER: usize = 1 << 16;

/// Largest ratio of the decompressed size to the file size. The identifiers of the particles do not compress well, and
/// keep the ratio of a valid checkpoint below 200.
const MAX_EXPANSION: u64 = 1000;

/// Progress of the outputs of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OutputPositions {
    /// Length of each table, bytes, in the order of the probes and then of the lists.
    pub table_bytes: Vec<u64>,
    /// Unfinished time means of the probes that use them.
    pub means: Vec<Option<IntervalMean>>,
    /// Times of the frames written, s.
    pub frame_times: Vec<f64>,
    /// Numbers of the next due probe sample, frame and checkpoint, then of the next due samples of the lists.
    pub next_due: Vec<u64>,
}

/// The content of a checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of this crate that wrote the checkpoint.
    pub version: String,
    /// FNV-1a hash of the scene with all default values.
    pub scene_hash: u64,
    /// Scene keys that were changed for this run, and their values.
    pub overrides: Vec<(String, String)>,
    /// Changes of controls so far.
    pub changes: Vec<ControlChange>,
    /// Simulated time, s.
    pub time: f64,
    /// Progress of the outputs.
    pub outputs: OutputPositions,
    /// Wall time of the run so far, s.
    pub wall_seconds: f64,
    /// Processor time of the run so far, s.
    pub cpu_seconds: f64,
    /// (Water particles + wet boundary particles) × force passes so far.
    pub particle_steps: u64,
    /// Wall time of stepping alone, s.
    pub stepping_seconds: f64,
    /// Names and FNV-1a hashes of the files that the scene names; `None` in checkpoints of the format before.
    #[serde(skip)]
    pub files: Option<Vec<(String, u64)>>,
    /// The bytes of the simulation; the file stores them unchanged after the other data.
    #[serde(skip)]
    pub state: Vec<u8>,
}

impl Checkpoint {
    /// Returns the checkpoint data before the first step of the `scene`, with the changed keys `sets` and the scene's `files`.
    pub(crate) fn initial(scene: &str, sets: &[(String, String)], files: Vec<(String, u64)>) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            scene_hash: fnv1a(scene.as_bytes()),
            overrides: sets.to_vec(),
            changes: vec![],
            time: 0.0,
            outputs: OutputPositions::default(),
            wall_seconds: 0.0,
            cpu_seconds: 0.0,
            particle_steps: 0,
            stepping_seconds: 0.0,
            files: Some(files),
            state: vec![],
        }
    }

    /// Writes the checkpoint to `folder` as [`LAST`], with the bytes of the simulation that `state` writes. The former last
    /// checkpoint becomes [`PREVIOUS`] if `good` is true. Otherwise the new one replaces it, because an invalid checkpoint must
    /// not replace a valid one.
    ///
    /// # Errors
    /// `File` if the checkpoint cannot be written; the former checkpoints remain.
    pub(crate) fn write(
        &self,
        folder: &Path,
        good: bool,
        state: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<()> {
        let (last, previous) = (folder.join(LAST), folder.join(PREVIOUS));
        // The file is on the disk under its temporary name before the other files are renamed: from here on, two complete
        // checkpoints exist.
        write_partial(&last, |file| self.pack(file, state).and_then(|()| file.sync_all()))?;
        if good {
            match fs::rename(&last, &previous) {
                Err(why) if why.kind() != io::ErrorKind::NotFound => {
                    let _ = fs::remove_file(partial_path(&last));
                    return Err(cannot_write(&previous, &why));
                }
                _ => {}
            }
        }
        commit_partial(&last)?;
        sync_folder(folder);
        Ok(())
    }

    /// Writes the checkpoint in its file format, packed piece by piece: no copy of it is in memory.
    fn pack<W: Write + Seek>(
        &self,
        file: &mut W,
        state: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let known = postcard::to_stdvec(&(self, &self.files)).map_err(io::Error::other)?;
        file.write_all(&[0; HEADER])?;
        // Higher compression levels take longer, and hardly reduce the size of flow data.
        let encoder = zstd::Encoder::new(Hashed::new(file), 1)?;
        let mut plain = Hashed::new(BufWriter::with_capacity(BUFFER, encoder));
        plain.write_all(&known)?;
        state(&mut plain)?;
        let unfolded = plain.length;
        let encoder = plain.inner.into_inner().map_err(io::IntoInnerError::into_error)?;
        let Hashed { inner: file, length, hash } = encoder.finish()?;
        let lengths = [unfolded, length].map(u64::to_le_bytes).concat();
        let sum = fnv1a_continue(hash, &lengths).to_le_bytes();
        file.seek(SeekFrom::Start(0))?;
        file.write_all(&[MAGIC, &FORMAT.to_le_bytes()[..], &lengths, &sum].concat())
    }

    /// Reads the checkpoint at `path`.
    ///
    /// # Errors
    /// `Restart` if the file does not exist, is not a checkpoint, is damaged, or has another format or version; `File`
    /// if it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).map_err(|why| match why.kind() {
            io::ErrorKind::NotFound => restart_error(
                ErrorCode::CheckpointNotFound,
                "there is no checkpoint",
                "a run writes one on Ctrl-C, and as often as [checkpoint] says, every ten minutes by default",
            ),
            _ => Error::read(path, &why),
        });
        bytes.and_then(|bytes| Self::from_bytes(&bytes)).map_err(|mut error| {
            if error.kind == ErrorKind::Restart {
                error.message = format!("{}: {}", path.display(), error.message);
            }
            error
        })
    }

    /// Reads a checkpoint from the content `bytes` of its file. The memory use is at most `MAX_EXPANSION` times their
    /// length.
    ///
    /// # Errors
    /// The same errors as [`Checkpoint::read`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        const AFRESH: &str = "start the run afresh with `pontoon run`";
        const OTHER: &str = "resume with the version that wrote it";
        let short = || restart_error(ErrorCode::BadCheckpoint, "the checkpoint is cut short", AFRESH);
        let damaged = || restart_error(ErrorCode::BadCheckpoint, "the checkpoint is damaged", AFRESH);
        let Some(rest) = bytes.strip_prefix(MAGIC) else {
            if MAGIC.starts_with(bytes) {
                return Err(short());
            }
            return Err(restart_error(
                ErrorCode::BadCheckpoint,
                "this is no checkpoint of pontoon",
                "name the folder of a run, as in `pontoon resume runs/raft`",
            ));
        };
        let (format, rest) = rest.split_first_chunk::<4>().ok_or_else(short)?;
        let format = u32::from_le_bytes(*format);
        if ![FORMAT, FORMAT_WITHOUT_FILES].contains(&format) {
            let what = format!("the checkpoint has format {format}; this program reads {FORMAT}");
            return Err(restart_error(ErrorCode::OtherVersion, &what, OTHER));
        }
        let (lengths, rest) = rest.split_first_chunk::<16>().ok_or_else(short)?;
        let (sum, packed) = rest.split_first_chunk::<8>().ok_or_else(short)?;
        let [unfolded, length] = [0, 8].map(|at| lengths[at..].first_chunk().map_or(0, |x| u64::from_le_bytes(*x)));
        if (packed.len() as u64) < length {
            return Err(short());
        }
        let sound = packed.len() as u64 == length
            && fnv1a_continue(fnv1a(packed), lengths) == u64::from_le_bytes(*sum)
            && unfolded <= MAX_EXPANSION.saturating_mul(length);
        if !sound {
            return Err(damaged());
        }
        let mut payload = Vec::new();
        // The memory use depends on the decompressed data, not on the length in the header.
        let read = zstd::Decoder::with_buffer(packed).and_then(|d| d.take(unfolded + 1).read_to_end(&mut payload));
        if read.is_err() || payload.len() as u64 != unfolded {
            return Err(damaged());
        }
        let (mut found, mut state) = postcard::take_from_bytes::<Self>(&payload).map_err(|_| damaged())?;
        if format == FORMAT {
            (found.files, state) = postcard::take_from_bytes(state).map_err(|_| damaged())?;
        }
        let known = payload.len() - state.len();
        if found.version != env!("CARGO_PKG_VERSION") {
            let what = format!("written by pontoon {}, this is {}", found.version, env!("CARGO_PKG_VERSION"));
            return Err(restart_error(
                ErrorCode::OtherVersion,
                &what,
                &format!("{OTHER}: another may not go on to the same bits"),
            ));
        }
        payload.drain(..known);
        found.state = payload;
        Ok(found)
    }
}

/// Writes to `inner`, and computes the length and the FNV-1a hash of the written bytes.
struct Hashed<W> {
    inner: W,
    length: u64,
    hash: u64,
}

impl<W: Write> Hashed<W> {
    fn new(inner: W) -> Self {
        Self { inner, length: 0, hash: fnv1a(&[]) }
    }
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.length += written as u64;
        self.hash = fnv1a_continue(self.hash, &bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

fn restart_error(code: ErrorCode, what: &str, help: &str) -> Error {
    Error::new(ErrorKind::Restart, what).with_code(code).help(help)
}

/// Returns the FNV-1a hash of `bytes`.
pub(crate) fn fnv1a(bytes: &[u8]) -> u64 {
    fnv1a_continue(0xcbf2_9ce4_8422_2325, bytes)
}

/// Returns the hash of earlier data with the hash `before`, followed by `bytes`.
pub(crate) fn fnv1a_continue(before: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(before, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[cfg(test)]
#[path = "../../tests/unit/output/checkpoint.rs"]
mod tests;
