"""The page in a real Chromium, used as a person would; its console must say nothing."""

import base64
import json
import math
import re

import numpy as np
import pytest

import rockflex as rf
from rockflex.web._presets import PRESETS

pytestmark = pytest.mark.web

FRAME = rf.Frame(5, 3.0, 40e3, 40e3, math.inf, 1.0, 10.0, 0.02)
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
RECORD = b"time (s),acc (m/s2)\n" + b"".join(b"%.2f,%.4f\n" % (0.02 * i, 3 * math.sin(0.1 * i)) for i in range(400))


def link(state):
    text = base64.urlsafe_b64encode(json.dumps(state).encode()).decode().rstrip("=")
    return f"/#s={text}"


def shown(visitor, scale, models):
    """Wait until the Response tab shows this."""
    wanted = json.dumps([scale, models], separators=(",", ":"))
    visitor.page.wait_for_function("w => document.querySelector('[data-shows]')?.dataset.shows === w", arg=wanted)


def peak(visitor, model, name):
    return visitor.value(f'#peaks tr[data-model="{model}"] [data-name="{name}"]')


def files(name, content):
    return {"name": name, "mimeType": "text/plain", "buffer": content}


def test_structure_by_presets_form_and_errors(visitor) -> None:
    page = visitor.page
    assert page.locator("#adequacy").inner_text() == rf.adequacy(FRAME.rocking(), base_mass=40e3).reason
    assert page.locator(".modes svg").count() == 5
    visitor.fill("structure.frame.n_stories", "3")
    page.wait_for_function("() => document.querySelectorAll('.modes svg').length === 3")
    three = rf.Frame(3, 3.0, 40e3, 40e3, math.inf, 1.0, 10.0, 0.02)
    assert visitor.value("#modes tbody tr:nth-child(2) td") == three.modal().period[1]
    visitor.fill("structure.frame.n_stories", "1000000")
    assert visitor.error("structure.frame.n_stories") == "It must be from 1 to 200, but 1e+06 was given."
    visitor.fill("structure.frame.period", "soon")
    assert "It must be the first period on a fixed base" in visitor.error("structure.frame.period")
    for place, preset in enumerate(PRESETS):
        page.get_by_label("Begin with").select_option(str(place))
        page.wait_for_function(
            "n => document.querySelector('.results h2').textContent === n", arg=preset["structure"]["name"]
        )
        assert page.locator(".error:visible").all_inner_texts() == []
    for kind in visitor.page.evaluate("Object.keys(rockflexPage.about.kinds)"):
        page.get_by_label("Kind").select_option(kind)
        page.wait_for_function(
            "k => k in rockflexPage.state.structure && !document.querySelector('.results.stale')", arg=kind
        )
        assert page.locator(".error:visible").all_inner_texts() == []


def test_tendons_are_added_and_removed(visitor) -> None:
    page = visitor.page
    page.get_by_label("Begin with").select_option("7")
    page.wait_for_function("() => document.querySelector('.results h2').textContent === 'Bridge pier'")
    before = visitor.value("dd[data-value] >> nth=2")
    page.get_by_role("button", name="Add a tendon").click()
    page.wait_for_function("b => Number(document.querySelectorAll('dd[data-value]')[2].dataset.value) > b", arg=before)
    visitor.fill("structure.tendons.0.position", "99")
    assert "The tendons must be symmetric" in visitor.error("structure.tendons")
    visitor.fill("structure.tendons.0.position", "0")
    page.get_by_role("button", name="Remove").click()
    page.wait_for_function(
        "b => Number(document.querySelectorAll('dd[data-value]')[2].dataset.value) === b", arg=before
    )


def test_matrices_are_imported(visitor, tmp_path) -> None:
    page = visitor.page
    k = np.array([[2e7, -1e7], [-1e7, 1e7]])
    np.savez(tmp_path / "fe.npz", mass=np.diag([4e4, 4e4]), stiffness=k, heights=[3.0, 6.0])
    page.get_by_label("File of matrices").set_input_files(tmp_path / "fe.npz")
    page.wait_for_function("() => document.querySelectorAll('.modes svg').length === 2")
    expected = rf.from_matrices([4e4, 4e4], k, [3.0, 6.0], base_mass=0.0, half_width=1.0, damping_ratio=0.02)
    assert visitor.value("#modes tbody td") == pytest.approx(expected.modal().period[0], rel=1e-12)
    page.get_by_label("File of matrices").set_input_files(files("bad.npz", b"nonsense"))
    assert "does not hold matrices that can be read" in visitor.error("import")


