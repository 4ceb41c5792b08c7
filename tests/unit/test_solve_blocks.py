"""Blocks of samples in the exact engine, against naive loops, matrix powers and dense sampling."""

import numpy as np
import pytest
from numba import njit
from scipy.linalg import expm

import rockflex as rf
from rockflex import _vectors
from rockflex._vectors import BLOCK, WIDE
from rockflex.models import Model
from rockflex.response import asked_of
from rockflex.solve import Engine
from rockflex.solve.exact import basis
from rockflex.solve.layout import VALUES

DT = 0.02
FRAMES = {
    "one mode": (1, {"damping_ratio": 0.02}),
    "undamped": (4, {"damping_ratio": 0.0}),
    "overdamped": (3, {"damping_ratio": 0.3}),
    "stiff": (4, {"damping_ratio": 0.02, "period": 0.1}),
}
FRAME = {
    "n_stories": 4,
    "story_height": 3.0,
    "story_mass": 40e3,
    "base_mass": 60e3,
    "stiffness_ratio": 0.125,
    "period": 0.6,
    "aspect_ratio": 9.0,
}
CASES = [(name, False) for name in FRAMES] + [("overdamped", True)]


@njit
def row_in_kernel(values, constant, by_ground, by_slope, course, table, begun, active, kicked):
    _vectors.row_over_block(values, constant, by_ground, by_slope, course, table, begun, active, kicked)


@njit
def outside_in_kernel(values, lower, upper):
    return _vectors.outside(values, lower, upper)


@njit
def pairs_in_kernel(ends, blocks, now, active):
    _vectors.step_pairs(ends, blocks, now, active)


@njit
def norms_in_kernel(norms, w, active):
    _vectors.set_norms(norms, w, active)


@njit
def less_in_kernel(out, one, other, factor):
    _vectors.set_less(out, one, other, factor)


@njit
def products_in_kernel(sums, table, factors, count, parts):
    _vectors.set_products(sums, table, factors, count, parts)


@njit
def more_products_in_kernel(sums, table, factors, count, parts):
    _vectors.add_products(sums, table, factors, count, parts)


@pytest.mark.parametrize(("pairs", "active"), [(1, 0), (2, 1), (2, 2), (6, 5), (16, 16)])
def test_a_row_over_a_block(pairs, active):
    random = np.random.default_rng(pairs + active)
    course, table = random.normal(size=(3, BLOCK)), random.normal(size=(2 * pairs, BLOCK))
    course[2, 0] = 0.0
    begun, kicked = random.normal(size=2 * pairs), np.concatenate((np.zeros(BLOCK), random.normal(size=BLOCK)))
    values, plain = np.zeros(BLOCK), np.zeros(BLOCK)
    row_in_kernel(values, 0.3, 0.4, -0.5, course, table, begun, active, kicked)
    _vectors._plain_row(plain, 0.3, 0.4, -0.5, course, table, begun, active, kicked)
    assert values == pytest.approx(plain, abs=1e-14 * (4 + 2 * pairs + BLOCK))


def test_samples_outside_limits():
    values = np.linspace(-1.0, 1.0, BLOCK)
    values[5] = np.nan
    for lower, upper in ((-0.5, 0.5), (-np.inf, 0.2), (0.0, np.inf), (-2.0, 2.0), (0.5, -0.5), (values[3], values[9])):
        assert outside_in_kernel(values, lower, upper) == _vectors._plain_outside(values, lower, upper)


