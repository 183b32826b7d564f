//! The files of runs, compared byte for byte.

use std::{collections::BTreeMap, fs, path::Path};

/// Every file below `folder` by its relative name.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fn collect(folder: &Path, from: &Path, into: &mut BTreeMap<String, Vec<u8>>) {
        for path in fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path()) {
            match path.is_dir() {
                true => collect(&path, from, into),
                false => {
                    let name = path.strip_prefix(from).unwrap().display().to_string();
                    into.insert(name, fs::read(&path).unwrap());
                }
            }
        }
    }
    let mut all = BTreeMap::new();
    collect(folder, folder, &mut all);
    all
}

/// Whether a file of a run contains wall time.
pub(crate) fn has_wall_time(name: &str) -> bool {
    name == "manifest.json" || name.starts_with("checkpoint")
}

/// Asserts that two runs, of which `what` tells the difference, have the same files, without those that contain wall time.
#[track_caller]
pub(crate) fn assert_same_files(one: &Path, other: &Path, what: &str) {
    let [expected, got] = [one, other].map(|folder| {
        let mut all = files(folder);
        all.retain(|name, _| !has_wall_time(name));
        all
    });
    assert!(expected.keys().eq(got.keys()), "{what}: {:?}\n{:?}", expected.keys(), got.keys());
    for (file, bytes) in &expected {
        assert!(*bytes == got[file], "{what}: {file} differs");
    }
}
