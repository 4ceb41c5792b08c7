"""Bases on unilateral spring-dashpots: the exact engine against power series between events, and random cases."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame, random_shaking
from twins.ground_springs import LEFT_EDGE, LOADED, RECEDING, RIGHT_EDGE, SLIDE, SLIP, TURN, SpringTwin

FRAME = make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)
SLENDER = make_frame(n_stories=4, stiffness_ratio=0.125, period=0.9, aspect_ratio=9.0)
BLOCK = rf.rigid_block(slenderness=0.25, half_diagonal=4.0, mass=1e5)
B = FRAME.rocking().half_width
DT = 0.01


def shaking(seed, strength, seconds=6.0):
    return random_shaking(seed, strength, seconds, DT)


def compared(structure, model, ground, a, vertical=None, rel=2e-8, free=0.0):
    """The run, and the twin's, after a look whether both are the same."""
    p = structure if isinstance(structure, rf.RockingProperties) else structure.rocking()
    if model not in ("rigid", "MDOF-S"):
        p = structure.rocking(int(model[0]) - 1)
    springs = ground.springs
    twin = SpringTwin.of(
        p, springs.positions, springs.stiffness, springs.damping, ground.base_inertia, friction=ground.friction
    )
    expected = twin.run(a, DT, vertical, free)
    motion = rf.GroundMotion(a, DT, vertical=vertical)
    run = rf.simulate(structure, motion, model, ground=ground, free_vibration=free)
    found = (run.max_rotation, run.max_top_displacement, run.max_base_moment, run.max_base_shear)
    assert found == pytest.approx(expected.peaks[:4], rel=rel, abs=1e-13)
    edge = max(0.0, expected.highs[RIGHT_EDGE], expected.highs[LEFT_EDGE])
    assert run.max_edge_uplift == pytest.approx(edge, rel=rel, abs=1e-13)
    if ground.friction is not None:
        assert run.max_slip == pytest.approx(expected.peaks[SLIDE], rel=rel, abs=1e-13)
        assert run.residual_slip == pytest.approx(expected.y[SLIP], rel=rel, abs=rel * run.max_slip)
    assert run.rotation[-1] == pytest.approx(expected.y[TURN], abs=10.0 * rel * run.max_rotation)
    parts = twin.energies(expected, twin.stored(twin.standing()[1]))
    size = max(abs(parts["input"]), parts["modes"], parts["springs"])
    assert abs(parts["error"]) < 1e-10 * size
    assert run.energy.closing_error < 1e-10
    assert run.energy.input[-1] == pytest.approx(parts["input"], abs=100.0 * rel * size)
    assert run.energy.damped[-1] == pytest.approx(parts["modes"], abs=100.0 * rel * size)
    return run, expected


def states(track):
    """Numbers of loaded springs that a run came through, and the states of single ones."""
    keys = [key[0] for _, before, _, after in track.events for key in (before, after)]
    return {sum(each == LOADED for each in key) for key in keys}, {each for key in keys for each in key}


def two(stiffness, damping, arm=B, inertia=6e4, **more):
    return rf.Ground(springs=rf.Springs([-arm, arm], stiffness, damping), base_inertia=inertia, **more)


@pytest.mark.slow
@pytest.mark.parametrize("model", ["2DOF-S", "3DOF-S", "MDOF-S"])
@pytest.mark.parametrize(("stiffness", "damping"), [(2e8, 5e6), (6e7, 0.0), (9e8, 2e6)])
def test_two_springs(model, stiffness, damping):
    _, twin = compared(FRAME, model, two(stiffness, damping), shaking(1, 9.0))
    assert states(twin)[0] >= {1, 2}


def test_a_base_that_flies():
    """A strong shaking from below throws the base off its springs again and again."""
    _, twin = compared(FRAME, "2DOF-S", two(3e8, 2e6), shaking(2, 8.0), 4.0 * shaking(3, 9.0))
    counts, single = states(twin)
    assert counts == {0, 1, 2}
    assert RECEDING in single


