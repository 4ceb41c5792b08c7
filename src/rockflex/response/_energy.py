"""The energy ledger (energy balance) of a history.

The simplified equations (Eqs. 15, 23 and 25) describe a system with the energy
½ I_θ θ'² + θ' Σ m* h* D' + ½ Σ m* D'² + ½ Σ m* ω² D² + s m_tot g B θ - ½ L_0^r g θ²
relative to the moving ground, plus the energy of the elements between base and ground. The work of the ground is
-∫ a (L_0^r θ' + Σ m* D') dt. For the complete equations the energy is that of Eqs. 6-8. A base that slides has further
kinetic energy, and one on springs the energy of its heave; vertical acceleration of the ground does work on the weight
that rises, -∫ a_v (m_tot z' - L_0^r θ θ') dt.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.values import Value
from rockflex.models._base_motion import horizontal_reaction
from rockflex.models._element_states import element_energies
from rockflex.models._elements import rate_of_elongation_row
from rockflex.models._motion_between_states import (
    IntervalsOfPhase,
    LinearMotion,
    MotionBetween,
    VerticalShaking,
    series_between_states,
)
from rockflex.models._phase import Key
from rockflex.models._rocking_model import RockingModel
from rockflex.models._spring_model import LOADED, YIELDING, SpringModel
from rockflex.models._state_layout import HEADER, SIDE
from rockflex.models._stored_energies import soil_strain, stored_energies
from rockflex.models._values_at_states import under_more_gravity


@dataclass(frozen=True, eq=False)
class EnergyLedger(Value):
    """Energies in J at every state of a history, relative to the moving ground; read-only arrays of shape (n_states,).

    ``kinetic + strain + gravity + element_strain + soil_strain + damped + yielded + elements.sum(axis=1) + friction +
    soil.sum(axis=1) + lost - input`` is constant; `residual` is its numerical deviation from the initial value.

    Parameters
    ----------
    kinetic, strain, gravity
        Kinetic energy, elastic strain energy, and potential energy of the lifted weight (zero in contact).
    element_strain
        Elastic energy stored in tendons and dissipators, relative to the base in contact before anything yields. A bar
        that hardens also stores energy at zero force, locked in by its plastic stretch.
    damped, input
        Energy dissipated by modal damping, and work of the ground, up to each state; found by quadrature of the exact
        states, or integrated with the motion.
    yielded
        Energy absorbed by the hysteretic spring of a Bouc-Wen superstructure, `strain` is then that of its elastic
        part; or dissipated by stories that yield.
    elements
        Energy dissipated by each element up to each state, in the order of `RockingProperties.elements`, shape
        (n_states, E). An element that breaks dissipates what it had stored.
    soil_strain
        Elastic energy stored in the springs under the base: ½ k z_j² while z_j < 0, loaded or not.
    friction, soil
        Energy lost by sliding, and by each spring under the base, shape (n_states, n_springs), up to each state.
    lost
        Energy lost in impacts up to each state.
    impact_losses
        Energy lost in each impact, shape (n_impacts,).

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> energy = rf.simulate(column, pulse, "2DOF-S", output="history",
    ...     free_vibration=5.0).energy
    >>> energy.impact_losses.size
    3
    >>> energy.closing_error < 1e-9
    True
    """

    kinetic: Array
    strain: Array
    gravity: Array
    element_strain: Array
    damped: Array
    yielded: Array
    elements: Array
    input: Array
    lost: Array
    impact_losses: Array
    soil_strain: Array
    friction: Array
    soil: Array

    @property
    def residual(self) -> Array:
        """Error of the energy balance at each state, in J."""
        spent = self.damped + self.yielded + self.elements.sum(axis=1) + self.lost
        total = self.stored + spent + self.friction + self.soil.sum(axis=1) - self.input
        return total - total[0]

    @property
    def stored(self) -> Array:
        """Stored energy: kinetic, strain, gravity and that of the elements and the springs under the base, in J."""
        return self.kinetic + self.strain + self.gravity + self.element_strain + self.soil_strain

    @property
    def tendons(self) -> Array:
        """Another name of `element_strain`."""
        return self.element_strain

    @property
    def closing_error(self) -> float:
        """Largest residual divided by the largest input energy, or by the initial energy if that is larger."""
        start = abs(float(self.stored[0]))
        scale = max(float(np.max(np.abs(self.input))), start)
        return float(np.max(np.abs(self.residual))) / scale if scale > 0.0 else 0.0


def energy_ledger(model: RockingModel, states: Array) -> EnergyLedger:
    """Return the energy ledger of a history; `states` as in `History`.

    Raises
    ------
    InputError
        If the model is too fast for the sampling: too many quadratures would be needed.
    """
    kinetic, strain, gravity = stored_energies(model, states)
    impact = np.flatnonzero(model.impacts(states))
    losses = kinetic[impact] - kinetic[impact + 1]
    lost = np.zeros(states.shape[0])
    np.add.at(lost, impact + 1, losses)
    work = energy_between_states(model, states)
    damped, given, yielded = work.damped, work.ground, np.zeros(work.damped.size)
    if model.integrated:
        layout, integrated = model.layout, model.integrates(states[:-1, SIDE])
        counters = np.diff(states[:, HEADER : HEADER + layout.size], axis=0)
        counted = counters[:, layout.damped : layout.yielded + 1]
        # The counters are not advanced while contact is solved in closed form, and resume when it ends.
        damped, given, yielded = np.where(integrated, counted.T, (damped, given, yielded))
        if layout.swept >= 0:
            work = work._replace(swing=np.where(integrated, counters[:, layout.swept], work.swing))
        if layout.rubbed >= 0:
            work = work._replace(friction=np.where(integrated, counters[:, layout.rubbed], work.friction))
        if layout.soil >= 0:
            soil, sweeps = counters[:, layout.soil : layout.sweeps], counters[:, layout.sweeps : layout.memory]
            work = work._replace(soil=soil, sweeps=sweeps)
    stored, losses_of = element_energies(model, states, swept_integrals(model, states, work))
    count = len(model.properties.elements)  # stories that yield follow
    yielded += losses_of[:, count:].sum(axis=1)
    return EnergyLedger(
        kinetic=kinetic,
        strain=strain + stored[:, count:].sum(axis=1),
        gravity=gravity,
        element_strain=stored[:, :count].sum(axis=1),
        damped=_summed(damped),
        yielded=_summed(yielded),
        elements=_summed(losses_of[:, :count]),
        input=_summed(given),
        lost=np.cumsum(lost),
        impact_losses=losses,
        soil_strain=soil_strain(model, states).sum(axis=1),
        friction=_summed(work.friction),
        soil=_summed(work.soil),
    )


def _summed(parts: Array) -> Array:
    """Return the sums up to each state of what is known between adjacent states."""
    return np.concatenate((np.zeros((1, *parts.shape[1:])), np.cumsum(parts, axis=0)))


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(10)
POINTS, WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS  # of Gauss-Legendre quadrature on 0 to 1
MIN_TABLED = 64  # power series that cost as much as the tables of a phase
MAX_SERIES = 10_000  # per interval with vertical motion: a minute of work for a record of a thousand samples
CHUNK = 2**13  # intervals, whose power series take some dozens of megabytes


class EnergyBetweenStates(NamedTuple):
    """Energies in J between adjacent states, shape (n_states - 1,) unless another is given; zero if integrated."""

    damped: Array  # by modal damping
    ground: Array  # work of the ground
    friction: Array  # lost by sliding
    swing: Array  # ∫ (δ'/r)² dt in rad²/s, with the rate of an element's elongation per unit distance from the pivot
    soil: Array  # (n_states - 1, n_springs): lost by each spring under the base
    sweeps: Array  # (n_states - 1, E): ∫ δ'² dt of each element in m²/s; on rigid ground only of attached dampers


def energy_between_states(model: RockingModel, states: Array) -> EnergyBetweenStates:
    """Return the work between adjacent states.

    Raises
    ------
    InputError
        If the model is too fast for the sampling, under vertical motion.
    """
    motion, last = MotionBetween(model), states.shape[0] - 1
    parts = [_work_of(model, motion, states[k : min(k + CHUNK, last) + 1]) for k in range(0, max(last, 1), CHUNK)]
    return EnergyBetweenStates(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def _work_of(model: RockingModel, motion: MotionBetween, states: Array) -> EnergyBetweenStates:
    n = states.shape[0] - 1
    damped, ground, friction, swing = np.zeros((4, n))
    soil, sweeps = -np.diff(soil_strain(model, states), axis=0), np.zeros((n, len(model.elements)))
    for part in motion.intervals(states).parts:
        found = PhaseWork(model, part.key, part.motion).of(part)
        damped[part.rows], ground[part.rows], friction[part.rows], swing[part.rows] = found[:, :4].T
        swept, first = swept_elements(model), 4
        if model.springs is not None:
            # The force of a spring that is loaded is that of its stiffness, which is stored, and that of its dashpot.
            branches = np.array(part.key[1 : model.springs.n + 1])
            loaded = np.flatnonzero((branches == LOADED) | (branches == YIELDING))
            soil[np.ix_(part.rows, loaded)] = model.springs.damping[loaded] * found[:, 4 + loaded]
            first += model.springs.n
        sweeps[part.rows[:, None], swept] = found[:, first:]
    if isinstance(model, SpringModel) and model.springs.capacity is not None:
        crushed = np.diff(model.permanent_settlements(states), axis=0)  # while a spring carries its capacity
        soil += (
            np.where(crushed != 0.0, np.where(np.isfinite(model.springs.capacity), model.springs.capacity, 0.0), 0.0)
            * crushed
        )
    return EnergyBetweenStates(damped, ground, friction, swing, soil, sweeps)


def swept_integrals(model: RockingModel, states: Array, work: EnergyBetweenStates) -> Array:
    """Return ∫ δ'² dt of each element between adjacent states in m²/s, shape (n_states - 1, E)."""
    if len(model.moving_places) == len(model.elements):
        return work.sweeps
    return work.sweeps + model.arms(states[:-1, SIDE]) ** 2 * work.swing[:, None]


