"""Section 3.2: the prototypes of Table 1, their clouds (Figures 5 to 7), and the friction that prevents sliding."""

from collections.abc import Iterable, Mapping
from functools import lru_cache, partial
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import rockflex as rf
from rockflex.foundation.arrays import Array, Bools
from rockflex.papers.silva_stojadinovic_2024 import _comparison as compare
from rockflex.papers.silva_stojadinovic_2024._comparison import (
    WEAKER,
    RemarkKind,
    ResampledInterval,
    bootstrap_intervals,
)
from rockflex.papers.silva_stojadinovic_2024._inputs import MODELS, STRUCTURES, PaperRecords, Piece, table_1_frame
from rockflex.report._document import PublishedNumber, Remark, ReproducedResult

if TYPE_CHECKING:
    import pandas as pd

TABLE_1 = "Parameters of the six 5-story prototypes"
SHEAR_NAMES, FLEXURE_NAMES = (
    tuple(name for name, row in STRUCTURES.items() if row[2] == b) for b in ("shear", "flexure")
)
MASSES = {
    SHEAR_NAMES: ("0.88", "0.09", "0.02", "0.008", "0.002"),
    FLEXURE_NAMES: ("0.68", "0.21", "0.07", "0.03", "0.01"),
}
HEIGHTS = {
    SHEAR_NAMES: ("0.70", "−0.24", "0.15", "−0.12", "0.10"),
    FLEXURE_NAMES: ("0.79", "0.23", "0.14", "0.10", "0.09"),
}
PRINTED: dict[str, dict[tuple[str, ...], str]] = {
    "I_θ/(m*_1 h*_1²)": {("#1", "#3"): "1.03", ("#2", "#4"): "1.05", ("#5",): "1.07", ("#6",): "1.10"},
    "m*_1 h*_1/L_0^r": {SHEAR_NAMES: "1.03", FLEXURE_NAMES: "0.90"},
    **{f"m*_{n}/(5 m_i)": {names: row[n - 1] for names, row in MASSES.items()} for n in range(1, 6)},
    **{f"h*_{n}/h_5": {names: row[n - 1] for names, row in HEIGHTS.items()} for n in range(1, 6)},
}
"""Printed values and the structures that share them, because the shapes do not depend on period or aspect ratio."""
PGV = 0.4  # m/s, for which the text gives the differences
AT_PGV = "Section 3.2, PGV = 0.4 m/s"
THRESHOLD = 1e-4  # rad, above which a run rocks
CLOUD_RESAMPLES = 200
PARTS = ("median", "84 % quantile")
SHEAR = np.array([row[2] == "shear" for row in STRUCTURES.values()])
THIRD_PLACE = list(STRUCTURES).index("#3")
FIGURE_5 = "Fragility curves of rocking"
PLACE = "Section 3.2"
CURVE_RESAMPLES, POINTS = 100, 50
AGREE = "< 0.1"
PANELS = (("#1", "#2"), ("#3", "#4"), ("#5", "#6"))  # of Fig. 5
FIGURE_6 = "Clouds of the rotation of the runs that rock and stand"
ROTATION = "max_rotation"
ROTATION_QUANTILES = "largest difference of the 84 % quantiles of θ_max"
ROTATION_ROWS = (
    ("largest difference of the medians of θ_max", "0.002", "rad", "median, largest", "median"),
    (
        "largest difference of the medians of θ_max over the median of MDOF-S", "15", "%", "median, of the largest",
        "median",
    ),
    (ROTATION_QUANTILES, "0.005", "rad", "84 % quantile, largest", "quantile"),
    (f"{ROTATION_QUANTILES} over that of MDOF-S", "12", "%", "84 % quantile, of the largest", "quantile"),
)  # fmt: skip
FIGURE_7 = "Clouds of the relative top displacement of the runs that rock and stand"
DISPLACEMENT = "max_top_displacement"
MEDIANS, QUANTILES = (
    f"largest relative difference of the {which} of u_top,max" for which in ("medians", "84 % quantiles")
)
DISPLACEMENT_ROWS = (
    (MEDIANS, "19", "%", "median, largest relative", "median_relative"),
    (f"{MEDIANS}, in m", "0.003", "m", "median, of the largest relative", "median_relative"),
    (QUANTILES, "22", "%", "84 % quantile, largest relative", "quantile_relative"),
    (f"{QUANTILES}, in m", "0.004", "m", "84 % quantile, of the largest relative", "quantile_relative"),
)
NEAR = "2DOF-C less 2DOF-S"
THIRD = "relative difference of #3 over the largest of the others"
MEAN = "median of the 2DOF models over that of MDOF-S, mean of three structures"
UNDER = "2DOF models underestimate"
ERROR = "an error in the text: Sections 3.3 and 5 have overestimate, as here"
DISPLACEMENT_STATEMENTS = (
    (THIRD, AT_PGV, "observable for #3", "#3 over the others", "> 1"),
    (
        "2DOF-C less 2DOF-S over the largest difference from MDOF-S", AT_PGV,
        "2DOF-C and 2DOF-S agree well, and differ from MDOF-S", NEAR, "< 0.5",
    ),
    (f"{MEAN}, flexure", "Sections 3.2 and 5", UNDER, "flexure", "< 1"),
    (f"{MEAN}, shear", "Section 3.2", UNDER, "shear", "< 1", ERROR),
    (f"{MEAN}, shear", "Section 5", "2DOF models overestimate", "shear", "> 1"),
)  # fmt: skip
SLIDING = "Friction that prevents sliding of the prototypes"
EVERY = 3  # every third record, because the friction of a run needs its history
FRICTION_RESAMPLES = 400
FRICTION_COSTS = (2.0, 2.4, 2.1, 3.7, 1.8, 2.1)  # s, see Piece
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


