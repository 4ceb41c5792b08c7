"""Structures from the matrices or the modes of any finite element program, also in its files."""

import hashlib
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, SupportsIndex, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.archives import ArchiveError, ArchiveLimits, arrays_from_npz
from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import (
    checked_damping_ratios,
    checked_finite_matrix,
    checked_finite_vector,
    checked_positive,
    checked_whole_number,
    float_array,
    number_of_dimensions,
)
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file, checked_file_path
from rockflex.foundation.matrices import checked_mass, checked_stiffness
from rockflex.foundation.overflow import explaining_overflow
from rockflex.structure._participation import MassNormalisedModes, excited_mode_indices
from rockflex.structure._structure import ModalStructure

if TYPE_CHECKING:
    from scipy.sparse import coo_array
NumbersOrPath: TypeAlias = ArrayLike | str | Path
"""Numbers, or the path of a file that contains them."""
MAX_FREEDOMS = 20_000  # degrees of freedom of a sparse matrix: 3 GB as a dense one
_NPZ_LIMITS = ArchiveLimits(1_000, 4_000_000_000, 8_000_000_000)
MAX_FORM_LINES = 50  # of a file, which tell its form
_ABAQUS_ENTRY = re.compile(r"\s*+-?\d++\s*+,\s*+\d++\s*+,\s*+-?\d++\s*+,\s*+\d++\s*+,\s*+[-+.\d]")
_ENTRY = re.compile(r"\s*+\d++[\s,]++\d++[\s,]++[-+]?+(?:\d++\.?+\d*+|\.\d++)(?:[EeDd][-+]?+\d++)?+\s*+$")
_MATRIX_SUFFIXES = (".npz", ".mtx", ".csv")
Heights = NumbersOrPath | Mapping[int, float]
"""Height of every degree of freedom in m, NaN for none, or a map {index: height} of those that translate."""
_MAX_COSINE = 1e-5  # tolerance for values with few printed digits


def read_matrix_market(path: Path) -> "coo_array":
    """Return the matrix of a file, coordinate or array, real or integer, general or symmetric.

    Raises
    ------
    ValueError
        If the file contains another kind of matrix, or other entries than its header announces.
    """
    from scipy.sparse import coo_array

    banner, *lines = path.read_text(encoding="utf-8").splitlines() or [""]
    if form := _other_matrix_form([banner, *lines[:MAX_FORM_LINES]]):
        raise ValueError(form)
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


def _other_matrix_form(lines: Sequence[str]) -> str:
    """Return what is wrong with the first lines of a matrix that other programs write; empty if nothing is known."""
    numbers = next((line for line in lines if line.strip() and not line.startswith("*")), "")
    if lines[0].startswith("*") or _ABAQUS_ENTRY.match(numbers):
        return (
            "it is in Abaqus's form MATRIX INPUT (node, degree of freedom, node, degree of freedom, value), which does "
            "not say the order of the degrees of freedom. Choose it, and save the matrix of those with mass by "
            "scipy.io.mmwrite or numpy.savez"
        )
    if _ENTRY.match(lines[0]):
        return (
            'its entries lack the header of Matrix Market. Write above them "%%MatrixMarket matrix coordinate real '
            'general" (or symmetric, if they are those of one triangle) and a line with the numbers of rows, columns '
            "and entries"
        )
    return ""


def given_or_read_matrix(name: str, given: NumbersOrPath) -> ArrayLike:
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
    path = checked_file_path(name, given)
    if path.suffix.lower() not in _MATRIX_SUFFIXES:
        raise InputError(f"{name}: the suffix of {path} must be one of {', '.join(_MATRIX_SUFFIXES)}.", field=name)
    check_regular_file(path, name)
    if not path.exists():
        raise InputError(f"{name}: the file {path} does not exist (working directory: {Path.cwd()}).", field=name)
    try:
        array = _READERS[path.suffix.lower()](name, path)
    except ArchiveError as error:
        raise InputError(f"{name}: no matrix of numbers can be read from {path}: it {error}.", field=name) from error
    except InputError:
        raise
    except Exception as error:  # readers of damaged files raise many types of exception
        raise InputError(f"{name}: no matrix of numbers can be read from {path}: {error}.", field=name) from error
    return array.ravel() if 1 in array.shape and array.shape != (1, 1) else array


