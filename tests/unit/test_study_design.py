"""Designs of a base: runs against structures built that way, and the study of them."""

import math
import pickle

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from design_case import CONTENT, FRAME, HEIGHT, LEVELS, PROPERTIES, STRUCTURE, SUITE, WIDTHS
from rockflex.studies.design import DesignStudy
from rockflex.studies.design._designs import checked_half_widths, designs_of_structure
from rockflex.studies.design._exceedance_fit import design_limit_state

CURVE = {"im": [0.5, 30.0], "rate": [0.1, 2e-5]}
SPECTRAL = {"level": None, "measure": "sa_t1", "hazard": CURVE}
TENDON = {"kind": "tendon", "initial_force": 1e5, "stiffness": 1e6}
SEARCHED = {"tendons": [], "target": 1e-3, "search": {"cost": {"half_width": 1.0}}}


@pytest.fixture
def runs(designed):
    return designed


def built(half_width, prestress=0.0, stiffness=0.0, base_mass=50e3):
    """The frame made with that base, and a tendon of that force and stiffness."""
    frame = rf.Frame(**FRAME | {"aspect_ratio": HEIGHT / half_width, "base_mass": base_mass})
    return rf.Restrained(frame, rf.Tendon(prestress, stiffness)) if prestress or stiffness else frame


def test_rows_are_those_of_structures_built_that_way():
    motions = [SUITE[name] for name in ("FF-1-a", "FF-3-b", "FF-5-a")]
    table = rf.run_design(STRUCTURE, motions, WIDTHS[::-1], LEVELS, ["MDOF-S", "2DOF-S"], [1.0, 2.5])
    weight, l0r = PROPERTIES.m_tot * 9.81, PROPERTIES.l0r
    structures = {f"B = {b:g} m, no tendon": built(b) for b in WIDTHS}
    structures |= {f"B = {b:g} m, held": built(b, 0.3 * weight, 0.6 * l0r * 9.81 / b**2) for b in WIDTHS}
    cloud = rf.run_cloud(structures, motions, ["MDOF-S", "2DOF-S"], [1.0, 2.5], free_vibration="settle")
    for name in ("structure", "motion", "model", "scale", "group", "status", "n_impacts", "error"):
        assert table[name].astype(str).tolist() == cloud[name].astype(str).tolist()
    for name in ("max_rotation", "max_top_displacement", "max_base_moment", "nominal_limit", "pgv", "max_tendon_force"):
        np.testing.assert_allclose(table[name], cloud[name], rtol=1e-8)
    assert {"rocking", "overturned"} <= set(table["status"])
    assert cloud["tendon_utilisation"].isna().any()  # no yield force was given there
    held = table[table["tendon"] == "held"]
    np.testing.assert_allclose(held["tendon_utilisation"], held["max_tendon_force"] / (0.9 * weight), rtol=1e-12)


def test_facts_of_a_design_are_closed_forms(runs):
    weight = PROPERTIES.m_tot * 9.81
    np.testing.assert_allclose(runs["resisting_moment"], (1.0 + runs["prestress_ratio"]) * weight * runs["half_width"])
    np.testing.assert_allclose(runs["aspect_ratio"] * runs["half_width"], HEIGHT, rtol=1e-12)
    np.testing.assert_allclose(runs["prestress_ratio"], np.where(runs["tendon"] == "held", 0.3, 0.0), rtol=1e-12)
    np.testing.assert_allclose(runs["stiffness_ratio"], np.where(runs["tendon"] == "held", 0.6, 0.0), rtol=1e-12)
    free, held = (runs[runs["tendon"] == name]["resisting_moment"].unique() for name in ("no tendon", "held"))
    assert (np.diff(free) > 0.0).all()
    assert (np.diff(held) > 0.0).all()
    assert (held > free).all()


@pytest.mark.parametrize("ratio", [0.0, 0.5, 1.0, 3.0])
def test_ratio_of_stiffness_is_that_of_the_slope(ratio):
    for design in designs_of_structure(PROPERTIES, WIDTHS, [rf.TendonLevel(0.1, ratio)], 0.0):
        expected = (ratio - 1.0) * PROPERTIES.l0r * 9.81
        assert design.properties.rocking_stiffness == pytest.approx(expected, rel=1e-12, abs=1e-6)


def test_a_base_whose_mass_grows():
    for design in designs_of_structure(PROPERTIES, WIDTHS, [], 6e3):
        b = design.properties.half_width
        made = built(b, base_mass=50e3 + 6e3 * 2.0 * (b - PROPERTIES.half_width)).rocking()
        for name in ("m_tot", "i_theta", "l0r", "translational_inertia", "resisting_moment"):
            assert getattr(design.properties, name) == pytest.approx(getattr(made, name), rel=1e-12)


