//! Input decks of MoorDyn v2: their line types, points and lines as sections of a scene.
//!
//! Each section of a deck begins with a line of hyphens that names it. Tables have two header lines, then a row for each entry;
//! an option is a value and its name. The format is that of MoorDyn's user documentation (Hall and others, version 2).

use std::{fmt::Write as _, path::Path};

use crate::{
    error::{Error, ErrorCode, Result, suggestion},
    math::Vector,
};

/// The section of a deck in which a row stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Section {
    LineTypes,
    Points,
    Lines,
    Options,
    /// A section that a scene has in another form, or whose rows are refused.
    Other(&'static str),
    /// A section that is not known.
    Unknown,
    /// What follows the end of the deck, or stands before its first section.
    None,
}

/// Words by which the head of a section is known, in the order in which they are looked for.
const SECTIONS: [(&str, Section); 17] = [
    ("NEED THIS", Section::None),
    ("EXTERNAL", Section::Other("external loads")),
    ("LINE TYPE", Section::LineTypes),
    ("LINE DICTIONARY", Section::LineTypes),
    ("ROD TYPE", Section::Other("rod types")),
    ("ROD DICTIONARY", Section::Other("rod types")),
    ("BODIES", Section::Other("bodies")),
    ("BODY", Section::Other("bodies")),
    ("ROD", Section::Other("rods")),
    ("POINT", Section::Points),
    ("CONNECTION", Section::Points),
    ("NODE", Section::Points),
    ("FAIL", Section::Other("failures")),
    ("CONTROL", Section::Other("control")),
    ("LINE", Section::Lines),
    ("OPTION", Section::Options),
    ("OUTPUT", Section::None),
];

/// A type of line in a deck.
#[derive(Clone, Debug, PartialEq)]
struct DeckType {
    name: String,
    /// Diameter (m), mass (kg/m), EI (N m²).
    sizes: [f64; 3],
    /// EA, or the file of its table.
    stiffness: Stiffness,
    /// BA, or minus the damping ratio.
    damping: f64,
    /// Cd, Ca, CdAx, CaAx.
    coefficients: [f64; 4],
    /// Further columns, as those of vortex-induced vibrations.
    more: Vec<String>,
}

/// Axial stiffness in a deck.
#[derive(Clone, Debug, PartialEq)]
enum Stiffness {
    /// EA, N.
    Constant(f64),
    /// Rows of strain and tension, N.
    Table(Vec<[f64; 2]>),
}

/// Where a point of a deck is held.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Attachment {
    Fixed,
    Coupled,
    Free,
}

/// A point of a deck.
#[derive(Clone, Debug, PartialEq)]
struct DeckPoint {
    id: String,
    attachment: Attachment,
    /// Place, m.
    at: Vector<3>,
    /// Mass (kg), volume (m³), Cd A (m²), Ca.
    body: [f64; 4],
}

/// A line of a deck.
#[derive(Clone, Debug, PartialEq)]
struct DeckLine {
    id: String,
    kind: String,
    /// The points at its ends.
    points: [usize; 2],
    length: f64,
    segments: usize,
}

/// The lines of a deck.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Deck {
    types: Vec<DeckType>,
    points: Vec<DeckPoint>,
    lines: Vec<DeckLine>,
    /// Value and name of each option.
    options: Vec<(String, String)>,
    /// Heads of sections with rows that are not known.
    unknown: Vec<String>,
}

/// Options that a scene has as keys of a line type.
const BED_OPTIONS: [&str; 3] = ["kbot", "cbot", "FrictionCoefficient"];

/// What may precede the number of a point, beside nothing.
const POINT_WORDS: [&str; 4] = ["connection", "point", "con", "p"];

/// The number that a word of a deck is, with the exponent of Fortran (1.0D6) too.
fn number_of(word: &str) -> Option<f64> {
    let digits = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let word = if digits { word.replace(['d', 'D'], "e") } else { return None };
    word.parse().ok().filter(|x: &f64| x.is_finite())
}

/// A row of a deck, with its place for errors.
struct Row<'a> {
    file: &'a str,
    line: usize,
    section: &'a str,
    words: Vec<&'a str>,
}