def test_earthquake_by_suite_pulse_and_scale(visitor) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    assert visitor.value('[data-measure="PGA"]') == EL_CENTRO.pga
    page.get_by_label("Suite", exact=True).select_option("fema-p695-far-field")
    page.locator('[data-record="FF-12-a"]').click()
    motion = rf.load_suite("fema-p695-far-field")["FF-12-a"]
    page.wait_for_function(
        "p => Number(document.querySelector('[data-measure=PGA]').dataset.value) === p", arg=motion.pga
    )
    assert page.locator(".thumbs button").count() == 44
    assert page.locator('[data-record="FF-12-a"]').get_attribute("aria-pressed") == "true"
    visitor.fill("scale", "2")
    page.wait_for_function(
        "p => Number(document.querySelector('[data-measure=PGA]').dataset.value) === p", arg=2 * motion.pga
    )
    assert visitor.value('[data-measure="Arias"]') == pytest.approx(4 * motion.arias)
    page.get_by_label("Where from").select_option("pulse")
    page.get_by_label("Shape").select_option("one_sine")
    slider = page.get_by_role("slider", name="Period")
    slider.focus()
    slider.press("ArrowRight")
    pulse = rf.one_sine_pulse(2.0, visitor.page.evaluate("rockflexPage.state.record.pulse.period")).scaled(2.0)
    page.wait_for_function(
        "p => Number(document.querySelector('[data-measure=PGV]').dataset.value) === p", arg=pulse.pgv
    )
    visitor.fill("record.pulse.period", "9999")
    assert visitor.error("record.pulse.period") == "It must be the period in s, from 0.05 to 20, but 9999 was given."


def test_an_upload_a_bad_one_and_one_that_is_too_large(visitor) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.get_by_label("Where from").select_option("upload")
    chooser = page.get_by_label("File", exact=True)
    chooser.set_input_files(files("mine.csv", RECORD))
    page.wait_for_function("() => document.querySelector('#record-title').textContent === 'mine'")
    assert "400 samples" in page.locator("#uploaded").inner_text()
    visitor.tab("response")
    shown(visitor, 1, ["MDOF-S", "2DOF-S", "fixed"])
    samples = [float(line.split(b",")[1]) for line in RECORD.splitlines()[1:]]
    expected = rf.simulate(FRAME, rf.GroundMotion(samples, 0.02), "2DOF-S", free_vibration=5.0)
    assert peak(visitor, "2DOF-S", "max_rotation") == pytest.approx(expected.max_rotation, rel=1e-9)
    visitor.tab("earthquake")
    chooser.set_input_files(files("bad.csv", b"no numbers at all\n"))
    assert "bad.csv holds no numbers" in visitor.error("record.upload")
    chooser.set_input_files(files("large.csv", b"1\n" * 3_000_000))
    assert visitor.error("record.upload") == "large.csv has 6.0 MB, but the page takes 5 MB at most."
    # A link does not hold the file; another server would not know it.
    state = visitor.state() | {"record": visitor.state()["record"] | {"upload": "0" * 64}, "tab": "response"}
    page.goto(visitor.url + link(state))
    page.reload()
    page.wait_for_selector("text=Choose the file again.")


def test_response_numbers_and_animation(visitor) -> None:
    page = visitor.page
    visitor.tab("response")
    shown(visitor, 1, ["MDOF-S", "2DOF-S", "fixed"])
    for model in ("MDOF-S", "2DOF-S", "fixed"):
        response = rf.simulate(FRAME, EL_CENTRO, model, free_vibration=5.0)
        for name in ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear", "n_impacts"):
            assert peak(visitor, model, name) == getattr(response, name)
    response = rf.simulate(FRAME, EL_CENTRO, "MDOF-S", free_vibration=5.0)
    shapes = np.vstack((np.zeros(5), FRAME.rocking().floors.displacement))
    heights, b = np.arange(6) * 3.0, FRAME.rocking().half_width
    for node in np.flatnonzero(
        np.isin(np.float32(response.time), page.evaluate("Array.from(rockflexStage.view().models[0].t)"))
    )[::97]:
        time, theta = float(np.float32(response.time[node])), response.rotation[node]
        if np.sum(np.float32(response.time) == np.float32(time)) > 1:
            continue  # an event: two states at once
        frame = page.evaluate(
            "t => { const f = rockflexStage.frame(0, t, 3); return [f.theta, f.points, f.base, f.side]; }", time
        )
        assert frame[0] == pytest.approx(theta, rel=1e-6, abs=1e-12)
        assert frame[3] == np.sign(theta)
        pivot, turned = np.sign(theta) * b, 3.0 * theta
        dx = 3.0 * shapes @ response.modal_displacement[node] - pivot
        x = pivot + dx * np.cos(turned) + heights * np.sin(turned)
        y = heights * np.cos(turned) - dx * np.sin(turned)
        assert np.array(frame[1]) == pytest.approx(np.column_stack((x, y)), abs=1e-4)
        assert min(frame[2][0][1], frame[2][1][1]) == pytest.approx(0.0, abs=1e-9)  # one edge stays on the ground


