"""Impact laws: what they do to the masses, what they cost, and that models apply them as they say."""

import math
import re

import numpy as np
import pytest

from builders import make_frame
from rockflex import AngularMomentum, ImpactLaw, InputError, PivotImpulse, Restitution, VVELComplete, VVELSimplified
from rockflex.models._impact import SidedRestitution, UnsavedLaw
from rockflex.models._landing import velocities_after
from rockflex.models._nonlinear_ground_system import nonlinear_system
from rockflex.models._quantities import Quantities
from rockflex.models._rocking_model import RockingModel

FRAME = make_frame(n_stories=4, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=6.0)
ALL = FRAME.rocking()
HEIGHTS, MASSES = 3.0 * np.arange(1.0, 5.0), np.full(4, 40e3)


class Mine:
    """A law of the user's own: half of the rotation goes on, and the modes are halved."""

    keeps, loses = "half", "the other half"

    def __repr__(self):
        return "Mine()"

    def after(self, properties, modal_velocity, rotation_velocity):
        return 0.5 * modal_velocity, 0.5 * rotation_velocity


LAWS = [
    VVELSimplified(),
    VVELComplete(),
    Restitution(0.0),
    Restitution(0.35),
    Restitution(1.0, shortest_excursion=0.02),
    SidedRestitution(Restitution(0.8), Restitution(0.3)),
    AngularMomentum(),
    AngularMomentum(0.6),
    PivotImpulse(),
    Mine(),
]


def draw(n, seed):
    """A state at an impact, θ = 0."""
    state = np.random.default_rng(seed).standard_normal(2 * n + 2)
    state[-2] = 0.0
    return state


def energy(p, state):
    """½ I_θ θ'² + θ' Σ m* h* D' + ½ Σ m* D'², the kinetic energy at D = 0."""
    n = p.n_modes
    v, spin = state[n : 2 * n], state[-1]
    mixed = spin * (p.effective_mass * p.effective_height) @ v
    return 0.5 * p.i_theta * spin**2 + mixed + 0.5 * p.effective_mass @ v**2


class Leaning(Mine):
    """The same law, which also depends on where the masses are."""

    def after(self, properties, modal_velocity, rotation_velocity, modal_displacement):
        return 0.5 * modal_velocity + 0.1 * modal_displacement, 0.5 * rotation_velocity


def landed(law, p, state, *displacement):
    velocity, spin = law.after(p, state[p.n_modes : 2 * p.n_modes], state[-1], *displacement)
    return np.concatenate((state[: p.n_modes], velocity, [0.0, spin]))


def applied(law, p, state, onward=1.0):
    """What a model makes of a state at an impact, under ground that drives the rotation on or, if -1, back."""
    model, n = RockingModel("mine", p, law=law, complete=True), p.n_modes
    phase = nonlinear_system(model, Quantities.none(n)).phase(model.start(1 if state[-1] < 0.0 else -1))
    (impact,) = (event for event in phase.events if event.name == "impact")
    full = np.concatenate((state, np.zeros(model.layout.size - state.size)))
    push = -onward * math.copysign(1e6, state[-1])  # m/s²
    if hasattr(impact.jump, "apply_at"):
        assert impact.jump.apply_at(full, push, 0.0) >= 0
    else:
        full, _ = impact.jump(full, push, 0.0)
    return full[: 2 * n + 2]


@pytest.mark.parametrize("law", LAWS, ids=repr)
@pytest.mark.parametrize("n", [0, 1, 2, 4])
def test_models_do_what_the_laws_say(law, n):
    p = ALL.truncated(n)
    for seed in range(20):
        before = draw(n, seed)
        before[:n] = 0.0
        np.testing.assert_allclose(applied(law, p, before), landed(law, p, before), rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("law", [AngularMomentum(), AngularMomentum(0.6), PivotImpulse(), Leaning()], ids=repr)
@pytest.mark.parametrize("n", [1, 4])
def test_complete_models_tell_the_laws_where_the_masses_are(law, n):
    p = ALL.truncated(n)
    for seed in range(20):
        before = draw(n, seed)
        before[:n] *= 0.01
        found, expected = applied(law, p, before), landed(law, p, before, before[:n])
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)
        bare = landed(law, p, before, 0.0 * before[:n])
        assert isinstance(law, AngularMomentum) or not np.array_equal(bare, expected) or expected[-1] == 0.0


