"""Scenes: read, changed, inspected; errors say what the program says."""

import copy
import pickle
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pontoon as pt

from conftest import TANK


def test_a_bundled_scene_is_found_by_its_name() -> None:
    scene = pt.Scene.read("still-tank")
    assert scene.dimension == 2 and scene.title
    assert "still-tank" in pt.scenes()


def test_two_bundled_scenes_with_tables_live_side_by_side() -> None:
    first, second = pt.Scene.read("dam-break"), pt.Scene.read("martin-moyce")
    del first
    assert not second.inspect().is_estimate, "its tables are still there"


def test_an_unknown_scene_names_the_nearest() -> None:
    with pytest.raises(pt.UnknownNameError) as told:
        pt.Scene.read("stil-tank")
    assert told.value.code == "unknown-name" and "still-tank" in (told.value.help or "")
    assert str(told.value).startswith("there is no scene"), "without the quotation marks of a KeyError"


def test_an_error_has_code_place_and_remedy() -> None:
    text = TANK.replace("density", "densty")
    with pytest.raises(pt.SceneError) as told:
        pt.Scene.from_toml(text)
    error = told.value
    line = 1 + text[: text.index("densty")].count("\n")
    assert error.code == "unknown-key" and error.line == line and error.file == "scene.toml"
    assert "density" in str(error), "the nearest key is named"
    assert isinstance(error, ValueError) and isinstance(error, pt.Error)
    again = pickle.loads(pickle.dumps(error))
    assert (again.code, again.line, str(again)) == (error.code, error.line, str(error))


def test_keys_are_changed_as_by_set_of_the_program(tank: pt.Scene) -> None:
    tank["solid.crate.free.density"] = 400
    tank["model.viscosity"] = "none"
    tank["solid.crate.shape"] = {"box": {"size": np.array([0.2, 0.2])}}
    assert tank["solid.crate.free.density"] == 400
    assert tank["model.viscosity"] == "none"
    assert tank.changes == {
        "solid.crate.free.density": "400",
        "model.viscosity": '"none"',
        "solid.crate.shape": "{ box = { size = [0.2, 0.2] } }",
    }
    assert tank.values()["model.viscosity"][1] != tank.values()["model.kernel"][1], "sources differ"


def test_entries_of_lists_are_read_by_name_and_number(tank: pt.Scene) -> None:
    ends = {"from": [0.5, 0.6], "to": [0.5, 0.9], "stiffness": 10.0}
    tank["spring"] = [{"name": "fore", "between": ["crate"], **ends}, {"name": "aft", "between": ["crate"], **ends}]
    tank["spring.aft.stiffness"] = 20.0
    assert tank["spring.fore.stiffness"] == 10.0 and tank["spring.aft.stiffness"] == tank["spring.1.stiffness"] == 20.0
    with pytest.raises(pt.UnknownNameError):
        tank["spring.mid.stiffness"]


def test_a_wrong_change_is_refused_and_leaves_the_scene_as_it_was(tank: pt.Scene) -> None:
    with pytest.raises(pt.SceneError) as told:
        tank["solid.crat.free.density"] = 400
    assert "crate" in str(told.value)
    with pytest.raises(pt.SceneError):
        tank["dp"] = "fine"
    with pytest.raises(TypeError):
        tank["dp"] = object()
    with pytest.raises(KeyError) as unknown:
        tank["solid.crate.free.densty"]
    assert isinstance(unknown.value, pt.UnknownNameError) and unknown.value.code == "unknown-key"
    assert "solid.crate.free.density" in (unknown.value.help or "")
    assert tank.changes == {} and tank.dp == 0.05


def test_a_copy_is_independent(tank: pt.Scene) -> None:
    finer = tank.set(dp=0.02)
    for other in (copy.copy(finer), copy.deepcopy(finer), pickle.loads(pickle.dumps(finer))):
        assert other.dp == 0.02 and other.to_toml() == finer.to_toml()
    assert tank.dp == 0.05


def test_a_scene_is_a_dictionary_too() -> None:
    scene = pt.Scene.from_dict(
        {
            "dimension": 2,
            "dp": 0.05,
            "until": 1.0,
            "water": [{"fill": {"box": {"min": [0, 0], "max": [1, 0.5]}}}],
            "solid": [{"name": "tank", "fixed": True, "shape": {"tank": {"size": [1.0, 1.0]}}}],
        }
    )
    assert scene.inspect()["size"]["fluid"] == 20 * 10


def test_a_dictionary_of_another_kind_is_refused() -> None:
    kinds: list[Any] = [3, None, [], {1: 2}, {"dp": object()}]
    for wrong in kinds:
        with pytest.raises(TypeError):
            pt.Scene.from_dict(wrong)


def test_modules_that_need_other_packages_are_imported_on_use() -> None:
    program = "import sys, pontoon as pt; print('pontoon.potential_flow' in sys.modules, pt.potential_flow.__name__)"
    told = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert told.stdout.split() == ["False", "pontoon.potential_flow"]
    with pytest.raises(AttributeError, match="nosuch"):
        getattr(pt, "nosuch")


def test_every_public_name_is_on_the_reference_page() -> None:
    page = (Path(__file__).parents[2] / "docs" / "reference" / "python.md").read_text(encoding="utf-8")
    documented = set(re.findall(r"[A-Za-z_]\w*", " ".join(re.findall(r"`([^`]*)`", page))))
    assert set(pt.__all__) <= documented, set(pt.__all__) - documented
    # The attributes of the classes.
    for name in pt.__all__:
        thing = getattr(pt, name)
        if isinstance(thing, type) and not issubclass(thing, BaseException):
            own = {key for part in thing.__mro__ if part.__module__.startswith("pontoon") for key in vars(part)}
            missing = {key for key in own if not key.startswith("_")} - documented
            assert not missing, f"{name}: {missing}"


def test_the_inspection_has_facts_and_findings(tank: pt.Scene) -> None:
    report = tank.inspect()
    assert report["size"]["fluid"] > 100 and report["bodies"][0]["name"] == "crate"
    # The crate has half the density of water: it floats on half its height.
    assert report["bodies"][0]["afloat"]["draft_m"] == pytest.approx(0.1, abs=1e-3)
    assert report["timing"] is None and tank.inspect(timing=True)["timing"]["run_s"] > 0.0
    tank["solid.crate.free.density"] = 3000
    tank["solid.crate.at"] = {"x": 0.5, "bottom": 0.3}
    assert all(finding.what and finding.mend for finding in tank.inspect().findings)
    assert tank.inspect().warnings == [f for f in tank.inspect().findings if f.severity == "warning"]
