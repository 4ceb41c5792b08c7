"""What each run of a page assumed: its laws, its ground and its start, and the hash of all that was given."""

import re

import numpy as np
import pytest

import rockflex as rf
from report_case import FRAME, PIER, PULSE, SPRINGS, runs
from report_page import read

BLOCK = rf.rigid_block(0.2, 3.0, 20e3)
SOFT = rf.Ground(0.4, rf.Springs([-0.8, 0.8], stiffness=2e8, damping=3e5), base_inertia=4e4)
LIGHT = rf.Ground(springs=rf.Springs([-0.4, 0.0, 0.5], stiffness=2e8, damping=3e5), base_inertia=4e4)


def lines(path):
    """The headed lines of a page."""
    return dict(re.findall(r"<p><b>(.+?)\.</b> (.*?)</p>", re.sub(r"</?su[bp]>", "", path.read_text("utf-8"))))


def one(*arguments, **options):
    return rf.simulate(*arguments, output="history", **options)


def test_inputs_of_some_runs_have_their_labels(tmp_path):
    yields = [one(FRAME, PULSE, "2DOF-S-BW", bouc_wen=rf.BoucWen(d)) for d in (0.02, 0.08)]
    grounds = [one(FRAME, PULSE, "2DOF-S", ground=g) for g in (rf.Ground(friction=0.1), SOFT)]
    found = lines(rf.write_report([*yields, *grounds, one(FRAME, PULSE, "2DOF-S")], tmp_path / "r.html"))
    bouc_wen, soft = found["Hysteresis"].split("; ")
    assert bouc_wen.startswith("Bouc–Wen, Dy = 20.0 mm, post-yield ratio 0.01, γ")
    assert bouc_wen.endswith(" (2DOF-S-BW (1))")
    assert "Dy = 80.0 mm" in soft
    assert soft.endswith(" (2DOF-S-BW (2))")
    assert found["Ground"].endswith(" (2DOF-S (2))")
    assert found["Friction"] == ("the base slides at μ = 0.1 (2DOF-S (1)); the base slides at μ = 0.4 (2DOF-S (2))")
    assert found["Impact law"].endswith("VVELSimplified (2DOF-S (1), 2DOF-S (3))") or "(" not in found["Impact law"]


def test_inputs_of_all_runs_have_none(tmp_path):
    found = lines(rf.write_report(runs(PIER, PULSE, ["2DOF-S", "MDOF-S"], ground=SPRINGS), tmp_path / "r.html"))
    assert found["Friction"] == "the base slides at μ = 0.4"
    assert found["Ground"].startswith("12 springs without tension, x = −1.80 to 1.80 m, Σk = 1440 MN/m")
    assert found["Ground"].endswith(" in heave), Ib = 500 t m²")
    assert "Initial state" not in found


def test_the_start_is_on_the_page(tmp_path):
    quiet, starts = rf.quiet_motion(6.0), (rf.InitialState(0.05), rf.InitialState(rotation_velocity=-0.1), None)
    found = [one(FRAME, quiet, "2DOF-S", initial=start) for start in starts]
    path = rf.write_report(found, tmp_path / "r.html")
    assert lines(path)["Initial state"] == "θ = 50.0 mrad (2DOF-S (1)); θ′ = −0.100 rad/s (2DOF-S (2))"
    checks = [row[1] for row in read(path).tables["checks"][1:]]
    for (text, _, value), run in zip(checks[:2], found[:2], strict=True):
        assert run.n_uplifts > 0
        assert value == run.uplift_times[0]
        assert re.fullmatch(rf"starts uplifted; {run.n_uplifts}×, next at [\d.]+ s", text)
    assert checks[2][0] == "none"
    block = one(BLOCK, quiet, "rigid", initial=starts[0])
    assert block.n_uplifts == 0  # it passes from one edge to the other
    assert read(rf.write_report(block, path)).tables["checks"][1][1][0] == "starts uplifted"


def test_the_start_on_springs_counts_from_rest(tmp_path):
    still = one(FRAME, PULSE, "2DOF-S", ground=LIGHT)
    assert abs(still.rotation[0]) > 1e-6  # the springs are not symmetric
    tipped = one(FRAME, PULSE, "2DOF-S", ground=LIGHT, initial=rf.InitialState(0.002, [0.003]))
    found = lines(rf.write_report([still, tipped], tmp_path / "r.html"))
    assert found["Initial state"] == "θ = 2.00 mrad, D1 = 3.00 mm (2DOF-S (2))"


def test_the_hash_tells_inputs_apart(tmp_path):
    quick = rf.quiet_motion(0.2)
    shaken = rf.GroundMotion(PULSE.acceleration[:40], PULSE.dt, vertical=PULSE.acceleration[:40])
    plain = rf.GroundMotion(shaken.acceleration, shaken.dt)
    other = rf.Ground(springs=rf.Springs([-0.4, 0.0, 0.6], stiffness=2e8, damping=3e5), base_inertia=4e4)
    cases = [
        *((quick, {"ground": ground}) for ground in (None, rf.Ground(friction=0.1), rf.Ground(friction=0.2))),
        *((quick, {"ground": ground}) for ground in (LIGHT, other, rf.Ground(springs=LIGHT.springs, base_inertia=5e4))),
        *((quick, {"impact": rf.Restitution(e)}) for e in (0.5, 0.6)),
        *((quick, {"initial": rf.InitialState(angle)}) for angle in (0.02, 0.021)),
        (quick, {"free_vibration": 0.3}),
        (plain, {}),
        (shaken, {}),
    ]

    def hashes(run, motion):
        pages = [rf.write_report(run, tmp_path / "r.html", motion=each).read_text("utf-8") for each in (None, motion)]
        return [re.search(r"inputs ([0-9a-f]{12})<", page)[1] for page in pages]

    found = [hashes(one(FRAME, motion, "2DOF-S", **options), motion) for motion, options in cases]
    for column in zip(*found, strict=True):
        assert len(set(column)) == len(cases)
    assert hashes(one(FRAME, quick, "2DOF-S", impact=rf.Restitution(0.5)), quick) == found[6]


def test_peaks_of_ground_motion_are_those_of_the_run_if_all_overturn(tmp_path):
    late = np.concatenate([rf.one_sine_pulse(8.0, 2.5).acceleration, [0.0, 30.0, 0.0, 0.0]])
    motion = rf.GroundMotion(late, rf.one_sine_pulse(8.0, 2.5).dt)
    fell = one(FRAME, motion, "2DOF-S")
    assert fell.status == "overturned"
    path = tmp_path / "r.html"
    for found, record, words in (
        (fell, None, True), (fell, motion, False), ([fell, one(FRAME, motion, "fixed")], None, False),
    ):  # fmt: skip
        reader = read(rf.write_report(found, path, motion=record))
        names = re.findall(r"PGA( during the run)?", reader.text)
        assert [bool(each) for each in names] == [words]
        assert (reader.facts["pga"][2] == pytest.approx(30.0)) == (not words)


def test_impact_laws_in_words(tmp_path):
    tipped = rf.Eccentric(FRAME, 0.2)
    run = one(tipped, PULSE, "rigid")
    found = lines(rf.write_report(run, tmp_path / "r.html"))
    law = run.history.model.law
    right, left = map(float, re.findall(r"0\.\d{3}", found["Impact law"]))
    assert right != left
    assert right == pytest.approx(law.right.e, abs=1e-3)
    assert left == pytest.approx(law.left.e, abs=1e-3)
