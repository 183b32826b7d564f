//! Open boundaries in three dimensions, normal to x and to y, and beside periodic sides and symmetry planes.

use pontoon::simulation::Simulation;

use crate::common;

const DP: f64 = 0.05;
const LENGTH: f64 = 0.8;

/// A channel along `axis`, 0.8 m long, 0.4 m wide between walls and 0.3 m deep, with a current of 1 m/s.
fn channel(axis: &str) -> Simulation<3> {
    let swap = |[along, across, up]: [f64; 3]| match axis {
        "x" => format!("[{along}, {across}, {up}]"),
        _ => format!("[{across}, {along}, {up}]"),
    };
    let wall = |name: &str, size: [f64; 3], at: [f64; 3]| {
        format!(
            "[[solid]]\nname = \"{name}\"\nfixed = true\nshape = {{ box = {{ size = {} }} }}\nat = {}\n",
            swap(size),
            swap(at)
        )
    };
    let walls = [
        wall("bed", [4.0, 1.0, 0.2], [0.4, 0.2, -0.1]),
        wall("left", [4.0, 0.3, 0.5], [0.4, -0.15, 0.25]),
        wall("right", [4.0, 0.3, 0.5], [0.4, 0.55, 0.25]),
    ];
    common::scene_simulation::<3>(&format!(
        "dimension = 3\ndp = {DP}\nuntil = 2.0\n\
         inflow = [{{ {axis} = 0.0, velocity = 1.0 }}]\noutflow = [{{ {axis} = {LENGTH}, velocity = 1.0 }}]\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = {} }} }}\nvelocity = {}\n{}\n",
        swap([LENGTH, 0.4, 0.3]),
        swap([1.0, 0.0, 0.0]),
        walls.concat()
    ))
    .expect("a sound scene")
}

/// A uniform flow keeps its level and speed for two passages, and the water is what the start and the faces have given, along either axis.
#[test]
fn a_uniform_flow_passes_faces_normal_to_x_and_to_y() {
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let mut sim = channel(name);
        let start = sim.system().fluid().len();
        assert_eq!(start, 16 * 8 * 6, "the water between the faces");
        common::run_to(&mut sim, 2.0 * LENGTH).expect("a sound run");
        let (fluid, exchange) = (sim.system().fluid(), sim.system().face_exchange());
        let taken: i64 = exchange.iter().map(|face| face.entered as i64 - face.left as i64).sum();
        assert_eq!(fluid.len() as i64, start as i64 + taken, "the books of the water");
        // A column more or less between two rebuilds of the lists is 1/16 of the water, and 1/32 of what has entered.
        let (level, entered) = (fluid.len() as f64 / start as f64, exchange[0].entered as f64 / (2 * start) as f64);
        assert!((level - 1.0).abs() < 1.0 / 15.0, "{name}: the volume is {level} of that at the start");
        assert!((entered - 1.0).abs() < 1.0 / 31.0, "{name}: {entered} of the water of two passages has entered");
        let mean = |k: usize| fluid.v.iter().map(|v| v[k]).sum::<f64>() / fluid.len() as f64;
        assert!((mean(axis) - 1.0).abs() < 0.02, "{name}: {} m/s", mean(axis));
        assert!(mean(1 - axis).abs() < 0.01, "{name}: {} m/s across", mean(1 - axis));
    }
}

/// A channel along x, half of it beside the plane y = 0 or one period of it between periodic sides, with a current of 1 m/s.
fn open_channel(sides: &str, walls: &str) -> Simulation<3> {
    common::scene_simulation::<3>(&format!(
        "dimension = 3\ndp = {DP}\nuntil = 1.0\n{sides}\n\
         inflow = [{{ x = 0.0, velocity = 1.0 }}]\noutflow = [{{ x = {LENGTH}, velocity = 1.0 }}]\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [{LENGTH}, 0.4, 0.3] }} }}\nvelocity = [1.0, 0.0, 0.0]\n\
         [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [4.0, 2.6, 0.2] }} }}\nat = [0.4, 0.0, -0.1]\n{walls}"
    ))
    .expect("a sound scene")
}

/// New particles beyond a face have their images across sides and planes in their own places: a uniform flow stays uniform there
/// while its water enters. Without these images, water at the plane moved across at more than a tenth of the current.
#[test]
fn a_uniform_flow_through_faces_stays_uniform_at_planes_and_periodic_sides() {
    let wall = "[[solid]]\nname = \"left\"\nfixed = true\nshape = { box = { size = [4.0, 0.3, 0.5] } }\nat = [0.4, 0.55, 0.25]\n";
    for (sides, walls) in [("symmetry = { y = 0.0 }", wall), ("periodic = { y = [0.0, 0.4] }", "")] {
        let mut sim = open_channel(sides, walls);
        let mut across = 0.0f64;
        while sim.time() < 0.3 {
            sim.step().expect("a sound run");
            let fluid = sim.system().fluid();
            let beside = fluid.r.iter().zip(fluid.v).filter(|(r, _)| r[1] < 0.1);
            across = beside.map(|(_, v)| v[1].abs()).fold(across, f64::max);
        }
        let exchange = sim.system().face_exchange();
        assert!(exchange.iter().any(|face| face.entered > 0), "{sides}: water has entered");
        assert!(across < 0.02, "{sides}: {across} m/s across");
        // What the images bring across is opposite.
        assert!(sides.contains("periodic") || exchange.iter().all(|face| face.momentum[1] == 0.0), "{exchange:?}");
    }
}
