"""Warnings: forces that ground or tendons cannot provide, rotations beyond a model's range, unbalanced energies."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from inspect import cleandoc
from pathlib import Path
from typing import Any, Generic, Self, TypeVar, overload

import numpy as np

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.errors import InputError, MissingQuantityError
from rockflex.foundation.files import checked_file_path
from rockflex.foundation.html import HtmlTable, curve_svg, svg_picture
from rockflex.foundation.language import translated
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.foundation.units import UnitSystem
from rockflex.foundation.values import Value
from rockflex.models._impact import restitution_left
from rockflex.models._rocking_model import RockingModel
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._energy import EnergyLedger
from rockflex.response._floors import FloorPeaks
from rockflex.response._history import History, SampledHistory
from rockflex.response._outputs import OUTPUTS, outputs_as_docstring
from rockflex.response._peaks import ELEMENT_PEAKS
from rockflex.response._response_file import load_response, save_response
from rockflex.response._sensitivity import Sensitivity

FALLEN = 1.57  # rad: an overturned run has a status of its own
NEGLIGIBLE = 0.05  # of the base shear, the push of leaning columns that needs no word
BARELY_LESS = 0.25  # of the velocity that a restitution takes, what the modes do not give back
BALANCED = 1e-6  # closing error of the energy balance up to which only rounding is at work


SI = UnitSystem("SI")


def warnings_of_response(model: str, peaks: Mapping[str, Any], units: UnitSystem = SI) -> tuple[str, ...]:
    """Return one text per warning; `peaks` are those of a `Response` by name."""

    def text(name: str) -> str:
        size, unit = OUTPUTS[name].unit_in(units)
        return f"{peaks[name] / size:.4g} {unit}"

    found: list[str] = []
    if peaks["min_vertical_reaction"] < 0.0:
        found.append(
            translated(
                "The vertical reaction falls to {force} at {time:.4g} s: {model} pulls the base down there, "
                "which no ground can. The pivot would lift, and what follows is to be read with care. Give simulate a "
                "Ground with springs, on which the base can leave the ground.",
                force=text("min_vertical_reaction"),
                time=peaks["time_of_min_vertical_reaction"],
                model=model,
            )
        )
    if peaks["min_joint_force"] < 0.0:
        found.append(
            translated(
                "The axial force of a joint above the base falls to {force} at {time:.4g} s: {model} pulls what is "
                "above down there, which no joint can. It would lift off, and what follows is to be read with care. "
                "Give it a tendon with more prestress, or fewer joints.",
                force=text("min_joint_force"),
                time=peaks["time_of_min_joint_force"],
                model=model,
            )
        )
    if peaks["tendon_overload"]:
        found.append(
            translated(
                "A tendon carries more than its yield force, up to {ratio:.4g} times it. It stays elastic in the "
                "model, so the results are not valid. Give it a post_yield_ratio.",
                ratio=peaks["tendon_utilisation"],
            )
        )
    if peaks["leaning_push"] > NEGLIGIBLE and peaks["status"] != "overturned":
        found.append(
            translated(
                "The leaning columns push the floors with up to {percent:.3g} % of the base shear as they lean with θ, "
                "which is neglected: V_b, drifts and floor accelerations are off by about as much. Use a model with "
                "P-Δ of the floors, or give these columns less weight.",
                percent=100.0 * peaks["leaning_push"],
            )
        )
    if peaks["column_pull"] > 1.0:
        found.append(
            translated(
                "The base moment of the building reaches {ratio:.3g} times that which pulls an outer column of the "
                "podium up: the column would lift off, and the building turn. What follows is to be read with care.",
                ratio=peaks["column_pull"],
            )
        )
    if peaks["may_fall"]:
        found.append(
            translated(
                "The run ends at {time:.4g} s while the base may still fall: θ is {rotation} there, the largest of the "
                "run and growing, or has energy enough to pass α. Its peak, and whether it overturns, is open. "
                'Continue the run with free_vibration="settle".',
                time=peaks["end_time"],
                rotation=text("residual_rotation"),
            )
        )
    if peaks["status"] == "overturned" and is_for_small_rotations(model):
        found.append(
            translated(
                "{model} is for small rotations, but decides here that the structure overturns. Let a complete model "
                "on rigid ground decide, such as {complete}.",
                model=model,
                complete=complete_model_label(model),
            )
        )
    if leaves_range(model, peaks["balance_ratio"], peaks["max_rotation"]):
        found.append(
            translated(
                "θ reaches {rotation}, {ratio:.3g} times the rotation α at which the static moment vanishes. "
                "{model} is for small rotations: whether the structure overturns is to be decided by a complete model "
                "on rigid ground, such as {complete}.",
                rotation=text("max_rotation"),
                ratio=peaks["balance_ratio"],
                model=model,
                complete=complete_model_label(model),
            )
        )
    return tuple(found)


def warnings_of_energy(closing_error: float) -> tuple[str, ...]:
    """Return a text if the energy balance of a run does not close."""
    if closing_error <= BALANCED:
        return ()
    return (
        translated(
            "The energy balance closes only to {error:.2g} of the largest input. Rounding explains at most "
            "{rounding:g}, unless springs give way by far less than a micrometre: otherwise an event was missed, or "
            "the motion of an element or of the ground was misread. Do not use the run then, and report it as an error "
            "of the program.",
            error=closing_error,
            rounding=BALANCED,
        ),
    )


def warnings_of_law(model: RockingModel) -> tuple[str, ...]:
    """Return a text if the restitution of a flexible structure hardly lets its rocking decay, and may mean another."""
    left = restitution_left(model.law, model.properties) if model.lifts and model.springs is None else None
    given, effective = left or (0.0, 0.0)
    if given == 0.0 or 1.0 - effective > BARELY_LESS * (1.0 - given):
        return ()
    return (
        translated(
            "The restitution {given:.4g} is that of θ' at the instant of an impact. The modes give back most of what "
            "the rotation loses then: from one half cycle to the next {effective:.4g} of its velocity is left. If the "
            "value was measured in a free rocking test, give AngularMomentum({given:.4g}).",
            given=given,
            effective=effective,
        ),
    )


def warnings_of_sensitivity(run: "Response") -> tuple[str, ...]:
    """Return a text if 1 % of its record moves a peak of a run with a history by more than 10 %.

    There is none of a model that is not linear between events, whose sensitivity is not known.
    """
    if run.history is None:
        return ()
    try:
        note = run.history.sensitivity.note
    except InputError:
        return ()
    return (note,) if note else ()


def warnings_of_run(run: "Response", units: UnitSystem = SI) -> tuple[str, ...]:
    """Return the warnings of the peaks and, of a run with a history, of its energies."""
    found = warnings_of_response(run.model, run.peaks(), units)
    if run.history is not None:
        found += warnings_of_law(run.history.model)
    try:
        return found if run.history is None else (*found, *warnings_of_energy(run.history.energy.closing_error))
    except InputError:  # too fast for the sampling: no energies
        return found


def complete_model_label(model: str) -> str:
    """Return the label of a complete model of the same structure."""
    return "rigid-C" if model == "rigid" else "MDOF-C"


def is_for_small_rotations(model: Any) -> Any:
    """Return whether a model, or each of many, is a simplified one, by its label."""
    return "-C" not in model if isinstance(model, str) else ~model.astype(str).str.contains("-C", regex=False)


def leaves_range(model: Any, balance_ratio: Any, rotation: Any) -> Any:
    """Return whether a run of a simplified model, or of many, went beyond α without overturning."""
    return is_for_small_rotations(model) & (balance_ratio > 1.0) & (rotation < FALLEN)


Quantity = TypeVar("Quantity")


class _OfHistory(Generic[Quantity]):
    """A quantity of the history that is available on the response under the same name."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name
        self.__doc__ = getattr(History, name).__doc__

    @overload
    def __get__(self, response: None, owner: type) -> Self: ...
    @overload
    def __get__(self, response: "Response", owner: type) -> Quantity: ...
    def __get__(self, response: "Response | None", owner: type) -> Self | Quantity:
        if response is None:
            return self
        if response.history is None:
            raise MissingQuantityError(
                f'This response contains only peaks, so it has no {self.name}. Simulate with output="history".'
            )
        return getattr(response.history, self.name)