impl Row<'_> {
    fn error(&self, what: impl Into<String>, help: impl Into<String>) -> Error {
        Error::scene(what).at(self.file, Some((self.line, 1)), self.section).help(help)
    }

    fn word(&self, column: usize, name: &str) -> Result<&str> {
        self.words.get(column).copied().ok_or_else(|| {
            let what = format!("this row has {} columns, and {name} is number {}", self.words.len(), column + 1);
            self.error(what, "MoorDyn v2 has the columns of its documentation in that order")
        })
    }

    fn number(&self, column: usize, name: &str) -> Result<f64> {
        self.read(self.word(column, name)?, name)
    }

    fn read(&self, word: &str, name: &str) -> Result<f64> {
        let help = if word.contains(',') { "write a decimal point" } else { "write a number" };
        number_of(word).ok_or_else(|| self.error(format!("{name} is \"{word}\", which is no number"), help))
    }

    fn positive(&self, column: usize, name: &str) -> Result<f64> {
        let number = self.number(column, name)?;
        let what = || self.error(format!("{name} is {number}"), "write a number greater than 0");
        if number > 0.0 { Ok(number) } else { Err(what()) }
    }

    fn numbers<const N: usize>(&self, first: usize, names: [&str; N]) -> Result<[f64; N]> {
        let mut made = [0.0; N];
        for (k, (x, name)) in made.iter_mut().zip(names).enumerate() {
            *x = self.number(first + k, name)?;
        }
        Ok(made)
    }
}

impl Deck {
    /// Reads a deck. Tables of stiffness are looked for in its `folder`, and `file` is its name in errors.
    ///
    /// # Errors
    /// `Scene`: names the line, what cannot be taken over, and what to do.
    pub(crate) fn parse(text: &str, file: &str, folder: &Path) -> Result<Self> {
        let mut deck = Self::default();
        let (mut section, mut heads, mut title) = (Section::None, 0, "");
        for (i, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.starts_with("---") {
                let upper = line.to_ascii_uppercase();
                let found = SECTIONS.iter().find(|(word, _)| upper.contains(word));
                let unknown = if section == Section::None { Section::None } else { Section::Unknown };
                section = found.map_or(unknown, |(_, section)| *section);
                title = line.trim_matches(|c: char| c == '-' || c.is_whitespace());
                heads = if section == Section::Options { 0 } else { 2 };
                continue;
            }
            if line.is_empty() || line.starts_with('#') || line.starts_with('!') {
                continue;
            }
            if heads > 0 {
                heads -= 1;
                continue;
            }
            let words = line.split_whitespace().collect();
            let row = Row { file, line: i + 1, section: title, words };
            match section {
                Section::LineTypes => deck.add_type(&row, folder)?,
                Section::Points => deck.add_point(&row)?,
                Section::Lines => deck.add_line(&row)?,
                Section::Options => {
                    let [value, name] = [row.word(0, "the value")?, row.word(1, "the name")?];
                    if BED_OPTIONS.iter().any(|known| known.eq_ignore_ascii_case(name)) {
                        row.read(value, name)?;
                    }
                    deck.options.push((value.into(), name.into()));
                }
                Section::Other(what) => {
                    let help = "a scene has bodies and rods as [[solid]], and the breaking load as  breaks  of a [[mooring]]: remove \
                                the section from the deck, and add them to the scene";
                    return Err(row.error(format!("{what} of a deck are not taken over"), help));
                }
                Section::Unknown if deck.unknown.iter().any(|head| head == title) => {}
                Section::Unknown => deck.unknown.push(title.into()),
                Section::None => {}
            }
        }
        if deck.lines.is_empty() {
            let what = format!("{file} has no lines");
            return Err(Error::scene(what).help("a deck of MoorDyn v2 has the sections LINE TYPES, POINTS and LINES"));
        }
        Ok(deck)
    }

    fn add_type(&mut self, row: &Row, folder: &Path) -> Result<()> {
        let new = line_type(row, folder)?;
        if self.types.iter().any(|known| file_name(&known.name) == file_name(&new.name)) {
            return Err(row.error(format!("two line types are called \"{}\"", new.name), "give each its own name"));
        }
        self.types.push(new);
        Ok(())
    }

