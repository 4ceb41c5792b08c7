"""What ``rockflex run`` prints."""

from collections.abc import Sequence
from itertools import groupby

from rockflex.cli._console import fits, grid, moment_unit, note, number, output, show
from rockflex.cli._simulations import SLIDING, Plan, Run
from rockflex.response import IMPACT_WINDOW

__all__ = ["print_failures", "print_runs"]

MAX_LISTED = 5
YIELDED = "A tendon passed its yield force, and the models keep it elastic: such runs are not to be trusted"
NOMINAL = "† θ passed 0.7 atan(B/h*_1), the nominal limit of overturning"
FRICTION = (
    "μ_req: largest |ΣF_x|/ΣF_z (Eqs. 20-22), of the whole run and without the {window:g} s after each impact; "
    "the base slides where it passes {mu:g}"
)
Columns = list[tuple[str, list[str]]]


def print_runs(title: str, plan: Plan, runs: Sequence[Run], elapsed: float, *, times: bool) -> None:
    """Print the peaks of every run, and when they occurred if asked to; by motion where the terminal is narrow."""
    console = output()
    for line in (title, *plan.assumptions.remarks()):
        console.print(line, markup=False, soft_wrap=True)
    tables = [(_peaks(runs), 1)]
    if times:
        tables.append((_times(runs), 0))
    if plan.friction is not None:
        tables.append((_sliding(runs), 0))
    for columns, n_words in tables:
        headings = [heading for heading, _ in columns]
        cells = list(zip(*(values for _, values in columns), strict=True))
        places = [[run.motion] if plan.scales == [1.0] else [run.motion, f"{run.scale:g}"] for run in runs]
        words = [*("motion", "scale")[: len(places[0])], "model"]
        rows = [[*place, run.model, *row] for place, run, row in zip(places, runs, cells, strict=True)]
        flat = grid([*words, *headings], rows, len(words) + n_words)
        if fits(console, flat):
            console.print()
            show(console, flat)
            continue
        start = len(words) - 1
        for place, members in groupby(rows, key=lambda row: row[:start]):
            console.print("\n" + " × ".join(place), markup=False, soft_wrap=True)
            show(console, grid(["model", *headings], [row[start:] for row in members], 1 + n_words))
    console.print()
    if any(run.peaks["nominal_overturning"] for run in runs):
        console.print(NOMINAL, markup=False, soft_wrap=True)
    if any((run.peaks["tendon_utilisation"] or 0.0) > 1.0 for run in runs):
        console.print(YIELDED, markup=False, soft_wrap=True)
    if plan.friction is not None:
        console.print(FRICTION.format(window=IMPACT_WINDOW, mu=plan.friction), markup=False, soft_wrap=True)
    each = "" if len(runs) == 1 else f", {number(1e3 * elapsed / len(runs), 3)} ms a run"
    console.print(f"{len(runs)} run{'s' * (len(runs) > 1)} in {number(elapsed, 3)} s{each}", markup=False)


def print_failures(runs: Sequence[Run]) -> int:
    """Say on stderr which runs could not be solved, and return how many."""
    failed = [run for run in runs if run.error is not None]
    if failed:
        note(f"{len(failed)} of {len(runs)} runs could not be solved:")
    for run in failed[:MAX_LISTED]:
        note(f"  {run.model} under {run.motion} × {run.scale:g}: {run.error}")
    if len(failed) > MAX_LISTED:
        note(f"  and {len(failed) - MAX_LISTED} more; --json and results.csv hold them all")
    return len(failed)


def _peaks(runs: Sequence[Run]) -> Columns:
    moments = [abs(run.peaks["max_base_moment"] or 0.0) for run in runs]
    unit, size = moment_unit(max(moments))
    columns: Columns = [
        ("status", [_status(run) for run in runs]),
        ("θ_max [rad]", _column(runs, "max_rotation")),
        ("u_top [m]", _column(runs, "max_top_displacement")),
        (f"M_b [{unit}]", _column(runs, "max_base_moment", size)),
        ("V_b [kN]", _column(runs, "max_base_shear", 1e3)),
        ("impacts", ["-" if run.error else str(run.peaks["n_impacts"]) for run in runs]),
    ]
    if any(run.peaks["max_tendon_force"] for run in runs):
        columns.append(("T [kN]", _column(runs, "max_tendon_force", 1e3)))
        columns.append(("T/F_y", _column(runs, "tendon_utilisation")))
    if any(run.run_time is not None for run in runs):
        columns.append(("time [ms]", [number(None if run.run_time is None else 1e3 * run.run_time, 3) for run in runs]))
    return columns


def _times(runs: Sequence[Run]) -> Columns:
    names = {"rotation": "θ_max", "top_displacement": "u_top", "base_moment": "M_b", "base_shear": "V_b"}
    columns = [(f"t({label}) [s]", _column(runs, f"time_of_max_{name}", digits=5)) for name, label in names.items()]
    return [*columns, ("end [s]", _column(runs, "end_time", digits=5))]


def _sliding(runs: Sequence[Run]) -> Columns:
    times = [run.friction["sliding_time"] for run in runs]
    moments = [
        "-" if run.error is not None else "no" if time is None else number(time, 5)
        for run, time in zip(runs, times, strict=True)
    ]
    required = [[number(run.friction[name]) for run in runs] for name in SLIDING[:2]]
    return [("μ_req", required[0]), ("μ_req [no impacts]", required[1]), ("slides at [s]", moments)]


def _column(runs: Sequence[Run], name: str, size: float = 1.0, digits: int = 4) -> list[str]:
    values = [run.peaks[name] for run in runs]
    return [number(None if value is None else value / size, digits) for value in values]


def _status(run: Run) -> str:
    if run.status is None:
        return "failed"
    return run.status.replace("_", " ") + (" †" if run.peaks["nominal_overturning"] else "")
