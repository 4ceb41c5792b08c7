"""Fragility: curves of a cloud, of stripes, and of incremental dynamic analyses."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, SupportsIndex

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rockflex._arrays import Array, Bools
from rockflex._cases import runs_of_case
from rockflex._checks import checked_whole_number
from rockflex._errors import InputError, SolverError
from rockflex._number_format import short_number
from rockflex._shown import number_with_noun
from rockflex.fragility import (
    CloudFits,
    LogisticFit,
    LognormalFragility,
    fit_capacities,
    fit_clouds,
    fit_stripes,
    observed_exceedance_fractions,
    recordings_of_runs,
    rocked_runs,
)
from rockflex.plot._study_tables import (
    check_table_columns,
    measure_axis_name,
    model_legend_handles,
    model_lines_and_symbols,
    names_in_column,
    structure_panels,
)
from rockflex.plot._style import (
    BLACK,
    BLUE,
    GRAY,
    RED,
    SHADE,
    SMALL,
    LineStyle,
    Size,
    add_legend_above,
    is_narrow_figure,
    label_panel,
    literal_text,
    new_figure,
    scaled_font_size,
    with_figure_style,
)

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.study.stripes import StripeLimit

_POINTS = 400
_LOGIT_END = np.log(0.995 / 0.005)  # logit at which a curve has arrived
_NEEDED = (
    *("structure", "model", "motion", "group", "scale", "status", "max_rotation", "overturned", "resurrections"),
    *("first_overturning_scale", "last_survival_scale"),
)
_MAX_ROWS = 6  # rows of panels
_SOURCE = "what run_incremental returned"


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
    groups = checked_whole_number("bins", bins, 0)
    fits, runs = _fits_of_clouds(clouds, measure, groups)
    styles = model_lines_and_symbols(names_in_column(fit.model for fit in fits))
    names = names_in_column(fit.structure for fit in fits)
    limit = _outcome_axis_limit(fits, runs, whole=overturning or groups > 0)
    ends = [fit.outcomes.measured[0] for fit in fits if fit.outcomes.measured is not None]
    lowest = min(ends, default=None)
    with with_figure_style(size=size):
        event = rf"\mathrm{{uplift}},\ θ_{{\mathrm{{max}}}}>{_threshold_text(fits[0].outcomes.threshold)}"
        y = "probability" if overturning else f"$P({event})$"
        figure, panels = structure_panels(names, 3, 2.1, measure_axis_name(fits[0].measure), y)
        for axes, name in zip(panels, names, strict=True):
            for fit in (fit for fit in fits if fit.structure == name):
                style, marker = styles[fit.model]
                _draw_outcome_curves(axes, fit, style, limit, confidence, overturning=overturning)
                if runs is not None and groups:
                    _mark_observed_fractions(
                        axes, runs_of_case(runs, fit.structure, fit.model), fit, marker, style.color, groups
                    )
            if lowest is not None:
                axes.axvspan(0.0, lowest, color=SHADE, linewidth=0.0, label="_no runs")
            failed = sum(fit.n_failed for fit in fits if fit.structure == name)
            if failed:
                axes.text(0.97, 0.05, f"{failed} failed", transform=axes.transAxes, ha="right", fontsize=SMALL)
        panels[0].set(xlim=(0.0, limit), ylim=(-0.03, 1.03))
        handles: list[Line2D | Patch] = [*model_legend_handles(styles, symbols=False)]
        if groups:
            handles.append(Line2D([], [], color=GRAY, marker="o", linestyle="", markersize=3.0, label="observed"))
        if overturning:
            handles.append(Line2D([], [], color=GRAY, linewidth=0.6, label="overturning"))
        if lowest is not None:
            handles.append(Patch(color=SHADE, linewidth=0.0, label="no runs"))
        add_legend_above(figure, handles)
    return figure


def _fits_of_clouds(
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
    measures = names_in_column(fit.measure for fit in fits)
    if len(measures) > 1 or (measure is not None and measures != [measure]):
        wanted = "one measure" if measure is None else repr(measure)
        raise InputError(
            f"The fits are of {', '.join(measures)}, but {wanted} is to be shown. Fit the clouds with that one."
        )
    if groups:
        raise InputError("bins counts runs, but only fits were given. Give the table of the study.")
    return fits, None


def _outcome_axis_limit(fits: list[CloudFits], runs: "pd.DataFrame | None", *, whole: bool) -> float:
    """End of the axis: where the curves of rocking approach 1, or the strongest motion if overturning is shown."""
    ends: list[float] = []
    for fit in fits:
        rocks, falls = fit.outcomes.initiation, fit.outcomes.overturning
        if isinstance(rocks, LogisticFit) and rocks.b1 > 0.0:
            ends.append(float(np.exp((_LOGIT_END - rocks.b0) / rocks.b1)))
        if whole and isinstance(falls, LogisticFit) and falls.b1 > 0.0:
            ends.append(2.0 * falls.median)
    if runs is None:
        return max(ends, default=1.0)
    strongest = float(runs[fits[0].measure].max())
    return strongest if whole else min(max(ends, default=strongest), strongest)


def _draw_outcome_curves(
    axes: Axes, fit: CloudFits, style: LineStyle, limit: float, confidence: float | None, *, overturning: bool
) -> None:
    im = np.linspace(limit / _POINTS, limit, _POINTS)
    curves = [(fit.outcomes.initiation, 1.2, fit.model)]
    if overturning:
        curves.append((fit.outcomes.overturning, 0.6, "_overturning"))
    for curve, width, label in curves:
        if confidence is not None:
            low, high = curve.band(im, confidence)
            axes.fill_between(im, low, high, color=style.color, alpha=0.13, linewidth=0.0, label="_band")
        axes.plot(im, curve.probability(im), color=style.color, linestyle=style.dashes, linewidth=width, label=label)


def _mark_observed_fractions(
    axes: Axes, runs: "pd.DataFrame", fit: CloudFits, marker: str, color: str, groups: int
) -> None:
    """Fraction of rocking runs in groups of neighbouring intensities, at their geometric mean."""
    rocks = rocked_runs(runs, fit.outcomes.threshold).to_numpy(dtype=bool)
    font_size = observed_exceedance_fractions(runs[fit.measure].to_numpy(dtype=float), rocks, groups)
    axes.plot(
        [at for at, _ in font_size], [fraction for _, fraction in font_size],
        marker, color=color, markersize=3.0, markerfacecolor="none", markeredgewidth=0.7, label="_observed",
    )  # fmt: skip


def _threshold_text(threshold: float) -> str:
    """The threshold as mathematics."""
    digits, exponent = f"{threshold:.3e}".split("e")
    digits = f"{float(digits):g}"
    times = "" if digits == "1" else rf"{digits}\times"
    return rf"{times}10^{{{int(exponent)}}}\ \mathrm{{rad}}"


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
        rotation in rad, or a limit state such as ``rockflex.fragility.residual_rotation_limit_state(0.005)``.
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
    check_table_columns(runs, needed, "the table of a stripe study")
    from rockflex.study.stripes import stripe_counts, stripe_limit_state

    counts = stripe_counts(runs, limit)
    if not len(counts):
        raise InputError("No run was solved. See the column error of the table.")
    styles = model_lines_and_symbols(names_in_column(runs["model"]))
    names = names_in_column(runs["structure"])
    end = 1.1 * float(counts["level"].max())
    with with_figure_style(size=size):
        event = stripe_limit_state(limit).symbol
        y = f"$P({event})$" if ">" in event else f"P({event})"
        figure, panels = structure_panels(names, 3, 2.1, measure_axis_name(measure), y)
        for axes, name in zip(panels, names, strict=True):
            notes: list[tuple[str, str]] = []
            for model, (style, marker) in styles.items():
                stripes = counts[(counts["structure"].astype(str) == name) & (counts["model"].astype(str) == model)]
                if len(stripes):
                    text = _draw_stripes(
                        axes,
                        stripes,
                        _fit_of_stripes(runs_of_case(runs, name, model), limit),
                        model,
                        style,
                        marker,
                        end,
                        confidence,
                    )
                    notes.append((text, style.color))
            axes.axvspan(0.0, float(counts["level"].min()), color=SHADE, linewidth=0.0, label="_no runs")
            for place, (text, color) in enumerate(reversed(notes)):
                axes.text(
                    0.97, 0.04 + 0.075 * place, text, transform=axes.transAxes, ha="right",
                    fontsize=scaled_font_size(6.5), color=color,
                )  # fmt: skip
        panels[0].set(xlim=(0.0, end), ylim=(-0.03, 1.03))
        add_legend_above(figure, model_legend_handles(styles))
    return figure


def _draw_stripes(
    axes: Axes,
    stripes: "pd.DataFrame",
    fit: LognormalFragility | None,
    model: str,
    style: LineStyle,
    marker: str,
    end: float,
    confidence: float | None,
) -> str:
    """Draw symbols, curve and band; return their text."""
    at, events, total = (stripes[name].to_numpy(dtype=float) for name in ("level", "n_exceeding", "n_total"))
    axes.plot(
        at, events / total, marker, color=style.color, markersize=3.5, markerfacecolor="none", markeredgewidth=0.8,
        label=f"_{model}",
    )  # fmt: skip
    if fit is None:
        return "no curve fits"
    im = np.linspace(end / _POINTS, end, _POINTS)
    axes.plot(im, fit.probability(im), color=style.color, linestyle=style.dashes, label=model)
    if confidence is not None and fit.covariance is not None:
        axes.fill_between(im, *fit.band(im, confidence), color=style.color, alpha=0.13, linewidth=0.0, label="_band")
    return f"median {fit.median:.3g}, β = {fit.beta:.2f}"


def _fit_of_stripes(runs: "pd.DataFrame", limit: "StripeLimit") -> LognormalFragility | None:
    from rockflex.study.stripes import stripe_limit_state

    solved = runs[runs["status"].notna()]
    exceeded = stripe_limit_state(limit).exceeded(solved).astype(bool)
    try:
        return fit_stripes(solved["level"], exceeded, np.ones(len(solved)), recordings_of_runs(solved))
    except (InputError, SolverError):
        return None


class _RecordCapacities(NamedTuple):
    """Capacities of the records of one structure and model, which of them are only bounds, and the fitted curve."""

    reached: Array
    censored: Bools
    resurrected: int
    fit: LognormalFragility | None


def plot_ida(
    runs: "pd.DataFrame", measure: str = "pga", *, confidence: float | None = 0.9, size: Size | None = None
) -> Figure:
    r"""Plot θ_max over an intensity measure, one curve per record, next to the capacities.

    Each structure and model has a row of two panels.

    Curves are interrupted where a run overturns, by the limit of the study; the first such run is a red cross at the
    top. Runs that do not overturn at a larger scale than one that did ("resurrections", Vamvatsikos & Cornell 2002)
    are open symbols. The right panel has the fraction of overturned records as steps (the Kaplan-Meier estimate if
    some never overturned), and the lognormal curve of `fit_capacities` with its band, by recording.

    Parameters
    ----------
    runs
        The table of an incremental study, such as that of `run_incremental`.
    measure
        Column of the intensity measure.
    confidence
        Confidence of the band around the lognormal curve, between 0 and 1; None for no band.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes per structure and model, over the measure in its unit: θ_max in rad, and probability.

    Raises
    ------
    InputError
        If the table lacks a column or has no rows, the measure is unknown, or there are too many structures and models;
        or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> motions = {"a": rf.ricker_pulse(2.5, 0.5), "b": rf.ricker_pulse(2.5, 1.0)}
    >>> runs = rf.run_incremental(structure, motions, "rigid", growth=1.5)
    >>> figure = rf.plot_ida(runs)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('PGA [m/s²]', '$θ_{\\mathrm{max}}$ [rad]')
    """
    check_table_columns(runs, (*_NEEDED, measure), _SOURCE)
    from rockflex.study.incremental import incremental_capacities

    capacities = incremental_capacities(runs, measure)
    groups = [(name, model) for name in names_in_column(runs["structure"]) for model in names_in_column(runs["model"])]
    groups = [group for group in groups if len(runs_of_case(runs, *group))]
    if len(groups) > _MAX_ROWS:
        raise InputError(
            f"{len(groups)} structures and models are too many for one figure; {_MAX_ROWS} fit. Plot fewer at a time."
        )
    with with_figure_style(size=size):
        across = 1 if is_narrow_figure() else 2
        figure = new_figure(6.3, 0.9 + 2.1 * len(groups) * 2 // across)
        grid = figure.subplots(2 * len(groups) // across, across, sharex=True, squeeze=False).reshape(-1, 2)
        for row, (structure, model) in enumerate(groups):
            left, right = grid[row]
            found = _record_capacities(runs_of_case(capacities, structure, model))
            failed = _draw_ida_curves(left, runs_of_case(runs, structure, model), measure)
            _draw_ida_capacities(right, found, confidence, failed)
            left.set(title=literal_text(f"{structure}, {model}"), ylabel=r"$θ_{\mathrm{max}}$ [rad]")
            right.set_ylabel("P(overturning)")
            label_panel(left, chr(ord("A") + 2 * row))
            label_panel(right, chr(ord("B") + 2 * row))
        grid[0, 0].set_xlim(0.0, _ida_axis_limit(runs, capacities, measure))
        for axes in grid[-1, -across:]:
            axes.set_xlabel(measure_axis_name(measure))
        add_legend_above(figure, _ida_legend_handles(), columnspacing=1.2, handlelength=1.6)
    return figure


def _record_capacities(rows: "pd.DataFrame") -> _RecordCapacities:
    known = rows[rows["capacity"].notna()]
    values, censored = known["capacity"].to_numpy(dtype=float), known["censored"].to_numpy(dtype=bool)
    try:
        fit = fit_capacities(values, censored, known["group"])
    except InputError:
        fit = None
    return _RecordCapacities(values, censored, int((known["resurrections"] > 0).sum()), fit)


def _ida_axis_limit(runs: "pd.DataFrame", capacities: "pd.DataFrame", measure: str) -> float:
    """End of the axis: a little beyond the last capacity and the last run that did not overturn."""
    stood = runs[runs["overturned"].notna() & ~runs["overturned"].fillna(True).astype(bool)]
    ends = [float(values.max()) for values in (stood[measure], capacities["capacity"]) if values.notna().any()]
    return 1.05 * max(ends, default=1.0)


def _draw_ida_curves(axes: Axes, runs: "pd.DataFrame", measure: str) -> int:
    """Draw one curve per record; return how many runs failed."""
    top = 0.0
    for _, ladder in runs.groupby("motion", observed=True, sort=False):
        solved = ladder[ladder["overturned"].notna()].sort_values("scale", kind="stable")
        if not len(solved):
            continue
        fell = solved["overturned"].to_numpy(dtype=bool)
        im, rotation = solved[measure].to_numpy(dtype=float), solved["max_rotation"].to_numpy(dtype=float)
        axes.plot(
            np.append(0.0, im), np.append(0.0, np.where(fell, np.nan, rotation)), color=GRAY, linewidth=0.5,
            alpha=0.8, label="_record",
        )  # fmt: skip
        top = max(top, float(rotation[~fell].max(initial=0.0)))
        if not fell.any():
            continue
        first = int(np.argmax(fell))
        axes.plot(
            [im[first]], [0.965], "x", color=RED, markersize=3.0, markeredgewidth=0.7,
            transform=axes.get_xaxis_transform(), label="_overturned",
        )  # fmt: skip
        again = ~fell & (np.arange(fell.size) > first)
        axes.plot(
            im[again], rotation[again], "o", color=BLUE, markersize=2.6, markerfacecolor="white",
            markeredgewidth=0.6, label="_resurrected", zorder=2.5,
        )  # fmt: skip
    axes.set_ylim(0.0, 1.12 * top or 0.1)
    return int(runs["overturned"].isna().sum())


def _draw_ida_capacities(axes: Axes, found: _RecordCapacities, confidence: float | None, failed: int) -> None:
    """Draw steps of the observed fraction, the lognormal curve, and the numbers."""
    axes.set_ylim(-0.03, 1.03)
    lines = [number_with_noun(found.reached.size, "record")]
    if found.censored.any():
        lines[0] += f", {int(found.censored.sum())} never overturned"
    if (~found.censored).any():
        at, fraction = _observed_capacity_fractions(found)
        axes.step(np.append(0.0, at), np.append(0.0, fraction), where="post", color=BLACK, linewidth=0.9, label="_ecdf")
    if found.fit is not None:
        end = float(found.reached.max()) * 1.3
        im = np.linspace(end / _POINTS, end, _POINTS)
        axes.plot(im, found.fit.probability(im), color=RED, linestyle="--", linewidth=1.1, label="_fit")
        if confidence is not None and found.fit.covariance is not None:
            axes.fill_between(im, *found.fit.band(im, confidence), color=RED, alpha=0.13, linewidth=0.0, label="_band")
        lines.append(f"median {short_number(found.fit.median)}, β = {found.fit.beta:.2f}")
    lines.append(f"{found.resurrected} with resurrections")
    if failed:
        lines.append(f"{number_with_noun(failed, 'run')} failed")
    axes.text(
        0.97, 0.05, "\n".join(lines), transform=axes.transAxes, ha="right", fontsize=SMALL, linespacing=1.3,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1.0},
    )  # fmt: skip


def _observed_capacity_fractions(found: _RecordCapacities) -> tuple[Array, Array]:
    """Capacities and the fraction of records up to each; records that never overturned are censored."""
    from scipy.stats import CensoredData, ecdf

    sample = CensoredData(uncensored=found.reached[~found.censored], right=found.reached[found.censored])
    estimate = ecdf(sample).cdf
    return np.asarray(estimate.quantiles), np.asarray(estimate.probabilities)


def _ida_legend_handles() -> list[Line2D]:
    return [
        Line2D([], [], color=GRAY, linewidth=0.7, label="record"),
        Line2D([], [], color=RED, marker="x", linestyle="", markersize=3.5, label="first overturning"),
        Line2D(
            [], [], color=BLUE, marker="o", linestyle="", markersize=3.0, markerfacecolor="white", label="stands again"
        ),
        Line2D([], [], color=BLACK, linewidth=0.9, label="observed"),
        Line2D([], [], color=RED, linestyle="--", label="lognormal"),
    ]
