"""The Earthquake tab in a real Chromium, used as a person would."""

import math

import pytest

import rockflex as rf

pytestmark = pytest.mark.web

RECORD = b"time (s),acc (m/s2)\n" + b"".join(b"%.2f,%.4f\n" % (0.02 * i, 3 * math.sin(0.1 * i)) for i in range(400))


def test_earthquake_by_suite_pulse_and_scale(visitor, el_centro) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    assert visitor.value('[data-measure="PGA"]') == el_centro.pga
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
    page.get_by_label("Source").select_option("pulse")
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


def test_an_upload_a_bad_one_and_one_that_is_too_large(visitor, frame, link) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.get_by_label("Source").select_option("upload")
    assert page.get_by_text("Choose a file; its motion and spectrum will appear here.").is_visible()
    visitor.upload("File", "mine.csv", RECORD)
    page.wait_for_function("() => document.querySelector('#record-title').textContent === 'mine'")
    assert "400 samples" in page.locator("#uploaded").inner_text()
    visitor.tab("response")
    visitor.shown(1, ["MDOF-S", "2DOF-S", "fixed"])
    samples = [float(line.split(b",")[1]) for line in RECORD.splitlines()[1:]]
    expected = rf.simulate(frame, rf.GroundMotion(samples, 0.02), "2DOF-S", free_vibration=5.0)
    assert visitor.peak("2DOF-S", "max_rotation") == pytest.approx(expected.max_rotation, rel=1e-9)
    visitor.tab("earthquake")
    visitor.upload("File", "bad.csv", b"no numbers at all\n")
    assert "bad.csv holds no numbers" in visitor.error("record.upload")
    visitor.upload("File", "large.csv", b"1\n" * 3_000_000)
    assert visitor.error("record.upload") == "large.csv has 6.0 MB, but the page takes 5 MB at most."
    # A link does not contain the file; another server would not know it.
    state = visitor.state() | {"record": visitor.state()["record"] | {"upload": "0" * 64}, "tab": "response"}
    page.goto(visitor.url + link(state))
    page.reload()
    page.wait_for_selector("text=Choose the file again.")
