//! Periodic sides and symmetry planes on a device. As on the host, water near a side has images, which follow all particles in the
//! arrays of places and velocities that the pair loop reads. The device makes them anew with the lists.

use super::layout::{Layout, Place, place_of};
use crate::system::{AxisSet, System, device_state};

/// The periodic sides and the symmetry planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides<const D: usize> {
    /// Where a period begins and ends along each axis, in units of a place, if it has one.
    sides: [Option<[i64; 2]>; D],
    /// Where there is a symmetry plane, in units of a place, and whether the side of greater coordinates is computed.
    planes: [Option<(i64, bool)>; D],
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
        let planes = system.symmetry_planes().0.map(|plane| plane.map(|plane| (layout.fine(plane.at), plane.is_upper)));
        Self { sides, planes, width: layout.coarse(device_state::image_width(system), f64::ceil) }
    }

    fn any(&self) -> bool {
        self.sides.iter().any(Option::is_some) || self.has_planes()
    }

    /// Whether there is a symmetry plane.
    pub(super) fn has_planes(&self) -> bool {
        self.planes.iter().any(Option::is_some)
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
        let across = self.planes.iter().map(|plane| if plane.is_some() { 2 } else { 1 });
        self.sides.iter().map(along).chain(across).product::<usize>() - 1
    }

    /// The range of cells along axis number `axis` that images reach, in 2⁻⁸ of the support.
    pub(super) fn reach(&self, axis: usize) -> Option<[i32; 2]> {
        let ends = self.sides[axis].or(self.planes[axis].map(|(at, _)| [at; 2]));
        ends.map(|[from, to]| [(from >> 32) as i32 - self.width, (to >> 32) as i32 + self.width])
    }

    /// The constants and functions of the shaders.
    pub(super) fn text(&self) -> String {
        let axes = |of: &dyn Fn(usize) -> bool| {
            let axes: Vec<_> = (0..3).map(|k| (k < D && of(k)).to_string()).collect();
            format!("vec3<bool>({})", axes.join(", "))
        };
        let is_upper = |k: usize, upper: bool| self.planes[k].is_some_and(|(_, is_upper)| is_upper == upper);
        let end = |k: usize| place_of(self.sides.map(|side| side.map_or(0, |ends| ends[k])));
        let planes = |times: i64| place_of(self.planes.map(|plane| plane.map_or(0, |(at, _)| times * at)));
        let places = [
            ("FROM", end(0)),
            ("TO", end(1)),
            ("PERIOD", place_of(self.periods())),
            ("MINUS_PERIOD", place_of(self.periods().map(|period| -period))),
            ("PLANES", planes(1)),
            ("TWICE_PLANES", planes(2)),
        ];
        let places: String = places.iter().map(|(name, place)| constant(name, place)).collect();
        format!(
            "const PERIODIC: bool = {};\nconst REFLECTS: bool = {};\nconst KINDS: u32 = {}u;\nconst WIDTH: i32 = {};\n\
             const AXES: vec3<bool> = {};\nconst UPPER: vec3<bool> = {};\nconst LOWER: vec3<bool> = {};\n{places}{}",
            self.any(),
            self.has_planes(),
            self.kinds(),
            self.width,
            axes(&|k| self.sides[k].is_some()),
            axes(&|k| is_upper(k, true)),
            axes(&|k| is_upper(k, false)),
            include_str!("shaders/sides.wgsl")
        )
    }

    /// The way to an image that is reflected along `axes`.
    pub(super) fn way(axes: AxisSet) -> u32 {
        (0..3).map(|k| u32::from(axes >> k & 1) * 3u32.pow(k)).sum()
    }
}
