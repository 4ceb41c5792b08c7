"""The uplifting steel frame of Clough & Huckelbridge (1977) under a table motion that you bring.

    python examples/clough_huckelbridge.py table.csv --measured "uplift=12,roof displacement=60"

The file has two columns with a line of names: time in s, and acceleration of the table in g. `--measured` takes largest
values of a test, in the units of the printed table. Properties: R. W. Clough & A. A. Huckelbridge, Preliminary
experimental study of seismic uplift of a steel frame, report UCB/EERC-77/22, 1977, as the companion files of a public
tutorial on rocking give them. No measured value is printed here: the report has them in figures alone.

What a comparison can say follows ASME V&V 20-2009: with the comparison error E = S - D of a computed value S and a
measured one D, and the validation uncertainty u_val = sqrt(u_num² + u_input² + u_D²), the error of the model lies in
E ± u_val. u_num is what a finer step changes, u_input what the inputs leave open.
"""

import argparse
import math
from collections.abc import Mapping
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import rockflex as rf

OUT = Path("out/clough")
INCH, POUND, KIP = 0.0254, 0.45359237, 4448.2216152605  # m, kg, N
G = 9.80665
STORIES = np.array([81.0, 64.0, 64.0]) * INCH
WIDTH = 144.0 * INCH  # between the columns of each of the two frames
E, STEEL = 29e3 * KIP / INCH**2, 0.28 * POUND / INCH**3
COLUMN, GIRDER = (5.01, 5.0, 0.36, 0.24), (6.03, 4.0, 0.28, 0.23)  # in: depth, flange, its thickness, web
FLOOR_MASS = 8000.0 * POUND
FOOT = 40.0 * KIP / INCH  # stiffness of each of the four feet, which push and cannot pull
HEAVE_DAMPING, DAMPING = 0.34, 0.05  # fractions of critical
BRACES = 30.0  # stiffness of the braces of the first story over that of its columns: not published
INPUTS = {  # factors at the ends of what is not known better
    "mass": (0.98, 1.02),
    "bending stiffness": (0.95, 1.05),
    "braces": (1 / 3, 3.0),
    "stiffness of the feet": (0.9, 1.1),
    "damping of the feet": (0.7, 1.3),
    "damping of the steel": (0.5, 1.5),
    "table motion": (0.98, 1.02),
}
UNITS = {"uplift": ("mm", 1e3), "roof displacement": ("mm", 1e3), "base moment": ("kN m", 1e-3)}


def area_and_inertia(section: tuple[float, float, float, float]) -> tuple[float, float]:
    """Return the area in m² and the moment of inertia in m⁴ of an I-section in inches."""
    depth, flange, thick, web = section
    inner = depth - 2.0 * thick
    inertia = (flange * depth**3 - (flange - web) * inner**3) / 12.0
    return (2.0 * flange * thick + web * inner) * INCH**2, inertia * INCH**4


def lateral_stiffness(factor: float, braces: float) -> np.ndarray:
    """Return the stiffness of the floors in N/m of both frames, hinged at their feet, by slopes and deflections.

    Columns and girders bend; both joints of a floor turn alike. The rotations are condensed.
    """
    n, column, girder = STORIES.size, E * area_and_inertia(COLUMN)[1], E * area_and_inertia(GIRDER)[1]
    whole = np.zeros((2 * n + 2, 2 * n + 2))  # displacements of levels 0 to n, then their rotations
    for k, h in enumerate(STORIES):
        at = [k, n + 1 + k, k + 1, n + 2 + k]
        turn, near, far = 6.0 * h, 4.0 * h**2, 2.0 * h**2
        bending = np.array(
            [[12, turn, -12, turn], [turn, near, -turn, far], [-12, -turn, 12, -turn], [turn, far, -turn, near]]
        )
        whole[np.ix_(at, at)] += 4.0 * column / h**3 * bending  # four columns
        whole[n + 2 + k, n + 2 + k] += 2.0 * 12.0 * girder / WIDTH  # two girders
    own = 12.0 * 4.0 * column / STORIES[0] ** 3
    whole[1, 1] += BRACES * braces * own
    free, turned = np.arange(1, n + 1), np.arange(n + 1, 2 * n + 2)
    coupling = whole[np.ix_(free, turned)]
    found = whole[np.ix_(free, free)] - coupling @ np.linalg.solve(whole[np.ix_(turned, turned)], coupling.T)
    return factor * 0.5 * (found + found.T)


def specimen(given: Mapping[str, float]) -> tuple[rf.LumpedStructure, rf.Ground]:
    """Return the frame and its feet, with factors on its inputs by name."""

    def factor(name: str) -> float:
        return given.get(name, 1.0)

    column, girder = (STEEL * area_and_inertia(each)[0] for each in (COLUMN, GIRDER))
    halves = 0.5 * (STORIES + np.append(STORIES[1:], 0.0))
    masses = factor("mass") * (FLOOR_MASS + 2.0 * girder * WIDTH + 4.0 * column * halves)
    base = factor("mass") * (2.0 * girder * WIDTH + 2.0 * column * STORIES[0])
    structure = rf.LumpedStructure(
        masses,
        lateral_stiffness(factor("bending stiffness"), factor("braces")),
        np.cumsum(STORIES),
        base_mass=base,
        half_width=0.5 * WIDTH,
        damping_ratio=DAMPING * factor("damping of the steel"),
    )
    k = 2.0 * FOOT * factor("stiffness of the feet")  # two feet on each side
    c = HEAVE_DAMPING * math.sqrt(2.0 * k * (masses.sum() + base)) * factor("damping of the feet")
    feet = rf.Springs([-0.5 * WIDTH, 0.5 * WIDTH], k, c)
    return structure, rf.Ground(springs=feet, base_inertia=base * (0.5 * WIDTH) ** 2)


