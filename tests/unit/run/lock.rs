//! Unit tests of `src/run/lock.rs`.

use super::*;

#[test]
fn a_lock_excludes_a_second_run_and_a_stale_lock_is_replaced() -> Result<()> {
    let folder = std::env::temp_dir().join(format!("pontoon-lock-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|e| Error::file(&folder, e))?;
    fs::write(folder.join("run.lock"), "1234567 left over").map_err(|e| Error::file(&folder, e))?;
    let lock = Lock::acquire(&folder)?;
    let second = Lock::acquire(&folder).err().map(|e| (e.kind, e.message)).unwrap_or((ErrorKind::File, String::new()));
    assert_eq!(second.0, ErrorKind::Restart);
    assert!(second.1.ends_with(&format!("process {}", std::process::id())), "names the process: {}", second.1);
    drop(lock);
    assert!(!folder.join("run.lock").exists());
    Lock::acquire(&folder)?;
    fs::remove_dir_all(&folder).map_err(|e| Error::file(&folder, e))
}
