"""A moored buoy in regular waves: a run, its series in pandas, a plot, and the heave against the wave.

The buoy answers with the period of the wave, and heaves nearly as high as the wave, which is longer than it.

    python buoy_in_waves.py [--out FOLDER] [--plot FILE]
"""

import argparse
import tempfile
from pathlib import Path

import pontoon as pt

#: Period (s) of the wave of the scene.
PERIOD = 1.2


def main() -> None:
    """Runs the scene, prints a table and checks the heave."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--out", type=Path, help="folder of the run")
    options.add_argument("--plot", type=Path, help="file for a plot of heave and wave")
    given = options.parse_args()

    scene = pt.Scene.read("buoy-in-waves")
    scene["dp"] = 0.025
    scene["until"] = 9.8
    scene["frames"] = "off"
    for finding in scene.inspect().findings:
        print(finding)

    out = given.out or Path(tempfile.mkdtemp()) / "buoy"
    run = pt.run(scene, out=out, report=False)
    table = run.to_pandas()
    print(table[["buoy.heave_m", "buoy.surge_m", "elevation.eta_m"]].describe().round(4))

    heave, wave = run.series["heave"], run.series["elevation.eta"]
    ratio = abs(heave.harmonic(PERIOD, since=5.0) / wave.harmonic(PERIOD, since=5.0))
    period = run.stats(start=4.0).value("heave", "T_z")
    print(f"heave over wave {ratio:.2f}, period {period:.3f} s of {PERIOD} s")

    if given.plot:
        import matplotlib

        matplotlib.use("Agg")
        axes = table[["buoy.heave_m", "elevation.eta_m"]].plot(xlabel="time (s)", ylabel="m", grid=True)
        axes.set_title(run.title)
        axes.figure.savefig(given.plot, dpi=120)

    assert abs(period / PERIOD - 1.0) < 0.05, "the buoy answers with the period of the wave"
    # Linear theory of a box of 0.3 m in a wave of 1.9 m: it follows the wave within about a third.
    assert 0.6 < ratio < 1.4


if __name__ == "__main__":
    main()
