//! Unit tests of `src/output/frame_sequence.rs`.

use super::*;

#[test]
fn frames_of_the_first_format_version_are_read() -> Result<()> {
    // Twelve particles of water 10 ms after the start of their fall, written by the crate vtkio with arrays in base 64.
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/frames");
    let frames = FrameSequence::open(&folder)?.ok_or_else(|| Error::file(&folder, "has no frames"))?;
    assert_eq!(frames.times(), [0.0, 0.01]);
    assert_eq!((frames.nearest_index(0.004), frames.nearest_index(0.006), frames.bytes(1)), (0, 1, 2247 + 1950));
    let (water, solids) = (frames.water(1)?, frames.solids(1)?);
    assert_eq!((water.position.len(), solids.position.len()), (12, 8));
    assert_eq!(water.position[0], [0.124_486_26, 0.124_090_31, 0.0]);
    assert_eq!(water.velocity[11], [0.017_186_126, -0.061_773_557, 0.0]);
    assert_eq!((water.density[0], water.pressure[8]), (1001.96265, -358.51703));
    assert_eq!(water.id, [0, 1, 2, 4, 5, 6, 8, 9, 10, 3, 7, 11]);
    assert!(water.solid_index.is_empty());
    assert_eq!(solids.position[7], [0.275, -0.475, 0.0]);
    assert_eq!((solids.solid_index, solids.density), (vec![0.0; 8], vec![1000.0; 8]));
    Ok(())
}

#[test]
fn a_damaged_frame_is_an_error_that_names_the_file() {
    let folder = std::env::temp_dir().join(format!("pontoon-damaged-frame-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("frames")).unwrap();
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/frames");
    std::fs::copy(golden.join("frames.pvd"), folder.join("frames.pvd")).unwrap();
    let whole = std::fs::read(golden.join("frames/water_00001.vtu")).unwrap();
    let frames = FrameSequence::open(&folder).unwrap().unwrap();
    let path = folder.join("frames/water_00001.vtu");
    assert!(frames.water(1).is_err(), "there is no file");
    for length in (0..whole.len()).step_by(7) {
        std::fs::write(&path, &whole[..length]).unwrap();
        let error = frames.water(1).unwrap_err().to_string();
        assert!(error.contains("water_00001.vtu: is not a frame of this program: it is cut short"), "{error}");
    }
    // The end of the file is intact, but an array lacks some digits.
    let text = String::from_utf8(whole).unwrap().replacen("eAE", "", 1);
    std::fs::write(&path, text).unwrap();
    let error = frames.water(1).unwrap_err().to_string();
    assert!(error.contains("the array \"velocity\" is damaged"), "{error}");
    std::fs::remove_dir_all(&folder).unwrap();
}
