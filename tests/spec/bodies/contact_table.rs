//! The table of all contacts: the solids of each pair, their force and position, without a pair named in the scene.

use std::{
    fs,
    path::{Path, PathBuf},
};

use pontoon::{
    Result, report,
    run::{self, Progress, RunOptions},
    scene::Scene,
};

use crate::common::TestFolder;

/// Two stacked boxes on a shelf beside a small pool, and a ball that falls onto the shelf later; 10, 5 and 3.93 kg/m.
const PILE: &str = r#"
dimension = 2
dp = 0.05
until = 0.4
frames = "off"
checkpoint = { every = 0.1 }

[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.5, 0.2] } }

[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.5, 0.4] } }

[[solid]]
name = "shelf"
fixed = true
shape = { box = { size = [0.8, 0.1] } }
at = { x = 2.0, y = 0.05 }

[[solid]]
name = "lower"
shape = { box = { size = [0.2, 0.1] } }
at = { x = 2.0, y = 0.15 }
free = { density = 500.0 }

[[solid]]
name = "upper"
shape = { box = { size = [0.1, 0.1] } }
at = { x = 2.0, y = 0.25 }
free = { density = 500.0 }

[[solid]]
name = "ball"
shape = { ball = { radius = 0.05 } }
at = { x = 1.75, y = 0.3 }
free = { density = 500.0 }

[[probe]]
contacts = true
every = 0.02

[[probe]]
contact = ["upper", "lower"]
every = 0.02
"#;

const G: f64 = 9.81;

impl TestFolder {
    /// Runs the scene until time `until` (s) and writes to the folder `name`.
    fn run(&self, name: &str, until: f64) -> Result<PathBuf> {
        let options = RunOptions { out: Some(self.join(name)), threads: Some(1), ..RunOptions::default() };
        Ok(run::run(&self.join("scene.toml"), &options, &mut |now: &Progress| now.time < until)?.folder)
    }
}

fn list(run: &Path) -> String {
    fs::read_to_string(run.join("lists/contacts.csv")).unwrap()
}

/// The cells of each row of a table, without the header.
fn rows(text: &str) -> Vec<Vec<String>> {
    text.lines().skip(1).map(|line| line.split(',').map(String::from).collect()).collect()
}

#[test]
fn the_contact_table_has_a_row_for_each_touching_pair_with_names_force_and_position() -> Result<()> {
    let home = TestFolder::with_scene("contacts-rows", PILE);
    let run = home.run("run", f64::INFINITY)?;
    let text = list(&run);
    assert_eq!(
        text.lines().next(),
        Some("t_s,first,second,pressing_N_per_m,fx_N_per_m,fy_N_per_m,x_m,y_m"),
        "two names, then the columns of the table of a pair"
    );
    let all = rows(&text);
    let number = |row: &[String], i: usize| row[i].parse::<f64>().unwrap();
    let times: Vec<f64> = all.iter().map(|row| number(row, 0)).collect();
    assert!(
        times.windows(2).all(|pair| pair[0] <= pair[1]) && times[0] > 0.0,
        "rows are in order of time; none is before the first step"
    );
    let last: Vec<&Vec<String>> = all.iter().filter(|row| number(row, 0) == 0.4).collect();
    let pairs: Vec<[&str; 2]> = last.iter().map(|row| [row[1].as_str(), row[2].as_str()]).collect();
    assert_eq!(
        pairs,
        [["shelf", "lower"], ["shelf", "ball"], ["lower", "upper"]],
        "pairs are in the order of the scene"
    );
    // The forces are the weights, at the touching faces. Contact springs still relax at the end: the boxes press with 3e-7 of their
    // weight too much. With the step of these 40 particles a contact sinks some tenths of a millimetre.
    let ball = 500.0 * std::f64::consts::PI * 0.05 * 0.05 * G;
    for (row, (weight, x, y)) in last.iter().zip([(15.0 * G, 2.0, 0.1), (ball, 1.75, 0.1), (5.0 * G, 2.0, 0.2)]) {
        let [pressing, across, up] = [3, 4, 5].map(|i| number(row, i));
        assert!((pressing / weight - 1.0).abs() < 1e-3 && (up / weight - 1.0).abs() < 1e-3, "{row:?} for {weight} N/m");
        assert!(across.abs() < 1e-3 * weight, "{row:?}");
        assert!((number(row, 6) - x).abs() < 2e-3 && (number(row, 7) - y).abs() < 2e-3, "{row:?}");
    }
    // The ball falls 0.15 m in 0.175 s.
    let first = all.iter().find(|row| row[2] == "ball").map(|row| number(row, 0));
    assert!(first.is_some_and(|t| (0.16..0.22).contains(&t)), "{first:?}");
    // The table of a pair has the same bits at the same times. It names the two solids in reverse order, so its force has the other sign.
    let own = fs::read_to_string(run.join("series/upper_lower_contact.csv")).unwrap();
    let own: Vec<Vec<String>> = rows(&own).into_iter().filter(|row| !row[4].is_empty()).collect();
    let listed: Vec<&Vec<String>> = all.iter().filter(|row| row[2] == "upper").collect();
    assert!(own.len() > 15 && own.len() == listed.len(), "{} and {}", own.len(), listed.len());
    for (own, listed) in own.iter().zip(listed) {
        assert_eq!((&own[0], &own[1], &own[4..]), (&listed[0], &listed[3], &listed[6..]));
        assert!(number(own, 3) == -number(listed, 5));
    }
    Ok(())
}

