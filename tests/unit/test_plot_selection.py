import numpy as np
import pytest

import rockflex as rf
from drawing import drawn
from rockflex.plot import plot_selection

SUITE = rf.load_suite("fema-p695-far-field")
TARGET = rf.ec8_spectrum(2.5, "C")


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


@pytest.mark.parametrize("measure", ["geometric mean", "rotd50", "rotd100"])
def test_selection_of_pairs_names_the_measure(measure):
    named = rf.TargetSpectrum([0.01, 10.0], [5.0, 0.5], name="$my")
    chosen = SUITE[:6].select(named, 2, [0.3, 0.6, 1.0], measure=measure, scale_limits=(0.01, 100.0))
    figure = drawn(plot_selection(chosen))
    label = figure.axes[0].get_ylabel()
    assert (
        label
        == {"geometric mean": "geometric-mean $S_a$", "rotd50": "RotD50 $S_a$", "rotd100": "RotD100 $S_a$"}[measure]
        + " [m/s²]"
    )


def test_selection_refuses_what_is_none():
    with pytest.raises(rf.InputError) as caught:
        plot_selection(SUITE)
    assert str(caught.value) == "selection must be a Selection, but Suite was given. Make one: suite.select(...)."
