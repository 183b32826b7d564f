//! Check that facets enclose a solid: every edge has two facets, which traverse the edge in opposite directions.

use crate::{
    error::{Error, Result},
    math::Vector,
};

/// An edge as (lower corner, higher corner, direction): the direction is true if the facet traverses the edge upwards.
type Edge = (u32, u32, bool);

/// Refuses an open surface, and inverted facets.
pub(crate) fn check_closed(points: &[Vector<3>], facets: &[[u32; 3]]) -> Result<()> {
    if facets.is_empty() {
        return Err(Error::scene("a mesh without a facet").help("give it at least four"));
    }
    let sides = facets.iter().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
    let mut edges: Vec<Edge> = sides.map(|(&a, &b)| (a.min(b), a.max(b), a < b)).collect();
    edges.sort_unstable();
    let groups = || edges.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1));
    let line = |edge: &Edge| {
        format!("{} – {} m", format_position(&points[edge.0 as usize]), format_position(&points[edge.1 as usize]))
    };
    let refuse = |bad: &dyn Fn(&[Edge]) -> bool, what: &dyn Fn(usize, String) -> String, help: &str| {
        let first = groups().find(|group| bad(group))?;
        let count = groups().filter(|group| bad(group)).count();
        Some(Error::scene(what(count, line(&first[0]))).help(help))
    };
    let counted = |n: usize| if n == 1 { "1 edge".into() } else { format!("{n} edges") };
    let faults = [
        refuse(
            &|group| group.len() == 1,
            &|n, at| format!("the mesh is open: {} with a facet on one side only, the first {at}", counted(n)),
            "fill the holes and join corners that nearly meet, in the program that made it; its water would leak in",
        ),
        refuse(
            &|group| group.len() > 2,
            &|n, at| format!("more than two facets of the mesh meet at {}, the first {at}", counted(n)),
            "leave out walls inside the solid; parts that touch are joined to one, or become two solids",
        ),
        refuse(
            &|group| group.len() == 2 && group[0].2 == group[1].2,
            &|n, at| format!("facets of the mesh are turned over: beside {}, the first {at}", counted(n)),
            "let all normals point outwards (\"recalculate normals\") in the program that made it",
        ),
    ];
    faults.into_iter().flatten().next().map_or(Ok(()), Err)
}

/// Formats a position for the user, to one part in ten thousand of a metre or finer.
pub(crate) fn format_position(x: &Vector<3>) -> String {
    let number = |x: f64| if x != 0.0 && x.abs() < 0.01 { format!("{x:.3e}") } else { format!("{x:.4}") };
    format!("({}, {}, {})", number(x[0]), number(x[1]), number(x[2]))
}
