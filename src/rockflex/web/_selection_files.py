"""Files of the records chosen for a target spectrum: tables, a figure, the scaled records, and a program."""

from collections.abc import Callable
from typing import Any

from rockflex.web._given import GIVEN, WHOLE
from rockflex.web._record_files import packed_records
from rockflex.web._state import State
from rockflex.web._svg import svg
from rockflex.web._target import SELECTIONS, call_of, options_of, target_of
from rockflex.web._uploads import Uploads


def _table(state: State, uploads: Uploads) -> tuple[str, str]:
    return "selection.csv", SELECTIONS.of(state, uploads)[0].table().to_csv(index=False, lineterminator="\n")


def _spectra(state: State, uploads: Uploads) -> tuple[str, str]:
    return "spectra.csv", SELECTIONS.of(state, uploads)[0].spectra().to_csv(index=False, lineterminator="\n")


def _figure(state: State, uploads: Uploads) -> tuple[str, bytes]:
    from rockflex.plot import plot_selection

    return "selection.svg", svg(plot_selection(SELECTIONS.of(state, uploads)[0]))


def _records(state: State, uploads: Uploads) -> tuple[str, bytes]:
    return "scaled-records.zip", packed_records(SELECTIONS.of(state, uploads)[0].suite)


def _python(state: State, _: Uploads) -> tuple[str, str]:
    choice = state.target
    name, values, named = call_of(choice)
    if name == "read_target":
        target = target_of(choice)
        name, named = "TargetSpectrum", {"damping_ratio": target.damping_ratio, "name": target.name}
        values = [target.periods.tolist(), target.sa.tolist()]
    options = {key: value for key, value in options_of(choice).items() if value is not None}
    given = f"rf.read_suite({WHOLE!r})  # unpacked from {WHOLE}.zip, which the page saves: Your records (ZIP)"
    lines = [
        "import rockflex as rf",
        "",
        f"target = rf.{name}({_arguments(values, named)})",
        f"suite = {given if choice.source == GIVEN else f'rf.load_suite({choice.source!r})'}",
        f"chosen = suite.select(target, {_arguments([choice.count, (choice.shortest, choice.longest)], options)})",
        "print(chosen)",
        "print(chosen.table().to_string(index=False))",
        'chosen.spectra().to_csv("spectra.csv", index=False)',
        'rf.save_figure(rf.plot_selection(chosen), "selection.png")',
    ]
    return "selection.py", "\n".join([*lines, ""])


def _arguments(values: list[Any], named: dict[str, Any]) -> str:
    return ", ".join([*map(repr, values), *(f"{name}={value!r}" for name, value in named.items())])


SELECTION_FILES: dict[str, Callable[[State, Uploads], tuple[str, str | bytes]]] = {
    "selection": _table,
    "selection-spectra": _spectra,
    "selection-figure": _figure,
    "selection-records": _records,
    "selection-python": _python,
}
