use super::*;
use crate::scene::Scene;

/// Three lines: two from anchors to a clump, and one from there to the vessel.
const DECK: &str = "\
--------------------- MoorDyn Input File ------------------------------------
A bridle with a clump
---------------------- LINE TYPES -----------------------------------
TypeName   Diam     MassDen   EA        BA/-zeta   EI     Cd     Ca    CdAx   CaAx
(name)     (m)      (kg/m)    (N)       (N-s/-)    (N-m2) (-)    (-)   (-)    (-)
main       0.0252   39.0      1.674e6   -0.8       0.0    1.37   1.0   0.204  0.1
hawser     0.0500   2.5       4.0e5     1.2e3      0.0    1.2    0.9   0.0    0.0
---------------------- POINTS ---------------------------------------
ID  Attachment   X      Y      Z      M     V      CdA   CA
(#) (-)          (m)    (m)    (m)    (kg)  (m^3)  (m^2) (-)
1   Fixed       -20.0   10.0  -15.0   0     0      0     0
2   Fixed       -20.0  -10.0  -15.0   0     0      0     0
3   Free         -8.0    0.0  -10.0   120   0.05   0.3   0.5
4   Coupled       0.0    0.0   -1.0   0     0      0     0
---------------------- LINES ----------------------------------------
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#) (name)    (#)      (#)      (m)       (-)      (-)
1   main      1        3        17.5      12       p
2   main      2        3        17.5      12       -
3   hawser    3        4        12.0      8        -
---------------------- OPTIONS --------------------------------------
0.001    dtM           time step of the lines
1e5      kbot          bed stiffness
1e4      cbot          bed damping
0.5      FrictionCoefficient
15.0     WtrDpth       water depth
---------------------- OUTPUTS --------------------------------------
FairTen3
------------------------- need this line --------------------------------------
";

/// A tank with a box on which the deck's coupled point is.
const SCENE: &str = r#"
dimension = 3
dp = 1.0
until = 1.0
water = [{ fill = { box = { min = [-22.0, -12.0, 0.0], max = [6.0, 12.0, 15.0] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [28.0, 24.0, 20.0] } }
at = { x = -22.0, y = -12.0 }
[[solid]]
name = "float"
shape = { box = { size = [6.0, 6.0, 4.0] } }
at = { x = 0.0, y = 0.0, bottom = 13.0 }
free = { density = 500.0 }
"#;

fn parsed(text: &str) -> Result<Deck> {
    Deck::parse(text, "lines.txt", Path::new(""))
}

#[test]
fn a_deck_of_three_lines_becomes_a_scene() {
    let sections = parsed(DECK).and_then(|deck| deck.to_toml("float", 15.0)).unwrap();
    let scene =
        Scene::parse(&format!("{SCENE}\n{sections}"), Path::new(""), &[]).unwrap_or_else(|e| panic!("{e}\n{sections}"));
    let [main, hawser] = &scene.line_type[..] else { panic!("{sections}") };
    assert_eq!((main.name.as_str(), main.diameter, main.mass_per_length), ("main", 0.0252, 39.0));
    assert_eq!((main.damping, main.damping_ratio), (None, Some(0.8)));
    assert_eq!((hawser.damping, hawser.damping_ratio), (Some(1200.0), None));
    assert_eq!([main.drag, main.added_mass, main.drag_axial, main.added_mass_axial], [1.37, 1.0, 0.204, 0.1].map(Some));
    assert_eq!([main.bed_stiffness, main.bed_damping, main.bed_friction], [1e5, 1e4, 0.5].map(Some));
    let point = &scene.mooring_point[0];
    assert_eq!((point.name.as_str(), &point.at[..]), ("point3", &[-8.0, 0.0, 5.0][..]));
    assert_eq!([point.mass, point.volume, point.drag_area, point.added_mass], [120.0, 0.05, 0.3, 0.5].map(Some));
    let lines: Vec<_> = scene.mooring.iter().map(|line| (line.name.as_str(), &line.between[..], line.length)).collect();
    let [joint, both] = [["point3".to_string()].to_vec(), ["float".to_string(), "point3".to_string()].to_vec()];
    assert_eq!(lines, [("line1", &joint[..], 17.5), ("line2", &joint[..], 17.5), ("line3", &both[..], 12.0)]);
    assert_eq!(scene.mooring[0].to, [-20.0, 10.0, 0.0], "the anchor is on the bottom");
    assert_eq!(scene.mooring[2].from, [0.0, 0.0, 14.0], "the fairlead is on the float");
    assert!(scene.mooring[0].from.is_empty() && scene.mooring[2].to.is_empty());
    assert!(sections.contains("# not taken over: WtrDpth = 15.0") && !sections.contains("kbot"));
}

/// The text that the sections give is the same after a second passage through the scene.
#[test]
fn the_sections_survive_a_round_trip() {
    let deck = parsed(DECK).unwrap();
    let read = |text: &str| Scene::parse(&format!("{SCENE}\n{text}"), Path::new(""), &[]).unwrap();
    let once = read(&deck.to_toml("float", 15.0).unwrap());
    let again = Scene::parse(&once.to_toml().unwrap(), Path::new(""), &[]).unwrap();
    assert_eq!(
        (&once.line_type, &once.mooring_point, &once.mooring),
        (&again.line_type, &again.mooring_point, &again.mooring)
    );
}

/// What a deck has and a scene does not is refused with its line.
#[test]
fn what_cannot_be_taken_over_is_refused() {
    let message = |from: &str, to: &str| {
        assert!(DECK.contains(from), "{from}");
        let made = parsed(&DECK.replacen(from, to, 1)).and_then(|deck| deck.to_toml("float", 15.0));
        made.err().unwrap_or_else(|| panic!("{to} is accepted")).to_string()
    };
    let near = message("3   hawser    3", "3   hauser    3");
    assert!(near.contains("hawser") && near.contains("lines.txt:20"), "{near}");
    assert!(message("1        3        17.5", "R1A      3        17.5").contains("R1A"));
    assert!(message("4   Coupled ", "4   Body1   ").contains("Body1"));
    assert!(message("1.674e6 ", "1e6|2e6 ").contains("viscoelastic"));
    assert!(message("1.674e6 ", "rope.dat").contains("rope.dat"));
    assert!(message("0.0252   39.0", "0.0252   x").contains("MassDen"));
    assert!(message("3   hawser    3        4", "3   hawser    1        2").contains("two fixed points"));
    let rods =
        DECK.replacen("---------------------- OPTIONS", "------- RODS ------\nID\n(-)\n1 rod\n------ OPTIONS", 1);
    assert!(parsed(&rods).err().unwrap().to_string().contains("rods"));
    assert!(parsed("no deck").err().unwrap().to_string().contains("no lines"));
}

/// Numbers as Fortran writes them are read; what a scene has no place for is told; what has no meaning is refused.
#[test]
fn no_part_of_a_deck_is_lost_without_a_word() {
    let sections = |deck: &str| parsed(deck).and_then(|deck| deck.to_toml("float", 15.0));
    let with = |more: &str| {
        DECK.replacen("---------------------- OPTIONS", &format!("{more}\n---------------------- OPTIONS"), 1)
    };
    let fortran = DECK.replacen("1e5      kbot", "3.0D6    kbot", 1);
    assert_ne!(fortran, DECK);
    assert!(sections(&fortran).unwrap().contains("bed_stiffness = 3000000.0"));
    let error = sections(&DECK.replacen("0.5      Friction", "0,5      Friction", 1)).unwrap_err();
    assert!(error.to_string().contains("decimal point"), "{error}");
    let told = sections(&with("------- SYNTHETIC ROPES ------\na\nb\nrope 1 2 3")).unwrap();
    assert!(told.contains("# not taken over: the section SYNTHETIC ROPES"), "{told}");
    assert!(sections(&DECK.replacen("1.674e6 ", "inf ", 1)).unwrap_err().to_string().contains("EA"));
    // The body of a free point becomes keys of it; that of a held one has none.
    let heavy = DECK.replacen("-1.0   0     0      0     0", "-1.0   500   0.2    0     0", 1);
    let told = sections(&heavy).unwrap();
    assert!(told.contains("# not taken over: of the Coupled point 4: M = 500.0, V = 0.2"), "{told}");
    let anchor = DECK.replacen("-20.0   10.0  -15.0   0 ", "-20.0   10.0  -15.0   70 ", 1);
    let told = sections(&anchor).unwrap();
    assert!(told.contains("# not taken over: of the Fixed point 1: M = 70.0\n"), "{told}");
    let idle = DECK.replacen("---------------------- LINES", "5 Free 1 1 -1 7 0 0 0\n---------------------- LINES", 1);
    assert!(sections(&idle).unwrap().contains("# not taken over: point 5, in which no line ends"));
    assert!(!sections(DECK).unwrap().contains("over: of the"), "the points of the deck are taken over whole");
    let points = DECK.replacen("3   hawser    3", "3   hawser    Point3", 1);
    assert_eq!(sections(&points), sections(DECK), "Point3 is point 3");
}

#[test]
fn a_table_of_stiffness_is_read_whole_or_refused() {
    let folder = std::env::temp_dir().join(format!("pontoon-moordyn-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let deck = DECK.replacen("1.674e6 ", "rope.dat", 1);
    let read = |table: &str| {
        std::fs::write(folder.join("rope.dat"), table).unwrap();
        Deck::parse(&deck, "lines.txt", &folder).and_then(|deck| deck.to_toml("float", 15.0))
    };
    let rows = "stiffness = [[0.0, 0.0], [0.01, 1000000.0], [0.02, 3000000.0]]";
    for table in
        ["strain tension\n(-) (N)\n0 0\n1.0D-2 1e6\n0.02 3e6\n", "strain,tension\n0.0,0.0\n0.01,1e6\n0.02,3e6\n"]
    {
        let sections = read(table).unwrap();
        assert!(sections.contains(rows), "{sections}");
    }
    for (table, line) in [
        ("0 0\n0.01 x\n0.02 3e6\n", "line 2"),
        ("0 0\n0.01 1e6\n0.005 2e6\n", "line 3"),
        ("-0.01 0\n0 1e5\n", "line 1"),
    ] {
        let error = read(table).unwrap_err().to_string();
        assert!(error.contains(line), "{error}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}
