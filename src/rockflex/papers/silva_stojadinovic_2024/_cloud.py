"""The cloud of Section 3.2, which Figures 5 to 7 share, and how its models differ at PGV = 0.4 m/s."""

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import MODELS, STRUCTURES, frame_of

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["PGV", "THRESHOLD", "Differences", "cloud", "differences", "percent"]

Array = NDArray[np.float64]

PGV = 0.4  # m/s, at which the text gives its differences
THRESHOLD = 1e-4  # rad, above which a run rocks
RESAMPLES = 200


@lru_cache(maxsize=1)
def cloud(records: Records) -> "pd.DataFrame":
    """Run the six structures with three models under every record as it is and times two."""
    frames = {name: frame_of(name) for name in STRUCTURES}
    return rf.run_cloud(frames, records.suite, MODELS, (1.0, 2.0))


@dataclass(frozen=True, eq=False)
class Differences:
    """What the 2DOF models say at PGV = 0.4 m/s less what MDOF-S does, each with its 90 % interval (low, high).

    Records are resampled whole, with both components, both scales, all structures and all models.
    """

    median: tuple[float, float, float]
    """Difference of medians, in the response's unit, of the structure and 2DOF model where it is relatively largest."""
    median_relative: tuple[float, float, float]
    quantile: tuple[float, float, float]
    """The same of the 84 % quantiles."""
    quantile_relative: tuple[float, float, float]
    ratios: dict[tuple[str, str], float]
    """Median of a 2DOF model over that of MDOF-S, by structure and model."""


@lru_cache(maxsize=2)
def differences(records: Records, quantity: str) -> Differences:
    """Compare the fits of a response, ``"max_rotation"`` or ``"max_top_displacement"``.

    Raises
    ------
    InputError
        If too few runs rocked for a fit.
    """
    runs = cloud(records)
    kept = runs[(runs["status"] == "rocking") & (runs["max_rotation"] > THRESHOLD)]
    keys = [(name, model) for name in STRUCTURES for model in MODELS]
    code = {key: number for number, key in enumerate(keys)}
    names, models = kept["structure"].astype(str), kept["model"].astype(str)
    codes = np.array([code[key] for key in zip(names, models, strict=True)], dtype=float)
    table = np.column_stack((codes, kept[quantity].to_numpy(dtype=float)))

    def fit(im: Array, rows: Array) -> Array:
        fits = [rf.fit_cloud(im[mine], rows[mine, 1]) for mine in (rows[:, 0] == i for i in range(len(keys)))]
        return np.array([(each.median(PGV), each.quantile(PGV, 0.84)) for each in fits], dtype=float)

    def curve(found: Array, at: Array) -> Array:
        of = found.reshape(len(STRUCTURES), len(MODELS), 2)
        away, relative = np.abs(of[:, 1:] - of[:, :1]), np.abs(of[:, 1:] / of[:, :1] - 1.0)
        pairs = [(away[..., i].flat[place], relative[..., i].flat[place]) for i, place in enumerate(_worst(relative))]
        return np.concatenate((np.ravel(pairs), (of[:, 1:, 0] / of[:, :1, 0]).ravel()))[at.astype(int)]

    n = 4 + len(STRUCTURES) * (len(MODELS) - 1)
    band = rf.bootstrap_band(
        fit, kept["pgv"].to_numpy(dtype=float), table, kept["group"].astype(str).to_numpy(), at=np.arange(n),
        n=RESAMPLES, curve=curve,
    )  # fmt: skip
    three = [(float(e), float(a), float(b)) for e, a, b in zip(band.estimate, band.low, band.high, strict=True)]
    others = [(name, model) for name in STRUCTURES for model in MODELS[1:]]
    ratios = {key: value[0] for key, value in zip(others, three[4:], strict=True)}
    return Differences(three[0], three[1], three[2], three[3], ratios)


def _worst(relative: Array) -> list[int]:
    """Place of the structure and model with the largest relative difference, of medians and of quantiles."""
    return [int(relative[..., i].argmax()) for i in range(2)]


def percent(values: tuple[float, float, float]) -> tuple[float, float, float]:
    """Return estimate, low and high in per cent."""
    estimate, low, high = values
    return 100.0 * estimate, 100.0 * low, 100.0 * high