@dataclass(frozen=True, eq=False, kw_only=True)
class Response(HtmlTable, Value):
    """The response of one structure to one motion.

    All peaks are the largest magnitudes of the continuous motion, including those between samples. A response with a
    history also has the quantities of the history: `time`, `side`, `ground_acceleration`, `modal_displacement`,
    `modal_velocity`, `modal_acceleration`, `rotation`, `rotation_velocity`, `rotation_acceleration`, `yielding`,
    `top_displacement`, `total_top_displacement`, `base_moment`, `base_shear`, `uplift_times`, `impact_times`,
    `story_drift`, `story_shear`, `floor_acceleration`, `total_floor_displacement`, `element_force`,
    `element_elongation`, `element_energy`, `element_state`, `slip`, `slip_velocity`, `heave`, `edge_uplift`,
    `spring_force`, `soil_pressure`, `bearing_pressure`, `uplifted`, `vertical_ground_acceleration`, `tendon_force`,
    `horizontal_reaction`, `vertical_reaction`, `friction_demand`, `required_friction`,
    `required_friction_excluding_impacts()`, `sliding_time()`, `energy`, `sensitivity`, `to_frame()`, `to_xarray()`,
    `to_matlab()`, `to_netcdf()`, `at()`, `resample()`, `floor_motion()`, `floor_spectrum()` and `settled_rotation()`;
    see `History`. A response with peaks only has none of them: `hasattr` returns False, and accessing one raises an
    `InputError`.

    Parameters
    ----------
    model
        Label of the model, such as ``"2DOF-S"``.
    motion
        Name of the ground motion.
    status
        ``"no_uplift"``, ``"rocking"`` (the base was off the ground) or ``"overturned"`` (|θ| reached π/2, which ends
        the run). A run that starts uplifted counts as rocking.
    {outputs}
    max_element_force
        Largest |F| of each element in N, in the order of `RockingProperties.elements`, shape (E,). A
        friction damper counts with its F_0 once it slides.
    max_element_elongation
        Largest |δ| of each element in m, shape (E,): r |θ| at the distance r from the pivot, in the complete models
        2 r sin(|θ|/2), or as in `Attachment`. It goes on beyond the elongation at which an element breaks.
    element_yielded
        Whether each element ever yielded or slid, shape (E,); of a tendon that stays elastic in the model, whether it
        carries more than its yield force.
    remaining_prestress
        Force of each tendon in N once the base is closed after the run, shape (n_tendons,): the initial force, less
        what its plastic stretch took; zero if it is slack or broken.
    ductility
        Largest drift of each story that yields over its drift at first yield, bottom to top, shape (N_floors,): zero
        for a story that stays elastic by definition. Without `YieldingStories` the shape is (0,).
    residual_drift
        Drift of each story in m at rest after the run, with what yielded as it is and everything else elastic, shape
        (N_floors,), or (0,).
    residual_drift_ratio
        The same over the height of the story, shape (N_floors,), or (0,).
    floors
        Floor peaks if the structure has floors and ``output="history"`` was requested; otherwise None.
    history
        The time history, or None with ``output="peaks"``.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> response = rf.simulate(column, pulse, "2DOF-S", free_vibration=5.0)
    >>> response.status, response.n_impacts
    ('rocking', 3)
    >>> round(response.max_rotation, 4)
    0.0395
    """

    model: str
    motion: str
    status: str
    max_rotation: float
    time_of_max_rotation: float
    max_top_displacement: float
    time_of_max_top_displacement: float
    max_base_moment: float
    time_of_max_base_moment: float
    max_base_shear: float
    time_of_max_base_shear: float
    max_total_top_displacement: float
    time_of_max_total_top_displacement: float
    max_horizontal_reaction: float
    time_of_max_horizontal_reaction: float
    min_vertical_reaction: float
    time_of_min_vertical_reaction: float
    max_tendon_force: float
    tendon_utilisation: float
    tendon_yield: bool
    tendon_overload: bool
    residual_rotation: float
    balance_ratio: float
    max_joint_rotation: float
    min_joint_force: float
    time_of_min_joint_force: float
    max_slip: float
    residual_slip: float
    max_edge_uplift: float
    max_edge_settlement: float
    settlement: float
    max_permanent_settlement: float
    leaning_push: float
    column_pull: float
    n_uplifts: int
    n_impacts: int
    guarded_impacts: float
    nominal_overturning: bool
    may_fall: bool
    end_time: float
    settled: bool
    max_element_force: Array
    max_element_elongation: Array
    element_yielded: Bools
    remaining_prestress: Array
    ductility: Array
    residual_drift: Array
    residual_drift_ratio: Array
    floors: FloorPeaks | None = None
    history: History | None = None

    time = _OfHistory[Array]()
    side = _OfHistory[Array]()
    ground_acceleration = _OfHistory[Array]()
    modal_displacement = _OfHistory[Array]()
    modal_velocity = _OfHistory[Array]()
    rotation = _OfHistory[Array]()
    rotation_velocity = _OfHistory[Array]()
    modal_acceleration = _OfHistory[Array]()
    rotation_acceleration = _OfHistory[Array]()
    yielding = _OfHistory[Array]()
    top_displacement = _OfHistory[Array]()
    total_top_displacement = _OfHistory[Array]()
    base_moment = _OfHistory[Array]()
    base_shear = _OfHistory[Array]()
    uplift_times = _OfHistory[Array]()
    impact_times = _OfHistory[Array]()
    story_drift = _OfHistory[Array]()
    story_shear = _OfHistory[Array]()
    floor_acceleration = _OfHistory[Array]()
    total_floor_displacement = _OfHistory[Array]()
    element_force = _OfHistory[Array]()
    element_elongation = _OfHistory[Array]()
    element_energy = _OfHistory[Array]()
    element_state = _OfHistory[Array]()
    joint_rotation = _OfHistory[Array]()
    joint_force = _OfHistory[Array]()
    permanent_settlement = _OfHistory[Array]()
    slip = _OfHistory[Array]()
    slip_velocity = _OfHistory[Array]()
    heave = _OfHistory[Array]()
    edge_uplift = _OfHistory[Array]()
    spring_force = _OfHistory[Array]()
    soil_pressure = _OfHistory[Array]()
    bearing_pressure = _OfHistory[Array]()
    uplifted = _OfHistory[Bools]()
    vertical_ground_acceleration = _OfHistory[Array]()
    tendon_force = _OfHistory[Array]()
    horizontal_reaction = _OfHistory[Array]()
    vertical_reaction = _OfHistory[Array]()
    friction_demand = _OfHistory[Array]()
    required_friction = _OfHistory[float]()
    required_friction_excluding_impacts = _OfHistory[Callable[..., float]]()
    sliding_time = _OfHistory[Callable[..., float | None]]()
    energy = _OfHistory[EnergyLedger]()
    sensitivity = _OfHistory[Sensitivity]()
    to_frame = _OfHistory[Callable[..., Any]]()
    to_xarray = _OfHistory[Callable[..., Any]]()
    to_matlab = _OfHistory[Callable[..., Path]]()
    to_netcdf = _OfHistory[Callable[..., Path]]()
    floor_motion = _OfHistory[Callable[..., GroundMotion]]()
    settled_rotation = _OfHistory[Callable[..., float]]()
    floor_spectrum = _OfHistory[Callable[..., Any]]()
    at = _OfHistory[Callable[..., SampledHistory]]()
    resample = _OfHistory[Callable[..., SampledHistory]]()

    def __post_init__(self) -> None:
        pass  # its arrays are read-only already, and every run of a study creates a response

    def __repr__(self) -> str:
        model = None if self.history is None else self.history.model
        left = None if model is None else restitution_left(model.law, model.properties)
        law = "" if left is None else f", effective restitution {left[1]:.4g}"
        return (
            f"Response({self.model} under {self.motion!r}: {self.status}, θ_max={self.max_rotation:.4g} rad, "
            f"u_top,max={self.max_top_displacement:.4g} m, {number_with_noun(self.n_impacts, 'impact')}{law})"
        )

    def _shown_as(self) -> dict[str, Any]:
        warned = {"warnings": " ".join(self.warnings)} if self.warnings else {}
        peaks = {name: value for name, value in self.peaks().items() if not name.startswith("time_of_")}
        return self._drawn_history() | peaks | warned

    def _drawn_history(self) -> dict[str, Any]:
        """The rotation over time as a small curve, or the displacement of the top if the base does not lift."""
        if self.history is None:
            return {}
        name = "rotation" if self.max_rotation > 0.0 else "top_displacement"
        time = self.history.time
        drawn = curve_svg(time, getattr(self.history, name))
        return {f"{name}, {time[0]:g} to {time[-1]:.4g} s": svg_picture(drawn, name)}

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings, a text each: forces that ground or tendons cannot provide, rotations too large for the model.

        A response with a history also warns if its energy balance does not close to 1e-6; `energy` is computed for it.
        """
        return warnings_of_run(self)

    @property
    def max_ductility(self) -> float:
        """Largest `ductility` of a story; NaN if no story can yield."""
        return float(self.ductility.max()) if self.ductility.size else math.nan

    @property
    def max_residual_drift_ratio(self) -> float:
        """Largest |`residual_drift_ratio`| of a story; NaN if no story can yield."""
        return float(np.abs(self.residual_drift_ratio).max()) if self.residual_drift_ratio.size else math.nan

    def peaks(self) -> dict[str, Any]:
        """Return every scalar by its name, for a table row or a JSON object."""
        return {name: getattr(self, name) for name in PEAKS}

    def save(self, path: str | Path) -> Path:
        """Write the response including its history to an ``.npz`` file, and return its path; see `load`.

        The suffix is added if the path has none.

        Raises
        ------
        InputError
            If the path has another suffix, such as ``.parquet``.
        """
        of_elements = {name: getattr(self, name) for name in ELEMENT_PEAKS}
        return save_response(checked_file_path("path", path), self.peaks(), of_elements, self.floors, self.history)

    @classmethod
    def load(cls, path: str | Path) -> "Response":
        """Read a response that `save` wrote.

        Files of earlier versions without a history do not tell the tendons apart: the peaks of the elements are empty.
        Without a history of a run that did not settle they lack the residual rotation too, which is then NaN, as is
        `balance_ratio`; the residual rotation on springs is then that from the unloaded ground.

        Raises
        ------
        InputError
            If the file is missing or is not a saved response.
        """
        peaks, floors, history = load_response(checked_file_path("path", path), KINDS)
        return Response(**peaks, floors=floors, history=history)


_SCALARS = (str, float, int, bool)
KINDS: dict[str, type] = {f.name: f.type for f in fields(Response) if isinstance(f.type, type) and f.type in _SCALARS}
PEAKS = tuple(KINDS)
if Response.__doc__:  # not with python -OO
    Response.__doc__ = cleandoc(Response.__doc__).replace("{outputs}", outputs_as_docstring(PEAKS))


def history_of(run: Response, place: int | None = None) -> History:
    """Return the history of a run, which is `result` in messages, or a place in `responses`.

    Raises
    ------
    InputError
        If it kept peaks only.
    """
    if run.history is None:
        name = "result" if place is None else "responses"
        raise InputError(
            f"{name if place is None else f'responses[{place}]'} ({run.model} under {shown(run.motion)}) keeps peaks "
            'only, but its history is needed. Simulate it with output="history".',
            field=name,
        )
    return run.history