def test_play_pause_scrub_and_speed(visitor) -> None:
    page = visitor.page
    visitor.tab("response")
    shown(visitor, 1, ["MDOF-S", "2DOF-S", "fixed"])
    page.get_by_label("Speed").select_option("1")
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("() => rockflexStage.time() > 0.5")
    page.get_by_role("button", name="Pause").click()
    stopped = page.evaluate("rockflexStage.time()")
    page.wait_for_timeout(300)
    assert page.evaluate("rockflexStage.time()") == stopped
    assert page.locator("#clock").inner_text() == f"{stopped:.2f} s"
    page.get_by_role("button", name="Largest rotation").click()
    response = rf.simulate(FRAME, EL_CENTRO, "MDOF-S", free_vibration=5.0)
    assert page.evaluate("rockflexStage.time()") == response.time_of_max_rotation
    assert page.evaluate("rockflexStage.frame(0, rockflexStage.time(), 1).theta") == pytest.approx(
        response.max_rotation, rel=0.02
    ) or response.rotation.min() == pytest.approx(-response.max_rotation, rel=0.02)
    scrub = page.get_by_role("slider", name="Time")
    scrub.focus()
    for _ in range(3):
        scrub.press("ArrowRight")
    assert page.evaluate("rockflexStage.time()") > response.time_of_max_rotation
    picture = page.evaluate("document.querySelector('.stage canvas').toDataURL()")
    scrub.press("Home")
    assert page.evaluate("document.querySelector('.stage canvas').toDataURL()") != picture
    amplify = page.get_by_role("slider", name="Amplification")
    amplify.focus()
    amplify.press("End")
    assert page.evaluate("rockflexStage.stage.amplification") == 200


def test_a_slider_redraws_quickly(visitor) -> None:
    page = visitor.page
    visitor.tab("response")
    shown(visitor, 1, ["MDOF-S", "2DOF-S", "fixed"])
    times = []
    for scale in (1.2, 1.4, 1.6, 1.8, 2.2):
        visitor.fill("scale", str(scale))
        shown(visitor, scale, ["MDOF-S", "2DOF-S", "fixed"])
        times.append(int(page.locator("[data-redrawn]").get_attribute("data-redrawn")))
    print(f"a change of the scale is drawn after {np.median(times):.0f} ms")


def test_models_and_overturning(visitor) -> None:
    page = visitor.page
    visitor.tab("response")
    for name in ("MDOF-S", "fixed"):
        page.get_by_label(name, exact=True).uncheck()
    page.get_by_label("Another model").fill("4DOF-S")
    page.get_by_label("Another model").press("Enter")
    shown(visitor, 1, ["2DOF-S", "4DOF-S"])
    visitor.fill("scale", "15")
    shown(visitor, 15, ["2DOF-S", "4DOF-S"])
    assert "the structure overturns" in page.locator("#verdict").inner_text()
    assert "overturned at" in page.locator('#peaks tr[data-model="2DOF-S"] [data-name="status"]').inner_text()
    page.evaluate("rockflexStage.move(rockflexStage.view().models[0].peaks.end_time)")
    assert abs(page.evaluate("rockflexStage.frame(0, rockflexStage.time(), 1).theta")) == pytest.approx(
        math.pi / 2, rel=1e-5
    )
    page.get_by_label("Another model").fill("77DOF-S")
    page.get_by_label("Another model").press("Enter")
    assert "needs 76 modes, but the structure has 5" in visitor.error("models")


