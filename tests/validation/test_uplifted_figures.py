"""Figs. 10, 12 and 15 of Silva & Stojadinović 2024 as they are drawn."""

import math
from itertools import pairwise

import numpy as np
import pytest
import scipy.optimize

import rockflex as rf
from builders import make_frame
from drawing import drawn

BEHAVIOURS = {"shear": math.inf, "flexure": 0.0}
# At h*/B = 10, from an independent computation: first and second ratio of 2DOF-S, 3DOF-S and all modes.
KNOWN = {
    ("shear", "2DOF-S"): (6.116,),
    ("shear", "3DOF-S"): (2.840, 2.904),
    ("shear", "MDOF-S"): (2.839, 1.621),
    ("flexure", "2DOF-S"): (4.705,),
    ("flexure", "3DOF-S"): (4.038, 1.720),
    ("flexure", "MDOF-S"): (4.034, 1.667),
}


def building(behaviour, n_stories=15, period=1.0):
    return make_frame(
        n_stories=n_stories,
        story_height=45.0 / n_stories,
        story_mass=600e3 / n_stories,
        stiffness_ratio=BEHAVIOURS[behaviour],
        period=period,
    )


@pytest.mark.slow
@pytest.mark.parametrize("behaviour", BEHAVIOURS)
def test_figure_10_at_the_gray_line_and_at_both_ends(behaviour):
    table = rf.frequency_ratios(building(behaviour), np.geomspace(0.01, 1e4, 61))
    figure = drawn(rf.plot_frequency_ratios(table, rf.pinned_beam(behaviour)))
    for axes, mode in zip(figure.axes, (1, 2), strict=True):
        (limit,) = [line.get_ydata()[0] for line in axes.get_lines() if line.get_label() == "_limit"]
        (gray,) = [line.get_xdata()[0] for line in axes.get_lines() if line.get_label() == "_mark"]
        assert gray == 10.0
        for line in axes.get_lines():
            known = KNOWN.get((behaviour, line.get_label()), ())
            if len(known) >= mode:
                x, y = line.get_data()
                assert y[np.argmin(np.abs(x - gray))] == pytest.approx(known[mode - 1], abs=5.1e-4)
                assert y[0] == pytest.approx(1.0, abs=5e-5)
                if line.get_label() == "MDOF-S":
                    assert y[-1] == pytest.approx(limit, rel=7e-3)
                if len(known) == mode and line.get_label() != "MDOF-S":
                    assert y[-1] > 1.3 * limit  # its highest mode stands for all above it


@pytest.mark.parametrize("behaviour", BEHAVIOURS)
def test_all_modes_of_a_narrow_base_tend_to_the_pinned_beam(behaviour):
    limit = rf.pinned_beam(behaviour).ratio
    errors = [
        rf.frequency_ratios(building(behaviour, n, 0.05), [1e4], None)["ratio"].to_numpy()[:2] / limit - 1.0
        for n in (15, 30, 60)
    ]
    print(behaviour, errors)
    for coarse, fine in pairwise(errors):
        np.testing.assert_allclose(fine / coarse, 0.25, atol=0.03)


@pytest.mark.parametrize("behaviour", BEHAVIOURS)
def test_figure_12_crosses_zero_where_the_ratios_say(behaviour):
    p = building(behaviour).rocking()
    (axes,) = drawn(rf.plot_frequency_equation(p)).axes
    for model in ("2DOF-S", "3DOF-S", "MDOF-S"):
        known = np.array(KNOWN[behaviour, model]) * p.omega[: len(KNOWN[behaviour, model])] / p.omega[0]
        (marks,) = [line for line in axes.get_lines() if line.get_label() == f"_{model}"]
        np.testing.assert_allclose(marks.get_xdata()[: known.size], known, rtol=4e-4)
        (curve,) = [line for line in axes.get_lines() if line.get_label() == model]
        x, y = curve.get_data()
        for root in marks.get_xdata():
            i = np.flatnonzero((x[:-1] <= root) & (x[1:] > root))[0]
            assert y[i] >= 0.0 > y[i + 1]
            zero = scipy.optimize.brentq(
                lambda w: rf.frequency_equation(p.truncated({"2": 1, "3": 2, "M": 15}[model[0]]), w * p.omega[0]),  # noqa: B023
                x[i], x[i + 1], xtol=1e-13,
            )  # fmt: skip
            assert root == pytest.approx(zero, rel=1e-10)


def test_figure_15_names_the_peaks():
    motion = rf.load_suite("el-centro-1940")[0].scaled(2.0)
    tower = rf.TaperedTower(200.0, 8.0, 4.0, 1.0, 2400.0, 25e9, 0.02)
    models = ("5DOF-fixed", "2DOF-S", "3DOF-S", "6DOF-S")
    panels = ("rotation", "top_displacement", "base_moment", "base_shear")  # those of the paper
    axes = drawn(rf.plot_history([rf.simulate(tower, motion, model) for model in models], panels=panels)).axes
    assert len(axes) == 4
    assert "0.00315 at 3.78 s" in [text.get_text() for text in axes[0].texts]


def ratios(stiffness_ratio: float, aspect_ratio: float, n_modes: int | None) -> np.ndarray:
    frame = make_frame(n_stories=15, stiffness_ratio=stiffness_ratio, aspect_ratio=aspect_ratio)
    return rf.uplifted_modes(frame.rocking(), n_modes).ratio


@pytest.mark.parametrize(("stiffness_ratio", "behaviour"), [(math.inf, "shear"), (0.0, "flexure")])
def test_curves_over_slenderness(stiffness_ratio: float, behaviour: str) -> None:
    slenderness = np.geomspace(0.1, 100.0, 25)
    one, two, every = (np.array([ratios(stiffness_ratio, s, n)[:2] for s in slenderness]) for n in (1, 2, None))
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
