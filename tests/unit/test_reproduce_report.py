"""The report on a publication, and what its targets may import."""

import ast
import csv
import io
import re
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import rockflex
from page import Page, check_page
from rockflex import report
from rockflex.papers.silva_stojadinovic_2024 import _comparison as compare
from rockflex.papers.silva_stojadinovic_2024._comparison import RemarkKind, ResampledInterval, Verdict
from rockflex.papers.silva_stojadinovic_2024._targets import TARGETS, target_title
from rockflex.report._document import FinishedResult, PublicationReport, Remark
from rockflex.report._publication_files import (
    inline_svg,
    report_numbers_to_csv,
    report_to_html,
    report_to_markdown,
    write_publication_report,
)

MEANINGS = {str(verdict): verdict.meaning for verdict in Verdict}
KINDS = {str(kind): kind.meaning for kind in RemarkKind}
NUMBERS = (
    compare.number("ω_1 <b>", "Table 3", "1.66", 1.6557, "rad/s"),
    compare.number("a|b & c_*", "Section 1", "0.27", 0.16, note='says "so" & <more>'),
    compare.statistic("R²", "Section 3.3", "0.99", ResampledInterval(0.983, 0.978, 0.988)),
    compare.statement("friction", "Section 3.1", "higher than 2", float("inf"), "> 2", agreed=Verdict.EQUIVALENT),
    compare.statistic("difference", "Section 3.2", "0.002", ResampledInterval(0.00093, 0.00064, 0.00329), "rad"),
    compare.count("pairs that rock", "Section 3.3", "693", ResampledInterval(882.0, 867.0, 900.0)),
    compare.assumed(compare.number("u_top", "Section 4.2", "≈ 0.05", 0.0784, "m"), "D_y = 0.035 m"),
    compare.judgement("ω*_1/ω_1 less 1", "Section 3.4", "about 1", 0.33, "< 0.1"),
)
CHECKS = (
    compare.check("T_1 & <x>", "Section 3.1", "0.5", 0.5, unit="s"),
    compare.check("M_r", "Table 2", "m_tot g B", 1.1, "< 1"),
)
computed = []
ROOT = Path(rockflex.__file__).parent


def remark():
    computed.append(1)
    return Remark(RemarkKind.AFTERWARDS, "Slices <b>", "20 of 20 & more.", ("h*_2 | m", "met"), [("51.33", "yes")])


def drawing():
    figure = Figure((3, 2))
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], marker="o")
    axes.set_title("x$_1$")
    return figure


@pytest.fixture(scope="module")
def document():
    sections = [
        report.ReproducedResult(
            "figure-3",
            "First & <only>",
            NUMBERS,
            {"figure-3": drawing, "figure-3-spread": drawing},
            "A note_1.",
            CHECKS,
            (remark, lambda: Remark(RemarkKind.BESIDE, "Short", "No table.")),
        ),
        report.ReproducedResult("table-1", "Second"),
    ]
    sections = [section.finished() for section in sections]
    return PublicationReport("A title", "A source", "72 records", {"rockflex": "1.2"}, MEANINGS, KINDS, sections)


@pytest.fixture(scope="module")
def folder(document, tmp_path_factory):
    out = tmp_path_factory.mktemp("report")
    files = write_publication_report(document, out)
    assert [file.name for file in files] == [
        "figure-3.svg", "figure-3-spread.svg", "report.html", "report.md", "numbers.csv",
    ]  # fmt: skip
    return out


def test_the_page_stands_alone(folder):
    text = (folder / "report.html").read_text("utf-8")
    page = check_page(text, 2)
    assert "prefers-color-scheme: dark" in text
    assert "@media print" in text
    assert "ω_1 <b>" in page.cells
    assert "<b>Records" in text
    assert text.count("First &amp; &lt;only&gt;") == 3  # heading and two figures
    assert any('says "so" & <more>' in cell for cell in page.cells)


