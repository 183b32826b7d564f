//! The builder of a solid, its start, the mass of a free body from its shape, and the checks at set-up.

use crate::{
    error::{Error, ErrorCode, Result},
    geometry::Shape,
    math::{Bivector, Bounds, Matrix, Pose, Vector},
    solid::{
        DEFAULT_CONTACT_SKIN, DEFAULT_FRICTION, DEFAULT_RESTITUTION, FreeBody, Kinematics, PrescribedMotion, Role,
        SolidSpec,
    },
};

/// Round-off allowed in the symmetry and the triangle inequality of an inertia, relative.
const INERTIA_SLACK: f64 = 1e-9;

impl<const D: usize> SolidSpec<D> {
    fn new(name: impl Into<String>, shape: Shape<D>, role: Role<D>) -> Self {
        Self {
            name: name.into(),
            shape,
            pose: Pose::identity(),
            role,
            friction: DEFAULT_FRICTION,
            restitution: DEFAULT_RESTITUTION,
            contact_skin: DEFAULT_CONTACT_SKIN,
            dry: None,
            ballast: Vec::new(),
        }
    }

    /// A solid that does not move. Its frame is the world's.
    pub fn fixed(name: impl Into<String>, shape: Shape<D>) -> Self {
        Self::new(name, shape, Role::Fixed)
    }

    /// A solid with a prescribed motion. Its frame is the world's where the motion is zero.
    pub fn driven(name: impl Into<String>, shape: Shape<D>, motion: PrescribedMotion<D>) -> Self {
        Self::new(name, shape, Role::Driven(motion))
    }

    /// A homogeneous free body of `density` (kg/m³), at rest in the world's frame.
    pub fn free(name: impl Into<String>, shape: Shape<D>, density: f64) -> Self {
        let body = FreeBody::from_density(&shape, density);
        Self::with_body(name, shape, body)
    }

    /// A free solid with the mass and the initial velocity of `body`, in the world's frame.
    pub fn with_body(name: impl Into<String>, shape: Shape<D>, body: FreeBody<D>) -> Self {
        Self::new(name, shape, Role::Free(body))
    }

    /// The same solid with its frame at `pose`, or at a point (m) without rotation.
    pub fn at(self, pose: impl Into<Pose<D>>) -> Self {
        Self { pose: pose.into(), ..self }
    }

    /// The same solid with a Coulomb friction coefficient (–).
    pub fn friction(self, friction: f64) -> Self {
        Self { friction, ..self }
    }

    /// The same solid with a restitution coefficient (–): 0 without rebound, 1 without loss.
    pub fn restitution(self, restitution: f64) -> Self {
        Self { restitution, ..self }
    }

    /// The same solid, with contact beginning at this distance (m) from its faces.
    pub fn contact_skin(self, contact_skin: f64) -> Self {
        Self { contact_skin, ..self }
    }

    /// Pose and velocity of the solid at t = 0.
    ///
    /// `centre` is the centre of mass of a free solid, the hinge of a hinged solid, otherwise the frame's origin.
    pub fn initial_kinematics(&self) -> Kinematics<D> {
        let still = Kinematics {
            pose: self.pose,
            centre: self.pose.position,
            velocity: Vector::zeros(),
            spin: Bivector::zero(),
        };
        match (&self.role, self.initial_body()) {
            (Role::Driven(motion), _) => motion.kinematics(&self.pose, 0.0),
            (_, None) => still,
            (_, Some(body)) => {
                Kinematics { centre: self.pose.point(&body.centre), velocity: body.velocity, spin: body.spin, ..still }
            }
        }
    }

    /// Checks shape (parts of a free solid may not overlap), pose, role, friction, restitution and
    /// contact skin.
    ///
    /// # Errors
    /// `Scene`: names the solid, what is wrong with it, and what would be right.
    pub fn check(&self) -> Result<()> {
        self.shape.check().map_err(|e| self.named(e))?;
        if let Role::Free(_) = self.role {
            self.shape.check_no_overlap().map_err(|e| self.named(e))?;
        }
        self.check_role()
    }

