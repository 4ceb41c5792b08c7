"""Fragility curves of a cloud study."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, SupportsIndex

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rockflex._cases import rows_of
from rockflex._checks import whole_number
from rockflex._errors import InputError
from rockflex.fragility import CloudFits, LogisticFit, fit_clouds, observed_fractions, rocked
from rockflex.plot._study_tables import keys_of, looks_of, measure_name, names_in, structure_panels
from rockflex.plot._style import GRAY, SHADE, SMALL, Look, Size, columns, styled

if TYPE_CHECKING:
    import pandas as pd

_POINTS = 400
_END = np.log(0.995 / 0.005)  # logit at which a curve has arrived


def plot_fragility(
    clouds: "pd.DataFrame | Sequence[CloudFits]",
    measure: str | None = None,
    *,
    confidence: float | None = None,
    overturning: bool = False,
    bins: SupportsIndex = 0,
    size: Size | None = None,
) -> Figure:
    r"""Plot the probability of rocking over an intensity measure, one panel per structure and one curve per model.

    The figure is that of Silva & Stojadinović 2024, Fig. 5: logistic curves of uplift with θ_max > 1e-4 rad. If
    all runs rock, or none, the line is flat. In the shaded range, below the weakest motion, curves are extrapolated.
    For another threshold, pass the result of `fit_clouds`.

    Parameters
    ----------
    clouds
        The table of a cloud study, such as that of `run_cloud`, or the result of `fit_clouds`.
    measure
        Column of the intensity measure; default: ``"pgv"``, or the measure of the fits.
    confidence
        Confidence of bands around the curves, between 0 and 1, by recording where the table has the column `group` or
        `motion`. Default: no bands.
    overturning
        Whether to draw the probability of overturning too, as thin lines.
    bins
        Number of groups of equally many runs, sorted by intensity, for which the fraction of rocking runs is marked;
        requires the table. Default: none.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per structure, over the measure in its unit.

    Raises
    ------
    InputError
        If the table lacks a column or holds no solved run of a structure and model, the fits use several measures or
        another one, bins are given with fits, or there are too many structures or models; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> motions = {"a": rf.ricker_pulse(2.5, 0.5), "b": rf.ricker_pulse(2.5, 1.0)}
    >>> runs = rf.run_cloud(structure, motions, "rigid", scales=[0.5, 1.0, 1.5, 2.0])
    >>> figure = rf.plot_fragility(runs, "pga")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('PGA [m/s²]', '$P(\\mathrm{uplift},\\ θ_{\\mathrm{max}}>10^{-4}\\ \\mathrm{rad})$')
    """
    groups = whole_number("bins", bins, 0)
    fits, runs = _fits(clouds, measure, groups)
    looks = looks_of(names_in(fit.model for fit in fits))
    names = names_in(fit.structure for fit in fits)
    limit = _limit(fits, runs, whole=overturning or groups > 0)
    ends = [fit.outcomes.measured[0] for fit in fits if fit.outcomes.measured is not None]
    lowest = min(ends, default=None)
    with styled(size=size):
        event = rf"\mathrm{{uplift}},\ θ_{{\mathrm{{max}}}}>{_power(fits[0].outcomes.threshold)}"
        y = "probability" if overturning else f"$P({event})$"
        figure, panels = structure_panels(names, 3, 2.1, measure_name(fits[0].measure), y)
        for axes, name in zip(panels, names, strict=True):
            for fit in (fit for fit in fits if fit.structure == name):
                look, marker = looks[fit.model]
                _draw(axes, fit, look, limit, confidence, overturning=overturning)
                if runs is not None and groups:
                    _mark(axes, rows_of(runs, fit.structure, fit.model), fit, marker, look.color, groups)
            if lowest is not None:
                axes.axvspan(0.0, lowest, color=SHADE, linewidth=0.0, label="_no runs")
            failed = sum(fit.n_failed for fit in fits if fit.structure == name)
            if failed:
                axes.text(0.97, 0.05, f"{failed} failed", transform=axes.transAxes, ha="right", fontsize=SMALL)
        panels[0].set(xlim=(0.0, limit), ylim=(-0.03, 1.03))
        handles: list[Line2D | Patch] = [*keys_of(looks, symbols=False)]
        if groups:
            handles.append(Line2D([], [], color=GRAY, marker="o", linestyle="", markersize=3.0, label="observed"))
        if overturning:
            handles.append(Line2D([], [], color=GRAY, linewidth=0.6, label="overturning"))
        if lowest is not None:
            handles.append(Patch(color=SHADE, linewidth=0.0, label="no runs"))
        labels = [str(handle.get_label()) for handle in handles]
        figure.legend(handles=handles, loc="outside upper center", ncols=columns(labels, 42 + 44 * (len(names) > 1)))
    return figure


def _fits(
    clouds: "pd.DataFrame | Sequence[CloudFits]", measure: str | None, groups: int
) -> "tuple[list[CloudFits], pd.DataFrame | None]":
    """The fits, and the solved runs if they are known."""
    if hasattr(clouds, "columns"):
        runs: pd.DataFrame = clouds  # pyright: ignore[reportAssignmentType]
        found = fit_clouds(runs, measure or "pgv")
        if not found:
            raise InputError("The table has no rows. Give what run_cloud returned.")
        return found, runs[runs["status"].notna()]
    given: list[Any] = list(clouds)
    fits = [fit for fit in given if isinstance(fit, CloudFits)]
    if not fits or len(fits) < len(given):
        raise InputError("clouds must be the table of a cloud study, or at least one fit of it from fit_clouds.")
    measures = names_in(fit.measure for fit in fits)
    if len(measures) > 1 or (measure is not None and measures != [measure]):
        wanted = "one measure" if measure is None else repr(measure)
        raise InputError(
            f"The fits are of {', '.join(measures)}, but {wanted} is to be shown. Fit the clouds with that one."
        )
    if groups:
        raise InputError("bins counts runs, but only fits were given. Give the table of the study.")
    return fits, None


def _limit(fits: list[CloudFits], runs: "pd.DataFrame | None", *, whole: bool) -> float:
    """End of the axis: where the curves of rocking approach 1, or the strongest motion if overturning is shown."""
    ends: list[float] = []
    for fit in fits:
        rocks, falls = fit.outcomes.initiation, fit.outcomes.overturning
        if isinstance(rocks, LogisticFit) and rocks.b1 > 0.0:
            ends.append(float(np.exp((_END - rocks.b0) / rocks.b1)))
        if whole and isinstance(falls, LogisticFit) and falls.b1 > 0.0:
            ends.append(2.0 * falls.median)
    if runs is None:
        return max(ends, default=1.0)
    strongest = float(runs[fits[0].measure].max())
    return strongest if whole else min(max(ends, default=strongest), strongest)


def _draw(axes: Axes, fit: CloudFits, look: Look, limit: float, confidence: float | None, *, overturning: bool) -> None:
    im = np.linspace(limit / _POINTS, limit, _POINTS)
    curves = [(fit.outcomes.initiation, 1.2, fit.model)]
    if overturning:
        curves.append((fit.outcomes.overturning, 0.6, "_overturning"))
    for curve, width, label in curves:
        if confidence is not None:
            low, high = curve.band(im, confidence)
            axes.fill_between(im, low, high, color=look.color, alpha=0.13, linewidth=0.0, label="_band")
        axes.plot(im, curve.probability(im), color=look.color, linestyle=look.dashes, linewidth=width, label=label)


def _mark(axes: Axes, runs: "pd.DataFrame", fit: CloudFits, marker: str, color: str, groups: int) -> None:
    """Fraction of rocking runs in groups of neighbouring intensities, at their geometric mean."""
    rocks = rocked(runs, fit.outcomes.threshold).to_numpy(dtype=bool)
    points = observed_fractions(runs[fit.measure].to_numpy(dtype=float), rocks, groups)
    axes.plot(
        [at for at, _ in points], [fraction for _, fraction in points],
        marker, color=color, markersize=3.0, markerfacecolor="none", markeredgewidth=0.7, label="_observed",
    )  # fmt: skip


def _power(threshold: float) -> str:
    """The threshold as mathematics."""
    digits, exponent = f"{threshold:.3e}".split("e")
    digits = f"{float(digits):g}"
    times = "" if digits == "1" else rf"{digits}\times"
    return rf"{times}10^{{{int(exponent)}}}\ \mathrm{{rad}}"
