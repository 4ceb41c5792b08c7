"""Checks of a run, or of a set of records, against limits: uplift, drifts, elements, and the ground under the base."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_in_range, checked_instance, checked_positive
from rockflex.foundation.errors import InputError, MissingQuantityError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.language import translated
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.foundation.units import UnitSystem
from rockflex.foundation.values import Value
from rockflex.response._history import History
from rockflex.response._moment_rotation import contact_length
from rockflex.response._record_set import RecordSet, design_value
from rockflex.response._response import Response, history_of

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, kw_only=True)
class CheckLimits:
    """The limits of `check`, and the sizes that some of them need; None: not checked.

    The sources of such limits are in "Checks" of the theory.

    Attributes
    ----------
    moment_ratio : float or None
        Base moment over the resisting moment, M_b/M_r. Without it the check tells whether the base lifts.
    rotation_ratio : float or None
        |θ| over α, the rotation at which the static moment vanishes.
    drift_ratio : float or None
        Story drift over the height of the story.
    tendon_ratio : float
        Tendon force over its yield force A f_p,y: stress over f_p,y.
    fuse_length, fuse_strain : float or None
        Length in m of a fuse that yields, and its strain: elongation over length.
    bearing_pressure : float or None
        Pressure under the base in Pa.
    breadth : float or None
        Width of the base perpendicular to the plane of rocking in m, for pressures on rigid ground and of toes.
    contact_ratio : float or None
        Smallest length in contact over the width 2 B of the base, up to 1.
    friction : float or None
        Coefficient of friction that is available between base and ground.
    slip : float or None
        Displacement along the ground in m of a base that can slide.
    seat_width : float or None
        Displacement of the top relative to the ground in m, rotation included, at which what lies on it loses its seat.
    toe_length, toe_stress : float or None
        Length in m of the bearing at either edge of the base, and its stress in Pa, f_cd or f_ck for example.

    Raises
    ------
    InputError
        If a value is not positive, or the `contact_ratio` above 1.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.CheckLimits(drift_ratio=0.01, friction=0.5).tendon_ratio
    1.0
    """

    moment_ratio: float | None = None
    rotation_ratio: float | None = None
    drift_ratio: float | None = None
    tendon_ratio: float = 1.0
    fuse_length: float | None = None
    fuse_strain: float | None = None
    bearing_pressure: float | None = None
    breadth: float | None = None
    contact_ratio: float | None = None
    friction: float | None = None
    slip: float | None = None
    seat_width: float | None = None
    toe_length: float | None = None
    toe_stress: float | None = None

    def __post_init__(self) -> None:
        units = {"bearing_pressure": "Pa", "toe_stress": "Pa"}
        lengths = ("fuse_length", "breadth", "slip", "seat_width", "toe_length")
        for each in fields(self):
            value: Any = getattr(self, each.name)
            if value is None and each.default is None:
                continue
            unit = "m" if each.name in lengths else units.get(each.name, "")
            number = checked_positive(each.name, value, unit)  # pyright: ignore[reportArgumentType]
            object.__setattr__(self, each.name, number)
        if self.contact_ratio is not None:
            checked_in_range("contact_ratio", self.contact_ratio, 0.0, 1.0, closed=True)


@dataclass(frozen=True)
class Check:
    """One check of a `CheckTable`.

    Attributes
    ----------
    name : str
        What is checked.
    demand : float
        In `unit`; NaN where a record overturns and the rule of its set gives no value.
    limit : float or None
        In `unit`; None where the check tells what happens, and nothing is to be kept.
    unit : str
        SI unit, empty for a ratio.
    source : str
        Where the limit comes from: a publication, the structure, or "user".
    note : str
        How the demand was found, and what it includes.
    at_least : bool
        Whether the demand must not fall below the limit, rather than not exceed it.
    """

    name: str
    demand: float
    limit: float | None
    unit: str
    source: str
    note: str
    at_least: bool = False

    @property
    def ratio(self) -> float | None:
        """Demand over limit, or limit over demand where it is `at_least`; infinite for a demand of zero then."""
        if self.limit is None:
            return None
        if self.at_least:
            return math.inf if self.demand == 0.0 else self.limit / self.demand
        return self.demand / self.limit

    @property
    def ok(self) -> bool | None:
        """Whether the limit is kept; None without one, and False where a record overturns and leaves no demand."""
        return None if self.ratio is None else self.ratio <= 1.0


USER, YIELD_FORCE, RUPTURE = "user", "yield force of the tendon", "elongation at which the element breaks"
NOMINAL_LIMIT = "0.7 atan(B/h*_1), Silva & Stojadinović 2024, Section 3.3"
SOURCES = (USER, YIELD_FORCE, RUPTURE, NOMINAL_LIMIT)  # of limits
NO_LIMIT = "no limit: give"  # begins what a check lacks that only needs its limit
_QUANTITIES = {"": "ratio", "rad": "rotation", "m": "displacement", "Pa": "stress"}


def check_in_units(check: Check, units: UnitSystem) -> tuple[float, float | None, str]:
    """Return demand, limit and unit of a check as tables show them."""
    size, unit = units.of(_QUANTITIES[check.unit])
    return check.demand / size, None if check.limit is None else check.limit / size, unit


@dataclass(frozen=True, repr=False)
class CheckTable(HtmlTable, Value):
    """The checks for which there were data; `check` returns it.

    Attributes
    ----------
    rows : tuple of Check
        The checks.
    missing : tuple of tuple of str
        The name of each other check, and what it lacks.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> run = rf.simulate(block, rf.one_sine_pulse(amplitude=4.0, period=1.0),
    ...     "rigid")
    >>> table = rf.check(run, rf.CheckLimits(rotation_ratio=0.5))
    >>> [(each.name, round(each.ratio, 2)) for each in table.rows]
    [('rotation', 0.37), ('rotation over α', 0.5)]
    """

    rows: tuple[Check, ...]
    missing: tuple[tuple[str, str], ...]

    def __repr__(self) -> str:
        failed = [each.name for each in self.rows if each.ok is False]
        return f"CheckTable({number_with_noun(len(self.rows), 'check')}, failed: {', '.join(failed) or 'none'})"

    def _shown_as(self) -> dict[str, Any]:
        words = {True: "ok", False: "fails", None: "-"}
        return {
            each.name: f"{words[each.ok]}: {each.demand:.4g} {each.unit}"
            + ("" if each.limit is None else f" for a limit of {each.limit:.4g} ({each.source})")
            for each in self.rows
        }

    @property
    def ok(self) -> bool:
        """Whether no limit is exceeded."""
        return all(each.ok is not False for each in self.rows)

    def to_frame(self) -> "pd.DataFrame":
        """Return the checks as a table indexed by name: demand, limit, unit, ratio, ok, source and note."""
        import pandas as pd

        names = ("name", "demand", "limit", "unit", "ratio", "ok", "source", "note")
        return pd.DataFrame([{name: getattr(each, name) for name in names} for each in self.rows]).set_index("name")


def check(result: Response | RecordSet, limits: CheckLimits | None = None) -> CheckTable:
    """Check a run, or a set of records, against limits.

    Of a set, the demand of each check is the value that its rule gives for the demands of the single records.

    Parameters
    ----------
    result
        A response with its history, or what `simulate_set` returned.
    limits
        The limits. Default: those that a source gives: the nominal limit of the rotation, 0.7 atan(B/h*_1) (Silva &
        Stojadinović 2024, Section 3.3), and the yield forces and rupture elongations of the elements.

    Returns
    -------
    CheckTable
        The checks, each with demand, limit, ratio and source, and what the others lack.

    Raises
    ------
    InputError
        If the result is none of both or has no history, or a limit is none.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> run = rf.simulate(frame, rf.one_sine_pulse(amplitude=3.0, period=0.8),
    ...     "2DOF-S")
    >>> table = rf.check(run, rf.CheckLimits(drift_ratio=0.005, friction=0.5))
    >>> table
    CheckTable(4 checks, failed: none)
    >>> table.to_frame()["ratio"].round(2).to_dict()
    {'uplift': nan, 'rotation': 0.23, 'story drift': 0.91, 'sliding': 0.5}
    """
    given = checked_instance("limits", CheckLimits() if limits is None else limits, CheckLimits)
    if not isinstance(result, Response | RecordSet):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"result must be a Response or what simulate_set returned, but {shown(result)} was given.", field="result"
        )
    runs = result.responses if isinstance(result, RecordSet) else (result,)
    rule = result.rule if isinstance(result, RecordSet) else None
    fallen = np.array([run.status == "overturned" for run in runs])
    histories = [history_of(run) for run in runs]
    rows, missing = list[Check](), list[tuple[str, str]]()
    for kind in KINDS:
        try:
            limit = kind.limit(histories[0], given)
            demands = np.array([kind.demand(run, own, given) for run, own in zip(runs, histories, strict=True)])
        except MissingQuantityError as lacks:
            missing.append((kind.name, str(lacks)))
            continue
        demand, note = design_value(demands, fallen, rule, worst_is_least=kind.at_least)
        words = () if len(runs) == 1 and not fallen.any() else (note,)
        note = "; ".join((*kind.remark(runs), *words))
        rows.append(Check(kind.name, demand, limit.value, kind.unit, limit.source, note, kind.at_least))
    return CheckTable(tuple(rows), tuple(missing))


class Limit(NamedTuple):
    """A limit and its source."""

    value: float | None
    source: str = USER


@dataclass(frozen=True)
class CheckKind:
    """A check: its demand of a run, and its limit; either raises a `MissingQuantityError` that says what it lacks."""

    name: str
    unit: str
    demand: Callable[[Response, History, CheckLimits], float]
    limit: Callable[[History, CheckLimits], Limit]
    at_least: bool = False
    remark: Callable[[tuple[Response, ...]], Iterator[str]] = lambda _: iter(())


def _user(*names: str) -> Callable[[History, CheckLimits], Limit]:
    """Return the function that gives the user's limit, the first of these, all of which are needed."""

    def limit(_: History, limits: CheckLimits) -> Limit:
        for name in names:
            if getattr(limits, name) is None:
                raise MissingQuantityError(
                    f"{NO_LIMIT} {name}" if name == names[0] else translated("give {name}", name=name)
                )
        return Limit(getattr(limits, names[0]))

    return limit


