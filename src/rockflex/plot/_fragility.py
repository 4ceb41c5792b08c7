"""Clouds of response over intensity, and fragility: of a cloud, of stripes, and of incremental dynamic analyses."""

from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, SupportsIndex

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rockflex.foundation.cases import runs_by_case, runs_of_case
from rockflex.foundation.checks import checked_whole_number
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number
from rockflex.foundation.shown import shown
from rockflex.foundation.units import Unit
from rockflex.fragility._cloud import CloudFit
from rockflex.fragility._clouds import CloudFits, fit_clouds, fit_each_cloud, recordings_of_runs
from rockflex.fragility._limit_states import (
    NOMINAL,
    OVERTURNING,
    ROCKED,
    limit_state_of,
    observed_exceedance_fractions,
    rocked_runs,
)
from rockflex.fragility._logistic import LogisticFit
from rockflex.fragility._lognormal import LognormalFragility, fit_capacities, fit_stripes
from rockflex.plot import _figures as figures
from rockflex.plot import _study_tables as tables
from rockflex.plot._figures import BLACK, BLUE, GRAY, RED, SHADE, SMALL, LineStyle, Size
from rockflex.response._outputs import ALL_RESULTS

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.studies.stripes import StripeLimit

_POINTS = 400
_LOGIT_END = np.log(0.995 / 0.005)  # logit at which a curve has arrived
_OF_INCREMENTAL = (
    *("structure", "model", "motion", "group", "scale", "status", "max_rotation", "overturned", "resurrections"),
    *("first_overturning_scale", "last_survival_scale"),
)
_MAX_ROWS = 6  # rows of panels
_QUANTITIES = ("max_rotation", "max_top_displacement", "max_total_top_displacement", "max_ductility")
_TINY = 6.75
_ROW = 0.056  # of the panel, from row to row of the numbers in it
_CROSSES = 0.038  # and of the crosses


