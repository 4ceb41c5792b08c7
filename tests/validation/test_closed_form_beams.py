"""Beams against closed forms, and against transfer matrices that share nothing with finite elements or Ritz shapes."""

import math

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize

import rockflex as rf

LENGTH, MASS, EI = 30.0, 800.0, 4e9
COMMON = {"height": LENGTH, "half_width": 2.0, "damping_ratio": 0.02}
CANTILEVER = np.array([1.875104068711961, 4.694091132974175, 7.854757438237613, 10.995540734875467, 14.137168391046471])


def beam(**changes):
    return rf.Beam(**({"mass": MASS, "bending_stiffness": EI} | COMMON | changes))


def transfer_frequencies(pieces, n, *, tip_mass=0.0, tip_rotary=0.0, highest=2000.0):
    """Frequencies of a cantilever of uniform pieces (length, m, EI, GA, J): zeros of what is left at a free tip."""

    def residual(omega):
        state = np.eye(4)[:, 2:]  # w, θ, M, V; clamped below
        for length, mass, bending, shear, rotary in pieces:
            # w' = θ + V/GA, θ' = M/EI, M' = -V - ω² J θ, V' = -ω² m w
            rates = np.zeros((4, 4))
            rates[0, 1], rates[0, 3] = 1.0, 1.0 / shear
            rates[1, 2] = 1.0 / bending
            rates[2, 1], rates[2, 3] = -(omega**2) * rotary, -1.0
            rates[3, 0] = -(omega**2) * mass
            state = scipy.linalg.expm(rates * length) @ state
        end = np.array([state[2] - omega**2 * tip_rotary * state[1], state[3] - omega**2 * tip_mass * state[0]])
        return np.linalg.det(end)

    found, low, step = [], 1e-3, 0.25
    value = residual(low)
    while len(found) < n and low < highest:
        high = low + step
        above = residual(high)
        if value * above < 0.0:
            found.append(scipy.optimize.brentq(residual, low, high, xtol=1e-12, rtol=1e-14))
        low, value = high, above
    return np.array(found)


def test_uniform_cantilever_by_finite_elements():
    exact = CANTILEVER**2 * math.sqrt(EI / MASS) / LENGTH**2
    np.testing.assert_allclose(beam().modal().omega, exact, rtol=1e-9)


def test_uniform_cantilever_participation():
    # Γ of mode 1 with top ordinate 1: 2 σ/λ with σ = 0.7340955 over φ(H) = 2; m*_1/m = (2 σ_1/λ_1)² = 0.6131.
    root = CANTILEVER
    sigma = (np.cosh(root) + np.cos(root)) / (np.sinh(root) + np.sin(root))
    props = beam().rocking()
    np.testing.assert_allclose(props.effective_mass / (MASS * LENGTH), (2.0 * sigma / root) ** 2, rtol=1e-8)
    np.testing.assert_allclose(props.effective_height / LENGTH, 1.0 / (sigma * root), rtol=1e-8)


def test_error_of_finite_elements_falls_with_the_fourth_power():
    exact = CANTILEVER**2 * math.sqrt(EI / MASS) / LENGTH**2
    errors = np.array([beam(n_elements=n).modal().omega / exact - 1.0 for n in (20, 40, 80)])
    orders = np.log2(errors[:-1] / errors[1:])
    print("relative errors of ω:\n", errors, "\norders:\n", orders)
    assert (errors > 0.0).all()  # from above, as every conforming element
    # The lowest mode is down at rounding.
    assert np.abs(orders[:, 1:] - 4.0).max() < 0.05


# The strain in shear is constant in an element, so the order is then the second.
@pytest.mark.parametrize(("shear_stiffness", "order"), [(None, 4.0), (lambda z: 4e8 * (2.0 - z / LENGTH), 2.0)])
def test_order_with_varying_sections(shear_stiffness, order):
    def omega(n):
        return beam(
            mass=lambda z: MASS * (2.0 - z / LENGTH),
            bending_stiffness=lambda z: EI * (2.0 - z / LENGTH) ** 3,
            shear_stiffness=shear_stiffness,
            n_elements=n,
        ).modal().omega  # fmt: skip

    finest = omega(1280)
    errors = np.array([omega(n) / finest - 1.0 for n in (20, 40, 80)])
    orders = np.log2(errors[:-1] / errors[1:])
    print("relative errors of ω:\n", errors, "\norders:\n", orders)
    assert (errors > 0.0).all()
    assert np.abs(orders[:, 2:] - order).max() < 0.1


def test_many_elements_keep_their_digits():
    exact = CANTILEVER**2 * math.sqrt(EI / MASS) / LENGTH**2
    np.testing.assert_allclose(beam(n_elements=8000).modal().omega, exact, rtol=1e-8)


def test_shear_beam():
    stiffness = 3e7
    stiff = beam(bending_stiffness=1e9 * stiffness * LENGTH**2, shear_stiffness=stiffness)
    exact = (2.0 * np.arange(1, 6) - 1.0) * math.pi / 2.0 / LENGTH * math.sqrt(stiffness / MASS)
    np.testing.assert_allclose(stiff.modal().omega, exact, rtol=1.1e-5)
    props = stiff.rocking()
    root = exact * LENGTH / math.sqrt(stiffness / MASS)
    np.testing.assert_allclose(props.effective_mass / (MASS * LENGTH), 2.0 / root**2, rtol=1e-6)


