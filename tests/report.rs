    screenshot(&run.join(report::REPORT_FILE), "moored.png", &["--window-size=1280,900"]);
}

#[test]
fn a_picture_shows_mooring_lines() {
    let folder = folder("moored-picture");
    let line = "\n[[line_type]]\nname = \"chain\"\ndiameter = 0.004\nmass_per_length = 0.1\nstiffness = 500.0\n\
                [[mooring]]\nname = \"bow\"\nbetween = [\"box\"]\nfrom = [0.5, 0.3]\nto = [0.1, 0.0]\nlength = 0.55\nline = \"chain\"\n";
    // Pixels in the dark grey of outlines and lines.
    let dark = |name: &str, scene: &str| {
        run_scene(&folder, name, scene, &["--no-report"]);
        let picture = format!("{name}.png");
        let result = pontoon(&folder, &["report", name, "--png", &picture, "--by", "speed", "--range", "0,1"]);
        assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
        let pixels = Pixmap::load_png(folder.join(picture)).unwrap();
        let grey = |p: &&PremultipliedColorU8| (60..90).contains(&p.red()) && p.red().abs_diff(p.blue()) < 25;
        pixels.pixels().iter().filter(grey).count()
    };
    let (with, without) = (dark("with", &format!("{BAY}{line}")), dark("without", BAY));
    assert!(with > without + 300, "{with} pixels, {without} without the line");
}

#[test]
fn water_that_enters_is_in_the_player() {
    let folder = folder("river");
    let scene = "title = \"River\"\ndimension = 2\ndp = 0.02\nuntil = 0.4\n\
                 inflow = [{ x = 0.0, velocity = 1.0 }]\noutflow = [{ x = 0.6, velocity = 1.0 }]\n\
                 [[water]]\nfill = { box = { min = [0.0, 0.0], max = [0.6, 0.2] } }\nvelocity = [1.0, 0.0]\n\
                 [[solid]]\nname = \"bed\"\nfixed = true\nshape = { box = { size = [2.0, 0.1] } }\nat = { x = 0.3, y = -0.05 }\n\
                 [frames]\nevery = 0.1\n";
    let run = run_scene(&folder, "river", scene, &[]);
    if chromium().is_none() {
        return;
    }
    let result = evaluate(
        &run.join(report::REPORT_FILE),
        "result.first = films[0].frames[0][0].length; result.last = films[0].frames.at(-1)[0].length;",
    );
    let (first, last) = (result["first"].as_f64().unwrap(), result["last"].as_f64().unwrap());
    assert!(
        first == 300.0 && (last / first - 1.0).abs() < 0.1,
        "{first} and {last} particles, of which many have entered"
    );
}

#[test]
fn compared_runs_share_time_and_colour_range() {
    let folder = folder("compare");
    run_scene(&folder, "a", BAY, &["--no-report"]);
    run_scene(&folder, "b", BAY, &["--set", "solid.box.free.density=250", "--no-report"]);
    assert!(!folder.join("a").join(report::REPORT_FILE).exists(), "--no-report writes no report");
    let result = pontoon(&folder, &["compare", "a", "b", "--out", "both.html"]);
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
    let page = folder.join("both.html");
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.contains("solid.box.free.density") && text.contains("What differs"), "the page lists the differences");
    if chromium().is_none() {
        return;
    }
    let result = evaluate(
        &page,
        "deck.seek(0.1); result.times = deck.views.map(view => view.t); result.ranges = deck.views.map(view => view.look.range);
         result.lines = charts.all[0].what.lines.map(line => line.label);",
    );
    assert_eq!((&result["times"][0], &result["times"][1]), (&Value::from(0.1), &Value::from(0.1)));
    assert_eq!(result["ranges"][0], result["ranges"][1], "equal colour ranges");
    assert!(result["lines"].as_array().unwrap().iter().any(|line| line == "b"), "{result}");
    screenshot(&page, "both.png", &["--window-size=1280,2000"]);
}

#[test]
fn a_comparison_of_different_scenes_states_the_series_of_each_run() {
    let folder = folder("unlike");
    run_scene(&folder, "a", BAY, &["--no-report"]);
    let fronted = BAY.replace("[[probe]]\nenergy = true", "[[probe]]\nfront = true");
    run_scene(&folder, "b", &fronted, &["--no-report"]);
    run_scene(&folder, "tub", &DEEP.replace("[[probe]]", "[[probe]]\nname = \"box\""), &["--no-report"]);
    let compare = |names: &[&str], out: &str| {
        let result = pontoon(&folder, &[&["compare"][..], names, &["--out", out]].concat());
        assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
        (fs::read_to_string(folder.join(out)).unwrap(), String::from_utf8_lossy(&result.stderr).into_owned())
    };
    let (text, result) = compare(&["a", "b"], "ab.html");
    assert!(
        text.contains("Not every run has every series; only in a: energy; only in b: front."),
        "series of each run"
    );
    assert!(!result.contains("in common"), "{result}");
    let (text, _) = compare(&["a", "tub"], "flat.html");
    assert!(
        text.contains("only in a: box.spin_radps, gauge, energy; only in tub: box.z_m, box.sway_m, box.roll_deg"),
        "columns of each run"
    );
    run_scene(&folder, "ball", DEEP, &["--no-report"]);
    let (_, result) = compare(&["a", "ball"], "none.html");
    assert!(result.contains("the runs have no series in common"), "{result}");
    if chromium().is_none() {
        return;
    }
    // Series that the first run lacks are drawn as well.
    let result = evaluate(
        &folder.join("flat.html"),
        "result.charts = charts.all.map(chart => [chart.what.title, chart.what.said ?? '', chart.what.lines.length]);",
    );
    let chart = |title: &str| {
        let all = result["charts"].as_array().unwrap();
        all.iter().find(|chart| chart[0] == title).unwrap_or_else(|| panic!("{title}: {result}")).clone()
    };
    assert_eq!(chart("heave"), serde_json::json!(["heave", "", 2]));
    assert_eq!(chart("sway"), serde_json::json!(["sway", "only in tub", 1]));
    assert_eq!(chart("eta"), serde_json::json!(["eta", "only in a", 1]));
}

