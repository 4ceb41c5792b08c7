"""A short hash of everything that was given, by which equal inputs are recognised."""

import dataclasses
import hashlib
from typing import Any

import numpy as np

from rockflex.models import SpringModel
from rockflex.report.run._given import Given
from rockflex.report.run._record import Record
from rockflex.response import History


def fingerprint(about: Given, record: Record) -> str:
    """Return the hash of structure, ground, record, and what each run assumed and started from."""
    p = about.properties
    numbers: list[Any] = [record.time, record.acceleration, record.vertical]
    numbers += [p.omega, p.effective_mass, p.effective_height, p.zeta, p.top_ordinate]
    numbers.append([p.i_theta, p.l0r, p.m_tot, p.half_width, p.translational_inertia, p.eccentricity])
    texts = [repr((p.elements, about.labels))]
    for history in about.histories:
        model = history.model
        # What follows from the inputs, as rest on springs does, has errors of rounding.
        numbers += [[float(f"{value:.6g}") for value in history.states[0].tolist()], *_ground(model)]
        texts += [_law(model), repr(model.bouc_wen), _length(history)]
    content = b"".join(np.asarray(each, dtype=np.float64).tobytes() for each in numbers)
    return hashlib.sha256(content + "\n".join(texts).encode()).hexdigest()[:12]


def _ground(model: Any) -> list[Any]:
    friction = getattr(model, "friction", None)
    known = [] if friction is None else [friction]
    if not isinstance(model, SpringModel):
        return known
    return [*known, model.springs.positions, model.springs.stiffness, model.springs.damping, model.inertia]


def _law(model: Any) -> str:
    # An object that is no dataclass is written with its address, which no two sessions share.
    law = model.law
    return repr(law) if dataclasses.is_dataclass(law) else type(law).__name__


def _length(history: History) -> str:
    return f"{float(history.time[-1]):.6g}"
