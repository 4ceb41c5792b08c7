"""Fig. 10: first and second uplifted frequencies of the 15-story structures, T_1 = 1 s, base mass one story mass."""

import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

SHEAR, FLEXURE = math.inf, 0.0


def ratios(stiffness_ratio: float, aspect_ratio: float, n_modes: int | None) -> np.ndarray:
    frame = make_frame(n_stories=15, stiffness_ratio=stiffness_ratio, aspect_ratio=aspect_ratio)
    return rf.uplifted_modes(frame.rocking(), n_modes).ratio


@pytest.mark.parametrize(("stiffness_ratio", "behaviour"), [(SHEAR, "shear"), (FLEXURE, "flexure")])
def test_curves_over_slenderness(stiffness_ratio: float, behaviour: str) -> None:
    slenderness = np.geomspace(0.1, 100.0, 25)
    one, two, every = (np.array([ratios(stiffness_ratio, s, n)[:2] for s in slenderness[:]]) for n in (1, 2, None))
    # Fewer modes are stiffer: the space of motions is smaller.
    assert (one[:, 0] >= two[:, 0]).all()
    assert (two >= every).all()
    assert (np.diff(one[:, 0]) > 0.0).all()
    assert (np.diff(every, axis=0) > 0.0).all()
    # The pinned beam, without gravity and with mass spread evenly, bounds all modes together from above.
    bound = rf.pinned_beam(behaviour).ratio
    print(behaviour, "h*/B → ∞:", every[-1], "pinned beam:", bound)
    assert (every[-1] < bound).all()
    np.testing.assert_allclose(every[0], 1.0, atol=0.02)


def test_a_base_of_no_width_without_gravity_is_the_pinned_beam() -> None:
    # A stiff beam feels no gravity; as B → 0 and with ever more modes its uplifted modes are those of the pinned beam.
    def first_two(n_modes: int) -> np.ndarray:
        beam = rf.Beam(
            height=30.0,
            mass=800.0,
            bending_stiffness=4e15,
            half_width=0.001,
            damping_ratio=0.0,
            n_modes=n_modes,
            n_elements=400,
        )
        return rf.uplifted_modes(beam.rocking()).ratio[:2]

    bound = rf.pinned_beam("flexure").ratio
    errors = np.array([first_two(n) / bound - 1.0 for n in (5, 10, 20, 40)])
    print("error of the uplifted modes by modes kept:\n", errors)
    assert (errors[:2] > 0.0).all()
    assert (errors[1] < errors[0] / 50.0).all()
    # What is left is the width that the base still has.
    np.testing.assert_allclose(errors[2:], 0.0, atol=1e-7)
