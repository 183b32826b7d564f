//! Holds the words of solids against one another.

use super::{
    FreeBodyConfig, MotionMode, NumberOrArray, PlacementConfig, Scene, ShapeConfig, SolidConfig,
    flexible::PolylineConfig,
    verify::{last_part, quoted_list},
};
use crate::error::Result;

impl Scene {
    pub(super) fn verify_solids(&self) -> Result<()> {
        for (i, solid) in self.solid.iter().enumerate() {
            let key = format!("solid.{i}");
            self.require_file_name(&format!("{key}.name"), &solid.name)?;
            if self.solid[..i].iter().any(|other| other.name == solid.name) {
                let what = format!("two solids are called \"{}\"", solid.name);
                return Err(self.error_with_help(&format!("{key}.name"), what, "give each its own name"));
            }
            if let Some(group) = &solid.group {
                self.verify_group(&format!("{key}.group"), group)?;
            }
            verify_shape(self, &format!("{key}.shape"), &solid.shape)?;
            if let Some(words) = &solid.at {
                verify_placement(self, &format!("{key}.at"), words, true)?;
            }
            self.verify_role(&key, solid)?;
            self.require_range(&format!("{key}.friction"), solid.friction, 10.0)?;
            self.require_range(&format!("{key}.restitution"), solid.restitution, 1.0)?;
        }
        Ok(())
    }

    /// Refuses a group whose name is none, or a solid's.
    fn verify_group(&self, key: &str, group: &str) -> Result<()> {
        let help = "a group is one word of letters, digits, _ and -, as in  group = \"floats\"";
        self.require_file_name(key, group).map_err(|e| e.help(help))?;
        match self.solid.iter().any(|solid| solid.name == group) {
            true => {
                let help = "give the group a name of its own: in  between  it stands beside those of solids";
                Err(self.error_with_help(key, format!("a solid is called \"{group}\", too"), help))
            }
            false => Ok(()),
        }
    }

    fn verify_role(&self, key: &str, solid: &SolidConfig) -> Result<()> {
        let roles =
            [("fixed", solid.fixed.is_some()), ("driven", solid.driven.is_some()), ("free", solid.free.is_some())];
        let roles: Vec<&str> = roles.into_iter().filter(|(_, given)| *given).map(|(word, _)| word).collect();
        if roles.len() != 1 {
            let what = match roles.len() {
                0 => format!("nothing says what moves solid \"{}\"", solid.name),
                _ => format!("solid \"{}\" is {}; it can be one of them", solid.name, quoted_list(&roles)),
            };
            let help = "write one of\n  fixed  = true\n  driven = { along = [1.0, 0.0], distance = { formula = \
                        \"0.05*sin(2*pi*t)\" } }\n  free   = { density = 500.0 }";
            let place = roles.last().map_or(key.to_string(), |role| format!("{key}.{role}"));
            return Err(self.error_with_help(&place, what, help));
        }
        if solid.fixed == Some(false) {
            let help = "a solid that is not fixed is driven = { ... } or free = { ... }";
            return Err(self.error_with_help(
                &format!("{key}.fixed"),
                "fixed = false does not say what moves it",
                help,
            ));
        }
        if let Some(words) = &solid.driven {
            self.verify_driven(&format!("{key}.driven"), words)?;
        }
        if let Some(words) = &solid.free {
            self.verify_free(&format!("{key}.free"), words)?;
        }
        Ok(())
    }