#[test]
fn the_rao_of_a_body_is_drawn_over_frequency() {
    let folder = folder("answers");
    let scene = format!("{BAY}\n[[statistic]]\nrao = {{ motion = \"box.heave_m\", wave = \"gauge\" }}\n");
    let run = run_scene(&folder, "bay", &scene, &["--no-report"]);
    let sections = |run: &Path| fs::read_to_string(report::write(run).unwrap().path).unwrap();
    assert!(!sections(&run).contains("<div id=\"answers\">"), "0.2 s have no waves");
    // A hundred waves of three periods; the heave of the box is twice the elevation.
    let mut tables = [
        ("gauge", String::from("t_s,level_m,eta_m")),
        ("box", String::from("t_s,x_m,y_m,surge_m,heave_m,pitch_deg,vx_mps,vy_mps,spin_radps")),
    ];
    for i in 0..4000 {
        let t = 0.05 * f64::from(i);
        let eta: f64 = [0.4, 0.5, 0.6].iter().map(|f| 0.01 * (std::f64::consts::TAU * f * t).sin()).sum();
        tables[0].1 += &format!("\n{t:?},{:?},{eta:?}", 0.3 + eta);
        tables[1].1 += &format!("\n{t:?},0.5,0.3,0.0,{:?},0.0,0.0,0.0,0.0", 2.0 * eta);
    }
    for (name, text) in tables {
        fs::write(run.join(format!("series/{name}.csv")), text + "\n").unwrap();
    }
    assert!(sections(&run).contains("<div id=\"answers\">"));
    if chromium().is_none() {
        return;
    }
    let result = evaluate(
        &run.join(report::REPORT_FILE),
        "result.all = charts.all.filter(chart => chart.what.title.startsWith('rao'))
           .map(({ what }) => [what.title, what.unit, what.lines[0].label, Math.min(...what.lines[0].x), Math.max(...what.lines[0].x)]);",
    );
    let expected = [("ratio", "m/m", 2.0), ("phase", "°", 0.0), ("coherence", "–", 1.0)];
    for ((what, unit, value), chart) in expected.into_iter().zip(result["all"].as_array().unwrap()) {
        assert_eq!(chart[0], format!("rao · {what}"));
        assert!(chart[1] == unit && chart[2] == "box heave", "{chart}");
        // Heave is a multiple of the wave, so the RAO is that multiple at every frequency, in single precision.
        let off = |end: usize| (chart[end].as_f64().unwrap() - value).abs();
        assert!(off(3) < 1e-5 && off(4) < 1e-5, "{chart}");
    }
    assert_eq!(result["all"].as_array().unwrap().len(), 3);
}

#[test]
fn a_picture_has_a_column_for_each_run_and_a_row_for_each_time() {
    let folder = folder("picture");
    run_scene(&folder, "a", BAY, &["--no-report"]);
    let result = pontoon(&folder, &["compare", "a", "a", "--png", "fields.png", "--time", "0,0.2", "--width", "900"]);
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
    let (two, path) = (Pixmap::load_png(folder.join("fields.png")).unwrap(), folder.join("one.png"));
    assert_eq!(two.width(), 900);
    let result = pontoon(&folder, &["report", "a", "--png", "one.png", "--by", "speed", "--range", "0,1"]);
    assert!(result.status.success() && path.is_file(), "{}", String::from_utf8_lossy(&result.stderr));
    // The same run twice: both columns show the same water.
    let dark = |from: u32, to: u32| {
        let inside = (from..to).flat_map(|x| (0..two.height()).map(move |y| (x, y)));
        inside
            .filter(|&(x, y)| two.pixel(x, y).is_some_and(|p| p.blue() > 70 && p.red() < 80 && p.green() < 160))
            .count()
    };
    let (left, right) = (dark(0, 450), dark(450, 900));
    assert!(left > 5000 && (left as f64 / right as f64 - 1.0).abs() < 0.15, "{left} and {right} pixels of water");
    let result = pontoon(&folder, &["report", "a", "--time", "1"]);
    assert!(!result.status.success(), "--time needs --png");
}

