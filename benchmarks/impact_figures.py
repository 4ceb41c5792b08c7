"""Figures of docs/theory/contact.md and forces.md, from the tables that impact_from_contact.py wrote."""

from pathlib import Path

import numpy as np
import pandas as pd
from impact_from_contact import on_a_mat, stiff_springs
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import rockflex as rf

FOLDER = Path(__file__).parents[1] / "docs" / "_static" / "contact"
BLACK, GRAY, GREEN, RED, BLUE = "#000000", "#8c8c8c", "#009e73", "#d55e00", "#0072b2"
OF_RATIO = {0.05: BLUE, 0.2: GREEN, 0.7: RED, 0.5: GREEN, 2.0: RED}
STYLE = {
    "font.size": 9.0,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlesize": 9.0,
    "grid.color": "#d9d9d9",
    "grid.linewidth": 0.5,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
}


def table(name: str) -> pd.DataFrame:
    return pd.read_csv(FOLDER / f"{name}.csv")


def restitution() -> Figure:
    """Restitution of blocks let go on two springs and on a bed."""
    figure = Figure(figsize=(7.4, 3.6), layout="constrained")
    found = table("free_rocking")
    left, right = figure.subplots(1, 2, sharey=True)
    for axes, kind in ((left, "two springs"), (right, "bed")):
        of_kind = found[(found["ground"] == kind) & (found["settlement"] < 0.05)]
        for slenderness in (0.1, 0.2, 0.4, 0.7):
            lines = of_kind[of_kind["slenderness"] == slenderness]
            law = lines["housner"].iloc[0]
            axes.axhline(law, color=BLACK, linewidth=0.9, linestyle="--")
            if axes is left:
                axes.text(1.2e-5, law - 0.008, f"α = {slenderness:g} rad", fontsize=8, va="top", color="#555555")
            for ratio in (0.05, 0.5, 2.0):
                one = lines[lines["damping"] == ratio]
                label = f"ζ = {ratio:g}" if slenderness == 0.1 else None
                axes.plot(one["settlement"], one["restitution"], color=OF_RATIO[ratio], label=label)
                axes.plot([8e-6], one["stiff"].iloc[:1], marker="<", color=OF_RATIO[ratio], markersize=5, clip_on=False)
        axes.set(xscale="log", title=kind)
        axes.set_xlim(8e-6, 0.04)
    left.set_ylabel("restitution e of the first landing")
    left.plot([], [], color=BLACK, linestyle="--", label="Housner")
    left.legend(loc="center left", bbox_to_anchor=(0.4, 0.48))
    figure.supxlabel(r"settlement $g/\omega_z^2$ under the weight / $(B\,\alpha_0)$", fontsize=9)
    return figure


def columns() -> Figure:
    """Energy lost by columns of any frequency."""
    figure = Figure(figsize=(6.2, 3.4), layout="constrained")
    axes, found = figure.subplots(), table("columns")
    for ratio, lines in found.groupby("damping"):
        color = OF_RATIO[ratio]
        axes.plot(lines["frequency_ratio"], lines["loss"], color=color, label=f"ζ = {ratio:g}")
        axes.plot([0.04, 0.4], [lines["first_landing"].iloc[0]] * 2, color=color, linestyle=":", linewidth=1.6)
    for value, name in ((1.0, "VVEL"), (found["housner"].iloc[0], "Housner, the structure a rigid block")):
        axes.axhline(value, color=BLACK, linewidth=0.9, linestyle="--")
        axes.text(0.011, value + 0.06, name, fontsize=8)
    axes.plot([], [], color=GRAY, linestyle=":", linewidth=1.6, label="one landing, flexure at rest")
    axes.set(
        xscale="log", ylim=(0.0, 4.1), xlabel=r"uplifted column / heave, $\omega^*_1/\omega_z$",
        ylabel="energy lost / loss of VVEL",
    )  # fmt: skip
    axes.legend(loc="center left", bbox_to_anchor=(0.03, 0.62))
    return figure