def table_1(_: PaperRecords) -> ReproducedResult:
    """Compute the modal properties of every structure."""
    ours = {name: _table_1_modal_values(name) for name in STRUCTURES}
    numbers = [
        _farthest_from_print(quantity, text, {name: ours[name][quantity] for name in names})
        for quantity, row in PRINTED.items()
        for names, text in row.items()
    ]
    note = (
        "T_1 and h*_1/B are input, so they are not among the numbers. A value that the table repeats, because it does "
        "not depend on them, is one number; ours is the value of the structure that differs most from it."
    )
    return ReproducedResult("table-1", TABLE_1, numbers, note=note)


def _table_1_modal_values(name: str) -> dict[str, float]:
    """Return the quantities of the table for a structure."""
    frame = table_1_frame(name)
    p = frame.rocking()
    mass, height = p.effective_mass.tolist(), p.effective_height.tolist()
    lever = mass[0] * height[0]
    mass_above, top = frame.n_stories * frame.story_mass, frame.n_stories * frame.story_height
    found = {"I_θ/(m*_1 h*_1²)": p.i_theta / (lever * height[0]), "m*_1 h*_1/L_0^r": lever / p.l0r}
    for n, (its_mass, its_height) in enumerate(zip(mass, height, strict=True), 1):
        found |= {f"m*_{n}/(5 m_i)": its_mass / mass_above, f"h*_{n}/h_5": its_height / top}
    return found


def _farthest_from_print(quantity: str, printed: str, values: Mapping[str, float]) -> PublishedNumber:
    """Compare the value that differs most from the printed one."""
    place = f"Table 1, {', '.join(values)}"
    lines = [compare.number(quantity, place, printed, value) for value in values.values()]
    return max(lines, key=lambda line: abs(line.difference or 0.0))


def cloud_pieces(_: PaperRecords) -> list[Piece]:
    """Return the runs of Figs. 5 to 7 as a piece, and those under weaker records."""
    return [Piece("cloud", n, 2, 3.0, _cloud_of_paper) for n in range(2)]


def run_cloud_of_paper(records: PaperRecords) -> "pd.DataFrame":
    """Run the six structures with three models under every record, at the scales 1 and 2."""
    return cloud_pieces(records)[0].table(records)


def run_weaker_cloud(records: PaperRecords) -> "pd.DataFrame":
    """Run the same with all records times 0.6."""
    return cloud_pieces(records)[1].table(records)


def _cloud_of_paper(records: PaperRecords, number: int) -> "pd.DataFrame":
    frames = {name: table_1_frame(name) for name in STRUCTURES}
    scales = [(1.0, WEAKER)[number] * scale for scale in SCALES]
    return rf.run_cloud(frames, records.suite, MODELS, scales, workers=records.workers)


