"""The files of the page that take long: the report and the animation."""

import io
import json
import re
import socket
import time

import pytest
from PIL import Image

import rockflex as rf
from rockflex.web import _downloads, _response
from rockflex.web._downloads import animation_file
from rockflex.web._forms import PRESETS
from rockflex.web._jobs import BackgroundFileJob
from rockflex.web._state import parse_page_state
from rockflex.web._uploads import UploadedRecords

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


@pytest.mark.slow
def test_the_report_has_the_numbers_of_the_tab(client) -> None:
    state = client.state(**STATE)
    name, body = client.download("/api/file/report", state)
    assert name == "report.html"
    text = body.decode()
    for each in client.ask("/api/response", state)["models"]:
        value = float(re.search(f'<td>{each["label"]}</td>.*?data-of="max_base_moment" data-value="([^"]+)"', text)[1])
        assert value == each["peaks"]["max_base_moment"]
    assert "<title>Structure #1 of Table 1 under EL-CENTRO-1940-NS × 1.5</title>" in text
    assert "http" not in text
    assert "<script" not in text
    assert "not computed" not in text


@pytest.mark.slow
def test_names_of_visitors_are_text(client) -> None:
    structure = PRESETS[0]["structure"] | {"name": "<img src=x onerror=alert(1)>"}
    text = client.download("/api/file/report", client.state(structure=structure))[1].decode()
    assert "&lt;img src=x onerror=alert(1)&gt;" in text
    assert "<img" not in text


@pytest.mark.slow
def test_what_takes_long_is_left_out_and_said(client, monkeypatch) -> None:
    on_springs = client.state(models=["2DOF-S"], ground=BED)
    assert "not computed" not in client.download("/api/file/report", on_springs)[1].decode()

    def refuse(*_):
        raise _downloads.Refusal({"energy": "too long"})

    monkeypatch.setattr(_response, "check_work_of_energy", refuse)
    monkeypatch.setattr(rf.History, "required_friction", property(lambda _: 1 / 0))
    text = client.download("/api/file/report", client.state(models=["2DOF-S"]))[1].decode()
    assert text.count("<td>not computed</td>") == 2
    assert "Not computed: energies and friction of a run that would take too long here." in text


def test_the_structure_tab_has_the_warnings(client) -> None:
    assert client.ask("/api/structure", client.state())["warnings"] == []
    (warning,) = client.ask("/api/structure", client.state(structure=TONNES))["warnings"]
    assert "The tip has a mass of 60 kg, less than a tenth of the 48000 kg" in warning


@pytest.mark.slow
@pytest.mark.web
def test_a_warning_is_seen(visit, link) -> None:
    visitor = visit(link({"structure": TONNES}))
    visitor.page.wait_for_selector("#warnings")
    assert "Masses are in kg: a tonne is 1000 kg." in visitor.page.locator("#warnings").inner_text()


@pytest.mark.slow
@pytest.mark.web
def test_tabs_on_paper(visit, link, client) -> None:
    few = {"suites": ["fema-p695-near-field-pulse"], "scales": [1.0]}
    visitor = visit(link(client.state(cloud=few, design=few | {"widths": 3})), color_scheme="dark")
    for tab in ("structure", "earthquake", "response", "fragility", "design"):
        visitor.tab(tab)
        if tab == "response":
            visitor.shown()
        if tab in ("fragility", "design"):
            visitor.run_study()
        visitor.settle()
        check_paper(visitor.page, tab)


def check_paper(page, tab) -> None:
    pypdf = pytest.importorskip("pypdf", reason="pages are read by pypdf, of rockflex[dev]")
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


SHORT = {"source": "pulse", "pulse": {"shape": "one_sine", "amplitude": 4.0, "period": 0.8}}


