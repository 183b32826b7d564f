"""Runs with their files: started, gone on with, read."""

from __future__ import annotations

import csv
import html
import json
import math
import os
import sys
import time as clock
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _pontoon
from ._errors import FileError, RestartError, UnknownNameError, unknown, usage
from .scene import Scene, parsed

if TYPE_CHECKING:
    import pandas
    import xarray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Progress:
    """Progress of a run.

    Attributes:
        folder: the folder of the run.
        time, until: simulated time now and at the end, s.
        dt: length of the last step, s.
        steps: number of completed steps.
        wall: wall time so far, s.
    """

    folder: Path
    time: float
    until: float
    dt: float
    steps: int
    wall: float


@dataclass(frozen=True)
class Series:
    """A series of a run.

    Attributes:
        name: "probe.column", as "buoy.heave_m".
        t: times, s: (N,).
        values: (N,).
        unit: unit of the values, as "m".
    """

    name: str
    t: Floats
    values: Floats
    unit: str
    #: Whether each value but the first is the mean since the one before.
    _is_mean: bool = False

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.values, dtype=dtype)

    def harmonic(self, period: float, since: float = 0.0) -> complex:
        """Returns the harmonic of `period` (s) as the factor of exp(iωt), in the unit of the values, beside a mean and a trend.

        Least squares over the whole periods at the end that begin at or after the time `since` (s). A mean counts in the middle
        of its interval.

        Raises:
            UsageError: there is no whole period.
        """
        whole = math.floor((self.t[-1] - since) / period) * period if period > 0.0 and len(self) else 0.0
        if not whole > 0.0:
            raise usage(f"{self.name} has no whole period of {period:g} s after {since:g} s", "give a period above 0 s that the series holds")
        chosen = self.t >= self.t[-1] - whole
        t, x = self._middles()[chosen], self.values[chosen]
        phase = 2.0 * np.pi * t / period
        basis = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase), t], axis=1)
        cosine, sine, *_ = np.linalg.lstsq(basis, x, rcond=None)[0]
        return complex(cosine, -sine)

    def _middles(self) -> Floats:
        """Returns the times to which the values belong: the middle of its interval for a mean."""
        middles: Floats = self.t.copy()
        if self._is_mean:
            middles[1:] = 0.5 * (self.t[:-1] + self.t[1:])
        return middles

    def __len__(self) -> int:
        return len(self.values)


class AllSeries(Mapping[str, Series]):
    """The series of a run by name. A part of a name is enough if it belongs to one series: "heave" for "buoy.heave_m".

    An unknown name raises UnknownNameError, which is a KeyError too.
    """

    def __init__(self, folder: Path, probes: Collection[Mapping[str, Any]]) -> None:
        self._kinds = {str(probe.get("name")): probe for probe in probes}
        self._tables: dict[str, tuple[Floats, dict[str, Floats]]] = {}
        self._names: dict[str, tuple[str, str]] = {}
        for path in sorted((folder / "series").glob("*.csv")):
            times, columns = _read_table(path)
            self._tables[path.stem] = (times, columns)
            self._names.update({f"{path.stem}.{column}": (path.stem, column) for column in columns})

    def __getitem__(self, name: str) -> Series:
        full = full_name(name, self._names)
        table, column = self._names[full]
        times, columns = self._tables[table]
        return Series(full, times, columns[column], _pontoon.unit(column), _is_mean(self._kinds.get(table, {}), column))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


@dataclass(frozen=True)
class Statistic:
    """A statistic of a series.

    Attributes:
        name: name of the `[[statistic]]` of the scene; empty for one that every series has.
        series: "probe.column".
        quantity: as "mean", "H_m0", "T_p".
        value, unit: its value and unit.
        from_s, until_s: the times that were evaluated, s.
    """

    name: str
    series: str
    quantity: str
    value: float
    unit: str
    from_s: float
    until_s: float


