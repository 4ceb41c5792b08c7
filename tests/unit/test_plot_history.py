"""Histories: panels, peaks, uplifts and falls, and bands of varied properties."""

import io
import math
import re
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest
from matplotlib import rc_context, rcParams
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex

import rockflex as rf
from builders import make_frame
from drawing import drawn, notes, spans, uplift_intervals
from rockflex.plot import plot_history, plot_spread
from rockflex.plot._history import response_curves

FRAME = make_frame()
MODELS = ("2DOF-S", "3DOF-S", "MDOF-S", "fixed")
RECORD = rf.load_suite("el-centro-1940")[0]
# Rotation at which the static resisting moment vanishes, from the masses by hand.
HALF_WIDTH = FRAME.modal().effective_height[0] / 10.0
BALANCE = 6 * 40e3 * HALF_WIDTH / (40e3 * 3.0 * (1 + 2 + 3 + 4 + 5))
SPREAD_MODELS = ("2DOF-C", "2DOF-S")
PULSE = rf.ricker_pulse(0.981, 0.5)


@pytest.fixture(scope="module")
def four():
    return [rf.simulate(FRAME, RECORD, model) for model in MODELS]


@pytest.fixture(scope="module")
def figure(four):
    return plot_history(four)


def curve(axes, index):
    """The line of a response, among those that carry a label of their own."""
    return [line for line in axes.get_lines() if not line.get_label().startswith("_")][index]


def test_panels_hold_a_line_for_every_response(figure, four):
    assert [axes.get_ylabel() for axes in figure.axes] == [
        "θ [rad]",
        r"$u_{\mathrm{top}}$ relative [m]",
        r"$u_{\mathrm{top}}$ total [m]",
        "$M_b$ [MN m]",
        "$V_b$ [MN]",
    ]
    values = (
        lambda r: r.rotation,
        lambda r: r.top_displacement,
        lambda r: r.total_top_displacement,
        lambda r: r.base_moment / 1e6,
        lambda r: r.base_shear / 1e6,
    )
    for axes, of in zip(figure.axes, values, strict=True):
        for i, response in enumerate(four):
            np.testing.assert_array_equal(curve(axes, i).get_xdata(), response.time)
            np.testing.assert_allclose(curve(axes, i).get_ydata(), of(response), rtol=1e-14)
    assert [notes(axes)[0] for axes in figure.axes] == ["A", "B", "C", "D", "E"]


def test_models_look_as_in_the_paper_and_the_legend_shows_those_looks(figure):
    looks = [(to_hex(curve(figure.axes[0], i).get_color()), curve(figure.axes[0], i).get_linestyle()) for i in range(4)]
    assert looks == [("#d55e00", "-."), ("#009e73", "--"), ("#000000", "-"), ("#8c8c8c", "-")]
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [*MODELS, "uplifted: MDOF-S"]
    assert [(to_hex(line.get_color()), line.get_linestyle()) for line in legend.get_lines()] == looks
    assert legend.get_title().get_text() == RECORD.name


def test_dashed_curves_lie_over_the_continuous_ones(figure):
    two, three, many, fixed = (curve(figure.axes[2], i).get_zorder() for i in range(4))
    assert fixed < many < three < two


def test_shading_is_the_uplift_of_the_most_detailed_model(figure, four):
    expected = uplift_intervals(four[2])
    assert len(expected) == four[2].n_uplifts > 10
    for axes in figure.axes:
        np.testing.assert_allclose(spans(axes.collections[0]), expected, rtol=1e-12)


def test_bars_at_the_foot_are_the_uplifts_of_each_rocking_model(figure, four):
    _, *bars = figure.axes[0].collections
    assert len(bars) == 3
    for bar, response in zip(bars, reversed(four[:3]), strict=True):
        np.testing.assert_allclose(spans(bar), uplift_intervals(response), rtol=1e-12)
        assert to_hex(bar.get_facecolor()[0]) == to_hex(curve(figure.axes[0], four.index(response)).get_color())
    low, high = figure.axes[0].get_ylim()
    foot = low + max(path.get_extents().y1 for bar in bars for path in bar.get_paths()) * (high - low)
    assert foot < -max(np.abs(r.rotation).max() for r in four)
    assert all(len(axes.collections) == 1 for axes in figure.axes[1:])


