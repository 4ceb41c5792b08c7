"""The search as a study: its file, its folder, its command and its figure."""

import hashlib
import json
import math

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from design_case import CONTENT, FRAME
from drawing import drawn
from rockflex.cli import app
from rockflex.study.design import DesignStudy, search_of
from rockflex.study.plan import ChunkedPlan

SEARCHED = {
    "structures": [{"name": "A", "frame": FRAME, "tendons": [{"initial_force": 3e5, "stiffness": 2e6}]}],
    "records": {"suites": ["fema-p695-far-field"], "include": ["FF-?-*"]},
    "models": ["2DOF-S"],
    "half_widths": [0.8, 1.6, 2.4],
    "scales": [0.7, 1.4, 2.8],
    "limits": [0.02, "overturning"],
    "level": [0.4, 0.8],
    "target": [0.2, 0.05],
    "search": {
        "tendon_factors": {"smallest": 0.0, "largest": 2.0, "count": 2},
        "refinements": 2,
        "designs_per_refinement": 3,
        "cost": {"half_width": 1.0, "prestress": 1e-6},
    },
    "runs_per_chunk": 54,
}


@pytest.fixture(scope="module")
def study():
    return DesignStudy(**SEARCHED)


@pytest.fixture(scope="module")
def folder(study, tmp_path_factory):
    path = tmp_path_factory.mktemp("search") / "kept"
    return path, rf.run_study(study, path)


@pytest.fixture(scope="module")
def found(study, folder):
    return rf.best_design(folder[1], *search_of(study.document()), n_resamples=40)


def parts(path):
    return {each.name: each.read_bytes() for each in (path / "parts").iterdir()}


def test_the_study_is_the_call_in_python(study, folder):
    _, table = folder
    held = rf.Restrained(rf.Frame(**FRAME), rf.Tendon(3e5, 2e6))
    motions = [motion for motion in rf.load_suite("fema-p695-far-field") if len(motion.name) == len("FF-1-a")]
    space = rf.DesignSearch([0.8, 1.6, 2.4], [0.0, 2.0], refinements=2, designs_per_refinement=3)
    wanted = [rf.Requirement(0.02, 0.2, at=0.4), rf.Requirement("overturning", 0.05, at=0.8)]
    cost = rf.DesignCost(1.0, 1e-6)
    pd.testing.assert_frame_equal(
        table, rf.search_design(held, motions, space, wanted, cost, "2DOF-S", [0.7, 1.4, 2.8])
    )
    assert search_of(study.document()) == (wanted, cost)
    assert table["error"].isna().all()
    assert set(table["round"]) == {0, 1, 2}


def test_rows_are_those_of_structures_built_that_way(folder):
    _, table = folder
    designs = table.groupby("structure", observed=True)
    motions = [motion for motion in rf.load_suite("fema-p695-far-field") if len(motion.name) == len("FF-1-a")]
    height = rf.Frame(**FRAME).rocking().effective_height[0]
    for name in ("design 6", "design 8", str(table["structure"].iloc[-1])):
        rows = designs.get_group(name)
        b, factor = rows["half_width"].iloc[0], rows["tendon_factor"].iloc[0]
        frame = rf.Frame(**FRAME | {"aspect_ratio": height / b})
        held = rf.Restrained(frame, rf.Tendon(3e5 * factor, 2e6 * factor))
        cloud = rf.run_cloud(held, motions, "2DOF-S", [0.7, 1.4, 2.8], free_vibration="settle")
        np.testing.assert_allclose(rows["max_rotation"], cloud["max_rotation"], rtol=1e-7)
        np.testing.assert_allclose(rows["resisting_moment"], held.rocking().resisting_moment, rtol=1e-12)


@pytest.mark.parametrize("stop", [1, 4, 6])
def test_a_search_that_is_killed_is_resumed_to_the_same_bytes(study, folder, tmp_path, stop):
    whole, table = folder

    def kill(progress):
        if progress.done == stop:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rf.run_study(study, tmp_path / "kept", progress=kill)
    assert len(parts(tmp_path / "kept")) in (stop, stop + 1)
    pd.testing.assert_frame_equal(rf.run_study(study, tmp_path / "kept"), table)
    assert parts(tmp_path / "kept") == parts(whole)


