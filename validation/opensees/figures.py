"""Figures of the comparison; matplotlib is used directly, as these are not results of rockflex only."""

from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")

import matplotlib.pyplot as plt
from first_excursion import Excursion
from fixed_base import FixedError
from frames import Contact, Prototype, linear, load_opensees, modes
from later_cycles import DURATION, Cycles
from matplotlib.ticker import NullFormatter
from references import reference
from stepping import Scheme, march, settle

import rockflex as rf

PROTOTYPE_COLOURS = ("tab:blue", "tab:orange")
STYLE = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "legend.frameon": False,
}


def fixed_figure(errors: dict[str, list[FixedError]], dt: float, path: Path) -> Path:
    """Error on a fixed base against OpenSees' step."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(5.5, 3.8), layout="constrained")
        names = ("$u_{top}$", "$V_b$", "$M_b$")
        for (prototype, found), colour in zip(errors.items(), PROTOTYPE_COLOURS, strict=True):
            steps = [dt / error.divisions for error in found]
            for k, (name, marker) in enumerate(zip(names, "o^s", strict=True)):
                values = [error.history[k] for error in found]
                label = f"{prototype}, {name}"
                axes.loglog(steps, values, marker=marker, markersize=4, lw=1.0, color=colour, label=label)
        axes.loglog(steps, [2.0 * (h * 40.0) ** 2 for h in steps], color="0.6", lw=1.0, ls="--", label="slope 2")
        axes.axhline(1e-4, color="0.3", lw=0.8, ls=":")
        axes.set(
            xlabel="step of OpenSees (s)", ylabel="largest difference over peak", title="Fixed base: error of OpenSees"
        )
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.legend(fontsize=7)
        return _saved(figure, path)


def excursion_figure(
    prototypes: tuple[Prototype, ...], shaking: rf.GroundMotion, tables: dict[str, list[Excursion]], path: Path
) -> Path:
    """First excursion of the simplified model, and its error against contact stiffness."""
    ops = load_opensees()
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(1, 3, figsize=(11.0, 3.4), layout="constrained")
        for axes, prototype in zip(grid, prototypes, strict=False):
            wanted = reference(prototype.structure(), "MDOF-S", shaking)
            shown = np.linspace(wanted.uplift, wanted.impact, 500)
            axes.plot(shown, 1e3 * wanted.motion(shown)[0], color="black", lw=2.5, alpha=0.35, label="rockflex MDOF-S")
            for stiffness, colour in ((1e9, "tab:green"), (1e10, "tab:orange"), (1e12, "tab:red")):
                linear(ops, prototype, Contact(stiffness))
                settle(ops)
                run = march(ops, shaking, wanted.impact + 0.1, Scheme(5e-4), modes(prototype).half_width)
                seen = run.time > wanted.uplift - 0.15
                label = f"k = {stiffness:.0e}"
                axes.plot(run.time[seen], 1e3 * run.rotation[seen], color=colour, lw=0.9, label=label)
            axes.set(xlabel="t (s)", ylabel="θ (10⁻³ rad)", title=f"{prototype.name}: first excursion, ζ = 0")
            axes.legend(fontsize=7, title="OpenSees: k in N/m", title_fontsize=7, loc="upper center")
        for (name, found), colour in zip(tables.items(), PROTOTYPE_COLOURS, strict=True):
            stiffness = [row.contact for row in found]
            grid[2].loglog(
                stiffness, [row.rotation for row in found], "o-", ms=4, lw=1, color=colour, label=f"{name}, θ"
            )
            grid[2].loglog(
                stiffness, [row.top for row in found], "^--", ms=4, lw=1, color=colour, label=f"{name}, u_top"
            )
        grid[2].set(
            xlabel="contact stiffness k (N/m)", ylabel="largest difference over peak", title="Error falls like 1/k"
        )
        grid[2].legend(fontsize=7)
        return _saved(figure, path)


def cycles_figure(found: dict[str, tuple[rf.Response, list[Cycles]]], path: Path) -> Path:
    """Rotation under El Centro: VVEL, a bouncing contact, an absorbing contact."""
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(
            2, len(found), figsize=(11.0, 5.2), sharex=True, layout="constrained", squeeze=False
        )
        for column, (name, (response, cycles)) in zip(grid.T, found.items(), strict=True):
            elastic = [each for each in cycles if each.case.name == "elastic"][-1]
            absorbing = [each for each in cycles if each.case.name == "absorbing"][-1]
            for axes, each, colour in ((column[0], elastic, "tab:red"), (column[1], absorbing, "tab:blue")):
                seen = response.time <= DURATION
                axes.plot(
                    response.time[seen], 1e3 * response.rotation[seen], color="black", lw=2.5, alpha=0.35,
                    label="rockflex, VVEL",
                )  # fmt: skip
                label = f"OpenSees, {each.case.name} contact"
                axes.plot(each.run.time, 1e3 * each.run.rotation, color=colour, lw=0.8, label=label)
                axes.set(ylabel="θ (10⁻³ rad)")
                axes.legend(fontsize=7, loc="upper left")
            column[0].set_title(f"{name}: El Centro 1940 NS, damping by stiffness")
            column[1].set_xlabel("t (s)")
        return _saved(figure, path)


def _saved(figure: plt.Figure, path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=130)
    plt.close(figure)
    return path
