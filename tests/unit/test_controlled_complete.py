"""Elements that yield and dampers in integrated models, against an independent integration by SciPy."""

import dataclasses

import numpy as np
import pytest

import rockflex as rf
from builders import NO_MODES, frame_values
from rockflex.models._state_layout import HEADER
from twins import impact_laws
from twins.complete import complete_frame
from twins.complete_model import BoucWen, Structure
from twins.controlled import Bar, Dashpot
from twins.controlled_complete import simulate_controlled

FRAME = frame_values(stiffness_ratio=0.125, period=0.7, aspect_ratio=7.0)
B = rf.Frame(**FRAME).rocking().half_width
SPRING = (0.04, 0.02, 0.5, 0.5, 8.0)
ELEMENTS = {
    "fuses": [rf.YieldingDissipator(2e7, 2e5, 0.02, x) for x in (B, -B)],
    "fuses in tension": [rf.YieldingDissipator(2e7, 2e5, 0.02, x, tension_only=True) for x in (B, -B)],
    "tendon": [rf.Tendon(1.2e5, 2e7, 0.0, 2e5, 0.01)],
    "hardening": [rf.YieldingDissipator(5e7, 1e5, 0.4, x, tension_only=True) for x in (B, -B)],
    "dampers": [rf.ViscousDamper(2e6, x) for x in (0.8 * B, -0.8 * B)],
    "asymmetric": [
        rf.YieldingDissipator(3e7, 1.5e5, 0.05, 1.1 * B),
        rf.YieldingDissipator(2e7, 1e5, 0.0, -0.9 * B, tension_only=True),
        rf.Tendon(1e5, 2e7, 0.1, 2e5, 0.02),
        rf.Tendon(1e5, 1e7, -0.2),
        rf.ViscousDamper(1e6, -0.5 * B),
    ],
}
MODELS = {
    # label: modes of the twin, what else the twin is told, what else the model is
    "2DOF-C": (1, {"law": impact_laws.CompleteVVEL()}, {}),
    "4DOF-C-SI": (3, {"law": impact_laws.SimplifiedVVEL()}, {}),
    "2DOF-S-BW": (
        1,
        {"law": impact_laws.SimplifiedVVEL(), "complete": False, "bouc_wen": BoucWen(*SPRING)},
        {"bouc_wen": rf.BoucWen(*SPRING)},
    ),
    "rigid-C": (0, {"law": impact_laws.Restitution(0.9)}, {"impact": rf.Restitution(0.9)}),
}
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment")
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
MOTION = rf.GroundMotion(2.5 * EL_CENTRO.acceleration[60:210], EL_CENTRO.dt)
PULSE = rf.one_sine_pulse(7.0, 1.6, dt=0.02)
SURGE = rf.GroundMotion(np.concatenate((PULSE.acceleration, np.zeros(100))), PULSE.dt)


def of_twin(element):
    """The element as the twin knows it."""
    if isinstance(element, rf.ViscousDamper):
        return Dashpot(element.coefficient, element.position)
    if isinstance(element, rf.YieldingDissipator):
        return Bar(
            element.stiffness,
            element.yield_force,
            element.post_yield_ratio,
            element.position,
            no_push=element.tension_only,
        )
    ratio, limit = element.post_yield_ratio, element.yield_force
    return Bar(
        element.stiffness,
        np.inf if ratio is None else limit,
        0.0 if ratio is None else ratio,
        element.position,
        element.initial_force / element.stiffness,
        no_push=ratio is not None,
    )


def both(model, elements, eccentricity=0.0, motion=MOTION, output="history"):
    n_modes, told, options = MODELS[model]
    given = complete_frame(**FRAME, n_modes=max(n_modes, 1))
    if n_modes == 0:
        given |= NO_MODES
    twin = simulate_controlled(
        Structure(**given, eccentricity=eccentricity),
        [of_twin(each) for each in elements],
        motion.acceleration,
        motion.dt,
        free=0.4,
        **told,
    )
    structure = rf.Eccentric(rf.Frame(**FRAME), eccentricity) if eccentricity else rf.Frame(**FRAME)
    run = rf.simulate(rf.Restrained(structure, elements), motion, model, output, free_vibration=0.4, **options)
    return twin, run


CASES = [
    *((model, case) for model in ("2DOF-C", "2DOF-S-BW") for case in ELEMENTS),
    *(("4DOF-C-SI", case) for case in ("fuses in tension", "asymmetric")),
    *(("rigid-C", case) for case in ("fuses", "asymmetric")),
]


