//! `[[solid]]`: fixed, driven and free solids.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    ballast::BallastConfig,
    motion::DrivenConfig,
    shape::{PlacementConfig, ShapeConfig, vector},
    water::StillWater,
    wavemaker,
};
use crate::{
    error::{Error, ErrorCode, Result, suggestion},
    geometry::{Shape, world_bounds},
    math::{Bivector, Matrix, NumberOrArray, Pose, Vector},
    scene::{
        context::{Context, Defaults, quoted_list, set_keys},
        file_units,
        untagged::DraftChoice,
    },
    solid::{BallastSpec, DEFAULT_CONTACT_SKIN, DEFAULT_FRICTION, DEFAULT_RESTITUTION, FreeBody, Role, SolidSpec},
};

/// Largest extent, dp, of bodies that must weigh at least half a water particle.
const SMALL: f64 = 7.9;

/// Thickness, dp, below which one row of boundary particles stands for both faces of a body.
const THIN: f64 = 1.5;

/// Least density over the water's of so thin a body, –.
const THIN_DENSITY: f64 = 0.2;

/// A section `[[solid]]`: a name, a shape, a place, and exactly one of `fixed`, `driven`, `free`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct SolidConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// Its group, a name for `[[contact]]`.
    pub group: Option<String>,
    /// Geometry in the solid's own frame.
    pub shape: ShapeConfig,
    /// Pose of that frame at the start; by default at the origin.
    pub at: Option<PlacementConfig>,
    /// `true`: it does not move.
    #[schemars(extend("const" = true))]
    pub fixed: Option<bool>,
    /// Its prescribed motion.
    pub driven: Option<DrivenConfig>,
    /// Its mass, if water, weight and contacts move it.
    pub free: Option<FreeBodyConfig>,
    /// Coulomb friction coefficient, –.
    pub friction: Option<f64>,
    /// Restitution coefficient, –.
    pub restitution: Option<f64>,
    /// Distance from its faces at which contact begins, m.
    #[schemars(extend("also" = "skin"))]
    pub contact_skin: Option<f64>,
    /// Whether the space that it encloses below its rim starts without water.
    pub dry: Option<bool>,
    /// Time at which it is removed, with the constraints on it, s.
    pub until: Option<f64>,
}

/// A body that water, weight and contacts move.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct FreeBodyConfig {
    /// Density, kg/m³.
    pub density: Option<f64>,
    /// Mass, kg (kg per metre of width in 2-D), in place of a density.
    pub mass: Option<f64>,
    /// Inertia about the centre of mass, kg m² (kg m²/m in 2-D): a number in 2-D; in 3-D the three
    /// about the solid's own axes, or the 3×3 tensor.
    pub inertia: Option<NumberOrArray>,
    /// Vector from the centroid to the centre of mass, in the solid's frame, m.
    pub centre_offset: Option<Vec<f64>>,
    /// Velocity of the centre of mass at the start, m/s.
    pub velocity: Option<Vec<f64>>,
    /// Spin at the start, rad/s: a number in 2-D, a vector in 3-D.
    pub spin: Option<NumberOrArray>,
    /// Time of its release, s; until then it is held at rest.
    pub release: Option<f64>,
    /// Locked modes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub locked: Vec<MotionMode>,
    /// Masses at its points that change with time, in addition to its own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ballast: Vec<BallastConfig>,
}

/// A mode of motion, which can be locked or left free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MotionMode {
    /// Translation along x.
    X,
    /// Translation along y.
    Y,
    /// Translation along z; 3-D.
    Z,
    /// Turning; 2-D.
    Turn,
    /// Turning about x; 3-D.
    TurnX,
    /// Turning about y; 3-D.
    TurnY,
    /// Turning about z; 3-D.
    TurnZ,
}

impl MotionMode {
    /// Its name in a scene.
    fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Turn => "turn",
            Self::TurnX => "turn_x",
            Self::TurnY => "turn_y",
            Self::TurnZ => "turn_z",
        }
    }

    /// Its number among the modes of this dimension, translations first; `None` if there is no such mode.
    pub(crate) fn index(self, dimension: usize) -> Option<usize> {
        match (self, dimension == 3) {
            (Self::X, _) => Some(0),
            (Self::Y, _) => Some(1),
            (Self::Z, true) | (Self::Turn, false) => Some(2),
            (Self::TurnX, true) => Some(3),
            (Self::TurnY, true) => Some(4),
            (Self::TurnZ, true) => Some(5),
            _ => None,
        }
    }
}

