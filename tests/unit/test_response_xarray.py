"""A history as a labelled data set."""

import sys

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame, random_shaking
from rockflex.response._outputs import HISTORY

FRAME = make_frame(n_stories=3, period=0.6, aspect_ratio=8.0)
MOTION = rf.GroundMotion(random_shaking(4, 9.0, 4.0, 0.02), 0.02, "random")


@pytest.fixture(scope="module")
def response():
    return rf.simulate(rf.Restrained(FRAME, [rf.Tendon(1e5, 1e6), rf.ViscousDamper(1e4)]), MOTION, "3DOF-S")


def test_a_data_set_has_all_quantities_labelled(response):
    pytest.importorskip("xarray")
    data = response.to_xarray()
    sizes = {"mode": 2, "floor": 3, "element": 2, "tendon": 1, "edge": 2}
    assert dict(data.sizes) == sizes | {"time": response.time.size}
    assert set(data) == set(HISTORY) - {
        "time",
        "soil_pressure",
        "bearing_pressure",
        "spring_force",
        "joint_rotation",
        "joint_force",
        "permanent_settlement",
    }
    assert data.attrs == {"model": "3DOF-S"}
    for name, values in data.items():
        np.testing.assert_array_equal(values, getattr(response, name))
        assert values.attrs.get("units", "") == HISTORY[name].si
    top = data["floor_acceleration"].sel(floor=3)
    np.testing.assert_array_equal(top, response.floor_acceleration[:, 2])
    left = data["edge_uplift"].sel(edge="left")
    np.testing.assert_array_equal(left, response.edge_uplift[:, 0])
    np.testing.assert_array_equal(data["time"], response.time)


def test_chosen_quantities_at_equal_steps(response):
    pytest.importorskip("xarray")
    data = response.resample(0.1).to_xarray(["rotation", "modal_velocity"])
    assert set(data) == {"rotation", "modal_velocity"}
    assert data["rotation"].sel(time=2.0, method="nearest") == response.at(2.0).rotation[0]
    with pytest.raises(rf.InputError, match="but 'angle' was given"):
        response.to_xarray(["angle"])


def test_a_bed_has_springs():
    pytest.importorskip("xarray")
    springs = rf.winkler_bed(FRAME.rocking().half_width, 3.0, n=6, subgrade_modulus=5e7)
    data = rf.simulate(FRAME, MOTION, "2DOF-S", ground=rf.Ground(springs=springs, base_inertia=2e4)).to_xarray()
    assert data["spring_force"].dims == ("time", "spring")
    assert data["soil_pressure"].attrs["units"] == "Pa"


def test_without_xarray_it_says_what_to_install(response, monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(rf.InputError, match=r'to_xarray needs xarray, .* pip install "rockflex\[xarray\]"; or use'):
        response.to_xarray()