def matrix_file_checksum(name: str, path: Path) -> str:
    """Return the SHA-256 of the shape and the numbers (little-endian doubles) of a file.

    Errors are those of `given_or_read_matrix`.
    """
    array = np.asarray(given_or_read_matrix(name, path), dtype="<f8")
    digest = hashlib.sha256(repr(array.shape).encode())
    digest.update(array.tobytes())
    return digest.hexdigest()


def _matrix_from_npz(name: str, path: Path) -> Array:
    content = arrays_from_npz(path, _NPZ_LIMITS)
    if "format" in content and "data" in content:
        from scipy.sparse import load_npz

        read = io.BytesIO()
        cast(Any, np.savez)(read, **content)
        read.seek(0)
        return _dense_matrix(name, path, load_npz(read))
    if name not in content and len(content) != 1:
        said = f'{path} must contain an array "{name}" or a single array, but it contains {[*content]}'
        raise InputError(f"{name}: {said}.", field=name)
    return np.asarray(content[name] if name in content else next(iter(content.values())), dtype=np.float64)


def _matrix_from_mtx(name: str, path: Path) -> Array:
    return _dense_matrix(name, path, read_matrix_market(path))


def _dense_matrix(name: str, path: Path, matrix: Any) -> Array:
    if max(matrix.shape) > MAX_FREEDOMS:
        raise InputError(
            f"{name}: {path} contains a sparse matrix of shape {matrix.shape}, but matrices are treated as dense, with "
            f"at most {MAX_FREEDOMS} degrees of freedom. Condense it to the degrees of freedom with mass, or give its "
            "modes to from_modes.",
            field=name,
        )
    return np.asarray(matrix.toarray(), dtype=np.float64)


def _matrix_from_csv(_: str, path: Path) -> Array:
    return np.loadtxt(path, delimiter=",", ndmin=2)


_READERS = {".npz": _matrix_from_npz, ".mtx": _matrix_from_mtx, ".csv": _matrix_from_csv}


