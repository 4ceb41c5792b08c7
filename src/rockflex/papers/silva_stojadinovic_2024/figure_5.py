"""Figure 5: fragility curves of rocking, conditioned on PGV."""

from itertools import product

import numpy as np

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._cloud import cloud
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._result import Result
from rockflex.papers.silva_stojadinovic_2024._structures import MODELS, STRUCTURES
from rockflex.papers.silva_stojadinovic_2024._verdict import Verdict, stated

__all__ = ["TITLE", "reproduce"]

TITLE = "Fragility curves of rocking"
NOTE = (
    "P(θ_max > 10⁻⁴ rad) by logistic regression on log PGV. The records here are stronger than the paper's: where all "
    "runs, or all but a few, rock, a curve is flat or rests on these few."
)


def reproduce(records: Records) -> Result:
    """Fit the curves, and find where those of the models part most."""
    runs = cloud(records)
    pgv = runs["pgv"].to_numpy(dtype=float)
    grid = np.geomspace(pgv.min(), pgv.max(), 200)
    curves = {(fit.structure, fit.model): fit.outcomes.initiation.probability(grid) for fit in rf.fit_clouds(runs)}
    apart = {"shear": 0.0, "flexure": 0.0}
    for (name, (_, _, behaviour)), model in product(STRUCTURES.items(), MODELS[1:]):
        gap = float(np.abs(curves[name, model] - curves[name, "MDOF-S"]).max())
        apart[behaviour] = max(apart[behaviour], gap)
    place, ground = "Section 3.2", Verdict.OTHER_RECORDS
    numbers = (
        stated(
            "largest difference of P between MDOF-S and a 2DOF model, shear", place, "the curves agree well",
            apart["shear"], "< 0.1", ground=ground,
        ),
        stated(
            "largest difference of P between MDOF-S and a 2DOF model, flexure over shear", place,
            "largest differences for flexure-dominant structures",
            apart["flexure"] / apart["shear"] if apart["shear"] else np.inf, "> 1", ground=ground,
        ),
    )  # fmt: skip
    return Result("figure-5", TITLE, numbers, {"figure-5": lambda: rf.plot_fragility(runs)}, NOTE)
