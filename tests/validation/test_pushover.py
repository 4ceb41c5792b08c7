"""Pushover: statically determinate stories in closed form, uplift, equilibrium with elements, and the bilinear fit."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex import InputError

STRENGTHS, RATIOS = np.array([300e3, 260e3, 120e3]), np.array([0.05, 0.1, 0.02])


def frame() -> rf.Frame:
    return make_frame(n_stories=3, stiffness_ratio=np.inf, period=0.6, aspect_ratio=6.0)


def yielding(ratios=RATIOS) -> rf.YieldingStories:
    return rf.YieldingStories(frame(), STRENGTHS, ratios)


def drift(shear, stiffness, strength, ratio):
    """The drift of a story under a shear that grows."""
    return np.where(
        shear <= strength, shear / stiffness, strength / stiffness + (shear - strength) / (ratio * stiffness)
    )


@pytest.mark.parametrize("pattern", [None, [1.0, 1.0, 1.0], [0.0, 0.0, 2.0]])
def test_story_shears_are_those_of_statics(pattern):
    structure = yielding()
    push = rf.pushover(structure, 0.3, pattern=pattern, lifts=False)
    shares = np.cumsum(push.pattern[::-1])[::-1]
    np.testing.assert_allclose(push.story_shear, np.outer(push.lateral_force, shares), rtol=1e-9, atol=1e-3)
    for k in range(3):
        expected = drift(push.story_shear[:, k], structure.stiffness[k], STRENGTHS[k], RATIOS[k])
        np.testing.assert_allclose(push.story_drift[:, k], expected, rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(push.base_shear, push.lateral_force, rtol=1e-9, atol=1e-3)
    heights = 3.0 * np.arange(1, 4)
    np.testing.assert_allclose(push.base_moment, push.lateral_force * (push.pattern @ heights), rtol=1e-9, atol=1e-2)
    assert push.top_displacement[-1] == pytest.approx(0.3, rel=1e-12)
    order = np.argsort(STRENGTHS / shares)
    reached = [f"story {k + 1} yields" for k in order if STRENGTHS[k] / shares[k] < push.lateral_force[-1]]
    assert [each.name for each in push.events] == reached
    for each, k in zip(push.events, order, strict=False):
        assert each.base_shear == pytest.approx(STRENGTHS[k] / shares[k], rel=1e-9)


def test_a_story_without_hardening_is_a_mechanism():
    push = rf.pushover(yielding(0.0), 0.2, lifts=False)
    assert [each.name for each in push.events] == ["story 3 yields"]
    assert push.base_shear[-1] == pytest.approx(push.base_shear[-2], rel=1e-9)
    assert push.fit().post_yield_ratio == pytest.approx(0.0, abs=1e-9)


def test_uplift_limits_the_forces():
    structure = frame()
    p = structure.rocking()
    push = rf.pushover(structure, 0.5)
    lever = push.pattern @ p.floors.heights
    (event,) = push.events
    assert event.name == "uplift"
    assert event.base_shear == pytest.approx(p.resisting_moment / lever, rel=1e-9)
    expected = (p.resisting_moment - p.l0r * 9.81 * push.rotation[-1]) / lever
    assert push.lateral_force[-1] == pytest.approx(expected, rel=1e-9)
    assert push.total_top_displacement[-1] == pytest.approx(0.5, rel=1e-12)
    top = push.top_displacement + p.top_height * push.rotation
    np.testing.assert_allclose(top, push.total_top_displacement, rtol=1e-9, atol=1e-12)
    assert rf.pushover(structure, 0.5, lifts=False).events == ()


def test_elements_share_the_force():
    """Ties take what the stories do not; braces are in the shear of a story, and tendons in the moment on the base."""
    elements = [
        rf.Tendon(200e3, 5e6),
        rf.YieldingDissipator(2e7, 50e3, 0.02, position=0.5),
        rf.YieldingDissipator(3e7, 60e3, 0.1, between=(0, 2), cosine=0.8),
        rf.YieldingDissipator(1e6, 40e3, 0.1, height=6.0),
    ]
    structure = rf.Restrained(frame(), elements)
    p = structure.rocking()
    push = rf.pushover(structure, 0.4)
    tendon, fuse, brace, tie = push.element_force.T
    np.testing.assert_allclose(push.base_shear + 0.8 * brace + tie, push.lateral_force, rtol=1e-8, atol=1e-2)
    off = push.rotation > 0.0
    b = p.half_width
    resisting = p.m_tot * 9.81 * b - p.l0r * 9.81 * push.rotation + tendon * b + fuse * (b - 0.5) + 6.0 * tie
    turning = push.lateral_force * (push.pattern @ p.floors.heights)
    assert off.sum() >= 2
    np.testing.assert_allclose(turning[off], resisting[off], rtol=1e-8)
    assert (turning[~off] <= resisting[~off] * (1.0 + 1e-9)).all()
    np.testing.assert_allclose(
        push.element_elongation[:, 3], (push.story_drift[:, :2].sum(axis=1) + 6.0 * push.rotation)
    )
    assert {each.name for each in push.events} == {
        *("uplift", "element 2 yields", "element 3 yields", "element 4 yields"),
    }


def test_the_way_ends_where_an_element_breaks():
    fuse = rf.YieldingDissipator(2e7, 50e3, 0.02, height=6.0, rupture_elongation=0.01)
    push = rf.pushover(rf.Restrained(frame(), fuse), 0.4, lifts=False)
    assert push.events[-1].name == "element 1 breaks"
    assert push.element_elongation[-1, 0] == pytest.approx(0.01, rel=1e-9)
    assert push.total_top_displacement[-1] < 0.4


def test_the_fit_has_the_same_stiffness_area_and_end():
    push = rf.pushover(yielding(), 0.2, lifts=False)
    for end in (0.1, None):
        fit, last = push.fit(end), end or 0.2
        v = np.interp(last, push.top_displacement, push.base_shear)
        u = np.append(push.top_displacement[push.top_displacement < last], last)
        area = np.trapezoid(np.interp(u, push.top_displacement, push.base_shear), u)
        ends = fit.yield_force + fit.post_yield_ratio * fit.stiffness * (last - fit.yield_displacement)
        lines = 0.5 * fit.yield_force * fit.yield_displacement
        lines += 0.5 * (fit.yield_force + ends) * (last - fit.yield_displacement)
        assert ends == pytest.approx(v, rel=1e-9)
        assert lines == pytest.approx(area, rel=1e-9)
        assert fit.stiffness == pytest.approx(push.base_shear[1] / push.top_displacement[1], rel=1e-9)
    hysteresis = push.fit().bouc_wen
    p = frame().rocking()
    # The first mode pushed by its own forces: V = m* ω² D.
    assert push.fit().yield_force == pytest.approx(
        p.effective_mass[0] * p.omega[0] ** 2 * hysteresis.yield_displacement, rel=1e-9
    )


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"top_displacement": -0.1}, "top_displacement"),
        ({"pattern": [1.0, 2.0]}, "pattern"),
        ({"pattern": [1.0, -2.0, 0.5]}, "pattern"),
        ({"structure": rf.rigid_block(0.2, 3.0)}, "structure"),
    ],
)
def test_bad_input_is_refused(given, field):
    with pytest.raises(InputError) as caught:
        rf.pushover(**({"structure": frame(), "top_displacement": 0.1} | given))
    assert caught.value.field == field


def test_a_curve_without_yielding_has_no_fit():
    for push in (rf.pushover(frame(), 0.1, lifts=False), rf.pushover(frame(), 0.5)):
        with pytest.raises(InputError) as caught:
            push.fit()
        assert caught.value.field == "top_displacement"


def test_the_figure_shows_curve_fit_and_events():
    push = rf.pushover(yielding(), 0.2, lifts=False)
    curve, drifts = rf.plot_pushover(push, push.fit()).axes
    line, fit, *marks = curve.get_lines()
    np.testing.assert_allclose(line.get_ydata() * 1e3, push.base_shear)
    assert fit.get_xdata()[1] == pytest.approx(push.fit().yield_displacement)
    assert len(marks) == len(push.events) == 3
    assert all(event.name in curve.texts[0].get_text() for event in push.events)
    assert len(drifts.patches) == 3