    fn verify_free(&self, key: &str, words: &FreeBodyConfig) -> Result<()> {
        self.require_positive(&format!("{key}.density"), words.density)?;
        let mass = self.require_positive(&format!("{key}.mass"), words.mass);
        mass.map_err(|e| e.help("write  free = { mass = 10.0 }        # kg; in 2-D kg/m"))?;
        if words.density.is_some() == words.mass.is_some() {
            return Err(self.error_with_help(
                key,
                "a free body has either a density or a mass",
                "write  free = { density = 500.0 }        # kg/m³",
            ));
        }
        for (word, vector) in [("centre_offset", &words.centre_offset), ("velocity", &words.velocity)] {
            if let Some(vector) = vector {
                self.require_dimension(&format!("{key}.{word}"), vector)?;
            }
        }
        self.require_positive(&format!("{key}.release"), words.release)?;
        if words.release.is_some() && (words.velocity.is_some() || words.spin.is_some()) {
            let what = "what is held at first starts at rest, with neither velocity nor spin";
            return Err(self.error_at(&format!("{key}.release"), what));
        }
        let three = self.dimension == 3;
        let spin_fits = match &words.spin {
            None => true,
            Some(NumberOrArray::One(_)) => !three,
            Some(NumberOrArray::List(list)) => three && list.len() == 3,
            Some(NumberOrArray::Rows(_)) => false,
        };
        if !spin_fits {
            return Err(self.error_with_help(
                &format!("{key}.spin"),
                "spin does not fit the dimension",
                "in 2-D a number, spin = 0.5; in 3-D a vector, spin = [0.0, 0.0, 0.5]        # rad/s",
            ));
        }
        self.verify_inertia(&format!("{key}.inertia"), words)?;
        self.verify_modes(&format!("{key}.locked"), &words.locked)
    }

    /// Refuses motions that there are not in the scene's dimension.
    pub(super) fn verify_modes(&self, key: &str, modes: &[MotionMode]) -> Result<()> {
        match modes.iter().find(|mode| mode.index(self.dimension).is_none()) {
            Some(_) => Err(self.error_with_help(
                key,
                format!("there is no such motion in {}-D", self.dimension),
                "in 2-D: x, y, turn; in 3-D: x, y, z, turn_x, turn_y, turn_z",
            )),
            None => Ok(()),
        }
    }