impl SolidConfig {
    fn new(name: impl Into<String>, shape: ShapeConfig) -> Self {
        Self {
            name: name.into(),
            group: None,
            shape,
            at: None,
            fixed: None,
            driven: None,
            free: None,
            friction: None,
            restitution: None,
            contact_skin: None,
            dry: None,
            until: None,
        }
    }

    /// A solid that nothing moves.
    pub fn fixed(name: impl Into<String>, shape: ShapeConfig) -> Self {
        Self { fixed: Some(true), ..Self::new(name, shape) }
    }

    /// A homogeneous free body of `density` (kg/m³).
    pub fn free(name: impl Into<String>, shape: ShapeConfig, density: f64) -> Self {
        let free = FreeBodyConfig { density: Some(density), ..FreeBodyConfig::default() };
        Self { free: Some(free), ..Self::new(name, shape) }
    }

    /// A solid with a prescribed motion.
    pub fn driven(name: impl Into<String>, shape: ShapeConfig, motion: DrivenConfig) -> Self {
        Self { driven: Some(motion), ..Self::new(name, shape) }
    }

    /// A free body with this mass and start.
    pub fn with_body(name: impl Into<String>, shape: ShapeConfig, body: FreeBodyConfig) -> Self {
        Self { free: Some(body), ..Self::new(name, shape) }
    }

    /// Returns the same solid at a place.
    pub fn at(self, at: PlacementConfig) -> Self {
        Self { at: Some(at), ..self }
    }

    /// Returns the same solid with a Coulomb friction coefficient (–).
    pub fn friction(self, friction: f64) -> Self {
        Self { friction: Some(friction), ..self }
    }

    /// Returns the same solid with a restitution coefficient (–).
    pub fn restitution(self, restitution: f64) -> Self {
        Self { restitution: Some(restitution), ..self }
    }

    /// Returns the same solid, with contact beginning at this distance (m) from its faces.
    pub fn contact_skin(self, contact_skin: f64) -> Self {
        Self { contact_skin: Some(contact_skin), ..self }
    }

    /// Returns the same solid, with its enclosed space without water at the start, or with water that is meant.
    pub fn dry(self, dry: bool) -> Self {
        Self { dry: Some(dry), ..self }
    }

    /// Refuses a solid that is not complete; `others` are the solids before it and `all` those of the scene.
    fn verify(&self, ctx: &Context, key: &str, others: &[SolidConfig], all: &[SolidConfig]) -> Result<()> {
        ctx.require_file_name(&format!("{key}.name"), &self.name)?;
        if others.iter().any(|other| other.name == self.name) {
            let what = format!("two solids are called \"{}\"", self.name);
            return Err(ctx.error_with_help(&format!("{key}.name"), what, "give each its own name"));
        }
        if let Some(group) = &self.group {
            verify_group(ctx, all, &format!("{key}.group"), group)?;
        }
        self.shape.verify(ctx, &format!("{key}.shape"))?;
        if let Some(at) = &self.at {
            at.verify(ctx, &format!("{key}.at"), true)?;
        }
        self.verify_role(ctx, key)?;
        ctx.require_positive(&format!("{key}.until"), self.until)?;
        let release = self.free.as_ref().and_then(|free| free.release);
        if let (Some(release), Some(until)) = (release, self.until.filter(|until| release.is_some_and(|t| t > *until)))
        {
            let what = format!("\"{}\" is released at {release} s, after its removal at {until} s", self.name);
            let help = "release it before its time  until";
            return Err(ctx
                .error_with_help(&format!("{key}.free.release"), what, help)
                .with_code(ErrorCode::OutOfRange));
        }
        ctx.require_range(&format!("{key}.friction"), self.friction, 10.0)?;
        ctx.require_range(&format!("{key}.restitution"), self.restitution, 1.0)
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, ctx: &Context, defaults: &mut Defaults, key: &str) {
        self.shape.fill(ctx, defaults, &format!("{key}.shape"));
        defaults.fill(
            format!("{key}.at"),
            &mut self.at,
            PlacementConfig::default(),
            "the shape's frame is the world's",
        );
        defaults.fill(format!("{key}.friction"), &mut self.friction, DEFAULT_FRICTION, "wet wood or plastic");
        let why = "lubrication by water dissipates the rebound";
        defaults.fill(format!("{key}.restitution"), &mut self.restitution, DEFAULT_RESTITUTION, why);
        if let Some(driven) = &mut self.driven {
            driven.fill(defaults, &format!("{key}.driven"));
        }
        for (i, ballast) in self.free.iter_mut().flat_map(|free| free.ballast.iter_mut().enumerate()) {
            ballast.fill(defaults, &format!("{key}.free.ballast.{i}"));
        }
    }

