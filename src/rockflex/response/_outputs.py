"""Every output of a run, described once: its symbol, its quantity, what it is, and which runs have it.

Tables, files for other programs, the command line, reports, figures, the page and the docstring of `Response` read
their headings, units and words here.
"""

from collections.abc import Iterable, Mapping
from fnmatch import fnmatchcase
from textwrap import wrap
from typing import Literal, NamedTuple

from rockflex.foundation.language import translated
from rockflex.foundation.units import QUANTITIES as KINDS_OF_QUANTITIES
from rockflex.foundation.units import Unit, UnitSystem

Runs = Literal["all", "floors", "tendons", "dissipating elements", "sliding", "springs", "joints"]
_OTHER_UNITS = {"angular velocity": "rad/s", "angular acceleration": "rad/s2", "distance": "km"}


class Output(NamedTuple):
    """An output of a run.

    Parameters
    ----------
    symbol
        What heads its columns and labels its axes, in every table and figure.
    quantity
        Its kind among the `QUANTITIES` of units, from which its unit follows; or "flag", "count" or a kind of which
        only files for programs tell the unit.
    words
        What it is, without the unit.
    note
        What else its docstring says, after the unit.
    of
        The runs that have it.
    usual
        Its unit in tables of the system "kN", where it is not that of the quantity.
    across
        Of a history with several values at a time: what these are of.
    worst_is_least
        Whether its least value is the most unfavourable.
    """

    symbol: str
    quantity: str
    words: str
    note: str = ""
    of: Runs = "all"
    usual: str = ""
    across: str = ""
    worst_is_least: bool = False

    @property
    def si(self) -> str:
        """Unit in files for other programs; empty for ratios, flags and counts."""
        if self.quantity in KINDS_OF_QUANTITIES:
            return KINDS_OF_QUANTITIES[self.quantity][2].replace("²", "2")
        return _OTHER_UNITS.get(self.quantity, "")

    def unit_in(self, units: UnitSystem, *, largest: float = 0.0) -> Unit:
        """Return the unit in tables; `largest` as in `UnitSystem.of`."""
        return units.of(self.quantity, self.usual, largest=largest)


HISTORY: Mapping[str, Output] = {
    "time": Output("t", "time", "time"),
    "side": Output("s", "flag", "side on which the base rocks"),
    "ground_acceleration": Output("a_g", "acceleration", "acceleration of the ground"),
    "rotation": Output("θ", "rotation", "rotation of the base"),
    "rotation_velocity": Output("θ'", "angular velocity", "velocity of the rotation"),
    "top_displacement": Output("u_top relative", "displacement", "displacement of the top relative to the base"),
    "total_top_displacement": Output("u_top total", "displacement", "displacement of the top relative to the ground"),
    "base_moment": Output("M_b", "moment", "base moment of the elastic forces"),
    "base_shear": Output("V_b", "force", "base shear of the elastic forces"),
    "horizontal_reaction": Output("ΣF_x", "force", "horizontal force of the ground on the base"),
    "vertical_reaction": Output("N", "force", "vertical force of the ground on the base"),
    "vertical_ground_acceleration": Output("a_v", "acceleration", "vertical acceleration of the ground"),
    "slip": Output("x", "displacement", "slip of the base along the ground", of="sliding"),
    "slip_velocity": Output("x'", "velocity", "velocity of the slip", of="sliding"),
    "heave": Output("z", "displacement", "rise of the base at the axis of the masses", of="springs"),
    "spring_force": Output("N_j", "force", "upward force of each spring", of="springs", across="spring"),
    "joint_rotation": Output("θ_j", "rotation", "rotation of each joint above the base", of="joints", across="joint"),
    "joint_force": Output("N_joint", "force", "axial force of each joint above the base", of="joints", across="joint"),
    "rotation_acceleration": Output("θ''", "angular acceleration", "acceleration of the rotation"),
    "modal_displacement": Output("D_n", "displacement", "modal displacement", across="mode"),
    "modal_velocity": Output("D'_n", "velocity", "modal velocity", across="mode"),
    "modal_acceleration": Output("D''_n", "acceleration", "modal acceleration", across="mode"),
    "story_drift": Output("drift", "displacement", "drift of each story", of="floors", across="floor"),
    "story_shear": Output("V", "force", "shear of each story", of="floors", across="floor"),
    "floor_acceleration": Output(
        "a_floor", "acceleration", "total acceleration of each floor", of="floors", usual="m/s²", across="floor"
    ),
    "total_floor_displacement": Output(
        "u_floor", "displacement", "displacement of each floor relative to the ground", of="floors", across="floor"
    ),
    "element_force": Output("F", "force", "force of each element", across="element"),
    "element_elongation": Output("δ", "displacement", "elongation of each element", across="element"),
    "tendon_force": Output("T", "force", "force of each tendon", of="tendons", across="tendon"),
    "edge_uplift": Output("edges", "displacement", "rise of edges", across="edge"),
    "permanent_settlement": Output(
        "w_p", "displacement", "permanent settlement of each spring", of="springs", across="spring"
    ),
    "soil_pressure": Output("p", "stress", "pressure of each spring on the ground", of="springs", across="spring"),
    "bearing_pressure": Output("q", "stress", "static bearing pressure", of="springs"),
    "friction_demand": Output("|ΣF_x|/ΣF_z", "ratio", "friction demand"),
    "yielding": Output("z", "ratio", "hysteretic variable of the Bouc-Wen model"),
    "uplifted": Output("", "flag", "whether the base is off the ground"),
}
"""The quantities of a history at its states."""