def test_one_rocking_model_needs_no_bars(four):
    panels = plot_history(four[2:]).axes
    assert [len(axes.collections) for axes in panels] == [1] * 5


@pytest.mark.parametrize(
    ("panel", "name", "factor"),
    [
        (0, "rotation", 1.0),
        (1, "top_displacement", 1.0),
        (2, "total_top_displacement", 1.0),
        (3, "base_moment", 1e6),
        (4, "base_shear", 1e6),
    ],
)
def test_true_peaks_are_marked_written_and_within_the_axes(figure, four, panel, name, factor):
    axes = figure.axes[panel]
    low, high = axes.get_ylim()
    marks = {
        (float(line.get_xdata()[0]), float(line.get_ydata()[0]))
        for line in axes.get_lines()
        if line.get_marker() == "o"
    }
    assert len(marks) == (3 if name == "rotation" else 4)
    for response in four:
        peak, when = getattr(response, f"max_{name}") / factor, getattr(response, f"time_of_max_{name}")
        if peak == 0.0:
            continue
        assert low < -peak < peak < high
        (value,) = (y for t, y in marks if t == when and abs(y) == peak)
        k = int(np.argmin(np.abs(response.time - when)))
        assert value == pytest.approx(getattr(response, name)[k] / factor, rel=0.1)
        assert any(text == f"{peak:.3g} at {when:.2f} s" for text in notes(axes))
    assert figure.axes[4].get_xlim() == (0.0, four[0].end_time)


@pytest.mark.slow
def test_nothing_outside_the_panels_touches_them_or_leaves_the_figure(four):
    labels = ["a name that is rather long", "another one, just as long as it", "third", "the structure on a fixed base"]
    for figure in (plot_history(four), plot_history(four, labels), plot_history([*four, *four])):
        renderer = FigureCanvasAgg(figure).get_renderer()
        figure.draw(renderer)
        outer = figure.bbox.padded(1.0)
        boxes = [axes.get_window_extent() for axes in figure.axes]
        legend = figure.legends[0].get_window_extent(renderer)
        assert outer.x0 <= legend.x0 < legend.x1 <= outer.x1
        assert outer.y0 <= legend.y0 < legend.y1 <= outer.y1
        for axes in figure.axes:
            texts = [text.get_window_extent(renderer) for text in axes.texts]
            for box in (legend, *texts):
                assert not any(box.overlaps(other) for other in boxes)
                assert outer.x0 <= box.x0 < box.x1 <= outer.x1
            for one, two in pairwise(texts[1:]):
                assert one.y0 >= two.y1 - 1.5


def test_a_run_without_uplift_says_so_and_keeps_an_open_axis():
    weak = RECORD.scaled(0.1)
    panels = plot_history([rf.simulate(FRAME, weak, model) for model in MODELS]).axes
    assert "no uplift" in notes(panels[0])
    assert panels[0].get_ylim() == (-1e-3, 1e-3)
    assert all(len(axes.collections) == 0 for axes in panels)
    assert panels[4].get_ylabel() == "$V_b$ [kN]"
    assert "fixed base" in notes(plot_history(rf.simulate(FRAME, weak, "fixed")).axes[0])


def test_labels_and_titles(four):
    other = rf.simulate(FRAME, rf.GroundMotion(RECORD.acceleration, RECORD.dt, name="a$b"), "2DOF-S")
    legend = plot_history([four[0], other]).legends[0]
    names = [text.get_text() for text in legend.get_texts()]
    assert names[:2] == [f"2DOF-S, {RECORD.name}", r"2DOF-S, a\$b"]
    assert legend.get_title().get_text() == ""
    legend = plot_history(four[:2], ["_one", "two"], title="Mine").legends[0]
    assert [text.get_text() for text in legend.get_texts()] == ["_one", "two", "uplifted: two"]
    assert legend.get_title().get_text() == "Mine"
    assert plot_history(other).legends[0].get_title().get_text() == r"a\$b"
    plot_history([four[0], other]).savefig(io.BytesIO())


