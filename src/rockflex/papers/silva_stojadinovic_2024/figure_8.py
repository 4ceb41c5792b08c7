"""Figure 8: the characteristics of the random prototypes."""

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._number import check
from rockflex.papers.silva_stojadinovic_2024._pool import population
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.report import Result

TITLE = "Distribution of the random prototypes"
RANGES = {
    "stories": ("n_stories", "2 to 15", "≥ 2", "≤ 15"),
    "h*_1/B": ("aspect_ratio", "5 to 10", "≥ 5", "≤ 10"),
    "m_0/m_i": ("base_mass_ratio", "1.0 to 3.0", "≥ 1.0", "≤ 3.0"),
}
COEFFICIENTS = {
    "shear": ("a_1, T = a_1 H^0.85", "0.06 to 0.095", "≥ 0.06", "≤ 0.095"),
    "flexure": ("a_2, T = a_2 H", "0.0125 to 0.05", "≥ 0.0125", "≤ 0.05"),
}


def reproduce(records: Records) -> Result:
    """Draw the prototypes, and check that they are within the ranges of the text."""
    pairs = population(records)
    place = "Section 3.3"
    columns = {name: (pairs[column], *rest) for name, (column, *rest) in RANGES.items()}
    for behaviour, (name, *rest) in COEFFICIENTS.items():
        columns[name] = (pairs.loc[pairs["behaviour"] == behaviour, "coefficient"], *rest)
    checks = [
        check(f"{which} {name}", place, printed, float(value), criterion)
        for name, (drawn, printed, low, high) in columns.items()
        for which, value, criterion in (("least", drawn.min(), low), ("largest", drawn.max(), high))
    ]
    note = "The prototypes are drawn from these ranges, so this only checks the library."
    figures = {"figure-8": lambda: rf.plot_population(pairs)}
    return Result("figure-8", TITLE, figures=figures, note=note, checks=checks)