def _check_lifts(history: History) -> None:
    if not history.model.lifts:
        raise MissingQuantityError(translated("the base is fixed"))


def _uplift_remark(runs: tuple[Response, ...]) -> Iterator[str]:
    lifting, n = sum(run.status != "no_uplift" for run in runs), len(runs)
    if n > 1:
        yield translated("the base lifts in {k} of {n} records", k=lifting, n=n)
    elif lifting:
        impacts = runs[0].n_impacts
        yield translated("the base lifts, {n} impact" if impacts == 1 else "the base lifts, {n} impacts", n=impacts)
    else:
        yield translated("the base stays closed")


def _moment_over_resisting(run: Response, history: History, _: CheckLimits) -> float:
    if not history.model.properties.n_modes:
        raise MissingQuantityError(translated("a rigid block has no elastic forces"))
    return run.max_base_moment / history.model.properties.resisting_moment


def _rotation(run: Response, history: History, _: CheckLimits) -> float:
    _check_lifts(history)
    return run.max_rotation


def _nominal_rotation(history: History, _: CheckLimits) -> Limit:
    limit = history.model.properties.nominal_overturning_rotation
    return Limit(limit, NOMINAL_LIMIT)


def _rotation_over_balance(run: Response, history: History, _: CheckLimits) -> float:
    _check_lifts(history)
    if all(math.isinf(each.balance_rotation) for each in history.model.properties.pivots):
        raise MissingQuantityError(translated("tendons keep the static moment from vanishing, so there is no α"))
    return run.balance_ratio