@lru_cache(maxsize=4)
def differences_between_models(
    records: PaperRecords, quantity: str, *, weaker: bool = False
) -> dict[str, ResampledInterval]:
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
    """
    im, table, groups = _rocking_runs(run_weaker_cloud(records) if weaker else run_cloud_of_paper(records), quantity)
    names = list(_compared_cloud_fits(_fitted_cloud_quantiles(im, table)))

    def fit(im: Array, table: Array) -> Array:
        return np.array(list(_compared_cloud_fits(_fitted_cloud_quantiles(im, table)).values()))

    return dict(zip(names, bootstrap_intervals(fit, im, table, groups, len(names), CLOUD_RESAMPLES), strict=True))


def cases_of_differences(records: PaperRecords, quantity: str) -> "pd.DataFrame":
    """Differences by structure and 2DOF model, such as ``"#3, 2DOF-S"``.

    The columns are `median` and `quantile`, in the response's unit, and the same over the value of MDOF-S,
    `median_relative` and `quantile_relative`; the quantile is that of 84 %.
    """
    import pandas as pd

    im, table, _ = _rocking_runs(run_cloud_of_paper(records), quantity)
    away, shares = (each.reshape(-1, len(PARTS)) for each in _differences_from_mdof(_fitted_cloud_quantiles(im, table)))
    names = [f"{name}, {model}" for name in STRUCTURES for model in MODELS[1:]]
    columns = ["median", "quantile", "median_relative", "quantile_relative"]
    return pd.DataFrame(np.column_stack((away, shares)), names, columns)


def largest_model_differences(
    records: PaperRecords, quantity: str, rows: Iterable[tuple[str, str, str, str, str]]
) -> list[PublishedNumber]:
    """Compare some `differences_between_models`, and note where they are largest.

    Each row has the name, the printed value and its unit, the name of the difference, and the column of
    `cases_of_differences` whose largest value tells where it is.
    """
    found, weaker = (differences_between_models(records, quantity, weaker=each) for each in (False, True))
    at, in_unit = cases_of_differences(records, quantity).idxmax(), {"%": 100.0}
    return [
        compare.statistic(
            name, AT_PGV, printed, found[key].times(in_unit.get(unit, 1.0)), unit,
            weaker=weaker[key].times(in_unit.get(unit, 1.0)), note=str(at[column]),
        )
        for name, printed, unit, key, column in rows
    ]  # fmt: skip


def _rocking_runs(runs: "pd.DataFrame", quantity: str) -> tuple[Array, Array, "NDArray[np.str_]"]:
    """Return PGV, a code of the case with the response, and the recording, of the runs that rock and stand."""
    kept = runs[(runs["status"] == "rocking") & (runs["max_rotation"] > THRESHOLD)]
    table = np.column_stack((case_codes(kept), kept[quantity].to_numpy(dtype=float)))
    return kept["pgv"].to_numpy(dtype=float), table, kept["group"].astype(str).to_numpy(dtype=np.str_)


def case_codes(runs: "pd.DataFrame") -> Array:
    """Return the number of the case, a structure with a model, of each run."""
    code = {name + model: float(number) for number, (name, model) in enumerate(product(STRUCTURES, MODELS))}
    return np.array([code[name] for name in runs["structure"].astype(str) + runs["model"].astype(str)], dtype=float)


def _fitted_cloud_quantiles(im: Array, rows: Array) -> Array:
    """Median and 84 % quantile by structure and model."""
    shape = (len(STRUCTURES), len(MODELS), len(PARTS))
    every = (rows[:, 0] == i for i in range(shape[0] * shape[1]))
    fits = [rf.fit_cloud(im[mine], rows[mine, 1]) for mine in every]
    return np.array([(fit.median(PGV), fit.quantile(PGV, 0.84)) for fit in fits], dtype=float).reshape(shape)


def _differences_from_mdof(fits: Array) -> tuple[Array, Array]:
    """Absolute and relative differences of the 2DOF models from MDOF-S."""
    return np.abs(fits[:, 1:] - fits[:, :1]), np.abs(fits[:, 1:] / fits[:, :1] - 1.0)


def _compared_cloud_fits(fits: Array) -> Mapping[str, float]:
    """Return the values of `differences_between_models` for one set of fits."""
    away, shares = _differences_from_mdof(fits)
    found: dict[str, float] = {}
    for place, part in enumerate(PARTS):
        absolute, relative = away[..., place].ravel(), shares[..., place].ravel()
        most, worst = int(absolute.argmax()), int(relative.argmax())
        found[f"{part}, largest"], found[f"{part}, of the largest"] = absolute[most], relative[most]
        found[f"{part}, largest relative"], found[f"{part}, of the largest relative"] = relative[worst], absolute[worst]
    by_structure, ratios = shares[..., 0].max(axis=1), fits[:, 1:, 0] / fits[:, :1, 0]
    return found | {
        "#3 over the others": by_structure[THIRD_PLACE] / np.delete(by_structure, THIRD_PLACE).max(),
        NEAR: np.abs(ratios[:, 0] - ratios[:, 1]).max() / by_structure.max(),
        "shear": ratios[SHEAR].mean(),
        "flexure": ratios[~SHEAR].mean(),
    }


def figure_5(records: PaperRecords) -> ReproducedResult:
    """Fit the curves, and find the largest differences between the models."""
    runs = run_cloud_of_paper(records)
    weaker = run_weaker_cloud(records)
    (shear, flexure, more), (of_shear, of_flexure, of_more) = map(_largest_probability_gaps, (runs, weaker))
    words = "the curves agree well"
    numbers = (
        compare.tendency(
            "largest difference of P between MDOF-S and a 2DOF model, shear", PLACE, words, shear, AGREE,
            reading=True, weaker=of_shear,
        ),
        compare.tendency(
            "largest difference of P between MDOF-S and a 2DOF model, flexure", PLACE, words, flexure, AGREE,
            reading=True, weaker=of_flexure, note=_runs_without_rocking(runs),
        ),
        compare.tendency(
            "largest difference of P between MDOF-S and a 2DOF model, flexure less shear", PLACE,
            "largest differences for flexure-dominant structures", more, "> 0", weaker=of_more,
        ),
    )  # fmt: skip
    note = (
        "P(θ_max > 10⁻⁴ rad) by logistic regression on log PGV, up to the PGV of the records. These records are "
        "stronger than those of the paper: if (almost) all runs rock, a curve is flat or depends on a few runs. "
        f"Intervals are over resampled records; what misses is looked at again with all records times {WEAKER}."
    )
    figures = {"figure-5": lambda: rf.plot_fragility(runs, together=PANELS)}
    return ReproducedResult("figure-5", FIGURE_5, numbers, figures, note)


def _largest_probability_gaps(runs: "pd.DataFrame") -> list[ResampledInterval]:
    """Return the largest difference of P from MDOF-S: for shear, for flexure, and flexure minus shear."""
    pgv, rocks = runs["pgv"].to_numpy(dtype=float), (runs["max_rotation"] > THRESHOLD).to_numpy(dtype=bool)
    grid = np.geomspace(pgv.min(), pgv.max(), POINTS)
    rows = np.column_stack((case_codes(runs), rocks))

    def fit(im: Array, drawn: Array) -> Array:
        every = (drawn[:, 0] == i for i in range(SHEAR.size * len(MODELS)))
        curves = np.array([_rocking_probability_curve(im[mine], drawn[mine, 1] > 0.0, grid) for mine in every])
        of = curves.reshape(SHEAR.size, len(MODELS), -1)
        gaps = np.abs(of[:, 1:] - of[:, :1]).max(axis=(1, 2))
        shear, flexure = gaps[SHEAR].max(), gaps[~SHEAR].max()
        return np.array([shear, flexure, flexure - shear])

    return bootstrap_intervals(fit, pgv, rows, runs["group"].astype(str).to_numpy(), 3, CURVE_RESAMPLES)


def _rocking_probability_curve(pgv: Array, rocks: Bools, grid: Array) -> Array:
    """Return the probability on the grid; constant if all runs have the same outcome."""
    if rocks.all() or not rocks.any():
        return np.full(grid.size, float(rocks[0]))
    return rf.fit_logistic(pgv, rocks).probability(grid)


def _runs_without_rocking(runs: "pd.DataFrame") -> str:
    """Show how few runs support the curves of #2, which differ the most."""
    still = runs[(runs["structure"] == "#2") & (runs["max_rotation"] <= THRESHOLD)]
    counts = still["model"].astype(str).value_counts()
    of = len(runs[(runs["structure"] == "#2") & (runs["model"] == "MDOF-S")])
    each = ", ".join(f"{counts.get(model, 0)} with {model}" for model in MODELS)
    return f"the curves of #2 depend on the runs that do not rock: {each}, of {of}"


