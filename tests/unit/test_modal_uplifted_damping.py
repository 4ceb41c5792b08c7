"""Damping while uplifted: closed forms, the state matrix in forty digits, free vibration, overdamped modes."""

import math
import time
from dataclasses import replace

import mpmath
import numpy as np
import pytest

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._inputs import TOWER, table_1_frame
from rockflex.structure import _uplifted
from rockflex.structure._uplifted import uplifted_damping_ratios


def roots_of(p):
    """Eigenvalues of Eq. 23 as it stands, rows of D_n not scaled, in forty digits."""
    n = p.n_modes
    with mpmath.workdps(40):
        mass, damping, stiffness = mpmath.eye(n + 1), mpmath.zeros(n + 1), mpmath.zeros(n + 1)
        mass[0, 0], stiffness[0, 0] = mpmath.mpf(p.i_theta), mpmath.mpf(p.rocking_stiffness)
        for k in range(n):
            w, h, m, zeta = (mpmath.mpf(float(x[k])) for x in (p.omega, p.effective_height, p.effective_mass, p.zeta))
            mass[0, k + 1], mass[k + 1, 0] = m * h, h
            damping[k + 1, k + 1], stiffness[k + 1, k + 1] = 2 * zeta * w, w**2
        state = mpmath.zeros(2 * n + 2)
        inverse = mass**-1
        low, drag = inverse * stiffness, inverse * damping
        for i in range(n + 1):
            state[i, n + 1 + i] = 1
            for j in range(n + 1):
                state[n + 1 + i, j], state[n + 1 + i, n + 1 + j] = -low[i, j], -drag[i, j]
        return [complex(root) for root in mpmath.eig(state, left=False, right=False)]


def expected(p):
    turning = sorted((root for root in roots_of(p) if root.imag > 1e-9 * abs(root)), key=abs)
    return np.array([-root.real / abs(root) for root in turning]), np.abs(turning)


# The eigenvalues are right to the rounding of the largest; 1e3 of it leaves room for their condition.
ROUNDING = 1e3 * np.finfo(float).eps


@pytest.mark.parametrize("name", ["#1", "#2", "#6"])
@pytest.mark.parametrize("n_modes", [1, 2, 5])
def test_against_the_state_matrix_in_forty_digits(name, n_modes):
    p = table_1_frame(name).rocking(n_modes)
    found = rf.uplifted_modes(p).damping_ratio
    ratios, sizes = expected(p)
    assert found.shape == (n_modes,)
    np.testing.assert_array_less(np.abs(found - ratios), ROUNDING * sizes[-1] / sizes)


def test_a_damping_ratio_of_each_mode():
    p = replace(TOWER.rocking(), zeta=[0.01, 0.02, 0.05, 0.08, 0.3])
    ratios, sizes = expected(p)
    np.testing.assert_array_less(np.abs(rf.uplifted_modes(p).damping_ratio - ratios), ROUNDING * sizes[-1] / sizes)


@pytest.mark.parametrize(("name", "found", "rule"), [("#1", 12.5, 12.2), ("#2", 9.5, 9.3), ("#6", 6.7, 6.6)])
def test_two_per_cent_become_several_times_as_much_with_one_mode(name, found, rule):
    p = table_1_frame(name).rocking(1)
    modes = rf.uplifted_modes(p)
    assert round(100.0 * modes.damping_ratio[0], 1) == found
    assert round(2.0 * modes.ratio[0], 1) == rule
    # ζ ω*/ω leaves out the weight, which slows the vibration by a share of the size (growth rate/ω_1)².
    share = (modes.growth_rate / p.omega[0]) ** 2
    assert modes.damping_ratio[0] == pytest.approx(0.02 * modes.ratio[0], rel=1.5 * share)


@pytest.mark.parametrize("zeta", [1e-3, 0.02, 0.15])
def test_one_mode_without_weight_in_closed_form(zeta):
    p = table_1_frame("#1").rocking(1)
    weightless = replace(p, l0r=1e-12 * p.l0r, zeta=zeta)
    modes = rf.uplifted_modes(weightless)
    assert modes.damping_ratio[0] == pytest.approx(zeta * modes.ratio[0], rel=1e-10)


def test_without_damping_there_is_none():
    found = rf.uplifted_modes(replace(table_1_frame("#1").rocking(), zeta=0.0)).damping_ratio
    np.testing.assert_allclose(found, 0.0, atol=ROUNDING)


def test_an_overdamped_mode_has_two_real_roots():
    """ζ ω*/ω = 1.2 with one mode: the motion creeps back, and sum and product of its roots give ζ*."""
    p = replace(table_1_frame("#1").rocking(1), zeta=0.2)
    roots = np.array(roots_of(p))
    assert np.abs(roots.imag).max() < 1e-12
    falling = np.sort(roots.real)[:2]  # the two fastest to decay; the others are the rotation's
    modes = rf.uplifted_modes(p)
    assert modes.damping_ratio[0] == pytest.approx(-falling.sum() / (2.0 * math.sqrt(falling.prod())), rel=1e-11)
    assert modes.damping_ratio[0] > 1.0


