"""The population of Section 3.3 as a kind of study: its command, report and figures."""

from typing import Any

from rockflex.report._study_kinds import table_rows
from rockflex.studies._study_kind import Document, Figures, Remark, Runs, StudyFindings, StudyKind

INTERVALS = ["n", "r2", "r2_low", "r2_high", "slope", "slope_low", "slope_high", "r2_line"]
OUTLIER = [
    *("behaviour", "motion", "pair", "n_stories", "aspect_ratio", "period", "pgv"),
    *("max_rotation_mdof", "max_rotation_2dof", "share"),
]


def _report_population(_: Any, pairs: Runs, found: StudyFindings) -> None:
    from rockflex.papers.silva_stojadinovic_2024.population._statistics import population_statistics

    said = population_statistics(pairs)
    for title, table in (
        ("Pairs by outcome", said.outcomes.reset_index(names="MDOF-S \\ 2DOF-S")),
        (
            "MDOF-S against 2DOF-S (Section 3.3), 90 % intervals",
            said.agreement[["group", "quantity", "behaviour", *INTERVALS]],
        ),
        ("Modal combination (Section 3.4), 90 % intervals", said.combination[["quantity", "estimate", *INTERVALS]]),
        ("Largest disagreements in rotation", said.outliers[OUTLIER]),
    ):
        found.tables[title] = table_rows(table)


def _figures_population(_: Document, pairs: Runs, __: str, ___: Remark) -> Figures:
    from rockflex.papers.silva_stojadinovic_2024.population import plots

    yield "population", lambda: plots.plot_population(pairs)
    yield "agreement", lambda: plots.plot_agreement(pairs)
    yield "modal_combination", lambda: plots.plot_modal_combination(pairs)


def _runs_population(pairs: Runs) -> Runs:
    import pandas as pd

    models = []
    for model, suffix in (("MDOF-S", "_mdof"), ("2DOF-S", "_2dof")):
        names = {name: str(name).removesuffix(suffix) for name in pairs if str(name).endswith(suffix)}
        models.append(pairs[[*names]].rename(columns=names).assign(structure="Population", model=model))
    return pd.concat(models, ignore_index=True)


POPULATION = StudyKind(
    name="population",
    command="population",
    summary="Run random structures under random records with MDOF-S and 2DOF-S, and compare the two.",
    described_by="rockflex.papers.silva_stojadinovic_2024.population.PopulationStudy",
    report=_report_population,
    figures=_figures_population,
    runs=_runs_population,
)
