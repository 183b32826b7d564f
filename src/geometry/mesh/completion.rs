//! Completes a surface that is not closed: the mirror image of a half, a cap on open edges, a plate around a sheet.

use super::{
    moments,
    surface::{Surface, counted, sorted_edges},
    welding::format_position,
};
use crate::{
    error::{Error, Result},
    geometry::triangulation::{MOST_CORNERS, triangulate},
    math::{Matrix, Vector},
};

/// Distance below which the open edge of a half lies in the plane of symmetry, or an open edge in a plane, over the size
/// of the mesh.
const IN_PLANE: f64 = 1e-4;

/// Least eigenvalue, over the sum of all, of the matrix Σ n nᵀ of the normals n at a corner: the corner of a plate moves only in
/// directions of larger eigenvalues.
const FLAT: f64 = 1e-3;

/// The names of the axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Adds the mirror image on the other side of the plane through the origin normal to `axis`. Open edges near this plane
/// are moved into it, and facets in the plane are removed.
pub(super) fn mirror(surface: &mut Surface, axis: usize, notes: &mut Vec<String>) -> Result<()> {
    let tolerance = IN_PLANE * surface.bounds().size().max();
    let name = AXES[axis];
    let mut open = vec![false; surface.points.len()];
    for [a, b] in open_edges(surface) {
        open[a as usize] = true;
        open[b as usize] = true;
    }
    let (mut moved, mut farthest) = (0, 0.0_f64);
    for (point, open) in surface.points.iter_mut().zip(&open) {
        let off = point[axis].abs();
        if off <= if *open { tolerance } else { 0.01 * tolerance } {
            if off > 0.0 {
                moved += 1;
                farthest = farthest.max(off);
            }
            point[axis] = 0.0;
        }
    }
    if moved > 0 {
        notes.push(format!(
            "{} moved into the plane {name} = 0, by {farthest:.1e} m at most",
            counted(moved, "corner is", "corners are")
        ));
    }
    let bounds = surface.bounds();
    if bounds.min[axis] < 0.0 && bounds.max[axis] > 0.0 {
        let what = format!(
            "mirror = \"{name}\" doubles a half, but the mesh reaches from {name} = {:.4} to {:.4} m",
            bounds.min[axis], bounds.max[axis]
        );
        return Err(Error::scene(what).help("leave mirror out, or let the half lie on one side of this plane"));
    }
    let in_plane: Vec<bool> = surface.points.iter().map(|p| p[axis] == 0.0).collect();
    if let Some(far) = (0..open.len())
        .filter(|&i| open[i])
        .min_by(|&i, &j| surface.points[i][axis].abs().total_cmp(&surface.points[j][axis].abs()))
        && !in_plane[far]
    {
        let what = format!(
            "mirror = \"{name}\" joins a half to its image, but its open edges end {:.3e} m from the plane {name} = 0",
            surface.points[far][axis].abs()
        );
        return Err(Error::scene(what).help("move the half to this plane in the program that made it"));
    }
    if !in_plane.contains(&true) {
        notes.push(format!("the mesh does not reach the plane {name} = 0; its mirror image is a separate part"));
    }
    let mut number = 0..;
    let flat = |facet: &[u32; 3]| facet.iter().all(|&p| in_plane[p as usize]);
    let flats: Vec<bool> = surface.facets.iter().map(flat).collect();
    surface.parts.retain(|_| number.next().is_none_or(|i: usize| !flats[i]));
    surface.facets.retain(|facet| !flat(facet));
    let mut images: Vec<u32> = (0..surface.points.len() as u32).collect();
    for (i, image) in images.iter_mut().enumerate().filter(|(i, _)| !in_plane[*i]) {
        let mut point = surface.points[i];
        point[axis] = -point[axis];
        *image = surface.points.len() as u32;
        surface.points.push(point);
    }
    let reflected: Vec<[u32; 3]> =
        surface.facets.iter().map(|&[a, b, c]| [b, a, c].map(|p| images[p as usize])).collect();
    surface.facets.extend(reflected);
    surface.parts.extend_from_within(..);
    Ok(())
}

