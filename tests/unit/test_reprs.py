"""What values say of themselves: a line of text, and a short table in a notebook."""

import subprocess
import sys
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


KINDS = [
    FRAME,
    rf.Restrained(rf.Leaning(FRAME, 1e3), [rf.Tendon(2e5, 8e6), rf.FrictionDamper(5e4, position=0.1)]),
    FRAME.lumped,
    rf.CantileverWithTipMass(
        height=12.0, tip_mass=5e5, bending_stiffness=4e10, base_mass=1e5, half_width=1.5, damping_ratio=0.03
    ),
    rf.from_matrices([20e3], [[4e6]], [3.0], base_mass=2e4, half_width=0.6, damping_ratio=0.02),
]


@pytest.mark.parametrize("structure", KINDS, ids=lambda structure: type(structure).__name__)
def test_a_structure_is_a_drawing_and_five_numbers(structure):
    p = structure.rocking()
    assert list(cells(structure)) == ["", "T₁", "m*₁", "h*₁", "I_θ", "M_r"]
    assert cells(structure)["I_θ"] == f"{p.i_theta:.4g} kg m²"
    (drawn,) = ET.fromstring(structure._repr_html_()).iter("svg")
    width, height = (float(drawn.get(name)) for name in ("width", "height"))
    lines = [line.get("points") for line in drawn.iter("polyline")]
    points = [tuple(map(float, point.split(","))) for line in lines for point in line.split()]
    assert all(-1.0 <= x <= width + 1.0 and -1.0 <= y <= height + 1.0 for x, y in points)
    assert len(lines) > 2 + 2 * len(p.elements)


def test_notebooks_show_structures_and_responses_without_matplotlib():
    code = (
        "import sys; import rockflex as rf; frame = rf.Frame(2, 3.0, 4e4, 4e4, 1.0, 0.5, 8.0, 0.02); "
        "frame._repr_html_(); rf.simulate(frame, rf.one_sine_pulse(3.0, 0.8))._repr_html_(); "
        "sys.exit('matplotlib' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_response_has_a_small_history_if_it_kept_one():
    rocks = rf.simulate(FRAME, rf.one_sine_pulse(4.0, 1.0), "2DOF-S")
    stands = rf.simulate(FRAME, rf.one_sine_pulse(0.1, 1.0), "2DOF-S")
    for response, name in ((rocks, "rotation"), (stands, "top_displacement")):
        (drawn,) = ET.fromstring(response._repr_html_()).iter("svg")
        points = [float(point.split(",")[1]) for point in drawn.find("polyline").get("points").split()]
        values = getattr(response, name)
        middle = float(drawn.get("height")) / 2.0
        scale = (middle - 2.0) / abs(values).max()
        assert min(points) == pytest.approx(middle - scale * values.max(), abs=0.06)
        assert max(points) == pytest.approx(middle - scale * values.min(), abs=0.06)
        assert any(label.startswith(f"{name}, ") for label in cells(response))
    peaks = rf.simulate(FRAME, rf.one_sine_pulse(4.0, 1.0), "2DOF-S", output="peaks")
    assert "svg" not in peaks._repr_html_()


def test_long_texts_are_shortened():
    assert len(html_table("t", {"text": "x" * 9999, "none": None})) < 400
