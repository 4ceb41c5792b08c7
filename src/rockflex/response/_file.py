"""Responses on disk: one .npz file, arrays as they are and everything else as JSON within it."""

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from rockflex._errors import InputError
from rockflex._files import write_whole
from rockflex.modal import FloorModes, RockingProperties
from rockflex.models import LinearModel
from rockflex.response._history import History
from rockflex.response._response import PEAKS, FloorPeaks, Response

__all__ = ["load", "save"]

FORMAT = "rockflex-response-1"
PROPERTIES = (
    "omega", "effective_mass", "effective_height", "top_ordinate", "i_theta", "l0r", "m_tot", "half_width", "zeta",
    "translational_inertia",
)  # fmt: skip
FLOOR_MODES = ("heights", "displacement", "force")
FLOOR_PEAKS = ("story_drift", "story_shear", "floor_acceleration")


def save(response: Response, path: Path) -> Path:
    """Write `response` to `path` (``.npz`` is added where it lacks); the file appears whole or not at all."""
    path = path if path.suffix == ".npz" else path.with_name(path.name + ".npz")
    scalars = {"format": FORMAT, **response.peaks()}
    arrays: dict[str, Any] = {}
    if response.floors is not None:
        arrays |= {f"floors.{name}": getattr(response.floors, name) for name in FLOOR_PEAKS}
    if response.history is not None:
        model = response.history.model
        scalars["lifts"] = model.lifts
        arrays["nodes"] = response.history.nodes
        arrays |= {f"properties.{name}": getattr(model.properties, name) for name in PROPERTIES}
        if model.properties.floors is not None:
            arrays |= {f"floor_modes.{name}": getattr(model.properties.floors, name) for name in FLOOR_MODES}
    arrays["response"] = np.array(json.dumps(scalars))
    content = io.BytesIO()
    np.savez_compressed(content, **arrays)
    return write_whole(path, content.getvalue())


def load(path: Path) -> Response:
    """Read what `save` wrote."""
    if not path.is_file():
        message = f"No saved response at {path}. Give the path that Response.save returned."
        raise InputError(message)
    try:
        with np.load(path) as file:
            arrays = {name: file[name] for name in file.files}
        scalars = json.loads(str(arrays["response"]))
        known = scalars.get("format") == FORMAT
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        message = f"{path} is not a saved response ({error}). Give a file that Response.save wrote."
        raise InputError(message) from error
    if not known:
        message = f"{path} has the format {scalars.get('format')!r}, but {FORMAT!r} is expected."
        raise InputError(message)
    floors = history = None
    if "floors.story_drift" in arrays:
        floors = FloorPeaks(*(arrays[f"floors.{name}"] for name in FLOOR_PEAKS))
    if "nodes" in arrays:
        history = History(_model(scalars, arrays), arrays["nodes"])
    return Response(**{name: scalars[name] for name in PEAKS}, floors=floors, history=history)


def _model(scalars: dict[str, Any], arrays: dict[str, Any]) -> LinearModel:
    values = {name: arrays[f"properties.{name}"] for name in PROPERTIES}
    values = {name: value if value.ndim else float(value) for name, value in values.items()}
    floors = None
    if "floor_modes.heights" in arrays:
        floors = FloorModes(*(arrays[f"floor_modes.{name}"] for name in FLOOR_MODES))
    return LinearModel(scalars["model"], RockingProperties(**values, floors=floors), scalars["lifts"])