    /// Refuses a solid that is not exactly one of fixed, driven and free.
    fn verify_role(&self, ctx: &Context, key: &str) -> Result<()> {
        let roles = [("fixed", self.fixed.is_some()), ("driven", self.driven.is_some()), ("free", self.free.is_some())];
        let roles = set_keys(roles);
        if self.fixed == Some(false) {
            let (what, help) = match roles.get(1) {
                Some(other) => (format!("fixed = false says nothing beside {other}"), "remove  fixed = false"),
                None => (
                    "fixed = false does not say what moves it".into(),
                    "a solid that is not fixed is driven = { ... } or free = { ... }",
                ),
            };
            return Err(ctx.error_with_help(&format!("{key}.fixed"), what, help));
        }
        if roles.len() != 1 {
            let what = match roles.len() {
                0 => format!("nothing says what moves solid \"{}\"", self.name),
                _ => format!("solid \"{}\" is {}; it can be one of them", self.name, quoted_list(&roles)),
            };
            let help = "write one of\n  fixed  = true\n  driven = { along = [1.0, 0.0], distance = { formula = \
                        \"0.05*sin(2*pi*t)\" } }\n  free   = { density = 500.0 }";
            let place = roles.last().map_or(key.to_string(), |role| format!("{key}.{role}"));
            let code = if roles.is_empty() { ErrorCode::MissingKey } else { ErrorCode::ConflictingKeys };
            return Err(ctx.error_with_help(&place, what, help).with_code(code));
        }
        if let Some(config) = &self.driven {
            config.verify(ctx, &format!("{key}.driven"))?;
        }
        if let Some(config) = &self.free {
            config.verify(ctx, &format!("{key}.free"))?;
        }
        Ok(())
    }

    /// Whether it starts at the draft of its equilibrium.
    pub(crate) fn is_afloat(&self) -> bool {
        self.at.as_ref().is_some_and(|at| at.draft == Some(DraftChoice::Equilibrium))
    }

    /// Whether the scene gives its tilt: an angle that is more than a heading.
    pub(crate) fn gives_tilt(&self) -> bool {
        self.at.as_ref().is_some_and(|at| {
            let is_heading = |turn: &[f64]| turn.len() == 3 && turn[..2] == [0.0, 0.0] && turn[2] != 0.0;
            at.angle_deg.is_some() || at.turn_deg.as_ref().is_some_and(|turn| !is_heading(turn))
        })
    }

