"""Tendons against closed forms and independent quadratures, and their limits."""

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import quad
from scipy.optimize import brentq

import rockflex as rf
from builders import make_frame, vector_field
from rockflex.models import parse_model
from rockflex.models._prepared_model import PreparedModel
from rockflex.models._quantities import Quantities
from rockflex.models._rocking_model import RockingModel

FRAME = make_frame()  # fmt: skip
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
MODELS = ["2DOF-S", "3DOF-S", "MDOF-S", "2DOF-C", "2DOF-C-SI", "3DOF-C-E", "MDOF-C", "rigid", "rigid-C"]
BLOCK = rf.RockingProperties([], [], [], [], i_theta=24e6, l0r=1.8e6, m_tot=240e3, half_width=1.2, zeta=0.02)


def tied(stiffness: float, force: float = 0.0) -> rf.Restrained:
    """Structure #1 with one tendon of a stiffness in units of what cancels the weight's slope."""
    p = FRAME.rocking()
    return rf.Restrained(FRAME, rf.Tendon(force, stiffness * p.l0r * 9.81 / p.half_width**2))


@pytest.mark.parametrize("model", [*MODELS, "fixed"])
def test_a_tendon_of_nothing_changes_nothing(model):
    nothing = rf.Restrained(FRAME, [rf.Tendon(0.0, 0.0), rf.Tendon(0.0, 0.0, 0.5), rf.Tendon(0.0, 0.0, -0.5)])
    plain, held = rf.simulate(FRAME, EL_CENTRO, model), rf.simulate(nothing, EL_CENTRO, model)
    size = np.abs(plain.history.states).max(axis=0)
    assert (np.abs(plain.history.states - held.history.states) <= 1e-9 * size).all()
    for name, value in plain.peaks().items():
        if name != "tendon_utilisation":
            near = isinstance(value, float)
            assert held.peaks()[name] == (pytest.approx(value, rel=1e-9, abs=1e-9, nan_ok=True) if near else value), (
                name
            )


def test_a_tendon_of_nothing_changes_nothing_of_a_yielding_structure():
    spring = rf.BoucWen(0.05)
    nothing = rf.Restrained(FRAME, rf.Tendon(0.0, 0.0))
    plain, held = (rf.simulate(s, EL_CENTRO, "2DOF-S", bouc_wen=spring) for s in (FRAME, nothing))
    np.testing.assert_array_equal(plain.history.states, held.history.states)


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-C", "MDOF-C"])
def test_prestress_holds_the_base_down(model):
    held = rf.simulate(tied(1.0, 1e8), EL_CENTRO, model)
    fixed = rf.simulate(FRAME, EL_CENTRO, "2DOF-S" if model == "2DOF-C" else "MDOF-S", impact=None)
    assert held.status == "no_uplift"
    assert fixed.status == "rocking"
    label = "1DOF-fixed" if model == "2DOF-C" else "fixed"
    reference = rf.simulate(FRAME, EL_CENTRO, label)
    assert held.max_top_displacement == pytest.approx(reference.max_top_displacement, rel=1e-12)
    assert held.max_base_shear == pytest.approx(reference.max_base_shear, rel=1e-12)


@pytest.mark.parametrize("model", ["2DOF-S", "2DOF-C"])
def test_a_stiff_tendon_reaches_the_fixed_base(model):
    quiet = EL_CENTRO.scaled(0.4)
    fixed = rf.simulate(FRAME, quiet, "1DOF-fixed").max_top_displacement
    gaps = []
    for stiffness in (1e3, 1e4, 1e5, 1e6):
        response = rf.simulate(tied(stiffness), quiet, model)
        assert response.status == "rocking"
        gaps.append(abs(response.max_top_displacement / fixed - 1.0))
    print(model, "stiff tendon to fixed base:", ", ".join(f"{gap:.2e}" for gap in gaps))
    assert all(after < before for before, after in pairwise(gaps))
    assert gaps[-1] < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("stiffness", [0.0, 0.5, 1.0, 1.001, 1.011, 0.989, 3.0, 100.0])
@pytest.mark.parametrize("model", MODELS)
def test_energy_closes(model, stiffness):
    response = rf.simulate(tied(stiffness, 1e5), EL_CENTRO, model)
    assert response.status == "rocking"
    assert response.energy.closing_error < 1e-9
    assert (response.energy.tendons > 0.0).any()
    assert (response.energy.impact_losses >= -1e-9 * response.energy.input.max()).all()


def test_energy_closes_where_the_structure_yields():
    response = rf.simulate(tied(2.0), EL_CENTRO, "2DOF-S", bouc_wen=rf.BoucWen(0.075))
    assert response.energy.closing_error < 1e-7
    assert (response.energy.tendons > 0.0).any()


@pytest.mark.parametrize("stiffness", [0.0, 0.3, 1.0, 1.0 + 1e-4, 5.0])
def test_a_rigid_block_falls_back_in_time(stiffness):
    """θ'' = -(M_r + k_r θ)/I_θ from rest: half a wave, a parabola, or a hyperbolic cosine."""
    block = dataclasses.replace(BLOCK, elements=(rf.Tendon(2e5, stiffness * 1.8e6 * 9.81 / 1.2**2),))
    theta = 0.3 * BLOCK.resisting_moment / (BLOCK.l0r * 9.81)
    moment, slope = block.resisting_moment, block.rocking_stiffness
    rate = math.sqrt(abs(slope) / block.i_theta)
    if stiffness == 1.0:
        expected = math.sqrt(2.0 * theta * block.i_theta / moment)
    elif slope > 0.0:
        expected = math.acos(moment / (moment + slope * theta)) / rate
    else:
        expected = math.acosh(moment / (moment + slope * theta)) / rate
    response = rf.simulate(block, rf.quiet_motion(8.0), "rigid", initial=rf.InitialState(rotation=theta))
    # cos and cosh are flat at one: their inverses keep half of the digits that the slope leaves.
    assert response.impact_times[0] == pytest.approx(expected, rel=1e-11 if abs(slope) > 0.01 * 1.8e6 * 9.81 else 1e-9)


