"""Demands of the user's own as columns of a cloud."""

import threading
import time

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex import InputError

FRAME = make_frame(n_stories=3, period=0.6, aspect_ratio=8.0)
SUITE = rf.load_suite("fema-p695-far-field")[:4]


def roof(response: rf.Response) -> float:
    """Largest acceleration of the roof."""
    return abs(response.floor_acceleration[:, -1]).max()


def drift(response: rf.Response) -> float:
    """Largest story drift."""
    return abs(response.story_drift).max()


def test_a_demand_is_a_column_with_the_value_of_each_run():
    runs = rf.run_cloud(
        {"A": FRAME}, SUITE, ["2DOF-S", "5DOF-S"], [0.5, 1.5], demands={"roof": roof, "drift": drift}, workers=2
    )
    assert list(runs.columns[-3:]) == ["roof", "drift", "error"]
    for row in runs.itertuples():
        if row.model == "5DOF-S":  # more modes than the structure has
            assert np.isnan(row.roof)
            assert "5DOF-S" in row.error
        else:
            response = rf.simulate(FRAME, SUITE[row.motion].scaled(row.scale), row.model)
            assert row.roof == pytest.approx(roof(response), rel=1e-9)
            assert row.drift == pytest.approx(drift(response), rel=1e-9)


def test_the_other_columns_do_not_change():
    plain = rf.run_cloud(FRAME, SUITE, "2DOF-S")
    more = rf.run_cloud(FRAME, SUITE, "2DOF-S", demands={"roof": roof}).drop(columns="roof")
    assert list(more.columns) == list(plain.columns)
    assert (more["status"] == plain["status"]).all()
    np.testing.assert_allclose(more["max_rotation"], plain["max_rotation"], rtol=1e-9)


def test_friction_and_a_demand_together():
    runs = rf.run_cloud(FRAME, SUITE, "2DOF-S", friction=True, demands={"roof": roof})
    alone = rf.run_cloud(FRAME, SUITE, "2DOF-S", friction=True)
    np.testing.assert_allclose(runs["required_friction"], alone["required_friction"], rtol=1e-9)
    assert runs["roof"].notna().all()


def test_a_demand_may_be_missing():
    none = {"nothing": lambda _: float("nan"), "none": lambda _: np.float32("nan"), "empty": lambda _: np.array(np.nan)}
    runs = rf.run_cloud(FRAME, SUITE, "2DOF-S", demands=none | {"count": lambda _: 3})
    assert runs[list(none)].isna().all(axis=None)
    assert runs["count"].tolist() == [3.0] * 4


@pytest.mark.parametrize(
    ("demands", "message"),
    [
        (roof, r"demands must be a dictionary from names of columns to functions of a Response, but roof"),
        ({"x": 3}, r"but 'x' is 3\. Give a text as the name, and a function\."),
        ({3: roof}, r"but 3 is roof"),
        ({"pga": roof, "drift": drift}, r"demands: the table has a column pga already\. Give the demand an"),
        ({"x": lambda r: r.rotation[:2]}, r"The demand 'x' must return one number, but for 2DOF-S under FF-1-a it ret"),
        ({"x": lambda _: None}, r"it returned None\. Reduce it, by abs\(\.\.\.\)\.max\(\) for instance\."),
    ],
)
def test_what_is_no_demand_is_refused(demands, message):
    with pytest.raises(InputError, match=message):
        rf.run_cloud(FRAME, SUITE, "2DOF-S", demands=demands)


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_what_a_demand_raises_of_the_first_run_ends_the_study(workers):
    """The first run is held back, so that the others fail before."""
    failed = threading.Event()

    def fails(response):
        if response.motion == SUITE[0].name and workers > 1:
            failed.wait(10.0)
            time.sleep(0.2)  # until the other failure is known
        failed.set()
        return 1 / 0

    with pytest.raises(ZeroDivisionError) as raised:
        rf.run_cloud(FRAME, SUITE, "2DOF-S", workers=workers, demands={"x": fails})
    assert raised.value.__notes__[0] == "This was raised by the demand 'x' of 2DOF-S under FF-1-a."
