"""The rows of the simplified models against Eqs. 15 and 23-25 as they are printed, in random states."""

import numpy as np
import pytest

from builders import make_frame
from rockflex.models import Model
from rockflex.models._quantities import Quantities
from rockflex.models._rigid_ground_system import system_on_rigid_ground
from rockflex.models._rocking_model import RockingModel

GRAVITY = 9.81


def model(n_modes, *, lifts=True):
    frame = make_frame(
        n_stories=4, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=9.0, damping_ratio=0.03
    )
    return Model(n_modes, lifts).of(frame.rocking())


def draw(n, seed=0):
    """A state with the ground acceleration and 1: the vector on which rows act."""
    return np.append(np.random.default_rng(seed).standard_normal(2 * n + 3) * 0.1, 1.0)


@pytest.mark.parametrize("n", [1, 2, 4])
@pytest.mark.parametrize("side", [1, -1])
def test_rocking_accelerations_satisfy_equation_23(n, side):
    tied = model(n)
    p, x, key = tied.properties, draw(n), tied.start(side)
    d, v, turn, a = x[:n], x[n : 2 * n], x[2 * n], x[-2]
    angular = tied.angular_acceleration(key) @ x
    modal = tied.modal_accelerations(key) @ x
    arm = p.effective_mass * p.effective_height
    weight = -side * p.m_tot * GRAVITY * p.half_width + p.l0r * GRAVITY * turn
    assert p.i_theta * angular + arm @ modal == pytest.approx(weight - p.l0r * a, rel=1e-12)
    inertial = modal + p.effective_height * angular
    np.testing.assert_allclose(
        inertial + 2.0 * p.zeta * p.omega * v + p.omega**2 * d, np.full(n, -a), rtol=0.0, atol=1e-10 * abs(modal).max()
    )


@pytest.mark.parametrize("n", [1, 2, 4])
def test_contact_satisfies_equations_15_and_24(n):
    tied = model(n)
    p, x = tied.properties, draw(n, 1)
    d, v, a = x[:n], x[n : 2 * n], x[-2]
    modal = tied.modal_accelerations(tied.start(0)) @ x
    np.testing.assert_allclose(modal, -a - 2.0 * p.zeta * p.omega * v - p.omega**2 * d, rtol=1e-13)
    assert not tied.angular_acceleration(tied.start(0)).any()
    moment = (p.effective_mass * p.effective_height) @ modal + p.l0r * a
    assert tied.overturning_moment(tied.start(0)) @ x == pytest.approx(moment, rel=1e-12)


def test_at_uplift_the_rotation_starts_from_what_the_weight_cannot_hold():
    tied = model(2)
    x = draw(2, 2)
    x[4:6] = 0.0
    resistance = tied.properties.m_tot * GRAVITY * tied.properties.half_width
    for side in (1, -1):
        excess = -tied.overturning_moment(tied.start(0)) @ x - side * resistance
        turn = tied.angular_acceleration(tied.start(side)) @ x
        assert turn == pytest.approx(excess / tied.free_inertia(side), rel=1e-12)


def test_a_fixed_base_resists_any_moment():
    free, fixed = model(2), model(2, lifts=False)
    resistance = free.properties.m_tot * GRAVITY * free.properties.half_width
    lifting, never = (system_on_rigid_ground([each], [Quantities.none(2)]).phase((0,)).events for each in (free, fixed))
    assert [float(event.constant[0]) for event in lifting] == [resistance, resistance]
    assert never == ()
    assert (free.sides, fixed.sides) == ((0, 1, -1), (0,))


def test_with_all_modes_the_free_inertia_is_that_of_the_half_width():
    # Σ m* h*² = Σ m h² then, so that m_tot B² is left of I_θ.
    p = model(4).properties
    for side in (1, -1):
        assert RockingModel("MDOF-S", p).free_inertia(side) == pytest.approx(p.m_tot * p.half_width**2, rel=1e-9)
