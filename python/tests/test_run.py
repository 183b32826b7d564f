"""Runs: the bits of the program, checkpoints at Ctrl-C, results as arrays and tables."""

import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import pontoon as pt
from pontoon.run import Statistics

from conftest import TANK, TANK_3D, needs_signals


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


@pytest.mark.skipif("PONTOON_PROGRAM" not in os.environ, reason="PONTOON_PROGRAM names no program")
def test_the_program_of_cargo_gives_the_bits_of_the_wheel(tmp_path: Path) -> None:
    scene = tmp_path / "crate" / "scene.toml"
    scene.parent.mkdir()
    scene.write_text(TANK)
    program = os.environ["PONTOON_PROGRAM"]
    subprocess.run([program, "run", str(scene), "--out", str(tmp_path / "program"), "--threads", "2", "-q"], check=True)
    run = pt.run(scene, out=tmp_path / "wheel", threads=1, report=False)
    assert files(tmp_path / "program") == files(run.folder)


@pytest.mark.parametrize("how", [pytest.param("signal", marks=needs_signals), "function"])
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


def test_a_harmonic_is_found_beside_a_mean_and_a_trend() -> None:
    t = np.linspace(0.0, 4.3, 431)
    values = 0.2 * np.cos(2.0 * np.pi * t / 1.2 + 0.7) + 0.05 + 0.01 * t
    series = pt.Series("box.heave_m", t, values, "m")
    found = series.harmonic(1.2, since=1.0)
    assert abs(found) == pytest.approx(0.2, abs=1e-9) and np.angle(found) == pytest.approx(0.7, abs=1e-9)
    for period in (5.0, 0.0, -1.0):
        with pytest.raises(pt.UsageError, match="whole period"):
            series.harmonic(period)


def test_results_are_arrays_with_units(tank: pt.Scene, tmp_path: Path) -> None:
    run = pt.run(tank, out=tmp_path / "run", report=False)
    heave = run.series["heave"]
    assert heave.name == "crate.heave_m" and heave.unit == "m" and len(heave) == 31
    assert np.array_equal(run.series["crate.heave"].values, np.asarray(heave))
    assert heave.t[0] == 0.0 and heave.t[-1] == pytest.approx(0.3)
    # A crate that starts on its draft stays there, within a fifth of a spacing.
    assert abs(heave.values).max() < 0.01
    with pytest.raises(KeyError, match="heave") as unknown:
        run.series["heav"]
    assert isinstance(unknown.value, pt.UnknownNameError) and "heave" in (unknown.value.help or "")
    assert "crate.heave_m" in run.series and "heav" not in run.series
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
    with pytest.raises(pt.UnknownNameError, match="crate.heave_m mean"):
        stats.value("crate.heave_m", "meen")
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
    assert absent.value.code == "file-not-found" and "manifest.json" in (absent.value.help or "")
    with pytest.raises(pt.FileError) as empty:
        pt.Run(tmp_path)
    assert empty.value.code == "checkpoint-not-found"
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "manifest.json").write_text("{")
    with pytest.raises(pt.RestartError) as damaged:
        pt.Run(tmp_path / "damaged")
    assert damaged.value.code == "bad-checkpoint" and damaged.value.help
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
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    runs = [pt.Run(tmp_path / str(number)) for number in range(3)]
    assert {run.status for run in runs} == {"finished"}
    assert files(runs[0].folder) == files(runs[1].folder) == files(runs[2].folder)


