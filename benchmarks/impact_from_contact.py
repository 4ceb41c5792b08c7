"""Tables of the studies of docs/theory/contact.md and forces.md: about half an hour on one core.

Writes docs/_static/contact/*.csv; `python benchmarks/impact_from_contact.py blocks` computes one of the tables only.
`impact_figures.py` draws them.
"""

import itertools
import math
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.integrate import solve_ivp

import rockflex as rf
from rockflex.models import housner

FOLDER = Path(__file__).parents[1] / "docs" / "_static" / "contact"
GRAVITY = 9.81
RATIOS = (0.05, 0.2, 0.7)  # damping of the heave, of critical
OVERDAMPED = 1.5  # the base does not rebound
SUITES = ("fema-p695-far-field", "fema-p695-near-field-no-pulse", "fema-p695-near-field-pulse")
TWO, BED, STRIPS = "two springs", "bed", 20
# Period in s, h*_1/B and stiffness ratio of the structures of Table 1 of Silva & Stojadinović (2024).
FRAMES = {
    "#1": (1.0, 10.0, math.inf),
    "#2": (1.0, 10.0, 0.0),
    "#3": (0.5, 10.0, math.inf),
    "#4": (0.5, 10.0, 0.0),
    "#5": (1.0, 5.0, math.inf),
    "#6": (1.0, 5.0, 0.0),
}
PEAKS = {"rotation": "max_rotation", "moment": "max_base_moment", "shear": "max_base_shear"}
VISIBLE = 0.02  # of the rotation at which the structure would stand on its edge
Row = dict[str, Any]
Array = np.ndarray


def springs(kind: str, half_width: float, mass: float, heave: float, ratio: float) -> rf.Springs:
    """Springs of a heave frequency in rad/s and a damping ratio of the heave."""
    total = mass * heave**2
    if kind == TWO:
        return rf.Springs([-half_width, half_width], 0.5 * total).damped(ratio, mass)
    strip = 2.0 * half_width / (STRIPS - 1)  # the outermost springs stand at the edges, where the stiff base pivots
    wide = half_width + 0.5 * strip
    return rf.winkler_bed(wide, 1.0, total / (2.0 * wide), n=STRIPS).damped(ratio, mass)


def with_rotary(p: rf.RockingProperties, inertia: float) -> rf.RockingProperties:
    """The same structure with the rotary inertia of base and floors in I_θ, so that rigid ground knows it too."""
    modes = (p.omega, p.effective_mass, p.effective_height, p.top_ordinate)
    scalars = (p.i_theta + inertia, p.l0r, p.m_tot, p.half_width)
    return rf.RockingProperties(
        *modes, *scalars, p.zeta, p.translational_inertia, top_height=p.top_height, base_mass=p.base_mass
    )


def contact_restitution(p: rf.RockingProperties, base_inertia: float, n_modes: int) -> float:
    """max(0, (J - m B²)/(J + m B²)), J = Σ m h² + I_b - Σ m* h*² of the modes that are slower than the contact."""
    slow = p.effective_mass[:n_modes] @ p.effective_height[:n_modes] ** 2
    inertia = p.translational_inertia + base_inertia - float(slow)
    narrow = p.m_tot * p.half_width**2
    return max(0.0, (inertia - narrow) / (inertia + narrow))


def block(slenderness: float, half_diagonal: float) -> tuple[rf.RockingProperties, float]:
    """A homogeneous block, and the base inertia that its springs need; its own is in the block already."""
    p = rf.rigid_block(slenderness, half_diagonal, 1e5)
    return p, 1e-9 * p.translational_inertia


def restitution(p: rf.RockingProperties, before: float, after: float) -> float:
    """Ratio of the rotation velocities at θ = 0 that belong to two apexes on rigid ground."""
    limit = p.resisting_moment / (p.l0r * GRAVITY)
    fall = [1.0 - (1.0 - abs(each) / limit) ** 2 for each in (before, after)]
    return math.sqrt(fall[1] / fall[0])