COLUMNS = (
    "time", "side", "ground_acceleration", "rotation", "rotation_velocity", "top_displacement",
    "total_top_displacement", "base_moment", "base_shear", "horizontal_reaction", "vertical_reaction",
)  # fmt: skip
"""The columns of every history."""

OUTPUTS: Mapping[str, Output] = {
    "max_rotation": Output("θ_max", "rotation", "largest |θ|"),
    "balance_ratio": Output(
        "θ_max/α", "ratio", "largest |θ| over α, at which the static moment vanishes",
        " (`Pivot.balance_rotation`): zero where tendons prevent that. A simplified model beyond 1 has left its range",
    ),
    "max_top_displacement": Output(
        "u_top relative", "displacement", "largest displacement of the top relative to the rotating base"
    ),
    "max_total_top_displacement": Output(
        "u_top total", "displacement", "largest displacement of the top relative to the ground",
        ", including the rotation of the base: u_top + h_top θ, in the complete models by Eq. 3. NaN if the height of "
        "the top is not known",
    ),
    "max_story_drift": Output("story drift", "displacement", "largest drift of all stories", of="floors"),
    "max_floor_acceleration": Output(
        "a_floor", "acceleration", "largest total acceleration of all floors", of="floors", usual="m/s²"
    ),
    "max_base_moment": Output(
        "M_b", "moment", "largest base moment of the elastic forces",
        "; zero for a rigid block, which has no elastic forces",
    ),
    "max_base_shear": Output(
        "V_b", "force", "largest base shear of the elastic forces",
        "; zero for a rigid block. With an impact law V_b and M_b are those of landings without rebound: \"Forces "
        "after an impact\" in the theory tells which to design for",
    ),
    "max_horizontal_reaction": Output(
        "ΣF_x", "force", "largest horizontal force of the ground, base inertia and damping included",
        " (Eq. 21). Unlike `max_base_shear` it includes the mass of modes left out, too. Impulses at impacts are not "
        "included",
    ),
    "min_vertical_reaction": Output(
        "N_min", "force", "least vertical force of the ground",
        " (Eq. 22 with the sign of the weight corrected). If it is negative, the model would need the ground to pull "
        "the base down; in reality the pivot would lift",
        worst_is_least=True,
    ),
    "max_tendon_force": Output("T", "force", "largest force of all tendons", "; zero without tendons", of="tendons"),
    "tendon_utilisation": Output(
        "T/F_y", "ratio", "largest force of a tendon over its yield force",
        "; zero without tendons, NaN if no yield force is given", of="tendons",
    ),
    "tendon_yield": Output(
        "", "flag", "whether any tendon reached its yield force", of="dissipating elements"
    ),
    "tendon_overload": Output(
        "", "flag", "whether a tendon that stays elastic in the model carries more than its yield force",
        ". It has no `post_yield_ratio`, and the results are not valid then", of="dissipating elements",
    ),
    "residual_rotation": Output(
        "θ_end", "rotation", "rotation at the end of the run, from that at rest",
        ": zero if the base is closed, NaN if it overturned. On springs it is measured from the rotation at rest under "
        "gravity. A run that does not settle (``free_vibration=\"settle\"``) may end while the base still rocks: "
        "`settled_rotation()` continues it",
        of="dissipating elements",
    ),
    "max_joint_rotation": Output(
        "θ_joint", "rotation", "largest rotation of the joints above the base",
        ", relative to what is below; zero without such joints", of="joints",
    ),
    "min_joint_force": Output(
        "N_joint", "force", "least axial force of the joints above the base",
        ", of what stands on them and of tendons; zero without such joints. If it is negative, the model would need a "
        "joint to pull what is above down; in reality it would lift off",
        of="joints", worst_is_least=True,
    ),
    "max_slip": Output(
        "x_max", "displacement", "largest slip of the base along the ground",
        "; zero unless the ground has a `friction`", of="sliding",
    ),
    "residual_slip": Output(
        "x_end", "displacement", "slip at the end of the run", ", positive to the right", of="sliding"
    ),
    "max_edge_uplift": Output(
        "edge up", "displacement", "how far an edge of the base rises above the ground",
        ": on springs from the level at which they are unloaded, on rigid ground 2 B |θ| (2 B sin |θ| for large "
        "rotations)",
        of="springs",
    ),
    "max_edge_settlement": Output(
        "edge down", "displacement", "how far an edge of the base sinks into the ground", "; zero on rigid ground",
        of="springs",
    ),
    "settlement": Output(
        "z_end", "displacement", "settlement of the base at the end of the run",
        ", at the axis of the masses, from the level at which the springs are unloaded", of="springs",
    ),
    "max_permanent_settlement": Output(
        "w_p", "displacement", "largest permanent settlement of a spring", "; zero where springs do not yield",
        of="springs",
    ),
    "leaning_push": Output(
        "Σ l g θ/V_b", "ratio", "push of leaning columns on the floors over the base shear",
        ", at the largest |θ| and the largest base shear; zero without leaning mass. The push is neglected, and above "
        "0.05 a warning says so",
    ),
    "column_pull": Output(
        "M_b/M_pull", "ratio", "largest base moment over that which first pulls a column of a podium up",
        ", where the weight is shared by all columns; zero without a podium, or where its `column_spacing` is not "
        "known. Above 1 a warning says so",
    ),
    "n_uplifts": Output(
        "uplifts", "count", "number of uplifts",
        ". An initial rotation does not count as one, so there can be one more impact than uplifts. On springs: how "
        "often an edge rises above the level of the unloaded springs",
    ),
    "n_impacts": Output(
        "impacts", "count", "number of impacts", ". On springs: how often an edge comes back to that level"
    ),
    "guarded_impacts": Output(
        "guarded", "ratio", "share of the impacts at which the guard of the impact law acted",
        ": where `AngularMomentum` would gain energy or turn back; zero with every other law",
    ),
    "nominal_overturning": Output("†", "flag", "whether |θ| exceeded 0.7 atan(B/h*_1)", " (Section 3.3)"),
    "may_fall": Output(
        "", "flag", "whether the run ends while the base may still overturn",
        ": while θ grows beyond all before, or with energy enough to pass α, as of a rigid body",
    ),
    "end_time": Output("end", "time", "time of the last state"),
    "settled": Output("", "flag", "whether the run ended at rest", " (``free_vibration=\"settle\"``)"),
}  # fmt: skip
"""The numbers and flags of a `Response`, and the two of its floors that sets and comparisons tell."""

