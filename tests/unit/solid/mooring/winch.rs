use super::*;

fn holding(tension: f64, gain: f64) -> Winch {
    Winch::new(WinchTarget::Tension { tension, gain }, 0.1, [5.0, 20.0])
}

/// On a taut line without mass, T = EA (d/L − 1), the error falls with the rate g EA d/L² to round-off, also with a gain at which an
/// explicit rule would be unstable, g EA Δt/L = 100.
#[test]
fn the_tension_is_held_with_any_gain() {
    let (stiffness, distance, dt) = (1e4, 10.1, 1e-3);
    for gain in [1e-4, 1e-2, 100.0] {
        let mut length = 10.0;
        let tension = |length: f64| stiffness * (distance / length - 1.0);
        for _ in 0..200_000 {
            length = holding(60.0, gain).next_length(length, tension(length), stiffness, dt);
        }
        assert!((tension(length) / 60.0 - 1.0).abs() < 1e-6, "gain {gain}: {} N", tension(length));
    }
}

/// The rate is limited, and so are the lengths.
#[test]
fn rates_and_lengths_are_limited() {
    let winch = holding(10.0, 1.0);
    assert_eq!(winch.next_length(10.0, 1e9, 1e4, 0.5), 10.05);
    assert_eq!(winch.next_length(10.0, 0.0, 1.0, 0.5), 9.95);
    assert_eq!(winch.next_length(5.01, 0.0, 1.0, 0.5), 5.0);
    assert_eq!(winch.next_length(19.99, 1e9, 1.0, 0.5), 20.0);
    let to = Winch::new(WinchTarget::Length(12.0), 0.1, [5.0, 20.0]);
    assert_eq!([to.next_length(11.0, 0.0, 1.0, 1.0), to.next_length(11.95, 0.0, 1.0, 1.0)], [11.1, 12.0]);
}

/// Numbers that no winch can have are named.
#[test]
fn faulty_numbers_are_refused() {
    let message =
        |winch: Winch, length: f64| winch.check(length).err().unwrap_or_else(|| panic!("{winch:?} is accepted"));
    assert!(message(holding(-1.0, 0.1), 10.0).contains("tension is -1"));
    assert!(message(Winch { rate_limit: f64::NAN, ..holding(1.0, 0.1) }, 10.0).contains("rate limit"));
    assert!(message(holding(1.0, 0.1), 30.0).contains("30 m long"));
    assert!(message(Winch { shortest: 0.0, ..holding(1.0, 0.1) }, 10.0).contains("range is 0 m"));
    assert!(message(Winch { target: WinchTarget::Length(21.0), ..holding(1.0, 0.1) }, 10.0).contains("target is 21"));
    assert_eq!(holding(1.0, 0.1).check(10.0), Ok(()));
}
