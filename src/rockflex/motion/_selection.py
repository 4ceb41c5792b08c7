"""Records chosen and scaled for a target spectrum."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._html import HtmlTable, span
from rockflex._shown import counted, few
from rockflex._values import Value
from rockflex.motion._choice import misfit
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._recordings import Combination, Recording
from rockflex.motion._target import TargetSpectrum

if TYPE_CHECKING:
    import pandas as pd

S = TypeVar("S", bound=Sequence[GroundMotion])


@dataclass(frozen=True, eq=False)
class Selection(HtmlTable, Value, Generic[S]):
    """Records chosen for a target spectrum, each scaled by one factor; see `Suite.select`.

    Parameters
    ----------
    target : TargetSpectrum
        The target.
    periods : ndarray, shape (m,)
        Periods in s at which spectra were compared.
    measure : {"component", "geometric mean", "rotd50", "rotd100"}
        What the ordinate of a record is: that of one component, or of the two of a pair.
    suite : Suite
        The chosen motions, scaled; the two components of a pair follow each other.
    names : tuple of tuple of str
        Names of the one or two motions of each of the n records.
    factors : ndarray, shape (n,)
        Factor by which each record was scaled.
    sa : ndarray, shape (n, m)
        Pseudo-acceleration of the scaled records in m/s².

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> chosen = suite.select(rf.ec8_spectrum(2.5, "C"), 7, (0.2, 2.0))
    >>> chosen
    Selection(7 records, misfit of the mean 0.043, least mean/target 0.92)
    >>> len(chosen.suite), chosen.factors.size, chosen.mean.shape
    (7, 7, (50,))
    """

    target: TargetSpectrum
    periods: Array
    measure: Combination
    suite: S
    names: tuple[tuple[str, ...], ...]
    factors: Array
    sa: Array

    def __repr__(self) -> str:
        return (
            f"Selection({counted(len(self.names), 'record')}, misfit of the mean {self.misfit:.2g}, "
            f"least mean/target {self.least_ratio:.2g})"
        )

    def _shown_as(self) -> Mapping[str, Any]:
        return {
            "records": f"{len(self.names)}: {few([' + '.join(names) for names in self.names])}",
            "measure": self.measure,
            "periods": f"{span(self.periods)} s",
            "factors": span(self.factors),
            "misfit of the mean": self.misfit,
            "least mean/target": self.least_ratio,
            "mean/target at a period of zero": None if math.isnan(self.zero_period_ratio) else self.zero_period_ratio,
        }

    @property
    def mean(self) -> Array:
        """Arithmetic mean of the spectra in m/s², shape (m,), which codes compare with the target."""
        return self.sa.mean(axis=0)

    @property
    def median(self) -> Array:
        """Geometric mean of the spectra in m/s², shape (m,): the median of a lognormal distribution."""
        return np.exp(np.log(self.sa).mean(axis=0))

    @property
    def dispersion(self) -> Array:
        """Standard deviation of ln S_a, shape (m,); NaN for a single record."""
        if len(self.sa) < 2:
            return np.full(self.periods.size, math.nan)
        return np.log(self.sa).std(axis=0, ddof=1)

    @property
    def misfits(self) -> Array:
        """Root mean square over the periods of ln(S_a/target) of each record, shape (n,)."""
        return misfit(self.sa / self.target.at(self.periods))

    @property
    def misfit(self) -> float:
        """Root mean square over the periods of ln(mean/target)."""
        return float(misfit(self.mean / self.target.at(self.periods)))

    @property
    def least_ratio(self) -> float:
        """Smallest ratio of the mean to the target; EN 1998-1:2004, 3.2.3.1.2, and ASCE 7-16, 16.2.3.2, ask for 0.9."""
        return float(np.min(self.mean / self.target.at(self.periods)))

    @property
    def zero_period_ratio(self) -> float:
        """Ratio of the mean to the target at a period of zero, for which EN 1998-1:2004 asks for 1.

        It is NaN where the target does not include a period of zero.
        """
        if self.target.periods[0] > 0.0:
            return math.nan
        return float(self.at([0.0]).mean() / self.target.at([0.0])[0])

    def at(self, periods: ArrayLike) -> Array:
        """Return the pseudo-acceleration of the scaled records in m/s² at other periods in s, shape (n, k).

        Raises
        ------
        InputError
            As for `GroundMotion.spectrum`.
        """
        motions = iter(self.suite)
        records = [Recording(tuple(next(motions) for _ in names)) for names in self.names]
        return np.stack([record.sa(periods, self.measure, self.target.damping_ratio) for record in records])

    def table(self) -> "pd.DataFrame":
        """Return a pandas table with one row for each record.

        Its columns are the record, what is known of it (event, year, magnitude, distance_km, vs30, station), its factor
        and misfit, and the smallest and largest ratio of its spectrum to the target.
        """
        import pandas as pd

        motions = {motion.name: motion for motion in self.suite}
        ratios = self.sa / self.target.at(self.periods)
        facts = ("event", "year", "magnitude", "distance_km", "vs30", "station")
        rows = [
            {
                "record": " + ".join(names),
                **{fact: getattr(motions[names[0]].metadata, fact, None) for fact in facts},
                "factor": factor,
                "misfit": each,
                "least_ratio": ratio.min(),
                "largest_ratio": ratio.max(),
            }
            for names, factor, each, ratio in zip(self.names, self.factors, self.misfits, ratios, strict=True)
        ]
        return pd.DataFrame(rows)

    def spectra(self) -> "pd.DataFrame":
        """Return a pandas table with one row for each period: target, statistics, and S_a of each record in m/s².

        The column of a record has its name, with "record " before it where that is the name of another column.
        """
        import pandas as pd

        columns = {
            "period": self.periods,
            "target": self.target.at(self.periods),
            "mean": self.mean,
            "median": self.median,
            "dispersion": self.dispersion,
        }
        for names, row in zip(self.names, self.sa, strict=True):
            name = " + ".join(names)
            columns[f"record {name}" if name in columns else name] = row
        return pd.DataFrame(columns)
