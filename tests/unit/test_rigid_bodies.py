"""Rigid bodies by the sizes that people know: blocks, and what holds them."""

import inspect
import math

import numpy as np
import pytest

import rockflex as rf


def test_a_block_has_the_properties_of_its_sides() -> None:
    block = rf.rigid_block(width=0.6, height=2.0, mass=250.0)
    assert (block.half_width, block.top_height, block.m_tot) == (0.3, 2.0, 250.0)
    assert block.l0r == pytest.approx(250.0, rel=1e-15)
    assert block.i_theta == pytest.approx(250.0 * (0.6**2 + 2.0**2) / 3.0, rel=1e-15)  # of a rectangle about a corner
    alike = rf.rigid_block(math.atan(0.3), math.hypot(0.3, 1.0), 250.0)
    for name in ("i_theta", "l0r", "half_width", "top_height"):
        assert getattr(alike, name) == pytest.approx(getattr(block, name), rel=1e-14), name


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({}, "width"),
        ({"width": 0.6}, "width"),
        ({"height": 2.0}, "height"),
        ({"slenderness": 0.2}, "slenderness"),
        ({"slenderness": 0.2, "height": 2.0}, "slenderness"),
        ({"width": 0.6, "height": 2.0, "half_diagonal": 1.0}, "half_diagonal"),
    ],
)
def test_sizes_that_do_not_make_a_block_are_refused(given: dict[str, float], field: str) -> None:
    with pytest.raises(rf.InputError, match="width and height") as caught:
        rf.rigid_block(**given)
    assert caught.value.field == field


def test_a_brick_released_beyond_its_balance_falls_in_the_time_of_a_physical_pendulum() -> None:
    brick = rf.rigid_block(width=0.104, height=0.225, mass=3.0)
    start = rf.InitialState(rotation=math.radians(35.0))
    fall = rf.simulate(brick, rf.quiet_motion(1.0), "rigid-C", initial=start)
    assert fall.status == "overturned"
    assert fall.history is not None
    # ½ I θ'² = m g R (cos(θ_0 - α) - cos(θ - α)) by quadrature, with the start, where the rate vanishes, taken out.
    alpha, r = math.atan2(0.104, 0.225), 0.5 * math.hypot(0.104, 0.225)
    u, weights = np.polynomial.legendre.leggauss(200)
    begin, end = math.radians(35.0) - alpha, 0.5 * math.pi - alpha
    s = 0.5 * (u + 1.0) * math.sqrt(end - begin)  # θ = begin + s²
    rate = np.sqrt(1.5 * 9.81 / r * (math.cos(begin) - np.cos(begin + s**2)))
    time = float(np.sum(weights * 2.0 * s / rate)) * 0.5 * math.sqrt(end - begin)
    assert time == pytest.approx(0.3341986, abs=5e-8)
    assert fall.history.time[-1] == pytest.approx(time, rel=1e-9)


def test_defaults_in_signatures_can_be_read() -> None:
    for name in rf.__all__:
        made = getattr(rf, name)
        if callable(made) and not isinstance(made, type):
            defaults = [each.default for each in inspect.signature(made).parameters.values()]
            assert all(len(each) < 10 for each in defaults if isinstance(each, tuple | list)), name


BLOCK = rf.rigid_block(width=1.6, height=9.6, mass=20e3)
PULSE = rf.one_sine_pulse(amplitude=4.0, period=1.0, dt=1e-3)


def test_what_holds_a_block_in_python_is_what_holds_it_in_a_file(tmp_path) -> None:
    tie = rf.Tendon(initial_force=5e3, stiffness=2e5, height=9.0)
    held = rf.Restrained(rf.Eccentric(BLOCK, 0.1), [rf.Tendon(2e4, 1e6, position=0.2), tie])
    (tmp_path / "held.toml").write_text(
        "eccentricity = 0.1\nblock = { width = 1.6, height = 9.6, mass = 20e3 }\n"
        '[[elements]]\nkind = "tendon"\ninitial_force = 2e4\nstiffness = 1e6\nposition = 0.2\n'
        '[[elements]]\nkind = "tendon"\ninitial_force = 5e3\nstiffness = 2e5\nheight = 9.0\n'
    )
    assert held.rocking() == rf.read_structure(tmp_path / "held.toml").rocking()
    one, other = rf.simulate(held, PULSE, "rigid"), rf.simulate(held.rocking(), PULSE, "rigid")
    assert one == other
    with pytest.raises(rf.InputError, match="no shapes of modes"):
        held.modal()


