import math

import numpy as np
import pytest
from matplotlib.colors import to_hex

import rockflex as rf
from builders import make_frame
from drawing import drawn, legend
from rockflex.plot import plot_energy, plot_mode_shapes, plot_moment_rotation

FRAME = make_frame()
RECORD = rf.load_suite("el-centro-1940")[0]
HALF_WIDTH = FRAME.modal().effective_height[0] / 10.0
RESISTANCE = 6 * 40e3 * 9.81 * HALF_WIDTH
SLOPE = 40e3 * 3.0 * (1 + 2 + 3 + 4 + 5) * 9.81


@pytest.fixture(scope="module")
def responses():
    return {model: rf.simulate(FRAME, RECORD, model) for model in ("2DOF-S", "MDOF-S", "fixed")}


@pytest.fixture(scope="module")
def fallen():
    initial = rf.InitialState(rotation=0.05, rotation_velocity=0.5)
    return rf.simulate(FRAME, rf.quiet_motion(20.0), "2DOF-S", initial=initial)


# --- moment over rotation ------------------------------------------------------------------------------------------


def test_moment_rotation_draws_the_loops_and_the_static_line(responses):
    figure = drawn(plot_moment_rotation(responses.values()))
    assert [axes.get_title() for axes in figure.axes] == ["2DOF-S", "MDOF-S"]
    for axes, response in zip(figure.axes, (responses["2DOF-S"], responses["MDOF-S"]), strict=True):
        loop, static = axes.get_lines()
        np.testing.assert_array_equal(loop.get_xdata(), response.rotation)
        np.testing.assert_allclose(loop.get_ydata(), response.base_moment / 1e6, rtol=1e-14)
        theta, moment = np.array(static.get_xdata()), 1e6 * np.array(static.get_ydata())
        np.testing.assert_allclose(moment[[1, 2]], [-RESISTANCE, RESISTANCE], rtol=1e-12)
        np.testing.assert_allclose(moment[[0, 3]], np.array([-1, 1]) * (RESISTANCE - SLOPE * theta[3]), rtol=1e-12)
        assert theta[3] == -theta[0] == axes.get_xlim()[1] > response.max_rotation
        assert axes.get_ylim()[1] * 1e6 > max(response.max_base_moment, RESISTANCE)
    assert figure.get_supylabel() == "$M_b$ [MN m]"
    assert figure.get_supxlabel() == "θ [rad]"
    assert legend(figure) == [r"static, $\pm(m_{tot}\,g\,B - L_0^r\,g\,|θ|)$"]


def test_loops_of_a_rigid_structure_lie_on_a_share_of_the_static_line():
    """In the rigid limit θ'' is minus the static moment over I_θ, and M_b what accelerates the mode: -m* h*² θ''."""
    p = FRAME.rocking(1)
    stiff = rf.RockingProperties(
        30 * p.omega, p.effective_mass, p.effective_height, p.top_ordinate, p.i_theta, p.l0r, p.m_tot, p.half_width, 0.9
    )
    response = rf.simulate(stiff, rf.quiet_motion(1.4), "2DOF-S", initial=rf.InitialState(rotation=0.1))
    loop, static = plot_moment_rotation(response).axes[0].get_lines()
    late = response.time > 0.5
    expected = np.interp(loop.get_xdata()[late], static.get_xdata()[2:], static.get_ydata()[2:])
    share = float(p.effective_mass[0] * p.effective_height[0] ** 2) / p.i_theta
    np.testing.assert_allclose(loop.get_ydata()[late], share * expected, rtol=0.01)


def test_moment_rotation_keeps_labels_with_their_curves(responses):
    figure = plot_moment_rotation([responses["fixed"], responses["MDOF-S"], responses["2DOF-S"]], ["f", "m", "t"])
    assert [axes.get_title() for axes in figure.axes] == ["m", "t"]
    assert [to_hex(axes.get_lines()[0].get_color()) for axes in figure.axes] == ["#000000", "#d55e00"]


@pytest.mark.slow
def test_moment_rotation_has_three_panels_a_row(responses):
    figure = drawn(plot_moment_rotation([responses["2DOF-S"]] * 4))
    assert [axes.axison for axes in figure.axes] == [True] * 4 + [False] * 2
    assert len({axes.get_xlim() for axes in figure.axes[:4]}) == 1


