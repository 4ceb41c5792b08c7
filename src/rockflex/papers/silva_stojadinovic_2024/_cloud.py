"""The cloud of Section 3.2, which Figures 5 to 7 share, and the differences of its models at PGV = 0.4 m/s."""

from collections.abc import Iterable, Mapping
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import rockflex as rf
from rockflex._arrays import Array
from rockflex.papers.silva_stojadinovic_2024._number import Interval, intervals_of, statistic
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import MODELS, STRUCTURES, frame_of
from rockflex.report import Number

if TYPE_CHECKING:
    import pandas as pd


PGV = 0.4  # m/s, for which the text gives the differences
PLACE = "Section 3.2, PGV = 0.4 m/s"
THRESHOLD = 1e-4  # rad, above which a run rocks
RESAMPLES = 200
PARTS = ("median", "84 % quantile")
SHEAR = np.array([row[2] == "shear" for row in STRUCTURES.values()])
THIRD = list(STRUCTURES).index("#3")


@lru_cache(maxsize=1)
def cloud(records: Records) -> "pd.DataFrame":
    """Run the six structures with three models under every record, at the scales 1 and 2."""
    frames = {name: frame_of(name) for name in STRUCTURES}
    return rf.run_cloud(frames, records.suite, MODELS, (1.0, 2.0))


@lru_cache(maxsize=2)
def differences(records: Records, quantity: str) -> dict[str, Interval]:
    """Compare the fits of a response, ``"max_rotation"`` or ``"max_top_displacement"``, at PGV = 0.4 m/s.

    Records are resampled whole, with both components, both scales, all structures and all models.

    Returns
    -------
    dict of str to Interval
        Of the 2DOF models against MDOF-S, each for ``"median"`` and ``"84 % quantile"``: the largest absolute
        difference in the response's unit (``"median, largest"``) and the same over the value of MDOF-S (``"median, of
        the largest"``); the largest relative difference (``"median, largest relative"``) and the same in the response's
        unit (``"median, of the largest relative"``). Of the medians only: ``"#3 over the others"``, the largest
        relative difference of #3 over that of all others; ``"2DOF-C less 2DOF-S"``, their largest difference over the
        largest relative one; ``"shear"`` and ``"flexure"``, the mean ratio of a 2DOF model to MDOF-S.

    Raises
    ------
    InputError
        If too few runs rocked for a fit.
    """
    im, table, groups = _kept(records, quantity)
    names = list(_compare(_fit(im, table)))
    band = rf.bootstrap_band(
        _fit, im, table, groups, at=np.arange(len(names)), n=RESAMPLES,
        curve=lambda fits, _: np.array(list(_compare(fits).values())),
    )  # fmt: skip
    return dict(zip(names, intervals_of(band), strict=True))


def places(records: Records, quantity: str) -> "pd.DataFrame":
    """Differences by structure and 2DOF model, such as ``"#3, 2DOF-S"``.

    The columns are `median` and `quantile`, in the response's unit, and the same over the value of MDOF-S,
    `median_relative` and `quantile_relative`; the quantile is that of 84 %.
    """
    import pandas as pd

    im, table, _ = _kept(records, quantity)
    away, shares = (each.reshape(-1, len(PARTS)) for each in _away(_fit(im, table)))
    names = [f"{name}, {model}" for name in STRUCTURES for model in MODELS[1:]]
    columns = ["median", "quantile", "median_relative", "quantile_relative"]
    return pd.DataFrame(np.column_stack((away, shares)), names, columns)


def largest(records: Records, quantity: str, rows: Iterable[tuple[str, str, str, str, str]]) -> list[Number]:
    """Compare some `differences`, and note where they are largest.

    Each row has the name, the printed value and its unit, the name of the difference, and the column of `places` whose
    largest value tells where it is.
    """
    found, at = differences(records, quantity), places(records, quantity).idxmax()
    return [
        statistic(name, PLACE, printed, found[key].times(100.0 if unit == "%" else 1.0), unit, note=str(at[column]))
        for name, printed, unit, key, column in rows
    ]


def _kept(records: Records, quantity: str) -> tuple[Array, Array, "NDArray[np.str_]"]:
    """Return PGV, a code of the case with the response, and the recording, of the runs that rock and stand."""
    runs = cloud(records)
    kept = runs[(runs["status"] == "rocking") & (runs["max_rotation"] > THRESHOLD)]
    table = np.column_stack((codes_of(kept), kept[quantity].to_numpy(dtype=float)))
    return kept["pgv"].to_numpy(dtype=float), table, kept["group"].astype(str).to_numpy(dtype=np.str_)


def codes_of(runs: "pd.DataFrame") -> Array:
    """Return the number of the case, a structure with a model, of each run."""
    code = {name + model: float(number) for number, (name, model) in enumerate(product(STRUCTURES, MODELS))}
    return np.array([code[name] for name in runs["structure"].astype(str) + runs["model"].astype(str)], dtype=float)


def _fit(im: Array, rows: Array) -> Array:
    """Median and 84 % quantile by structure and model."""
    shape = (len(STRUCTURES), len(MODELS), len(PARTS))
    every = (rows[:, 0] == i for i in range(shape[0] * shape[1]))
    fits = [rf.fit_cloud(im[mine], rows[mine, 1]) for mine in every]
    return np.array([(fit.median(PGV), fit.quantile(PGV, 0.84)) for fit in fits], dtype=float).reshape(shape)


def _away(fits: Array) -> tuple[Array, Array]:
    """Absolute and relative differences of the 2DOF models from MDOF-S."""
    return np.abs(fits[:, 1:] - fits[:, :1]), np.abs(fits[:, 1:] / fits[:, :1] - 1.0)


def _compare(fits: Array) -> Mapping[str, float]:
    """Return the values of `differences` for one set of fits."""
    away, shares = _away(fits)
    found: dict[str, float] = {}
    for place, part in enumerate(PARTS):
        absolute, relative = away[..., place].ravel(), shares[..., place].ravel()
        most, worst = int(absolute.argmax()), int(relative.argmax())
        found[f"{part}, largest"], found[f"{part}, of the largest"] = absolute[most], relative[most]
        found[f"{part}, largest relative"], found[f"{part}, of the largest relative"] = relative[worst], absolute[worst]
    by_structure, ratios = shares[..., 0].max(axis=1), fits[:, 1:, 0] / fits[:, :1, 0]
    return found | {
        "#3 over the others": by_structure[THIRD] / np.delete(by_structure, THIRD).max(),
        "2DOF-C less 2DOF-S": np.abs(ratios[:, 0] - ratios[:, 1]).max() / by_structure.max(),
        "shear": ratios[SHEAR].mean(),
        "flexure": ratios[~SHEAR].mean(),
    }
