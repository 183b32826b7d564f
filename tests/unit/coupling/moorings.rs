use super::share_behind;

/// The whole kernel lies behind a plane at its far edge, half of it behind one through its centre, nothing beyond its radius.
#[test]
fn the_share_behind_a_plane_falls_from_one_to_zero() {
    for (t, share) in [(-1.0, 1.0), (0.0, 0.5), (1.0, 0.0), (2.0, 0.0), (-3.0, 1.0)] {
        assert!((share_behind(t) - share).abs() < 1e-15, "t = {t}: {}", share_behind(t));
    }
    assert!((share_behind(0.3) + share_behind(-0.3) - 1.0).abs() < 1e-15);
}
