"""Studies and validation cases: the commands `pontoon study` and `pontoon validate`, with tables as results."""

from __future__ import annotations

import csv
import itertools
import os
import re
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _pontoon, _toml
from ._errors import Error, Fault, UsageError, usage
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
        return [run for run in _runs(self.folder) if run.status == "finished"]

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
    out: str | os.PathLike[str] | None = None,
    dp: Sequence[float] = (),
    vary: Mapping[str, Sequence[Any]] | None = None,
    repeat: int = 1,
    threads: int | None = None,
    quiet: bool = True,
) -> Study:
    """Runs a scene at several spacings, with several values of keys: errors against processor time, orders.

    A run that has finished is not run again. Ctrl-C stops the run in hand with a checkpoint; the same call goes on.

    Args:
        scene: a scene, a folder, a file, or the name of a scene that comes with the package. A scene from a text or a
            dictionary is written to `out/scene` with the files that it names.
        out: folder for runs and results, by default `studies/<scene>`; a scene from a text has the name "scene".
        dp: particle spacings, m; by default that of the scene.
        vary: keys of the scene and their values, as `{"model.kernel": ["wendland", "cubic"]}`.
        repeat: number of runs of each, from starts that differ by a millionth of dp.
        threads: number of threads of each run.
        quiet: whether to print errors only.

    Raises:
        SceneError: a key or a value, also of `vary`, is wrong; tells file, line and remedy. Nothing is run then.
        UsageError: the command refuses its arguments or the folder, as a list of values with nothing in it.
        Fault: the computation of a run cannot go on. The other runs are in the folder.
        Error: a run failed for another reason, which `code` has.
    """
    scene = scene if isinstance(scene, Scene) else Scene.read(scene)
    native, varied = scene._native, [(key, [_toml.value(x) for x in values]) for key, values in (vary or {}).items()]
    kind, word, _, changes = native.origin()
    folder = Path("studies") / (_name(word) if kind == "found" else "scene") if out is None else Path(out)
    # The checks of the command, with the place of an error.
    choices = [[("dp", _toml.value(spacing)) for spacing in dp or [scene.dp]]]
    choices += [[(key, text) for text in texts] for key, texts in varied]
    grid = [native.with_overrides(changed) for changed in itertools.product(*choices)]
    if not grid:
        raise usage("a list of values has nothing in it", "give each key of vary one value or more")
    for changed in grid:
        changed.check()
    file = [changed.file(folder) for changed in grid][0]
    arguments = ["--out", str(folder), "--repeat", str(repeat)]
    arguments += ["--dp", ",".join(_toml.value(x) for x in dp)] if dp else []
    arguments += [word for key, texts in varied for word in ("--vary", f"{key}={','.join(texts)}")]
    arguments += [word for key, text in changes for word in ("--set", f"{key}={text}")]
    failed = _command("study", [os.fspath(file), *arguments], folder, threads, quiet)
    return Study(folder, "study.csv", failed)


def validate(
    *cases: str,
    out: str | os.PathLike[str] = "validation",
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
        UnknownNameError: there is no such case; `help` has the nearest.
        UsageError, Fault, Error: as for `study`.
    """
    _pontoon.check_cases(cases)
    arguments = [*cases, "--out", os.fspath(out), "--repeat", str(repeat), *(["--full"] if full else [])]
    failed = _command("validate", arguments, Path(out), threads, quiet)
    return Study(Path(out), "validation.csv", failed)


def _name(scene: str) -> str:
    """Returns the name of a scene as the command forms it from the path."""
    path = Path(scene)
    return (path.parent if path.name == "scene.toml" else path).stem or "scene"


def _runs(folder: Path) -> list[Run]:
    """Returns the runs of a study, without those that were set aside."""
    manifests = sorted((folder / "runs").glob("*/manifest.json"))
    return [Run(path.parent) for path in manifests if not re.search(r"\.old(-\d+)?$", path.parent.name)]


def _command(name: str, arguments: list[str], folder: Path, threads: int | None, quiet: bool) -> bool:
    """Runs a command of the program in a process of its own; returns whether a check exceeds its bound."""
    command = [sys.executable, "-m", "pontoon", name, *arguments]
    command += ["--threads", str(threads)] if threads is not None else []
    command += ["--quiet"] if quiet else []
    pipe = subprocess.PIPE if quiet else None
    # Ctrl-C in a terminal reaches all processes of the session, and a second one would end the command without a checkpoint.
    own = sys.platform != "win32"
    with subprocess.Popen(
        command, stdout=pipe, stderr=pipe, text=True, encoding="utf-8", start_new_session=own
    ) as process:
        try:
            _, told = process.communicate()
        except KeyboardInterrupt:
            if own:
                process.send_signal(signal.SIGINT)
            process.communicate()
            raise
    code = process.returncode
    if code == 130:
        raise KeyboardInterrupt
    if code not in (0, 3):
        text = (told or f"`pontoon {name}` ended with exit code {code}").removeprefix("error: ").strip()
        raise _failure(folder, text) if code == 1 else _refusal(text)
    return code == 3


def _refusal(text: str) -> UsageError:
    """Returns the exception for the text of a command that refuses its arguments."""
    message, _, help = text.partition("\n")
    return UsageError(text, message=message, help=help.strip() or None)


def _failure(folder: Path, text: str) -> Error:
    """Returns the exception for the first failed run in a folder; `text` is what the command said."""
    for run in _runs(folder):
        if run.status == "failed":
            fault, code = run.manifest.get("fault"), run.manifest.get("error_code")
            return Fault(text, help=fault["cause"], **fault) if fault else Error(text, code=code or "invalid-usage")
    return Error(text)


def _number(text: str) -> Any:
    if text == "":
        return None
    if text in ("true", "false"):
        return text == "true"
    try:
        return float(text)
    except ValueError:
        return text
