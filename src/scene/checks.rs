//! The words of `[[check]]`: held against one another, then made into what a run judges itself by.

use std::path::Path;

use super::{CheckConfig, CheckPlan, Reference, Scene, table, verify::suggestion};
use crate::{
    error::{Error, Result},
    math::expression::Formula,
    plan::Align,
};

impl Scene {
    /// Refuses checks that cannot be meant, before any table is opened.
    pub(super) fn verify_checks(&self) -> Result<()> {
        let names = self.probe_names();
        for (i, check) in self.check.iter().enumerate() {
            let key = format!("check.{i}");
            let Some((probe, _)) = check.series.split_once('.') else {
                let what = "a series is a probe and its column, with a point between";
                return Err(self.error_at(&format!("{key}.series"), what));
            };
            let Some(i) = names.iter().position(|name| name == probe) else {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                let what = format!("no probe is called \"{probe}\"{}", suggestion(probe, &names));
                return Err(self.error_with_help(
                    &format!("{key}.series"),
                    what,
                    format!("known: {}", names.join(", ")),
                ));
            };
            if self.probe[i].contacts.is_some() {
                return Err(self.list_has_no_series(&format!("{key}.series"), probe));
            }
            self.verify_reference(&key, check)?;
            self.verify_times(&key, check)?;
            self.verify_figures(&key, check)?;
        }
        Ok(())
    }

    /// A table or a formula, and one of them.
    fn verify_reference(&self, key: &str, check: &CheckConfig) -> Result<()> {
        let of_table = [
            ("reference", check.reference.is_some()),
            ("column", check.column.is_some()),
            ("time", check.time.is_some()),
            ("delay", check.delay.is_some()),
        ];
        match &check.formula {
            Some(text) => {
                if let Some((word, _)) = of_table.iter().find(|(_, given)| *given) {
                    let what = format!("a check by a formula has no {word}: that is of a table");
                    let help = "give either formula, or reference and column";
                    return Err(self.error_with_help(&format!("{key}.{word}"), what, help));
                }
                let place = |e: Error| self.origin.with_location(e, &format!("{key}.formula"));
                Formula::parse(text).map(|_| ()).map_err(place)
            }
            None => match of_table[..2].iter().find(|(_, given)| !given) {
                Some((word, _)) => {
                    let what = format!("\"{word}\" is missing: a check needs something to be held against");
                    Err(self.error_at(&format!("{key}.{word}"), what))
                }
                None => Ok(()),
            },
        }
    }

    fn verify_times(&self, key: &str, check: &CheckConfig) -> Result<()> {
        self.require_positive(&format!("{key}.mean"), check.mean)?;
        if let Some(zero) = check.zero.filter(|zero| !(*zero >= 0.0 && zero.is_finite())) {
            return Err(
                self.error_at(&format!("{key}.zero"), format!("zero is a time of the run, and {zero} s is none"))
            );
        }
        match check.align {
            Some(Align::Crossing(threshold)) => {
                self.require_positive(&format!("{key}.align.crossing"), Some(threshold))?
            }
            Some(Align::Start(threshold)) => self.require_positive(&format!("{key}.align.start"), Some(threshold))?,
            Some(Align::Best) | None => {}
        }
        match (check.from, check.until) {
            (Some(from), Some(until)) if from >= until => {
                let what = format!("nothing lies between from = {from} and until = {until}");
                Err(self.error_with_help(
                    &format!("{key}.until"),
                    what,
                    "until is the later time, in the run's own time",
                ))
            }
            _ => Ok(()),
        }
    }

    /// A bound may only name figures that the check forms.
    fn verify_figures(&self, key: &str, check: &CheckConfig) -> Result<()> {
        let Some(bound) = check.bound else { return Ok(()) };
        let figures = [
            ("N", bound.relative_l2),
            ("M", bound.amplitude_ratio),
            ("peak", bound.peak),
            ("off", bound.off),
            ("aligned_N", bound.aligned_relative_l2),
            ("delay", bound.delay),
        ];
        if let Some((word, figure)) = figures.iter().find(|(_, figure)| figure.is_some_and(|x| x < 0.0)) {
            let what = format!("{word} is the largest that passes, and {} is below 0", figure.unwrap_or_default());
            return Err(self.error_at(&format!("{key}.bound.{word}"), what));
        }
        if matches!(check.align, None | Some(Align::Start(_)))
            && let Some((word, _)) = figures[4..].iter().find(|(_, figure)| figure.is_some())
        {
            let what = format!("the bound names {word}, but nothing is aligned");
            return Err(self.error_with_help(
                &format!("{key}.bound.{word}"),
                what,
                "write  align = \"best\"  in this check",
            ));
        }
        Ok(())
    }

    /// What the run is held against; the tables are there and have the columns.
    pub(super) fn check_plans(&self) -> Result<Vec<CheckPlan>> {
        let words = |(i, check): (usize, &CheckConfig)| {
            let place = |e: Error| self.origin.with_location(e, &format!("check.{i}.reference"));
            let reference = match &check.formula {
                Some(text) => Reference::Formula(text.clone()),
                None => {
                    let file = check.reference.clone().unwrap_or_default();
                    let (time, column) =
                        (check.time.clone().unwrap_or_default(), check.column.clone().unwrap_or_default());
                    let path = table::path_beside(&self.origin.folder, &file).map_err(place)?;
                    table::read_series(&path, &time, &column).map_err(place)?;
                    let delay = check.delay.unwrap_or_default();
                    Reference::Table { file: Path::new(&file).to_path_buf(), time, column, delay }
                }
            };
            Ok(CheckPlan {
                series: check.series.clone(),
                reference,
                from: check.from,
                until: check.until,
                zero: check.zero,
                mean: check.mean,
                align: check.align,
                paper: check.paper,
                bound: check.bound,
            })
        };
        self.check.iter().enumerate().map(words).collect()
    }
}
