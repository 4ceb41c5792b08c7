"""Responses on disk: one .npz file that contains the arrays, and everything else as JSON."""

import io
import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any, cast

import numpy as np

from rockflex.foundation.archives import ArchiveLimits, arrays_from_npz
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file, write_given_file
from rockflex.foundation.registry import registered_objects
from rockflex.foundation.shown import shown
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import (
    LAW_CLASSES,
    ImpactLaw,
    Restitution,
    UnsavedLaw,
)
from rockflex.models._jointed_model import model_on_rigid_ground
from rockflex.models._rocking_model import Pose, RockingModel
from rockflex.models._sliding import SlidingModel
from rockflex.models._spring_model import SpringModel
from rockflex.models._state_checks import check_states
from rockflex.response._floors import FloorPeaks
from rockflex.response._history import History
from rockflex.response._peaks import (
    ELEMENT_PEAKS,
    OF_STORIES,
)
from rockflex.structure._analysis import FloorModes
from rockflex.structure._attachment import YieldingStory, element_parameters
from rockflex.structure._base_element import BaseElement
from rockflex.structure._elements import ELEMENTS
from rockflex.structure._ground import Springs
from rockflex.structure._joint import JointAbove
from rockflex.structure._law_bars import BARS
from rockflex.structure._pivot import OnColumns
from rockflex.structure._rocking import RockingProperties

Kept = tuple[dict[str, Any], FloorPeaks | None, History | None]

_LIMITS = ArchiveLimits(1_000, 4_000_000_000, 8_000_000_000)
FORMAT = "rockflex-response-4"
PROPERTIES = (
    "omega",
    "effective_mass",
    "effective_height",
    "top_ordinate",
    "i_theta",
    "l0r",
    "m_tot",
    "half_width",
    "zeta",
    "translational_inertia",
)
KNOWN = ("top_height", "base_mass", "eccentricity", "leaning_mass", "restitution", "opens")
LATER: dict[str, Any] = {
    "guarded_impacts": 0.0,
    "may_fall": False,
    "leaning_push": 0.0,
    "max_joint_rotation": 0.0,
    "min_joint_force": 0.0,
    "time_of_min_joint_force": 0.0,
    "column_pull": 0.0,
    "settlement": 0.0,
    "max_permanent_settlement": 0.0,
}  # what older files do not have
SAVED_LAWS: dict[str, Callable[..., ImpactLaw]] = {**LAW_CLASSES, "UnsavedLaw": UnsavedLaw}
SPRINGS = ("positions", "stiffness", "damping", "area", "capacity")
FLOOR_MODES = ("heights", "displacement", "force")
FLOOR_PEAKS = ("story_drift", "story_shear", "floor_acceleration", "total_floor_displacement")


