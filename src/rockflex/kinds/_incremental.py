"""The incremental dynamic analysis: its capacities."""

from typing import Any

from rockflex.kinds._kind import Document, Figures, Findings, Remark, Runs, StudyKind


def _report(study: Any, runs: Runs, found: Findings) -> None:
    from rockflex._cases import cases
    from rockflex.fragility import LIMIT_STATES, fit_capacities
    from rockflex.motion import MEASURES
    from rockflex.study.incremental import incremental_capacities

    rows = []
    for measure in (MEASURES["pga"], MEASURES["pgv"]):
        capacities = incremental_capacities(runs, measure.name).dropna(subset=["capacity"])
        for structure, model, each in cases(capacities):
            what = f"{structure} with {model}, {measure.label}"
            fit = found.fitted(lambda each=each: fit_capacities(each["capacity"], each["censored"]), what)
            rows.append(
                {
                    "structure": structure,
                    "model": model,
                    "measure": measure.label,
                    "records": len(each),
                    "never overturned": int(each["censored"].sum()),
                    "resurrections": int(each["resurrections"].sum()),
                    "median [SI]": fit and fit.median,
                    "β": fit and fit.beta,
                }
            )
    found.tables[f"Capacities to {LIMIT_STATES[study.limit].rotation}, lognormal"] = rows


def _figures(_: Document, runs: Runs, measure: str, __: Remark) -> Figures:
    from rockflex import plot

    yield "capacities", lambda: plot.plot_ida(runs, measure)


INCREMENTAL = StudyKind(
    name="incremental",
    command="ida",
    summary="Scale every record until the structure overturns, and fit the capacities (incremental dynamic analysis).",
    described_by="rockflex.study.incremental.IncrementalStudy",
    report=_report,
    figures=_figures,
    measured=True,
)
