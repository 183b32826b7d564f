//! Scene files: schema, reference pages, errors, bad input, bundled scenes and preflight findings.

mod bad_input;
mod bundled_scenes;
mod errors;
mod preflight;
mod preflight_faults;
mod records;
mod reference;
mod schema;
mod silent_errors;
mod surroundings;