def test_rotary_inertia_and_tendons_of_its_own_stay():
    tower = rf.TaperedTower(200.0, 8.0, 4.0, 1.0, 2400.0, 25e9, 0.02).rocking()
    (wide,) = designs_of_structure(tower, [10.0], [], 0.0)
    rotary = tower.i_theta - tower.translational_inertia - tower.m_tot * 64.0
    assert wide.properties.i_theta == pytest.approx(tower.translational_inertia + rotary + tower.m_tot * 100.0)
    pair = [rf.Tendon(1e5, 1e6, -0.5), rf.Tendon(1e5, 1e6, 0.5)]
    held = rf.Restrained(STRUCTURE, pair).rocking()
    (design,) = designs_of_structure(held, [2.0], [], 0.0)
    assert (design.tendon, design.properties.tendons) == ("its own tendons", tuple(pair))
    table = rf.run_design(held, SUITE[0], [1.0, 2.0])
    np.testing.assert_allclose(
        table["stiffness_ratio"], [1e6 * 2 * (b**2 + 0.25) / (held.l0r * 9.81) for b in (1.0, 2.0)], rtol=1e-12
    )


def test_a_rigid_block():
    block = rf.rigid_block(0.2, 1.5)
    table = rf.run_design(block, SUITE[0], [0.3, 0.6], models="rigid")
    np.testing.assert_allclose(table["aspect_ratio"], block.l0r / block.m_tot / np.array([0.3, 0.6]))


# The study


def test_a_study_is_the_call_in_python(tmp_path):
    study = DesignStudy(**CONTENT)
    table = rf.run_study(study)
    motions = [motion for motion in SUITE if motion.name.startswith(("FF-1-", "FF-2-"))]
    levels = [rf.TendonLevel(name="none"), rf.TendonLevel(0.3, 0.6)]
    pd.testing.assert_frame_equal(table, rf.run_design(STRUCTURE, motions, WIDTHS, levels, scales=[1.0, 2.0]))
    assert study.document()["half_widths"] == pytest.approx(WIDTHS)
    assert list(table["tendon"].cat.categories) == ["none", "F₀ = 0.3 W, k = 0.6 L₀ʳg/B²"]
    plan = study.plan()
    assert (plan.n_runs, plan.n_chunks) == (48, 7)
    assert pickle.loads(pickle.dumps(plan)).chunk(3).equals(plan.chunk(3))
    assert DesignStudy(**study.document() | {"structures": CONTENT["structures"]}).document() == study.document()


def test_the_example_is_a_study():
    from pathlib import Path

    plan = rf.load_study(Path(__file__).parents[2] / "examples" / "design.toml").plan()
    assert plan.n_runs == 33 * 72 * 2


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"half_widths": {"smallest": 2.0, "largest": 1.0, "count": 3}}, "half_widths must be a list in"),
        ({"half_widths": {"smallest": 1.0, "largest": 2.0}}, "half_widths must be a list in m, or a"),
        ({"half_widths": [1.0, 1.0]}, "half_widths: '1' occurs more than once. Give each once."),
        ({"half_widths": [1.0, -1.0]}, "half_widths must be one or more positive numbers in m, but"),
        ({"half_widths": 3.0}, "half_widths must be a list of half widths B in m, or a range {smallest = 1.0,"),
        ({"limits": ["half"]}, "limits: limit must be a rotation from 0.0001 rad to below π/2, a multiple of 0.7"),
        ({"measure": "relative_pgv"}, "measure must not depend on the base, as a level of relative_pgv does."),
        ({"measure": "pgw"}, "measure must be one of pga, pgv,"),
        ({"level": None}, "level and hazard: give one of them, not both, for the strength of the shaking."),
        ({"hazard": {"im": [0.1, 1.0], "rate": [1e-2, 1e-4]}}, "level and hazard: give one of them, not both,"),
        ({"level": None, "hazard": {"im": [0.1, 1.0], "rate": [1e-2, 1e-1]}}, "rate must be positive and fall from"),
        ({"target": 1.5}, "target must lie in [0, 1), but 1.5 was given. With a level it is a probability."),
        ({"target": 0.0}, "target must be a positive, finite number in probability or 1/year, but 0.0 was given."),
        ({"level": -1.0}, "level must be a positive, finite number in the unit of the measure, but -1.0 was given."),
        ({"structures": CONTENT["structures"] * 2}, "structures must be one table [[structures]], but"),
        ({"scales": [math.inf]}, "scales must be one or more finite factors, but [inf] was given."),
        ({"tendons": [{"prestress": 0.2}]}, "prestress is not known; there are prestress_ratio, stiffness_ratio,"),
    ],
)
def test_a_specification_that_is_wrong(changes, message):
    with pytest.raises(rf.InputError) as caught:
        DesignStudy(**CONTENT | changes)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"models": ["3DOF-fixed"]}, "models: 3DOF-fixed has a fixed base, so the base width has no effect."),
        ({"tendons": [{}, {}]}, "tendons: 'no tendon' occurs more than once. Give each once."),
        (
            {
                "structures": [
                    {"frame": FRAME, "elements": [{"kind": "tendon", "initial_force": 1e5, "stiffness": 1e6}]}
                ]
            },
            "The structure has its own tendons, and levels of tendons are given too. Leave out one or the other",
        ),
        ({"limits": ["2.5 nominal"], "half_widths": [9.0]}, "B = 9 m, none: limit must be a rotation from 0.0001 rad"),
        ({"limits": ["2.5 nominal"], "half_widths": [9.0]}, "but '2.5 nominal' (1.62 rad) was given."),
        ({"base_mass_per_width": 1e6}, "B = 0.8 m, none: base_mass must be a zero or positive, finite number in kg"),
        (SPECTRAL, "The fragility is in a spectral measure at a damping ratio of 0.02, but the hazard curve is at a"),
        (SPECTRAL | SEARCHED, "The fragility is in a spectral measure at a damping ratio of 0.02,"),
    ],
)
def test_a_design_that_cannot_be_built(changes, message):
    with pytest.raises(rf.InputError) as caught:
        DesignStudy(**CONTENT | changes).plan()
    assert message in str(caught.value)