def test_moment_rotation_of_an_overturning_run_keeps_its_scale(fallen, responses):
    figure = plot_moment_rotation([fallen, responses["2DOF-S"]])
    assert figure.axes[0].get_xlim()[1] == pytest.approx(1.1 * responses["2DOF-S"].max_rotation)
    assert plot_moment_rotation(fallen).axes[0].get_xlim()[1] == pytest.approx(1.1 * RESISTANCE / SLOPE)
    limit = plot_moment_rotation(fallen).axes[0].get_ylim()[1] * 1e6
    assert RESISTANCE < limit < 0.5 * fallen.max_base_moment


def test_moment_rotation_without_uplift_shows_the_static_line_whole():
    figure = plot_moment_rotation(rf.simulate(FRAME, RECORD.scaled(0.1), "2DOF-S"))
    assert figure.axes[0].get_xlim()[1] == pytest.approx(1.1 * RESISTANCE / SLOPE)
    assert figure.axes[0].get_ylim()[1] == pytest.approx(1.1 * RESISTANCE / 1e6)


def test_moment_rotation_needs_a_base_that_lifts(responses):
    with pytest.raises(rf.InputError, match="None of the responses has a base that can lift"):
        plot_moment_rotation(responses["fixed"])


# --- mode shapes ---------------------------------------------------------------------------------------------------


def test_mode_shapes_start_at_the_base_and_sum_to_one():
    figure = drawn(plot_mode_shapes(FRAME))
    lines = [axes.get_lines()[1] for axes in figure.axes]
    assert len(lines) == 5
    for line in lines:
        np.testing.assert_array_equal(line.get_ydata(), [0, 3, 6, 9, 12, 15])
    np.testing.assert_allclose(sum(line.get_xdata() for line in lines), [0, 1, 1, 1, 1, 1], atol=1e-12)
    for axes, line in zip(figure.axes, lines, strict=True):
        low, high = axes.get_xlim()
        assert low < line.get_xdata().min() < line.get_xdata().max() < high
        assert axes.get_ylim()[1] > 15


def test_mode_shapes_state_what_the_modes_are():
    modes = FRAME.modal()
    titles = [axes.get_title() for axes in plot_mode_shapes(FRAME, 2).axes]
    assert len(titles) == 2
    assert titles[0].splitlines()[0] == "$T_{1}$ = 1 s"
    share = 100.0 * modes.effective_mass[1] / (5 * 40e3)
    assert titles[1].splitlines() == [
        f"$T_{{2}}$ = {modes.period[1]:.3g} s",
        rf"$m^*_{{2}}/Σm$ = {share:.3g} %",
        rf"$h^*_{{2}}$ = −{-modes.effective_height[1]:.3g} m",
    ]


def test_mode_shapes_of_some_modes_alone_give_masses_in_kg():
    modes = FRAME.modal(2)
    title = plot_mode_shapes(modes).axes[0].get_title().splitlines()[1]
    assert title.startswith("$m^*_{1}$ = ")
    assert title.endswith(" kg")
    assert float(title.split()[2]) == pytest.approx(modes.effective_mass[0], rel=5e-3)


def test_mode_shapes_fold_into_rows_and_thin_out_their_marks():
    high = make_frame(n_stories=50, stiffness_ratio=0.0, period=2.0)
    figure = drawn(plot_mode_shapes(high, 7))
    assert [axes.axison for axes in figure.axes] == [True] * 7 + [False] * 3
    assert figure.axes[0].get_lines()[1].get_marker() in ("", "None")
    assert plot_mode_shapes(FRAME).axes[0].get_lines()[1].get_marker() == "o"


