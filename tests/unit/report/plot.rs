//! Unit tests of `src/report/plot.rs`.

use super::*;

fn line(points: &[(f64, f64)]) -> PlotLine {
    PlotLine::new("", 0, LineStyle::Dotted, points.to_vec())
}

#[test]
fn a_plot_has_its_titles_labels_legend_and_round_ticks() {
    let labels = ["20 mm", "10 mm", "<5 mm"].map(String::from).to_vec();
    let line = PlotLine { name: "laminar & SPS".into(), labels, ..line(&[(2.0, 0.4), (30.0, 0.2), (500.0, 0.11)]) };
    let svg = log_log_plot(["processor time, s", "N, –"], &[line]);
    for word in
        ["<svg", ">processor time, s<", ">N, –<", ">20 mm<", ">&lt;5 mm<", ">laminar &amp; SPS<", ">0.2<", ">100<"]
    {
        assert!(svg.contains(word), "\"{word}\" is not in: {svg}");
    }
    assert_eq!(svg.matches("<circle").count(), 4, "three points and one in the legend");
    assert!(roxmltree::Document::parse(&svg).is_ok(), "{svg}");
}

#[test]
fn an_error_bar_is_vertical_and_within_the_axis() {
    let bare = PlotLine { style: LineStyle::Dots, ..line(&[(2.0, 0.4), (30.0, 0.2)]) };
    let spanned = PlotLine { spans: vec![(0.05, 0.9), (0.2, 0.2)], ..bare.clone() };
    let (bare, spanned) = (log_log_plot(["x", "y"], &[bare]), log_log_plot(["x", "y"], &[spanned]));
    // One bar of three strokes: the second point has no spread.
    let bar =
        |svg: &str| svg.lines().find(|line| line.contains("stroke=\"#0072b2\"")).map(|line| line.matches('M').count());
    assert_eq!((bar(&bare), bar(&spanned)), (None, Some(3)), "{spanned}");
    assert!(!bare.contains(">0.05<") && spanned.contains(">0.05<"), "{spanned}");
}

#[test]
fn points_are_at_their_values_on_the_axes() {
    let svg = line_plot(["x", "y"], &[line(&[(0.0, 0.0), (5.0, 10.0), (10.0, 20.0)])]);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let number = |node: roxmltree::Node, name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
    let dots: Vec<[f64; 2]> = document
        .descendants()
        .filter(|node| node.has_tag_name("circle"))
        .map(|node| [number(node, "cx"), number(node, "cy")])
        .collect();
    // The x axis ends at the outer points; the y axis has a margin of 5 %.
    assert_eq!(dots, [[82.0, 346.2], [409.0, 188.0], [736.0, 29.8]]);
    let tick = |label: &str| {
        let text = document.descendants().find(|node| node.text() == Some(label) && node.has_tag_name("text")).unwrap();
        [number(text, "x"), (10.0 * (number(text, "y") - 5.0)).round() / 10.0]
    };
    assert_eq!((tick("10")[0], tick("20")[1]), (736.0, 29.8), "the first tick of 10 is on the x axis");
}

#[test]
fn empty_lines_zeros_and_values_that_are_not_finite_are_drawn_without_errors() {
    let broken = line(&[(0.0, 1.0), (1.0, 2.0), (2.0, f64::NAN), (3.0, f64::INFINITY), (4.0, 1.0), (5.0, 3.0)]);
    let plots = [
        log_log_plot(["x", "y"], &[]),
        line_plot(["x", "y"], &[]),
        line_plot(["x", "y"], &[line(&[(0.0, 0.0), (1.0, 0.0)])]),
        log_log_plot(["x", "y"], &[line(&[(0.0, 0.0)])]),
        line_plot(["x", "y"], &[line(&[(3.0, -2.0)])]),
        line_plot(["x", "y"], &[broken]),
    ];
    for svg in &plots {
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
    assert!(plots[4].contains(">−2<"), "a minus sign, not a hyphen: {}", plots[4]);
    let parts = plots[5].lines().find(|line| line.contains("stroke=\"#0072b2\"")).map(|line| line.matches('M').count());
    assert_eq!(parts, Some(2), "the line is interrupted at values that are not finite");
    assert_eq!(plots[5].matches("<circle").count(), 4);
}

#[test]
fn a_long_legend_has_a_second_row() {
    let of = |i: usize, name: &str| PlotLine::new(name, i, LineStyle::Plain, vec![(0.0, 1.0), (1.0, 2.0)]);
    let height = |lines: &[PlotLine]| {
        let svg = line_plot(["x", "y"], lines);
        svg.split("height=\"").nth(1).and_then(|rest| rest.split('"').next()?.parse::<f64>().ok()).unwrap()
    };
    let long = "a name of thirty-three characters";
    assert_eq!(height(&[of(0, "")]), 420.0);
    assert_eq!(height(&[of(0, "a"), of(0, "a"), of(1, "b")]), 420.0 + 34.0);
    assert_eq!(height(&[of(0, long), of(1, "b"), of(2, long)]), 420.0 + 56.0);
}

#[test]
fn tick_steps_are_round_numbers() {
    assert_eq!([0.0013, 0.3, 0.7, 2.0, 11.0].map(round_step), [0.002, 0.5, 1.0, 2.0, 20.0]);
}
