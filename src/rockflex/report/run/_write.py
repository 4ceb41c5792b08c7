"""The report of a run as a file."""

from collections.abc import Collection, Iterable
from datetime import date as Date  # noqa: N812
from pathlib import Path
from typing import Any

from rockflex._errors import InputError
from rockflex._files import path_of, write_whole
from rockflex._shown import shown
from rockflex.motion import GroundMotion
from rockflex.report.run._given import given
from rockflex.report.run._page import html_of, page_of
from rockflex.response import Response, friction_coefficient

SUFFIXES = (".html", ".htm")
_MOST = 800  # letters of all notes


def write_report(
    responses: Response | Iterable[Response],
    path: str | Path,
    *,
    structure: Any = None,
    motion: GroundMotion | None = None,
    title: str | None = None,
    date: str | Date | None = None,
    friction: float | None = None,
    notes: str | Iterable[str] = (),
) -> Path:
    """Write what a structure did under one record on one sheet of A4, as HTML that needs nothing else.

    The page has the parameters of the structure and its modes, the record, what is assumed, the histories and the loop
    of base moment and rotation of every model, their largest values, checks with their warnings, and the versions
    that computed them. Any browser prints it on exactly one sheet.

    The checks compare the rotation with the nominal limit of overturning, 0.7 atan(B/h*_1) (Section 3.3), the vertical
    reaction with zero, the friction that each run requires (Eqs. 20-22) with `friction`, the forces of tendons with
    those at which they yield, and the balance of the energies with zero. Friction and energies of a run on many stiff
    springs would take minutes; they are left out, and the page says so.

    Parameters
    ----------
    responses
        Up to six responses of one structure to one record at one scale, each with its history.
    path
        The file to write, which ends in .html; an existing file is replaced. Missing folders are created.
    structure
        The structure, or its `RockingProperties`: it gives the page its kind, and all of its modes. Default: the
        properties of the response with the most modes.
    motion
        The record, scaled or not: the page then has its origin, its measures and its scale, relative to the
        record as `RecordInfo.scale` knows it. Default: the ground acceleration of the responses.
    title
        Heading. Default: the kind of the structure, and the record.
    date
        Date on the page. Default: today.
    friction
        Coefficient of friction between base and ground, to compare with the one that each run requires.
    notes
        A text, or several, to add to the page; up to 800 letters together.

    Returns
    -------
    Path
        The file written. It is written completely or not at all.

    Raises
    ------
    InputError
        If there are no responses or more than six, one has no history, they are not of one structure and one record, or
        `structure` or `motion` are not theirs; if the path is a folder or has another suffix, or cannot be written to;
        if the friction is not positive, or the notes are too long.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> pulse = rf.ricker_pulse(4.0, 0.6)
    >>> runs = [rf.simulate(frame, pulse, model, output="history") for model in ("2DOF-S", "MDOF-S", "fixed")]
    >>> folder = Path(tempfile.mkdtemp())
    >>> rf.write_report(runs, folder / "report.html", structure=frame, motion=pulse, friction=0.5).name
    'report.html'
    """
    target = checked_path("path", path)
    text = report_html(
        responses, structure=structure, motion=motion, title=title, date=date, friction=friction, notes=notes
    )
    try:
        return write_whole(target, text.encode())
    except OSError as error:
        raise InputError(
            f"Cannot write to {target}: {error.strerror or error}. Give a path that can be written to.", field="path"
        ) from error


def report_html(
    responses: Response | Iterable[Response],
    *,
    structure: Any = None,
    motion: GroundMotion | None = None,
    title: str | None = None,
    date: str | Date | None = None,
    friction: float | None = None,
    notes: str | Iterable[str] = (),
    omitted: Collection[str] = (),
) -> str:
    """Return the page of `write_report` as text; no energies and no friction of the models in `omitted`."""
    heading, day = _heading(title), _day(date)
    coefficient = None if friction is None else _coefficient(friction)
    told = _notes(notes)
    about = given(responses, structure, motion)
    page = page_of(
        about,
        title=heading,
        date=day,
        friction=coefficient,
        warnings=_structure_warnings(about.properties if structure is None else structure),
        notes=told,
        omitted=omitted,
    )
    return html_of(page, about)


def checked_path(name: str, path: str | Path) -> Path:
    """Return the path of a report.

    Raises
    ------
    InputError
        If it is a folder, or has another suffix than .html.
    """
    target = path_of(name, path)
    if target.is_dir():
        raise InputError(
            f"{name} {target} is a folder. Give a file in it, such as {target / 'report.html'}.", field="path"
        )
    if target.suffix.lower() not in SUFFIXES:
        raise InputError(
            f"A report is a page of HTML, but the {name} {shown(str(target))} ends in {shown(target.suffix)}. Let it "
            "end in .html; a browser prints the page, also as PDF.",
            field="path",
        )
    return target


def _heading(title: Any) -> str | None:
    if title is None or isinstance(title, str):
        return title
    raise InputError(f"title must be a text, but {shown(title)} was given.", field="title")


def _day(date: Any) -> str:
    if isinstance(date, str):
        return date
    if date is None or isinstance(date, Date):
        return (date or Date.today()).strftime("%Y-%m-%d")
    raise InputError(f"date must be a text or a datetime.date, but {shown(date)} was given.", field="date")


def _coefficient(friction: float) -> float:
    try:
        return friction_coefficient(friction)
    except InputError as error:
        raise InputError(str(error).replace("mu must", "friction must"), field="friction") from None


def _notes(notes: Any) -> list[str]:
    texts: list[Any] = [notes] if isinstance(notes, str) else list(notes) if isinstance(notes, Iterable) else [notes]
    for text in texts:
        if not isinstance(text, str):
            raise InputError(f"notes must be texts, but {shown(text)} was given.", field="notes")
    size = sum(map(len, texts))
    if size > _MOST:
        raise InputError(
            f"The page has room for notes of {_MOST} letters, but {size} were given. Shorten them.", field="notes"
        )
    return texts


def _structure_warnings(structure: Any) -> tuple[str, ...]:
    from rockflex.structure import structure_warnings

    return structure_warnings(structure)
