"""The variance of results split by where it comes from, by the law of total variance."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.checks import checked_finite_vector
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

if TYPE_CHECKING:
    import pandas as pd


def variance_shares(values: ArrayLike, sources: Mapping[str, ArrayLike]) -> "pd.DataFrame":
    """Split the variance of results among the sources of their scatter: records, structures, models.

    Var Y = Var E[Y|source] + E Var[Y|source]. The first term over Var Y is the share of a source by itself, its Sobol
    index of the first order. The means by source are fitted together, so that a table may be crossed, as every
    structure under every record, or drawn, and what they scatter because groups are finite is taken off. What all
    sources leave belongs to their interactions and to what is not among them.

    Parameters
    ----------
    values
        Of n runs; take logarithms of demands, since these scatter by factors.
    sources
        Labels of the runs by name of the source, shape (n,): the columns `motion`, `number` and `model` of a study, for
        example. Each source must have two labels or more, and one of them two runs or more.

    Returns
    -------
    pandas.DataFrame
        A row a source and one for ``"interactions"``: `variance`, `share` of the whole, and the number of `labels`. An
        estimate below zero is left as it is: the share is then too small for so few runs.

    Raises
    ------
    InputError
        If values are not finite or do not differ, or a source has too few labels, or as many as there are runs.

    Examples
    --------
    >>> import numpy as np
    >>> import rockflex as rf
    >>> frames = [rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=period,
    ...     aspect_ratio=8.0, damping_ratio=0.02) for period in (0.4, 0.5, 0.6)]
    >>> runs = rf.simulate_many(frames, rf.load_suite("fema-p695-far-field")[:8],
    ...     scales=2.0)
    >>> shares = rf.variance_shares(np.log(runs["max_rotation"]),
    ...     {"records": runs["motion"], "structure": runs["structure"]})
    >>> shares["labels"].tolist()
    [8, 3, 0]
    """
    import pandas as pd

    y = checked_finite_vector("values", values, "")
    if y.size < 3 or not np.ptp(y) > 0.0:
        raise InputError(
            f"values must be three or more finite numbers that differ, but {shown(values)} was given.", field="values"
        )
    if not sources:
        raise InputError("sources must name one source or more.", field="sources")
    groups = {name: _groups(name, labels, y.size) for name, labels in sources.items()}
    columns = [np.ones((y.size, 1)), *(group[:, None] == np.arange(1, group.max() + 1) for group in groups.values())]
    design = np.concatenate(columns, axis=1).astype(float)
    products, freedom = design.T @ design, y.size - design.shape[1]
    if freedom < 1 or np.linalg.matrix_rank(products, hermitian=True) < design.shape[1]:
        raise InputError(
            f"The labels of {', '.join(groups)} cannot be told apart in {y.size} runs: each label of one source goes "
            "with one of another, or there are too few runs. Give a table in which they are crossed or drawn.",
            field="sources",
        )
    inverse = np.linalg.inv(products)
    effects = inverse @ (design.T @ y)
    left = float(((y - design @ effects) ** 2).sum()) / freedom
    rows, first = dict[str, tuple[float, int]](), 1
    for name, group in groups.items():
        sizes, own = np.bincount(group) / y.size, slice(first, first + int(group.max()))
        first = own.stop
        centred = np.diag(sizes[1:]) - np.outer(sizes[1:], sizes[1:])
        scatter = float(effects[own] @ centred @ effects[own]) - left * float(np.trace(centred @ inverse[own, own]))
        rows[name] = scatter / (1.0 - float(sizes @ sizes)), sizes.size
    rows["interactions"] = left, 0
    whole = sum(max(variance, 0.0) for variance, _ in rows.values())
    table = pd.DataFrame(list(rows.values()), columns=["variance", "labels"], index=pd.Index(rows, name="source"))
    table.insert(1, "share", table["variance"] / whole)
    return table


def _groups(name: str, labels: ArrayLike, count: int) -> NDArray[np.int64]:
    """The number of the label of every run."""
    given = np.asarray(labels)
    if given.shape != (count,):
        raise InputError(
            f"{name} must have {count} labels, one for each value, but {given.size} were given.", field="sources"
        )
    known, group = np.unique(given.astype(str), return_inverse=True)
    if not 1 < known.size < count:
        raise InputError(
            f"{name} must have at least two labels, and fewer than the {count} runs, but it has {known.size}.",
            field="sources",
        )
    return group.astype(np.int64)
