"""Tendons: their bounds, what they add to the properties, and what a response says of them."""

import dataclasses
import math

import numpy as np
import pytest

import rockflex as rf
from builders import BY_HAND, make_frame

CENTRAL = rf.Tendon(0.4e6, 5e6, yield_force=1.5e6)
PAIR = [rf.Tendon(0.2e6, 3e6, -0.7), rf.Tendon(0.2e6, 3e6, 0.7, 0.9e6)]
MOTION = rf.load_suite("el-centro-1940")[0].scaled(1.5)


def held(tendons) -> rf.RockingProperties:
    return rf.RockingProperties(**BY_HAND, elements=tendons)


def test_properties_of_a_held_base():
    free, p = rf.RockingProperties(**BY_HAND), held([CENTRAL, *PAIR])
    assert p.prestress == pytest.approx(0.8e6, rel=1e-15)
    assert p.resisting_moment - free.resisting_moment == pytest.approx(0.8e6 * 1.2, rel=1e-12)
    assert p.weight_moment == free.resisting_moment == 240e3 * 9.81 * 1.2
    # By symmetry Σ k (B - x)² = B² Σ k + Σ k x².
    assert p.tendon_stiffness == pytest.approx(11e6 * 1.2**2 + 2 * 3e6 * 0.7**2, rel=1e-12)
    assert p.rocking_stiffness == pytest.approx(p.tendon_stiffness - 1.8e6 * 9.81, rel=1e-12)
    assert free.tendon_stiffness == 0.0
    assert free.rocking_stiffness == -1.8e6 * 9.81
    assert p.truncated(1).tendons == p.tendons


def test_a_restrained_structure_is_the_structure_with_tendons():
    frame = make_frame(n_stories=3, stiffness_ratio=0.0, period=0.6, aspect_ratio=8.0)  # fmt: skip
    restrained = rf.Restrained(frame, CENTRAL)
    assert restrained.tendons == (CENTRAL,)
    assert restrained.rocking(2).tendons == (CENTRAL,)
    assert restrained.rocking(2).n_modes == 2
    assert restrained.rocking(2).floors is not None
    np.testing.assert_array_equal(restrained.modal(2).omega, frame.modal(2).omega)
    assert dataclasses.replace(restrained.rocking(), elements=()).resisting_moment == frame.rocking().resisting_moment


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"initial_force": 2.0, "yield_force": 1.5}, "initial_force must not exceed yield_force, 1.5 N, but 2 N"),
    ],
)
def test_a_tendon_out_of_range(values, says):
    with pytest.raises(rf.InputError) as caught:
        rf.Tendon(**{"initial_force": 1.0, "stiffness": 1.0, **values})
    assert says in str(caught.value)


@pytest.mark.parametrize(
    "tendons",
    [
        [rf.Tendon(1e5, 1e6, 0.5)],
        [rf.Tendon(1e5, 1e6, 0.5), rf.Tendon(1e5, 1e6, -0.6)],
        [rf.Tendon(1e5, 1e6, 0.5), rf.Tendon(2e5, 1e6, -0.5)],
        [rf.Tendon(1e5, 1e6, 0.5), rf.Tendon(1e5, 2e6, -0.5)],
        [rf.Tendon(1e5, 1e6), rf.Tendon(1e5, 1e6, 0.5), rf.Tendon(1e5, 1e6, 0.5)],
    ],
)
def test_asymmetric_tendons_make_two_sides(tendons):
    p = held(tendons)
    right, left = p.pivot(1), p.pivot(-1)
    assert not p.symmetric
    assert (right.prestress_moment, right.tendon_stiffness) != (left.prestress_moment, left.tendon_stiffness)


def test_other_refusals():
    with pytest.raises(rf.InputError, match=r"Elements must act within half_width = 1\.2 m to each side of .*"):
        held([rf.Tendon(1.0, 1.0, 1.3), rf.Tendon(1.0, 1.0, -1.3)])
    with pytest.raises(rf.InputError, match=r"elements must be Tendon, .* objects, .*but 3 was given\. Write Tendon\("):
        held(3)
    with pytest.raises(rf.InputError, match=r"structure must be a structure"):
        rf.Restrained(3.0, CENTRAL)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("model", ["MDOF-S", "MDOF-C-SI", "2DOF-S", "rigid-C"])
