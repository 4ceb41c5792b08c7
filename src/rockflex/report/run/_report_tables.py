"""Facts and tables of the page: structure, modes, record, assumptions, elements, and largest values."""

import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.descriptions import described_arguments
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import rounded_number
from rockflex.foundation.shown import shown
from rockflex.foundation.units import Unit, UnitSystem, named_unit
from rockflex.models._impact import RuledLaw, restitution_left
from rockflex.motion._ground_motion import GroundMotion
from rockflex.report.run._reported_runs import ReportedRuns
from rockflex.response._history import History
from rockflex.response._outputs import OF_MOTION, OUTPUTS, REACTIONS, outputs_of
from rockflex.response._response import Response
from rockflex.structure._attachment import PLACE, YieldingStory, element_parameters
from rockflex.structure._base_element import BaseElement
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._uplifted import UpliftedModes, uplifted_modes

MAX_MODES = 4  # modes
_MOST_UPLIFTED = 200  # modes, for which the uplifted ones are found at once
MAX_COORDINATES = 3  # modes
MAX_ELEMENTS = 6  # elements
ROUNDING = 1e-9  # m: drifts that are none
SIDES = ("right", "left")
STATUS = {"no_uplift": "no uplift", "rocking": "rocking", "overturned": "overturned"}
ASSUMPTIONS = ("Impact law", "Hysteresis", "Ground", "Friction", "Initial state")
DAGGER = "†"
_SYMBOLS = {"initial_force": "F_0", "stiffness": "k", "yield_force": "F_y", "coefficient": "c", "force": "F_0"}
_QUANTITIES = {"N": "force", "N/m": "stiffness", "N s/m": "damping", "m": "displacement"}  # of parameters of elements


@dataclass(frozen=True)
class ReportCell:
    """A text of the page, and the value that it shows, if it shows one."""

    text: str
    value: float | None = None  # in SI units, with all digits
    of: str = ""  # name of the value, as in `Response` or `RockingProperties`
    wrong: bool = False  # whether it is to be noticed


@dataclass(frozen=True)
class ReportFact:
    """A named value: "T_1", with its cell and its unit."""

    name: str
    cell: ReportCell
    unit: str = ""


@dataclass(frozen=True)
class ReportTable:
    """Headings, each with its unit, and rows of cells; the first column has names."""

    heads: Sequence[tuple[str, str]]
    rows: Sequence[Sequence[ReportCell]]


def value_cell(value: float | None, of: str, size: float = 1.0, digits: int = 3, *, wrong: bool = False) -> ReportCell:
    """Return the cell of a value in units of `size`."""
    return ReportCell(rounded_number(None if value is None else value / size, digits), value, of, wrong)


def value_fact(name: str, value: float, unit: Unit, of: str, digits: int = 3) -> ReportFact:
    """Return a fact with a value in a unit."""
    return ReportFact(name, value_cell(value, of, unit.size, digits), unit.name)


@dataclass(frozen=True, eq=False)
class ReportedRecord:
    """The ground acceleration of the runs, in m/s², scaled, at times in s; each array has the shape (n,)."""

    name: str
    source: str  # what is known of its origin, in a line; empty if nothing is
    time: Array
    acceleration: Array
    vertical: Array  # zero if there is none
    facts: list[ReportFact]  # its measures


def reported_record(report: ReportedRuns) -> ReportedRecord:
    """Return the record of the runs: from the motion if it is known, otherwise from the longest history."""
    name = report.responses[0].motion
    longest = max(range(len(report.histories)), key=lambda place: float(report.histories[place].time[-1]))
    history, run = report.histories[longest], report.responses[longest]
    second, g, velocity = (report.units.of(each) for each in ("time", "acceleration", "velocity"))
    ends = value_fact(translated("Length of the run"), float(history.time[-1]), second, "end_time")
    pva = float(np.max(np.abs(history.vertical_ground_acceleration), initial=0.0))
    vertical = [value_fact(translated("PVA, vertical"), pva, g, "pva")] if pva > 0.0 else []
    if report.motion is None:
        time, acceleration = history.time, history.ground_acceleration
        steps = 0.5 * (acceleration[1:] + acceleration[:-1]) * np.diff(time)
        pgv = float(np.max(np.abs(np.cumsum(steps)), initial=0.0))
        pga = float(np.max(np.abs(acceleration)))
        # All runs overturned, and nothing is known of the ground after the last of them did.
        fell = run.status == "overturned"
        facts = [
            value_fact(translated("PGA during the run") if fell else "PGA", pga, g, "pga"),
            value_fact(translated("PGV during the run") if fell else "PGV", pgv, velocity, "pgv"),
            *vertical,
            ends,
        ]
        return ReportedRecord(name, "", time, acceleration, history.vertical_ground_acceleration, facts)
    motion = report.motion.scaled(report.scale)
    scale = report.scale if motion.metadata is None or motion.metadata.scale is None else motion.metadata.scale
    facts = [
        ReportFact(translated("Scale"), ReportCell(f"{scale:.6g}", scale, "scale")),
        value_fact("PGA", motion.pga, g, "pga"),
        value_fact("PGV", motion.pgv, velocity, "pgv"),
        *vertical,
        value_fact(translated("Length of the record"), motion.duration, second, "duration"),
        value_fact(translated("Significant duration D_5–95"), motion.d5_95, second, "d5_95"),
        ends,
    ]
    upwards = np.zeros_like(motion.time) if motion.vertical is None else motion.vertical
    return ReportedRecord(name, _record_source_text(motion), motion.time, motion.acceleration, upwards, facts)