@dataclass(frozen=True, eq=False)
class DegreesOfFreedom:
    """The degrees of freedom that translate horizontally or rotate in the plane; the base does not move the others.

    Attributes
    ----------
    translates : ndarray of int, shape (T,)
        Indices of the horizontal translations, in order of height.
    heights : ndarray, shape (T,)
        Their heights above the base in m.
    rotates : ndarray of int, shape (R,)
        Indices of the rotations in the plane.
    size : int
        Number N of degrees of freedom.
    """

    translates: NDArray[np.intp]
    heights: Array
    rotates: NDArray[np.intp]
    size: int

    @classmethod
    def of(cls, heights: Heights, rotations: Sequence[SupportsIndex], size: int) -> "DegreesOfFreedom":
        """Return the degrees of freedom of a structure that has `size` of them.

        Raises
        ------
        InputError
            If a height is missing or not positive, or an index is out of range or named twice.
        """
        if not isinstance(rotations, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"rotations must be a sequence of indices of degrees of freedom, but {type(rotations).__name__} was "
                "given.",
                field="rotations",
            )
        turning = [checked_whole_number("rotations, index", i, 0, size - 1, field="rotations") for i in rotations]
        where, values = _translating_freedoms(heights, turning, size)
        twice = sorted({i for i in turning if turning.count(i) > 1 or i in where})
        if twice:
            raise InputError(
                f"rotations must list each degree of freedom once, and none that has a height, but {twice[0]} is "
                "listed twice.",
                field="rotations",
            )
        if values.min(initial=np.inf) <= 0.0 or values.size == 0:
            lowest = f"{values.min():g} m" if values.size else "none"
            raise InputError(
                f"heights must contain at least one height in m above the base, all positive, but {lowest} was given. "
                "A mass at the base belongs to base_mass; freedoms that do not translate horizontally have no height.",
                field="heights",
            )
        order = np.argsort(values, kind="stable")
        return cls(np.array(where, dtype=np.intp)[order], values[order], np.array(turning, dtype=np.intp), size)

    def kept(self, keep: Bools) -> "DegreesOfFreedom":
        """Return the degrees of freedom of the structure reduced to some of them.

        Raises
        ------
        InputError
            If none of the remaining ones translates.
        """
        number = np.cumsum(keep) - 1
        moves, turns = keep[self.translates], keep[self.rotates]
        if not moves.any():
            raise InputError(
                "mass must be assigned to at least one degree of freedom that translates horizontally, but it is zero "
                "for all of them.",
                field="mass",
            )
        return DegreesOfFreedom(
            number[self.translates[moves]], self.heights[moves], number[self.rotates[turns]], int(keep.sum())
        )

    def modes(self, omega: Array, shapes: Array, mass: Array) -> MassNormalisedModes:
        """Return the modes, with φ^T M φ = 1, and their participation; `mass` is (N, N).

        Degrees of freedom at the same height form one station, with their mean ordinate and the sum of their forces. If
        a rotation has mass, its moment acts at an unknown height, so there are no forces at stations.
        """
        translation, rotation = np.zeros(self.size), np.zeros(self.size)
        translation[self.translates] = 1.0
        rotation[self.translates] = self.heights
        rotation[self.rotates] = 1.0
        moved = mass @ shapes
        stations, at, count = np.unique(self.heights, return_inverse=True, return_counts=True)
        ordinates, forces = np.zeros((2, stations.size, omega.size))
        np.add.at(ordinates, at, shapes[self.translates])
        np.add.at(forces, at, moved[self.translates])
        carried = bool(np.any(mass[self.rotates]))
        return MassNormalisedModes(
            omega=omega,
            shear=translation @ moved,
            moment=rotation @ moved,
            heights=stations,
            ordinates=ordinates / count[:, None],
            forces=None if carried else forces,
            mass=float(translation @ mass @ translation),
            first_moment=float(translation @ mass @ rotation),
            inertia=float(rotation @ mass @ rotation),
        )


def _translating_freedoms(heights: Heights, turning: Sequence[int], size: int) -> tuple[list[int], Array]:
    """Return the degrees of freedom that translate horizontally, and their heights."""
    if isinstance(heights, Mapping):
        where = [checked_whole_number("heights, index", i, 0, size - 1, field="heights") for i in heights]
        return where, checked_finite_vector("heights", list(heights.values()), "m")
    given = given_or_read_matrix("heights", heights)
    values = float_array(given)
    if values is None or values.ndim != 1:
        checked_finite_vector("heights", given, "m")  # raises an error
        raise AssertionError
    others = [i for i in range(size) if i not in turning]
    if values.size == size:
        values = values[others]  # the height of a rotation, at its node, does not matter
    elif values.size != len(others):
        raise InputError(
            f"heights must contain one height for each of the {size} degrees of freedom, but {values.size} were given. "
            "List those that rotate in rotations; if others do not translate horizontally, give the heights of those "
            "that do with their indices, such as {0: 3.0, 2: 6.0}.",
            field="heights",
        )
    moves = ~np.isnan(values)
    return [i for i, each in zip(others, moves, strict=True) if each], checked_finite_vector(
        "heights", values[moves], "m"
    )


