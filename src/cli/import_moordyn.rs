//! `pontoon import-moordyn`: the lines of a MoorDyn deck as sections of a scene.

use std::path::{Path, PathBuf};

use crate::{
    error::{Error, Result},
    scene::{file_content::decode, moordyn::Deck},
};
use clap::Args;

/// Which deck, and how it lies in the scene.
#[derive(Args)]
pub struct ImportMoordynArgs {
    /// Input file of MoorDyn v2
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The solid on which the coupled points are
    #[arg(long, value_name = "NAME", default_value = "body")]
    solid: String,
    /// Height of the still water level in the scene, m: 0 in the deck
    #[arg(long, value_name = "METRES", default_value_t = 0.0, allow_negative_numbers = true)]
    level: f64,
}

/// Returns the sections.
pub fn import(args: &ImportMoordynArgs) -> Result<String> {
    let bytes = std::fs::read(&args.file).map_err(|why| Error::read(&args.file, &why))?;
    let text = decode(&bytes).text;
    let folder = args.file.parent().unwrap_or(Path::new(""));
    Deck::parse(&text, &args.file.display().to_string(), folder)?.to_toml(&args.solid, args.level)
}
