//! A formula of a scene in the time t, or in the place x, y, z: its value and, by the chain rule, its exact derivative with
//! respect to the first variable.
//!
//! Usual precedence: −t^2 is −(t²), 2^3^2 is 2^(3²), 2e-3 is a number. Every node is evaluated as the pair (x, dx/dt), which
//! needs neither symbolic differentiation nor an approximation.

mod parser;

use crate::{error::Result, math::Vector};
use parser::read;

/// A formula in the time t (s): numbers, `t`, `pi`, `+ - * / ^`, brackets and the usual functions.
///
/// ```
/// # use pontoon::math::expression::Formula;
/// let heave = Formula::parse("0.05*sin(2*pi*t/1.2)")?;
/// let (value, rate) = heave.value_and_rate(0.0);
/// assert_eq!(value, 0.0);
/// assert!((rate - 0.05 * std::f64::consts::TAU / 1.2).abs() < 1e-15);
/// # Ok::<(), pontoon::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Formula {
    root: Node,
}

/// A function of one number: its value and its derivative there.
type Function = fn(f64) -> (f64, f64);

#[derive(Clone, Debug)]
enum Node {
    Number(f64),
    /// The i-th variable of the formula.
    Variable(usize),
    Negate(Box<Node>),
    Binary(Binary, Box<Node>, Box<Node>),
    Call(Function, Box<Node>),
}

#[derive(Clone, Copy, Debug)]
enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Min,
    Max,
}

const FUNCTIONS: [(&str, Function); 14] = [
    ("sin", |x| (x.sin(), x.cos())),
    ("cos", |x| (x.cos(), -x.sin())),
    ("tan", |x| (x.tan(), 1.0 + x.tan().powi(2))),
    ("asin", |x| (x.asin(), 1.0 / (1.0 - x * x).sqrt())),
    ("acos", |x| (x.acos(), -1.0 / (1.0 - x * x).sqrt())),
    ("atan", |x| (x.atan(), 1.0 / (1.0 + x * x))),
    ("sinh", |x| (x.sinh(), x.cosh())),
    ("cosh", |x| (x.cosh(), x.sinh())),
    ("tanh", |x| (x.tanh(), 1.0 - x.tanh().powi(2))),
    ("exp", |x| (x.exp(), x.exp())),
    ("ln", |x| (x.ln(), 1.0 / x)),
    ("log10", |x| (x.log10(), 1.0 / (x * std::f64::consts::LN_10))),
    ("sqrt", |x| (x.sqrt(), 0.5 / x.sqrt())),
    ("abs", |x| (x.abs(), if x < 0.0 { -1.0 } else { 1.0 })),
];

/// Functions of two numbers.
const CHOICES: [(&str, Binary); 2] = [("min", Binary::Min), ("max", Binary::Max)];

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// `Scene` if it cannot be read: says what is wrong, at which character, and which words are known.
    pub fn parse(text: &str) -> Result<Self> {
        read(text, &["t"]).map(|root| Self { root })
    }

    /// The formula that is `x` at all times.
    pub(crate) fn constant(x: f64) -> Self {
        Self { root: Node::Number(x) }
    }

    /// Whether the formula is without `t`.
    pub(crate) fn is_constant(&self) -> bool {
        self.root.is_constant()
    }

    /// Value and rate (1/s) at time `t` (s). Not finite where the formula is not, as 1/t at 0.
    pub fn value_and_rate(&self, t: f64) -> (f64, f64) {
        self.root.evaluate(&[t])
    }
}

/// A formula in the place: x and y (m), in 3-D also z.
///
/// ```
/// # use pontoon::math::expression::ScalarField;
/// let swirl = ScalarField::<2>::parse("-sin(pi*x)*cos(pi*y)")?;
/// assert_eq!(swirl.value_at(&[0.5, 0.0].into()), -1.0);
/// # Ok::<(), pontoon::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ScalarField<const D: usize> {
    root: Node,
}

impl<const D: usize> ScalarField<D> {
    /// Reads a formula.
    ///
    /// # Errors
    /// As [`Formula::parse`].
    pub fn parse(text: &str) -> Result<Self> {
        read(text, &["x", "y", "z"][..D]).map(|root| Self { root })
    }