def test_a_part_that_is_lost_is_computed_anew(study, folder, tmp_path, monkeypatch):
    whole, table = folder
    rf.run_study(study, tmp_path / "kept")
    n_chunks = study.plan().n_chunks
    for number in (0, n_chunks - 1):
        (tmp_path / "kept" / "parts" / f"part-{number:05d}.parquet").unlink()
    computed = []
    real = ChunkedPlan.chunk
    monkeypatch.setattr(ChunkedPlan, "chunk", lambda plan, number: computed.append(number) or real(plan, number))
    pd.testing.assert_frame_equal(rf.run_study(study, tmp_path / "kept"), table)
    assert computed == [0, n_chunks - 1]
    assert parts(tmp_path / "kept") == parts(whole)


def test_designs_without_a_search_are_the_same_documents_as_before():
    text = json.dumps(DesignStudy(**CONTENT).document(), sort_keys=True)
    assert "search" not in text
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == "9ad81c970e4495d0"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"target": None}, "target is missing: a search needs the probability or annual rate that must not be"),
        ({"target": [0.1]}, "target must be one number, or one for each of the 2 limits, but [0.1] was given."),
        ({"level": [0.4, 0.5, 0.6]}, "level must be one number, or one for each of the 2 limits, but [0.4, 0.5, 0.6]"),
        ({"level": [0.4, -0.5]}, "level must be a positive, finite number in the unit of the measure, but -0.5 was"),
        ({"limits": [0.02, 0.02], "level": 0.4}, "requirements must be one or more Requirement objects, each with"),
        ({"tendons": [{}]}, "A search varies the elements of the structure itself by factors. Leave out the levels"),
        ({"half_widths": [1.0], "search": {"cost": {"half_width": 1.0}}}, "There is only one design to look at."),
        ({"search": {}}, "[search] cost is missing: a table of half_width, prestress and dissipator_force"),
        ({"search": {"cost": {}}}, "cost: all unit costs are zero"),
        ({"search": {"cost": {"width": 1.0}}}, "[search.cost] width is not known; there are half_width, prestress,"),
        (
            {"search": SEARCHED["search"] | {"tendon_factors": {"smallest": 1.0}}},
            "tendon_factors must be a list of factors, or a range {smallest = 0.5, largest = 2.0, count = 4}",
        ),
        (
            {"search": SEARCHED["search"] | {"tendon_factors": "all"}},
            "[search] tendon_factors must be a list of factors on the tendons of the structure, or a range",
        ),
        (
            {"search": SEARCHED["search"] | {"tendon_scaling": "area"}},
            '[search] tendon_scaling must be "size" (force and stiffness) or "force", but \'area\' was given.',
        ),
    ],
)
def test_a_search_that_is_wrong(changes, message):
    with pytest.raises(rf.InputError) as caught:
        DesignStudy(**SEARCHED | changes)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"models": ["2DOF-S", "MDOF-S"]}, "models: a search needs one model, but 2DOF-S, MDOF-S were given."),
        (
            {"search": SEARCHED["search"] | {"dissipator_factors": [0.0, 1.0]}},
            "dissipator_factors were given, but the structure has no yielding dissipator or friction damper that they "
            "could multiply.",
        ),
    ],
)
def test_a_search_that_cannot_be_planned(changes, message):
    with pytest.raises(rf.InputError) as caught:
        DesignStudy(**SEARCHED | changes).plan()
    assert str(caught.value) == message


# The command line

FILE = """
study = "design"
models = ["2DOF-S"]
half_widths = [0.8, 1.6, 2.4]
scales = [0.7, 1.4, 2.8]
limits = [0.02, "overturning", "max_base_moment > 4e6"]
{question}
[records]
suites = ["fema-p695-far-field"]
include = ["FF-?-*"]
{hazard}
[[structures]]
tendons = [{{initial_force = 3e5, stiffness = 2e6}}]
frame = {{n_stories = 3, story_height = 3.0, story_mass = 40e3, base_mass = 50e3, stiffness_ratio = inf, period = 0.6, \
aspect_ratio = 8, damping_ratio = 0.02}}
[search]
tendon_factors = [0.0, 2.0]
refinements = 1
designs_per_refinement = 2
cost = {{half_width = 1.0, prestress = 1e-6}}
"""
HAZARD = "[hazard]\nim = [0.05, 0.2, 0.8]\nrate = [0.1, 1e-2, 2e-4]"


