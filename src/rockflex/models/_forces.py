"""What the base gives to the ground and what the superstructure gives to the base, as rows over the motion.

Rows run over what the model's own rows do; they hold in contact, and while a simplified model rocks. What a complete
model does while it rocks is in `_observe`.
"""

import numpy as np
from numpy.typing import NDArray

from rockflex.models._linear import LinearModel
from rockflex.models._nonlinear import NonlinearModel

__all__ = ["horizontal_row", "lost_support_row", "missing_mass_rows", "row_size"]

Array = NDArray[np.float64]


def row_size(model: LinearModel | NonlinearModel) -> int:
    """Columns of a row: [D_1..D_N, D'_1..D'_N, θ, θ', a, s], of a nonlinear model with z after θ'."""
    return 2 * model.properties.n_modes + (5 if isinstance(model, NonlinearModel) else 4)


def horizontal_row(model: LinearModel | NonlinearModel, *, rocking: bool) -> Array:
    """ΣF_x = m_tot a + L_0^r θ'' + Σ m* D'' in N, Eq. 21 for small rotations: a row."""
    p = model.properties
    rows = model.modal_accelerations(rocking=rocking)
    row = p.effective_mass @ rows
    if rocking:
        row = row + p.l0r * model.angular_acceleration()
    row[-2] += p.m_tot
    return row


def lost_support_row(model: LinearModel | NonlinearModel) -> Array:
    """By how much ΣF_z falls below its value at rest while rocking, times the side, in N: a row.

    ΣF_z = m_tot (g + s B θ'') and the pull of the tendons, Eq. 22 for small rotations with its sign mended. In contact
    it rests at m_tot g and their prestress.
    """
    p = model.properties
    row = -p.m_tot * p.half_width * model.angular_acceleration()
    row[2 * p.n_modes] -= p.half_width * p.axial_stiffness
    return row


def missing_mass_rows(model: LinearModel | NonlinearModel, *, rocking: bool) -> Array:
    """What the masses left out add to base moment and base shear, -Σ m_i h_i (a + h_i θ''), in N m and N: two rows.

    Modes above those kept follow the base at once, so their elastic forces are the inertia of their masses.
    """
    left = model.properties.mass_left_out
    rows = np.zeros((2, row_size(model)))
    rows[:, -2] = -left[1], -left[0]
    if rocking:
        rows -= np.outer((left[2], left[1]), model.angular_acceleration())
    return rows
