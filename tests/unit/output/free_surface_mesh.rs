//! Unit tests of `src/output/free_surface_mesh.rs`.

use super::*;

/// Water on a lattice of 20 × 20 × 10 dp that rotates about z.
fn block(dp: f32) -> FramePoints {
    let mut water = FramePoints::default();
    for n in 0..4000 {
        let r = [n % 20, n / 20 % 20, n / 400].map(|i| (i as f32 + 0.5) * dp);
        water.position.push(r);
        water.velocity.push([-r[1], r[0], 0.0]);
    }
    water
}

#[test]
fn the_surface_of_a_block_encloses_its_volume_and_is_level() -> Result<()> {
    let dp = 0.02_f32;
    let surface = FreeSurfaceMesh::reconstruct(&block(dp), f64::from(dp))?;
    let corner = |i: usize| Vector3::from(surface.corners[i]).cast::<f64>();
    let cone = |t: &[usize; 3]| corner(t[0]).dot(&corner(t[1]).cross(&corner(t[2]))) / 6.0;
    let volume: f64 = surface.triangles.iter().map(cone).sum();
    let exact = 4000.0 * f64::from(dp).powi(3);
    // Edges are rounded over a dp, which is 1 % of a block of this size. A mesh inside out would have a negative volume.
    assert!((volume / exact - 1.0).abs() < 0.02, "{volume} m³ for {exact}");
    let top = surface.corners.iter().filter(|x| x[2] > 0.1 && (x[0] - 0.2).abs() < 0.1 && (x[1] - 0.2).abs() < 0.1);
    // The bound is a twentieth of dp, so that the mesh adds no error to a wave of ten dp.
    assert!(top.clone().count() > 50);
    for x in top {
        assert!((x[2] - 0.2).abs() < 0.05 * dp, "the surface is at {} m", x[2]);
    }
    Ok(())
}

#[test]
fn every_edge_has_two_triangles_and_every_corner_a_velocity() -> Result<()> {
    let dp = 0.02_f32;
    let surface = FreeSurfaceMesh::reconstruct(&block(dp), f64::from(dp))?;
    let mut edges = std::collections::HashMap::new();
    for t in &surface.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|sum| *sum == 0), "each edge has two triangles of opposite direction");
    for (x, v) in surface.corners.iter().zip(&surface.velocity) {
        // The velocity is the mean of the water within 3 dp, all of it on one side.
        let off = (v[0] + x[1]).hypot(v[1] - x[0]);
        assert!(off < 1.5 * dp && v[2].abs() < 1e-6, "{v:?} m/s at {x:?}");
    }
    assert_eq!(surface.velocity.len(), surface.corners.len());
    Ok(())
}

#[test]
fn the_free_surface_mesh_of_no_water_is_empty() -> Result<()> {
    assert_eq!(FreeSurfaceMesh::reconstruct(&FramePoints::default(), 0.1)?, FreeSurfaceMesh::default());
    Ok(())
}
