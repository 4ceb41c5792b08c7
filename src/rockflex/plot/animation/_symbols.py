"""Lines of springs and of elements between base and ground, as on the web page."""

from collections.abc import Sequence

import numpy as np

from rockflex._arrays import Array

Polyline = Sequence[tuple[float, float]]

COLORS = {"Tendon": "#b5558a", "YieldingDissipator": "#6b7a00", "ViscousDamper": "#0f7f8c", "FrictionDamper": "#7d5a30"}
SPRING, SPRING_FREE = "#64748b", "#a9b1bb"


def coil(length: float, half: float) -> list[Polyline]:
    """Return a coil spring of a length, `half` wide to either side, as lines of (across, along)."""
    turns = [(0.0 if i in (0, 5) else half * (-1.0) ** i, share * length)
             for i, share in enumerate((0.12, 0.24, 0.4, 0.56, 0.72, 0.88))]  # fmt: skip
    return [[(0.0, 0.0), *turns, (0.0, length)]]


def strokes(kind: str, length: float) -> list[Polyline]:
    """Return the lines of an element of a class and a length, as lines of (across, along) in points."""
    if kind == "YieldingDissipator":  # a bar, thick where it is held and narrow where it yields
        side = [(3.0, 0.0), (3.0, 0.26), (1.0, 0.36), (1.0, 0.64), (3.0, 0.74), (3.0, 1.0)]
        outline = [(-x, y) for x, y in side] + side[::-1]
        return [[(x, y * length) for x, y in outline]]
    if kind == "ViscousDamper":  # a piston in a cylinder
        cylinder = [(-4.0, 0.75), (-4.0, 0.2), (4.0, 0.2), (4.0, 0.75)]
        parts = [[(0.0, 0.0), (0.0, 0.2)], cylinder, [(-2.6, 0.5), (2.6, 0.5)], [(0.0, 0.5), (0.0, 1.0)]]
        return [[(x, y * length) for x, y in part] for part in parts]
    if kind == "FrictionDamper":  # two plates with the bolt that clamps them
        plates = [[(-1.4, 0.0), (-1.4, 0.68)], [(1.4, 0.32), (1.4, 1.0)], [(-5.0, 0.5), (5.0, 0.5)]]
        return [[(x, y * length) for x, y in plate] for plate in plates]
    return [[(0.0, 0.0), (0.0, length)]]


def between(lines: Sequence[Polyline], start: Array, end: Array) -> tuple[Array, Array]:
    """Return x and y of lines of (across, along) laid from one point to another, with gaps between them."""
    direction = end - start
    along = direction / (float(np.hypot(*direction)) or 1.0)
    across = np.array([along[1], -along[0]])
    return joined([start + np.outer([u for u, _ in line], across) + np.outer([v for _, v in line], along)
                   for line in lines])  # fmt: skip


def joined(lines: Sequence[Array]) -> tuple[Array, Array]:
    """Return x and y of several lines, each of shape (k, 2), with gaps between them."""
    if not lines:
        return np.empty(0), np.empty(0)
    gap = np.full((1, 2), np.nan)
    points = np.concatenate([part for line in lines for part in (line, gap)])
    return points[:, 0], points[:, 1]
