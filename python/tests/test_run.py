"""Runs: the bits of the program, checkpoints at Ctrl-C, results as arrays and tables."""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import pontoon as pt

from conftest import TANK


def files(folder: Path) -> dict[str, bytes]:
    """Returns the series and frames of a run."""
    found = [*sorted((folder / "series").glob("*.csv")), *sorted((folder / "frames").glob("*.vtu"))]
    assert found
    return {str(path.relative_to(folder)): path.read_bytes() for path in found}


def test_command_line_and_python_give_the_same_bits(tmp_path: Path) -> None:
    scene = tmp_path / "crate" / "scene.toml"
    scene.parent.mkdir()
    scene.write_text(TANK)
    command = [sys.executable, "-m", "pontoon", "run", str(scene), "--dp", "0.04", "--out", str(tmp_path / "cli"), "-q"]
    subprocess.run([*command, "--threads", "2"], check=True)
    read = pt.Scene.read(scene.parent)
    read["dp"] = 0.04
    run = pt.run(read, out=tmp_path / "python", threads=1)
    text = pt.Scene.from_toml(TANK).set(dp=0.04)
    other = pt.run(text, out=tmp_path / "text", report=False)
    assert files(tmp_path / "cli") == files(run.folder) == files(other.folder)
    assert (run.folder / "report.html").exists() and not (other.folder / "report.html").exists()
    assert (tmp_path / "text" / "scene" / "scene.toml").read_text() == TANK


@pytest.mark.parametrize("how", ["signal", "function"])
def test_a_stopped_run_goes_on_to_the_same_bits(tank: pt.Scene, tmp_path: Path, how: str) -> None:
    whole = pt.run(tank, out=tmp_path / "whole", report=False)
    tank["frames.every"] = 0.1
    if how == "signal":
        # A second signal would fall into the code of this test.
        sent: list[pt.Progress] = []

        def send(now: pt.Progress) -> None:
            if now.time > 0.05 and not sent:
                sent.append(now)
                os.kill(os.getpid(), signal.SIGINT)

        tank["dp"] = 0.02
        whole = pt.run(tank, out=tmp_path / "finer", report=False)
        with pytest.raises(KeyboardInterrupt) as told:
            pt.run(tank, out=tmp_path / "part", progress=send)
        assert Path(getattr(told.value, "folder")) == tmp_path / "part"
    else:
        tank["dp"] = 0.02
        whole = pt.run(tank, out=tmp_path / "finer", report=False)
        run = pt.run(tank, out=tmp_path / "part", progress=lambda now: now.time < 0.05, report=False)
        assert run.status == "interrupted"
    part = pt.Run(tmp_path / "part")
    assert part.status == "interrupted" and part.manifest["simulated_s"] < 0.3
    done = pt.resume(part.folder, report=False)
    assert done.status == "finished" and files(done.folder) == files(whole.folder)
    with pytest.raises(pt.RestartError):
        pt.resume(done.folder)


def test_results_are_arrays_with_units(tank: pt.Scene, tmp_path: Path) -> None:
    run = pt.run(tank, out=tmp_path / "run", report=False)
    heave = run.series["heave"]
    assert heave.name == "crate.heave_m" and heave.unit == "m" and len(heave) == 31
    assert np.array_equal(run.series["crate.heave"].values, np.asarray(heave))
    assert heave.t[0] == 0.0 and heave.t[-1] == pytest.approx(0.3)
    # A crate that starts on its draft stays there, within a fifth of a spacing.
    assert abs(heave.values).max() < 0.01
    with pytest.raises(KeyError, match="heave"):
        run.series["heav"]
    assert run.series["level"].values[0] == pytest.approx(0.5, abs=0.03)
    assert [frame.number for frame in run.frames] == [0, 1, 2, 3]
    frame = run.frames.at(0.21)
    # A frame is written after the step that reaches its time.
    assert 0.2 <= frame.time < 0.205 and frame.water.position.shape == (run.manifest["particles"]["fluid"], 2)
    assert frame.water.density.mean() == pytest.approx(1000.0, rel=0.02)
    assert run.frames[-1].solids.position.shape[1] == 2
    with pytest.raises(IndexError):
        run.frames[4]
    stats = run.stats("crate")
    assert stats.value("heave", "mean") == pytest.approx(float(heave.values.mean()), abs=1e-4)
    assert run.rao() == []
    assert "<iframe" in run._repr_html_() and (run.folder / "report.html").exists()
    assert run.scene.title == tank.title


