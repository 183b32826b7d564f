//! Wavemakers, absorption and damping zones.

mod absorption;
mod generated_waves;
mod sponge_layers;
mod wavemaker;