def figure_6(records: PaperRecords) -> ReproducedResult:
    """Run the cloud, and compare the models' regressions."""
    runs = run_cloud_of_paper(records)
    note = (
        "Differences of 2DOF-C or 2DOF-S from MDOF-S, for the structure and model where they are largest in rad. We "
        "interpret the text so: 0.002 rad are 15 % of a median of 0.013 rad, where the differences are not "
        "relatively largest. Intervals are over resampled recordings, with all of their runs."
    )
    figures = {"figure-6": lambda: rf.plot_clouds(runs, ROTATION, plain=True)}
    return ReproducedResult(
        "figure-6",
        FIGURE_6,
        largest_model_differences(records, ROTATION, ROTATION_ROWS),
        figures,
        note,
        remarking=(partial(_readings_of_differences, records),),
    )


def _readings_of_differences(records: PaperRecords) -> Remark:
    """Show the differences where they are largest, absolutely and relatively."""
    at = cases_of_differences(records, ROTATION)
    where = {part: str(place) for part, place in at.idxmax().items()}
    reasons = {
        "median": "largest of the medians, in rad",
        "quantile": "largest of the 84 % quantiles, in rad",
        "median_relative": "relatively largest of the medians",
        "quantile_relative": "relatively largest of the 84 % quantiles",
    }
    rows: list[tuple[str, ...]] = [("the paper", "", "0.002 rad (15 %)", "0.005 rad (12 %)")]
    for reason, words in reasons.items():
        row = at.loc[where[reason]]
        cells = [f"{row[part]:.5f} rad ({100.0 * row[part + '_relative']:.1f} %)" for part in ("median", "quantile")]
        rows.append((where[reason], words, *cells))
    return Remark(
        RemarkKind.BESIDE,
        "Which difference is the largest",
        "One line for each structure and model. The last two lines interpret the text by the largest relative "
        "difference.",
        ("structure and model", "where the difference is", "medians", "84 % quantiles"),
        rows,
    )