def test_tables_for_pandas_and_xarray(tank: pt.Scene, tmp_path: Path) -> None:
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    run = pt.run(tank, out=tmp_path / "run", report=False)
    table = run.to_pandas()
    assert table.attrs["units"]["crate.heave_m"] == "m" and table.index.name == "t_s"
    assert np.array_equal(table["crate.heave_m"].to_numpy(), run.series["heave"].values)
    data = run.to_xarray()
    assert data["crate.heave_m"].attrs["units"] == "m" and data["time"].attrs["units"] == "s"
    assert set(run.stats().to_pandas()["quantity"]) >= {"mean", "std"}


def test_faults_and_wrong_folders_are_told(tank: pt.Scene, tmp_path: Path) -> None:
    with pytest.raises(pt.FileError) as absent:
        pt.Run(tmp_path / "nowhere")
    assert absent.value.code == "checkpoint-not-found"
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    with pytest.raises(pt.UsageError):
        pt.run(tank, out=tmp_path / "full")
    # Water that settles around the crate is faster than this guard allows, again after the rollback.
    tank["guard.speed"] = 1e-5
    with pytest.raises(pt.Fault) as fault:
        pt.run(tank, out=tmp_path / "fault")
    assert fault.value.code == "speed-limit" and fault.value.who.startswith("water particle")
    assert len(fault.value.position) == 2 and fault.value.cause
    assert pt.Run(tmp_path / "fault").status == "failed"


def test_an_exception_of_the_progress_function_stops_the_run(tank: pt.Scene, tmp_path: Path) -> None:
    tank["dp"] = 0.02

    def fail(now: pt.Progress) -> None:
        raise LookupError(f"at {now.time}")

    with pytest.raises(LookupError):
        pt.run(tank, out=tmp_path / "run", progress=fail)
    assert pt.Run(tmp_path / "run").status == "interrupted"


def test_runs_in_threads_are_independent(tank: pt.Scene, tmp_path: Path) -> None:
    def go(number: int) -> None:
        pt.run(tank, out=tmp_path / str(number), threads=1, report=False)

    threads = [threading.Thread(target=go, args=(number,)) for number in range(3)]
    begun = time.monotonic()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert time.monotonic() - begun < 60.0
    assert files(tmp_path / "0") == files(tmp_path / "1") == files(tmp_path / "2")


def test_the_command_of_the_package_is_the_program() -> None:
    told = subprocess.run([sys.executable, "-m", "pontoon", "--version"], check=True, capture_output=True, text=True)
    assert told.stdout.split() == ["pontoon", pt.__version__]
    wrong = subprocess.run([sys.executable, "-m", "pontoon", "run", "nosuch"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "there is no scene" in wrong.stderr


def test_studies_and_validation_give_tables(tank: pt.Scene, tmp_path: Path) -> None:
    tank["until"] = 0.05
    tank["check"] = [{"series": "crate.heave_m", "formula": "0", "bound": {"off": 0.05}}]
    study = pt.study(tank, out=tmp_path / "study", dp=[0.05, 0.04], vary={"model.viscosity": ["none"]})
    assert [row["dp_m"] for row in study.rows] == [0.05, 0.04] and not study.failed
    assert len(study.runs) == 2 and {run.status for run in study.runs} == {"finished"}
    with pytest.raises(pt.Error, match="nosuch"):
        pt.validate("nosuch", out=tmp_path / "cases")