@pytest.mark.parametrize("n", [0, 1, 2, 4])
def test_an_excursion_too_short_to_count_sticks_as_the_simplified_law(n):
    p = ALL.truncated(n)
    before = draw(n, 1)
    before[:n] = 0.0
    for law in (Restitution(0.7, shortest_excursion=1e9), SidedRestitution(*[Restitution(0.7, 1e9)] * 2)):
        found = applied(law, p, before, onward=-1.0)
        np.testing.assert_allclose(found, landed(VVELSimplified(), p, before), rtol=1e-13, atol=1e-14)


def test_the_kinetic_energy_is_that_of_the_masses():
    """Of each mass, across h_i θ' + u'_i and upward B θ', and of the base."""
    for seed in range(10):
        state = draw(4, seed)
        spin = state[-1]
        across = HEIGHTS * spin + ALL.floors.displacement @ state[4:8]
        expected = 0.5 * MASSES @ across**2 + 0.5 * ALL.m_tot * (ALL.half_width * spin) ** 2
        assert energy(ALL, state) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("law", [VVELSimplified(), VVELComplete(), Restitution(0.6)], ids=repr)
def test_with_all_modes_every_mass_keeps_its_horizontal_velocity(law):
    before = draw(4, 5)
    after = landed(law, ALL, before)
    across = [HEIGHTS * state[-1] + ALL.floors.displacement @ state[4:8] for state in (before, after)]
    np.testing.assert_allclose(across[1], across[0], rtol=1e-10)


def test_one_mode_by_equation_29():
    p = ALL.truncated(1)
    (m,), (h,) = p.effective_mass, p.effective_height
    signs = set()
    for seed in range(30):
        before = draw(1, seed)
        v, spin = before[1], before[-1]
        sign = math.copysign(1.0, v + h * spin)
        signs.add(sign)
        root = math.sqrt(spin**2 * float(MASSES @ HEIGHTS**2) / m + 2.0 * h * spin * v + v**2)
        assert landed(VVELComplete(), p, before)[1] == pytest.approx(sign * root, rel=1e-13)
    assert signs == {-1.0, 1.0}


def test_equation_19_holds_for_any_number_of_modes():
    for n in (1, 2, 3, 4):
        p = ALL.truncated(n)
        before = draw(n, n)
        after, _ = VVELComplete().after(p, before[n : 2 * n], before[-1])
        plain, _ = VVELSimplified().after(p, before[n : 2 * n], before[-1])
        lever = p.effective_mass * p.effective_height
        horizontal = before[-1] ** 2 * float(MASSES @ HEIGHTS**2)
        horizontal += 2.0 * before[-1] * lever @ before[n : 2 * n] + p.effective_mass @ before[n : 2 * n] ** 2
        assert p.effective_mass @ after**2 == pytest.approx(horizontal, rel=1e-12)
        np.testing.assert_allclose(after / plain, after[0] / plain[0], rtol=1e-13)  # one factor for all
        factor = after[0] / plain[0]
        assert factor == pytest.approx(1.0, abs=1e-11) if n == 4 else factor > 1.0 + 1e-7


def test_where_no_mode_moves_after_the_impact_none_does():
    """D' = -h* θ', with numbers whose products are exact."""
    p = ALL.truncated(1)
    spin = 0.25
    before = np.array([0.1, -p.effective_height[0] * spin, 0.0, spin])
    assert landed(VVELComplete(), p, before)[1] == 0.0
    assert applied(VVELComplete(), p, before).tolist() == [0.1, 0.0, 0.0, 0.0]


@pytest.mark.parametrize("n", [1, 2, 4])
@pytest.mark.parametrize("e", [0.0, 0.4, 1.0])
def test_what_an_impact_costs(n, e):
    """The losses of docs/design/0005-complete-models.md at D = 0."""
    p = ALL.truncated(n)
    seen = float(p.effective_mass @ p.effective_height**2)
    horizontal = float(MASSES @ HEIGHTS**2)
    for seed in range(10):
        before = draw(n, seed)
        half = 0.5 * before[-1] ** 2
        losses = {
            VVELSimplified(): half * (p.i_theta - seen),
            VVELComplete(): half * (p.i_theta - horizontal),
            Restitution(e): half * (1.0 - e * e) * (p.i_theta - seen),
        }
        for law, loss in losses.items():
            after = landed(law, p, before)
            assert energy(p, before) - energy(p, after) == pytest.approx(loss, rel=1e-9, abs=1e-9 * energy(p, before))
            assert loss >= 0.0
    if n == 4:  # no rotary inertia: the vertical velocities of all masses, and no more
        assert p.i_theta - horizontal == pytest.approx(p.m_tot * p.half_width**2, rel=1e-9)


