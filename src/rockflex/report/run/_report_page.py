"""Reports of runs, of sets of records and of comparisons, written as HTML, PDF or documents of Word."""

from collections.abc import Collection, Iterable
from dataclasses import fields, replace
from datetime import date as Date  # noqa: N812
from pathlib import Path
from typing import Any

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path, write_given_file
from rockflex.foundation.language import Language, chosen_language, use_language
from rockflex.foundation.shown import shown
from rockflex.foundation.units import Decimal, SystemName, checked_unit_system, with_decimal_commas
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._suite import Selection
from rockflex.report.run._comparison_page import comparison_page
from rockflex.report.run._report_appendix import ReportAppendix
from rockflex.report.run._report_files import chromium, page_as_pdf, report_as_word, word_module
from rockflex.report.run._report_tables import ReportCell, ReportedRecord, ReportFact, ReportTable
from rockflex.report.run._run_page import run_page
from rockflex.report.run._set_page import set_page
from rockflex.report.run._sheet import Figures, ReportPage, checked_report_texts, page_as_html
from rockflex.response._comparison import Comparison
from rockflex.response._limit_checks import CheckLimits
from rockflex.response._record_set import RecordSet
from rockflex.response._response import Response

SUFFIXES = (".html", ".htm", ".pdf", ".docx")
_AS_GIVEN = {"title", "texts", "versions", "inputs"}  # parts of a page that keep their decimal points


def write_report(
    responses: Response | Iterable[Response] | RecordSet | Comparison,
    path: str | Path,
    *,
    structure: Any = None,
    motion: GroundMotion | None = None,
    title: str | None = None,
    date: str | Date | None = None,
    friction: float | None = None,
    notes: str | Iterable[str] = (),
    project: str = "",
    author: str = "",
    checker: str = "",
    appendix: bool = False,
    limits: CheckLimits | None = None,
    selection: Selection | None = None,
    units: SystemName = "kN",
    language: Language = "en",
    decimal: Decimal | None = None,
) -> Path:
    """Write the response of a structure to one record on one sheet of A4: HTML that needs no other file, PDF or DOCX.

    The page has the parameters of the structure and its modes, the record, what is assumed, the histories and the loop
    of base moment and rotation of every model, their largest values, checks with their warnings, and the versions
    that computed them. Any browser prints it on exactly one sheet. A PDF is that page, printed by Chromium, Chrome or
    Edge, found on the path or named by the environment variable ``ROCKFLEX_BROWSER``. A document of Word has the same
    contents, on as many sheets as they take; it needs the extra ``rockflex[docx]``.

    The checks compare the rotation with the nominal limit of overturning, 0.7 atan(B/h*_1) (Section 3.3), the vertical
    reaction with zero, the friction that each run requires (Eqs. 20-22) with `friction`, the forces of tendons with
    those at which they yield, and the balance of the energies with zero. Friction and energies of a run on many stiff
    springs would take minutes; they are left out, and the page says so.

    Parameters
    ----------
    responses
        Up to six responses of one structure to one record at one scale, each with its history. Or what `simulate_set`
        returned: then the page has the peaks by record, their statistics, the values for design and the checks, on as
        many sheets as it takes. Or a `Comparison`: then it has all alternatives as they rock, their demands with the
        differences, statistics over several records, and the histories under the governing one.
    path
        The file to write, which ends in .html, .pdf or .docx; an existing one is replaced. Missing folders are created.
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
    project, author, checker
        Texts for a line below the heading.
    appendix
        Whether further sheets follow: cross-sections with their material, if the structure has any, and the loops of
        base and elements of every run that lifts.
    limits
        Limits of `check`, whose table the page of a run then has for every model. A set has it always.
    selection
        The choice of the records of a set: the page then draws their spectra with the target, the range of periods and
        the first period of the structure.
    units
        Units of tables and figures: ``"kN"`` (kN, kN m or MN m, mm and m, t, g), ``"MN"`` (MN, mm and m, t, g),
        ``"SI"`` (N, m, kg, m/s²) or ``"kip-in"`` (kip, in, kip s²/in, g). Warnings have units of their own.
    language
        Language of the report: ``"en"``, ``"de"``, ``"it"``, ``"fr"`` or ``"es"``. What users write, such as names,
        stays as it is.
    decimal
        The decimal sign of tables, texts and figures, ``"."`` or ``","``. Default: that of the language, a comma in all
        but English. The values in the attributes ``data-value``, which are for programs and in SI units, have points.

    Returns
    -------
    Path
        The file written. It is written completely or not at all.

    Raises
    ------
    InputError
        If there are no responses or more than six, one has no history, they are not of one structure and one record, or
        `structure` or `motion` are not theirs; if the path is a folder or has another suffix, or cannot be written to;
        if the friction is not positive, the notes are too long, or `units`, `language` or `decimal` is none of these;
        if there is no browser for a PDF, or python-docx is not installed; if an option is given that a set or a
        comparison does not take.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> pulse = rf.ricker_pulse(4.0, 0.6)
    >>> runs = [rf.simulate(frame, pulse, model, output="history")
    ...     for model in ("2DOF-S", "MDOF-S", "fixed")]
    >>> folder = Path(tempfile.mkdtemp())
    >>> rf.write_report(runs, folder / "report.html", structure=frame,
    ...     motion=pulse, friction=0.5).name
    'report.html'
    """
    target = checked_report_path("path", path)
    given: dict[str, Any] = {"title": title, "date": date, "notes": notes, "project": project, "author": author}
    given |= {"checker": checker, "structure": structure, "motion": motion, "friction": friction}
    with use_language(language, decimal):
        given |= {"appendix": appendix, "limits": limits, "selection": selection}
        page, figures = _page_of_report(responses, units=units, **given)
        if target.suffix.lower() == ".docx":
            from rockflex.plot._figures import figure_as_png

            drawings = {stem: (label, figure_as_png(figure)) for stem, (label, figure) in figures.items()}
            content = report_as_word(page, drawings)
        else:
            text = page_as_html(page, figures)
            content = page_as_pdf(text) if target.suffix.lower() == ".pdf" else text.encode()
    return write_given_file(target, content)