    /// Value at the place `r` (m).
    pub fn value_at(&self, r: &Vector<D>) -> f64 {
        self.root.evaluate(r.as_slice()).0
    }
}

/// A formula in the place and the time: x and y (m), in 3-D also z, and t (s).
///
/// ```
/// # use pontoon::math::expression::UnsteadyField;
/// let gust = UnsteadyField::<2>::parse("0.2*y*sin(pi*t)")?;
/// assert_eq!(gust.value_at(&[0.5, 1.0].into(), 0.5), 0.2);
/// # Ok::<(), pontoon::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct UnsteadyField<const D: usize> {
    root: Node,
}

impl<const D: usize> UnsteadyField<D> {
    /// Reads a formula.
    ///
    /// # Errors
    /// As [`Formula::parse`].
    pub fn parse(text: &str) -> Result<Self> {
        let names: &[&str] = if D == 2 { &["x", "y", "t"] } else { &["x", "y", "z", "t"] };
        read(text, names).map(|root| Self { root })
    }

    /// Whether the field is the same everywhere and at all times.
    pub(crate) fn is_constant(&self) -> bool {
        self.root.is_constant()
    }

    /// Whether the formula contains the time.
    pub(crate) fn changes_in_time(&self) -> bool {
        self.root.reads(D)
    }

    /// The field that is `value` everywhere, at all times.
    pub fn constant(value: f64) -> Self {
        Self { root: Node::Number(value) }
    }

    /// Value at the place `r` (m) and the time `t` (s).
    pub fn value_at(&self, r: &Vector<D>, t: f64) -> f64 {
        let mut variables = [t; 4];
        variables[..D].copy_from_slice(r.as_slice());
        self.root.evaluate(&variables[..=D]).0
    }
}

impl Node {
    /// Whether the formula contains variable number `i`.
    fn reads(&self, i: usize) -> bool {
        match self {
            Self::Number(_) => false,
            Self::Variable(own) => *own == i,
            Self::Negate(x) | Self::Call(_, x) => x.reads(i),
            Self::Binary(_, x, y) => x.reads(i) || y.reads(i),
        }
    }

    fn is_constant(&self) -> bool {
        match self {
            Self::Number(_) => true,
            Self::Variable(_) => false,
            Self::Negate(x) | Self::Call(_, x) => x.is_constant(),
            Self::Binary(_, x, y) => x.is_constant() && y.is_constant(),
        }
    }

    fn evaluate(&self, t: &[f64]) -> (f64, f64) {
        match self {
            Self::Number(x) => (*x, 0.0),
            Self::Variable(i) => (t[*i], if *i == 0 { 1.0 } else { 0.0 }),
            Self::Negate(x) => {
                let (x, dx) = x.evaluate(t);
                (-x, -dx)
            }
            Self::Binary(binary, x, y) => binary.evaluate(x.evaluate(t), y.evaluate(t)),
            Self::Call(function, x) => {
                let (x, dx) = x.evaluate(t);
                let (value, slope) = function(x);
                (value, if dx == 0.0 { 0.0 } else { slope * dx })
            }
        }
    }
}

impl Binary {
    fn evaluate(self, (x, dx): (f64, f64), (y, dy): (f64, f64)) -> (f64, f64) {
        match self {
            Self::Add => (x + y, dx + dy),
            Self::Subtract => (x - y, dx - dy),
            Self::Multiply => (x * y, dx * y + x * dy),
            Self::Divide => (x / y, (dx - x / y * dy) / y),
            Self::Power => {
                let base = if dx == 0.0 || y == 0.0 { 0.0 } else { y * x.powf(y - 1.0) * dx };
                let exponent = if dy == 0.0 { 0.0 } else { x.powf(y) * x.ln() * dy };
                (x.powf(y), base + exponent)
            }
            // The extreme of a value and no value is no value.
            Self::Min => {
                if y < x || y.is_nan() {
                    (y, dy)
                } else {
                    (x, dx)
                }
            }
            Self::Max => {
                if y > x || y.is_nan() {
                    (y, dy)
                } else {
                    (x, dx)
                }
            }
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/math/expression.rs"]
mod tests;
