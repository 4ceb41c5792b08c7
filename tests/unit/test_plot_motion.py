"""Ground motions, and selected records beside their target."""

import io

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

import rockflex as rf
from drawing import drawn
from rockflex.foundation.number_format import short_number, unit_with_prefix
from rockflex.plot import plot_motion, plot_selection

RECORD = rf.load_suite("el-centro-1940")[0]
SUITE = rf.load_suite("fema-p695-far-field")
TARGET = rf.ec8_spectrum(2.5, "C")


@pytest.mark.slow
def test_motion_draws_its_integrals_and_its_spectrum():
    figure = drawn(plot_motion(RECORD))
    a, spectrum, v, d = figure.axes
    assert [axes.get_ylabel() for axes in (a, v, d, spectrum)] == ["$a$ [m/s²]", "$v$ [m/s]", "$d$ [m]", "$S_a$ [m/s²]"]
    samples = RECORD.acceleration
    velocity = cumulative_trapezoid(samples, dx=RECORD.dt, initial=0.0)
    np.testing.assert_array_equal(a.get_lines()[0].get_ydata(), samples)
    np.testing.assert_allclose(v.get_lines()[0].get_ydata(), velocity, atol=1e-12)
    np.testing.assert_allclose(d.get_lines()[0].get_ydata(), RECORD.displacement)
    for axes in (a, v, d):
        assert axes.get_xlim() == (0.0, RECORD.duration)
        assert axes.get_ylim()[1] > np.abs(axes.get_lines()[0].get_ydata()).max()
    (curve,) = spectrum.get_lines()
    for i in (0, 100, 239):
        assert curve.get_ydata()[i] == pytest.approx(RECORD.sa(float(curve.get_xdata()[i]), 0.05), rel=1e-12)
    assert spectrum.get_xscale() == "log"
    assert spectrum.get_ylim()[1] > curve.get_ydata().max()


def test_motion_states_its_measures():
    a, spectrum, v, d = plot_motion(RECORD).axes
    assert a.get_title(loc="right") == f"PGA = {RECORD.pga:.3g} m/s² ({RECORD.pga / 9.81:.3g} g)"
    assert v.get_title(loc="right") == f"PGV = {RECORD.pgv:.3g} m/s"
    assert d.get_title(loc="right") == f"PGD = {RECORD.pgd:.3g} m"
    assert spectrum.get_title() == (
        f"$I_a$ = {RECORD.arias:.3g} m/s, $D_{{5–95}}$ = {RECORD.d5_95:.3g} s (shaded)\nspectrum for ζ = 5 %"
    )


def test_motion_shades_the_significant_duration():
    energy = cumulative_trapezoid(RECORD.acceleration**2, dx=RECORD.dt, initial=0.0)
    expected = [np.interp(share * energy[-1], energy, RECORD.time) for share in (0.05, 0.95)]
    for axes in plot_motion(RECORD).axes:
        if axes.get_xlabel() == "$T$ [s]":
            continue
        (box,) = axes.patches
        np.testing.assert_allclose([box.get_x(), box.get_x() + box.get_width()], expected, atol=2 * RECORD.dt)


def test_motion_shows_its_vertical_component():
    both = RECORD.with_vertical(0.8 * RECORD.acceleration[::-1])
    figure = drawn(plot_motion(both))
    panels = {axes.get_ylabel(): axes for axes in figure.axes}
    places = [panels[label].get_position().y0 for label in ("$a$ [m/s²]", "$a_v$ [m/s²]", "$v$ [m/s]", "$d$ [m]")]
    assert places == sorted(places, reverse=True)
    upwards = panels["$a_v$ [m/s²]"]
    np.testing.assert_array_equal(upwards.get_lines()[0].get_ydata(), both.vertical)
    assert upwards.get_title(loc="right") == f"PVA = {both.pva:.3g} m/s² ({both.pva / 9.81:.3g} g)"
    horizontal, vertical = panels["$S_a$ [m/s²]"].get_lines()
    assert [text.get_text() for text in panels["$S_a$ [m/s²]"].get_legend().get_texts()] == ["horizontal", "vertical"]
    period = float(vertical.get_xdata()[100])
    assert vertical.get_ydata()[100] == pytest.approx(both.vertical_motion.sa(period, 0.05), rel=1e-12)
    assert horizontal.get_ydata()[100] == pytest.approx(both.sa(period, 0.05), rel=1e-12)


def test_motion_may_be_quiet_and_nameless():
    figure = drawn(plot_motion(rf.GroundMotion(np.zeros(100), 0.01)))
    assert figure.get_suptitle() == "ground motion"
    assert figure.axes[0].get_ylim() == (-1.0, 1.0)
    named = plot_motion(rf.GroundMotion(np.zeros(100), 0.01, name="$x"))
    assert named.get_suptitle() == r"\$x"
    named.savefig(io.BytesIO())