def test_a_mode_that_takes_no_part_has_no_height():
    """Two equal masses on equal springs to the ground: the second mode has neither shear nor moment at h = const."""
    modes = rf.ModalProperties(
        omega=np.array([1.0, 2.0]), effective_mass=np.array([2.0, 0.0]), effective_height=np.array([1.5, math.inf]),
        participation=np.array([1.0, 0.0]), shapes=np.array([[1.0, -1.0], [1.0, 1.0]]), heights=np.array([1.0, 2.0]),
    )  # fmt: skip
    first, second = drawn(plot_mode_shapes(modes)).axes
    assert first.get_title().endswith("= 1.5 m")
    assert second.get_title().endswith("= none")
    np.testing.assert_array_equal(second.get_lines()[1].get_xdata(), 0.0)
    assert second.get_xlim() == (-1.25, 1.25)


def test_mode_shapes_refuse_what_has_no_modes():
    with pytest.raises(rf.InputError, match=r"structure_or_modal must be .* RockingProperties was given"):
        plot_mode_shapes(FRAME.rocking())
    with pytest.raises(rf.InputError, match="n_modes must be a whole number from 1 to 5, but 6 was given"):
        plot_mode_shapes(FRAME, 6)


# --- energy --------------------------------------------------------------------------------------------------------


def layers(axes):
    """Height of every layer over time, from the corners of its polygon."""
    found = {}
    for collection in axes.collections:
        vertices = collection.get_paths()[0].vertices
        n = (len(vertices) - 1) // 2
        bottom, top = vertices[1:n, 1], vertices[n + 1 : 2 * n, 1][::-1]
        found[collection.get_label()] = (vertices[1:n, 0], bottom, top)
    return found


def test_energy_layers_stack_up_to_the_input(responses):
    response = responses["MDOF-S"]
    figure = drawn(plot_energy(response))
    axes = figure.axes[0]
    stack = layers(axes)
    assert list(stack) == ["damped", "lost in impacts", "raised weight", "strain", "kinetic"]
    (line,) = axes.get_lines()
    np.testing.assert_allclose(line.get_ydata(), response.energy.input / 1e3, rtol=1e-14)
    top = stack["kinetic"][2]
    np.testing.assert_allclose(top, line.get_ydata()[: top.size], atol=1e-9 * line.get_ydata().max())
    lost = stack["lost in impacts"]
    assert (lost[2] - lost[1])[-1] == pytest.approx(response.energy.impact_losses.sum() / 1e3, rel=1e-9)
    assert axes.get_ylabel() == "energy [kJ]"
    assert axes.get_ylim()[1] > line.get_ydata().max()
    assert axes.get_title() == (f"MDOF-S under {RECORD.name}, closing error {response.energy.closing_error:.1e}")
    assert legend(figure) == ["input", *reversed(stack)]


def test_energy_leaves_out_what_stays_empty(responses):
    assert list(layers(plot_energy(responses["fixed"]).axes[0])) == ["damped", "strain", "kinetic"]
    rest = rf.simulate(FRAME, rf.quiet_motion(2.0), "fixed")
    axes = drawn(plot_energy(rest)).axes[0]
    assert layers(axes) == {}
    assert axes.get_ylim() == (0.0, 1.0)


def test_energy_of_a_release_starts_from_what_was_raised():
    start = 0.05
    response = rf.simulate(FRAME, rf.quiet_motion(5.0), "2DOF-S", initial=rf.InitialState(rotation=start))
    (line,) = plot_energy(response).axes[0].get_lines()
    assert line.get_label() == "start + input"
    np.testing.assert_allclose(1e3 * line.get_ydata(), RESISTANCE * start - 0.5 * SLOPE * start**2, rtol=1e-9)


def test_energy_is_drawn_up_to_the_fall(fallen):
    axes = drawn(plot_energy(fallen)).axes[0]
    supply, mark = axes.get_lines()
    assert mark.get_label() == "overturning"
    reached = supply.get_xdata()[-1]
    assert mark.get_xdata()[0] == reached
    at = float(np.interp(reached, fallen.time, fallen.rotation))
    assert 0.8 * RESISTANCE / SLOPE < at <= RESISTANCE / SLOPE
    assert all(np.all(top >= bottom - 1e-9) for _, bottom, top in layers(axes).values())


def test_energy_needs_a_history():
    with pytest.raises(rf.InputError, match="keeps peaks only, but its history is needed"):
        plot_energy(rf.simulate(FRAME, RECORD, "2DOF-S", output="peaks"))
