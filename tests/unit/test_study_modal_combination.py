"""2DOF-S and the second mode on a fixed base, combined."""

import math

import pytest

import rockflex as rf
from builders import make_frame

FRAME = make_frame(stiffness_ratio=0.0)
MOTION = rf.load_suite("fema-p695-far-field")["FF-1-a"]


def test_peaks_are_combined_as_the_paper_has_it():
    found, p = rf.modal_combination(FRAME, MOTION), FRAME.rocking()
    one = rf.simulate(FRAME, MOTION, "2DOF-S", output="peaks")
    # The second mode alone, as a structure of its own on a fixed base.
    alone = rf.RockingProperties(
        p.omega[1:2], p.effective_mass[1:2], p.effective_height[1:2], p.top_ordinate[1:2],
        p.i_theta, p.l0r, p.m_tot, p.half_width, p.zeta[1:2], p.translational_inertia,
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
    with pytest.raises(
        rf.InputError, match=r"A modal combination needs two modes, but the structure has 1\. Give more"
    ):
        rf.modal_combination(FRAME.rocking(1), MOTION)
