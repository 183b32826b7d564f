//! Unit tests of `src/output/vtu.rs`.

use super::*;

/// Points with fields, among them numbers that are not finite, and triangles between them.
fn sample(points: usize) -> (Vec<f32>, Cells, Vec<DataArray>) {
    let wave = |i: usize| (i as f32 * 0.37).sin() * 1e3;
    let mut density: Vec<f32> = (0..points).map(wave).collect();
    let special = [f32::NAN, f32::from_bits(0xffc0_1234), f32::INFINITY, -0.0, f32::MIN_POSITIVE / 8.0];
    density.iter_mut().zip(special).for_each(|(x, special)| *x = special);
    let fields = vec![
        DataArray::new("velocity", 3, (0..3 * points).map(wave).collect()),
        DataArray::new("density", 1, density),
        DataArray { name: "id".into(), components: 1, values: Values::U32((0..points as u32).rev().collect()) },
    ];
    let triangles = (0..points as i64 / 3 * 3).collect();
    ((0..3 * points).map(wave).collect(), Cells { connectivity: triangles, points_per_cell: 3, cell_type: 5 }, fields)
}

fn file(points: usize) -> Vec<u8> {
    let (points, cells, fields) = sample(points);
    write(points, cells, fields).unwrap()
}

/// Bits of the numbers, for a comparison that includes NaN.
fn bits(values: &Values) -> Vec<u64> {
    match values {
        Values::F32(x) => x.iter().map(|x| u64::from(x.to_bits())).collect(),
        Values::U32(x) => x.iter().map(|x| u64::from(*x)).collect(),
        Values::I64(x) => x.iter().map(|x| *x as u64).collect(),
        Values::U8(x) => x.iter().map(|x| u64::from(*x)).collect(),
    }
}

#[test]
fn a_grid_survives_writing_and_reading_to_the_bit() {
    // No point, one point, exactly one block of 65,536 bytes (for fields with 4 bytes a point), and several blocks.
    for count in [0, 1, 16_384, 50_000] {
        let (points, cells, fields) = sample(count);
        let (read, read_fields) = read_points(&file(count)).unwrap();
        assert_eq!(bits(&Values::F32(read)), bits(&Values::F32(points)));
        assert_eq!(read_fields.len(), fields.len());
        for (read, field) in read_fields.iter().zip(&fields) {
            assert_eq!((&read.name, read.components), (&field.name, field.components));
            assert!(bits(&read.values) == bits(&field.values), "{} of {count} points", field.name);
        }
        let read_cells = read_arrays(&file(count), &["Cells"]).unwrap();
        let triangles = cells.connectivity.len() / 3;
        let offsets = (1..=triangles as i64).map(|i| 3 * i).collect();
        let expected = [Values::I64(cells.connectivity), Values::I64(offsets), Values::U8(vec![5; triangles])];
        assert!(read_cells.into_iter().map(|(_, array)| array.values).eq(expected), "cells of {count} points");
    }
}

#[test]
fn a_file_truncated_at_any_byte_is_refused() {
    let whole = file(40);
    let end = whole.trim_ascii_end().len();
    assert!(read_points(&whole[..end]).is_ok());
    for length in 0..end {
        assert!(read_points(&whole[..length]).is_err(), "the first {length} bytes of {end} were accepted");
    }
}

#[test]
fn a_file_with_a_wrong_byte_is_refused_or_read_without_a_panic() {
    let whole = file(12);
    for at in 0..whole.len() {
        for wrong in [0, 1, b'9', b'>', 0x80, 0xff] {
            let mut file = whole.clone();
            file[at] = wrong;
            if let Ok((points, fields)) = read_points(&file) {
                assert!(
                    points.len() % 3 == 0 && fields.iter().all(|f| f.values.len() == points.len() / 3 * f.components)
                );
            }
        }
    }
}

