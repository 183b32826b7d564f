"""Linear potential flow about a half-immersed box that begins to sway in a closed tank, fitted as the test of the program fits its run.

A box 0.2 m wide and 0.05 m deep in a tank of 2.4 × 0.3 m moves by a min(t, 1 s) sin(ω t). Bilinear finite elements in half of the tank
(the potential is odd about the middle); surface elevation and potential advance by the scheme of Runge and Kutta. Prints the added mass
(kg/m) and damping (kg/(m s)) of the whole periods before 3.4 s.  Usage: python3 sway_in_a_tank.py [OMEGA in rad/s] [CELL in m]
"""

import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg

HALF_LENGTH, DEPTH, HALF_WIDTH, DRAFT, UNTIL, STEP = 1.2, 0.3, 0.1, 0.05, 3.4, 0.001
GRAVITY, DENSITY = 9.81, 1000.0


def elements(cell):
    """Returns the operator from the surface potential to the vertical velocity there, the same of a unit velocity of the box, and the
    rows that give the potential on the face of the box, with the lengths of that face that its nodes have."""
    columns, rows = round(HALF_LENGTH / cell), round(DEPTH / cell)
    side, keel = round(HALF_WIDTH / cell), round((DEPTH - DRAFT) / cell)
    wet = np.ones((columns, rows), bool)
    wet[:side, keel:] = False
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
    surface, middle, face = number[side:, rows], number[0, : keel + 1], number[side, keel:]
    length = np.full(len(face), cell)
    length[[0, -1]] = cell / 2
    flux = np.zeros(used.sum())
    flux[face] = -length
    inside = np.setdiff1d(np.arange(used.sum()), np.union1d(surface, middle))
    solve = linalg.splu(stiffness[inside][:, inside].tocsc()).solve
    extended = np.zeros((used.sum(), len(surface)))
    extended[surface, np.arange(len(surface))] = 1.0
    extended[inside] = solve(-stiffness[:, surface].toarray()[inside])
    moved = np.zeros(used.sum())
    moved[inside] = solve(flux[inside])
    width = np.full(len(surface), cell)
    width[[0, -1]] = cell / 2
    rise = (stiffness @ extended)[surface] / width[:, None]
    return rise, (stiffness @ moved - flux)[surface] / width, extended[face], moved[face], length


def force(omega, cell):
    """Returns times (s) and the force on the box (N/m) for an amplitude of 1 m."""
    rise, rise_by_box, at_face, at_face_by_box, length = elements(cell)

    def speed(t):
        return np.sin(omega * t) + t * omega * np.cos(omega * t) if t < 1.0 else omega * np.cos(omega * t)

    def rates(t, state):
        return np.array([rise @ state[1] + rise_by_box * speed(t), -GRAVITY * state[0]])

    times, state, potential = np.arange(0.0, UNTIL + STEP / 2, STEP), np.zeros((2, len(rise))), []
    for t in times:
        potential.append(at_face @ state[1] + at_face_by_box * speed(t))
        first = rates(t, state)
        second = rates(t + STEP / 2, state + STEP / 2 * first)
        third = rates(t + STEP / 2, state + STEP / 2 * second)
        fourth = rates(t + STEP, state + STEP * third)
        state = state + STEP / 6 * (first + 2 * second + 2 * third + fourth)
    pressure = -DENSITY * np.gradient(np.array(potential), STEP, axis=0)
    return times, -2.0 * pressure @ length


def main():
    omega = float(sys.argv[1]) if len(sys.argv) > 1 else 8.0
    cell = float(sys.argv[2]) if len(sys.argv) > 2 else 0.005
    times, loads = force(omega, cell)
    kept = times > UNTIL - int(2.4 * omega / (2 * np.pi)) * 2 * np.pi / omega
    angles = omega * times[kept]
    terms = np.stack([np.ones(kept.sum()), np.sin(angles), np.cos(angles)], 1)
    _, sine, cosine = np.linalg.lstsq(terms, loads[kept], rcond=None)[0]
    print(f"added mass {sine / omega**2:.3f} kg/m, damping {-cosine / omega:.2f} kg/(m s)")


if __name__ == "__main__":
    main()
