"""Multiple stripes: observed fractions at each level, and the lognormal curve through them."""

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._cases import rows_of
from rockflex._errors import InputError, SolverError
from rockflex.fragility import LognormalFragility, fit_stripes, recordings_of
from rockflex.plot._study_tables import check_columns, keys_of, looks_of, measure_name, names_in, structure_panels
from rockflex.plot._style import SHADE, Look, Size, columns, points, styled

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.study.stripes import StripeLimit


_POINTS = 400


def plot_stripes(
    runs: "pd.DataFrame",
    limit: "StripeLimit" = "overturning",
    measure: str = "level of the stripe",
    *,
    confidence: float | None = 0.9,
    size: Size | None = None,
) -> Figure:
    """Plot the fraction of runs that exceed a limit in each stripe, one panel per structure, one curve per model.

    The curves are those of `fit_stripes`; if the stripes do not determine one, there are only symbols. In the shaded
    range, below the lowest stripe, they are extrapolated. Bands are those of recordings, by the column `group`, else
    by `motion`; a table without either is taken as one of independent runs.

    Parameters
    ----------
    runs
        The table of a stripe study.
    limit
        ``"overturning"`` (|θ| = π/2), ``"nominal"`` (|θ| > 0.7 atan(B/h*_1)), ``"tendon_yield"``, ``"uplift"``, a
        rotation in rad, or a limit state such as ``rockflex.fragility.residual_beyond(0.005)``.
    measure
        Name of the measure of the levels, such as ``"pgv"``, for the axis; it is not in the table.
    confidence
        Confidence of the bands around the curves, between 0 and 1; None for no bands.
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
        If the table lacks a column or has no solved run, the limit is unknown, or there are too many structures or
        models; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> import pandas as pd
    >>> levels, n = [0.2] * 10 + [0.4] * 10 + [0.8] * 10, [1, 5, 9]
    >>> fell = [place % 10 < n[place // 10] for place in range(30)]
    >>> runs = pd.DataFrame({"structure": "#1", "model": "MDOF-S", "level": levels, "nominal_overturning": fell})
    >>> runs["status"] = ["overturned" if each else "rocking" for each in fell]
    >>> runs["max_rotation"] = [1.571 if each else 0.01 for each in fell]
    >>> figure = rf.plot_stripes(runs, measure="pgv")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('PGV [m/s]', 'P(overturning)')
    """
    needed = ("structure", "model", "level", "status", "max_rotation", "nominal_overturning")
    check_columns(runs, needed, "the table of a stripe study")
    from rockflex.study.stripes import stripe_counts, stripe_limit

    counts = stripe_counts(runs, limit)
    if not len(counts):
        raise InputError("No run was solved. See the column error of the table.")
    looks = looks_of(names_in(runs["model"]))
    names = names_in(runs["structure"])
    end = 1.1 * float(counts["level"].max())
    with styled(size=size):
        event = stripe_limit(limit).symbol
        y = f"$P({event})$" if ">" in event else f"P({event})"
        figure, panels = structure_panels(names, 3, 2.1, measure_name(measure), y)
        for axes, name in zip(panels, names, strict=True):
            notes: list[tuple[str, str]] = []
            for model, (look, marker) in looks.items():
                stripes = counts[(counts["structure"].astype(str) == name) & (counts["model"].astype(str) == model)]
                if len(stripes):
                    text = _draw(
                        axes, stripes, _fit(rows_of(runs, name, model), limit), model, look, marker, end, confidence
                    )
                    notes.append((text, look.color))
            axes.axvspan(0.0, float(counts["level"].min()), color=SHADE, linewidth=0.0, label="_no runs")
            for place, (text, color) in enumerate(reversed(notes)):
                axes.text(
                    0.97, 0.04 + 0.075 * place, text, transform=axes.transAxes, ha="right", fontsize=points(6.5),
                    color=color,
                )  # fmt: skip
        panels[0].set(xlim=(0.0, end), ylim=(-0.03, 1.03))
        figure.legend(handles=keys_of(looks), loc="outside upper center", ncols=columns(list(looks), 42))
    return figure


def _draw(
    axes: Axes,
    stripes: "pd.DataFrame",
    fit: LognormalFragility | None,
    model: str,
    look: Look,
    marker: str,
    end: float,
    confidence: float | None,
) -> str:
    """Draw symbols, curve and band; return their text."""
    at, events, total = (stripes[name].to_numpy(dtype=float) for name in ("level", "n_exceeding", "n_total"))
    axes.plot(
        at, events / total, marker, color=look.color, markersize=3.5, markerfacecolor="none", markeredgewidth=0.8,
        label=f"_{model}",
    )  # fmt: skip
    if fit is None:
        return "no curve fits"
    im = np.linspace(end / _POINTS, end, _POINTS)
    axes.plot(im, fit.probability(im), color=look.color, linestyle=look.dashes, label=model)
    if confidence is not None and fit.covariance is not None:
        axes.fill_between(im, *fit.band(im, confidence), color=look.color, alpha=0.13, linewidth=0.0, label="_band")
    return f"median {fit.median:.3g}, β = {fit.beta:.2f}"


def _fit(runs: "pd.DataFrame", limit: "StripeLimit") -> LognormalFragility | None:
    from rockflex.study.stripes import stripe_limit

    solved = runs[runs["status"].notna()]
    exceeded = stripe_limit(limit).exceeded(solved).astype(bool)
    try:
        return fit_stripes(solved["level"], exceeded, np.ones(len(solved)), recordings_of(solved))
    except (InputError, SolverError):
        return None
