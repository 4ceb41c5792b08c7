"""A run that is refused is an error of its own: alone, in a table, a study, on the command line and on the page."""

import json
import math
import tomllib

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import random_shaking
from rockflex.cli._app import app
from rockflex.models import _work, parse_model
from rockflex.models._work import Task, WorkLimitError
from rockflex.motion._columns import record_csv
from rockflex.studies import PreparedCase
from rockflex.studies._ground_tables import GroundTable
from rockflex.web import _state
from rockflex.web._refusal import Refusal
from rockflex.web._response import response_view
from rockflex.web._uploads import UploadedRecords

FRAME = """
[frame]
n_stories = 3
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = 0.6
aspect_ratio = 8.0
damping_ratio = 0.03
"""
TENDON = 'elements = [{ kind = "tendon", position = 0.0, initial_force = 2e5, stiffness = 4e6 }]\n'
FUSE = 'elements = [{ kind = "yielding_dissipator", position = 0.6, stiffness = 5e7, yield_force = 1e5 }]\n'
DAMPER = 'elements = [{ kind = "friction_damper", position = 0.6, force = 6e4 }]\n'
BRACE = 'elements = [{ kind = "yielding_dissipator", stiffness = 5e7, yield_force = 1e5, between = [0, 1] }]\n'
STORIES = "[stories]\nstrengths = [2e5, 1.8e5, 1.2e5]\npost_yield_ratio = 0.05\n"
SLIP = "[ground]\nfriction = 0.25\n"
SPRINGS = "[ground]\nbase_inertia = 3e5\n[ground.springs]\nstiffness = 4e8\ndamping = 2e6\n"
# Of every kind what stands before and after the frame in a file, and a model.
KINDS = {
    "plain": ("", "", "MDOF-S"),
    "fixed": ("", "", "fixed"),
    "rigid": ("", "", "rigid"),
    "eccentric": ("eccentricity = 0.1\n", "", "MDOF-S"),
    "leaning": ("leaning_masses = [2e4, 2e4, 2e4]\n", "", "MDOF-S"),
    "tendon": (TENDON, "", "MDOF-S"),
    "fuse": (FUSE, "", "MDOF-S"),
    "friction damper": (DAMPER, "", "MDOF-S"),
    "brace": (BRACE, "", "MDOF-S"),
    "yielding stories": ("", STORIES, "MDOF-S"),
    "springs": ("", SPRINGS, "MDOF-S"),
    "tendon on springs": (TENDON, SPRINGS, "MDOF-S"),
    "slides": ("", SLIP, "MDOF-S"),
    "slides on springs": ("", SLIP + SPRINGS.removeprefix("[ground]\n"), "MDOF-S"),
    "complete": ("", "", "MDOF-C"),
    "complete with a tendon": (TENDON, "", "MDOF-C"),
    "complete on springs": ("", SPRINGS, "MDOF-C"),
    "complete, slides": ("", SLIP, "MDOF-C"),
    "hysteretic": ("", "[bouc_wen]\nyield_displacement = 0.05\n", "2DOF-S-BW"),
}
SHORT = rf.GroundMotion(np.linspace(0.0, 1e-3, 8), 0.02, name="short")
LONG = rf.GroundMotion(random_shaking(3, 6.0, 24.0, 0.02), 0.02, name="long")
WIDE = rf.GroundMotion(
    np.array([0.0, 3.0, -3.0, 2.0, -2.0]), 1e4, name="wide"
)  # steps within which a rotation overflows
GROWS = "plain", "eccentric", "leaning", "friction damper", "brace", "yielding stories", "slides"


class Fails:
    """A law of a user's own that does not work."""

    keeps = loses = "nothing"

    def after(self, properties, modal_velocity, rotation_velocity):
        raise ValueError("no such thing")


@pytest.fixture(params=KINDS)
def kind(request):
    """One of the kinds of structures and models."""
    return request.param


@pytest.fixture
def made(kind, tmp_path):
    """Its file, the structure, the model, and the further arguments of `simulate`."""
    head, tail, model = KINDS[kind]
    file = tmp_path / "structure.toml"
    file.write_text(head + FRAME + tail)
    content = tomllib.loads(file.read_text())
    only = tmp_path / "only.toml"
    only.write_text(head + FRAME + (tail if "stories" in content else ""))
    structure, more = rf.read_structure(only), {}
    if "ground" in content:
        more["ground"] = GroundTable(**content["ground"]).under(structure.rocking())
    if "bouc_wen" in content:
        more["bouc_wen"] = rf.BoucWen(**content["bouc_wen"])
    return file, structure, model, more


def limit_between(structure, model, more, *, history):
    """A work limit that the short motion is below, and the long one above."""
    tied = parse_model(model).of(structure.rocking(), None, more.get("bouc_wen"), more.get("ground"))
    case = PreparedCase(tied, history=history, floors=history)
    return math.sqrt(math.prod(case.task(motion).work().total for motion in (SHORT, LONG)))


def assert_one_is_lost(table, words):
    """The long run, of two, has an error in words; the other one has its result."""
    lost, kept = table[table["motion"] != "short"].iloc[0], table[table["motion"] == "short"].iloc[0]
    assert words in lost["error"]
    assert len(table) == 2
    assert isinstance(kept["status"], str)
    assert not isinstance(lost["status"], str)
    assert kept["max_top_displacement" if kept["model"] != "rigid" else "max_rotation"] >= 0.0