def swept_elements(model: RockingModel) -> list[int]:
    """Return the places of viscous elements whose elongation does not follow from the rotation."""
    return [place for place in model.moving_places if model.elements[place].tension(0).damping > 0.0]


class Table(NamedTuple):
    """Integrals over intervals of one length, as functionals and forms of z at their starts."""

    drag: Array  # (r, Z): products with z, whose squares add up to what the modes dissipate
    base: Array  # (r, B, Z): the same for products of the rates of the base
    push: Array  # (2, Z): ∫ F dt and ∫ t F dt of the force F on the ground for each m/s² of its acceleration
    friction: Array  # (Z, Z): ∫ R x' dt of the horizontal reaction R, a form


class PhaseWork:
    """The work in intervals of one phase.

    A result has a column for each of damping, ground, friction and swing, and one with ∫ z_j'² dt for each spring under
    the base, and for each of `swept_elements`.

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
        spins = unit[[place + 1 for place in layout.rotations]]
        self._push = model.levers @ spins + p.effective_mass @ unit[N : 2 * N]
        self._tilt, self._turns = model.toppling @ unit[layout.rotations], spins
        rates = [unit[layout.spin]]
        if model.springs is not None:
            rates += [unit[layout.heave + 1] - x * unit[layout.spin] for x in model.springs.positions.tolist()]
            self._lift = p.m_tot * unit[layout.heave + 1]
        else:
            self._lift = (model.lifts_by(model.stance(key)) * model.weights) @ spins
        for place in swept_elements(model):
            rates.append(motion.taken(rate_of_elongation_row(model.stretch(place, model.stance(key)), layout)))
        self._rates = np.array(rates)
        # Few independent rates, of which all others are sums: θ', the heave's and those of the modes.
        self._base, self._shares = _independent(self._rates)
        self._slide, self._held, self._heavier = np.zeros((3, len(unit)))
        if layout.slip >= 0:
            self._push += p.horizontal_mass * unit[layout.slip + 1]
        if layout.slip >= 0 and model.bordered_system(key).freed[1]:
            heavier = under_more_gravity(model)
            self._slide = unit[layout.slip + 1]
            self._held = motion.taken(horizontal_reaction(model, key))
            self._heavier = motion.taken(horizontal_reaction(heavier, key)) - self._held

    def of(self, part: IntervalsOfPhase) -> Array:
        """Return the work in intervals, shape (n, 4 + n_springs + number of `swept_elements`)."""
        found = np.zeros((part.rows.size, 3 + len(self._rates)))
        rows = np.flatnonzero(part.steps)
        z, left = part.z[rows], part.steps[rows]
        if part.shaking is not None:
            found[rows] = self._by_series(z, left, part.shaking.of(rows))
            return found
        if rows.size * self._motion.parts(float(left.max(initial=0.0))) > MIN_TABLED:
            for level, which in self._motion.pieces(z, left):
                found[rows[which]] += self._by_table(z[which], self._tables[level])
        rest = np.flatnonzero(left)
        found[rows[rest]] += self._by_series(z[rest], left[rest])
        return found

    def _by_table(self, z: Array, table: Table) -> Array:
        found = np.zeros((len(z), 3 + len(self._rates)))
        found[:, 0] = _squares(z @ table.drag.T)
        found[:, 1] = -(z[:, -3:-1] * (z @ table.push.T)).sum(axis=1)
        if self._slide.any():
            found[:, 2] = -((z @ table.friction) * z).sum(axis=1)
        base = z @ table.base.swapaxes(0, 1).swapaxes(1, 2)  # (B, n, r)
        for column, shares in enumerate(self._shares, 3):
            found[:, column] = _squares(np.einsum("b,bnr->nr", shares, base))
        return found

    @cached_property
    def _tables(self) -> list[Table]:
        """The tables for the lengths of `LinearMotion.pieces`: by quadrature for the last one, and doubled."""
        motion, unit = self._motion, np.eye(len(self._motion.rates))
        length = motion.lengths[-1]
        z = series_between_states(motion.series(unit, np.full(len(unit), length)), POINTS).swapaxes(
            0, 1
        )  # of unit vectors, (Z, P, Z)
        weights = length * WEIGHTS
        rows = np.sqrt(weights)[:, None] * (z @ np.concatenate((self._drag, self._base)).T).swapaxes(0, 2)
        n, push, slide = len(self._drag), weights[:, None] * (z @ self._push).T, (z @ self._slide).T
        found = [
            Table(
                drag=_triangle(rows[:n].reshape(-1, 1, len(unit)))[:, 0],
                base=_triangle(rows[n:].swapaxes(0, 1)),
                push=np.stack((push.sum(axis=0), (length * POINTS) @ push)),
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

    def _by_series(self, z: Array, steps: Array, shaking: VerticalShaking | None = None) -> Array:
        longest = float(steps.max(initial=0.0))
        found, parts = np.zeros((len(z), 3 + len(self._rates))), self._motion.parts(longest)
        if parts > MAX_SERIES:
            raise InputError(
                f"The energy ledger of {self._label} needs {parts} power series per step, above the limit of "
                f"{MAX_SERIES}, since the ground moves vertically: the model vibrates or decays at up to "
                f"{self._motion.speed:.3g} rad/s, and steps last up to {longest:.3g} s. Keep fewer modes, or refine "
                "the record."
            )
        h = (steps / parts)[:, None]
        weights = h * WEIGHTS
        for k, terms in enumerate(self._motion.developed(z, steps, shaking)):
            z = series_between_states(terms, POINTS).swapaxes(0, 1)  # (n, P, Z)
            rates = z @ self._rates.T
            push, held = z[..., -3] * (z @ self._push), z @ self._held
            if shaking is not None:
                up = shaking.rise[:, None] + (k + POINTS) * h * shaking.slope[:, None]
                tilting = ((z @ self._tilt.T) * (z @ self._turns.T)).sum(axis=-1)
                push += up * (z @ self._lift - tilting)
                held += up * (z @ self._heavier)
            found[:, 0] += (_squares(z @ self._drag.T) * weights).sum(axis=1)
            found[:, 1] -= (push * weights).sum(axis=1)
            found[:, 2] -= (held * (z @ self._slide) * weights).sum(axis=1)
            found[:, 3:] += (rates**2 * weights[..., None]).sum(axis=1)
        return found


def _independent(rates: Array) -> tuple[Array, Array]:
    """Return few functionals, (B, Z), and the shares of which given ones, (K, Z), are sums, (K, B)."""
    columns = np.flatnonzero(rates.any(axis=0))
    if columns.size < len(rates):  # of few rates of the state
        return np.eye(rates.shape[1])[columns], rates[:, columns]
    return rates, np.eye(len(rates))


def _squares(values: Array) -> Array:
    """Return sums of squares over the last axis."""
    return np.einsum("...r,...r->...", values, values)


def _triangle(rows: Array) -> Array:
    """Return few rows, (r, B, Z), from many, with the same sums of products of the B functionals."""
    _, B, Z = rows.shape
    return np.asarray(np.linalg.qr(rows.reshape(-1, B * Z), mode="r"), dtype=float).reshape(-1, B, Z)