    fn add_point(&mut self, row: &Row) -> Result<()> {
        let new = point(row)?;
        if self.points.iter().any(|known| known.id == new.id) {
            return Err(row.error(format!("two points are called \"{}\"", new.id), "give each its own number"));
        }
        self.points.push(new);
        Ok(())
    }

    fn add_line(&mut self, row: &Row) -> Result<()> {
        let kind = row.word(1, "LineType")?;
        if !self.types.iter().any(|known| known.name == kind) {
            let names = self.types.iter().map(|known| known.name.as_str());
            let what = format!("no line type is called \"{kind}\"{}", suggestion(kind, names.clone()));
            let help = format!("known: {}", names.collect::<Vec<_>>().join(", "));
            return Err(row.error(what, help).with_code(ErrorCode::UnknownName));
        }
        let end = |column: usize, name: &str| {
            let id = row.word(column, name)?;
            let lower = id.to_ascii_lowercase();
            let bare = POINT_WORDS.iter().find_map(|word| lower.strip_prefix(word)).unwrap_or(id);
            let called = |name: &str| self.points.iter().position(|point| point.id == name);
            called(id).or_else(|| called(bare)).ok_or_else(|| {
                let help = "lines end in points of the deck; ends on rods (R1A) are not taken over";
                row.error(format!("there is no point \"{id}\""), help).with_code(ErrorCode::UnknownName)
            })
        };
        let points = [end(2, "AttachA")?, end(3, "AttachB")?];
        let [length, segments] = [row.positive(4, "UnstrLen")?, row.number(5, "NumSegs")?];
        if !(segments >= 1.0 && segments.fract() == 0.0) {
            return Err(row.error(format!("NumSegs is {segments}"), "a whole number, 1 or more"));
        }
        let id = row.word(0, "ID")?.into();
        if self.lines.iter().any(|known| known.id == id) {
            return Err(row.error(format!("two lines are called \"{id}\""), "give each its own number"));
        }
        self.lines.push(DeckLine { id, kind: kind.into(), points, length, segments: segments as usize });
        Ok(())
    }

    /// The value of the last option called `known`, in any case of letters.
    fn option(&self, known: &str) -> Option<f64> {
        self.options.iter().rfind(|(_, name)| known.eq_ignore_ascii_case(name)).and_then(|(value, _)| number_of(value))
    }

    /// Number of lines that end in point number `p`.
    fn lines_at(&self, p: usize) -> usize {
        self.lines.iter().filter(|line| line.points.contains(&p)).count()
    }

