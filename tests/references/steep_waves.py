"""Potential flow of a piston without the assumption of small waves, beside the run of a scene.

Surface elevation and potential of the surface advance by the equations of Zakharov (1968) and the scheme of Runge and Kutta, between the
face of the paddle and the end of the water. At each stage Laplace's equation is solved on columns that follow paddle and surface, with
Chebyshev's points along each column and central differences across. Of small waves the amplitude is 0.2 % too low. Reads the motion of
the paddle and the elevation at the gauges in RUN/series (paddle.csv, row.csv); prints, over the last four periods, twice the amplitude at
the period, and the height from crest to trough, both over the height asked for. Command of a run: docs/measurements/wave-resolution.csv.
"""

import argparse
import csv

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg
from scipy.interpolate import CubicSpline

GRAVITY = 9.81
ROWS, CELL, STEPS = 9, 84, 60


def table(path):
    rows = list(csv.reader(line for line in open(path) if not line.startswith("#")))
    return rows[0], np.array([[float(x) if x else np.nan for x in row] for row in rows[1:]])


def chebyshev(n):
    """Points from 0 (bed) to 1 (surface) and the matrix of derivatives there."""
    i = np.arange(n + 1)
    x = np.cos(np.pi * i / n)
    c = np.where((i == 0) | (i == n), 2.0, 1.0) * (-1.0) ** i
    difference = x[:, None] - x[None, :]
    d = np.outer(c, 1 / c) / (difference + np.eye(n + 1))
    d -= np.diag(d.sum(1))
    order = np.argsort(x)
    return (0.5 * (x + 1))[order], 2.0 * d[np.ix_(order, order)]


class Tank:
    def __init__(self, depth, end, zone, period, paddle):
        k = (2 * np.pi / period) ** 2 / GRAVITY
        for _ in range(200):
            k = (2 * np.pi / period) ** 2 / (GRAVITY * np.tanh(k * depth))
        self.depth, self.end, self.zone = depth, end, zone
        self.columns = int(round(end * k / (2 * np.pi) * CELL)) + 1
        self.place = np.linspace(0.0, 1.0, self.columns)
        self.sigma, self.d = chebyshev(ROWS)
        self.dd = self.d @ self.d
        self.paddle, self.speed = paddle, paddle.derivative()
        self.rate = 8.0 * np.sqrt(GRAVITY * depth) / (end - zone)

    def vertical_velocity(self, x, step, eta, psi, speed):
        """At the surface."""
        m, n = self.columns, ROWS + 1
        h = self.depth + eta
        h1 = np.gradient(h, step, edge_order=2)
        h2 = np.empty(m)
        h2[1:-1] = (h[2:] - 2 * h[1:-1] + h[:-2]) / step**2
        h2[0], h2[-1] = h2[1], h2[-2]
        s = self.sigma[None, :]
        sx = -s * (h1 / h)[:, None]
        sxx = s * (-h2 / h + 2 * (h1 / h) ** 2)[:, None]
        square = sx**2 + (1 / h**2)[:, None]
        number = np.arange(m * n).reshape(m, n)
        rows, columns, values = [], [], []

        def add(row, column, value):
            rows.append(np.broadcast_to(row, value.shape).ravel())
            columns.append(np.broadcast_to(column, value.shape).ravel())
            values.append(value.ravel())

        inner = slice(1, m - 1)
        body = np.arange(1, n - 1)
        row = number[inner][:, body]
        one = np.ones(row.shape)
        for shift, factor in ((-1, 1.0), (0, -2.0), (1, 1.0)):
            add(row, number[1 + shift : m - 1 + shift][:, body], factor / step**2 * one)
        first = square[inner][:, body, None] * self.dd[None, body, :] + sxx[inner][:, body, None] * self.d[None, body, :]
        add(row[:, :, None], number[inner][:, None, :], first)
        cross = sx[inner][:, body, None] * self.d[None, body, :] / step
        add(row[:, :, None], number[2:][:, None, :], cross)
        add(row[:, :, None], number[:-2][:, None, :], -cross)
        for i, sign in ((0, 1), (m - 1, -1)):
            row = number[i, body]
            for shift, factor in ((0, -1.5), (1, 2.0), (2, -0.5)):
                add(row, number[i + sign * shift, body], sign * factor / step * np.ones(row.shape))
            add(row[:, None], number[i][None, :], sx[i, body, None] * self.d[body, :])
        add(number[:, 0][:, None], number, np.broadcast_to(self.d[0], (m, n)))
        add(number[:, -1], number[:, -1], np.ones(m))
        right = np.zeros((m, n))
        right[0, 1:-1] = speed
        right[:, -1] = psi
        matrix = sparse.csc_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(m * n,) * 2)
        phi = linalg.splu(matrix, permc_spec="COLAMD").solve(right.ravel()).reshape(m, n)
        return phi @ self.d[-1] / h

    def rates(self, t, state):
        eta, psi = state
        face, speed = float(self.paddle(t)), float(self.speed(t))
        x = face + (self.end - face) * self.place
        step = x[1] - x[0]
        w = self.vertical_velocity(x, step, eta, psi, speed)
        eta_x, psi_x = np.gradient(eta, step, edge_order=2), np.gradient(psi, step, edge_order=2)
        slope = 1 + eta_x**2
        carried = speed * (1 - self.place)
        zone = np.clip((x - self.zone) / (self.end - self.zone), 0, 1) ** 2 * self.rate
        return np.array(
            [
                -eta_x * psi_x + w * slope + carried * eta_x - zone * eta,
                -GRAVITY * eta - 0.5 * psi_x**2 + 0.5 * w**2 * slope + carried * psi_x - zone * psi,
            ]
        )

    def run(self, until, step, gauges):
        state, told = np.zeros((2, self.columns)), []
        for i in range(int(round(until / step)) + 1):
            t = i * step
            x = float(self.paddle(t)) + (self.end - float(self.paddle(t))) * self.place
            told.append(np.interp(gauges, x, state[0]))
            a = self.rates(t, state)
            b = self.rates(t + step / 2, state + step / 2 * a)
            c = self.rates(t + step / 2, state + step / 2 * b)
            d = self.rates(t + step, state + step * c)
            state = state + step / 6 * (a + 2 * b + 2 * c + d)
            for y in state:
                y[2:-2] -= 0.01 / 16 * (y[:-4] - 4 * y[1:-3] + 6 * y[2:-2] - 4 * y[3:-1] + y[4:])
        return step * np.arange(len(told)), np.array(told)


