"""Required friction: closed forms, the two forms of Eq. 22, impacts left out, and what is said of bad input."""

import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

GRAVITY = 9.81
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
FRAME = make_frame()
MASS, HEIGHTS = 40e3, 3.0 * np.arange(1, 6)
TOTAL, ARM = 6 * MASS, MASS * HEIGHTS.sum()


def half_width(structure=FRAME):
    return structure.rocking().half_width


def test_a_rigid_block_in_contact_needs_the_ground_acceleration_over_g():
    """|Σ m a| / (m_tot g), up to the uplift at a = m_tot g B / L_0^r."""
    threshold = GRAVITY * TOTAL * half_width() / ARM
    motion = rf.half_sine_pulse(0.9 * threshold, 1.0)
    for model in ("rigid", "rigid-C"):
        run = rf.simulate(FRAME, motion, model)
        assert run.status == "no_uplift"
        np.testing.assert_allclose(run.friction_demand, np.abs(motion.acceleration) / GRAVITY, rtol=1e-13)
        np.testing.assert_allclose(run.vertical_reaction, TOTAL * GRAVITY, rtol=1e-13)
        np.testing.assert_allclose(run.horizontal_reaction, TOTAL * motion.acceleration, rtol=1e-13)
        assert run.required_friction == pytest.approx(0.9 * threshold / GRAVITY, rel=1e-9)
        assert run.required_friction_excluding_impacts() == run.required_friction


@pytest.mark.parametrize("model", ["rigid", "rigid-C"])
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_rigid_block_at_uplift(model, direction):
    """I_θ s θ'' = |a| L - m_tot g B in the first instant, about the pivot s = -sign(a)."""
    p, width = FRAME.rocking(), half_width()
    a = 1.3 * GRAVITY * TOTAL * width / ARM
    run = rf.simulate(FRAME, rf.rectangular_pulse(direction * a, 0.5), model)
    turn = (a * ARM - TOTAL * GRAVITY * width) / p.i_theta
    push, support = TOTAL * a - ARM * turn, TOTAL * (GRAVITY + width * turn)
    first = int(np.flatnonzero(run.side)[0])
    assert run.time[first] == 0.0
    assert run.horizontal_reaction[first] == pytest.approx(direction * push, rel=1e-12)
    assert run.vertical_reaction[first] == pytest.approx(support, rel=1e-12)
    assert run.friction_demand[first] == pytest.approx(push / support, rel=1e-12)


