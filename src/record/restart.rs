//! Checkpoints: all that a run needs to go on to the same bits.
//!
//! The file is the magic word, the format's number, the payload's length and its hash (FNV-1a), then the
//! payload itself (postcard). A file that was cut short or changed is recognised, never half believed.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::write_lasting;
use crate::error::{Error, Kind, Result};

const MAGIC: &[u8; 8] = b"PONTOON\n";
const FORMAT: u32 = 2;
const HEADER: usize = 8 + 4 + 8 + 8;

/// What a checkpoint holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of this crate that wrote it.
    pub version: String,
    /// [`hash`] of the scene with every default filled in.
    pub scene: u64,
    /// Scene keys changed for this run, and their values.
    pub sets: Vec<(String, String)>,
    /// Length of each table, bytes, in the order of the probes.
    pub tables: Vec<u64>,
    /// Times of the frames written, s.
    pub frames: Vec<f64>,
    /// Numbers of the next looks, frame and checkpoint that are due.
    pub due: Vec<u64>,
    /// Wall time of the run so far, s.
    pub wall: f64,
    /// Processor time of the run so far, s.
    pub cpu: f64,
    /// Water and wet boundary particles × force passes so far.
    pub particle_steps: u64,
    /// Wall time of stepping alone, s.
    pub stepping: f64,
    /// The simulation's own bytes.
    pub state: Vec<u8>,
}

impl Checkpoint {
    /// Writes it to `path`, replacing the one before only when whole.
    ///
    /// # Errors
    /// `File` if it cannot be written; the one before stays.
    pub fn write(&self, path: &Path) -> Result<()> {
        let payload = postcard::to_stdvec(self)
            .map_err(|e| Error::new(Kind::Restart, format!("the checkpoint cannot be packed: {e}")))?;
        let mut bytes = Vec::with_capacity(HEADER + payload.len());
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&FORMAT.to_le_bytes());
        bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&hash(&payload).to_le_bytes());
        bytes.extend_from_slice(&payload);
        write_lasting(path, &bytes)
    }

    /// Reads the checkpoint at `path`.
    ///
    /// # Errors
    /// `Restart` if there is none, or it is no checkpoint, damaged, or of another format or version.
    pub fn read(path: &Path) -> Result<Self> {
        let refuse = |why: &str, help: &str| {
            Err(Error::new(Kind::Restart, format!("{}: {why}", path.display())).help(help.to_string()))
        };
        let bytes = match std::fs::read(path) {
            Ok(bytes) => bytes,
            Err(why) if why.kind() == std::io::ErrorKind::NotFound => {
                return refuse(
                    "there is no checkpoint",
                    "a run writes one on Ctrl-C, and at an interval if the scene asks for it",
                );
            }
            Err(why) => return Err(Error::file(path, why)),
        };
        let (magic, rest) = bytes.split_at(bytes.len().min(MAGIC.len()));
        if magic != MAGIC {
            return refuse(
                "this is no checkpoint of pontoon",
                "name the folder of a run, as in `pontoon resume runs/raft`",
            );
        }
        let afresh = "start the run afresh with `pontoon run`";
        let Some((format, rest)) = rest.split_first_chunk::<4>() else {
            return refuse("the checkpoint is cut short", afresh);
        };
        let format = u32::from_le_bytes(*format);
        if format != FORMAT {
            return refuse(
                &format!("the checkpoint has format {format}; this program reads {FORMAT}"),
                "resume with the version that wrote it",
            );
        }
        let Some((length, rest)) = rest.split_first_chunk::<8>() else {
            return refuse("the checkpoint is cut short", afresh);
        };
        let Some((sum, payload)) = rest.split_first_chunk::<8>() else {
            return refuse("the checkpoint is cut short", afresh);
        };
        if payload.len() as u64 != u64::from_le_bytes(*length) {
            return refuse("the checkpoint is cut short", afresh);
        }
        if hash(payload) != u64::from_le_bytes(*sum) {
            return refuse("the checkpoint is damaged", afresh);
        }
        let Ok(found) = postcard::from_bytes::<Self>(payload) else {
            return refuse("the checkpoint is damaged", afresh);
        };
        if found.version != env!("CARGO_PKG_VERSION") {
            let why = format!("written by pontoon {}, this is {}", found.version, env!("CARGO_PKG_VERSION"));
            return refuse(&why, "resume with the version that wrote it: another may not go on to the same bits");
        }
        Ok(found)
    }
}

/// FNV-1a hash of `bytes`.
pub fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Checkpoint {
        Checkpoint {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: hash(b"scene"),
            sets: vec![("dp".into(), "0.02".into())],
            tables: vec![12, 40],
            frames: vec![0.0, 0.1],
            due: vec![3, 1],
            wall: 1.5,
            cpu: 2.5,
            particle_steps: 1200,
            stepping: 1.25,
            state: vec![1, 2, 3, 250],
        }
    }

    #[test]
    fn the_hash_is_fnv_1a() {
        assert_eq!(hash(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(hash(b"foobar"), 0x8594_4171_f739_67e8, "the published test vector");
    }

    #[test]
    fn a_checkpoint_reads_back_and_every_damage_is_seen() -> Result<()> {
        let path = std::env::temp_dir().join(format!("pontoon-checkpoint-{}.bin", std::process::id()));
        example().write(&path)?;
        assert_eq!(Checkpoint::read(&path)?, example());
        let good = std::fs::read(&path).map_err(|e| Error::file(&path, e))?;
        for cut in 0..good.len() {
            std::fs::write(&path, &good[..cut]).map_err(|e| Error::file(&path, e))?;
            assert_eq!(Checkpoint::read(&path).err().map(|e| e.kind), Some(Kind::Restart), "cut at {cut}");
        }
        for place in 0..good.len() {
            let mut bad = good.clone();
            bad[place] ^= 0x10;
            std::fs::write(&path, &bad).map_err(|e| Error::file(&path, e))?;
            assert_eq!(Checkpoint::read(&path).err().map(|e| e.kind), Some(Kind::Restart), "changed at {place}");
        }
        let other = Checkpoint { version: "0.0.0".into(), ..example() };
        other.write(&path)?;
        assert!(Checkpoint::read(&path).is_err_and(|e| e.what.contains("written by pontoon 0.0.0")));
        std::fs::remove_file(&path).map_err(|e| Error::file(&path, e))
    }
}
