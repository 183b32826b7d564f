"""Prints what a control function costs a step, beside the work of the function itself, with one thread.

The figure is the wall time from the end of the water's step to the answer of a function that does nothing, the least of ten
runs: the caches are cold in some.
"""

import pontoon as pt


def cost(scene: pt.Scene, until: float) -> float:
    """Returns the time of a call (s)."""
    with scene.build(threads=1) as sim:
        sim.advance(until, control=lambda h: None)
        return sim.time_spent()["callbacks"] / sim.steps


if __name__ == "__main__":
    buoy = pt.Scene.read("buoy-in-waves")
    print(f"{min(cost(buoy, 0.05) for _ in range(10)) * 1e6:.2f} µs a call")