def first_landing(p: rf.RockingProperties, ground: rf.Ground, tilt: float) -> tuple[float, int]:
    """Restitution between the first two apexes of a block that is let go at `tilt`, and how often an edge lands."""
    limit = p.resisting_moment / (p.l0r * GRAVITY)
    quarter = math.acosh(1.0 / (1.0 - tilt / limit)) / math.sqrt(p.l0r * GRAVITY / p.i_theta)
    still = rf.quiet_motion(2.1 * quarter, dt=quarter / 500.0)
    run = rf.simulate(p, still, "rigid", ground=ground, initial=rf.InitialState(rotation=tilt), work_limit=None)
    return restitution(p, tilt, run.rotation.min()), run.n_impacts


def weightless_landing(beta: float, ratio: float, places: tuple[float, ...]) -> tuple[float, float]:
    """Landing on infinitely stiff springs, where the weight has no time to act: in units of m, B and ω_z.

    Returns the restitution, from the angular momentum about the new edge, and the share of the energy that is lost
    before the base leaves the springs. `beta` is m B²/J; all springs are equal.
    """
    x, inertia = np.array(places), 1.0 / beta

    def rate(_: float, y: Array) -> list[float]:
        down, closing = y[0] - x * y[1], y[2] - x * y[3]
        push = np.where(down < 0.0, np.maximum(0.0, -down - 2.0 * ratio * closing), 0.0) / x.size
        return [y[2], y[3], push.sum(), -(x @ push) / inertia]

    last = solve_ivp(rate, (0.0, 40.0), [0.0, 0.0, -1.0, -1.0], rtol=1e-8, atol=1e-11, max_step=0.02).y[:, -1]
    kept = (last[2] ** 2 + inertia * last[3] ** 2) / (1.0 + inertia)
    return (last[2] - inertia * last[3]) / (inertia + 1.0), 1.0 - kept


def places_of(kind: str) -> tuple[float, ...]:
    """Positions of the springs over B."""
    return (-1.0, 1.0) if kind == TWO else tuple(np.linspace(-1.0, 1.0, STRIPS))


def free_rocking() -> pd.DataFrame:
    """Blocks let go at half their largest tilt."""
    rows = []
    for slenderness in (0.1, 0.2, 0.4, 0.7):
        p, inertia = block(slenderness, 3.0)
        limit = p.resisting_moment / (p.l0r * GRAVITY)
        for kind in (TWO, BED):
            for ratio in (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0):
                beta = p.m_tot * p.half_width**2 / p.translational_inertia
                stiff = weightless_landing(beta, ratio, places_of(kind))[0]
                for settled in 10.0 ** -np.arange(1.0, 5.1, 0.5):
                    heave = math.sqrt(GRAVITY / (settled * limit * p.half_width))
                    ground = rf.Ground(springs=springs(kind, p.half_width, p.m_tot, heave, ratio), base_inertia=inertia)
                    found, landings = first_landing(p, ground, 0.5 * limit)
                    law = housner(p).e
                    rows.append((slenderness, kind, ratio, settled, law, stiff, found, landings))
    return pd.DataFrame(
        rows,
        columns=["slenderness", "ground", "damping", "settlement", "housner", "stiff", "restitution", "n_landings"],
    )


def column(frequency: float) -> tuple[rf.RockingProperties, float]:
    """One mass on a column, and the rotary inertia of its base."""
    top, height, base, b = 1e5, 10.0, 2e4, 1.5
    inertia, total = base * (2.0 * b) ** 2 / 12.0, top + base
    p = rf.RockingProperties(
        [frequency], [top], [height], [1.0], i_theta=top * height**2 + total * b**2 + inertia, l0r=top * height,
        m_tot=total, half_width=b, zeta=0.02, translational_inertia=top * height**2, base_mass=base,
    )  # fmt: skip
    return p, inertia