def from_matrices(
    mass: NumbersOrPath,
    stiffness: NumbersOrPath,
    heights: Heights,
    *,
    rotations: Sequence[SupportsIndex] = (),
    base_mass: float,
    half_width: float,
    damping_ratio: ArrayLike,
    n_modes: SupportsIndex | None = None,
) -> ModalStructure:
    """Return a structure from its mass and stiffness matrices on a fixed base.

    A unit rotation of the base displaces a horizontal degree of freedom at height h by h, and a rotational one by 1;
    the ground displaces only the horizontal ones. Neither affects the others, such as out-of-plane degrees of freedom
    or vertical ones on the axis. Massless degrees of freedom are condensed out exactly.

    Parameters
    ----------
    mass : array_like (N,) or (N, N), or path
        Masses or mass matrix in kg (kg m² for rotations), excluding the base; rows of zeros are allowed.
    stiffness : array_like (N, N), or path
        Symmetric positive definite stiffness in N/m (N m/rad for rotations).
    heights : array_like (N,), path, or mapping
        Height of each degree of freedom above the base in m, NaN for one that does not translate horizontally, or a
        map ``{index: height}`` of those that do. The highest one with mass is the top.
    rotations : sequence of int
        Indices of the rotations in the plane, which need no height, with the sign of the base rotation: a positive
        rotation displaces the structure above it in the direction of the positive translations.
    base_mass, half_width : float
        Mass m_0 of the base in kg, zero or positive, and its half-width B in m.
    damping_ratio : array_like
        Damping ratio in [0, 1): one number for all modes, or one per retained mode.
    n_modes : int, optional
        Number of modes to retain, the lowest first, not counting modes that are not excited. Default: all.

    Returns
    -------
    ModalStructure
        Its properties include `floors` if no rotation has mass.

    Raises
    ------
    InputError
        If a file cannot be read, the shapes do not match, a matrix is not symmetric positive (definite), or a mode has
        no coordinate D_n.

    Notes
    -----
    Paths end in ``.npz`` (an array with the name of the argument), ``.mtx`` or ``.csv``. The matrices are treated as
    dense. Mass that couples a degree of freedom to the base itself, as consistent mass matrices have in the lowest
    elements, is missing from the matrices of a fixed base: use lumped masses, or short elements at the base.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.from_matrices(
    ...     mass=[20e3, 20e3], stiffness=[[8e6, -4e6], [-4e6, 4e6]],
    ...     heights=[3.0, 6.0],
    ...     base_mass=20e3, half_width=0.6, damping_ratio=0.02,
    ... )
    >>> structure.modal().period.round(3)
    array([0.719, 0.275])
    """
    k_given = given_or_read_matrix("stiffness", stiffness)
    size = np.shape(k_given)[0] if number_of_dimensions(k_given) == 2 else 1
    k = checked_stiffness(k_given, size)
    m_given = given_or_read_matrix("mass", mass)
    m = _checked_mass_matrix(m_given, size)
    freedoms = DegreesOfFreedom.of(heights, rotations, size)
    keep = np.asarray(m.any(axis=1))
    freedoms = freedoms.kept(keep)
    m = checked_mass(m[np.ix_(keep, keep)], freedoms.size)
    with explaining_overflow("The modes of the given mass and stiffness matrices"):
        if not keep.all():
            tie = k[np.ix_(keep, ~keep)]
            k = k[np.ix_(keep, keep)] - tie @ np.linalg.solve(k[np.ix_(~keep, ~keep)], tie.T)
            k = 0.5 * (k + k.T)
        modes = freedoms.modes(*_modes_from_matrices(k, m), m)
    return _modal_structure(modes, base_mass, half_width, damping_ratio, n_modes)


