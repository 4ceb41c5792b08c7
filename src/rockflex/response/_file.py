"""Responses on disk: one .npz file that contains the arrays, and everything else as JSON."""

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any, cast

import numpy as np

from rockflex._errors import InputError
from rockflex._files import check_regular, write_whole
from rockflex._shown import shown
from rockflex.modal import FloorModes, RockingProperties, Tendon
from rockflex.models import (
    BoucWen,
    ForgottenLaw,
    ImpactLaw,
    LinearModel,
    NonlinearModel,
    Restitution,
    RockingModel,
    SidedRestitution,
    VVELComplete,
    VVELSimplified,
)
from rockflex.response._floor_peaks import FloorPeaks
from rockflex.response._history import History

Kept = tuple[dict[str, Any], FloorPeaks | None, History | None]

FORMAT = "rockflex-response-2"
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
KNOWN_OR_NOT = ("top_height", "base_mass")
LAWS: dict[str, Callable[..., ImpactLaw]] = {
    "VVELSimplified": VVELSimplified,
    "VVELComplete": VVELComplete,
    "Restitution": Restitution,
    "SidedRestitution": SidedRestitution,
    "ForgottenLaw": ForgottenLaw,
}
FLOOR_MODES = ("heights", "displacement", "force")
FLOOR_PEAKS = ("story_drift", "story_shear", "floor_acceleration", "total_floor_displacement")


def save(path: Path, peaks: dict[str, Any], floors: FloorPeaks | None, history: History | None) -> Path:
    """Write a response to `path`, adding the suffix ``.npz`` if necessary; the file is complete or absent."""
    if path.suffix[1:2].isalpha() and path.suffix.lower() != ".npz":  # "scale 1.5" has no suffix
        raise InputError(
            f"A response is saved as .npz, but {path.name!r} was given. Name it {path.stem + '.npz'!r}; for a "
            'table of the history write pandas.DataFrame({"time": response.time, "rotation": response.rotation})'
            ".to_parquet(...)."
        )
    path = path if path.suffix.lower() == ".npz" else path.with_name(path.name + ".npz")
    scalars = {"format": FORMAT, **peaks}
    arrays: dict[str, Any] = {}
    if floors is not None:
        arrays |= {f"floors.{name}": getattr(floors, name) for name in FLOOR_PEAKS}
    if history is not None:
        model = history.model
        scalars["lifts"] = model.lifts
        scalars["law"] = _described(model.law)
        scalars["missing_mass"] = model.missing_mass
        scalars |= {name: getattr(model.properties, name) for name in (*KNOWN_OR_NOT, "eccentricity")}
        if model.integrated:
            scalars["complete"] = model.complete
            scalars["bouc_wen"] = None if model.bouc_wen is None else asdict(model.bouc_wen)
        scalars["tendons"] = [asdict(tendon) for tendon in model.properties.tendons]
        arrays["states"] = history.states
        arrays |= {f"properties.{name}": getattr(model.properties, name) for name in PROPERTIES}
        if model.properties.floors is not None:
            arrays |= {f"floor_modes.{name}": getattr(model.properties.floors, name) for name in FLOOR_MODES}
    arrays["response"] = np.array(json.dumps(scalars))
    content = io.BytesIO()
    np.savez_compressed(content, **arrays)
    return write_whole(path, content.getvalue())


def load(path: Path, kinds: dict[str, type]) -> Kept:
    """Read a response written by `save`, with peaks of these names and types."""
    check_regular(path)
    if not path.exists():
        raise InputError(f"No saved response at {path}. Give the path that Response.save returned.")
    try:
        with zipfile.ZipFile(path) as archive:  # whole members, so that their checksums are verified
            content = {name.removesuffix(".npy"): archive.read(name) for name in archive.namelist()}
        arrays = {name: np.load(io.BytesIO(part)) for name, part in content.items()}
        scalars = json.loads(str(arrays["response"]))
        known = scalars["format"] == FORMAT
        kept = _kept(scalars, arrays, kinds) if known else None
    except Exception as error:  # zipfile, zlib, NumPy and json raise almost any exception for damaged files
        reason = f"{type(error).__name__}: {error}"
        raise InputError(f"{path} is not a saved response ({reason}). Give a file that Response.save wrote.") from error
    if kept is None:
        raise InputError(f"{path} has the format {shown(scalars['format'])}, but {FORMAT!r} is expected.")
    return kept


def _kept(scalars: dict[str, Any], arrays: dict[str, Any], kinds: dict[str, type]) -> Kept:
    for name, values in arrays.items():
        if name != "response" and values.dtype != np.float64:
            raise InputError(f"{name} must be of type float64, but is of type {values.dtype}.")
    peaks = {name: _typed(scalars, name, kind) for name, kind in kinds.items()}
    floors = history = None
    if "nodes" in arrays:  # as older versions named the states
        arrays = arrays | {"states": arrays["nodes"]}
    if "states" in arrays:
        history = History(_model(scalars, arrays), arrays["states"])
    if "floors.story_drift" in arrays:
        floors = FloorPeaks(*(arrays[f"floors.{name}"] for name in FLOOR_PEAKS))
        if floors.story_drift.shape != arrays["floor_modes.heights"].shape:
            raise InputError(f"There are peaks of {floors.story_drift.size} floors, but a different number of heights.")
    return peaks, floors, history


def _typed(scalars: dict[str, Any], name: str, kind: type) -> Any:
    if type(scalars[name]) is not kind:
        raise InputError(f"{name} must be of type {kind.__name__}, but is {shown(scalars[name])}.")
    return scalars[name]


def _described(law: ImpactLaw) -> dict[str, Any]:
    """Return an impact law as JSON; for a user-defined law only its description."""
    name = type(law).__name__
    if name in LAWS and type(law) is LAWS[name]:
        return {"law": name, **asdict(cast("Any", law))}
    return {"law": "ForgottenLaw", "description": repr(law), "keeps": str(law.keeps), "loses": str(law.loses)}


def _law(parameters: dict[str, Any]) -> ImpactLaw:
    name = parameters.pop("law")
    if name == "SidedRestitution":
        parameters = {edge: Restitution(**each) for edge, each in parameters.items()}
    return LAWS[name](**parameters)


def _model(scalars: dict[str, Any], arrays: dict[str, Any]) -> RockingModel:
    values = {name: arrays[f"properties.{name}"] for name in PROPERTIES}
    values = {name: value if value.ndim else float(value) for name, value in values.items()}
    floors = None
    if "floor_modes.heights" in arrays:
        floors = FloorModes(*(arrays[f"floor_modes.{name}"] for name in FLOOR_MODES))
    tendons = [Tendon(**each) for each in _typed(scalars, "tendons", list)]
    known = {name: scalars[name] for name in KNOWN_OR_NOT}
    known["eccentricity"] = scalars.get("eccentricity", 0.0)  # files of symmetric bases may lack it
    properties = RockingProperties(**values, floors=floors, elements=tendons, **known)
    lifts, parameters = _typed(scalars, "lifts", bool), dict(_typed(scalars, "law", dict))
    missing = _typed(scalars, "missing_mass", bool)
    law = _law(parameters)
    if "complete" not in scalars:
        return LinearModel(scalars["model"], properties, lifts, law, missing)
    bouc_wen = None if scalars["bouc_wen"] is None else BoucWen(**scalars["bouc_wen"])
    return NonlinearModel(
        scalars["model"], properties, lifts, law, _typed(scalars, "complete", bool), bouc_wen, missing
    )