    /// The sections of a scene, in which coupled points are on the solid called `solid` and the still water is at the height
    /// `level` (m).
    ///
    /// # Errors
    /// `Scene` if a free point ends one line alone, or a line ends on fixed points alone.
    pub(crate) fn to_toml(&self, solid: &str, level: f64) -> Result<String> {
        let mut text = format!("# Mooring lines of a MoorDyn deck, with still water at the height {level:?} m.\n");
        for head in &self.unknown {
            let _ = writeln!(text, "# not taken over: the section {head}");
        }
        for DeckType { name, more, .. } in self.types.iter().filter(|kind| !kind.more.is_empty()) {
            let _ = writeln!(text, "# not taken over: after CaAx of {name}: {}", more.join(" "));
        }
        for (value, name) in &self.options {
            if !BED_OPTIONS.iter().any(|known| known.eq_ignore_ascii_case(name)) {
                let _ = writeln!(text, "# not taken over: {name} = {value}");
            }
        }
        for (p, point) in self.points.iter().enumerate() {
            self.write_left_out(&mut text, p, point);
        }
        for kind in &self.types {
            self.write_type(&mut text, kind);
        }
        let place = |p: usize| self.points[p].at + Vector::from([0.0, 0.0, level]);
        let numbers = |x: Vector<3>| format!("[{:?}, {:?}, {:?}]", x[0], x[1], x[2]);
        let free = |p: &usize| self.points[*p].attachment == Attachment::Free && self.lines_at(*p) > 0;
        for p in (0..self.points.len()).filter(free) {
            let DeckPoint { id, body: [mass, volume, drag_area, added_mass], .. } = &self.points[p];
            if self.lines_at(p) < 2 {
                let help = "a free end of a line is not taken over: hold it, or add a clump to a longer line";
                return Err(Error::scene(format!("free point {id} ends one line alone")).help(help));
            }
            let _ = writeln!(text, "\n[[mooring_point]]\nname = \"point{id}\"\nat = {}", numbers(place(p)));
            let body = [("mass", mass), ("volume", volume), ("drag_area", drag_area), ("added_mass", added_mass)];
            for (word, x) in body.into_iter().filter(|(_, x)| **x != 0.0) {
                let _ = writeln!(text, "{word} = {x:?}");
            }
        }
        for line in &self.lines {
            // An end at a solid or a point comes first, an end on the ground second. If neither end is on the ground, end B comes
            // first: it is the fairlead in decks.
            let [a, b] = line.points;
            let on_ground = |p: usize| self.points[p].attachment == Attachment::Fixed;
            let [first, second] = if on_ground(b) { [a, b] } else { [b, a] };
            if on_ground(first) {
                let help = "a line without a moving end has no load to give: remove it from the deck";
                return Err(Error::scene(format!("line {} is held by two fixed points", line.id)).help(help));
            }
            let name = |p: usize| match self.points[p].attachment {
                Attachment::Fixed => None,
                Attachment::Coupled => Some(format!("\"{solid}\"")),
                Attachment::Free => Some(format!("\"point{}\"", self.points[p].id)),
            };
            let between: Vec<String> = [first, second].into_iter().filter_map(name).collect();
            let _ = writeln!(text, "\n[[mooring]]\nname = \"line{}\"\nbetween = [{}]", line.id, between.join(", "));
            for (word, p) in [("from", first), ("to", second)] {
                if self.points[p].attachment != Attachment::Free {
                    let _ = writeln!(text, "{word} = {}", numbers(place(p)));
                }
            }
            let DeckLine { length, kind, segments, .. } = line;
            let _ = writeln!(text, "length = {length:?}\nline = \"{}\"\nsegments = {segments}", file_name(kind));
        }
        Ok(text)
    }

    /// Writes the data of point number `p` that a scene does not take over: all data of a point without a line, and the body of a
    /// point that is held.
    fn write_left_out(&self, text: &mut String, p: usize, point: &DeckPoint) {
        let DeckPoint { id, attachment, body, .. } = point;
        if self.lines_at(p) == 0 {
            let _ = writeln!(text, "# not taken over: point {id}, in which no line ends");
            return;
        }
        if *attachment == Attachment::Free {
            return;
        }
        let given = ["M", "V", "CdA", "CA"].into_iter().zip(body).filter(|(_, x)| **x != 0.0);
        let given: Vec<String> = given.map(|(name, x)| format!("{name} = {x:?}")).collect();
        if !given.is_empty() {
            let whose = if *attachment == Attachment::Coupled { "; add it to the solid" } else { "" };
            let _ = writeln!(text, "# not taken over: of the {attachment:?} point {id}: {}{whose}", given.join(", "));
        }
    }

    fn write_type(&self, text: &mut String, kind: &DeckType) {
        let [diameter, mass, bending] = kind.sizes;
        let [drag, added, drag_axial, added_axial] = kind.coefficients;
        let _ = writeln!(text, "\n[[line_type]]\nname = \"{}\"\ndiameter = {diameter:?}", file_name(&kind.name));
        let _ = writeln!(text, "mass_per_length = {mass:?}");
        let _ = match &kind.stiffness {
            Stiffness::Constant(stiffness) => writeln!(text, "stiffness = {stiffness:?}"),
            Stiffness::Table(rows) => writeln!(text, "stiffness = {rows:?}"),
        };
        let _ = match kind.damping {
            damping if damping < 0.0 => writeln!(text, "damping_ratio = {:?}", -damping),
            damping => writeln!(text, "damping = {damping:?}"),
        };
        let bed = [("bed_stiffness", "kbot"), ("bed_damping", "cbot"), ("bed_friction", "FrictionCoefficient")];
        let bed = bed.map(|(word, option)| (word, self.option(option)));
        let own = [
            ("bending_stiffness", bending),
            ("drag", drag),
            ("added_mass", added),
            ("drag_axial", drag_axial),
            ("added_mass_axial", added_axial),
        ];
        let given = own.map(|(word, x)| (word, Some(x)));
        for (word, x) in given.into_iter().chain(bed).filter_map(|(word, x)| Some((word, x?))) {
            let _ = writeln!(text, "{word} = {x:?}");
        }
    }
}

