//! Any text as a scene: read, resolved, sized; built where it is small.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use pontoon::scene::Scene;

/// Particles up to which a scene is built, and so also its tables read.
const SMALL: f64 = 2000.0;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(scene) = Scene::parse(text, Path::new("."), &[]) else { return };
    let resolved = scene.resolve();
    let Ok(size) = scene.size() else { return };
    assert!(resolved.is_ok() && scene.to_toml().is_ok());
    if scene.dimension == 2 && size.fluid + size.boundary < SMALL {
        let _ = scene.build::<2>();
    }
});