def run_report_as_html(
    responses: Response | Iterable[Response] | RecordSet | Comparison,
    *,
    language: Language = "en",
    decimal: Decimal | None = None,
    **options: Any,
) -> str:
    """Return the page of `write_report` with these options as text; no energies and no friction of models `omitted`."""
    with use_language(language, decimal):
        return page_as_html(*_page_of_report(responses, **options))


def _page_of_report(
    responses: Response | Iterable[Response] | RecordSet | Comparison,
    *,
    title: str | None = None,
    date: str | Date | None = None,
    notes: str | Iterable[str] = (),
    project: str = "",
    author: str = "",
    checker: str = "",
    units: SystemName = "kN",
    omitted: Collection[str] = (),
    selection: Selection | None = None,
    **options: Any,
) -> tuple[ReportPage, Figures]:
    """Return the contents of a report, and its figures; `options` are those of its kind."""
    from rockflex.plot._figures import figures_in_units

    texts = checked_report_texts(title, date, notes, project, author, checker)
    system = checked_unit_system(units)
    given = {name: value for name, value in options.items() if value is not None and value is not False}
    given |= {} if selection is None else {"selection": selection}
    with figures_in_units(system):
        if isinstance(responses, RecordSet):
            _refuse_unused_options("a set", given, ("structure", "limits", "selection"))
            page, figures = set_page(responses, texts, system, **given)
        elif isinstance(responses, Comparison):
            _refuse_unused_options("a comparison", given, ("sets", "checks"))
            page, figures = comparison_page(responses, texts, system, **given)
        else:
            _refuse_unused_options("runs", given, options)
            page, figures = run_page(responses, texts, system, omitted=omitted, **options)
    return _with_decimal_commas(page) if chosen_language()[1] == "," else page, figures


def _with_decimal_commas(part: Any) -> Any:
    """Return contents of a page with decimal commas; what users wrote, and versions, stay as they are."""
    if isinstance(part, str):
        return with_decimal_commas(part)
    if isinstance(part, list | tuple):
        return type(part)(map(_with_decimal_commas, part))  # pyright: ignore[reportUnknownArgumentType]
    if isinstance(part, ReportPage | ReportTable | ReportFact | ReportCell | ReportedRecord | ReportAppendix):
        own = [each.name for each in fields(part) if each.name not in _AS_GIVEN]
        return replace(part, **{name: _with_decimal_commas(getattr(part, name)) for name in own})
    return part


def _refuse_unused_options(what: str, given: Collection[str], taken: Collection[str]) -> None:
    unused = next((name for name in given if name not in taken), None)
    if unused == "friction" and "limits" in taken:
        raise InputError(
            "The report of a set has the friction among its limits. Leave friction out, and give "
            "limits=CheckLimits(friction=...).",
            field="friction",
        )
    if unused is not None:
        raise InputError(f"A report of {what} takes no {unused}. Leave it out.", field=unused)


def checked_report_path(name: str, path: str | Path) -> Path:
    """Return the path of a report."""
    target = checked_file_path(name, path)
    if target.is_dir():
        raise InputError(
            f"{name} {target} is a folder. Give a file in it, such as {target / 'report.html'}.", field="path"
        )
    if target.suffix.lower() not in SUFFIXES:
        raise InputError(
            f"{name} must end in .html, .pdf or .docx, a page of HTML, a PDF or a document of Word, but "
            f"{shown(str(target))} was given.",
            field="path",
        )
    needed = {".pdf": chromium, ".docx": word_module}.get(target.suffix.lower())
    if needed is not None:
        needed()  # raises where it is missing, before anything is computed
    return target
