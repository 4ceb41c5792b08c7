"""The cheapest design over one variable, and what the others may be there."""

from typing import TYPE_CHECKING, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._checks import instance, one_of
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.plot._style import (
    BLUE,
    GREEN,
    LOOKS,
    ORANGE,
    RED,
    SMALL,
    THEMES,
    Look,
    Size,
    literal,
    narrow,
    new_figure,
    recoloured,
    styled,
)
from rockflex.plot._units import readable, short
from rockflex.study.design import BestDesign, Interpolated, margins_of, trade_off

if TYPE_CHECKING:
    import pandas as pd

_AXES = {
    "half_width": ("half_width", "half width $B$", "m"),
    "tendon_factor": ("prestress", "prestress $ΣF_0$", "N"),
    "dissipator_factor": ("dissipator_force", "force of the dissipators $ΣF_y$", "N"),
}
_LOOKS = (Look(BLUE, "-"), Look(ORANGE, "--"), Look(GREEN, "-."), *LOOKS)
_FINE = 81  # points along each side of a plane
_MARK = 4.0


class _Scale:
    """The column of a variable as it is plotted, and the name of its axis."""

    def __init__(self, variable: str, designs: "pd.DataFrame") -> None:
        self.variable = variable
        self.column, words, unit = _AXES[variable]
        if not designs[self.column].to_numpy(float).any():  # factors on forces of zero
            self.column, words, unit = variable, variable.replace("_", " "), ""
        forces = unit == "N"
        self.divisor, self.unit = readable(float(designs[self.column].max()), unit) if forces else (1.0, unit)
        self.name = f"{words} [{self.unit}]" if unit else words

    def of(self, table: "pd.DataFrame") -> "np.ndarray[tuple[int], np.dtype[np.float64]]":
        return table[self.column].to_numpy(float) / self.divisor


def plot_design_search(
    found: BestDesign, *, theme: Literal["light", "dark"] = "light", size: Size | None = None
) -> Figure:
    """Plot the least cost over the width, and the trade-off of prestress against dissipators at the best width.

    Left: the least cost at which all targets are met, as predicted by `trade_off`, in the colour of the limit that
    governs; symbols are the designs that were run, filled where they meet all targets; a ring with bars is the cheapest
    of them with its band. Right, if the search varied two variables or more: for the other values of the cheapest
    design, lines on which each limit just meets its target, the region in which one does not (shaded), and lines of
    equal cost.

    Parameters
    ----------
    found
        What `best_design` returned.
    theme
        ``"light"`` or ``"dark"``.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One or two axes.

    Raises
    ------
    InputError
        If the theme is unknown, or too few designs have probabilities of all limits; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0], refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost, model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> figure = rf.plot_design_search(rf.best_design(runs, targets, cost))
    >>> [axes.get_xlabel() for axes in figure.axes]
    ['half width $B$ [m]', 'half width $B$ [m]']
    """
    instance("found", found, BestDesign)
    if not one_of(theme, THEMES):
        raise InputError(f'theme must be "light" or "dark", but {shown(theme)} was given.')
    between = Interpolated.of(found)
    varied = [*between.given]
    labels = [each.label for each in found.requirements]
    if len(labels) > len(_LOOKS):
        raise InputError(f"{len(labels)} requirements were given, but there are {len(_LOOKS)} looks for their lines.")
    looks = dict(zip(labels, recoloured(_LOOKS), strict=False))
    with styled(theme, size=size):
        count = min(len(varied), 2)
        figure = new_figure(7.2 if count > 1 else 4.2, 0.9 + 3.0 * count if narrow() else 3.9)
        panels: list[Axes] = list(np.atleast_1d(figure.subplots(*((count, 1) if narrow() else (1, count)))))
        _draw_costs(panels[0], found, varied[0], looks)
        if len(varied) > 1:
            _draw_plane(panels[1], found, between, (varied[-2], varied[-1]), looks)
        for axes in panels:
            axes.tick_params(colors=_ink(), grid_color=mpl.rcParams["grid.color"])
        handles = [
            Line2D([], [], color=look.color, linestyle=look.dashes, label=literal(label))  # pyright: ignore[reportArgumentType]
            for label, look in looks.items()
        ]
        for name, face in (("run, meets all targets", _ink()), ("run, does not", "none")):
            handles.append(
                Line2D(
                    [], [], color="none", marker="o", markersize=_MARK, markeredgecolor=_ink(), markerfacecolor=face,
                    label=name,
                )
            )  # fmt: skip
        figure.legend(
            handles=handles,
            loc="outside upper center",
            ncols=1 if narrow() else 2,
            title=_answer(found),
            title_fontsize="medium",
        )
    return figure


def _ink() -> str:
    return str(mpl.rcParams["text.color"])


