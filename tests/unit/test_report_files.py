"""Reports with a head and an appendix, as PDF and as documents of Word."""

import io
import json
import os
import shutil
import stat
import sys

import pytest
from typer.testing import CliRunner

import rockflex as rf
from report_case import FRAME, HELD, PULSE, runs
from report_page import number, read
from rockflex.cli._app import app
from rockflex.report.run._report_files import BROWSERS

HEAD = {"project": "Viaduct A7", "author": "M. Rossi & sons", "checker": "K. Weiß", "title": "Pier <3>"}
HOLLOW = rf.Section.box(width=5.0, depth=2.5, wall=0.35, elastic_modulus=33e9, density=2500, stiffness_factor=0.5)
BRIDGE = rf.CantileverWithTipMass(
    height=15.0, section=HOLLOW, tip_mass=900e3, base_mass=200e3, half_width=3.0, damping_ratio=0.03
)


@pytest.fixture(scope="module")
def held():
    return runs(HELD, PULSE, ["2DOF-S", "MDOF-S", "fixed"])


@pytest.fixture
def no_browser(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))
    monkeypatch.delenv("ROCKFLEX_BROWSER", raising=False)


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_the_head_says_who_made_it(held, tmp_path):
    text = rf.write_report(held, tmp_path / "r.html", structure=HELD, date="May 2030", **HEAD).read_text("utf-8")
    for word in ("Viaduct A7", "M. Rossi &amp; sons", "K. Weiß", "Pier &lt;3&gt;", "May 2030", "Checked by"):
        assert word in text
    assert 'class="heads"' not in rf.write_report(held, tmp_path / "r.html").read_text("utf-8")
    for name in ("project", "author", "checker"):
        with pytest.raises(rf.InputError) as caught:
            rf.write_report(held, tmp_path / "s.html", **{name: 3})
        assert caught.value.field == name
    assert not (tmp_path / "s.html").exists()


@pytest.mark.slow
def test_equal_inputs_give_equal_pages(held, tmp_path):
    one, other = (
        rf.write_report(held, tmp_path / name, structure=HELD, motion=PULSE, date="2030-01-02")
        for name in ("a.html", "b.html")
    )
    assert one.read_bytes() == other.read_bytes()


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_the_appendix_has_loops_of_every_run_that_lifts(held, tmp_path):
    one = rf.write_report(held, tmp_path / "r.html", structure=HELD).read_text("utf-8")
    more = rf.write_report(held, tmp_path / "r.html", structure=HELD, appendix=True).read_text("utf-8")
    assert (one.count("<svg"), more.count("<svg")) == (2, 4)
    for label, there in (("2DOF-S", True), ("MDOF-S", True), ("fixed", False)):
        assert (f"Loops of base and elements, {label}" in more) == there
    assert "Cross-sections" not in more
    assert "http" not in more
    plain = runs(FRAME, PULSE, ["2DOF-S"])
    nothing = rf.write_report(plain, tmp_path / "r.html", structure=FRAME, appendix=True).read_text("utf-8")
    assert 'aria-label="Appendix"' not in nothing


@pytest.mark.usefixtures("undrawn")
def test_the_appendix_has_sections_and_material(tmp_path):
    structure = rf.Eccentric(BRIDGE, 0.2)
    path = rf.write_report(runs(structure, PULSE, ["2DOF-S"]), tmp_path / "r.html", structure=structure, appendix=True)
    _, (name, *cells) = read(path).tables["sections"]
    area = 5.0 * 2.5 - 4.3 * 1.8
    second = (5.0 * 2.5**3 - 4.3 * 1.8**3) / 12.0
    expected = [area, second, 33.0, 2500.0, 0.5, 0.5 * 33e9 * second / 1e6, 2.5 * area]
    assert name[0] == "whole height"
    assert [number(text) for text, _, _ in cells] == pytest.approx(expected, rel=5.1e-4)


@pytest.mark.usefixtures("undrawn")
def test_sections_of_a_tower_at_both_ends(tmp_path):
    tower = rf.TaperedTower(
        height=50.0, base_radius=3.0, top_radius=2.0, wall=0.5, density=2400.0, elastic_modulus=25e9, damping_ratio=0.02
    )
    path = rf.write_report(runs(tower, PULSE, ["2DOF-S"]), tmp_path / "r.html", structure=tower, appendix=True)
    _, *rows = read(path).tables["sections"]
    assert [row[0][0] for row in rows] == ["base", "top"]
    ring = [3.141593 * (r**2 - (r - 0.5) ** 2) for r in (3.0, 2.0)]
    assert [number(row[1][0]) for row in rows] == pytest.approx(ring, rel=5.1e-4)


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")  # the page, whose words and numbers are read; the document has its pictures
def test_a_document_of_word_has_the_same_contents(held, tmp_path):
    docx = pytest.importorskip("docx")
    path = rf.write_report(
        held, tmp_path / "r.docx", structure=HELD, motion=PULSE, notes="A note.", appendix=True, **HEAD
    )
    page = read(rf.write_report(held, tmp_path / "r.html", structure=HELD, motion=PULSE, appendix=True, **HEAD))
    document = docx.Document(io.BytesIO(path.read_bytes()))
    texts = "\n".join(each.text for each in document.paragraphs)
    for word in (*HEAD.values(), "A note.", "Computed by rockflex", "Loops of base and elements, MDOF-S"):
        assert word in texts
    assert (document.core_properties.title, document.core_properties.author) == (HEAD["title"], HEAD["author"])
    tables = {table.rows[0].cells[1].text: table for table in document.tables}
    for name, key in (("peaks", "status"), ("checks", "uplift")):
        _, *expected = page.tables[name]
        found = [[cell.text for cell in row.cells] for row in tables[key].rows][1:]
        assert [[plain(text) for text in row] for row in found] == [
            [plain(text) for text, _, _ in row] for row in expected
        ]
    assert len(document.inline_shapes) == 4  # the record, all runs, and the loops of two
    assert (document.sections[0].page_width.mm, document.sections[0].page_height.mm) == pytest.approx(
        (210, 297), abs=0.1
    )


