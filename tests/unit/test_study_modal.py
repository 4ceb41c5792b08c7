"""Uplifted frequencies, and the modal combination."""

import math

import numpy as np
import pytest
import scipy.linalg

import rockflex as rf
from builders import make_frame

TWO_MODES = make_frame(stiffness_ratio=0.0)
MOTION = rf.load_suite("fema-p695-far-field")["FF-1-a"]


def test_peaks_are_combined_as_the_paper_has_it():
    found, p = rf.modal_combination(TWO_MODES, MOTION), TWO_MODES.rocking()
    one = rf.simulate(TWO_MODES, MOTION, "2DOF-S", output="peaks")
    # The second mode alone, as a structure of its own on a fixed base.
    alone = rf.RockingProperties(
        p.omega[1:2], p.effective_mass[1:2], p.effective_height[1:2], p.top_ordinate[1:2],
        p.i_theta, p.l0r, p.m_tot, p.half_width, p.zeta[1:2], p.translational_inertia
    )  # fmt: skip
    second = rf.simulate(alone, MOTION, "1DOF-fixed", output="peaks")
    for name in ("top_displacement", "base_shear", "base_moment"):
        largest = getattr(second, f"max_{name}")
        assert getattr(found.second, name) == pytest.approx(largest, rel=1e-9)
        combined = math.sqrt(getattr(one, f"max_{name}") ** 2 + largest**2)
        assert getattr(found, f"max_{name}") == pytest.approx(combined, rel=1e-9)
    assert found.rocking.max_rotation == one.max_rotation
    assert found.second.displacement == MOTION.sd(2.0 * math.pi / p.omega[1], 0.02)


def test_one_mode_has_nothing_to_combine():
    with pytest.raises(rf.InputError, match=r"A modal combination needs two modes, but the structure has 1\. Give"):
        rf.modal_combination(TWO_MODES.rocking(1), MOTION)


FRAME = make_frame(base_mass=30e3, stiffness_ratio=0.5, period=0.8, aspect_ratio=7.0)
TOWER = rf.TaperedTower(200.0, 8.0, 4.0, 1.0, 2400.0, 25e9, 0.02)


def test_every_width_is_the_frame_built_with_it():
    table = rf.frequency_ratios(FRAME, (0.5, 7.0, 40.0))
    assert list(table["model"].unique()) == ["2DOF-S", "3DOF-S", "MDOF-S"]
    assert len(table) == 3 * (1 + 2 + 5)
    for (count, aspect_ratio), rows in table.groupby(["n_modes", "aspect_ratio"]):
        frame = make_frame(base_mass=30e3, stiffness_ratio=0.5, period=0.8, aspect_ratio=aspect_ratio)
        modes = rf.uplifted_modes(frame.rocking(), count)
        assert list(rows["mode"]) == list(range(1, count + 1))
        np.testing.assert_allclose(rows["half_width"], frame.half_width, rtol=1e-12)
        np.testing.assert_allclose(rows["omega"], frame.modal().omega[:count], rtol=1e-12)
        np.testing.assert_allclose(rows["uplifted_omega"], modes.omega, rtol=1e-11)
        np.testing.assert_allclose(rows["ratio"], modes.ratio, rtol=1e-11)


def test_rotary_inertia_stays_as_the_base_narrows():
    p = TOWER.rocking()
    (row,) = rf.frequency_ratios(p, [50.0], 1).to_dict("records")
    half_width = p.effective_height[0] / 50.0
    rotary = p.i_theta - p.translational_inertia - p.m_tot * 64.0
    assert rotary > 0.0
    inertia = p.translational_inertia + rotary + p.m_tot * half_width**2
    lever = p.effective_mass[0] * p.effective_height[0]
    mass = np.array([[inertia, lever], [lever, p.effective_mass[0]]])
    stiffness = np.diag([-p.l0r * 9.81, p.effective_mass[0] * p.omega[0] ** 2])
    squares = scipy.linalg.eigh(stiffness, mass, eigvals_only=True)
    assert row["half_width"] == pytest.approx(half_width)
    assert row["uplifted_omega"] == pytest.approx(squares[1] ** 0.5, rel=1e-9)
    assert row["ratio"] == row["uplifted_omega"] / p.omega[0]


def test_models_by_name_and_tendons_stay():
    table = rf.frequency_ratios(FRAME, [3.0], (None, 5))
    assert list(table["model"].unique()) == ["MDOF-S", "6DOF-S"]
    np.testing.assert_array_equal(*(rows["ratio"] for _, rows in table.groupby("model")))
    held = rf.Restrained(FRAME, rf.Tendon(1e5, 1e8))
    stiff, free = (rf.frequency_ratios(each, [5.0], None)["ratio"] for each in (held, FRAME))
    assert (stiff.to_numpy() > free.to_numpy()).all()


def test_about_either_edge_of_an_eccentric_base():
    moved = rf.Eccentric(FRAME, 0.3)
    for side in (1, -1):
        table = rf.frequency_ratios(moved, [3.0, 6.0], None, side=side)
        for width, rows in table.groupby("half_width"):
            expected = rf.uplifted_modes(FRAME.rocking().with_half_width(width - side * 0.3)).omega
            np.testing.assert_allclose(rows["uplifted_omega"], expected, rtol=1e-11)
    np.testing.assert_array_equal(
        rf.frequency_ratios(moved, [3.0])["ratio"], rf.frequency_ratios(moved, [3.0], side=1)["ratio"]
    )


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rf.frequency_ratios(FRAME, [1.0, 0.0]), "aspect_ratios must be one or more positive numbers, but"),
        (lambda: rf.frequency_ratios(FRAME, [1.0], 6), "n_modes must be a whole number from 1 to 5, but 6 was given."),
        (lambda: rf.frequency_ratios(FRAME, [1.0], ()), "n_modes is empty. Give at least one number of modes, or None"),
        (lambda: rf.frequency_ratios(rf.rigid_block(0.2, 2.0), [1.0]), "An aspect ratio h*_1/B needs a structure"),
        (
            lambda: rf.frequency_ratios(
                rf.RockingProperties([1.0], [1.0], [-1.0], [1.0], 9.0, 3.0, 2.0, 1.0, 0.0), [1.0]
            ),
            "An aspect ratio h*_1/B needs a structure whose h*_1 is positive, but one with h*_1 = -1 m was given.",
        ),
    ],
)
def test_what_has_no_ratio_is_named(call, message):
    with pytest.raises(rf.InputError) as caught:
        call()
    assert str(caught.value).startswith(message)