def test_a_tie_holds_a_block_like_a_spring_at_its_height() -> None:
    """I_θ θ'' = -s (m g b - m h g |θ|) - m h a - k z² θ, linear on each side: the slow rotation under a tie alone."""
    k, z, start = 3e5, 8.0, 0.05
    held = rf.Restrained(BLOCK, [rf.Tendon(0.0, k, height=z), rf.Tendon(0.0, k, height=z, cosine=-1.0)])
    run = rf.simulate(held, rf.quiet_motion(0.5), "rigid", initial=rf.InitialState(rotation=start))
    assert run.history is not None
    p, stiffness = BLOCK, k * z**2 - BLOCK.l0r * 9.81
    rest, rate = -p.weight_moment / stiffness, math.sqrt(stiffness / p.i_theta)
    inside = run.history.rotation > 0.02
    expected = rest + (start - rest) * np.cos(rate * run.history.time[inside])
    np.testing.assert_allclose(run.history.rotation[inside], expected, rtol=1e-10)


def test_a_block_with_a_tendon_rocks_as_published() -> None:
    """tan α = 1/6, R = 4.866 m, F_0 = 0.1 W, k = 0.8 W R/b², one sine of 4 m/s² and 1 s."""
    alpha, r, mass = math.atan(1.0 / 6.0), 4.866, 1e3
    weight, b = mass * 9.81, r * math.sin(alpha)
    held = rf.Restrained(rf.rigid_block(alpha, r, mass), rf.Tendon(0.1 * weight, 0.8 * weight * r / b**2))
    pulse = rf.one_sine_pulse(amplitude=4.0, period=1.0, dt=1e-4)
    assert rf.simulate(held, pulse, "rigid-C", free_vibration=2.0).max_rotation == pytest.approx(0.09095764, abs=5e-8)


@pytest.mark.parametrize("model", ["rigid", "rigid-C"])
def test_an_elastic_tendon_pulls_until_it_snaps(model: str) -> None:
    k, start, snaps = 2e6, 3e4, 0.012
    tendon = rf.Tendon(start, k, rupture_elongation=snaps)
    whole = rf.simulate(rf.Restrained(BLOCK, rf.Tendon(start, k)), PULSE, model)
    held = rf.simulate(rf.Restrained(BLOCK, tendon), PULSE, model)
    strong = rf.simulate(rf.Restrained(BLOCK, rf.Tendon(start, k, rupture_elongation=10.0)), PULSE, model)
    assert strong.max_rotation == pytest.approx(whole.max_rotation, rel=1e-9)
    assert abs(held.max_rotation - whole.max_rotation) > 0.1 * whole.max_rotation
    assert held.max_element_force[0] == pytest.approx(start + k * snaps, rel=1e-12)
    assert (held.remaining_prestress[0], strong.remaining_prestress[0]) == (0.0, pytest.approx(start))
    assert not held.tendon_overload
    lost = (start + k * snaps) ** 2 / (2.0 * k)  # all that it stores when it breaks, F²/2k
    assert held.element_energy[0] == pytest.approx(lost, rel=1e-9)
    assert np.abs(held.energy.residual).max() < 1e-9 * held.energy.input.max()


def test_a_tendon_that_snaps_falls_to_zero_in_a_slow_push() -> None:
    snaps = 0.016
    pushed = rf.moment_rotation(rf.Restrained(BLOCK, rf.Tendon(3e4, 2e6, rupture_elongation=snaps)), [0.04, 0.0])
    turn, force = pushed.rotation, pushed.element_force[:, 0]
    before = turn * 0.8 < snaps * (1.0 - 1e-9)
    first = np.arange(turn.size) < int(np.argmax(turn))
    np.testing.assert_allclose(force[first & before], 3e4 + 2e6 * 0.8 * turn[first & before], rtol=1e-12)
    assert force[~first].max() == 0.0
    with pytest.raises(rf.InputError, match="with stiffness"):
        rf.Tendon(3e4, 0.0, rupture_elongation=0.1)


@pytest.mark.parametrize("more", [{}, {"rupture_elongation": 0.02}, {"yield_force": 4e4, "post_yield_ratio": 0.0}])
def test_a_tie_without_initial_force_is_taut_in_contact_whatever_ran_before(more: dict[str, float]) -> None:
    tie = rf.Tendon(0.0, 2e6, height=5.8, **more)
    held = rf.Restrained(rf.rigid_block(width=0.6, height=6.0, mass=7e3), [tie, rf.Tendon(10.0, 2e6, height=5.8)])
    record = rf.load_suite("fema-p695-near-field-pulse")["NFP-9-a"]
    first, _, again = (rf.simulate(held, record.scaled(scale), "rigid", "peaks") for scale in (0.3, 0.6, 0.3))
    assert again.max_rotation == first.max_rotation
