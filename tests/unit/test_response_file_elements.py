"""Responses with elements on disk, and files of the version before there were any but elastic tendons."""

import json
import math

import numpy as np
import pytest

import rockflex as rf

ELEMENTS = [
    rf.Tendon(2e5, 1e7, 0.4, 2.2e5, 0.02, 0.9),
    rf.Tendon(1e5, 2e6, -0.2),
    rf.YieldingDissipator(2e7, 3e4, 0.1, -0.9, True, 0.5),
    rf.YieldingDissipator(2e7, 3e4),
    rf.ViscousDamper(2e4, 0.3),
]
START = rf.InitialState(rotation=0.02)
OF_ELEMENTS = ("max_element_force", "max_element_elongation", "element_yielded", "remaining_prestress")

# What the version before wrote for the block below: a base with two elastic tendons falls back onto the ground.
OLDER = """{"format": "rockflex-response-2", "model": "rigid", "motion": "Quiet t=0.3 s", "status": "rocking",
"max_rotation": 0.02, "time_of_max_rotation": 0.0, "max_top_displacement": 0.0, "time_of_max_top_displacement": 0.0,
"max_base_moment": 0.0, "time_of_max_base_moment": 0.0, "max_base_shear": 0.0, "time_of_max_base_shear": 0.0,
"max_total_top_displacement": NaN, "time_of_max_total_top_displacement": NaN,
"max_horizontal_reaction": 244199.99999999997, "time_of_max_horizontal_reaction": 0.2610919081441764,
"min_vertical_reaction": 1219950.0, "time_of_min_vertical_reaction": 0.2610919081441764, "max_tendon_force": 212000.0,
"tendon_utilisation": 1.0095238095238095, "n_uplifts": 0, "n_impacts": 1, "nominal_overturning": false,
"end_time": 0.30000000000000004, "settled": false, "lifts": true, "law": {"law": "VVELSimplified"},
"missing_mass": false, "top_height": null, "base_mass": null, "eccentricity": 0.0, "tendons": [{"initial_force":
200000.0, "stiffness": 1000000.0, "position": 0.4, "yield_force": 210000.0}, {"initial_force": 100000.0, "stiffness":
500000.0, "position": -0.2, "yield_force": null}]}"""
STATES = [
    [0.0, 1.0, 0.0, 0.02, 0.0],
    [0.1, 1.0, 0.0, 0.017086249659398433, -0.058344046334398485],
    [0.2, 1.0, 0.0, 0.008303515985738825, -0.11751872861181942],
    [0.2610919081441764, 1.0, 0.0, 0.0, -0.154438337209386],
    [0.2610919081441764, 0.0, 0.0, 0.0, -0.0],
    [0.30000000000000004, 0.0, 0.0, 0.0, 0.0],
]


def block(elements):
    return rf.RockingProperties(
        [], [], [], [], i_theta=2.0e6, l0r=4.0e5, m_tot=1.0e5, half_width=1.0, zeta=[], elements=elements
    )


def older(path, **changes):
    """Write a file as the version before did; `changes` of its scalars, None leaves the history out."""
    p, scalars = block(()), json.loads(OLDER) | changes
    names = ("omega", "effective_mass", "effective_height", "top_ordinate", "i_theta", "l0r", "m_tot", "half_width")
    arrays = {f"properties.{name}": getattr(p, name) for name in (*names, "zeta", "translational_inertia")}
    if scalars["tendons"] is not None:
        arrays["states"] = np.array(STATES)
    np.savez_compressed(path, **arrays, response=np.array(json.dumps(scalars)))
    return path


@pytest.mark.parametrize("output", ["history", "peaks"])
def test_every_element_comes_back(tmp_path, output):
    motion = rf.one_sine_pulse(5.0, 0.5)
    run = rf.simulate(block(ELEMENTS), motion, "rigid", output=output, impact=rf.VVELSimplified())
    assert run.element_yielded.any()
    back = rf.Response.load(run.save(tmp_path / "run"))
    for name in OF_ELEMENTS:
        assert np.array_equal(getattr(back, name), getattr(run, name))
        assert getattr(back, name).dtype == getattr(run, name).dtype
        assert not getattr(back, name).flags.writeable
    assert back.residual_rotation == run.residual_rotation
    assert back == run or math.isnan(run.max_total_top_displacement)
    if output == "history":
        assert back.history == run.history
        assert back.history.model.properties.elements == tuple(ELEMENTS)
        assert np.array_equal(back.element_force, run.element_force)
        assert np.array_equal(back.energy.elements, run.energy.elements)


def test_a_file_of_the_version_before(tmp_path):
    tendons = [rf.Tendon(2e5, 1e6, 0.4, yield_force=2.1e5), rf.Tendon(1e5, 5e5, -0.2)]
    now = rf.simulate(block(tendons), rf.quiet_motion(0.3, dt=0.1), "rigid", initial=START, impact=rf.VVELSimplified())
    back = rf.Response.load(older(tmp_path / "old.npz"))
    assert back.history.model.properties.elements == tuple(tendons)
    for name, value in now.peaks().items():
        known = pytest.approx(value, rel=1e-12, nan_ok=True) if isinstance(value, float) else value
        assert getattr(back, name) == known, name
    for name in OF_ELEMENTS:
        np.testing.assert_allclose(getattr(back, name), getattr(now, name), rtol=1e-12)
    assert (back.tendon_yield, back.tendon_overload, back.residual_rotation) == (True, True, 0.0)
    assert back.warnings == now.warnings
    np.testing.assert_allclose(back.tendon_force, now.tendon_force, rtol=1e-12)
    assert rf.Response.load(back.save(tmp_path / "again")) == back


@pytest.mark.parametrize(
    ("changes", "residual"),
    [
        ({}, math.nan),
        ({"settled": True}, 0.0),
        ({"status": "no_uplift"}, 0.0),
        ({"status": "overturned", "settled": False}, math.nan),
    ],
)
def test_peaks_of_the_version_before(tmp_path, changes, residual):
    back = rf.Response.load(older(tmp_path / "old.npz", tendons=None, **changes))
    assert back.history is None
    assert back.max_element_force.size == back.remaining_prestress.size == 0
    assert back.max_tendon_force == 212000.0
    assert back.tendon_overload
    assert back.residual_rotation == pytest.approx(residual, nan_ok=True)


@pytest.mark.parametrize(
    ("name", "change", "text"),
    [
        (
            "max_element_force",
            lambda a: a[:3],
            r"max_element_force must have the shape \(5,\), but .* \(3,\)",
        ),
        ("remaining_prestress", lambda a: a[None], r"remaining_prestress must have the shape \(2,\), but .* \(1, 2\)"),
        ("element_yielded", lambda a: a != 0.0, r"elements\.element_yielded must be of type float64, but .* bool"),
        ("max_element_elongation", None, r"KeyError: 'elements\.max_element_elongation'"),
    ],
)
def test_arrays_of_elements_that_do_not_fit(tmp_path, name, change, text):
    motion = rf.quiet_motion(0.3, dt=0.1)
    path = rf.simulate(block(ELEMENTS), motion, "rigid", initial=START, impact=rf.VVELSimplified()).save(tmp_path / "a")
    with np.load(path) as file:
        arrays = dict(file)
    values = arrays.pop(f"elements.{name}")
    np.savez(path, **arrays, **({f"elements.{name}": change(values)} if change else {}))
    with pytest.raises(rf.InputError, match=text):
        rf.Response.load(path)
