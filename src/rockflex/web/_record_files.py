"""Records as files that every command and `read_suite` read."""

import io
import zipfile
from collections.abc import Iterable

from rockflex.motion import GroundMotion, record_csv
from rockflex.web._unpacking import flat_names

MADE = (1980, 1, 1, 0, 0, 0)  # the same records give the same archive


def packed_records(motions: Iterable[GroundMotion]) -> bytes:
    """Return a ZIP archive with a CSV file of each motion, which says what is known of it."""
    members = list(motions)
    names = flat_names(f"{motion.name.replace('/', '_')}.csv" for motion in members)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=3) as archive:
        for name, motion in zip(names, members, strict=True):
            archive.writestr(zipfile.ZipInfo(name, MADE), record_csv(motion), zipfile.ZIP_DEFLATED)
    return packed.getvalue()
