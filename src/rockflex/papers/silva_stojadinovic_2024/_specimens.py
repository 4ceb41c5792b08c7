"""The parts that Figures 3 and 4 share: unknown parameters of the two specimens, runs, and bands over their ranges."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from itertools import product
from typing import Any

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._number import compared, stated
from rockflex.papers.silva_stojadinovic_2024._verdict import Verdict

SPECIMEN_MODELS = ("2DOF-C", "2DOF-C-SI", "2DOF-S", "MDOF-S")

# Nominal values first. None of these parameters of the specimens is known.
TWO_HZ = {"base_mass_ratio": (0.1, 0.0, 0.05, 0.2, 0.3), "damping_ratio": (0.01, 0.005, 0.02)}
S1 = {
    "base_mass_ratio": (0.3, 0.1, 0.6),
    "damping_ratio": (0.02, 0.005, 0.05),
    "width_ratio": (0.2, 0.15, 0.25),
    "effective_height": (1.0, 0.5, 2.0),
    "spacing": (1.5, 1.3, 1.65),
}

equal = partial(compared, ground=Verdict.EQUIVALENT)
holds = partial(stated, ground=Verdict.EQUIVALENT)
BUILT = "the equivalent is built so"

Free = Mapping[str, tuple[float, ...]]
Make = Callable[..., rf.RockingProperties]
Run = Callable[[rf.RockingProperties, str], rf.Response]


def nominal(free: Free) -> dict[str, float]:
    """Return the nominal value of each parameter."""
    return {name: values[0] for name, values in free.items()}


def combinations(free: Free) -> list[dict[str, float]]:
    """Return every combination of the values."""
    return [dict(zip(free, values, strict=True)) for values in product(*free.values())]


def histories(properties: rf.RockingProperties, run: Run) -> dict[str, rf.Response]:
    """Return the responses of the four models by name."""
    return {model: run(properties, model) for model in SPECIMEN_MODELS}


def widest(values: Iterable[float]) -> float:
    """Return the ratio of the largest to the smallest value."""
    found = list(values)
    return max(found) / min(found)


def drawings(
    name: str, title: str, responses: Mapping[str, rf.Response], free: Free, make: Make, run: Run
) -> dict[str, Callable[[], Any]]:
    """Return the figure of the responses, and that of each model with the band over all combinations."""
    nominals, panels = list(responses.values()), ("rotation", "top_displacement")

    def spread() -> Any:
        cases = [make(**case) for case in combinations(free)]
        varied = [[run(case, model) for case in cases] for model in responses]
        return rf.plot_spread(nominals, varied, panels=panels, title=title)

    return {name: lambda: rf.plot_history(nominals, panels=panels, title=title), f"{name}-spread": spread}
