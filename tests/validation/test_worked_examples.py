"""What the gallery says of its controlled-rocking structures, against their runs and closed forms."""

import math
import runpy
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rockflex as rf

EXAMPLES = Path(__file__).parents[2] / "examples"
GALLERY = EXAMPLES / "gallery"
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def hybrid() -> dict[str, Any]:
    """Names of the script of the hybrid wall."""
    return runpy.run_path(str(GALLERY / "hybrid_wall.py"))


@pytest.fixture(scope="module")
def frame() -> dict[str, Any]:
    """Names of the script of the nine-story frame."""
    return runpy.run_path(str(GALLERY / "nine_story_frame.py"))


def test_the_walls_are_as_strong_and_one_of_them_closes(hybrid):
    strengths = [curve.moment[curve.rotation == 0.01][0] for curve in hybrid["flags"].values()]
    assert strengths[1] == pytest.approx(strengths[0], rel=0.1)
    closing, other = (wall.rocking().recentring_ratio for wall in hybrid["walls"].values())
    assert closing > 1.15
    assert other < 1.0
    first, second = (curve.residual_rotations for curve in hybrid["flags"].values())
    assert not first.any()
    assert second[2] > 0.01


def test_an_earthquake_closes_the_wall_down_to_the_elastic_stretch_of_its_bars(hybrid):
    runs = hybrid["runs"]
    assert runs["error"].isna().all()
    assert runs["settled"].all()
    closing, other = (group for _, group in runs.groupby("structure", sort=False))
    assert closing.loc[closing["residual_rotation"] != 0.0, "tendon_yield"].all()
    rest = other["residual_rotation"].abs()
    assert rest.max() < 0.002  # FEMA P-58
    elastic = rest[(rest > 0.0) & ~other["tendon_yield"]]
    assert (elastic < hybrid["spring_back"] * (1.0 + 1e-9)).all()  # less where the bars were not driven down to yield
    assert elastic.median() == pytest.approx(hybrid["spring_back"], rel=1e-9)


def test_tendons_of_the_walls_yield_at_one_rotation(hybrid):
    runs = hybrid["runs"]
    np.testing.assert_array_equal(runs["tendon_yield"], runs["max_rotation"] >= hybrid["yields_at"])
    few, many = (group["tendon_yield"].mean() for _, group in runs.groupby("structure", sort=False))
    assert few > many > 0.0


def test_one_mode_finds_the_rotation_of_the_frame_but_not_its_shear(frame):
    one, every = (
        [
            {name: np.median(of, axis=0) for name, of in frame["peaks"][model, scale].items()}
            for scale in frame["SCALES"]
        ]
        for model in frame["MODELS"]
    )
    ratios = {
        name: [b[name] / a[name] for a, b in zip(one, every, strict=True)] for name in ("rotation", "shear", "moment")
    }
    assert ratios["rotation"] == pytest.approx([1.0] * 3, abs=0.1)
    assert [each[0] for each in ratios["moment"]] == pytest.approx([1.0] * 3, abs=0.1)
    shear, middle = ([each[place] for each in ratios[name]] for name, place in (("shear", 0), ("moment", 4)))
    assert sorted(shear) == shear
    assert sorted(middle) == middle
    assert shear[-1] > 2.0
    assert middle[-1] > 1.5


def test_moments_of_the_frame_sum_up_to_that_of_its_base(frame):
    record = frame["suite"][0].scaled(2.0)
    response = rf.simulate(frame["frame"], record, "MDOF-S")
    base = response.story_shear.sum(axis=1) * frame["STORY_HEIGHT"]
    np.testing.assert_allclose(base, response.base_moment, atol=1e-9 * response.max_base_moment)


def test_tendons_of_the_frame_yield_alike_with_one_mode_and_with_all(frame):
    runs = frame["runs"]
    counts = rf.stripe_counts(runs, "tendon_yield")
    one, every = (
        rf.fit_stripes(of["level"], of["n_exceeding"], of["n_total"]).median for _, of in counts.groupby("model")
    )
    assert math.isclose(one, every, rel_tol=0.1)
    assert runs.loc[runs["residual_rotation"] != 0.0, "tendon_yield"].all()
    assert runs["settled"].all()
    yields_at = 0.4 * 1580e6 / 195e9 * 36.0 / 6.0
    np.testing.assert_array_equal(runs["tendon_yield"], runs["max_rotation"] >= yields_at)


def test_random_walls_all_settle_and_open_for_a_reason():
    given = tomllib.loads((EXAMPLES / "controlled_rocking_walls.toml").read_text("utf-8"))
    del given["records_per_structure"]
    runs = rf.run_study(rf.MonteCarloStudy(**given | {"count": 6}))
    assert len(runs) == 6 * 72
    assert runs["error"].isna().all()
    assert runs["settled"].all()
    left_open = runs["residual_rotation"] != 0.0
    assert (runs.loc[left_open, "tendon_yield"] | (runs.loc[left_open, "recentring_ratio"] < 1.0)).all()
    assert left_open.any()
    assert (runs["tendon_yield"] == (runs["tendon_utilisation"] >= 1.0)).all()
