"""Alternatives side by side: their demands under the same records, and how these differ."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import is_one_of
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.foundation.values import Value
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._outputs import COMPARED_DEMANDS
from rockflex.response._record_set import FRACTILE, MEDIAN, fractile
from rockflex.response._response import Response

if TYPE_CHECKING:
    import pandas as pd


STATISTICS = {"median": "median", "p84": "84 %", "max": "largest", "mean": "mean"}
"""The statistics over records, and what tables call them."""


_NONE = 1e-9  # in SI units: what is left by rounding


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Value):
    """The responses of alternatives to the same records, as `compare` returns them.

    Attributes
    ----------
    names : tuple of str
        Of the alternatives; the others are compared with the first.
    structures : tuple
        The alternatives themselves.
    runs : pandas.DataFrame
        A row for each alternative (`structure`) and record (`motion`), with the columns of `simulate_many`, and
        `max_story_drift` in m and `max_floor_acceleration` in m/s², the largest of all floors. `residual_rotation` is
        missing unless the runs end at rest, with ``free_vibration="settle"``.
    motion : GroundMotion
        The governing record, scaled: that under which the first alternative rotates most or, on a fixed base, has the
        largest base moment.
    responses : tuple of Response
        The response of each alternative to that record, with its history.

    Examples
    --------
    >>> import rockflex as rf
    >>> known = {"story_mass": 40e3, "base_mass": 40e3, "stiffness_ratio": 1.0,
    ...     "period": 0.5, "damping_ratio": 0.02}
    >>> narrow, wide = (rf.Frame(2, 3.0, aspect_ratio=ratio, **known)
    ...     for ratio in (8.0, 6.0))
    >>> both = rf.compare({"narrow": narrow, "wide": wide},
    ...     rf.one_sine_pulse(amplitude=3.0, period=0.8))
    >>> both.differences().loc[["max_rotation", "max_base_moment"]].round(1)
                     wide
    max_rotation     35.9
    max_base_moment  26.7
    """

    names: tuple[str, ...]
    structures: tuple[Any, ...]
    runs: "pd.DataFrame"
    motion: GroundMotion
    responses: tuple[Response, ...]

    @property
    def n_records(self) -> int:
        """Number of records."""
        return len(self.runs) // len(self.names)

    def demands(self, statistic: str = "median") -> "pd.DataFrame":
        """Return a row for each demand, in SI units, with a column for each alternative.

        Demands that no alternative has are left out. A run that overturned exceeds every value: it counts as infinity.

        Parameters
        ----------
        statistic
            Over the records: ``"median"``, ``"p84"`` (84 % of the records stay below), ``"max"`` or ``"mean"``.

        Raises
        ------
        InputError
            If the statistic is unknown.
        """
        import pandas as pd

        if not is_one_of(statistic, STATISTICS):
            raise InputError(
                f"statistic must be {', '.join(STATISTICS)}, but {shown(statistic)} was given.", field="statistic"
            )
        fell = self.runs["status"].eq("overturned").to_numpy(bool)
        found: dict[str, list[float]] = {}
        for demand in COMPARED_DEMANDS:
            values = np.abs(self.runs[demand].to_numpy(float))
            if not np.any(values > _NONE):  # nor where all are missing
                continue
            known = np.where(values <= _NONE, 0.0, values)  # no demand to divide by
            counted = np.where(fell, np.inf, known).reshape(len(self.names), -1)
            found[demand] = [_statistic_of(row, statistic) for row in counted]
        return pd.DataFrame.from_dict(found, orient="index", columns=list(self.names))

    def differences(self, statistic: str = "median") -> "pd.DataFrame":
        """Return how much more each demand is than that of the first alternative, in %, with a column for the others.

        Missing where that is zero or infinite; see `demands`.
        """
        values = self.demands(statistic)
        first = values[self.names[0]].where(lambda it: (it > 0.0) & np.isfinite(it))
        return values[list(self.names[1:])].div(first, axis=0).sub(1.0).mul(100.0)

    @property
    def overturned(self) -> tuple[int, ...]:
        """Number of records under which each alternative overturned."""
        return tuple(self.runs["status"].eq("overturned").to_numpy(bool).reshape(len(self.names), -1).sum(1).tolist())

    def __repr__(self) -> str:
        return f"Comparison({', '.join(map(repr, self.names))} under {number_with_noun(self.n_records, 'record')})"


def _statistic_of(values: Array, statistic: str) -> float:
    """Return a statistic of the demands of one alternative; NaN if it has none."""
    known = values[~np.isnan(values)]
    if known.size == 0:
        return np.nan
    if statistic in ("max", "mean"):
        return float(known.max() if statistic == "max" else known.mean())
    share = MEDIAN if statistic == "median" else FRACTILE
    return fractile(known, np.zeros(known.size, bool), share)
