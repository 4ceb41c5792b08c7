"""The design of a base: the probability of each design, and the least width."""

from collections.abc import Mapping
from typing import Any, Literal

from rockflex.kinds._kind import Document, Figures, Findings, Remark, Runs, StudyKind


def _report(study: Any, runs: Runs, found: Findings) -> None:
    from rockflex.fragility import limit_label
    from rockflex.study.design import design_tables, questions_of, smallest_width

    if study.search is not None:
        _report_search(study, runs, found)
        return
    levels: list[float | None] = study.level if isinstance(study.level, list) else [study.level]
    at = ", ".join(f"{level:g}" for level in dict.fromkeys(levels) if level is not None)
    asked = "annual rate" if study.hazard else f"P at {study.measure} = {at}"
    value = "rate" if study.hazard else "probability"
    targets = [target for _, _, target, _ in questions_of(study.document())]
    designs: dict[tuple[str, str, float], dict[str, Any]] = {}
    widths: list[dict[str, Any]] = []
    for target, (limit, table) in zip(targets, design_tables(runs, study.document()), strict=True):
        word = limit_label(limit)
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
        most = ", ".join(f"{target:g}" for target in dict.fromkeys(targets) if target is not None)
        found.tables[f"Least half width from which on the {asked} is at most {most}"] = widths


def _report_search(study: Any, runs: Runs, found: Findings) -> None:
    from rockflex.study.design import search_of
    from rockflex.study.design.search import best_design

    requirements, cost = search_of(study.document())
    best = best_design(runs, requirements, cost)
    found.remarks += best.notes
    found.tables["Designs of the search, in the order in which they were run"] = [
        _row(row, [each.label for each in requirements]) for row in best.designs.to_dict("records")
    ]
    if best.best is None:
        return
    chosen = {"best": best.best} | ({} if best.cautious is None else {"cautious": best.cautious})
    names = {"best": "the cheapest that meets all targets", "cautious": "the cheapest whose bands meet them too"}
    found.tables["Cheapest designs"] = [
        {"which": names[word], **_row(best.designs.iloc[place].to_dict(), [])} for word, place in chosen.items()
    ]
    found.tables[f"Limits of the cheapest design, governed by {best.governs}"] = [
        {
            "limit": row["limit"],
            "governs": "yes" if row["limit"] == best.governs else "no",
            "target": row["target"],
            "value": row["value"],
            "low": row["low"],
            "high": row["high"],
            "value/target": row["used"],
            "cost without it": row["cost_without"],
        }
        for row in best.limits.to_dict("records")
    ]
    found.tables["Cheapest design in resamples of the recordings"] = [
        {str(name): value for name, value in row.items()} for row in best.interval.to_dict("records")
    ]


def _row(row: Mapping[Any, Any], labels: list[str]) -> dict[str, Any]:
    """What is told of a design, with the values of some requirements."""
    return {
        "design": row["structure"],
        "governs": row["governs"],
        "meets": "yes" if row["meets"] else "no",
        "B [m]": row["half_width"],
        "tendons": row["tendon_factor"],
        "dissipators": row["dissipator_factor"],
        "ΣF_0 [N]": row["prestress"],
        "ΣF_y [N]": row["dissipator_force"],
        "cost": row["cost"],
        **{label: row[label] for label in labels},
        "meets in resamples": row["confidence"],
        "chosen in resamples": row["chosen"],
        "failed": row["n_failed"],
    }


def _figures(spec: Document, runs: Runs, _: str, __: Remark) -> Figures:
    from rockflex import plot
    from rockflex.fragility import limit_label
    from rockflex.study.design import design_tables, questions_of, search_of
    from rockflex.study.design.search import best_design

    if "search" in spec:
        best = best_design(runs, *search_of(spec))
        themes: dict[str, Literal["light", "dark"]] = {"design_search": "light", "design_search_dark": "dark"}
        for name, theme in themes.items():
            yield name, lambda theme=theme: plot.plot_design_search(best, theme=theme)
        return
    targets = [target for _, _, target, _ in questions_of(spec)]
    for target, (limit, table) in zip(targets, design_tables(runs, spec), strict=True):
        stem = f"design_{'_'.join(limit_label(limit).split())}"
        yield stem, lambda table=table, target=target: plot.plot_design(table, target)


def _runs(table: Runs) -> Runs:
    # The widths of a design are counted together, and so are all designs of a search.
    if "tendon" not in table:
        return table.assign(structure="Designs of the search")
    return table.assign(structure=[f"Designs, tendons: {tendon}" for tendon in table["tendon"]])


DESIGN = StudyKind(
    name="design",
    command="design",
    summary="Find how wide a base must be, or the cheapest width, tendons and dissipators together.",
    described_by="rockflex.study.design.DesignStudy",
    report=_report,
    figures=_figures,
    runs=_runs,
)
