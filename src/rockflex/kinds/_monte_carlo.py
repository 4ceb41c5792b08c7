"""The Monte Carlo simulation: its random structures, and the cloud of their runs."""

from typing import Any

from rockflex._shown import counted
from rockflex.kinds import _cloud
from rockflex.kinds._kind import Findings, Runs, StudyKind


def _report(study: Any, runs: Runs, found: Findings) -> None:
    structures = runs.drop_duplicates("number")
    lost = int(structures["weight"].isna().sum())
    if lost:
        found.remarks.append(f"{lost} of {len(structures)} structures cannot be built; their runs have an error")
    found.tables[f"Values of {counted(len(structures), 'random structure')}"] = [
        {"variable": name, "least": values.min(), "median": values.median(), "largest": values.max()}
        for name in (*study.variables, "recentring_ratio")
        for values in (structures[name],)
    ]
    _cloud.report(study, runs, found)


MONTE_CARLO = StudyKind(
    name="monte_carlo",
    command="monte-carlo",
    summary="Run random structures under the records, and fit regressions and fragility curves of all of them.",
    described_by="rockflex.study.monte_carlo.MonteCarloStudy",
    report=_report,
    figures=_cloud.figures,
    measured=True,
)