def save_response(
    path: Path, peaks: dict[str, Any], of_elements: dict[str, Any], floors: FloorPeaks | None, history: History | None
) -> Path:
    """Write a response to `path`, adding the suffix ``.npz`` if necessary; the file is complete or absent.

    `peaks` are its scalars by name, and `of_elements` its `ELEMENT_PEAKS`.
    """
    if path.suffix[1:2].isalpha() and path.suffix.lower() != ".npz":  # "scale 1.5" has no suffix
        raise InputError(
            f"A response is saved as .npz, but {path.name!r} was given. Name it {path.stem + '.npz'!r}; for a "
            'table of the history write pandas.DataFrame({"time": response.time, "rotation": response.rotation})'
            ".to_parquet(...)."
        )
    path = path if path.suffix.lower() == ".npz" else path.with_name(path.name + ".npz")
    scalars = {"format": FORMAT, **peaks}
    arrays: dict[str, Any] = {f"elements.{name}": values.astype(float) for name, values in of_elements.items()}
    if floors is not None:
        arrays |= {f"floors.{name}": getattr(floors, name) for name in FLOOR_PEAKS}
    if history is not None:
        model = history.model
        check_states(model, history.states)  # what could not be read again is not written
        scalars["lifts"] = model.lifts
        scalars["law"] = _impact_law_to_file(model.law)
        scalars["missing_mass"] = model.missing_mass
        scalars |= {name: getattr(model.properties, name) for name in KNOWN}
        if model.integrated:
            scalars["complete"] = model.complete
            scalars["bouc_wen"] = None if model.bouc_wen is None else asdict(model.bouc_wen)
        scalars["gravity"] = model.gravity
        for name, value in model.ground_parameters.items():
            if isinstance(value, np.ndarray):  # of every spring
                arrays[f"springs.{name}"] = value
            else:
                scalars[name] = value
        scalars["stories"] = [asdict(each) for each in model.properties.stories]
        scalars["joints"] = [
            {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in asdict(each).items()}
            for each in model.properties.joints
        ]
        scalars["columns"] = None if model.properties.columns is None else asdict(model.properties.columns)
        scalars["elements"] = [
            {"kind": type(each).__name__, **element_parameters(each)} for each in model.properties.elements
        ]
        arrays["states"] = history.states
        arrays |= {f"properties.{name}": getattr(model.properties, name) for name in PROPERTIES}
        if model.properties.floors is not None:
            arrays |= {f"floor_modes.{name}": getattr(model.properties.floors, name) for name in FLOOR_MODES}
    arrays["response"] = np.array(json.dumps(scalars))
    content = io.BytesIO()
    np.savez_compressed(content, **arrays)
    return write_given_file(path, content.getvalue())


def load_response(path: Path, kinds: dict[str, type]) -> Kept:
    """Read a response written by `save`, with peaks of these names and types."""
    check_regular_file(path)
    if not path.exists():
        raise InputError(f"No saved response at {path}. Give the path that Response.save returned.")
    try:
        arrays = arrays_from_npz(path, _LIMITS)
        scalars = LATER | json.loads(str(arrays["response"]))
        kept = _response_from_file(scalars, arrays, kinds) if scalars["format"] == FORMAT else None
    except Exception as error:  # NumPy and json raise almost any exception for damaged files
        reason = f"{type(error).__name__}: {error}"
        raise InputError(f"{path} is not a saved response ({reason}). Give a file that Response.save wrote.") from error
    if kept is None:
        raise InputError(f"{path} has the format {shown(scalars['format'])}, but {FORMAT!r} is expected.")
    return kept


def _response_from_file(scalars: dict[str, Any], arrays: dict[str, Any], kinds: dict[str, type]) -> Kept:
    for name, values in arrays.items():
        if name != "response" and values.dtype != np.float64:
            raise InputError(f"{name} must be of type float64, but is of type {values.dtype}.")
    floors = history = None
    if "states" in arrays:
        history = History(_model_from_file(scalars, arrays), arrays["states"])
        check_states(history.model, history.states)
    peaks = _of_elements(arrays, history) | {
        name: _typed(scalars, name, kind) for name, kind in kinds.items() if name not in ELEMENT_PEAKS
    }
    if "floors.story_drift" in arrays:
        floors = FloorPeaks(*(arrays[f"floors.{name}"] for name in FLOOR_PEAKS))
        if floors.story_drift.shape != arrays["floor_modes.heights"].shape:
            raise InputError(f"There are peaks of {floors.story_drift.size} floors, but a different number of heights.")
    return peaks, floors, history


def _of_elements(arrays: dict[str, Any], history: History | None) -> dict[str, Any]:
    """Return the peaks of the elements."""
    found = {name: arrays[f"elements.{name}"] for name in ELEMENT_PEAKS}
    found["element_yielded"] = found["element_yielded"] != 0.0
    elements = () if history is None else history.model.properties.elements
    for name, values in found.items():
        values.setflags(write=False)
        known = sum(each.prestressed for each in elements) if name == "remaining_prestress" else len(elements)
        if name in OF_STORIES:
            known = values.size
        if values.ndim != 1 or (history is not None and values.size != known):
            raise InputError(f"{name} must have the shape ({known},), but its shape is {values.shape}.")
    return found


