//! The browser of the tests that open pages.

use std::{process::Command, sync::OnceLock};

/// The command of Chromium if it is installed. Without it a test prints "skipped", and fails in CI.
pub(crate) fn chromium() -> Option<&'static str> {
    static FOUND: OnceLock<Option<&'static str>> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let answers =
            |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|result| result.status.success());
        let found = ["chromium", "chromium-browser", "google-chrome"].into_iter().find(answers);
        if found.is_none() {
            assert!(std::env::var("CI").as_deref() != Ok("true"), "CI needs Chromium to open the page of a run");
            eprintln!("skipped: Chromium is not installed, so the page was not opened in a browser");
        }
        found
    })
}