def plot_fragility(
    clouds: "pd.DataFrame | Sequence[CloudFits]",
    measure: str | None = None,
    *,
    confidence: float | None = None,
    overturning: bool = False,
    bins: SupportsIndex = 0,
    together: Sequence[Sequence[str]] | None = None,
    size: Size | None = None,
) -> Figure:
    r"""Plot the probability of rocking over an intensity measure, one panel per structure and one curve per model.

    Two structures a panel are Silva & Stojadinović 2024, Fig. 5: logistic curves of uplift with θ_max > 1e-4 rad. If
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
    together
        Structures that share a panel, such as ``[("#1", "#2"), ("#3", "#4")]``; each curve of the second and further
        ones is thinner, and all have their names. Default: a panel for each structure.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per structure or group of structures, over the measure in its unit.

    Raises
    ------
    InputError
        If the table lacks a column or holds no solved run of a structure and model, the fits use several measures or
        another one, bins are given with fits, or there are too many structures or models; if `together` does not have
        each structure once; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> motions = {"a": rf.ricker_pulse(2.5, 0.5), "b": rf.ricker_pulse(2.5, 1.0)}
    >>> runs = rf.run_cloud(structure, motions, "rigid",
    ...     scales=[0.5, 1.0, 1.5, 2.0])
    >>> figure = rf.plot_fragility(runs, "pga")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('PGA [m/s²]', '$P(\\mathrm{uplift},\\ θ_{\\mathrm{max}}>10^{-4}\\ \\mathrm{rad})$')
    """
    groups = checked_whole_number("bins", bins, 0)
    fits, runs = _fits_of_clouds(clouds, measure, groups)
    styles = tables.model_lines_and_symbols(tables.names_in_column(fit.model for fit in fits))
    shared = _shared_panels(tables.names_in_column(fit.structure for fit in fits), together)
    limit = _outcome_axis_limit(fits, runs, whole=overturning or groups > 0)
    ends = [fit.outcomes.measured[0] for fit in fits if fit.outcomes.measured is not None]
    lowest = min(ends, default=None)
    with figures.applied_figure_style(size=size):
        digits, exponent = f"{fits[0].outcomes.threshold:.3e}".split("e")
        times = "" if float(digits) == 1.0 else rf"{float(digits):g}\times"
        limit_text = rf"{times}10^{{{int(exponent)}}}\ \mathrm{{rad}}"
        event = rf"\mathrm{{{translated('uplift')}}},\ θ_{{\mathrm{{max}}}}>{limit_text}"
        y = translated("probability") if overturning else f"$P({event})$"
        titles = [", ".join(names) for names in shared]
        figure, panels = tables.structure_panels(titles, 3, 2.1, tables.measure_axis_name(fits[0].measure), y)
        for axes, names in zip(panels, shared, strict=True):
            for fit in (fit for name in names for fit in fits if fit.structure == name):
                style, marker = styles[fit.model]
                _draw_fragility_curve(
                    axes, fit.outcomes.initiation, limit, confidence, style,
                    linewidth=1.2 / (1 + names.index(fit.structure)), label=fit.model,
                )  # fmt: skip
                if overturning:
                    fallen = fit.outcomes.overturning
                    _draw_fragility_curve(axes, fallen, limit, confidence, style, linewidth=0.6, label="_overturning")
                if runs is not None and groups:
                    _mark_observed_fractions(
                        axes, runs_of_case(runs, fit.structure, fit.model), fit, marker, style.color, groups
                    )
            if lowest is not None:
                axes.axvspan(0.0, lowest, color=SHADE, linewidth=0.0, label="_no runs")
            if len(names) > 1:
                _name_curves(axes, fits, names, limit)
            failed = sum(fit.n_failed for fit in fits if fit.structure in names)
            if failed:
                text = translated("{n} failed", n=failed)
                axes.text(0.97, 0.05, text, transform=axes.transAxes, ha="right", fontsize=SMALL)
        panels[0].set(xlim=(0.0, limit), ylim=(-0.03, 1.03))
        handles: list[Line2D | Patch] = [*tables.model_legend_handles(styles, symbols=False)]
        if groups:
            observed = translated("observed")
            handles.append(Line2D([], [], color=GRAY, marker="o", linestyle="", markersize=3.0, label=observed))
        if overturning:
            handles.append(Line2D([], [], color=GRAY, linewidth=0.6, label=translated("overturning")))
        if lowest is not None:
            handles.append(Patch(color=SHADE, linewidth=0.0, label=translated("no runs")))
        figures.add_legend_above(figure, handles)
    return figure


def _shared_panels(names: list[str], together: Sequence[Sequence[str]] | None) -> list[list[str]]:
    """Return the structures of each panel."""
    if together is None:
        return [[name] for name in names]
    shared = [[group] if isinstance(group, str) else list(group) for group in together]
    given = [name for group in shared for name in group]
    if sorted(given) != sorted(names):
        raise InputError(
            f"together must have each structure once, of {', '.join(names)}, but {shown(together)} was given."
        )
    return shared


def _name_curves(axes: Axes, fits: list[CloudFits], names: list[str], limit: float) -> None:
    """Write the name of each structure right of its last curve, at a height of its own, or under a flat one."""
    at = np.linspace(limit / _POINTS, limit, _POINTS)
    for place, name in enumerate(names):
        height = (place + 1.0) / (len(names) + 1.0)
        curves = [fit.outcomes.initiation.probability(at) for fit in fits if fit.structure == name]
        chance = min(curves, key=lambda curve: float(np.sum(curve)))
        reached = int(np.abs(chance - height).argmin())
        flat = abs(float(chance[reached]) - height) > 0.5 * height
        point = (0.5 * limit, float(np.interp(0.5 * limit, at, chance))) if flat else (float(at[reached]), height)
        axes.annotate(
            name, point, xytext=(0, -4) if flat else (5, 0), textcoords="offset points", fontsize=SMALL,
            va="top" if flat else "center",
        )  # fmt: skip


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
    measures = tables.names_in_column(fit.measure for fit in fits)
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