/// Closes the open edges that lie in planes normal to `axis`.
pub(super) fn cap(surface: &mut Surface, axis: usize, notes: &mut Vec<String>) -> Result<()> {
    let size = surface.bounds().size().max();
    let name = AXES[axis];
    let loops = open_loops(surface)?;
    if loops.is_empty() {
        notes.push(format!("the mesh has no open edge; cap = \"{name}\" changes nothing"));
    }
    let heights = |ring: &[u32]| {
        let heights = ring.iter().map(|&p| surface.points[p as usize][axis]);
        heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let mut planes: Vec<(f64, Vec<Vec<u32>>)> = Vec::new();
    for ring in loops {
        let (low, high) = heights(&ring);
        if high - low > IN_PLANE * size {
            let at = format_position(&surface.points[ring[0] as usize]);
            let what = format!(
                "cap = \"{name}\" closes open edges in a plane, but the edge at {at} m reaches from {name} = {low:.4} to \
                 {high:.4} m"
            );
            return Err(
                Error::scene(what).help("cut the mesh in a plane, or close this edge in the program that made it")
            );
        }
        let middle = 0.5 * (low + high);
        match planes.iter_mut().find(|(height, _)| (height - middle).abs() <= IN_PLANE * size) {
            Some((_, rings)) => rings.push(ring),
            None => planes.push((middle, vec![ring])),
        }
    }
    let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
    let flat: Vec<[f64; 2]> = surface.points.iter().map(|p| [p[first], p[second]]).collect();
    for (height, rings) in planes {
        let facets = fill(&flat, rings).ok_or_else(|| {
            Error::scene(format!("the open edges of the mesh in the plane {name} = {height:.4} m cross each other, or have more than {MOST_CORNERS} corners"))
                .help("close them in the program that made the mesh")
        })?;
        surface.parts.extend(facets.iter().map(|_| 0));
        surface.facets.extend(facets);
    }
    Ok(())
}

/// Returns triangles of the area that the rings enclose. Rings inside an even number of others are outlines; the rest
/// are holes.
fn fill(flat: &[[f64; 2]], rings: Vec<Vec<u32>>) -> Option<Vec<[u32; 3]>> {
    let area = |ring: &[u32]| -> f64 {
        (0..ring.len())
            .map(|i| (flat[ring[i] as usize], flat[ring[(i + 1) % ring.len()] as usize]))
            .map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0]))
            .sum()
    };
    let inside = |p: [f64; 2], ring: &[u32]| {
        let crossed = (0..ring.len()).filter(|&i| {
            let (a, b) = (flat[ring[i] as usize], flat[ring[(i + 1) % ring.len()] as usize]);
            (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        crossed.count() % 2 == 1
    };
    let around: Vec<Vec<usize>> = (0..rings.len())
        .map(|i| (0..rings.len()).filter(|&j| j != i && inside(flat[rings[i][0] as usize], &rings[j])).collect())
        .collect();
    let turned = |ring: &[u32], positive: bool| {
        let mut ring = ring.to_vec();
        if (area(&ring) > 0.0) != positive {
            ring.reverse();
        }
        ring
    };
    let mut facets = Vec::new();
    for i in (0..rings.len()).filter(|&i| around[i].len().is_multiple_of(2)) {
        let own = |j: usize| around[j].len() == around[i].len() + 1 && around[j].contains(&i);
        let holes: Vec<Vec<u32>> = (0..rings.len()).filter(|&j| own(j)).map(|j| turned(&rings[j], false)).collect();
        let triangles = triangulate(flat, &turned(&rings[i], true), &holes)?;
        // The cap continues the orientation of the surface along the outline.
        let upward = area(&rings[i]) > 0.0;
        facets.extend(triangles.into_iter().map(|[a, b, c]| if upward { [a, b, c] } else { [b, a, c] }));
    }
    Some(facets)
}

/// Replaces the surface by a plate of this thickness (m), half of it on each side.
pub(super) fn thicken(surface: &mut Surface, thickness: f64, notes: &mut Vec<String>) -> Result<()> {
    let size = surface.bounds().size().max();
    if thickness > size {
        let what = format!("thickness = {thickness} makes a plate thicker than the mesh is large, {size:.4} m");
        return Err(Error::scene(what).help("thickness is in m, whatever the unit of the file: 20 mm are  0.02"));
    }
    let edges = sorted_edges(&surface.facets);
    let groups = || edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high));
    if let Some(group) = groups().find(|group| group.len() > 2 || group.len() == 2 && group[0].up == group[1].up) {
        let at = format_position(&surface.points[group[0].low as usize]);
        let what = format!("the plate around the mesh has no sides at {at} m: more than two facets meet there");
        return Err(Error::scene(what).help("give each sheet its own mesh, as parts of a compound"));
    }
    let rim = open_edges(surface);
    if rim.is_empty() {
        let volume = moments(&surface.points, &surface.facets).volume.abs();
        notes.push(format!(
            "the mesh is closed: thickness = {thickness} makes it a hollow shell; without thickness it is a solid of \
             {volume:.3e} m³"
        ));
    }
    let n = surface.points.len() as u32;
    let mut squares = vec![Matrix::<3>::zeros(); surface.points.len()];
    let mut sums = vec![Vector::<3>::zeros(); surface.points.len()];
    for facet in &surface.facets {
        let corners = facet.map(|p| surface.points[p as usize]);
        let Some(normal) = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).try_normalize(0.0) else {
            continue;
        };
        for i in 0..3 {
            let (along, back) = (corners[(i + 1) % 3] - corners[i], corners[(i + 2) % 3] - corners[i]);
            let angle = along.angle(&back);
            squares[facet[i] as usize] += normal * normal.transpose() * angle;
            sums[facet[i] as usize] += normal * angle;
        }
    }
    // Each side lies half the thickness from every facet at the corner, in the sense of least squares.
    let offsets: Vec<Vector<3>> = squares
        .iter()
        .zip(&sums)
        .map(|(square, sum)| {
            let eigen = square.symmetric_eigen();
            let least = FLAT * eigen.eigenvalues.sum();
            let along = |i: usize| {
                let axis = eigen.eigenvectors.column(i).into_owned();
                axis * (axis.dot(sum) / eigen.eigenvalues[i])
            };
            (0..3).filter(|&i| eigen.eigenvalues[i] > least).map(along).sum::<Vector<3>>() * (0.5 * thickness)
        })
        .collect();
    let below: Vec<Vector<3>> = surface.points.iter().zip(&offsets).map(|(p, d)| p - d).collect();
    surface.points.iter_mut().zip(&offsets).for_each(|(p, d)| *p += d);
    surface.points.extend(below);
    let under: Vec<[u32; 3]> = surface.facets.iter().map(|&[a, b, c]| [b + n, a + n, c + n]).collect();
    surface.facets.extend(under);
    surface.facets.extend(rim.into_iter().flat_map(|[a, b]| [[b, a, a + n], [b, a + n, b + n]]));
    surface.parts = vec![0; surface.facets.len()];
    Ok(())
}

