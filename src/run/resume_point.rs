//! Selects the checkpoint from which a run continues: the last in the run's folder, or the previous one if the last is unusable.
//! Defines which scene keys a resumed run may change. Writes no file.

use std::{fs, path::Path};

use super::{
    outputs::{contact_list_path, series_folder},
    run_folder,
};
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result},
    output::{Checkpoint, checkpoint},
    scene::Scene,
};

/// The point from which a run continues.
pub(crate) struct ResumePoint {
    /// The checkpoint.
    pub checkpoint: Checkpoint,
    /// The scene, as it was at the start; its guards may have been set since.
    pub scene: Scene,
    /// The reason why the last checkpoint is unusable, if this is the one before.
    pub warning: Option<String>,
}

impl ResumePoint {
    /// Replaces guards, which stop a run but do not change its equations, or the device, by `sets` for the run in `folder`.
    ///
    /// # Errors
    /// `Usage` for any other key; `Scene` for an invalid value.
    pub(crate) fn with_guard_overrides(mut self, folder: &Path, sets: &[(String, String)]) -> Result<Self> {
        if sets.is_empty() {
            return Ok(self);
        }
        if let Some((key, _)) = sets.iter().find(|(key, _)| !may_change(key)) {
            let what = format!("{key} cannot be changed in a run that has begun: only [guard] and model.device can");
            let help =
                format!("--set guard.escape=remove is such a change; `pontoon run` with --set {key}=… starts afresh");
            return Err(Error::new(ErrorKind::Usage, what).help(help));
        }
        let known = &mut self.checkpoint;
        known.overrides.retain(|(key, _)| sets.iter().all(|(set, _)| set != key));
        known.overrides.extend_from_slice(sets);
        self.scene = Scene::read(&folder.join(run_folder::SCENE), &known.overrides)?;
        known.scene_hash = checkpoint::fnv1a(self.scene.to_toml()?.as_bytes());
        Ok(self)
    }
}

/// Whether a run that has begun can go on with another value of `key`.
fn may_change(key: &str) -> bool {
    key.split('.').next() == Some("guard") || key == "model.device"
}

/// The newest usable checkpoint in `folder`.
///
/// # Errors
/// The error of the last checkpoint, if the previous one is unusable too.
pub(crate) fn latest_resume_point(folder: &Path) -> Result<ResumePoint> {
    let last = match load_matching(folder, checkpoint::LAST) {
        Ok((checkpoint, scene)) => return Ok(ResumePoint { checkpoint, scene, warning: None }),
        Err(why) => why,
    };
    match load_matching(folder, checkpoint::PREVIOUS) {
        Ok((checkpoint, scene)) => {
            let warning = format!(
                "{}; the run goes on from the checkpoint before, {}, at t = {:.6} s",
                last.message,
                checkpoint::PREVIOUS,
                checkpoint.time
            );
            Ok(ResumePoint { checkpoint, scene, warning: Some(warning) })
        }
        // An error that both checkpoints have is reported once, and a previous checkpoint that does not exist is not reported.
        Err(why) if why.message == last.message || !folder.join(checkpoint::PREVIOUS).exists() => Err(last),
        Err(why) => {
            let help = last.help.clone().unwrap_or_default();
            Err(last.help(format!("the checkpoint before is of no use either: {}\n{help}", why.message)))
        }
    }
}

/// Whether `folder` contains a checkpoint, usable or not.
pub(crate) fn has_checkpoint(folder: &Path) -> bool {
    [checkpoint::LAST, checkpoint::PREVIOUS].iter().any(|name| folder.join(name).exists())
}

/// The checkpoint `name` in `folder`, if the scene and the tables there are those that it was made with.
fn load_matching(folder: &Path, name: &str) -> Result<(Checkpoint, Scene)> {
    let mut checkpoint = Checkpoint::read(&folder.join(name))?;
    let scene = Scene::read(&folder.join(run_folder::SCENE), &checkpoint.overrides)?;
    if checkpoint::fnv1a(scene.to_toml()?.as_bytes()) != checkpoint.scene_hash {
        let what = format!("the scene in {} is not the one that this run began with", folder.display());
        return Err(Error::new(ErrorKind::Restart, what)
            .with_code(ErrorCode::OtherSetup)
            .help("undo the change there, or start afresh with `pontoon run`"));
    }
    let beside = folder.join("scene");
    let files = run_folder::file_hashes(&scene, &beside)?;
    let known = checkpoint.files.get_or_insert_with(|| files.clone());
    if let Some((changed, _)) = known.iter().find(|file| !files.contains(file)) {
        let what = format!("{} is not the file that this run began with", beside.join(changed).display());
        return Err(Error::new(ErrorKind::Restart, what)
            .with_code(ErrorCode::OtherSetup)
            .help("put the file back as it was, or start afresh with `pontoon run`"));
    }
    let plan = scene.plan()?;
    let series = plan.probes.iter().map(|probe| series_folder(folder).join(format!("{}.csv", probe.name)));
    let lists = plan.contacts.iter().map(|list| contact_list_path(folder, &list.name));
    for (table, &bytes) in series.chain(lists).zip(&checkpoint.outputs.table_bytes) {
        let there = fs::metadata(&table).map_or(0, |file| file.len());
        if there < bytes {
            let what = format!("{} has {there} bytes, fewer than the {bytes} of {name}", table.display());
            return Err(Error::new(ErrorKind::Restart, what).help("start the run afresh with `pontoon run`"));
        }
    }
    Ok((checkpoint, scene))
}