#[test]
fn the_contact_table_of_a_resumed_run_equals_that_of_an_uninterrupted_run() -> Result<()> {
    let home = TestFolder::with_scene("contacts-resume", PILE);
    let (whole, broken) = (home.run("whole", f64::INFINITY)?, home.run("broken", 0.25)?);
    // The run resumes from the checkpoint at 0.2 s. The table is longer and is truncated first.
    fs::rename(broken.join("checkpoint.previous.bin"), broken.join("checkpoint.bin")).unwrap();
    let before = list(&broken).len();
    run::resume(&broken, &[], Some(1), &mut |_: &Progress| true)?;
    assert!(before < list(&whole).len() && list(&broken) == list(&whole));
    // A table shorter than the checkpoint expects is refused by name.
    let cut = home.run("cut", 0.25)?;
    fs::write(cut.join("lists/contacts.csv"), "t_s\n").unwrap();
    let error =
        run::resume(&cut, &[], Some(1), &mut |_: &Progress| true).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(error.contains("contacts.csv has 4 bytes, fewer than the"), "{error}");
    Ok(())
}

#[test]
fn a_contact_table_is_not_a_series_and_is_not_part_of_the_report() -> Result<()> {
    let home = TestFolder::with_scene("contacts-page", PILE);
    let run = home.run("run", f64::INFINITY)?;
    let manifest = fs::read_to_string(run.join("manifest.json")).unwrap();
    assert!(manifest.contains("\"lists/contacts.csv\""), "the manifest names it");
    let statistics = fs::read_to_string(run.join("statistics.csv")).unwrap();
    assert!(statistics.contains("upper_lower_contact.pressing") && !statistics.contains("contacts."), "{statistics}");
    let page = report::write(&run)?;
    assert!(page.remarks.is_empty(), "{:?}", page.remarks);
    let refused = |words: &str| {
        let scene = Scene::parse(&format!("{PILE}\n{words}"), Path::new(""), &[]);
        let error = scene.and_then(|scene| scene.build::<2>().map(|_| ())).err().unwrap_or_else(|| panic!("{words}"));
        error.to_string()
    };
    for words in [
        "[[check]]\nseries = \"contacts.pressing_N_per_m\"\nformula = \"0\"",
        "[[statistic]]\nwaves = \"contacts.pressing_N_per_m\"",
    ] {
        let message = refused(words);
        assert!(message.contains("\"contacts\" lists all contacts, many at one time, and has no series"), "{message}");
    }
    let message = refused("[[probe]]\nname = \"mean\"\ncontacts = true\naverage = true");
    assert!(message.contains("a list of contacts takes no means"), "{message}");
    let message = refused("[[probe]]\ncontacts = false");
    assert!(message.contains("contacts = false watches nothing"), "{message}");
    Ok(())
}