/// The name of a line type with the letters that names of a scene have.
fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect()
}

fn line_type(row: &Row, folder: &Path) -> Result<DeckType> {
    let [diameter, mass] = [row.positive(1, "Diam")?, row.positive(2, "MassDen")?];
    let word = row.word(3, "EA")?;
    if word.contains('|') || row.word(4, "BA")?.contains('|') {
        let help = "write the static stiffness as EA, and one BA; viscoelastic ropes are not taken over";
        return Err(row.error(format!("EA is \"{word}\", a viscoelastic line"), help));
    }
    let is_number = number_of(word).is_some() || word.parse::<f64>().is_ok();
    let stiffness = match is_number {
        true => Stiffness::Constant(row.positive(3, "EA")?),
        false => Stiffness::Table(read_table(row, folder, word)?),
    };
    Ok(DeckType {
        name: row.word(0, "Name")?.into(),
        sizes: [diameter, mass, row.number(5, "EI")?],
        stiffness,
        damping: row.number(4, "BA/-zeta")?,
        coefficients: row.numbers(6, ["Cd", "Ca", "CdAx", "CaAx"])?,
        more: row.words.iter().skip(10).map(|word| word.to_string()).collect(),
    })
}

/// The rows of strain and tension (N) in the file `name` beside the deck.
fn read_table(row: &Row, folder: &Path, name: &str) -> Result<Vec<[f64; 2]>> {
    let text = std::fs::read_to_string(folder.join(name)).map_err(|why| {
        let help = "EA is a number (N), or the name of a file of strain and tension beside the deck";
        row.error(format!("EA is \"{name}\", which is neither a number nor a file: {why}"), help)
    })?;
    let refuse = |line: usize, what: &str| {
        let help = "after its heads a table has two numbers in each line, strain and tension (N), which both rise";
        Err(row.error(format!("EA is the table \"{name}\", whose line {line} {what}"), help))
    };
    let mut rows: Vec<[f64; 2]> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let words: Vec<&str> =
            line.split(|c: char| c.is_whitespace() || ",;".contains(c)).filter(|w| !w.is_empty()).collect();
        let numbers: Vec<f64> = words.iter().map_while(|word| number_of(word)).collect();
        let is_comment = words.is_empty() || words[0].starts_with(['#', '!']);
        match numbers[..] {
            [strain, tension] if words.len() == 2 => {
                if rows.last().is_some_and(|last| strain <= last[0] || tension < last[1]) {
                    return refuse(i + 1, "does not rise");
                }
                rows.push([strain, tension]);
            }
            // Heads have no number.
            [] if is_comment || rows.is_empty() => {}
            _ => return refuse(i + 1, "has not two numbers"),
        }
    }
    match rows.first() {
        Some([strain, tension]) if *strain > 0.0 && *tension > 0.0 => rows.insert(0, [0.0; 2]),
        Some([0.0, 0.0]) => {}
        _ => return refuse(1, "begins without the strain 0 and the tension 0"),
    }
    if rows.len() < 2 {
        return refuse(1, "is followed by no numbers");
    }
    Ok(rows)
}

fn point(row: &Row) -> Result<DeckPoint> {
    let word = row.word(1, "Attachment")?;
    let attachment = match word.to_ascii_uppercase().as_str() {
        "FIXED" | "FIX" | "ANCHOR" => Attachment::Fixed,
        "COUPLED" | "VESSEL" | "VES" | "CPLD" => Attachment::Coupled,
        "FREE" | "CONNECT" | "CON" | "POINT" => Attachment::Free,
        _ => {
            let help = "Fixed, Coupled and Free points are taken over; make points of bodies and turbines Coupled, with their world place";
            return Err(row.error(format!("a point is attached to \"{word}\""), help));
        }
    };
    Ok(DeckPoint {
        id: row.word(0, "ID")?.into(),
        attachment,
        at: Vector::from(row.numbers(2, ["X", "Y", "Z"])?),
        body: row.numbers(5, ["Mass", "Volume", "CdA", "CA"])?,
    })
}

#[cfg(test)]
#[path = "../../tests/unit/scene/moordyn.rs"]
mod tests;