    /// The solid in the water `pool`. Drafts are measured from the level of the water at its place. One that starts at its equilibrium
    /// is placed with its lowest point at the level.
    pub(crate) fn build<const D: usize>(&self, ctx: &Context, key: &str, pool: &StillWater<D>) -> Result<SolidSpec<D>> {
        let place = |part: &str| {
            let key = format!("{key}.{part}");
            move |e: Error| ctx.with_location(e, &key)
        };
        let shape: Shape<D> = self.shape.build(ctx).map_err(place("shape"))?;
        let (name, at) = (&self.name, self.at.clone().unwrap_or_default());
        let place_at = |level: f64| at.build(&shape, level);
        let own_level = pool.level_at(&world_bounds(&shape, &place_at(pool.still.level)));
        let pose = place_at(own_level.unwrap_or(pool.still.level));
        let role = match (&self.driven, &self.free) {
            (Some(config), _) => {
                let key = format!("{key}.driven");
                Role::Driven(match &config.wave {
                    Some(wave) => wavemaker::build(ctx, &key, config, wave, (&shape, &pose), pool)?,
                    None => config.build(ctx, &key, self.until.unwrap_or(f64::INFINITY))?,
                })
            }
            (None, Some(config)) => {
                let body = config.build(&shape);
                let part = if config.inertia.is_some() { "free.inertia" } else { "free" };
                body.check()
                    .map_err(|e| Error { message: format!("solid \"{}\": {}", name, e.message), ..e })
                    .map_err(place(part))?;
                Role::Free(body)
            }
            (None, None) => Role::Fixed,
        };
        let entries = self.free.iter().flat_map(|free| free.ballast.iter().enumerate());
        let ballast = entries
            .map(|(i, ballast)| ballast.build(ctx, &format!("{key}.free.ballast.{i}")))
            .collect::<Result<Vec<BallastSpec<D>>>>()?;
        if self.is_afloat() && !matches!(role, Role::Free(_)) {
            let key = format!("{key}.at.draft");
            return Err(ctx.error_with_help(
                &key,
                "only a free body finds its own draft",
                "give the height or a draft in metres",
            ));
        }
        let spec = SolidSpec {
            name: self.name.clone(),
            shape,
            pose,
            role,
            friction: self.friction.unwrap_or(DEFAULT_FRICTION),
            restitution: self.restitution.unwrap_or(DEFAULT_RESTITUTION),
            contact_skin: self.contact_skin.unwrap_or(DEFAULT_CONTACT_SKIN),
            dry: self.dry,
            ballast,
        };
        let blamed = if spec.has_valid_contact_skin() { key.to_string() } else { format!("{key}.contact_skin") };
        spec.check().map_err(|e| ctx.with_location(e, &blamed))?;
        // A file in another unit has its own error.
        let unresolved = file_units::is_from_file(&self.shape) && spec.shape.bounds().size().max() < ctx.dp;
        if !unresolved {
            verify_weight(ctx, key, &spec)?;
        }
        verify_thickness(ctx, key, &spec)?;
        Ok(spec)
    }
}

impl FreeBodyConfig {
    /// A homogeneous body of `mass` (kg; kg/m in 2-D), at rest.
    pub fn from_mass(mass: f64) -> Self {
        Self { mass: Some(mass), ..Self::default() }
    }

