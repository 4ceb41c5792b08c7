"""The ground of a state: it reaches the runs, the program and the files of the page."""

import io
import math

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import frame_values
from rockflex.models import LinearModel, _label
from rockflex.web import _download
from rockflex.web._download import download
from rockflex.web._refusal import Refusal
from rockflex.web._response import responses
from rockflex.web._script import response_script
from rockflex.web._state import parse_state
from rockflex.web._structures import structure_view
from rockflex.web._studies import shared
from rockflex.web._uploads import Uploads

FRAME = {"frame": frame_values(n_stories=2, period=0.5, aspect_ratio=8.0)}
BED = {"breadth": 3.0, "n": 8}
GROUNDS = [
    {"friction": 0.3},
    {"friction": [0.3, "inf"], "base_inertia": 2e4, "springs": {"stiffness": 5e8, "damping": [1e6, 2e6]}},
    {"base_inertia": 2e4, "springs": {"positions": [-0.4, 0.4], "stiffness": 9e8, "heave_damping_ratio": 0.2}},
    {"mat_mass": 4e4, "bed": BED | {"subgrade_modulus": 9e8, "damping": 2e6, "end_zone": 0.1, "end_ratio": 2.0}},
    {"mat_mass": 4e4, "bed": BED | {"breadth": 1.0, "shear_modulus": 3e8, "poisson_ratio": 0.3}},
]


@pytest.fixture
def made(monkeypatch):
    """Return the grounds that reach a model, which is then built without them."""
    grounds = []

    def grounded(label, kept, ground, law, missing_mass):
        grounds.append(ground)
        return LinearModel(label, kept, True, law or rf.VVELSimplified(), missing_mass)

    monkeypatch.setattr(_label, "grounded", grounded)
    return grounds


def state_of(ground, **other):
    return parse_state({"structure": FRAME, "models": ["2DOF-S"], "free_vibration": 0.0, "ground": ground, **other})


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("eccentricity", [None, 0.05])
def test_runs_programs_and_studies_have_the_ground(made, tmp_path, monkeypatch, ground, eccentricity):
    monkeypatch.chdir(tmp_path)
    state = state_of(ground, structure=FRAME | ({"eccentricity": eccentricity} if eccentricity else {}))
    built, _, (response,) = responses(state, Uploads())
    assert made == [state.ground.under(built.properties)]
    exec(compile(response_script(state), "response.py", "exec"), space := {})
    assert made[1] == made[0]
    assert space["responses"]["2DOF-S"].max_rotation == pytest.approx(response.max_rotation, rel=1e-12)
    study = rf.CloudStudy(**shared(state, Uploads(), "cloud", ["2DOF-S"], "Cloud"))
    assert study.ground == state.ground


@pytest.mark.parametrize(
    ("ground", "path", "text"),
    [
        ({"friction": -1.0}, "ground.friction", "it must be from 0.001 to inf, but -1 was given."),
        ({"springs": {"stiffness": 0.0}}, "ground.springs.stiffness", "it must be from 1 to 1e+15, but 0 was given."),
        ({"bed": {}}, "ground.bed.breadth", "it is missing: the dimension of the base perpendicular to the plane"),
        ({"frction": 0.3}, "ground.frction", "it is not known here."),
    ],
)
def test_wrong_values_are_refused(ground, path, text):
    with pytest.raises(Refusal) as raised:
        state_of(ground)
    ((found, said),) = raised.value.errors.items()
    assert (found, said[: len(text)]) == (path, text)


def test_contradictions_name_their_field():
    state = state_of({"springs": {"stiffness": 5e8}})
    with pytest.raises(Refusal) as raised:
        responses(state, Uploads())
    ((path, said),) = raised.value.errors.items()
    assert path == "ground.base_inertia"
    assert said.startswith("A base without rotary inertia")


def test_friction_that_prevents_sliding_may_be_infinite():
    assert state_of({"friction": "inf"}).ground.friction == math.inf


SOFT = GROUNDS[3] | {"friction": 0.1}
RECORD = {"source": "suite", "suite": "fema-p695-far-field", "name": "FF-2-a"}


def test_histories_have_the_columns_of_the_base():
    state = state_of(SOFT, record=RECORD, scale=2.0)
    _, _, (run,) = responses(state, Uploads())
    name, _, content = download(state, "histories", Uploads())
    table = pd.read_csv(io.BytesIO(content))
    assert name == "histories.csv"
    expected = {
        "slip (m)": run.slip, "slip_velocity (m/s)": run.slip_velocity, "heave (m)": run.heave,
        "left_edge_uplift (m)": run.edge_uplift[:, 0], "right_edge_uplift (m)": run.edge_uplift[:, 1],
    } | {f"spring_force_{k + 1} (N)": run.spring_force[:, k] for k in range(8)}  # fmt: skip
    assert list(table.columns)[-len(expected) :] == list(expected)
    for head, values in expected.items():
        np.testing.assert_allclose(table[head], values, rtol=1e-8, atol=1e-12)
    _, _, content = download(state, "peaks", Uploads())
    assert pd.read_csv(io.BytesIO(content))["max_slip"][0] == run.max_slip > 0.0


def test_histories_of_too_many_springs_are_refused(monkeypatch):
    monkeypatch.setattr(_download, "CELLS", 1000)
    with pytest.raises(Refusal) as raised:
        download(state_of(SOFT), "histories", Uploads())
    assert raised.value.errors["models"].startswith("the histories with the forces of all springs have ")


def test_a_structure_tells_the_springs_under_it():
    bed = {"breadth": 3.0, "n": 40, "subgrade_modulus": 9e8, "heave_damping_ratio": 0.25}
    state = state_of({"friction": 0.3, "mat_mass": 4e4, "bed": bed})
    view = structure_view(state.structure, state.ground)["ground"]
    p = state.structure.build().rocking()
    springs = state.ground.under(p).springs
    assert view["slides"]
    assert len(view["springs"]) == 9
    assert (view["springs"][0], view["springs"][-1]) == (springs.positions[0], springs.positions[-1])
    facts = {fact["symbol"]: fact["value"] for fact in view["facts"]}
    assert facts["w"] == pytest.approx(1e3 * p.m_tot * 9.81 / springs.total_stiffness)
    assert facts["ζ_z"] == pytest.approx(0.25)
    assert facts["Σkx²"] == springs.rotational_stiffness
    assert structure_view(state.structure)["ground"] is None
    slides = state_of({"friction": 0.3})
    assert structure_view(slides.structure, slides.ground)["ground"] == {"slides": True, "springs": [], "facts": []}