def from_modes(
    omega: NumbersOrPath,
    shapes: NumbersOrPath,
    mass: NumbersOrPath,
    heights: Heights,
    *,
    rotations: Sequence[SupportsIndex] = (),
    base_mass: float,
    half_width: float,
    damping_ratio: ArrayLike,
    n_modes: SupportsIndex | None = None,
) -> ModalStructure:
    """Return a structure from its mass and its modes on a fixed base, in any normalisation.

    Parameters
    ----------
    omega : array_like, shape (n,), or path
        Circular frequencies in rad/s, in ascending order.
    shapes : array_like, shape (N, n), or path
        Mode shapes as columns, orthogonal with respect to the mass.
    mass, heights, rotations, base_mass, half_width, damping_ratio, n_modes
        As for `from_matrices`.

    Returns
    -------
    ModalStructure

    Raises
    ------
    InputError
        If a file cannot be read, the shapes do not match, the frequencies are not in ascending order, or two mode
        shapes are not orthogonal.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.from_modes(
    ...     omega=[8.74, 22.88], shapes=[[0.61803, 1.61803], [1.0, -1.0]],
    ...     mass=[20e3, 20e3], heights=[3.0, 6.0],
    ...     base_mass=20e3, half_width=0.6, damping_ratio=0.02,
    ... )
    >>> structure.modal().effective_mass.round(-1)
    array([37890.,  2110.])
    """
    w = checked_finite_vector("omega", given_or_read_matrix("omega", omega), "rad/s")
    falls = np.flatnonzero(np.diff(w, prepend=0.0) < 0.0)
    if w.size == 0 or w[0] <= 0.0 or falls.size:
        raise InputError(
            f"omega must contain positive frequencies in rad/s in ascending order, but {w} was given. Sort the modes.",
            field="omega",
        )
    given = given_or_read_matrix("shapes", shapes)
    columns = checked_finite_vector("shapes", given, "any unit")[:, None] if number_of_dimensions(given) == 1 else given
    size = np.shape(columns)[0] if number_of_dimensions(columns) == 2 else 1
    phi = checked_finite_matrix("shapes", columns, "any unit", (size, w.size))
    m = _checked_mass_matrix(given_or_read_matrix("mass", mass), size)
    freedoms = DegreesOfFreedom.of(heights, rotations, size)
    products = phi.T @ m @ phi
    own = np.diag(products)
    if not (own > 0.0).all():
        i = int(np.argmin(own))
        raise InputError(
            f"Mode shape {i + 1} moves no mass (φ^T M φ = {own[i]:.3g}). Check that both "
            "have the same order of degrees of freedom.",
            field="mass",
        )
    cosines = products / np.sqrt(np.outer(own, own)) - np.eye(w.size)
    if np.abs(cosines).max() > _MAX_COSINE:
        i, j = sorted(int(each) for each in np.unravel_index(np.argmax(np.abs(cosines)), cosines.shape))
        raise InputError(
            f"The mode shapes must be orthogonal with respect to the mass, but φ_{i + 1}^T M φ_{j + 1} is "
            f"{cosines[i, j]:.3g} times the product of their norms. Give the mass that the modes were computed with, "
            "the degrees of freedom in the same order, and shapes with enough digits.",
            field="shapes",
        )
    return _modal_structure(freedoms.modes(w, phi / np.sqrt(own), m), base_mass, half_width, damping_ratio, n_modes)


def _modal_structure(
    modes: MassNormalisedModes,
    base_mass: float,
    half_width: float,
    damping_ratio: ArrayLike,
    n_modes: SupportsIndex | None,
) -> ModalStructure:
    kept = excited_mode_indices(modes.modal(), n_modes)
    taken = replace(
        modes,
        omega=modes.omega[kept],
        shear=modes.shear[kept],
        moment=modes.moment[kept],
        ordinates=modes.ordinates[:, kept],
        forces=None if modes.forces is None else modes.forces[:, kept],
    )
    return ModalStructure(
        taken,
        checked_positive("base_mass", base_mass, "kg", zero=True),
        checked_positive("half_width", half_width, "m"),
        checked_damping_ratios("damping_ratio", damping_ratio, kept.size),
    )


def _checked_mass_matrix(given: ArrayLike, size: int) -> Array:
    if number_of_dimensions(given) == 2:
        m = checked_finite_matrix("mass", given, "kg", (size, size))
    else:
        values = checked_finite_vector("mass", given, "kg")
        if values.size != size:
            raise InputError(
                f"mass must contain one mass for each of the {size} degrees of freedom, but {values.size} were given.",
                field="mass",
            )
        m = np.diag(values)
    own = np.diag(m)
    if own.min() < 0.0:
        i = int(np.argmin(own))
        raise InputError(f"mass must not be negative, but it is {own[i]:g} at degree of freedom {i}.", field="mass")
    return m


def _modes_from_matrices(stiffness: Array, mass: Array) -> tuple[Array, Array]:
    """Return the frequencies as singular values of C^T L^-T, with K = C C^T and M = L L^T, and the mode shapes."""
    root = np.linalg.cholesky(mass)
    _, omega, vectors = np.linalg.svd(np.linalg.solve(root, np.linalg.cholesky(stiffness)).T)
    return omega[::-1].copy(), np.asarray(np.linalg.solve(root.T, vectors.T)[:, ::-1], dtype=np.float64)