@pytest.mark.slow
@pytest.mark.parametrize(("model", "case"), CASES)
def test_peaks_and_events(model, case):
    twin, run = both(model, ELEMENTS[case], 0.25 if case == "asymmetric" else 0.0)
    found = twin.result()
    assert (run.n_uplifts, run.n_impacts) == (found.n_uplifts, found.n_impacts)
    assert run.n_impacts > 5
    assert twin.n_changes > 4 or case == "dampers"
    for name in PEAKS:
        assert getattr(run, name) == pytest.approx(getattr(found, name), rel=1e-8, abs=1e-14), name
    np.testing.assert_allclose(run.uplift_times, found.uplift_times, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(run.impact_times, found.impact_times, rtol=0.0, atol=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("model", ["2DOF-C", "rigid-C"])
@pytest.mark.parametrize("case", ["tendon", "hardening", "asymmetric"])
def test_large_rotations(model, case):
    """Chords are shorter than arcs: at 0.3 rad by 0.4 %."""
    twin, run = both(model, ELEMENTS[case], 0.25 if case == "asymmetric" else 0.0, SURGE)
    assert run.max_rotation > 0.1
    for name in PEAKS:
        assert getattr(run, name) == pytest.approx(getattr(twin.result(), name), rel=1e-8, abs=1e-14), name


@pytest.mark.slow
def test_ground_reactions():
    """The elements pull the base towards their places in contact."""
    twin, run = both("4DOF-C-SI", ELEMENTS["asymmetric"], 0.25, SURGE)
    time, *forces = np.array(twin.forces).T
    last = np.array([np.flatnonzero(np.abs(run.time - each) < 1e-9)[-1] for each in time])
    inside = (time > 0.1) & (time < SURGE.time[-1] - 0.01)
    for mine, expected in zip((run.horizontal_reaction, run.vertical_reaction), forces, strict=True):
        np.testing.assert_allclose(mine[last][inside], expected[inside], rtol=1e-6, atol=1e-7 * 2.4e6)
    assert run.min_vertical_reaction <= run.vertical_reaction.min() * (1.0 + 1e-9)
    peaks = both("4DOF-C-SI", ELEMENTS["asymmetric"], 0.25, SURGE, "peaks")[1]
    assert peaks.min_vertical_reaction == pytest.approx(run.min_vertical_reaction, rel=1e-12)
    assert run.min_vertical_reaction == pytest.approx(run.vertical_reaction.min(), rel=1e-2)


def dissipated_by_dampers(p, layout, states):
    """c r² ∫ (δ'/r)² dt over each side."""
    side, total = states[:-1, 1], 0.0
    for element in p.elements:
        if isinstance(element, rf.ViscousDamper):
            swept = np.diff(layout.of(states, layout.swept))
            for which in (1, -1):
                arm = p.pivot(which).arm - which * element.position
                total += element.coefficient * arm**2 * swept[side == which].sum()
    return total


@pytest.mark.slow
@pytest.mark.parametrize("model", ["2DOF-C", "2DOF-S-BW"])
@pytest.mark.parametrize("case", ["dampers", "asymmetric"])
def test_energy_of_dampers(model, case):
    twin, run = both(model, ELEMENTS[case], 0.25 if case == "asymmetric" else 0.0)
    model = run.history.model
    found = dissipated_by_dampers(model.properties, model.layout, run.history.states)
    assert found == pytest.approx(twin.damped, rel=1e-7)
    assert twin.damped > 1e3


def stored(element, memory):
    """Energy of a bar at δ = 0 with a plastic stretch, less that without; kinematic hardening locks energy in."""
    k, a = element.stiffness, element.post_yield_ratio
    e = element.initial_force / k if isinstance(element, rf.Tendon) else 0.0
    slack = (isinstance(element, rf.Tendon) or element.tension_only) and (1.0 - a) * memory > e

    def energy(e, m):
        return 0.5 * a * k * e**2 + 0.5 * (1.0 - a) * k * (e - m) ** 2

    return energy((1.0 - a) * memory if slack else e, memory) - energy(e, 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("case", ["fuses", "hardening", "tendon", "asymmetric", "dampers"])
@pytest.mark.parametrize("model", ["4DOF-C-SI", "2DOF-S-BW"])
def test_energy_balance(model, case):
    """What the ground gives is damped, lost in impacts, taken by elements, or still there."""
    structure = rf.Eccentric(rf.Frame(**FRAME), 0.25) if case == "asymmetric" else rf.Frame(**FRAME)
    held, options = rf.Restrained(structure, ELEMENTS[case]), MODELS[model][2]
    run = rf.simulate(held, MOTION, model, "history", free_vibration=2.0, **options)
    p, states, layout = run.history.model.properties, run.history.states, run.history.model.layout
    last = np.flatnonzero(run.side == 0.0)[-1]
    states = states[: last + 1]
    known = states[:, HEADER + layout.memory :]
    taken, place = dissipated_by_dampers(p, layout, states), 0
    for element in p.elements:
        if isinstance(element, rf.YieldingDissipator) or getattr(element, "post_yield_ratio", None) is not None:
            yielded = np.abs(np.diff(known[:, place])).sum()
            taken += (1.0 - element.post_yield_ratio) * element.yield_force * yielded
            taken += stored(element, float(known[-1, place]))
            place += 1
    assert place == layout.n_internal
    ledger = run.energy
    total = ledger.kinetic + ledger.strain + ledger.gravity + ledger.damped + ledger.yielded + ledger.lost
    assert taken > 1e-3 * ledger.input[last]
    assert total[last] + taken == pytest.approx(ledger.input[last], rel=1e-8)


@pytest.mark.parametrize("model", ["2DOF-C", "4DOF-C-SI", "2DOF-S-BW", "rigid-C"])
def test_elements_without_effect_change_nothing(model):
    """But for rounding, which may change a step: more states are summed in other vectors. A step allows 1e-10."""
    frame, options = rf.Frame(**FRAME), MODELS[model][2]
    nothing = [rf.ViscousDamper(0.0, 0.3), rf.Tendon(0.0, 0.0, -0.2)]
    runs = [
        rf.simulate(each, MOTION, model, "peaks", free_vibration=1.0, **options)
        for each in (frame, rf.Restrained(frame, nothing))
    ]
    for name in (*PEAKS, "max_base_shear", "n_impacts", "min_vertical_reaction", "time_of_max_rotation"):
        assert getattr(runs[1], name) == pytest.approx(getattr(runs[0], name), rel=1e-9), name


@pytest.mark.parametrize("model", ["2DOF-C", "2DOF-S-BW"])
def test_a_fuse_that_never_yields_is_a_spring(model):
    places, options = (0.9 * B, -0.4 * B), MODELS[model][2]
    runs = [
        rf.simulate(rf.Restrained(rf.Frame(**FRAME), each), MOTION, model, "peaks", **options)
        for each in (
            [rf.YieldingDissipator(2e7, 1e12, 0.1, x) for x in places],
            [rf.Tendon(0.0, 2e7, x) for x in places],
        )
    ]
    assert runs[0].n_impacts == runs[1].n_impacts > 3
    for name in PEAKS:
        assert getattr(runs[0], name) == pytest.approx(getattr(runs[1], name), rel=1e-12), name


def order(errors, factors):
    return np.diff(np.log(errors)) / np.diff(np.log(factors))


def test_slender_blocks_with_elements_are_linearised_ones():
    """Similar motions of ever more slender rigid blocks: rotations fall with B, and differences with B²."""
    slenderness, errors = 0.2 * 0.5 ** np.arange(5.0), []
    time = 0.01 * np.arange(300)
    for alpha in slenderness:
        block = rf.rigid_block(slenderness=alpha, half_diagonal=3.0)
        b, weight = block.half_width, block.m_tot * 9.81
        elements = [
            *(rf.YieldingDissipator(0.3 * weight / (0.01 * b**2), 0.3 * weight, 0.02, x) for x in (b, -0.5 * b)),
            rf.Tendon(0.1 * weight, 0.2 * weight / (0.02 * b**2), 0.0, 0.2 * weight, 0.05),
            rf.ViscousDamper(0.05 * weight / b**2, 0.7 * b),
        ]
        held = dataclasses.replace(block, elements=tuple(elements))
        motion = rf.GroundMotion(4.0 * alpha * 9.81 * np.sin(8.0 * time) * (time < 1.5), 0.01)
        one, other = (rf.simulate(held, motion, model) for model in ("rigid-C", "rigid"))
        assert other.n_impacts >= 5
        assert 0.1 < other.max_rotation / alpha < 1.0
        errors.append(abs(one.max_rotation / other.max_rotation - 1.0))
    assert order(errors, slenderness)[-1] == pytest.approx(2.0, abs=0.1)


def test_large_structures_with_elements_are_simplified_ones():
    """The same motion of ever larger structures: rotations, and what Eq. 23 leaves out, fall with their size."""
    modal, sizes, errors = rf.Frame(**FRAME).rocking(1), 4.0 * 2.0 ** np.arange(6.0), []
    for size in sizes:
        larger = dataclasses.replace(
            modal,
            effective_height=size * modal.effective_height,
            i_theta=size**2 * modal.i_theta,
            translational_inertia=size**2 * modal.translational_inertia,
            l0r=size * modal.l0r,
            half_width=size * modal.half_width,
            elements=tuple(dataclasses.replace(each, position=size * each.position) for each in ELEMENTS["fuses"]),
        )
        one, other = (rf.simulate(larger, MOTION, model) for model in ("2DOF-C-SI", "2DOF-S"))
        errors.append(abs(one.max_base_moment / other.max_base_moment - 1.0))
    assert order(errors, 1.0 / sizes)[-1] == pytest.approx(1.0, abs=0.1)
