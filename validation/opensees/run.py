"""rockflex against OpenSees: tables on the screen, figures under out/opensees.

python validation/opensees/run.py [folder]
"""

import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from figures import cycles_figure, excursion_figure, fixed_figure
from first_excursion import Excursion, complete, pulse, simplified
from fixed_base import fixed_errors, modal_differences
from frames import FLEXURE, SHEAR, Prototype, load_opensees
from later_cycles import impact_share, later_cycles, reference
from newton import by_newton
from references import absolute_damping
from references import reference as excursion_reference
from rich.console import Console
from rich.table import Table
from speed import speeds
from springs import DAMPED_GROUND, PARALLEL_GROUND, STIFF_GROUND, compare, explained, speeds_on_springs
from yielding import yielding

import rockflex as rf

PROTOTYPES = (SHEAR, FLEXURE)
STIFFNESS_RATIO = {SHEAR: 0.02, FLEXURE: 0.015}  # first mode; with 2 % the fifth mode of #2 would be overdamped
GRID = [(1e10, 2e-4), (1e11, 2e-4), (1e12, 2e-4), (1e13, 1e-4)]
STEPS = [(1e13, 2e-3), (1e13, 1e-3), (1e13, 5e-4), (1e13, 2.5e-4)]
LARGE = [(1e10, 5e-4), (1e11, 5e-4), (1e12, 2e-4)]
OUT = Path(__file__).parents[2] / "out" / "opensees"


def main() -> None:
    """Print every table and write every figure."""
    started = time.perf_counter()
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    console = Console(width=120)
    try:
        ops = load_opensees()
    except ImportError as error:
        raise SystemExit(str(error)) from error
    folder.mkdir(parents=True, exist_ok=True)
    ops.logFile(str(folder / "opensees.log"), "-noEcho")  # otherwise it prints warnings about the eigen solver
    console.print(f"OpenSees {ops.version()}, rockflex {rf.__version__}\n")
    record, shaking = rf.load_suite("el-centro-1940")[0], pulse()
    written = [
        fixed_base(console, record, folder),
        first_excursions(console, shaking, folder),
        impacts(console, record, folder),
    ]
    yielding_stories(console, shaking)
    springs(console, record, shaking)
    times(console)
    console.print("\n".join(f"wrote {path}" for path in written))
    console.print(f"{time.perf_counter() - started:.0f} s in all")


def fixed_base(console: Console, record: rf.GroundMotion, folder: Path) -> Path:
    """Part (a)."""
    table = Table("structure", "ω_n", "m*_n", "h*_n", "B", title="fixed base: largest relative difference of all modes")
    for prototype in PROTOTYPES:
        table.add_row(prototype.name, *(f"{value:.0e}" for value in modal_differences(prototype).values()))
    console.print(table)
    found = {p.name: fixed_errors(p, record, (4, 8, 16, 32, 64, 128)) for p in PROTOTYPES}
    title = f"fixed base, {record.name}, modal damping 2 %: OpenSees (average acceleration) − rockflex, over the peak"
    columns = ("steps per sample", "u_top", "V_b", "M_b", "peak of u_top", "of V_b", "of M_b")
    table = Table("structure", *columns, title=title)
    for name, errors in found.items():
        for each in errors:
            values = (f"{value:.1e}" for value in (*each.history, *each.peak))
            table.add_row(name, str(each.divisions), *values)
    console.print(table)
    return fixed_figure(found, record.dt, folder / "fixed_base.png")


def first_excursions(console: Console, shaking: rf.GroundMotion, folder: Path) -> Path:
    """Part (b)."""
    tables: dict[str, list[Excursion]] = {}
    for prototype in PROTOTYPES:
        tables[prototype.name] = simplified(prototype, shaking, GRID)
        ratio = STIFFNESS_RATIO[prototype]
        rows = {
            "MDOF-S, ζ = 0": tables[prototype.name],
            "MDOF-S, ζ = 0, the step": simplified(prototype, shaking, STEPS),
            "without L_0^r g θ": simplified(prototype, shaking, GRID[2:3], gravity_spring=False),
            f"MDOF-S, damped by stiffness, {ratio:.1%}": simplified(
                prototype, shaking, GRID[-2:], ("stiffness", ratio)
            ),
            "MDOF-S, modal 2 %": simplified(prototype, shaking, GRID[-2:], ("modal", 0.02)),
            "its damping as OpenSees'": simplified(prototype, shaking, GRID[-2:], ("modal", 0.02), like_opensees=True),
            "MDOF-C, ζ = 0": complete(prototype, shaking, LARGE),
            "Newton, columns shorten": complete(prototype, shaking, LARGE, like_opensees=True),
        }
        console.print(excursion_table(prototype.name, rows))
        for name, mine, theirs in references(prototype, shaking):
            console.print(
                f"{name}: uplift {mine[0]:.7f} and {theirs[0]:.7f} s, difference of θ {theirs[1]:.1e} of θ_max"
            )
        console.print()
    return excursion_figure(PROTOTYPES, shaking, tables, folder / "first_excursion.png")


def yielding_stories(console: Console, shaking: rf.GroundMotion) -> None:
    """Part (b), with stories that yield and leaning mass."""
    rows = {"the same equations": yielding(shaking, GRID), "hinged columns": yielding(shaking, GRID[-1:], columns=True)}
    table = excursion_table(
        "#1, stories that yield", {name: [each.excursion for each in row] for name, row in rows.items()}
    )
    console.print(table)
    for name, row in rows.items():
        drifts = ", ".join(f"{each.drift:.1e}" for each in row)
        console.print(f"{name}: largest difference of the story drifts, over their peaks: {drifts}")
    console.print(f"ductilities: {', '.join(f'{each:.2f}' for each in rows['hinged columns'][0].ductility)}\n")


