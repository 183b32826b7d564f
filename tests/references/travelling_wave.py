"""A steep wave in a periodic sea, which an ideal fluid keeps for ever: writes its scene, and tells what a run loses.

The start is Stokes's wave of second order (1847) in water 0.2 m deep: surface, velocity and pressure. The amplitude of a period is that
of the first harmonic along the surface; the root of the kinetic energy, which includes motions beside the wave, is printed as well.
Energy travels at the group velocity, so that a period's loss divided by group over phase velocity is that of a wave length in a flume.

    python3 travelling_wave.py DIR --kd 2.5 --height 0.04 --dp 0.008     (writes DIR/scene.toml and DIR/surface.csv)
    python3 travelling_wave.py DIR --kd 2.5 --width 0.096                (the same in 3-D, periodic across as well; h = 1.8 dp)
    pontoon run DIR --out RUN
    python3 travelling_wave.py RUN --judge --kd 2.5 --dp 0.008
"""

import argparse
import cmath
import csv
import math
import os

DEPTH, GRAVITY, PERIODS, READINGS, GAUGES = 0.2, 9.81, 12, 80, 40


class Wave:
    def __init__(self, kd, dp):
        k = kd / DEPTH
        self.length = round(2 * math.pi / k / dp) * dp
        self.k = 2 * math.pi / self.length
        self.omega = math.sqrt(GRAVITY * self.k * math.tanh(self.k * DEPTH))
        self.period = 2 * math.pi / self.omega
        self.group = 0.5 * (1 + 2 * self.k * DEPTH / math.sinh(2 * self.k * DEPTH))


def write(directory, wave, amplitude, dp, width):
    up, across = ("z", [width / 2]) if width else ("y", [])
    k, omega, length = wave.k, wave.omega, wave.length
    tanh, sinh, cosh = (f(k * DEPTH) for f in (math.tanh, math.sinh, math.cosh))
    second = amplitude**2 * k / 4 * (3 - tanh**2) / tanh**3
    os.makedirs(directory, exist_ok=True)
    with open(os.path.join(directory, "surface.csv"), "w") as file:
        file.write(f"x_m,y_m\n0,{-DEPTH}\n{length},{-DEPTH}\n")
        for i in range(401):
            x = length * (1 - i / 400)
            file.write(f"{x:.6f},{amplitude * math.cos(k * x) + second * math.cos(2 * k * x):.6f}\n")
    parts = [(amplitude * omega / sinh, k), (0.75 * amplitude**2 * k * omega / sinh**4, 2 * k)]
    velocity = [
        "+".join(f"{speed}*{down}({n}*({up}+{DEPTH}))*{along}({n}*x)" for speed, n in parts)
        for down, along in (("cosh", "cos"), ("sinh", "sin"))
    ]
    pressure = f"{1000 * GRAVITY}*({amplitude}*cos({k}*x)*cosh({k}*({up}+{DEPTH}))/{cosh}-{amplitude + second})"
    if width:
        velocity.insert(1, "0")
    shape, sides = ("prism", f'length = {width}, axis = "y", ') if width else ("polygon", "")
    size, place = ([length + 0.4, *([width + 0.4] if width else []), 0.08], [length / 2, *across, -DEPTH - 0.04])
    fill = f'shape = {{ {shape} = {{ {sides}file = "surface.csv" }} }}' + (f", at = {{ y = {width / 2} }}" if width else "")
    periodic = f"x = [0.0, {length}]" + (f", y = [0.0, {width}]" if width else "")
    at = ", ".join(f"{axis} = {x}" for axis, x in zip("xyz" if width else "xy", place))
    first, last = ([x, *across] if width else x for x in (length / GAUGES / 2, length * (1 - 0.5 / GAUGES)))
    every = wave.period / READINGS
    with open(os.path.join(directory, "scene.toml"), "w") as file:
        file.write(f"""title = "A wave in a periodic sea"
dimension = {3 if width else 2}
dp = {dp}
until = {(PERIODS + 0.1) * wave.period}
frames = "off"
periodic = {{ {periodic} }}

[model]                    # the default laws where a paddle makes a named wave
gradient = "near_surface"
h_over_dp = {1.8 if width else 2.4}
viscosity = {{ riemann = {{ threshold = 0.3 }} }}

[[water]]
fill = {{ {fill} }}
velocity = {velocity}
pressure = "{pressure}"

[[solid]]
name = "bed"
fixed = true
shape = {{ box = {{ size = {size} }} }}
at = {{ {at} }}

[[probe]]
energy = true
every = {every}

[[probe]]
name = "row"
elevation = {{ from = {first}, to = {last}, count = {GAUGES} }}
every = {every}

[[probe]]
budget = true
every = {every}
""")


def table(run, name):
    with open(os.path.join(run, "series", name + ".csv")) as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return rows[0], [[float(x) for x in row] for row in rows[1:]]


def judge(run, wave):
    names, rows = table(run, "energy")
    column = next(i for i, name in enumerate(names) if name.startswith("water_kinetic"))
    names, heights = table(run, "row")
    gauges = [i for i, name in enumerate(names) if name.startswith("level")]

    def along(row):
        wave_along = (row[i] * cmath.exp(-2j * math.pi * n / len(gauges)) for n, i in enumerate(gauges))
        return 2 * abs(sum(wave_along)) / len(gauges)

    kinds = {"kinetic energy": [math.sqrt(row[column]) for row in rows], "surface": [along(row) for row in heights]}
    for kind, values in kinds.items():
        means = [sum(values[i * READINGS : (i + 1) * READINGS]) / READINGS for i in range(PERIODS)]
        # Of the third to the twelfth period, by a line through their logarithms.
        x, y = range(2, PERIODS), [math.log(mean) for mean in means[2:]]
        middle, level = sum(x) / len(x), sum(y) / len(y)
        slope = sum((a - middle) * (b - level) for a, b in zip(x, y)) / sum((a - middle) ** 2 for a in x)
        print(f"{kind:15}", *(f"{mean / means[0]:.3f}" for mean in means), f"loss a wave length {-100 * slope / wave.group:.2f} %")


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("directory")
parser.add_argument("--judge", action="store_true")
parser.add_argument("--kd", type=float, default=2.5)
parser.add_argument("--height", type=float, default=0.04)
parser.add_argument("--dp", type=float, default=0.008)
parser.add_argument("--width", type=float, default=0.0)
args = parser.parse_args()
wave = Wave(args.kd, args.dp)
if args.judge:
    judge(args.directory, wave)
else:
    write(args.directory, wave, 0.5 * args.height, args.dp, args.width)
