//! The list of all contacts: who touches whom, how hard and where, without naming a pair beforehand.

use std::{
    fs,
    path::{Path, PathBuf},
};

use pontoon::{
    Result, report,
    run::{self, Progress, RunOptions},
    scene::Scene,
};

use crate::common::Home;

/// Two boxes piled on a shelf beside a small pool, and a ball that falls onto the shelf later; 10, 5 and 3.93 kg/m.
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

impl Home {
    /// Runs the scene until time `until` (s) into the folder `name`.
    fn ran(&self, name: &str, until: f64) -> Result<PathBuf> {
        let options = RunOptions { out: Some(self.0.join(name)), threads: Some(1), ..RunOptions::default() };
        Ok(run::run(&self.0.join("scene.toml"), &options, &mut |now: &Progress| now.time < until)?.folder)
    }
}

fn list(run: &Path) -> String {
    fs::read_to_string(run.join("lists/contacts.csv")).unwrap()
}

/// The rows of a table, cell by cell, without its head.
fn rows(text: &str) -> Vec<Vec<String>> {
    text.lines().skip(1).map(|line| line.split(',').map(String::from).collect()).collect()
}

#[test]
fn each_reading_has_a_row_for_each_pair_with_who_how_hard_and_where() -> Result<()> {
    let home = Home::with("contacts-rows", PILE);
    let run = home.ran("run", f64::INFINITY)?;
    let text = list(&run);
    assert_eq!(
        text.lines().next(),
        Some("t_s,first,second,pressing_N_per_m,fx_N_per_m,fy_N_per_m,x_m,y_m"),
        "as of the pair's own table, behind the names"
    );
    let all = rows(&text);
    let number = |row: &[String], i: usize| row[i].parse::<f64>().unwrap();
    let times: Vec<f64> = all.iter().map(|row| number(row, 0)).collect();
    assert!(
        times.windows(2).all(|pair| pair[0] <= pair[1]) && times[0] > 0.0,
        "in time; nothing before the first step"
    );
    let last: Vec<&Vec<String>> = all.iter().filter(|row| number(row, 0) == 0.4).collect();
    let pairs: Vec<[&str; 2]> = last.iter().map(|row| [row[1].as_str(), row[2].as_str()]).collect();
    assert_eq!(pairs, [["shelf", "lower"], ["shelf", "ball"], ["lower", "upper"]], "in the order of the scene");
    // Weights, where the faces meet. The boxes press with 3e-7 of their weight too much at the end, springs that still settle; at
    // the step of these 40 particles a contact sinks some tenths of a millimetre.
    let ball = 500.0 * std::f64::consts::PI * 0.05 * 0.05 * G;
    for (row, (weight, x, y)) in last.iter().zip([(15.0 * G, 2.0, 0.1), (ball, 1.75, 0.1), (5.0 * G, 2.0, 0.2)]) {
        let [pressing, across, up] = [3, 4, 5].map(|i| number(row, i));
        assert!((pressing / weight - 1.0).abs() < 1e-3 && (up / weight - 1.0).abs() < 1e-3, "{row:?} for {weight} N/m");
        assert!(across.abs() < 1e-3 * weight, "{row:?}");
        assert!((number(row, 6) - x).abs() < 2e-3 && (number(row, 7) - y).abs() < 2e-3, "{row:?}");
    }
    // The ball falls 0.15 m in 0.175 s: not before.
    let first = all.iter().find(|row| row[2] == "ball").map(|row| number(row, 0));
    assert!(first.is_some_and(|t| (0.16..0.22).contains(&t)), "{first:?}");
    // The table of a pair says the same bits at the same times; it names the two the other way round, so its force is the other's.
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
fn a_resumed_list_is_the_unbroken_one_byte_for_byte() -> Result<()> {
    let home = Home::with("contacts-resume", PILE);
    let (whole, broken) = (home.ran("whole", f64::INFINITY)?, home.ran("broken", 0.25)?);
    // From the checkpoint of 0.2 s: the list is longer, and is cut back first.
    fs::rename(broken.join("checkpoint.previous.bin"), broken.join("checkpoint.bin")).unwrap();
    let before = list(&broken).len();
    run::resume(&broken, &[], Some(1), &mut |_: &Progress| true)?;
    assert!(before < list(&whole).len() && list(&broken) == list(&whole));
    // A list that lost what the checkpoint counts on is told of by name.
    let cut = home.ran("cut", 0.25)?;
    fs::write(cut.join("lists/contacts.csv"), "t_s\n").unwrap();
    let error =
        run::resume(&cut, &[], Some(1), &mut |_: &Progress| true).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(error.contains("contacts.csv has 4 bytes, fewer than the"), "{error}");
    Ok(())
}

#[test]
fn a_list_is_no_series_and_the_page_does_without_it() -> Result<()> {
    let home = Home::with("contacts-page", PILE);
    let run = home.ran("run", f64::INFINITY)?;
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
