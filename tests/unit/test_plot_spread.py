import numpy as np
import pytest

import rockflex as rf
from drawing import drawn
from rockflex.plot import plot_spread

MODELS = ("2DOF-C", "2DOF-S")
PULSE = rf.ricker_pulse(0.981, 0.5)


def run(base, model):
    return rf.simulate(rf.equivalent_2hz_long_base(base, 0.01), PULSE, model, free_vibration=1.0)


@pytest.fixture(scope="module")
def nominal():
    return [run(0.1, model) for model in MODELS]


@pytest.fixture(scope="module")
def varied():
    return [[run(base, model) for base in (0.0, 0.3)] for model in MODELS]


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
            assert axes.get_title(loc="left") == MODELS[row]
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
    text = "varied must hold 2 groups, one per response, each of at least one response, but groups of {} were given."
    for groups, sizes in (([varied[0]], "[2]"), ([varied[0], []], "[2, 0]")):
        with pytest.raises(rf.InputError) as caught:
            plot_spread(nominal, groups)
        assert str(caught.value) == text.format(sizes)
    peaks = rf.simulate(rf.equivalent_2hz_long_base(0.0, 0.01), PULSE, "2DOF-S", output="peaks")
    with pytest.raises(rf.InputError, match="keeps peaks only"):
        plot_spread(nominal, [varied[0], [peaks]])