def test_takes_one_response_any_iterable_and_the_column_of_a_table(four):
    table = rf.simulate_many(FRAME, RECORD, ["2DOF-S", "fixed"], output="history")
    assert len(plot_history(four[0]).axes) == 5
    assert len(plot_history(iter(four)).legends[0].get_texts()) == 5
    assert len(plot_history(table["response"]).legends[0].get_texts()) == 3


def test_sixteen_responses_are_told_apart_and_no_more(four):
    looks = [c.style for c in response_curves([*four, *[four[0]] * 12])]
    assert len({(style.color, style.dashes) for style in looks}) == 16
    with pytest.raises(rf.InputError, match=r"^17 responses are too many to distinguish in one figure\. Plot fewer"):
        plot_history([*four, *[four[0]] * 13])


def test_black_is_for_the_model_with_the_most_modes(four):
    five = rf.simulate(FRAME, RECORD, "5DOF-S")
    four_modes = rf.simulate(FRAME, RECORD, "4DOF-S")
    assert [c.style.color for c in response_curves([four_modes, five])][1] == "#000000"
    assert [c.style.color for c in response_curves([five, four[2]])][1] == "#000000"


def test_what_cannot_be_drawn_is_named(four):
    peaks = rf.simulate(FRAME, RECORD, "2DOF-S", output="peaks")
    cases = [
        (([],), "There is no response to plot"),
        (([four[0], peaks],), f"responses[1] (2DOF-S under '{RECORD.name}') keeps peaks only"),
        (([four[0], None],), "responses[1] must be a Response, but NoneType was given"),
        ((four, ["a"]), "labels must be a sequence of 4 strings, one per response, but 1 was given"),
        ((four, "abcd"), "but the string 'abcd' was given"),
    ]
    for arguments, said in cases:
        with pytest.raises(rf.InputError, match=re.escape(said)):
            plot_history(*arguments)


def test_the_settings_of_the_caller_stay_as_they_are(four):
    with rc_context({"font.size": 17.0, "axes.grid": False, "figure.facecolor": "red"}):
        before = dict(rcParams)
        figure = plot_history(four[0])
        assert dict(rcParams) == before
    assert figure.get_facecolor() == (1.0, 0.0, 0.0, 1.0)
    assert figure.axes[0].yaxis.label.get_fontsize() == 17.0


