//! Records: laws from tables stay between their samples, on the clock of the run, and notes name what a table is taken for.

use std::{fs, path::Path};

use pontoon::{
    output::SeriesTable,
    preflight::{Preflight, Severity},
    run::{self, InspectOptions, Progress, RunOptions},
    scene::{BuiltScene, Scene},
    solid::Role,
};

use crate::common::TestFolder;

/// A tank that a law moves; `LAW` stands for the law.
const SCENE: &str = "dimension = 2\ndp = 0.05\nuntil = 2.0\nframes = \"off\"\n\
    [[water]]\nfill = { box = { min = [0.0, 0.0], max = [0.6, 0.2] } }\n\
    [[solid]]\nname = \"tank\"\nshape = { tank = { size = [0.6, 0.4] } }\n\
    driven = { along = [1.0, 0.0], distance = LAW }\n\
    [domain]\nmin = [-4.0, -4.0]\nmax = [5.0, 5.0]\n[[probe]]\nmotion = \"tank\"\nevery = 0.01\n";

/// Samples of a smooth way of 0.02 m and back, every 0.1 s from `start`.
fn samples(start: f64, count: i32) -> impl Iterator<Item = (f64, f64)> {
    (0..count).map(move |i| (start + 0.1 * f64::from(i), 0.01 * (1.0 - (0.314 * f64::from(i)).cos())))
}

/// A folder with a scene of this law and the file `record.csv`.
fn folder(name: &str, law: &str, record: impl AsRef<[u8]>) -> TestFolder {
    let folder = TestFolder::new(&format!("records-{name}"));
    fs::write(folder.join("scene.toml"), SCENE.replace("LAW", law)).unwrap();
    fs::write(folder.join("record.csv"), record).unwrap();
    folder
}

fn inspected(folder: &Path) -> pontoon::Result<Preflight> {
    let options = InspectOptions { threads: Some(1), ..InspectOptions::default() };
    Ok(run::inspect(&folder.join("scene.toml"), &options)?.report().unwrap().preflight)
}

/// Findings of the kinds that concern records: severity, topic, text with its remedy.
fn findings(folder: &Path) -> Vec<(Severity, &'static str, String)> {
    let found = inspected(folder).unwrap_or_else(|e| panic!("{e}")).findings.into_iter();
    let of_record =
        found.filter(|f| matches!(f.topic, "table_layout" | "record_span" | "record_unit" | "record_uneven"));
    of_record.map(|f| (f.severity, f.topic, format!("{}\n{}", f.what, f.mend))).collect()
}

/// The displacement of the driven tank at time `t` (s).
fn displacement(folder: &Path, t: f64) -> f64 {
    let BuiltScene { setup, .. } = Scene::read(folder, &[]).unwrap().build::<2>().unwrap();
    let tank = &setup.solids[0];
    let Role::Driven(motion) = &tank.role else { panic!("the tank is driven") };
    motion.kinematics(&tank.pose, t).pose.point(&pontoon::math::Vector::from([0.0, 0.0]))[0]
        - tank.pose.point(&pontoon::math::Vector::from([0.0, 0.0]))[0]
}

#[test]
fn a_gate_of_four_points_moves_between_its_points_in_a_run() -> pontoon::Result<()> {
    let folder =
        folder("gate", "{ file = \"record.csv\", column = \"y_m\" }", "t_s,y_m\n0,0\n0.1,0\n0.3,0.5\n10,0.5\n");
    let sets = [("until", "0.5")].map(|(key, value)| (key.to_string(), value.to_string()));
    let options = RunOptions { out: Some(folder.join("out")), overrides: sets.to_vec(), threads: Some(1) };
    run::run(&folder.join("scene.toml"), &options, &mut |_: &Progress| true)?;
    let table = SeriesTable::read(&folder.join("out/series/tank.csv"))?;
    let way = &table.values[table.columns.iter().position(|name| name == "surge_m").unwrap()];
    // The reading differs from the law by round-off only: the motion is prescribed.
    assert!(way.iter().all(|x| (-1e-9..=0.5 + 1e-9).contains(x)), "from {:?} to {:?}", way.first(), way.last());
    assert!(way.last().is_some_and(|x| (x - 0.5).abs() < 1e-9));
    Ok(())
}