def _drift_ratio(run: Response, history: History, _: CheckLimits) -> float:
    floors = history.model.properties.floors
    if run.floors is None or floors is None:
        raise MissingQuantityError(translated("the structure has no floors"))
    first = int(floors.heights[0] == 0.0)  # stations of a distributed mass begin with the base
    heights = floors.story_heights[first:]
    if heights.min() <= 0.0:
        raise MissingQuantityError(translated("the floors do not stand one above another, so stories have no height"))
    return float((run.floors.story_drift[first:] / heights).max())


def _tendon_ratio(run: Response, history: History, _: CheckLimits) -> float:
    if not history.model.properties.tendons:
        raise MissingQuantityError(translated("there are no tendons"))
    if math.isnan(run.tendon_utilisation):
        raise MissingQuantityError(translated("give the tendons their yield_force"))
    return run.tendon_utilisation


def _fuse_strain(run: Response, history: History, limits: CheckLimits) -> float:
    fuses = [each.fuse for each in history.model.properties.elements]
    if not any(fuses):
        raise MissingQuantityError(translated("there are no fuses"))
    assert limits.fuse_length is not None
    return float(run.max_element_elongation[fuses].max()) / limits.fuse_length


def _rupture_ratio(run: Response, history: History, _: CheckLimits) -> float:
    ends = np.array([each.breaks_at for each in history.model.properties.elements])
    if not np.isfinite(ends).any():
        raise MissingQuantityError(translated("no element breaks at an elongation"))
    return float((run.max_element_elongation / ends).max())


