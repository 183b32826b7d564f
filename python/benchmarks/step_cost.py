"""Prints what a step costs when Python asks for each, against the same steps in one call, and the memory of a view and a copy.

With one thread, for a small scene and a larger one: the least wall time of some repeats from the same state. Memory is
that which Python's allocators, NumPy's included, hold for the arrays of position and velocity.

    python step_cost.py
"""

import time
import tracemalloc
from collections.abc import Callable

import pontoon as pt

#: Steps of a measurement, and measurements of which the least counts.
STEPS, REPEATS = 200, 5


def least(sim: pt.Simulation, state: bytes, steps: Callable[[], None]) -> float:
    """Returns the least wall time of `steps`, each time from `state`, s per step."""
    times = []
    for _ in range(REPEATS):
        sim.restore(state)
        begun = time.perf_counter()
        steps()
        times.append((time.perf_counter() - begun) / STEPS)
    return min(times)


def step_costs(sim: pt.Simulation) -> tuple[float, float]:
    """Returns the cost of a step by `step` and in one `advance`, s."""

    def one_by_one() -> None:
        for _ in range(STEPS):
            sim.step()

    state = sim.save()
    one_by_one()
    end = sim.time
    alone, together = least(sim, state, one_by_one), least(sim, state, lambda: sim.advance(end))
    sim.restore(state)
    return alone, together


def memory(use: Callable[[], object]) -> int:
    """Returns the memory that Python holds while the result of `use` lives, bytes."""
    # The first use imports and fills caches.
    use()
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    held = use()
    taken = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    del held
    return taken


def view_memory(sim: pt.Simulation) -> tuple[int, int]:
    """Returns the memory of position and velocity in a view and as copies, bytes."""
    with sim.water.view() as view:
        viewed = memory(lambda: (view.position, view.velocity))
    return viewed, memory(lambda: (sim.water.position, sim.water.velocity))


def main() -> None:
    """Measures both scenes."""
    for name, dp in (("raft", 0.02), ("buoy-in-waves", 0.01)):
        with pt.Scene.read(name).set(dp=dp).build(threads=1) as sim:
            sim.step()
            alone, together = step_costs(sim)
            viewed, copied = view_memory(sim)
            print(f"{name} at dp {dp} m, {len(sim.water)} water particles, {STEPS} steps:")
            print(f"  {alone * 1e6:.1f} µs a step by step(), {together * 1e6:.1f} µs in one advance()")
            print(f"  position and velocity: {viewed} B as a view, {copied} B as copies")


if __name__ == "__main__":
    main()
