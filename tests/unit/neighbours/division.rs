//! Unit tests of `src/neighbours/division.rs`.

use super::*;

/// Indices that are kept as ranges come back, also those of a part whose ends lie in a range or between two.
#[test]
fn indices_kept_as_ranges_come_back() {
    for all in [vec![], vec![7], vec![0, 1, 2, 5, 6, 9, 12, 13, 14], (3..20).collect()] {
        let indices = IndexRanges::new(all.iter().copied());
        assert_eq!((indices.iter().collect::<Vec<u32>>(), indices.len()), (all.clone(), all.len()));
        let around = all.first().zip(all.last()).map_or(0..0, |(first, last)| *first as usize..*last as usize + 1);
        assert_eq!(indices.around(), around);
        for (start, end) in (0..22).flat_map(|start| (start..22).map(move |end| (start, end))) {
            let wanted: Vec<u32> = all.iter().copied().filter(|i| (start..end).contains(&(*i as usize))).collect();
            assert_eq!(indices.within(&(start..end)).collect::<Vec<_>>(), wanted, "{all:?} from {start} to {end}");
        }
    }
}

/// The water of a rank is marked only if particles of other ranks lie between its own.
#[test]
fn own_water_in_one_range_has_no_marks() {
    let mut division = Division { by_owner: true, ..Division::default() };
    division.set_own_water(vec![2, 3, 4], 8);
    assert_eq!(division.own_water().map(|(own, marks)| (own.len(), marks)), Some((3, None)));
    division.set_own_water(vec![1, 3], 5);
    assert_eq!(division.own_water().and_then(|(_, marks)| marks), Some(&[false, true, false, true, false][..]));
    assert_eq!(division.own_range(5), 1..4);
}
