"""Response surfaces of the margins of the requirements, and the designs that are worth trying next."""

from collections.abc import Callable, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.study.design.search._space import DesignSearch, Point

CHUNK = 5_000  # points at once
SMOOTHINGS = (1e-6, 1e-3, 1e-2, 0.1, 1.0, 10.0)

Costs = Callable[[Array], Array]
Integer = NDArray[np.intp]


class Surface:
    """Smoothed thin-plate splines through the margins of the designs tried, one for each requirement.

    Coordinates are counted in steps between the values that were given, so that the surface does not depend on units.
    The smoothing of each spline is the one with the smallest error where each design is left out in turn (Wahba 1990,
    Spline Models for Observational Data, Chapter 4).

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
        known = np.isfinite(margins).all(axis=1)
        self._centres, values = steps[known], margins[known]
        n, d = self._centres.shape
        tail = np.column_stack((np.ones(n), self._centres))
        if n <= d + 1 or np.linalg.matrix_rank(tail) <= d:
            raise InputError(
                f"Only {int(known.sum())} of {known.size} designs have all probabilities, too few to interpolate "
                "between them."
            )
        system = np.zeros((n + d + 1, n + d + 1))
        system[:n, n:], system[n:, :n] = tail, tail.T
        bending = _bending(self._centres, self._centres)
        padded = np.vstack((values, np.zeros((d + 1, values.shape[1]))))
        least = np.full(values.shape[1], np.inf)
        self._weights = np.zeros_like(padded)
        for smoothing in SMOOTHINGS:
            system[:n, :n] = bending + smoothing * np.eye(n)
            inverse = np.linalg.pinv(system)
            weights = inverse @ padded
            left_out = ((weights[:n] / np.diag(inverse)[:n, None]) ** 2).sum(axis=0)
            better = left_out < least
            least[better], self._weights[:, better] = left_out[better], weights[:, better]

    def margins(self, steps: Array) -> Array:
        """Margins at other coordinates, shape (k, m)."""
        return np.concatenate([self._at(steps[start : start + CHUNK]) for start in range(0, len(steps), CHUNK)])

    def _at(self, steps: Array) -> Array:
        rows = np.column_stack((_bending(steps, self._centres), np.ones(len(steps)), steps))
        return rows @ self._weights


def _bending(steps: Array, centres: Array) -> Array:
    """r² log r between two sets of coordinates."""
    squares = ((steps[:, None, :] - centres[None, :, :]) ** 2).sum(axis=2)
    return 0.5 * squares * np.log(np.where(squares > 0.0, squares, 1.0))


def next_points(search: DesignSearch, level: int, tried: Sequence[Point], margins: Array, costs: Costs) -> list[Point]:
    """Points that a refinement tries, in the order of their number; `costs` are those of values of the variables.

    One half are the cheapest designs that are expected to meet all targets, and that are the cheapest for one value of
    a variable. The other half are those among them that are farthest from all designs tried, so that the trade-off is
    known in its whole range. If there are too few, those that are expected to meet or miss the targets by the least
    follow. Where no design is expected to meet the targets, they are the closest to doing so.
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
    new[chosen] = False
    nearest = np.lexsort((cost, np.abs(worst)))
    chosen += [int(place) for place in nearest[new[nearest]][: most - len(chosen)]]
    return _listed(points[chosen])


def _cheapest_of_each(values: Integer, cost: Array) -> Integer:
    """Place of the least cost among the points of each value."""
    order = np.lexsort((cost, values))
    return order[np.unique(values[order], return_index=True)[1]]


def _codes(points: Integer) -> Integer:
    """A number for each point; no grid reaches 2^20."""
    return points[:, 0] * 2**40 + points[:, 1] * 2**20 + points[:, 2]


def _listed(points: Integer) -> list[Point]:
    found = [(int(b), int(tendon), int(dissipator)) for b, tendon, dissipator in points]
    return sorted(found)
