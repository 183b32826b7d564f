//! Unit tests of `src/output/frame_index.rs`.

use std::fs;

use super::*;
use crate::output::FrameSequence;

const PARTS: [&str; 2] = ["water", "solids"];

/// A folder of this name for a list.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pontoon-frame-index-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The text of the list of frames at these `times`, written at once.
fn text(times: &[f64]) -> String {
    let mut out = Vec::new();
    write_entries(&mut out, 0, times, "frames", &PARTS).unwrap();
    String::from_utf8(out).unwrap()
}

#[test]
fn the_list_names_the_files_of_each_time() {
    let text = text(&[0.0, 0.25]);
    assert!(text.contains("timestep=\"0.25\" part=\"1\" name=\"solids\" file=\"frames/solids_00001.vtu\""));
    assert_eq!(text.matches("<DataSet ").count(), 4);
}

#[test]
fn a_list_that_grows_is_the_list_written_at_once() {
    let folder = folder("grows");
    let path = folder.join("frames.pvd");
    let mut index = FrameIndex::new(path.clone(), "frames", &PARTS);
    let times: Vec<f64> = (0..40).map(|i| f64::from(i) * 0.1).collect();
    for count in 1..=30 {
        index.append(&times[..count]).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), text(&times[..count]), "{count} frames");
    }
    // After a rollback, beside a damaged list, and of another writer, which knows nothing of the list.
    index.write(&times[..10]).unwrap();
    index.append(&times[..11]).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), text(&times[..11]));
    fs::write(&path, "damaged").unwrap();
    index.append(&times[..12]).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), text(&times[..12]));
    FrameIndex::new(path.clone(), "frames", &PARTS).append(&times[..13]).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), text(&times[..13]));
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_reader_follows_a_list_that_grows_shrinks_and_changes() {
    let folder = folder("follows");
    let mut index = FrameIndex::new(folder.join("frames.pvd"), "frames", &PARTS);
    let mut times: Vec<f64> = (0..20).map(f64::from).collect();
    index.write(&times[..5]).unwrap();
    let mut frames = FrameSequence::open(&folder).unwrap().unwrap();
    for count in [5, 6, 20, 12, 13] {
        index.write(&times[..count]).unwrap();
        frames.update().unwrap();
        assert_eq!(frames.times(), &times[..count], "{count} frames");
    }
    // Frames that a rollback replaced, as many as before.
    times[8..13].iter_mut().for_each(|t| *t += 0.5);
    index.write(&times[..13]).unwrap();
    frames.update().unwrap();
    assert_eq!(frames.times(), &times[..13]);
    fs::write(folder.join("frames.pvd"), "<DataSet name=\"water\" timestep=\"x\"/>").unwrap();
    assert!(FrameSequence::open(&folder).is_err_and(|why| why.message.contains("list of frames")));
    fs::remove_dir_all(&folder).unwrap();
}