def frames() -> Figure:
    """θ_max of the structures of Table 1 over that with VVEL."""
    figure = Figure(figsize=(7.4, 5.0), layout="constrained")
    found = table("frames")
    found = found[(found["case"] == "mat") & (found["model"] == "MDOF-S") & (found["law"] == "VVEL")]
    springs = found[found["ground"] == "two springs"]
    for axes, name in zip(
        figure.subplots(2, 3, sharex=True, sharey=True).flat, sorted(set(found["structure"])), strict=True
    ):
        same = found[(found["structure"] == name) & (found["run"] == "VVEL, records + 1 %")].iloc[0]
        axes.axhspan(same["q16"], same["q84"], color="#dddddd", zorder=0, label="VVEL, records × 1.01")
        for ratio in (0.05, 0.7):
            one = springs[(springs["structure"] == name) & (springs["damping"] == ratio)]
            axes.fill_between(one["frequency_ratio"], one["q16"], one["q84"], color=OF_RATIO[ratio], alpha=0.18)
            axes.plot(one["frequency_ratio"], one["q50"], color=OF_RATIO[ratio], label=f"ζ = {ratio:g}", marker=".")
        axes.axhline(1.0, color=BLACK, linewidth=0.9, linestyle="--")
        axes.set(xscale="log", yscale="log", ylim=(0.5, 3.0), title=TITLES[name])
        axes.set_yticks([0.5, 0.7, 1.0, 1.5, 2.0, 3.0], ["0.5", "0.7", "1", "1.5", "2", "3"], minor=False)
        axes.set_yticks([], minor=True)
        axes.set_xticks([0.3, 1.0, 3.0, 10.0], ["0.3", "1", "3", "10"])
    figure.axes[0].legend(loc="upper right")
    figure.supxlabel(r"stiffness of the ground, $r = \omega_z B/(\omega_1 h^*_1)$", fontsize=9)
    figure.supylabel(r"$\theta_{max}$ on springs / $\theta_{max}$ with VVEL", fontsize=9)
    return figure


TITLES = {
    "#1": "#1: shear, 1 s, h/B = 10",
    "#2": "#2: flexure, 1 s, 10",
    "#3": "#3: shear, 0.5 s, 10",
    "#4": "#4: flexure, 0.5 s, 10",
    "#5": "#5: shear, 1 s, 5",
    "#6": "#6: flexure, 1 s, 5",
}
LAWS = {
    "VVEL": (BLUE, "VVEL"),
    "Housner": (RED, "Housner (rigid block)"),
    "generalised": (GREEN, r"$e_J$ of the momentum"),
}


def laws() -> Figure:
    """θ_max on stiff springs over that with each law."""
    figure = Figure(figsize=(7.4, 3.8), layout="constrained")
    axes = figure.subplots()
    found, blocks = table("frames"), table("blocks")
    stiff = found[(found["frequency_ratio"] == 20.0) & (found["damping"] == 0.7) & (found["ground"] == "two springs")]
    rows = [
        (f"{name}, {case}, {model}", each)
        for (name, case, model), each in stiff.groupby(["structure", "case", "model"])
    ]
    rows.sort(key=lambda row: (row[1]["e"].iloc[0], row[0]))
    rigid = blocks[(blocks["settlement"] == 1e-4) & (blocks["damping"] == 0.7) & (blocks["ground"] == "two springs")]
    rows += [(f"rigid block, α = {slenderness:g}", each) for slenderness, each in rigid.groupby("slenderness")]
    for place, (_, each) in enumerate(rows):
        for shift, (law, (color, _)) in zip((-0.22, 0.0, 0.22), LAWS.items(), strict=True):
            for one in each[each["law"] == law].itertuples():
                bar(axes, place + shift, one, color)
    axes.axvline(1.0, color=BLACK, linewidth=0.9, linestyle="--")
    for color, label in LAWS.values():
        axes.plot([], [], color=color, marker="o", markersize=4, label=label)
    axes.set_yticks(range(len(rows)), [name for name, _ in rows])
    axes.invert_yaxis()
    axes.set(
        xscale="log",
        xlabel=r"$\theta_{max}$ on stiff springs (ζ = 0.7) / $\theta_{max}$ with the law: median, 16 and 84 %",
    )
    axes.set_xticks([0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0], ["0.5", "0.7", "1", "1.5", "2", "3", "5"])
    axes.set_xticks([], minor=True)
    axes.set_xlim(0.45, 8.0)
    axes.legend(loc="center right")
    return figure