@pytest.mark.parametrize("rotary", [1e-9, 900.0])
def test_timoshenko_beam(rotary):
    shear = 5e7
    expected = transfer_frequencies([(LENGTH, MASS, EI, shear, rotary)], 4)
    found = beam(shear_stiffness=shear, rotary_inertia=rotary).modal(4).omega
    np.testing.assert_allclose(found, expected, rtol=5e-6)


def test_rotary_inertia_in_bending():
    expected = transfer_frequencies([(LENGTH, MASS, EI, 1e30, 20e3)], 4)
    for method in ("fe", "ritz"):
        found = beam(rotary_inertia=20e3, method=method, shapes=power_shapes(12) if method == "ritz" else None)
        np.testing.assert_allclose(found.modal(4).omega, expected, rtol=1e-6)


def test_steps_and_bodies_along_the_height():
    lower, upper = (12.0, 900.0, 6e9, 8e7, 30.0), (18.0, 500.0, 2e9, 3e7, 10.0)
    expected = transfer_frequencies([lower, upper], 3, tip_mass=5e3, tip_rotary=40e3)

    def steps(i):
        return ([0.0, 12.0, 12.0, 30.0], [lower[i], lower[i], upper[i], upper[i]])

    found = beam(
        mass=steps(1),
        bending_stiffness=steps(2),
        shear_stiffness=steps(3),
        rotary_inertia=steps(4),
        lumped_masses=rf.LumpedMasses([LENGTH], [5e3], [40e3]),
    )
    np.testing.assert_allclose(found.modal(3).omega, expected, rtol=2e-6)


def power_shapes(n):
    """Polynomials of Legendre times z², well apart up to high degrees."""
    squared = np.polynomial.Polynomial([0.0, 0.0, 1.0])
    rows = []
    for j in range(n):
        legendre = np.polynomial.Legendre.basis(j, domain=[0.0, LENGTH]).convert(kind=np.polynomial.Polynomial)
        rows.append(squared * legendre / LENGTH**2)

    def columns(order):
        return lambda z: np.column_stack([(p.deriv(order) if order else p)(z) for p in rows])

    return rf.RitzShapes(columns(0), columns(1), columns(2))


def test_ritz_converges_from_above():
    exact = CANTILEVER[:3] ** 2 * math.sqrt(EI / MASS) / LENGTH**2
    errors = [beam(method="ritz", shapes=power_shapes(n), n_modes=3).modal().omega / exact - 1.0 for n in (3, 5, 7, 10)]
    print("relative errors of ω by Ritz:\n", np.array(errors))
    assert (np.diff(errors, axis=0) < 1e-12).all()
    assert (np.array(errors) > -1e-10).all()
    np.testing.assert_allclose(errors[-1], 0.0, atol=1e-6)


def test_rayleigh_quotient_by_hand():
    one = rf.RitzShapes(lambda z: z[:, None] ** 2, lambda z: 2.0 * z[:, None], lambda z: np.full((z.size, 1), 2.0))
    body = rf.LumpedMasses([LENGTH / 2.0], [6e3])
    props = beam(method="ritz", shapes=one, n_modes=1, lumped_masses=body).rocking()
    mass = MASS * LENGTH**5 / 5.0 + 6e3 * (LENGTH / 2.0) ** 4
    moved = MASS * LENGTH**3 / 3.0 + 6e3 * (LENGTH / 2.0) ** 2
    turned = MASS * LENGTH**4 / 4.0 + 6e3 * (LENGTH / 2.0) ** 3
    assert props.omega[0] == pytest.approx(math.sqrt(4.0 * EI * LENGTH / mass), rel=1e-12)
    assert props.effective_mass[0] == pytest.approx(moved**2 / mass, rel=1e-12)
    assert props.effective_height[0] == pytest.approx(turned / moved, rel=1e-12)
    assert props.l0r == pytest.approx(MASS * LENGTH**2 / 2.0 + 6e3 * LENGTH / 2.0, rel=1e-12)
    assert props.translational_inertia == pytest.approx(MASS * LENGTH**3 / 3.0 + 6e3 * LENGTH**2 / 4.0, rel=1e-12)


@pytest.mark.parametrize("shear_stiffness", [None, 2e7])
def test_few_elements_are_exact_under_a_force_at_the_tip(shear_stiffness):
    # A column of nearly no mass: 1/k = H³/(3 EI) + H/(GA_s).
    tip = rf.LumpedMasses([LENGTH], [1e6])
    light = beam(mass=1e-4, n_modes=1, n_elements=1, shear_stiffness=shear_stiffness, lumped_masses=tip)
    softness = LENGTH**3 / (3.0 * EI) + (LENGTH / shear_stiffness if shear_stiffness else 0.0)
    assert light.modal().omega[0] == pytest.approx(1.0 / math.sqrt(softness * 1e6), rel=1e-8)
