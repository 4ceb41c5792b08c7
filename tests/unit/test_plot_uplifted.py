"""Figures of uplifted frequencies, moment-rotation laws and towers: the artists carry the right numbers."""

import math
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import make_frame
from drawing import drawn, legend, notes

FRAME = make_frame()
OTHER = make_frame(stiffness_ratio=0.0)
TOWER = rf.TaperedTower(200.0, 8.0, 4.0, 1.0, 2400.0, 25e9, 0.02)
RATIOS = (0.2, 2.0, 20.0, 200.0)


@pytest.fixture(scope="module")
def tables():
    return {"shear": rf.frequency_ratios(FRAME, RATIOS), "bend$ing": rf.frequency_ratios(OTHER, RATIOS)}


def named(axes, label):
    return [line for line in axes.get_lines() if line.get_label() == label]


@pytest.mark.slow
def test_a_curve_a_model_and_structure_in_a_panel_a_mode(tables):
    limits = {"shear": rf.pinned_beam("shear"), "bend$ing": rf.pinned_beam("flexure")}
    backwards = {
        name: table.sort_values("aspect_ratio", ascending=False, kind="stable") for name, table in tables.items()
    }
    figure = drawn(rf.plot_frequency_ratios(backwards, limits))
    for axes, mode in zip(figure.axes, (1, 2), strict=True):
        assert axes.get_xscale() == "log"
        assert [text.get_text() for text in axes.texts if "." in text.get_text()] == [
            f"{beam.ratio[mode - 1]:.3f}" for beam in limits.values()
        ]
        assert [line.get_ydata()[0] for line in named(axes, "_limit")] == [b.ratio[mode - 1] for b in limits.values()]
        assert named(axes, "_mark")[0].get_xdata() == [10.0, 10.0]
        for model, keeps in (("2DOF-S", 1), ("3DOF-S", 2), ("MDOF-S", 5)):
            lines = named(axes, model)
            assert len(lines) == (2 if keeps >= mode else 0)
            for line, table in zip(lines, tables.values(), strict=False):
                rows = table[(table["model"] == model) & (table["mode"] == mode)]
                np.testing.assert_array_equal(line.get_xdata(), RATIOS)
                np.testing.assert_array_equal(line.get_ydata(), rows["ratio"])
                assert axes.get_ylim()[0] < 1.0 < rows["ratio"].max() < axes.get_ylim()[1]
    assert legend(figure) == [
        "2DOF-S", "3DOF-S", "MDOF-S", "shear", r"bend\$ing", "pinned beam, no spring", r"$h^*_1/B$ = 10",
    ]  # fmt: skip
    one, two = named(figure.axes[0], "MDOF-S")
    assert one.get_color() == two.get_color()
    assert one.get_linestyle() != two.get_linestyle()


def test_one_table_needs_no_name_and_no_limit(tables):
    figure = drawn(rf.plot_frequency_ratios(tables["shear"], rf.pinned_beam("shear", n_modes=3), modes=(3,), mark=None))
    (axes,) = figure.axes
    assert legend(figure) == ["2DOF-S", "3DOF-S", "MDOF-S", "pinned beam, no spring"]
    assert not named(axes, "_mark")
    assert axes.get_ylabel() == "$ω^*_{3}/ω_{3}$"
    assert legend(drawn(rf.plot_frequency_ratios(tables["shear"])))[-1] == r"$h^*_1/B$ = 10"


def test_curves_break_at_poles_and_cross_zero_at_the_marks():
    figure = drawn(rf.plot_frequency_equation({"stiff": FRAME, "soft": OTHER.rocking()}))
    assert [axes.get_title() for axes in figure.axes] == ["stiff", "soft"]
    for axes, frame in zip(figure.axes, (FRAME, OTHER), strict=True):
        p = frame.rocking()
        end = axes.get_xlim()[1]
        assert [line.get_xdata()[0] for line in named(axes, "_pole")] == list(
            (p.omega / p.omega[0])[p.omega / p.omega[0] < end]
        )
        written = notes(axes)
        for model, count in (("2DOF-S", 1), ("3DOF-S", 2), ("MDOF-S", 5)):
            kept = p.truncated(count)
            (curve,) = named(axes, model)
            x, y = curve.get_xdata(), curve.get_ydata()
            assert (np.diff(x) > 0.0).all()
            np.testing.assert_allclose(
                y, rf.frequency_equation(kept, x * p.omega[0]) / (p.i_theta * p.omega[0] ** 2), rtol=1e-6
            )
            poles = kept.omega[kept.omega < end * p.omega[0]] / p.omega[0]
            np.testing.assert_array_equal(x[np.isnan(y)], poles)
            (marks,) = named(axes, f"_{model}")
            roots = rf.uplifted_modes(kept).omega / p.omega[0]
            np.testing.assert_array_equal(marks.get_xdata(), roots[roots < end])
            np.testing.assert_array_equal(marks.get_ydata(), 0.0)
            # Where the curve falls through zero without a break in between there is a mark, and nowhere else.
            down = np.flatnonzero((y[:-1] > 0.0) & (y[1:] <= 0.0))
            np.testing.assert_allclose(0.5 * (x[down] + x[down + 1]), roots[roots < end], atol=0.03)
            at = written.index(model)
            assert written[at + 1 : at + 1 + min(count, 2)] == [f"   {root:.3f}" for root in roots[:2]]
    assert legend(figure) == ["2DOF-S", "3DOF-S", "MDOF-S", r"$ω_n/ω_1$, fixed base"]


