//! Traces as WGSL.

use std::fmt::Write as _;

use crate::sph::trace::{Operation, Trace};

/// The constant `x` in single precision; `None` if it overflows.
fn literal(x: f64) -> Option<String> {
    let single = x as f32;
    single.is_finite().then(|| if single < 0.0 { format!("({single:?}f)") } else { format!("{single:?}f") })
}

/// The operations of `trace` that its results need, as statements. `input` says how the inputs are read; the other names begin with
/// `prefix`, and the results with `out_`. `None` if a constant overflows single precision.
pub(super) fn statements(trace: &Trace, prefix: &str, input: impl Fn(&str) -> String) -> Option<String> {
    let needed = trace.needed();
    let mut names = vec![String::new(); trace.operations.len()];
    let mut text = String::new();
    for (at, operation) in trace.operations.iter().enumerate().filter(|(at, _)| needed[*at]) {
        let n = |operand: u32| names[operand as usize].as_str();
        let expression = match *operation {
            Operation::Input(k) => {
                names[at] = input(&trace.inputs[k as usize]);
                continue;
            }
            Operation::Constant(bits) => {
                names[at] = literal(f64::from_bits(bits))?;
                continue;
            }
            Operation::Add(a, b) => format!("{} + {}", n(a), n(b)),
            Operation::Sub(a, b) => format!("{} - {}", n(a), n(b)),
            Operation::Mul(a, b) => format!("{} * {}", n(a), n(b)),
            Operation::Div(a, b) => format!("{} / {}", n(a), n(b)),
            Operation::Neg(a) => format!("-{}", n(a)),
            Operation::Abs(a) => format!("abs({})", n(a)),
            Operation::Fma(a, b, c) => format!("fma({}, {}, {})", n(a), n(b), n(c)),
            Operation::Sqrt(a) => format!("sqrt({})", n(a)),
            Operation::Max(a, b) => format!("max({}, {})", n(a), n(b)),
            Operation::Min(a, b) => format!("min({}, {})", n(a), n(b)),
            Operation::SelectBelow(a, b, yes, no) => format!("select({}, {}, {} < {})", n(no), n(yes), n(a), n(b)),
        };
        names[at] = format!("{prefix}{at}");
        let _ = writeln!(text, "let {} = {expression};", names[at]);
    }
    for (name, at) in &trace.results {
        let _ = writeln!(text, "let out_{name} = {};", names[*at as usize]);
    }
    Some(text)
}

/// `text` with each line moved to the right by `by` blanks.
pub(super) fn indented(text: &str, by: usize) -> String {
    text.lines().map(|line| format!("{}{line}\n", " ".repeat(by))).collect()
}
