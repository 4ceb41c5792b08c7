"""Work between the states of a history, by integrals of squares and products of its motion."""

from functools import cached_property
from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.models import (
    CLOSED,
    LOADED,
    SIDE,
    Key,
    LinearMotion,
    MotionBetween,
    Part,
    RockingModel,
    Shaking,
    SpringModel,
    arms,
    horizontal_reaction,
    inside,
    soil_strain,
    under_more_gravity,
)

PLACES, WEIGHTS = 0.5 * (np.polynomial.legendre.leggauss(10)[0] + 1.0), 0.5 * np.polynomial.legendre.leggauss(10)[1]
FEW = 64  # power series that cost as much as the tables of a phase
MOST_PARTS = 10_000  # per interval with vertical motion: a minute of power series for a record of a thousand samples
AT_ONCE = 2**13  # intervals, whose power series take some dozens of megabytes


class Work(NamedTuple):
    """Energies in J between adjacent states, shape (n_states - 1,) unless another is given; zero if integrated."""

    damped: Array  # by modal damping
    ground: Array  # work of the ground
    friction: Array  # lost by sliding
    swing: Array  # ∫ (δ'/r)² dt in rad²/s, with the rate of an element's elongation per unit distance from the pivot
    soil: Array  # (n_states - 1, n_springs): lost by each spring under the base
    sweeps: Array  # (n_states - 1, E): ∫ δ'² dt of each element in m²/s; only on springs


