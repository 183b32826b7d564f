//! The free surface of water in space as a mesh, made from frames by the crate splashsurf: `surface.pvd` is the film,
//! `surface/surface_00000.vtu` are its pictures, triangles that look outwards with the water's velocity at their corners.

use std::path::Path;

use splashsurf_lib::{Parameters, nalgebra::Vector3, reconstruct_surface, sph_interpolation::SphInterpolator};
use vtkio::model::{CellType, Cells, ElementType, VertexNumbers};

use super::{
    cannot_write,
    frame::{data_array, mesh_vtu, pvd_index},
    frame_sequence::{FramePoints, FrameSequence},
    write_atomically,
};
use crate::error::{Error, ErrorKind, Result};

/// How far a particle is seen, dp.
const REACH: f64 = 3.0;
/// Edge of the cubes that are marched through, dp.
const CUBE: f64 = 0.75;
/// Share of the water at which its surface lies: with this the still surface is 0.005 dp above the true one, half a dp above the
/// uppermost particles.
const ISO_LEVEL: f32 = 0.64;

/// A closed surface of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FreeSurfaceMesh {
    /// Corners, m.
    pub corners: Vec<[f32; 3]>,
    /// Triangles: numbers of their corners, counter-clockwise as seen from outside.
    pub triangles: Vec<[usize; 3]>,
    /// Velocity of the water at the corners, m/s; empty if the frame did not keep it.
    pub velocity: Vec<[f32; 3]>,
}

impl FreeSurfaceMesh {
    /// The surface of `water` in space, of particles `dp` (m) apart. Bodies are not water, so they are outside it.
    ///
    /// # Errors
    /// `Usage` if it cannot be made.
    pub fn reconstruct(water: &FramePoints, dp: f64) -> Result<Self> {
        if water.position.is_empty() {
            return Ok(Self::default());
        }
        let points: Vec<Vector3<f32>> = water.position.iter().map(|x| Vector3::from(*x)).collect();
        let mut how = Parameters::new((0.5 * dp) as f32, (REACH * dp) as f32, (CUBE * dp) as f32);
        how.iso_surface_threshold = ISO_LEVEL;
        let made = reconstruct_surface::<i64, f32>(&points, &how)
            .map_err(|why| Error::new(ErrorKind::Usage, format!("no surface can be made: {why}")))?;
        let corners = made.mesh.vertices;
        let velocity = match &made.particle_densities {
            Some(densities) if !water.velocity.is_empty() => {
                let mass = how.rest_density * (dp as f32).powi(3);
                let near = SphInterpolator::new(&points, densities, mass, how.compact_support_radius);
                let given: Vec<Vector3<f32>> = water.velocity.iter().map(|v| Vector3::from(*v)).collect();
                near.interpolate_vector_quantity(&given, &corners, true)
            }
            _ => Vec::new(),
        };
        Ok(Self {
            corners: corners.into_iter().map(Into::into).collect(),
            triangles: made.mesh.triangles,
            velocity: velocity.into_iter().map(Into::into).collect(),
        })
    }

    /// The text of a .vtu file.
    fn to_vtu(&self) -> std::result::Result<Vec<u8>, vtkio::Error> {
        let cells = Cells {
            cell_verts: VertexNumbers::XML {
                connectivity: self.triangles.iter().flatten().map(|i| *i as u64).collect(),
                offsets: (1..=self.triangles.len() as u64).map(|i| 3 * i).collect(),
            },
            types: vec![CellType::Triangle; self.triangles.len()],
        };
        let velocity = (!self.velocity.is_empty())
            .then(|| data_array("velocity", ElementType::Vectors, self.velocity.iter().flatten().copied().collect()));
        mesh_vtu(self.corners.iter().flatten().copied().collect(), cells, velocity.into_iter().collect())
    }
}

/// Writes the surface of each picture of the `shown` film, of particles `dp` (m) apart, into the run's `folder`; how many.
///
/// # Errors
/// `File` if a frame cannot be read or a picture written; `Usage` if a surface cannot be made.
pub fn write(folder: &Path, shown: &FrameSequence, dp: f64) -> Result<usize> {
    let pictures = folder.join("surface");
    std::fs::create_dir_all(&pictures).map_err(|why| cannot_write(&pictures, &why))?;
    for number in 0..shown.times().len() {
        let path = pictures.join(format!("surface_{number:05}.vtu"));
        let surface = FreeSurfaceMesh::reconstruct(&shown.water(number)?, dp)?;
        let text = surface.to_vtu().map_err(|why| Error::new(ErrorKind::File, format!("{}: {why}", path.display())))?;
        write_atomically(&path, &text)?;
    }
    write_atomically(&folder.join("surface.pvd"), pvd_index(shown.times(), "surface", &["surface"]).as_bytes())?;
    Ok(shown.times().len())
}

#[cfg(test)]
#[path = "../../tests/unit/output/free_surface_mesh.rs"]
mod tests;