def test_no_restitution_is_the_simplified_law():
    for n in (0, 1, 4):
        p, before = ALL.truncated(n), draw(n, 7)
        one, other = landed(Restitution(0.0), p, before), landed(VVELSimplified(), p, before)
        assert np.array_equal(one, other)
        before[:n] = 0.0
        assert np.array_equal(applied(Restitution(0.0), p, before), applied(VVELSimplified(), p, before))


def test_the_laws_of_the_library_are_values():
    assert VVELSimplified() == VVELSimplified()
    assert Restitution(0.5) == Restitution(0.5, 1e-4)
    assert Restitution(np.float32(0.5)).e == 0.5
    assert type(Restitution(1).e) is float
    assert len({VVELSimplified(), VVELComplete(), Restitution(0.5), Restitution(0.5)}) == 3
    with pytest.raises(AttributeError):
        Restitution(0.5).e = 0.6
    for law in (*LAWS, UnsavedLaw("Mine()", "a", "b")):
        assert isinstance(law, ImpactLaw)
        assert law.keeps
        assert law.loses
    assert not isinstance("law", ImpactLaw)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ((-0.1,), "e must lie in [0, 1], but -0.1 was given."),
        ((1.0000001,), "e must lie in [0, 1], but 1.0000001 was given. It is the ratio"),
        ((0.5, "brief"), "shortest_excursion must be a number in s, but 'brief' was given."),
    ],
)
def test_restitutions_that_are_none(arguments, text):
    with pytest.raises(InputError, match=re.escape(text)):
        Restitution(*arguments)


def test_a_forgotten_law_says_so():
    law = UnsavedLaw("<Mine at 0x1>", "this", "that")
    with pytest.raises(InputError) as caught:
        law.after(ALL, np.zeros(4), 1.0)
    assert str(caught.value) == ("The impact law <Mine at 0x1> was not saved with the response. Pass the law itself.")


class Odd:
    keeps, loses = "", ""

    def __init__(self, answer):
        self.answer = answer

    def after(self, properties, modal_velocity, rotation_velocity):
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


@pytest.mark.parametrize(
    ("answer", "text"),
    [
        (ArithmeticError("no idea"), "no idea"),
        (None, "after must return the modal velocities in m/s and the rotation velocity in rad/s, but it returned"),
        (([1.0], 0.0), "The modal velocity after an impact must have 2 values, but 1 were returned."),
        ((1.0, 0.0), "the modal velocity after an impact must be one-dimensional, but an array of shape () was given."),
        (([1.0, math.nan], 0.0), "the modal velocity after an impact must be finite, but 1 of 2 values are not"),
        (("fast", 0.0), "the modal velocity after an impact must be a sequence of numbers in m/s, but str was given."),
        (([1.0, 2.0], math.inf), "the rotation velocity after an impact must be a finite number in rad/s, but inf"),
        (([1.0, 2.0], None), "the rotation velocity after an impact must be a finite number in rad/s, but None"),
    ],
)
def test_what_a_law_may_not_answer(answer, text):
    with pytest.raises(InputError, match="The impact law Odd failed: ") as caught:
        velocities_after(Odd(answer), ALL.truncated(2), np.zeros(2), 1.0)
    assert text in str(caught.value)


def test_a_law_is_given_copies():
    class Careless(Mine):
        def after(self, properties, modal_velocity, rotation_velocity):
            modal_velocity[:] = np.nan
            return [0.1, 0.2], 0.0

    before = np.array([1.0, 2.0])
    velocity, spin = velocities_after(Careless(), ALL.truncated(2), before, 3.0)
    assert (velocity.tolist(), spin, before.tolist()) == ([0.1, 0.2], 0.0, [1.0, 2.0])
