"""The heave of a box in regular waves beside that of Capytaine: the response amplitude operator (RAO).

A flume in 2-D stands for a box that is long along the crests. The wave is measured in a run without the box, at its place. Capytaine
has a box twenty times as long as it is broad.

    python heave_rao.py [--periods 1.0 1.2 1.5] [--dp 0.025] [--panels 1600] [--plot FILE]
"""

import argparse
import math
import tempfile
from pathlib import Path

import numpy as np

import pontoon as pt
from pontoon import potential_flow

#: Breadth and height of the box, its place, and depth of the water, m.
BREADTH, HEIGHT, PLACE, DEPTH = 0.3, 0.125, 2.0, 0.3
#: Height of the waves, m, and the times between which their amplitude is measured, s: the beach is reached, and nothing has come back.
WAVE, START, UNTIL = 0.04, 6.0, 11.0


def flume(period: float, dp: float, box: bool) -> pt.Scene:
    """Returns a flume with waves of this period (s) and a beach, with or without the box."""
    solid = f"""
[[solid]]
name = "box"
shape = {{ box = {{ size = [{BREADTH}, {HEIGHT}] }} }}
at = {{ x = {PLACE}, draft = "equilibrium" }}
free = {{ density = 500.0 }}

[[probe]]
motion = "box"
every = 0.01
"""
    return pt.Scene.from_toml(
        f"""
dimension = 2
dp = {dp}
until = {UNTIL}
frames = "off"

[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [6.5, {DEPTH}] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [6.7, 0.5] }} }}
at = {{ x = -0.2 }}

[[solid]]
name = "paddle"
shape = {{ box = {{ size = [0.05, 0.5] }} }}
at = {{ x = -0.025, bottom = 0.0 }}
driven = {{ along = [1.0, 0.0], wave = {{ regular = {{ height = {WAVE}, period = {period} }}, absorb = true }} }}

[[damping]]
from = [3.5, 0.0]
to = [6.5, 0.0]

[[probe]]
elevation = {{ x = {PLACE} }}
every = 0.01
{solid if box else ""}"""
    )


def bodies(folder: Path, panels: int) -> potential_flow.PanelledBodies:
    """Returns the panels of a box twenty times as long as broad."""
    length = 20.0 * BREADTH
    scene = pt.Scene.from_toml(
        f"""
dimension = 3
dp = 0.05
until = 1.0

[[water]]
fill = {{ box = {{ min = [-1.0, {-0.6 * length}, 0.0], max = [1.0, {0.6 * length}, {DEPTH}] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [2.0, {1.2 * length}, 0.5] }} }}
at = {{ x = -1.0, y = {-0.6 * length} }}

[[solid]]
name = "box"
shape = {{ box = {{ size = [{BREADTH}, {length}, {HEIGHT}] }} }}
at = {{ x = 0.0, y = 0.0, draft = "equilibrium" }}
free = {{ density = 500.0 }}
"""
    )
    return potential_flow.export_bodies(scene, folder, panels=panels)


def main() -> None:
    """Runs the waves, prints both RAOs and checks the difference."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--periods", type=float, nargs="+", default=[1.2, 1.5], help="periods of the waves, s")
    options.add_argument("--dp", type=float, default=0.025, help="particle spacing, m")
    options.add_argument("--panels", type=int, default=1600, help="panels of Capytaine")
    options.add_argument("--plot", type=Path, help="file for a plot")
    given = options.parse_args()
    out = Path(tempfile.mkdtemp())
    periods = sorted(given.periods, reverse=True)

    omega = [2.0 * math.pi / period for period in periods]
    computed = bodies(out / "bodies", given.panels).solve(omega, motions=["surge", "heave", "pitch"]).rao("heave")
    heave = []
    for period in periods:
        runs = [
            pt.run(flume(period, given.dp, box), out=out / f"{period:g}-{box}", report=False) for box in (False, True)
        ]
        names = ("elevation.eta", "heave")
        wave, answer = (abs(run.series[name].harmonic(period, START)) for run, name in zip(runs, names, strict=True))
        print(f"period {period:g} s: wave {1e3 * wave:.1f} mm, heave {1e3 * answer:.1f} mm")
        heave.append(answer / wave)
    measured = pt.Rao(
        name="flume",
        motion="box.heave_m",
        unit="m/m",
        frequency=1.0 / np.array(periods),
        amplitude=np.array(heave),
        phase=np.full(len(heave), np.nan),
        coherence=np.ones(len(heave)),
    )
    comparison = potential_flow.compare_raos(measured, computed)
    print(comparison)
    if given.plot:
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot

        figure, axes = pyplot.subplots(figsize=(5, 4))
        comparison.plot(axes)
        figure.savefig(given.plot, dpi=120)

    # Measured with five rows in the height of the box: -6 % at 1.5 s, -11 % at 1.2 s.
    assert abs(comparison.difference).max() < 0.15


if __name__ == "__main__":
    main()