#[test]
fn a_study_draws_the_fields_of_its_variants_side_by_side() {
    let folder = folder("study");
    fs::write(folder.join("bay.toml"), BAY).unwrap();
    let plain = ["study", "bay.toml", "--vary", "model.diffusion=none,fourtakas", "--out", "s", "--quiet"];
    let study = |more: &[&str]| {
        let result = pontoon(&folder, &[&plain[..], more].concat());
        assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
        String::from_utf8(result.stdout).unwrap()
    };
    let run = folder.join("s/runs/dp-0.02_diffusion-none");
    study(&[]);
    assert!(!run.join("frames.pvd").exists(), "a study writes no frames by default");
    // A run without frames is repeated with frames and has the same readings.
    let series = |run: &str| fs::read(folder.join(run).join("series/box.csv")).unwrap();
    let result = study(&["--png", "s/both.png", "--time", "0.1,0.2", "--width", "900"]);
    let both = Pixmap::load_png(folder.join("s/both.png")).unwrap();
    assert!(result.contains(&format!("both.png: 900 × {} pixels", both.height())), "{result}");
    assert_eq!(series("s/runs/dp-0.02_diffusion-none"), series("s/runs/dp-0.02_diffusion-none.old"));
    // A column for each variant: both halves show the same amount of water.
    let coloured = |from: u32, to: u32| {
        let inside = (from..to).flat_map(|x| (0..both.height()).map(move |y| (x, y)));
        let grey = |p: PremultipliedColorU8| p.red().abs_diff(p.blue()) < 40 && p.red().abs_diff(p.green()) < 40;
        inside.filter(|&(x, y)| both.pixel(x, y).is_some_and(|p| !grey(p))).count() as f64
    };
    let (left, right) = (coloured(0, 450), coloured(450, 900));
    assert!(left > 5000.0 && (left / right - 1.0).abs() < 0.15, "{left} and {right} pixels of water");
    // A row for each time; existing frames are drawn without another run.
    study(&["--png", "s/one.png", "--time", "0.2", "--width", "900"]);
    let one = Pixmap::load_png(folder.join("s/one.png")).unwrap();
    assert!(one.height() < both.height() && !folder.join("s/runs/dp-0.02_diffusion-none.old-2").exists());
    for (file, time, part) in [("no/x.png", "0.1", "no folder"), ("x.png", "0.3", "end at 0.2 s")] {
        let result = pontoon(&folder, &[&plain[..], &["--png", file, "--time", time]].concat());
        assert!(!result.status.success() && String::from_utf8_lossy(&result.stderr).contains(part), "{result:?}");
    }
}

/// A fault as a step check reports it.
fn fault() -> Error {
    let fault = Fault {
        code: ErrorCode::LeftDomain,
        reason: "the water has left".into(),
        who: "water particle 12".into(),
        step: 7,
        time: 0.01,
        position: vec![0.1, 0.2],
        velocity: vec![30.0, 0.0],
        density: Some(1010.0),
        cause: "too long a step: shorten the step".into(),
    };
    let mut error = Error::new(ErrorKind::Fault, "the water has left the domain");
    error.fault = Some(Box::new(fault));
    error
}

#[test]
fn the_report_of_a_failed_or_unfinished_run_states_its_status() {
    let folder = folder("fails");
    let run = run_scene(&folder, "bay", BAY, &["--no-report"]);
    let mut manifest = Manifest::read(&run).unwrap();
    manifest.status = RunStatus::Running;
    manifest.write(&run).unwrap();
    let page_text = |run: &Path| {
        let page = report::write(run).unwrap();
        assert!(page.bytes < report::MAX_PAGE_BYTES);
        fs::read_to_string(page.path).unwrap()
    };
    assert!(page_text(&run).contains("This run has not finished"));
    let result = pontoon(&folder, &["report", "nowhere"]);
    assert!(!result.status.success() && String::from_utf8_lossy(&result.stderr).contains("holds no run"));
    manifest.record_failure(&fault());
    manifest.notes = vec!["waves.csv is read so: separator tab".into()];
    manifest.events = vec!["rope \"line\" breaks at 0.5 s".into()];
    manifest.write(&run).unwrap();
    let text = page_text(&run);
    let words = ["This run could not go on", "the water has left", "shorten the step", "separator tab"];
    for word in words.into_iter().chain(["rope &quot;line&quot; breaks at 0.5 s"]) {
        assert!(text.contains(word), "{word:?} is not on the page");
    }
}

#[test]
fn a_report_loads_no_external_resource_and_a_missing_scene_is_a_remark() {
    let folder = folder("lost");
    let run = run_scene(&folder, "bay", BAY, &["--no-report"]);
    fs::remove_dir_all(run.join("scene")).unwrap();
    let page = report::write(&run).unwrap();
    assert!(page.remarks.iter().any(|remark| remark.contains("bodies and gauges are not drawn")), "{:?}", page.remarks);
    let text = fs::read_to_string(page.path).unwrap();
    for word in ["src=", "@import", "url(", "fetch(", "XMLHttpRequest", "href=\"http"] {
        assert!(!text.contains(word), "{word:?} is on the page");
    }
}
