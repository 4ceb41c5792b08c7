"""Bases whose elements may balance the weight are integrated."""

import itertools

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from rockflex.models import LinearModel, NonlinearModel, Quantities, parse_model
from rockflex.models._balance import meets
from rockflex.solve import Engine

FRAME = rf.Frame(**frame_values(stiffness_ratio=0.125, period=0.7, aspect_ratio=7.0))
P = FRAME.rocking()
B, WEIGHT = P.half_width, P.l0r * 9.81
EL_CENTRO = rf.load_suite("el-centro-1940")[0]


def model_of(*elements):
    return parse_model("2DOF-S").of(rf.Restrained(FRAME, elements).rocking())


@pytest.mark.parametrize(
    "elements",
    [
        # Elastic, after yielding, the one that is slack left out, or a yielding fuse together with an elastic tendon
        [rf.Tendon(1e5, WEIGHT / B**2)],
        [rf.YieldingDissipator(50.0 * WEIGHT / B**2, 1e5, 0.02)],
        [rf.YieldingDissipator(3.0 * WEIGHT / B**2, 1e5, 0.0, tension_only=True), rf.Tendon(0.0, WEIGHT / B**2)],
        [rf.YieldingDissipator(4.0 * WEIGHT / B**2, 1e5, 0.1), rf.Tendon(1e5, 0.6 * WEIGHT / B**2)],
        [rf.YieldingDissipator(9.0 * WEIGHT / B**2, 1e5, 0.0, rupture_elongation=1.0), rf.Tendon(0.0, WEIGHT / B**2)],
    ],
)
def test_balanced_on_some_branches(elements):
    assert isinstance(model_of(*elements), NonlinearModel)


@pytest.mark.parametrize(
    "elements",
    [
        [rf.Tendon(1e5, 1.1 * WEIGHT / B**2)],
        # A fuse that can also push is never slack.
        [rf.YieldingDissipator(3.0 * WEIGHT / B**2, 1e5, 0.3), rf.Tendon(0.0, WEIGHT / B**2)],
        [rf.ViscousDamper(1e9, B)],
    ],
)
def test_not_balanced(elements):
    assert isinstance(model_of(*elements), LinearModel)


def test_every_combination_counts():
    rng = np.random.default_rng(3)
    for _ in range(200):
        choices = [rng.uniform(0.0, 0.4, rng.integers(1, 4)) for _ in range(rng.integers(1, 7))]
        sums = np.array([sum(each) for each in itertools.product(*choices)])
        nearest = np.abs(sums - 1.0).min()
        for margin in (0.5 * nearest, 2.0 * nearest):
            assert meets(choices, 1.0, margin) == (margin > nearest)


def test_many_elements_take_no_time():
    choices = [np.array([0.0, 1e-3 * k, 1e-2 * k]) for k in range(1, 41)]
    assert meets(choices, 1.0, 1e-3)


@pytest.mark.parametrize("share", [0.97, 1.03])
def test_both_engines_agree_near_balance(share):
    model = model_of(
        rf.YieldingDissipator(20.0 * share * WEIGHT / B**2 / 4.0, 1e5, 0.2, -B),
        rf.Tendon(1e5, 8e6, 0.0, 2e5, 0.01),
    )
    assert isinstance(model, LinearModel)
    other = NonlinearModel(model.label, model.properties, complete=False, law=model.law)
    one, two = (
        Engine(each, Quantities.none(1)).run(2.0 * EL_CENTRO.acceleration, EL_CENTRO.dt) for each in (model, other)
    )
    assert one.n_impacts == two.n_impacts > 5
    assert one.peaks[0] == pytest.approx(two.peaks[0], rel=2e-9)
