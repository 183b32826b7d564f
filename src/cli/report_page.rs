//! `pontoon report` and `pontoon compare`; the page that a run leaves at its end.

use std::path::{Path, PathBuf};

use crate::{
    error::{Error, ErrorKind, Result},
    math::format::{bytes, duration},
    report::{self, ColourField, Page, PictureOptions},
};
use clap::{Args, ValueEnum};

use super::{print_error, print_output};

/// A page of one run.
#[derive(Args)]
pub struct ReportArgs {
    /// Folder of the run
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    #[command(flatten)]
    picture: PictureArgs,
}

/// A page of several.
#[derive(Args)]
pub struct CompareArgs {
    /// Folders of the runs
    #[arg(value_name = "DIR", num_args = 2.., required = true)]
    folders: Vec<PathBuf>,
    /// The page to write
    #[arg(long, value_name = "FILE", default_value = "compare.html")]
    out: PathBuf,
    #[command(flatten)]
    picture: PictureArgs,
}

/// A picture instead of a page.
#[derive(Args)]
struct PictureArgs {
    /// Write a picture to FILE instead of a page [default: frame.png]
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "frame.png", value_parser = png_file)]
    png: Option<PathBuf>,
    #[command(flatten)]
    look: PictureStyleArgs,
}

/// What a picture shows.
#[derive(Args)]
pub struct PictureStyleArgs {
    /// Times of the pictures, s, separated by commas; of each the nearest frame [default: the last]
    #[arg(long, value_name = "SECONDS,..", value_delimiter = ',', requires = "png")]
    time: Vec<f64>,
    /// What colours the particles
    #[arg(long, value_name = "FIELD", default_value = "pressure", requires = "png")]
    by: ColourBy,
    /// Values of the two ends of the colours [default: the usual range of all that is shown]
    #[arg(long, value_name = "LOW,HIGH", value_parser = number_pair, allow_hyphen_values = true, requires = "png")]
    range: Option<[f64; 2]>,
    /// Width of the picture, pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1600, value_parser = clap::value_parser!(u32).range(200..=16_000), requires = "png")]
    width: u32,
}

/// What colours the particles.
#[derive(Clone, Copy, ValueEnum)]
enum ColourBy {
    /// The pressure
    Pressure,
    /// The pressure beyond that of still water at the place
    Excess,
    /// The speed
    Speed,
}

/// Parses two increasing numbers, separated by a comma.
fn number_pair(text: &str) -> std::result::Result<[f64; 2], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[low, high]) if low < high && low.is_finite() && high.is_finite() => Ok([low, high]),
        _ => Err("write the lower and the higher value, as in --range 0,5000".into()),
    }
}

/// Runs the command `pontoon report` and returns its exit code.
///
/// # Errors
/// As [`report::write`].
pub fn report(args: &ReportArgs) -> Result<u8> {
    match &args.picture.png {
        Some(png) => draw_picture(std::slice::from_ref(&args.folder), &args.picture.look.picture_options()?, png)?,
        None => print_page(&report::write(&args.folder)?)?,
    }
    Ok(0)
}

/// Runs the command `pontoon compare` and returns its exit code.
///
/// # Errors
/// As [`report::compare`].
pub fn compare(args: &CompareArgs) -> Result<u8> {
    match &args.picture.png {
        Some(png) => draw_picture(&args.folders, &args.picture.look.picture_options()?, png)?,
        None => print_page(&report::compare(&args.folders, &args.out)?)?,
    }
    Ok(0)
}

impl PictureStyleArgs {
    /// Returns the options of the picture, with the names of the runs above its columns.
    ///
    /// # Errors
    /// `Usage` if a time is not a number.
    pub fn picture_options(&self) -> Result<PictureOptions> {
        if let Some(t) = self.time.iter().find(|t| !t.is_finite()) {
            let help = "give seconds, as in --time 0.5,1";
            return Err(Error::new(ErrorKind::Usage, format!("--time {t} is no time")).help(help));
        }
        let field = match self.by {
            ColourBy::Pressure => ColourField::Pressure,
            ColourBy::Excess => ColourField::ExcessPressure,
            ColourBy::Speed => ColourField::Speed,
        };
        Ok(PictureOptions {
            times: self.time.clone(),
            field,
            range: self.range,
            width: self.width,
            column_titles: vec![],
        })
    }
}

/// Draws the runs in `folders` to `out` and prints the path.
///
/// # Errors
/// As [`report::picture`].
pub fn draw_picture(folders: &[PathBuf], shot: &PictureOptions, out: &Path) -> Result<()> {
    let (width, height) = report::write_picture(folders, shot, out)?;
    print_output(&format!("{}: {width} × {height} pixels\n", out.display()))
}

/// Prints the path of a page and the items that the page omits.
fn print_page(page: &Page) -> Result<()> {
    for remark in &page.remarks {
        print_error(&format!("warning: {remark}\n"));
    }
    print_output(&page_line(page))
}

fn page_line(page: &Page) -> String {
    let size = bytes(page.bytes as f64);
    format!("page: {} ({size}, written in {})\n", page.path.display(), duration(page.seconds))
}

/// Writes the page of the run in `folder` at its end. An error of the page does not change the outcome of the run; it
/// is passed to `told`.
///
/// # Errors
/// As [`print_output`].
pub fn write_after_run(folder: &Path, quiet: bool, told: impl Fn(&Error)) -> Result<()> {
    match report::write(folder) {
        Ok(_) if quiet => {}
        Ok(page) => print_output(&page_line(&page))?,
        Err(why) => told(&why),
    }
    Ok(())
}

/// Reads the name of a picture file.
pub fn png_file(text: &str) -> std::result::Result<PathBuf, String> {
    let file = PathBuf::from(text);
    match file.extension().is_some_and(|end| end.eq_ignore_ascii_case("png")) {
        true => Ok(file),
        false => Err("a picture is a PNG file: give it a name that ends in .png".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::number_pair;

    #[test]
    fn the_ends_of_a_range_rise() {
        assert_eq!(number_pair("-5, 1e3"), Ok([-5.0, 1000.0]));
        assert!(["5,1", "1", "1,2,3", "a,b", "0,inf"].iter().all(|text| number_pair(text).is_err()));
    }
}