class Statistics(list[Statistic]):
    """The statistics of a run.

    Attributes:
        remarks: why statistics are missing.
    """

    def __init__(self, rows: list[Statistic], remarks: list[str]) -> None:
        super().__init__(rows)
        self.remarks = remarks

    def value(self, series: str, quantity: str, name: str | None = None) -> float:
        """Returns the value of a quantity of a series, as `stats.value("buoy.heave_m", "H_mean")`.

        Args:
            series: "probe.column", or a part of it that belongs to one series.
            quantity: as "mean".
            name: name of the `[[statistic]]`; by default the statistic that every series has, else the only one.

        Raises:
            UnknownNameError: no series or several have such a quantity, or several statistics. It is a KeyError too.
        """
        rows = [row for row in self if row.quantity == quantity and (name is None or row.name == name)]
        known = list(dict.fromkeys(row.series for row in rows))
        if series not in known and not any(series in _short_names(full) for full in known):
            raise unknown("statistic", f"{series} {quantity}", [f"{row.series} {row.quantity}" for row in self])
        full = full_name(series, known)
        rows = [row for row in rows if row.series == full]
        usual = [row for row in rows if row.name == ""] or rows
        if len(usual) > 1:
            what = f"{full} has several values of {quantity}: of {', '.join(row.name for row in usual)}"
            help = "give the name of the statistic"
            raise UnknownNameError(f"{what}\n  {help}", code="unknown-name", message=what, help=help)
        return usual[0].value

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a table with a row for each statistic."""
        import pandas

        table: pandas.DataFrame = pandas.DataFrame([vars(row) for row in self])
        return table


@dataclass(frozen=True)
class Rao:
    """How a motion answers the irregular wave of the scene, over frequency.

    Attributes:
        name: name of the `[[statistic]]`.
        motion: series of the motion.
        unit: unit of `amplitude`, as "m/m".
        frequency: Hz: (N,).
        amplitude: amplitude of the motion over that of the wave: (N,).
        phase: phase of the motion less that of the wave, degrees: (N,).
        coherence: share of the variance of the motion that is linearly related to the wave, 0 to 1: (N,).
    """

    name: str
    motion: str
    unit: str
    frequency: Floats
    amplitude: Floats
    phase: Floats
    coherence: Floats


@dataclass(frozen=True)
class Points:
    """Particles of a frame.

    Attributes:
        position: m: (N, D).
        velocity: m/s: (N, D); empty if the frames do not have it, as all below.
        density: kg/m³: (N,).
        pressure: Pa: (N,).
        id: names of the particles for life: (N,).
        solid: number of the solid of each boundary particle: (N,); empty for water.
    """

    position: NDArray[np.float32]
    velocity: NDArray[np.float32]
    density: NDArray[np.float32]
    pressure: NDArray[np.float32]
    id: NDArray[np.uint32]
    solid: NDArray[np.float32]


class Frame:
    """A frame of a run; its particles are read when they are asked for."""

    def __init__(self, folder: Path, number: int, time: float, dimension: int) -> None:
        self._folder, self.number, self.time, self._dimension = folder, number, time, dimension

    def _points(self, solids: bool) -> Points:
        arrays = _pontoon.frame(self._folder, self.number, solids)
        for name in ("position", "velocity"):
            if name in arrays:
                arrays[name] = arrays[name][:, : self._dimension]
        empty = {"id": np.empty(0, np.uint32), "velocity": np.empty((0, self._dimension), np.float32)}
        names = ("position", "velocity", "density", "pressure", "id", "solid")
        return Points(*(arrays.get(name, empty.get(name, np.empty(0, np.float32))) for name in names))

    @property
    def water(self) -> Points:
        """The water particles."""
        return self._points(False)

    @property
    def solids(self) -> Points:
        """The boundary particles of all solids."""
        return self._points(True)

    def __repr__(self) -> str:
        return f"<Frame {self.number} at t = {self.time:.6g} s>"


class Frames:
    """The frames of a run, by number or, with `at`, by time."""

    def __init__(self, folder: Path, dimension: int) -> None:
        self._folder, self._dimension = folder, dimension
        self.times: Floats = np.array(_pontoon.frame_times(folder))

    def __len__(self) -> int:
        return len(self.times)

    def __getitem__(self, number: int) -> Frame:
        index = range(len(self.times))[number]
        return Frame(self._folder, index, float(self.times[index]), self._dimension)

    def __iter__(self) -> Iterator[Frame]:
        return (self[number] for number in range(len(self)))

    def at(self, time: float) -> Frame:
        """Returns the frame nearest to a time (s)."""
        if len(self.times) == 0:
            raise usage(f"the run in {self._folder} has no frames", "set frames.every in the scene")
        return self[int(np.argmin(np.abs(self.times - time)))]


class Run:
    """The folder of a run, finished or not.

    >>> run = pontoon.Run("runs/raft")                                      # doctest: +SKIP
    >>> run.series["heave"].values                                          # doctest: +SKIP

    Raises:
        FileError: there is no such folder, or it holds no run.
        RestartError: its `manifest.json` is damaged.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        path = self.folder / "manifest.json"
        try:
            self._manifest: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except OSError as why:
            code = "checkpoint-not-found" if self.folder.is_dir() else "file-not-found"
            what = f"{self.folder} holds no run: {why.strerror or why}"
            help = "name the folder that `pontoon run` or pontoon.run wrote: it holds a manifest.json"
            raise FileError(f"{what}\n  {help}", code=code, message=what, help=help) from None
        except ValueError as why:
            what = f"{path} is damaged: {why}"
            help = "run the scene again, or restore the file from a copy"
            raise RestartError(f"{what}\n  {help}", code="bad-checkpoint", message=what, help=help) from None
        self._series: AllSeries | None = None
        self._frames: Frames | None = None

    @property
    def manifest(self) -> dict[str, Any]:
        """The content of `manifest.json`: particles, steps, wall time, checks, warnings, every effective value."""
        return self._manifest

    @property
    def status(self) -> str:
        """ "finished", "interrupted", "failed" or "running"."""
        return str(self._manifest["status"])

    @property
    def title(self) -> str:
        """Caption of the scene."""
        return str(self._manifest["title"])

    @property
    def warnings(self) -> list[str]:
        """The warnings of the run."""
        return list(self._manifest["warnings"])

    @property
    def checks(self) -> list[dict[str, Any]]:
        """The verdicts of the checks of the scene."""
        return list(self._manifest["checks"])

    @property
    def scene(self) -> Scene:
        """The scene of the run with its changed keys."""
        return Scene.from_toml(str(self._manifest["scene"]), folder=self.folder / "scene")

    @property
    def series(self) -> AllSeries:
        """The series by name."""
        if self._series is None:
            self._series = AllSeries(self.folder, self._probes())
        return self._series

    def _probes(self) -> list[dict[str, Any]]:
        """Returns the keys of each probe with their effective values."""
        probes: dict[str, dict[str, Any]] = {}
        for entry in self._manifest.get("values", []):
            section, _, rest = entry["key"].partition(".")
            number, _, key = rest.partition(".")
            if section == "probe":
                probes.setdefault(number, {})[key] = parsed(entry["value"])
        return list(probes.values())

    @property
    def frames(self) -> Frames:
        """The frames."""
        if self._frames is None:
            self._frames = Frames(self.folder, self.scene.dimension)
        return self._frames

    def to_pandas(self) -> pandas.DataFrame:
        """Returns all series in one table with the time as index; `attrs["units"]` has the unit of each column.

        Series with other times have gaps where only others have a reading.
        """
        import pandas

        columns = {name: pandas.Series(s.values, index=s.t, name=name) for name, s in self.series.items()}
        table: pandas.DataFrame = pandas.DataFrame(columns)
        table.index.name = "t_s"
        table.attrs["units"] = {name: s.unit for name, s in self.series.items()}
        table.attrs["title"] = self.title
        return table

    def to_xarray(self) -> xarray.Dataset:
        """Returns all series as a data set over `time` (s); each variable has `attrs["units"]`."""
        import xarray

        table = self.to_pandas()
        data = xarray.Dataset(
            {
                name: ("time", table[name].to_numpy(), {"units": "1" if s.unit == "–" else s.unit})
                for name, s in self.series.items()
            },
            coords={"time": ("time", table.index.to_numpy(), {"units": "s"})},
            attrs={"title": self.title, "source": f"pontoon {self._manifest['version']}"},
        )
        return data

    def _statistics(self, series: str | None, start: float | None, end: float | None) -> dict[str, Any]:
        content: dict[str, Any] = json.loads(_pontoon.statistics(self.folder, series, start, end))
        return content

    def stats(
        self, series: str | None = None, *, start: float | None = None, end: float | None = None
    ) -> Statistics:
        """Returns means, extremes, waves and spectra of the series, as `pontoon stats` does.

        Args:
            series: a probe or a series; by default all.
            start, end: the times that are evaluated, s.

        Raises:
            UsageError: there is no such series.
        """
        content = self._statistics(series, start, end)
        return Statistics([Statistic(**row) for row in content["rows"]], content["remarks"])

    def rao(self, *, start: float | None = None, end: float | None = None) -> list[Rao]:
        """Returns how motions answer irregular waves over frequency, for each `[[statistic]]` that asks for it."""
        groups: dict[tuple[str, str, str], list[dict[str, Any]]] = {}
        for row in self._statistics(None, start, end)["raos"]:
            groups.setdefault((row["name"], row["series"], row["unit"]), []).append(row)
        columns = ("frequency_hz", "rao", "phase_deg", "coherence")
        return [
            Rao(*key, *(np.array([row[column] for row in rows], dtype=float) for column in columns))
            for key, rows in groups.items()
        ]

    def report(self) -> Path:
        """Writes the page of the run, a player with plots and tables in one file, and returns its path."""
        return Path(_pontoon.write_report(self.folder))

    def _repr_html_(self) -> str:
        """The page of the run, for Jupyter."""
        page = self.folder / "report.html"
        if not page.exists():
            page = self.report()
        content = html.escape(page.read_text(encoding="utf-8"), quote=True)
        return f'<iframe srcdoc="{content}" style="width: 100%; height: 640px; border: 0"></iframe>'

    def __repr__(self) -> str:
        now, end = self._manifest["simulated_s"], self._manifest["until_s"]
        return f"<Run {str(self.folder)!r}: {self.status}, t = {now:.6g} of {end:.6g} s>"


