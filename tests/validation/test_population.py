"""Section 3.3 and 3.4 of Silva & Stojadinović (2024) on the 72 records of FEMA P-695 without pulses.

The paper's 105 recordings cannot be redistributed; with others, 0.98 stands for its R² of 0.99 in the top displacement,
and slopes of about 0.96 (shear) and 1.04 (flexure) for 0.97 and 1.03. The R² of the rotation, 0.90 in the paper, hangs
on a handful of outliers: over draws of 400 pairs it ranges from about 0.7 to 0.95.
"""

import pytest

from rockflex.papers.silva_stojadinovic_2024.population import PopulationStudy, population_statistics
from rockflex.studies._run_plan import run_plan


@pytest.fixture(scope="module")
def found():
    suites = ["fema-p695-far-field", "fema-p695-near-field-no-pulse"]
    pairs = run_plan(PopulationStudy(records={"suites": suites}, pairs=600, seed=0).plan())
    assert pairs["error"].isna().all()
    return population_statistics(pairs)


@pytest.fixture(scope="module")
def agreement(found):
    return found.agreement.set_index(["group", "quantity", "behaviour"])


@pytest.fixture(scope="module")
def combination(found):
    return found.combination.set_index(["quantity", "estimate"])


@pytest.mark.slow
def test_top_displacement_agrees_while_rocking(agreement):
    row = agreement.loc[("rocking", "top_displacement", "all")]
    assert row["r2"] == pytest.approx(0.983, abs=0.01)
    assert row["r2_high"] - row["r2_low"] < 0.02


@pytest.mark.slow
def test_rotation_agrees_less(agreement):
    row = agreement.loc[("rocking", "rotation", "all")]
    assert row["r2_low"] < 0.90 < row["r2_high"]
    assert row["r2_high"] - row["r2_low"] > 0.05
    assert row["r2"] < agreement.loc[("rocking", "top_displacement", "all"), "r2"]


@pytest.mark.parametrize(("behaviour", "slope"), [("shear", 0.960), ("flexure", 1.045)])
def test_one_mode_errs_to_one_side(agreement, behaviour, slope):
    """One mode overestimates the top displacement of shear buildings, and underestimates it of those that bend."""
    row = agreement.loc[("rocking", "top_displacement", behaviour)]
    assert row["slope"] == pytest.approx(slope, abs=0.02)
    assert (row["slope_high"] < 1.0) if behaviour == "shear" else (row["slope_low"] > 1.0)


def test_models_agree_on_the_start_of_rocking(found):
    off = found.outcomes.loc["no_uplift"].sum() - found.outcomes.loc["no_uplift", "no_uplift"]
    assert off <= 3
    assert found.outcomes.loc["rocking", "rocking"] > 0.95 * found.outcomes.loc["rocking"].sum()


def test_outliers_are_short_stiff_and_slender(found):
    """Section 3.3: the outliers have high aspect ratios, few stories and short periods."""
    worst = found.outliers[found.outliers["share"].notna()].head(5)
    assert worst["n_stories"].median() <= 6
    assert worst["period"].median() < 0.6
    assert worst["aspect_ratio"].median() >= 7


def test_second_mode_moves_more_than_on_a_fixed_base(combination):
    assert combination.loc[("second_displacement", "S_d(ω_2)"), "slope_low"] > 1.0


def test_combination_helps_the_base_shear_alone(combination):
    """Fig. 13: R² of 0.41 to 0.55 for the base shear, of the line y = x; 0.93 and 0.99 either way for the others.

    The line y = c1 x would give some 0.8 for the base shear, with and without the second mode: it is not what is meant.
    """
    r2 = combination["r2"]
    assert r2["base_shear", "2DOF-S"] == pytest.approx(0.41, abs=0.12)
    assert r2["base_shear", "SRSS"] == pytest.approx(0.55, abs=0.12)
    assert r2["base_shear", "SRSS"] > r2["base_shear", "2DOF-S"] + 0.05
    assert combination.loc[("base_shear", "2DOF-S"), "r2_line"] > 0.7
    for quantity, value in (("base_moment", 0.93), ("top_displacement", 0.99)):
        for estimate in ("2DOF-S", "SRSS"):
            assert r2[quantity, estimate] == pytest.approx(value, abs=0.03)
    assert combination.loc[("base_shear", "SRSS"), "slope_low"] > 1.0