    fn verify_inertia(&self, key: &str, words: &FreeBodyConfig) -> Result<()> {
        let good = match (&words.inertia, self.dimension) {
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
        Err(self.error_with_help(key, "this cannot be an inertia", help))
    }
}

/// Refuses a shape that has no meaning in the scene's dimension, or whose lengths are not lengths.
pub(super) fn verify_shape(scene: &Scene, key: &str, words: &ShapeConfig) -> Result<()> {
    let sizes = |key: &str, size: &[f64]| {
        scene.require_dimension(&format!("{key}.size"), size)?;
        size.iter().try_for_each(|x| scene.require_positive(&format!("{key}.size"), Some(*x)))
    };
    let only = |dimension: usize, word: &str, instead: &str| match scene.dimension == dimension {
        true => Ok(()),
        false => {
            let what = format!("a {word} needs a {dimension}-D scene, and this one is {}-D", scene.dimension);
            Err(scene.error_with_help(key, what, instead))
        }
    };
    let axis = |key: &str, axis: Option<super::AxisName>| match axis {
        Some(super::AxisName::Z) if scene.dimension == 2 => {
            Err(scene.error_with_help(&format!("{key}.axis"), "a 2-D scene has no z axis", "write  axis = \"x\""))
        }
        _ => Ok(()),
    };
    match words {
        ShapeConfig::Box { size } => sizes(&format!("{key}.box"), size),
        ShapeConfig::Ball { radius } => scene.require_positive(&format!("{key}.ball.radius"), Some(*radius)),
        ShapeConfig::Capsule { length, radius, axis: a } => {
            let key = format!("{key}.capsule");
            scene.require_positive(&format!("{key}.length"), Some(*length))?;
            scene.require_positive(&format!("{key}.radius"), Some(*radius))?;
            axis(&key, *a)
        }
        ShapeConfig::Cylinder { length, radius, .. } => {
            only(3, "cylinder", "in 2-D a ball is a disc:  shape = { ball = { radius = 0.1 } }")?;
            scene.require_positive(&format!("{key}.cylinder.length"), Some(*length))?;
            scene.require_positive(&format!("{key}.cylinder.radius"), Some(*radius))
        }
        ShapeConfig::Polygon(words) => {
            only(2, "polygon", "in 3-D, boxes, balls, cylinders and capsules can be put together as a compound")?;
            verify_polyline(scene, &format!("{key}.polygon"), words)?;
            verify_drawing(scene, &format!("{key}.polygon"), words)?;
            match words.thickness {
                Some(_) => Err(scene.error_at(&format!("{key}.polygon"), "a polygon is solid: it has no thickness")),
                None => Ok(()),
            }
        }
        ShapeConfig::Polyline(words) => {
            only(2, "polyline", "in 3-D, walls are boxes or a tank")?;
            verify_polyline(scene, &format!("{key}.polyline"), words)?;
            match words.is_drawing() {
                true => {
                    Err(scene.error_at(&format!("{key}.polyline.file"), "a drawing is a closed outline: a polygon"))
                }
                false => verify_drawing(scene, &format!("{key}.polyline"), words),
            }
        }
        ShapeConfig::Tank { size, thickness } => {
            scene.require_positive(&format!("{key}.tank.thickness"), *thickness)?;
            sizes(&format!("{key}.tank"), size)
        }
        ShapeConfig::Mesh(words) => {
            only(3, "mesh", "in 2-D an outline is a polygon:  shape = { polygon = { file = \"hull.svg\" } }")?;
            scene.require_positive(&format!("{key}.mesh.scale"), words.scale)
        }
        ShapeConfig::Compound(parts) => {
            let key = format!("{key}.compound");
            if parts.is_empty() {
                return Err(scene.error_at(&key, "a compound has one part or more"));
            }
            parts.iter().enumerate().try_for_each(|(i, part)| {
                verify_shape(scene, &format!("{key}.{i}.shape"), &part.shape)?;
                part.at.as_ref().map_or(Ok(()), |words| verify_placement(scene, &format!("{key}.{i}.at"), words, false))
            })
        }
    }
}

fn verify_polyline(scene: &Scene, key: &str, words: &PolylineConfig) -> Result<()> {
    scene.require_positive(&format!("{key}.thickness"), words.thickness)?;
    match (&words.points, &words.file) {
        (Some(points), None) => points.iter().try_for_each(|p| scene.require_dimension(key, p)),
        (None, Some(_)) => Ok(()),
        _ => Err(scene.error_at(key, format!("a {} has either points or a file of points", last_part(key)))),
    }
}

/// Refuses words of a drawing where there is none.
fn verify_drawing(scene: &Scene, key: &str, words: &PolylineConfig) -> Result<()> {
    scene.require_positive(&format!("{key}.scale"), words.scale)?;
    let words_of_one = [("id", words.id.is_some()), ("scale", words.scale.is_some()), ("unit", words.unit.is_some())];
    match words_of_one.iter().find(|(_, given)| *given && !words.is_drawing()) {
        Some((word, _)) => Err(scene.error_at(&format!("{key}.{word}"), format!("{word} belongs to a drawing (.svg)"))),
        None => Ok(()),
    }
}

/// Refuses a place that has no meaning in the scene's dimension, or says the height twice.
pub(super) fn verify_placement(scene: &Scene, key: &str, words: &PlacementConfig, afloat: bool) -> Result<()> {
    let three = scene.dimension == 3;
    let refuse = |word: &str, what: &str, help: &str| Err(scene.error_with_help(&format!("{key}.{word}"), what, help));
    if words.z.is_some() && !three {
        return refuse("z", "a 2-D scene has no z", "in 2-D x is horizontal and y is up");
    }
    if words.angle_deg.is_some() && three {
        return refuse("angle_deg", "a turn in 3-D has an axis", "write  turn_deg = [0.0, 30.0, 0.0]");
    }
    match &words.turn_deg {
        Some(_) if !three => return refuse("turn_deg", "a turn in 2-D is one angle", "write  angle_deg = 30.0"),
        Some(turn) => scene.require_dimension(&format!("{key}.turn_deg"), turn)?,
        None => {}
    }
    let up = if three { ("z", words.z.is_some()) } else { ("y", words.y.is_some()) };
    let heights = [up, ("bottom", words.bottom.is_some()), ("draft", words.draft.is_some())];
    let heights: Vec<&str> = heights.into_iter().filter(|(_, given)| *given).map(|(word, _)| word).collect();
    if heights.len() > 1 {
        let help = "give one: the height of the frame, of the lowest point, or the draft";
        return refuse(heights[1], &format!("{} say the height twice", quoted_list(&heights)), help);
    }
    if !afloat && words.draft.is_some() {
        return refuse("draft", "only a solid has a draft", "give the height");
    }
    Ok(())
}