def test_the_command_of_the_package_is_the_program() -> None:
    told = subprocess.run([sys.executable, "-m", "pontoon", "--version"], check=True, capture_output=True, text=True)
    assert told.stdout.split() == ["pontoon", pt.__version__]
    wrong = subprocess.run([sys.executable, "-m", "pontoon", "run", "nosuch"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "there is no scene" in wrong.stderr


IRREGULAR = """
title = "A crate between small waves"
dimension = 2
dp = 0.05
until = 30.0
frames = "off"

[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.2, 0.3] } }

[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.5, 0.8] } }
at = { x = -0.3 }

[[solid]]
name = "paddle"
shape = { box = { size = [0.2, 0.7] } }
at = { x = -0.1, bottom = 0.0 }
driven = { along = [1.0, 0.0], distance = { formula = "0.01*(2-cos(2*pi*1.45*t)-cos(2*pi*1.9*t))" } }

[[solid]]
name = "crate"
free = { density = 500.0, locked = ["x", "turn"] }
shape = { box = { size = [0.3, 0.2] } }
at = { x = 0.8, draft = "equilibrium" }

[[probe]]
motion = "crate"
every = 0.05

[[probe]]
name = "gauge"
elevation = { x = 0.4 }
every = 0.05

[[statistic]]
rao = { motion = "crate", wave = "gauge" }
from = 2.0
"""


def test_the_answer_to_irregular_waves_is_a_function_of_frequency(tmp_path: Path) -> None:
    run = pt.run(pt.Scene.from_toml(IRREGULAR), out=tmp_path / "run", report=False)
    heave = next(rao for rao in run.rao() if rao.motion == "crate.heave_m")
    assert heave.unit == "m/m" and heave.name == "rao"
    assert len(heave.frequency) == len(heave.amplitude) == len(heave.phase) == len(heave.coherence) > 0
    # The longer waves of the paddle are the highest at the gauge; a frequency stands for 1/7 Hz.
    assert any(abs(heave.frequency - 1.45) < 0.1)
    assert (heave.amplitude > 0.0).all() and (abs(heave.phase) <= 180.0).all()
    assert (heave.coherence > 0.0).all() and (heave.coherence < 1.0 + 1e-9).all()


#: Amplitudes over the wave (m/m, °/m) and leads (degrees) at frequencies of 0.4 and 0.6 Hz of the six motions of a body.
MOTIONS_3D = {
    "surge_m": ((0.9, 0.5), 90.0),
    "sway_m": ((0.3, 0.2), -60.0),
    "heave_m": ((1.0, 0.8), 0.0),
    "roll_deg": ((40.0, 60.0), 30.0),
    "pitch_deg": ((50.0, 25.0), -90.0),
    "yaw_deg": ((10.0, 5.0), 150.0),
}


def test_the_answer_of_a_body_in_3d_has_six_motions_alike_here_and_at_the_command_line(tmp_path: Path) -> None:
    text = TANK_3D + """
[[probe]]
motion = "crate"

[[probe]]
name = "gauge"
elevation = { x = 0.2, y = 0.3 }

[[statistic]]
rao = { motion = "crate", wave = "gauge" }

[[statistic]]
name = "regular"
rao = { motion = "crate", wave = "gauge" }
period = 2.5
"""
    run = pt.run(pt.Scene.from_toml(text).set(until=0.001, frames="off"), out=tmp_path / "run", report=False)
    # The tables of a longer run: waves of two frequencies, whose periods divide the segments of the spectra, and a
    # linear body in them.
    t, frequencies, amplitudes = np.arange(0.0, 400.0, 0.1), np.array([0.4, 0.6]), np.array([0.02, 0.015])

    def wave(shares: tuple[float, float], lead: float) -> list[float]:
        phases = 2.0 * np.pi * frequencies[:, None] * t + np.radians([[20.0], [-70.0]]) + np.radians(lead)
        values: list[float] = ((np.array(shares) * amplitudes)[:, None] * np.cos(phases)).sum(axis=0).tolist()
        return values

    for name, known in {"crate": MOTIONS_3D, "gauge": {"eta_m": ((1.0, 1.0), 0.0)}}.items():
        path = run.folder / "series" / f"{name}.csv"
        head = path.read_text().splitlines()[0]
        columns = head.split(",")
        assert set(known) <= set(columns)
        values = [t.tolist()] + [wave(*known[c]) if c in known else [0.0] * len(t) for c in columns[1:]]
        rows = [",".join(repr(float(x)) for x in row) for row in zip(*values, strict=True)]
        path.write_text("\n".join([head, *rows]) + "\n")
    told = {rao.motion: rao for rao in run.rao()}
    assert list(told) == [f"crate.{motion}" for motion in MOTIONS_3D]
    for motion, (shares, lead) in MOTIONS_3D.items():
        rao = told[f"crate.{motion}"]
        assert rao.name == "rao" and rao.unit == ("m/m" if motion.endswith("_m") else "°/m")
        for frequency, share in zip(frequencies, shares, strict=True):
            k = int(np.argmin(abs(rao.frequency - frequency)))
            # A line of the spectrum is 0.01 Hz wide. The window of a segment spreads a sine over the lines beside it alike in
            # wave and motion.
            assert abs(rao.frequency[k] - frequency) < 0.005
            assert rao.amplitude[k] == pytest.approx(share, rel=0.01), motion
            assert (rao.phase[k] - lead + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1.0), motion
            assert rao.coherence[k] == pytest.approx(1.0, abs=0.01), motion
    # The command line has the same answers, and with the period of regular waves the same figures.
    command = [sys.executable, "-m", "pontoon", "stats", str(run.folder), "--json"]
    answers = json.loads(subprocess.run([*command, "--rao"], check=True, capture_output=True, text=True).stdout)
    here = [(rao.motion, f, a) for rao in run.rao() for f, a in zip(rao.frequency, rao.amplitude, strict=True)]
    assert [(row["series"], row["frequency_hz"], row["rao"]) for row in answers] == here
    figures = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    regular = [row for row in figures if row["name"] == "regular"]
    assert regular == [vars(row) for row in run.stats() if row.name == "regular"]
    assert {row["series"] for row in regular if row["quantity"] == "rao"} == set(told)
    by_period = {row["series"]: row["value"] for row in regular if row["quantity"] == "rao"}
    assert by_period["crate.roll_deg"] == pytest.approx(40.0, rel=0.01)


def test_a_harmonic_of_means_has_the_phase_of_what_they_are_means_of(tmp_path: Path) -> None:
    # A driven box, read now and as means over a sixth of a period: 30 degrees late at the end of their interval.
    text = TANK.replace("free = { density = 500.0 }", 'driven = { along = [1, 0], distance = { formula = "0.01*sin(40*t)" } }')
    text = text.replace('draft = "equilibrium"', "y = 0.5") + """
[[probe]]
name = "means"
motion = "crate"
every = 0.02618
average = true
"""
    run = pt.run(pt.Scene.from_toml(text).set(frames="off", until=0.5), out=tmp_path / "run", report=False)
    means, whole = (run.series[f"{name}.surge_m"].harmonic(np.pi / 20.0) for name in ("means", "crate"))
    assert abs(np.angle(means / whole)) < np.radians(1.0) and abs(whole) == pytest.approx(0.01, rel=1e-3)
    # The amplitude is lower by sin(x)/x with half the interval, 0.5236 rad.
    assert abs(means / whole) == pytest.approx(np.sin(0.5236) / 0.5236, rel=0.01)


def test_a_statistic_of_several_series_or_names_is_not_chosen_by_chance() -> None:
    def row(name: str, series: str, value: float) -> pt.Statistic:
        return pt.Statistic(name, series, "mean", value, "m", 0.0, 1.0)

    rows = [row("", "fore.heave_m", 1.0), row("", "aft.heave_m", 2.0), row("late", "aft.heave_m", 3.0)]
    stats = Statistics([*rows, row("a", "gauge.eta_m", 4.0), row("b", "gauge.eta_m", 5.0)], [])
    assert stats.value("aft.heave", "mean") == 2.0 and stats.value("aft.heave", "mean", "late") == 3.0
    assert stats.value("eta", "mean", "b") == 5.0
    for series, part in (("heave", "fore.heave_m, aft.heave_m"), ("eta", "a, b"), ("surge", "surge mean")):
        with pytest.raises(pt.UnknownNameError, match=part):
            stats.value(series, "mean")


def test_a_study_gives_a_table(tank: pt.Scene, tmp_path: Path) -> None:
    tank["until"] = 0.05
    tank["check"] = [{"series": "crate.heave_m", "formula": "0", "bound": {"off": 0.05}}]
    study = pt.study(tank, out=tmp_path / "study", dp=[0.05, 0.04], vary={"model.viscosity": ["none"]})
    assert [row["dp_m"] for row in study.rows] == [0.05, 0.04] and not study.failed
    assert len(study.runs) == 2 and {run.status for run in study.runs} == {"finished"}
    # Runs of other scenes are set aside under new names.
    for _ in range(2):
        tank["solid.crate.friction"] = 0.1 + float(tank["solid.crate.friction"])
        study = pt.study(tank, out=tmp_path / "study", dp=[0.05, 0.04], vary={"model.viscosity": ["none"]})
    assert len(list((tmp_path / "study" / "runs").iterdir())) == 6 and len(study.runs) == 2


def test_a_study_finds_the_files_of_a_text_and_has_a_folder(
    tank: pt.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "still.csv").write_text("t_s,heave_m\n0,0\n1,0\n")
    text = TANK.replace("until = 0.3", "until = 0.05")
    text += '\n[[check]]\nseries = "crate.heave_m"\nreference = "still.csv"\ncolumn = "heave_m"\nbound = { off = 0.05 }\n'
    scene = pt.Scene.from_toml(text, folder=tmp_path / "tables")
    monkeypatch.chdir(tmp_path)
    study = pt.study(scene)
    assert study.folder == Path("studies") / "scene" and not study.failed
    assert [row["check"] for row in study.rows] == ["crate.heave_m"]
    assert (study.folder / "scene" / "still.csv").read_text() == (tmp_path / "tables" / "still.csv").read_text()
    assert sorted(os.listdir(tmp_path / "tables")) == ["still.csv"], "the folder of the files stays as it was"


def test_what_is_wrong_with_a_study_is_told_before_it_runs(tank: pt.Scene, tmp_path: Path) -> None:
    out = tmp_path / "study"
    with pytest.raises(pt.SceneError) as key:
        pt.study(tank, out=out, vary={"model.kernle": ["cubic"]})
    assert key.value.code == "unknown-key" and key.value.key == "model.kernle" and '"kernel"' in str(key.value)
    with pytest.raises(pt.SceneError) as value:
        pt.study(tank, out=out, vary={"model.kernel": ["wendland", "cubik"]})
    assert value.value.code == "unknown-name" and "cubic" in str(value.value)
    with pytest.raises(pt.SceneError) as spacing:
        pt.study(tank, out=out, dp=[-0.1])
    assert spacing.value.code == "out-of-range" and spacing.value.key == "dp"
    tank["check"] = [{"series": "crat.heave_m", "formula": "0"}]
    with pytest.raises(pt.SceneError, match="crate"):
        pt.study(tank, out=out)
    assert not out.exists()
    with pytest.raises(pt.UnknownNameError, match="still-tank") as case:
        pt.validate("stil-tank", out=out)
    assert case.value.code == "unknown-name" and isinstance(case.value, KeyError)


def test_refusals_and_failures_of_a_study_are_exceptions(tank: pt.Scene, tmp_path: Path) -> None:
    with pytest.raises(pt.UsageError, match="nothing in it"):
        pt.study(tank, out=tmp_path / "none", vary={"model.kernel": []})
    with pytest.raises(pt.UsageError, match="two runs") as twice:
        pt.study(tank, out=tmp_path / "twice", dp=[0.05, 0.05])
    assert twice.value.help and twice.value.help.startswith("give each")
    # As in a run: water that settles is faster than this.
    tank["guard.speed"] = 1e-5
    with pytest.raises(pt.Fault) as fault:
        pt.study(tank, out=tmp_path / "fault")
    assert fault.value.code == "speed-limit" and fault.value.who.startswith("water particle")
    assert len(fault.value.position) == 2 and fault.value.help == fault.value.cause


@needs_signals
def test_a_stopped_study_goes_on(tank: pt.Scene, tmp_path: Path) -> None:
    tank["dp"], tank["until"] = 0.02, 1.0
    tank["check"] = [{"series": "crate.heave_m", "formula": "0"}]
    folder, ended = tmp_path / "study", threading.Event()

    def stop_the_second_run() -> None:
        while not ended.wait(0.01):
            if any((folder / "runs").glob("*wendland*/series/*.csv")):
                os.kill(os.getpid(), signal.SIGINT)
                return

    watch = threading.Thread(target=stop_the_second_run)
    watch.start()
    grid = {"model.kernel": ["cubic", "wendland"]}
    with pytest.raises(KeyboardInterrupt):
        pt.study(tank, out=folder, vary=grid)
    ended.set()
    watch.join()
    study = pt.study(tank, out=folder, vary=grid)
    assert len(study.runs) == 2 and {run.status for run in study.runs} == {"finished"}


def test_a_validation_case_is_run_and_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    cases = pt.validate("still-tank")
    assert cases.folder == Path("validation") and not cases.failed
    assert cases.rows and all(row["passed"] is True for row in cases.rows)
    assert len(cases.runs) == 1
