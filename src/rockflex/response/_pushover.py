"""Pushover: lateral forces that grow slowly, with stories and elements that yield, on a fixed base or with uplift."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_magnitude, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.values import Value
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._elements import RIGHT
from rockflex.models._rocking_model import RockingModel
from rockflex.response._quasi_static import (
    StaticElementState,
    element_at_start_of_path,
    next_branch,
    next_branch_change,
    start_moving,
    static_tension,
)
from rockflex.structure._analysis import FloorModes
from rockflex.structure._branches import Element

if TYPE_CHECKING:
    import pandas as pd

ROUNDING = 1e-9  # of the initial stiffness: a slope that is none
NEAR = 1e-12  # relative to the target: changes this close to each other happen at once
MAX_CHANGES = 10_000
REACHED, UPLIFT = -2, -1  # what happens next, in place of an element


@dataclass(frozen=True)
class PushoverEvent:
    """A change on the way of a pushover, at a displacement of the top in m and a base shear in N.

    `name` is ``"uplift"``, ``"story 1 yields"``, ``"element 2 yields"``, ``"element 2 breaks"`` and so on.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> (event,) = rf.pushover(column, top_displacement=0.5).events
    >>> event.name, round(event.base_shear / 1e3, 1)
    ('uplift', 58.9)
    """

    name: str
    top_displacement: float
    base_shear: float


@dataclass(frozen=True)
class BilinearFit:
    """Two lines in place of a pushover curve: the same initial stiffness, last point and area under the curve.

    Attributes
    ----------
    yield_displacement : float
        Displacement of the top where the lines meet, in m.
    yield_force : float
        Base shear there in N.
    post_yield_ratio : float
        α, the slope of the second line over that of the first.
    top_ordinate : float
        Γ_1 φ_top,1: displacement of the top per unit of the first modal coordinate D_1.

    Examples
    --------
    >>> import rockflex as rf
    >>> one = rf.LumpedStructure([50e3], [[5e7]], [3.0], base_mass=30e3,
    ...     half_width=1.0, damping_ratio=0.03)
    >>> fit = rf.pushover(rf.YieldingStories(one, strengths=150e3,
    ...     post_yield_ratio=0.1), 0.05, lifts=False).fit()
    >>> round(fit.yield_displacement,
    ...     6), round(fit.yield_force), round(fit.post_yield_ratio, 6)
    (0.003, 150000, 0.1)
    """

    yield_displacement: float
    yield_force: float
    post_yield_ratio: float
    top_ordinate: float

    @property
    def stiffness(self) -> float:
        """Slope of the first line in N/m."""
        return self.yield_force / self.yield_displacement

    @property
    def bouc_wen(self) -> BoucWen:
        """The hysteresis of a 2DOF-S-BW model with this curve, D_y = u_y/(Γ_1 φ_top,1).

        Raises
        ------
        InputError
            If the curve falls after yielding: the model has no negative stiffness.
        """
        if self.post_yield_ratio < 0.0:
            raise InputError(
                f"The second line has the slope α = {self.post_yield_ratio:.4g} < 0, which no Bouc-Wen superstructure "
                "has. Fit a pushover on a fixed base (lifts=False): uplift is in the 2DOF-S-BW model anyway.",
                field="post_yield_ratio",
            )
        return BoucWen(self.yield_displacement / self.top_ordinate, self.post_yield_ratio)


@dataclass(frozen=True, eq=False, repr=False)
class Pushover(Value):
    """The way of a structure whose floors are pushed slowly to the right; everything is linear between its n points.

    Attributes
    ----------
    top_displacement : ndarray, shape (n,)
        Displacement of the highest floor in m relative to the base.
    total_top_displacement : ndarray, shape (n,)
        The same relative to the ground in m, with the rotation.
    rotation : ndarray, shape (n,)
        θ in rad; zero on a fixed base.
    lateral_force : ndarray, shape (n,)
        Sum of the forces on the floors in N.
    base_shear, base_moment : ndarray, shape (n,)
        Sums of the restoring forces in N and of their moments in N m, as in a `Response`; ties and braces carry what
        the lateral force has more.
    story_drift, story_shear : ndarray, shape (n, N)
        Drifts in m and shears of the restoring forces in N, bottom to top.
    element_force, element_elongation : ndarray, shape (n, E)
        Of the elements, in N and m.
    pattern : ndarray, shape (N,)
        Share of each floor in the lateral force.
    events : tuple of PushoverEvent
        What changes on the way, in this order.
    top_ordinate : float
        Γ_1 φ_top,1.

    Examples
    --------
    >>> import rockflex as rf
    >>> one = rf.LumpedStructure([50e3], [[5e7]], [3.0], base_mass=30e3,
    ...     half_width=1.0, damping_ratio=0.03)
    >>> push = rf.pushover(rf.YieldingStories(one, strengths=150e3,
    ...     post_yield_ratio=0.1), 0.05, lifts=False)
    >>> shown = push.to_frame()[["top_displacement", "base_shear"]] / [1.0, 1e3]
    >>> print(shown.round(3))
       top_displacement  base_shear
    0             0.000         0.0
    1             0.003       150.0
    2             0.050       385.0
    """

    top_displacement: Array
    total_top_displacement: Array
    rotation: Array
    lateral_force: Array
    base_shear: Array
    base_moment: Array
    story_drift: Array
    story_shear: Array
    element_force: Array
    element_elongation: Array
    pattern: Array
    events: tuple[PushoverEvent, ...]
    top_ordinate: float

    def __repr__(self) -> str:
        return (
            f"Pushover({self.top_displacement.size} points, top up to {self.top_displacement[-1]:.4g} m, base shear up "
            f"to {self.base_shear.max():.4g} N, {len(self.events)} events)"
        )

    def fit(self, top_displacement: float | None = None) -> BilinearFit:
        """Return the bilinear fit of equal energy to the base shear over the displacement of the top.

        Parameters
        ----------
        top_displacement
            Displacement in m up to which the curve counts. Default: the last one.

        Raises
        ------
        InputError
            If the displacement is not on the way, or nothing yields before it.
        """
        end = float(self.top_displacement[-1])
        if top_displacement is not None:
            given = checked_magnitude("top_displacement", top_displacement, end, "m")
            end = checked_positive("top_displacement", given, "m")
        if (np.diff(self.top_displacement) <= 0.0).any():
            raise InputError(
                "The displacement of the top relative to the base falls after uplift, so that there is no curve to "
                "fit. Fit a pushover on a fixed base (lifts=False).",
                field="top_displacement",
            )
        last, first = float(np.interp(end, self.top_displacement, self.base_shear)), self.top_displacement[1]
        inside = self.top_displacement < end
        u, v = np.append(self.top_displacement[inside], end), np.append(self.base_shear[inside], last)
        stiffness, area = float(self.base_shear[1] / first), float(np.trapezoid(v, u))
        if stiffness * end - last <= ROUNDING * last:
            raise InputError(
                f"Nothing yields up to a displacement of {end:.4g} m, so that there is no second line to fit. Push "
                "farther.",
                field="top_displacement",
            )
        meets = (2.0 * area - last * end) / (stiffness * end - last)
        ratio = (last - stiffness * meets) / (stiffness * (end - meets))
        return BilinearFit(
            yield_displacement=meets,
            yield_force=stiffness * meets,
            post_yield_ratio=0.0 if abs(ratio) < ROUNDING else ratio,
            top_ordinate=self.top_ordinate,
        )

    def to_frame(self) -> "pd.DataFrame":
        """Return the way as a table, one row a point, with stories and elements counted from 1."""
        import pandas as pd

        names = ("top_displacement", "total_top_displacement", "rotation", "lateral_force", "base_shear", "base_moment")
        columns = {name: getattr(self, name) for name in names}
        for name in ("story_drift", "story_shear", "element_force", "element_elongation"):
            values = getattr(self, name)
            columns |= {f"{name}_{k + 1}": values[:, k] for k in range(values.shape[1])}
        return pd.DataFrame(columns)


class _Point(NamedTuple):
    """A point of equilibrium: D and θ, the sum of the forces, and the elements."""

    moved: Array
    force: float
    places: tuple[StaticElementState, ...]
    closed: bool


class _PushoverEquilibria:
    """The equilibria of a structure under lateral forces of one pattern, by the displacement of its top."""

    def __init__(self, model: RockingModel, pattern: Array, floors: FloorModes) -> None:
        p, layout = model.properties, model.layout
        self.elements, self.lifts = model.elements, model.lifts
        self.rest = np.append(model.bent_at_rest(np.zeros(len(self.elements))), 0.0)
        kept = [*range(p.n_modes), layout.rotation]
        self.rows = np.array(
            [model.stretch(place, model.stance_on(RIGHT))[kept] for place in range(len(self.elements))]
        )
        self.rows = self.rows.reshape(len(self.elements), p.n_modes + 1)
        self.attached = np.array([each.position is None for each in self.elements], dtype=bool)
        self.stiffness = np.diag(np.append(p.effective_mass * p.omega**2, -p.l0r * model.gravity))
        self.push = np.append(pattern @ floors.displacement, pattern @ p.turning_heights(floors.heights))
        self.weight = np.append(np.zeros(p.n_modes), -p.pivot(RIGHT).weight_moment)
        self.top = np.append(
            floors.displacement[int(np.argmax(floors.heights))], float(p.turning_heights(floors.heights.max()))
        )

    def start(self) -> _Point:
        """Return the state at rest."""
        places = tuple(element_at_start_of_path(each) for each in self.elements)
        return _Point(self.rest, 0.0, self.stretched(places, self.rest), True)

    def solved(
        self, places: tuple[StaticElementState, ...], top: float, *, closed: bool, rate: bool = False
    ) -> tuple[Array, float]:
        """Return D, θ and the sum of the forces at a displacement of the top, or their rates."""
        free = len(self.top) - closed
        stiffness, load = self.stiffness.copy(), np.zeros(len(self.top)) if rate else self.weight.copy()
        for each, row, place in zip(self.elements, self.rows, places, strict=True):
            pull = each.tension(place.branch)
            stiffness += pull.stiffness * np.outer(row, row)
            if not rate:
                load -= row * (pull.force + pull.internal_factor * place.memory)
        whole = np.zeros((free + 1, free + 1))
        whole[:free, :free] = stiffness[:free, :free]
        whole[:free, free], whole[free, :free] = -self.push[:free], self.top[:free]
        found = np.linalg.solve(whole, np.append(load[:free], top))
        return np.append(found[:free], np.zeros(int(closed))).astype(float), float(found[free])

    def stretched(self, places: tuple[StaticElementState, ...], moved: Array) -> tuple[StaticElementState, ...]:
        """Return the elements at displacements."""
        ends = (self.rows @ moved).tolist()
        return tuple(place._replace(elongation=end) for place, end in zip(places, ends, strict=True))

    def onward(self, point: _Point) -> tuple[tuple[StaticElementState, ...], Array, float]:
        """Return the elements as they begin to move on from a point, and the rates of D, θ and the forces."""
        places = point.places
        moved, force = self.solved(places, 1.0, closed=point.closed, rate=True)
        for _ in range(len(places)):
            ways = np.sign(np.where(np.abs(self.rows @ moved) > NEAR, self.rows @ moved, 0.0)).astype(int).tolist()
            begun = tuple(
                start_moving(each, place, way) if way else place
                for each, place, way in zip(self.elements, places, ways, strict=True)
            )
            if begun == places:
                break
            places = begun
            moved, force = self.solved(places, 1.0, closed=point.closed, rate=True)
        return places, moved, force

    def lift(self, places: tuple[StaticElementState, ...], force: float) -> float:
        """Return the moment in N m that turns a closed base to the right, less what it resists; negative if none."""
        turned = force * self.push[-1] + self.weight[-1]
        for each, row, place, attached in zip(self.elements, self.rows, places, self.attached.tolist(), strict=True):
            turned -= row[-1] * static_tension(
                each, place if attached else start_moving(each, place, int(np.sign(row[-1])))
            )
        return turned


def pushover_path(model: RockingModel, pattern: Array, target: float, floors: FloorModes) -> Pushover:
    """Return the way of a structure to a displacement of its top relative to the ground.

    Parameters
    ----------
    model
        A simplified model on rigid ground.
    pattern : ndarray, shape (N,)
        Share of each floor in the lateral force.
    target
        Displacement in m, positive.
    floors
        The floors of its structure.

    Raises
    ------
    InputError
        If the branches of an element follow one another without end.
    """
    way = _PushoverEquilibria(model, pattern, floors)
    point = way.start()
    top = float(way.top @ point.moved)
    points, events, near = [point], list[tuple[str, int]](), NEAR * target
    names = [f"element {k + 1}" for k in range(len(model.properties.elements))]
    names += [f"story {each.floor}" for each in model.properties.stories]
    for _ in range(MAX_CHANGES):
        places, rate, growth = way.onward(point)
        ahead = [(target - top, REACHED)]
        for k, (each, place) in enumerate(zip(way.elements, places, strict=True)):
            speed = float(way.rows[k] @ rate)
            stop = next_branch_change(each, place, int(np.sign(speed))) if abs(speed) > NEAR else None
            if stop is not None:
                ahead.append((max((stop[0] - place.elongation) / speed, 0.0), k))
        if point.closed and way.lifts:
            now = way.lift(places, point.force)
            later = way.lift(way.stretched(places, point.moved + rate), point.force + growth)
            if later > now:
                ahead.append((max(-now / (later - now), 0.0), UPLIFT))
        step, which = min(ahead)
        top += step
        moved, force = way.solved(places, top, closed=point.closed)
        places = way.stretched(places, moved)
        if step <= near and which != REACHED:  # it happens together with what came before
            points.pop()
        ended = False
        if which >= 0:
            each, speed = way.elements[which], float(way.rows[which] @ rate)
            places, branch = _changed(way.elements, places, which, int(np.sign(speed)))
            ended = each.broken(branch)  # its force is lost at once, which no slow path can follow
            if ended or each.yields(branch):
                events.append((f"{names[which]} {'breaks' if ended else 'yields'}", len(points)))
        elif which == UPLIFT:
            events.append(("uplift", len(points)))
        point = _Point(moved, force, places, point.closed and which != UPLIFT)
        points.append(point)
        if which == REACHED or ended:
            return _result(model, floors, pattern, way, points, events)
    raise InputError(
        f"The branches of the elements change more than {MAX_CHANGES} times. Check their laws.", field="structure"
    )


def _changed(
    elements: tuple[Element, ...], places: tuple[StaticElementState, ...], which: int, direction: int
) -> tuple[tuple[StaticElementState, ...], int]:
    """Return the elements after one of them has reached the end of its branch, and its next branch."""
    stop = next_branch_change(elements[which], places[which], direction)
    assert stop is not None
    after = next_branch(elements[which], places[which]._replace(elongation=stop[0]), stop[1])
    return (*places[:which], after, *places[which + 1 :]), stop[1]


def _result(
    model: RockingModel,
    floors: FloorModes,
    pattern: Array,
    way: _PushoverEquilibria,
    points: list[_Point],
    events: list[tuple[str, int]],
) -> Pushover:
    p, n = model.properties, model.properties.n_modes
    moved = np.array([point.moved for point in points])
    tensions = np.array(
        [
            [static_tension(each, place) for each, place in zip(way.elements, point.places, strict=True)]
            for point in points
        ]
    ).reshape(len(points), len(way.elements))
    count = len(p.elements)
    restoring = moved[:, :n] * p.omega**2  # accelerations of the modes, with those of stories that yield
    restoring += tensions[:, count:] @ (way.rows[count:, :n] / p.effective_mass)
    forces = restoring @ (floors.force / p.omega**2).T
    u = moved[:, :n] @ floors.displacement.T
    shear, total = restoring @ p.effective_mass, moved @ way.top
    highest = int(np.argmax(floors.heights))
    return Pushover(
        top_displacement=u[:, highest],
        total_top_displacement=total,
        rotation=moved[:, n],
        lateral_force=np.array([point.force for point in points]),
        base_shear=shear,
        base_moment=restoring @ (p.effective_mass * p.moment_heights),
        story_drift=np.diff(u, axis=1, prepend=0.0),
        story_shear=np.cumsum(forces[:, ::-1], axis=1)[:, ::-1],
        element_force=tensions[:, :count],
        element_elongation=moved @ way.rows[:count].T,
        pattern=pattern,
        events=tuple(PushoverEvent(name, float(u[place, highest]), float(shear[place])) for name, place in events),
        top_ordinate=float(floors.displacement[highest, 0]),
    )
