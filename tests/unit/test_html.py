"""What notebooks show of values."""

import xml.etree.ElementTree as ET

import pytest

import rockflex as rf
from builders import make_frame
from rockflex._html import html_table

FRAME = make_frame(n_stories=8, period=0.6, aspect_ratio=8.0)


def cells(value):
    """Caption and rows of a table that is well-formed."""
    tree = ET.fromstring(value._repr_html_())
    return tree.findtext("caption"), {row.findtext("th"): row.findtext("td") for row in tree.iter("tr")}


def test_a_structure():
    title, rows = cells(FRAME.rocking())
    assert title == "RockingProperties"
    assert rows["half_width"] == f"{FRAME.rocking().half_width:.5g}"
    assert rows["omega"].endswith(", ... (8)")
    assert "floors" not in rows


def test_a_response_with_a_name_that_is_markup():
    motion = rf.GroundMotion(rf.one_sine_pulse(3.0, 1.0).acceleration, 0.005, "<b>&")
    response = rf.simulate(FRAME, motion, "2DOF-S")
    title, rows = cells(response)
    assert (title, rows["motion"], rows["status"]) == ("Response", "<b>&", response.status)
    assert rows["max_rotation"] == f"{response.max_rotation:.5g}"
    assert "<b>" not in response._repr_html_()


@pytest.mark.parametrize(
    "fit",
    [
        rf.fit_cloud([0.1, 0.2, 0.4], [1.0, 2.0, 3.0]),
        rf.fit_logistic([0.1, 0.2, 0.3, 0.4, 0.5], [0, 0, 1, 0, 1]),
        rf.LognormalFragility(0.5, 0.4),
    ],
)
def test_fits(fit):
    title, rows = cells(fit)
    assert title == type(fit).__name__
    assert rows


def test_long_texts_are_shortened():
    assert len(html_table("t", {"text": "x" * 9999, "none": None})) < 400