def test_every_number_and_verdict_is_in_the_page(folder, document):
    page = Page((folder / "report.html").read_text("utf-8"))
    for line in NUMBERS:
        for text in (line.place, line.name, line.printed, line.ours_as_text, line.difference_as_text, line.verdict):
            assert str(text) in page.cells
    assert document.counts == {
        "reproduced": 1, "compatible": 1, "equivalent specimen": 1, "cannot tell": 1, "cannot be compared": 1,
        "parameter not given": 1, "authors' judgement": 1, "does not reproduce": 1,
    }  # fmt: skip
    assert page.cells.count("a|b & c_*") == 2  # among those that do not reproduce, and in its section


def test_checks_and_remarks_are_shown_and_not_counted(folder, document):
    page, plain = (folder / "report.html").read_text("utf-8"), (folder / "report.md").read_text("utf-8")
    assert sum(document.counts.values()) == len(NUMBERS)
    assert f"<caption>{len(NUMBERS)} numbers</caption>" in page
    for text in (page, plain):
        assert "1 of 2 checks of ourselves hold" in text
        assert all(meaning in text for meaning in KINDS.values())
        assert "No table." in text
    cells = Page(page).cells
    assert {"T_1 & <x>", "m_tot g B", "51.33"} <= set(cells)
    assert [cell for cell in cells if cell in ("yes", "no")] == ["yes", "no", "yes"]
    assert "Slices &lt;b&gt;" in page
    assert ">h*_2 | m<" in page
    assert r"| h\*\_2 \| m | met |" in plain
    assert "**Remark, chosen after the fact: Slices" in plain
    assert "T_1 &" not in (folder / "numbers.csv").read_text("utf-8")


def test_a_result_is_drawn_once_and_when_it_is_finished(document):
    assert computed == [1]  # for the page and the Markdown together
    before = report.ReproducedResult("figure-3", "First", remarking=(remark,))
    assert computed == [1]
    assert before.finished().remarks[0].rows == [("51.33", "yes")]
    assert computed == [1, 1]
    assert before.finished(whole=False).remarks == ()
    assert computed == [1, 1]


def test_a_finished_result_is_stored_without_loss(document):
    first = document.sections[0]
    again = FinishedResult.from_json(first.to_json())
    assert again.to_json() == first.to_json()
    assert again.drawings == first.drawings
    assert [line.ours for line in again.numbers] == [line.ours for line in NUMBERS]  # an infinite one, too
    for write in (report_to_html, report_to_markdown, report_numbers_to_csv):
        stored = [FinishedResult.from_json(section.to_json()) for section in document.sections]
        assert write(replace(document, sections=stored)) == write(document)


def test_a_number_named_like_a_formula_is_a_text(document):
    first = document.sections[0]
    numbers = [replace(first.numbers[0], name="=1+1", note="@SUM(A1)"), *first.numbers[1:]]
    text = report_numbers_to_csv(replace(document, sections=[replace(first, numbers=numbers)]))
    row = next(csv.DictReader(io.StringIO(text)))
    assert (row["name"], row["note"]) == ("'=1+1", "'@SUM(A1)")


def test_a_report_says_what_it_lacks(folder, document):
    part = replace(document, missing=["figure-9", "sliding"])
    for whole, text in (
        ((folder / "report.html").read_text("utf-8"), report_to_html(part)),
        ((folder / "report.md").read_text("utf-8"), report_to_markdown(part)),
    ):
        assert "figure-9, sliding" in text
        assert "figure-9" not in whole
        assert "Unfinished" not in whole
    check_page(report_to_html(part), 2)


def test_figures_that_are_there_are_not_written_again(document, tmp_path):
    files = write_publication_report(document, tmp_path, only="table-1")
    assert [file.name for file in files if not file.exists()] == ["figure-3.svg", "figure-3-spread.svg"]
    check_page((tmp_path / "report.html").read_text("utf-8"), 2)