def _record_source_text(motion: GroundMotion) -> str:
    """Return event, station and vertical component in a line."""
    info = motion.metadata
    if info is None:
        return ""
    event = " ".join(str(each) for each in (info.event, info.year) if each is not None)
    size = "" if info.magnitude is None else f"M {info.magnitude:g}"
    vertical = (
        ""
        if motion.vertical is None or not info.vertical_source
        else translated("vertical: {source}", source=info.vertical_source)
    )
    return ", ".join(each for each in (event, size, info.station or "", info.component or "", vertical) if each)


def title_text(what: str, record: str) -> str:
    """Return the title of a report without one of its own."""
    return translated("{structure} under {record}", structure=what, record=record or translated("a ground motion"))


def title_of_several_text(what: str, n: int) -> str:
    """Return the title of a report on some records without one of its own."""
    return translated(
        "{structure} under {n} record" if n == 1 else "{structure} under {n} records", structure=what, n=n
    )


def structure_kind_text(structure: Any) -> str:
    """Return the kind of a structure in words: "Frame", "Cantilever with tip mass, restrained"."""
    around: list[str] = []
    while hasattr(structure, "structure"):  # restrained or eccentric
        around.append(translated(_class_name_in_words(structure).lower()))
        structure = structure.structure
    if isinstance(structure, RockingProperties):
        kind = translated("Structure given by its rocking properties" if structure.n_modes else "Rigid block")
    else:
        kind = translated(_class_name_in_words(structure))
    return ", ".join([kind, *around])


def structure_facts(p: RockingProperties, units: UnitSystem) -> list[ReportFact]:
    """Return the parameters of a structure."""
    mass, length, ratio, g = (units.of(each) for each in ("mass", "length", "ratio", "acceleration"))
    moment = units.of("moment", largest=p.resisting_moment)
    height = float(p.effective_height[0]) if p.n_modes else p.l0r / p.m_tot
    pivot = p.weaker_pivot
    slope = "h*_1/B" if p.n_modes else "h/B"
    base = (
        [] if p.base_mass is None else [value_fact(translated("Mass of the base m_0"), p.base_mass, mass, "base_mass")]
    )
    top = (
        []
        if p.top_height is None
        else [value_fact(translated("Height of the top"), p.top_height, length, "top_height")]
    )
    leaning = [
        value_fact(translated("Leaning mass"), p.leaning_mass, mass, "leaning_mass", 4),
        value_fact(
            translated("Share of the weight on the base"), 100.0 * p.weight_share, Unit(1.0, "%"), "weight_share"
        ),
    ]
    shift = [value_fact(translated("Eccentricity e"), p.eccentricity, length, "eccentricity")] if p.eccentricity else []
    lands: list[ReportFact] = []
    if p.opens != "both":
        lands.append(ReportFact(translated("Opens to one side"), ReportCell(translated(p.opens))))
    if p.restitution is not None:
        lands.append(value_fact(translated("Restitution"), p.restitution, ratio, "restitution", 4))
    held = (
        [value_fact(translated("Prestress of the tendons"), p.prestress, units.of("force"), "prestress")]
        if p.tendons
        else []
    )
    return [
        ReportFact(translated("Modes"), ReportCell(str(p.n_modes or translated("none (rigid)")), p.n_modes, "n_modes")),
        value_fact(translated("Total mass m_tot"), p.m_tot, mass, "m_tot", 4),
        *(leaning if p.leaning_mass else []),
        *base,
        *top,
        value_fact(translated("Half width of the base B"), p.half_width, length, "half_width"),
        *shift,
        *lands,
        value_fact(translated("Slenderness {ratio}", ratio=slope), height / p.half_width, ratio, "slenderness"),
        *_rotation_limit_facts(p, units.of("rotation")),
        value_fact(translated("Inertia about a pivot I_θ"), pivot.i_theta, units.of("inertia"), "i_theta", 4),
        *held,
        value_fact(translated("Resisting moment M_r"), p.resisting_moment, moment, "resisting_moment", 4),
        value_fact(translated("Uplift at a_lift = M_r/L_0"), p.uplift_acceleration, g, "uplift_acceleration"),
    ]


