"""Probes that `Simulation.read` reads at any time: dictionaries with the keys of a `[[probe]]` section."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

Probe = Mapping[str, Any]


def elevation(at: float | Sequence[float], *, surface: str = "highest") -> dict[str, Any]:
    """Elevation of the free surface (m) at x in 2-D, at (x, y) in 3-D.

    Args:
        at: horizontal place, m.
        surface: "highest", "lowest" or "all", where several surfaces lie above one another.
    """
    place = [at] if isinstance(at, (int, float)) else list(at)
    gauge: dict[str, Any] = dict(zip(("x", "y"), (float(x) for x in place), strict=False))
    return {"elevation": gauge | {"surface": surface}}


def pressure(at: Sequence[float]) -> dict[str, Any]:
    """Pressure of the water (Pa) at a point (m)."""
    return {"pressure": [float(x) for x in at]}


def velocity(at: Sequence[float]) -> dict[str, Any]:
    """Velocity of the water (m/s) at a point (m)."""
    return {"velocity": [float(x) for x in at]}


def flow(start: Sequence[float], end: Sequence[float]) -> dict[str, Any]:
    """Flow of the water through the section from `start` to `end` (m)."""
    return {"flow": {"from": [float(x) for x in start], "to": [float(x) for x in end]}}


def motion(solid: str) -> dict[str, Any]:
    """Motion of the solid with this name."""
    return {"motion": solid}


def force(solid: str) -> dict[str, Any]:
    """Force and torque of the water on the solid with this name."""
    return {"force": solid}


def joint(name: str) -> dict[str, Any]:
    """Reaction and motion of the joint with this name."""
    return {"joint": name}


def spring(name: str) -> dict[str, Any]:
    """Length and tension of the spring with this name."""
    return {"spring": name}


def rope(name: str) -> dict[str, Any]:
    """Length and tension of the rope with this name."""
    return {"rope": name}


def runup(solid: str) -> dict[str, Any]:
    """Run-up of the water on the solid with this name, m."""
    return {"runup": solid}


def contact(first: str, second: str) -> dict[str, Any]:
    """Contact force between two solids."""
    return {"contact": [first, second]}


def energy() -> dict[str, Any]:
    """Energies of water and bodies, J (J/m in 2-D)."""
    return {"energy": True}