#[test]
fn a_force_and_a_motor_of_a_table_stay_between_their_samples() {
    let folder = TestFolder::new("records-gust");
    let text = SCENE.replace("distance = LAW", "distance = { formula = \"0\" }")
        + "[[solid]]\nname = \"box\"\nshape = { box = { size = [0.2, 0.1] } }\nat = { x = 0.3, draft = \"equilibrium\" }\nfree = { density = 500.0 }\n\
           [[force]]\nname = \"gust\"\non = \"box\"\nforce = [{ file = \"record.csv\", column = 2 }, 0.0]\ntorque = { file = \"record.csv\", column = 2, scale = -2.0, time_factor = 0.5, offset = 1.0 }\n";
    fs::write(folder.join("scene.toml"), text).unwrap();
    fs::write(folder.join("record.csv"), "0,0\n1,0\n1.1,10\n1.5,0\n20,0\n").unwrap();
    let BuiltScene { setup, .. } = Scene::read(&folder, &[]).unwrap().build::<2>().unwrap();
    let gust = &setup.constraints.forces[0];
    for i in 0..=2000 {
        let t = 0.001 * f64::from(i);
        let (force, torque) = (gust.force[0].value_and_rate(t).0, gust.torque[0].value_and_rate(0.5 * t + 1.0).0);
        assert!((-1e-12..=10.0 + 1e-12).contains(&force), "{force} N at {t} s");
        assert!((torque + 2.0 * force).abs() < 1e-9, "{torque} N m at {t} s");
    }
}

#[test]
fn a_note_gives_the_spans_of_record_and_run_and_the_remedy_removes_it() {
    let rows = |start: f64, count: i32| -> String {
        std::iter::once("t_s,x_m\n".into())
            .chain(samples(start, count).map(|(t, x)| format!("{t:.2},{x:.6}\n")))
            .collect()
    };
    let law = |more: &str| format!("{{ file = \"record.csv\", column = \"x_m\"{more} }}");
    let cases = [
        (
            "late",
            rows(12.5, 31),
            Severity::Warning,
            "from 12.5 to 15.5 s of a run from 0 to 2 s, has no time in common",
            "offset = -12.5",
            ", offset = -12.5",
        ),
        (
            "short",
            rows(0.0, 11),
            Severity::Note,
            "from 0 to 1 s of a run from 0 to 2 s, ends within the run and holds its last value, 0.02",
            "until = 1",
            ", time_factor = 2.0",
        ),
        (
            "middle",
            rows(0.5, 31),
            Severity::Note,
            "begins after the run starts and holds its first value, 0",
            "offset = -0.5",
            ", offset = -0.5",
        ),
        ("past", rows(-5.0, 31), Severity::Warning, "from -5 to -2 s", "offset = 5", ", offset = 5.0"),
    ];
    for (name, record, severity, what, remedy, more) in cases {
        let with_fault = findings(&folder(name, &law(""), &record));
        let [(found, "record_span", text)] = &with_fault[..] else { panic!("{name}: {with_fault:?}") };
        assert!(*found == severity && text.contains(what) && text.contains(remedy), "{name}: {text}");
        assert!(text.contains("record.csv") && text.contains("solid.tank.driven.distance"), "{name}: {text}");
        assert_eq!(findings(&folder(name, &law(more), &record)), [], "{name} with {more}");
    }
    let milliseconds: String = std::iter::once("t_s,x_m\n".into())
        .chain(samples(0.0, 31).map(|(t, x)| format!("{:.0},{x:.6}\n", 1000.0 * t)))
        .collect();
    let found = findings(&folder("ms", &law(""), &milliseconds));
    assert!(found.len() == 1 && found[0].2.contains("time_factor = 0.001"), "{found:?}");
    assert_eq!(findings(&folder("ms", &law(", time_factor = 0.001"), &milliseconds)), []);
}

