"""The checks of every run: uplift, overturning, contact, friction, its elements, and the energy balance."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import partial

from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import rounded_number
from rockflex.foundation.units import UnitSystem
from rockflex.report.run._report_tables import (
    ReportCell,
    ReportTable,
    follows_impact_law,
    ground_friction_range,
    overturning_margin,
    value_cell,
)
from rockflex.report.run._reported_runs import ReportedRuns
from rockflex.response._friction import IMPACT_WINDOW
from rockflex.response._history import History
from rockflex.response._limit_checks import NO_LIMIT, Check, CheckTable, check_in_units
from rockflex.response._response import BALANCED, Response

NO_BREAK = "\u00a0"  # a space at which no line ends
MAX_CLOSED_ROTATION, MAX_TILT = 1e-9, 1e-4  # rad
MAX_SETTLING_TIME = 5.0  # s of computing, for a base to come to rest
MAX_WORK = 2_000_000  # states times springs times modes: energies and friction of more take minutes


@dataclass(frozen=True)
class CheckedRun:
    """A run to check, and the coefficient of friction between base and ground, if it is known."""

    label: str
    response: Response
    history: History
    friction: float | None
    long: bool
    """Whether to compute its energies and required friction, which may take minutes."""
    units: UnitSystem


def labels_of_long_runs(report: ReportedRuns) -> set[str]:
    """Return the labels of runs whose energies and friction would take minutes: runs on many stiff springs."""
    found: set[str] = set()
    for label, history in zip(report.labels, report.histories, strict=True):
        springs, n_modes = history.model.springs, max(history.model.properties.n_modes, 1)
        if springs is not None and history.time.size * springs.n * n_modes > MAX_WORK:
            found.add(label)
    return found


def has_bearing_area(history: History) -> bool:
    """Return whether the base stands on springs with an area."""
    springs = history.model.springs
    return springs is not None and springs.area is not None


def run_check_table(report: ReportedRuns, friction: float | None, omitted: Collection[str]) -> ReportTable:
    """Return the checks, a row for each run; long ones are left out for the labels in `omitted`."""
    runs = [
        CheckedRun(label, response, history, friction, label not in omitted, report.units)
        for label, response, history in zip(report.labels, report.responses, report.histories, strict=True)
    ]
    columns = {
        translated("uplift"): _uplift_cell,
        translated("overturning"): partial(_overturning_cell, report),
        translated("contact"): _contact_cell,
        translated("friction"): _friction_cell,
    }
    if report.properties.tendons:
        columns[translated("tendons")] = _tendon_cell
    if report.properties.elements:
        columns[translated("re-centring")] = partial(_residual_rotation_cell, report)
    columns[translated("energy balance")] = _energy_balance_cell
    return ReportTable(
        [(name, "") for name in (translated("model"), *columns)],
        [[ReportCell(run.label), *(check(run) for check in columns.values())] for run in runs],
    )


def _uplift_cell(run: CheckedRun) -> ReportCell:
    if not run.history.model.lifts:
        return ReportCell(translated("fixed base"))
    times = run.history.uplift_times
    # On springs, off the ground is where an edge is.
    start = translated("starts uplifted") if run.history.uplifted[0] else ""
    if run.response.n_uplifts == 0 or not times.size:
        return ReportCell(start or translated("none"), 0.0, "n_uplifts")
    first = translated(
        "{n}×, next at {time} s" if start else "{n}×, first at {time} s",
        n=run.response.n_uplifts,
        time=rounded_number(float(times[0])),
    )
    return ReportCell(f"{start}; {first}" if start else first, float(times[0]), "first_uplift")


def _overturning_cell(report: ReportedRuns, run: CheckedRun) -> ReportCell:
    """Compare the rotation to either side with the nominal limit θ_nom of Section 3.3."""
    if not run.history.model.lifts:
        return ReportCell("–")
    if run.response.status == "overturned":
        end = run.response.end_time
        return ReportCell(translated("overturned at {time} s", time=rounded_number(end)), end, "end_time", True)
    if run.response.max_rotation == 0.0:
        return ReportCell(translated("no rotation"), 0.0, "max_rotation")
    margin = overturning_margin(report.properties, run.response, run.history)
    beyond = run.response.nominal_overturning
    return ReportCell(f"{rounded_number(margin)} {'<' if beyond else '≥'} 1", margin, "overturning_margin", beyond)


def _contact_cell(run: CheckedRun) -> ReportCell:
    least = run.response.min_vertical_reaction
    if run.history.model.springs is not None:
        if not (run.long and has_bearing_area(run.history)):
            return ReportCell(translated("springs only push"), least, "min_vertical_reaction")
        bearing, soil = (float(q.max()) for q in (run.history.bearing_pressure, run.history.soil_pressure))
        size = run.units.of("stress").size
        words = translated(
            "q {bearing}, {spring} at a spring",
            bearing=run.units.text(bearing, "stress"),
            spring=rounded_number(soil / size),
        )
        return ReportCell(words, bearing, "bearing_pressure")
    held = least >= 0.0
    when = rounded_number(run.response.time_of_min_vertical_reaction)
    words = "N ≥ 0" if held else translated("N < 0 at {time} s", time=when)
    return ReportCell(words, least, "min_vertical_reaction", not held)


def _friction_cell(run: CheckedRun) -> ReportCell:
    """Compare |ΣF_x|/ΣF_z with the coefficient; a base that slides shows how far."""
    limits = ground_friction_range(run.history.model)
    if limits is not None:
        moved = run.response.max_slip
        far = run.units.text(moved, "displacement")
        words = translated("slides {slip}", slip=far) if moved else translated("does not slide")
        return ReportCell(words, moved, "max_slip")
    if not run.long:
        return ReportCell(translated("not computed"))
    try:
        whole = run.history.required_friction
        needed = run.history.required_friction_excluding_impacts()
    except InputError:
        return ReportCell(translated("not computed"))
    spikes = translated(" ({friction} with impacts)", friction=rounded_number(whole))
    spikes = "" if math.isclose(whole, needed, rel_tol=5e-3) else spikes
    if run.friction is None:
        return ReportCell(f"μ ≥ {rounded_number(needed)}{spikes}", needed, "required_friction")
    slips = needed > run.friction
    words = f"{rounded_number(needed)}{spikes} {'>' if slips else '≤'} {run.friction:.4g}"
    return ReportCell(words, needed, "required_friction", slips)


def _tendon_cell(run: CheckedRun) -> ReportCell:
    if not run.history.model.lifts:
        return ReportCell("–")
    used, force = run.response.tendon_utilisation, run.response.max_tendon_force
    if math.isnan(used):
        return ReportCell(run.units.text(force, "force"), force, "max_tendon_force")
    sign = ">" if used > 1.0 else "≤"
    words = translated(", yields") if run.response.tendon_yield and not run.response.tendon_overload else ""
    return ReportCell(f"F/F_y = {rounded_number(used)} {sign} 1{words}", used, "tendon_utilisation", used > 1.0)


def _residual_rotation_cell(report: ReportedRuns, run: CheckedRun) -> ReportCell:
    """Residual rotation of the base at rest, and λ at |θ| → 0 and at the largest rotation."""
    p, response = report.properties, run.response
    if not run.history.model.lifts or response.status == "overturned":
        return ReportCell("–")
    ratios = ""
    if math.isfinite(p.recentring_ratio):
        turned = response.max_rotation
        ratios = f"; λ = {rounded_number(p.recentring_ratio)}"
        there = rounded_number(p.recentring_ratio_at(turned))
        ratios += translated(", {ratio} at θ_max", ratio=there) if turned > 0.0 else ""
    left = _settled_rotation(run)
    if left is None:
        now = run.units.text(response.residual_rotation, "rotation")
        return ReportCell(
            translated("not settled, θ = {rotation}", rotation=now) + ratios,
            response.residual_rotation,
            "residual_rotation",
        )
    if math.isnan(left):
        return ReportCell(translated("overturns after the run") + ratios, None, "settled_rotation", True)
    if abs(left) < MAX_CLOSED_ROTATION:
        return ReportCell(translated("closes") + ratios, left, "settled_rotation")
    # On springs fuses that yielded tilt a base that is closed.
    wrong = abs(left) > MAX_TILT or run.history.model.springs is None
    words = translated("θ = {rotation} left", rotation=run.units.text(left, "rotation"))
    return ReportCell(words + ratios, left, "settled_rotation", wrong)


def _settled_rotation(run: CheckedRun) -> float | None:
    """Return the rotation that remains in rad; None if it takes too long to find."""
    if run.response.settled:
        return run.response.residual_rotation
    try:
        return run.history.settled_rotation(MAX_SETTLING_TIME) if run.long else None
    except (InputError, SolverError):
        return None


def _energy_balance_cell(run: CheckedRun) -> ReportCell:
    """Show the error of the energy balance over the input."""
    if not run.long:
        return ReportCell(translated("not computed"))
    try:
        error = run.history.energy.closing_error
    except InputError:
        return ReportCell(translated("not computed"))
    if error <= BALANCED:
        return ReportCell(translated("closes to {error}", error=_power_of_ten_text(error)), error, "closing_error")
    return value_cell(error, "closing_error", wrong=True)


def _power_of_ten_text(value: float) -> str:
    """Write a small error as a power of ten that it does not exceed."""
    return "0" if value == 0.0 else f"10^{math.ceil(math.log10(value))}".replace("-", "−")


def run_check_legend(report: ReportedRuns, friction: float | None, *, omitted: bool) -> list[str]:
    """Return the legend of the columns."""
    models = [history.model for history in report.histories]
    slides = [ground_friction_range(model) is not None for model in models]
    lines = [
        translated("Overturning: nominal limit θ_nom over θ_max, to the side that is nearer to it.")
        if report.properties.eccentricity
        else translated("Overturning: nominal limit θ_nom over θ_max.")
    ]
    if not all(slides):
        window = f"{IMPACT_WINDOW:g}"
        lines.append(
            translated("Friction: largest |ΣF_x|/N without the {window} s after each impact.", window=window)
            if friction is None
            else translated(
                "Friction: largest |ΣF_x|/N without the {window} s after each impact, to be below the μ = {friction} "
                "given.",
                window=window,
                friction=f"{friction:.4g}",
            )
        )
    if any(slides):
        lines.append(translated("Friction of a base that can slide: how far it does."))
    if any(map(has_bearing_area, report.histories)):
        lines.append(
            translated(
                "Contact: q, the largest static bearing pressure of the effective area, and of a spring with its "
                "dashpot."
            )
        )
    if report.properties.elements:
        lines.append(translated("Re-centring: what remains when the base is at rest, in free vibration after the run."))
    lines.append(translated("Energy balance: its largest error over the input energy."))
    if any(map(follows_impact_law, models)):
        lines.append(
            translated(
                "Forces with an impact law: without the impulse of impacts, and on rigid ground without rebound; on "
                "stiff ground that rebounds V_b of flexural structures may be larger."
            )
        )
    if omitted:
        lines.append(translated("Not computed: energies and friction of a run that would take too long here."))
    return lines


def limit_check_table(labels: Sequence[str], tables: Sequence[CheckTable], units: UnitSystem) -> ReportTable:
    """Return checks against limits: a row a check, with the demand and its ratio for each label."""
    rows: dict[str, list[Check | None]] = {}
    for place, table in enumerate(tables):
        for each in table.rows:
            rows.setdefault(each.name, [None] * len(tables))[place] = each
    heads = [
        (translated("check (ratio)"), ""),
        *((label, "") for label in labels),
        (translated("limit"), ""),
        (translated("source of the limit"), ""),
    ]
    body: list[list[ReportCell]] = []
    for name, found in rows.items():
        first = next(each for each in found if each is not None)
        limit, unit = check_in_units(first, units)[1:]
        sign = "≥" if first.at_least else "≤"
        words = "–" if limit is None else f"{sign} {rounded_number(limit)} {unit}".rstrip().replace(" ", NO_BREAK)
        cells = [ReportCell("–") if each is None else _limit_check_cell(each, units) for each in found]
        body.append(
            [
                ReportCell(translated(name)),
                *cells,
                ReportCell(words),
                ReportCell(translated(first.source) or (first.note if len(tables) == 1 else "–")),
            ]
        )
    return ReportTable(heads, body)


def _limit_check_cell(row: Check, units: UnitSystem) -> ReportCell:
    demand, _, unit = check_in_units(row, units)
    if math.isnan(demand):
        return ReportCell(translated("overturns"), None, "demand", True)
    ratio = ""
    if row.ratio is not None:
        ratio = f" ({rounded_number(row.ratio)}, {translated('ok' if row.ok else 'fails')})"
    return ReportCell(
        f"{rounded_number(demand)} {unit}".rstrip().replace(" ", NO_BREAK) + ratio,
        row.demand,
        "demand",
        row.ok is False,
    )


def missing_checks_text(table: CheckTable) -> str:
    """Return what was not checked, and why, in a sentence for each reason."""
    lacking = [(translated(name), lacks) for name, lacks in table.missing if NO_LIMIT not in lacks]
    return " ".join(translated("Not checked: {name}: {reason}.", name=name, reason=lacks) for name, lacks in lacking)
