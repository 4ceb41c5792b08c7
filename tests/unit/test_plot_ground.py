"""Figures of a base that slides, or is on springs."""

import numpy as np
import pytest

import rockflex as rf
from drawing import drawn, legend, notes, uplift_intervals
from rockflex.plot._history import response_curves

PIER = rf.CantileverWithTipMass(
    height=12.0, tip_mass=500e3, mass_per_length=10e3, bending_stiffness=4.0e10, base_mass=120e3, half_width=1.5,
    damping_ratio=0.03, n_modes=2,
)  # fmt: skip
P = PIER.rocking()
B, INERTIA = P.half_width, 120e3 * 3.0**2 / 12.0
BED = rf.winkler_bed(B, 4.0, 150e6, n=8).damped(0.1, P.m_tot)
RECORD = rf.load_suite("fema-p695-far-field")["FF-2-a"].acceleration[300:1500]
PLAIN = rf.GroundMotion(RECORD, 0.01, "part")
SHAKEN = rf.GroundMotion(RECORD, 0.01, "part", vertical=3.0 * np.roll(RECORD, 40))


@pytest.fixture(scope="module")
def hops():
    return rf.simulate(PIER, SHAKEN, "MDOF-S", ground=rf.Ground(0.4, BED, INERTIA))


@pytest.fixture(scope="module")
def slides():
    return rf.simulate(PIER, SHAKEN, "MDOF-S", ground=rf.Ground(0.2))


@pytest.fixture(scope="module")
def stands():
    return rf.simulate(PIER, PLAIN, "MDOF-S")


def panel(figure, name):
    return next(axes for axes in figure.axes if axes.get_ylabel().startswith(name))


@pytest.mark.slow
def test_histories_show_slip_and_edges_where_the_ground_makes_them_matter(hops, slides, stands):
    def names(responses):
        return [axes.get_ylabel().split(" [")[0] for axes in rf.plot_history(responses).axes]

    usual = names(stands)
    assert names(slides) == [*usual, "x"]
    assert names(hops) == [*usual, "x", "edges"]
    assert len(rf.plot_history(stands, panels=["slip", "edge_uplift"]).axes) == 2
    figure = drawn(rf.plot_history([hops, slides], labels=["soil", "rigid"]))
    first, *_, mark = panel(figure, "x").get_lines()
    np.testing.assert_array_equal(first.get_ydata(), hops.slip)
    assert abs(mark.get_ydata()[0]) == slides.max_slip
    edges = panel(figure, "edges")
    left, right, *_ = edges.get_lines()
    np.testing.assert_array_equal(np.stack((left.get_ydata(), right.get_ydata()), axis=1), hops.edge_uplift)
    assert left.get_color() == right.get_color()
    assert left.get_linewidth() > right.get_linewidth()
    low, high = edges.get_ylim()
    assert low < -hops.max_edge_settlement
    assert high > hops.max_edge_uplift
    assert f"{hops.max_edge_uplift:.3g} at" in notes(edges)[2]
    assert legend(figure)[:2] == ["soil", "rigid"]


def test_a_base_on_springs_is_uplifted_while_an_edge_is_off_its_spring(hops, stands):
    np.testing.assert_array_equal(stands.history.uplifted, stands.side != 0.0)
    lifted = hops.spring_force[:, [0, -1]] == 0.0
    # A spring that pushes no more but is still compressed is not lifted.
    assert not np.any(hops.history.uplifted & ~lifted.any(axis=1))
    (curve,) = response_curves(hops)
    assert curve.uplifts.shape[0] > 5
    np.testing.assert_array_equal(response_curves(stands)[0].uplifts, uplift_intervals(stands))
    outer = hops.history.model.springs.positions[[0, -1]]
    heights = hops.heave[:, None] - outer * hops.rotation[:, None]
    inside = (heights.max(axis=1) > 1e-6) & (np.roll(heights, 1, axis=0).max(axis=1) > 1e-6)
    assert np.all(hops.history.uplifted[inside])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["hops", "slides"])
def test_the_layers_of_energy_add_up(name, request):
    run = request.getfixturevalue(name)
    figure = drawn(rf.plot_energy(run))
    (axes,) = figure.axes
    texts = legend(figure)
    assert "friction of the base" in texts
    assert ("damped by the ground" in texts) == ("compressed ground" in texts) == (name == "hops")
    (supply,) = (line for line in axes.get_lines() if "input" in line.get_label())
    top = max(axes.collections, key=lambda each: each.get_paths()[0].vertices[:, 1].max())
    vertices = top.get_paths()[0].vertices
    for time, value in zip(*supply.get_data(), strict=True):
        near = vertices[vertices[:, 0] == time, 1]
        assert near.max() == pytest.approx(value, abs=1e-6 * max(supply.get_ydata()))
    assert vertices[:, 1].min() >= 0.0