def _rotation_limit_facts(p: RockingProperties, unit: Unit) -> list[ReportFact]:
    """Return θ_nom, and α where the static moment vanishes at all; about both edges if they differ."""
    height, found = "h*_1" if p.n_modes else "h", list[ReportFact]()
    for pivot, name, width in zip(p.pivots, SIDES, ("B − e", "B + e"), strict=False):
        one = p.symmetric
        label = "θ_nom" if one else f"θ_nom {translated(name)}"
        arm = "B" if not p.eccentricity else f"({width})"
        nominal, end = pivot.nominal_overturning_rotation, "" if one else f"_{name}"
        found.append(value_fact(f"{label} = 0.7 atan({arm}/{height})", nominal, unit, f"nominal{end}"))
        if math.isfinite(pivot.balance_rotation):
            slope = "(L_0 g)" if not p.tendons else "(L_0 g − k_t)"
            label = f"α{'' if one else f' {translated(name)}'} = M_r/{slope}"
            found.append(value_fact(label, pivot.balance_rotation, unit, f"alpha{end}"))
    return found


def mode_table(p: RockingProperties, units: UnitSystem) -> ReportTable | None:
    """Return the first modes, on a fixed base and while uplifted; None for a rigid block."""
    if not p.n_modes:
        return None
    uplifted, length = _uplifted_modes_of_structure(p), units.of("length")
    shares = p.effective_mass / (p.horizontal_mass - (p.base_mass or 0.0))
    rows = [
        [
            ReportCell(str(n + 1)),
            value_cell(2.0 * math.pi / float(p.omega[n]), "period"),
            value_cell(None if uplifted is None else 2.0 * math.pi / float(uplifted.omega[n]), "uplifted_period"),
            value_cell(float(shares[n]), "mass_share", 0.01),
            value_cell(float(p.effective_height[n]), "effective_height", length.size),
            value_cell(float(p.zeta[n]), "zeta", 0.01),
            value_cell(None if uplifted is None else float(uplifted.damping_ratio[n]), "uplifted_damping_ratio", 0.01),
        ]
        for n in range(min(p.n_modes, MAX_MODES))
    ]
    if p.n_modes > 1:
        total, empty = ReportCell(f"1–{p.n_modes}" if p.n_modes > MAX_MODES else "Σ"), ReportCell("")
        rows.append([total, empty, empty, value_cell(float(np.sum(shares)), "mass_share", 0.01), empty, empty, empty])
    share = "m*_n/m_tot" if p.base_mass is None else "m*_n/Σm"
    heads = [(translated("mode"), ""), ("T_n", "s"), ("T*_n", "s"), (share, "%"), ("h*_n", length.name)]
    heads += [("ζ_n", "%"), ("ζ*_n", "%")]
    return ReportTable(heads, rows)


def _uplifted_modes_of_structure(p: RockingProperties) -> UpliftedModes | None:
    try:
        return uplifted_modes(p) if p.n_modes <= _MOST_UPLIFTED else None
    except (InputError, SolverError):
        return None


