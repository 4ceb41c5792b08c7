"""Quantity, unit, time step and component of samples, by all that is said of them."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.motion._declared import Declared
from rockflex.motion._findings import (
    Evidence,
    Finding,
    NoAccelerationError,
    same_step,
    settled,
    shown_step,
)
from rockflex.motion._header import MAX_STEP, MIN_STEP, Header
from rockflex.motion._record_info import (
    CHANNEL,
    COMPASS,
    VERTICAL_NAME,
    Direction,
    component_azimuth,
    component_direction,
)
from rockflex.motion._units import AccelerationUnit, Quantity

SUFFIXES: dict[str, Quantity] = {
    ".at2": "acceleration",
    ".acc": "acceleration",
    ".vt2": "velocity",
    ".vel": "velocity",
    ".dt2": "displacement",
    ".dis": "displacement",
    ".disp": "displacement",
    ".dsp": "displacement",
    ".rsp": "spectrum",
    ".spc": "spectrum",
    ".fas": "spectrum",
}
# Words in the name of a file that say what it holds, where nothing else does.
NAME_WORDS: dict[str, Quantity] = {
    "vel": "velocity",
    "velocity": "velocity",
    "dis": "displacement",
    "disp": "displacement",
    "displacement": "displacement",
    "spectrum": "spectrum",
    "spectra": "spectrum",
    "psa": "spectrum",
}
# The end of a file's name that says so; a number of three digits is an azimuth.
HORIZONTAL_ENDING = re.compile(rf"[-_. ](?:{COMPASS}|{CHANNEL}[NE12]|\d{{3}})$", re.IGNORECASE)
MISSING = re.compile(r"-?9{2,}(?:\.(?:9+|0*))?|-?99\.(?:9{2,}|0*)|-?9999\d*")
MIN_MISSING = 99.0
GROUP = (2.0, 1e3)  # times by which the code exceeds the next largest value, at least, and the share of samples


@dataclass(frozen=True)
class ComponentEvidence:
    """The name of a component, and what says so."""

    name: str
    said: str


@dataclass(frozen=True)
class Way:
    """The name of a component, its direction and the finding; empty and None where nothing is known."""

    name: str = ""
    direction: Direction | None = None
    finding: Finding | None = None


def settled_quantity(file: Path, words: list[Evidence[Quantity]], header: Header) -> Evidence[Quantity] | None:
    """Return what says that samples are an acceleration, None if nothing does; or raise an error with what they are."""
    stated: list[Evidence[Quantity]] = [*words, *(each for each in header.quantities if each.value != "counts")]
    suffix = SUFFIXES.get(file.suffix.lower())
    if suffix is not None:
        stated.append(Evidence(suffix, f'suffix of the file "{file.suffix}"'))
    elif not stated:
        named: list[Quantity] = [
            NAME_WORDS[word] for word in re.split(r"[-_. ]", file.stem.lower()) if word in NAME_WORDS
        ]
        if named:
            stated.append(Evidence(named[-1], f'name of the file "{file.name}"'))
    others = [each for each in stated if each.value != "acceleration"]
    if others and len(others) == len(stated):
        raise NoAccelerationError(
            f"{file} holds a {others[0].value} by its {others[0].said}, but an acceleration is expected. Give the file "
            "of the acceleration; if this is one, correct what says otherwise.",
            found=others[0].value,
        )
    remedy = "Keep what is right: correct the header, or rename the file."
    return settled(file, "quantity", stated, None, remedy, lambda one, other: one == other)


def finding_of_quantity(quantity: Evidence[Quantity] | None, unit: Evidence[AccelerationUnit]) -> Finding:
    """Return the finding that samples are an acceleration, by their unit where nothing else says so."""
    return Finding("quantity", "acceleration", f"by the unit, {unit.said}" if quantity is None else quantity.said)


def settled_unit(
    file: Path,
    label: list[Evidence[AccelerationUnit]],
    header: Header,
    given: Declared,
    *,
    columns: bool,
) -> Evidence[AccelerationUnit]:
    """Return the unit of samples by the label of their column, the header, the suffix and the caller."""
    stated = [*label, *header.units]
    if not columns and file.suffix.lower() == ".at2":
        stated.append(Evidence(AccelerationUnit("g"), "suffix .AT2 of PEER's format, which is in g"))
    remedy = 'Say which one holds: units="g", "m/s2" or "cm/s2".'
    found = settled(file, "unit", stated, given.unit_evidence, remedy, AccelerationUnit.same)
    if found is not None:
        return found
    counts = next((each for each in header.quantities if each.value == "counts"), None)
    if counts is not None:
        raise counts_need_value(file, counts.said)
    if header.unknown:
        raise InputError(
            f"{file}: the header gives the unit {header.unknown[0].value!r}, which is not known "
            f"({header.unknown[0].said}). "
            'Write it as g, m/s2 or cm/s2; if the file holds counts, give the value of one: units="2.4e-4 cm/s2".',
            field="units",
        )
    raise InputError(
        f"{file} does not state the unit of its acceleration. Declare it: "
        'read_motion(path, units="g"), "m/s2" or "cm/s2"; or label the column "acc (g)".',
        field="units",
    )


def counts_need_value(file: Path, said: str) -> InputError:
    """Return the error of a file that holds counts of a recorder, whose value nobody gives."""
    return InputError(
        f'{file} holds counts of a recorder by its {said}. Give the value of one count: units="2.4e-4 cm/s2".',
        field="units",
    )


def remedy_of_unit(unit: Evidence[AccelerationUnit]) -> str:
    """Return what to do about a unit that cannot be right, for a message."""
    if unit.said.startswith(("units=", "suffix")):
        return 'Declare the unit of the file: units="m/s2" or units="cm/s2".'
    return f"Correct the unit in {unit.said}."


def settled_step(
    file: Path, stated: list[Evidence[float]], given: Declared, known: str, *, trusted: bool
) -> Evidence[float]:
    """Return the time step in s by what the file states and the caller; `known` says what there is without one.

    A step that no recorder has needs the word of the caller, unless it is `trusted`.
    """
    remedy = "Say which one holds: dt=0.01."
    found = settled(file, "time step", stated, given.step_evidence, remedy, same_step)
    if found is None:
        raise InputError(f"{file} has {known}: give the sampling step, read_motion(path, dt=0.01).", field="dt")
    if given.dt is None and not trusted and not MIN_STEP <= found.value <= MAX_STEP:
        raise InputError(
            f"{file}: the time step would be {shown_step(found.value)} by its {found.said}, but records have steps of "
            f"{MIN_STEP:g} to {MAX_STEP:g} s. The numbers may be in another unit than s, or count the rows. Give the "
            "step in s: dt=0.01.",
            field="dt",
        )
    return found


def settled_component(file: Path, label: ComponentEvidence | None, header: list[Evidence[str]]) -> Way:
    """Return the component of samples by the label of their column, the header and the name of the file."""
    stated = [] if label is None else [Evidence(label.name, label.said)]
    stated += header
    by_name = component_direction(file)
    name = stated[0].value if stated else ""
    ways = [Evidence[Direction](_direction(each.value), each.said) for each in stated]
    if by_name is None and ways and HORIZONTAL_ENDING.search(file.stem):
        by_name = "horizontal"
    if by_name is not None:
        ways.append(Evidence[Direction](by_name, f'name of the file "{file.name}"'))
    remedy = "Correct the label or the header, or rename the file."
    found = settled(file, "component", ways, None, remedy, _same_way)
    if found is None:
        return Way()
    shown_name = "" if not name or name.casefold() == found.value else f"{name}, "
    return Way(name, found.value, Finding("component", f"{shown_name}{found.value}", found.said))


def _direction(name: str) -> Direction:
    """Return the direction of a named component."""
    if VERTICAL_NAME.fullmatch(name) and component_azimuth(name) is None:
        return component_direction(Path(), name) or "vertical"
    return "horizontal"


def _same_way(one: Direction, other: Direction) -> bool:
    return (one == "horizontal") == (other == "horizontal")


def check_missing_values(file: Path, values: Array, lines: list[int]) -> None:
    """Raise an InputError if the largest values are a code for missing ones, such as -999 or 999.99."""
    size = np.abs(values)
    peak = float(size.max(initial=0.0))
    if peak < MIN_MISSING or not MISSING.fullmatch(f"{peak:.6f}".rstrip("0").rstrip(".")):
        return
    codes = size == peak
    others = float(size[~codes].max(initial=0.0))
    if peak >= GROUP[0] * others or np.count_nonzero(codes) > max(3.0, size.size / GROUP[1]):
        k = int(np.argmax(codes))
        raise InputError(
            f"{file}, line {lines[k]}: {values[k]:g} stands for a missing value, as it seems: the others reach "
            f"{others:g}. A record without gaps is expected: fill the gaps, or cut the record there."
        )
