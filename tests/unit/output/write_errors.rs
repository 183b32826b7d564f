use std::{io, path::Path};

use super::cannot_write;

/// The advice fits the cause, and every command: `report` and `export` have no option for another folder.
#[test]
fn the_advice_of_a_file_that_cannot_be_written_fits_its_cause() {
    let folder = std::env::temp_dir();
    let advice = |kind: io::ErrorKind, path: &Path| cannot_write(path, &kind.into()).help.unwrap_or_default();
    for (kind, part) in [
        (io::ErrorKind::PermissionDenied, "allow writing in the folder"),
        (io::ErrorKind::ReadOnlyFilesystem, "allow writing in the folder"),
        (io::ErrorKind::StorageFull, "free some space"),
        (io::ErrorKind::InvalidInput, "use another folder"),
    ] {
        let told = advice(kind, &folder.join("report.html"));
        assert!(told.contains(part) && !told.contains("--out"), "{kind}: {told}");
    }
    let gone = advice(io::ErrorKind::NotFound, &folder.join("pontoon-never/report.html"));
    assert!(gone.contains("pontoon-never is gone"), "{gone}");
    assert!(advice(io::ErrorKind::PermissionDenied, Path::new("a.png")).contains("the folder ."));
}
