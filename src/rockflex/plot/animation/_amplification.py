"""How much an animation enlarges displacements, so that they can be seen."""

from collections.abc import Sequence

import numpy as np

from rockflex.plot._curves import Curve
from rockflex.plot.animation._poses import Poses

ROUND = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 150.0, 200.0, 300.0,
         400.0, 500.0, 600.0, 800.0, 1000.0)  # fmt: skip
VISIBLE = 0.15  # drawn displacement of the top over the size of the structure, at most


def usual_amplification(curves: Sequence[Curve], poses: Sequence[Poses]) -> float:
    """Return the largest round number for which no structure is drawn to move by more than 0.15 of its size.

    At least 1, and 1 if one falls: a fall shows without it, and could not be told from a large rotation with it.
    """
    if any(curve.falls or curve.overturned for curve in curves):
        return 1.0
    largest = max(map(_motion, poses))
    fitting = [each for each in ROUND if each * largest <= VISIBLE]
    return fitting[-1] if fitting else 1.0


def _motion(poses: Poses) -> float:
    """Return the largest displacement in the frames over the size of the structure."""
    size = poses.outline.size
    turned = np.abs(poses.rotation) * size + np.abs(poses.sway).max(axis=1)
    moved = turned + np.abs(poses.slip) + np.abs(poses.heave)
    return float(moved.max()) / size