def _draw_fragility_curve(
    axes: Axes, curve: Any, end: float, confidence: float | None, style: LineStyle, **line: Any
) -> None:
    """Draw a probability up to an intensity, with its band where the uncertainty of the curve is known."""
    im = np.linspace(end / _POINTS, end, _POINTS)
    axes.plot(im, curve.probability(im), **style.look, **line)
    if confidence is not None:
        low, high = curve.band(im, confidence)
        axes.fill_between(im, low, high, color=style.color, alpha=0.13, linewidth=0.0, label="_band")


def _mark_observed_fractions(
    axes: Axes, runs: "pd.DataFrame", fit: CloudFits, marker: str, color: str, groups: int
) -> None:
    """Fraction of rocking runs in groups of neighbouring intensities, at their geometric mean."""
    rocks = rocked_runs(runs, fit.outcomes.threshold).to_numpy(dtype=bool)
    observed = observed_exceedance_fractions(runs[fit.measure].to_numpy(dtype=float), rocks, groups)
    axes.plot(
        *zip(*observed, strict=True), marker, color=color, markersize=3.0, markerfacecolor="none", markeredgewidth=0.7,
        label="_observed",
    )  # fmt: skip


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
        As in `stripe_counts`: ``"overturning"``, a rotation in rad, ``"max_ductility > 4"``, ...
    measure
        Name of the measure of the levels, such as ``"pgv"``, for the axis; it is not in the table.
    confidence
        Confidence of the bands around the curves, between 0 and 1; None for no bands.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    >>> runs = pd.DataFrame({"structure": "#1", "model": "MDOF-S",
    ...     "level": levels, "nominal_overturning": fell})
    >>> runs["status"] = ["overturned" if each else "rocking" for each in fell]
    >>> runs["max_rotation"] = [1.571 if each else 0.01 for each in fell]
    >>> figure = rf.plot_stripes(runs, measure="pgv")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('PGV [m/s]', 'P(overturning)')
    """
    needed = ("structure", "model", "level", "status", "max_rotation", "nominal_overturning")
    tables.check_table_columns(runs, needed, "the table of a stripe study")
    from rockflex.studies.stripes import stripe_counts

    counts = stripe_counts(runs, limit)
    if not len(counts):
        raise InputError("No run was solved. See the column error of the table.")
    styles = tables.model_lines_and_symbols(tables.names_in_column(runs["model"]))
    names = tables.names_in_column(runs["structure"])
    end = 1.1 * float(counts["level"].max())
    with figures.applied_figure_style(size=size):
        event = translated(limit_state_of(limit).symbol)
        y = f"$P({event})$" if ">" in event else f"P({event})"
        figure, panels = tables.structure_panels(names, 3, 2.1, tables.measure_axis_name(measure), y)
        for axes, name in zip(panels, names, strict=True):
            notes: list[tuple[str, str]] = []
            for model, (style, marker) in styles.items():
                stripes = counts[(counts["structure"].astype(str) == name) & (counts["model"].astype(str) == model)]
                if not len(stripes):
                    continue
                axes.plot(
                    stripes["level"], stripes["n_exceeding"] / stripes["n_total"], marker, color=style.color,
                    markersize=3.5, markerfacecolor="none", markeredgewidth=0.8, label=f"_{model}",
                )  # fmt: skip
                fit = _fit_of_stripes(runs_of_case(runs, name, model), limit)
                if fit is None:
                    notes.append((translated("no curve fits"), style.color))
                else:
                    known = None if fit.covariance is None else confidence
                    _draw_fragility_curve(axes, fit, end, known, style, label=model)
                    notes.append((_lognormal_text(f"{fit.median:.3g}", fit.beta), style.color))
            axes.axvspan(0.0, float(counts["level"].min()), color=SHADE, linewidth=0.0, label="_no runs")
            for place, (text, color) in enumerate(reversed(notes)):
                axes.text(
                    0.97, 0.04 + 0.075 * place, text, transform=axes.transAxes, ha="right",
                    fontsize=figures.scaled_font_size(6.5), color=color,
                )  # fmt: skip
        panels[0].set(xlim=(0.0, end), ylim=(-0.03, 1.03))
        figures.add_legend_above(figure, tables.model_legend_handles(styles))
    return figure


def _lognormal_text(median: str, beta: float) -> str:
    return translated("median {median}, β = {beta}", median=median, beta=f"{beta:.2f}")


def _fit_of_stripes(runs: "pd.DataFrame", limit: "StripeLimit") -> LognormalFragility | None:
    solved = runs[runs["status"].notna()]
    exceeded = limit_state_of(limit).exceeded(solved).astype(bool)
    try:
        return fit_stripes(solved["level"], exceeded, np.ones(len(solved)), recordings_of_runs(solved))
    except (InputError, SolverError):
        return None


def plot_ida(
    runs: "pd.DataFrame", measure: str = "pga", *, confidence: float | None = 0.9, size: Size | None = None
) -> Figure:
    r"""Plot θ_max over an intensity measure, one curve per record, next to the capacities.

    Each structure and model has a row of two panels.

    Curves are interrupted where a run overturns, by the limit of the study; the first such run is a red cross at the
    top. Runs that do not overturn at a larger scale than one that did ("resurrections", Vamvatsikos & Cornell 2002)
    are open symbols. The right panel has the fraction of overturned records as steps (the Kaplan-Meier estimate if
    some never reached the limit), and the lognormal curve of `fit_capacities` with its band, by recording.

    Parameters
    ----------
    runs
        The table of an incremental study, such as that of `run_incremental`.
    measure
        Column of the intensity measure.
    confidence
        Confidence of the band around the lognormal curve, between 0 and 1; None for no band.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    tables.check_table_columns(runs, (*_OF_INCREMENTAL, measure), "what run_incremental returned")
    from rockflex.studies.incremental import incremental_capacities

    capacities = incremental_capacities(runs, measure)
    cases = list(runs_by_case(runs))
    if len(cases) > _MAX_ROWS:
        raise InputError(
            f"{len(cases)} structures and models are too many for one figure; {_MAX_ROWS} fit. Plot fewer at a time."
        )
    with figures.applied_figure_style(size=size):
        across, unit = 1 if figures.is_narrow() else 2, figures.axis_unit("rotation")
        figure = figures.new_figure(6.3, 0.9 + 2.1 * len(cases) * 2 // across)
        grid = figure.subplots(2 * len(cases) // across, across, sharex=True, squeeze=False).reshape(-1, 2)
        for row, (structure, model, ladders) in enumerate(cases):
            left, right = grid[row]
            failed = _draw_ida_curves(left, ladders, measure, unit.size)
            _draw_ida_capacities(right, runs_of_case(capacities, structure, model), confidence, failed)
            left.set(title=figures.literal_text(f"{structure}, {model}"), ylabel=unit.heading(r"$θ_{\mathrm{max}}$"))
            right.set_ylabel(f"P({translated('overturning')})")
            figures.label_panel(left, chr(ord("A") + 2 * row))
            figures.label_panel(right, chr(ord("B") + 2 * row))
        grid[0, 0].set_xlim(0.0, _ida_axis_limit(runs, capacities, measure))
        for axes in grid[-1, -across:]:
            axes.set_xlabel(tables.measure_axis_name(measure))
        handles = [
            Line2D([], [], color=GRAY, linewidth=0.7, label=translated("record")),
            Line2D([], [], color=RED, marker="x", linestyle="", markersize=3.5, label=translated("first overturning")),
            Line2D(
                [], [], color=BLUE, marker="o", linestyle="", markersize=3.0, markerfacecolor="white",
                label=translated("stands again"),
            ),
            Line2D([], [], color=BLACK, linewidth=0.9, label=translated("observed")),
            Line2D([], [], color=RED, linestyle="--", label=translated("lognormal")),
        ]  # fmt: skip
        figures.add_legend_above(figure, handles, columnspacing=1.2, handlelength=1.6)
    return figure


def _ida_axis_limit(runs: "pd.DataFrame", capacities: "pd.DataFrame", measure: str) -> float:
    """End of the axis: a little beyond the last capacity and the last run that did not overturn."""
    stood = runs[runs["overturned"].notna() & ~runs["overturned"].fillna(True).astype(bool)]
    ends = [float(values.max()) for values in (stood[measure], capacities["capacity"]) if values.notna().any()]
    return 1.05 * max(ends, default=1.0)


def _draw_ida_curves(axes: Axes, runs: "pd.DataFrame", measure: str, size: float) -> int:
    """Draw one curve per record; return how many runs failed."""
    top = 0.0
    for _, ladder in runs.groupby("motion", observed=True, sort=False):
        solved = ladder[ladder["overturned"].notna()].sort_values("scale", kind="stable")
        if not len(solved):
            continue
        fell = solved["overturned"].to_numpy(dtype=bool)
        im, rotation = solved[measure].to_numpy(dtype=float), solved["max_rotation"].to_numpy(dtype=float) / size
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
    axes.set_ylim(0.0, 1.12 * top or 0.1 / size)
    return int(runs["overturned"].isna().sum())


def _draw_ida_capacities(axes: Axes, rows: "pd.DataFrame", confidence: float | None, failed: int) -> None:
    """Draw steps of the observed fraction, the lognormal curve, and the numbers."""
    axes.set_ylim(-0.03, 1.03)
    rows = rows[rows["capacity"].notna()]
    reached, censored = rows["capacity"].to_numpy(dtype=float), rows["censored"].to_numpy(dtype=bool)
    lines = [translated("{n} record" if len(rows) == 1 else "{n} records", n=len(rows))]
    if censored.any():
        lines[0] += translated(", {n} never reached the limit", n=int(censored.sum()))
    if not censored.all():
        from scipy.stats import CensoredData, ecdf

        # Records that never reached the limit are censored.
        estimate = ecdf(CensoredData(uncensored=reached[~censored], right=reached[censored])).cdf
        at, fraction = np.append(0.0, estimate.quantiles), np.append(0.0, estimate.probabilities)
        axes.step(at, fraction, where="post", color=BLACK, linewidth=0.9, label="_ecdf")
    with suppress(InputError):  # too few records
        fit = fit_capacities(reached, censored, rows["group"])
        end = float(reached.max()) * 1.3
        known = None if fit.covariance is None else confidence
        _draw_fragility_curve(axes, fit, end, known, LineStyle(RED, "--"), linewidth=1.1, label="_fit")
        lines.append(_lognormal_text(short_number(fit.median), fit.beta))
    lines.append(translated("{n} with resurrections", n=int((rows["resurrections"] > 0).sum())))
    if failed:
        lines.append(translated("{n} run failed" if failed == 1 else "{n} runs failed", n=failed))
    axes.text(
        0.97, 0.05, "\n".join(lines), transform=axes.transAxes, ha="right", fontsize=SMALL, linespacing=1.3,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1.0},
    )  # fmt: skip


class _PlottedCloud(NamedTuple):
    """The solved runs of one structure and model, and the line through those that rocked without overturning."""

    structure: str
    model: str
    rocked: "pd.DataFrame"
    fallen: "pd.DataFrame"
    n_failed: int
    line: CloudFit | None
    fitted: bool


def plot_clouds(
    runs: "pd.DataFrame",
    quantity: Literal[
        "max_rotation", "max_top_displacement", "max_total_top_displacement", "max_ductility"
    ] = "max_rotation",
    measure: str = "pgv",
    *,
    threshold: float = ROCKED,
    nominal: bool = False,
    plain: bool = False,
    size: Size | None = None,
) -> Figure:
    r"""Plot the response of runs that rocked without overturning over an intensity measure, one panel per structure.

    The figure is that of Silva & Stojadinović 2024, Figs. 6 and 7: lines log(y) = c1 + c2 log(IM), with natural
    logarithms, by least squares, and their dispersion σ. The panel lists these values, and the numbers of runs that
    rocked (`n`) and overturned (`OV`). Overturned runs have no peak; they are crosses at the top, one row per model.
    Where there is no fit, for instance with motions of a single intensity, the panel has points without a line and a
    note.

    Parameters
    ----------
    runs
        The table of a cloud study, such as `run_cloud` returns.
    quantity
        ``"max_rotation"`` (Fig. 6), ``"max_top_displacement"`` (Fig. 7, relative to the base),
        ``"max_total_top_displacement"`` (relative to the ground) or, of stories that yield, ``"max_ductility"``.
    measure
        Column of the intensity measure.
    threshold
        A run counts as rocking if its base uplifted and its rotation in rad is larger.
    nominal
        Whether runs that exceed 0.7 atan(B/h*_1) count as overturned, as well as those that reach π/2.
    plain
        Whether to leave out the numbers and the overturned runs, as in the paper, so that the axes end at the points.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per structure, with logarithmic scales; rad or m over the measure in its unit.

    Raises
    ------
    InputError
        If the quantity is unknown, the table lacks a column or holds no solved run, a measure is not positive, or there
        are too many structures or models; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> motions = {"a": rf.ricker_pulse(2.5, 0.5), "b": rf.ricker_pulse(2.5, 1.0)}
    >>> runs = rf.run_cloud(structure, motions, "rigid",
    ...     scales=[0.5, 1.0, 1.5, 2.0])
    >>> figure = rf.plot_clouds(runs, measure="pga")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('PGA [m/s²]', '$θ_{\\mathrm{max}}$ [rad]')
    """
    if quantity not in _QUANTITIES:
        raise InputError(f"quantity must be one of {', '.join(_QUANTITIES)}, but {shown(quantity)} was given.")
    import pandas as pd

    tables.check_table_columns(runs, ("structure", "model", "status", measure, quantity), "what run_cloud returned")
    clouds = _plotted_clouds(runs, quantity, measure, threshold, nominal=nominal)
    if plain:
        clouds = [cloud._replace(fallen=cloud.fallen[:0]) for cloud in clouds]
    styles = tables.model_lines_and_symbols(tables.names_in_column(cloud.model for cloud in clouds))
    names = tables.names_in_column(cloud.structure for cloud in clouds)
    rocked, fallen = pd.concat([cloud.rocked for cloud in clouds]), pd.concat([cloud.fallen for cloud in clouds])
    with figures.applied_figure_style(size=size):
        known = ALL_RESULTS[quantity]
        y = Unit(1.0, known.si).heading(figures.symbol_in_mathematics(known.symbol))  # in SI units, as c1 in the panels
        figure, panels = tables.structure_panels(names, 2, 2.45, tables.measure_axis_name(measure), y)
        panels[0].set(xscale="log", yscale="log")
        for axes in panels:
            tables.label_log_axis_plainly(axes.xaxis)
        rows_of_text = 0 if plain else len(styles) + 1
        _set_cloud_limits(panels[0], rocked, pd.concat([rocked, fallen]), quantity, measure, rows_of_text)
        for axes, name in zip(panels, names, strict=True):
            rows: list[tuple[str, str]] = []
            for cloud in (cloud for cloud in clouds if cloud.structure == name):
                style, marker = styles[cloud.model]
                crosses = 0.97 - _CROSSES * list(styles).index(cloud.model)
                _draw_cloud(axes, cloud, quantity, measure, style, marker, crosses)
                rows.append((_cloud_numbers_text(cloud), style.color))
            if not plain:
                _write_cloud_numbers(axes, rows)
        handles = tables.model_legend_handles(styles)
        if len(fallen):
            fallen = translated("overturned")
            handles.append(Line2D([], [], color=BLACK, marker="x", linestyle="", markersize=3.0, label=fallen))
        figures.add_legend_above(figure, handles)
    return figure


def _plotted_clouds(
    runs: "pd.DataFrame", quantity: str, measure: str, threshold: float, *, nominal: bool
) -> list[_PlottedCloud]:
    """Clouds of all structures and models, in the order of the table."""
    fits, _ = fit_each_cloud(runs, measure, threshold=threshold, nominal=nominal)
    fit_of = {(fit.structure, fit.model): fit for fit in fits}
    everything = runs[runs["status"].notna()]
    if not len(everything):
        raise InputError("No run was solved. See the column error of the table.")
    bad = ~(everything[measure].to_numpy(dtype=float) > 0.0)
    if bad.any():
        raise InputError(
            f"{measure} must be positive, as its axis is logarithmic, but {int(bad.sum())} of {bad.size} values are "
            f"not. Leave those runs out: keep the rows with {measure} > 0."
        )
    clouds: list[_PlottedCloud] = []
    for structure, model, group in runs_by_case(runs):
        solved = group[group["status"].notna()]
        fell = (NOMINAL if nominal else OVERTURNING).exceeded(solved).to_numpy(dtype=bool)
        rocks = ~fell & rocked_runs(solved, threshold).to_numpy(dtype=bool)
        fit = fit_of.get((structure, model))
        line = fit and (fit.outcomes.rotation if quantity == "max_rotation" else getattr(fit, quantity[4:]))
        failed = len(group) - len(solved)
        clouds.append(_PlottedCloud(structure, model, solved[rocks], solved[fell], failed, line, fit is not None))
    return clouds


def _set_cloud_limits(
    axes: Axes, rocked: "pd.DataFrame", seen: "pd.DataFrame", quantity: str, measure: str, rows: int
) -> None:
    """Leave room for all points, the rows of numbers below them, and above them a row of crosses per row but one."""
    im = seen[measure].to_numpy(dtype=float)
    values = rocked[quantity].to_numpy(dtype=float)
    values = values[values > 0.0]
    low, high = (values.min(), values.max()) if values.size else (1e-4, 1e-1)
    left, right = (im.min(), im.max()) if im.size else (0.1, 1.0)
    below, above = 0.06 + _ROW * rows, 0.06 + _CROSSES * max(rows - 1, 0)
    height = max(float(np.log(high / low)), 0.5) / (1.0 - below - above)
    axes.set_ylim(low * np.exp(-below * height), high * np.exp(above * height))
    margin = 1.15 if right > 2.0 * left else 2.0  # of one intensity alone, wide enough for labels
    axes.set_xlim(left / margin, right * margin)


def _draw_cloud(
    axes: Axes, cloud: _PlottedCloud, quantity: str, measure: str, style: LineStyle, marker: str, crosses: float
) -> None:
    """Draw the runs that stand, their line, and at the height `crosses` those that overturned."""
    im = cloud.rocked[measure].to_numpy(dtype=float)
    axes.plot(
        im, cloud.rocked[quantity].to_numpy(dtype=float), marker, color=style.color, markersize=2.4,
        markerfacecolor="none", markeredgewidth=0.45, alpha=0.6, label=f"_{cloud.model}",
    )  # fmt: skip
    if cloud.line is not None:
        ends = np.array([im.min(), im.max()])
        axes.plot(ends, cloud.line.median(ends), **style.look, linewidth=1.3, label=cloud.model, zorder=3.0)
    axes.plot(
        cloud.fallen[measure], np.full(len(cloud.fallen), crosses), "x", color=style.color, markersize=2.6,
        markeredgewidth=0.6, transform=axes.get_xaxis_transform(), label="_overturned",
    )  # fmt: skip


def _cloud_numbers_text(cloud: _PlottedCloud) -> str:
    line = cloud.line
    three = "     –     –     –" if line is None else f"{line.c1:6.2f}{line.c2:6.2f}{line.dispersion:6.2f}"
    remarks = [translated("{n} failed", n=cloud.n_failed)] * bool(cloud.n_failed)
    remarks += [translated("no fit")] * (not cloud.fitted)
    remark = f" ({', '.join(remarks)})" if remarks else ""
    return f"{cloud.model[:9]:>9}{three}{len(cloud.rocked):5d}{len(cloud.fallen):4d}{remark}".replace("-0.00", " 0.00")


def _write_cloud_numbers(axes: Axes, rows: list[tuple[str, str]]) -> None:
    """Write the numbers of all models, the first on top, in the lower right corner."""
    header = f"{'':9}{'c₁':>6}{'c₂':>6}{'σ':>6}{'n':>5}{'OV':>4}"
    width = max(len(text) for text, _ in rows)  # remarks stand behind, and move no column
    for place, (text, color) in enumerate(reversed([(header, BLACK), *rows])):
        axes.text(
            0.985, 0.025 + _ROW * place, text.ljust(width), transform=axes.transAxes, color=color,
            fontsize=figures.scaled_font_size(_TINY), ha="right", family="DejaVu Sans Mono",
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.6, "pad": 0.5},
        )  # fmt: skip
