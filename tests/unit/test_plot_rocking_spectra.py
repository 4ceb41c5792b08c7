import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from drawing import drawn, legend
from rockflex.plot import plot_overturning_spectrum, plot_rocking_spectrum


@pytest.fixture(scope="module")
def rocking():
    record = rf.load_suite("el-centro-1940")[0]
    return rf.rocking_spectrum(record, (0.15, 0.25), np.linspace(1.0, 6.0, 11), free_vibration=5.0)


def overturning(lowest, highest):
    ratios = np.arange(1.0, 1.0 + len(lowest))
    return pd.DataFrame({"frequency_ratio": ratios, "lowest": lowest, "highest_standing": highest})


def curves(axes):
    return [line for line in axes.get_lines() if not line.get_label().startswith("_")]


def test_a_curve_a_slenderness_broken_where_blocks_overturn(rocking):
    figure = drawn(plot_rocking_spectrum(rocking.sample(frac=1.0, random_state=1), title="a$b"))
    (axes,) = figure.axes
    assert rocking["overturned"].any()
    for line, slenderness in zip(curves(axes), (0.15, 0.25), strict=True):
        rows = rocking[rocking["slenderness"] == slenderness]
        expected = np.where(rows["overturned"].astype(bool), np.nan, rows["relative_rotation"])
        np.testing.assert_array_equal(line.get_xdata(), rows["period"])
        np.testing.assert_array_equal(line.get_ydata(), expected)
        assert axes.get_ylim()[1] > 1.05 * np.nanmax(expected, initial=0.0)
    crosses = [line for line in axes.get_lines() if line.get_marker() == "x"]
    fallen = rocking[rocking["overturned"].astype(bool)]
    assert sum(len(line.get_xdata()) for line in crosses) == len(fallen)
    assert legend(figure) == [
        "α = 0.15 rad",
        "α = 0.25 rad",
        "overturned",
    ]
    assert axes.get_title() == r"a\$b"


def test_where_all_overturn_there_is_still_an_axis(rocking):
    fallen = rocking[rocking["overturned"].astype(bool)]
    axes = drawn(plot_rocking_spectrum(fallen)).axes[0]
    assert axes.get_ylim()[1] > 1.0


def test_the_range_in_which_either_happens_is_hatched():
    table = overturning([1.2, 1.4, 2.6, np.nan], [1.2, 3.6, 7.2, np.nan])
    figure = drawn(plot_overturning_spectrum({"one sine": table, "other": overturning([2.0], [2.0])}))
    (axes,) = figure.axes
    np.testing.assert_array_equal(curves(axes)[0].get_ydata(), table["lowest"])
    assert axes.get_ylim()[1] > 7.2
    area = axes.collections[0].get_paths()[0].get_extents()
    assert (area.x0, area.x1, area.y1) == (2.0, 3.0, 7.2)
    names = legend(figure)
    assert names == ["one sine", "other", "uplift", "either"]


def test_a_range_without_end_fills_the_panel_and_one_table_needs_no_name():
    figure = drawn(plot_overturning_spectrum(overturning([2.0, 3.0], [np.inf, np.inf])))
    (axes,) = figure.axes
    assert axes.collections[0].get_paths()[0].get_extents().y1 == pytest.approx(axes.get_ylim()[1])
    plain = plot_overturning_spectrum(overturning([2.0, 3.0], [2.0, 3.0]), title="t")
    assert [text.get_text() for text in plain.legends[0].get_texts()] == ["lowest", "uplift"]
    assert plain.axes[0].get_title() == "t"


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: plot_rocking_spectrum(pd.DataFrame({"period": [1.0]})), "lacks slenderness, relative_rotation"),
        (lambda: plot_overturning_spectrum(overturning([], [])), "has no rows"),
        (lambda: plot_overturning_spectrum({}), "There is no table to plot"),
        (lambda: plot_overturning_spectrum({str(i): overturning([1.0], [1.0]) for i in range(17)}), "17 tables"),
    ],
)
def test_what_cannot_be_drawn_is_named(call, said):
    with pytest.raises(rf.InputError, match=said):
        call()