OF_TABLES: Mapping[str, Output] = {
    "duration": Output("", "time", "duration of the record"),
    "time_of_max_*": Output("", "time", "time of the largest value"),
    "time_of_min_*": Output("", "time", "time of the least value"),
    "max_element_force_*": Output("F", "force", "largest force of an element"),
    "max_element_elongation_*": Output("δ", "displacement", "largest elongation of an element"),
    "element_energy_*": Output("E", "energy", "energy that an element takes"),
    "max_ductility": Output("μ_max", "ratio", "largest drift of a story over that at first yield"),
    "ductility_*": Output("μ", "ratio", "largest drift of a story over that at first yield"),
    "max_residual_drift_ratio": Output("", "ratio", "largest drift left over the height of the story"),
    "residual_drift_*": Output("drift", "displacement", "drift of a story that is left"),
    "sliding_time": Output("slides at", "time", "time at which the base would slide"),
    "nominal_limit": Output("θ_nom", "rotation", "nominal limit of overturning"),
    "*_edge_uplift": Output("edge", "displacement", "rise of an edge of the base"),
    "joint_rotation_*": Output("θ_j", "rotation", "rotation of a joint above the base"),
    "permanent_settlement_*": Output("w_p", "displacement", "permanent settlement of a spring"),
    "spring_force_*": Output("N_j", "force", "upward force of a spring"),
    "distance_km": Output("", "distance", "distance of the station"),
}
"""Further columns of tables of runs and of histories; a star stands for any letters."""

