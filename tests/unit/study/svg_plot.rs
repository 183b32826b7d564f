//! Unit tests of `src/study/svg_plot.rs`.

use super::*;

#[test]
fn a_plot_has_its_titles_labels_and_round_marks() -> Result<()> {
    let points = vec![(2.0, 0.4), (30.0, 0.2), (500.0, 0.11)];
    let labels = ["20 mm", "10 mm", "5 mm"].map(String::from).to_vec();
    let line = PlotLine { labels, ..PlotLine::new(0, LineStyle::Dotted, points) };
    let svg = log_log_plot(["processor time, s", "N, –"], &[line])?;
    for word in ["<svg", "processor time, s", "N, –", "20 mm", "0.2", "100"] {
        assert!(svg.contains(word), "\"{word}\" is not there");
    }
    Ok(())
}

#[test]
fn a_span_is_drawn_upright_and_the_axis_reaches_it() -> Result<()> {
    let bare = PlotLine::new(0, LineStyle::Dots, vec![(2.0, 0.4), (30.0, 0.2)]);
    let spanned = PlotLine { spans: vec![(0.05, 0.9), (0.2, 0.2)], ..bare.clone() };
    let drawn = |line: PlotLine| log_log_plot(["x", "y"], &[line]);
    let (bare, spanned) = (drawn(bare)?, drawn(spanned)?);
    // One bar: the second point is known exactly.
    let bars = |svg: &str| svg.matches("stroke=\"#0072B2\" stroke-width=\"3\"").count();
    assert_eq!((bars(&bare), bars(&spanned)), (0, 1), "{spanned}");
    assert!(!bare.contains("\n0.05\n") && spanned.contains("\n0.05\n"), "{spanned}");
    Ok(())
}

#[test]
fn nothing_and_zeros_can_be_drawn() -> Result<()> {
    log_log_plot(["x", "y"], &[])?;
    line_plot(["x", "y"], &[PlotLine::new(0, LineStyle::Plain, vec![(0.0, 0.0), (1.0, 0.0)])])?;
    log_log_plot(["x", "y"], &[PlotLine::new(0, LineStyle::Dots, vec![(0.0, 0.0)])]).map(|_| ())
}

#[test]
fn steps_are_round() {
    assert_eq!([0.0013, 0.3, 0.7, 2.0, 11.0].map(round_step), [0.002, 0.5, 1.0, 2.0, 20.0]);
}