def test_fragility_runs_refits_and_cancels(visitor) -> None:
    page = visitor.page
    visitor.tab("fragility")
    page.get_by_role("button", name="Run", exact=True).click()
    page.wait_for_function("() => document.querySelector('#status').textContent.startsWith('Done: 132')")
    runs = rf.run_cloud(FRAME, rf.load_suite("fema-p695-far-field"), "MDOF-S", [0.5, 1.0, 2.0], free_vibration="settle")
    (fit,) = rf.fit_clouds(runs, "pgv")
    assert visitor.value('#fits [data-name="median"]') == pytest.approx(fit.outcomes.initiation.median)
    page.get_by_label("Intensity measure").select_option("sa_t1")
    page.get_by_label("What is asked: that").select_option("nominal")
    (fit,) = rf.fit_clouds(runs, "sa_t1", nominal=True)
    page.wait_for_function(
        "m => Math.abs(document.querySelector('#fits [data-name=median]').dataset.value / m - 1) < 1e-9",
        arg=fit.outcomes.overturning.median,
    )
    page.get_by_label("What is asked: that").select_option("rotation")
    visitor.fill("cloud.rotation", "7")
    assert "a rotation in rad, from 0.0001 to 1.5, but 7 was given" in visitor.error("cloud.rotation")
    visitor.fill("cloud.rotation", "0.02")
    page.get_by_label("MDOF-C-SI").check()
    visitor.fill("cloud.scales", "0.5, 1, 1.5, 2, 3, 4, 5, 6")
    page.get_by_role("button", name="Run", exact=True).click()
    page.wait_for_function("() => /^[1-9]\\d* of/.test(document.querySelector('#status').textContent)")
    page.get_by_role("button", name="Cancel").click()
    page.wait_for_function("() => document.querySelector('#status').textContent.startsWith('Cancelled after')")
    assert page.locator("#cancel").is_disabled()


def test_design_answers_how_wide(visitor) -> None:
    page = visitor.page
    visitor.tab("design")
    visitor.fill("design.widths", "4")
    page.get_by_role("button", name="Search").click()
    page.wait_for_function("() => document.querySelector('#design-status').textContent.startsWith('Done: ')")
    answers = page.locator("#width p")
    assert answers.count() == 2
    assert re.search(r"no tendon: B = [\d.]+ m is enough \(now B = 1\.05 m", answers.first.inner_text())
    free, held = (visitor.value(f'#width p[data-tendon="{name}"]') for name in ("no tendon", "F₀ = 0.2 W"))
    assert held < free
    visitor.fill("design.target", "0.0001")
    page.wait_for_selector("text=no base tried is wide enough")
    visitor.fill("design.widest", "999")
    assert "from 1 to 10, but 999 was given" in visitor.error("design.widest")


@pytest.mark.parametrize("tab", ["structure", "earthquake", "response", "fragility", "design"])
def test_downloads_of_each_tab(visitor, tab) -> None:
    page = visitor.page
    visitor.tab(tab)
    if tab in ("fragility", "design"):
        page.locator("#run, #search").first.click()
        page.wait_for_function(
            "() => /^Done/.test(document.querySelector('#status, #design-status').textContent)", timeout=180_000
        )
    for button in page.locator(".downloads button").all():
        with page.expect_download() as got:
            button.click()
        assert got.value.path().stat().st_size > 50
        assert got.value.suggested_filename.rsplit(".")[-1] in ("svg", "csv", "toml", "py")


def test_a_link_reopens_the_page(visitor, visit) -> None:
    visitor.fill("structure.frame.period", "0.7")
    visitor.tab("earthquake")
    visitor.fill("scale", "1.5")
    visitor.tab("response")
    visitor.page.get_by_label("2DOF-S", exact=True).uncheck()
    shown(visitor, 1.5, ["MDOF-S", "fixed"])
    seen = peak(visitor, "MDOF-S", "max_rotation")
    address = visitor.page.evaluate("location.hash")
    visitor.page.reload()
    shown(visitor, 1.5, ["MDOF-S", "fixed"])
    assert peak(visitor, "MDOF-S", "max_rotation") == seen
    other = visit(f"/{address}")
    shown(other, 1.5, ["MDOF-S", "fixed"])
    assert peak(other, "MDOF-S", "max_rotation") == seen
    assert other.state() == visitor.state()