def _distance_to_edge(history: History) -> tuple[Array, Array]:
    """Return the distance in m of the ground's resultant from the nearer edge, and the resultant in N, shape (n,).

    On rigid ground while the base is closed. Moments about the axis of the masses: those of inertia, -Σ m_i h_i
    (a + u''_i), and of the elements under the base, which pull on the ground where they stand.
    """
    p = history.model.properties
    if np.any(history.side != 0.0):
        raise MissingQuantityError(
            translated(
                "on rigid ground a base that lifts stands on its edge, where no length and no pressure is defined. "
                "Give simulate a Ground with springs, such as winkler_bed, or check the toe"
            )
        )
    if any(each.height is not None for each in p.elements):
        raise MissingQuantityError(
            translated("ties to the ground carry a part of the moment; give simulate a Ground with springs")
        )
    force = history.vertical_reaction
    moved = history.modal_acceleration
    base = (history.horizontal_reaction - moved @ p.effective_mass) / p.horizontal_mass  # a, and that of sliding
    inertia = p.l0r * base + moved @ (p.effective_mass * p.effective_height)
    places = np.array([each.position for each in p.elements])
    place = (history.element_force @ places - inertia) / np.where(force > 0.0, force, math.inf)
    return np.maximum(np.minimum(p.pivot(1).arm - place, p.pivot(-1).arm + place), 0.0), force


def _bearing_pressure(_: Response, history: History, limits: CheckLimits) -> float:
    if history.model.springs is not None:
        return float(history.bearing_pressure.max())
    if limits.breadth is None:
        raise MissingQuantityError(translated("give breadth, the width of the base perpendicular to the plane"))
    edge, force = _distance_to_edge(history)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.where(force > 0.0, force / (2.0 * limits.breadth * edge), 0.0).max())


def _contact_ratio(_: Response, history: History, __: CheckLimits) -> float:
    width = 2.0 * history.model.properties.half_width
    if history.model.springs is not None:
        return float(contact_length(history.edge_uplift, width).min()) / width
    return min(3.0 * float(_distance_to_edge(history)[0].min()) / width, 1.0)


def _required_friction(_: Response, history: History, __: CheckLimits) -> float:
    if history.model.layout.slip >= 0:
        raise MissingQuantityError(translated("the base can slide: give slip, the displacement that it may have"))
    return history.required_friction_excluding_impacts()


def _slip(run: Response, history: History, _: CheckLimits) -> float:
    if history.model.layout.slip < 0:
        raise MissingQuantityError(translated("the base cannot slide in this run"))
    return run.max_slip


def _top_travel(run: Response, _: History, __: CheckLimits) -> float:
    if math.isnan(run.max_total_top_displacement):
        raise MissingQuantityError(
            translated("the height of the top is not known: give RockingProperties the top_height")
        )
    return run.max_total_top_displacement


def _toe_stress(_: Response, history: History, limits: CheckLimits) -> float:
    assert limits.toe_length is not None
    assert limits.breadth is not None
    return float(history.vertical_reaction.max()) / (limits.toe_length * limits.breadth)


KINDS = (
    CheckKind(
        "uplift",
        "",
        _moment_over_resisting,
        lambda _, limits: Limit(limits.moment_ratio, "" if limits.moment_ratio is None else USER),
        remark=_uplift_remark,
    ),
    CheckKind("rotation", "rad", _rotation, _nominal_rotation),
    CheckKind("rotation over α", "", _rotation_over_balance, _user("rotation_ratio")),
    CheckKind("story drift", "", _drift_ratio, _user("drift_ratio")),
    CheckKind(
        "tendon stress",
        "",
        _tendon_ratio,
        lambda _, limits: Limit(limits.tendon_ratio, YIELD_FORCE if limits.tendon_ratio == 1.0 else USER),
    ),
    CheckKind("fuse strain", "", _fuse_strain, _user("fuse_strain", "fuse_length")),
    CheckKind("rupture", "", _rupture_ratio, lambda _, __: Limit(1.0, RUPTURE)),
    CheckKind("bearing pressure", "Pa", _bearing_pressure, _user("bearing_pressure")),
    CheckKind("contact length", "", _contact_ratio, _user("contact_ratio"), at_least=True),
    CheckKind("sliding", "", _required_friction, _user("friction")),
    CheckKind("slip", "m", _slip, _user("slip")),
    CheckKind("unseating", "m", _top_travel, _user("seat_width")),
    CheckKind("toe stress", "Pa", _toe_stress, _user("toe_stress", "toe_length", "breadth")),
)
