"""The parameters of the integrated phases of a model."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.models import LINEAR, VERTICAL, NonlinearModel, Quantities, RockingModel
from rockflex.solve.adaptive.layout import Flow

TREMOR = 0.01  # m/s²


def flow_of(model: NonlinearModel, quantities: Quantities, tolerance: float) -> Flow:
    """Return the parameters of the integrated phases of a model."""
    own = VERTICAL if model.complete else LINEAR
    kinds = quantities.kinds if model.complete else np.full(len(quantities), LINEAR, dtype=np.int64)
    turning = [LINEAR] * (model.layout.remembered > 0)  # the row of θ'
    return Flow(
        field=model.field(),
        kinds=np.concatenate(([LINEAR], kinds, turning, [own])).astype(np.int64),
        levers=np.vstack((np.zeros((1, 2)), quantities.levers, np.zeros((1 + len(turning), 2)))),
        rest=model.properties.resting_reaction,
        scale=_scale(model),
        tolerance=tolerance,
        moving=model.layout.core + (model.bouc_wen is not None),
        counted=model.layout.memory,
    )


def flow_in(flow: Flow, pivots: Array, *, ledger: bool) -> Flow:
    """Return the parameters for one run, with its own pivots and with or without energies, which no motion needs."""
    field = flow.field._replace(pivots=pivots, ledger=ledger)
    return flow._replace(field=field, counted=flow.counted if ledger else flow.moving)


def _scale(model: RockingModel) -> Array:
    """Return the sizes of D, D', θ, θ' and z due to an acceleration of `TREMOR`; smaller errors do not matter."""
    p = model.properties
    rotation = TREMOR / GRAVITY * p.m_tot * p.half_width / p.l0r
    fall = math.sqrt(p.l0r * GRAVITY / p.i_theta)
    return np.concatenate((TREMOR / p.omega**2, TREMOR / p.omega, [rotation, rotation * fall, TREMOR / GRAVITY]))
