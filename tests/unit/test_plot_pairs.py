import numpy as np
import pytest
from matplotlib.colors import to_hex

import rockflex as rf
from drawing import drawn, legend, notes
from drawn_studies import lines
from rockflex.papers.silva_stojadinovic_2024.population import population_statistics
from rockflex.plot._figures import BLUE


@pytest.mark.slow
def test_population_bars_count_the_pairs(pairs):
    figure = drawn(rf.plot_population(pairs))
    shear, flexure = ((pairs["behaviour"] == name).sum() for name in ("shear", "flexure"))
    assert legend(figure) == [rf"shear, $ρ=\infty$ ({shear})", rf"flexure, $ρ=0$ ({flexure})"]
    names = ["n_stories", "aspect_ratio", "base_mass_ratio", "period", "height", "pgv"]
    for axes, name in zip(figure.axes, names, strict=True):
        tops = {}
        for bars, behaviour in zip(axes.containers, ("shear", "flexure"), strict=True):
            values = pairs[name][pairs["behaviour"] == behaviour].to_numpy(float)
            assert sum(bar.get_height() for bar in bars) == len(values)
            for bar in bars:
                middle = bar.get_x() + 0.5 * bar.get_width()
                if name not in ("period", "pgv"):
                    assert bar.get_height() == np.isclose(values, middle).sum()
                assert bar.get_y() == tops.get(round(middle, 9), 0)
                tops[round(middle, 9)] = bar.get_height()
    drawn(rf.plot_population(pairs[:1]))


# Fig. 9


@pytest.mark.slow
def test_agreement_shows_every_pair_that_stands(pairs):
    figure = drawn(rf.plot_agreement(pairs))
    statistics = population_statistics(pairs, n_resamples=20).agreement
    resting = pairs[pairs["status_mdof"] == "no_uplift"]
    rocking = pairs[(pairs["status_mdof"] == "rocking") & (pairs["status_2dof"] != "overturned")]
    shown = [("no_uplift", resting, "top_displacement")]
    shown += [("rocking", rocking, name) for name in ("top_displacement", "rotation")]
    for axes, (group, rows, quantity) in zip(figure.axes[:3], shown, strict=True):
        drawn_of = {marks.get_label(): marks for marks in axes.collections}
        for (behaviour, ratio), some in rows.groupby(["behaviour", "aspect_ratio"], observed=True):
            marks = drawn_of.pop(f"_{behaviour} {ratio:g}")
            expected = some[[f"max_{quantity}_2dof", f"max_{quantity}_mdof"]]
            np.testing.assert_array_equal(marks.get_offsets(), expected)
            np.testing.assert_array_equal(marks.get_array(), some["period"])
            assert marks.cmap.name == {"shear": "Reds", "flexure": "Blues"}[behaviour]
            assert (marks.norm.vmin, marks.norm.vmax) == (pairs["period"].min(), pairs["period"].max())
            np.testing.assert_array_equal(np.argsort(marks.get_sizes()), np.argsort(some["n_stories"]))
        assert not drawn_of
        told = statistics[(statistics["group"] == group) & (statistics["quantity"] == quantity)].set_index("behaviour")
        assert notes(axes)[0] == (
            f"R² = {told['r2']['all']:.2f}, n = {len(rows)}\n$c_1$ = {told['slope']['shear']:.2f}, shear\n"
            f"$c_1$ = {told['slope']['flexure']:.2f}, flexure"
        )
        ((x, y),) = [line.get_data() for line in lines(axes, "_equal")]
        np.testing.assert_array_equal(x, y)
    key = figure.axes[3]
    titles = [each.get_title().get_text() for each in (*key.artists, key.get_legend())]
    assert titles == [r"$h^*_1/B$", "stories"]
    assert [text.get_text() for text in key.artists[0].get_texts()] == ["5", "6", "7", "8", "9", "10"]


@pytest.mark.slow
def test_pairs_without_results_are_told_and_empty_groups_drawn(pairs):
    some = pairs[:8].copy()
    some["status_mdof"] = ["rocking"] * 5 + ["overturned"] * 2 + [None]
    some["status_2dof"] = ["rocking"] * 4 + ["overturned", "rocking", "rocking", "rocking"]
    figure = drawn(rf.plot_agreement(some))
    assert notes(figure.axes[3]) == ["left out: 3 overturned, 1 failed"]
    assert notes(figure.axes[0])[0].startswith("R² = –, n = 0\n$c_1$ = –, shear")
    figure = drawn(rf.plot_modal_combination(some))
    assert figure.legends[0].get_title().get_text() == "4 rocking pairs; left out: 3 overturned, 1 failed"
    none = drawn(rf.plot_modal_combination(some[4:7]))
    assert none.legends[0].get_title().get_text() == "0 rocking pairs; left out: 3 overturned"
    assert not lines(none.axes[0], "_regression")
    one = drawn(rf.plot_agreement(pairs[pairs["behaviour"] == "shear"]))
    assert "$c_1$ = –, flexure" in notes(one.axes[1])[0]


# Fig. 13


def test_modal_combination_is_the_root_of_the_sum_of_squares(pairs):
    figure = drawn(rf.plot_modal_combination(pairs))
    rows = pairs[(pairs["status_mdof"] == "rocking") & (pairs["status_2dof"] != "overturned")]
    weight, moment = rows["structure_mass"] * 9.81, rows["l0r_g"]
    second = rows["effective_mass_2"] * rows["sa_2"]
    one = {name: rows[f"max_{name}_2dof"] for name in ("top_displacement", "base_shear", "base_moment")}
    expected = [
        (rows["sd_2"], rows["max_second_displacement_mdof"], None),
        (
            np.hypot(one["top_displacement"], rows["top_ordinate_2"] * rows["sd_2"]),
            rows["max_top_displacement_mdof"],
            one["top_displacement"],
        ),
        (
            np.hypot(one["base_shear"], second) / weight,
            rows["max_base_shear_mdof"] / weight,
            one["base_shear"] / weight,
        ),
        (
            np.hypot(one["base_moment"], rows["effective_height_2"] * second) / moment,
            rows["max_base_moment_mdof"] / moment,
            one["base_moment"] / moment,
        ),
    ]
    for axes, (x, y, alone) in zip(figure.axes, expected, strict=True):
        for behaviour in ("shear", "flexure"):
            mine = rows["behaviour"] == behaviour
            found = np.column_stack(lines(axes, f"_{behaviour}")[0].get_data())
            np.testing.assert_allclose(found, np.column_stack((x[mine], y[mine])), rtol=1e-12)
        c1 = float(np.linalg.lstsq(np.asarray(x)[:, None], np.asarray(y))[0][0])
        (line,) = lines(axes, "_regression")
        assert to_hex(line.get_color()) == BLUE
        np.testing.assert_allclose(line.get_ydata(), c1 * line.get_xdata())
        told = [f"R² = {1.0 - ((y - x) ** 2).sum() / ((y - y.mean()) ** 2).sum():.2f}".replace("-", "−")]
        if alone is not None:
            r2 = 1.0 - ((y - alone) ** 2).sum() / ((y - y.mean()) ** 2).sum()
            told.append(f"(2DOF-S alone: {r2:.2f})".replace("-0", "−0"))
        assert notes(axes)[0] == "\n".join([*told, f"$y$ = {c1:.2f} $x$"])
