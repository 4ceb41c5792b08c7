"""The cloud: its outcomes and regressions, and its fragility curves."""

from typing import TYPE_CHECKING, Any

from rockflex.kinds._kind import Document, Figures, Findings, Remark, Runs, StudyKind

if TYPE_CHECKING:
    from rockflex.fragility import CloudFit


def report(_: Any, runs: Runs, found: Findings) -> None:
    """Count the outcomes, and fit the regressions."""
    from rockflex._cases import cases
    from rockflex.fragility import OVERTURNING, ROCKING, LogisticFit, fit_each_cloud
    from rockflex.motion import MEASURES

    pgv = MEASURES["pgv"]
    fits, reasons = fit_each_cloud(runs, pgv.name)
    found.unfitted += [f"{structure} with {model}: {reason}" for (structure, model), reason in reasons.items()]
    fits_of = {(each.structure, each.model): each for each in fits}
    outcomes = found.tables[f"Outcomes, and P({ROCKING.label}) by logistic regression on log {pgv.label}"] = []
    lines = found.tables[f"log y = c1 + c2 log {pgv.label} of runs that rocked and stand (rad, m, {pgv.unit})"] = []
    for structure, model, group in cases(runs):
        name = {"structure": structure, "model": model}
        solved, fallen = group["status"].notna(), OVERTURNING.exceeded(group)
        rocked = solved & ~fallen & ROCKING.exceeded(group)
        fit = fits_of.get((structure, model))
        curve = fit and fit.outcomes.initiation
        fitted = isinstance(curve, LogisticFit)
        outcomes.append(
            {
                **name,
                "fit": curve.method if fitted else "all alike" if curve else "none",
                "no rocking": int((solved & ~fallen & ~rocked).sum()),
                "rocking": int(rocked.sum()),
                "overturned": int(fallen.sum()),
                "failed": int((~solved).sum()),
                pgv.with_unit(f"{pgv.label} of P(rocking)=½"): curve.median if fitted else None,
                "spread [-]": curve.dispersion if fitted else None,
            }
        )
        lines += [
            {**name, "y": "θ_max", **_line(fit and fit.outcomes.rotation)},
            {**name, "y": "u_top relative to the base", **_line(fit and fit.top_displacement)},
            {**name, "y": "u_top in total", **_line(fit and fit.total_top_displacement)},
        ]


def _line(fit: "CloudFit | None") -> dict[str, Any]:
    return {"c1": fit and fit.c1, "c2": fit and fit.c2, "spread": fit and fit.dispersion, "R²": fit and fit.r2}


def figures(_: Document, runs: Runs, measure: str, remark: Remark) -> Figures:
    """Yield the fragility curves and the clouds."""
    from rockflex import plot
    from rockflex.fragility import fit_each_cloud

    fits, reasons = fit_each_cloud(runs, measure)
    for (structure, model), reason in reasons.items():
        remark(f"No fit: {structure} with {model}: {reason}")
    if fits:
        names = zip(runs["structure"].astype(str), runs["model"].astype(str), strict=True)
        fitted = runs[[case not in reasons for case in names]]
        yield "fragility", lambda: plot.plot_fragility(fitted, measure)
    else:
        remark("No figure fragility, and clouds without lines: add records or scales to the study, and run it again")
    yield "rotation", lambda: plot.plot_clouds(runs, "max_rotation", measure)
    yield "top_displacement", lambda: plot.plot_clouds(runs, "max_top_displacement", measure)
    if runs["max_total_top_displacement"].notna().any():
        yield "total_top_displacement", lambda: plot.plot_clouds(runs, "max_total_top_displacement", measure)


CLOUD = StudyKind(
    name="cloud",
    command="cloud",
    summary="Run every structure under every record at every scale, and fit regressions and fragility curves.",
    described_by="rockflex.study.cloud.CloudStudy",
    report=report,
    figures=figures,
    measured=True,
)
