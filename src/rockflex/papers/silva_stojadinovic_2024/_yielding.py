"""Structure #1 with Bouc-Wen hysteresis under El Centro, which Figures 16 and 17 share."""

import numpy as np

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import frame_of

STRONG = 0.075  # m, D_1,y of Fig. 17
WEAK, STRONGER = 0.035, 0.045  # m, D_1,y of Fig. 16, not given in the paper
SAME = "< 1.1"  # our reading of "approximately the same", of top displacements


def run(records: Records, model: str, yield_displacement: float | None = None) -> rf.Response:
    """Run structure #1, which is elastic if no yield displacement is given."""
    law = None if yield_displacement is None else rf.BoucWen(yield_displacement)
    return rf.simulate(frame_of("#1"), records.el_centro, model, bouc_wen=law)


def largest_yielding(response: rf.Response) -> float:
    """Return the largest |z|, which is 1 at full yielding."""
    return float(np.abs(response.yielding).max())
