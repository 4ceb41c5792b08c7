"""The multiple-stripe analysis: its counts and its fragility curves."""

from typing import Any

from rockflex.kinds._kind import Document, Figures, Findings, Remark, Runs, StudyKind


def _report(study: Any, runs: Runs, found: Findings) -> None:
    from rockflex._cases import cases
    from rockflex.fragility import NOMINAL, OVERTURNING, UPLIFT, fit_stripes
    from rockflex.study.stripes import stripe_counts

    counts = found.tables[f"Runs beyond the limit at each level of {study.measure}"] = []
    fits = found.tables[f"Fragility by maximum likelihood, lognormal in {study.measure}"] = []
    for limit in (UPLIFT, NOMINAL, OVERTURNING):
        for structure, model, each in cases(stripe_counts(runs, limit.name)):  # pyright: ignore[reportArgumentType]
            stripes = each["level"], each["n_exceeding"], each["n_total"]
            what = f"{structure} with {model}, {limit.label}"
            fit = found.fitted(lambda stripes=stripes: fit_stripes(*stripes), what)
            name = {"limit": limit.label, "structure": structure, "model": model}
            fits.append({**name, "median": fit and fit.median, "β": fit and fit.beta})
            counts.append({**name, **{f"{level:g}": f"{n}/{total}" for level, n, total in zip(*stripes, strict=True)}})


def _figures(spec: Document, runs: Runs, _: str, __: Remark) -> Figures:
    from rockflex import plot

    yield "stripes", lambda: plot.plot_stripes(runs, measure=spec["measure"])


STRIPES = StudyKind(
    name="stripes",
    command="stripes",
    summary="Scale the records to levels of an intensity measure, and fit how many exceed a limit.",
    described_by="rockflex.study.stripes.StripeStudy",
    report=_report,
    figures=_figures,
)
