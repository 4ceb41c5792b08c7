"""Records as files that every command and `read_suite` read."""

import csv
import io
import zipfile
from collections.abc import Iterable
from typing import Any

from rockflex.motion import GroundMotion, RecordInfo
from rockflex.web._unpacking import flat_names

TABLE = "_records.csv"  # what headers of CSV files cannot say
FACTS = {
    "RSN": "rsn",
    "event": "event",
    "year": "year",
    "station": "station",
    "magnitude": "magnitude",
    "Rrup (km)": "distance_km",
    "Rjb (km)": "distance_jb_km",
    "Vs30 (m/s)": "vs30",
}
MADE = (1980, 1, 1, 0, 0, 0)  # the same records give the same archive


def record_table(motion: GroundMotion) -> str:
    """Return a motion as a CSV file, to the last bit."""
    columns = {"time (s)": motion.time, "acc (m/s2)": motion.acceleration}
    if motion.vertical is not None:
        columns["vertical (m/s2)"] = motion.vertical
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    lines = [",".join(map(repr, row)) for row in rows]
    return "\n".join([",".join(columns), *lines, ""])


def packed_records(motions: Iterable[GroundMotion]) -> bytes:
    """Return a ZIP archive with a CSV file of each motion, and a table of what is known of them."""
    members = list(motions)
    names = flat_names(f"{motion.name.replace('/', '_')}.csv" for motion in members)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=3) as archive:
        for name, motion in zip(names, members, strict=True):
            archive.writestr(zipfile.ZipInfo(name, MADE), record_table(motion), zipfile.ZIP_DEFLATED)
        if any(_facts(motion) for motion in members):
            archive.writestr(zipfile.ZipInfo(TABLE, MADE), _table(names, members), zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def _table(names: list[str], motions: list[GroundMotion]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, ["file", *FACTS], lineterminator="\n")
    writer.writeheader()
    writer.writerows({"file": name, **_facts(motion)} for name, motion in zip(names, motions, strict=True))
    return text.getvalue()


def _facts(motion: GroundMotion) -> dict[str, Any]:
    info = motion.metadata or RecordInfo()
    return {head: value for head, name in FACTS.items() if (value := getattr(info, name)) is not None}
