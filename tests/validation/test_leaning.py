"""Leaning mass: against an integration in the displacements of the floors, closed forms, and limits."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

import rockflex as rf
from rockflex import InputError

G = 9.81
FLOORS = np.array([3.0, 6.5, 10.0])
STANDING = np.array([30e3, 25e3, 20e3])
LEANING = np.array([40e3, 35e3, 10e3])
STIFFNESS = np.array([[9e7, -4e7, 0.0], [-4e7, 7e7, -3e7], [0.0, -3e7, 3e7]])
BASE, WIDTH, ZETA = 15e3, 1.3, 0.03


def wall() -> rf.LumpedStructure:
    return rf.LumpedStructure(STANDING, STIFFNESS, FLOORS, base_mass=BASE, half_width=WIDTH, damping_ratio=ZETA)


def shaking() -> rf.GroundMotion:
    t = np.arange(251) * 0.02
    return rf.GroundMotion(3.4 * np.sin(5.0 * t) * np.exp(-((t - 1.8) ** 2)) + 1.2 * np.sin(17.0 * t) * (t < 3.0), 0.02)


def rotations(motion: rf.GroundMotion) -> tuple[np.ndarray, int]:
    """θ at the samples and the number of uplifts, with the equations written in the displacements of the floors."""
    mass, n = STANDING + LEANING, FLOORS.size
    weight = (STANDING.sum() + BASE) * G
    omega2, shapes = eigh(STIFFNESS, np.diag(mass))
    damping = np.diag(mass) @ shapes @ np.diag(2.0 * ZETA * np.sqrt(omega2)) @ shapes.T @ np.diag(mass)
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n], whole[:n, n], whole[n, :n] = np.diag(mass), mass * FLOORS, mass * FLOORS
    whole[n, n] = mass @ FLOORS**2 + WIDTH**2 * (STANDING.sum() + BASE)

    def rates(y: np.ndarray, a: float, side: int) -> np.ndarray:
        u, theta, v, spin = y[:n], y[n], y[n + 1 : 2 * n + 1], y[-1]
        force = -STIFFNESS @ u - damping @ v - mass * a
        if side == 0:
            return np.concatenate((v, [0.0], force / mass, [0.0]))
        moment = -(mass @ FLOORS) * a - side * weight * WIDTH + G * (mass @ FLOORS) * theta
        return np.concatenate((v, [spin], np.linalg.solve(whole, np.append(force, moment))))

    def overturning(y: np.ndarray, a: float) -> float:
        return -(mass * FLOORS) @ (rates(y, a, 0)[n + 1 : 2 * n + 1] + a)

    y, side, uplifts, found = np.zeros(2 * n + 2), 0, 0, [0.0]
    samples, dt = motion.acceleration, motion.dt
    for first, last in pairwise(samples):
        t = 0.0
        while t < dt:

            def ground(s: float, first: float = first, last: float = last) -> float:
                return first + (last - first) * s / dt

            if side == 0:

                def ends(s: float, y: np.ndarray) -> float:
                    return weight * WIDTH - abs(overturning(y, ground(s)))
            else:

                def ends(s: float, y: np.ndarray, side: int = side) -> float:
                    return side * y[n]

            ends.terminal, ends.direction = True, -1
            done = solve_ivp(
                lambda s, y, side=side: rates(y, ground(s), side),
                (t, dt),
                y,
                "DOP853",
                events=ends,
                rtol=1e-11,
                atol=1e-13,
            )
            y, t = done.y[:, -1].copy(), float(done.t[-1])
            if done.status != 1:
                continue
            if side == 0:
                side, uplifts = int(np.sign(overturning(y, ground(t)))), uplifts + 1
                y[n] = side * 1e-17
            else:
                y[n + 1 : 2 * n + 1] += FLOORS * y[-1]
                y[n], y[-1], side = 0.0, 0.0, 0
        found.append(y[n])
    return np.array(found), uplifts


def test_the_motion_is_that_of_an_integration_in_the_displacements_of_the_floors():
    motion = shaking()
    expected, uplifts = rotations(motion)
    response = rf.simulate(rf.Leaning(wall(), LEANING), motion, "MDOF-S", output="history", free_vibration=0.0)
    at = np.searchsorted(response.time, np.arange(expected.size) * motion.dt - 1e-9)
    scale = np.abs(expected).max()
    assert scale > 0.002
    assert response.n_uplifts == uplifts > 1
    np.testing.assert_allclose(response.rotation[at], expected, rtol=0.0, atol=1e-7 * scale)
    assert response.energy.closing_error < 1e-10


def test_the_parameters_are_the_sums_over_both_kinds_of_mass():
    p = rf.Leaning(wall(), LEANING).rocking()
    both, standing = STANDING + LEANING, STANDING.sum() + BASE
    assert p.m_tot == pytest.approx(standing, rel=1e-14)
    assert p.horizontal_mass == pytest.approx(standing + LEANING.sum(), rel=1e-14)
    assert p.weight_share == pytest.approx(standing / (standing + LEANING.sum()), rel=1e-14)
    assert p.l0r == pytest.approx(both @ FLOORS, rel=1e-14)
    assert p.i_theta == pytest.approx(both @ FLOORS**2 + WIDTH**2 * standing, rel=1e-13)
    assert p.resisting_moment == pytest.approx(G * WIDTH * standing, rel=1e-13)
    assert p.base_mass == pytest.approx(BASE, rel=1e-12)
    assert p.effective_mass.sum() == pytest.approx(both.sum(), rel=1e-12)


def test_without_leaning_mass_nothing_changes():
    alone = rf.simulate(wall(), shaking(), "MDOF-S")
    same = rf.simulate(rf.Leaning(wall(), 0.0), shaking(), "MDOF-S")
    assert same.max_rotation == alone.max_rotation > 0.0
    assert same.max_base_moment == alone.max_base_moment


def test_on_a_base_that_does_not_lift_leaning_mass_is_mass():
    heavy = rf.LumpedStructure(
        STANDING + LEANING, STIFFNESS, FLOORS, base_mass=BASE, half_width=WIDTH, damping_ratio=ZETA
    )
    leaning, mass = (rf.simulate(each, shaking(), "fixed") for each in (rf.Leaning(wall(), LEANING), heavy))
    assert leaning.max_base_moment == pytest.approx(mass.max_base_moment, rel=1e-12)
    assert leaning.max_rotation == mass.max_rotation == 0.0


@pytest.mark.parametrize(
    "ground",
    [rf.Ground(friction=0.35), rf.Ground(springs=rf.winkler_bed(WIDTH, 2.0, 2e8, damping=1e6, n=5), base_inertia=2e5)],
    ids=["sliding", "springs"],
)
def test_energy_is_balanced_on_any_ground(ground):
    response = rf.simulate(
        rf.Leaning(wall(), LEANING), shaking(), "MDOF-S", ground=ground, output="history", free_vibration=1.0
    )
    assert response.energy.closing_error < 1e-9


def test_the_horizontal_reaction_moves_all_mass():
    response = rf.simulate(rf.Leaning(wall(), LEANING), shaking(), "MDOF-S", output="history", free_vibration=0.0)
    floors = response.history.floor_acceleration
    ground = np.interp(response.time, np.arange(shaking().acceleration.size) * 0.02, shaking().acceleration)
    inertia = floors @ (STANDING + LEANING) + BASE * ground
    reaction = response.history.horizontal_reaction
    np.testing.assert_allclose(reaction, inertia, rtol=0.0, atol=1e-9 * np.abs(inertia).max())


def test_elements_and_a_saved_response(tmp_path):
    held = rf.Restrained(rf.Leaning(wall(), LEANING), rf.Tendon(initial_force=100e3, stiffness=4e6, position=0.2))
    response = rf.simulate(held, shaking(), "2DOF-S", output="history")
    again = rf.Response.load(response.save(tmp_path / "run.npz"))
    assert again.history.model.properties.leaning_mass == LEANING.sum()
    assert again.energy.closing_error == response.energy.closing_error < 1e-9


@pytest.mark.parametrize("masses", [[1e3, 2e3], -1.0, [1e3, -1e3, 0.0], [1e3, np.nan, 0.0]])
def test_wrong_masses_are_refused(masses):
    with pytest.raises(InputError) as caught:
        rf.Leaning(wall(), masses)
    assert caught.value.field == "masses"


def test_what_cannot_be_combined_is_refused():
    leaning = rf.Leaning(wall(), LEANING)
    with pytest.raises(InputError, match="MDOF-S"):
        rf.simulate(leaning, shaking(), "MDOF-C")
    for other in (rf.Restrained(wall(), rf.Tendon(1e5, 1e6)), rf.rigid_block(0.2, 3.0), 3.0):
        with pytest.raises(InputError) as caught:
            rf.Leaning(other, LEANING)
        assert caught.value.field == "structure"