def run(
    scene: Scene | str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    progress: bool | Callable[[Progress], object] = False,
    report: bool = True,
) -> Run:
    """Runs a scene to its end with its files, as `pontoon run` does, to the same bits.

    Ctrl-C stops after the present step with a checkpoint and raises KeyboardInterrupt, whose attribute `folder` is the
    folder of the run; `resume` goes on from there.

    Args:
        scene: a scene, a folder, a file, or the name of a scene that comes with the package.
        out: folder for the results, new or empty; by default `runs/<scene>`, numbered if taken.
        threads: number of threads, by default one for each processor. It changes the speed, never the result.
        progress: True prints a line; a function gets a `Progress` about twenty times a second, and stops the run with a
            checkpoint if it returns False.
        report: whether to write the page at the end.

    Raises:
        SceneError, UsageError, FileError: before anything is computed.
        Fault: the computation cannot go on; the folder of the run holds all output up to then.
    """
    scene = scene if isinstance(scene, Scene) else Scene.read(scene)
    place = None if out is None else os.fspath(out)
    return _ended(scene._native.run(place, threads, _follower(progress)), report)


def resume(
    folder: str | os.PathLike[str],
    *,
    guard: Mapping[str, str] | None = None,
    threads: int | None = None,
    progress: bool | Callable[[Progress], object] = False,
    report: bool = True,
) -> Run:
    """Goes on with an interrupted run, to the same bits as an unbroken one.

    Args:
        folder: the folder of the run.
        guard: changed keys of `[guard]`, as `{"guard.escape": "remove"}`.
        threads, progress, report: as for `run`.

    Raises:
        RestartError: the run has finished, or there is no checkpoint.
        UsageError: `guard` names another key.
        Fault: the computation cannot go on.
    """
    changes = [(key, str(value)) for key, value in (guard or {}).items()]
    return _ended(_pontoon.resume(os.fspath(folder), changes, threads, _follower(progress)), report)


