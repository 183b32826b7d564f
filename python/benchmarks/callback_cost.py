"""Prints what a control function costs a step, beside the work of the function itself, with one thread.

The figure is the wall time from the end of the water's step to the answer of a function that does nothing, the median and the
least of ten runs: in a small tank, and in a larger one, where most of the time goes into memory that the water's step has taken out
of the caches.

    python callback_cost.py
    valgrind --tool=callgrind --callgrind-out-file=/dev/null python callback_cost.py --count [--without]

With --count it makes the same steps of a small tank with or without the function and prints their number: the difference of the
instructions over the number of steps is the count of a call.
"""

import argparse
from statistics import median

import pontoon as pt

#: Runs of a measurement.
REPEATS = 10


def nothing(h: pt.BodyStep) -> None:
    """The control function."""


def cost(scene: pt.Scene, until: float) -> float:
    """Returns the time of a call in an advance to `until` (s), s."""
    with scene.build(threads=1) as sim:
        sim.advance(until, control=nothing)
        return sim.time_spent()["callbacks"] / sim.steps


def main() -> None:
    """Measures or counts."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--count", action="store_true", help="make the steps of a count of instructions")
    options.add_argument("--without", action="store_true", help="without the function")
    given = options.parse_args()
    small = pt.Scene.read("buoyancy")
    small["dp"], small["until"] = 0.04, 1.5
    if given.count:
        with small.build(threads=1) as sim:
            sim.advance(control=None if given.without else nothing)
            print(f"{sim.steps} steps")
        return
    for what, scene, until in (("small tank", small, 0.5), ("buoy-in-waves", pt.Scene.read("buoy-in-waves"), 0.05)):
        particles = scene.inspect()["size"]["fluid"]
        costs = [1e6 * cost(scene, until) for _ in range(REPEATS)]
        print(f"{what}, {particles} particles: {median(costs):.2f} µs a call, at least {min(costs):.2f} µs")


if __name__ == "__main__":
    main()
