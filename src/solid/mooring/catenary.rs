//! The elastic catenary: the shape and the tension of a line at rest between two points, hanging or partly on a flat bed.
//!
//! H is the horizontal tension, V the vertical tension at the upper end, w the weight less buoyancy per metre, and EA the axial
//! stiffness. A hanging line of length L spans (Irvine 1981)
//!
//!   x = H/w (asinh(V/H) − asinh((V − w L)/H)) + H L/EA
//!   z = H/w (√(1 + (V/H)²) − √(1 + ((V − w L)/H)²)) + (V L − ½ w L²)/EA
//!
//! and a line of which the length L_B = L − V/w lies on a bed with the friction coefficient C_B (Jonkman 2007)
//!
//!   x = L_B + H/w asinh(V/H) + H L/EA + C_B w/(2 EA) (max(λ, 0)² − L_B²),  λ = L_B − H/(C_B w)
//!   z = H/w (√(1 + (V/H)²) − 1) + V²/(2 EA w)
//!
//! Both are gradients of a convex complementary energy of (H, V), so that a damped Newton iteration finds the one solution.

/// Most iterations of Newton's method.
const ITERATIONS: usize = 200;

/// Error of the span at which the iteration ends, over the length.
const TOLERANCE: f64 = 1e-13;

/// A homogeneous line between two points of a vertical plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CatenarySpan {
    /// Horizontal distance of the ends, m, 0 or more.
    pub(crate) x: f64,
    /// Height of the upper end above the lower end, m, 0 or more.
    pub(crate) z: f64,
    /// Length without tension, m.
    pub(crate) length: f64,
    /// Weight less buoyancy, N/m, more than 0.
    pub(crate) weight: f64,
    /// Axial stiffness EA, N.
    pub(crate) stiffness: f64,
    /// Friction coefficient of a flat bed at the height of the lower end, –; `None` if there is no bed.
    pub(crate) bed: Option<f64>,
}

/// The solution of a [`CatenarySpan`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Catenary {
    span: CatenarySpan,
    /// Horizontal tension at the upper end, N.
    pub(crate) horizontal: f64,
    /// Vertical tension at the upper end, N.
    pub(crate) vertical: f64,
}

impl CatenarySpan {
    /// Horizontal and vertical distance of the ends (m) under the tension H, V (N) at the upper end.
    fn distance(&self, h: f64, v: f64) -> [f64; 2] {
        let Self { length, weight: w, stiffness: ea, .. } = *self;
        let bottom = v - w * length;
        match self.bed.filter(|_| bottom < 0.0) {
            None => [
                h / w * ((v / h).asinh() - (bottom / h).asinh()) + h * length / ea,
                h / w * (1f64.hypot(v / h) - 1f64.hypot(bottom / h)) + (v * length - 0.5 * w * length * length) / ea,
            ],
            Some(friction) => {
                let lying = length - v / w;
                let x =
                    lying + h / w * (v / h).asinh() + h * length / ea - self.friction_contraction(h, lying, friction);
                [x, h / w * (1f64.hypot(v / h) - 1.0) + 0.5 * v * v / (ea * w)]
            }
        }
    }

    /// Stretch (m) that friction takes from the part of length `lying` (m) on the bed.
    fn friction_contraction(&self, h: f64, lying: f64, friction: f64) -> f64 {
        if friction == 0.0 {
            return 0.0;
        }
        let slack = lying - h / (friction * self.weight);
        0.5 * friction * self.weight / self.stiffness * (lying * lying - slack.max(0.0).powi(2))
    }

    /// Derivatives of [`CatenarySpan::distance`] by H and V: the symmetric matrix of rows x and z.
    fn compliance(&self, h: f64, v: f64) -> [[f64; 2]; 2] {
        let Self { length, weight: w, stiffness: ea, .. } = *self;
        let bottom = v - w * length;
        let unit = |t: f64| t / h.hypot(t);
        match self.bed.filter(|_| bottom < 0.0) {
            None => {
                let turn = (v / h).asinh() - (bottom / h).asinh();
                let xh = (turn - unit(v) + unit(bottom)) / w + length / ea;
                let xv = (h / h.hypot(v) - h / h.hypot(bottom)) / w;
                [[xh, xv], [xv, (unit(v) - unit(bottom)) / w + length / ea]]
            }
            Some(friction) => {
                let lying = length - v / w;
                let mut xh = ((v / h).asinh() - unit(v)) / w + length / ea;
                let mut xv = (h / h.hypot(v) - 1.0) / w;
                if friction > 0.0 {
                    let slack = (lying - h / (friction * w)).max(0.0);
                    xh -= slack / ea;
                    xv += friction * (lying - slack) / ea;
                }
                let zv = unit(v) / w + v / (ea * w);
                [[xh, xv], [(h / h.hypot(v) - 1.0) / w, zv]]
            }
        }
    }

