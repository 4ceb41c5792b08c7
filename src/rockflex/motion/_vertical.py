"""The vertical component beside the horizontal one: checks, equal lengths, and what is said of it."""

import warnings
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector
from rockflex._errors import InputError, RecordWarning
from rockflex._shown import shown
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._samples import Samples

APART = 1.0  # s by which the lengths of two components may differ without a warning


def checked(vertical: ArrayLike, n_samples: int) -> Array:
    """Return the vertical samples, as many as the horizontal ones."""
    samples = finite_vector("vertical", vertical, "m/s²")
    if samples.size != n_samples:
        raise InputError(
            f"vertical must have as many samples as acceleration, {n_samples}, but {samples.size} were given. Append "
            "zeros to the shorter one; motion.with_vertical(GroundMotion(vertical, dt)) does this.",
            field="vertical",
        )
    return samples


def known(name: str, vertical: Array | None) -> Array:
    """Return the vertical samples, or raise an error if there are none."""
    if vertical is None:
        raise InputError(
            f"The motion {shown(name)} has no vertical component. Give one: read_motion(path, vertical=...), or "
            "motion.with_vertical(...)."
        )
    return vertical


def info_alone(info: RecordInfo | None) -> RecordInfo:
    """Return the metadata of the vertical component as a motion of its own."""
    info = info or RecordInfo()
    return replace(info, component=None, direction="vertical", source=info.vertical_source, vertical_source=None)


def info_of_both(name: str, given: RecordInfo | None, info: RecordInfo | None) -> tuple[int, RecordInfo | None]:
    """Return the sign that makes a vertical record positive upwards, and the metadata with its source.

    Raises
    ------
    InputError
        If the record is known to be horizontal.
    """
    given = given or RecordInfo()
    if given.direction == "horizontal":
        raise InputError(
            f"A vertical ground motion is expected, but {shown(name)} is a horizontal component according to the "
            "header of the file. Give the vertical component (UP, V, UD or DWN). If it is one, declare it: "
            'dataclasses.replace(motion, metadata=RecordInfo(direction="vertical")).',
            field="vertical",
        )
    down = given.direction == "down"
    source = name or given.source
    if source is None:
        return -1 if down else 1, info
    note = " (reversed: it is positive downwards)" if down else ""
    return -1 if down else 1, replace(info or RecordInfo(), vertical_source=f"{source}{note}")


def aligned(name: str, along: Samples, upwards: Samples) -> tuple[Array, Array]:
    """Return the samples of both components of a motion, with zeros after the end of the shorter one.

    Raises
    ------
    InputError
        If the steps differ.
    """
    if abs(along.dt - upwards.dt) > 1e-9 * along.dt:
        finer = min(along.dt, upwards.dt)
        raise InputError(
            f"Both components need the same time step, but the horizontal one has dt = {along.dt:g} s and the vertical "
            f"one {upwards.dt:g} s. Resample the coarser one, for example with motion.resampled({finer:g}), before "
            "horizontal.with_vertical(vertical).",
            field="vertical",
        )
    longest = max(along.acceleration.size, upwards.acceleration.size)
    if abs(along.duration - upwards.duration) > APART:
        warnings.warn(
            f"The motion {shown(name)} lasts {along.duration:g} s, and its vertical component {upwards.duration:g} s; "
            "zeros were appended to the shorter one. Make sure that both start at the same instant.",
            RecordWarning,
            stacklevel=3,
        )
    first, second = (np.pad(each.acceleration, (0, longest - each.acceleration.size)) for each in (along, upwards))
    return first, second
