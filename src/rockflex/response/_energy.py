"""The energy ledger of a history.

The simplified equations (Eqs. 15, 23 and 25) are those of a system with the energy
½ I_θ θ'² + θ' Σ m* h* D' + ½ Σ m* D'² + ½ Σ m* ω² D² + s m_tot g B θ - ½ L_0^r g θ²
relative to the moving ground (and that of tendons), on which the ground does the work -∫ a (L_0^r θ' + Σ m* D') dt. The
complete ones have that of Eqs. 6-8.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.models import GROUND, HEADER, SIDE, TIME, RockingModel, stored_energies, tendon_energy
from rockflex.solve import ClosedForm

Array = NDArray[np.float64]

REACH = 8.0  # radians of the fastest mode that one Gauss rule spans; its points then number 20 at most
MOST_PIECES = 10_000  # of an interval: a minute of quadrature for a record of a thousand samples


@dataclass(frozen=True, eq=False)
class EnergyLedger(Value):
    """Energies in J at every node of a history, shape (n_nodes,) each, relative to the moving ground; read-only.

    ``kinetic + strain + gravity + tendons + damped + yielded + lost - input`` keeps its first value; `residual` is what
    it strays.

    Parameters
    ----------
    kinetic, strain, gravity
        Energy of motion, of flexure, and of the raised weight (zero in contact).
    tendons
        What the tendons have taken up since the base stood on the ground.
    damped, input
        Dissipated by modal damping, and put in by the ground, up to each node: quadratures of the exact states, or
        integrated with the motion.
    yielded
        Taken up by the hysteretic spring of a Bouc-Wen superstructure, whose `strain` is that of its elastic share.
    lost
        Lost in the impacts up to each node.
    impact_losses
        Loss of each impact, shape (n_impacts,).
    """

    kinetic: Array
    strain: Array
    gravity: Array
    tendons: Array
    damped: Array
    yielded: Array
    input: Array
    lost: Array
    impact_losses: Array

    @property
    def residual(self) -> Array:
        """Energy that the ledger cannot account for at each node, in J."""
        total = self.stored + self.damped + self.yielded + self.lost - self.input
        return total - total[0]

    @property
    def stored(self) -> Array:
        """Energy that may still come back: kinetic, strain, gravity and tendons, in J."""
        return self.kinetic + self.strain + self.gravity + self.tendons

    @property
    def closing_error(self) -> float:
        """Largest residual over the largest energy that went through: input, or what was there at the start."""
        start = abs(float(self.stored[0]))
        scale = max(float(np.max(np.abs(self.input))), start)
        return float(np.max(np.abs(self.residual))) / scale if scale > 0.0 else 0.0


def energy_ledger(model: RockingModel, nodes: Array) -> EnergyLedger:
    """Ledger of a history; `nodes` as in `History`.

    Raises
    ------
    InputError
        If the model is so fast against the sampling that the quadratures would be too many.
    """
    kinetic, strain, gravity = stored_energies(model, nodes)
    impact = np.flatnonzero(is_impact(model, nodes))
    losses = kinetic[impact] - kinetic[impact + 1]
    lost = np.zeros(nodes.shape[0])
    np.add.at(lost, impact + 1, losses)
    damped, work = _work(model, nodes)
    yielded = np.zeros(damped.size)
    if model.integrated:
        integrated = (nodes[:-1, SIDE] != 0.0) | (model.bouc_wen is not None)
        counted = np.diff(nodes[:, HEADER + model.layout.damped : HEADER + model.layout.yielded + 1], axis=0)
        # The counters rest while contact is carried in closed form, and jump to where they were when it ends.
        damped, work, yielded = np.where(integrated, counted.T, (damped, work, yielded))
    return EnergyLedger(
        kinetic=kinetic,
        strain=strain,
        gravity=gravity,
        tendons=tendon_energy(model, nodes),
        damped=np.concatenate(([0.0], np.cumsum(damped))),
        yielded=np.concatenate(([0.0], np.cumsum(yielded))),
        input=np.concatenate(([0.0], np.cumsum(work))),
        lost=np.cumsum(lost),
        impact_losses=losses,
    )


def is_impact(model: RockingModel, nodes: Array) -> NDArray[np.bool_]:
    """True between the two nodes of every impact, shape (n_nodes - 1,)."""
    spin = model.layout.of(nodes, model.layout.spin)
    time, side = nodes[:, TIME], nodes[:, SIDE]
    same_time, rocking = time[1:] == time[:-1], side[:-1] != 0.0
    return same_time & rocking & ((side[1:] != side[:-1]) | (spin[1:] != spin[:-1]))


def _work(model: RockingModel, nodes: Array) -> tuple[Array, Array]:
    """Energy damped and put in between neighbouring nodes, (n_nodes - 1,) each, by Gauss quadrature."""
    p = model.properties
    n = p.n_modes
    nodes = nodes[:, : HEADER + model.layout.core]
    motion = ClosedForm(model)
    span = np.diff(nodes[:, TIME])
    places, weights = _rule(model.label, motion.fastest, float(span.max(initial=0.0)))
    drag = 2.0 * p.zeta * p.omega * p.effective_mass
    damped, work = np.zeros(span.size), np.zeros(span.size)
    for place, weight in zip(places, weights, strict=True):
        states = motion.between(nodes, float(place))
        v = states[:, n : 2 * n]
        acceleration = nodes[:-1, GROUND] + place * np.diff(nodes[:, GROUND])
        damped += weight * span * (v**2 @ drag)
        work -= weight * span * acceleration * (p.l0r * states[:, -1] + v @ p.effective_mass)
    return damped, work


def _rule(label: str, fastest: float, longest: float) -> tuple[Array, Array]:
    """Places in [0, 1] and weights of a composite Gauss rule for states that turn or decay at `fastest` (rad/s)."""
    pieces = max(math.ceil(fastest * longest / REACH), 1)
    if pieces > MOST_PIECES:
        raise InputError(
            f"The energy ledger of {label} needs {pieces} quadratures a step, above the limit of {MOST_PIECES}: the "
            f"model turns or decays at up to {fastest:.3g} rad/s, and steps last up to {longest:.3g} s. Keep fewer "
            "modes, damp them less, or refine the record."
        )
    places, weights = np.polynomial.legendre.leggauss(8 + math.ceil(1.5 * fastest * longest / pieces))
    starts = np.arange(pieces)[:, None]
    return ((starts + 0.5 + 0.5 * places) / pieces).ravel(), np.tile(0.5 * weights / pieces, pieces)
