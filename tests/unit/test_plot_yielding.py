import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from drawing import drawn, notes, spans, uplift_intervals
from rockflex.plot import plot_hysteresis, plot_yielding

FRAME = make_frame()
RECORD = rf.load_suite("el-centro-1940")[0]
LAW = rf.BoucWen(0.035)


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
    assert axes.get_xlabel() == r"$u_{\mathrm{top}}$, relative [m]"
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


def test_the_panels_need_histories():
    peaks = rf.simulate(FRAME, RECORD, "2DOF-S", output="peaks")
    for plot in (plot_hysteresis, plot_yielding):
        with pytest.raises(rf.InputError, match="keeps peaks only, but a plot needs the history"):
            plot(peaks)