def test_a_page_without_failures_has_no_list_of_them(document):
    fine = replace(document, sections=[FinishedResult("table-1", "Second", NUMBERS[:1])])
    text = report_to_html(fine)
    check_page(text, 0)
    assert 'id="failing"' not in text
    assert "Checks of ourselves, not counted" not in text


def test_markdown_holds_the_same(folder, document):
    text = (folder / "report.md").read_text("utf-8")
    assert text == report_to_markdown(document)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert len({len(re.findall(r"(?<!\\)\|", row)) for row in rows}) == 4  # of the four kinds of table
    assert r"a\|b & c\_\*" in text
    assert "**does not reproduce**" in text
    for stem in re.findall(r"\]\(([^)]*)\)", text):
        assert (folder / stem).is_file()


def test_the_table_has_all_digits(folder, document):
    text = (folder / "numbers.csv").read_text("utf-8")
    assert text == report_numbers_to_csv(document)
    rows = list(csv.DictReader(io.StringIO(text)))
    assert [row["verdict"] for row in rows] == [str(line.verdict) for line in NUMBERS]
    assert [float(row["rockflex"]) for row in rows] == [line.ours for line in NUMBERS]
    assert rows[3]["rockflex"] == "inf"
    assert rows[1]["note"] == 'says "so" & <more>'


def test_inline_figures_do_not_share_names():
    text = (
        '<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" width="3pt" height="2pt" viewBox="0 0 3 2">'
        '<metadata>http://x</metadata><!-- c --><style type="text/css">*{a: b}</style><defs><path id="m1"/></defs>'
        '<g id="g" clip-path="url(#p)"><use xlink:href="#m1"/>'
        '<image xlink:href="data:image/png;base64,AA=="/></g></svg>'
    )
    assert inline_svg(text, "f", "label") == (
        '<svg viewBox="0 0 3 2" role="img" aria-label="label" class="drawing"><defs><path id="f-m1"/></defs>'
        '<g id="f-g" clip-path="url(#f-p)"><use href="#f-m1"/><image href="data:image/png;base64,AA=="/></g></svg>'
    )


def imported(source):
    """Modules of ours that a source imports, wherever it does."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found.add("." * node.level + (node.module or ""))
    return {name for name in found if name.startswith((".", "rockflex"))}


def beyond(source, allowed):
    """What it imports of ours besides these modules and what is in them."""
    return {name for name in imported(source) if not any(name == a or name.startswith(f"{a}.") for a in allowed)}


ALLOWED = (
    "rockflex.papers",
    "rockflex.report",
    "rockflex.foundation.arrays",
)  # results are filled in, arrays only named
LIBRARY = ("population", "_equivalents")  # parts of the library that only the paper needs


def targets():
    """Modules of the papers that reproduce something, or help with it."""
    paths = sorted((ROOT / "papers").rglob("*.py"))
    return [path for path in paths if not any(part in (*path.parts, path.stem) for part in LIBRARY)]


@pytest.mark.parametrize("path", targets(), ids=lambda path: path.stem)
def test_papers_use_the_public_front_alone(path):
    others = imported(path.read_text("utf-8")) - {"rockflex"}
    assert {name for name in others if not name.startswith(ALLOWED)} == set()


@pytest.mark.parametrize("path", sorted((ROOT / "report").glob("_[dp]*.py")), ids=lambda path: path.stem)
def test_the_report_of_the_paper_knows_figures_and_files(path):
    known = {"rockflex.report", "rockflex.plot", "rockflex.foundation.csv", "rockflex.foundation.files"}
    assert beyond(path.read_text("utf-8"), known) == set()


def test_the_walk_sees_what_is_forbidden():
    source = "import rockflex as rf\ndef f():\n    from rockflex.response import Response\n    from ..motion import x\n"
    assert imported(source) == {"rockflex", "rockflex.response", "..motion"}
    assert beyond(source, {"rockflex.plot"}) == {"rockflex", "rockflex.response", "..motion"}


def test_every_target_has_a_title_of_its_own():
    titles = [target_title(target) for target in TARGETS]
    assert len(set(titles)) == len(titles)
