"""Stories that yield against the 2DOF-S-BW model of their pushover: how far the small model can be trusted."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import rockflex as rf

OUT = Path("out/stories")
SUITES = ("fema-p695-far-field", "fema-p695-near-field-pulse", "fema-p695-near-field-no-pulse")
FRAMES = {"#1": (1.0, 10.0), "#3": (0.5, 10.0), "#5": (1.0, 5.0)}  # period in s and h*/B of Table 1, shear frames
RATIOS = (0.5, 0.7, 0.85, 1.0, 1.3, 2.0)  # base shear at yield over that at uplift, first-mode forces
POST_YIELD_RATIO, SCALES, FREE_VIBRATION = 0.05, (1.0, 2.0), 10.0
WANTED = ["motion", "scale", "status", "max_rotation", "max_top_displacement", "max_base_shear"]


def frame(period: float, aspect_ratio: float) -> rf.Frame:
    """Return a five-story frame of Table 1 (Silva & Stojadinović 2024)."""
    return rf.Frame(
        n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=float("inf"), period=period,
        aspect_ratio=aspect_ratio, damping_ratio=0.02,
    )  # fmt: skip


def shears(structure: rf.Frame, pattern: str) -> np.ndarray:
    """Return story shears over the base shear: those of the first mode, or with a first story 20 % weaker."""
    forces = structure.rocking().floors.force[:, 0]
    found = np.cumsum((forces / forces.sum())[::-1])[::-1].copy()
    found[0] *= 0.8 if pattern == "weak first story" else 1.0
    return found


def study() -> pd.DataFrame:
    """Return a row for each frame, pattern, strength, record and scale, with the peaks of both models."""
    motions = [motion for name in SUITES for motion in rf.load_suite(name)]
    options = {"scales": SCALES, "free_vibration": FREE_VIBRATION}
    tables = []
    for name, values in FRAMES.items():
        elastic = frame(*values)
        p = elastic.rocking()
        at_uplift = p.resisting_moment / p.effective_height[0]
        for pattern in ("first mode", "weak first story"):
            for ratio in (*RATIOS, np.inf):
                yielding, small = elastic, {"models": "2DOF-S"}
                if np.isfinite(ratio):
                    yielding = rf.YieldingStories(
                        elastic, ratio * at_uplift * shears(elastic, pattern), POST_YIELD_RATIO
                    )
                    top = 4.0 * float(yielding.yield_drift.sum())
                    small = {"models": "2DOF-S-BW", "bouc_wen": rf.pushover(yielding, top, lifts=False).fit().bouc_wen}
                elif pattern != "first mode":
                    continue
                whole = rf.simulate_many({name: yielding}, motions, models="MDOF-S", **options)
                model = rf.simulate_many({name: elastic}, motions, **small, **options)
                both = whole[WANTED].merge(model[WANTED], on=["motion", "scale"], suffixes=("", "_small"))
                tables.append(both.assign(frame=name, pattern=pattern, strength=ratio))
                print(f"{name}, {pattern}, V_y/V_uplift = {ratio:g}: {len(both)} pairs", flush=True)
    return pd.concat(tables, ignore_index=True)


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Return medians and dispersions of small over whole, by frame, pattern and strength, where both rock."""
    rows = []
    for (name, pattern, strength), runs in table.groupby(["frame", "pattern", "strength"]):
        standing = runs[(runs.status != "overturned") & (runs.status_small != "overturned")]
        row = {"frame": name, "pattern": pattern, "strength": strength, "pairs": len(runs)}
        row["agree"] = float((runs.status == runs.status_small).mean())
        rocks = standing[(standing.max_rotation > 1e-3) & (standing.max_rotation_small > 1e-3)]
        for quantity, part in (
            ("max_rotation", rocks),
            ("max_top_displacement", standing),
            ("max_base_shear", standing),
        ):
            log = np.log(part[f"{quantity}_small"] / part[quantity])
            row |= {f"{quantity}_median": float(np.exp(log.median())), f"{quantity}_dispersion": float(log.std())}
        rows.append(row | {"rock": len(rocks)})
    return pd.DataFrame(rows)


def figure(found: pd.DataFrame) -> Figure:
    """Plot the medians with a band of one dispersion over the strength; the elastic pairs stand at the right."""
    names = {"max_rotation": "θ", "max_top_displacement": "u_top", "max_base_shear": "V_b"}
    with mpl.rc_context({"font.size": 9.0, "axes.grid": True, "grid.alpha": 0.4}):
        result = Figure(figsize=(7.2, 5.2), layout="constrained")
        grid = result.subplots(2, 3, sharex=True, sharey="col")
    for row, pattern in zip(grid, ("first mode", "weak first story"), strict=True):
        for axes, (quantity, symbol) in zip(row, names.items(), strict=True):
            for (frame_name, part), style in zip(found.groupby("frame"), ("-", "--", ":"), strict=True):
                line = part[(part.pattern == pattern) & np.isfinite(part.strength)].sort_values("strength")
                middle, spread = line[f"{quantity}_median"], line[f"{quantity}_dispersion"]
                (drawn,) = axes.plot(line.strength, middle, style, marker="o", markersize=3, label=frame_name)
                color = drawn.get_color()
                low, high = middle * np.exp(-spread), middle * np.exp(spread)
                axes.fill_between(line.strength, low, high, color=color, alpha=0.12)
                elastic = part[~np.isfinite(part.strength)]
                axes.plot(
                    [2.35], elastic[f"{quantity}_median"], marker="s", color=color, markersize=4, linestyle="none"
                )
            axes.axhline(1.0, color="black", linewidth=0.7)
            axes.set_title(f"{symbol}, {pattern}", fontsize=9)
            axes.set_yscale("log")
            axes.set_yticks([0.5, 0.7, 1.0, 1.4, 2.0], ["0.5", "0.7", "1", "1.4", "2"], minor=False)
            axes.minorticks_off()
            axes.set_xticks([0.5, 1.0, 1.5, 2.0, 2.35], ["0.5", "1", "1.5", "2", "el."])
    for axes in grid[1]:
        axes.set_xlabel("V_y / V_uplift")
    for axes in grid[:, 0]:
        axes.set_ylabel("2DOF-S-BW over MDOF-S")
    grid[0, 0].legend(fontsize=8)
    return result


def main() -> None:
    """Run the study, and write its table, the summary and the figure."""
    OUT.mkdir(parents=True, exist_ok=True)
    table = study()
    table.to_parquet(OUT / "pairs.parquet")
    found = summary(table)
    found.to_csv(OUT / "summary.csv", index=False)
    rf.save_figure(figure(found), OUT / "stories.png")
    print(found.round(3).to_string(index=False))
    print(f"{2 * len(table)} runs; table, summary and figure in {OUT.resolve()}")


if __name__ == "__main__":
    main()