def _class_name_in_words(structure: Any) -> str:
    """Return the name of a class in words."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(structure).__name__).capitalize()


def initial_state_text(history: History, units: UnitSystem) -> str:
    """Return the rotation, the modal displacements and their velocities at the start, as far as they are not zero."""
    layout, state = history.model.layout, history.states[:1]
    # On springs the base may rest at an angle, from which the rotation of an initial state counts.
    rest = history.model.rest.rotation
    n = layout.modes
    values = [
        ("θ", layout.of(state, layout.rotation)[0] - rest, units.of("rotation")),
        ("θ′", layout.of(state, layout.spin)[0], named_unit("rad/s")),
        *((f"D_{k + 1}", layout.of(state, k)[0], units.of("displacement")) for k in range(n)),
        *((f"D′_{k + 1}", layout.of(state, n + k)[0], units.of("velocity")) for k in range(n)),
    ]
    shown = [
        f"{name} = {rounded_number(float(value) / unit.size)} {unit.name}"
        for name, value, unit in values
        if np.abs(value) / unit.size > 1e-12
    ]
    return ", ".join([*shown[: 2 + MAX_COORDINATES], *(["…"] if len(shown) > 2 + MAX_COORDINATES else [])])


def assumption_lines(report: ReportedRuns) -> list[tuple[str, str]]:
    """Return impact laws, hysteresis, ground and initial states as headed lines.

    What does not hold for all runs, or an impact law for all that have one, is followed by the labels of its runs.
    """
    found: dict[str, dict[str, list[str]]] = {head: {} for head in ASSUMPTIONS}
    for label, history in zip(report.labels, report.histories, strict=True):
        for head, text in _assumption_lines_of_run(history, report.units):
            found[head].setdefault(text, []).append(label)
    lines: list[tuple[str, str]] = []
    for head, texts in found.items():
        among = sum(map(len, texts.values())) if head == "Impact law" else len(report.labels)
        each = [text if len(runs) == among else f"{text} ({', '.join(runs)})" for text, runs in texts.items()]
        lines += [(translated(head), "; ".join(each))] if each else []
    return lines


def _assumption_lines_of_run(history: History, units: UnitSystem) -> list[tuple[str, str]]:
    """Return the assumptions of one run."""
    model = history.model
    lines = [("Impact law", _impact_law_text(model.law, model.properties))] if follows_impact_law(model) else []
    if model.bouc_wen is not None:
        lines.append(("Hysteresis", _hysteresis_text(model.bouc_wen, units)))
    lines += _ground_lines(model, units)
    start = initial_state_text(history, units)
    return [*lines, *([("Initial state", start)] if start else [])]


def follows_impact_law(model: Any) -> bool:
    """Whether an impact law ends the rocking of a model: on springs none does."""
    return model.lifts and model.springs is None


def _impact_law_text(law: Any, properties: RockingProperties) -> str:
    if isinstance(law, RuledLaw):
        left = restitution_left(law, properties)
        after = left and translated("{e} from one half cycle to the next", e=rounded_number(left[1], 4))
        return f"{law.in_words()}{f'; {after}' if after else ''}"
    return getattr(law, "description", type(law).__name__)


def _hysteresis_text(b: Any, units: UnitSystem) -> str:
    start = f"Bouc–Wen, D_y = {units.text(b.yield_displacement, 'displacement')}"
    ratio = translated("post-yield ratio {ratio}", ratio=f"{b.post_yield_ratio:g}")
    return f"{start}, {ratio}, γ = {b.gamma:g}, β = {b.beta:g}, n = {b.exponent:g}"


def _ground_lines(model: Any, units: UnitSystem) -> list[tuple[str, str]]:
    """Return the ground of a model; nothing for rigid ground on which it does not slide."""
    lines: list[tuple[str, str]] = []
    springs, mass, length = model.springs, model.properties.m_tot, units.of("length")
    if springs is not None:
        ratio = 0.5 * springs.total_damping / math.sqrt(springs.total_stiffness * mass)
        inertia = model.inertia - model.properties.translational_inertia
        parts = [
            translated("{n} springs without tension", n=springs.n),
            translated(
                "x = {first} to {last}",
                first=rounded_number(float(springs.positions[0]) / length.size),
                last=units.text(float(springs.positions[-1]), "length"),
            ),
            f"Σk = {units.text(springs.total_stiffness, 'stiffness')}",
            f"Σk x² = {units.text(springs.rotational_stiffness, 'rotational stiffness')}",
            translated(
                "Σc = {damping} ({percent} % of critical in heave)",
                damping=units.text(springs.total_damping, "damping"),
                percent=rounded_number(100.0 * ratio),
            ),
        ]
        if inertia > 1e-9 * model.inertia:
            parts.append(f"I_b = {units.text(inertia, 'inertia')}")
        lines.append(("Ground", ", ".join(parts)))
    friction = ground_friction_range(model)
    if friction is not None:
        least, most = friction
        span = f"{least:.4g}" if least == most else f"{least:.4g}–{most:.4g}"
        lines.append(("Friction", translated("the base slides at μ = {friction}", friction=span)))
    return lines


def ground_friction_range(model: Any) -> tuple[float, float] | None:
    """Return the least and the largest finite coefficient at which a base slides, or None if it cannot."""
    friction = getattr(model, "friction", None)
    if friction is None or model.layout.slip < 0:
        return None
    values = np.atleast_1d(np.asarray(friction, dtype=np.float64))
    return float(values.min()), float(values.max())


def elements_text(p: RockingProperties, units: UnitSystem) -> str:
    """Return the elements of a structure in a line, alike ones together; empty if there are none."""
    kinds = Counter(" ".join(describe_element(each, units)[:2]) for each in p.elements)
    return "; ".join(kind if count == 1 else f"{count} × {kind}" for kind, count in kinds.items())


def element_table(report: ReportedRuns) -> ReportTable | None:
    """Return elements and stories that yield with their largest forces and elongations; None if there are none.

    Elements count in runs that lift, and those away from the base and stories in all.
    """
    elements, stories = report.properties.elements, report.properties.stories
    away = bool(stories) or any(each.attached for each in elements)
    both = zip(report.responses, report.histories, strict=True)
    runs = [run for run, history in both if history.model.lifts or away]
    if not (elements or stories) or not runs:
        return None
    units, names = report.units, [report.units.of(each).name for each in ("length", "force", "displacement")]
    heads = [(translated("element"), ""), ("x", names[0]), (translated("properties"), ""), ("F_max", names[1])]
    heads += [("δ_max", names[2]), (translated("state"), "")]
    rows = [_element_table_row(k, elements, runs, units) for k in range(len(elements))]
    rows += [_story_table_row(each, runs, units) for each in stories]
    if len(rows) > MAX_ELEMENTS:
        blank = ReportCell("")
        rows[MAX_ELEMENTS:] = [[ReportCell(translated("and {n} more", n=len(rows) - MAX_ELEMENTS)), *[blank] * 5]]
    return ReportTable(heads, rows)


def _story_table_row(story: YieldingStory, runs: Sequence[Response], units: UnitSystem) -> list[ReportCell]:
    ductility = max(float(run.ductility[story.floor - 1]) for run in runs if run.ductility.size)
    left = max((abs(float(run.residual_drift[story.floor - 1])) for run in runs if run.ductility.size), default=0.0)
    beyond = ductility - 1.0 if ductility > 1.0 else 0.0
    force = story.yield_force * (min(ductility, 1.0) + story.post_yield_ratio * beyond)
    drift = ductility * story.yield_force / story.stiffness
    properties = f"k = {units.text(story.stiffness, 'stiffness')}, F_y = {units.text(story.yield_force, 'force')}"
    after = translated("post-yield ratio {ratio}", ratio=f"{story.post_yield_ratio:.4g}")
    remains = translated("{drift} left", drift=units.text(left if left > ROUNDING else 0.0, "displacement"))
    return [
        ReportCell(translated("story {number}", number=story.floor)),
        ReportCell(""),
        ReportCell(f"{properties}, {after}"),
        value_cell(force, f"max_story_force_{story.floor}", units.of("force").size),
        value_cell(drift, f"max_story_drift_{story.floor}", units.of("displacement").size),
        ReportCell(f"μ = {ductility:.2f}, {remains}"),
    ]


def _element_table_row(
    place: int, elements: Sequence[BaseElement], runs: Sequence[Response], units: UnitSystem
) -> list[ReportCell]:
    element, yielded = elements[place], any(bool(run.element_yielded[place]) for run in runs)
    force = max(float(run.max_element_force[place]) for run in runs)
    elongation = max(float(run.max_element_elongation[place]) for run in runs)
    name, properties, state = describe_element(element, units)
    broke = elongation >= element.breaks_at
    return [
        ReportCell(f"{place + 1} {name}"),
        ReportCell(element.where_in(units.of("length")))
        if element.attached
        else value_cell(element.position, "position", units.of("length").size),
        ReportCell(properties),
        value_cell(force, f"max_element_force_{place + 1}", units.of("force").size),
        value_cell(elongation, f"max_element_elongation_{place + 1}", units.of("displacement").size),
        ReportCell(
            translated("broken") if broke else state[yielded], None, "", broke or (yielded and element.prestressed)
        ),
    ]


def describe_element(element: BaseElement, units: UnitSystem) -> tuple[str, str, tuple[str, str]]:
    """Return kind, properties, and the words for an element that did not, or did, yield."""
    known = described_arguments(type(element))
    given = {name: value for name, value in element_parameters(element).items() if name not in PLACE}
    texts = [_property_text(name, value, known[name].unit, units) for name, value in given.items()]
    return translated(element.words), ", ".join(filter(None, texts)), element.yield_words


def _property_text(name: str, value: Any, unit: str, units: UnitSystem) -> str:
    """Return the text of a parameter of an element; empty for one that is not given."""
    if value is None or value is False:
        return ""
    if name == "post_yield_ratio":
        return translated("post-yield ratio {ratio}", ratio=f"{value:.4g}")
    if name == "rupture_elongation":
        return translated("breaks at {elongation}", elongation=units.text(value, "displacement"))
    if name == "tension_only":
        return translated("tension only")
    words = name.replace("_", " ")
    if value is True:
        return words
    if unit in _QUANTITIES and isinstance(value, float):
        return f"{_SYMBOLS.get(name, words)} = {units.text(value, _QUANTITIES[unit])}"
    return f"{words} = {shown(value)}"


def largest_rotations(run: Response, history: History) -> dict[int, float]:
    """Return the largest |θ| in rad to the right (1) and to the left (-1)."""
    found = {side: float(np.max(side * history.rotation, initial=0.0)) for side in (1, -1)}
    found[max(found, key=found.__getitem__)] = run.max_rotation  # also between the stored states
    return found


def nominal_rotation_share(p: RockingProperties, run: Response, history: History) -> float:
    """Return the largest |θ| over the nominal limit θ_nom = 0.7 atan(b/h*_1), to the side on which it is larger."""
    sides = largest_rotations(run, history).items()
    return max(value / p.pivot(side).nominal_overturning_rotation for side, value in sides)


def overturning_margin(p: RockingProperties, run: Response, history: History) -> float:
    """Return the smaller of the nominal limits over the rotation to the same side; infinite without rotation."""
    share = nominal_rotation_share(p, run, history)
    return 1.0 / share if share else math.inf


def peak_table(report: ReportedRuns) -> ReportTable:
    """Return the largest values of every run, with columns for the motion of its base on the ground."""
    columns = _peak_columns(report)
    rows: list[list[ReportCell]] = []
    for label, run, history in zip(report.labels, report.responses, report.histories, strict=True):
        fell = run.status == "overturned"
        words = translated(STATUS[run.status] if history.model.lifts else "fixed base")
        status = ReportCell(f"{words} {DAGGER}" if fell else words, None, "status", run.nominal_overturning)
        share = None if fell else nominal_rotation_share(report.properties, run, history)
        shaken = None if run.floors is None else float(np.max(run.floors.floor_acceleration))
        values = {"nominal_share": share, "max_floor_acceleration": shaken}
        cells = [
            value_cell(values[of] if of in values else float(getattr(run, of)), of, unit.size)
            for of, (_, unit) in columns.items()
        ]
        rows.append([ReportCell(label), status, *cells, ReportCell(str(run.n_uplifts), run.n_uplifts, "n_uplifts")])
    columns_of_values = [(name, unit.name) for name, unit in columns.values()]
    heads = [(translated("model"), ""), (translated("status"), ""), *columns_of_values, (translated("uplifts"), "")]
    return ReportTable(heads, rows)


def outputs_of_base(report: ReportedRuns) -> tuple[str, ...]:
    """Return the outputs of a base that can slide, and of one on springs."""
    layouts = [history.model.layout for history in report.histories]
    slides, gives = any(each.slip >= 0 for each in layouts), any(each.heave >= 0 for each in layouts)
    return (outputs_of("sliding") if slides else ()) + (outputs_of("springs") if gives else ())


def _peak_columns(report: ReportedRuns) -> dict[str, tuple[str, Unit]]:
    """Return the headings and units of the columns by the names of their values."""
    units, floors = report.units, any(run.floors is not None for run in report.responses)
    names = (*OF_MOTION, *(("max_floor_acceleration",) if floors else ()), *REACTIONS, *outputs_of_base(report))
    moment = max(run.max_base_moment for run in report.responses)
    columns = {name: (translated(OUTPUTS[name].symbol), OUTPUTS[name].unit_in(units, largest=moment)) for name in names}
    rotation = columns.pop("max_rotation")
    return {"max_rotation": rotation, "nominal_share": ("θ_max/θ_nom", units.of("share"))} | columns
