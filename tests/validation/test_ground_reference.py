"""Bases on springs, bases that slide, and vertical shaking against the numbers of a high-precision reference.

The reference integrates the equations with two step sizes; each case has the relative difference of both.
"""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

STRUCTURES = {
    "#1": make_frame(),
    "#2": make_frame(stiffness_ratio=0.0),
    "#4": make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0),
    "stiff": make_frame(period=0.5, aspect_ratio=5.0),
}
SUITES = {"FF": "fema-p695-far-field", "NFNP": "fema-p695-near-field-no-pulse", "NFP": "fema-p695-near-field-pulse"}

# Structure, model, record, scale; k, c, I_b, number of springs; θ_max, u_top, M_b, edge uplift, error of the reference.
SPRINGS = {
    "pulse": ("#1", "2DOF-S", "NFP-9-b", 1.0, 545e6, 4.71e6, 14800.0, 2,
              (0.05716074444934251, 0.06473940423656513, 3785727.2635887447, 0.11648038967477024), 1.9e-7),
    "stays down": ("#2", "3DOF-S", "NFNP-18-b", 0.5, 153e6, 4.81e6, 18900.0, 2,
                   (0.0044788844489950025, 0.04544430749270024, 1992126.998499946, 0.0), 1.1e-10),
    "strong": ("#4", "3DOF-S", "NFP-9-a", 1.5, 158e6, 5.99e6, 57200.0, 2,
               (0.1391931012454836, 0.04863206236928524, 6723274.265079566, 0.31935311108866565), 7.1e-6),
    "bed": ("#2", "2DOF-S", "NFNP-19-b", 1.0, 220e6, 3.04e6, 18900.0, 7,
            (0.00844812526495881, 0.05080106326357686, 2341391.757971619, 0.013276917271664683), 3.0e-8),
    "bed, all modes": ("#2", "MDOF-S", "FF-17-b", 0.5, 94e6, 1.82e6, 18900.0, 7,
                       (0.00374667577194002, 0.03327917402207614, 1369821.6229703864, 0.0010510537002958184), 5.2e-8),
}  # fmt: skip
# Structure, model, record, scale, friction; θ_max, u_top, largest and last slip, uplifts; error of the reference.
SLIDING = {
    "#1": ("#1", "2DOF-S", "FF-1-b", 1.5, 0.134,
           (0.0347376766626081, 0.06707296809396139, 0.09491565835660118, 0.09053303028782164, 33), 3.1e-8),
    "#2": ("#2", "2DOF-S", "NFNP-15-a", 1.5, 0.0944,
           (0.01598411990450114, 0.08653523045043111, 0.26394394428596757, 0.16495194241098401, 7), 1.6e-8),
    "all modes": ("stiff", "MDOF-S", "NFP-7-a", 0.5, 0.379,
                  (0.00864454824195041, 0.03279363183036761, 0.005465298799990192, -0.005465298799990192, 32), 3.7e-9),
}  # fmt: skip
# The vertical record is another component, cut or padded to the length of the horizontal one.
ON_SPRINGS_SHAKEN_UP = (0.0018332064555600651, 0.042125853168573237, 2080630.003953784)
SHAKEN_UP = (0.028029863473751627, 0.046701973965104726, 10923853.1424885, 11)


def record(name, scale):
    return rf.load_suite(SUITES[name.split("-")[0]])[name].scaled(scale)


def upwards(motion, size):
    a = np.zeros(size)
    a[: motion.acceleration.size] = motion.acceleration[:size]
    return a


def positions(p, count):
    return np.linspace(-p.half_width, p.half_width, count)


@pytest.mark.parametrize("name", SPRINGS)
def test_springs(name):
    structure, model, motion, scale, k, c, inertia, count, expected, error = SPRINGS[name]
    springs = rf.Springs(positions(STRUCTURES[structure].rocking(), count), k, c)
    ground = rf.Ground(springs=springs, base_inertia=inertia)
    run = rf.simulate(STRUCTURES[structure], record(motion, scale), model, ground=ground, output="peaks")
    found = (run.max_rotation, run.max_top_displacement, run.max_base_moment, run.max_edge_uplift)
    assert found == pytest.approx(expected, rel=max(1e-8, 3.0 * error))


def test_springs_shaken_vertically():
    motion = record("NFNP-18-b", 0.5)
    up = upwards(record("NFNP-15-a", 0.3), motion.acceleration.size)
    both = rf.GroundMotion(motion.acceleration, motion.dt, vertical=up)
    springs = rf.Springs(positions(STRUCTURES["#2"].rocking(), 2), 4e8, 4e6)
    ground = rf.Ground(springs=springs, base_inertia=18900.0)
    run = rf.simulate(STRUCTURES["#2"], both, "3DOF-S", ground=ground, output="peaks")
    found = (run.max_rotation, run.max_top_displacement, run.max_base_moment)
    assert found == pytest.approx(ON_SPRINGS_SHAKEN_UP, rel=1e-9)


@pytest.mark.parametrize("name", SLIDING)
def test_sliding(name):
    structure, model, motion, scale, friction, expected, error = SLIDING[name]
    ground = rf.Ground(friction=friction)
    run = rf.simulate(STRUCTURES[structure], record(motion, scale), model, ground=ground, output="peaks")
    found = (run.max_rotation, run.max_top_displacement, run.max_slip, run.residual_slip, run.n_uplifts)
    assert found == pytest.approx(expected, rel=max(1e-8, 3.0 * error))


def test_vertical_shaking_of_rigid_ground():
    motion = record("NFP-10-a", 1.0)
    up = upwards(record("NFP-10-b", 0.6), motion.acceleration.size)
    both = rf.GroundMotion(motion.acceleration, motion.dt, vertical=up)
    run = rf.simulate(STRUCTURES["stiff"], both, "MDOF-S", output="peaks")
    found = (run.max_rotation, run.max_top_displacement, run.max_base_moment, run.n_uplifts)
    assert found == pytest.approx(SHAKEN_UP, rel=1.6e-7)
