//! Creates self-contained HTML pages without scripts or external files.

use std::time::SystemTime;

use super::{REPEATS_NOTE, ResultRow, spread_table};
use crate::output::manifest::Machine;
pub(crate) use crate::report::html::{escape, table};

const STYLE: &str = "body{font:15px/1.45 sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#222}\
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}svg{width:54em;max-width:100%;height:auto}\
table{border-collapse:collapse;margin:.6em 0;font-size:.87em}td,th{padding:.2em .7em;text-align:left;\
border-bottom:1px solid #ddd;font-variant-numeric:tabular-nums}th{border-bottom:2px solid #888}\
td:first-child{white-space:nowrap}\
code{font-size:.92em}\
.missed{color:#b00020;font-weight:bold}figure{margin:.5em 0}figcaption{font-size:.9em;color:#444}";

/// Returns the page with `title` and the content `body`.
pub(crate) fn html_page(title: &str, body: &str) -> Vec<u8> {
    let title = escape(title);
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\
         <style>{STYLE}</style></head>\n<body>\n<h1>{title}</h1>\n{body}</body></html>\n"
    )
    .into_bytes()
}

/// Returns a plot with its caption.
pub(crate) fn plot_figure(svg: &str, caption: &str) -> String {
    format!("<figure>{svg}<figcaption>{}</figcaption></figure>\n", escape(caption))
}

/// Returns the page section on the spread of the repeats, or an empty text if no run has repeats.
pub(crate) fn repeats_section(rows: &[ResultRow]) -> String {
    let told = spread_table(rows);
    match told.is_empty() {
        true => String::new(),
        false => format!("<h2>Repeats</h2>\n<p>{}</p>\n{}", REPEATS_NOTE, table(&told)),
    }
}

/// Returns a table of the command, machine and time of the runs.
pub(crate) fn provenance_table(command: &str, machine: &Machine, threads: Option<usize>) -> String {
    let Machine { processor, cpus, instructions, os, .. } = machine;
    let instructions = instructions.as_deref().unwrap_or("no lanes");
    let threads = threads.map_or("–".into(), |n| n.to_string());
    let rows = [
        ("command", command.to_string()),
        ("date", timestamp()),
        ("version", format!("pontoon {}", env!("CARGO_PKG_VERSION"))),
        ("machine", format!("{processor}, {cpus} processors, {instructions}, {os}")),
        ("threads", threads),
    ];
    let rows: String =
        rows.iter().map(|(key, x)| format!("<tr><td>{key}</td><td><code>{}</code></td></tr>\n", escape(x))).collect();
    format!("<table>\n{rows}</table>\n")
}

/// Returns the current date and time, UTC.
pub(crate) fn timestamp() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_user_writes_cannot_break_the_page() {
        let text = String::from_utf8_lossy(&html_page("<script>", &table(&[vec!["a&b".into()]]))).into_owned();
        assert!(text.contains("&lt;script&gt;") && text.contains("a&amp;b") && !text.contains("<script>"));
    }
}
