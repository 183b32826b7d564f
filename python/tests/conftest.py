"""Scenes of the tests: small tanks, which a step takes about a millisecond."""

import signal
import sys

import pytest

import pontoon as pt

# A job in the background of a shell begins with Ctrl-C ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)

needs_signals = pytest.mark.skipif(sys.platform == "win32", reason="os.kill with SIGINT ends a process of Windows at once")

TANK = """
title = "A crate afloat"
dimension = 2
dp = 0.05
until = 0.3

[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.0, 0.5] } }

[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 1.0] } }

[[solid]]
name = "crate"
free = { density = 500.0 }
shape = { box = { size = [0.3, 0.2] } }
at = { x = 0.5, draft = "equilibrium" }

[[probe]]
motion = "crate"
every = 0.01

[[probe]]
elevation = { x = 0.2 }
every = 0.01

[frames]
every = 0.1
"""

TANK_3D = """
title = "A crate afloat, 3-D"
dimension = 3
dp = 0.1
until = 0.1

[[water]]
fill = { box = { min = [0.0, 0.0, 0.0], max = [1.0, 0.6, 0.5] } }

[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.6, 1.0] } }

[[solid]]
name = "crate"
free = { density = 500.0 }
shape = { box = { size = [0.4, 0.3, 0.2] } }
at = { x = 0.5, y = 0.3, draft = "equilibrium" }
"""


@pytest.fixture
def tank() -> pt.Scene:
    """A crate afloat in a tank, 2-D."""
    return pt.Scene.from_toml(TANK)


@pytest.fixture
def tank_3d() -> pt.Scene:
    """A crate afloat in a tank, 3-D."""
    return pt.Scene.from_toml(TANK_3D)