def test_a_footing_is_a_map_of_pressure_with_its_contact(hops):
    figure = drawn(rf.plot_footing(hops))
    edges, soil, contact, bar = figure.axes
    left, right, _ = edges.get_lines()
    np.testing.assert_allclose(np.stack((left.get_ydata(), right.get_ydata()), axis=1), 1e3 * hops.edge_uplift)
    (mesh,) = soil.collections
    values = np.ma.getdata(mesh.get_array())
    kept = np.concatenate(([True], np.diff(hops.time) > 0.0))
    np.testing.assert_allclose(values, hops.soil_pressure[kept].T / 1e6)
    assert np.ma.getmaskarray(mesh.get_array()).sum() == (hops.soil_pressure[kept] <= 0.0).sum()
    assert bar.get_ylabel() == "pressure [MPa]"
    (line,) = contact.get_lines()
    np.testing.assert_allclose(line.get_ydata(), 100.0 * (hops.spring_force > 0.0).mean(axis=1))  # equal widths
    assert line.get_ydata().min() == 0.0  # it hops
    assert edges.get_title() == "MDOF-S under part"
    assert rf.plot_footing(hops, title="mine").axes[0].get_title() == "MDOF-S under mine"


def test_a_few_springs_are_lines_of_force():
    springs = rf.Springs([-B, 0.0, B], 5e8, 3e6)
    run = rf.simulate(PIER, PLAIN, "2DOF-S", ground=rf.Ground(springs=springs, base_inertia=INERTIA))
    _, soil, contact = drawn(rf.plot_footing(run)).axes
    assert soil.get_ylabel() == "force [MN]"
    for line, force in zip(soil.get_lines(), run.spring_force.T, strict=True):
        np.testing.assert_allclose(line.get_ydata(), force / 1e6)
    assert [text.get_text() for text in soil.get_legend().get_texts()] == ["x = −1.5 m", "x = 0 m", "x = 1.5 m"]
    pushing = run.spring_force > 0.0
    np.testing.assert_allclose(contact.get_lines()[0].get_ydata(), pushing @ [25.0, 50.0, 25.0])


def test_a_base_on_rigid_ground_has_no_springs_to_draw(slides):
    with pytest.raises(rf.InputError, match="The base of this response is not on springs"):
        rf.plot_footing(slides)


def test_springs_never_pull_and_so_never_warn(hops):
    undamped = rf.Ground(springs=rf.Springs([-B, B], 1e9), base_inertia=INERTIA)
    for run in (hops, rf.simulate(PIER, SHAKEN, "MDOF-S", ground=undamped)):
        assert run.min_vertical_reaction == 0.0
        assert run.vertical_reaction.min() >= -1e-9 * P.m_tot
        assert run.warnings == ()
    rigid = rf.simulate(PIER, SHAKEN, "MDOF-S")
    assert rigid.min_vertical_reaction < 0.0
    assert "Give simulate a Ground with springs, on which the base can leave the ground." in rigid.warnings[0]


@pytest.mark.slow
@pytest.mark.parametrize("held", [False, True])
def test_loops_of_a_base_on_springs_meet_its_equation_of_motion(held):
    fuses = [rf.YieldingDissipator(5e7, 2e5, 0.02, x) for x in (-1.0, 0.5)]
    pier = rf.Restrained(PIER, fuses) if held else PIER
    run = rf.simulate(pier, SHAKEN, "MDOF-S", ground=rf.Ground(springs=BED, base_inertia=INERTIA))
    figure = drawn(rf.plot_loops(run))
    total, *parts = figure.axes[0].get_lines()
    np.testing.assert_array_equal(total.get_xdata(), run.rotation)
    inertia = P.translational_inertia + INERTIA
    flexure = run.modal_acceleration @ (P.effective_mass * P.effective_height)
    # I_c θ'' + Σ m* h* D'' = -M - L_0^r a
    moment = -(inertia * run.rotation_acceleration + flexure + P.l0r * run.ground_acceleration)
    np.testing.assert_allclose(total.get_ydata() * 1e6, moment, atol=1e-7 * np.abs(moment).max())
    names = ["weight", "springs", *(["1 fuse, x = −1 m", "2 fuse, x = 0.5 m"] if held else [])]
    assert [part.get_label() for part in parts] == names
    path = figure.axes[0].get_ylabel()
    assert path == "M [MN m]"
    assert drawn(rf.plot_moment_rotation(run)).axes[0].get_title() == "MDOF-S"


def test_vertical_motion_changes_the_weight_that_resists():
    run = rf.simulate(PIER, SHAKEN, "MDOF-S")
    (total,) = drawn(rf.plot_loops(run)).axes[0].get_lines()
    rocking = run.side != 0.0
    theta, side = run.rotation[rocking], run.side[rocking]
    heavy = 9.81 + run.vertical_ground_acceleration[rocking]
    expected = heavy * (side * P.m_tot * B - P.l0r * theta)
    np.testing.assert_allclose(total.get_ydata() * 1e6, expected, rtol=1e-9, atol=1e-3)