def work_between(model: RockingModel, states: Array) -> Work:
    """Return the work between adjacent states.

    Raises
    ------
    InputError
        If the model is too fast for the sampling, under vertical motion.
    """
    motion, last = MotionBetween(model), states.shape[0] - 1
    parts = [_work_of(model, motion, states[k : min(k + AT_ONCE, last) + 1]) for k in range(0, max(last, 1), AT_ONCE)]
    return Work(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def _work_of(model: RockingModel, motion: MotionBetween, states: Array) -> Work:
    n = states.shape[0] - 1
    damped, ground, friction, swing = np.zeros((4, n))
    soil, sweeps = -np.diff(soil_strain(model, states), axis=0), np.zeros((n, len(model.elements)))
    for part in motion.intervals(states).parts:
        found = PhaseWork(model, part.key, part.motion).of(part)
        damped[part.rows], ground[part.rows], friction[part.rows], swing[part.rows] = found[:, :4].T
        if not isinstance(model, SpringModel):
            continue
        # The force of a spring that is loaded is that of its stiffness, which is stored, and that of its dashpot.
        loaded = np.flatnonzero(np.array(part.key[1 : model.springs.n + 1]) == LOADED)
        soil[np.ix_(part.rows, loaded)] = model.springs.damping[loaded] * found[:, 4 + loaded]
        sweeps[part.rows] = found[:, 4 + model.springs.n :]
    return Work(damped, ground, friction, swing, soil, sweeps)


def sweeps_of(model: RockingModel, states: Array, work: Work) -> Array:
    """Return ∫ δ'² dt of each element between adjacent states in m²/s, shape (n_states - 1, E)."""
    if isinstance(model, SpringModel) or not model.elements:
        return work.sweeps
    return arms(model, states[:-1, SIDE]) ** 2 * work.swing[:, None]


class Table(NamedTuple):
    """Integrals over intervals of one length, as functionals and forms of z at their starts."""

    drag: Array  # (r, Z): products with z, whose squares add up to what the modes dissipate
    base: Array  # (r, B, Z): the same for products of the rates of the base
    push: Array  # (2, Z): ∫ F dt and ∫ t F dt of the force F on the ground for each m/s² of its acceleration
    friction: Array  # (Z, Z): ∫ R x' dt of the horizontal reaction R, a form


class PhaseWork:
    """The work in intervals of one phase.

    A result has a column for each of damping, ground, friction and swing, and one with ∫ z_j'² dt for each spring under
    the base, and for each element on springs.

    Parameters
    ----------
    model, key
        The model and the phase.
    motion
        The motion in it.
    """

    def __init__(self, model: RockingModel, key: Key, motion: LinearMotion) -> None:
        p, layout, unit = model.properties, model.layout, np.eye(len(motion.rates))
        N = p.n_modes
        self._label, self._motion = model.label, motion
        self._drag = np.sqrt(2.0 * p.zeta * p.omega * p.effective_mass)[:, None] * unit[N : 2 * N]
        self._push = p.l0r * unit[layout.spin] + p.effective_mass @ unit[N : 2 * N]
        self._tilt, self._lift = p.l0r * unit[layout.rotation], np.zeros(len(unit))
        self._base, self._places = unit[[layout.spin]], np.zeros(0)
        if isinstance(model, SpringModel):
            self._base = unit[[layout.spin, layout.heave + 1]]
            self._places = np.array([*model.springs.positions, *(each.position for each in model.elements)])
            self._lift = p.m_tot * unit[layout.heave + 1]
        elif key[0] != CLOSED:
            self._lift = key[0] * p.m_tot * p.pivot(key[0]).arm * unit[layout.spin]
        self._slide, self._held, self._heavier = np.zeros((3, len(unit)))
        if layout.slip >= 0:
            self._push += p.m_tot * unit[layout.slip + 1]
        if layout.slip >= 0 and model.arrow(key).freed[1]:
            heavier = under_more_gravity(model)
            self._slide = unit[layout.slip + 1]
            self._held = motion.taken(horizontal_reaction(model, model.accelerations(key)))
            self._heavier = motion.taken(horizontal_reaction(heavier, heavier.accelerations(key))) - self._held

    def of(self, part: Part) -> Array:
        """Return the work in intervals, shape (n, 4 + n_springs + E)."""
        found = np.zeros((part.rows.size, 4 + self._places.size))
        rows = np.flatnonzero(part.steps)
        z, left = part.z[rows], part.steps[rows]
        if part.shaking is not None:
            found[rows] = self._by_series(z, left, part.shaking.of(rows))
            return found
        if rows.size * self._motion.parts(float(left.max(initial=0.0))) > FEW:
            for level, which in self._motion.pieces(z, left):
                found[rows[which]] += self._by_table(z[which], self._tables[level])
        rest = np.flatnonzero(left)
        found[rows[rest]] += self._by_series(z[rest], left[rest])
        return found

    def _by_table(self, z: Array, table: Table) -> Array:
        found = np.zeros((len(z), 4 + self._places.size))
        found[:, 0] = _squares(z @ table.drag.T)
        found[:, 1] = -(z[:, -3:-1] * (z @ table.push.T)).sum(axis=1)
        if self._slide.any():
            found[:, 2] = -((z @ table.friction) * z).sum(axis=1)
        spin, *heaving = (z @ each.T for each in table.base.swapaxes(0, 1))
        for column, rate in enumerate((spin, *(heaving[0] - place * spin for place in self._places.tolist())), 3):
            found[:, column] = _squares(rate)
        return found

    @cached_property
    def _tables(self) -> list[Table]:
        """The tables for the lengths of `LinearMotion.pieces`: by quadrature for the last one, and doubled."""
        motion, unit = self._motion, np.eye(len(self._motion.rates))
        length = motion.lengths[-1]
        z = inside(motion.series(unit, np.full(len(unit), length)), PLACES).swapaxes(0, 1)  # of unit vectors, (Z, P, Z)
        weights = length * WEIGHTS
        rows = np.sqrt(weights)[:, None] * (z @ np.concatenate((self._drag, self._base)).T).swapaxes(0, 2)
        n, push, slide = len(self._drag), weights[:, None] * (z @ self._push).T, (z @ self._slide).T
        found = [
            Table(
                drag=_triangle(rows[:n].reshape(-1, 1, len(unit)))[:, 0],
                base=_triangle(rows[n:].swapaxes(0, 1)),
                push=np.stack((push.sum(axis=0), (length * PLACES) @ push)),
                friction=(z @ self._held * weights) @ slide,
            )
        ]
        for length, change in zip(motion.lengths[:0:-1].tolist(), motion.changes[:0:-1], strict=True):
            half, later = found[-1], unit + change
            push = half.push + half.push @ later
            push[1] += length * half.push[0] @ later
            friction = half.friction + later.T @ half.friction @ later
            drag = _triangle(np.concatenate((half.drag, half.drag @ later))[:, None])[:, 0]
            base = _triangle(np.concatenate((half.base, half.base @ later)))
            found.append(Table(drag, base, push, friction))
        return found[::-1]

    def _by_series(self, z: Array, steps: Array, shaking: Shaking | None = None) -> Array:
        longest = float(steps.max(initial=0.0))
        found, parts = np.zeros((len(z), 4 + self._places.size)), self._motion.parts(longest)
        if parts > MOST_PARTS:
            raise InputError(
                f"The energy ledger of {self._label} needs {parts} power series per step, above the limit of "
                f"{MOST_PARTS}, since the ground moves vertically: the model vibrates or decays at up to "
                f"{self._motion.speed:.3g} rad/s, and steps last up to {longest:.3g} s. Keep fewer modes, or refine "
                "the record."
            )
        h = (steps / parts)[:, None]
        weights = h * WEIGHTS
        for k, terms in enumerate(self._motion.developed(z, steps, shaking)):
            z = inside(terms, PLACES).swapaxes(0, 1)  # (n, P, Z)
            spin, *heaving = (z @ each for each in self._base)
            push, held = z[..., -3] * (z @ self._push), z @ self._held
            if shaking is not None:
                up = shaking.rise[:, None] + (k + PLACES) * h * shaking.slope[:, None]
                push += up * (z @ self._lift - (z @ self._tilt) * spin)
                held += up * (z @ self._heavier)
            rates = (spin, *(heaving[0] - place * spin for place in self._places.tolist()))
            found[:, 0] += (_squares(z @ self._drag.T) * weights).sum(axis=1)
            found[:, 1] -= (push * weights).sum(axis=1)
            found[:, 2] -= (held * (z @ self._slide) * weights).sum(axis=1)
            for column, rate in enumerate(rates, 3):
                found[:, column] += (rate**2 * weights).sum(axis=1)
        return found


def _squares(values: Array) -> Array:
    """Return sums of squares over the last axis."""
    return np.einsum("...r,...r->...", values, values)


def _triangle(rows: Array) -> Array:
    """Return few rows, (r, B, Z), from many, with the same sums of products of the B functionals."""
    _, B, Z = rows.shape
    return np.asarray(np.linalg.qr(rows.reshape(-1, B * Z), mode="r"), dtype=float).reshape(-1, B, Z)