def figure_7(records: PaperRecords) -> ReproducedResult:
    """Run the cloud, and compare the models' regressions."""
    runs = run_cloud_of_paper(records)
    found, weaker = (differences_between_models(records, DISPLACEMENT, weaker=each) for each in (False, True))
    numbers = largest_model_differences(records, DISPLACEMENT, DISPLACEMENT_ROWS)
    numbers += [
        compare.tendency(
            name, place, words, found[key], bound, reading=key == NEAR, weaker=weaker[key], note="".join(note)
        )
        for name, place, words, key, bound, *note in DISPLACEMENT_STATEMENTS
    ]
    note = (
        "Differences of 2DOF-C or 2DOF-S from MDOF-S, for the structure and model where they are relatively largest: "
        "the text gives per cent first, and names #3. Intervals are over resampled recordings with all of their runs."
    )
    return ReproducedResult(
        "figure-7", FIGURE_7, numbers, {"figure-7": lambda: rf.plot_clouds(runs, DISPLACEMENT, plain=True)}, note
    )


def sliding(records: PaperRecords) -> ReproducedResult:
    """Run the structures under every third record, and compare medians of the required friction."""
    found = friction_intervals(_friction_runs(records), MODEL, "printed")
    numbers = [
        compare.tendency(f"median of the required friction, least ratio: {name}", PLACE, words, found[name], "> 1")
        for name, words in WORDS.items()
    ]
    numbers.append(compare.tendency(ABOVE, PLACE, "cases higher than 1.0", found[ABOVE], "> 0"))
    note = (
        f"{MODEL}, every third record unscaled ({len(records.suite[::EVERY])} records), runs that rock and stand; "
        "Eqs. 20-22, with Eq. 22 as it is printed. Intervals are over resampled records."
    )
    return ReproducedResult(
        "sliding",
        SLIDING,
        numbers,
        note=note,
        remarking=(partial(_both_signs_of_friction, records), partial(_count_of_pivot_lifts, records)),
    )