def table_motion(file: Path, refined: int = 1) -> rf.GroundMotion:
    """Return the motion of a file at even steps, its median step divided by `refined`; between samples it is linear."""
    time, acceleration = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2).T[:2]
    if time.size < 2 or not (np.diff(time) > 0.0).all():
        raise SystemExit(f"{file}: the first column must be times in s that increase, the second accelerations in g.")
    dt = float(np.median(np.diff(time))) / refined
    even = np.arange(time[0], time[-1] + 0.5 * dt, dt)
    return rf.GroundMotion(G * np.interp(even, time, acceleration), dt, file.stem)


def maxima(motion: rf.GroundMotion, given: Mapping[str, float], model: str = "MDOF-S") -> dict[str, float]:
    """Return the largest values of a run in SI units."""
    structure, ground = specimen(given)
    run = rf.simulate(
        structure,
        motion.scaled(given.get("table motion", 1.0)),
        model,
        "peaks",
        ground=None if model == "fixed" else ground,
    )
    roof = run.max_top_displacement if model == "fixed" else run.max_total_top_displacement
    uplift = 0.0 if model == "fixed" else run.max_edge_uplift
    return {"uplift": uplift, "roof displacement": roof, "base moment": run.max_base_moment}


def validation_table(file: Path, measured: Mapping[str, float]) -> pd.DataFrame:
    """Return S, u_num and u_input of each quantity, and E ± u_val where it was measured."""
    motion = table_motion(file)
    nominal, refined = maxima(motion, {}), maxima(table_motion(file, 4), {})
    ends = {name: [maxima(motion, {name: each}) for each in pair] for name, pair in INPUTS.items()}
    rows = []
    for name, (unit, size) in UNITS.items():
        numerical = abs(refined[name] - nominal[name])
        parts = {key: 0.5 * abs(high[name] - low[name]) for key, (low, high) in ends.items()}
        inputs = math.sqrt(sum(each**2 for each in parts.values()))
        row = {"quantity": name, "unit": unit, "S": size * nominal[name], "u_num": size * numerical}
        row |= {"u_input": size * inputs, "most by": max(parts, key=lambda key: parts[key])}
        if name in measured:
            row |= {
                "D": measured[name],
                "E": row["S"] - measured[name],
                "u_val": math.hypot(row["u_num"], row["u_input"]),
            }
        rows.append(row)
    return pd.DataFrame(rows).set_index("quantity")


def drawn(file: Path) -> Figure:
    """Draw the lift of both feet and the base moment, with the frame held down."""
    structure, ground = specimen({})
    motion = table_motion(file)
    run = rf.simulate(structure, motion, ground=ground, free_vibration=2.0)
    fixed = rf.simulate(structure, motion, "fixed", free_vibration=2.0)
    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    lift, moment = figure.subplots(2, 1, sharex=True)
    history = run.history
    rise = history.heave[:, None] - history.rotation[:, None] * np.array([-0.5, 0.5]) * WIDTH
    for k, name in enumerate(("left", "right")):
        lift.plot(history.time, 1e3 * np.maximum(rise[:, k], 0.0), label=f"{name} feet")
    lift.set(ylabel="lift [mm]")
    moment.plot(fixed.history.time, 1e-3 * fixed.base_moment, color="0.7", label="held down")
    moment.plot(history.time, 1e-3 * run.base_moment, label="free to lift")
    moment.set(xlabel="time [s]", ylabel="base moment [kN m]")
    for axes in (lift, moment):
        axes.legend(loc="upper right")
    return figure


def measured_values(text: str) -> dict[str, float]:
    """Return the values of ``--measured`` by name."""
    pairs = (part.partition("=") for part in text.split(",") if part.strip())
    found = {name.strip(): float(value) for name, _, value in pairs}
    unknown = sorted(found.keys() - UNITS.keys())
    if unknown:
        raise SystemExit(f"--measured: {unknown[0]!r} is not known. Known are {', '.join(UNITS)}.")
    return found


def main() -> None:
    """Print the table, and draw the motion."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("file", type=Path, help="the motion of the table: time in s, acceleration in g")
    parser.add_argument("--measured", default="", help='largest measured values, such as "uplift=12" in mm')
    parser.add_argument("--out", type=Path, default=OUT)
    given = parser.parse_args()
    structure, _ = specimen({})
    properties = structure.rocking()
    print(f"{properties.m_tot * G / KIP:.1f} kip, periods on a fixed base {2 * math.pi / properties.omega} s")
    table = validation_table(given.file, measured_values(given.measured))
    print(table.to_string(float_format=lambda value: f"{value:.3g}"))
    held = maxima(table_motion(given.file), {}, "fixed")
    print(f"held down: base moment {1e-3 * held['base moment']:.3g} kN m")
    given.out.mkdir(parents=True, exist_ok=True)
    table.to_csv(given.out / "validation.csv")
    mpl.rcParams["savefig.dpi"] = 150
    drawn(given.file).savefig(given.out / "uplift.png")


if __name__ == "__main__":
    main()