def plain(text):
    """A text without blanks and marks of subscripts."""
    return "".join(text.split()).replace("_", "").replace("^", "")


@pytest.mark.slow
def test_subscripts_and_superscripts_of_word(held, tmp_path):
    docx = pytest.importorskip("docx")
    document = docx.Document(rf.write_report(held, tmp_path / "r.docx", structure=HELD))
    parts = [
        part
        for table in document.tables
        for row in table.rows
        for cell in row.cells
        for text in cell.paragraphs
        for part in text.runs
    ]
    assert {"max", "nom"} <= {part.text for part in parts if part.font.subscript}
    assert not [part.text for part in parts if "_" in part.text]


def test_without_python_docx_it_says_what_to_install(held, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "docx", None)
    with pytest.raises(rf.InputError, match=r"rockflex\[docx\]") as caught:
        rf.write_report(held, tmp_path / "r.docx")
    assert caught.value.field == "path"


def test_without_a_browser_a_pdf_is_refused(held, tmp_path, no_browser, monkeypatch):
    with pytest.raises(rf.InputError, match=r"chromium.*ends in \.html") as caught:
        rf.write_report(held, tmp_path / "r.pdf")
    assert caught.value.field == "path"
    monkeypatch.setenv("ROCKFLEX_BROWSER", "no-such-program")
    with pytest.raises(rf.InputError, match="no-such-program, which is no program"):
        rf.write_report(held, tmp_path / "r.pdf")


@pytest.mark.skipif(os.name == "nt", reason="the browser is a shell script")
def test_a_browser_that_prints_nothing_is_told(held, tmp_path, monkeypatch):
    browser = tmp_path / "browser"
    browser.write_text("#!/bin/sh\necho broken pipe of colours >&2\n")
    browser.chmod(browser.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("ROCKFLEX_BROWSER", str(browser))
    with pytest.raises(rf.InputError, match="printed no PDF: broken pipe of colours"):
        rf.write_report(held, tmp_path / "r.pdf")
    assert not (tmp_path / "r.pdf").exists()


@pytest.mark.slow
@pytest.mark.web
@pytest.mark.skipif(not any(map(shutil.which, BROWSERS)), reason="needs a browser of the Chromium family")
def test_a_pdf_has_the_sheet_and_numbered_pages(held, tmp_path):
    pypdf = pytest.importorskip("pypdf")
    for more in (False, True):
        path = rf.write_report(held, tmp_path / "r.pdf", structure=HELD, appendix=more, **HEAD)
        pages = pypdf.PdfReader(path).pages
        assert (len(pages) == 1) != more
        assert "Viaduct A7" in pages[0].extract_text()
        for place, page in enumerate(pages, 1):
            assert f"{place} / {len(pages)}" in page.extract_text()
            assert [round(float(side) / 72 * 25.4) for side in page.mediabox[2:]] == [210, 297]


FILE = """
name = "Pier"
elements = [{kind = "tendon", initial_force = 8e5, stiffness = 2e7}]
frame = {n_stories = 2, story_height = 3.0, story_mass = 4e4, base_mass = 4e4, stiffness_ratio = 1.0, \
period = 0.5, aspect_ratio = 8.0, damping_ratio = 0.02}
[report]
project = "Viaduct A7"
author = "M. Rossi"
appendix = true
"""


@pytest.mark.slow
def test_the_head_from_a_structure_file_and_from_flags(tmp_path):
    file, page = tmp_path / "pier.toml", tmp_path / "r.html"
    file.write_text(FILE, "utf-8")
    known = [str(file), "el-centro-1940", "--model", "2DOF-S", "--report", str(page), "--json"]
    done = CliRunner().invoke(app, ["run", *known, "--report-author", "A. Nother", "--report-checker", "K. Weiß"])
    assert done.exit_code == 0, done.output
    assert "report" not in json.loads(done.stdout)["structure"]
    text = page.read_text("utf-8")
    assert all(word in text for word in ("Viaduct A7", "A. Nother", "K. Weiß", "Appendix", "Pier under EL-CENTRO"))
    assert "M. Rossi" not in text
    assert isinstance(rf.read_structure(file), rf.Restrained)
    refused = CliRunner().invoke(app, ["run", str(file), "el-centro-1940", "--report-project", "x"])
    assert refused.exit_code == 2
    assert "--report" in refused.stderr
    file.write_text(FILE.replace("author", "autor"), "utf-8")
    refused = CliRunner().invoke(app, ["run", *known, "--force"])
    assert refused.exit_code == 2
    assert "author" in refused.stderr