def assert_is_refused(error, words, made, motion, limit, output, **more):
    """So is the run alone, and in a table with another one."""
    _, structure, model, options = made
    options = options | {"work_limit": limit} | more
    with pytest.raises(error, match=words):
        rf.simulate(structure, motion, model, output, **options)
    assert_one_is_lost(rf.simulate_many(structure, [SHORT, motion], model, output, **options), words)


def on_command_line(made, motion, tmp_path, *arguments):
    """The runs of `rockflex run` under the short motion and another one, as a table."""
    import pandas as pd

    files = []
    for each in (SHORT, motion):
        files.append(tmp_path / f"{each.name}.csv")
        files[-1].write_text(record_csv(each))
    given = [str(made[0]), *map(str, files), "--model", made[2], "--json", *map(str, arguments)]
    result = CliRunner().invoke(app, ["run", *given], env={"COLUMNS": "200"})
    assert result.exit_code == 0, result.stderr
    return pd.DataFrame(json.loads(result.stdout)["runs"])


def page_answer(made, words):
    """The page's answer is a refusal in words."""
    structure = tomllib.loads(made[0].read_text())
    own = {name: structure.pop(name) for name in ("ground", "bouc_wen") if name in structure}
    state = _state.parse_page_state({"structure": structure | {"name": "it"}, "models": [made[2]], **own})
    with pytest.raises(Refusal, match=words) as caught:
        response_view(state, UploadedRecords())
    assert set(caught.value.errors) == {"models"}


@pytest.mark.parametrize("output", ["peaks", "history"])
def test_more_work_than_its_limit(made, output, tmp_path, monkeypatch) -> None:
    limit = limit_between(*made[1:], history=output == "history")
    assert_is_refused(WorkLimitError, "work_limit is", made, LONG, limit, output)
    if output == "peaks":
        cloud = rf.run_cloud(made[1], [SHORT, LONG], made[2], work_limit=limit, **made[3])
        assert_one_is_lost(cloud, "work_limit is")
        assert_one_is_lost(on_command_line(made, LONG, tmp_path, "--work-limit", limit), "work_limit is")
    monkeypatch.setattr(_state, "RUN_WORK_LIMIT", 1e-9)
    page_answer(made, "work_limit is")


@pytest.mark.slow
@pytest.mark.parametrize("output", ["peaks", "history"])
def test_a_limit_that_is_reached_on_the_way(made, output, tmp_path, monkeypatch) -> None:
    limit = 0.3 * limit_between(*made[1:], history=output == "history")
    monkeypatch.setattr(Task, "check", lambda self, limit: None)  # as where the estimate is far too low
    assert_is_refused(rf.SolverError, "was stopped at", made, LONG, limit, output)
    if output == "peaks":
        assert_one_is_lost(rf.run_cloud(made[1], [SHORT, LONG], made[2], work_limit=limit, **made[3]), "was stopped at")
        assert_one_is_lost(on_command_line(made, LONG, tmp_path, "--work-limit", limit), "was stopped at")
    monkeypatch.setattr(_state, "RUN_WORK_LIMIT", 1e-9)
    page_answer(made, "was stopped at")


@pytest.mark.slow
def test_a_history_that_no_memory_holds(made, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(_work, "HISTORY", 2e4)  # bytes
    assert_is_refused(WorkLimitError, "The history of", made, LONG, None, "history")
    folder = tmp_path / "out"
    assert_one_is_lost(on_command_line(made, LONG, tmp_path, "--out", folder, "--figures", "9"), "The history of")
    page_answer(made, "The history of")


def test_a_time_step_that_is_too_long(kind, made, tmp_path) -> None:
    if kind not in GROWS:  # nothing grows exponentially, or it is integrated
        return
    assert_is_refused(rf.InputError, "is too long", made, WIDE, None, "peaks")
    assert_one_is_lost(rf.run_cloud(made[1], [SHORT, WIDE], made[2], work_limit=None, **made[3]), "is too long")
    assert_one_is_lost(on_command_line(made, WIDE, tmp_path, "--work-limit", "none"), "is too long")


@pytest.mark.slow
def test_a_law_that_fails(kind, made) -> None:
    if kind == "fixed" or "springs" in kind:  # no law acts
        return
    assert_is_refused(rf.InputError, "Fails", made, LONG, None, "peaks", impact=Fails())
    cloud = rf.run_cloud(made[1], [SHORT, LONG], made[2], impact=Fails(), **made[3])
    assert_one_is_lost(cloud, "Fails")


@pytest.mark.parametrize("vertical", [False, True])
def test_of_structures_that_are_prepared_together_only_that_one_is_refused(vertical) -> None:
    rise = np.array([0.0, 1.0, 0.5, 0.0, 0.0, 0.0]) if vertical else None
    motion = rf.GroundMotion(np.array([0.0, 5.0, -5.0, 3.0, 0.0, 0.0]), 60.0, name="slow", vertical=rise)
    large = rf.Frame(3, 3.0, 40e3, 40e3, math.inf, period=1.0, aspect_ratio=10.0, damping_ratio=0.02)
    small = rf.Frame(3, 3e-3, 40e3, 40e3, math.inf, period=0.05, aspect_ratio=10.0, damping_ratio=0.02)
    for order in ([small, large], [large, small]):
        table = rf.simulate_many(order, motion, work_limit=None)
        expected = rf.simulate(large, motion, output="peaks", work_limit=None)
        lost, kept = table.iloc[order.index(small)], table.iloc[order.index(large)]
        assert "is too long" in lost["error"]
        assert (kept["status"], kept["max_rotation"]) == (expected.status, expected.max_rotation)
