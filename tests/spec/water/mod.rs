//! The water: equations, pair loop, neighbours, time integration, and water at rest.

mod beside_reference;
mod faces_in_3d;
mod gradient_correction;
mod gravity;
mod kernels;
mod laws;
mod neighbours;
mod open_boundaries;
mod open_flows;
mod periodic;
mod refused_faces;
mod seas_through_faces;
mod simd;
mod still_water;
mod symmetry;
mod symmetry_planes;
mod time_integration;
