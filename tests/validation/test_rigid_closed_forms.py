"""The rigid block against closed forms: quarter period, overturning by pulses, overturning spectra, decay of the peaks.

In p² = L g/I_θ, α = m_tot B/L and φ = θ/α the linearised block moves by φ'' = p² (φ - s - a/(g α)). The pulses'
thresholds follow from the growing part of φ, which must vanish; the decay from 1 - (1 - φ)², the squared speed
at impact in units of p α, of which an impact leaves η².
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import rockflex as rf

G = 9.81
STEP = 0.01
MASS, HALF_WIDTH, FIRST_MOMENT, INERTIA = 1.4e5, 0.8, 9e5, 1.1e7
RATE = math.sqrt(FIRST_MOMENT * G / INERTIA)
ALPHA = MASS * HALF_WIDTH / FIRST_MOMENT


def block(i_theta=INERTIA, l0r=FIRST_MOMENT, m_tot=MASS, half_width=HALF_WIDTH):
    return rf.RockingProperties(
        omega=[],
        effective_mass=[],
        effective_height=[],
        top_ordinate=[],
        i_theta=i_theta,
        l0r=l0r,
        m_tot=m_tot,
        half_width=half_width,
        zeta=[],
    )


def released(rotation, duration, model="rigid", impact=None, structure=None):
    """The history of a block let go at a rotation, on quiet ground."""
    start = rf.InitialState(rotation=rotation)
    motion = rf.quiet_motion(duration, STEP)
    structure = structure or block()
    return rf.simulate(structure, motion, model=model, output="history", initial=start, impact=impact).history


def impacts(history):
    """Indices of the nodes just before each impact; the node just after is the next one."""
    side = history.side
    return np.flatnonzero((side[:-1] != 0.0) & (side[1:] != side[:-1]))


@pytest.mark.parametrize("fraction", [0.01, 0.2, -0.7, 0.999])
def test_quarter_period(fraction):
    history = released(fraction * ALPHA, 12.0)
    expected = math.acosh(1.0 / (1.0 - abs(fraction))) / RATE
    assert history.time[impacts(history)[0]] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("rotation", [0.02, -0.1])
def test_quarter_period_at_full_trigonometry(rotation):
    history = released(rotation, 10.0, model="rigid-C")
    top = abs(rotation)

    def time(x):  # θ = θ_0 - x², which takes away the pole at the start
        low = 0.5 * x**2
        middle = top - low
        gained = MASS * HALF_WIDTH * math.cos(middle) - FIRST_MOMENT * math.sin(middle)
        return 2.0 * x / math.sqrt(4.0 * G * gained * math.sin(low) / INERTIA) if x else 0.0

    expected = quad(time, 1e-9, math.sqrt(top), epsabs=0.0, epsrel=1e-10)[0]
    assert history.time[impacts(history)[0]] == pytest.approx(expected, rel=1e-7)


def test_energy_at_full_trigonometry():
    history = released(0.9 * math.atan(ALPHA), 12.0, model="rigid-C", impact=rf.Restitution(0.9))
    turn, spin, side = history.rotation, history.rotation_velocity, history.side
    raised = MASS * G * HALF_WIDTH * side * np.sin(turn) - 2.0 * FIRST_MOMENT * G * np.sin(0.5 * turn) ** 2
    energy = 0.5 * INERTIA * spin**2 + raised
    hits = impacts(history)
    assert hits.size >= 2
    bounds = [0, *(hits + 1), energy.size]
    for k, (first, last) in enumerate(pairwise(bounds)):
        np.testing.assert_allclose(energy[first:last], energy[0] * 0.81**k, rtol=1e-9)


@pytest.mark.parametrize(("share", "status"), [(1.0 - 1e-7, "rocking"), (1.0 + 1e-7, "overturned")])
@pytest.mark.parametrize(("model", "balance"), [("rigid", ALPHA), ("rigid-C", math.atan(ALPHA))])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_unstable_balance(model, balance, share, status, sign):
    start = rf.InitialState(rotation=sign * share * balance)
    response = rf.simulate(block(), rf.quiet_motion(30.0, 0.02), model=model, output="peaks", initial=start)
    assert response.status == status
    if status == "overturned":
        assert response.max_rotation == math.pi / 2
    else:
        assert response.max_rotation == sign * start.rotation
        assert response.n_impacts >= 1


def half_sine(r, frequency):
    return math.sqrt(r**2 - 1) + r * math.exp(-(math.pi - math.asin(1 / r)) / frequency) - frequency


def full_sine(r, frequency):
    return math.sqrt(r**2 - 1) - r * math.exp(-(2 * math.pi - math.asin(1 / r)) / frequency) - frequency


THRESHOLDS = [
    (half_sine, 2.0, 1.800724),
    (half_sine, 5.0, 3.289147),
    (half_sine, 10.0, 5.786522),
    (full_sine, 2.0, 2.349903),
    (full_sine, 3.0, 3.631150),
    (full_sine, 5.0, 7.168129),
]


def pulse(form, frequency, r, samples=4000):
    amplitude, half = r * G * ALPHA, math.pi / (frequency * RATE)
    if form is half_sine:
        return rf.half_sine_pulse(amplitude, half, dt=half / samples)
    return rf.one_sine_pulse(amplitude, 2.0 * half, dt=2.0 * half / samples)


def after_pulse(motion, rest):
    """Peaks of a block that sticks at its first impact: it overturns before, or never."""
    return rf.simulate(block(), motion, model="rigid", output="peaks", free_vibration=rest, impact=STICKS)


@pytest.mark.parametrize(("form", "frequency", "printed"), THRESHOLDS)
def test_printed_thresholds_solve_their_equations(form, frequency, printed):
    assert brentq(form, 1.0, 100.0, args=(frequency,), xtol=1e-13) == pytest.approx(printed, abs=5.1e-7)


@pytest.mark.parametrize(("form", "frequency", "printed"), THRESHOLDS)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_least_sine_pulse_that_overturns(form, frequency, printed, sign):
    def run(r):
        return after_pulse(pulse(form, frequency, sign * r), 30.0 / RATE)

    over, back = run(printed + 3e-6), run(printed - 3e-6)
    assert (over.status, over.n_impacts) == ("overturned", 0)
    assert back.n_impacts >= 1
    assert back.status == "rocking"


BLOCK = rf.rigid_block(0.18, 2.0)
STICKS = rf.Restitution(0.0)  # no rotation is left after an impact, so it overturns before it, or never
PULSES = {  # of an amplitude and a whole period
    half_sine: lambda a, t: rf.half_sine_pulse(a, t / 2, t / 2 / 4000),
    full_sine: lambda a, t: rf.one_sine_pulse(a, t, t / 4000),
}


def thresholds(form, frequencies):
    return [brentq(form, 1.0, 100.0, args=(each,), xtol=1e-13) for each in frequencies]


@pytest.mark.slow
@pytest.mark.parametrize(("form", "ratios"), [(half_sine, [2.0, 5.0, 10.0]), (full_sine, [2.0, 3.0, 5.0])])
def test_an_overturning_spectrum_without_impact_is_the_closed_form(form, ratios):
    with pytest.warns(UserWarning, match="small rotations"):
        table = rf.overturning_spectrum(BLOCK, PULSES[form], ratios, "rigid", impact=STICKS, tolerance=1e-8)
    # The pulse is piecewise linear: its amplitude is short by some (2 π/steps)²/12.
    np.testing.assert_allclose(table["lowest"], thresholds(form, ratios), rtol=2e-6)
    assert (table["impacts"] == 0).all()
    np.testing.assert_allclose(table["highest_standing"], table["lowest"], rtol=1e-7)


def test_with_housners_impact_the_upper_boundary_is_the_one_without_impact():
    with pytest.warns(UserWarning, match="small rotations"):
        table = rf.overturning_spectrum(BLOCK, PULSES[full_sine], [3.0, 5.0], "rigid", tolerance=1e-8)
    np.testing.assert_allclose(table["highest_standing"], thresholds(full_sine, [3.0, 5.0]), rtol=2e-6)
    assert (table["lowest"] < 0.5 * table["highest_standing"]).all()


@pytest.mark.slow
def test_a_half_sine_overturns_without_impact_whatever_the_impact():
    with pytest.warns(UserWarning, match="small rotations"):
        stuck, rocking = (
            rf.overturning_spectrum(BLOCK, PULSES[half_sine], [2.0, 5.0], "rigid", impact=law) for law in (STICKS, None)
        )
    np.testing.assert_allclose(stuck["lowest"], rocking["lowest"], rtol=2e-6)


@pytest.mark.parametrize("r", [1.05, 2.0, 6.0])
def test_least_rectangular_pulse_that_overturns(r):
    duration = math.log(r / (r - 1.0)) / RATE

    def run(strength):
        motion = rf.rectangular_pulse(strength * G * ALPHA, duration, dt=duration / 7)
        return after_pulse(motion, 40.0 / RATE)

    assert run(r * (1.0 + 1e-9)).status == "overturned"
    assert run(r * (1.0 - 1e-9)).status == "rocking"


def test_pulse_below_the_weight_does_not_lift():
    assert after_pulse(pulse(half_sine, 5.0, 1.0 - 1e-9), 1.0).status == "no_uplift"
    assert after_pulse(pulse(half_sine, 5.0, 1.001), 1.0).status == "rocking"


@pytest.mark.parametrize("eta", [0.5, 0.93, None])
def test_decay_of_successive_peaks(eta):
    """None is the default: Housner's own coefficient."""
    history = released(0.8 * ALPHA, 20.0, impact=None if eta is None else rf.Restitution(eta))
    kept = 1.0 - 2.0 * MASS * HALF_WIDTH**2 / INERTIA if eta is None else eta
    phi, rate = abs(history.rotation) / ALPHA, history.rotation_velocity / (RATE * ALPHA)
    peak = rate**2 - (1.0 - phi) ** 2  # -(1 - φ_peak)² of the excursion, all along it
    hits = impacts(history)
    assert hits.size >= 5
    expected = 0.8
    for k, (first, last) in enumerate(pairwise([0, *(hits[:5] + 1)])):
        assert history.side[first] == (-1.0) ** k
        np.testing.assert_allclose(peak[first:last], -((1.0 - expected) ** 2), rtol=1e-9)
        missed = expected - phi[first:last].max()  # by the samples; the curvature is p² at most
        assert -1e-12 < missed < (RATE * STEP) ** 2 / 8.0
        expected = 1.0 - math.sqrt(1.0 - kept**2 * (1.0 - (1.0 - expected) ** 2))


@pytest.mark.parametrize("slenderness", [0.1, 0.35])
def test_housner_coefficient_of_a_homogeneous_block(slenderness):
    mass, half_diagonal = 900.0, 1.7
    structure = block(
        i_theta=4.0 / 3.0 * mass * half_diagonal**2,
        l0r=mass * half_diagonal * math.cos(slenderness),
        m_tot=mass,
        half_width=half_diagonal * math.sin(slenderness),
    )
    for model in ("rigid", "rigid-C"):
        history = released(0.5 * slenderness, 3.0, model=model, structure=structure)
        k = impacts(history)[0]
        before, after = history.rotation_velocity[[k, k + 1]]
        assert after / before == pytest.approx(1.0 - 1.5 * math.sin(slenderness) ** 2, rel=1e-12)