@pytest.mark.parametrize(("count", "parts"), [(0, 1), (3, 1), (4, 2), (7, 2), (16, 1)])
def test_sums_of_products(count, parts):
    random = np.random.default_rng(1)
    table, factors = random.normal(size=(BLOCK, 3 * WIDE)), random.normal(size=BLOCK)
    sums = random.normal(size=3 * WIDE)
    used = np.arange(BLOCK) % (BLOCK // parts) < count
    expected = factors[used] @ table[used]
    for more, compiled, plain in (
        (sums.copy(), more_products_in_kernel, _vectors._plain_further_sums),
        (0.0, products_in_kernel, _vectors._plain_sums),
    ):
        for way in (compiled, plain):
            found = sums.copy()
            way(found, table, factors, count, parts)
            assert found == pytest.approx(more + expected, abs=1e-13)


@pytest.mark.parametrize(("pairs", "active"), [(1, 1), (2, 1), (3, 3), (5, 4), (6, 6), (16, 15)])
def test_pairs_step_and_keep_what_is_held(pairs, active):
    random = np.random.default_rng(pairs)
    blocks, now = random.normal(size=(4, pairs)), random.normal(size=2 * pairs)
    # A longer array behind them shows whether anything is written beyond their end.
    for way in (pairs_in_kernel, _vectors._plain_pairs):
        ends = np.full(2 * pairs + 8, 7.0)
        way(ends[: 2 * pairs], blocks, now, active)
        for k in range(pairs):
            x, y = now[k], now[pairs + k]
            expected = blocks[0, k] * x + blocks[1, k] * y, blocks[2, k] * x + blocks[3, k] * y
            assert (ends[k], ends[pairs + k]) == (pytest.approx(expected, abs=1e-14) if k < active else (7.0, 7.0))
        assert (ends[2 * pairs :] == 7.0).all()
    for way in (norms_in_kernel, _vectors._plain_norms):
        norms = np.full(pairs + 8, 7.0)
        way(norms[:pairs], now, active)
        assert norms[:active] == pytest.approx(np.hypot(now[:pairs], now[pairs:])[:active], rel=1e-15)
        assert (norms[active:] == 7.0).all()
    for way in (less_in_kernel, _vectors._plain_less):
        less = np.full(2 * pairs + 8, 7.0)
        way(less[: 2 * pairs], now, now[::-1].copy(), 0.3)
        assert less[: 2 * pairs] == pytest.approx(now - 0.3 * now[::-1], abs=1e-15)
        assert (less[2 * pairs :] == 7.0).all()


def prepared(name, dense):
    """Return the engine's tables of contact and of rocking to the right."""
    n, changes = FRAMES[name]
    tied = Model(n).of(rf.Frame(**{**FRAME, **changes}).rocking())
    with pytest.MonkeyPatch.context() as patch:
        if dense:
            patch.setattr(basis, "WORST_CONDITION", 0.0)
        engine = Engine(tied, asked_of(tied))
        engine._phases.place(tied.start(1))
        return engine._phases.system(DT, engine._phases.fastest)


def step_of(system, p):
    """Return exp(B h) as a matrix."""
    if system.phases[p]["dense"]:
        return system.propagator[p, 0]
    pairs = system.blocks.shape[3]
    k = np.arange(pairs)
    step = np.zeros((2 * pairs, 2 * pairs))
    block = system.blocks[p, 0]
    step[k, k], step[k, pairs + k] = block[0], block[1]
    step[pairs + k, k], step[pairs + k, pairs + k] = block[2], block[3]
    return step


def rows_of(system, p):
    return system.rows[p, VALUES, :, : system.stray.shape[1]].T


@pytest.mark.parametrize(("name", "dense"), CASES)
@pytest.mark.parametrize("p", [0, 1])
def test_tables_of_a_block_are_powers_of_a_step(name, dense, p):
    system = prepared(name, dense)
    step, kick = step_of(system, p), -system.forced[p, 1]
    rows = rows_of(system, p)
    assert system.phases[p]["block"] == BLOCK
    assert not system.kicked[p, :, :BLOCK].any()
    power, size = np.eye(step.shape[0]), np.abs(rows).sum(axis=1)
    for m in range(BLOCK):
        power = step @ power
        scale = np.maximum(np.abs(rows) @ np.abs(power).sum(axis=1), size)
        assert np.abs(system.ahead[p, :, :, m] - rows @ power).max() <= 1e-12 * scale.max()
        found = system.kicked[p, :, BLOCK + m]
        assert found == pytest.approx(rows @ power @ kick, abs=1e-12 * scale.max() * np.abs(kick).max())
        if not system.phases[p]["dense"]:
            j = BLOCK - 1 - m
            pushed = system.pushed[p, j, : kick.size]
            assert pushed == pytest.approx(power @ kick, abs=1e-12 * np.abs(kick).max() * np.abs(power).sum())


@pytest.mark.parametrize(("name", "dense"), CASES)
@pytest.mark.parametrize("p", [0, 1])
def test_leeway_bounds_the_deviation_from_chords(name, dense, p):
    """For random motions of every pair, and for a jump of the slope, between all samples of a block."""
    system = prepared(name, dense)
    pairs, parts = system.blocks.shape[3], 20
    roots, vectors = np.linalg.eig(step_of(system, p))
    generator = (vectors @ np.diag(np.log(roots.astype(complex))) @ np.linalg.inv(vectors)).real / parts
    active = pairs if p == 1 else int(system.phases[p]["active"])
    small, rows, random = expm(generator), rows_of(system, p), np.random.default_rng(2)
    for _ in range(20):
        w = np.zeros(2 * pairs)
        w[:active], w[pairs : pairs + active] = random.normal(size=(2, active))
        jump = random.normal() * np.linalg.norm(w) / np.linalg.norm(system.forced[p, 1])
        norms = np.hypot(w[:pairs], w[pairs:])
        slack = norms @ system.leeway[p, :, : rows.shape[0]] + system.stray[p] * abs(jump)
        w = w - system.forced[p, 1] * jump
        path = [w]
        for _ in range(BLOCK * parts):
            path.append(small @ path[-1])
        values = rows @ np.array(path).T
        ends = values[:, ::parts]
        chords = np.array(
            [np.interp(np.arange(BLOCK * parts + 1), np.arange(BLOCK + 1) * parts, each) for each in ends]
        )
        worst = np.abs(values - chords).max(axis=1)
        assert (worst <= slack * (1.0 + 1e-9) + 1e-9 * np.abs(values).max(axis=1)).all()


@pytest.mark.parametrize("seconds", [4.0, 40.0])
def test_many_equal_peaks(seconds):
    """Undamped free vibration on a fixed base: more blocks with the same peak than are kept for later."""
    frame = rf.Frame(**{**FRAME, "n_stories": 1, "damping_ratio": 0.0})
    start = rf.InitialState(modal_velocity=[0.3])
    run = rf.simulate(frame, rf.quiet_motion(seconds, dt=0.011), "fixed", initial=start, output="peaks")
    omega, top = float(frame.rocking().omega[0]), float(frame.rocking().top_ordinate[0])
    assert run.max_top_displacement == pytest.approx(0.3 / omega * abs(top), rel=1e-12)


def test_a_steep_fall_shortens_the_blocks():
    """A tiny block whose rotation grows e-fold within a long step, against the same record in short steps."""
    block, dt = rf.rigid_block(slenderness=0.2, half_diagonal=1e-3), 0.02
    times = dt * np.arange(40)
    coarse = rf.GroundMotion(0.1 * 9.81 * np.sin(40.0 * times) + 9.81 * 0.2 * (times > 0.1) * (times < 0.2), dt)
    fine_times = dt / 8 * np.arange(39 * 8 + 1)
    fine = rf.GroundMotion(np.interp(fine_times, times, coarse.acceleration), dt / 8)
    one, other = (rf.simulate(block, motion, "rigid", output="peaks") for motion in (coarse, fine))
    assert one.n_impacts == other.n_impacts
    assert one.max_rotation == pytest.approx(other.max_rotation, rel=1e-9)
