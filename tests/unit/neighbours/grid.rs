use super::*;

/// The numbers of the particles in the rows of cells that meet the box from `min` to `max`.
fn found(grid: &CellGrid<2>, min: [f64; 2], max: [f64; 2]) -> Vec<u32> {
    let mut all = Vec::new();
    grid.visit_rows(&Bounds { min: Vector::from(min), max: Vector::from(max) }, |row| all.extend(row));
    all
}

/// A rank that knows a part of the water finds that in the order in which all water is found.
#[test]
fn a_part_is_found_in_the_order_of_the_whole() {
    // Multiples of irrational numbers fill a square of 4 × 4 cells evenly, in no order.
    let r: Vec<Vector<2>> = (1..400)
        .map(|i| Vector::from([2.0_f64.sqrt(), 3.0_f64.sqrt()].map(|x| 4.0 * (f64::from(i) * x).fract())))
        .collect();
    let part: Vec<u32> = (0..r.len() as u32).filter(|i| i % 3 != 1 && r[*i as usize][0] > 1.5).collect();
    let places: Vec<Vector<2>> = part.iter().map(|&i| r[i as usize]).collect();
    let (whole, known) = (CellGrid::new(&r, 1.0), CellGrid::of_part(&places, (Bounds::around(&r), r.len()), 1.0));
    for (min, max) in
        [([0.0, 0.0], [4.0, 4.0]), ([1.2, 0.3], [2.4, 3.9]), ([2.5, 2.5], [9.0, 9.0]), ([-3.0, 1.0], [-1.0, 2.0])]
    {
        let wanted: Vec<u32> = found(&whole, min, max).into_iter().filter(|i| part.contains(i)).collect();
        let got: Vec<u32> = found(&known, min, max).into_iter().map(|k| part[k as usize]).collect();
        assert_eq!(got, wanted, "from {min:?} to {max:?}");
    }
    assert!(found(&CellGrid::of_part(&[], (Bounds::around(&r), r.len()), 1.0), [0.0, 0.0], [4.0, 4.0]).is_empty());
}
