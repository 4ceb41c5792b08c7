"""What the runs of one page have in common, and the ground that they must share."""

import math

import numpy as np
import pytest

import rockflex as rf
from report_case import FRAME, PULSE, runs
from report_page import read

PERIOD = 0.6
JUMPS = {
    "cosine": rf.one_cosine_pulse(4.0, PERIOD),
    "rectangular": rf.rectangular_pulse(4.0, PERIOD),
    "cut off": rf.GroundMotion(PULSE.acceleration[: PULSE.acceleration.size // 2 + 3], PULSE.dt, name="cut"),
}


@pytest.mark.parametrize("free", [0.0, 3.0, "settle"])
@pytest.mark.parametrize("name", JUMPS)
def test_a_record_may_end_with_a_jump(name, free, tmp_path):
    motion = JUMPS[name]
    assert motion.acceleration[-1] != 0.0
    found = runs(FRAME, motion.scaled(0.7), ["2DOF-S", "MDOF-S", "fixed"], free_vibration=free)
    facts = read(rf.write_report(found, tmp_path / "r.html", motion=motion)).facts
    assert facts["scale"][2] == pytest.approx(0.7)


def test_a_run_that_settles_at_the_jump(tmp_path):
    weak = JUMPS["cosine"].scaled(0.01)
    still, long = (rf.simulate(FRAME, weak, "2DOF-S", output="history", free_vibration=how) for how in ("settle", 1.0))
    for pair in ([still, long], [long, still]):
        assert read(rf.write_report(pair, tmp_path / "r.html", motion=weak)).facts["scale"][2] == pytest.approx(0.01)


def with_vertical(motion, factor):
    return rf.GroundMotion(motion.acceleration, motion.dt, name="named", vertical=factor * motion.acceleration)


def test_the_vertical_component_is_compared(tmp_path):
    path = tmp_path / "r.html"
    plain, *shaken = (rf.simulate(FRAME, with_vertical(PULSE, k), "2DOF-S", output="history") for k in (0.0, 0.4, 0.5))
    for pair in ([plain, shaken[0]], shaken):
        for each in (pair, pair[::-1]):
            with pytest.raises(rf.InputError, match=r"differ in the vertical acceleration of the ground\. Write"):
                rf.write_report(each, path)
    for motion, run, words in (
        (
            with_vertical(PULSE, 0.0),
            shaken[0],
            "were run with vertical acceleration, but 'named' is without it. Give",
        ),
        (with_vertical(PULSE, 0.4), plain, "run without vertical acceleration, but 'named' is with it. Give"),
        (with_vertical(PULSE, 0.4), shaken[1], "run with vertical acceleration, but 'named' is with it, or with an"),
    ):
        with pytest.raises(rf.InputError) as error:
            rf.write_report(run, path, motion=motion)
        assert words in str(error.value)
    assert not path.exists()
    twice = runs(FRAME, with_vertical(PULSE, 0.4).scaled(2.0), ["2DOF-S", "MDOF-C", "fixed"])
    facts = read(rf.write_report(twice, path, motion=with_vertical(PULSE, 0.4))).facts
    assert facts["pva"][2] == pytest.approx(0.8 * PULSE.pga, rel=1e-3)


def test_the_margin_of_an_eccentric_base_is_that_of_the_side_it_moves_to(tmp_path):
    whole = FRAME.rocking()
    tipped = rf.Eccentric(FRAME, 0.3 * whole.half_width)
    height = whole.effective_height[0]
    for motion in (PULSE.scaled(1.4), PULSE.scaled(-1.4)):
        (run,) = runs(tipped, motion, ["2DOF-S"], free_vibration=3.0)
        reader = read(rf.write_report(run, tmp_path / "r.html", structure=tipped))
        checks = {name: (text, value) for text, name, value in reader.tables["checks"][1]}
        arms = {1: 0.7 * whole.half_width, -1: 1.3 * whole.half_width}
        shares = [np.max(side * run.rotation) / math.atan2(arm, height) for side, arm in arms.items()]
        text, margin = checks["overturning_margin"]
        assert margin == pytest.approx(0.7 / max(shares), rel=1e-3)
        assert ("<" in text) == (margin < 1.0)
        peaks = {name: value for _, name, value in reader.tables["peaks"][1]}
        assert peaks["nominal_share"] == pytest.approx(max(shares) / 0.7, rel=1e-3)
        assert reader.facts["nominal_right"][2] == pytest.approx(0.7 * math.atan2(arms[1], height))
        assert reader.facts["alpha_right"][2] == pytest.approx(whole.m_tot * arms[1] / whole.l0r)
        words = reader.text.replace("θmax", "θ_max").replace("θnom", "θ_nom")
        assert "θ_nom over θ_max, to the side that is nearer to it" in words


def test_an_empty_title_is_no_title(tmp_path):
    (run,) = runs(FRAME, PULSE, ["2DOF-S"])
    assert "Frame under Ricker" in read(rf.write_report(run, tmp_path / "r.html", structure=FRAME, title="")).text
