//! Bodies in water: equilibrium, motion, loads, contact, and solids that a host program owns.

mod accelerated_frames;
mod acoustic_added_mass;
mod ballast;
mod buoyancy;
mod concave_solids;
mod contact_groups;
mod contact_skin;
mod contact_table;
mod coupling;
mod energy_budget;
mod deep_water;
mod equilibrium;
mod external_bodies;
mod film;
mod friction;
mod linear_theory;
mod load_breakdown;
mod many_bodies;
mod meshes;
mod natural_periods;
mod rest_poses;
mod shapes;
mod thin_parts;
mod trim;
mod walls;
mod wind;