@pytest.mark.slow
def test_the_gif_is_that_of_the_library(client, frame, tmp_path) -> None:
    state = client.state(record=SHORT, models=["MDOF-S", "fixed"], scale=1.5, free_vibration=1.0)
    made = client.made("animation", state)
    assert (made["status"], made["name"]) == ("done", "animation.gif")
    pulse = rf.one_sine_pulse(4.0, 0.8).scaled(1.5)
    runs = [rf.simulate(frame, pulse, model, free_vibration=1.0) for model in ("MDOF-S", "fixed")]
    title = f"{pulse.name} × 1.5"
    with rf.figure_style(units="SI"):
        same = rf.animate(runs, tmp_path / "same.gif", structure=frame, width=800, title=title)
    with Image.open(io.BytesIO(made["content"])) as image, Image.open(same) as other:
        assert image.size == other.size
        assert image.n_frames == other.n_frames > 40
        assert made["done"] == made["total"] == image.n_frames
        for place in (0, image.n_frames // 2, image.n_frames - 1):
            image.seek(place)
            other.seek(place)
            assert image.convert("RGB").tobytes() == other.convert("RGB").tobytes()


@pytest.mark.slow
def test_a_long_one_has_fewer_frames_and_a_longer_one_is_refused(client, monkeypatch) -> None:
    state = client.state(record=SHORT, models=["fixed"], free_vibration=1.0)

    def frames() -> int:
        with Image.open(io.BytesIO(client.made("animation", state)["content"])) as image:
            return image.n_frames

    usual = frames()
    monkeypatch.setattr(_downloads, "FRAME_RATES", ((1.0, 25.0), (10.0, 12.5)))
    assert frames() == pytest.approx(usual / 2, abs=1)
    monkeypatch.setattr(_downloads, "FRAME_RATES", ((1.0, 25.0),))
    said = client.made("animation", state)["errors"]["free_vibration"]
    assert "the animation would last 1." in said
    assert "but the page draws 1 s at most. Choose a shorter record or less free vibration, or take Python" in said


LONG = {"record": SHORT, "models": ["MDOF-S", "2DOF-S", "fixed"], "free_vibration": 40.0}


def test_it_ends_when_nobody_waits(client, monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._jobs.ABANDONED_AFTER", 0.5)
    state = parse_page_state(client.state(**LONG))
    job = BackgroundFileJob(lambda told: animation_file(state, UploadedRecords(), told))
    job.compute()
    assert job.status == "cancelled"
    assert job.file is None


@pytest.mark.slow
def test_it_can_be_cancelled_and_says_how_far_it_is(client) -> None:
    token = client.make("animation", client.state(**LONG))
    path, seen = f"/api/file/{token}", []
    while len(seen) < 3:
        answer = json.loads(client.request(path)[2])
        assert answer["status"] in ("waiting", "running")
        if answer["done"] and answer["done"] not in seen:
            seen.append(answer["done"])
    assert seen == sorted(seen)
    assert seen[-1] < answer["total"]
    assert client.request(f"{path}/content")[0] == 404
    assert client.request(path, method="DELETE")[0] == 200
    while (answer := json.loads(client.request(path)[2]))["status"] == "running":
        time.sleep(0.02)
    assert answer["status"] == "cancelled"
    assert answer["done"] < answer["total"]


def test_a_file_is_kept_until_it_has_arrived(client) -> None:
    path = f"/api/file/{client.make('histories', client.state())}"
    while json.loads(client.request(path)[2])["status"] != "done":
        time.sleep(0.02)
    assert client.request(f"{path}/content", method="HEAD")[0] == 200
    host, port = client.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port))) as broken:
        broken.sendall(f"GET {path}/content HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        assert broken.recv(100)
    status, _, content = client.request(f"{path}/content")
    assert status == 200
    assert content.startswith(b"model,")
    assert client.request(path, method="DELETE")[0] == 200
    assert client.request(f"{path}/content")[0] == 404


def test_an_unknown_file_is_refused(client) -> None:
    assert "no file named 'soul'" in client.refused("/api/file/soul", client.state())[""]
    assert client.request("/api/file/none")[0] == 404


@pytest.mark.slow
def test_the_page_answers_while_it_draws(client) -> None:
    state = client.state(record=SHORT, models=["MDOF-S", "2DOF-S", "fixed"], free_vibration=10.0)
    path = f"/api/file/{client.make('animation', state)}"
    while not json.loads(client.request(path)[2])["done"]:
        time.sleep(0.02)
    for _ in range(3):
        client.ask("/api/structure", state)
    assert json.loads(client.request(path)[2])["status"] == "running"
    client.request(path, method="DELETE")


@pytest.mark.slow
@pytest.mark.web
def test_the_button_saves_the_gif_and_says_that_it_works(visit, link, client) -> None:
    visitor = visit(link(client.state(record=SHORT, free_vibration=2.0)))
    page = visitor.respond()
    button = page.get_by_role("button", name="Animation (GIF)")
    making = page.locator(".downloads:has([data-file=animation])")
    with page.expect_download(timeout=120_000) as got:
        button.click()
        page.wait_for_function("b => b.ariaBusy === 'true'", arg=button.element_handle())
        button.click()  # once is enough
        making.get_by_text(re.compile(r"[1-9]\d* of \d+ frames")).wait_for()
        assert 0.0 < page.locator(".making progress").evaluate("bar => bar.value") < 1.0
    content = got.value.path().read_bytes()
    assert got.value.suggested_filename == "animation.gif"
    with Image.open(io.BytesIO(content)) as image:
        assert image.format == "GIF"
        assert image.n_frames > 50
        assert image.size[0] == 800
    page.wait_for_function("b => b.ariaBusy === 'false'", arg=button.element_handle())
    assert making.locator("[role=status]").inner_text() == "Saved."
    assert not visitor.said


@pytest.mark.slow
@pytest.mark.web
def test_an_animation_can_be_cancelled_on_the_page(visit, link, client) -> None:
    visitor = visit(link(client.state(**LONG)))
    page = visitor.respond(1, LONG["models"])
    saved = []
    page.on("download", lambda each: saved.append(each))
    page.get_by_role("button", name="Animation (GIF)").click()
    page.locator(".making").get_by_role("button", name="Cancel").click()
    page.locator(".downloads:has([data-file=animation])").get_by_text("Cancelled.", exact=True).wait_for()
    assert page.locator('[data-file="animation"]').evaluate("b => b.ariaBusy") == "false"
    assert saved == []


@pytest.mark.slow
@pytest.mark.web
def test_the_page_says_that_an_animation_would_be_too_long(visitor, monkeypatch) -> None:
    monkeypatch.setattr(_downloads, "FRAME_RATES", ((1.0, 25.0),))
    visitor.respond()
    visitor.page.get_by_role("button", name="Animation (GIF)").click()
    visitor.wait_for_error("free_vibration", "The animation would last ")


@pytest.mark.slow
def test_answers_and_files_are_in_the_language_of_the_page(client) -> None:
    status, headers, body = client.request("/languages/de.json")
    assert (status, headers["content-type"]) == (200, "application/json")
    assert headers["etag"]
    german = json.loads(body)
    other = {"name": "A", "structure": PRESETS[1]["structure"], "models": ["MDOF-S"]}
    state = client.state(language="de", alternatives=[other])
    for what, text in (("report", "Largest values"), ("comparison", "story drift")):
        page = client.download(f"/api/file/{what}", state)[1].decode()
        assert '<html lang="de"' in page
        assert german[text] in page
    rows = client.ask("/api/alternatives", state)["rows"]
    assert any(german["story drift"] in row[0]["text"] for row in rows)
    assert list(client.refused("/api/state", state | {"language": "la"})) == ["language"]


@pytest.mark.slow
@pytest.mark.web
def test_reports_are_printed(client, monkeypatch) -> None:
    if not json.loads(client.request("/api/about")[2])["pdf"]:
        pytest.skip("no browser that prints")
    other = {"name": "A", "structure": PRESETS[1]["structure"], "models": ["MDOF-S"]}
    state = client.state(alternatives=[other])
    name, content = client.download("/api/file/comparison-pdf", state)
    assert (name, content[:5]) == ("comparison.pdf", b"%PDF-")
    suites = {"record_set": {"suites": ["fema-p695-near-field-pulse"]}}
    token = client.ask("/api/study/record_set", state | suites)["token"]
    client.wait("record_set", token, state | suites)
    name, content = client.download(f"/api/study/record_set/{token}/report-pdf", state | suites)
    assert (name, content[:5]) == ("report.pdf", b"%PDF-")
    assert client.post("/api/file/figure-pdf", {"state": state})[0] == 404
    monkeypatch.setenv("ROCKFLEX_BROWSER", "/nowhere/chromium")
    assert "ROCKFLEX_BROWSER" in client.made("report-pdf", state)["errors"][""]


def test_figures_have_the_units_of_the_page(client) -> None:
    found = {}
    for units in ("kip-in", "SI"):
        _, figure = client.download("/api/file/figure", client.state(record=SHORT, units=units))
        found[units] = " ".join(re.findall(r"<!-- (.*?) -->", figure.decode()))  # of glyphs, what they write
    assert "kip in" in found["kip-in"]
    assert "kip" not in found["SI"]


def test_reports_say_what_they_were_computed_from(client) -> None:
    """Tip mass, section, material and the factor for cracks, in the units of the page; and the scale in titles."""
    section = {"shape": "box", "width": 3.0, "depth": 2.5, "wall": 0.4, "elastic_modulus": 31e9, "density": 2400.0}
    pier = {"height": 24.0, "tip_mass": 910e3, "half_width": 3.5, "damping_ratio": 0.03, "base_mass": 0.0}
    pier |= {"section": section | {"stiffness_factor": 0.6}}
    state = client.state(structure={"name": "Pier", "cantilever": pier}, units="kN", scale=2.0, models=["2DOF-S"])
    report = client.download("/api/file/report", state)[1].decode()
    for text in ("tip mass 910 t", "box", "width 3 m", "depth 2.5 m", "31 GPa", "2400 kg/m³", "stiffness factor 0.6"):
        assert text in report
    concrete = {"elastic_modulus": 3e10, "density": 2500.0}
    parts = [{"shape": "tube", "diameter": 1.0, "wall": 0.02, "elastic_modulus": 2.1e11, "density": 7850.0}]
    parts += [{"shape": "circle", "diameter": 0.96, **concrete}]
    for cut, names in (
        (section | concrete, ["(box, concrete, "]),
        ({"shape": "composite", "parts": parts}, ["(tube, steel, ", "(circle, concrete, "]),
    ):
        state["structure"]["cantilever"] = pier | {"section": cut}
        report = client.download("/api/file/report", state)[1].decode()
        assert all(name in report for name in names)
    state["structure"]["cantilever"] = pier
    kept = [{"name": "A", "structure": {"name": "Pier", "cantilever": pier | {"height": 20.0}}, "models": ["2DOF-S"]}]
    compared = client.download("/api/file/comparison", state | {"alternatives": kept})[1].decode()
    assert "EL-CENTRO-1940-NS × 2</title>" in compared
