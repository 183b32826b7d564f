//! Unit tests of `src/geometry/fill.rs`.

use super::*;
use crate::geometry::wall::{LineSide, side_of_line};

fn pool<const D: usize>(size: [f64; D]) -> WaterRegion<D> {
    let size = Vector::from(size);
    WaterRegion { shape: Shape::Box { size }, pose: Pose::at(size * 0.5) }
}

/// Smallest distance (dp) of water from the face of the solid, and largest distance of a wetted face point from water.
fn clearance<const D: usize>(water: &[Vector<D>], shape: &Shape<D>, pose: &Pose<D>, dp: f64) -> (f64, f64) {
    let nearest = water.iter().map(|x| shape.signed_distance(&pose.local(x))).fold(f64::INFINITY, f64::min);
    let reach = |x: Vector<D>| water.iter().map(|w| (w - x).norm()).fold(f64::INFINITY, f64::min);
    // Points on the face: fine boundary points of the shape, projected to the face.
    let fine = shape.boundary_points(0.3 * dp, 1);
    let face = fine.iter().map(|p| p.r - shape.outward_normal(&p.r, 1e-3 * dp) * shape.signed_distance(&p.r));
    // Water is inside the tanks and on the left of the lines of these tests: no other face of a wall is wet.
    let faces_water = |x: &Vector<D>| match shape {
        Shape::Tank { size, .. } => (0..D).all(|i| x[i] > -1e-9 && x[i] < size[i] + 1e-9),
        Shape::Polyline { points, .. } => {
            matches!(side_of_line(x, points), LineSide::Left(_) | LineSide::Right(0.0..1e-9))
        }
        _ => true,
    };
    let face = face.filter(faces_water);
    let top = water.iter().map(|w| w[D - 1]).fold(f64::NEG_INFINITY, f64::max);
    let bare = face.map(|x| pose.point(&x)).filter(|x| x[D - 1] < top - 1.5 * dp).map(reach).fold(0.0, f64::max);
    (nearest / dp, bare / dp)
}

fn assert_fits<const D: usize>(filled: &FilledWater<D>, shape: &Shape<D>, pose: &Pose<D>, dp: f64) {
    let (nearest, bare) = clearance(&filled.r, shape, pose, dp);
    assert!(nearest >= 0.45, "{shape:?}: water {nearest} dp from the face");
    // Half a dp normal to the face and half a spacing along it in D − 1 directions: 0.71 and 0.87 dp on a fitting
    // lattice; disorder adds a fifth.
    let most = if D == 2 { 0.85 } else { 1.04 };
    assert!(bare <= most, "{shape:?}: a gap of {bare} dp");
    let cells = crate::geometry::cells::spacing_flags(&filled.r, 0, 0.5 * dp);
    assert!(cells.iter().all(|spaced| *spaced), "{shape:?}: points closer than half a dp");
}

#[test]
fn the_water_around_a_fitting_tank_and_body_is_the_exact_lattice() {
    let tank = Shape::Tank { size: Vector::from([4.0, 5.0]), thickness: 0.3 };
    let (block, at) = (Shape::Box { size: Vector::from([1.0, 0.5]) }, Pose::at(Vector::from([2.0, 1.25])));
    let solids = [(&tank, &Pose::identity()), (&block, &at)];
    let filled = fill(&[pool([4.0, 2.0])], &solids, 0.1).unwrap();
    assert_eq!((filled.r.len(), filled.removed_in_solids, filled.removed_in_regions), (750, 50, 0));
    for x in filled.r.iter().flat_map(|r| r.iter()) {
        assert!((x / 0.1 - 0.5 - (x / 0.1 - 0.5).round()).abs() < 1e-9);
    }
}

#[test]
fn overlapping_water_regions_share_a_lattice_without_duplicates() {
    let film = pool([2.0, 0.2]);
    let mut column = pool([0.5, 1.0]);
    column.pose.position[0] += 0.3;
    let filled = fill(&[column, film], &[], 0.1).unwrap();
    assert_eq!((filled.r.len(), filled.removed_in_regions), (50 + 30, 10));
    assert!(fill(&[pool([1.0, 0.04])], &[], 0.1).is_err());
    assert!(fill(&[pool([1.0, 1.0])], &[], 1e-9).is_err());
}

