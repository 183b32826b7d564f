"""Prints what a control function costs a step, beside the work of the function itself, with one thread.

The figure is the wall time from the end of the water's step to the answer of a function that does nothing, the median and the
least of ten runs. A call takes 2,300 instructions, counted by callgrind as the difference of two runs with and without a function;
most of the time goes into memory that the water's step has taken out of the caches.
"""

from statistics import median

import pontoon as pt


def cost(scene: pt.Scene, until: float) -> float:
    """Returns the time of a call (s)."""
    with scene.build(threads=1) as sim:
        sim.advance(until, control=lambda h: None)
        return sim.time_spent()["callbacks"] / sim.steps


if __name__ == "__main__":
    buoy = pt.Scene.read("buoy-in-waves")
    costs = [1e6 * cost(buoy, 0.05) for _ in range(10)]
    print(f"{median(costs):.2f} µs a call, at least {min(costs):.2f} µs")
