"""Loops of bases, of elements, and of superstructures that yield."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

import rockflex as rf
from builders import make_frame
from drawing import drawn, legend, notes, spans, uplift_intervals
from rockflex.plot import plot_hysteresis, plot_yielding

WALL = rf.CantileverWithTipMass(
    height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.5, damping_ratio=0.02
)
TENDON = rf.Tendon(300e3, 8e6, yield_force=500e3, post_yield_ratio=0.02)
FUSES = [rf.YieldingDissipator(60e6, 100e3, 0.02, x) for x in (-0.5, 0.5)]
HELD = rf.Restrained(WALL, [TENDON, *FUSES])
ARM, WEIGHT, SLOPE = 1.5, 60e3 * 9.81, 50e3 * 10.0 * 9.81
MOTION = rf.load_suite("fema-p695-far-field")["FF-2-a"].scaled(1.5)
PULSE = rf.ricker_pulse(5.0, 1.2)
FRAME = make_frame()
RECORD = rf.load_suite("el-centro-1940")[0]
LAW = rf.BoucWen(0.035)


@pytest.fixture(scope="module")
def run():
    return rf.simulate(HELD, MOTION, "MDOF-S")


def test_a_pushover_is_drawn_with_its_parts():
    curve = rf.moment_rotation(HELD, [0.01, -0.02, 0.03, 0.0])
    figure = drawn(rf.plot_loops(curve))
    base, *elements = figure.axes
    assert (base.get_xlabel(), base.get_ylabel()) == ("θ [rad]", "M [MN m]")
    names = ["total", "weight", "1 tendon, x = 0 m", "2 fuse, x = −0.5 m", "3 fuse, x = 0.5 m"]
    assert legend(figure) == names
    total, weight, *parts = base.get_lines()
    np.testing.assert_array_equal(total.get_xdata(), curve.rotation)
    np.testing.assert_allclose(total.get_ydata(), curve.moment / 1e6, rtol=1e-14)
    np.testing.assert_allclose(weight.get_ydata() + sum(part.get_ydata() for part in parts), total.get_ydata())
    for place, (axes, part) in enumerate(zip(elements, parts, strict=True)):
        (line,) = axes.get_lines()
        np.testing.assert_array_equal(line.get_xdata(), curve.element_elongation[:, place])
        np.testing.assert_allclose(line.get_ydata(), curve.element_force[:, place] / 1e3, rtol=1e-14)
        assert (axes.get_title(), axes.get_ylabel()) == (names[2 + place], "F [kN]")
        assert to_hex(line.get_color()) == to_hex(part.get_color())
    assert len({to_hex(line.get_color()) for line in base.get_lines()}) == 5


def test_a_run_is_drawn_without_its_states_in_contact(run):
    figure = drawn(rf.plot_loops(run))
    assert figure.legends[0].get_title().get_text() == "FF-2-a"
    base, tendon, *_ = figure.axes
    total = base.get_lines()[0]
    rocking = run.history.side != 0.0
    theta, force = run.history.rotation[rocking], run.history.element_force[rocking]
    np.testing.assert_array_equal(total.get_xdata(), theta)
    side = np.sign(theta)
    levers = np.array([ARM * side, (ARM + 0.5 * side) * side, (ARM - 0.5 * side) * side]).T
    expected = side * WEIGHT * ARM - SLOPE * theta + (levers * force).sum(axis=1)
    away = theta != 0.0
    np.testing.assert_allclose(total.get_ydata()[away] * 1e6, expected[away], rtol=1e-9)
    np.testing.assert_array_equal(tendon.get_lines()[0].get_ydata() * 1e3, run.history.element_force[:, 0])
    assert rf.plot_loops(run, title="mine $1").legends[0].get_title().get_text() == r"mine \$1"


@pytest.mark.slow
def test_a_base_on_springs_is_drawn_with_its_edges():
    springs = rf.Springs([-ARM, 0.3, ARM], 1e8, 2e6)
    ground = rf.Ground(springs=springs, base_inertia=2e4)
    curve = rf.moment_rotation(HELD, [0.01, -0.01], ground=ground)
    for result in (curve, rf.simulate(HELD, PULSE, "2DOF-S", ground=ground)):
        base, edges, *elements = drawn(rf.plot_loops(result)).axes
        names = ["total", "weight", "springs", "1 tendon, x = 0 m", "2 fuse, x = −0.5 m", "3 fuse, x = 0.5 m"]
        assert [line.get_label() for line in base.get_lines()] == names
        total, weight, soil, *parts = (line.get_ydata() for line in base.get_lines())
        np.testing.assert_allclose(weight + soil + sum(parts), total, atol=1e-9 * np.abs(total).max())
        np.testing.assert_allclose(weight * 1e6, -SLOPE * result.rotation, atol=1e-9 * SLOPE)
        np.testing.assert_allclose(soil * 1e6, result.spring_force @ springs.positions, atol=1e-6 * WEIGHT)
        assert (edges.get_title(), edges.get_ylabel()) == ("edges of the base", "rise [mm]")
        _, left, right = (line.get_ydata() for line in edges.get_lines())
        np.testing.assert_allclose(np.stack((left, right), axis=1), 1e3 * result.edge_uplift)
        assert len(elements) == 3


def test_the_static_line_on_springs_is_that_of_a_push():
    ground = rf.Ground(springs=rf.Springs([-ARM, ARM], 1e8, 2e6), base_inertia=2e4)
    run = rf.simulate(WALL, PULSE, "2DOF-S", ground=ground)
    figure = drawn(rf.plot_moment_rotation(run))
    assert legend(figure) == ["static, on the springs"]
    theta, moment = figure.axes[0].get_lines()[1].get_data()
    push = rf.moment_rotation(WALL, [theta.max(), theta.min()], ground=ground)
    np.testing.assert_allclose(moment, push.moment / 1e6)
    np.testing.assert_array_equal(theta, push.rotation)
    held = rf.simulate(HELD, PULSE, "2DOF-S", ground=ground)
    path = drawn(rf.plot_moment_rotation(held)).axes[0].get_lines()[1]
    total = rf.plot_loops(held).axes[0].get_lines()[0]
    np.testing.assert_allclose(path.get_xydata(), total.get_xydata(), rtol=1e-9, atol=1e-12)


def test_many_elements_fill_rows_and_a_free_base_has_none():
    many = rf.Restrained(
        WALL, [TENDON, *FUSES, rf.FrictionDamper(5e4, -1.0), rf.ViscousDamper(1e5), rf.Tendon(1e5, 1e6, 1.2)]
    )
    figure = drawn(rf.plot_loops(rf.moment_rotation(many, [0.02, -0.02])))
    assert [axes.get_title()[:8] for axes in figure.axes[1:]] == [
        "1 tendon", "2 fuse, ", "3 fuse, ", "4 fricti", "5 viscou", "6 tendon"
    ]  # fmt: skip
    assert len({axes.get_position().y0 for axes in figure.axes[1:]}) == 3
    free = drawn(rf.plot_loops(rf.moment_rotation(WALL, [0.02, -0.02])))
    assert len(free.axes) == 1
    assert legend(free) == ["total"]


def test_a_run_that_falls_is_cut_and_one_at_rest_is_empty():
    initial = rf.InitialState(rotation=0.05, rotation_velocity=1.5)
    held = rf.Restrained(WALL, FUSES[0])
    fallen = rf.simulate(held, rf.quiet_motion(20.0), "2DOF-S", initial=initial)
    assert fallen.status == "overturned"
    assert drawn(rf.plot_loops(fallen)).axes[0].get_xlim()[1] < 0.6
    still = rf.simulate(HELD, PULSE.scaled(0.01), "2DOF-S")
    assert still.status == "no_uplift"
    assert drawn(rf.plot_loops(still)).axes[0].get_lines()[0].get_xdata().size == 0


def test_the_static_line_of_a_base_with_fuses_is_its_path(run):
    elastic = rf.simulate(rf.Restrained(WALL, rf.Tendon(300e3, 8e6)), MOTION, "MDOF-S")
    figure = drawn(rf.plot_moment_rotation([run, elastic], ["fuses", "tendon"]))
    assert legend(figure) == [
        "resisting moment of weight and elements",
        r"static, $\pm(M_r - (L_0^r\,g - k_t)\,|θ|)$",
    ]
    path = figure.axes[0].get_lines()[1]
    total = rf.plot_loops(run).axes[0].get_lines()[0]
    np.testing.assert_array_equal(path.get_xydata(), total.get_xydata())
    assert figure.axes[0].get_ylim()[1] > np.abs(path.get_ydata()).max()


def test_the_law_of_a_base_with_fuses_is_a_first_push():
    figure = drawn(rf.plot_moment_rotation_laws(HELD, rotation=0.03))
    (law,) = [line for line in figure.axes[1].get_lines() if line.get_label() == "rocking"]
    curve = rf.moment_rotation(HELD, [0.03])
    theta, moment = law.get_data()
    half = theta.size // 2
    np.testing.assert_allclose(theta[half:], curve.rotation[1:])
    np.testing.assert_allclose(moment[half:] * 1e6, curve.moment[1:])
    np.testing.assert_allclose(theta, -theta[::-1])
    np.testing.assert_allclose(moment, -moment[::-1])
    said = [text.get_text() for text in figure.axes[1].texts]
    assert f"$M_r$ = {curve.uplift_moments[0] / 1e6:.3g} MN m" in said
    assert not any("slope" in text for text in said)


def test_the_law_marks_where_a_fuse_no_longer_helps():
    held = rf.Restrained(WALL, rf.YieldingDissipator(60e6, 100e3))
    axes = drawn(rf.plot_moment_rotation_laws(held, rotation=0.3)).axes[1]
    (mark,) = [line for line in axes.get_lines() if line.get_label() == "_0"]
    zero = (WEIGHT + 100e3) * ARM / SLOPE
    np.testing.assert_allclose(mark.get_xdata(), [-zero, zero])
    assert any(f"$M$ = 0 at ±{zero:.3g} rad" in text.get_text() for text in axes.texts)


@pytest.mark.parametrize(
    ("result", "said"),
    [
        (3.0, "result must be a Response or a MomentRotation, but float was given"),
        (rf.simulate(WALL, MOTION, "2DOF-S", output="peaks"), "keeps peaks only, but its history is needed"),
        (rf.simulate(WALL, PULSE, "fixed"), "cannot lift, so it has no loops"),
    ],
)
def test_bad_input_is_explained(result, said):
    with pytest.raises(rf.InputError, match=said):
        rf.plot_loops(result)


@pytest.fixture(scope="module")
def pair():
    elastic = rf.simulate(FRAME, RECORD, "2DOF-S")
    return [elastic, rf.simulate(FRAME, RECORD, "2DOF-S-BW", bouc_wen=LAW)]


@pytest.fixture(scope="module")
def fallen():
    start = rf.InitialState(rotation=0.05, rotation_velocity=0.5)
    return rf.simulate(FRAME, rf.quiet_motion(20.0), "2DOF-S", initial=start)


def loop(axes, index):
    line = axes.get_lines()[index]
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


def test_loops_are_the_force_of_the_mode_over_the_top(pair):
    axes = drawn(plot_hysteresis(pair)).axes[0]
    p = FRAME.rocking(1)
    mass, omega, top = float(p.effective_mass[0]), float(p.omega[0]), float(p.top_ordinate[0])
    x, force = loop(axes, 0)
    np.testing.assert_allclose(1e3 * force, mass * omega**2 * x / top, rtol=1e-9, atol=1e-6)
    x, force = loop(axes, 1)
    share = LAW.post_yield_ratio
    spring = share * x / top + (1 - share) * LAW.yield_displacement * pair[1].yielding
    np.testing.assert_allclose(1e3 * force, mass * omega**2 * spring, rtol=1e-9, atol=1e-6)
    assert axes.get_xlabel() == r"$u_{\mathrm{top}}$ relative [m]"
    assert axes.get_ylabel() == "$V_b$ [kN]"
    right, high = axes.get_xlim()[1], axes.get_ylim()[1]
    assert right > max(r.max_top_displacement for r in pair)
    assert 1e3 * high > max(r.max_base_shear for r in pair)


def test_the_hysteretic_loop_encloses_what_the_spring_took_up(pair):
    """The area is work; over the whole run it is the last of the nodes' energies, up to what is still stored."""
    x, force = loop(plot_hysteresis(pair).axes[0], 1)
    work = float(np.trapezoid(1e3 * force, x))
    taken = float(pair[1].history.states[-1, -1])
    p = FRAME.rocking(1)
    # V_b works on D_1 and not on the top.
    work /= float(p.top_ordinate[0])
    stored = 0.5 * 1e3 * abs(force[-1]) * (1e3 * abs(force[-1]) / float(p.effective_mass[0] * p.omega[0] ** 2))
    elastic = LAW.post_yield_ratio * float(p.effective_mass[0] * p.omega[0] ** 2) * (x[-1] / p.top_ordinate[0]) ** 2 / 2
    assert work == pytest.approx(taken, rel=0.02, abs=stored + elastic)
    assert work > 10 * (stored + elastic)


