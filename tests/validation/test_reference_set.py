"""The reference set of the examples: its first runs against numbers of another program, on any machine.

`examples/reference_set.csv` holds what the twin of `twins.fine_step` computes, on exact sub-samples with a search for
events that shares no code with the engine; what is written there are 17 digits. The set claims that two machines agree
to 1e-9 times the sensitivity of a peak.
"""

import math
from pathlib import Path

import pandas as pd
import pytest

import rockflex as rf
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

EXAMPLES = Path(__file__).parents[2] / "examples"
KEYS = ["number", "motion", "scale"]
CLOSE = 1e-9


@pytest.fixture(scope="module")
def runs():
    study = rf.load_study(EXAMPLES / "reference_set.toml").model_copy(update={"count": 8})
    table = rf.run_study(study)
    stored = pd.read_csv(EXAMPLES / "reference_set.csv")
    return stored.merge(table, on=KEYS, suffixes=("_stored", ""), validate="one_to_one")


def test_its_first_runs_are_those_of_the_twin(runs):
    assert len(runs) == 32
    assert (runs["status"] == runs["status_stored"]).all()
    assert set(runs["status"]) == {"no_uplift", "rocking", "overturned"}
    stands = runs[runs["status"] != "overturned"]
    allowed = CLOSE * stands["sensitivity_max_rotation"].abs().clip(lower=1.0).fillna(1.0)
    for peak in ("max_rotation", "max_top_displacement", "max_base_moment"):
        off = (stands[peak] - stands[f"{peak}_stored"]).abs()
        assert (off <= allowed * stands[f"{peak}_stored"].abs()).all(), peak


def twin_of(row, suite):
    p = math.sqrt(1.5 * 9.81 / row.height)
    motion = suite[row.motion].scaled(row.scale)
    given = frame_properties(
        n_stories=int(row.stories),
        story_height=row.height / row.stories,
        story_mass=40e3,
        base_mass=40e3 * row.base_ratio + 1.0,
        stiffness_ratio=math.inf,
        period=2.0 * math.pi / (row.frequency_ratio * p),
        aspect_ratio=row.slenderness,
        damping_ratio=row.damping,
    )
    return simulate_fine(**given, acceleration=motion.acceleration, dt=motion.dt, substeps=16)


@pytest.mark.slow
def test_what_is_stored_is_what_the_twin_computes(runs):
    suite = rf.load_study(EXAMPLES / "reference_set.toml").records.load(EXAMPLES)
    for row in runs.iloc[::5].itertuples():
        twin = twin_of(row, suite)
        for peak in ("rotation", "top_displacement", "base_moment"):
            stored = getattr(row, f"max_{peak}_stored")
            assert getattr(twin, f"max_{peak}") == pytest.approx(stored, rel=1e-10, abs=0.0), (row.Index, peak)
