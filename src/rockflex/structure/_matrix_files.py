"""Matrices from the files that finite element programs write."""

import hashlib
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._files import check_regular, path_of
from rockflex.structure._matrix_market import read_matrix_market

Given: TypeAlias = ArrayLike | str | Path
"""Numbers, or the path of a file that contains them."""

MOST = 20_000  # degrees of freedom of a sparse matrix: 3 GB as a dense one
_SUFFIXES = (".npz", ".mtx", ".csv")


def numbers(name: str, given: Given) -> ArrayLike:
    """Return the given numbers, read from a file if a path was given.

    The suffix decides the format: ``.npz`` (the array of that name, the only array, or a sparse matrix as saved by
    SciPy), ``.mtx`` (Matrix Market) or ``.csv`` (rows of comma-separated numbers; a single row or column is a vector).

    Raises
    ------
    InputError
        If the file is missing, has another format, or does not contain such numbers.
    """
    if not isinstance(given, str | Path):
        return given
    path = path_of(name, given)
    if path.suffix.lower() not in _SUFFIXES:
        raise InputError(f"{name}: the suffix of {path} must be one of {', '.join(_SUFFIXES)}.", field=name)
    check_regular(path, name)
    if not path.exists():
        raise InputError(f"{name}: the file {path} does not exist (working directory: {Path.cwd()}).", field=name)
    try:
        array = _READERS[path.suffix.lower()](name, path)
    except InputError:
        raise
    except Exception as error:  # readers of damaged files raise many types of exception
        raise InputError(f"{name}: no matrix of numbers can be read from {path}: {error}.", field=name) from error
    return array.ravel() if 1 in array.shape and array.shape != (1, 1) else array


def checksum(name: str, path: Path) -> str:
    """Return the SHA-256 of the shape and the numbers (little-endian doubles) of a file; errors as in `numbers`."""
    array = np.asarray(numbers(name, path), dtype="<f8")
    digest = hashlib.sha256(repr(array.shape).encode())
    digest.update(array.tobytes())
    return digest.hexdigest()


def _from_npz(name: str, path: Path) -> Array:
    with np.load(path, allow_pickle=False) as content:
        keys = content.files
        if "format" in keys and "data" in keys:
            from scipy.sparse import load_npz

            return _dense(name, path, load_npz(path))
        if name not in keys and len(keys) != 1:
            raise InputError(
                f'{name}: {path} must contain an array "{name}" or a single array, but it contains {keys}.', field=name
            )
        return np.asarray(content[name if name in keys else keys[0]], dtype=np.float64)


def _from_mtx(name: str, path: Path) -> Array:
    return _dense(name, path, read_matrix_market(path))


def _dense(name: str, path: Path, matrix: Any) -> Array:
    if max(matrix.shape) > MOST:
        raise InputError(
            f"{name}: {path} contains a sparse matrix of shape {matrix.shape}, but matrices are treated as dense, with "
            f"at most {MOST} degrees of freedom. Condense it to the degrees of freedom with mass, or give its modes to "
            "from_modes.",
            field=name,
        )
    return np.asarray(matrix.toarray(), dtype=np.float64)


def _from_csv(_: str, path: Path) -> Array:
    return np.loadtxt(path, delimiter=",", ndmin=2)


_READERS = {".npz": _from_npz, ".mtx": _from_mtx, ".csv": _from_csv}