def test_a_rigid_block_let_go_at_an_angle():
    """At rest at θ_0: I_θ θ'' = m_tot g (L/m_tot sin θ - B cos θ), and the mass centre is all there is."""
    p, width, theta = FRAME.rocking(), half_width(), 0.05
    run = rf.simulate(FRAME, rf.quiet_motion(0.1), "rigid-C", initial=rf.InitialState(rotation=theta))
    turn = GRAVITY * (ARM * math.sin(theta) - TOTAL * width * math.cos(theta)) / p.i_theta
    radius, slope = math.hypot(ARM / TOTAL, width), math.atan2(width, ARM / TOTAL) - theta
    # The mass centre lies at `radius` from the pivot, `slope` from the vertical, and moves at right angles to that.
    push = TOTAL * turn * radius * math.cos(slope)
    support = TOTAL * (GRAVITY + turn * radius * math.sin(slope))
    assert run.horizontal_reaction[0] == pytest.approx(push, rel=1e-12)
    assert run.vertical_reaction[0] == pytest.approx(support, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("model", ["2DOF-S", "2DOF-C", "MDOF-S", "1DOF-fixed", "fixed"])
def test_a_slow_push_needs_its_acceleration_over_g(model):
    """Static limit: the masses follow the ground, so Σ m (a + u'') is m_tot a."""
    motion = rf.half_sine_pulse(0.4, 400.0, dt=0.1)
    run = rf.simulate(FRAME, motion, model)
    assert run.status == "no_uplift"
    late = run.time > 200.0  # once what the start left has died away
    expected = np.abs(run.ground_acceleration) / GRAVITY
    np.testing.assert_allclose(run.friction_demand[late], expected[late], atol=2e-6)
    assert run.required_friction == pytest.approx(0.4 / GRAVITY, rel=1e-3)


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-C", "rigid-C"])
def test_a_mirrored_record_needs_the_same(model):
    run, mirrored = (rf.simulate(FRAME, EL_CENTRO.scaled(s), model) for s in (1.3, -1.3))
    assert run.n_impacts > 5
    assert mirrored.required_friction == pytest.approx(run.required_friction, rel=1e-8)
    assert mirrored.required_friction_excluding_impacts() == pytest.approx(
        run.required_friction_excluding_impacts(), rel=1e-8
    )
    first, second = run.sliding_time(0.15), mirrored.sliding_time(0.15)
    assert first is not None
    assert second == pytest.approx(first, abs=1e-9)
    before = run.time < run.impact_times[2]
    np.testing.assert_allclose(
        mirrored.horizontal_reaction[before], -run.horizontal_reaction[before], rtol=1e-6, atol=1.0
    )
    np.testing.assert_allclose(mirrored.vertical_reaction[before], run.vertical_reaction[before], rtol=1e-6)


@pytest.mark.parametrize("model", ["2DOF-S", "2DOF-C"])
def test_equation_22_as_printed(model):
    """Summed mass by mass, with -g; and by its magnitude, as Eq. 20 has it."""
    structure = rf.LumpedStructure(
        [30e3, 20e3], [[9e6, -5e6], [-5e6, 5e6]], [3.0, 6.0], base_mass=25e3, half_width=0.6, damping_ratio=0.03
    )
    run = rf.simulate(structure, EL_CENTRO.scaled(1.5), model)
    p = run.history.model.properties
    s, theta, spin, turn = run.side, run.rotation, run.rotation_velocity, run.rotation_acceleration
    inside = run.time < run.end_time
    u, v, w = (
        x @ p.floors.displacement.T for x in (run.modal_displacement, run.modal_velocity, run.modal_acceleration)
    )
    forces = np.zeros((2, run.time.size))
    for m, h, i in ((25e3, 0.0, None), (30e3, 3.0, 0), (20e3, 6.0, 1)):
        ui, vi, wi = (np.zeros(run.time.size) if i is None else x[:, i] for x in (u, v, w))
        sin, cos, b = np.sin(theta), np.cos(theta), s * p.half_width
        forces[0] += m * (
            run.ground_acceleration + turn * (b * sin + h * cos - ui * sin) + wi * cos
            + spin**2 * (b * cos - h * sin - ui * cos) - 2 * spin * vi * sin
        )  # fmt: skip
        forces[1] += m * (
            -GRAVITY + turn * (b * cos - h * sin - ui * cos) - wi * sin
            + spin**2 * (-b * sin - h * cos + ui * sin) - 2 * spin * vi * cos
        )  # fmt: skip
    # Where contact takes no time, the accelerations at both its ends are those of the rocking that follows.
    lasting = inside & ~((s == 0.0) & (turn != 0.0))
    largest = float(np.max(np.abs(forces[0] / forces[1])[lasting]))
    printed = run.required_friction_excluding_impacts(window=0.0, printed=True)
    assert 1.0 <= printed / largest < 1.03  # between the nodes it may be more
    mended = run.required_friction_excluding_impacts(window=0.0)
    assert mended == run.required_friction
    assert abs(printed / mended - 1.0) > 0.05
    moment = run.sliding_time(0.9 * printed, printed=True)
    assert moment is not None
    assert run.sliding_time(1.001 * printed, printed=True) is None
    small = p.m_tot * (GRAVITY + s * p.half_width * turn)  # a simplified model's own, for small rotations
    upward = small if model == "2DOF-S" else forces[1] + 2.0 * p.m_tot * GRAVITY
    np.testing.assert_allclose(run.vertical_reaction[lasting], upward[lasting], rtol=1e-9, atol=1e-6 * p.m_tot)


def test_infinite_where_the_base_would_lose_contact():
    """Bouncing from side to side, a flexible structure on a light base would jump."""
    run = rf.simulate(FRAME, EL_CENTRO, "2DOF-C", impact=rf.Restitution(0.9))
    assert run.vertical_reaction.min() < 0.0
    assert np.array_equal(np.isinf(run.friction_demand), run.vertical_reaction <= 0.0)
    assert run.required_friction == math.inf
    assert run.sliding_time(1e6) == pytest.approx(run.time[run.vertical_reaction <= 0.0][0], abs=EL_CENTRO.dt)


def test_nothing_moves_nothing_is_needed():
    run = rf.simulate(FRAME, rf.quiet_motion(1.0), "MDOF-S")
    assert run.required_friction == 0.0
    assert run.required_friction_excluding_impacts(window=2.0) == 0.0
    assert run.sliding_time(1e-9) is None


def test_a_window_as_long_as_the_run_leaves_what_is_before_the_first_impact():
    run = rf.simulate(FRAME, EL_CENTRO, "2DOF-S")
    before = run.time <= run.impact_times[0]
    reached = run.required_friction_excluding_impacts(window=1e3)
    assert reached >= run.friction_demand[before][:-1].max()
    assert reached <= run.required_friction
    falling = rf.simulate(FRAME, rf.quiet_motion(5.0), "2DOF-S", initial=rf.InitialState(rotation=0.01))
    assert falling.required_friction_excluding_impacts(window=1e3) <= falling.required_friction


def test_one_node_alone():
    run = rf.simulate(FRAME, EL_CENTRO, "2DOF-S")
    moment = int(np.argmax(run.friction_demand))
    history = type(run.history)(run.history.model, run.history.states[moment : moment + 1])
    assert history.required_friction == pytest.approx(run.friction_demand[moment], rel=1e-12)
    assert history.sliding_time(0.1) == run.time[moment]
    assert history.sliding_time(10.0) is None


@pytest.mark.parametrize(
    ("ask", "text"),
    [
        (lambda run: run.required_friction_excluding_impacts(window=-0.1), r"window must be a zero or positive"),
        (lambda run: run.required_friction_excluding_impacts(math.nan), "window must be a zero or positive.*but nan"),
        (lambda run: run.sliding_time(0.0), r"mu must be a friction coefficient above zero, such as 0\.5, but 0\.0"),
        (lambda run: run.sliding_time(math.inf), "mu must be a friction coefficient above zero.*but inf was given"),
        (lambda run: run.sliding_time("much"), "mu must be a friction coefficient above zero.*but 'much' was given"),
    ],
)
def test_bad_input(ask, text):
    run = rf.simulate(FRAME, rf.quiet_motion(0.1), "2DOF-S")
    with pytest.raises(rf.InputError, match=text):
        ask(run)


def test_a_model_too_fast_for_its_sampling():
    p = rf.RockingProperties([1e6], [1e4], [5.0], [1.0], 4e5, 6e4, 1.2e4, 0.8, 0.02)
    run = rf.simulate(p, rf.GroundMotion([0.0, 1.0, 0.0], 0.01), "2DOF-S")
    text = r"The friction demand of 2DOF-S needs \d+ points per step, above the limit of 2000:"
    with pytest.raises(rf.InputError, match=text):
        _ = run.required_friction
    assert np.isfinite(run.friction_demand).all()


@pytest.mark.parametrize(
    "name",
    [
        "horizontal_reaction", "vertical_reaction", "friction_demand", "required_friction",
        "required_friction_excluding_impacts", "sliding_time",
    ],
)  # fmt: skip
def test_peaks_alone_know_no_friction(name):
    run = rf.simulate(FRAME, EL_CENTRO, "2DOF-S", output="peaks")
    assert not hasattr(run, name)
    with pytest.raises(
        rf.InputError, match=f'contains only peaks, so it has no {name}. Simulate with output="history"'
    ):
        getattr(run, name)
