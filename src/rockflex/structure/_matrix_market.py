"""Real matrices in the Matrix Market format (Boisvert, Pozo & Remington 1996, NISTIR 5935).

SciPy's reader crashes the interpreter on some damaged files, so the text is parsed here.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from scipy.sparse import coo_array


def read_matrix_market(path: Path) -> "coo_array":
    """Return the matrix of a file, coordinate or array, real or integer, general or symmetric.

    Raises
    ------
    ValueError
        If the file contains another kind of matrix, or other entries than its header announces.
    """
    from scipy.sparse import coo_array

    banner, *lines = path.read_text(encoding="utf-8").splitlines() or [""]
    mark, *kinds = banner.split() or [""]
    form, field, symmetry = ([word.lower() for word in kinds] + [""] * 4)[1:4]
    if (
        mark != "%%MatrixMarket"
        or form not in ("coordinate", "array")
        or field not in ("real", "integer", "double")
        or symmetry not in ("general", "symmetric")
    ):
        raise ValueError(
            "its first line must declare a matrix, coordinate or array, real or integer, general or symmetric"
        )
    head, *body = [line for line in lines if line.strip() and not line.startswith("%")] or [""]
    numbers = [int(word) for word in head.split()]
    if len(numbers) != (3 if form == "coordinate" else 2) or min(numbers) < 0:
        raise ValueError("its size line must give the numbers of rows and columns, and in coordinate format of entries")
    rows, columns = numbers[:2]
    if form == "coordinate":
        entries = np.loadtxt(body, dtype=np.float64, ndmin=2) if body else np.zeros((0, 3))
        if entries.shape != (numbers[2], 3):
            raise ValueError(f"it must contain {numbers[2]} entries of three numbers, but it contains {entries.shape}")
        row, column, value = entries.T
    else:
        value = np.loadtxt(body, dtype=np.float64, ndmin=1) if body else np.zeros(0)
        count = rows * columns if symmetry == "general" else rows * (rows + 1) // 2
        if value.size != count or (symmetry == "symmetric" and rows != columns):
            raise ValueError(
                f"it must contain {count} numbers for a matrix of {rows} by {columns}, but it contains {value.size}"
            )
        whole = np.ones((columns, rows), dtype=np.bool_)  # the file lists it column by column
        column, row = np.nonzero(whole if symmetry == "general" else np.triu(whole))
        row, column = row + 1.0, column + 1.0
    places = np.stack((row, column)) - 1.0
    inside = (places >= 0.0).all() and (places < [[rows], [columns]]).all()
    if not inside or (places != np.floor(places)).any():
        raise ValueError(f"its entries must lie in {rows} rows and {columns} columns, counted from 1")
    i, j = places.astype(np.int64)
    if symmetry == "symmetric":
        mirrored = i != j
        i, j, value = np.append(i, j[mirrored]), np.append(j, i[mirrored]), np.append(value, value[mirrored])
    return coo_array((value, (i, j)), shape=(rows, columns))
