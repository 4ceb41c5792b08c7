"""The downloads: figures, tables, studies and programs."""

import csv
import io
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import tomli_w

from rockflex.kinds import KINDS
from rockflex.motion import GroundMotion, record_csv
from rockflex.response import UNITS_OF_GROUND, UNITS_OF_HISTORY, Response, ground_columns
from rockflex.web._given import FOLDER, HEAD, WHOLE, given_suite
from rockflex.web._jobs import Job
from rockflex.web._pages import PAGES
from rockflex.web._record_files import packed_records
from rockflex.web._records import motion_of
from rockflex.web._refusal import Refusal, refusing
from rockflex.web._report import run_report
from rockflex.web._response import check_energy, responses
from rockflex.web._script import response_script
from rockflex.web._selection_files import SELECTION_FILES
from rockflex.web._state import State
from rockflex.web._studies import StudyPage
from rockflex.web._svg import svg
from rockflex.web._uploads import Uploads, clean_name

KINDS_OF_FILES = {
    ".zip": "application/zip",
    ".svg": "image/svg+xml",
    ".gif": "image/gif",
    ".html": "text/html",
    ".csv": "text/csv",
    ".toml": "application/toml",
    ".py": "text/x-python",
}
ROWS = 250_000  # of a table of histories
CELLS = 6_000_000  # of it: a bed has a column for every spring


def download(state: State, what: str, uploads: Uploads) -> tuple[str, str, bytes]:
    """Return the name, the type and the content of a file.

    Parameters
    ----------
    state
        The state of the page.
    what
        ``"report"``, ``"figure"``, ``"energy"``, ``"modes"``, ``"peaks"``, ``"histories"``,
        ``"record"``, ``"records"``, ``"study"``, ``"structure"``, ``"python"``, those of `SELECTION_FILES`, and
        ``"cloud-study"``, ``"cloud-python"``, ``"cloud-records"``, ``"design-study"``, ``"design-python"``,
        ``"design-records"``.
    uploads
        Records of visitors.

    Raises
    ------
    Refusal
        If there is no such file, or the state cannot be simulated.
    """
    maker = _MAKERS.get(what) or _study_maker(what)
    if maker is None:
        raise Refusal(f"There is no download named {what[:40]!r}.", 404)
    name, content = maker(state, uploads)
    data = content if isinstance(content, bytes) else content.encode()
    return name, KINDS_OF_FILES[Path(name).suffix], data


def _figure(state: State, uploads: Uploads) -> tuple[str, bytes]:
    from rockflex.plot import plot_history

    return "response.svg", svg(plot_history(responses(state, uploads)[2]))


def _energy(state: State, uploads: Uploads) -> tuple[str, bytes]:
    from rockflex.plot import plot_energy

    _, motion, found = responses(state, uploads)
    check_energy(found[0], motion, state)
    return "energy.svg", svg(plot_energy(found[0]))


def _modes(state: State, _: Uploads) -> tuple[str, bytes]:
    from rockflex.plot import plot_mode_shapes
    from rockflex.web._structures import build

    built = build(state.structure)
    if built.modes is None:
        message = "the shapes of the modes are not known, so there is no figure of them."
        raise Refusal({"structure": message})
    return "modes.svg", svg(plot_mode_shapes(built.modes, min(built.modes.n_modes, 10)))


def _peaks(state: State, uploads: Uploads) -> tuple[str, str]:
    _, motion, found = responses(state, uploads)
    rows = [response.peaks() for response in found]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["motion", "scale", *rows[0]])
    writer.writerows([motion.name, state.scale, *row.values()] for row in rows)
    return "peaks.csv", text.getvalue()


def _histories(state: State, uploads: Uploads) -> tuple[str, str]:
    import pandas as pd

    found = responses(state, uploads)[2]
    rows = sum(response.time.size for response in found)
    if rows > ROWS:
        message = (
            f"the histories have {rows} rows, but the page writes {ROWS} at most. Choose fewer models, or Python lines."
        )
        raise Refusal({"models": message})
    of_ground = [_of_ground(each) for each in found]
    cells = sum(
        each.time.size * (len(UNITS_OF_HISTORY) + len(more)) for each, more in zip(found, of_ground, strict=True)
    )
    if cells > CELLS:
        message = (
            f"the histories with the forces of all springs have {cells} values, but the page writes {CELLS} at most. "
            "Choose fewer models or springs, or Python lines."
        )
        raise Refusal({"models": message})
    heads = {name: f"{name} ({unit})" if unit else name for name, unit in UNITS_OF_HISTORY.items()}
    # The total displacement is missing where the height of the top is not known.
    columns = ({head: getattr(each, name, math.nan) for name, head in heads.items()} for each in found)
    tables = [
        pd.DataFrame({"model": each.model, **part, **_of_elements(each), **more})
        for each, part, more in zip(found, columns, of_ground, strict=True)
    ]
    return "histories.csv", pd.concat(tables).to_csv(index=False, float_format="%.9g", na_rep="nan")


