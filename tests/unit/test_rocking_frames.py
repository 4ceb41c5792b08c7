"""Free-standing columns under a cap, as one rigid body, and the restitution that goes with it."""

import math

import numpy as np
import pytest

import rockflex as rf
from rockflex.models import Restitution

PULSE = rf.one_sine_pulse(amplitude=4.0, period=1.0)


def frame(ratio: float, n: int = 4) -> rf.RockingProperties:
    """Columns of tan α = 1/6 under a cap of `ratio` times their mass."""
    return rf.rocking_frame(n, 1.6, 9.6, 60e3, ratio * n * 60e3)


@pytest.mark.parametrize(("ratio", "published"), [(1.0, 0.9493), (7.5, 0.9465)])
def test_the_restitution_is_the_published_one(ratio: float, published: float) -> None:
    p = frame(ratio)
    assert p.restitution == pytest.approx(published, abs=5e-5)
    assert rf.simulate(p, PULSE, "rigid") == rf.simulate(p, PULSE, "rigid", impact=Restitution(p.restitution or 0.0))


def test_a_column_without_a_cap_is_a_block() -> None:
    alone, block = frame(0.0, 1), rf.rigid_block(width=1.6, height=9.6, mass=60e3)
    for name in ("i_theta", "l0r", "m_tot", "half_width", "top_height"):
        assert getattr(alone, name) == pytest.approx(getattr(block, name), rel=1e-14), name
    assert alone.restitution == pytest.approx(1.0 - 1.5 / 37.0, rel=1e-14)  # Housner's
    one, other = (rf.simulate(each, PULSE, "rigid-C").max_rotation for each in (alone, block))
    assert one == pytest.approx(other, rel=1e-9)


@pytest.mark.parametrize("ratio", [0.5, 7.5])
def test_a_frame_rocks_like_a_larger_block_of_its_restitution(ratio: float) -> None:
    p, alpha = frame(ratio), math.atan(1.0 / 6.0)
    larger = rf.rigid_block(alpha, math.hypot(0.8, 4.8) * (1.0 + 3.0 * ratio) / (1.0 + 2.0 * ratio))
    for model in ("rigid", "rigid-C"):
        alike = rf.simulate(larger, PULSE, model, impact=Restitution(p.restitution or 0.0))
        assert rf.simulate(p, PULSE, model).max_rotation == pytest.approx(alike.max_rotation, rel=1e-9)


def test_momentum_about_the_new_edges_gives_the_restitution() -> None:
    """The cap moves by (2 h θ, 2 b |θ|); about the new edges each column and the cap keep their angular momentum.

    A column that turns with θ' about its left edge has the momentum I_c θ' + m (h² - b²) θ' about the other one, and
    the cap 2 h m 2 h θ' - 2 b m 2 b θ'.
    """
    b, h, n, column, cap = 0.6, 3.3, 3, 20e3, 90e3
    centre = column * (b**2 + h**2) / 3.0
    before = n * (centre + column * (h**2 - b**2)) + 4.0 * cap * (h**2 - b**2)
    after = n * (centre + column * (h**2 + b**2)) + 4.0 * cap * (h**2 + b**2)
    assert rf.rocking_frame(n, 2.0 * b, 2.0 * h, column, cap).restitution == pytest.approx(before / after, rel=1e-14)


def test_a_long_record_rocks_as_runge_kutta_steps_of_8_microseconds_have_it() -> None:
    """A frame whose cap is 21 times as heavy as its columns; contact begins as in `Restitution`."""
    p = rf.rocking_frame(2, 0.612, 6.06, 4900.0, 211e3)
    record = rf.load_suite("fema-p695-near-field-pulse")["NFP-3-b"].scaled(1.5)
    run = rf.simulate(p, record, "rigid", "peaks")
    assert (run.n_uplifts, run.n_impacts) == (3, 301)
    assert run.max_rotation == pytest.approx(0.11232487792631676, rel=1e-9)
    assert run.max_total_top_displacement == pytest.approx(0.6806887602334796, rel=1e-9)


def test_reactions_are_those_of_columns_and_cap() -> None:
    p = frame(2.0)
    assert p.m_tot == pytest.approx(4 * 60e3 * 3.0)
    assert p.resting_reaction == pytest.approx(p.m_tot * 9.81)
    assert p.uplift_acceleration == pytest.approx(9.81 / 6.0, rel=1e-14)


def test_squat_columns_and_wrong_restitutions_are_refused() -> None:
    with pytest.raises(rf.InputError, match="slender") as caught:
        rf.rocking_frame(2, 5.0, 3.0, 1e3, 1e4)
    assert caught.value.field == "column_width"
    body = {"omega": [], "effective_mass": [], "effective_height": [], "top_ordinate": [], "zeta": []}
    body |= {"i_theta": 10.0, "l0r": 2.0, "m_tot": 1.0, "half_width": 0.5}
    with pytest.raises(rf.InputError, match="at most 1"):
        rf.RockingProperties(**body, restitution=1.1)
    flexible = rf.Frame(2, 3.0, 4e4, 4e4, 0.1, period=0.5, aspect_ratio=5.0, damping_ratio=0.02).rocking()
    with pytest.raises(rf.InputError, match=r"impact=Restitution") as caught:
        rf.RockingProperties(**{name: getattr(flexible, name) for name in (*body,)}, restitution=0.5)
    assert caught.value.field == "restitution"


def test_restitution_one_keeps_the_energy_of_free_rocking() -> None:
    p = rf.RockingProperties([], [], [], [], 10.0, 2.0, 1.0, 0.5, [], restitution=1.0)
    run = rf.simulate(p, rf.quiet_motion(4.0), "rigid", initial=rf.InitialState(rotation=0.1))
    assert run.n_impacts == 3
    assert np.abs(run.rotation).max() == pytest.approx(0.1, rel=1e-12)
    assert run.energy.residual == pytest.approx(0.0, abs=1e-10)
