"""How often the pivot would lift in a study."""

import pandas as pd
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.kinds import KINDS
from rockflex.study.plan import PivotLifts, pivot_lifts

RUNS = pd.DataFrame(
    {
        "structure": ["A", "A", "A", "A", "B", "B"],
        "model": ["MDOF-S"] * 6,
        "status": ["rocking", "rocking", "overturned", None, "no_uplift", "rocking"],
        "min_vertical_reaction": [-1.0, 1.0, -5.0, float("nan"), 2.0, 0.0],
    }
)


def test_only_runs_that_rock_and_stand_count() -> None:
    assert pivot_lifts(RUNS) == [PivotLifts("A", "MDOF-S", 2, 1), PivotLifts("B", "MDOF-S", 1, 0)]


def test_widths_of_a_design_are_counted_together_and_pairs_by_model() -> None:
    assert pivot_lifts(KINDS["design"].runs(RUNS.assign(tendon="none"))) == [
        PivotLifts("Designs, tendons: none", "MDOF-S", 3, 1)
    ]
    names = {"status": "status_mdof", "min_vertical_reaction": "min_vertical_reaction_mdof"}
    pairs = RUNS.rename(columns=names).drop(columns=["structure", "model"])
    pairs = pairs.assign(status_2dof="rocking", min_vertical_reaction_2dof=-1.0)
    lifts = pivot_lifts(KINDS["population"].runs(pairs))
    assert lifts == [PivotLifts("Population", "MDOF-S", 3, 1), PivotLifts("Population", "2DOF-S", 6, 6)]


def test_the_sentence() -> None:
    assert str(PivotLifts("A", "MDOF-S", 22, 11)) == (
        "A, MDOF-S: in 11 of 22 runs that rock and stand the model pulls the base down (min_vertical_reaction below "
        "zero), which no ground can: the pivot would lift. Read what follows in such a run with care."
    )


def test_flexural_frames_would_lift_often_and_shear_frames_do_not() -> None:
    """Structures #4 and #3 of Table 1."""
    suite = rf.load_suite("fema-p695-far-field")
    share = {}
    for name, stiffness_ratio in (("flexure", 0.0), ("shear", float("inf"))):
        frame = make_frame(stiffness_ratio=stiffness_ratio, period=0.5)
        runs = rf.run_cloud(frame, list(suite)[::4], ["MDOF-S"], (2.0,))
        (found,) = pivot_lifts(runs)
        standing = runs[runs["status"] == "rocking"]
        assert found.lifting == (standing["min_vertical_reaction"] < 0.0).sum()
        share[name] = found.lifting / found.rocking
    assert share["flexure"] > 0.2 > share["shear"]


@pytest.mark.parametrize("column", ["max_total_top_displacement", "max_horizontal_reaction", "min_vertical_reaction"])
def test_every_kind_of_table_has_the_columns(column: str) -> None:
    frame = make_frame(n_stories=2, stiffness_ratio=1.0, period=0.5, aspect_ratio=8.0)
    motion = rf.load_suite("el-centro-1940")[0]
    response = rf.simulate(frame, motion, "2DOF-S", output="peaks")
    many = rf.simulate_many(frame, motion, "2DOF-S")
    cloud = rf.run_cloud(frame, [motion], "2DOF-S")
    for table in (many, cloud):
        assert table[column].tolist() == [getattr(response, column)]
    assert f"time_of_{column}" in cloud


def test_runs_beyond_the_balance_rotation_are_counted_and_told() -> None:
    runs = RUNS.assign(
        balance_ratio=[1.2, 0.9, 5.0, float("nan"), 0.0, 3.0], max_rotation=[0.1, 0.1, 1.571, None, 0, 0.3]
    )
    assert [each.beyond for each in pivot_lifts(runs)] == [1, 1]
    assert "θ passes α" in str(pivot_lifts(runs)[1])
    assert "such as rigid-C" in str(pivot_lifts(runs.assign(model="rigid"))[1])
    assert [each.beyond for each in pivot_lifts(runs.assign(model="MDOF-C-SI"))] == [0, 0]