def test_a_rigid_block():
    half = BLOCK.half_width
    inertia = BLOCK.m_tot * half**2 / 3.0
    _, twin = compared(BLOCK, "rigid", two(2e8, 3e6, half, inertia), shaking(4, 12.0))
    assert states(twin)[0] >= {1, 2}


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
def test_a_bed_of_springs(model):
    """Springs of different stiffness, some of them without a dashpot."""
    chance = np.random.default_rng(5)
    stiffness = 5e7 * chance.uniform(0.5, 2.0, 7)
    damping = 1e6 * chance.uniform(0.0, 2.0, 7) * (np.arange(7) % 3 > 0)
    springs = rf.Springs(np.linspace(-B, B, 7), stiffness, damping)
    _, twin = compared(FRAME, model, rf.Ground(springs=springs, base_inertia=6e4), shaking(6, 8.0))
    assert len(states(twin)[0]) > 4


@pytest.mark.parametrize("eccentricity", [0.2 * B, -0.35 * B])
def test_an_eccentric_base(eccentricity):
    """The base tilts under its weight before it is shaken, and its springs differ."""
    springs = rf.Springs([-B - eccentricity, 0.1 * B, B - eccentricity], [2e8, 4e8, 1e8], 2e6)
    ground = rf.Ground(springs=springs, base_inertia=6e4)
    run, twin = compared(rf.Eccentric(FRAME, eccentricity), "2DOF-S", ground, shaking(7, 8.0))
    assert run.rotation[0] != 0.0
    assert len(states(twin)[0]) > 2


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
def test_springs_with_friction(model):
    run, twin = compared(FRAME, model, two(3e8, 4e6, friction=0.15), shaking(8, 9.0), free=1.0)
    assert {key[1] for _, key, *_ in twin.events} == {-1, 0, 1}
    assert run.max_slip > 1e-3


def test_springs_of_different_friction():
    """Grip moves with the force from one spring to the other, and is nothing in flight."""
    ground = two(3e8, 2e6, friction=[0.1, 0.3])
    _, twin = compared(FRAME, "2DOF-S", ground, shaking(9, 8.0), 3.0 * shaking(10, 9.0))
    assert states(twin)[0] == {0, 1, 2}


@pytest.mark.parametrize("friction", [None, 0.2])
def test_vertical_shaking(friction):
    ground = two(2e8, 5e6, friction=friction)
    compared(FRAME, "MDOF-S", ground, shaking(11, 4.0), shaking(12, 5.0))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_random_bases(seed):
    """Any structure, number of springs, settlement of 1 to 20 mm and damping ratio up to 0.7."""
    chance = np.random.default_rng(100 + seed)
    structure = (FRAME, SLENDER)[seed % 2]
    p = structure.rocking()
    count = int(chance.integers(2, 6))
    positions = np.linspace(-p.half_width, p.half_width, count) * chance.uniform(0.8, 1.0)
    stiffness = p.m_tot * 9.81 / chance.uniform(1e-3, 2e-2) / count * chance.uniform(0.7, 1.3, count)
    ratio = chance.uniform(0.0, 0.7)
    damping = 2.0 * ratio * np.sqrt(p.m_tot / stiffness.sum()) * stiffness
    friction = None if seed % 3 == 0 else chance.uniform(0.1, 0.5)
    springs = rf.Springs(positions, stiffness, damping)
    ground = rf.Ground(friction=friction, springs=springs, base_inertia=p.m_tot * p.half_width**2 / 5.0)
    vertical = None if seed % 4 < 2 else shaking(300 + seed, 6.0, 4.0)
    a = shaking(200 + seed, chance.uniform(3.0, 9.0), 4.0)
    compared(structure, ("2DOF-S", "3DOF-S")[seed // 2 % 2], ground, a, vertical, rel=1e-7)
