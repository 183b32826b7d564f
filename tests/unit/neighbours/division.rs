//! Unit tests of `src/neighbours/division.rs`.

use super::*;

/// Numbers that are kept as ranges come back, also those of a part whose ends lie in a range or between two.
#[test]
fn numbers_kept_as_ranges_come_back() {
    for all in [vec![], vec![7], vec![0, 1, 2, 5, 6, 9, 12, 13, 14], (3..20).collect()] {
        let numbers = Numbers::new(all.iter().copied());
        assert_eq!((numbers.iter().collect::<Vec<u32>>(), numbers.len()), (all.clone(), all.len()));
        let around = all.first().zip(all.last()).map_or(0..0, |(first, last)| *first as usize..*last as usize + 1);
        assert_eq!(numbers.around(), around);
        for (start, end) in (0..22).flat_map(|start| (start..22).map(move |end| (start, end))) {
            let wanted: Vec<u32> = all.iter().copied().filter(|i| (start..end).contains(&(*i as usize))).collect();
            assert_eq!(numbers.within(&(start..end)).collect::<Vec<_>>(), wanted, "{all:?} from {start} to {end}");
        }
    }
}
