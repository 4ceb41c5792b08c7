"""The parts that the figures of a population share: the pairs shown, and panels of one model against another."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.plot._study_tables import check_columns
from rockflex.plot._style import GRAY, SMALL

if TYPE_CHECKING:
    import pandas as pd


BEHAVIOURS = {"shear": r"shear, $ρ=\infty$", "flexure": r"flexure, $ρ=0$"}
_FEWEST = 3  # pairs for a comparison, as in `population_statistics`
_NEEDED = ("behaviour", "status_mdof", "status_2dof")


@dataclass(frozen=True, eq=False)
class Groups:
    """Pairs by outcome, as in `population_statistics`; `left_out` gives the number of other pairs, and the reason."""

    resting: "pd.DataFrame"
    rocking: "pd.DataFrame"
    left_out: str


def groups_of(pairs: "pd.DataFrame", columns: tuple[str, ...]) -> Groups:
    """Divide the pairs into those without uplift and those that rock, according to MDOF-S.

    Raises
    ------
    InputError
        If the table lacks a column, or no pair was solved.
    """
    check_columns(pairs, (*_NEEDED, *columns), "what run_population returned")
    solved = pairs[pairs["status_mdof"].notna() & pairs["status_2dof"].notna()]
    if not len(solved):
        raise InputError("No pair was solved. See the column error of the table.")
    resting = solved[solved["status_mdof"] == "no_uplift"]
    rocking = solved[(solved["status_mdof"] == "rocking") & (solved["status_2dof"] != "overturned")]
    fallen, failed = len(solved) - len(resting) - len(rocking), len(pairs) - len(solved)
    counts = ((fallen, "overturned"), (failed, "failed"))
    return Groups(resting, rocking, ", ".join(f"{count} {word}" for count, word in counts if count))


def square_panel(axes: Axes, x: Array, y: Array, lines: list[str]) -> float:
    """Draw equal axes with the line of equality, and lines of text in the lower right corner; return their end."""
    limit = 1.06 * float(max(x.max(initial=0.0), y.max(initial=0.0))) or 1.0
    axes.plot([0.0, limit], [0.0, limit], color=GRAY, linestyle="--", linewidth=0.8, zorder=1.5, label="_equal")
    axes.set(xlim=(0.0, limit), ylim=(0.0, limit), aspect="equal")
    axes.locator_params(nbins=5)
    axes.text(
        0.97, 0.03, "\n".join(lines), transform=axes.transAxes, fontsize=SMALL, ha="right", linespacing=1.35,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0}, zorder=1.4,
    )  # fmt: skip
    return limit


def slope(x: Array, y: Array) -> float:
    """Return c1 of y = c1 x by least squares; NaN for too few pairs."""
    return float(x @ y / (x @ x)) if x.size >= _FEWEST and x.any() else math.nan


def determination(x: Array, y: Array) -> float:
    """Return R² = 1 - Σ(y - x)²/Σ(y - ȳ)² of the line y = x; NaN for too few pairs."""
    spread = float(np.sum((y - y.mean()) ** 2)) if y.size >= _FEWEST else 0.0
    return 1.0 - float(np.sum((y - x) ** 2)) / spread if spread > 0.0 else math.nan


def number(value: float, digits: int = 2) -> str:
    """Write a number with a number of decimals; a dash if it is not finite."""
    return f"{value:.{digits}f}".replace("-", "−") if np.isfinite(value) else "–"