@pytest.mark.slow
def test_matplotlib_is_imported_late_and_pyplot_never():
    code = (
        "import sys, rockflex\n"
        "assert 'matplotlib' not in sys.modules\n"
        "import rockflex.plot\n"
        "assert 'matplotlib' in sys.modules and 'matplotlib.pyplot' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_panels_are_chosen_and_lettered_from_the_top(four):
    figure = plot_history(four, panels=("top_displacement", "rotation"), title="")
    assert [axes.get_ylabel() for axes in figure.axes] == [r"$u_{\mathrm{top}}$ relative [m]", "θ [rad]"]
    assert [notes(axes)[0] for axes in figure.axes] == ["A", "B"]
    np.testing.assert_array_equal(curve(figure.axes[0], 2).get_ydata(), four[2].top_displacement)
    assert figure.axes[1].get_xlabel() == "time [s]"
    # The bars of the uplifts stand at the foot of the first.
    assert [len(axes.collections) for axes in figure.axes] == [4, 1]
    (alone,) = plot_history(four[0], panels=["base_shear"]).axes
    assert alone.get_ylabel() == "$V_b$ [kN]"


def test_a_detail_is_a_second_column_of_panels(four):
    figure = plot_history(four, panels=("rotation", "top_displacement"), detail=(2.0, 5.5))
    assert [notes(axes)[0] for axes in figure.axes] == ["A", "B", "C", "D"]
    whole = (0.0, max(float(response.time[-1]) for response in four))
    assert [axes.get_xlim() for axes in figure.axes] == [whole, (2.0, 5.5)] * 2
    quantities = [axes.get_ylabel()[:1] for axes in figure.axes]
    assert quantities == ["θ", "θ", "$", "$"]
    assert [axes.get_xlabel() for axes in figure.axes] == ["", "", "time [s]", "time [s]"]
    for axes in figure.axes[:2]:
        np.testing.assert_array_equal(curve(axes, 2).get_ydata(), four[2].rotation)
    narrow = plot_history(four, panels=["rotation"], detail=(2.0, 5.5), size="column")
    assert [axes.get_xlim() for axes in narrow.axes] == [whole, (2.0, 5.5)]


@pytest.mark.parametrize("detail", [(2.0,), (5.0, 2.0), (-1.0, 2.0), (0.0, 1e3)])
def test_a_detail_lies_within_the_responses(four, detail):
    with pytest.raises(rf.InputError, match=re.escape(f"but {detail!r} was given")):
        plot_history(four, detail=detail)


def test_lines_are_the_caller_s(four):
    given = [("gray", "-"), ("blue", "--"), ("#123456", ":"), ("black", "-.")]
    figure = plot_history(four, panels=["rotation"], lines=given)
    looks = [(to_hex(curve(figure.axes[0], i).get_color()), curve(figure.axes[0], i).get_linestyle()) for i in range(4)]
    assert looks == [("#8c8c8c", "-"), ("#0072b2", "--"), ("#123456", ":"), ("#000000", "-.")]
    for wrong in (given[:3], [*given[:3], ("no colour", "-")], [*given[:3], ("black", "dashes")]):
        with pytest.raises(rf.InputError, match=r"lines must be 4 pairs of a colour and one of -, --, -\., :"):
            plot_history(four, lines=wrong)


def test_what_the_ground_must_hold_is_a_panel_of_its_own(four):
    (axes,) = plot_history(four[2], panels=["horizontal_reaction"]).axes
    assert axes.get_ylabel() == "$ΣF_x$ [kN]"
    np.testing.assert_allclose(curve(axes, 0).get_ydata(), four[2].horizontal_reaction / 1e3, rtol=1e-14)


def test_the_accelerogram_is_a_panel_that_is_asked_for(four):
    (axes,) = plot_history(four[2], panels=["ground_acceleration"]).axes
    np.testing.assert_allclose(curve(axes, 0).get_ydata(), four[2].ground_acceleration, rtol=1e-14)
    peak = int(np.abs(four[2].ground_acceleration).argmax())
    assert any(f"at {four[2].time[peak]:.2f} s" in text.get_text() for text in axes.texts)


def test_without_a_known_height_there_is_no_panel_of_the_total_displacement():
    p = FRAME.rocking(1)
    names = ("omega", "effective_mass", "effective_height", "top_ordinate", "i_theta", "l0r", "m_tot", "half_width")
    bare = rf.RockingProperties(**{name: getattr(p, name) for name in names}, zeta=p.zeta)
    response = rf.simulate(bare, RECORD, "2DOF-S")
    assert math.isnan(response.max_total_top_displacement)
    labels = [axes.get_ylabel() for axes in plot_history(response).axes]
    assert labels == ["θ [rad]", r"$u_{\mathrm{top}}$ relative [m]", "$M_b$ [MN m]", "$V_b$ [kN]"]
    with pytest.raises(
        rf.InputError, match=r"^The height of the top is not known, so there is no total displacement\."
    ):
        plot_history(response, panels=["total_top_displacement"])


@pytest.mark.parametrize("panels", [(), ("rotation", "rotation"), ("theta",)])
def test_panels_that_are_none_are_named(four, panels):
    with pytest.raises(rf.InputError, match=re.escape(f"each once, but {panels!r} was given")):
        plot_history(four, panels=panels)


def test_complete_and_yielding_models_have_looks_of_their_own(four):
    labels = ("2DOF-C", "2DOF-C-SI", "3DOF-C-E", "2DOF-S")
    models = [rf.simulate(FRAME, RECORD, label) for label in labels]
    models.append(rf.simulate(FRAME, RECORD, "2DOF-S", bouc_wen=rf.BoucWen(0.02)))
    curves = response_curves([*models, *four[2:]])
    colors = {curve.label: curve.style.color for curve in curves}
    assert colors["2DOF-C"] == "#cc79a7"
    assert colors["2DOF-C-SI"] == "#e69f00"
    assert colors["2DOF-S"] == "#d55e00"
    assert colors["2DOF-S-BW"] == "#56b4e9"
    assert len({(curve.style.color, curve.style.dashes) for curve in curves}) == len(curves)
    assert curves[0].order < curves[1].order < 3.0


@pytest.fixture(scope="module")
def fallen():
    """Released beyond the amplitude from which it can return, after one return."""
    quiet = rf.quiet_motion(20.0)
    return rf.simulate(FRAME, quiet, "2DOF-S", initial=rf.InitialState(rotation=0.05, rotation_velocity=0.5))


@pytest.fixture(scope="module")
def returned():
    return rf.simulate(FRAME, rf.quiet_motion(20.0), "3DOF-S", initial=rf.InitialState(rotation=0.05))


def test_overturning_squashes_no_other_curve(fallen, returned):
    assert (fallen.status, returned.status) == ("overturned", "rocking")
    figure = plot_history([fallen, returned])
    rotation, displacement, total, moment, _ = figure.axes
    high = rotation.get_ylim()[1]
    assert high == pytest.approx(1.12 * returned.max_rotation)
    (triangle,) = (line for line in rotation.get_lines() if line.get_marker() in "^v")
    when = float(np.interp(high, np.abs(fallen.rotation), fallen.time))
    assert float(triangle.get_xdata()[0]) == pytest.approx(when, rel=1e-9)
    assert triangle.get_marker() == "^"
    assert triangle.get_ydata()[0] == high
    for axes in figure.axes:
        (line,) = (line for line in axes.get_lines() if line.get_linestyle() == ":")
        assert list(line.get_xdata()) == [fallen.end_time] * 2
    assert f"overturned, {fallen.end_time:.2f} s" in notes(rotation)
    before = fallen.time < np.min(fallen.time[np.abs(fallen.rotation) > BALANCE])
    for axes, values, factor, name in (
        (displacement, fallen.top_displacement, 1.0, "top_displacement"),
        (total, fallen.total_top_displacement, 1.0, "total_top_displacement"),
        (moment, fallen.base_moment, 1e6, "base_moment"),
    ):
        largest = max(np.abs(values[before]).max(), getattr(returned, f"max_{name}")) / factor
        assert axes.get_ylim()[1] == pytest.approx(1.12 * largest)
    assert np.abs(fallen.base_moment).max() / 1e6 > moment.get_ylim()[1]


def test_overturning_to_the_left_points_down():
    initial = rf.InitialState(rotation=-0.05, rotation_velocity=-0.5)
    left = rf.simulate(FRAME, rf.quiet_motion(20.0), "2DOF-S", initial=initial)
    assert left.status == "overturned"
    axes = plot_history(left).axes[0]
    (triangle,) = (line for line in axes.get_lines() if line.get_marker() in "^v")
    assert triangle.get_marker() == "v"
    assert triangle.get_ydata()[0] == axes.get_ylim()[0]


def test_where_all_overturn_the_axis_reaches_the_rotation_of_balance(fallen):
    assert plot_history(fallen).axes[0].get_ylim()[1] == pytest.approx(1.12 * BALANCE)
    fixed = rf.simulate(FRAME, rf.quiet_motion(20.0), "fixed")
    assert plot_history([fallen, fixed]).axes[0].get_ylim()[1] == pytest.approx(1.12 * BALANCE)


def test_a_fall_that_the_record_cuts_short_squashes_nothing_either(returned):
    initial = rf.InitialState(rotation=0.05, rotation_velocity=0.5)
    falling = rf.simulate(FRAME, rf.quiet_motion(1.0), "2DOF-S", initial=initial)
    assert falling.status == "rocking"
    assert falling.max_rotation > BALANCE
    axes = plot_history([falling, returned]).axes[0]
    assert axes.get_ylim()[1] == pytest.approx(1.12 * returned.max_rotation)
    assert any(line.get_marker() == "^" for line in axes.get_lines())


@pytest.mark.slow
def test_a_run_beyond_balance_from_the_start_is_shown_whole():
    start = rf.InitialState(rotation=1.2 * BALANCE)
    response = rf.simulate(FRAME, rf.quiet_motion(20.0), "2DOF-S", initial=start)
    assert response.status == "overturned"
    panels = plot_history(response).axes
    assert panels[0].get_ylim()[1] > 0.5 * math.pi
    assert panels[1].get_ylim()[1] > response.max_top_displacement


@pytest.mark.slow
def test_phases_open_at_both_ends_are_shaded(returned):
    initial = rf.InitialState(rotation=0.05)
    short = rf.simulate(FRAME, rf.quiet_motion(0.5), "2DOF-S", initial=initial)
    np.testing.assert_allclose(spans(plot_history(short).axes[1].collections[0]), [[0.0, 0.5]])
    expected = uplift_intervals(returned)
    assert expected[0, 0] == 0.0
    np.testing.assert_allclose(spans(plot_history(returned).axes[1].collections[0]), expected, rtol=1e-12)


def run(base, model):
    return rf.simulate(rf.equivalent_2hz_long_base(base, 0.01), PULSE, model, free_vibration=1.0)


@pytest.fixture(scope="module")
def nominal():
    return [run(0.1, model) for model in SPREAD_MODELS]


@pytest.fixture(scope="module")
def varied():
    return [[run(base, model) for base in (0.0, 0.3)] for model in SPREAD_MODELS]


def band(axes):
    """Time, lower and upper edge of a filled band."""
    (area,) = axes.collections
    vertices = area.get_paths()[0].vertices
    times = np.unique(vertices[:, 0])
    edges = [vertices[vertices[:, 0] == t, 1] for t in times]
    return times, np.array([e.min() for e in edges]), np.array([e.max() for e in edges])


def test_the_band_is_least_and_largest_of_all_at_each_instant(nominal, varied):
    figure = drawn(plot_spread(nominal, varied, title="x"))
    panels = np.array(figure.axes).reshape(2, 2)
    for row, (one, group) in enumerate(zip(nominal, varied, strict=True)):
        for column, name in enumerate(("rotation", "top_displacement")):
            axes = panels[row, column]
            times, low, high = band(axes)
            values = np.array([np.interp(times, r.time, getattr(r, name)) for r in (one, *group)])
            np.testing.assert_allclose(low, values.min(axis=0), atol=1e-12)
            np.testing.assert_allclose(high, values.max(axis=0), atol=1e-12)
            (line,) = axes.get_lines()
            np.testing.assert_array_equal(line.get_ydata(), getattr(one, name))
            assert axes.get_title(loc="left") == SPREAD_MODELS[row]
            assert axes.get_ylim()[1] > max(getattr(r, f"max_{name}") for r in group)
    assert figure.legends[0].get_title().get_text() == "x"


def test_panels_and_labels_are_the_caller_s(nominal, varied):
    figure = drawn(plot_spread(nominal, varied, ["a", "b"], panels=["base_shear"]))
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["a", "b"]
    assert all(axes.get_ylabel().startswith("$V_b$") for axes in figure.axes)
    assert figure.legends[0].get_title().get_text() == PULSE.name


def test_what_falls_counts_no_more_and_stretches_nothing():
    p = rf.equivalent_s1(0.3, 0.02, 0.2, 0.5)
    quiet = rf.quiet_motion(2.0)
    stands = rf.simulate(p, quiet, "2DOF-S", initial=rf.InitialState(rotation=0.1))
    falls = rf.simulate(p, quiet, "2DOF-S", initial=rf.InitialState(rotation=0.1, rotation_velocity=5.0))
    assert falls.status == "overturned"
    axes = plot_spread([stands], [[falls]], panels=["rotation"]).axes[0]
    balance = p.m_tot * p.half_width / p.l0r
    assert axes.get_ylim()[1] < 1.2 * balance
    times, low, high = band(axes)
    after = times > falls.end_time
    np.testing.assert_allclose(low[after], high[after], atol=1e-12)


def test_groups_must_fit(nominal, varied):
    for groups, sizes in (([varied[0]], "[2]"), ([varied[0], []], "[2, 0]")):
        with pytest.raises(rf.InputError, match=re.escape(f"but groups of {sizes} were given")):
            plot_spread(nominal, groups)
    peaks = rf.simulate(rf.equivalent_2hz_long_base(0.0, 0.01), PULSE, "2DOF-S", output="peaks")
    with pytest.raises(rf.InputError, match="keeps peaks only"):
        plot_spread(nominal, [varied[0], [peaks]])