    /// Finds the tension at which the ends have their given distance. A line longer than the way down and along the bed has no
    /// horizontal tension.
    pub(crate) fn solve(&self) -> Catenary {
        let Self { x, z, length, weight: w, stiffness: ea, .. } = *self;
        let least = 1e-9 * w * length;
        let slack_vertical = 2.0 * z * w / (1.0 + (1.0 + 2.0 * z * w / ea).sqrt());
        let slack = self.bed.is_some() && slack_vertical < w * length && x <= length - slack_vertical / w;
        if slack || x <= 1e-12 * length {
            let vertical = match slack || self.bed.is_some() && slack_vertical < w * length {
                true => slack_vertical,
                // Both halves hang from their ends; a taut line has its stretch.
                false => (0.5 * w * (length + z)).max(ea * (z / length - 1.0) + 0.5 * w * length),
            };
            return Catenary { span: *self, horizontal: if slack { 0.0 } else { least }, vertical };
        }
        let ratio = (length * length - z * z) / (x * x) - 1.0;
        let steepness = if ratio > 0.0 { (3.0 * ratio).sqrt() } else { 0.2 };
        let mut h = (0.5 * w * x / steepness).max(least);
        let mut v = 0.5 * w * (z / steepness.tanh() + length);
        let error = |h: f64, v: f64| {
            let [dx, dz] = self.distance(h, v);
            [dx - x, dz - z]
        };
        let size = |e: [f64; 2]| e[0].hypot(e[1]);
        let mut now = error(h, v);
        for _ in 0..ITERATIONS {
            if size(now) <= TOLERANCE * length {
                break;
            }
            let [[a, b], [c, d]] = self.compliance(h, v);
            let determinant = a * d - b * c;
            let step = [(b * now[1] - d * now[0]) / determinant, (c * now[0] - a * now[1]) / determinant];
            let mut part = 1.0;
            let better = std::iter::from_fn(|| {
                let tried = ((h + part * step[0]).max(0.1 * h), v + part * step[1]);
                part *= 0.5;
                Some(tried)
            })
            .take(40)
            .find(|&(h, v)| size(error(h, v)) < size(now));
            let Some(next) = better else { break };
            (h, v) = next;
            now = error(h, v);
        }
        Catenary { span: *self, horizontal: h, vertical: v }
    }
}

impl Catenary {
    /// Length on the bed, m.
    pub(crate) fn lying(&self) -> f64 {
        let hanging = self.vertical / self.span.weight;
        if self.span.bed.is_some() { (self.span.length - hanging).max(0.0) } else { 0.0 }
    }

    /// Tension (N) at the arc length `s` (m) without tension from the lower end.
    #[cfg(test)]
    pub(crate) fn tension(&self, s: f64) -> f64 {
        let (w, lying) = (self.span.weight, self.lying());
        if s < lying {
            let friction = self.span.bed.unwrap_or_default();
            return (self.horizontal - friction * w * (lying - s)).max(0.0);
        }
        self.horizontal.hypot(self.vertical - w * (self.span.length - s))
    }

    /// Horizontal and vertical distance (m) from the lower end of the point at the arc length `s` (m) without tension.
    pub(crate) fn position(&self, s: f64) -> [f64; 2] {
        let CatenarySpan { length, weight: w, stiffness: ea, bed, .. } = self.span;
        let (h, lying) = (self.horizontal.max(1e-12 * w * length), self.lying());
        let bottom = self.vertical - w * length;
        if lying == 0.0 {
            let here = bottom + w * s;
            return [
                h / w * ((here / h).asinh() - (bottom / h).asinh()) + h * s / ea,
                h / w * (1f64.hypot(here / h) - 1f64.hypot(bottom / h)) + (bottom * s + 0.5 * w * s * s) / ea,
            ];
        }
        // A slack line lies evenly spread up to the foot of the part that hangs.
        let spread = if self.horizontal > 0.0 { 1.0 } else { self.span.x / lying };
        let friction = bed.unwrap_or_default();
        let stretch = |s: f64| {
            let pulled = |s: f64| (self.horizontal - friction * w * (lying - s)).max(0.0);
            match friction > 0.0 {
                true => (pulled(s).powi(2) - pulled(0.0).powi(2)) / (2.0 * friction * w * ea),
                false => self.horizontal * s / ea,
            }
        };
        if s <= lying {
            return [s * spread + stretch(s), 0.0];
        }
        let up = s - lying;
        let x = h / w * (w * up / h).asinh() + self.horizontal * up / ea;
        let hangs = if self.horizontal > 0.0 { x } else { 0.0 };
        [lying * spread + stretch(lying) + hangs, h / w * (1f64.hypot(w * up / h) - 1.0) + 0.5 * w * up * up / ea]
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/solid/mooring/catenary.rs"]
mod tests;
