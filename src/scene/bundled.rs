//! The scenes that are compiled into the program.

/// A bundled scene: the name of its folder, its `scene.toml`, and the names and texts of the other files.
pub type BundledScene = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

/// Expands to the text of a file in the folder of a scene.
macro_rules! text {
    ($scene:literal, $file:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/", $scene, "/", $file))
    };
}

macro_rules! scene {
    ($scene:literal $(, $file:literal)*) => {
        (
            $scene,
            text!($scene, "scene.toml"),
            &[("README.md", text!($scene, "README.md")) $(, ($file, text!($scene, $file)))*],
        )
    };
}

/// Returns all bundled scenes.
pub fn bundled_scenes() -> &'static [BundledScene] {
    &[
        scene!("raft"),
        scene!("hinged-raft"),
        scene!("regular-waves"),
        scene!("buoy-in-waves"),
        scene!("flume-box-by-name"),
        scene!("flap-converter"),
        scene!("harbour"),
        scene!("moored-box"),
        scene!("moored-barge"),
        scene!("cylinder"),
        scene!("focused-box"),
        scene!("solitary-runup"),
        scene!("still-tank"),
        scene!("still-wedge"),
        scene!("still-tank-3d"),
        scene!("still-wedge-3d"),
        scene!("buoyancy"),
        scene!("buoyancy-3d"),
        scene!("added-mass"),
        scene!("added-mass-3d"),
        scene!("standing-wave", "surface.csv"),
        scene!("poiseuille"),
        scene!("couette"),
        scene!("taylor-green"),
        scene!("dam-break", "tip.csv"),
        scene!("martin-moyce", "front.csv"),
        scene!("lobovsky", "pressure.csv"),
        scene!("sinking-cylinder", "centre.csv"),
        scene!("ciem-piston", "flume.csv"),
        scene!("ren-box", "harmonics.csv"),
        scene!("flume-box", "flap.csv", "body.csv", "elevation_1.csv", "elevation_2.csv"),
        scene!("column", "force.csv", "velocity.csv"),
        scene!("column-gate", "force.csv"),
        scene!("wigley", "wigley.obj", "seabed.stl"),
        scene!("sloshing"),
    ]
}
