//! A number that records the operations on it. An equation that is evaluated with such numbers becomes a [`Trace`], the list of
//! its operations. A trace gives the text of a program for another machine, or is evaluated in double precision.

use std::{
    cell::RefCell,
    collections::HashMap,
    ops::{Add, Div, Mul, Neg, Sub},
};

use super::Num;

/// One operation; its operands are places in the trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// The n-th input.
    Input(u32),
    /// A constant, by the bits of its double precision.
    Constant(u64),
    /// a + b.
    Add(u32, u32),
    /// a − b.
    Sub(u32, u32),
    /// a·b.
    Mul(u32, u32),
    /// a/b.
    Div(u32, u32),
    /// −a.
    Neg(u32),
    /// |a|.
    Abs(u32),
    /// a·b + c.
    Fma(u32, u32, u32),
    /// √a.
    Sqrt(u32),
    /// The larger.
    Max(u32, u32),
    /// The smaller.
    Min(u32, u32),
    /// The third where the first is below the second, else the fourth.
    SelectBelow(u32, u32, u32, u32),
}

impl Operation {
    /// Its operands.
    pub fn operands(self) -> impl Iterator<Item = u32> {
        let (count, all) = match self {
            Self::Input(_) | Self::Constant(_) => (0, [0; 4]),
            Self::Neg(a) | Self::Abs(a) | Self::Sqrt(a) => (1, [a, 0, 0, 0]),
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Max(a, b)
            | Self::Min(a, b) => (2, [a, b, 0, 0]),
            Self::Fma(a, b, c) => (3, [a, b, c, 0]),
            Self::SelectBelow(a, b, c, d) => (4, [a, b, c, d]),
        };
        all.into_iter().take(count)
    }

    /// Whether a machine computes something for it.
    pub fn is_arithmetic(self) -> bool {
        !matches!(self, Self::Input(_) | Self::Constant(_))
    }
}

/// The operations of an equation, each of them once. Operations without effect are left out: x·1, x + 0 and, as every number is
/// finite, x·0.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// The operations, in an order in which they can be computed.
    pub operations: Vec<Operation>,
    places: HashMap<Operation, u32>,
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Names of the results and their places.
    pub results: Vec<(String, u32)>,
}

impl Trace {
    /// Records the operations of `equation`, which receives the recorder and passes its results to it.
    #[inline(never)]
    pub fn record(equation: &mut dyn FnMut(&Recorder)) -> Self {
        let recorder = Recorder(RefCell::default());
        equation(&recorder);
        recorder.0.into_inner()
    }

    fn constant(&self, at: u32) -> Option<f64> {
        if let Operation::Constant(bits) = self.operations[at as usize] { Some(f64::from_bits(bits)) } else { None }
    }

    fn is(&self, at: u32, x: f64) -> bool {
        self.constant(at) == Some(x)
    }

    /// The place of `operation`, which is added if it is new.
    fn put(&mut self, operation: Operation) -> u32 {
        use Operation::{Add, Fma, Max, Min, Mul};
        // Either order of a sum or a product has the same bits.
        let operation = match operation {
            Add(a, b) if b < a => Add(b, a),
            Mul(a, b) if b < a => Mul(b, a),
            Max(a, b) if b < a => Max(b, a),
            Min(a, b) if b < a => Min(b, a),
            Fma(a, b, c) if b < a => Fma(b, a, c),
            other => other,
        };
        if let Some(at) = self.simplified(operation) {
            return at;
        }
        *self.places.entry(operation).or_insert_with(|| {
            self.operations.push(operation);
            self.operations.len() as u32 - 1
        })
    }

    fn put_constant(&mut self, x: f64) -> u32 {
        // A zero has no sign here.
        self.put(Operation::Constant((x + 0.0).to_bits()))
    }

    /// The place of the result, if it is there already or a simpler operation gives it.
    fn simplified(&mut self, operation: Operation) -> Option<u32> {
        use Operation::{Abs, Add, Fma, Max, Min, Mul, Neg, Sub};
        let both = |trace: &Self, a, b| Some((trace.constant(a)?, trace.constant(b)?));
        match operation {
            Add(a, b) => match both(self, a, b) {
                Some((x, y)) => Some(self.put_constant(x + y)),
                None if self.is(a, 0.0) => Some(b),
                None if self.is(b, 0.0) => Some(a),
                None => match (self.operations[a as usize], self.operations[b as usize]) {
                    (_, Neg(y)) => Some(self.put(Sub(a, y))),
                    (Neg(x), _) => Some(self.put(Sub(b, x))),
                    _ => None,
                },
            },
            Sub(a, b) => match both(self, a, b) {
                Some((x, y)) => Some(self.put_constant(x - y)),
                None if self.is(b, 0.0) => Some(a),
                None if self.is(a, 0.0) => Some(self.put(Neg(b))),
                None => match self.operations[b as usize] {
                    Neg(y) => Some(self.put(Add(a, y))),
                    _ => None,
                },
            },
            Mul(a, b) => match both(self, a, b) {
                Some((x, y)) => Some(self.put_constant(x * y)),
                None if self.is(a, 0.0) || self.is(b, 1.0) => Some(a),
                None if self.is(b, 0.0) || self.is(a, 1.0) => Some(b),
                None => None,
            },
            Fma(a, b, c) => {
                if let Some((x, y)) = both(self, a, b) {
                    let product = self.put_constant(x * y);
                    Some(self.put(Add(product, c)))
                } else if self.is(a, 0.0) || self.is(b, 0.0) {
                    Some(c)
                } else if self.is(a, 1.0) {
                    Some(self.put(Add(b, c)))
                } else if self.is(b, 1.0) {
                    Some(self.put(Add(a, c)))
                } else if self.is(c, 0.0) {
                    Some(self.put(Mul(a, b)))
                } else {
                    None
                }
            }
            Neg(a) => match (self.constant(a), self.operations[a as usize]) {
                (Some(x), _) => Some(self.put_constant(-x)),
                (_, Neg(b)) => Some(b),
                _ => None,
            },
            Max(a, b) => both(self, a, b).map(|(x, y)| self.put_constant(x.max(y))),
            Min(a, b) => both(self, a, b).map(|(x, y)| self.put_constant(x.min(y))),
            Abs(a) => self.constant(a).map(|x| self.put_constant(x.abs())),
            _ => None,
        }
    }

