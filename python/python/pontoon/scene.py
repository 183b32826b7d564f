"""Scenes: read, changed, inspected, built."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, overload

from . import _toml
from ._errors import unknown
from ._pontoon import NativeScene

if TYPE_CHECKING:
    from .simulation import HostedSimulation, Simulation


@dataclass(frozen=True)
class Finding:
    """A property of a scene that may be unintended.

    Attributes:
        severity: "warning" or "note".
        topic: identifier of its kind, as "capsizes".
        what: description of the fault with its numbers.
        mend: the correction with its number.
    """

    severity: str
    topic: str
    what: str
    mend: str

    def __str__(self) -> str:
        return f"{self.severity}: {self.what}\n  {self.mend}"


class Inspection(Mapping[str, Any]):
    """What a scene would run and what looks wrong with it: a mapping with the keys of `pontoon inspect --json`.

    Attributes:
        findings: what looks wrong, warnings first; empty for an estimate.
    """

    def __init__(self, content: dict[str, Any]) -> None:
        self._content = content
        self.findings = [Finding(**finding) for finding in content.get("findings", [])]

    def __getitem__(self, key: str) -> Any:
        return self._content[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._content)

    def __len__(self) -> int:
        return len(self._content)

    @property
    def warnings(self) -> list[Finding]:
        """The findings that make results inaccurate or the run unlike what is meant."""
        return [finding for finding in self.findings if finding.severity == "warning"]

    @property
    def is_estimate(self) -> bool:
        """Whether the scene has so many particles that its cost is estimated and no findings are made."""
        return bool(self._content.get("estimate", False))

    def __repr__(self) -> str:
        size = self._content.get("size", self._content)
        return f"<Inspection of {self['title']!r}: {size['fluid']:.0f} water particles, {len(self.findings)} findings>"


class Scene:
    """A scene: its file or text, and changed keys.

    >>> scene = Scene.from_toml('''
    ... dimension = 2
    ... dp = 0.05
    ... until = 1.0
    ... water = [{ fill = { box = { min = [0, 0], max = [1, 0.5] } } }]
    ... [[solid]]
    ... name = "tank"
    ... fixed = true
    ... shape = { tank = { size = [1.0, 1.0] } }
    ... ''')
    >>> scene["dp"] = 0.1
    >>> scene.dp
    0.1
    """

    def __init__(self, native: NativeScene) -> None:
        self._native = native

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Scene:
        """Reads a folder with a `scene.toml`, a scene file, or a scene that comes with the package, by its name.

        Raises:
            UsageError: there is no such scene; names the nearest.
            SceneError: a key or a value is wrong; tells file, line and remedy.
        """
        return cls(NativeScene.find(os.fspath(path), []))

    @classmethod
    def from_toml(cls, text: str, *, folder: str | os.PathLike[str] = "") -> Scene:
        """Reads a scene from a text. Files that it names are in `folder`.

        Raises:
            SceneError: a key or a value is wrong; tells line and remedy.
        """
        return cls(NativeScene.parse(text, os.fspath(folder), []))

    @classmethod
    def from_dict(cls, content: Mapping[str, Any], *, folder: str | os.PathLike[str] = "") -> Scene:
        """Builds a scene from the keys and values of a scene file; a section that may repeat is a list of dictionaries.

        >>> scene = Scene.from_dict({
        ...     "dimension": 2, "dp": 0.05, "until": 1.0,
        ...     "water": [{"fill": {"box": {"min": [0, 0], "max": [1, 0.5]}}}],
        ...     "solid": [{"name": "tank", "fixed": True, "shape": {"tank": {"size": [1.0, 1.0]}}}],
        ... })

        Args:
            content: numbers, strings, lists, NumPy arrays and dictionaries.
            folder: folder of the files that the scene names.

        Raises:
            SceneError: as `from_toml`.
            TypeError: a value has no form in TOML.
        """
        return cls.from_toml(_toml.section(content), folder=folder)

    def __setitem__(self, key: str, value: Any) -> None:
        """Changes a key, as `--set` of the program does: "dp", "model.viscosity", "solid.buoy.free.density".

        A value is a number, a string, a list or a dictionary.

        Raises:
            SceneError: the scene has no such key, or the value is of the wrong kind. The scene is then as before. Whether values
                fit together is told when the scene is inspected, built or run.
        """
        self._native = self._native.with_overrides([(key, _toml.value(value))])

    def set(self, **values: Any) -> Scene:
        """Returns a copy with changed keys of the top level, as `scene.set(dp=0.02, until=3.0)`."""
        changed = self.copy()
        for key, value in values.items():
            changed[key] = value
        return changed

    def __getitem__(self, key: str) -> Any:
        """Returns the effective value of a key, as `scene["solid.buoy.free.density"]`, be it a default.

        Entries of lists are found by name or number: `scene["joint.hinge.kind"]`, `scene["joint.0.kind"]`.

        Raises:
            UnknownNameError: there is no effective value with this key. It is a KeyError too.
        """
        values = {known: value for known, value, _ in self._native.values()}
        section, _, rest = key.partition(".")
        name, _, rest = rest.partition(".")
        numbered = re.compile(rf"{re.escape(section)}\.(\d+)\.name")
        for known, value in values.items():
            found = numbered.fullmatch(known)
            if found and key not in values and parsed(value) == name:
                key = f"{section}.{found[1]}.{rest}"
        if key not in values:
            raise unknown("effective value with the key", key, values, code="unknown-key")
        return parsed(values[key])

    def copy(self) -> Scene:
        """Returns a scene with the same origin and the same changed keys."""
        return Scene(self._native)

    def values(self) -> dict[str, tuple[Any, str]]:
        """Returns every effective value with its source: a line of the scene, a change, or a default with its reason."""
        return {key: (parsed(value), source) for key, value, source in self._native.values()}

    @property
    def title(self) -> str | None:
        """Caption."""
        return self._native.title

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._native.dimension

    @property
    def dp(self) -> float:
        """Particle spacing, m."""
        return self._native.dp

    @property
    def until(self) -> float:
        """Simulated time at the end, s."""
        return self._native.until

    @property
    def changes(self) -> dict[str, str]:
        """Changed keys with their values as TOML."""
        return dict(self._native.origin()[3])

    def to_toml(self) -> str:
        """Returns the scene with its changed keys as TOML."""
        return self._native.to_toml()

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene as TOML to a file."""
        Path(path).write_text(self.to_toml(), encoding="utf-8")

    def inspect(self, *, timing: bool = False, threads: int | None = None) -> Inspection:
        """Returns particles, memory, drafts, waves and findings, without a run.

        Args:
            timing: step for up to a second, to measure the time on this machine: `["timing"]["step_s"]` (s per step) and
                `["timing"]["run_s"]` (s; hours are this over 3600). Without it `["timing"]` is None. The estimate of a scene
                of more than 4 million particles has no timing, but `["thread_seconds"]` at the usual speed.
            threads: number of threads of the timing.

        Raises:
            SceneError: a value or a file of the scene is wrong.
        """
        content: dict[str, Any] = json.loads(self._native.inspect(threads, timing))
        return Inspection(content)

    @overload
    def build(self, *, hosted: Literal[False] = False, threads: int | None = None) -> Simulation: ...
    @overload
    def build(self, *, hosted: Literal[True], threads: int | None = None) -> HostedSimulation: ...
    def build(self, *, hosted: bool = False, threads: int | None = None) -> Simulation | HostedSimulation:
        """Builds a simulation to be stepped; it writes no files.

        Args:
            hosted: whether another program moves the free solids: `build_hosted`.
            threads: number of threads, by default one for each processor. It changes the speed, never the result.

        Raises:
            SceneError: a value or a file of the scene is wrong.
        """
        from .simulation import Simulation

        return self.build_hosted(threads=threads) if hosted else Simulation(self, threads=threads)

    def build_hosted(self, *, threads: int | None = None) -> HostedSimulation:
        """Builds a simulation whose free solids another program moves: it takes loads and returns motions.

        Raises:
            SceneError: the scene has joints, springs, ropes, forces or contacts; they belong to that program.
        """
        from .simulation import HostedSimulation

        return HostedSimulation(self, threads=threads)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_scene, self._native.origin())

    def __deepcopy__(self, memo: dict[int, Any]) -> Scene:
        return self.copy()

    def __repr__(self) -> str:
        return f"<Scene {self.title!r}: {self.dimension}-D, dp {self.dp} m, until {self.until} s>"


def parsed(text: str) -> Any:
    """Returns the value of a TOML text."""
    if text in ("true", "false"):
        return text == "true"
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return float(text)
    except ValueError:
        pass
    if text.startswith('"') and text.endswith('"'):
        try:
            return json.loads(text)
        except ValueError:
            return text[1:-1]
    if text.startswith("["):
        try:
            return json.loads(text)
        except ValueError:
            return text
    return text


def _scene(kind: str, content: str, folder: str, changes: list[tuple[str, str]]) -> Scene:
    if kind == "found":
        return Scene(NativeScene.find(content, changes))
    return Scene(NativeScene.parse(content, folder, changes))