def _answer(found: BestDesign) -> str:
    if found.best is None:
        return "No design meets all targets"
    best = found.designs.iloc[found.best]
    words = [f"B = {short(best['half_width'])} m"]
    for column, symbol in (("prestress", "$ΣF_0$"), ("dissipator_force", "$ΣF_y$")):
        if best[column] > 0.0:
            divisor, unit = readable(float(best[column]), "N")
            words.append(f"{symbol} = {short(best[column] / divisor)} {unit}")
    return f"Cheapest: {', '.join(words)}; {literal(found.governs)} governs"


def _draw_costs(axes: Axes, found: BestDesign, variable: str, looks: dict[str, Look]) -> None:
    scale = _Scale(variable, found.designs)
    curve = trade_off(found, variable)
    for label, look in looks.items():
        cost = np.where(curve["governs"] == label, curve["cost"].to_numpy(float), np.nan)
        axes.plot(scale.of(curve), cost, color=look.color, linestyle=look.dashes, linewidth=1.6, label=label)
    _draw_runs(axes, scale.of(found.designs), found.designs["cost"].to_numpy(float), found)
    if found.best is not None:
        bands = {str(row["quantity"]): np.array([row["low"], row["high"]]) for row in found.interval.to_dict("records")}
        across = bands.get(scale.column, np.full(2, np.nan)) / scale.divisor
        x, y = (
            float(values[found.best]) for values in (scale.of(found.designs), found.designs["cost"].to_numpy(float))
        )
        for ends in ((across, [y, y]), ([x, x], bands["cost"])):
            axes.plot(*ends, color=_ink(), linewidth=2.0, alpha=0.6, label="_band", solid_capstyle="butt")
        _ring(axes, x, y)
    axes.set(xlabel=scale.name, ylabel="cost")


def _draw_plane(
    axes: Axes, found: BestDesign, between: Interpolated, names: tuple[str, str], looks: dict[str, Look]
) -> None:
    """Draw the limits over two variables, where the others are those of the best design or the one nearest to it."""
    designs = found.designs
    place = found.best if found.best is not None else _nearest(found)
    values = {name: np.array([float(designs[name].iloc[place])]) for name in between.given}
    for name in names:
        values[name] = np.linspace(between.given[name][0], between.given[name][-1], _FINE)
    table = between.designs(values)
    across, up = (_Scale(name, designs) for name in names)
    shape = _FINE, _FINE
    x, y = (scale.of(table).reshape(shape) for scale in (across, up))
    margins = between.at(table)
    worst = margins.max(axis=1).reshape(shape)
    axes.contourf(x, y, worst, levels=[0.0, np.inf], colors=[_ink()], alpha=0.12)
    for column, (_, look) in enumerate(looks.items()):
        each = margins[:, column].reshape(shape)
        if each.min() < 0.0 < each.max():
            axes.contour(x, y, each, levels=[0.0], colors=[look.color], linestyles=[look.dashes], linewidths=1.6)
    cost = np.asarray(found.cost.of(table["half_width"], table["prestress"], table["dissipator_force"]), dtype=float)
    if cost.max() > cost.min():
        lines = axes.contour(x, y, cost.reshape(shape), levels=6, colors=[_ink()], linewidths=0.6, linestyles="dotted")
        axes.clabel(lines, fontsize=SMALL, fmt=short)
    others = [name for name in between.given if name not in names]
    near = np.all([np.isclose(designs[name], values[name][0]) for name in others], axis=0) if others else slice(None)
    there = designs[near] if others else designs
    _draw_runs(axes, across.of(there), up.of(there), found, there["meets"].to_numpy(bool))
    if found.best is not None:
        _ring(axes, float(across.of(designs)[place]), float(up.of(designs)[place]))
    fixed = [_Scale(name, designs) for name in others]
    words = [f"{s.name.rpartition(' [')[0] or s.name} = {short(float(s.of(designs)[place]))} {s.unit}" for s in fixed]
    axes.set(xlabel=across.name, ylabel=up.name, title=", ".join(words))


def _nearest(found: BestDesign) -> int:
    labels = [each.label for each in found.requirements]
    margins = margins_of(found.designs[labels].to_numpy(float), found.requirements)
    return int(np.nan_to_num(margins, nan=np.inf).max(axis=1).argmin())


def _draw_runs(axes: Axes, x: object, y: object, found: BestDesign, meets: object = None) -> None:
    met = found.designs["meets"].to_numpy(bool) if meets is None else np.asarray(meets, dtype=bool)
    for which, face in ((~met, "none"), (met, _ink())):
        if not which.any():  # an empty line that is not clipped spoils the layout
            continue
        axes.plot(
            np.asarray(x)[which], np.asarray(y)[which], "o", markersize=_MARK, markerfacecolor=face,
            markeredgecolor=_ink(), markeredgewidth=0.6, alpha=0.75, label="_runs", clip_on=False,
        )  # fmt: skip


def _ring(axes: Axes, x: float, y: float) -> None:
    axes.plot(
        [x], [y], "o", markersize=11.0, markerfacecolor="none", markeredgecolor=RED, markeredgewidth=1.8,
        label="_best", zorder=4.0, clip_on=False,
    )  # fmt: skip
