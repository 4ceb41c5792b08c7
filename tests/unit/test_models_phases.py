"""The equations of motion of a phase and the events that end it, against the equations as they are printed."""

import dataclasses

import numpy as np
import pytest

from builders import make_frame
from rockflex import BoucWen, Tendon
from rockflex.models import Model
from rockflex.models._elements import base_equations_of
from rockflex.models._linear_bases import linear_system_base
from rockflex.models._linear_system import linear_system_of
from rockflex.models._nonlinear_ground_system import nonlinear_system
from rockflex.models._quantities import Quantities
from rockflex.models._rigid_ground_system import system_on_rigid_ground

GRAVITY = 9.81
FRAME = make_frame(n_stories=4, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=9.0, damping_ratio=0.03)
TENDONS = (Tendon(stiffness=3e6, initial_force=2e5), Tendon(stiffness=1e6, initial_force=9e4, position=0.3))
PLAIN = FRAME.rocking()
CASES = {
    "plain": PLAIN,
    "tied": dataclasses.replace(PLAIN, elements=TENDONS),
    "eccentric": dataclasses.replace(PLAIN, eccentricity=0.2),
    "eccentric and tied": dataclasses.replace(PLAIN, eccentricity=-0.15, elements=TENDONS),
}
STRUCTURES = pytest.mark.parametrize("name", CASES)
EITHER = pytest.mark.parametrize("side", [1, -1])


def model(name, n=None):
    return Model(n).of(CASES[name])


@EITHER
@STRUCTURES
@pytest.mark.parametrize("n", [0, 1, 2, 4])
def test_an_arrow_solved_for_the_rotation_is_its_angular_acceleration(n, name, side):
    """Eq. 23 row by row: N oscillators, and the base that borders them."""
    tied = model(name, n)
    p, key = tied.properties, tied.start(side)
    arrow, pivot = tied.bordered_system(key), tied.properties.pivot(side)
    # M [D''; θ''] = right, over [D, D', θ, θ', a, 1]
    mass = np.eye(n + 1)
    mass[:n, n] = p.effective_height
    mass[n, :n] = p.effective_mass * p.effective_height
    mass[n, n] = pivot.i_theta
    right = np.zeros((n + 1, 2 * n + 4))
    for i in range(n):
        right[i, i], right[i, n + i], right[i, -2] = -(p.omega[i] ** 2), -2.0 * p.zeta[i] * p.omega[i], -1.0
    right[n, 2 * n] = p.l0r * GRAVITY - sum(t.stiffness * reach(p, t, side) ** 2 for t in p.tendons)
    right[n, -2] = -p.l0r
    right[n, -1] = -side * p.m_tot * GRAVITY * pivot.arm
    right[n, -1] -= side * sum(t.initial_force * reach(p, t, side) for t in p.tendons)
    expected = np.linalg.solve(mass, right)
    scale = np.abs(expected).max(axis=0) + 1e-300
    np.testing.assert_allclose(tied.angular_acceleration(key) / scale, expected[n] / scale, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(tied.modal_accelerations(key) / scale, expected[:n] / scale, rtol=0.0, atol=1e-10)
    # And the arrow's own coefficients, with D'' eliminated.
    left = 1.0 / arrow.flexibility[0, 0]
    assert left == pytest.approx(pivot.i_theta - float(np.sum(p.effective_mass * p.effective_height**2)), rel=1e-9)
    assert left == pytest.approx(tied.free_inertia(side), rel=1e-9)
    row = np.zeros(2 * n + 4)
    row[:n], row[n : 2 * n] = arrow.leverage[0] * p.omega**2, arrow.leverage[0] * 2.0 * p.zeta * p.omega
    row[2 * n], row[2 * n + 1] = -arrow.stiffness[0, 0], -arrow.damping[0, 0]
    row[-2], row[-1] = arrow.drive[0], arrow.constant[0]
    np.testing.assert_allclose(
        row / left, tied.angular_acceleration(key), rtol=1e-12, atol=1e-12 * np.abs(row).max() / left
    )
    assert arrow.freed.tolist() == [True]


def reach(p, tendon, side):
    """Distance of a tendon from the pivot of a side."""
    return p.half_width - side * p.eccentricity - side * tendon.position


@STRUCTURES
def test_in_contact_nothing_of_the_base_is_free(name):
    tied = model(name)
    arrow = tied.bordered_system(tied.start(0))
    assert arrow.freed.tolist() == [False]
    assert not arrow.flexibility.any()
    assert not tied.angular_acceleration(tied.start(0)).any()


@STRUCTURES
@pytest.mark.parametrize("bouc_wen", [None, BoucWen(0.05)])
@pytest.mark.parametrize("complete", [False, True])
def test_phases_end_at_the_resisting_moments_of_the_pivots_and_at_a_quarter_turn(name, complete, bouc_wen):
    if not complete and bouc_wen is None:
        tied, none = Model(1).of(CASES[name]), Quantities.none(1)
        system = (
            linear_system_of(linear_system_base(tied, none, none))
            if tied.elements
            else system_on_rigid_ground([tied], [none])
        )
        phase_of, sign = system.phase, ()
    else:
        tied = Model(1, complete=complete).of(CASES[name], bouc_wen=bouc_wen)
        phase_of, sign = nonlinear_system(tied, Quantities.none(1)).phase, (1,) * (bouc_wen is not None)
    p, moving = tied.properties, [*range(tied.layout.moving)]
    uplifts = [event for event in phase_of((*tied.start(0), *sign)).events if event.name == "uplift"]
    assert [event.target for event in uplifts] == [(*tied.start(side), *sign) for side in (1, -1)]
    for side, event in zip((1, -1), uplifts, strict=True):
        assert float(np.squeeze(event.constant)) == pytest.approx(p.pivot(side).resisting_moment, rel=1e-14)
        row, moment = np.squeeze(event.row)[moving], side * tied.overturning_moment(tied.start(0))
        assert np.array_equal(row, moment[:-2])
        assert float(np.squeeze(event.direct)) == moment[-2]
        ends = {each.name: each for each in phase_of((*tied.start(side), *sign)).events}
        turned = np.eye(tied.layout.size)[tied.layout.rotation][moving]
        assert np.array_equal(np.squeeze(ends["impact"].row)[moving], side * turned)
        assert ends["impact"].target == (*tied.start(0), *sign)
        assert np.array_equal(np.squeeze(ends["overturning"].row)[moving], -side * turned)
        assert (ends["overturning"].target, ends["overturning"].constant) == (None, 0.5 * np.pi)


@EITHER
@STRUCTURES
def test_the_border_of_base_and_tendons_is_that_of_the_pivot(name, side):
    tied = model(name)
    p, pivot, key = tied.properties, tied.properties.pivot(side), tied.start(side)
    assert len(p.tendons) == len(key) - 1
    whole = base_equations_of(p, tied.elements, key)
    assert whole.inertia[0, 0] == pivot.i_theta
    assert whole.stiffness[0, 0] == pytest.approx(pivot.rocking_stiffness, rel=1e-12)
    assert whole.constant[0] == pytest.approx(-side * pivot.resisting_moment, rel=1e-14)
    assert whole.ground[0] == -p.l0r
    assert not whole.damping.any()
