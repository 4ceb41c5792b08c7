"""Compilation of all kernels ahead of need."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import numpy as np

from rockflex._kernel import KERNELS, notice
from rockflex._numba import folder_of
from rockflex.modal import Tendon
from rockflex.motion import GroundMotion, rotated_spectrum
from rockflex.response import Response
from rockflex.structure import LumpedStructure, Restrained
from rockflex.study._simulate import simulate


@dataclass(frozen=True)
class Warmth:
    """What `warm` did.

    Parameters
    ----------
    compiled
        Number of kernels that were compiled; 0 if all were on disk.
    duration
        Time that it took, s.
    folder
        Folder under which the compiled kernels are; None if they cannot be kept, because no folder can be written.

    Examples
    --------
    >>> import rockflex as rf
    >>> done = rf.warm()
    >>> done.duration > 0.0
    True
    """

    compiled: int
    duration: float
    folder: Path | None


def warm(progress: Callable[[str], None] | None = None) -> Warmth:
    """Compile everything that simulations need, ahead of the first one.

    Compiled kernels are kept on disk for later processes, until rockflex or numba is upgraded. They are found in the
    ``__pycache__`` folders of the package or, if those cannot be written, in the user's cache; the environment variable
    ``NUMBA_CACHE_DIR`` names another place. If all are there, nothing is done.

    Parameters
    ----------
    progress
        Is called with the name of each step before it starts.

    Returns
    -------
    Warmth
        What was compiled, where it is, and how long it took.

    Examples
    --------
    >>> import rockflex as rf
    >>> done = rf.warm()
    >>> rf.warm().compiled
    0
    """
    if progress is not None:
        notice.told = True  # the caller tells
    start, before = perf_counter(), _compiled()
    for name, step in STEPS.items():
        if progress is not None:
            progress(name)
        step()
    return Warmth(_compiled() - before, perf_counter() - start, _folder())


def _folder() -> Path | None:
    """Return the folder under which all compiled kernels are."""
    folders = [folder for folder in map(folder_of, KERNELS) if folder is not None]
    return Path(os.path.commonpath(folders)) if folders else None


def _compiled() -> int:
    """Return how many kernels were compiled by this process."""
    return sum(sum(kernel.stats.cache_misses.values()) for kernel in KERNELS if hasattr(kernel, "stats"))


def _structure() -> LumpedStructure:
    return LumpedStructure(
        [1e4, 1e4],
        [[4e6, -2e6], [-2e6, 2e6]],
        [3.0, 6.0],
        base_mass=1e4,
        half_width=0.7,
        damping_ratio=0.02,
    )


def _runs(model: str) -> Response:
    return simulate(_structure(), _motion(), model)


def _tied() -> None:
    simulate(Restrained(_structure(), Tendon(1e3, 1e5)), _motion(), "MDOF-S")


def _motion() -> GroundMotion:
    return GroundMotion(4.0 * np.sin(0.05 * np.arange(200)), 0.01)


def _complete() -> None:
    response = _runs("MDOF-C")
    _ = response.energy, response.total_top_displacement  # from the accelerations and the curves of a history


def _spectra() -> None:
    _motion().spectrum([0.5])
    rotated_spectrum(_motion(), _motion(), [0.5])


STEPS: dict[str, Callable[[], object]] = {
    "simplified models with elements": _tied,
    "complete and yielding models": _complete,
    "response spectra": _spectra,
}
