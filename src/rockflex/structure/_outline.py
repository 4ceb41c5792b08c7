"""The points of a structure that drawings show, with their displacements."""

import numpy as np

from rockflex._arrays import Array
from rockflex.modal import ModalProperties, RockingProperties


def outline_of_structure(p: RockingProperties, modes: ModalProperties | None, most: int) -> tuple[Array, Array]:
    """Return the heights of a structure and how its modes displace them.

    Parameters
    ----------
    p
        Its properties. Without `modes` their floors are drawn; where they have none, a straight line to the top, or a
        block as high as its centre of mass is twice.
    modes
        Its modes, if they are known, at least as many as those of `p`.
    most
        Number of points above the base; others are left out, evenly by height.

    Returns
    -------
    heights : ndarray, shape (m,)
        From zero at the base to the top in m, ascending.
    shapes : ndarray, shape (m, n)
        Horizontal displacement of these points per unit of each D_n, relative to the base.
    """
    if modes is not None:
        heights, shapes = modes.heights, (modes.shapes * modes.participation)[:, : p.n_modes]
    elif p.floors is not None:
        heights, shapes = p.floors.heights, p.floors.displacement
    else:
        usual = 1.25 * float(np.abs(p.effective_height).max()) if p.n_modes else 2.0 * p.l0r / p.m_tot
        heights, shapes = np.array([p.top_height or usual]), p.top_ordinate[None, :]
    order = np.argsort(heights, kind="stable")  # those of freedoms may come in any order
    kept = order[np.unique(np.linspace(0, order.size - 1, min(most, order.size)).astype(int))]
    return np.append(0.0, heights[kept]), np.vstack((np.zeros(shapes.shape[1]), shapes[kept]))
