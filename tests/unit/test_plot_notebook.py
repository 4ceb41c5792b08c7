"""Figures as notebooks show them: by themselves, sharp, and in the style of the files."""

import struct

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

import rockflex as rf

PULSE = rf.ricker_pulse(4.0, 0.6)


def size_of(png: bytes) -> tuple[int, int]:
    """Width and height of a PNG in dots."""
    assert png.startswith(b"\x89PNG")
    width, height = struct.unpack(">II", png[16:24])
    return width, height


def test_a_figure_shows_itself_as_a_sharp_picture():
    figure = rf.plot_motion(PULSE)
    assert isinstance(figure, Figure)
    png, size = figure._repr_png_()
    inches = figure.get_size_inches()
    assert (size["width"], size["height"]) == tuple(round(100 * each) for each in inches)
    assert size_of(png) == pytest.approx((2 * size["width"], 2 * size["height"]), abs=1)


def test_the_settings_of_the_caller_change_nothing():
    figure = rf.plot_motion(PULSE)
    before = figure._repr_png_()
    dpi = figure.dpi
    with mpl.rc_context({"savefig.dpi": 30, "savefig.bbox": "tight", "font.family": "serif"}):
        assert size_of(figure._repr_png_()[0]) == size_of(before[0])
    assert figure.dpi == dpi


def test_pyplot_shows_it_no_second_time():
    import matplotlib.pyplot as plt

    rf.plot_motion(PULSE)
    assert plt.get_fignums() == []