def test_the_range_may_be_given():
    (axes,) = drawn(rf.plot_frequency_equation(FRAME, (3,), highest=4.0)).axes
    assert axes.get_xlim() == (0.0, 4.0)
    assert len(named(axes, "4DOF-S")) == 1


def test_laws_of_the_pinned_beam_and_of_the_rocking_base():
    p = FRAME.rocking()
    figure = drawn(rf.plot_moment_rotation_laws(FRAME))
    left, right = figure.axes
    end = left.get_xlim()[1]
    zero = p.m_tot * p.half_width / p.l0r
    assert left.get_ylabel() == "M [MN m]"
    np.testing.assert_allclose(
        named(left, "pinned beam")[0].get_xydata(), [[s * end, s * p.l0r * 9.81 * end / 1e6] for s in (-1, 1)]
    )
    theta, moment = named(right, "rocking")[0].get_data()
    weight = p.m_tot * 9.81 * p.half_width / 1e6
    np.testing.assert_allclose(theta, [-end, 0.0, 0.0, end])
    np.testing.assert_allclose(moment[1:3], [-weight, weight])
    np.testing.assert_allclose(moment[3], weight - p.l0r * 9.81 / 1e6 * end)
    np.testing.assert_allclose(moment, -moment[::-1])
    np.testing.assert_allclose(named(right, "_0")[0].get_xdata(), [-zero, zero])
    assert end > zero
    arm = p.l0r * 9.81 / 1e6
    assert notes(left)[-1] == f"slope $k_r$ =\n{arm:.3g} MN m/rad"
    assert f"$M_r$ = {weight:.3g} MN m" in notes(right)
    assert f"slope $-L_0^r\\,g$ =\n−{arm:.3g} MN m/rad\n$M$ = 0 at ±{zero:.3g} rad" in notes(right)


def test_tendons_change_the_law():
    p = FRAME.rocking()
    held = replace(p, elements=rf.Tendon(2e5, 1.05 * p.l0r * 9.81 / p.half_width**2))
    left, right = drawn(rf.plot_moment_rotation_laws(held, spring=1e6, rotation=0.05)).axes
    assert left.get_xlim() == (-0.05, 0.05)
    np.testing.assert_allclose(named(left, "pinned beam")[0].get_ydata(), [-0.05, 0.05])
    moment = named(right, "rocking")[0].get_ydata() * 1e6
    start = (p.m_tot * 9.81 + 2e5) * p.half_width
    np.testing.assert_allclose(moment[2:], [start, start + 0.05 * p.l0r * 9.81 * 0.05])
    assert notes(right)[-1].endswith("$M$ does not vanish")
    assert "k_t" in notes(right)[-1]
    assert not named(right, "_0")
    falling = drawn(rf.plot_moment_rotation_laws(p, rotation=3.0 * p.m_tot * p.half_width / p.l0r)).axes[1]
    assert falling.texts[-1].get_va() == "top"
    lines = notes(falling)[-1].splitlines()
    assert lines[0] == f"$M$ = 0 at ±{p.m_tot * p.half_width / p.l0r:.3g} rad"
    assert lines[-1] == f"$M_r$ = {p.m_tot * 9.81 * p.half_width / 1e6:.3g} MN m"
    short = drawn(rf.plot_moment_rotation_laws(p, rotation=1e-3)).axes[1]
    assert "vanish" not in notes(short)[-1]
    assert "= 0" not in notes(short)[-1]
    drawn(rf.plot_moment_rotation_laws(held))


def test_each_side_of_an_eccentric_base_has_its_own_law():
    p = rf.Eccentric(FRAME, 0.2).rocking()
    axes = drawn(rf.plot_moment_rotation_laws(p)).axes[1]
    end, weight = axes.get_xlim()[1], p.m_tot * 9.81 / 1e6
    near, far = p.half_width - 0.2, p.half_width + 0.2
    theta, moment = named(axes, "rocking")[0].get_data()
    np.testing.assert_allclose(theta, [-end, 0.0, 0.0, end])
    np.testing.assert_allclose(moment[1:3], [-weight * far, weight * near])
    arm = p.l0r * 9.81 / 1e6
    np.testing.assert_allclose(moment[::3], [-weight * far + arm * end, weight * near - arm * end])
    zeros = np.array([-far, near]) * p.m_tot / p.l0r
    np.testing.assert_allclose(named(axes, "_0")[0].get_xdata(), zeros)
    said = notes(axes)
    for text in (f"$M_r$ = {weight * near:.3g} MN m", f"$M_r$ = {weight * far:.3g} MN m", f"{zeros[1]:.3g} rad"):
        assert text in said
    assert end > -zeros[0]
    # A stiff tendon beside the left edge lets it fall to the left alone.
    held = replace(p, elements=rf.Tendon(0.0, 2.0 * p.l0r * 9.81 / p.half_width**2, -far))
    right = drawn(rf.plot_moment_rotation_laws(held)).axes[1]
    np.testing.assert_allclose(named(right, "_0")[0].get_xdata(), zeros[:1])
    assert any("(right)" in text and "(left)" in text for text in notes(right))


