"""Where the uncertainty of an annual rate comes from: records, structure, model and hazard, and their interactions."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_instance, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.fragility._annual_rate import hazard_quadrature
from rockflex.fragility._arguments import Curve, FragilityCurve, checked_confidence, checked_fragility_curve
from rockflex.fragility._hazard import HazardCurve
from rockflex.fragility._hazard_branches import HazardBranches
from rockflex.fragility._jackknife import sampled_by_recordings

if TYPE_CHECKING:
    import pandas as pd

SOURCES = ("structure", "model", "records", "hazard")


@dataclass(frozen=True, eq=False)
class RateShares(Value):
    """An annual rate of failure, or a probability of it, with all its uncertainty, and where that comes from.

    Attributes
    ----------
    mean : float
        Mean over all sources: the rate in 1/year within the ends of the hazard curves, or the probability.
    low, high : float
        Quantiles between which it lies with the confidence asked for.
    shares : pandas.DataFrame
        A row a source: `variance` of the means by the source alone; `share`, that over the whole variance, its Sobol
        index of the first order; `total`, its total Sobol index, with all interactions that it takes part in; and the
        number of its `values`. A row ``"interactions"`` has what no source makes alone.

    Examples
    --------
    >>> import rockflex as rf
    >>> mean = rf.HazardCurve([0.1, 0.2, 0.4, 0.8], [1e-2, 3e-3, 6e-4, 1e-4])
    >>> curves = {("pier", model): rf.LognormalFragility(median, 0.4)
    ...     for model, median in {"MDOF-S": 0.5, "2DOF-S": 0.6}.items()}
    >>> found = rf.rate_shares(rf.HazardBranches.lognormal(mean, 0.6), curves)
    >>> found
    RateShares(mean 0.000345, 8.12e-05 to 0.000948)
    >>> found.shares["total"].round(2).to_dict()
    {'structure': 0.0, 'model': 0.19, 'records': 0.0, 'hazard': 0.87, 'interactions': 0.06}
    """

    mean: float
    low: float
    high: float
    shares: "pd.DataFrame"

    def __repr__(self) -> str:
        return f"RateShares(mean {self.mean:.3g}, {self.low:.3g} to {self.high:.3g})"


def rate_shares(
    hazard: HazardCurve | HazardBranches,
    curves: Mapping[tuple[str, str], FragilityCurve | Curve],
    *,
    weights: Mapping[str, float] | None = None,
    years: float | None = None,
    logarithm: bool = False,
    confidence: float = 0.9,
) -> RateShares:
    """Split the variance of an annual rate of failure among records, structure, model and hazard.

    Every fragility curve is integrated with every hazard curve, and the logarithms of the rates are drawn from the
    normal distribution of the jackknife over recordings, of all fits together. On this table, in which all sources are
    crossed, the law of total variance holds exactly: Var Y = Var E[Y|source] + E Var[Y|source].

    Parameters
    ----------
    hazard
        A curve, or branches of an uncertain one, in the measure and the unit of the fragility.
    curves
        Fragility curves by names of structure and model, as ``("pier", "MDOF-S")``, of every structure with every
        model. Fits such as ``outcomes.curve(0.02)`` know how uncertain they are from their records; a given curve
        has no such scatter.
    weights
        By names of structures and models, in proportion to the probability that each is the true one; all of one kind
        or none. Default: equal. The names are taken for all that may be, not for a sample of it.
    years
        Split the probability of at least one failure in these years, 1 - exp(-rate years). Default: the rate.
    logarithm
        Split the variance of the natural logarithm, in which factors count. `mean`, `low` and `high` stay as they are.
    confidence
        Confidence of `low` and `high`, in [0, 1).

    Raises
    ------
    InputError
        If a structure lacks a model, fits have different numbers of recordings, a weight is not positive or of no such
        name, nothing is uncertain, a rate whose logarithm is wanted is zero; as for `annual_rate`.

    Examples
    --------
    >>> import rockflex as rf
    >>> blocks = {name: rf.rigid_block(slenderness=slenderness, half_diagonal=3.0)
    ...     for name, slenderness in {"wide": 0.2, "narrow": 0.18}.items()}
    >>> runs = rf.run_cloud(blocks, rf.load_suite("fema-p695-far-field")[:12],
    ...     "rigid", scales=[1.0, 2.0, 4.0])
    >>> mean = rf.HazardCurve([0.05, 0.2, 0.8, 3.2], [5e-2, 5e-3, 2e-4, 5e-6])
    >>> found = rf.rate_shares(rf.HazardBranches.lognormal(mean, 0.5),
    ...     {(fit.structure, fit.model): fit.outcomes.overturning
    ...      for fit in rf.fit_clouds(runs, "pgv")})
    >>> found.shares["values"].tolist()
    [2, 1, 2048, 24, 0]
    """
    import pandas as pd

    branches, chances = (
        (hazard.curves, hazard.weights)
        if isinstance(hazard, HazardBranches)
        else ((checked_instance("hazard", hazard, HazardCurve),), np.ones(1))
    )
    structures, models = _names(curves)
    rates = _rates(branches, {names: curves[names] for names in _crossed(structures, models)})
    rates = rates.reshape(len(structures), len(models), rates.shape[1], len(branches))
    by_source = [
        *_weights({} if weights is None else weights, structures, models),
        np.full(rates.shape[2], 1.0 / rates.shape[2]),
        chances,
    ]
    if years is not None:
        rates = -np.expm1(-checked_positive("years", years, "years") * rates)
    if not isinstance(logarithm, bool | np.bool_):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"logarithm must be True or False, but {shown(logarithm)} was given.", field="logarithm")
    if logarithm and not (rates > 0.0).all():
        raise InputError("logarithm needs rates above zero, but no run of a structure with a model fails.")
    split = np.log(rates) if logarithm else rates
    whole = float(_mean((split - _mean(split, by_source)) ** 2, by_source))
    if not whole > 1e-24 * float(_mean(split**2, by_source)):
        raise InputError(
            "There is nothing uncertain here: one structure, one model, a curve without scatter, and one hazard curve. "
            "Give HazardBranches, more curves, or fits of recordings.",
            field="curves",
        )
    rows: list[tuple[float, float, int]] = []
    for axis in range(len(SOURCES)):
        others = [place for place in range(len(SOURCES)) if place != axis]
        alone = _variance(_mean(split, by_source, others), by_source[axis : axis + 1])
        left = _variance(_mean(split, by_source, [axis]), [by_source[place] for place in others])
        rows.append((alone, (whole - left) / whole, split.shape[axis]))
    between = whole - sum(variance for variance, *_ in rows)
    table = pd.DataFrame(
        [*rows, (between, between / whole, 0)],
        columns=["variance", "total", "values"],
        index=pd.Index([*SOURCES, "interactions"], name="source"),
    )
    table.insert(1, "share", table["variance"] / whole)
    low, high = _quantiles(rates, by_source, checked_confidence(confidence))
    return RateShares(float(_mean(rates, by_source)), low, high, table)


def _names(curves: Mapping[tuple[str, str], Any]) -> tuple[list[str], list[str]]:
    """Names of the structures and of the models, in their order."""
    if not _is_mapping(curves) or not curves or not all(_is_pair(names) for names in curves):
        raise InputError(
            "curves must be one fragility curve or more by (structure, model), as {('pier', 'MDOF-S'): curve}, but "
            f"{shown(curves)} was given.",
            field="curves",
        )
    structures, models = (list(dict.fromkeys(names)) for names in zip(*curves, strict=True))
    lacking = [names for names in _crossed(structures, models) if names not in curves]
    if lacking:
        raise InputError(
            f"curves must have every structure with every model, but {shown(lacking[0])} is missing.", field="curves"
        )
    return structures, models


def _is_mapping(given: object) -> bool:
    return isinstance(given, Mapping)


def _is_pair(names: object) -> bool:
    return isinstance(names, tuple) and len(cast("tuple[object, ...]", names)) == 2


def _crossed(structures: list[str], models: list[str]) -> list[tuple[str, str]]:
    return [(structure, model) for structure in structures for model in models]


def _rates(hazard: tuple[HazardCurve, ...], curves: Mapping[tuple[str, str], Any]) -> Array:
    """Annual rates, shape (curves, draws, hazard curves)."""
    nodes = [hazard_quadrature(curve) for curve in hazard]
    im, places = np.unique(np.concatenate([each for each, _ in nodes]), return_inverse=True)
    shares = np.zeros((im.size, len(hazard)))
    columns = np.repeat(np.arange(len(hazard)), [each.size for each, _ in nodes])
    shares[places, columns] = np.concatenate([share for _, share in nodes])

    found = [_drawn_rates(curve, hazard[0], im, shares) for curve in curves.values()]
    recordings = {count for _, count in found if count}
    if len(recordings) > 1:
        raise InputError(
            f"All fits must be of the same recordings, but they have {shown(sorted(recordings))} of them.",
            field="curves",
        )
    drawn = max(len(rates) for rates, _ in found)
    return np.stack([np.broadcast_to(rates, (drawn, len(hazard))) for rates, _ in found])


def _drawn_rates(curve: Any, hazard: HazardCurve, im: Array, shares: Array) -> tuple[Array, int]:
    """Rates of a curve, shape (draws or 1, hazard curves), and the number of its recordings.

    The logarithm of the rate is drawn as the jackknife has it. Parameters drawn far out would make rates out of
    proportion.
    """
    probability = checked_fragility_curve(curve, "curves")
    hazard.check_damping(getattr(curve, "damping", None))
    best = (probability(im) @ shares)[None]
    without = curve.probability_without(im) if hasattr(curve, "probability_without") else None
    if without is not None:
        rates = without @ shares
        if len(rates) < 2 or not (np.isfinite(rates).all() and (rates > 0.0).all()):
            raise InputError(
                "A fragility curve cannot be fitted without one of its recordings. Add recordings, or choose another "
                "limit.",
                field="curves",
            )
        return np.exp(sampled_by_recordings(np.log(best), np.log(rates))), len(rates)
    known = hasattr(curve, "drawn") and getattr(curve, "covariance", ()) is not None
    return (curve.drawn(im) @ shares if known else best), 0


def _weights(given: Mapping[str, float], structures: list[str], models: list[str]) -> list[Array]:
    """Probabilities of the structures and of the models."""
    if not _is_mapping(given):
        raise InputError(
            f"weights must be a mapping from names to numbers, as {{'MDOF-S': 0.7, '2DOF-S': 0.3}}, but {shown(given)} "
            "was given.",
            field="weights",
        )
    strange = set(given) - {*structures, *models}
    wrong = {*structures} & {*models} & set(given)
    if strange or wrong:
        word = f"{shown(strange.pop())} is neither" if strange else f"{shown(wrong.pop())} is both"
        raise InputError(f"weights must be by names of structures and models, but {word}.", field="weights")
    found: list[Array] = []
    for kind, names in (("structures", structures), ("models", models)):
        some = [given[name] for name in names if name in given]
        if some and len(some) < len(names):
            raise InputError(f"weights must be of all {kind} or of none, {', '.join(names)}.", field="weights")
        each = np.array([checked_positive("weights", weight, "") for weight in some or np.ones(len(names))])
        found.append(each / each.sum())
    return found


def _mean(values: Array, weights: list[Array], axes: list[int] | None = None) -> Array:
    """The mean over some axes, by default all."""
    for axis in sorted(range(len(weights)) if axes is None else axes, reverse=True):
        values = np.moveaxis(values, axis, -1) @ weights[axis]
    return values


def _variance(values: Array, weights: list[Array]) -> float:
    return float(_mean((values - _mean(values, weights)) ** 2, weights))


def _quantiles(rates: Array, weights: list[Array], confidence: float) -> tuple[float, float]:
    """Quantiles of values with these weights on their axes."""
    chances = weights[0]
    for each in weights[1:]:
        chances = np.multiply.outer(chances, each)
    order = np.argsort(rates, axis=None)
    values, below = rates.ravel()[order], np.cumsum(chances.ravel()[order])
    places = np.searchsorted(below, (0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence)).clip(max=values.size - 1)
    return float(values[places[0]]), float(values[places[1]])
