//! Tells the program the commit of its source, for the manifests of its runs.

use std::{env, fs, path::Path, process::Command};

fn main() {
    // Run again only when the source has changed: then a commit that changes nothing of it costs no build.
    for path in ["build.rs", "src", "Cargo.toml", "Cargo.lock"] {
        println!("cargo:rerun-if-changed={path}");
    }
    let home = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    if let Some(commit) = packaged(Path::new(&home)).or_else(|| checked_out(&home)) {
        println!("cargo:rustc-env=PONTOON_COMMIT={commit}");
    }
}

/// The commit that a package of crates.io was made from.
fn packaged(home: &Path) -> Option<String> {
    let text = fs::read_to_string(home.join(".cargo_vcs_info.json")).ok()?;
    let hash = text.split("\"sha1\"").nth(1)?.split('"').nth(1)?;
    Some(hash.chars().take(12).collect())
}

/// The commit that is checked out, if `home` is the repository itself.
fn checked_out(home: &str) -> Option<String> {
    let git = |words: &[&str]| {
        let said = Command::new("git").arg("-C").arg(home).args(words).output().ok()?;
        said.status.success().then(|| String::from_utf8_lossy(&said.stdout).trim().to_string())
    };
    let top = git(&["rev-parse", "--show-toplevel"])?;
    if fs::canonicalize(top).ok()? != fs::canonicalize(home).ok()? {
        return None;
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    let changed = git(&["status", "--porcelain", "--", "src", "Cargo.toml", "Cargo.lock"])?;
    Some(if changed.is_empty() { commit } else { commit + ", changed" })
}
