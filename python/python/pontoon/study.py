"""Studies and validation cases: the commands `pontoon study` and `pontoon validate`, with tables as results."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _toml
from ._errors import Error, usage
from .run import Run
from .scene import Scene

if TYPE_CHECKING:
    import pandas


class Study:
    """The results of a study or of validation cases.

    Attributes:
        folder: the folder with the results and the runs.
        rows: a dictionary for each run and check, with the columns of `study.csv`; empty fields are None.
        failed: whether a check exceeds its bound.
    """

    def __init__(self, folder: Path, table: str, failed: bool) -> None:
        self.folder, self.failed = folder, failed
        with (folder / table).open(encoding="utf-8", newline="") as file:
            self.rows = [{key: _number(text) for key, text in row.items()} for row in csv.DictReader(file)]

    @property
    def runs(self) -> list[Run]:
        """The runs that have finished."""
        folders = sorted({path.parent for path in (self.folder / "runs").glob("*/manifest.json")})
        return [run for run in map(Run, folders) if run.status == "finished" and not run.folder.name.endswith(".old")]

    def to_pandas(self) -> pandas.DataFrame:
        """Returns the rows as a table."""
        import pandas

        table: pandas.DataFrame = pandas.DataFrame(self.rows)
        return table

    def __repr__(self) -> str:
        return f"<Study {str(self.folder)!r}: {len(self.rows)} rows>"


def study(
    scene: Scene | str | os.PathLike[str],
    *,
    out: str | os.PathLike[str],
    dp: Sequence[float] = (),
    vary: Mapping[str, Sequence[Any]] | None = None,
    repeat: int = 1,
    threads: int | None = None,
    quiet: bool = True,
) -> Study:
    """Runs a scene at several spacings, with several values of keys: errors against processor time, orders.

    A run that has finished is not run again; after Ctrl-C the same call goes on.

    Args:
        scene: a scene, a folder, a file, or the name of a scene that comes with the package.
        out: folder for runs and results.
        dp: particle spacings, m; by default that of the scene.
        vary: keys of the scene and their values, as `{"model.kernel": ["wendland", "cubic"]}`.
        repeat: number of runs of each, from starts that differ by a millionth of dp.
        threads: number of threads of each run.
        quiet: whether to print errors only.

    Raises:
        SceneError: the scene is wrong.
        Error: the command ended with an error, whose text the exception has.
    """
    scene = scene if isinstance(scene, Scene) else Scene.read(scene)
    arguments = ["--out", os.fspath(out), "--repeat", str(repeat)]
    if dp:
        arguments += ["--dp", ",".join(repr(float(x)) for x in dp)]
    for key, values in (vary or {}).items():
        arguments += ["--vary", f"{key}={','.join(_toml.value(x) for x in values)}"]
    kind, content, folder, changes = scene._native.origin()
    for key, text in changes:
        arguments += ["--set", f"{key}={text}"]
    if kind == "found":
        failed = _command("study", [content, *arguments], threads, quiet)
    else:
        if folder:
            raise usage("a study of a text does not find its files", "write the scene to a file with scene.write")
        with tempfile.TemporaryDirectory() as place:
            path = Path(place) / "scene.toml"
            path.write_text(content, encoding="utf-8")
            failed = _command("study", [str(path), *arguments], threads, quiet)
    return Study(Path(out), "study.csv", failed)


def validate(
    *cases: str,
    out: str | os.PathLike[str],
    full: bool = False,
    repeat: int = 1,
    threads: int | None = None,
    quiet: bool = True,
) -> Study:
    """Runs validation cases and judges them: errors against theory and experiments, bounds.

    Args:
        cases: names of `pontoon validate --list`; by default the usual ones, coarse: some minutes.
        out: folder for runs and results.
        full: as fine and as long as the papers: hours to days.
        repeat, threads, quiet: as for `study`.

    Raises:
        Error: the command ended with an error, whose text the exception has.
    """
    arguments = [*cases, "--out", os.fspath(out), "--repeat", str(repeat), *(["--full"] if full else [])]
    failed = _command("validate", arguments, threads, quiet)
    return Study(Path(out), "validation.csv", failed)


def _command(name: str, arguments: list[str], threads: int | None, quiet: bool) -> bool:
    """Runs a command of the program in a process of its own; returns whether a check exceeds its bound."""
    command = [sys.executable, "-m", "pontoon", name, *arguments]
    command += ["--threads", str(threads)] if threads is not None else []
    command += ["--quiet"] if quiet else []
    done = subprocess.run(command, stdout=subprocess.PIPE if quiet else None, stderr=subprocess.PIPE, text=True)
    if done.returncode == 130:
        raise KeyboardInterrupt
    if done.returncode not in (0, 3):
        text = done.stderr.removeprefix("error: ").strip()
        raise Error(text or f"`pontoon {name}` ended with exit code {done.returncode}")
    return done.returncode == 3


def _number(text: str) -> Any:
    if text == "":
        return None
    if text in ("true", "false"):
        return text == "true"
    try:
        return float(text)
    except ValueError:
        return text