def _of_ground(response: Response) -> dict[str, Any]:
    """Return the histories of a base that slides or is on springs, and of vertical motion, as columns."""
    columns = {} if response.history is None else ground_columns(response.history)
    return {f"{name} ({UNITS_OF_GROUND[name.rstrip('0123456789').rstrip('_')]})": columns[name] for name in columns}


def _of_elements(response: Response) -> dict[str, Any]:
    """Return the histories of the elements between the base and the ground as columns, counted from one."""
    columns: dict[str, Any] = {}
    parts = zip(response.element_elongation.T, response.element_force.T, strict=True)
    for place, (elongation, force) in enumerate(parts, start=1):
        columns[f"element_{place}_elongation (m)"] = elongation
        columns[f"element_{place}_force (N)"] = force
    return columns


def _record(state: State, uploads: Uploads) -> tuple[str, str]:
    motion = motion_of(state.record, uploads)
    return f"{_file_name(motion)}.csv", record_csv(motion)


def _records(state: State, uploads: Uploads) -> tuple[str, bytes]:
    return f"{WHOLE}.zip", packed_records(given_suite(state, uploads))


def _file_name(motion: GroundMotion) -> str:
    """The name of a motion as a file name; a unit in it, such as m/s, is not a path."""
    return clean_name(motion.name.replace("/", "_"))


def _structure_toml(state: State, _: Uploads) -> tuple[str, str]:
    return "structure.toml", tomli_w.dumps(state.structure.model_dump(exclude_none=True))


def _study(state: State, uploads: Uploads) -> tuple[str, str]:
    """The runs of the Response tab as a cloud study of one record."""
    motion = motion_of(state.record, uploads)
    head = "# rockflex cloud study.toml --out study\n"
    records: dict[str, Any] = {"suites": [state.record.suite], "include": [motion.name]}
    if state.record.source != "suite":
        name = f"{_file_name(motion)}.csv"
        head += f'# Put the record, which the page saves as "{name}", into the folder records next to this file.\n'
        records = {"folder": "records"}
    content: dict[str, Any] = {
        "study": "cloud",
        "name": state.structure.name or "Response",
        "models": list(state.models),
        "scales": [state.scale],
        "free_vibration": state.free_vibration,
    }
    content |= state.assumed(state.models)
    structure = state.structure.model_dump(exclude_none=True)
    return "study.toml", head + tomli_w.dumps(content | {"records": records, "structures": [structure]})


def _python(state: State, uploads: Uploads) -> tuple[str, str]:
    own = state.record.source in ("upload", "folder")
    name = _file_name(motion_of(state.record, uploads)) if own else ""
    return "response.py", response_script(state, name)


def _study_maker(what: str) -> Callable[[State, Uploads], tuple[str, str | bytes]] | None:
    """What makes the file or the program of a study, such as "cloud-study" or "design-python"; None if nothing does."""
    kind, _, form = what.partition("-")
    page = PAGES.get(kind)
    if page is None:
        return None

    def toml(state: State, uploads: Uploads) -> tuple[str, str]:
        study = page.study(state, uploads)
        head = f"# rockflex {KINDS[kind].command} {kind}.toml --out study\n"
        head += HEAD if study.records.folder else ""
        return f"{kind}.toml", head + tomli_w.dumps(study.model_dump(exclude_none=True))

    def python(state: State, uploads: Uploads) -> tuple[str, str]:
        return f"{kind}.py", page.script(state, page.study(state, uploads))

    def records(state: State, uploads: Uploads) -> tuple[str, bytes]:
        return f"{FOLDER}.zip", packed_records(page.study(state, uploads).records.motions)

    return {"study": toml, "python": python, "records": records}.get(form)


def study_file(page: StudyPage, job: Job, state: State, what: str) -> tuple[str, str, bytes]:
    """Return the name, the type and the content of the table or the figure of a study, from its runs so far.

    Raises
    ------
    Refusal
        If there are no runs yet, or nothing can be drawn.
    """
    if what == "table":
        return f"{page.table_name}.csv", "text/csv", page.table(job, state).to_csv(index=False).encode()
    with refusing(""):
        return f"{page.figure_name}.svg", "image/svg+xml", svg(page.figure(job, state))


_MAKERS: dict[str, Any] = SELECTION_FILES | {
    "figure": _figure,
    "energy": _energy,
    "report": run_report,
    "modes": _modes,
    "peaks": _peaks,
    "histories": _histories,
    "record": _record,
    "records": _records,
    "structure": _structure_toml,
    "study": _study,
    "python": _python,
}
