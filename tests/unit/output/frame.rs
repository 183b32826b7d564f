//! Unit tests of `src/output/frame.rs`.

use super::*;
use crate::output::FrameSequence;

#[test]
fn points_in_2d_are_written_with_a_third_coordinate_and_a_vertex_each() -> io::Result<()> {
    for points in [vec![Vector::<2>::new(1.0, 2.0), Vector::<2>::new(3.0, 4.0)], vec![]] {
        let numbers: Vec<f32> = points.iter().map(|x| x[0] as f32).collect();
        let density = DataArray::new("density", 1, numbers.clone()).into();
        let mut file = io::Cursor::new(Vec::new());
        let give = |use_piece: &mut dyn FnMut(&Values)| use_piece(&Values::F32(to_3d(&points)));
        let size = vtu::write_vertices(&mut file, points.len(), give, vec![density])?;
        let file = file.into_inner();
        assert_eq!(size, file.len() as u64);
        let (read, fields) = vtu::read_points(&file).map_err(io::Error::other)?;
        let expected = if points.is_empty() { vec![] } else { vec![1.0, 2.0, 0.0, 3.0, 4.0, 0.0] };
        assert_eq!((read, fields), (expected, vec![DataArray::new("density", 1, numbers)]));
        let text = String::from_utf8_lossy(&file).into_owned();
        assert!(text.contains(&format!("NumberOfPoints=\"{0}\" NumberOfCells=\"{0}\"", points.len())), "{text}");
    }
    Ok(())
}

#[test]
fn an_unknown_field_is_refused_with_the_nearest_name() {
    let plan = FramesPlan { every: 1.0, fields: vec!["presure".into()], crop: None, moorings: false };
    let error = FrameWriter::new(&std::env::temp_dir(), &plan, vec![]).err();
    assert_eq!(error.and_then(|e| e.help), Some("did you mean \"pressure\"?".into()));
}

#[test]
fn a_broken_line_is_read_in_two_parts_and_one_that_does_not_act_in_none() -> Result<()> {
    let folder = std::env::temp_dir().join(format!("pontoon-frame-of-lines-{}", std::process::id()));
    let plan = FramesPlan { every: 1.0, fields: vec![], crop: None, moorings: true };
    let mut writer = FrameWriter::new(&folder, &plan, vec![])?;
    let line = |y: f64, segments: usize, broken: Option<usize>| MooringReading::<2> {
        nodes: (0..=segments).map(|k| Vector::from([k as f64, y])).collect(),
        tensions: vec![1.0; segments],
        broken,
        ..MooringReading::default()
    };
    writer
        .write_lines("moorings_00000.vtu", &[line(0.0, 3, None), MooringReading::default(), line(2.0, 4, Some(1))])?;
    writer.times.push(0.0);
    writer.index.append(&writer.times)?;
    let parts = FrameSequence::open(&folder)?.map(|frames| frames.moorings(0)).transpose()?.unwrap_or_default();
    let nodes = |y: f32, from: u8, to: u8| (from..=to).map(|k| [f32::from(k), y, 0.0]).collect::<Vec<_>>();
    assert_eq!(parts, [nodes(0.0, 0, 3), nodes(2.0, 0, 1), nodes(2.0, 2, 4)]);
    std::fs::remove_dir_all(&folder).map_err(|why| Error::file(&folder, why))
}