#[test]
fn an_elevation_of_uneven_samples_is_told() {
    let scene = "dimension = 2\ndp = 0.02\nuntil = 2.0\n\
        [[water]]\nfill = { box = { min = [0.0, 0.0], max = [2.0, 0.3] } }\n\
        [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [2.2, 0.6] } }\nat = { x = -0.2 }\n\
        [[solid]]\nname = \"paddle\"\nshape = { box = { size = [0.1, 0.6] } }\nat = { x = -0.05, bottom = 0.0 }\n\
        driven = { along = [1.0, 0.0], wave = { elevation = { file = \"record.csv\", column = \"eta_m\" } } }\n";
    let record = |warp: f64| {
        let rows = (0..41).map(|i| 0.05 * f64::from(i)).map(|t| {
            let t = t + warp * (3.0 * t).sin();
            format!("{t:.6},{:.6}\n", 0.02 * (5.0 * t).sin())
        });
        "t_s,eta_m\n".to_string() + &rows.collect::<String>()
    };
    let notes = |warp: f64| {
        let folder = folder("uneven", "", record(warp));
        fs::write(folder.join("scene.toml"), scene).unwrap();
        findings(&folder).into_iter().map(|(_, topic, text)| format!("{topic}: {text}")).collect::<Vec<_>>().join("; ")
    };
    assert_eq!(notes(0.0), "");
    // 40 intervals in 1.986 s.
    let found = notes(0.05);
    assert!(found.contains("record_uneven") && found.contains("every 0.0497 s"), "{found}");
    // Of waves too high or too long the unit of the record is the probable reason.
    let refused = |column: &str, factors: [f64; 2]| {
        let rows = (0..41)
            .map(|i| 0.25 * f64::from(i))
            .map(|t| format!("{:.6},{:.6}\n", t * factors[0], 0.02 * (5.0 * t).sin() * factors[1]));
        let folder = folder("wave-unit", "", format!("t_s,{column}\n{}", rows.collect::<String>()));
        fs::write(folder.join("scene.toml"), scene.replace("eta_m", column)).unwrap();
        inspected(&folder).map_or_else(|error| error.to_string(), |_| String::new())
    };
    let told = refused("eta_mm", [1.0, 1000.0]);
    assert!(told.contains("is in mm") && told.contains("scale = 0.001"), "{told}");
    let told = refused("eta_m", [1000.0, 1.0]);
    assert!(told.contains("if its times are in ms, write  time_factor = 0.001"), "{told}");
}

#[test]
fn scale_time_factor_and_offset_move_the_samples_exactly() {
    let record = "t_ms,x_mm\n0,0\n500,0\n1000,20\n2000,20\n";
    let law = "{ file = \"record.csv\", column = \"x_mm\", scale = 0.001, time_factor = 0.001, offset = 0.25 }";
    let folder = folder("scaled", law, record);
    // Samples at 0.25, 0.75, 1.25 and 2.25 s; 20 mm are 0.02 m.
    for (t, x) in [(0.0, 0.0), (0.75, 0.0), (1.25, 0.02), (2.0, 0.02)] {
        assert!((displacement(&folder, t) - x).abs() < 1e-12, "{} at {t} s", displacement(&folder, t));
    }
    let found = findings(&folder);
    assert!(found.iter().all(|(_, topic, _)| *topic != "record_unit"), "{found:?}");
}

