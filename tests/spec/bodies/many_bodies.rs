//! From one body to a thousand: the same bits at any number of threads. How a pile comes to rest is in `carried`.

use pontoon::{
    geometry::Shape,
    math::Vector,
    model::{Dimension, Model},
    simulation::Simulation,
    solid::{Dim, Role},
};

use crate::common;

/// So many cubes of 4 dp, at most `row` side by side, stacked 0.2 dp apart from 2 dp under the surface upwards and thrown at one another.
fn crowd<const D: usize>(count: usize, row: usize) -> Simulation<D>
where
    Dim<D>: Dimension<D>,
{
    let (dp, depth) = (0.02, 10.0);
    let row = row.min(count);
    let shape = Shape::Box { size: Vector::repeat(4.0 * dp) };
    let mut floats = Vec::new();
    for i in 0..count {
        let cell: [usize; D] = std::array::from_fn(|axis| {
            let layer = i / row.pow(axis as u32);
            if axis + 1 == D { layer } else { layer % row }
        });
        let mut at = cell.map(|k| (3.0 + 4.2 * (k as f64 + 0.5)) * dp);
        at[D - 1] += (depth - 5.0) * dp;
        let mut float = common::float(shape.clone(), at, [300.0, 600.0, 900.0, 1500.0][i % 4]);
        (float.name, float.friction, float.restitution) = (format!("cube-{i}"), 0.4, 0.2);
        let Role::Free(body) = &mut float.role else { panic!("a free body") };
        let sense = if cell.iter().sum::<usize>() % 2 == 0 { 1.0 } else { -1.0 };
        body.velocity = Vector::from_fn(|axis, _| if axis == 0 { 0.8 } else { -0.5 }) * sense;
        floats.push(float);
    }
    let mut size = [(4.2 * row as f64 + 6.0).ceil() * dp; D];
    size[D - 1] = depth * dp;
    let mut water = common::lattice([0.0; D], size, dp);
    // Not nearer to a cube than the half dp that it would start off its face.
    water.retain(|r| floats.iter().all(|float| (r - float.pose.position).amax() > 2.45 * dp));
    let highest = floats.last().map_or(0.0, |float| float.pose.position[D - 1]);
    size[D - 1] = highest + 8.0 * dp;
    let mut solids = vec![common::tank(size, dp)];
    solids.extend(floats);
    common::simulation(Model::water(D, dp, depth * dp), water, depth * dp, solids)
}

/// Whether 50 steps of the crowd end in the same bits on 1, 2 and 3 threads; asserts that its bodies have met.
fn same<const D: usize>(count: usize, row: usize) -> bool
where
    Dim<D>: Dimension<D>,
{
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let (mut sim, mut met) = (crowd::<D>(count, row), 0);
            for _ in 0..50 {
                sim.step().expect("a sound run");
                met += sim.contacts().len();
            }
            // Neighbours go for one another with 1.6 m/s, over 4 mm; found: 13 blows of 10 bodies, 700 of 100.
            assert!(met >= count / 2, "{count} bodies had {met} blows");
            sim.save().expect("a state")
        })
    };
    let first = run(1);
    run(2) == first && run(3) == first
}

#[test]
fn one_ten_a_hundred_and_a_thousand_bodies_give_the_same_bits_on_one_two_and_three_threads() {
    for count in [1, 10, 100, 1000] {
        assert!(same::<2>(count, 40), "{count} bodies");
    }
}

#[test]
fn a_hundred_bodies_in_space_give_the_same_bits_on_one_two_and_three_threads() {
    assert!(same::<3>(100, 5));
}