def invoke(*arguments):
    return CliRunner().invoke(app, [*map(str, arguments)], env={"COLUMNS": "300"})


@pytest.mark.parametrize(
    ("question", "hazard"), [("level = 0.4\ntarget = [0.3, 0.1, 0.9]", ""), ("target = [1e-2, 1e-3, 0.1]", HAZARD)]
)
def test_a_search_is_run_kept_told_and_drawn(tmp_path, question, hazard):
    file, kept = tmp_path / "search.toml", tmp_path / "kept"
    file.write_text(FILE.format(question=question, hazard=hazard), "utf-8")
    assert "at most 432 runs in 3 parts, 18 records" in invoke("design", file, "--dry-run").stdout
    done = invoke("design", file, "--out", kept)
    assert done.exit_code == 0, done.stderr
    document = json.loads(invoke("design", file, "--out", kept, "--json").stdout)
    study = rf.load_study(file)
    found = rf.best_design(rf.StudyFolder.load(kept).frame(), *search_of(study.document()))
    (designs,) = (rows for title, rows in document.items() if title.startswith("Designs of the search"))
    assert [row["cost"] for row in designs] == found.designs["cost"].tolist()
    (limits,) = (rows for title, rows in document.items() if title.startswith("Limits of the cheapest design"))
    assert [row["limit"] for row in limits if row["governs"] == "yes"] == [found.governs]
    assert [row["value"] for row in limits] == found.limits["value"].tolist()
    assert f"governed by {found.governs}" in done.stdout
    assert document["Cheapest designs"][0]["B [m]"] == found.designs.loc[found.best, "half_width"]
    figures = invoke("figures", kept)
    assert figures.exit_code == 0, figures.stderr
    names = sorted(path.name for path in (kept / "figures").iterdir())
    assert names == ["design_search.png", "design_search_dark.png", "summary.json"]


# The figure


def test_a_search_is_drawn(found):
    figure = drawn(rf.plot_design_search(found))
    costs, plane = figure.axes
    assert (costs.get_xlabel(), costs.get_ylabel()) == ("half width $B$ [m]", "cost")
    assert (plane.get_xlabel(), plane.get_ylabel()) == ("half width $B$ [m]", "prestress $ΣF_0$ [kN]")
    curve = rf.trade_off(found)
    drawn_costs = np.concatenate(
        [line.get_ydata() for line in costs.lines if line.get_label() in set(curve["governs"])]
    )
    np.testing.assert_allclose(np.sort(drawn_costs[np.isfinite(drawn_costs)]), np.sort(curve["cost"]))
    best = found.designs.loc[found.best]
    ((ring,), (other,)) = ([line for line in axes.lines if line.get_label() == "_best"] for axes in figure.axes)
    assert (ring.get_xdata()[0], ring.get_ydata()[0]) == (best["half_width"], best["cost"])
    assert other.get_ydata()[0] == pytest.approx(best["prestress"] / 1e3)
    shown = sum(len(line.get_xdata()) for line in costs.lines if line.get_label() == "_runs")
    assert shown == len(found.designs)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.texts][:2] == [each.label for each in found.requirements]
    assert f"{found.governs} governs" in legend.get_title().get_text()


def test_themes_differ(found, tmp_path):
    light, dark = (drawn(rf.plot_design_search(found, theme=theme)) for theme in ("light", "dark"))
    assert sum(light.get_facecolor()[:3]) == 3.0
    assert sum(dark.get_facecolor()[:3]) < 0.5
    for figure, bright in ((light, False), (dark, True)):
        for axes in figure.axes:
            for tick in axes.xaxis.get_ticklabels():
                from matplotlib.colors import to_rgb

                assert (sum(to_rgb(tick.get_color())) > 1.5) == bright
    with pytest.raises(rf.InputError) as caught:
        rf.plot_design_search(found, theme="night")
    assert str(caught.value) == 'theme must be "light" or "dark", but \'night\' was given.'


def test_a_search_that_found_nothing_is_drawn(folder):
    hard = [rf.Requirement(0.001, 1e-3, at=1.0)]
    nothing = rf.best_design(folder[1], hard, rf.DesignCost(1.0), n_resamples=20)
    figure = drawn(rf.plot_design_search(nothing))
    assert figure.legends[0].get_title().get_text() == "No design meets all targets"
    assert math.isnan(nothing.interval["best"].iloc[0])