#[test]
fn the_water_removed_by_a_disc_has_the_area_of_the_disc() {
    let pool = [pool([4.0, 4.0])];
    for (x, y) in [(2.0, 2.0), (2.03, 1.97), (2.0 + 0.031, 2.0 + 0.047)] {
        let (disc, at) = (Shape::Ball { radius: 0.5 }, Pose::at(Vector::from([x, y])));
        let filled = fill(&pool, &[(&disc, &at)], 0.1).unwrap();
        // 78.5 cells; the error is half a cell for each of the four sides.
        assert!((filled.removed_in_solids as f64 - 78.54).abs() <= 2.0, "{}", filled.removed_in_solids);
        assert_eq!(filled.r.len() + filled.removed_in_solids, 1600);
        assert_fits(&filled, &disc, &at, 0.1);
    }
}

#[test]
fn water_around_a_tilted_box_or_one_off_the_lattice_has_no_gap() {
    let block = Shape::Box { size: Vector::from([1.0, 1.0]) };
    for (x, y, turn) in [(2.03, 2.0, 0.0), (2.05, 2.05, 0.0), (2.03, 1.98, 0.3), (2.0, 3.93, 0.0)] {
        let at = Pose::rotated(Vector::from([x, y]), &[turn]);
        let filled = fill(&[pool([4.0, 4.0])], &[(&block, &at)], 0.1).unwrap();
        let (wet, _) = block.submerged_volume(&at, 4.0);
        // The error is half a cell for each of the four sides, not half a row.
        assert!((filled.removed_in_solids as f64 - 100.0 * wet).abs() <= 2.0, "{}", filled.removed_in_solids);
        assert_fits(&filled, &block, &at, 0.1);
    }
}

#[test]
fn packing_around_a_float_keeps_the_surface_level() {
    let block = Shape::Box { size: Vector::from([1.0, 1.0]) };
    let at = Pose::at(Vector::from([2.03, 3.95]));
    let filled = fill(&[pool([4.0, 4.0])], &[(&block, &at)], 0.1).unwrap();
    let top = filled.r.iter().map(|x| (x[1] - 3.95) / 0.1).fold(f64::NEG_INFINITY, f64::max);
    // No particle rises by more than a quarter of a spacing. Tests of the particle count detect a hollow.
    assert!(top < 0.25, "the top row rises to {top} dp above its height");
}

#[test]
fn water_fills_the_space_above_a_slope_only() {
    let points = [[0.0, 0.0], [1.0, 0.0], [4.0, 1.2]].map(Vector::from).to_vec();
    let bed = Shape::Polyline { points, thickness: 0.2 };
    let filled = fill(&[pool([4.0, 1.0])], &[(&bed, &Pose::identity())], 0.05).unwrap();
    let area = 4.0 - 0.5 * 2.5 * 1.0 - 0.5; // the triangle under the slope up to x = 3.5, then the rest
    assert!((filled.r.len() as f64 * 0.0025 - area).abs() < 0.02, "{}", filled.r.len() as f64 * 0.0025);
    assert_fits(&filled, &bed, &Pose::identity(), 0.05);
    // Far from the slope the lattice is unchanged.
    assert!(filled.r.iter().any(|x| (x - Vector::from([0.025, 0.975])).norm() < 1e-9));
}

#[test]
fn water_fills_the_space_under_a_shelf_that_ends_in_it() {
    // A shelf in mid-water, one at the right side of the water, and a table whose legs end above the bed; volume of the walls, m².
    let lines: [(&[[f64; 2]], f64); 3] = [
        (&[[1.0, 0.6], [2.0, 0.6]], 0.1),
        (&[[3.0, 0.6], [4.0, 0.6]], 0.1),
        (&[[1.0, 0.3], [1.0, 0.6], [2.0, 0.6], [2.0, 0.3]], 0.14),
    ];
    for (points, volume) in lines {
        let shelf = Shape::Polyline { points: points.iter().copied().map(Vector::from).collect(), thickness: 0.1 };
        let filled = fill(&[pool([4.0, 1.0])], &[(&shelf, &Pose::identity())], 0.05).unwrap();
        // Within a row of cells along the table's outline of 1.6 m, cut by its faces.
        let lack = 4.0 - filled.r.len() as f64 * 0.0025 - volume;
        assert!(lack.abs() < 0.021, "{points:?}: {lack} m² too few");
    }
    // A sill between two places of the bed has ground under it.
    let sill = [[1.0, 0.0], [1.0, 0.4], [2.0, 0.4], [2.0, 0.0]].map(Vector::from).to_vec();
    let sill = Shape::Polyline { points: sill, thickness: 0.1 };
    let filled = fill(&[pool([4.0, 1.0])], &[(&sill, &Pose::identity())], 0.05).unwrap();
    assert_eq!(filled.r.len(), 1600 - 160);
}

