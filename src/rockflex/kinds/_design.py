"""The design of a base: the probability of each design, the least width, and its page."""

from typing import Any

from rockflex.kinds._kind import Document, Figures, Findings, Remark, Runs, StudyKind


def _report(study: Any, runs: Runs, found: Findings) -> None:
    from rockflex.fragility import limit_label
    from rockflex.study.design import design_tables, smallest_width

    asked = "annual rate" if study.hazard else f"P at {study.measure} = {study.level:g}"
    value = "rate" if study.hazard else "probability"
    designs: dict[tuple[str, str, float], dict[str, Any]] = {}
    widths: list[dict[str, Any]] = []
    for limit, table in design_tables(runs, study.document()):
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
        if study.target is None:
            continue
        for each in smallest_width(table, study.target).to_dict("records"):
            words = {"limit": word, **{name: each[name] for name in ("tendon", "model", "outcome")}}
            widths.append({**words, "B [m]": each["half_width"], "B, upper limit [m]": each["half_width_upper"]})
            if each["note"]:
                found.remarks.append(f"{word}, {each['tendon']}, {each['model']}: {each['note']}")
    found.tables[f"Designs, and the {asked} of exceeding each limit; medians of all runs"] = [*designs.values()]
    if widths:
        found.tables[f"Least half width from which on the {asked} is at most {study.target:g}"] = widths


def _figures(spec: Document, runs: Runs, _: str, __: Remark) -> Figures:
    from rockflex import plot
    from rockflex.fragility import limit_label
    from rockflex.study.design import design_tables

    target = spec.get("target")
    for limit, table in design_tables(runs, spec):
        stem = f"design_{'_'.join(limit_label(limit).split())}"
        yield stem, lambda table=table: plot.plot_design(table, target)


def _runs(table: Runs) -> Runs:
    # The widths of a design are counted together.
    return table.assign(structure=[f"Designs, tendons: {tendon}" for tendon in table["tendon"]])


DESIGN = StudyKind(
    name="design",
    command="design",
    summary="Run a structure on bases of many widths and with several tendons, and find how wide the base must be.",
    described_by="rockflex.study.design.DesignStudy",
    report=_report,
    figures=_figures,
    runs=_runs,
    page="_design",
)
