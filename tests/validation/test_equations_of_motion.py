"""The equations of motion, derived anew by machine (Silva & Stojadinović 2024, Eqs. 3-16, 19, 21, 22 and 25).

SymPy starts from the coordinates of two or three lumped masses, arrives at what the paper prints, and is then
compared in numbers with what the models compute.
"""

import numpy as np
import pytest
import sympy as sp

from builders import vector_field
from rockflex import RockingProperties
from rockflex.models._reactions import reactions
from rockflex.models._rocking_model import RockingModel
from rockflex.models._values_at_states import accelerations_at_states
from twins.lagrange import GRAVITY, GROUND, derived, lumped, orthogonal


def right_hand_side(properties, side, a, state):
    """(D'', θ'') of the complete model from [D, D', θ, θ'] on a side: what is under test."""
    model, n = RockingModel("MDOF-C", properties, complete=True), properties.n_modes
    rates = vector_field(model, side).rates_at(np.append(state, np.zeros(model.layout.size - state.size)), a, 0.0)
    return rates[n : 2 * n], rates[2 * n + 1]


def ground_forces(properties, side, a, state):
    """(F_x, F_z) that the ground gives the base, in N: what is under test."""
    model = RockingModel("MDOF-C", properties, complete=True)
    nodes = np.array([[0.0, side, a, 0.0, *state, *np.zeros(model.layout.size - state.size)]])
    forces = reactions(model, nodes, accelerations_at_states(model, nodes))
    return np.array([forces.horizontal[0], forces.vertical[0]])


BOTH = pytest.mark.parametrize("side", [1, -1])
COUNTS = pytest.mark.parametrize("count", [2, 3])
G = 9.81


def rocking(s):
    given = s.properties()
    return RockingProperties(
        **{k: [float(x) for x in v] if isinstance(v, list) else float(v) for k, v in given.items()}
    )


def vanishes(expression, turn):
    return sp.expand(sp.expand(expression).subs(sp.cos(turn) ** 2, 1 - sp.sin(turn) ** 2)) == 0


@pytest.mark.slow
@COUNTS
@BOTH
def test_lagrange_gives_equations_11_and_12(count, side):
    s, motion = lumped(count), derived(count, side)
    (theta, *q), (spin, *v), (turn, *w) = motion.x, motion.rates, motion.accelerations
    sin, cos, b = sp.sin(theta), sp.cos(theta), side * s.half_width
    eleven = 0
    rows = [[0] * count, *s.shapes.tolist()]
    for m, h, row in zip([s.base_mass, *s.masses], [0, *s.heights], rows, strict=True):
        u, du, ddu = (sum(f * c for f, c in zip(row, values, strict=True)) for values in (q, v, w))
        eleven -= m * GRAVITY * (b * cos - h * sin - cos * u) + m * GROUND * (b * sin + h * cos - sin * u)
        eleven -= m * (turn * (b**2 + h**2) - turn * 2 * b * u - spin * 2 * b * du + h * ddu)
        # Σ φ² q², and not (Σ φ q)²: equal by orthogonality in the sum over masses alone.
        eleven -= m * sum(f**2 * (turn * c**2 + 2 * spin * c * dc) for f, c, dc in zip(row, q, v, strict=True))
    assert vanishes(eleven - motion.equations[0], theta)
    for n in range(count):
        elastic = s.omega[n] ** 2 * q[n] + 2 * s.zeta * s.omega[n] * v[n]
        twelve = s.excitation[n] * (-b * spin**2 + GRAVITY * sin - GROUND * cos) - s.tilt[n] * turn
        twelve += s.modal_mass[n] * (spin**2 * q[n] - elastic - w[n])
        assert vanishes(twelve - motion.equations[1 + n], theta)


@pytest.mark.slow
@COUNTS
@BOTH
def test_lagrange_gives_equations_13_and_14(count, side):
    s, motion = lumped(count), derived(count, side)
    p, gamma = s.properties(), s.participation
    m, h, total = p["effective_mass"], p["effective_height"], p["m_tot"]
    theta, spin, turn = motion.x[0], motion.rates[0], motion.accelerations[0]
    d, v, w = (sp.symbols(f"{name}1:{count + 1}") for name in ("D", "D_t", "D_tt"))
    scaled = {}
    for old, new in ((motion.x, d), (motion.rates, v), (motion.accelerations, w)):
        scaled.update({old[1 + n]: gamma[n] * new[n] for n in range(count)})
    sin, cos, b = sp.sin(theta), sp.cos(theta), side * s.half_width
    thirteen = p["i_theta"] * turn + total * b * (GRAVITY * cos + GROUND * sin)
    thirteen += p["l0r"] * (GROUND * cos - GRAVITY * sin)
    for n in range(count):
        thirteen += m[n] * (turn * d[n] * (d[n] - 2 * b) + h[n] * w[n] + 2 * spin * v[n] * (d[n] - b))
        thirteen -= m[n] * d[n] * (GRAVITY * cos + GROUND * sin)
    assert vanishes(motion.equations[0].subs(scaled) + thirteen, theta)
    for n in range(count):
        fourteen = h[n] * turn + w[n] + 2 * s.zeta * s.omega[n] * v[n] + s.omega[n] ** 2 * d[n]
        fourteen += spin**2 * (b - d[n]) - GRAVITY * sin + GROUND * cos
        assert vanishes(motion.equations[1 + n].subs(scaled) + s.excitation[n] * fourteen, theta)


