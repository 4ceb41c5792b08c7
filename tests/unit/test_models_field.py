"""The vector field of the nonlinear models and their uplifts, against the twin's, at random states."""

import numpy as np
import pytest

from builders import NO_MODES, frame_values, vector_field
from rockflex import BoucWen
from rockflex.models import Model
from rockflex.models._nonlinear_ground_system import nonlinear_system
from rockflex.models._quantities import HORIZONTAL, LEFT_OUT, LINEAR, SWAY, SWING, VERTICAL, Quantities
from rockflex.structure import RockingProperties
from twins import complete_model as twin
from twins.complete import complete_frame

FRAME = frame_values(
    n_stories=4, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=6.0, damping_ratio=0.04
)
SPRING = (0.03, 0.05, 0.7, 0.3, 2.5)
LEVERS = np.array([[9.0, 0.0], [1.2, 3.4], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]])


def pair(n, *, complete, spring=None):
    """The model and its twin."""
    given = complete_frame(**FRAME, n_modes=max(n, 1)) | (NO_MODES if n == 0 else {})
    choice = Model(None if n else 0, complete=complete, closure="SI" if complete and n else None)
    model = choice.of(RockingProperties(**given), bouc_wen=BoucWen(*spring) if spring else None)
    other = twin.CompleteModel(
        twin.Structure(**given), complete=complete, bouc_wen=twin.BoucWen(*spring) if spring else None
    )
    return model, other


def states(n, count=20):
    """[D, D', θ, θ', z] and ground accelerations, of all signs."""
    rng = np.random.default_rng(n)
    for _ in range(count):
        motion = np.concatenate((rng.normal(0.0, 0.2, n), rng.normal(0.0, 2.0, n), rng.normal(0.0, 0.5, 3)))
        yield motion, rng.normal(0.0, 8.0)


def rates_of(model, side, acceleration, motion):
    n = model.properties.n_modes
    branch = 1 if n == 0 or motion[n] >= 0.0 else -1
    full = np.concatenate((motion, np.zeros(model.layout.size - motion.size)))
    return vector_field(model, side, branch).rates_at(full, acceleration, 0.0)


CASES = [(n, True, None) for n in (0, 1, 2, 4)] + [(1, True, SPRING), (1, False, SPRING)]


@pytest.mark.parametrize(("n", "complete", "spring"), CASES)
@pytest.mark.parametrize("side", [1, -1, 0])
def test_rates(n, complete, spring, side):
    model, other = pair(n, complete=complete, spring=spring)
    for motion, a in states(n):
        if side == 0:
            motion[2 * n : 2 * n + 2] = 0.0
        rates = rates_of(model, side, a, motion)
        state = np.concatenate((motion[2 * n : 2 * n + 2], motion[: 2 * n], motion[-1:] if spring else []))
        expected = other.field(state, a, side)
        size = np.abs(expected).max()
        np.testing.assert_allclose(rates[: 2 * n], expected[2 : 2 + 2 * n], rtol=1e-11, atol=1e-12 * size)
        np.testing.assert_allclose(rates[2 * n : 2 * n + 2], expected[:2], rtol=1e-11, atol=1e-12 * size)
        if spring:
            assert rates[2 * n + 2] == pytest.approx(expected[-1], rel=1e-12)
        else:
            assert rates[2 * n + 2] == 0.0
        p = model.properties
        if side:
            left = other.inertia(motion[:n], side) - float(p.effective_mass @ p.effective_height**2)
            assert vector_field(model, side).inertia_at(motion) == pytest.approx(left, rel=1e-12)


@pytest.mark.parametrize(("n", "complete", "spring"), CASES)
@pytest.mark.parametrize("side", [1, -1, 0])
def test_energies_are_counted(n, complete, spring, side):
    """What is stored grows by what is put in, less what is damped and what the hysteretic spring takes."""
    model, other = pair(n, complete=complete, spring=spring)
    p = model.properties

    def stored(state):
        energy = other.kinetic_energy(state, side) + other.potential_energy(state, side)
        if spring:  # the elastic share alone
            d = other.modal(state)[0]
            energy -= 0.5 * (1.0 - spring[1]) * float(p.effective_mass @ (p.omega * d) ** 2)
        return energy

    for motion, a in states(n, 10):
        if side == 0:
            motion[2 * n : 2 * n + 2] = 0.0
        rates = rates_of(model, side, a, motion)
        v = motion[n : 2 * n]
        damped = float((2.0 * p.zeta * p.omega * p.effective_mass) @ v**2)
        yielded = 0.0
        if spring:
            force = p.effective_mass[0] * p.omega[0] ** 2 * (1.0 - spring[1]) * spring[0] * motion[-1]
            yielded = force * v[0]
        assert rates[2 * n + 3] == pytest.approx(damped, rel=1e-12)
        assert rates[2 * n + 5] == pytest.approx(yielded, rel=1e-12)
        state = np.concatenate((motion[2 * n : 2 * n + 2], motion[: 2 * n], motion[-1:] if spring else []))
        direction = other.field(state, a, side)
        step = 1e-6
        growth = (stored(state + step * direction) - stored(state - step * direction)) / (2.0 * step)
        terms = abs(rates[2 * n + 4]) + damped + abs(yielded) + abs(growth)
        assert growth == pytest.approx(rates[2 * n + 4] - damped - yielded, abs=1e-6 * terms)


