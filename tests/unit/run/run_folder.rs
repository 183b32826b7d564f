//! Unit tests of `src/run/run_folder.rs`.

use super::*;

#[test]
fn the_run_folder_contains_the_scene_and_only_the_tables_that_it_names() -> std::io::Result<()> {
    let home = std::env::temp_dir().join(format!("pontoon-folder-{}", std::process::id()));
    let scene = home.join("bay");
    fs::create_dir_all(scene.join("data"))?;
    let text = "a = { file = \"./data/flap.csv\" }\nb = [\"../secret.csv\", \"no.csv\"]\n";
    fs::write(scene.join("scene.toml"), text)?;
    fs::write(scene.join("data/flap.csv"), "t_s,x_m\n")?;
    fs::write(scene.join("other.csv"), "")?;
    fs::write(home.join("secret.csv"), "")?;
    let file = scene_file(&scene);
    assert_eq!(scene_name(&file), "bay");
    let out = home.join("out");
    let folder = create_run_folder(&file, Some(&out)).map_err(std::io::Error::other)?;
    copy_scene(&file, None, text, &folder).map_err(std::io::Error::other)?;
    assert!(out.join("scene/data/flap.csv").is_file() && out.join(SCENE).is_file());
    assert!(!out.join("scene/other.csv").exists() && !out.join("secret.csv").exists());
    let again = create_run_folder(&file, Some(&out)).err().map(|e| e.kind);
    assert_eq!(again, Some(ErrorKind::Usage), "a folder that is not empty is refused");
    fs::remove_dir_all(home)
}