def _typed(scalars: dict[str, Any], name: str, kind: type) -> Any:
    if type(scalars[name]) is not kind:
        raise InputError(f"{name} must be of type {kind.__name__}, but is {shown(scalars[name])}.")
    return scalars[name]


def _impact_law_to_file(law: ImpactLaw) -> dict[str, Any]:
    """Return an impact law as JSON; for a user-defined law only its description."""
    name = type(law).__name__
    if name in SAVED_LAWS and type(law) is SAVED_LAWS[name]:
        return {"law": name, **asdict(cast("Any", law))}
    return {"law": "UnsavedLaw", "description": shown(law), "keeps": str(law.keeps), "loses": str(law.loses)}


def _impact_law_from_file(parameters: dict[str, Any]) -> ImpactLaw:
    name = parameters.pop("law")
    if name == "SidedRestitution":
        parameters = {edge: Restitution(**each) for edge, each in parameters.items()}
    return SAVED_LAWS[name](**parameters)


def _element_from_file(kind: str, **values: Any) -> BaseElement:
    """Return an element from the name of its class and its parameters.

    Raises
    ------
    InputError
        If no installed package has such an element.
    """
    known = {each.__name__: each for each in (ELEMENTS | BARS | registered_objects("elements")).values()}
    if kind not in known:
        raise InputError(
            f"The structure has an element {kind!r}, which no installed package registers. Install the package that "
            f"has it, with an entry point of the group rockflex.elements; known are {', '.join(known)}."
        )
    return known[kind](**values)


def _model_from_file(scalars: dict[str, Any], arrays: dict[str, Any]) -> RockingModel:
    values = {name: arrays[f"properties.{name}"] for name in PROPERTIES}
    values = {name: value if value.ndim else float(value) for name, value in values.items()}
    floors = None
    if "floor_modes.heights" in arrays:
        floors = FloorModes(*(arrays[f"floor_modes.{name}"] for name in FLOOR_MODES))
    elements = [_element_from_file(**each) for each in _typed(scalars, "elements", list)]
    known = {name: scalars[name] for name in KNOWN if name in scalars}
    known["stories"] = [YieldingStory(**each) for each in scalars["stories"]]
    known["joints"] = [JointAbove(**each) for each in scalars.get("joints", [])]
    if scalars.get("columns") is not None:
        known["columns"] = OnColumns(**scalars["columns"])
    properties = RockingProperties(**values, floors=floors, elements=elements, **known)
    lifts, parameters = _typed(scalars, "lifts", bool), dict(_typed(scalars, "law", dict))
    missing = _typed(scalars, "missing_mass", bool)
    law = _impact_law_from_file(parameters)
    gravity = scalars["gravity"]
    nonlinear = dict[str, Any]()
    if "complete" in scalars:
        bouc_wen = scalars["bouc_wen"]
        nonlinear["complete"] = _typed(scalars, "complete", bool)
        nonlinear["bouc_wen"] = None if bouc_wen is None else BoucWen(**bouc_wen)
        nonlinear["stepwise"] = not nonlinear["complete"] and bouc_wen is None
    if "springs.positions" in arrays:
        springs = Springs(*(arrays.get(f"springs.{name}") for name in SPRINGS))  # pyright: ignore[reportArgumentType]
        rotation, heave = _typed(scalars, "rest", list)
        return SpringModel(
            scalars["model"],
            properties,
            missing_mass=missing,
            gravity=gravity,
            springs=springs,
            inertia=_typed(scalars, "inertia", float),
            friction=arrays.get("springs.friction"),
            rest=Pose(rotation, heave),
            **nonlinear,
        )
    known = scalars["model"], properties, lifts, law, missing, gravity
    if "friction" in scalars:
        return SlidingModel(*known, friction=_typed(scalars, "friction", float), **nonlinear)
    return model_on_rigid_ground(*known, **nonlinear)
