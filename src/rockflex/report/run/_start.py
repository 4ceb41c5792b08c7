"""The state from which a run starts, if not from rest."""

import numpy as np

from rockflex.models import SpringModel
from rockflex.report.run._numbers import rounded
from rockflex.response import History

_LISTED = 3  # modes


def initial_state(history: History) -> str:
    """Return the rotation, the modal displacements and their velocities at the start, as far as they are not zero."""
    layout, state = history.model.layout, history.states[:1]
    # On springs the base may rest at an angle, from which the rotation of an initial state counts.
    rest = history.model.rest[0] if isinstance(history.model, SpringModel) else 0.0
    n = layout.modes
    values = [
        ("θ", 1e3 * (layout.of(state, layout.rotation)[0] - rest), "mrad"),
        ("θ′", layout.of(state, layout.spin)[0], "rad/s"),
        *((f"D_{k + 1}", 1e3 * layout.of(state, k)[0], "mm") for k in range(n)),
        *((f"D′_{k + 1}", layout.of(state, n + k)[0], "m/s") for k in range(n)),
    ]
    told = [f"{name} = {rounded(float(value))} {unit}" for name, value, unit in values if np.abs(value) > 1e-12]
    return ", ".join([*told[: 2 + _LISTED], *(["…"] if len(told) > 2 + _LISTED else [])])


def starts_uplifted(history: History) -> bool:
    """Return whether the base is off the ground at the start; on springs, whether an edge is."""
    return bool(history.uplifted[0])
