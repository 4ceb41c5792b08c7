"""Motions as CSV files whose first lines say what is known of the record, and what these lines say."""

from dataclasses import fields
from pathlib import Path

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._text import real

MARK = "Record of rockflex"
NOT_WRITTEN = ("source_format", "stated_pga")  # they are about the file that was read
KINDS = {int | None: int, float | None: float}
FACTS = {each.name: KINDS.get(each.type, str) for each in fields(RecordInfo) if each.name not in NOT_WRITTEN}  # pyright: ignore[reportCallIssue, reportArgumentType]


def record_csv(motion: GroundMotion) -> str:
    """Return a motion as the text of a CSV file, to the last bit, that `read_motion` reads with all that is known."""
    info = motion.metadata or RecordInfo()
    known = {name: value for name in FACTS if (value := getattr(info, name)) is not None}
    heads = [f"# {MARK}", *(f"# {name}: {' '.join(str(value).split())}" for name, value in known.items())]
    columns = {"time (s)": motion.time, "acceleration (m/s2)": motion.acceleration}
    if motion.vertical is not None:
        columns["vertical (m/s2)"] = motion.vertical
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return "\n".join([*(heads if known else []), ",".join(columns), *(",".join(map(repr, row)) for row in rows), ""])


def stated_facts(file: Path, heads: list[str]) -> RecordInfo:
    """Return what the first lines of a file say of its record, if `record_csv` wrote them.

    Raises
    ------
    InputError
        If a number in them is none.
    """
    found: dict[str, str | int | float] = {}
    lines = [head.strip("# ,;\t") for head in heads]  # as spreadsheets leave them
    for line, head in enumerate(lines if lines[:1] == [MARK] else [], 1):
        name, _, text = (part.strip() for part in head.partition(":"))
        if name not in FACTS or not text:
            continue
        kind = FACTS[name]
        value = text if kind is str else real(text)
        if value is None or value != kind(value):
            raise InputError(f"{file}, line {line}: {name} must be a number, but {shown(text)} was given.")
        found[name] = kind(value)
    if found.get("direction", "horizontal") not in ("horizontal", "vertical", "down"):
        raise InputError(
            f'{file}: direction must be "horizontal", "vertical" or "down", but {shown(found["direction"])} was given.'
        )
    return RecordInfo(**found)  # pyright: ignore[reportArgumentType]