    /// [`SolidSpec::check`] without the shape.
    pub(super) fn check_role(&self) -> Result<()> {
        let role = match &self.role {
            Role::Fixed => Ok(()),
            Role::Driven(motion) => motion.check(),
            Role::Free(body) => body.check(),
        };
        role.and_then(|()| self.check_ballast())
            .and_then(|()| {
                let turn = self.pose.rotation;
                let off = (turn * turn.transpose() - Matrix::identity()).norm();
                require(self.pose.position.norm().is_finite(), || "its position is not finite".into(), "m, finite")?;
                require(off < 1e-6, || "its pose is not a rotation".into(), "an orthogonal matrix")?;
                let friction = self.friction;
                require(friction >= 0.0 && friction.is_finite(), || format!("friction is {friction}"), "0 or more")?;
                let bounce = self.restitution;
                require(
                    (0.0..=1.0).contains(&bounce),
                    || format!("restitution is {bounce}"),
                    "0 (stays) … 1 (bounces)",
                )?;
                let (skin, most) = (self.contact_skin, self.thickest_skin());
                let right = format!("0 to {most:.4} m, half of its smallest extent");
                require(self.has_valid_contact_skin(), || format!("its contact skin is {skin} m"), &right)
            })
            .map_err(|e| self.named(e))
    }

    /// Refuses a motion at the start along a locked motion: the engine would keep it.
    pub(super) fn check_locks(&self) -> Result<()> {
        let Role::Free(body) = &self.role else { return Ok(()) };
        let moves =
            |rates: &[f64], locks: &[bool]| rates.iter().zip(locks).any(|(rate, locked)| *locked && *rate != 0.0);
        let along = moves(body.velocity.as_slice(), &body.locked_translations)
            || moves(&body.spin.axial(), &body.locked_rotations);
        require(
            !along,
            || "it starts with a motion that is locked".into(),
            "a velocity and a spin of 0 along locked motions",
        )
        .map_err(|e| self.named(e))
    }

    /// Refuses ballast of a solid that is not free, and ballast without a finite position or a valid mass at t = 0.
    fn check_ballast(&self) -> Result<()> {
        let free = matches!(self.role, Role::Free(_)) || self.ballast.is_empty();
        require(free, || "it has ballast and is not free".into(), "free: the mass of any other solid has no effect")?;
        for ballast in &self.ballast {
            let (place, mass) = (ballast.at.norm(), ballast.mass_at(0.0));
            require(place.is_finite(), || "its ballast is nowhere".into(), "a point in its frame, m, finite")?;
            require(mass.is_finite(), || format!("its ballast is {mass} kg"), "0 or more and finite")?;
        }
        Ok(())
    }

    /// Whether the solid may be a hull in the `water` (m). Without `dry`, a fixed basin around all water and a fixed bed may not.
    pub(crate) fn may_be_hull(&self, water: &Bounds<D>) -> bool {
        let bounds = self.shape.bounds_at(&self.initial_kinematics().pose);
        let is_basin = (0..D - 1).all(|i| bounds.min[i] <= water.min[i] && water.max[i] <= bounds.max[i]);
        let fixed = matches!(self.role, Role::Fixed);
        self.dry.is_some() || !(fixed && (is_basin || matches!(self.shape, Shape::Polyline { .. })))
    }

    /// Whether it has no contact skin, or one that is not thicker than half of its smallest extent.
    pub(crate) fn has_valid_contact_skin(&self) -> bool {
        self.contact_skin == 0.0 || (0.0..=self.thickest_skin()).contains(&self.contact_skin)
    }

    fn thickest_skin(&self) -> f64 {
        0.5 * self.shape.bounds().size().min()
    }

    fn named(&self, mut error: Error) -> Error {
        error.message = format!("solid \"{}\": {}", self.name, error.message);
        error
    }
}

impl<const D: usize> FreeBody<D> {
    /// A body at rest, of `mass` (kg; kg/m in 2-D) and `inertia` (kg m²; kg m²/m in 2-D, in `[(0, 0)]`) about its centre of mass,
    /// which is the origin of the solid's frame.
    pub fn new(mass: f64, inertia: Matrix<D>) -> Self {
        Self {
            mass,
            centre: Vector::zeros(),
            inertia,
            velocity: Vector::zeros(),
            spin: Bivector::zero(),
            locked_translations: [false; D],
            locked_rotations: [false; 3],
        }
    }

    /// The same body with its centre of mass at this point (m) of the solid's frame.
    pub fn centre(self, centre: impl Into<Vector<D>>) -> Self {
        Self { centre: centre.into(), ..self }
    }