def figures(t, eta, period, height):
    last = t >= t[-1] - 4 * period
    w = 2 * np.pi / period
    waves = [np.ones(last.sum())] + [f(n * w * t[last]) for n in (1, 2, 3) for f in (np.sin, np.cos)]
    fit = np.linalg.lstsq(np.stack(waves, 1), eta[last], rcond=None)[0]
    return 2 * np.hypot(fit[1], fit[2]) / height, (eta[last].max(0) - eta[last].min(0)) / height


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    for name, what in (
        ("depth", "of the still water, m"),
        ("end", "of the water ahead of the paddle, m"),
        ("zone", "where damping begins, m"),
        ("period", "of the wave, s"),
        ("height", "asked for, m"),
    ):
        parser.add_argument(f"--{name}", type=float, required=True, help=what)
    asked = parser.parse_args()
    run, depth, end, zone, period, height = (getattr(asked, name) for name in ("run", "depth", "end", "zone", "period", "height"))
    names, motion = table(f"{run}/series/paddle.csv")
    x = motion[:, names.index("surge_m")]
    tank = Tank(depth, end, zone, period, CubicSpline(motion[:, 0], x))
    names, rows = table(f"{run}/series/row.csv")
    etas = [i for i, name in enumerate(names) if name.startswith("eta")]
    gauges = np.array([float(names[i].split("_")[2]) for i in etas])
    t, theory = tank.run(rows[-1, 0], period / STEPS, gauges)
    of_theory, of_run = figures(t, theory, period, height), figures(rows[:, 0], rows[:, etas], period, height)
    print("gauge, m            ", *(f"{x:6.2f}" for x in gauges))
    for what, i in (("amplitude", 0), ("height", 1)):
        print(f"{what:9}  theory   ", *(f"{x:6.3f}" for x in of_theory[i]))
        print(f"{what:9}  run      ", *(f"{x:6.3f}" for x in of_run[i]))
    print("amplitude, run/theory", *(f"{x:6.3f}" for x in of_run[0] / of_theory[0]))


if __name__ == "__main__":
    main()
