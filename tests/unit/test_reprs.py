"""What values say of themselves: a line of text, and a short table in a notebook."""

import xml.etree.ElementTree as ET

import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.html import html_table

FRAME = make_frame(n_stories=8, period=0.6, aspect_ratio=8.0)
SUITE = rf.load_suite("fema-p695-far-field")
RUNS = rf.run_cloud(FRAME, SUITE, "2DOF-S", scales=[1.0, 2.0, 4.0])
FITS = rf.fit_clouds(RUNS)[0]
CHOSEN = SUITE.select(rf.ec8_spectrum(2.5, "C"), 7, (0.2, 2.0))
NEVER = rf.fit_outcomes([0.1, 0.2, 0.3, 0.4], [0.0, 0.01, 0.02, 0.03], [False] * 4)
FALLING = rf.fit_logistic([0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [1, 1, 0, 1, 0, 0])
VALUES = [
    FITS,
    FITS.outcomes,
    FITS.outcomes.overturning,
    FITS.top_displacement,
    NEVER,
    FALLING,
    SUITE,
    SUITE[0],
    rf.one_sine_pulse(3.0, 1.0),
    FRAME.modal(),
    CHOSEN,
    rf.LognormalFragility(0.5, 0.4),
]
each_value = pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)


def cells(value: object) -> dict[str, str]:
    """Rows of the table, which is well-formed and has the name of the class."""
    tree = ET.fromstring(value._repr_html_())
    assert tree.findtext("caption") == type(value).__name__
    return {row.findtext("th"): row.findtext("td") for row in tree.iter("tr")}


@each_value
def test_a_value_is_a_short_table(value):
    rows = cells(value)
    assert 2 < len(rows) < 18
    assert max(map(len, rows.values())) <= 240


@pytest.mark.parametrize("value", VALUES[:9], ids=lambda value: type(value).__name__)
def test_a_value_is_a_line_of_text(value):
    text = repr(value)
    assert text.startswith(f"{type(value).__name__}(")
    assert "array" not in text
    assert "\n" not in text
    assert len(text) < 160


def test_a_line_of_text_has_the_numbers():
    outcomes = FITS.outcomes
    counts = f"{outcomes.n_no_rocking} no rocking, {outcomes.n_rocking} rocking, {outcomes.n_overturned} overturned"
    assert repr(FITS) == f"CloudFits('S1', '2DOF-S', 'pgv': {counts}, 0 failed)"
    assert counts in repr(outcomes)
    assert f"median {outcomes.overturning.median:.4g}" in repr(outcomes)
    assert f"median={outcomes.overturning.median:.4g}" in repr(outcomes.overturning)
    assert f"{outcomes.overturning.n_events} of {outcomes.overturning.n} runs" in repr(outcomes.overturning)
    assert f"c2={FITS.top_displacement.c2:.4g}" in repr(FITS.top_displacement)
    assert "overturning: in none of 4 runs" in repr(NEVER)
    assert "median" not in repr(FALLING)
    separated = rf.fit_logistic([0.1, 0.2, 0.3, 0.4], [0, 0, 1, 1])
    assert repr(separated).endswith("2 of 4 runs, Firth, separated)")


def test_tables_have_the_numbers():
    rows = cells(FITS)
    line = FITS.outcomes.rotation
    assert rows["rotation"].startswith(f"{float(line.median(1.0)):.4g} rad · IM^{line.c2:.4g}, ")
    assert rows["top_displacement"].startswith(f"{float(FITS.top_displacement.median(1.0)):.4g} m")
    assert cells(FALLING)["note"].startswith("The probability does not rise")
    assert "note" not in cells(FITS.outcomes.overturning)
    suite = cells(SUITE)
    peaks = [motion.pga for motion in SUITE]
    assert suite["pga"] == f"{min(peaks):.4g} to {max(peaks):.4g} m/s²"
    assert suite["motions"].startswith("44: FF-1-a, FF-1-b, ")
    assert suite["motions"].endswith(", ..., FF-22-a, FF-22-b")
    motion = cells(SUITE[0])
    assert (motion["event"], motion["pgv"]) == ("Northridge", f"{SUITE[0].pgv:.4g} m/s")
    assert "event" not in cells(rf.one_sine_pulse(3.0, 1.0))
    assert cells(CHOSEN)["misfit of the mean"] == f"{CHOSEN.misfit:.5g}"
    assert cells(FRAME.modal())["n_modes"] == "8"


def test_a_suite_of_pulses_has_no_magnitudes():
    pulses = rf.Suite([rf.ricker_pulse(2.0, 1.0)])
    assert cells(pulses)["pga"] == f"{pulses[0].pga:.4g} m/s²"
    assert "magnitude" not in cells(pulses)


def test_properties_in_a_notebook():
    rows = cells(FRAME.rocking())
    assert rows["half_width"] == f"{FRAME.rocking().half_width:.5g}"
    assert rows["omega"].endswith(", ... (8)")
    assert "floors" not in rows


def test_a_response_with_a_name_that_is_markup():
    motion = rf.GroundMotion(rf.one_sine_pulse(3.0, 1.0).acceleration, 0.005, "<b>&")
    response = rf.simulate(FRAME, motion, "2DOF-S")
    rows = cells(response)
    assert (rows["motion"], rows["status"]) == ("<b>&", response.status)
    assert rows["max_rotation"] == f"{response.max_rotation:.5g}"
    assert "<b>" not in response._repr_html_()


def test_long_texts_are_shortened():
    assert len(html_table("t", {"text": "x" * 9999, "none": None})) < 400
