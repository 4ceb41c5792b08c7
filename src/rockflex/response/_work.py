"""Work between the states of a history, by Gauss quadrature of the motion."""

import math
from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array
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
    motion = ClosedForm(model)
    intervals = motion.intervals(states)
    span = np.diff(states[:, TIME])
    places, weights = _rule(model.label, motion.fastest, float(span.max(initial=0.0)))
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


def _rule(label: str, fastest: float, longest: float) -> tuple[Array, Array]:
    """Return points in [0, 1] and weights of a Gauss rule for states with eigenvalues up to `fastest` (rad/s)."""
    pieces = max(math.ceil(fastest * longest / REACH), 1)
    if pieces > MOST_PIECES:
        raise InputError(
            f"The energy ledger of {label} needs {pieces} quadratures per step, above the limit of {MOST_PIECES}: the "
            f"model vibrates or decays at up to {fastest:.3g} rad/s, and steps last up to {longest:.3g} s. Keep fewer "
            "modes, damp them less, or refine the record."
        )
    places, weights = np.polynomial.legendre.leggauss(8 + math.ceil(1.5 * fastest * longest / pieces))
    starts = np.arange(pieces)[:, None]
    return ((starts + 0.5 + 0.5 * places) / pieces).ravel(), np.tile(0.5 * weights / pieces, pieces)
