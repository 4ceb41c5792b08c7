"""Where the rocking phase does not uncouple it stays dense: the same motion, by full matrices."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from builders import frame_values
from rockflex import Frame, GroundMotion, load_suite, simulate
from rockflex.models import parse_model
from rockflex.response import asked_of
from rockflex.solve import Engine
from rockflex.solve.exact import basis
from twins.exact import Exact
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

MOTION = load_suite("el-centro-1940")[0].scaled(1.5)
PEAKS = ("rotation", "top_displacement", "base_moment", "base_shear")


def frame(**changes):
    given = frame_values(n_stories=3, stiffness_ratio=0.125, period=0.5, aspect_ratio=9.0)
    return {**given, **changes}


def prepared(given, label, dt=MOTION.dt):
    """The phases of contact and of rocking to the right, uncoupled, and their tables for a time step."""
    tied = parse_model(label).of(Frame(**given).rocking())
    phases = Engine(tied, asked_of(tied))._phases
    places = [phases.place(tied.start(side)) for side in (0, 1)]
    assert phases.dense == any(phases._bases[place].dense for place in places)
    return [phases._bases[place] for place in places], phases.system(dt, 0.0), places


def assert_dense(bases, system, places):
    """Rocking alone: contact uncouples as it stands."""
    assert [each.dense for each in bases] == [False, True]
    assert system.phases["dense"][places].tolist() == [False, True]
    assert system.propagator.size
    assert system.propagator[places[1]].any()


def assert_uncoupled(bases, system, places):
    assert [each.dense for each in bases] == [False, False]
    assert not system.phases["dense"].any()
    assert system.propagator.size == 0
    assert places[0] != places[1]


def assert_same_peaks(one, other, rtol):
    assert (one.status, one.n_uplifts, one.n_impacts) == (other.status, other.n_uplifts, other.n_impacts)
    for name in PEAKS:
        assert getattr(one, f"max_{name}") == pytest.approx(getattr(other, f"max_{name}"), rel=rtol, abs=0.0), name


@pytest.mark.parametrize("label", ["2DOF-S", "MDOF-S"])
@pytest.mark.parametrize("damping_ratio", [0.0, 0.02, 0.2])
def test_dense_and_uncoupled_agree(monkeypatch, label, damping_ratio):
    given = frame(damping_ratio=damping_ratio)
    uncoupled = simulate(Frame(**given), MOTION, label, free_vibration=2.0)
    assert uncoupled.n_impacts > 5
    monkeypatch.setattr(basis, "WORST_CONDITION", 0.0)
    assert_dense(*prepared(given, label))
    dense = simulate(Frame(**given), MOTION, label, free_vibration=2.0)
    # Without damping the motion itself doubles any difference at every impact.
    assert_same_peaks(dense, uncoupled, 1e-10 if damping_ratio else 1e-7)
    for name in ("story_drift", "story_shear", "floor_acceleration"):
        np.testing.assert_allclose(getattr(dense.floors, name), getattr(uncoupled.floors, name), rtol=1e-7)
    assert dense.energy.closing_error < 1e-9


def test_many_modes_that_turn_often_within_a_sample(monkeypatch):
    given = frame(n_stories=8, stiffness_ratio=0.0, period=0.4)
    uncoupled = simulate(Frame(**given), MOTION)
    monkeypatch.setattr(basis, "WORST_CONDITION", 0.0)
    assert_same_peaks(simulate(Frame(**given), MOTION), uncoupled, 1e-9)


def discriminant(damping_ratio):
    """Of the three roots of the rocking phase with one mode that are left beside its growing one."""
    parameters = frame_properties(**frame(damping_ratio=damping_ratio), n_modes=1).kwargs()
    matrix = Exact(**parameters, dt=0.02, substeps=1).generator[True][:4, :4]
    characteristic = np.poly(matrix)
    growing = max(np.roots(characteristic), key=lambda root: root.real).real
    a, b, c, d = np.polydiv(characteristic, [1.0, -growing])[0]
    return 18 * a * b * c * d - 4 * b**3 * d + b**2 * c**2 - 4 * a * c**3 - 27 * a**2 * d**2


def test_where_two_eigenvalues_merge():
    """At one damping ratio an oscillation while rocking becomes critical, and its two eigenvectors one."""
    damping_ratio = brentq(discriminant, 0.1, 0.6, xtol=1e-15, rtol=1e-15)
    given = frame(damping_ratio=damping_ratio)
    assert_dense(*prepared(given, "2DOF-S"))
    for nearby in (damping_ratio * 0.9, damping_ratio * 1.1):
        assert_uncoupled(*prepared(frame(damping_ratio=nearby), "2DOF-S"))
    run = simulate(Frame(**given), MOTION, "2DOF-S", free_vibration=1.0)
    parameters = frame_properties(**given, n_modes=1).kwargs()
    twin = simulate_fine(**parameters, acceleration=MOTION.acceleration, dt=MOTION.dt, free_vibration=1.0)
    assert run.n_impacts > 3
    assert_same_peaks(run, twin, 1e-9)


@pytest.mark.parametrize("offset", [1e-12, 1e-9, 1e-7, 1e-5, 1e-3, -1e-12, -1e-9, -1e-7, -1e-5, -1e-3])
def test_close_to_the_merger(offset):
    """Dense or not, the answer moves by no more than the damping does."""
    damping_ratio = brentq(discriminant, 0.1, 0.6, xtol=1e-15, rtol=1e-15) * (1.0 + offset)
    given = frame(damping_ratio=damping_ratio)
    run = simulate(Frame(**given), MOTION, "2DOF-S", output="peaks")
    parameters = frame_properties(**given, n_modes=1).kwargs()
    assert_same_peaks(run, simulate_fine(**parameters, acceleration=MOTION.acceleration, dt=MOTION.dt), 1e-9)


@pytest.mark.parametrize("n_stories", [2, 3])
def test_a_narrow_base_uncouples(monkeypatch, n_stories):
    """Matrices were tens of thousands of steps a sample here. The last bit of I_θ moves these peaks by 2e-9."""
    given = frame(n_stories=n_stories, stiffness_ratio=0.0, period=1.0, aspect_ratio=1600.0)
    assert_uncoupled(*prepared(given, "MDOF-S", 0.02))
    whole = load_suite("el-centro-1940")[0].scaled(0.01)
    brief = GroundMotion(whole.acceleration[:200], whole.dt)
    uncoupled = simulate(Frame(**given), brief, output="peaks")
    monkeypatch.setattr(basis, "WORST_CONDITION", 0.0)
    assert_dense(*prepared(given, "MDOF-S", 0.02))
    assert uncoupled.n_impacts > 0
    assert_same_peaks(simulate(Frame(**given), brief, output="peaks"), uncoupled, 1e-7)


TABLES = """
import numpy as np
import rockflex as rf
from builders import make_frame
from rockflex.solve.exact import basis

basis.WORST_CONDITION = 0.0
frame = make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)
half_width = frame.rocking().half_width
springs = rf.Springs([-half_width, half_width], 3e8, 1e15)
motion = rf.GroundMotion(3.0 * np.sin(0.07 * np.arange(200)), 0.01)
try:
    rf.simulate(frame, motion, "2DOF-S", ground=rf.Ground(springs=springs, base_inertia=60e3))
except rf.InputError as error:
    print(error)
"""


def test_the_work_limit_counts_the_tables_of_a_phase_that_decays_at_once():
    """A dashpot of 1e15 N s/m: the bounds of the phase at the start alone would take an hour."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])}
    done = subprocess.run(
        [sys.executable, "-c", TABLES], env=environment, capture_output=True, text=True, timeout=60, check=True
    )
    assert "work_limit is 30 s" in done.stdout