def test_three_panels(pair):
    figure = drawn(plot_yielding(pair, ["elastic", "yields"], title="Mine"))
    rotation, displacement, loops = figure.axes
    assert [notes(axes)[0] for axes in figure.axes] == ["A", "B", "C"]
    assert (rotation.get_ylabel(), loops.get_ylabel()) == ("θ [rad]", "$V_b$ [kN]")
    for axes, name in ((rotation, "rotation"), (displacement, "top_displacement")):
        for line, response in zip((k for k in axes.get_lines() if k.get_label()[0] != "_"), pair, strict=True):
            np.testing.assert_array_equal(line.get_ydata(), getattr(response, name))
        assert any(text.startswith(f"{getattr(pair[1], 'max_' + name):.3g} at") for text in notes(axes))
    assert len(loops.get_lines()) == 2
    legend = figure.legends[0]
    assert [text.get_text() for text in legend.get_texts()] == ["elastic", "yields"]
    assert legend.get_title().get_text() == "Mine"
    np.testing.assert_allclose(spans(displacement.collections[0]), uplift_intervals(pair[0]), rtol=1e-12)
    assert displacement.get_xlim() == (0.0, pair[0].end_time)


def test_default_titles_and_labels(pair):
    legend = plot_yielding(pair).legends[0]
    assert [text.get_text() for text in legend.get_texts()] == ["2DOF-S", "2DOF-S-BW"]
    assert legend.get_title().get_text() == RECORD.name
    other = rf.simulate(FRAME, RECORD.scaled(0.5), "2DOF-S-BW", bouc_wen=LAW)
    assert plot_hysteresis([pair[1], other], ["a", "b"]).legends[0].get_title().get_text() == RECORD.name


def test_a_fall_does_not_stretch_the_loops(fallen, pair):
    figure = drawn(plot_hysteresis([fallen, pair[0]]))
    x, force = loop(figure.axes[0], 0)
    assert x.size < fallen.time.size
    assert 1e3 * np.abs(force).max() < 0.5 * fallen.max_base_shear
    assert np.abs(x).max() <= figure.axes[0].get_xlim()[1]