def test_overdamped_beside_modes_that_vibrate():
    """Two real roots beside the rotation's belong to one mode: the last, which the base's own inertia makes stiff."""
    p = replace(table_1_frame("#1").rocking(), zeta=0.5)
    found = rf.uplifted_modes(p).damping_ratio
    roots = np.array(roots_of(p))
    still = np.sort(roots.real[np.abs(roots.imag) < 1e-12 * np.abs(roots)])
    assert still.size == 4
    fast, slow = still[:2]
    assert found[-1] == pytest.approx(-(fast + slow) / (2.0 * math.sqrt(fast * slow)), rel=1e-10)
    ratios, _ = expected(p)
    np.testing.assert_allclose(found[:-1], ratios, rtol=1e-10)


def test_pairs_of_several_overdamped_modes():
    """Uncoupled oscillators: of four real roots the slowest and the fastest are one pair, the other two the other."""
    squares, zeta = np.array([-1.0, 100.0, 110.0]), np.array([0.0, 3.0, 1.5])
    found = uplifted_damping_ratios(squares, np.diag(2.0 * zeta * np.sqrt(np.abs(squares))))
    np.testing.assert_allclose(found, zeta[1:], rtol=1e-12)


def test_tendons_that_hold_the_rotation():
    """Its sway is a vibration too, with the lowest frequency; it is left out."""
    held = rf.Restrained(table_1_frame("#1"), rf.Tendon(1e6, 2e9)).rocking()
    assert held.rocking_stiffness > 0.0
    ratios, sizes = expected(held)
    found = rf.uplifted_modes(held).damping_ratio
    assert ratios.size == found.size + 1
    np.testing.assert_array_less(np.abs(found - ratios[1:]), ROUNDING * sizes[-1] / sizes[1:])


def test_free_vibration_decays_at_that_rate():
    """Of a nearly weightless structure with one mode that rocks freely, D falls by exp(-2π ζ*/√(1 - ζ*²)) a period."""
    p = table_1_frame("#1").rocking(1)
    p = replace(p, l0r=1e-3 * p.l0r)
    modes = rf.uplifted_modes(p)
    zeta, omega = modes.damping_ratio[0], modes.omega[0]
    period = 2.0 * math.pi / (omega * math.sqrt(1.0 - zeta**2))
    response = rf.simulate(
        p,
        rf.quiet_motion(2.0 * period, dt=period / 64.0),
        model="2DOF-S",
        initial=rf.InitialState(rotation=0.3, modal_displacement=[0.01], rotation_velocity=1.0),
    )
    assert response.status == "rocking"
    assert response.n_impacts == 0
    steps = np.diff(response.modal_displacement[:, 0], n=2)  # free of the slow drift about which D swings
    decay = math.exp(-2.0 * math.pi * zeta / math.sqrt(1.0 - zeta**2))
    assert steps[64] / steps[0] == pytest.approx(decay, rel=1e-3)


MANY = rf.Frame(
    n_stories=60, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=np.inf, period=4.0,
    aspect_ratio=8.0, damping_ratio=0.02,
)  # fmt: skip


def many_modes(case):
    p = MANY.rocking()
    if case == "clustered":  # pairs of modes whose frequencies differ by a millionth, and two that are equal
        omega = p.omega.copy()
        omega[1::2] = omega[::2] * (1.0 + 1e-6)
        omega[21] = omega[20]
        return replace(p, omega=omega, zeta=np.full(60, 0.02))
    if case == "held":  # the rotation vibrates
        return rf.Restrained(MANY, rf.Tendon(1e6, 1e10)).rocking()
    zeta = {"light": 0.02, "heavy": 0.2, "overdamped": 0.5, "undamped": 0.0}.get(case, 0.02)
    return replace(p, zeta=np.linspace(0.5, 1.0, 60) * zeta)


@pytest.mark.parametrize("case", ["light", "heavy", "clustered", "held", "undamped"])
def test_many_modes_have_the_damping_of_the_dense_matrix(case, monkeypatch):
    p = many_modes(case)
    found = rf.uplifted_modes(p)
    monkeypatch.setattr(_uplifted, "_tracked_damping_ratios", lambda *_: None)
    dense = rf.uplifted_modes(p).damping_ratio
    assert not np.array_equal(found.damping_ratio, dense) or case == "undamped"
    np.testing.assert_array_less(
        np.abs(found.damping_ratio - dense), ROUNDING * max(p.omega[-1], found.omega[-1]) / found.omega
    )


def test_many_modes_of_which_some_are_overdamped(monkeypatch):
    p = many_modes("overdamped")
    found = rf.uplifted_modes(p).damping_ratio
    assert found.shape == (60,)
    assert (found > 1.0).any()
    monkeypatch.setattr(_uplifted, "_tracked_damping_ratios", lambda *_: None)
    np.testing.assert_array_equal(rf.uplifted_modes(p).damping_ratio, found)


@pytest.mark.slow
def test_a_thousand_stories_take_seconds():
    p = rf.Frame(
        n_stories=1000, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=np.inf, period=20.0,
        aspect_ratio=8.0, damping_ratio=0.02,
    ).rocking()  # fmt: skip
    begin = time.process_time()
    found = rf.uplifted_modes(p)
    assert time.process_time() - begin < 10.0  # all eigenvalues of 2002 equations took 30 s, the shapes more
    assert (np.diff(found.omega) > 0.0).all()
    assert (found.omega > p.omega * (1.0 - 1e-9)).all()
    assert (found.omega[:-1] < p.omega[1:] * (1.0 + 1e-9)).all()
    first = found.omega[:100]
    moment = rf.frequency_equation(p, np.array([first * (1.0 - 1e-9), first * (1.0 + 1e-9)]))
    assert (moment[0] * moment[1] < 0.0).all()
