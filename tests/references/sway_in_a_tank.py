"""Linear potential flow about a box that begins to sway in a closed tank, fitted as the test of the program fits its run.

A box 0.2 m wide moves by a min(t, 1 s) sin(ω t): half immersed, 0.05 m deep in a tank of 2.4 × 0.3 m, or with --submerged from 0.25 to
0.35 m above the bed of one of 1.2 × 0.6 m. Bilinear finite elements in half of the tank (the potential is odd about the middle); surface
elevation and potential advance by the scheme of Runge and Kutta. Prints the added mass (kg/m) and damping (kg/(m s)) of the whole
periods between 1 s and --until, and with --run FOLDER --amplitude A those of the series box_force.csv of a run
(docs/measurements/sway.toml, sway-submerged.toml), and both over these.
"""

import argparse

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg

HALF_WIDTH, STEP = 0.1, 0.001
GRAVITY, DENSITY = 9.81, 1000.0


def elements(cell, length, depth, keel, top):
    """Returns the operator from the surface potential to the vertical velocity there, the same of a unit velocity of the box, and the
    rows that give the potential on the face of the box, with the lengths of that face that its nodes have."""
    columns, rows, side, keel, top = (round(x / cell) for x in (length, depth, HALF_WIDTH, keel, top))
    wet = np.ones((columns, rows), bool)
    wet[:side, keel:top] = False
    used = np.zeros((columns + 1, rows + 1), bool)
    for i in (0, 1):
        for j in (0, 1):
            used[i : columns + i, j : rows + j] |= wet
    number = np.full(used.shape, -1)
    number[used] = np.arange(used.sum())
    i, j = np.nonzero(wet)
    corners = np.stack([number[i, j], number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]], 1)
    local = np.array([[4, -1, -2, -1], [-1, 4, -1, -2], [-2, -1, 4, -1], [-1, -2, -1, 4]]) / 6.0
    places = np.repeat(corners, 4, 1).ravel(), np.tile(corners, (1, 4)).ravel()
    stiffness = sparse.csc_matrix((np.tile(local.ravel(), len(corners)), places), shape=(used.sum(),) * 2)
    # In the middle the potential is 0: the surface above a submerged box begins beside it.
    surface = number[side if top == rows else 1 :, rows]
    middle = np.setdiff1d(number[0], -1)
    face = number[side, keel : top + 1]
    height = np.full(len(face), cell)
    height[[0, -1]] = cell / 2
    flux = np.zeros(used.sum())
    flux[face] = -height
    inside = np.setdiff1d(np.arange(used.sum()), np.union1d(surface, middle))
    solve = linalg.splu(stiffness[inside][:, inside].tocsc()).solve
    extended = np.zeros((used.sum(), len(surface)))
    extended[surface, np.arange(len(surface))] = 1.0
    extended[inside] = solve(-stiffness[:, surface].toarray()[inside])
    moved = np.zeros(used.sum())
    moved[inside] = solve(flux[inside])
    width = np.full(len(surface), cell)
    width[-1] = cell / 2
    if top == rows:
        width[0] = cell / 2
    rise = (stiffness @ extended)[surface] / width[:, None]
    return rise, (stiffness @ moved - flux)[surface] / width, extended[face], moved[face], height


def force(omega, until, *tank):
    """Returns times (s) and the force on the box (N/m) for an amplitude of 1 m."""
    rise, rise_by_box, at_face, at_face_by_box, height = elements(*tank)

    def speed(t):
        return np.sin(omega * t) + t * omega * np.cos(omega * t) if t < 1.0 else omega * np.cos(omega * t)

    def rates(t, state):
        return np.array([rise @ state[1] + rise_by_box * speed(t), -GRAVITY * state[0]])

    times, state, potential = np.arange(0.0, until + STEP / 2, STEP), np.zeros((2, len(rise))), []
    for t in times:
        potential.append(at_face @ state[1] + at_face_by_box * speed(t))
        first = rates(t, state)
        second = rates(t + STEP / 2, state + STEP / 2 * first)
        third = rates(t + STEP / 2, state + STEP / 2 * second)
        fourth = rates(t + STEP, state + STEP * third)
        state = state + STEP / 6 * (first + 2 * second + 2 * third + fourth)
    pressure = -DENSITY * np.gradient(np.array(potential), STEP, axis=0)
    return times, -2.0 * pressure @ height


def coefficients(times, loads, omega, until):
    """Returns added mass and damping of the whole periods between 1 s and `until`, for an amplitude of 1 m."""
    kept = (times > until - int((until - 1.0) * omega / (2 * np.pi)) * 2 * np.pi / omega) & (times <= until + 1e-9)
    angles = omega * times[kept]
    terms = np.stack([np.ones(kept.sum()), np.sin(angles), np.cos(angles)], 1)
    _, sine, cosine = np.linalg.lstsq(terms, loads[kept], rcond=None)[0]
    return np.array([sine / omega**2, -cosine / omega])


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--omega", type=float, default=8.0, help="rad/s")
    options.add_argument("--cell", type=float, default=0.005, help="m")
    options.add_argument("--until", type=float, help="s; 3.4, submerged 2")
    options.add_argument("--submerged", action="store_true")
    options.add_argument("--run", help="folder of a run")
    options.add_argument("--amplitude", type=float, default=0.01, help="of the run, m")
    asked = options.parse_args()
    until = asked.until or (2.0 if asked.submerged else 3.4)
    tank = (0.6, 0.6, 0.25, 0.35) if asked.submerged else (1.2, 0.3, 0.25, 0.3)
    theory = coefficients(*force(asked.omega, until, asked.cell, *tank), asked.omega, until)
    print("theory  added mass {:.3f} kg/m, damping {:.2f} kg/(m s)".format(*theory))
    if asked.run:
        series = np.genfromtxt(f"{asked.run}/series/box_force.csv", delimiter=",", skip_header=1)
        found = coefficients(series[:, 0], series[:, 1], asked.omega, until) / asked.amplitude
        print("run     added mass {:.3f} kg/m, damping {:.2f} kg/(m s)".format(*found))
        print("ratio   {:.3f}, {:.3f}".format(*(found / theory)))


if __name__ == "__main__":
    main()
