"""Work between the states of a history, by Gauss quadrature of the motion."""

import math
from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array, Complex
from rockflex._errors import InputError
from rockflex.models import (
    GROUND,
    HEADER,
    RISE,
    SIDE,
    TIME,
    RockingModel,
    SpringModel,
    accelerations,
    arms,
    raised_weight_rate,
    reactions,
    spring_forces,
)
from rockflex.solve import ClosedForm

REACH = 8.0  # radians of the fastest mode covered by one Gauss rule, which then has at most 20 points
MOST_PIECES = 10_000  # per interval: a minute of quadrature for a record of a thousand samples
AT_ONCE = 2**16  # intervals, whose states take some megabytes


class Work(NamedTuple):
    """Energies in J between adjacent states; each of shape (n_states - 1,) unless another is given."""

    damped: Array  # by modal damping
    ground: Array  # work of the ground
    swing: Array  # ∫ (δ'/r)² dt in rad²/s, with the rate of an element's elongation per unit distance from the pivot
    friction: Array  # lost by sliding
    soil: Array  # (n_states - 1, n_springs): work on each spring under the base
    sweeps: Array  # (n_states - 1, E): ∫ δ'² dt of each element in m²/s; only on springs


def work_between(model: RockingModel, states: Array) -> Work:
    """Return the work between adjacent states.

    Raises
    ------
    InputError
        If the model is too fast for the sampling.
    """
    motion, last = ClosedForm(model), states.shape[0] - 1
    parts = [_work_of(model, motion, states[k : min(k + AT_ONCE, last) + 1]) for k in range(0, max(last, 1), AT_ONCE)]
    return Work(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def _work_of(model: RockingModel, motion: ClosedForm, states: Array) -> Work:
    intervals = motion.intervals(states)
    span = np.diff(states[:, TIME])
    places, weights = _rule(model.label, intervals.roots, float(span.max(initial=0.0)))
    total: Work | None = None
    linear = [TIME, GROUND, RISE]
    rows, moved = states[:-1].copy(), np.diff(states[:, linear], axis=0)
    for place, weight, inside in zip(places, weights, intervals.along(places), strict=True):
        rows[:, HEADER:] = inside
        rows[:, linear] = states[:-1, linear] + place * moved
        power = _power(model, rows)
        parts = (weight * (span * each.T).T for each in power)
        total = Work(*parts) if total is None else Work(*(one + more for one, more in zip(total, parts, strict=True)))
    assert total is not None
    return total


def _power(model: RockingModel, states: Array) -> Work:
    """Return the rates of the work at states inside their intervals."""
    p, layout = model.properties, model.layout
    v, spin = layout.velocities(states), layout.of(states, layout.spin)
    push = p.l0r * spin + v @ p.effective_mass
    friction = np.zeros(spin.size)
    if layout.slip >= 0:
        slide = layout.of(states, layout.slip + 1)
        push = push + p.m_tot * slide
        sliding = slide != 0.0
        if sliding.any():
            moving = states[sliding]
            held = reactions(model, moving, accelerations(model, moving)).horizontal
            friction[sliding] = -held * slide[sliding]
    ground = -states[:, GROUND] * push
    if states[:, RISE].any():
        ground = ground - states[:, RISE] * raised_weight_rate(model, states)
    soil, sweeps = np.zeros((spin.size, 0)), np.zeros((spin.size, len(model.elements)))
    if isinstance(model, SpringModel):
        heaving = layout.of(states, layout.heave + 1)
        rate = heaving[:, None] - model.springs.positions * spin[:, None]
        soil = -spring_forces(model, states) * rate
        for place, each in enumerate(model.elements):
            sweeps[:, place] = (heaving - each.position * spin) ** 2
    drag = 2.0 * p.zeta * p.omega * p.effective_mass
    return Work(v**2 @ drag, ground, spin**2, friction, soil, sweeps)


def sweeps_of(model: RockingModel, states: Array, work: Work) -> Array:
    """Return ∫ δ'² dt of each element between adjacent states in m²/s, shape (n_states - 1, E)."""
    if isinstance(model, SpringModel) or not model.elements:
        return work.sweeps
    return arms(model, states[:-1, SIDE]) ** 2 * work.swing[:, None]


def _rule(label: str, roots: Complex, longest: float) -> tuple[Array, Array]:
    """Return rising points in [0, 1] and weights of Gauss rules for states with eigenvalues `roots` (rad/s).

    What oscillates or grows needs pieces of equal length. What decays without lasting oscillation is gone after the
    first of them, which is halved towards its start until it is resolved there.
    """
    size = np.abs(roots)
    lasting = float(size[size > -2.0 * roots.real].max(initial=0.0))
    pieces = max(math.ceil(lasting * longest / REACH), 1)
    if pieces > MOST_PIECES:
        raise InputError(
            f"The energy ledger of {label} needs {pieces} quadratures per step, above the limit of {MOST_PIECES}: the "
            f"model vibrates at up to {lasting:.3g} rad/s, and steps last up to {longest:.3g} s. Keep fewer modes, or "
            "refine the record."
        )
    turn = float(size.max(initial=0.0)) * longest / pieces
    halvings = math.ceil(math.log2(max(turn / REACH, 1.0)))
    edges = np.concatenate(([0.0], 0.5 ** np.arange(halvings, 0, -1), np.arange(1, pieces + 1))) / pieces
    places, weights = np.polynomial.legendre.leggauss(8 + math.ceil(1.5 * min(turn, REACH)))
    half = 0.5 * np.diff(edges)[:, None]
    return (edges[:-1, None] + half * (1.0 + places)).ravel(), (half * weights).ravel()