def bar(axes: Axes, place: float, one: "pd.Series[float]", color: str) -> None:
    axes.plot([one.q16, one.q84], [place, place], color=color, linewidth=2.0, solid_capstyle="butt")
    axes.plot([one.q50], [place], color=color, marker="o", markersize=4)


def forces() -> Figure:
    """M_b and V_b of the structures of Table 1 over those with VVEL."""
    figure = Figure(figsize=(7.4, 4.4), layout="constrained")
    found = table("forces")
    every = figure.subplots(2, 6, sharex=True, sharey=True)
    for column, name in enumerate(TITLES):
        mine = found[found["structure"] == name]
        same = mine[mine["run"] == "VVEL, records + 1 %"].iloc[0]
        for axes, peak in zip(every[:, column], ("moment", "shear"), strict=True):
            axes.axhspan(
                same[f"{peak}_q16"], same[f"{peak}_q84"], color="#dddddd", zorder=0, label="VVEL, records × 1.01"
            )
            for ratio in (0.05, 0.7):
                one = mine[mine["damping"] == ratio]
                label = f"ζ = {ratio:g}: median, 16 and 84 %"
                r, low, high = one["frequency_ratio"], one[f"{peak}_q16"], one[f"{peak}_q84"]
                axes.fill_between(r, low, high, color=OF_RATIO[ratio], alpha=0.18)
                axes.plot(r, one[f"{peak}_q50"], color=OF_RATIO[ratio], label=label, marker=".")
            axes.axhline(1.0, color=BLACK, linewidth=0.9, linestyle="--")
            axes.set(xscale="log", ylim=(0.4, 1.5))
            axes.set_xticks([1.0, 3.0, 10.0], ["1", "3", "10"])
            axes.set_xticks([], minor=True)
        every[0, column].set_title(TITLES[name].replace(": ", "\n").replace("h/B = ", ""))
    every[0, 0].set_ylabel("$M_b$ on springs / with VVEL")
    every[1, 0].set_ylabel("$V_b$ on springs / with VVEL")
    figure.supxlabel(r"stiffness of the ground, $r = \omega_z B/(\omega_1 h^*_1)$", fontsize=9)
    handles, labels = every[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


def landing() -> Figure:
    """One landing of #4: forces with VVEL, and on stiff springs."""
    figure = Figure(figsize=(6.6, 5.4), layout="constrained")
    p, inertia = on_a_mat("#4")
    motion = rf.load_suite("fema-p695-far-field")["FF-1-a"].scaled(2.0)
    times = np.linspace(9.34, 9.48, 6001)
    weight = p.m_tot * 9.81
    every = figure.subplots(3, 1, sharex=True)
    runs = {
        "VVEL": (BLACK, {}),
        "springs, ζ = 0.05": (BLUE, {"ratio": 0.05}),
        "springs, ζ = 0.7": (RED, {"ratio": 0.7}),
    }
    for label, (color, given) in runs.items():
        ground = {"ground": stiff_springs(p, inertia, 20.0, **given)} if given else {}
        history = rf.simulate(p, motion, "MDOF-S", work_limit=None, **ground).history
        assert history is not None
        shown = history.at(times)
        values = (shown.base_moment / p.resisting_moment, shown.base_shear / weight, shown.vertical_reaction / weight)
        for axes, value in zip(every, values, strict=True):
            axes.plot(times, value, color=color, label=label, linewidth=1.1)
    every[0].set_ylabel("$M_b / M_r$")
    every[1].set_ylabel(r"$V_b / (m_{tot}\,g)$")
    every[2].set_ylabel(r"$N / (m_{tot}\,g)$")
    every[2].set_yscale("symlog", linthresh=3.0)
    every[2].set_yticks([0.0, 1.0, 3.0, 10.0, 30.0], ["0", "1", "3", "10", "30"])
    every[2].set_xlabel("time (s)")
    figure.legend(*every[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


if __name__ == "__main__":
    for draw in (restitution, columns, frames, laws, forces, landing):
        with rc_context(STYLE):
            rf.save_figure(draw(), FOLDER / f"{draw.__name__}.png")