def columns() -> pd.DataFrame:
    """Energy that a landing takes until the next apex, over that of VVEL: columns that come down without vibrating."""
    rows, heave = list[tuple[float, ...]](), 3000.0
    p, inertia = column(1.0)
    beta = p.m_tot * p.half_width**2 / inertia
    for ratio in RATIOS:
        first = weightless_landing(beta, ratio, places_of(TWO))[1]
        for over in 10.0 ** np.arange(-2.0, 0.38, 0.125):
            p, inertia = column(1.0)
            stiffer = math.sqrt(p.i_theta / (p.i_theta - p.effective_mass[0] * p.effective_height[0] ** 2))
            p, inertia = column(over * heave / stiffer)
            start = rf.InitialState(rotation=2e-5, rotation_velocity=-0.15)
            still = rf.quiet_motion(2.0, dt=1e-3)
            ground = rf.Ground(springs=springs(TWO, p.half_width, p.m_tot, heave, ratio), base_inertia=inertia)
            run = rf.simulate(p, still, "2DOF-S", ground=ground, initial=start, work_limit=None)
            law = rf.simulate(p, still, "2DOF-S", initial=start, impact=rf.VVELSimplified())
            until = np.append(law.impact_times, law.end_time)[1]
            apex = law.time[np.argmax(np.abs(law.rotation) * ((law.time > 0.01) & (law.time < until)))]
            taken = np.interp(apex, run.time, run.energy.soil.sum(axis=1))
            spin, narrow = (
                run.rotation_velocity[np.searchsorted(run.time, run.impact_times[0])],
                p.m_tot * p.half_width**2,
            )
            rigid = (1.0 - (1.0 - 2.0 * narrow / p.i_theta) ** 2) * p.i_theta / (narrow + inertia)
            rows.append((ratio, over, apex, taken / (0.5 * spin**2 * (narrow + inertia)), first, rigid))
    return pd.DataFrame(rows, columns=["damping", "frequency_ratio", "apex", "loss", "first_landing", "housner"])


def records(step: int) -> list[rf.GroundMotion]:
    """Every so many-th component of the three suites of FEMA P-695."""
    return [motion for suite in SUITES for motion in list(rf.load_suite(suite))[::step]]


