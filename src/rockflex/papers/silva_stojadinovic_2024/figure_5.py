"""Figure 5: fragility curves of rocking, conditioned on PGV."""

from typing import TYPE_CHECKING

import numpy as np

import rockflex as rf
from rockflex._arrays import Array, Bools
from rockflex.papers.silva_stojadinovic_2024._cloud import SHEAR, THRESHOLD, cloud, codes_of
from rockflex.papers.silva_stojadinovic_2024._number import Interval, intervals_of, tendency
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import MODELS
from rockflex.report import Result

if TYPE_CHECKING:
    import pandas as pd


TITLE = "Fragility curves of rocking"
PLACE = "Section 3.2"
RESAMPLES, POINTS = 100, 50
AGREE = "< 0.1"


def reproduce(records: Records) -> Result:
    """Fit the curves, and find the largest differences between the models."""
    runs = cloud(records)
    shear, flexure, more = _gaps(runs)
    words = "the curves agree well"
    numbers = (
        tendency(
            "largest difference of P between MDOF-S and a 2DOF model, shear", PLACE, words, shear, AGREE,
            note="0.1 is our reading",
        ),
        tendency(
            "largest difference of P between MDOF-S and a 2DOF model, flexure", PLACE, words, flexure, AGREE,
            note=f"0.1 is our reading; {_few(runs)}",
        ),
        tendency(
            "largest difference of P between MDOF-S and a 2DOF model, flexure less shear", PLACE,
            "largest differences for flexure-dominant structures", more, "> 0",
        ),
    )  # fmt: skip
    note = (
        "P(θ_max > 10⁻⁴ rad) by logistic regression on log PGV, up to the PGV of the records. These records are "
        "stronger than those of the paper: if (almost) all runs rock, a curve is flat or depends on a few runs. "
        "Intervals are over resampled records."
    )
    return Result("figure-5", TITLE, numbers, {"figure-5": lambda: rf.plot_fragility(runs)}, note)


def _gaps(runs: "pd.DataFrame") -> list[Interval]:
    """Return the largest difference of P from MDOF-S: for shear, for flexure, and flexure minus shear."""
    pgv, rocks = runs["pgv"].to_numpy(dtype=float), (runs["max_rotation"] > THRESHOLD).to_numpy(dtype=bool)
    grid = np.geomspace(pgv.min(), pgv.max(), POINTS)
    rows = np.column_stack((codes_of(runs), rocks))

    def fit(im: Array, drawn: Array) -> Array:
        every = (drawn[:, 0] == i for i in range(SHEAR.size * len(MODELS)))
        curves = np.array([_curve(im[mine], drawn[mine, 1] > 0.0, grid) for mine in every])
        of = curves.reshape(SHEAR.size, len(MODELS), -1)
        gaps = np.abs(of[:, 1:] - of[:, :1]).max(axis=(1, 2))
        shear, flexure = gaps[SHEAR].max(), gaps[~SHEAR].max()
        return np.array([shear, flexure, flexure - shear])

    band = rf.bootstrap_band(
        fit, pgv, rows, runs["group"].astype(str).to_numpy(), at=np.arange(3), n=RESAMPLES, curve=lambda found, _: found
    )
    return intervals_of(band)


def _curve(pgv: Array, rocks: Bools, grid: Array) -> Array:
    """Return the probability on the grid; constant if all runs have the same outcome."""
    if rocks.all() or not rocks.any():
        return np.full(grid.size, float(rocks[0]))
    return rf.fit_logistic(pgv, rocks).probability(grid)


def _few(runs: "pd.DataFrame") -> str:
    """Show how few runs support the curves of #2, which differ the most."""
    still = runs[(runs["structure"] == "#2") & (runs["max_rotation"] <= THRESHOLD)]
    counts = still["model"].astype(str).value_counts()
    of = len(runs[(runs["structure"] == "#2") & (runs["model"] == "MDOF-S")])
    each = ", ".join(f"{counts.get(model, 0)} with {model}" for model in MODELS)
    return f"the curves of #2 depend on the runs that do not rock: {each}, of {of}"
