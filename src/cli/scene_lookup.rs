//! Finding a scene: a path, a folder of ./scenes, or one built into the program.

use std::{
    fs,
    path::{MAIN_SEPARATOR, Path, PathBuf},
    process,
    sync::atomic::{AtomicUsize, Ordering},
};

use crate::{
    error::{Error, ErrorCode, ErrorKind, Result, nearest_name},
    scene::{BundledScene, bundled_scenes},
};

/// A scene that was found; one that is built in lies in a temporary folder for as long as this lives.
pub struct FoundScene {
    path: PathBuf,
    temporary: Option<PathBuf>,
    /// The process that laid it out. A copy of this in a process that was forked from it does not remove the folder.
    process: u32,
}

impl FoundScene {
    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What came of the scene; an error calls one that is built in by its name, not by where it lies for the moment.
    pub fn with_scene_name<T>(&self, outcome: Result<T>) -> Result<T> {
        let Some(folder) = &self.temporary else { return outcome };
        let without = |text: &mut String| *text = text.replace(&format!("{}{MAIN_SEPARATOR}", folder.display()), "");
        outcome.map_err(|mut error| {
            without(&mut error.message);
            error.location.iter_mut().for_each(|place| without(&mut place.file));
            error.help.iter_mut().for_each(without);
            error
        })
    }
}

impl Drop for FoundScene {
    fn drop(&mut self) {
        if let Some(folder) = self.temporary.as_ref().filter(|_| self.process == process::id()) {
            // Left over, it does no harm.
            let _ = fs::remove_dir_all(folder);
        }
    }
}

/// A scene that comes with the program.
pub struct BundledSceneInfo {
    /// Its name.
    pub name: String,
    /// Its caption.
    pub title: String,
    /// The first sentence of its README.
    pub about: String,
    /// Its folder in ./scenes, if it is there.
    pub folder: Option<PathBuf>,
}

/// The scene that `word` means.
///
/// # Errors
/// `Usage` if there is none: names the nearest.
pub fn find_scene(word: &Path) -> Result<FoundScene> {
    let beside = Path::new("scenes").join(word);
    for path in [word, &beside] {
        if path.is_file() || path.join("scene.toml").is_file() {
            return Ok(FoundScene { path: path.to_owned(), temporary: None, process: process::id() });
        }
    }
    let shelf = bundled_scenes();
    let name = word.to_string_lossy();
    if let Some(scene) = shelf.iter().find(|(known, ..)| *known == name) {
        return unpack(scene);
    }
    let help = match nearest_name(&name, shelf.iter().map(|(known, ..)| *known)) {
        Some(near) => format!("did you mean {near:?}? `pontoon scenes` lists all that come with the program"),
        None => "name a folder with a scene.toml, a scene file, or a scene of `pontoon scenes`".into(),
    };
    Err(Error::new(ErrorKind::Usage, format!("there is no scene {name:?}"))
        .with_code(ErrorCode::UnknownName)
        .help(help))
}

/// Lays a built-in scene out in a temporary folder of its own.
fn unpack((name, text, files): &BundledScene) -> Result<FoundScene> {
    static UNPACKED: AtomicUsize = AtomicUsize::new(0);
    let number = UNPACKED.fetch_add(1, Ordering::Relaxed);
    let temporary = std::env::temp_dir().join(format!("pontoon-{}-{number}", process::id()));
    let found = FoundScene { path: temporary.join(name), temporary: Some(temporary), process: process::id() };
    let refused = |why| Error::write(&found.path, "written", &why);
    fs::create_dir_all(&found.path).map_err(refused)?;
    for (file, text) in files.iter().chain([&("scene.toml", *text)]) {
        let target = found.path.join(file);
        fs::write(&target, text).map_err(|why| Error::write(&target, "written", &why))?;
    }
    Ok(found)
}

/// All scenes that come with the program.
pub fn scene_infos() -> Vec<BundledSceneInfo> {
    let listed = |(name, text, files): &BundledScene| {
        let words = text.parse::<toml::Table>().ok();
        let readme = files.iter().find(|(file, _)| *file == "README.md").map_or("", |(_, readme)| readme);
        let folder = Path::new("scenes").join(name);
        BundledSceneInfo {
            name: name.to_string(),
            title: words.and_then(|w| Some(w.get("title")?.as_str()?.to_owned())).unwrap_or_default(),
            about: first_sentence(readme),
            folder: folder.join("scene.toml").is_file().then_some(folder),
        }
    };
    bundled_scenes().iter().map(listed).collect()
}

/// The first sentence of `readme` that is no heading, of a line however long.
fn first_sentence(readme: &str) -> String {
    let paragraph = readme.split("\n\n").map(str::trim).find(|text| !text.is_empty() && !text.starts_with('#'));
    let text = without_links(&paragraph.unwrap_or("").split_whitespace().collect::<Vec<_>>().join(" "));
    text.split_once(". ").map_or(text.clone(), |(first, _)| format!("{first}."))
}

/// `text` with the words of its links alone, and names in no back-quotes.
fn without_links(text: &str) -> String {
    let (mut said, mut rest) = (String::new(), text);
    while let Some((before, after)) = rest.split_once("](") {
        let (Some(begins), Some((_, behind))) = (before.rfind('['), after.split_once(')')) else { break };
        said.extend([&before[..begins], &before[begins + 1..]]);
        rest = behind;
    }
    (said + rest).replace('`', "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_a_scene_is_the_first_sentence_of_its_readme() {
        let readme = "# A raft\n\nSix bodies, 1.7 m\nlong. More.\n\nSource.\n";
        assert_eq!(first_sentence(readme), "Six bodies, 1.7 m long.");
        assert_eq!(first_sentence("# Only a heading\n"), "");
        let linked = "# A raft\n\nThe [raft](../raft/README.md) of `raft`, in [1, 2] (twice). More.\n";
        assert_eq!(first_sentence(linked), "The raft of raft, in [1, 2] (twice).");
        for scene in scene_infos() {
            assert!(scene.about.ends_with('.') && !scene.title.is_empty(), "{}: {:?}", scene.name, scene.about);
            assert!(!scene.about.contains("]("), "{}: {:?}", scene.name, scene.about);
        }
    }
}
