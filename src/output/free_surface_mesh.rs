//! The free surface of 3-D water as a mesh, which the crate splashsurf makes from frames. `surface.pvd` lists the
//! files, such as `surface/surface_00000.vtu`. Normals of the triangles point outwards; each corner has the velocity of
//! the water.

use std::{io, path::Path};

use splashsurf_lib::{Parameters, nalgebra::Vector3, reconstruct_surface, sph_interpolation::SphInterpolator};

use super::{
    cannot_write,
    frame_index::FrameIndex,
    frame_sequence::{FramePoints, FrameSequence},
    vtu::{self, Cells, DataArray},
    write_atomically,
};
use crate::error::{Error, ErrorKind, Result};

/// Support radius of a particle, dp.
const REACH: f64 = 3.0;
/// Edge of the cubes in the marching-cubes algorithm, dp.
const CUBE: f64 = 0.75;
/// Density at the surface relative to that of water. With this value, the still surface is 0.005 dp above the true
/// surface, which is half a dp above the uppermost particles.
const ISO_LEVEL: f32 = 0.64;
/// VTK's number of the triangle as a cell type.
const TRIANGLE: u8 = 5;

/// A closed surface of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FreeSurfaceMesh {
    /// Corners, m.
    pub corners: Vec<[f32; 3]>,
    /// Triangles, as indices of their corners, counter-clockwise as seen from outside.
    pub triangles: Vec<[usize; 3]>,
    /// Velocity of the water at the corners, m/s; empty if the frame does not contain velocities.
    pub velocity: Vec<[f32; 3]>,
}

impl FreeSurfaceMesh {
    /// Returns the free surface of `water` in 3-D, with the particle spacing `dp` (m). Bodies are not part of the
    /// water, so they are outside the surface.
    ///
    /// # Errors
    /// `Usage` if the surface cannot be made.
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

    /// Returns the surface as a .vtu file.
    fn to_vtu(&self) -> io::Result<Vec<u8>> {
        let connectivity = self.triangles.iter().flatten().map(|i| *i as i64).collect();
        let cells = Cells { connectivity, points_per_cell: 3, cell_type: TRIANGLE };
        let velocity = (!self.velocity.is_empty())
            .then(|| DataArray::new("velocity", 3, self.velocity.iter().flatten().copied().collect()));
        vtu::write(self.corners.iter().flatten().copied().collect(), cells, velocity.into_iter().collect())
    }
}

/// Writes the surface of the water in each of the `frames` into the run's `folder`; `dp` (m) is the particle spacing.
/// Returns the number of files.
///
/// # Errors
/// `File` if a frame cannot be read or a file cannot be written; `Usage` if a surface cannot be made.
pub fn write(folder: &Path, frames: &FrameSequence, dp: f64) -> Result<usize> {
    let files = folder.join("surface");
    std::fs::create_dir_all(&files).map_err(|why| cannot_write(&files, &why))?;
    for number in 0..frames.times().len() {
        let path = files.join(format!("surface_{number:05}.vtu"));
        let surface = FreeSurfaceMesh::reconstruct(&frames.water(number)?, dp)?;
        let file = surface.to_vtu().map_err(|why| cannot_write(&path, &why))?;
        write_atomically(&path, &file)?;
    }
    FrameIndex::new(folder.join("surface.pvd"), "surface", &["surface"]).write(frames.times())?;
    Ok(frames.times().len())
}

#[cfg(test)]
#[path = "../../tests/unit/output/free_surface_mesh.rs"]
mod tests;