def random_states(count, side, seed, draws=20):
    """[D, D', θ, θ'] and a, far beyond what a structure would bear."""
    rng = np.random.default_rng(seed)
    for _ in range(draws):
        modes = np.concatenate([rng.uniform(-0.9, 0.9, count), rng.uniform(-3.0, 3.0, count)])
        yield np.append(modes, [side * rng.uniform(0.0, 1.5), rng.uniform(-2.0, 2.0)]), rng.uniform(-12.0, 12.0)


def generalised(s, turning, modal):
    """(θ, q_1, ..) from θ and D_n, or their derivatives."""
    return np.append(turning, np.array(s.participation, float) * modal)


def coordinates(s, state):
    n = s.n
    return generalised(s, state[-2], state[:n]), generalised(s, state[-1], state[n : 2 * n])


@COUNTS
@BOTH
def test_models_follow_the_derived_equations(count, side):
    s, motion = lumped(count), derived(count, side)
    terms = sp.Matrix(motion.equations)
    inertia = motion.numbers(terms.jacobian(motion.accelerations))
    rest = motion.numbers(terms.subs(dict.fromkeys(motion.accelerations, 0)))
    for state, a in random_states(count, side, seed=3):
        given = (*coordinates(s, state), np.zeros(count + 1), a, G)
        expected = -np.linalg.solve(inertia(*given), rest(*given)[:, 0])
        modes, turn = right_hand_side(rocking(s), side, a, state)
        actual = generalised(s, turn, modes)
        np.testing.assert_allclose(actual, expected, rtol=1e-10, atol=1e-10 * abs(expected).max())


@COUNTS
@BOTH
def test_ground_forces_are_those_of_the_masses(count, side):
    s, motion = lumped(count), derived(count, side)
    forces = motion.numbers(sp.Matrix(motion.forces))
    for state, a in random_states(count, side, seed=4):
        modes, turn = right_hand_side(rocking(s), side, a, state)
        expected = forces(*coordinates(s, state), generalised(s, turn, modes), a, G)[:, 0]
        actual = ground_forces(rocking(s), side, a, state)
        np.testing.assert_allclose(actual, expected, rtol=1e-10, atol=1e-10 * abs(expected).max())


@COUNTS
def test_ground_forces_in_contact(count):
    s, motion, p = lumped(count), derived(count, 1), rocking(lumped(count))
    forces = motion.numbers(sp.Matrix(motion.forces))
    for state, a in random_states(count, 1, seed=5):
        state[-2:] = 0.0
        modes = -a - p.omega**2 * state[:count] - 2.0 * p.zeta * p.omega * state[count:-2]  # Eq. 15
        expected = forces(*coordinates(s, state), generalised(s, 0.0, modes), a, G)[:, 0]
        actual = ground_forces(p, 0, a, state)
        np.testing.assert_allclose(actual, expected, rtol=1e-10, atol=1e-10 * abs(expected).max())
        assert actual[1] == pytest.approx(p.m_tot * G, rel=1e-12)


@COUNTS
@BOTH
def test_base_accelerates_upward_where_equation_16_holds(count, side):
    p = rocking(lumped(count))
    lever = p.effective_mass * p.effective_height
    met = []
    for state, a in random_states(count, side, seed=6, draws=100):
        state[-2:] = 0.0
        d, v = state[:count], state[count:-2]
        moment = lever @ (-a - p.omega**2 * d - 2.0 * p.zeta * p.omega * v) + p.l0r * a
        holds = -side * moment > p.m_tot * G * p.half_width - side * G * (p.effective_mass @ d)
        assert (side * right_hand_side(p, side, a, state)[1] > 0.0) == holds
        met.append(holds)
    assert 10 < sum(met) < 90


@pytest.mark.slow
@COUNTS
def test_all_modes_together_have_the_inertia_of_the_masses(count):
    """Σ m*_n h*_n² = Σ m_i h_i² as quadratic forms in the heights, for any masses and whatever modes fit them."""
    masses = sp.Matrix(sp.symbols(f"m1:{count + 1}", positive=True))
    free = sp.symbols("f1:3")
    rows = [[1, free[0]], [1, 0]] if count == 2 else [[1, free[0], free[1]], [1, -1, 2], [0, 0, 1]]
    shapes, diagonal = orthogonal(rows, masses), sp.diag(*masses)
    form = sp.zeros(count)
    for n in range(count):
        column = diagonal * shapes[:, n]  # L_n^θ is this times h, and m*_n h*_n² = (L_n^θ)² / M_n
        form += column * column.T / (shapes[:, n].T * column)[0]
    assert (form - diagonal).applyfunc(sp.cancel) == sp.zeros(count)


@COUNTS
def test_equation_25_leaves_of_equation_19_the_inertia_that_the_modes_lack(count):
    m, h, before = (sp.symbols(f"{name}1:{count + 1}") for name in ("m", "h", "D_t"))
    spin, horizontal = sp.symbols("theta_t I_h")
    left = right = lack = 0
    for n in range(count):
        left += m[n] * (h[n] * spin + before[n]) ** 2
        right += 2 * spin * m[n] * h[n] * before[n] + m[n] * before[n] ** 2
        lack += m[n] * h[n] ** 2
    assert sp.expand(right + spin**2 * horizontal - left - spin**2 * (horizontal - lack)) == 0
