"""The energy ledger of the simplified models (Eqs. 15, 23 and 25).

The simplified equations are those of a system with the energy
½ I_θ θ'² + θ' Σ m* h* D' + ½ Σ m* D'² + ½ Σ m* ω² D² + s m_tot g B θ - ½ L_0^r g θ²
relative to the moving ground, on which the ground does the work -∫ a (L_0^r θ' + Σ m* D') dt.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.models import LinearModel
from rockflex.solve import ExactEngine

__all__ = ["EnergyLedger", "energy_ledger"]

Array = NDArray[np.float64]

REACH = 8.0  # radians of the fastest mode that one Gauss rule spans; its points then number 20 at most
MOST_PIECES = 10_000  # of an interval: a minute of quadrature for a record of a thousand samples


@dataclass(frozen=True, eq=False)
class EnergyLedger:
    """Energies in J at every node of a history, shape (n_nodes,) each, relative to the moving ground; read-only.

    ``kinetic + strain + gravity + damped + lost - input`` keeps its first value; `residual` is what it strays.

    Parameters
    ----------
    kinetic, strain, gravity
        Energy of motion, of flexure, and of the raised weight (zero in contact).
    damped, input
        Dissipated by modal damping, and put in by the ground, up to each node: quadratures of the exact states.
    lost
        Lost in the impacts up to each node, by the impact law: ½ θ'² (I_θ - Σ m* h*²) each (Eq. 25).
    impact_losses
        Loss of each impact, shape (n_impacts,).
    """

    kinetic: Array
    strain: Array
    gravity: Array
    damped: Array
    input: Array
    lost: Array
    impact_losses: Array

    @property
    def residual(self) -> Array:
        """Energy that the ledger cannot account for at each node, in J."""
        total = self.kinetic + self.strain + self.gravity + self.damped + self.lost - self.input
        return total - total[0]

    @property
    def closing_error(self) -> float:
        """Largest residual over the largest energy that went through: input, or what was there at the start."""
        start = abs(self.kinetic[0] + self.strain[0] + self.gravity[0])
        scale = max(float(np.max(np.abs(self.input))), start)
        return float(np.max(np.abs(self.residual))) / scale if scale > 0.0 else 0.0


def energy_ledger(model: LinearModel, nodes: Array) -> EnergyLedger:
    """Ledger of a history; `nodes` as in `History`.

    Raises
    ------
    InputError
        If the model is so fast against the sampling that the quadratures would be too many.
    """
    p = model.properties
    n = p.n_modes
    side, d, v = nodes[:, 1], nodes[:, 3 : 3 + n], nodes[:, 3 + n : 3 + 2 * n]
    rotation, spin = nodes[:, -2], nodes[:, -1]
    lever = p.effective_mass * p.effective_height
    kinetic = 0.5 * p.i_theta * spin**2 + spin * (v @ lever) + 0.5 * v**2 @ p.effective_mass
    impact = np.flatnonzero((side[:-1] != 0.0) & (side[1:] == 0.0))
    losses = 0.5 * spin[impact] ** 2 * model.free_inertia
    lost = np.zeros(nodes.shape[0])
    np.add.at(lost, impact + 1, losses)
    damped, work = _work(model, nodes)
    ledger = EnergyLedger(
        kinetic=kinetic,
        strain=0.5 * d**2 @ (p.effective_mass * p.omega**2),
        gravity=side * p.resisting_moment * rotation - 0.5 * p.l0r * GRAVITY * rotation**2,
        damped=np.concatenate(([0.0], np.cumsum(damped))),
        input=np.concatenate(([0.0], np.cumsum(work))),
        lost=np.cumsum(lost),
        impact_losses=losses,
    )
    for values in vars(ledger).values():
        values.setflags(write=False)
    return ledger


def _work(model: LinearModel, nodes: Array) -> tuple[Array, Array]:
    """Energy damped and put in between neighbouring nodes, (n_nodes - 1,) each, by Gauss quadrature."""
    p = model.properties
    n = p.n_modes
    empty = np.zeros((0, 2 * n + 4))
    engine = ExactEngine(model, empty, empty)
    span = np.diff(nodes[:, 0])
    places, weights = _rule(model.label, engine.fastest, float(span.max(initial=0.0)))
    drag = 2.0 * p.zeta * p.omega * p.effective_mass
    damped, work = np.zeros(span.size), np.zeros(span.size)
    for place, weight in zip(places, weights, strict=True):
        states = engine.between(nodes, float(place))
        v = states[:, n : 2 * n]
        acceleration = nodes[:-1, 2] + place * np.diff(nodes[:, 2])
        damped += weight * span * (v**2 @ drag)
        work -= weight * span * acceleration * (p.l0r * states[:, -1] + v @ p.effective_mass)
    return damped, work


def _rule(label: str, fastest: float, longest: float) -> tuple[Array, Array]:
    """Places in [0, 1] and weights of a composite Gauss rule for states that turn or decay at `fastest` (rad/s)."""
    pieces = max(math.ceil(fastest * longest / REACH), 1)
    if pieces > MOST_PIECES:
        message = (
            f"The energy ledger of {label} needs {pieces} quadratures a step, above the limit of {MOST_PIECES}: the "
            f"model turns or decays at up to {fastest:.3g} rad/s, and steps last up to {longest:.3g} s. Keep fewer "
            "modes, damp them less, or refine the record."
        )
        raise InputError(message)
    places, weights = np.polynomial.legendre.leggauss(8 + math.ceil(1.5 * fastest * longest / pieces))
    starts = np.arange(pieces)[:, None]
    return ((starts + 0.5 + 0.5 * places) / pieces).ravel(), np.tile(0.5 * weights / pieces, pieces)