ALL_RESULTS: Mapping[str, Output] = {**OUTPUTS, **OF_TABLES}

OF_MOTION = ("max_rotation", "max_top_displacement", "max_total_top_displacement", "max_base_moment", "max_base_shear")
REACTIONS = ("max_horizontal_reaction", "min_vertical_reaction")
"""The peaks of every run, in the order of its tables."""

DEMANDS_OF_SET = (
    "max_rotation", "max_top_displacement", "max_total_top_displacement", "max_story_drift", "max_floor_acceleration",
    "max_base_moment", "max_base_shear", "max_horizontal_reaction", "min_vertical_reaction", "max_tendon_force",
    "max_slip", "max_edge_uplift", "max_edge_settlement", "max_permanent_settlement", "max_joint_rotation",
    "min_joint_force",
)  # fmt: skip
"""The demands of a set of records."""
DEMANDS_BY_RECORD = ("max_rotation", "max_total_top_displacement", "max_story_drift", "max_base_moment",
                     "max_base_shear", "min_vertical_reaction")  # fmt: skip
"""The demands that tables show for each record of a set."""
COMPARED_DEMANDS = (
    "max_rotation", "balance_ratio", "max_top_displacement", "max_total_top_displacement", "max_story_drift",
    "max_floor_acceleration", "max_base_shear", "max_base_moment", "tendon_utilisation", "max_edge_uplift",
    "max_edge_settlement", "max_permanent_settlement", "max_slip", "residual_rotation", "max_joint_rotation",
)  # fmt: skip
"""The demands of a comparison, in the order of its table."""


def outputs_of(*runs: Runs) -> tuple[str, ...]:
    """Return the names of the outputs that only such runs have."""
    return tuple(name for name, each in OUTPUTS.items() if each.of in runs)


def legend(names: Iterable[str], *, of_few: bool = False) -> list[str]:
    """Return what is below a table that shows these outputs: the symbol of each, and what it is.

    Where only those are to be explained that not all runs have, it is `of_few`.
    """
    shown = [OUTPUTS[name] for name in names]
    return [
        f"{translated(each.symbol)}: {translated(each.words)}"
        for each in shown
        if not of_few or each.of not in ("all", "floors")
    ]


def described_output(name: str) -> Output | None:
    """Return the output of a column of runs or of a history; None if it is another one."""
    for known in (HISTORY, ALL_RESULTS):
        if name in known:
            return known[name]
    return next((each for pattern, each in OF_TABLES.items() if fnmatchcase(name, pattern)), None)


def outputs_as_docstring(names: Iterable[str]) -> str:
    """Return the entries of a docstring for outputs, each with the time of its peak if `names` has that too."""
    listed = tuple(names)
    lines: list[str] = []
    for name in listed:
        if name not in OUTPUTS:
            continue
        known, time = OUTPUTS[name], f"time_of_{name}"
        unit = f"{',' if ',' in known.words else ''} in {known.si.replace('2', '²')}" if known.si else ""
        also = (time,) if time in listed else ()
        text = f"{known.words[0].upper()}{known.words[1:]}{unit}{', and its time in s' if also else ''}{known.note}."
        lines += [", ".join((name, *also)), *wrap(text, 116, initial_indent="    ", subsequent_indent="    ")]
    return "\n".join(lines)
