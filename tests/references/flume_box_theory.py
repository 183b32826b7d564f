#!/usr/bin/env python3
"""Box of Hadzic et al. 2005 in the wave that was measured before it, by linear potential flow: how near can exact linear theory come?

The surface measured at x = 1.16 m (elevation_1.csv) is carried to the box at 2.11 m by linear dispersion; response amplitude operators
of the box (linear_waves.py) turn it into surge, heave and pitch. N is that of the checks of scenes/flume-box, at the times of body.csv:
as it is; with the mean difference taken out; and with the best delay of the wave and the best linear damping beyond that of the
radiated waves taken as well, in parts of the critical one (of surge: none, as it has no stiffness).
Linear theory has no drift: from the recorded surge a straight line and a parabola are taken out before its N is formed.
Sources: Newman 1977, 6.16-6.19, for the equation of motion; the rest as in linear_waves.py.

Usage: flume_box_theory.py        (half a minute)
"""
import os
import numpy as np
from linear_waves import box, solve, wavenumbers

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(HERE, "..", "..", "scenes", "flume-box")
RHO, G, B, T, DEPTH, X = 1000.0, 9.81, 0.10, 0.034, 0.40, 2.11 - 1.16


def table(name):
    rows = [line for line in open(os.path.join(SCENE, name), encoding="utf-8") if line[0] in "-0123456789."]
    return np.array([[float(v) for v in line.split(",")] for line in rows]).T


def operators(inertia, below, ws):
    """Complex motions (surge, heave, pitch counter-clockwise) per wave amplitude at the angular frequencies ws, without damping,
    with the matrices that damping needs; the centre of mass is `below` the still level."""
    dofs = ["sway", "heave", "roll"]
    mesh = box(B, T, DEPTH, 30, 0.03)
    m = RHO * B * T
    # metacentric height: half draft up to the centre of buoyancy, B^2/12T to the metacentre
    gm = below - T / 2 + B * B / 12 / T
    M, C = np.diag([m, m, inertia]), np.diag([0, RHO * G * B, m * G * gm])
    return M, C, [solve(mesh, w, dofs, RHO, G, z0=-below, wave=True) for w in ws]


def motions(of, ws, damping):
    M, C, found = of
    out = []
    for w, r in zip(ws, found):
        critical = 2 * np.sqrt(np.diag(C) * (np.diag(M) + np.diag(r["A"])))
        D = r["B"] + np.diag(np.array([0, *damping]) * critical)
        out.append(np.linalg.solve(C - w * w * (M + r["A"]) - 1j * w * D, r["F"]))
    return np.array(out)


def natural_period(of, ws):
    """Of pitch with sway: the zero of the coupled stiffness."""
    M, C, found = of
    f = [C[2, 2] - w * w * (M[2, 2] + r["A"][2, 2] - r["A"][0, 2] ** 2 / (M[0, 0] + r["A"][0, 0])) for w, r in zip(ws, found)]
    return 2 * np.pi / np.interp(0, f[::-1], ws[::-1])


def n_of(s, r):
    return np.sqrt(np.sum((s - r) ** 2) / np.sum(r * r))


def without(x, t, degree):
    return x - np.polyval(np.polyfit(t, x, degree), t)


def main():
    t1, eta = table("elevation_1.csv")
    body = table("body.csv")
    t, record = body[0], body[1:]
    dt, n = 0.02, 2048
    grid = np.arange(n) * dt
    wave = np.fft.rfft(np.interp(grid, t1, eta - eta[:20].mean(), left=0, right=0))
    w_all = 2 * np.pi * np.fft.rfftfreq(n, dt)
    used = (w_all > 2 * np.pi * 0.3) & (w_all < 2 * np.pi * 3.2)
    ws = np.linspace(2 * np.pi * 0.29, 2 * np.pi * 3.21, 60)
    k = np.array([wavenumbers(w * w / G, DEPTH, 1)[0] for w in w_all[used]])
    print("inertia, below: period of pitch; N of surge (no drift), heave, pitch: as is | mean out | best delay | and best damping (heave, pitch)")
    for inertia, below in ((0.00483, 0.009), (0.00354, 0.009), (0.00483, 0.013)):
        of = operators(inertia, below, ws)

        def run(damping, late):
            x = motions(of, ws, damping)
            out = []
            for j in range(3):
                rao = np.interp(w_all[used], ws, x[:, j].real) + 1j * np.interp(w_all[used], ws, x[:, j].imag)
                line = np.zeros(len(w_all), complex)
                # numpy transforms with exp(-i w t), the operators have exp(-i w t) in time: conjugate
                line[used] = wave[used] * np.conj(rao * np.exp(1j * k * X)) * np.exp(-1j * w_all[used] * late)
                out.append(np.interp(t, grid, np.fft.irfft(line, n)))
            out[2] = np.degrees(out[2])
            return np.array(out)

        def figures(x):
            plain, zeroed = [], []
            for j in range(3):
                a, r = (x[j], record[j]) if j else (without(x[0], t, 2), without(record[0], t, 2))
                plain.append(n_of(a, r))
                zeroed.append(n_of(a - np.mean(a - r), r))
            return np.array(plain), np.array(zeroed)

        text = lambda a: " ".join(f"{v:.2f}" for v in a)
        plain, zeroed = figures(run((0, 0), 0))
        delays = np.arange(-0.1, 0.1001, 0.002)
        late = [min(delays, key=lambda d: figures(run((0, 0), d))[1][j]) for j in range(3)]
        moved = [figures(run((0, 0), late[j]))[1][j] for j in range(3)]
        best = []
        for j in (1, 2):
            tried = [(figures(run((c, c), d))[1][j], c, d) for c in np.arange(0, 0.31, 0.03) for d in np.arange(-0.08, 0.041, 0.008)]
            best.append(min(tried))
        print(f"{inertia}, {below}: {natural_period(of, ws):.3f} s; {text(plain)} | {text(zeroed)} | {text(moved)} at "
              + ", ".join(f"{1e3 * d:+.0f} ms" for d in late) + " | " + "; ".join(f"{v:.2f} at {c:.2f}, {1e3 * d:+.0f} ms" for v, c, d in best))


if __name__ == "__main__":
    main()