def test_forces_along_the_history(model):
    p = held([CENTRAL, *PAIR])
    response = rf.simulate(p, MOTION, model)
    assert response.status == "rocking"
    theta = response.rotation
    # Distances of the points where the tendons leave the base, from the turned to the resting base.
    moved = np.abs(np.exp(1j * np.abs(theta)) - 1.0) if "-C" in model else np.abs(theta)
    for k, tendon in enumerate(p.tendons):
        arm = np.where(theta > 0.0, 1.2 - tendon.position, 1.2 + tendon.position)
        expected = tendon.initial_force + tendon.stiffness * arm * moved
        np.testing.assert_allclose(response.tendon_force[:, k], expected, rtol=1e-12)
    # The peak is that of the continuous motion, over both pivots alike.
    stretch = 2.0 * math.sin(0.5 * response.max_rotation) if "-C" in model else response.max_rotation
    largest = [0.4e6 + 5e6 * 1.2 * stretch, 0.2e6 + 3e6 * 1.9 * stretch]
    assert response.max_tendon_force == pytest.approx(max(largest), rel=1e-12)
    assert response.tendon_utilisation == pytest.approx(max(largest[0] / 1.5e6, largest[1] / 0.9e6), rel=1e-12)
    assert response.max_tendon_force >= response.tendon_force.max()


def test_without_tendons_there_is_no_force():
    response = rf.simulate(rf.RockingProperties(**BY_HAND), MOTION, "2DOF-S")
    assert response.max_tendon_force == 0.0
    assert response.tendon_utilisation == 0.0
    assert response.tendon_force.shape == (response.time.size, 0)
    assert math.isnan(rf.simulate(held(rf.Tendon(1e5, 1e6)), MOTION, "2DOF-S").tendon_utilisation)


def test_tables_have_the_forces():
    table = rf.simulate_many([held(CENTRAL), rf.RockingProperties(**BY_HAND)], MOTION, ["2DOF-S", "2DOF-C"])
    single = rf.simulate(held(CENTRAL), MOTION, "2DOF-S", output="peaks")
    assert table["max_tendon_force"].tolist()[0] == single.max_tendon_force
    assert table["tendon_utilisation"].tolist()[:3:2] == [single.tendon_utilisation, 0.0]


def test_reactions_hold_the_tendons_pull():
    p = held([CENTRAL, *PAIR])
    for model in ("MDOF-S", "MDOF-C-SI"):
        response = rf.simulate(p, MOTION, model)
        free = dataclasses.replace(p, elements=())
        tied = response.history.model
        without = rf.History(dataclasses.replace(tied, properties=free), response.history.states)
        theta, spin = response.rotation, response.rotation_velocity
        force = response.tendon_force.sum(axis=1)
        contact = response.side == 0.0
        np.testing.assert_allclose(response.vertical_reaction[contact], 240e3 * 9.81 + 0.8e6, rtol=1e-12)
        # While rocking the accelerations differ too: compare through them, Σ m x'' of Eqs. 21 and 22 at one state.
        spun = response.rotation_acceleration - without.rotation_acceleration
        pushed = (response.modal_acceleration - without.modal_acceleration) @ p.effective_mass
        across = response.side * p.m_tot * p.half_width - response.modal_displacement @ p.effective_mass
        if model == "MDOF-C-SI":  # a chord of the circle about the pivot stands at θ/2
            x = spun * (across * np.sin(theta) + p.l0r * np.cos(theta)) + pushed * np.cos(theta)
            z = spun * (across * np.cos(theta) - p.l0r * np.sin(theta)) - pushed * np.sin(theta)
            x, z = x + force * np.sin(theta / 2), z + force * np.cos(theta / 2)
        else:  # for small rotations the tendons stay upright
            x, z = spun * p.l0r + pushed, spun * response.side * p.m_tot * p.half_width + force
        np.testing.assert_allclose(response.horizontal_reaction - without.horizontal_reaction, x, atol=1e-3)
        np.testing.assert_allclose(response.vertical_reaction - without.vertical_reaction, z, atol=1e-3)
        assert spin.any()
        assert response.required_friction < np.inf
