"""The report of a run, printed by a real Chromium: always one sheet of A4, with nothing cut off."""

import io

import pytest
from matplotlib.figure import Figure

import rockflex as rf
import rockflex.plot._run_sheet
from report_case import FRAME, HELD, PIER, PULSE, SPRINGS, runs

pytestmark = pytest.mark.web
pypdf = pytest.importorskip("pypdf", reason="pages are counted by pypdf, of rockflex[dev]")

TALL = rf.Frame(10, 3.0, 40e3, 40e3, 1.0, period=1.5, aspect_ratio=8.0, damping_ratio=0.02)
HOLLOW = rf.Section.box(width=5.0, depth=2.5, wall=0.35, elastic_modulus=33e9, density=2500, stiffness_factor=0.5)
BRIDGE = rf.CantileverWithTipMass(
    height=15.0, section=HOLLOW, tip_mass=900e3, base_mass=200e3, half_width=3.0, damping_ratio=0.03
)
LONG = rf.GroundMotion(PULSE.acceleration, PULSE.dt, name="the_name_of_a_record_that_does_not_end " * 8)
MOST = ("2DOF-S", "3DOF-S", "MDOF-S", "2DOF-C", "3DOF-C-SI", "fixed")
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
CASES = {
    "one": (FRAME, PULSE, ["2DOF-S"], {}),
    "four": (TALL, EL_CENTRO, ["2DOF-S", "3DOF-S", "MDOF-S", "fixed"], {}),
    "six": (rf.Restrained(TALL, rf.ViscousDamper(1e5)), PULSE, MOST, {}),
    "section": (BRIDGE, PULSE, ["2DOF-S", "MDOF-S", "fixed"], {}),
    "elements": (HELD, EL_CENTRO.scaled(2.0), ["2DOF-S", "MDOF-S", "fixed"], {}),
    "springs": (HELD, EL_CENTRO, ["2DOF-S", "MDOF-S"], {"ground": SPRINGS}),
    "sliding": (FRAME, EL_CENTRO, ["2DOF-S", "MDOF-S"], {"ground": rf.Ground(friction=0.2)}),
    "overturned": (FRAME, rf.one_sine_pulse(8.0, 2.5), ["2DOF-S", "MDOF-S", "2DOF-C", "rigid"], {}),
    "fixed": (PIER, PULSE, ["fixed"], {}),
    "rigid": (rf.rigid_block(0.5, 4.0, 20e3), PULSE, ["rigid", "rigid-C"], {}),
    "names": (FRAME, LONG, ["2DOF-S", "MDOF-S"], {}),
}
FULL = ["2DOF-S", "3DOF-S", "MDOF-S", "4DOF-S", "2DOF-C", "fixed"]
NOTES = {
    "many": ["x"] * 60,
    "broken": ["a\nb"] * 200,
    "wide": "W" * 800,
    "letters": ["x"] * 800,
    "words": "Remarks of some length. " * 33,
    "ideographs": "面" * 800,
}
WORDS = {"title": "A title that goes on, as those of appendices do, " * 9, "notes": "Remarks of some length. " * 33}
MEASURE = """() => {
  const sheet = document.querySelector(".sheet");
  const end = sheet.getBoundingClientRect();
  const wide = [...document.querySelectorAll("table, p, h1, h2, dl, figure")].filter((each) => {
    const box = each.getBoundingClientRect();
    return each.scrollWidth > each.clientWidth + 1 || box.right > end.right + 1 || box.bottom > end.bottom + 1;
  });
  const rows = [...document.querySelectorAll("td, dd")].filter((cell) => cell.scrollWidth > cell.clientWidth + 1);
  const parts = [...sheet.children].map((each) => each.getBoundingClientRect());
  return {
    over: sheet.scrollHeight - sheet.clientHeight,
    wide: [...wide, ...rows].map((each) => each.outerHTML.slice(0, 80)),
    overlaps: parts.slice(1).filter((box, k) => box.top < parts[k].bottom - 1).length,
    figure: document.querySelector(".figure svg").getBoundingClientRect().height / 96 * 25.4,
  };
}"""


@pytest.fixture(scope="module")
def page(sheet):
    sheet.set_viewport_size({"width": 794, "height": 1123})
    return sheet


@pytest.fixture(scope="module")
def several_runs():
    """The runs of a report with little on it, and of one with much."""
    few = runs(FRAME, PULSE, ["2DOF-S", "MDOF-S"])
    full = [
        *runs(HELD, EL_CENTRO.scaled(2.0), FULL[:4], free_vibration=4.0, impact=rf.Restitution(0.5)),
        *runs(HELD, EL_CENTRO.scaled(2.0), FULL[4:], free_vibration=4.0),
    ]
    return (few, FRAME), (full, HELD)


@pytest.fixture
def blank(monkeypatch):
    """Figures as large as those of a report, without anything in them."""

    def figure(*_, width, height):
        return Figure((width / 25.4, height / 25.4), layout="constrained")

    for name in ("draw_run_sheet", "draw_record_strip"):
        monkeypatch.setattr(rockflex.plot._run_sheet, name, figure)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_one_sheet(page, case, tmp_path):
    structure, motion, models, options = CASES[case]
    found = runs(structure, motion, models, free_vibration=4.0, **options)
    words = WORDS if case in ("names", "six", "elements", "overturned") else {}
    path = rf.write_report(found, tmp_path / "run.html", structure=structure, motion=motion, friction=0.5, **words)
    page.emulate_media(media="null")
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    for how in ({"prefer_css_page_size": True}, {"format": "A4"})[: 2 if words else 1]:
        sheets = pypdf.PdfReader(io.BytesIO(page.pdf(**how))).pages
        assert len(sheets) == 1
        assert [round(float(side) / 72 * 25.4) for side in sheets[0].mediabox[2:]] == [210, 297]
    text = sheets[0].extract_text()
    assert all(model in text for model in models)
    page.emulate_media(media="print")
    measured = page.evaluate(MEASURE)
    assert measured["over"] <= 0
    assert measured["wide"] == []
    assert measured["overlaps"] == 0
    assert measured["figure"] >= 50.0
    assert asked == [path.as_uri()]


@pytest.mark.slow
@pytest.mark.parametrize("notes", NOTES)
@pytest.mark.usefixtures("blank")
def test_notes_of_any_kind_stay_on_the_sheet(page, several_runs, notes, tmp_path):
    page.emulate_media(media="print")
    for found, structure in several_runs:
        path = tmp_path / "run.html"
        rf.write_report(found, path, structure=structure, friction=0.3, notes=NOTES[notes], title="A long title " * 12)
        page.goto(path.as_uri())
        assert len(pypdf.PdfReader(io.BytesIO(page.pdf(format="A4"))).pages) == 1
        measured = page.evaluate(MEASURE)
        assert measured["over"] <= 0
        assert measured["overlaps"] == 0
        assert measured["figure"] >= 40.0
