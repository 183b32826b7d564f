//! Which of the checkpoints in a run's folder the run goes on from: the last one, or the one before where the last
//! is of no use. Writes nothing.

use std::{fs, path::Path};

use super::{
    folder,
    outputs::{list_of, series_folder},
};
use crate::{
    error::{Error, Kind, Result},
    record::{Checkpoint, restart},
    scene::Scene,
};

/// What a run goes on from.
pub struct Kept {
    /// The checkpoint.
    pub checkpoint: Checkpoint,
    /// The scene, as it was at the start.
    pub scene: Scene,
    /// Why it is not the last checkpoint, if it is the one before.
    pub warning: Option<String>,
}

/// The newest checkpoint of use in `folder`.
///
/// # Errors
/// What is wrong with the last one, if the one before is of no use either.
pub fn newest(folder: &Path) -> Result<Kept> {
    let last = match usable(folder, restart::LAST) {
        Ok((checkpoint, scene)) => return Ok(Kept { checkpoint, scene, warning: None }),
        Err(why) => why,
    };
    match usable(folder, restart::PREVIOUS) {
        Ok((checkpoint, scene)) => {
            let warning = format!(
                "{}; the run goes on from the checkpoint before, {}, at t = {:.6} s",
                last.what,
                restart::PREVIOUS,
                checkpoint.time
            );
            Ok(Kept { checkpoint, scene, warning: Some(warning) })
        }
        // Said once where both say the same, and nothing of one that never was.
        Err(why) if why.what == last.what || !folder.join(restart::PREVIOUS).exists() => Err(last),
        Err(why) => {
            let help = last.help.clone().unwrap_or_default();
            Err(last.help(format!("the checkpoint before is of no use either: {}\n{help}", why.what)))
        }
    }
}

/// Whether `folder` holds a checkpoint, be it of use or not.
pub fn any(folder: &Path) -> bool {
    [restart::LAST, restart::PREVIOUS].iter().any(|name| folder.join(name).exists())
}

/// The checkpoint `name` in `folder`, if the scene and the tables there are those that it was made with.
fn usable(folder: &Path, name: &str) -> Result<(Checkpoint, Scene)> {
    let checkpoint = Checkpoint::read(&folder.join(name))?;
    let scene = Scene::read(&folder.join(folder::SCENE), &checkpoint.sets)?;
    if restart::hash(scene.to_toml()?.as_bytes()) != checkpoint.scene {
        let what = format!("the scene in {} is not the one that this run began with", folder.display());
        return Err(Error::new(Kind::Restart, what).help("undo the change there, or start afresh with `pontoon run`"));
    }
    let plan = scene.plan()?;
    let series = plan.probes.iter().map(|probe| series_folder(folder).join(format!("{}.csv", probe.name)));
    let lists = plan.contacts.iter().map(|list| list_of(folder, &list.name));
    for (table, &bytes) in series.chain(lists).zip(&checkpoint.tables) {
        let there = fs::metadata(&table).map_or(0, |file| file.len());
        if there < bytes {
            let what = format!("{} has {there} bytes, fewer than the {bytes} of {name}", table.display());
            return Err(Error::new(Kind::Restart, what).help("start the run afresh with `pontoon run`"));
        }
    }
    Ok((checkpoint, scene))
}
