//! Parses the text of a formula into a tree. An error names the place that cannot be read.

use super::{Binary, CHOICES, FUNCTIONS, Node};
use crate::error::{Error, Result, suggestion};

/// Deepest nesting of brackets, signs and powers.
const DEPTH: usize = 64;

/// Longest formula, bytes: with [`DEPTH`] it bounds the depth of the tree.
const LENGTH: usize = 1000;

/// Reads a formula of the variables called `names`.
pub(super) fn read(text: &str, names: &'static [&'static str]) -> Result<Node> {
    let mut reader = Reader { text, names, place: 0, depth: 0 };
    if text.len() > LENGTH {
        return Err(reader.wrong(format!("it is longer than {LENGTH} characters")));
    }
    let root = reader.sum()?;
    match reader.peek() {
        None => Ok(root),
        Some(c) => Err(reader.wrong(format!("an operator is expected before '{c}'"))),
    }
}

/// Reads a formula from left to right.
struct Reader<'a> {
    text: &'a str,
    /// Names of the variables.
    names: &'static [&'static str],
    place: usize,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn sum(&mut self) -> Result<Node> {
        let mut left = self.product()?;
        loop {
            let binary = match self.peek() {
                Some('+') => Binary::Add,
                Some('-') => Binary::Subtract,
                _ => return Ok(left),
            };
            self.place += 1;
            left = Node::Binary(binary, Box::new(left), Box::new(self.product()?));
        }
    }

    fn product(&mut self) -> Result<Node> {
        let mut left = self.signed()?;
        loop {
            let binary = match self.peek() {
                Some('*') => Binary::Multiply,
                Some('/') => Binary::Divide,
                _ => return Ok(left),
            };
            self.place += 1;
            left = Node::Binary(binary, Box::new(left), Box::new(self.signed()?));
        }
    }

    /// A power, or one with a sign before it: so −t² is −(t²), and 2⁻ᵗ is read too.
    fn signed(&mut self) -> Result<Node> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.wrong(format!("it is nested more than {DEPTH} deep")));
        }
        let node = match self.peek() {
            Some(sign @ ('+' | '-')) => {
                self.place += 1;
                let inner = self.signed()?;
                if sign == '-' { Node::Negate(Box::new(inner)) } else { inner }
            }
            _ => {
                let base = self.atom()?;
                if self.peek() == Some('^') {
                    self.place += 1;
                    Node::Binary(Binary::Power, Box::new(base), Box::new(self.signed()?))
                } else {
                    base
                }
            }
        };
        self.depth -= 1;
        Ok(node)
    }

    fn atom(&mut self) -> Result<Node> {
        match self.peek() {
            Some('(') => {
                self.place += 1;
                let inner = self.sum()?;
                self.take(')')?;
                Ok(inner)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.word(),
            Some(c) => {
                Err(self.wrong(format!("a number, {} or a function is expected before '{c}'", self.names.join(", "))))
            }
            None => {
                Err(self.wrong(format!("it ends where a number, {} or a function is expected", self.names.join(", "))))
            }
        }
    }

    fn number(&mut self) -> Result<Node> {
        let rest = &self.text[self.place..];
        let digits = |from: usize| from + rest[from..].bytes().take_while(|b| b.is_ascii_digit() || *b == b'.').count();
        let mut end = digits(0);
        if rest[end..].starts_with(['e', 'E']) {
            let sign = usize::from(rest[end + 1..].starts_with(['+', '-']));
            let power = digits(end + 1 + sign);
            end = if power > end + 1 + sign { power } else { end };
        }
        let number = rest[..end].parse().map_err(|_| self.wrong(format!("\"{}\" is not a number", &rest[..end])))?;
        self.place += end;
        Ok(Node::Number(number))
    }

    fn word(&mut self) -> Result<Node> {
        let rest = &self.text[self.place..];
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let word = &rest[..end];
        let variable = self.names.iter().position(|name| *name == word).map(Node::Variable);
        let constant = (word == "pi").then_some(Node::Number(std::f64::consts::PI));
        if let Some(node) = variable.or(constant) {
            self.place += end;
            return Ok(node);
        }
        let function = FUNCTIONS.iter().find(|(name, _)| *name == word);
        let choice = CHOICES.iter().find(|(name, _)| *name == word);
        if function.is_none() && choice.is_none() {
            return Err(self.wrong(format!("\"{word}\" is not known{}", suggestion(word, self.known()))));
        }
        self.place += end;
        self.take('(')?;
        let first = Box::new(self.sum()?);
        let node = match (function, choice) {
            (Some((_, function)), _) => Node::Call(*function, first),
            (None, Some((_, binary))) => {
                self.take(',')?;
                Node::Binary(*binary, first, Box::new(self.sum()?))
            }
            (None, None) => *first,
        };
        self.take(')')?;
        Ok(node)
    }

    /// The next character that is not blank.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.place..];
        self.place += rest.len() - rest.trim_start().len();
        self.text[self.place..].chars().next()
    }

    fn take(&mut self, wanted: char) -> Result<()> {
        match self.peek() {
            Some(c) if c == wanted => {
                self.place += c.len_utf8();
                Ok(())
            }
            Some(c) => Err(self.wrong(format!("'{wanted}' is expected before '{c}'"))),
            None => Err(self.wrong(format!("it ends where '{wanted}' is expected"))),
        }
    }

    fn wrong(&self, what: impl std::fmt::Display) -> Error {
        let column = self.text[..self.place].chars().count() + 1;
        let known = self.known().collect::<Vec<_>>().join(", ");
        let example = match self.names {
            ["t"] => "of the time t (s), such as 0.05*sin(2*pi*t/1.2)",
            _ => "of the place (m), such as 0.1*sin(2*pi*x)*cos(2*pi*y)",
        };
        Error::scene(format!(
            "formula \"{}\", character {column}: {what}",
            self.text.chars().take(80).collect::<String>()
        ))
        .help(format!("write a formula {example}\nknown: + - * / ^ ( ), {known}"))
    }

    fn known(&self) -> impl Iterator<Item = &'static str> + use<> {
        let words = FUNCTIONS.iter().map(|f| f.0).chain(CHOICES.iter().map(|c| c.0));
        self.names.iter().copied().chain(["pi"]).chain(words)
    }
}