    /// Refuses a body without a mass, and vectors that do not fit the dimension.
    fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        ctx.require_positive(&format!("{key}.density"), self.density)?;
        let mass = ctx.require_positive(&format!("{key}.mass"), self.mass);
        mass.map_err(|e| e.help("write  free = { mass = 10.0 }        # kg; in 2-D kg/m"))?;
        if self.density.is_some() == self.mass.is_some() {
            return Err(ctx
                .error_with_help(
                    key,
                    "a free body has either a density or a mass",
                    "write  free = { density = 500.0 }        # kg/m³",
                )
                .with_code(match self.density {
                    Some(_) => ErrorCode::ConflictingKeys,
                    None => ErrorCode::MissingKey,
                }));
        }
        for (word, vector) in [("centre_offset", &self.centre_offset), ("velocity", &self.velocity)] {
            if let Some(vector) = vector {
                ctx.require_dimension(&format!("{key}.{word}"), vector)?;
            }
        }
        ctx.require_positive(&format!("{key}.release"), self.release)?;
        if self.release.is_some() && (self.velocity.is_some() || self.spin.is_some()) {
            let what = "what is held at first starts at rest, with neither velocity nor spin";
            return Err(ctx.error_at(&format!("{key}.release"), what).with_code(ErrorCode::ConflictingKeys));
        }
        let three = ctx.dimension == 3;
        let spin_fits = match &self.spin {
            None => true,
            Some(NumberOrArray::One(_)) => !three,
            Some(NumberOrArray::List(list)) => three && list.len() == 3,
            Some(NumberOrArray::Rows(_)) => false,
        };
        if !spin_fits {
            return Err(ctx.error_with_help(
                &format!("{key}.spin"),
                "spin does not fit the dimension",
                "in 2-D a number, spin = 0.5; in 3-D a vector, spin = [0.0, 0.0, 0.5]        # rad/s",
            ));
        }
        self.verify_inertia(ctx, &format!("{key}.inertia"))?;
        let mut ballast = self.ballast.iter().enumerate();
        ballast.try_for_each(|(i, ballast)| ballast.verify(ctx, &format!("{key}.ballast.{i}")))?;
        verify_modes(ctx, &format!("{key}.locked"), &self.locked)?;
        self.verify_start(ctx, key)
    }

    /// Refuses a motion at the start along a locked mode.
    fn verify_start(&self, ctx: &Context, key: &str) -> Result<()> {
        for mode in &self.locked {
            let Some(number) = mode.index(ctx.dimension) else { continue };
            let (word, rate) = match number.checked_sub(ctx.dimension) {
                None => ("velocity", self.velocity.as_ref().and_then(|velocity| velocity.get(number)).copied()),
                Some(axis) => (
                    "spin",
                    match &self.spin {
                        Some(NumberOrArray::One(spin)) => Some(*spin),
                        Some(NumberOrArray::List(list)) => list.get(axis).copied(),
                        _ => None,
                    },
                ),
            };
            let Some(rate) = rate.filter(|rate| *rate != 0.0) else { continue };
            let (name, unit) = (mode.name(), if word == "spin" { "rad/s" } else { "m/s" });
            let what = format!("{word} moves the body with {rate} {unit} along \"{name}\", which is locked");
            let help = format!("make this part of  {word}  0, or remove \"{name}\" from  locked");
            return Err(ctx
                .error_with_help(&format!("{key}.{word}"), what, help)
                .with_code(ErrorCode::ConflictingKeys));
        }
        Ok(())
    }

    /// Refuses an inertia that does not fit the dimension or is not symmetric and positive.
    fn verify_inertia(&self, ctx: &Context, key: &str) -> Result<()> {
        let good = match (&self.inertia, ctx.dimension) {
            (None, _) => true,
            (Some(NumberOrArray::One(x)), 2) => *x > 0.0,
            (Some(NumberOrArray::List(list)), 3) => list.len() == 3 && list.iter().all(|x| *x > 0.0),
            (Some(NumberOrArray::Rows(rows)), 3) => {
                rows.len() == 3
                    && rows.iter().all(|row| row.len() == 3)
                    && (0..3).all(|i| rows[i][i] > 0.0 && (0..i).all(|j| rows[i][j] == rows[j][i]))
            }
            _ => false,
        };
        if good {
            return Ok(());
        }
        let help = "in 2-D a positive number, kg m²/m; in 3-D three positive numbers or a symmetric 3×3 tensor, kg m²";
        Err(ctx.error_with_help(key, "this cannot be an inertia", help))
    }

    /// The body of this `shape`.
    fn build<const D: usize>(&self, shape: &Shape<D>) -> FreeBody<D> {
        let mut body = match (self.density, self.mass) {
            (Some(density), _) => FreeBody::from_density(shape, density),
            (None, mass) => FreeBody::from_mass(shape, mass.unwrap_or_default()),
        };
        match &self.inertia {
            Some(NumberOrArray::One(x)) => {
                body.inertia = Matrix::zeros();
                body.inertia[(0, 0)] = *x;
            }
            Some(NumberOrArray::List(list)) => body.inertia = Matrix::from_diagonal(&vector(list)),
            Some(NumberOrArray::Rows(rows)) => body.inertia = Matrix::from_fn(|i, j| rows[i][j]),
            None => {}
        }
        let given = |x: &Option<Vec<f64>>| x.as_ref().map_or_else(Vector::zeros, |x| vector(x));
        body.centre += given(&self.centre_offset);
        body.velocity = given(&self.velocity);
        body.spin = match &self.spin {
            Some(NumberOrArray::One(x)) => Bivector::from_axial(&[*x]),
            Some(NumberOrArray::List(list)) => Bivector::from_axial(list),
            _ => Bivector::zero(),
        };
        for mode in self.locked.iter().filter_map(|axis| axis.index(D)) {
            match mode.checked_sub(D) {
                None => body.locked_translations[mode] = true,
                Some(axis) => body.locked_rotations[axis] = true,
            }
        }
        body
    }
}

/// Refuses solids that are not complete or share a name.
pub(crate) fn verify(ctx: &Context, solids: &[SolidConfig]) -> Result<()> {
    let verify = |(i, solid): (usize, &SolidConfig)| solid.verify(ctx, &format!("solid.{i}"), &solids[..i], solids);
    solids.iter().enumerate().try_for_each(verify)
}