@pytest.mark.parametrize("stiffness", [0.3, 1.0, 5.0])
def test_a_large_rotation_falls_back_in_time(stiffness):
    """The complete rigid block by the quadrature of its energy, with chords for the tendons' lengths."""
    block = dataclasses.replace(
        BLOCK, elements=tuple(rf.Tendon(1e5, 0.5 * stiffness * 1.8e6 * 9.81 / 1.2**2, x) for x in (-0.8, 0.8))
    )
    start = 0.12

    def potential(theta: float) -> float:
        raised = 240e3 * 1.2 * math.sin(theta) + 1.8e6 * (math.cos(theta) - 1.0)
        held = 0.0
        for tendon in block.tendons:
            arm = 1.2 - tendon.position
            stretch = math.hypot(arm * (1.0 - math.cos(theta)), arm * math.sin(theta))
            held += tendon.initial_force * stretch + 0.5 * tendon.stiffness * stretch**2
        return 9.81 * raised + held

    top = potential(start)
    # θ = θ_0 - u² takes the root out of the integrand.
    expected, _ = quad(
        lambda u: 2.0 * u / math.sqrt(2.0 * (top - potential(start - u * u)) / block.i_theta) if u > 0 else 0.0,
        1e-9, math.sqrt(start), epsabs=1e-13, epsrel=1e-12,
    )  # fmt: skip
    response = rf.simulate(block, rf.quiet_motion(8.0), "rigid-C", initial=rf.InitialState(rotation=start))
    assert response.impact_times[0] == pytest.approx(expected, rel=2e-8)


def test_the_field_holds_the_gradient_of_the_tendons_energy():
    """V(θ) of a tendon from the coordinates of Eq. 3, differentiated by SymPy."""
    theta = sp.symbols("theta")
    force, stiffness, b, x = sp.Integer(200000), sp.Integer(3000000), sp.Rational(6, 5), sp.Rational(7, 10)
    for side in (1, -1):
        energy = 0
        for place in (x, -x):
            from_pivot = place - side * b
            moved = (from_pivot * sp.cos(theta) - from_pivot, -from_pivot * sp.sin(theta))
            stretch = sp.sqrt(moved[0] ** 2 + moved[1] ** 2)
            energy += force * stretch + stiffness * stretch**2 / 2
        gradient = sp.lambdify(theta, sp.diff(energy, theta))
        free = rf.RockingProperties([6.0, 25.0], [150e3, 30e3], [11.0, 3.0], [1.3, -0.5], 24e6, 1.8e6, 240e3, 1.2, 0.02)
        held = dataclasses.replace(free, elements=(rf.Tendon(200e3, 3e6, 0.7), rf.Tendon(200e3, 3e6, -0.7)))
        motion = np.array([0.05, -0.01, 0.3, 0.2, side * 0.2, -0.4, 0, 0, 0, 0])
        with_tendons, without = (rates_of(p, side, motion) for p in (held, free))
        d = motion[:2]
        inertia = 24e6 - free.effective_mass @ free.effective_height**2
        inertia += free.effective_mass @ (d**2 - 2.0 * side * 1.2 * d)
        spun = with_tendons[5] - without[5]
        assert spun * inertia == pytest.approx(-gradient(side * 0.2), rel=1e-11)
        np.testing.assert_allclose(with_tendons[2:4] - without[2:4], -free.effective_height * spun, rtol=1e-10)


def rates_of(properties: rf.RockingProperties, side: int, motion: np.ndarray) -> np.ndarray:
    return vector_field(RockingModel("MDOF-C", properties, complete=True), side).rates_at(motion, 1.7, 0.0)


@pytest.mark.parametrize("stiffness", [1.0, 1.011, 0.989, 1.1, 2.0])
def test_series_and_steps_agree_where_the_weight_is_balanced_or_nearly_so(stiffness):
    model = parse_model("MDOF-S").of(tied(stiffness, 1e5).rocking())
    assert not model.integrated
    exact = PreparedModel(model, Quantities.none(model.properties.n_modes)).run(EL_CENTRO.acceleration, EL_CENTRO.dt)
    other = RockingModel(model.label, model.properties, stepwise=True, law=model.law)
    integrated = PreparedModel(other, Quantities.none(other.properties.n_modes)).run(
        EL_CENTRO.acceleration, EL_CENTRO.dt
    )
    assert exact.n_impacts == integrated.n_impacts > 5
    assert exact.peaks[0] == pytest.approx(integrated.peaks[0], rel=2e-9)


@pytest.mark.parametrize("stiffness", [0.5, 1.0, 3.0])
def test_uplifted_frequencies_with_tendons(stiffness):
    p = tied(stiffness).rocking()
    modes = rf.uplifted_modes(p)
    scale = p.i_theta * p.omega[0] ** 2
    np.testing.assert_allclose(rf.frequency_equation(p, modes.omega[:2]) / scale, 0.0, atol=1e-7)
    if stiffness > 1.0:
        assert modes.growth_rate == 0.0
        # Below the first frequency on a fixed base the equation falls from k_r > 0 and crosses zero once.
        expected = brentq(lambda w: float(rf.frequency_equation(p, w)), 1e-6, p.omega[0] * (1.0 - 1e-9))
        assert modes.sway_rate == pytest.approx(expected, rel=1e-9)
    elif stiffness < 1.0:
        assert modes.growth_rate > 0.0
        assert modes.sway_rate == 0.0