def scenes() -> dict[str, str]:
    """Returns the names of the scenes that come with the package, and the first sentence about each."""
    return {name: about for name, _, about in _pontoon.bundled_scenes()}


def _ended(outcome: tuple[Any, str, bool], report: bool) -> Run:
    done = Run(outcome[0])
    if report:
        done.report()
    return done


def _follower(progress: bool | Callable[[Progress], object]) -> Callable[..., object] | None:
    if progress is False:
        return None
    follow = _Line() if progress is True else progress

    def follower(folder: Any, time: float, until: float, dt: float, steps: int, wall: float) -> object:
        return follow(Progress(Path(folder), time, until, dt, steps, wall))

    return follower


class _Line:
    """Prints progress on one line of standard error, twice a second."""

    def __init__(self) -> None:
        self._last, self._ended = 0.0, False

    def __call__(self, now: Progress) -> None:
        done = now.time >= now.until
        if self._ended or (clock.monotonic() - self._last < 0.5 and not done):
            return
        self._last, self._ended = clock.monotonic(), done
        share = now.time / now.until
        left = f", {now.wall * (1.0 - share) / share:.0f} s left" if 0.0 < share < 1.0 else ""
        text = f"\r{100.0 * share:3.0f} %  t = {now.time:.4g} of {now.until:.4g} s, {now.steps} steps{left} "
        sys.stderr.write(text.ljust(72) + ("\n" if done else ""))
        sys.stderr.flush()


