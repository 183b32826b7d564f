//! Periodic sides on a device. As on the host, water near a side has images, which follow all particles in the arrays of places and
//! velocities that the pair loop reads. The device makes them anew with the lists.

use super::layout::{Layout, Place, place_of};
use crate::system::{System, device_state};

/// The periodic sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides<const D: usize> {
    /// Where a period begins and ends along each axis, in units of a place, if it has one.
    sides: [Option<[i64; 2]>; D],
    /// Distance to which images reach beyond a side, in 2⁻⁸ of the support.
    width: i32,
}

/// `place` as a constant of a shader.
fn constant(name: &str, place: &Place) -> String {
    let join = |words: Vec<String>| words.join(", ");
    let hi = join(place[..4].iter().map(|x| format!("{}", *x as i32)).collect());
    let lo = join(place[4..].iter().map(|x| format!("{x}u")).collect());
    format!("const {name}: Place = Place(vec4<i32>({hi}), vec4<u32>({lo}));\n")
}

impl<const D: usize> Sides<D> {
    /// Those of `system`.
    pub(super) fn new(system: &System<D>, layout: &Layout) -> Self {
        let sides = system.periodic().map(|side| side.map(|ends| ends.map(|x| layout.fine(x))));
        Self { sides, width: layout.coarse(device_state::image_width(system), f64::ceil) }
    }

    fn any(&self) -> bool {
        self.sides.iter().any(Option::is_some)
    }

    /// The periods along each axis, in units of a place; 0 where there is none.
    pub(super) fn periods(&self) -> [i64; D] {
        self.sides.map(|side| side.map_or(0, |[from, to]| to - from))
    }

    /// Kinds of particles that are sorted into cells: water, boundary particles, images.
    pub(super) fn kinds(&self) -> usize {
        if self.any() { 3 } else { 2 }
    }

    /// The most images of a water particle.
    pub(super) fn images_of_each(&self) -> usize {
        let along = |side: &Option<[i64; 2]>| match side {
            None => 1,
            Some([from, to]) if (to >> 32) - (from >> 32) >= 2 * i64::from(self.width) => 2,
            Some(_) => 3,
        };
        self.sides.iter().map(along).product::<usize>() - 1
    }

    /// The range of cells along axis number `axis` that images reach, in 2⁻⁸ of the support.
    pub(super) fn reach(&self, axis: usize) -> Option<[i32; 2]> {
        self.sides[axis].map(|[from, to]| [(from >> 32) as i32 - self.width, (to >> 32) as i32 + self.width])
    }

    /// The constants of the shaders.
    pub(super) fn constants(&self) -> String {
        let end = |k: usize| place_of(self.sides.map(|side| side.map_or(0, |ends| ends[k])));
        let axes: Vec<_> = (0..3).map(|k| self.sides.get(k).is_some_and(Option::is_some).to_string()).collect();
        let places = [
            ("FROM", end(0)),
            ("TO", end(1)),
            ("PERIOD", place_of(self.periods())),
            ("MINUS_PERIOD", place_of(self.periods().map(|period| -period))),
        ];
        let places: String = places.iter().map(|(name, place)| constant(name, place)).collect();
        format!(
            "const PERIODIC: bool = {};\nconst KINDS: u32 = {}u;\nconst WIDTH: i32 = {};\n\
             const AXES: vec3<bool> = vec3<bool>({});\n{places}",
            self.any(),
            self.kinds(),
            self.width,
            axes.join(", ")
        )
    }
}