@pytest.mark.slow
def test_the_frequency_equation_about_either_edge():
    p = rf.Eccentric(FRAME, 0.2).rocking()
    for side in (1, -1, None):
        (axes,) = drawn(rf.plot_frequency_equation(p, (None,), side=side)).axes
        roots = named(axes, "_MDOF-S")[0].get_xdata()
        expected = rf.uplifted_modes(p, side=side).omega / p.omega[0]
        np.testing.assert_allclose(roots, expected[: roots.size])


def test_a_tower_by_its_measures():
    left, right = drawn(rf.plot_tower(TOWER, 50.0)).axes
    sides = [path.get_extents() for area in left.collections[:2] for path in area.get_paths()]
    assert [(box.x0, box.x1, box.y0, box.y1) for box in sides] == [(-8, -3, 0, 200), (3, 8, 0, 200)]
    np.testing.assert_array_equal(named(left, "_arm")[0].get_xydata(), [[8.0, 0.0], [0.0, 50.0]])
    slab = left.collections[2].get_paths()[0].get_extents()
    assert (slab.x0, slab.x1) == (-7.0, 7.0)
    assert 0.5 * (slab.y0 + slab.y1) == 50.0
    expected = {
        "O",
        f"$Δ$ = {math.hypot(50.0, 8.0):.4g} m",
        "$H$ = 200 m",
        "$B$ = $R_c$ = 8 m",
        "$t_c$ = 1 m",
        "$z$ = 50 m",
    }
    assert expected <= set(notes(left))
    assert {"$R$ = 7 m", "$r$ = 6 m"} <= set(notes(right))
    assert [patch.get_radius() for patch in right.patches[1:3]] == [7.0, 6.0]
    assert right.get_title() == "section at 50 m"
    assert drawn(rf.plot_tower(TOWER)).axes[1].get_title() == "section at 100 m"
    drawn(rf.plot_tower(replace(TOWER, wall=4.0), 200.0))


RATIOS_OF_ONE = rf.frequency_ratios(FRAME, [1.0])
BEAM = rf.pinned_beam("shear", n_modes=1)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: rf.plot_frequency_ratios({}), "0 tables were given"),
        (lambda: rf.plot_frequency_ratios(pd.DataFrame({"mode": [1]})), "lacks model, aspect_ratio, ratio"),
        (lambda: rf.plot_frequency_ratios({"a": rf.frequency_ratios(FRAME, [1.0], 1)}), "'a' has no row of mode 2"),
        (lambda: rf.plot_frequency_ratios({"a": RATIOS_OF_ONE}, {"b": BEAM}), "limits has the name 'b'"),
        (lambda: rf.plot_frequency_ratios(RATIOS_OF_ONE, BEAM), "Give pinned_beam(..., n_modes=2)"),
        (lambda: rf.plot_frequency_ratios(RATIOS_OF_ONE, modes=()), "modes is empty"),
        (lambda: rf.plot_frequency_equation({}), "Give at least one structure"),
        (lambda: rf.plot_frequency_equation(3.0), "structure must be a structure"),
        (lambda: rf.plot_frequency_equation(FRAME, (6,)), "n_modes must be a whole number from 1 to 5, but 6"),
        (lambda: rf.plot_frequency_equation(FRAME, highest=-1.0), "highest must be a positive"),
        (lambda: rf.plot_frequency_equation(rf.rigid_block(0.2, 2.0)), "A structure without modes"),
        (lambda: rf.plot_moment_rotation_laws(rf.Frame), "the class Frame was given"),
        (lambda: rf.plot_moment_rotation_laws(FRAME, spring=0.0), "spring must be a positive"),
        (lambda: rf.plot_tower(FRAME), "tower must be a TaperedTower, but Frame was given"),
        (lambda: rf.plot_tower(TOWER, 201.0), "section must be at most the height of the tower, 200 m, but 201 m"),
    ],
)
def test_what_cannot_be_drawn_is_named(call, said):
    with pytest.raises(rf.InputError, match=re.escape(said)):
        call()


def test_too_many_models_are_named():
    frame = make_frame(n_stories=15, stiffness_ratio=0.1)
    table = rf.frequency_ratios(frame, [1.0], (*range(1, 16), None))
    with pytest.raises(rf.InputError, match=r"16 models are too many to distinguish in one figure\. Plot fewer"):
        rf.plot_frequency_ratios(table)