/// Refuses a group name that is not a name, or is the name of a solid.
fn verify_group(ctx: &Context, solids: &[SolidConfig], key: &str, group: &str) -> Result<()> {
    let help = "a group is one word of letters, digits, _ and -, as in  group = \"floats\"";
    ctx.require_file_name(key, group).map_err(|e| e.help(help))?;
    match solids.iter().any(|solid| solid.name == group) {
        true => {
            let help = "give the group a name of its own: in  between  it stands beside those of solids";
            Err(ctx.error_with_help(key, format!("a solid is called \"{group}\", too"), help))
        }
        false => Ok(()),
    }
}

/// Refuses motions that there are not in the scene's dimension.
pub(crate) fn verify_modes(ctx: &Context, key: &str, axes: &[MotionMode]) -> Result<()> {
    match axes.iter().find(|axis| axis.index(ctx.dimension).is_none()) {
        Some(_) => Err(ctx.error_with_help(
            key,
            format!("there is no such motion in {}-D", ctx.dimension),
            "in 2-D: x, y, turn; in 3-D: x, y, z, turn_x, turn_y, turn_z",
        )),
        None => Ok(()),
    }
}

pub(crate) fn require_solid(ctx: &Context, solids: &[SolidConfig], key: &str, name: &str) -> Result<()> {
    if solids.iter().any(|solid| solid.name == name) {
        return Ok(());
    }
    let members = solids.iter().filter(|solid| solid.group.as_deref() == Some(name));
    let members: Vec<&str> = members.map(|solid| solid.name.as_str()).collect();
    if !members.is_empty() {
        let what = format!("\"{name}\" is a group, and here a single solid is meant");
        let help =
            "ties, forces and probes are of single solids, and only  [[contact]] between  takes groups; of this one";
        return Err(ctx.error_with_help(key, what, format!("{help}: {}", members.join(", "))));
    }
    let names: Vec<&str> = solids.iter().map(|solid| solid.name.as_str()).collect();
    let known =
        if names.is_empty() { "the scene has no solids".into() } else { format!("known: {}", names.join(", ")) };
    Err(ctx
        .error_with_help(
            key,
            format!("no solid is called \"{name}\"{}", suggestion(name, names.iter().copied())),
            known,
        )
        .with_code(ErrorCode::UnknownName))
}

/// Refuses a free body under gravity that is small and weighs less than half a water particle: it would ride on single particles.
fn verify_weight<const D: usize>(ctx: &Context, key: &str, spec: &SolidSpec<D>) -> Result<()> {
    let (rho0, heavy) = (ctx.rho0.unwrap_or_default(), ctx.has_gravity());
    let Some(body) = spec.initial_body() else { return Ok(()) };
    let least = 0.5 * rho0 * ctx.dp.powi(D as i32);
    let small = spec.shape.bounds_at(&Pose::identity()).size().max() < SMALL * ctx.dp;
    if !heavy || !small || body.mass >= least {
        return Ok(());
    }
    let part = 0.5 * body.mass / least;
    let what =
        format!("\"{}\" is small and weighs {part:.2} of a water particle: no draft could come of that", spec.name);
    let dp = 0.99 * ctx.dp * (body.mass / least).powf(1.0 / D as f64);
    Err(ctx.error_with_help(
        &format!("{key}.free"),
        what,
        format!("half of one is the least: write  dp = {dp:.2e}  or less"),
    ))
}

/// Refuses a light free plate with a single row of boundary particles, which cannot have the pressures of both sides.
fn verify_thickness<const D: usize>(ctx: &Context, key: &str, spec: &SolidSpec<D>) -> Result<()> {
    let (rho0, heavy) = (ctx.rho0.unwrap_or_default(), ctx.has_gravity());
    let Some(body) = spec.initial_body() else { return Ok(()) };
    let thickness = spec.shape.bounds_at(&Pose::identity()).size().min();
    let density = body.mass / (rho0 * spec.shape.volume_properties().volume);
    if !heavy || thickness >= THIN * ctx.dp || density >= THIN_DENSITY {
        return Ok(());
    }
    let what = format!(
        "\"{}\" is {:.2} dp thick and has {density:.2} of the water's density: one row of boundary particles stands for \
         both its faces",
        spec.name,
        thickness / ctx.dp
    );
    let help = format!(
        "two rows bear it: write  dp = {:.2e}  or less, or make it as heavy as {THIN_DENSITY}",
        0.5 * thickness
    );
    Err(ctx.error_with_help(&format!("{key}.free"), what, help))
}
