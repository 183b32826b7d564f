//! Unit tests of `src/preflight/rounding.rs`.

use super::*;

#[test]
fn numbers_are_rounded_up_or_down_to_two_digits() {
    assert_eq!(
        [three_digits(0.123456), three_digits(-12.0), three_digits(1234.4), three_digits(2e-7)],
        ["0.123", "-12", "1234", "2.00e-7"]
    );
    assert_eq!(
        [
            two_digits_down(0.01),
            two_digits_down(0.0129),
            two_digits_up(0.0121),
            two_digits_up(131.0),
            two_digits_down(2.0)
        ],
        ["0.01", "0.012", "0.013", "140", "2"]
    );
    assert_eq!(place(&[0.1 + 0.2, -1e-17]), "[0.3, 0]");
}
