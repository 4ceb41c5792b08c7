"""The kinds of study: the command, the report and the figures of each."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun
from rockflex.studies._study_kind import Document, Figures, Remark, Row, Runs, StudyFindings, StudyKind

if TYPE_CHECKING:
    from rockflex.fragility._cloud import CloudFit


def _report_cloud(study: Any, runs: Runs, found: StudyFindings) -> None:
    """Count the outcomes, and fit the regressions."""
    from rockflex.foundation.cases import runs_by_case
    from rockflex.fragility._clouds import fit_each_cloud
    from rockflex.fragility._limit_states import OVERTURNING, ROCKING
    from rockflex.fragility._logistic import LogisticFit
    from rockflex.motion._measures import MEASURES

    pgv = MEASURES["pgv"]
    fits, reasons = fit_each_cloud(runs, pgv.name)
    found.unfitted += [f"{structure} with {model}: {reason}" for (structure, model), reason in reasons.items()]
    fits_of = {(each.structure, each.model): each for each in fits}
    outcomes = found.tables[f"Outcomes, and P({ROCKING.label}) by logistic regression on log {pgv.label}"] = []
    lines = found.tables[f"log y = c1 + c2 log {pgv.label} of runs that rocked and stand (rad, m, {pgv.unit})"] = []
    for structure, model, group in runs_by_case(runs):
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
            {**name, "y": "θ_max", **_cloud_line_row(fit and fit.outcomes.rotation)},
            {**name, "y": "u_top relative to the base", **_cloud_line_row(fit and fit.top_displacement)},
            {**name, "y": "u_top in total", **_cloud_line_row(fit and fit.total_top_displacement)},
        ]
        if "max_ductility" in group and group["max_ductility"].notna().any():
            lines.append({**name, "y": "μ_max of the stories", **_cloud_line_row(fit and fit.ductility)})
    _report_limits(study, runs, found)


def _report_limits(study: Any, runs: Runs, found: StudyFindings) -> None:
    """Fit a logistic curve to the runs beyond each limit of the study."""
    from rockflex.foundation.cases import runs_by_case
    from rockflex.fragility._limit_states import limit_state_of
    from rockflex.fragility._logistic import LogisticFit, fit_logistic
    from rockflex.motion._measures import MEASURES

    pgv, rows = MEASURES["pgv"], list[Row]()
    for state in map(limit_state_of, study.limits or ()):
        for structure, model, group in runs_by_case(runs[runs["status"].notna()]):
            beyond = state.exceeded(group).fillna(False).to_numpy(dtype=bool)
            row: Row = {"limit": state.label, "structure": structure, "model": model}
            row["beyond"] = f"{beyond.sum()}/{len(group)}"
            curve: LogisticFit | None = None
            if beyond.any() and not beyond.all():
                what = f"{structure} with {model}, {state.label}"
                curve = found.fitted(lambda group=group, beyond=beyond: fit_logistic(group[pgv.name], beyond), what)
            rows.append(row | {"median": curve and curve.median, "spread [-]": curve and curve.dispersion})
    if rows:
        found.tables[f"P(limit) by logistic regression on log {pgv.label}, with overturned runs ({pgv.unit})"] = rows


def _cloud_line_row(fit: "CloudFit | None") -> dict[str, Any]:
    return {"c1": fit and fit.c1, "c2": fit and fit.c2, "spread": fit and fit.dispersion, "R²": fit and fit.r2}


def _figures_cloud(_: Document, runs: Runs, measure: str, remark: Remark) -> Figures:
    """Yield the fragility curves and the clouds."""
    from rockflex.fragility._clouds import fit_each_cloud
    from rockflex.plot._fragility import plot_clouds, plot_fragility

    fits, reasons = fit_each_cloud(runs, measure)
    for (structure, model), reason in reasons.items():
        remark(f"No fit: {structure} with {model}: {reason}")
    if fits:
        names = zip(runs["structure"].astype(str), runs["model"].astype(str), strict=True)
        fitted = runs[[case not in reasons for case in names]]
        yield "fragility", lambda: plot_fragility(fitted, measure)
    else:
        remark("No figure fragility, and clouds without lines: add records or scales to the study, and run it again")
    yield "rotation", lambda: plot_clouds(runs, "max_rotation", measure)
    yield "top_displacement", lambda: plot_clouds(runs, "max_top_displacement", measure)
    if runs["max_total_top_displacement"].notna().any():
        yield "total_top_displacement", lambda: plot_clouds(runs, "max_total_top_displacement", measure)
    if "max_ductility" in runs and runs["max_ductility"].notna().any():
        yield "ductility", lambda: plot_clouds(runs, "max_ductility", measure)


CLOUD = StudyKind(
    name="cloud",
    command="cloud",
    summary="Run every structure under every record at every scale, and fit regressions and fragility curves.",
    described_by="rockflex.studies.cloud.CloudStudy",
    report=_report_cloud,
    figures=_figures_cloud,
    measured=True,
)


def _report_incremental(study: Any, runs: Runs, found: StudyFindings) -> None:
    from rockflex.foundation.cases import runs_by_case
    from rockflex.fragility._limit_states import limit_state_of
    from rockflex.fragility._lognormal import fit_capacities
    from rockflex.motion._measures import MEASURES
    from rockflex.studies.incremental import incremental_capacities

    rows = []
    for measure in (MEASURES["pga"], MEASURES["pgv"]):
        capacities = incremental_capacities(runs, measure.name).dropna(subset=["capacity"])
        for structure, model, each in runs_by_case(capacities):
            what = f"{structure} with {model}, {measure.label}"
            fit = found.fitted(lambda each=each: fit_capacities(each["capacity"], each["censored"]), what)
            rows.append(
                {
                    "structure": structure,
                    "model": model,
                    "measure": measure.label,
                    "records": len(each),
                    "limit never reached": int(each["censored"].sum()),
                    "resurrections": int(each["resurrections"].sum()),
                    "median [SI]": fit and fit.median,
                    "β": fit and fit.beta,
                }
            )
    found.tables[f"Capacities to {limit_state_of(study.limit).rotation}, lognormal"] = rows


def _figures_incremental(_: Document, runs: Runs, measure: str, __: Remark) -> Figures:
    from rockflex.plot._fragility import plot_ida

    yield "capacities", lambda: plot_ida(runs, measure)


INCREMENTAL = StudyKind(
    name="incremental",
    command="ida",
    summary="Scale every record until the structure overturns, and fit the capacities (incremental dynamic analysis).",
    described_by="rockflex.studies.incremental.IncrementalStudy",
    report=_report_incremental,
    figures=_figures_incremental,
    measured=True,
)


def _report_stripes(study: Any, runs: Runs, found: StudyFindings) -> None:
    from rockflex.foundation.cases import runs_by_case
    from rockflex.fragility._limit_states import LIMIT_STATES, NOMINAL, OVERTURNING, UPLIFT, limit_state_of
    from rockflex.fragility._lognormal import fit_stripes
    from rockflex.studies.stripes import stripe_counts

    counts = found.tables[f"Runs beyond the limit at each level of {study.measure}"] = []
    fits = found.tables[f"Fragility by maximum likelihood, lognormal in {study.measure}"] = []
    usual = (UPLIFT, NOMINAL, OVERTURNING, *LIMIT_STATES.added.values())
    for limit in map(limit_state_of, study.limits or usual):
        exceeding = found.fitted(lambda limit=limit: stripe_counts(runs, limit), limit.label)
        for structure, model, each in runs_by_case(exceeding) if exceeding is not None else ():
            stripes = each["level"], each["n_exceeding"], each["n_total"]
            what = f"{structure} with {model}, {limit.label}"
            fit = found.fitted(lambda stripes=stripes: fit_stripes(*stripes), what)
            name = {"limit": limit.label, "structure": structure, "model": model}
            fits.append({**name, "median": fit and fit.median, "β": fit and fit.beta})
            counts.append({**name, **{f"{level:g}": f"{n}/{total}" for level, n, total in zip(*stripes, strict=True)}})


def _figures_stripes(spec: Document, runs: Runs, _: str, __: Remark) -> Figures:
    from rockflex.plot._fragility import plot_stripes

    limits = spec.get("limits") or ["overturning"]
    for place, limit in enumerate(limits, start=1):
        stem = "stripes" if len(limits) == 1 else f"stripes_{place}"
        yield stem, lambda limit=limit: plot_stripes(runs, limit, measure=spec["measure"])


STRIPES = StudyKind(
    name="stripes",
    command="stripes",
    summary="Scale the records to levels of an intensity measure, and fit how many exceed a limit.",
    described_by="rockflex.studies.stripes.StripeStudy",
    report=_report_stripes,
    figures=_figures_stripes,
)


def _report_monte_carlo(study: Any, runs: Runs, found: StudyFindings) -> None:
    structures = runs.drop_duplicates("number")
    lost = int(structures["weight"].isna().sum())
    if lost:
        found.remarks.append(f"{lost} of {len(structures)} structures cannot be built; their runs have an error")
    found.tables[f"Values of {number_with_noun(len(structures), 'random structure')}"] = [
        {"variable": name, "least": values.min(), "median": values.median(), "largest": values.max()}
        for name in (*study.variables, "recentring_ratio")
        for values in (structures[name],)
    ]
    _report_cloud(study, runs, found)


MONTE_CARLO = StudyKind(
    name="monte_carlo",
    command="monte-carlo",
    summary="Run random structures under the records, and fit regressions and fragility curves of all of them.",
    described_by="rockflex.studies.monte_carlo.MonteCarloStudy",
    report=_report_monte_carlo,
    figures=_figures_cloud,
    measured=True,
)


def _report_design(study: Any, runs: Runs, found: StudyFindings) -> None:
    from rockflex.fragility._limit_states import limit_state_label
    from rockflex.studies.design._design_table import smallest_width

    if study.search is not None:
        _report_search(study, runs, found)
        return
    if not study.limits:
        found.remarks.append("the study has no limits: rf.design_table evaluates its runs")
        return
    levels: list[float | None] = study.level if isinstance(study.level, list) else [study.level]
    at = ", ".join(f"{level:g}" for level in dict.fromkeys(levels) if level is not None)
    asked = "annual rate" if study.hazard else f"P at {study.measure} = {at}"
    value = "rate" if study.hazard else "probability"
    designs: dict[tuple[str, str, float], dict[str, Any]] = {}
    widths: list[dict[str, Any]] = []
    for limit, target, table in study.question.tables(runs):
        word = limit_state_label(limit)
        for reason, lost in table[table[value].isna()].groupby("note"):
            found.unfitted.append(f"{word}: no {value} of {len(lost)} of {len(table)} designs. {reason}")
        for each in table.to_dict("records"):
            row = designs.setdefault(
                (each["model"], each["tendon"], each["half_width"]),
                {
                    "tendon": each["tendon"],
                    "model": each["model"],
                    "B [m]": each["half_width"],
                    "h*/B": each["aspect_ratio"],
                    "M_r [N m]": each["resisting_moment"],
                    "M_b [N m]": each["median_base_moment"],
                    "utilisation": each["median_tendon_utilisation"],
                    "failed": each["n_failed"],
                },
            )
            row |= {word: each[value], f"{word}, low": each["low"], f"{word}, high": each["high"]}
        if target is None:
            continue
        for each in smallest_width(table, target).to_dict("records"):
            words = {"limit": word, **{name: each[name] for name in ("tendon", "model", "outcome")}}
            widths.append({**words, "B [m]": each["half_width"], "B, upper limit [m]": each["half_width_upper"]})
            if each["note"]:
                found.remarks.append(f"{word}, {each['tendon']}, {each['model']}: {each['note']}")
    found.tables[f"Designs, and the {asked} of exceeding each limit; medians of all runs"] = [*designs.values()]
    if widths:
        most = ", ".join(f"{target:g}" for target in dict.fromkeys(study.question.targets) if target is not None)
        found.tables[f"Least half width from which on the {asked} is at most {most}"] = widths


def _report_search(study: Any, runs: Runs, found: StudyFindings) -> None:
    from rockflex.studies.design._best_design import best_design

    requirements = study.question.requirements
    best = best_design(runs, requirements, study.question.cost)
    found.remarks += best.notes
    found.tables["Designs of the search, in the order in which they were run"] = [
        _searched_design_row(row, [each.label for each in requirements]) for row in best.designs.to_dict("records")
    ]
    if best.best is None:
        return
    names = {"best": "the cheapest that meets all targets", "cautious": "the cheapest whose bands meet them too"}
    found.tables["Cheapest designs"] = [
        {"which": said, **_searched_design_row(best.designs.iloc[getattr(best, name)].to_dict(), [])}
        for name, said in names.items()
        if getattr(best, name) is not None
    ]
    limits = best.limits.assign(governs=["yes" if each == best.governs else "no" for each in best.limits["limit"]])
    limits = limits.rename(columns={"used": "value/target", "cost_without": "cost without it"})
    columns = ["limit", "governs", "target", "value", "low", "high", "value/target", "cost without it"]
    found.tables[f"Limits of the cheapest design, governed by {best.governs}"] = table_rows(limits[columns])
    found.tables["Cheapest design in resamples of the recordings"] = table_rows(best.interval)


def table_rows(table: Runs) -> list[Row]:
    return [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]


SEARCHED = {
    "structure": "design",
    "governs": "governs",
    "meets": "meets",
    "half_width": "B [m]",
    "tendon_factor": "tendons",
    "dissipator_factor": "dissipators",
    "prestress": "ΣF_0 [N]",
    "dissipator_force": "ΣF_y [N]",
    "cost": "cost",
}
RESAMPLED = {"confidence": "meets in resamples", "chosen": "chosen in resamples", "n_failed": "failed"}


def _searched_design_row(row: Mapping[Any, Any], labels: list[str]) -> Row:
    """Return the row of a design in the report, with the values of some requirements."""
    names = SEARCHED | {label: label for label in labels} | RESAMPLED
    return {said: row[name] for name, said in names.items()} | {"meets": "yes" if row["meets"] else "no"}


def _figures_design(spec: Document, runs: Runs, _: str, __: Remark) -> Figures:
    from rockflex.fragility._limit_states import limit_state_label
    from rockflex.plot._design import plot_design, plot_design_search
    from rockflex.studies.design._best_design import best_design
    from rockflex.studies.design._design_study import DesignQuestion

    question = DesignQuestion.of_document(spec)
    if question.cost is not None:
        best = best_design(runs, question.requirements, question.cost)
        yield "design_search", lambda: plot_design_search(best)
        return
    if not spec["limits"]:
        raise InputError(
            "The study has no limits, whose probabilities a figure would show. Give its runs with a limit to "
            "rf.design_table, and the table to rf.plot_design."
        )
    for limit, target, table in question.tables(runs):
        stem = f"design_{'_'.join(limit_state_label(limit).split())}"
        yield stem, lambda table=table, target=target: plot_design(table, target)


def _runs_design(table: Runs) -> Runs:
    # The widths of a design are counted together, and so are all designs of a search.
    if "tendon" not in table:
        return table.assign(structure="Designs of the search")
    return table.assign(structure=[f"Designs, tendons: {tendon}" for tendon in table["tendon"]])


DESIGN = StudyKind(
    name="design",
    command="design",
    summary="Find how wide a base must be, or the cheapest width, tendons and dissipators together.",
    described_by="rockflex.studies.design.DesignStudy",
    report=_report_design,
    figures=_figures_design,
    runs=_runs_design,
)
