"""Response surfaces of the margins of the requirements, and the designs that are worth trying next."""

from collections.abc import Callable, Sequence
from itertools import product

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.study.design.search._space import DesignSearch, Point

CHUNK = 20_000  # points at once

Costs = Callable[[Array], Array]


class Surface:
    """Thin-plate splines through the margins of the designs tried, one for each requirement.

    Coordinates are counted in steps between the values that were given, so that the surface does not depend on units.

    Parameters
    ----------
    steps : ndarray, shape (n, d)
        Coordinates of the designs in the variables that are varied.
    margins : ndarray, shape (n, m)
        Their margins; designs without a margin are left out.

    Raises
    ------
    InputError
        If too few designs have margins.
    """

    def __init__(self, steps: Array, margins: Array) -> None:
        from scipy.interpolate import RBFInterpolator

        known = np.isfinite(margins).all(axis=1)
        try:
            self._at = RBFInterpolator(steps[known], margins[known], kernel="thin_plate_spline", degree=1)
        except (ValueError, np.linalg.LinAlgError) as error:
            raise InputError(
                f"Only {int(known.sum())} of {known.size} designs have all probabilities, too few to interpolate "
                "between them."
            ) from error

    def margins(self, steps: Array) -> Array:
        """Margins at other coordinates, shape (k, m)."""
        parts = [self._at(steps[start : start + CHUNK]) for start in range(0, len(steps), CHUNK)]
        return np.concatenate(parts)


def next_points(
    search: DesignSearch, level: int, tried: Sequence[Point], margins: Array, costs: Costs
) -> list[Point]:
    """Points that a refinement tries, in the order of their number; `costs` are those of values of the variables.

    One half are the cheapest designs that are expected to meet all targets, and that are the cheapest for one value of
    a variable. The other half are those among them that are farthest from all designs tried, so that the trade-off is
    known in its whole range. Where no design is expected to meet the targets, they are the closest to doing so.
    """
    axes, most = search.varied, search.designs_per_refinement
    points = np.array([*product(*search.grid(level))])
    scale = 2.0**search.refinements
    seen = np.array(tried)
    try:
        surface = Surface(seen[:, axes] / scale, margins)
    except InputError:
        return []
    worst = surface.margins(points[:, axes] / scale).max(axis=1)
    cost = costs(search.at(points))
    new = ~np.isin(_codes(points), _codes(seen))
    meets = worst <= 0.0
    if not meets.any():
        order = np.lexsort((cost, worst))
        return _listed(points[order[new[order]][:most]])
    front = np.unique(
        np.concatenate([_cheapest_of_each(points[:, axis], np.where(meets, cost, np.inf)) for axis in axes])
    )
    front = front[new[front] & meets[front]]
    front = front[np.argsort(cost[front], kind="stable")]
    chosen = [int(place) for place in front[: -(-most // 2)]]
    rest = [int(place) for place in front[len(chosen) :]]
    while rest and len(chosen) < most:
        known = np.concatenate([seen, points[chosen]])
        apart = [float(np.abs(known - points[place]).max(axis=1).min()) for place in rest]
        chosen.append(rest.pop(int(np.argmax(apart))))
    return _listed(points[chosen])


def _cheapest_of_each(values: Array, cost: Array) -> Array:
    """Place of the least cost among the points of each value."""
    order = np.lexsort((cost, values))
    return order[np.unique(values[order], return_index=True)[1]]


def _codes(points: Array) -> Array:
    """A number for each point; no grid reaches 2^20."""
    return points[:, 0] * 2**40 + points[:, 1] * 2**20 + points[:, 2]


def _listed(points: Array) -> list[Point]:
    found = [(int(b), int(tendon), int(dissipator)) for b, tendon, dissipator in points]
    return sorted(found)