/// Returns the edges with one facet, in the direction of the facet.
pub(super) fn open_edges(surface: &Surface) -> Vec<[u32; 2]> {
    let edges = sorted_edges(&surface.facets);
    let groups = edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)).filter(|group| group.len() == 1);
    groups
        .map(|group| if group[0].up { [group[0].low, group[0].high] } else { [group[0].high, group[0].low] })
        .collect()
}

/// Returns the closed loops of the open edges, each against the direction of its facets.
fn open_loops(surface: &Surface) -> Result<Vec<Vec<u32>>> {
    let mut next: Vec<Option<u32>> = vec![None; surface.points.len()];
    let edges = open_edges(surface);
    let faulty = |p: u32| {
        let at = format_position(&surface.points[p as usize]);
        Error::scene(format!("open edges of the mesh meet at {at} m, so they are not simple loops"))
            .help("close this place in the program that made the mesh")
    };
    for [a, b] in &edges {
        if next[*b as usize].replace(*a).is_some() {
            return Err(faulty(*b));
        }
    }
    let mut loops = Vec::new();
    for [_, start] in edges {
        let (mut ring, mut at) = (Vec::new(), start);
        while let Some(after) = next[at as usize].take() {
            ring.push(at);
            at = after;
        }
        if ring.is_empty() {
            continue;
        }
        if at != start || ring.len() < 3 {
            return Err(faulty(at));
        }
        loops.push(ring);
    }
    Ok(loops)
}