def references(
    prototype: Prototype, shaking: rf.GroundMotion
) -> Iterator[tuple[str, tuple[float], tuple[float, float]]]:
    """Independent integrations compared with rockflex: uplift times and the largest difference of θ."""
    undamped = excursion_reference(prototype.structure(second_order=True), "MDOF-C", shaking)
    linear = excursion_reference(prototype.structure(second_order=True), "MDOF-S", shaking)
    pairs = {
        "MDOF-C and Newton's law for its kinematics": (undamped, by_newton(prototype, shaking, shortening=False)),
        "MDOF-C and MDOF-S": (undamped, linear),
        "MDOF-S and the damped integration at ζ = 0": (
            excursion_reference(prototype.structure(), "MDOF-S", shaking),
            absolute_damping(prototype, shaking, 0.0),
        ),
    }
    for name, (mine, other) in pairs.items():
        at = np.linspace(max(mine.uplift, other.uplift), min(mine.impact, other.impact), 2000)[1:-1]
        difference = float(np.max(np.abs(mine.motion(at)[0] - other.motion(at)[0]))) / mine.largest[0]
        yield name, (mine.uplift,), (other.uplift, difference)


def excursion_table(name: str, rows: dict[str, list[Excursion]]) -> Table:
    """One structure's first excursions."""
    columns = ("against", "k (N/m)", "dt (s)", "uplift (s)", "impact (s)", "θ_max", "θ(t)", "u_top(t)", "s")
    table = Table(*columns, title=f"{name}, Ricker pulse: OpenSees minus the reference; θ and u over their peaks")
    for against, found in rows.items():
        for each in found:
            values = (each.uplift, each.impact, each.peak, each.rotation, each.top)
            texts = ("" if np.isnan(value) else f"{value:.1e}" for value in values)
            table.add_row(against, f"{each.contact:.0e}", f"{each.dt:g}", *texts, f"{each.seconds:.2f}")
            against = ""
        table.add_section()
    return table


def impacts(console: Console, record: rf.GroundMotion, folder: Path) -> Path:
    """Part (c)."""
    shown = {}
    ends = ("first impact", "5 s", "8 s", "12 s")
    for prototype in PROTOTYPES:
        ratio = STIFFNESS_RATIO[prototype]
        response, cycles = reference(prototype, record, ratio), later_cycles(prototype, record, ratio)
        title = (
            f"{prototype.name}, {record.name}, damped by stiffness ({ratio:.1%}): θ of OpenSees minus MDOF-S (VVEL) "
            f"over θ_max, until"
        )
        table = Table("contact", "k (N/m)", "dt (s)", *ends, "rebound", "s", title=title)
        for each in cycles:
            errors = (f"{value:.1e}" for value in each.errors)
            given = (each.case.name, f"{each.case.contact.stiffness:.0e}", f"{each.case.scheme.dt:g}")
            table.add_row(*given, *errors, f"{each.rebound:.2f}", f"{each.run.seconds:.1f}")
        console.print(table)
        console.print(
            f"impacts in rockflex until 12 s: {int(np.sum(response.impact_times < 12.0))}; VVEL dissipates "
            f"{impact_share(prototype):.2%} of the kinetic energy of a rigid rotation\n"
        )
        shown[prototype.name] = (response, cycles)
    return cycles_figure(shown, folder / "later_cycles.png")


def springs(console: Console, record: rf.GroundMotion, shaking: rf.GroundMotion) -> None:
    """Part (d)."""
    columns = ("motion", "contact", "dt (s)", "uplift (s)", "θ_max", "θ(t)", "OpenSees ms", "rockflex ms", "ratio")
    grounds = (STIFF_GROUND, DAMPED_GROUND, PARALLEL_GROUND)
    for prototype in PROTOTYPES:
        title = f"{prototype.name} on two springs of {STIFF_GROUND.stiffness:g} N/m: OpenSees minus rockflex"
        table = Table(*columns, title=title)
        for motion, steps in ((shaking, (5e-4,)), (record, (1e-3, 2.5e-4))):
            for each in compare(prototype, motion, [(ground, dt) for ground in grounds for dt in steps]):
                table.add_row(
                    motion.name, each.ground.kind, f"{each.dt:g}", f"{each.late:.1e}", f"{each.peak:.1e}",
                    f"{each.rotation:.1e}", f"{each.opensees * 1e3:.0f}", f"{each.rockflex * 1e3:.1f}",
                    f"{each.opensees / each.rockflex:.0f}",
                )  # fmt: skip
        console.print(table)
        for motion, dt in ((shaking, 5e-4), (record, 2.5e-4)):
            peak, rotation = explained(prototype, motion, DAMPED_GROUND, dt)
            console.print(f"{motion.name}, series, against its own law by LSODA: θ_max {peak:.1e}, θ(t) {rotation:.1e}")


def times(console: Console) -> None:
    """Part (e)."""
    columns = ("structure", "against", "error ≤", "k (N/m)", "dt (s)", "error", "OpenSees ms", "rockflex ms", "ratio")
    table = Table(*columns, title="under the pulse, at the same error of θ_max")
    for prototype in PROTOTYPES:
        for each in (*speeds(prototype), *speeds_on_springs(prototype)):
            table.add_row(
                prototype.name, each.model, f"{each.target:g}", f"{each.contact:.0e}", f"{each.dt:g}",
                f"{each.error:.1e}", f"{each.opensees * 1e3:.0f}", f"{each.rockflex * 1e3:.2f}", f"{each.ratio:.0f}",
            )  # fmt: skip
    console.print(table)


if __name__ == "__main__":
    main()
