//! Unit tests of `src/output/frame.rs`.

use super::*;

#[test]
fn a_cloud_reads_back_as_it_was() -> std::result::Result<(), vtkio::Error> {
    for points in [vec![Vector::<2>::new(1.0, 2.0), Vector::<2>::new(3.0, 4.0)], vec![]] {
        let numbers: Vec<f32> = points.iter().map(|x| x[0] as f32).collect();
        let scalar = ElementType::Scalars { num_comp: 1, lookup_table: None };
        let text = points_vtu(&points, vec![data_array("density", scalar, numbers)])?;
        let Vtk { data: DataSet::UnstructuredGrid { pieces, .. }, .. } = Vtk::parse_xml(text.as_slice())? else {
            return Err(vtkio::Error::UnknownFileExtension(None));
        };
        let piece = pieces.into_iter().next().ok_or(vtkio::Error::UnknownFileExtension(None))?;
        let piece = piece.into_loaded_piece_data(None).map_err(|_| vtkio::Error::UnknownFileExtension(None))?;
        assert_eq!(piece.points, IOBuffer::F32(to_3d(&points)));
        assert_eq!(piece.cells.types.len(), points.len());
    }
    Ok(())
}

#[test]
fn the_film_names_both_pictures_of_each_time() {
    let text = pvd_index(&[0.0, 0.25], "frames", &PARTS);
    assert!(text.contains("timestep=\"0.25\" part=\"1\" name=\"solids\" file=\"frames/solids_00001.vtu\""));
    assert_eq!(text.matches("<DataSet ").count(), 4);
}

#[test]
fn an_unknown_field_names_the_nearest() {
    let words = FramesPlan { every: 1.0, fields: vec!["presure".into()], crop: None };
    let error = FrameWriter::new(&std::env::temp_dir(), &words, vec![]).err();
    assert_eq!(error.and_then(|e| e.help), Some("did you mean \"pressure\"?".into()));
}