#[test]
fn a_factor_that_is_the_inverse_of_that_of_the_unit_is_warned_of() {
    let record = "t_ms,x_mm\n0,0\n500,0\n1000,20\n2000,20\n";
    let units = |more: &str| {
        let law = format!("{{ file = \"record.csv\", column = \"x_mm\"{more} }}");
        let found = findings(&folder("inverse", &law, record)).into_iter();
        found.filter(|(_, topic, _)| *topic == "record_unit").map(|(severity, _, text)| (severity, text)).collect()
    };
    let found: Vec<(Severity, String)> = units(", scale = 1000, time_factor = 0.001");
    let [(Severity::Warning, text)] = &found[..] else { panic!("{found:?}") };
    assert!(text.contains("scale = 1000 is the inverse") && text.contains("write  scale = 0.001"), "{text}");
    let found = units(", scale = 0.001, time_factor = 1000");
    let [(Severity::Warning, text)] = &found[..] else { panic!("{found:?}") };
    assert!(text.contains("time_factor = 1000 is the inverse") && text.contains("time_factor = 0.001"), "{text}");
    // Other factors are meant.
    assert_eq!(units(", scale = -0.002, time_factor = 0.001"), []);
}

#[test]
fn a_run_and_an_inspection_note_the_layout_of_a_table_and_its_units() -> pontoon::Result<()> {
    let rows: String = samples(0.0, 31).map(|(t, x)| format!("{t:.2};{x:.6}\n").replace('.', ",")).collect();
    let folder = folder("layout", "{ file = \"record.csv\", column = 2 }", rows);
    let found = findings(&folder);
    let [(Severity::Note, "table_layout", text)] = &found[..] else { panic!("{found:?}") };
    for part in [
        "record.csv (solid.tank.driven.distance)",
        "separator semicolon",
        "decimal commas",
        "no row of names",
        "times from column 1",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let sets = [("until", "0.25")].map(|(key, value)| (key.to_string(), value.to_string()));
    let options = RunOptions { out: Some(folder.join("out")), overrides: sets.to_vec(), threads: Some(1) };
    let notes = run::run(&folder.join("scene.toml"), &options, &mut |_: &Progress| true)?.manifest.notes;
    assert!(notes.len() == 1 && notes[0].contains("separator semicolon"), "{notes:?}");
    let rows: String = samples(0.0, 31).map(|(t, x)| format!("{t:.2},{:.3}\n", 1000.0 * x)).collect();
    let folder = self::folder("unit", "{ file = \"record.csv\", column = \"x_mm\" }", format!("t_s,x_mm\n{rows}"));
    let found = findings(&folder);
    assert!(
        matches!(&found[..], [(Severity::Warning, "record_unit", text)] if text.contains("is in mm") && text.contains("scale = 0.001")),
        "{found:?}"
    );
    Ok(())
}

#[test]
fn laws_checks_and_points_of_other_layouts_are_read_and_wrong_keys_are_refused() {
    let folder = TestFolder::new("records-all");
    let text = SCENE.replace("distance = LAW", "distance = { file = \"record.csv\", column = \"Weg\" }")
        + "[[solid]]\nname = \"wedge\"\nfixed = true\nshape = { polygon = { file = \"points.txt\" } }\n\
           [[check]]\nseries = \"tank.surge_m\"\nreference = \"record.csv\"\ncolumn = \"Weg\"\noffset = 0.1\nscale = 1.0\n";
    fs::write(folder.join("scene.toml"), &text).unwrap();
    let rows: String = samples(0.0, 31).map(|(t, x)| format!("{t:.2}\t{x:.6}\r\n").replace('.', ",")).collect();
    let utf16: Vec<u8> = format!("\u{feff}Zeit\tWeg\r\n{rows}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(folder.join("record.csv"), utf16).unwrap();
    fs::write(folder.join("points.txt"), "0.2 0.0\n0.4 0.0\n0.4 0.1\n").unwrap();
    let BuiltScene { file_notes, .. } = Scene::read(&folder, &[]).unwrap().build::<2>().unwrap();
    let topics: Vec<&str> = file_notes.iter().map(|note| note.topic).collect();
    assert_eq!(topics, ["table_layout"; 3], "{file_notes:?}");
    let refused = |law: &str| {
        Scene::parse(&SCENE.replace("LAW", law), &folder, &[])
            .and_then(|s| s.build::<2>().map(|_| ()))
            .unwrap_err()
            .to_string()
    };
    for (law, part) in [
        ("{ formula = \"t\", offset = 1.0, time_factor = 2.0 }", "time_factor and offset belong to a file"),
        ("{ file = \"record.csv\", column = \"Weg\", time_factor = -1.0 }", "time_factor must be a positive number"),
        ("{ file = \"record.csv\", column = \"Weg\", scale = 0.0 }", "scale is a factor other than 0"),
        ("{ file = \"record.csv\", column = 0 }", "columns are counted from 1"),
        ("{ file = \"record.csv\", column = 3 }", "has no column 3"),
        ("{ file = \"record.csv\", column = \"weg\" }", "did you mean \"Weg\"?"),
    ] {
        assert!(refused(law).contains(part), "{law}: {}", refused(law));
    }
}

/// The warnings about units of a column of this name as the distance, the angle, the force and the torque, and of a
/// check.
fn unit_warnings(part: &str, column: &str) -> Vec<String> {
    unit_warnings_beside(part, column, "")
}

/// The same of a law with these keys beside the column.
fn unit_warnings_beside(part: &str, column: &str, keys: &str) -> Vec<String> {
    let record = format!("{{ file = \"record.csv\", column = \"{column}\"{keys} }}");
    let own = "[[solid]]\nname = \"box\"\nshape = { box = { size = [0.2, 0.1] } }\nat = { x = 0.3, draft = \"equilibrium\" }\nfree = { density = 500.0 }\n";
    let still = SCENE.replace("distance = LAW", "distance = { formula = \"0\" }");
    let text = match part {
        "distance" => SCENE.replace("LAW", &record),
        "angle" | "angle_deg" => {
            SCENE.replace("along = [1.0, 0.0], distance = LAW", &format!("hinge = [0.0, 0.0], {part} = {record}"))
        }
        "force" => format!("{still}{own}[[force]]\nname = \"f\"\non = \"box\"\nforce = [{record}, 0.0]\n"),
        "torque" => format!("{still}{own}[[force]]\nname = \"f\"\non = \"box\"\ntorque = {record}\n"),
        series => {
            format!("{still}[[check]]\nseries = \"{series}\"\nreference = \"record.csv\"\ncolumn = \"{column}\"\n")
        }
    };
    let folder = TestFolder::new("records-units");
    let rows: String = samples(0.0, 31).map(|(t, x)| format!("{t:.2},{x:.6}\n")).collect();
    fs::write(folder.join("record.csv"), format!("t_s,{column}\n{rows}")).unwrap();
    let BuiltScene { file_notes, .. } = Scene::parse(&text, &folder, &[]).unwrap().build::<2>().unwrap();
    let of_units = file_notes.into_iter().filter(|note| note.topic == "record_unit" && note.is_warning);
    of_units.map(|note| format!("{}\n{}", note.what, note.remedy)).collect()
}

#[test]
fn a_column_in_another_unit_or_of_another_quantity_is_told_with_both() {
    // Each factor by hand: 180/pi, 4.448 N in a pound-force, 9.81 N in the weight of 1 kg, 0.3048 m in a foot.
    for (part, column, told, remedy) in [
        ("distance", "x (km h-1)", "another quantity than m", "name a column in m"),
        ("distance", "x (m/s²)", "another quantity than m", "name a column in m"),
        ("angle", "x_m", "another quantity than rad", "name a column in rad"),
        ("angle_deg", "x_rad", "used as if in deg", "scale = 57.2957795"),
        ("force", "F (lb)", "a mass, where N is meant", "scale = 4.44822161"),
        (
            "force",
            "F (kg)",
            "a mass, where N is meant",
            "scale = 9.80665  beside the column; the weight of 1 kg is 9.81 N",
        ),
        ("force", "F (m/s)", "another quantity than N", "name a column in N"),
        ("torque", "M (ft-lb)", "a mass, where N m is meant", "scale = 1.355817"),
        ("torque", "M (kN-m)", "used as if in N m", "scale = 1000"),
        ("tank.pitch_deg", "pitch_rad", "used as if in deg", "scale = 57.2957795"),
        ("tank.pitch_deg", "pitch [rad]", "used as if in deg", "scale = 57.2957795"),
        ("tank.pitch_deg", "pitch (mrad)", "used as if in deg", "scale = 0.0572957795"),
        ("tank.pitch_deg", "pitch_m", "another quantity than deg", "name a column in deg"),
        ("tank.spin_radps", "w_degps", "used as if in radps", "scale = 0.0174532925"),
        ("tank.vx_mps", "v_kmh", "used as if in mps", "scale = 0.27777777"),
        ("tank.vx_mps", "v (m min-1)", "used as if in mps", "scale = 0.01666666"),
        ("tank.surge_m", "p [Pa]", "another quantity than m", "name a column in m"),
        ("tank.surge_m", "eta_inch", "used as if in m", "scale = 0.0254"),
        ("distance", "v_ms", "another quantity than m", "name a column in m"),
        ("distance", "a_ms2", "another quantity than m", "name a column in m"),
        ("distance", "zmm", "used as if in m", "scale = 0.001"),
        ("distance", "z_MM", "used as if in m", "scale = 0.001  beside the column; 1 MM is taken as 0.001 m"),
        ("force", "FX_KN", "used as if in N", "scale = 1000  beside the column; 1 KN is taken as 1000 N"),
        ("force", "fx_kN_per_m", "used as if in N", "scale = 1000"),
        ("torque", "q_Nmm", "used as if in N m", "scale = 0.001"),
    ] {
        let found = unit_warnings(part, column);
        let [text] = &found[..] else { panic!("{column} as {part}: {found:?}") };
        assert!(text.contains(told) && text.contains(remedy), "{column} as {part}: {text}");
    }
    for (part, column) in [
        ("distance", "x_m"),
        ("angle", "a_deg"),
        ("angle", "a_rad"),
        ("angle_deg", "a (deg)"),
        ("force", "F (N)"),
        ("force", "F (N/m)"),
        ("torque", "M_Nm"),
        ("force", "fx_N_per_m"),
        ("distance", "z_min"),
        ("angle", "deg"),
        ("angle", "pitch_DEG"),
        ("tank.pitch_deg", "pitch_deg"),
        ("tank.pitch_deg", "pitch (-)"),
        ("tank.vx_mps", "v (m s-1)"),
        ("tank.vx_mps", "v_ms"),
        ("tank.surge_m", "surge"),
    ] {
        assert_eq!(unit_warnings(part, column), [] as [String; 0], "{column} as {part}");
    }
}

#[test]
fn times_in_minutes_days_and_microseconds_are_told_with_the_factor() {
    for (column, factor) in
        [("time_min", "60"), ("time_hours", "3600"), ("time_days", "86400"), ("time_us", "0.000001")]
    {
        let law = format!("{{ file = \"record.csv\", column = \"x_m\", time = \"{column}\" }}");
        let rows: String = samples(0.0, 31).map(|(t, x)| format!("{t:.2},{x:.6}\n")).collect();
        let found = findings(&folder("time-unit", &law, format!("{column},x_m\n{rows}")));
        let [(Severity::Warning, "record_unit", text)] = &found[..] else { panic!("{column}: {found:?}") };
        assert!(text.contains("used as if in s") && text.contains(&format!("time_factor = {factor}")), "{text}");
    }
}

#[test]
fn degrees_that_a_scale_converts_again_are_told() {
    let warned = |part: &str, column: &str| unit_warnings_beside(part, column, ", scale = 0.0174532925");
    for (part, column) in [("angle", "pitch_deg"), ("angle_deg", "pitch")] {
        let found = warned(part, column);
        let [text] = &found[..] else { panic!("{column} as {part}: {found:?}") };
        assert!(text.contains("again by scale = 0.0174532925") && text.contains("remove scale"), "{text}");
    }
    assert_eq!(warned("angle", "pitch"), [] as [String; 0], "a column without unit is converted by its scale");
}

#[test]
fn a_missing_column_of_times_or_values_is_told_at_its_key_with_the_columns() {
    let check = "[[check]]\nseries = \"tank.surge_m\"\nreference = \"record.csv\"\ncolumn = \"x_m\"\n";
    let refused = |law: &str, more: &str, names: &str| {
        let rows: String = samples(0.0, 31).map(|(t, x)| format!("{t:.2},{x:.6}\n")).collect();
        let folder = folder("columns", law, format!("{names}\n{rows}"));
        let text = SCENE.replace("LAW", law) + more;
        let built = Scene::parse(&text, &folder, &[]).and_then(|scene| scene.build::<2>().map(|_| ()));
        built.map_or_else(|error| error.to_string(), |()| String::new())
    };
    let law = "{ file = \"record.csv\", column = \"x_m\" }";
    for name in ["seconds", "Frame"] {
        let told = refused(law, "", &format!("{name},x_m"));
        let proposal = format!("time = \"{name}\"; its columns: {name}, x_m");
        assert!(told.contains("solid.tank.driven.distance.time") && told.contains(&proposal), "{told}");
        let told = refused("{ formula = \"0\" }", check, &format!("{name},x_m"));
        assert!(told.contains("check.0.time") && told.contains(&proposal), "{told}");
    }
    // A row of names that are too many: columns go by number.
    let told = refused(law, "", "t_s,x_m,z_m");
    assert!(told.contains("3 names over rows of 2 cells") && !told.contains("\"1\""), "{told}");
    let told = refused("{ file = \"record.csv\" }", "", "t_s,x_m,z_m");
    assert!(told.contains("write  column = 2,"), "{told}");
    let told = refused("{ file = \"record.csv\" }", "", "t_s,x_m");
    assert!(told.contains("distance.column") && told.contains("write  column = \"x_m\""), "{told}");
    // The record ends at 3 s.
    let told = refused("{ formula = \"0\" }", &format!("{check}from = 5.0\n"), "t_s,x_m");
    assert!(told.contains("check.0.from") && told.contains(":21:") && told.contains("goes from 0 to 3 s"), "{told}");
    assert_eq!(refused("{ formula = \"0\" }", &format!("{check}from = 1.0\n"), "t_s,x_m"), "");
}

#[test]
fn a_check_of_an_unknown_series_and_a_scene_of_another_encoding_are_told_at_their_place() {
    let text = SCENE.replace("LAW", "{ formula = \"0\" }")
        + "[[check]]\nseries = \"tank.surge\"\nformula = \"0\"\nbound = { off = 0.1 }\n";
    let folder = TestFolder::new("records-series");
    let told = |bytes: &[u8]| {
        fs::write(folder.join("scene.toml"), bytes).unwrap();
        inspected(&folder).map_or_else(|error| error.to_string(), |_| String::new())
    };
    let unknown = told(text.as_bytes());
    for part in ["scene.toml:18:1, check.0.series", "did you mean \"tank.surge_m\"?"] {
        assert!(unknown.contains(part), "{part}: {unknown}");
    }
    let utf16: Vec<u8> = format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let bare: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    for bytes in [utf16, bare] {
        let told = told(&bytes);
        assert!(told.contains("is in UTF-16") && told.contains("save it as UTF-8"), "{told}");
    }
    // A u with two points in Windows-1252, the second character of the second line.
    let told = told(b"# a\n#\xfc\ndimension = 2\n");
    assert!(told.contains("Windows-1252") && told.contains(":2:2") && told.contains("as UTF-8"), "{told}");
}

#[test]
fn a_probe_is_set_by_its_name_without_one_of_its_own() {
    let text = SCENE.replace("LAW", "{ formula = \"0\" }");
    let folder = TestFolder::new("records-set");
    let every = |key: &str| {
        let sets = [(key.to_string(), "0.25".to_string())];
        Scene::parse(&text, &folder, &sets).map(|scene| scene.probe[0].every)
    };
    assert_eq!(every("probe.tank.every").unwrap(), Some(0.25));
    assert_eq!(every("probe.0.every").unwrap(), Some(0.25));
    let told = every("probe.tnk.every").unwrap_err().to_string();
    assert!(told.contains("did you mean \"tank\"?"), "{told}");
}