#[test]
fn a_refused_file_has_a_reason() {
    let refusal = |from: &str, to: &str| {
        let whole = file(3);
        let at = whole.windows(from.len()).position(|bytes| bytes == from.as_bytes()).unwrap();
        read_points(&[&whole[..at], to.as_bytes(), &whole[at + from.len()..]].concat()).unwrap_err()
    };
    assert_eq!(read_points(b"nothing of the kind").unwrap_err(), "it is cut short");
    assert_eq!(refusal("UnstructuredGrid", "PolyData"), "it is no unstructured grid of VTK");
    assert_eq!(refusal("LittleEndian", "BigEndian"), "its arrays are not little-endian and compressed by zlib");
    assert_eq!(refusal("Float32", "Float16"), "it has an array of Float16");
    assert_eq!(refusal("\"3\"", "\"many\""), "NumberOfPoints of Piece is no number");
    assert_eq!(refusal("\"3\"", "\"4\""), "the array \"velocity\" has not 3 numbers for each of 4 points");
    assert_eq!(refusal("offset=\"", "offset=\"99999"), "the array \"velocity\" is damaged");
    assert_eq!(refusal("\"raw\"", "\"base64\""), "its appended arrays are not raw bytes");
    assert_eq!(refusal("<Points>", "<Corners>"), "expected 'Corners' tag, not 'Points' at 12:1");
}

#[test]
fn a_block_header_with_wrong_sizes_is_refused() {
    let words = |words: &[u64]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<_>>();
    for header in [
        &[][..],
        &[1, 8],
        &[u64::MAX, 8, 0],
        &[u64::MAX / 8, 8, 0],
        &[2, 8, 0, 4],
        &[1, u64::MAX, 0, 2],
        &[1, 8, 0, u64::MAX],
    ] {
        assert_eq!(decompress(&words(header), 8), None, "{header:?}");
    }
    // A block with more or fewer bytes than its header declares.
    let mut data = Cursor::new(Vec::new());
    let array = DataArray { name: "ones".into(), components: 1, values: Values::U8(vec![1; 100]) };
    let size = append_blocks(array.into(), &mut data).unwrap();
    let mut data = data.into_inner();
    assert_eq!(size, data.len() as u64);
    assert_eq!(decompress(&data, 8), Some(vec![1; 100]));
    for partial in [99, 101] {
        data[16] = partial;
        assert_eq!(decompress(&data, 8), None);
    }
}

/// A file on a disk with so many bytes.
struct SmallDisk(Cursor<Vec<u8>>, u64);

impl Write for SmallDisk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.0.position() + bytes.len() as u64 > self.1 {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for SmallDisk {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

/// Ranks give their values one after the other and would wait for ever for a first rank that stops to take them.
#[test]
fn a_full_disk_is_an_error_and_all_values_are_taken() {
    let whole = {
        let mut file = SmallDisk(Cursor::new(Vec::new()), u64::MAX);
        write_vertices(&mut file, 3, |use_piece| use_piece(&Values::F32(vec![0.5; 9])), vec![]).unwrap()
    };
    for size in [0, 700, 900, whole - 1, whole] {
        let taken = std::cell::RefCell::new(Vec::new());
        let field = |name: &'static str| {
            ArrayPieces::new((name, 1), (Values::U32(vec![]), 3), {
                let taken = &taken;
                move |use_piece| {
                    taken.borrow_mut().push(name);
                    use_piece(&Values::U32(vec![1, 2, 3]));
                }
            })
        };
        let points = |use_piece: PieceUser<'_>| {
            taken.borrow_mut().push("points");
            use_piece(&Values::F32(vec![0.5; 9]));
        };
        let mut file = SmallDisk(Cursor::new(Vec::new()), size);
        let written = write_vertices(&mut file, 3, points, vec![field("first"), field("second")]);
        assert_eq!(written.map_err(|e| e.kind()), Err(io::ErrorKind::StorageFull), "{size} B");
        assert_eq!(*taken.borrow(), ["points", "second", "first"], "{size} B");
    }
}
