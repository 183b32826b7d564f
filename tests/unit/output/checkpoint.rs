//! Unit tests of `src/output/checkpoint.rs`.

use super::*;

fn example() -> Checkpoint {
    Checkpoint {
        version: env!("CARGO_PKG_VERSION").into(),
        scene_hash: fnv1a(b"scene"),
        overrides: vec![("dp".into(), "0.02".into())],
        changes: vec![],
        time: 0.25,
        outputs: OutputPositions {
            table_bytes: vec![12, 40],
            means: vec![None, Some(IntervalMean::default())],
            frame_times: vec![0.0, 0.1],
            next_due: vec![3, 1],
        },
        wall_seconds: 1.5,
        cpu_seconds: 2.5,
        particle_steps: 1200,
        stepping_seconds: 1.25,
        files: Some(vec![("gate.csv".into(), 7)]),
        state: vec![1, 2, 3, 250],
    }
}

/// The content of a checkpoint's file.
fn packed(checkpoint: &Checkpoint) -> io::Result<Vec<u8>> {
    let mut file = io::Cursor::new(Vec::new());
    checkpoint.pack(&mut file, |out| out.write_all(&checkpoint.state))?;
    Ok(file.into_inner())
}

fn refusal(bytes: &[u8]) -> Option<ErrorKind> {
    Checkpoint::from_bytes(bytes).err().map(|e| e.kind)
}

#[test]
fn the_hash_is_fnv_1a() {
    assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
    assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8, "the published test vector");
}

#[test]
fn a_checkpoint_survives_writing_and_every_damage_is_detected() -> io::Result<()> {
    let good = packed(&example())?;
    assert_eq!(Checkpoint::from_bytes(&good).ok(), Some(example()));
    for cut in 0..good.len() {
        let what = Checkpoint::from_bytes(&good[..cut]).err().map(|e| e.message).unwrap_or_default();
        assert!(what.contains("cut short"), "cut at {cut}: {what}");
    }
    for place in 0..good.len() {
        for bit in 0..8 {
            let mut bad = good.clone();
            bad[place] ^= 1 << bit;
            assert_eq!(refusal(&bad), Some(ErrorKind::Restart), "bit {bit} of byte {place} changed");
        }
    }
    assert_eq!(refusal(&[&good[..], b"x"].concat()), Some(ErrorKind::Restart), "a byte too many");
    let other = packed(&Checkpoint { version: "0.0.0".into(), ..example() })?;
    assert!(Checkpoint::from_bytes(&other).is_err_and(|e| e.message.contains("written by pontoon 0.0.0")));
    Ok(())
}

#[test]
fn a_checkpoint_of_the_format_before_is_read_without_the_hashes_of_files() -> Result<()> {
    let known = postcard::to_stdvec(&example()).expect("it is serialised");
    let payload = [&known[..], &example().state].concat();
    let packed = zstd::encode_all(&payload[..], 1).expect("it is packed");
    let mut old = forged(payload.len() as u64, &packed);
    old[MAGIC.len()..MAGIC.len() + 4].copy_from_slice(&FORMAT_WITHOUT_FILES.to_le_bytes());
    assert_eq!(Checkpoint::from_bytes(&old)?, Checkpoint { files: None, ..example() });
    Ok(())
}

/// A file with a valid hash over any lengths and payload.
fn forged(unfolded: u64, packed: &[u8]) -> Vec<u8> {
    let lengths = [unfolded, packed.len() as u64].map(u64::to_le_bytes).concat();
    let sum = fnv1a_continue(fnv1a(packed), &lengths).to_le_bytes();
    [MAGIC, &FORMAT.to_le_bytes()[..], &lengths, &sum, packed].concat()
}

#[test]
fn a_forged_length_is_refused_before_memory_is_allocated() -> io::Result<()> {
    // 64 MB of zeros in some kB: refused for the compression ratio, and for a wrong length.
    let bomb = zstd::encode_all(io::repeat(0).take(1 << 26), 1)?;
    for unfolded in [u64::MAX, 1 << 26, 1 << 40, 1000, 0] {
        assert_eq!(refusal(&forged(unfolded, &bomb)), Some(ErrorKind::Restart), "declared length {unfolded} bytes");
    }
    assert_eq!(refusal(&forged(100, b"no zstd at all")), Some(ErrorKind::Restart));
    // Lists with a declared length of 2⁶⁰ entries.
    let lists = [&[1, b'x', 7, 0][..], &[0xff; 9], &[1]].concat();
    assert_eq!(refusal(&forged(lists.len() as u64, &zstd::encode_all(&lists[..], 1)?)), Some(ErrorKind::Restart));
    Ok(())
}

#[test]
fn the_last_two_checkpoints_are_kept_and_a_damaged_one_never_replaces_an_intact_one() -> Result<()> {
    let folder = std::env::temp_dir().join(format!("pontoon-checkpoint-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|e| Error::file(&folder, e))?;
    let at = |time| Checkpoint { time, ..example() };
    let write = |checkpoint: Checkpoint, good| checkpoint.write(&folder, good, |out| out.write_all(&[1, 2]));
    let time = |name: &str| Checkpoint::read(&folder.join(name)).map(|c| c.time).ok();
    write(at(1.0), true)?;
    assert_eq!([time(LAST), time(PREVIOUS)], [Some(1.0), None]);
    write(at(2.0), true)?;
    assert_eq!([time(LAST), time(PREVIOUS)], [Some(2.0), Some(1.0)]);
    fs::write(folder.join(LAST), "damaged").map_err(|e| Error::file(&folder, e))?;
    write(at(3.0), false)?;
    assert_eq!([time(LAST), time(PREVIOUS)], [Some(3.0), Some(1.0)]);
    let none = Checkpoint::read(&folder.join("none")).err().map(|e| e.message).unwrap_or_default();
    assert!(none.ends_with("there is no checkpoint"), "{none}");
    fs::remove_dir_all(&folder).map_err(|e| Error::file(&folder, e))
}