def friction_pieces(_: PaperRecords) -> list[Piece]:
    """Return the runs of each structure as a piece; friction takes longer where modes are faster."""
    return [
        Piece("friction", n, len(STRUCTURES), cost, _friction_of_structure) for n, cost in enumerate(FRICTION_COSTS)
    ]


def _friction_runs(records: PaperRecords) -> "pd.DataFrame":
    """Return the required friction of every run that rocks and stands, with both signs of Eq. 22."""
    import pandas as pd

    return pd.concat([piece.table(records) for piece in friction_pieces(records)], ignore_index=True)


def _friction_of_structure(records: PaperRecords, number: int) -> "pd.DataFrame":
    import pandas as pd

    suite, name = records.suite[::EVERY], list(STRUCTURES)[number]
    frame = table_1_frame(name)  # one for all runs, which share what is prepared for it
    recordings = rf.group_stations(suite)
    groups = {motion.name: each.name for each in recordings for motion in each.horizontal}
    rows: list[dict[str, str | float]] = []
    for model in MODELS:
        for motion in suite:
            response = rf.simulate(frame, motion, model)
            if response.status == "rocking":
                printed = response.required_friction_excluding_impacts(0.0, printed=True)
                row = {"model": model, "structure": name, "group": groups[motion.name]}
                rows.append(row | {"printed": printed, "mended": response.required_friction})
    return pd.DataFrame(rows, columns=["model", "structure", "group", "printed", "mended"])


def friction_intervals(runs: "pd.DataFrame", model: str, sign: str) -> dict[str, ResampledInterval]:
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
    found = bootstrap_intervals(fit, friction, codes, mine["group"].to_numpy(), len(PAIRS) + 1, FRICTION_RESAMPLES)
    return dict(zip((*PAIRS, ABOVE), found, strict=True))


def _both_signs_of_friction(records: PaperRecords) -> Remark:
    """Repeat this with the corrected sign of the weight and with the other models."""
    rows: list[tuple[str, ...]] = []
    above: dict[str, list[str]] = {sign: [] for sign in SIGNS}
    for sign, words in SIGNS.items():
        for model in MODELS:
            found = friction_intervals(_friction_runs(records), model, sign)
            above[sign] += [model] * (found["shear over flexure"].estimate > 1.0)
            cells = [f"{found[name].estimate:.2f}" for name in PAIRS]
            rows.append((words, model, *cells, f"{found[ABOVE].estimate:.0f}"))
    return Remark(
        RemarkKind.BESIDE,
        "Both signs of the weight in Eq. 22",
        "Eq. 22 is printed with −g + z''_i, in which one sign is wrong. As printed, shear-dominant buildings are more "
        f"prone to sliding than flexural ones with {_listed_models(above['printed'])}; with the corrected sign, with "
        f"{_listed_models(above['mended'])}."
        + " The conclusion of the paper depends on this misprint."
        * (MODEL in above["printed"] and not above["mended"]),
        ("Eq. 22", "model", *(f"least ratio, {name}" for name in PAIRS), ABOVE),
        rows,
    )


def _count_of_pivot_lifts(records: PaperRecords) -> Remark:
    """Count the runs in which the pivot would lift."""
    frames = [table_1_frame(name) for name in STRUCTURES]
    runs = rf.simulate_many(
        frames, records.suite[::EVERY], MODELS, scales=SCALES, free_vibration="settle", workers=records.workers
    )
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
        RemarkKind.BESIDE,
        "Runs in which the pivot would lift",
        "Of the runs that rock and stand under every third record, those in which the vertical reaction falls below "
        "zero: the model pulls the base down, but the ground cannot, and no friction is enough. The paper does not "
        "mention them. They are in its clouds and in ours.",
        ("structure", *(f"{model}, × {scale:g}" for model in MODELS for scale in SCALES)),
        rows,
    )


def _listed_models(models: list[str]) -> str:
    return " and ".join(models) or "no model"