def full_name(name: str, known: Collection[str]) -> str:
    """Returns the series "probe.column" among `known` that `name` or a unique part of a name means.

    Raises:
        UnknownNameError: there is none, or several.
    """
    if name in known:
        return name
    found = [full for full in known if name in _short_names(full)]
    if len(found) == 1:
        return found[0]
    if found:
        what, help = f"{name!r} may be each of {', '.join(found)}", "give the whole name"
        raise UnknownNameError(f"{what}\n  {help}", code="unknown-name", message=what, help=help)
    raise unknown("series", name, known)


def _is_mean(probe: Mapping[str, Any], column: str) -> bool:
    """Returns whether readings in a column of a probe with these keys are means; totals are none."""
    is_total = column.startswith(("volume_", "absorbed_")) or "budget" in probe
    is_total = is_total or ("face" in probe and not column.startswith("water_"))
    return probe.get("average") is True and not is_total


def _short_names(full: str) -> set[str]:
    """Returns the names by which a series may be called: without its probe, without its unit, without both."""
    probe, column = full.split(".", 1)
    plain = column.rsplit("_", 1)[0] if _pontoon.unit(column) != "–" else column
    return {column, plain, f"{probe}.{plain}"}


def _read_table(path: Path) -> tuple[Floats, dict[str, Floats]]:
    """Reads times (s) and columns of a table of series."""
    with path.open(encoding="utf-8", newline="") as file:
        head = next(csv.reader(file), [])
        rows = [[float(word) if word else float("nan") for word in row] for row in csv.reader(file)]
    numbers = np.array(rows, dtype=float).reshape(len(rows), len(head))
    return numbers[:, 0].copy(), {name: numbers[:, i].copy() for i, name in enumerate(head) if i > 0}