    /// Which operations the results need.
    pub fn needed(&self) -> Vec<bool> {
        let mut needed = vec![false; self.operations.len()];
        self.results.iter().for_each(|(_, at)| needed[*at as usize] = true);
        for at in (0..self.operations.len()).rev() {
            if needed[at] {
                self.operations[at].operands().for_each(|operand| needed[operand as usize] = true);
            }
        }
        needed
    }

    /// Number of arithmetic operations that the results need. A negation is part of the operation that uses it.
    pub fn count(&self) -> usize {
        let needed = self.needed();
        let all = self.operations.iter().zip(needed);
        all.filter(|(operation, needed)| {
            *needed && operation.is_arithmetic() && !matches!(operation, Operation::Neg(_))
        })
        .count()
    }

    /// The results for the values that `input` has by name, in double precision.
    pub fn evaluate(&self, input: impl Fn(&str) -> f64) -> Vec<(String, f64)> {
        let mut values: Vec<f64> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let x = |at: u32| values[at as usize];
            values.push(match *operation {
                Operation::Input(n) => input(&self.inputs[n as usize]),
                Operation::Constant(bits) => f64::from_bits(bits),
                Operation::Add(a, b) => x(a) + x(b),
                Operation::Sub(a, b) => x(a) - x(b),
                Operation::Mul(a, b) => x(a) * x(b),
                Operation::Div(a, b) => x(a) / x(b),
                Operation::Neg(a) => -x(a),
                Operation::Abs(a) => x(a).abs(),
                Operation::Fma(a, b, c) => x(a) * x(b) + x(c),
                Operation::Sqrt(a) => x(a).sqrt(),
                Operation::Max(a, b) => x(a).max(x(b)),
                Operation::Min(a, b) => x(a).min(x(b)),
                Operation::SelectBelow(a, b, yes, no) => {
                    if x(a) < x(b) {
                        x(yes)
                    } else {
                        x(no)
                    }
                }
            });
        }
        self.results.iter().map(|(name, at)| (name.clone(), values[*at as usize])).collect()
    }
}

/// The maker of a trace.
pub struct Recorder(RefCell<Trace>);

impl Recorder {
    /// The input called `name`.
    pub fn input(&self, name: &str) -> Traced<'_> {
        let mut trace = self.0.borrow_mut();
        let n = trace.inputs.iter().position(|input| input == name).unwrap_or_else(|| {
            trace.inputs.push(name.into());
            trace.inputs.len() - 1
        });
        let at = trace.put(Operation::Input(n as u32));
        drop(trace);
        Traced { recorder: self, at }
    }

    /// The constant `x`.
    pub fn constant(&self, x: f64) -> Traced<'_> {
        Traced { recorder: self, at: self.0.borrow_mut().put_constant(x) }
    }

    /// Makes `x` the result called `name`.
    pub fn result(&self, name: &str, x: Traced) {
        self.0.borrow_mut().results.push((name.into(), x.at));
    }
}

/// A number of a trace. None of its operations is inlined: every combination of terms is compiled with it.
#[derive(Clone, Copy)]
pub struct Traced<'a> {
    recorder: &'a Recorder,
    at: u32,
}

impl Traced<'_> {
    fn put(self, operation: Operation) -> Self {
        Self { at: self.recorder.0.borrow_mut().put(operation), ..self }
    }
}

macro_rules! binary {
    ($($operator:ident $method:ident),+) => {
        $(impl $operator for Traced<'_> {
            type Output = Self;
            #[inline(never)]
            fn $method(self, b: Self) -> Self {
                self.put(Operation::$operator(self.at, b.at))
            }
        })+
    };
}
binary!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Traced<'_> {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        self.put(Operation::Neg(self.at))
    }
}

impl Num for Traced<'_> {
    #[inline(never)]
    fn constant(self, x: f64) -> Self {
        Self { at: self.recorder.0.borrow_mut().put_constant(x), ..self }
    }
    /// An input, but a parameter that is 0 stays a constant.
    #[inline(never)]
    fn parameter(self, name: &str, k: usize, x: f64) -> Self {
        if x == 0.0 { self.constant(x) } else { self.recorder.input(&format!("{name}{k}")) }
    }
    #[inline(never)]
    fn fma(self, b: Self, c: Self) -> Self {
        self.put(Operation::Fma(self.at, b.at, c.at))
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        self.put(Operation::Sqrt(self.at))
    }
    #[inline(never)]
    fn abs(self) -> Self {
        self.put(Operation::Abs(self.at))
    }
    #[inline(never)]
    fn max(self, other: Self) -> Self {
        self.put(Operation::Max(self.at, other.at))
    }
    #[inline(never)]
    fn min(self, other: Self) -> Self {
        self.put(Operation::Min(self.at, other.at))
    }
    #[inline(never)]
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        self.put(Operation::SelectBelow(self.at, limit.at, yes.at, no.at))
    }
}
