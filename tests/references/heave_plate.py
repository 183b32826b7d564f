"""A flat plate that begins to swing across itself in an unbounded fluid without viscosity, by discrete vortices in two dimensions.

The speed is U sin(2 pi t/T) from rest, KC = U T/b with the breadth b. The plate is the image of a circle; in each step a vortex whose strength
satisfies Kutta's condition leaves each edge, a third of the way to the one before. Prints the added mass over rho pi b^2/4 and the drag
coefficient, by Fourier averages over the first period as in the test of the program: -F dv/dt and -F v over those of rho pi b^2/4 (dv/dt)^2
and rho b/2 |v|^3. Needs numpy. With 80 to 160 steps and cores of 0.02 the drag agrees within 5 %.
"""

import argparse

import numpy as np

RADIUS = 0.5  # of the circle: the plate is from -1 to 1


def to_plate(s):
    return s + RADIUS**2 / s


def to_circle(z):
    root = np.sqrt(z * z - 4 * RADIUS**2)
    s = 0.5 * (z + root)
    return np.where(abs(s) >= RADIUS, s, 0.5 * (z - root))


def both_halves(s, strength):
    return np.r_[s, -s.conj()], np.r_[strength, -strength]


def at_edge(s, strength):
    """Velocity (complex conjugate, on the circle) at the edge by vortices and their images."""
    return np.sum(strength * (1 / (RADIUS - s) - 1 / (RADIUS - RADIUS**2 / s.conj()))) / 2j / np.pi


def velocity(s, strength, stream, core):
    """Velocity of the vortices of one half in the plane of the plate, with Routh's correction."""
    all_s, all_strength = both_halves(s, strength)
    distance2 = abs(to_plate(s)[:, None] - to_plate(all_s)[None, :]) ** 2
    apart = s[:, None] - all_s[None, :]
    np.fill_diagonal(apart, 1.0)
    pairs = distance2 / (distance2 + core**2) / apart
    np.fill_diagonal(pairs, 0.0)
    images = 1 / (s[:, None] - RADIUS**2 / all_s.conj()[None, :])
    slope = -1j * stream * (1 + RADIUS**2 / s**2) + (pairs - images) @ all_strength / 2j / np.pi
    first, second = 1 - RADIUS**2 / s**2, 2 * RADIUS**2 / s**3
    return (slope / first - strength / 4j / np.pi * second / first**2).conj()


def first_period(kc, steps, core):
    dt, omega = 1.0 / steps, 2 * np.pi
    stream = lambda t: 2 * kc * np.sin(omega * t)
    s, strength, moments = np.zeros(0, complex), np.zeros(0), [0.0]
    for n in range(steps):
        now = stream((n + 1) * dt)
        new = 1 + 0.02j * np.sign(now)
        if len(s) and abs(to_plate(s[-1]) - 1) < 0.5:
            new = 1 + (to_plate(s[-1]) - 1) / 3
        if abs(new - 1) < 2e-3:
            new = 1 + 2e-3j * np.sign(now)
        new = to_circle(np.array([new]))
        lack = -2j * now + at_edge(*both_halves(s, strength))
        s, strength = np.r_[s, new], np.r_[strength, -(lack / at_edge(*both_halves(new, np.ones(1)))).real]
        all_s, all_strength = both_halves(s, strength)
        moments.append(np.sum(all_strength * (all_s - RADIUS**2 / all_s.conj())).real)
        middle = to_circle(to_plate(s) + 0.5 * dt * velocity(s, strength, now, core))
        s = to_circle(to_plate(s) + dt * velocity(middle, strength, stream((n + 1.5) * dt), core))
        s *= np.maximum(1.001 * RADIUS / abs(s), 1.0)
        s = np.where(s.real < 0, -s.conj(), s)
    t = (np.arange(steps) + 0.5) * dt
    force, speed, acceleration = np.diff(moments) / dt, stream(t), 2 * kc * omega * np.cos(omega * t)
    added_mass = 1 + np.sum(force * acceleration) / np.sum(np.pi * acceleration**2)
    return added_mass, np.sum(force * speed) / np.sum(abs(speed) ** 3)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kc", type=float, nargs="+")
    parser.add_argument("--steps", type=int, default=160)
    parser.add_argument("--core", type=float, default=0.02, help="radius of the cores over half the breadth")
    own = parser.parse_args()
    for kc in own.kc:
        print("KC %g: added mass %.2f, drag coefficient %.2f" % (kc, *first_period(kc, own.steps, own.core)))