@dataclass(frozen=True)
class Bench:
    """One structure under every so many-th record, with one model and the scales of the records."""

    p: rf.RockingProperties
    model: str
    scales: tuple[float, ...]
    step: int = 2

    def peaks(self, more: float = 1.0, **options: Any) -> pd.DataFrame:
        """Peaks and counts of events; `more` scales the records further."""
        scales = [more * each for each in self.scales]
        made = rf.simulate_many(
            self.p, records(self.step), self.model, scales=scales, output="peaks", workers=1, work_limit=None, **options
        )
        made["scale"] /= more
        return made.set_index(["motion", "scale"])[["status", "n_impacts", "min_vertical_reaction", *PEAKS.values()]]

    def kept(self, run: pd.DataFrame, law: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
        """Return the runs that stand and visibly rock in both, and which runs fell."""
        both = run.join(law.add_suffix("_law"))
        limit = self.p.resisting_moment / (self.p.l0r * GRAVITY)
        fell = both[["status", "status_law"]] == "overturned"
        return both[~fell.any(axis=1) & (both["max_rotation_law"] > VISIBLE * limit)], fell

    def forces(self, run: pd.DataFrame, law: pd.DataFrame) -> dict[str, float]:
        """Quantiles of the ratios of peaks, their share above 1.1, and medians without and with N < 0 by the law."""
        kept, _ = self.kept(run, law)
        pressed = kept["min_vertical_reaction_law"] >= 0.0
        found: dict[str, float] = {"runs": len(kept), "runs_pressed": int(pressed.sum())}
        for name, peak in PEAKS.items():
            ratio = kept[peak] / kept[f"{peak}_law"]
            found |= {f"{name}_q{q}": ratio.quantile(q / 100.0) for q in (16, 50, 84)}
            found |= {f"{name}_pressed": ratio[pressed].median(), f"{name}_pulled": ratio[~pressed].median()}
            found[f"{name}_above"] = float((ratio > 1.1).mean())
        return found

    def compared(self, run: pd.DataFrame, law: pd.DataFrame) -> dict[str, float]:
        """Quantiles of the ratio of θ_max over the runs that stand and visibly rock in both."""
        kept, fell = self.kept(run, law)
        ratio = kept["max_rotation"] / kept["max_rotation_law"]
        return {
            "runs": len(kept),
            "overturned": int(fell["status"].sum()),
            "overturned_law": int(fell["status_law"].sum()),
            **{f"q{q}": ratio.quantile(q / 100.0) for q in (16, 50, 84)},
            "landings": kept["n_impacts"].median(),
            "impacts_law": kept["n_impacts_law"].median(),
        }


def compare(bench: Bench, laws: dict[str, rf.ImpactLaw], grounds: Iterable[tuple[Row, rf.Ground]]) -> list[Row]:
    """One row for each ground and law; first those of the laws among themselves, and with records 1 % stronger."""
    of = {name: bench.peaks(impact=law) for name, law in laws.items()}
    first = next(iter(laws))
    rows: list[Row] = [
        {"run": each, "law": first} | bench.compared(of[each], of[first]) for each in laws if each != first
    ]
    stronger = bench.peaks(1.01, impact=laws[first])
    rows.append({"run": f"{first}, records + 1 %", "law": first} | bench.compared(stronger, of[first]))
    for row, ground in grounds:
        run = bench.peaks(ground=ground)
        rows += [{"run": "contact", **row, "law": name} | bench.compared(run, of[name]) for name in laws]
    return rows


def bare_frame(name: str) -> rf.RockingProperties:
    """A structure of Table 1, whose base has no rotary inertia."""
    period, slender, stiffness_ratio = FRAMES[name]
    frame = rf.Frame(
        n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=stiffness_ratio,
        period=period, aspect_ratio=slender, damping_ratio=0.02,
    )  # fmt: skip
    return frame.rocking()


def on_a_mat(name: str) -> tuple[rf.RockingProperties, float]:
    """The same on a mat of the width of the base, and the rotary inertia of the mat."""
    bare = bare_frame(name)
    inertia = bare.base_mass * bare.half_width**2 / 3.0
    return with_rotary(bare, inertia), inertia


def stiff_springs(p: rf.RockingProperties, inertia: float, over: float, ratio: float) -> rf.Ground:
    """Two springs of the stiffness r and the damping ζ."""
    heave = over * p.omega[0] * p.effective_height[0] / p.half_width
    return rf.Ground(springs=springs(TWO, p.half_width, p.m_tot, heave, ratio), base_inertia=inertia)


def forces() -> pd.DataFrame:
    """Peaks of the structures of Table 1 on mats over those with VVEL: with Housner's law, and on springs.

    Overdamped springs take fewer records, because their runs are slow.
    """
    rows: list[Row] = []
    for name in FRAMES:
        p, inertia = on_a_mat(name)
        bench, few = Bench(p, "MDOF-S", (1.0, 2.0)), Bench(p, "MDOF-S", (1.0, 2.0), step=8)
        vvel = rf.VVELSimplified()
        law, others = bench.peaks(impact=vvel), {"Housner": bench.peaks(impact=housner(p))}
        others["VVEL, records + 1 %"] = bench.peaks(1.01, impact=vvel)
        rows += [{"structure": name, "run": run} | bench.forces(found, law) for run, found in others.items()]
        for over, ratio in itertools.product((1.0, 2.0, 3.0, 5.0, 10.0, 20.0), (*RATIOS, OVERDAMPED)):
            run = (few if ratio == OVERDAMPED else bench).peaks(ground=stiff_springs(p, inertia, over, ratio))
            row = {"structure": name, "run": "contact", "frequency_ratio": over, "damping": ratio}
            rows.append(row | bench.forces(run, law))
        print(name, "forces", flush=True)
    return pd.DataFrame(rows)


def frames() -> pd.DataFrame:
    """The structures of Table 1 with all modes; base with the rotary inertia of a mat, and with that of wide floors."""
    rows: list[Row] = []
    for name in FRAMES:
        bare = bare_frame(name)
        b, total = bare.half_width, bare.m_tot
        cases = [("mat", "MDOF-S", bare.base_mass * b**2 / 3.0)]
        if name in ("#1", "#6"):
            cases += [("wide floors", "MDOF-S", 3.0 * total * b**2)]
        if name in ("#4",):
            cases += [("mat", "2DOF-S", bare.base_mass * b**2 / 3.0)]
        for case, model, inertia in cases:
            p = with_rotary(bare, inertia)
            e = contact_restitution(p, inertia, 1 if model == "2DOF-S" else p.n_modes)
            laws: dict[str, rf.ImpactLaw] = {"VVEL": rf.VVELSimplified(), "Housner": housner(p)}
            if e > 0.0:
                laws["generalised"] = rf.Restitution(e)
            grounds = []
            for over, ratio, kind in itertools.product((0.3, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0), RATIOS, (TWO, BED)):
                if kind == BED and (ratio == RATIOS[0] or name not in ("#1", "#4") or case != "mat"):
                    continue
                heave = over * p.omega[0] * p.effective_height[0] / b
                soil = springs(kind, b, total, heave, ratio)
                row = {"ground": kind, "damping": ratio, "frequency_ratio": over, "heave": heave}
                grounds.append((row, rf.Ground(springs=soil, base_inertia=inertia)))
            found = compare(Bench(p, model, (1.0, 2.0)), laws, grounds)
            rows += [{"structure": name, "case": case, "model": model, "e": e} | each for each in found]
            print(name, case, model, flush=True)
    return pd.DataFrame(rows)


def blocks() -> pd.DataFrame:
    """Rigid blocks on two springs and on a bed."""
    rows: list[Row] = []
    for slenderness, half_diagonal, scales in ((0.15, 10.0, (1.0, 2.0)), (0.3, 5.0, (1.0, 2.0))):
        p, inertia = block(slenderness, half_diagonal)
        limit = p.resisting_moment / (p.l0r * GRAVITY)
        bed = springs(BED, p.half_width, p.m_tot, math.sqrt(GRAVITY / (1e-3 * limit * p.half_width)), 0.7)
        of_bed = first_landing(p, rf.Ground(springs=bed, base_inertia=inertia), 0.5 * limit)[0]
        laws: dict[str, rf.ImpactLaw] = {
            "Housner": housner(p),
            "VVEL": rf.VVELSimplified(),
            "measured on a bed": rf.Restitution(of_bed),
        }
        grounds = []
        for settled, ratio, kind in itertools.product((1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4), RATIOS, (TWO, BED)):
            if kind == BED and settled < 1e-3:
                continue
            heave = math.sqrt(GRAVITY / (settled * limit * p.half_width))
            soil = springs(kind, p.half_width, p.m_tot, heave, ratio)
            row = {"ground": kind, "damping": ratio, "settlement": settled, "heave": heave}
            grounds.append((row, rf.Ground(springs=soil, base_inertia=inertia)))
        found = compare(Bench(p, "rigid", scales), laws, grounds)
        rows += [{"slenderness": slenderness, "half_diagonal": half_diagonal} | each for each in found]
    return pd.DataFrame(rows)


TABLES: dict[str, Callable[[], pd.DataFrame]] = {
    "free_rocking": free_rocking,
    "columns": columns,
    "blocks": blocks,
    "frames": frames,
    "forces": forces,
}

if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for wanted in sys.argv[1:] or TABLES:
        TABLES[wanted]().to_csv(FOLDER / f"{wanted}.csv", index=False, float_format="%.6g")
