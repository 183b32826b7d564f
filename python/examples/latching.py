"""Latching control of a heaving point absorber: a brake holds the float at each end of its stroke, so that it moves in
phase with the wave. The power take-off, a damper of the same constant, then takes several times the power.

Theory: J. Falnes, Ocean Waves and Oscillating Systems, 2002, section 6.3: the optimum is a velocity in phase with the
exciting force; a float whose own period is shorter than that of the wave gets there by waiting.

    python latching.py
"""

import math

import pontoon as pt

#: Wave: height (m) and period (s).
HEIGHT, PERIOD = 0.04, 1.6
#: Width and height of the float, m; it floats on half its height.
WIDTH, TALL = 0.24, 0.12
#: Damping of the power take-off, N s/m per metre of width.
TAKE_OFF = 60.0
#: Damping of the brake that holds the float, N s/m per metre of width.
BRAKE = 2.0e4
#: Simulated time (s), and the time from which power is counted (s).
UNTIL, FROM = 11.2, 4.8

SCENE = f"""
title = "A heaving point absorber"
dimension = 2
dp = 0.02
until = {UNTIL}
frames = "off"

[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [4.6, 0.4] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [4.8, 0.7] }} }}
at = {{ x = -0.2 }}

[[solid]]
name = "paddle"
shape = {{ box = {{ size = [0.08, 0.7] }} }}
at = {{ x = -0.04, bottom = 0.0 }}
driven = {{ along = [1.0, 0.0], wave = {{ regular = {{ height = {HEIGHT}, period = {PERIOD} }}, absorb = true }} }}

[[damping]]
from = [2.9, 0.0]
to = [4.6, 0.0]

[[solid]]
name = "float"
shape = {{ box = {{ size = [{WIDTH}, {TALL}] }} }}
at = {{ x = 1.8, draft = "equilibrium" }}
free = {{ density = 500.0 }}

[[joint]]
name = "rail"
kind = "slider"
between = ["float"]
at = [1.8, 0.4]
along = [0.0, 1.0]
motor = {{ damping = {TAKE_OFF} }}

[model]
h_over_dp = 2.0
"""


class Latch:
    """Holds the float when it stops, and releases it so that it passes the middle with the crest.

    A float of its own period T₀ takes T₀/2 from end to end; the wave takes T/2. It is held for the difference.
    """

    def __init__(self, own_period: float) -> None:
        self.wait = 0.5 * (PERIOD - own_period)
        self.speed = 0.0
        self.release = 0.0
        self.free_since = 0.0

    def __call__(self, h: pt.BodyStep) -> bool:
        """Returns whether the float is held; called each 5 ms."""
        speed = float(h["float"].velocity[1])
        held = h.time < self.release
        turned = speed * self.speed <= 0.0 and h.time > self.free_since + 0.25 * PERIOD
        if not held and turned and h.time > 1.0:
            self.release, held = h.time + self.wait, True
        if not held:
            self.speed = speed
        else:
            self.free_since = self.release
        h.drive("rail", damping=BRAKE if held else TAKE_OFF)
        return held


def power(own_period: float | None) -> float:
    """Returns the mean power of the take-off (W/m), with latching if the float's own period (s) is given."""
    latch = None if own_period is None else Latch(own_period)
    energy, last = 0.0, FROM

    def control(h: pt.BodyStep) -> None:
        nonlocal energy, last
        held = latch is not None and latch(h)
        if h.time > FROM:
            # The take-off alone counts: what the brake takes is lost.
            speed = float(h["float"].velocity[1])
            energy += 0.0 if held else TAKE_OFF * speed * speed * (h.time - last)
            last = h.time

    with pt.Scene.from_toml(SCENE).build() as sim:
        sim.advance(control=control, every=0.005)
    return energy / (UNTIL - FROM)


def main() -> None:
    """Compares the power with and without latching."""
    report = pt.Scene.from_toml(SCENE).inspect()
    own_period = float(report["bodies"][0]["afloat"]["heave_with_added_s"])
    free, latched = power(None), power(own_period)
    # Energy flux of a linear wave in finite depth, W/m.
    k = dispersion(2.0 * math.pi / PERIOD, 0.4)
    group = 0.5 * (2.0 * math.pi / PERIOD / k) * (1.0 + 2.0 * k * 0.4 / math.sinh(2.0 * k * 0.4))
    flux = 1000.0 * 9.81 * HEIGHT**2 / 8.0 * group
    print(f"own period of heave {own_period:.2f} s, wave {PERIOD} s, energy flux {flux:.2f} W/m")
    print(f"power: uncontrolled {free:.3f} W/m, latched {latched:.3f} W/m, ratio {latched / free:.2f}")
    assert 0.0 < free < latched < flux, "more than without control, less than the wave carries"
    assert latched > 1.3 * free, "latching pays where the wave is longer than the float's own period"


def dispersion(omega: float, depth: float) -> float:
    """Returns the wave number k (1/m) with ω² = g k tanh(k d), by Newton's method."""
    k = omega * omega / 9.81
    for _ in range(50):
        th = math.tanh(k * depth)
        k -= (9.81 * k * th - omega * omega) / (9.81 * th + 9.81 * k * depth * (1.0 - th * th))
    return k


if __name__ == "__main__":
    main()
