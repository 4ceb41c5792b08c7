"""What holds, carries and dissipates: impact laws, hysteresis, the ground, and the elements between it and the base."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rockflex.modal import BaseElement, FrictionDamper, Tendon, ViscousDamper
from rockflex.models import Restitution, SidedRestitution, SpringModel
from rockflex.report.run._given import Given
from rockflex.report.run._numbers import rounded
from rockflex.report.run._start import initial_state
from rockflex.report.run._table import Cell, Table, shows
from rockflex.response import History, Response

LISTED = 6  # elements
_LAW, _START = "Impact law", "Initial state"


def assumption_lines(about: Given) -> list[tuple[str, str]]:
    """Return impact laws, hysteresis, ground and initial states as headed lines.

    What does not hold for all runs, or an impact law for all that have one, is followed by the labels of its runs.
    """
    found: dict[str, dict[str, list[str]]] = {head: {} for head in (_LAW, "Hysteresis", "Ground", "Friction", _START)}
    for label, history in zip(about.labels, about.histories, strict=True):
        for head, text in _lines_of(history):
            found[head].setdefault(text, []).append(label)
    lines: list[tuple[str, str]] = []
    for head, texts in found.items():
        among = sum(map(len, texts.values())) if head == _LAW else len(about.labels)
        each = [text if len(runs) == among else f"{text} ({', '.join(runs)})" for text, runs in texts.items()]
        lines += [(head, "; ".join(each))] if each else []
    return lines


def _lines_of(history: History) -> list[tuple[str, str]]:
    """Return what one run assumes."""
    model = history.model
    lines = [(_LAW, _law(model.law))] if follows_law(model) else []
    if model.bouc_wen is not None:
        lines.append(("Hysteresis", _hysteresis(model.bouc_wen)))
    lines += _ground(model)
    start = initial_state(history)
    return [*lines, *([(_START, start)] if start else [])]


def follows_law(model: Any) -> bool:
    """Whether an impact law ends the rocking of a model: on springs none does."""
    return model.lifts and not isinstance(model, SpringModel)


def _law(law: Any) -> str:
    if isinstance(law, Restitution):
        return f"Restitution, e = {rounded(law.e)}"
    if isinstance(law, SidedRestitution):
        right, left = rounded(law.right.e), rounded(law.left.e)
        return f"Restitution, e = {right} from the right and {left} from the left edge"
    return getattr(law, "description", type(law).__name__)


def _hysteresis(b: Any) -> str:
    return (
        f"Bouc–Wen, D_y = {rounded(1e3 * b.yield_displacement)} mm, post-yield ratio {b.post_yield_ratio:g}, "
        f"γ = {b.gamma:g}, β = {b.beta:g}, n = {b.exponent:g}"
    )


def _ground(model: Any) -> list[tuple[str, str]]:
    """Return the ground of a model; nothing for rigid ground on which it does not slide."""
    lines: list[tuple[str, str]] = []
    if isinstance(model, SpringModel):
        springs, mass = model.springs, model.properties.m_tot
        ratio = 0.5 * springs.total_damping / math.sqrt(springs.total_stiffness * mass)
        inertia = model.inertia - model.properties.translational_inertia
        turns = f", I_b = {rounded(inertia / 1e3)} t m²" if inertia > 1e-9 * model.inertia else ""
        lines.append(
            (
                "Ground",
                f"{springs.n} springs without tension, x = {rounded(float(springs.positions[0]))} to "
                f"{rounded(float(springs.positions[-1]))} m, Σk = {rounded(springs.total_stiffness / 1e6)} MN/m, "
                f"Σk x² = {rounded(springs.rotational_stiffness / 1e6)} MN m/rad, Σc = "
                f"{rounded(springs.total_damping / 1e3)} kN s/m ({rounded(100.0 * ratio)} % of critical in heave)"
                f"{turns}",
            )
        )
    friction = ground_friction(model)
    if friction is not None:
        least, most = friction
        span = f"{least:.4g}" if least == most else f"{least:.4g} to {most:.4g}"
        lines.append(("Friction", f"the base slides at μ = {span}"))
    return lines


def ground_friction(model: Any) -> tuple[float, float] | None:
    """Return the least and the largest finite coefficient at which a base slides, or None if it cannot."""
    friction = getattr(model, "friction", None)
    if friction is None or model.layout.slip < 0:
        return None
    values = np.atleast_1d(np.asarray(friction, dtype=np.float64))
    return float(values.min()), float(values.max())


def element_table(about: Given) -> Table | None:
    """Return the elements of the base with their largest forces and elongations among the runs that lift.

    Returns None if there are none, or no run lifts.
    """
    elements = about.properties.elements
    runs = [run for run, history in zip(about.responses, about.histories, strict=True) if history.model.lifts]
    if not elements or not runs:
        return None
    heads = [("element", ""), ("x", "m"), ("properties", ""), ("F_max", "kN"), ("δ_max", "mm"), ("state", "")]
    rows = [_row(k, elements, runs) for k in range(min(len(elements), LISTED))]
    if len(elements) > LISTED:
        blank = Cell("")
        rows.append([Cell(f"and {len(elements) - LISTED} more"), *[blank] * 5])
    return Table(heads, rows)


def _row(place: int, elements: Sequence[BaseElement], runs: Sequence[Response]) -> list[Cell]:
    element = elements[place]
    force = max(float(run.max_element_force[place]) for run in runs)
    elongation = max(float(run.max_element_elongation[place]) for run in runs)
    yielded = any(bool(run.element_yielded[place]) for run in runs)
    name, properties, state = _words(element)
    return [
        Cell(f"{place + 1} {name}"),
        shows(element.position, "position"),
        Cell(properties),
        shows(force, f"max_element_force_{place + 1}", 1e3),
        shows(elongation, f"max_element_elongation_{place + 1}", 1e-3),
        Cell(state[yielded], None, "", yielded and isinstance(element, Tendon)),
    ]


def _words(element: BaseElement) -> tuple[str, str, tuple[str, str]]:
    """Return kind, properties, and the words for an element that did not, or did, yield."""
    if isinstance(element, ViscousDamper):
        return "viscous damper", f"c = {rounded(element.coefficient / 1e3)} kN s/m", ("", "")
    if isinstance(element, FrictionDamper):
        return "friction damper", f"F_0 = {rounded(element.force / 1e3)} kN", ("did not slide", "slid")
    stiffness = f"k = {rounded(element.stiffness / 1e6)} MN/m"
    limit = "" if element.yield_force is None else f", F_y = {rounded(element.yield_force / 1e3)} kN"
    after = "" if element.post_yield_ratio is None else f", post-yield ratio {element.post_yield_ratio:.4g}"
    breaks = "" if element.rupture_elongation is None else f", breaks at {rounded(1e3 * element.rupture_elongation)} mm"
    if isinstance(element, Tendon):
        state = ("elastic", "beyond F_y" if element.post_yield_ratio is None else "yielded")
        start = f"F_0 = {rounded(element.initial_force / 1e3)} kN, "
        return "tendon", start + stiffness + limit + after + breaks, state
    only = ", tension only" if element.tension_only else ""
    return "yielding dissipator", stiffness + limit + after + breaks + only, ("elastic", "yielded")
