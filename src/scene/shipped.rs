//! The scenes that come with the program, for a binary that stands alone.

/// A scene of the program's own.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// Name of its folder.
    pub name: &'static str,
    /// Its `scene.toml`.
    pub text: &'static str,
    /// The other files of its folder: name and text.
    pub files: &'static [(&'static str, &'static str)],
}

/// Text of a file of the folder of a scene.
macro_rules! text {
    ($scene:literal, $file:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/", $scene, "/", $file))
    };
}

macro_rules! scene {
    ($scene:literal $(, $file:literal)*) => {
        Shipped {
            name: $scene,
            text: text!($scene, "scene.toml"),
            files: &[("README.md", text!($scene, "README.md")) $(, ($file, text!($scene, $file)))*],
        }
    };
}

/// All of them.
pub fn shipped() -> &'static [Shipped] {
    &[
        scene!("raft"),
        scene!("still-tank"),
        scene!("buoyancy"),
        scene!("buoyancy-3d"),
        scene!("dam-break", "tip.csv"),
        scene!("flume-box", "flap.csv", "body.csv", "elevation_1.csv", "elevation_2.csv"),
        scene!("column", "force.csv", "velocity.csv"),
    ]
}
