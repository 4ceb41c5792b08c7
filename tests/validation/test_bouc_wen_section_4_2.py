"""Silva & Stojadinović 2024, Section 4.2: structure #1 that yields, under El Centro, to three digits."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

FRAME = make_frame()
RECORD = rf.load_suite("el-centro-1940")[0]


def run(yield_displacement, model):
    return rf.simulate(FRAME, RECORD, model, bouc_wen=rf.BoucWen(yield_displacement))


def test_printed_peaks_at_75_mm():
    rocking, fixed = run(0.075, "2DOF-S-BW"), run(0.075, "1DOF-fixed-BW")
    assert rocking.max_rotation == pytest.approx(1.123e-2, abs=0.5e-5)
    assert rocking.max_top_displacement == pytest.approx(0.0546, abs=0.5e-4)
    assert fixed.max_top_displacement == pytest.approx(0.1354, abs=0.5e-4)
    assert fixed.max_rotation == 0.0


def test_it_rocks_and_barely_yields_at_75_mm():
    rocking, fixed = run(0.075, "2DOF-S-BW"), run(0.075, "1DOF-fixed-BW")
    elastic = rf.simulate(FRAME, RECORD, "2DOF-S")
    assert rocking.max_rotation == pytest.approx(elastic.max_rotation, rel=0.05)
    assert np.abs(rocking.yielding).max() < 0.6 < 0.99 < np.abs(fixed.yielding).max()


def test_it_yields_and_barely_rocks_at_35_mm():
    weak, elastic = run(0.035, "2DOF-S-BW"), rf.simulate(FRAME, RECORD, "2DOF-S")
    assert 0.0 < weak.max_rotation < 0.4 * elastic.max_rotation
    assert np.abs(weak.yielding).max() > 0.99
    # What stays behind is plastic: the force has returned to zero and the top has not.
    elastic_part = weak.base_shear / elastic.max_base_shear * elastic.max_top_displacement
    assert np.abs(weak.top_displacement - elastic_part).max() > 0.02


def test_a_weaker_structure_does_not_rock_at_all():
    weakest, fixed = run(0.03, "2DOF-S-BW"), run(0.03, "1DOF-fixed-BW")
    assert weakest.status == "no_uplift"
    assert weakest.max_top_displacement == pytest.approx(fixed.max_top_displacement, rel=1e-9)
