"""Matrices from the files that finite element programs write."""

import hashlib
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._errors import InputError
from rockflex._files import check_regular, path_of
from rockflex.structure._matrix_market import read_matrix_market

Float = NDArray[np.float64]
Given: TypeAlias = ArrayLike | str | Path
"""Numbers, or the path of a file that holds them."""

MOST = 20_000  # freedoms of a sparse matrix, which takes 3 GB when dense
_SUFFIXES = (".npz", ".mtx", ".csv")


def numbers(name: str, given: Given) -> ArrayLike:
    """Return what was given, read from its file if it is a path.

    Files are told by their suffix: ``.npz`` (the array of that name, the only one, or a sparse matrix as SciPy saves
    it), ``.mtx`` (Matrix Market) and ``.csv`` (rows of numbers between commas; one row or column is a vector).

    Raises
    ------
    InputError
        If the file is missing, of another kind, or does not hold such numbers.
    """
    if not isinstance(given, str | Path):
        return given
    path = path_of(name, given)
    if path.suffix.lower() not in _SUFFIXES:
        raise InputError(f"{name}: {path} must be one of {', '.join(_SUFFIXES)}, told by its suffix.", field=name)
    check_regular(path, name)
    if not path.exists():
        raise InputError(f"{name}: the file {path} does not exist (working directory: {Path.cwd()}).", field=name)
    try:
        array = _READERS[path.suffix.lower()](name, path)
    except InputError:
        raise
    except Exception as error:  # the readers of damaged files raise many kinds
        raise InputError(
            f"{name}: {path} does not hold a matrix of numbers that can be read: {error}.", field=name
        ) from error
    return array.ravel() if 1 in array.shape and array.shape != (1, 1) else array


def checksum(name: str, path: Path) -> str:
    """SHA-256 of the shape and the numbers (little-endian doubles) of a file; raises as `numbers` does."""
    array = np.asarray(numbers(name, path), dtype="<f8")
    digest = hashlib.sha256(repr(array.shape).encode())
    digest.update(array.tobytes())
    return digest.hexdigest()


def _from_npz(name: str, path: Path) -> Float:
    with np.load(path, allow_pickle=False) as content:
        keys = content.files
        if "format" in keys and "data" in keys:
            from scipy.sparse import load_npz

            return _dense(name, path, load_npz(path))
        if name not in keys and len(keys) != 1:
            raise InputError(
                f'{name}: {path} must hold an array "{name}", or one array alone, but it holds {keys}.', field=name
            )
        return np.asarray(content[name if name in keys else keys[0]], dtype=np.float64)


def _from_mtx(name: str, path: Path) -> Float:
    return _dense(name, path, read_matrix_market(path))


def _dense(name: str, path: Path, matrix: Any) -> Float:
    if max(matrix.shape) > MOST:
        raise InputError(
            f"{name}: {path} holds a sparse matrix of the shape {matrix.shape}, but matrices are taken as dense, with "
            f"{MOST} freedoms at most. Condense it to the freedoms that carry mass, or give its modes to from_modes.",
            field=name,
        )
    return np.asarray(matrix.toarray(), dtype=np.float64)


def _from_csv(_: str, path: Path) -> Float:
    return np.loadtxt(path, delimiter=",", ndmin=2)


_READERS = {".npz": _from_npz, ".mtx": _from_mtx, ".csv": _from_csv}
