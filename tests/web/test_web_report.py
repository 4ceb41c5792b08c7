"""The report of the Response tab, the page on paper, and warnings about a structure."""

import io
import re

import pytest

import rockflex as rf
from rockflex.web import _report
from rockflex.web._presets import PRESETS

STATE = {"models": ["2DOF-S", "MDOF-S", "fixed"], "scale": 1.5}
TONNES = {
    "cantilever": {
        "height": 12.0,
        "tip_mass": 60.0,
        "mass_per_length": 4e3,
        "bending_stiffness": 2e9,
        "base_mass": 50e3,
        "half_width": 1.5,
        "damping_ratio": 0.02,
    }
}
BED = {"base_inertia": 5e5, "springs": {"positions": [-1.0, 0.0, 1.0], "stiffness": 4e8, "damping": 1e6}}


def test_the_report_has_the_numbers_of_the_tab(client) -> None:
    state = client.state(**STATE)
    name, body = client.download("/api/download/report", state)
    assert name == "report.html"
    text = body.decode()
    for each in client.ask("/api/response", state)["models"]:
        value = float(re.search(f'<td>{each["label"]}</td>.*?data-of="max_base_moment" data-value="([^"]+)"', text)[1])
        assert value == each["peaks"]["max_base_moment"]
    assert "<title>Structure #1 of Table 1 under EL-CENTRO-1940-NS × 1.5</title>" in text
    assert "http" not in text
    assert "<script" not in text
    assert "not computed" not in text


def test_names_of_visitors_are_text(client) -> None:
    structure = PRESETS[0]["structure"] | {"name": "<img src=x onerror=alert(1)>"}
    text = client.download("/api/download/report", client.state(structure=structure))[1].decode()
    assert "&lt;img src=x onerror=alert(1)&gt;" in text
    assert "<img" not in text


def test_what_takes_long_is_left_out_and_said(client, monkeypatch) -> None:
    on_springs = client.state(models=["2DOF-S"], ground=BED)
    text = client.download("/api/download/report", on_springs)[1].decode()
    assert text.count("<td>not computed</td>") == 2
    assert "Not computed: energies and friction of a run that would take too long here." in text
    monkeypatch.setattr(rf.History, "required_friction", property(lambda _: pytest.fail("computed")))
    client.download("/api/download/report", on_springs)

    def refuse(*_):
        raise _report.Refusal({"energy": "too long"})

    monkeypatch.setattr(_report, "check_energy", refuse)
    text = client.download("/api/download/report", client.state(models=["2DOF-S"]))[1].decode()
    assert text.count("<td>not computed</td>") == 2


def test_the_structure_tab_has_the_warnings(client) -> None:
    assert client.ask("/api/structure", client.state())["warnings"] == []
    (warning,) = client.ask("/api/structure", client.state(structure=TONNES))["warnings"]
    assert "The tip has a mass of 60 kg, less than a tenth of the 48000 kg" in warning


@pytest.mark.web
def test_a_warning_is_seen(visit, link) -> None:
    visitor = visit(link({"structure": TONNES}))
    visitor.page.wait_for_selector("#warnings")
    assert "Masses are in kg: a tonne is 1000 kg." in visitor.page.locator("#warnings").inner_text()


@pytest.mark.web
@pytest.mark.parametrize("tab", ["structure", "earthquake", "response", "fragility", "design"])
def test_a_tab_on_paper(visit, tab) -> None:
    pypdf = pytest.importorskip("pypdf", reason="pages are read by pypdf, of rockflex[dev]")
    visitor = visit(color_scheme="dark")
    page = visitor.page
    visitor.tab(tab)
    if tab == "response":
        visitor.shown(1, ["MDOF-S", "2DOF-S", "fixed"])
    if tab == "design":
        visitor.fill("design.widths", "3")
    if tab in ("fragility", "design"):
        visitor.run_study()
    page.wait_for_load_state("networkidle")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    assert page.evaluate("document.documentElement.dataset.theme") == "light"
    shown = page.evaluate(
        """() => [...document.querySelectorAll("input, textarea, button, header, form")]
          .filter((e) => e.checkVisibility()).map((e) => e.outerHTML.slice(0, 80))"""
    )
    assert shown == []
    assert page.get_by_text("Point at one of these charts").locator("visible=true").count() == 0
    wide = page.evaluate(
        """() => [...document.querySelectorAll("#view *")].filter((e) => e.checkVisibility()
            && e.getBoundingClientRect().right > document.querySelector("main").getBoundingClientRect().right + 1)
          .map((e) => e.outerHTML.slice(0, 80))"""
    )
    assert wide == []
    # The numbers at the axes have the colour of the light theme, and none that of the dark one.
    inks = page.evaluate(
        """() => [...document.querySelectorAll(".chart canvas")].filter((c) => c.checkVisibility()).map((c) => {
          const { data } = c.getContext("2d").getImageData(0, 0, c.width, c.height);
          const count = (r, g, b) => {
            let n = 0;
            for (let i = 0; i < data.length; i += 4)
              n += data[i] === r && data[i + 1] === g && data[i + 2] === b && data[i + 3] === 255;
            return n;
          };
          return [c.width / c.clientWidth, count(0x5a, 0x64, 0x70), count(0xa2, 0xac, 0xb8)];
        })"""
    )
    assert inks or tab == "structure"
    assert all(ratio == pytest.approx(3.0, rel=0.01) and light > 0 and dark == 0 for ratio, light, dark in inks)
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.emulate_media(media="screen")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    assert page.locator("header").is_visible()
    sheets = pypdf.PdfReader(io.BytesIO(page.pdf(prefer_css_page_size=True))).pages
    assert 1 <= len(sheets) <= 3
    text = sheets[0].extract_text()
    assert "Structure #1 of Table 1" in text
    assert "Copy link" not in text
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"  # as before