def test_a_hazard_curve_in_a_file_states_its_damping():
    for changes in ({"measure": "sa_t1_5"}, {"hazard": CURVE | {"damping": FRAME["damping_ratio"]}}):
        study = DesignStudy(**CONTENT | SPECTRAL | changes)
        assert study.plan().n_runs == len(study.plan().motions) * 12
    with pytest.raises(rf.InputError, match="damping must lie"):
        DesignStudy(**CONTENT | SPECTRAL | {"hazard": CURVE | {"damping": 2.0}})


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rf.TendonLevel(-0.1), "prestress_ratio must be a zero or positive, finite number in W, but -0.1"),
        (lambda: rf.TendonLevel(0.1, math.inf), "stiffness_ratio must be a zero or positive, finite number in L_0^r"),
        (lambda: rf.TendonLevel(0.1, 0.0, 0.0), "yield_ratio must be a positive, finite number in W, but 0.0 was"),
        (lambda: rf.TendonLevel(0.5, 0.0, 0.4), "prestress_ratio must not exceed yield_ratio, 0.4, but 0.5 was given."),
        (lambda: rf.run_design(STRUCTURE, SUITE[0], []), "half_widths must be one or more positive numbers in m, but"),
        (
            lambda: rf.run_design(STRUCTURE, SUITE[0], [1.0], [0.2]),
            "tendons must hold TendonLevel objects, but float was given.",
        ),
        (
            lambda: rf.run_design(
                rf.Restrained(STRUCTURE, [rf.Tendon(1.0, 1.0, -0.5), rf.Tendon(1.0, 1.0, 0.5)]), SUITE[0], [0.4]
            ),
            "B = 0.4 m: Elements must act within half_width = 0.4 m to each side of the axis of the masses, but",
        ),
    ],
)
def test_damaged_arguments_of_a_design(call, message):
    with pytest.raises(rf.InputError) as caught:
        call()
    assert str(caught.value).startswith(message)


def test_half_widths_rise():
    assert checked_half_widths([2.0, 1.0]) == [1.0, 2.0]
    assert checked_half_widths({"smallest": 1, "largest": 2, "count": 5}) == [1.0, 1.25, 1.5, 1.75, 2.0]


def test_limits():
    assert design_limit_state(0.02, 0.1).threshold == 0.02
    assert design_limit_state("nominal", 0.1).threshold == 0.1
    assert design_limit_state("0.5 nominal", 0.1).threshold == 0.05
    assert design_limit_state("overturning", 0.1).threshold == math.pi / 2
    for limit in (0.0, 1e-5, 1.6, math.nan, True, "x nominal", "0.5 0.5 nominal", "", "0.0005 nominal", None):
        with pytest.raises(rf.InputError, match=r"limit must be a rotation from 0\.0001 rad"):
            design_limit_state(limit, 0.1)