def test_motion_refuses_what_is_none():
    with pytest.raises(rf.InputError, match="motion must be a GroundMotion, but ndarray was given"):
        plot_motion(np.zeros(5))


@pytest.mark.parametrize(
    ("largest", "expected"),
    [(2.5e9, (1e9, "GN m")), (1e6, (1e6, "MN m")), (-3e4, (1e3, "kN m")), (999.0, (1.0, "N m")), (0.0, (1.0, "N m"))],
)
def test_units_suit_the_largest_value(largest, expected):
    assert unit_with_prefix(largest, "N m") == expected


@pytest.mark.parametrize(
    ("value", "text"), [(2345.6, "2350"), (-0.012345, "−0.0123"), (1.0, "1"), (0.0, "0"), (380123.0, "380000")]
)
def test_numbers_have_three_digits(value, text):
    assert short_number(value) == text


def lines(axes):
    return {line.get_label(): line for line in axes.get_lines()}


def test_selection_draws_records_mean_target_and_band():
    chosen = SUITE[:20].select(TARGET, 5, (0.2, 2.0))
    figure = drawn(plot_selection(chosen))
    upper, lower = figure.axes
    curves = lines(upper)
    label = f"mean: misfit {chosen.misfit:.2g}, at least {chosen.least_ratio:.2f} of the target"
    assert set(curves) == {"5 records", "_1", "_2", "_3", "_4", label, TARGET.name}
    periods = curves[label].get_xdata()
    assert periods[0] == pytest.approx(0.2 / 3)
    assert periods[-1] == pytest.approx(6.0)
    rows = np.array([motion.spectrum(periods).sa for motion in chosen.suite])
    for key, row in zip(("5 records", "_1", "_2", "_3", "_4"), rows, strict=True):
        np.testing.assert_allclose(curves[key].get_ydata(), row, rtol=1e-10)
    np.testing.assert_allclose(curves[label].get_ydata(), rows.mean(axis=0), rtol=1e-10)
    known = curves[TARGET.name].get_xdata()
    assert known[-1] <= 4.0 < known[-1] * 1.1  # the target ends at 4 s
    np.testing.assert_allclose(curves[TARGET.name].get_ydata(), TARGET.at(known), rtol=1e-14)
    median, spread = np.exp(np.log(rows).mean(axis=0)), np.log(rows).std(axis=0, ddof=1)
    (band,) = upper.collections
    corners = band.get_paths()[0].vertices
    assert corners[:, 1].max() == pytest.approx(np.max(median * np.exp(spread)), rel=1e-10)
    assert corners[:, 1].min() == pytest.approx(np.min(median * np.exp(-spread)), rel=1e-10)
    for axes in figure.axes:
        (box,) = axes.patches
        assert (box.get_x(), box.get_x() + box.get_width()) == pytest.approx((0.2, 2.0))
    ratio = lower.get_lines()[0]
    np.testing.assert_allclose(ratio.get_ydata(), rows.mean(axis=0)[periods <= 4.0] / TARGET.at(known), rtol=1e-10)
    assert {line.get_ydata()[0] for line in lower.get_lines()[1:]} == {0.9, 1.0}
    assert upper.get_ylabel() == "$S_a$ [m/s²]"
    assert figure.legends[0].get_title().get_text() == "ζ = 5 %, 0.2 to 2 s"


@pytest.mark.parametrize("periods", [[0.0], [1.0], [0.0, 0.5, 1.0], [0.1, 0.5, 1.0]])
def test_selection_of_one_record(periods):
    chosen = SUITE[:4].select(TARGET, 1, periods)
    upper, lower = drawn(plot_selection(chosen)).axes
    assert len(upper.get_lines()) == 2
    assert not upper.collections
    low, high = upper.patches[0].get_x(), upper.patches[0].get_x() + upper.patches[0].get_width()
    assert 0.0 < low < high
    assert lower.get_ylim()[0] < 1.0 < lower.get_ylim()[1]


@pytest.mark.slow
@pytest.mark.parametrize("measure", ["geometric mean", "rotd50", "rotd100"])
def test_selection_of_pairs_names_the_measure(measure):
    named = rf.TargetSpectrum([0.01, 10.0], [5.0, 0.5], name="$my")
    chosen = SUITE[:6].select(named, 2, [0.3, 0.6, 1.0], measure=measure, scale_limits=(0.01, 100.0))
    figure = drawn(plot_selection(chosen))
    names = {"geometric mean": "geometric-mean $S_a$", "rotd50": "RotD50 $S_a$", "rotd100": "RotD100 $S_a$"}
    assert figure.axes[0].get_ylabel() == f"{names[measure]} [m/s²]"


def test_selection_refuses_what_is_none():
    with pytest.raises(rf.InputError, match="selection must be a Selection, but Suite was given"):
        plot_selection(SUITE)
