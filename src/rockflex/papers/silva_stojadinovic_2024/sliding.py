"""The friction that prevents sliding of the prototypes of Table 1 (end of Section 3.2)."""

from functools import lru_cache, partial
from typing import TYPE_CHECKING

import numpy as np

import rockflex as rf
from rockflex._arrays import Array
from rockflex.papers.silva_stojadinovic_2024._number import Interval, intervals_of, tendency
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import MODELS, STRUCTURES, frame_of
from rockflex.papers.silva_stojadinovic_2024._verdict import Kind
from rockflex.report import Remark, Result

if TYPE_CHECKING:
    import pandas as pd


TITLE = "Friction that prevents sliding of the prototypes"
PLACE = "Section 3.2"
EVERY = 3  # every third record, because the friction of a run needs its history
RESAMPLES = 400
SCALES = (1.0, 2.0)
MODEL = "2DOF-C"  # with which Section 3.1 checks for sliding
SIGNS = {"printed": "as printed", "mended": "N = Σ m_i (g + z''_i)"}
PAIRS = {
    "h*_1/B = 5 over 10": {"#5": "#1", "#6": "#2"},
    "T_1 = 0.5 s over 1 s": {"#3": "#1", "#4": "#2"},
    "shear over flexure": {"#1": "#2", "#3": "#4", "#5": "#6"},
}
WORDS = {
    "h*_1/B = 5 over 10": "lower aspect ratios are more prone to sliding",
    "T_1 = 0.5 s over 1 s": "shorter periods are more prone to sliding",
    "shear over flexure": "shear-dominant buildings are more prone to sliding",
}
ABOVE = "runs that need more than 1.0"


def reproduce(records: Records) -> Result:
    """Run the structures under every third record, and compare medians of the required friction."""
    found = _intervals(_runs(records), MODEL, "printed")
    numbers = [
        tendency(f"median of the required friction, least ratio: {name}", PLACE, words, found[name], "> 1")
        for name, words in WORDS.items()
    ]
    numbers.append(tendency(ABOVE, PLACE, "cases higher than 1.0", found[ABOVE], "> 0"))
    note = (
        f"{MODEL}, every third record unscaled ({len(records.suite[::EVERY])} records), runs that rock and stand; "
        "Eqs. 20-22, with Eq. 22 as it is printed. Intervals are over resampled records."
    )
    return Result(
        "sliding", TITLE, numbers, note=note, remarking=(partial(_both_signs, records), partial(_lifts, records))
    )


@lru_cache(maxsize=1)
def _runs(records: Records) -> "pd.DataFrame":
    """Return the required friction of every run that rocks and stands, with both signs of Eq. 22."""
    import pandas as pd

    suite = records.suite[::EVERY]
    groups = rf.run_cloud(frame_of("#1"), suite, MODEL).set_index("motion")["group"].astype(str).to_dict()
    rows: list[dict[str, str | float]] = []
    for model in MODELS:
        for name in STRUCTURES:
            for motion in suite:
                response = rf.simulate(frame_of(name), motion, model)
                if response.status == "rocking":
                    printed = response.required_friction_excluding_impacts(0.0, printed=True)
                    row = {"model": model, "structure": name, "group": groups[motion.name]}
                    rows.append(row | {"printed": printed, "mended": response.required_friction})
    return pd.DataFrame(rows)


def _intervals(runs: "pd.DataFrame", model: str, sign: str) -> dict[str, Interval]:
    """Return the smallest ratio of medians of each statement, and the number of runs that need more than 1."""
    mine = runs[runs["model"] == model]
    codes = mine["structure"].map({name: place for place, name in enumerate(STRUCTURES)}).to_numpy(dtype=float)
    names = list(STRUCTURES)

    def fit(friction: Array, structure: Array) -> Array:
        medians = [float(np.median(friction[structure == place])) for place in range(len(names))]
        median = dict(zip(names, medians, strict=True))
        ratios = [min(median[one] / median[other] for one, other in pairs.items()) for pairs in PAIRS.values()]
        return np.array([*ratios, float((friction > 1.0).sum())])

    # Infinite where the ground would have to pull; large enough for a median or a count.
    friction = np.minimum(mine[sign].to_numpy(dtype=float), 1e6)
    band = rf.bootstrap_band(
        fit, friction, codes, mine["group"].to_numpy(), at=np.arange(len(PAIRS) + 1), n=RESAMPLES,
        curve=lambda values, _: values,
    )  # fmt: skip
    return dict(zip((*PAIRS, ABOVE), intervals_of(band), strict=True))


def _both_signs(records: Records) -> Remark:
    """Repeat this with the corrected sign of the weight and with the other models."""
    rows: list[tuple[str, ...]] = []
    above: dict[str, list[str]] = {sign: [] for sign in SIGNS}
    for sign, words in SIGNS.items():
        for model in MODELS:
            found = _intervals(_runs(records), model, sign)
            above[sign] += [model] * (found["shear over flexure"].estimate > 1.0)
            cells = [f"{found[name].estimate:.2f}" for name in PAIRS]
            rows.append((words, model, *cells, f"{found[ABOVE].estimate:.0f}"))
    return Remark(
        Kind.BESIDE,
        "Both signs of the weight in Eq. 22",
        "Eq. 22 is printed with −g + z''_i, in which one sign is wrong. As printed, shear-dominant buildings are more "
        f"prone to sliding than flexural ones with {_listed(above['printed'])}; with the corrected sign, with "
        f"{_listed(above['mended'])}."
        + " The conclusion of the paper depends on this misprint."
        * (MODEL in above["printed"] and not above["mended"]),
        ("Eq. 22", "model", *(f"least ratio, {name}" for name in PAIRS), ABOVE),
        rows,
    )


def _lifts(records: Records) -> Remark:
    """Count the runs in which the pivot would lift."""
    frames = [frame_of(name) for name in STRUCTURES]
    runs = rf.simulate_many(frames, records.suite[::EVERY], MODELS, scales=SCALES, free_vibration="settle")
    standing = runs[runs["status"] == "rocking"]
    lifted = standing["min_vertical_reaction"] < 0.0
    rows: list[tuple[str, ...]] = []
    for place, name in enumerate(STRUCTURES):
        cells: list[str] = []
        for model in MODELS:
            for scale in SCALES:
                chosen = (standing["structure"] == place) & (standing["model"] == model) & (standing["scale"] == scale)
                cells.append(f"{int(lifted[chosen].sum())} of {int(chosen.sum())}")
        rows.append((name, *cells))
    return Remark(
        Kind.BESIDE,
        "Runs in which the pivot would lift",
        "Of the runs that rock and stand under every third record, those in which the vertical reaction falls below "
        "zero: the model pulls the base down, but the ground cannot, and no friction is enough. The paper does not "
        "mention them. They are in its clouds and in ours.",
        ("structure", *(f"{model}, × {scale:g}" for model in MODELS for scale in SCALES)),
        rows,
    )


def _listed(models: list[str]) -> str:
    return " and ".join(models) or "no model"