    /// The same body with this inertia (kg m²; kg m²/m in 2-D, in `[(0, 0)]`) about its centre of mass.
    pub fn inertia(self, inertia: Matrix<D>) -> Self {
        Self { inertia, ..self }
    }

    /// The same body with this velocity (m/s) of its centre of mass at the start.
    pub fn velocity(self, velocity: impl Into<Vector<D>>) -> Self {
        Self { velocity: velocity.into(), ..self }
    }

    /// The same body with this spin (rad/s) at the start.
    pub fn spin(self, spin: Bivector<D>) -> Self {
        Self { spin, ..self }
    }

    /// The same body, which cannot move along the world's axis number `axis`.
    ///
    /// # Panics
    /// If `axis` is not less than the dimension.
    pub fn lock_translation(mut self, axis: usize) -> Self {
        self.locked_translations[axis] = true;
        self
    }

    /// The same body, which cannot turn about the world's axis number `axis`; 0 in 2-D.
    ///
    /// # Panics
    /// If `axis` is more than 2.
    pub fn lock_rotation(mut self, axis: usize) -> Self {
        self.locked_rotations[axis] = true;
        self
    }

    /// The homogeneous body of `density` (kg/m³) that fills `shape`, at rest; J is the second moment of the volume about its
    /// centroid.
    ///
    ///   m = ρ V,   I = ρ (tr J · 1 − J) in 3-D, ρ tr J in 2-D
    pub fn from_density(shape: &Shape<D>, density: f64) -> Self {
        let volume = shape.volume_properties();
        let trace = volume.second_moment.trace();
        let inertia = if D == 2 {
            Matrix::from_fn(|i, j| if (i, j) == (0, 0) { trace } else { 0.0 })
        } else {
            Matrix::identity() * trace - volume.second_moment
        };
        Self::new(density * volume.volume, inertia * density).centre(volume.centroid)
    }

    /// The homogeneous body of `mass` (kg; kg/m in 2-D) that fills `shape`, at rest.
    pub fn from_mass(shape: &Shape<D>, mass: f64) -> Self {
        Self::from_density(shape, mass / shape.volume_properties().volume)
    }

    /// Checks that mass and inertia are those of a body.
    ///
    /// # Errors
    /// `Scene` if a number is not finite, the mass is not positive, or the inertia is not that of any body.
    pub fn check(&self) -> Result<()> {
        let mass = self.mass;
        require(mass > 0.0 && mass.is_finite(), || format!("its mass is {mass} kg"), "more than 0 and finite")?;
        let rest = self.centre.norm() + self.velocity.norm() + self.spin.0.norm();
        require(rest.is_finite(), || "its centre, velocity or spin is not finite".into(), "finite numbers")?;
        if D == 2 {
            let inertia = self.inertia[(0, 0)];
            let fine = inertia > 0.0 && inertia.is_finite();
            return require(fine, || format!("its inertia is {inertia} kg m²"), "more than 0 and finite");
        }
        let inertia = nalgebra::Matrix3::from_fn(|i, j| self.inertia[(i, j)]);
        let size = inertia.norm();
        let symmetric = size.is_finite() && (inertia - inertia.transpose()).norm() <= INERTIA_SLACK * size;
        require(symmetric, || "its inertia is not a symmetric matrix of finite numbers".into(), "I_ij = I_ji")?;
        let mut principal: Vec<f64> = inertia.symmetric_eigenvalues().iter().copied().collect();
        principal.sort_by(f64::total_cmp);
        require(
            principal[0] > 0.0 && principal[0] + principal[1] >= principal[2] * (1.0 - INERTIA_SLACK),
            || format!("no body has the principal moments of inertia {principal:?} kg m²"),
            "all more than 0, and none more than the sum of the other two",
        )
    }
}

/// An error saying `what` is wrong and what `would be` right, unless `fine`.
fn require(fine: bool, what: impl FnOnce() -> String, right: &str) -> Result<()> {
    if fine {
        Ok(())
    } else {
        Err(Error::scene(what()).with_code(ErrorCode::OutOfRange).help(format!("it must be: {right}")))
    }
}

#[cfg(test)]
#[path = "../../tests/unit/solid/body.rs"]
mod tests;