@pytest.mark.parametrize(("n", "complete", "spring"), CASES)
def test_uplift_is_by_equations_16_and_24(n, complete, spring):
    model, other = pair(n, complete=complete, spring=spring)
    key = (*model.start(0), *((1,) if spring else ()))
    phase = nonlinear_system(model, Quantities.none(n)).phase(key)
    right, left = (event for event in phase.events if event.name == "uplift")
    assert (right.constant, left.constant) == pytest.approx((other.resisting(1), other.resisting(-1)), rel=1e-12)
    for motion, a in states(n):
        state = np.concatenate(([0.0, 0.0], motion[: 2 * n], motion[-1:] if spring else []))
        motion[2 * n : 2 * n + 2] = 0.0
        full = np.concatenate((motion, np.zeros(model.layout.size - motion.size)))
        expected = other.overturning(state, a)
        for side, event in ((1, right), (-1, left)):
            found = side * (event.row @ full + event.direct * a)
            assert found == pytest.approx(expected, rel=1e-11, abs=1e-12 * other.resisting(1))


def test_at_uplift_the_complete_rotation_starts_from_the_excess():
    """θ'' (I + ...) = s (|M| - m_tot g B) where the base leaves the ground."""
    model, other = pair(2, complete=True)
    resistance = model.properties.resisting_moment
    for motion, a in states(2):
        motion[4:6] = 0.0
        for side in (1, -1):
            moment = other.overturning(np.concatenate(([0.0, 0.0], motion[:4])), a)
            excess = -moment - side * resistance
            rates = rates_of(model, side, a, motion)
            left = vector_field(model, side).inertia_at(motion)
            assert rates[5] * left == pytest.approx(excess, rel=1e-10, abs=1e-10 * abs(moment))


def test_the_simplified_field_is_the_linear_model():
    """With a spring that does not yield, Eq. 23's rows."""
    model, _ = pair(1, complete=False, spring=(1e9, 0.5, 0.5, 0.5, 2.0))
    linear = model.linear
    rng = np.random.default_rng(2)
    for side in (1, -1, 0):
        motion = rng.normal(0.0, 0.1, 5)
        a = rng.normal()
        if side == 0:
            motion[2:4] = 0.0
        motion[4] = motion[0] / 1e9  # z while elastic
        rates, key = rates_of(model, side, a, motion), linear.start(side)
        vector = np.concatenate((motion[:4], [a, 1.0]))
        assert rates[1] == pytest.approx(float((linear.modal_accelerations(key) @ vector)[0]), rel=1e-9)
        if side:
            assert rates[3] == pytest.approx(float(linear.angular_acceleration(key) @ vector), rel=1e-9)


@pytest.mark.parametrize(("n", "complete", "spring"), CASES)
@pytest.mark.parametrize("side", [1, -1, 0])
def test_many_states_in_one_call(n, complete, spring, side):
    model, _ = pair(n, complete=complete, spring=spring)
    rng = np.random.default_rng(7)
    field = vector_field(model, side, kinds=[SWAY, LEFT_OUT, SWING, LINEAR, HORIZONTAL, VERTICAL], levers=LEVERS)
    motion, rows = rng.normal(0.0, 0.3, (9, model.layout.size)), rng.normal(0.0, 1.0, (9, len(LEVERS)))
    a, a_v = rng.normal(0.0, 4.0, (2, 9))
    rates, values = field.rates_along(motion, a, a_v), rows.copy()
    field.observe_along(motion, rates, a, a_v, values)
    for k in range(9):
        assert np.array_equal(rates[k], field.rates_at(motion[k], a[k], a_v[k]))
        one = rows[k].copy()
        field.observe_at(motion[k], rates[k], a[k], a_v[k], one)
        assert np.array_equal(values[k], one)
    assert np.array_equal(values[:, 3], rows[:, 3])
    assert field.rates_along(motion[:0], a[:0], a_v[:0]).shape == (0, model.layout.size)