#[test]
fn water_around_a_ball_has_no_gap() {
    let (ball, at) = (Shape::Ball { radius: 0.4 }, Pose::at(Vector::from([1.013, 0.987, 1.03])));
    let filled = fill(&[pool([2.0, 2.0, 2.0])], &[(&ball, &at)], 0.1).unwrap();
    assert!((filled.removed_in_solids as f64 - 268.1).abs() < 8.0, "{}", filled.removed_in_solids);
    assert_fits(&filled, &ball, &at, 0.1);
}

#[test]
fn a_gap_too_narrow_for_a_row_of_particles_stays_dry() {
    let tank = Shape::Tank { size: Vector::from([2.1, 5.0]), thickness: 0.4 };
    let (block, at) = (Shape::Box { size: Vector::from([2.0, 1.0]) }, Pose::at(Vector::from([1.05, 1.5])));
    let filled = fill(&[pool([2.1, 3.0])], &[(&tank, &Pose::identity()), (&block, &at)], 0.1).unwrap();
    // The gap is half a dp on either side, so water would be a quarter of a dp from both faces.
    assert!(filled.r.iter().all(|x| x[1] <= 1.0 || x[1] >= 2.0));
    assert!(filled.r.len() >= 2 * 10 * 21 - 21, "the water below and above remains: {}", filled.r.len());
}

#[test]
fn filling_has_the_same_bits_on_any_number_of_threads() {
    let (ball, at) = (Shape::Ball { radius: 0.4 }, Pose::at(Vector::from([1.013, 0.987, 1.03])));
    let filled = |threads: usize| {
        let workers = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        workers.install(|| fill(&[pool([2.0, 2.0, 2.0])], &[(&ball, &at)], 0.1).unwrap())
    };
    let one = filled(1);
    assert!([2, 3, 8].into_iter().all(|threads| filled(threads) == one));
}

/// Ranks that each fill a part have the water of one in the order of the ranks, also where it is packed around a ball and two regions
/// overlap.
#[test]
fn the_parts_of_ranks_are_the_water_of_one() {
    let mut column = pool([0.5, 0.5, 1.0]);
    column.pose.position += Vector::from([0.3, 0.1, 0.0]);
    let (regions, dp) = ([column, pool([1.2, 0.7, 0.5])], 0.05);
    let (ball, at) = (Shape::Ball { radius: 0.17 }, Pose::at(Vector::from([0.53, 0.36, 0.5])));
    let solids = [(&ball, &at, true)];
    let filled = |ranks: &Ranks| {
        let filling = Filling {
            regions: &regions,
            inside: Vec::new(),
            levels: Vec::new(),
            solids: &solids,
            spaces: &[],
            ranks,
            owners: ranks,
        };
        filling.fill(dp).unwrap()
    };
    let whole = filled(&Ranks::default());
    assert!(whole.water.removed_in_solids > 50 && whole.water.removed_in_regions > 50);
    let parts: Vec<_> = std::thread::scope(|scope| {
        let filled = &filled;
        let threads: Vec<_> =
            Ranks::in_threads(3).into_iter().map(|ranks| scope.spawn(move || filled(&ranks))).collect();
        threads.into_iter().map(|thread| thread.join().expect("a rank does not panic")).collect()
    });
    assert!(parts.iter().all(|part| part.water.r.len() > 100), "each rank has a part");
    assert!(parts.iter().all(|part| part.water.removed_in_solids == whole.water.removed_in_solids));
    assert_eq!(parts.iter().flat_map(|part| part.water.r.clone()).collect::<Vec<_>>(), whole.water.r);
    assert_eq!(parts.into_iter().flat_map(|part| part.home).collect::<Vec<_>>(), whole.home);
}
