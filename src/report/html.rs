//! Escapes text and creates tables in HTML, for all pages of the program.

/// Returns `text` with the special characters of HTML escaped.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns a table whose first row is the header.
pub(crate) fn table(rows: &[Vec<String>]) -> String {
    let row = |cells: &Vec<String>, tag: &str| {
        let cells = cells.iter().map(|cell| {
            let class = if cell.starts_with("MISSED") || cell == "failed" { " class=\"missed\"" } else { "" };
            format!("<{tag}{class}>{}</{tag}>", escape(cell))
        });
        format!("<tr>{}</tr>\n", cells.collect::<String>())
    };
    let mut rows = rows.iter();
    let head = rows.next().map(|cells| row(cells, "th")).unwrap_or_default();
    format!("<table>\n{head}{}</table>\n", rows.map(|cells| row(cells, "td")).collect::<String>())
}