@pytest.mark.parametrize(
    ("hash_", "text"),
    [
        ("#s=%%%", "does not hold a state"),
        ("#elsewhere", None),
        ("#s=AAAA", "it is damaged"),
        (link({"structure": {"frame": {"n_stories": 10**6}}})[1:], "structure.frame.story_height: it is missing"),
        (link(7)[1:], "The link does not hold a state of the page."),
        (link({"structure": PRESETS[1]["structure"], "models": ["<img src=x onerror=alert(1)>"]})[1:], "Unknown model"),
    ],
)
def test_a_damaged_link_is_told(visit, hash_, text) -> None:
    visitor = visit(f"/{hash_}")
    banner = visitor.page.locator("#banner")
    if text is None:
        assert banner.is_hidden()
    else:
        assert "The link cannot be opened" in banner.inner_text()
        assert text in banner.inner_text()
    assert visitor.page.locator("#adequacy").is_visible()


def test_two_visitors_do_not_see_each_other(visit) -> None:
    one, other = visit(), visit()
    one.fill("structure.name", "<b>Mine</b>")
    one.page.wait_for_function("() => document.querySelector('.results h2').textContent === '<b>Mine</b>'")
    one.tab("earthquake")
    one.fill("scale", "3")
    other.page.reload()
    other.page.wait_for_selector("#adequacy")
    assert other.state()["structure"]["name"] == "Structure #1 of Table 1"
    assert other.state()["scale"] == 1.0
    assert "Mine" not in other.page.content()


def test_the_keyboard_is_enough(visitor) -> None:
    page = visitor.page
    page.locator('[data-tab="structure"]').focus()
    for tab in ("earthquake", "response", "fragility", "design", "structure"):
        page.keyboard.press("ArrowRight")
        page.wait_for_selector(f'[data-tab="{tab}"][aria-selected="true"]')
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    page.wait_for_selector('[data-tab="response"][aria-selected="true"]')
    shown(visitor, 1, ["MDOF-S", "2DOF-S", "fixed"])
    page.locator("#play").focus()
    page.keyboard.press("Enter")
    page.wait_for_function("() => rockflexStage.playing()")
    page.keyboard.press("Space")
    page.wait_for_function("() => !rockflexStage.playing()")
    labels = page.evaluate(
        "[...document.querySelectorAll('main input, main select, main textarea')]"
        ".filter(e => !e.labels?.length && !e.getAttribute('aria-label')).length"
    )
    assert labels == 0


@pytest.mark.parametrize("tab", ["structure", "earthquake", "response", "fragility", "design"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_needs_no_sideways_scrolling(visit, tab, scheme) -> None:
    visitor = visit(viewport={"width": 390, "height": 800}, color_scheme=scheme, has_touch=True)
    visitor.tab(tab)
    visitor.page.wait_for_timeout(200)
    assert visitor.page.evaluate("document.documentElement.scrollWidth") <= 390
    assert visitor.page.evaluate("document.documentElement.dataset.theme") == scheme
    visitor.page.click("#theme")
    assert visitor.page.evaluate("document.documentElement.dataset.theme") != scheme


FIELDS = [
    "",
    "x",
    "-1",
    "1e999",
    "nan",
    "inf",
    "1e300",
    "0",
    "'; drop",
    "<b>1</b>",
    "١٢",
    "9" * 400,
    "1,2,3",
    "[[1]]",
    "0x10",
    "null",
]


@pytest.mark.parametrize(("preset", "kind"), [(0, "frame"), (6, "tapered_tower"), (8, "cantilever"), (10, "lumped")])
def test_nonsense_in_any_field_is_answered_beside_it(visitor, preset, kind) -> None:
    page = visitor.page
    page.get_by_label("Begin with").select_option(str(preset))
    page.wait_for_function("k => k in rockflexPage.state.structure", arg=kind)
    names = page.evaluate(
        "k => rockflexPage.about.kinds[k].fields"
        ".filter(f => !['choice', 'flag', 'table', 'matrix'].includes(f.type)).map(f => f.name)",
        kind,
    )
    for place, name in enumerate(names):
        box = page.locator(f'[data-path="structure.{kind}.{name}"] input')
        good = box.input_value()
        for text in FIELDS[place % 4 :: 4]:
            box.fill(text)
            box.press("Tab")
        box.fill(good)
        box.press("Tab")
    page.wait_for_function("() => !document.querySelector('.results.stale')")
    assert page.locator(".error:visible").all_inner_texts() == []
    assert "Traceback" not in page.content()
