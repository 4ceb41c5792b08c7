"""Checks against limits: by hand where there is a closed form, and what each lacks."""

import math
from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from report_page import read

G = 9.81
FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=8.0)
PULSE = rf.one_sine_pulse(3.0, 0.8)
BLOCK = rf.rigid_block(slenderness=0.25, half_diagonal=3.0, mass=50e3)
EVERYTHING = rf.CheckLimits(
    moment_ratio=2.0, rotation_ratio=0.5, drift_ratio=0.005, fuse_length=0.5, fuse_strain=0.03, bearing_pressure=3e5,
    breadth=2.0, contact_ratio=0.4, friction=0.5, slip=0.05, seat_width=0.3, toe_length=0.2, toe_stress=20e6,
)  # fmt: skip


def rows(result, **limits):
    return {each.name: each for each in rf.check(result, rf.CheckLimits(**limits)).rows}


def missing(result, limits=EVERYTHING):
    return dict(rf.check(result, limits).missing)


def held(**tendon):
    fuse = rf.YieldingDissipator(60e6, 60e3, 0.02, 0.4, rupture_elongation=0.02)
    return rf.Restrained(FRAME, [rf.Tendon(100e3, 5e6, **tendon), fuse])


def test_contact_of_a_rigid_block_that_stays_closed():
    """e = h a/g: Navier without tension is in contact over 3 (B - e), Meyerhof's area is 2 (B - e)."""
    run = rf.simulate(BLOCK, rf.one_sine_pulse(2.0, 1.0), "rigid")
    half, height = BLOCK.half_width, BLOCK.l0r / BLOCK.m_tot
    a = float(np.abs(run.ground_acceleration).max())
    edge = half - height * a / G
    found = rows(run, bearing_pressure=1e5, contact_ratio=0.5, breadth=2.0)
    assert found["contact length"].demand == pytest.approx(3.0 * edge / (2.0 * half), rel=1e-12)
    assert found["contact length"].ratio == pytest.approx(0.5 / found["contact length"].demand)
    pressure = BLOCK.m_tot * G / (2.0 * 2.0 * edge)
    assert found["bearing pressure"].demand == pytest.approx(pressure, rel=1e-12)
    assert found["bearing pressure"].ratio == pytest.approx(pressure / 1e5)


def test_a_closed_block_under_no_motion_stands_on_its_whole_base():
    found = rows(
        rf.simulate(BLOCK, rf.quiet_motion(1.0), "rigid"), bearing_pressure=1e5, contact_ratio=1.0, breadth=2.0
    )
    assert found["contact length"].demand == 1.0
    assert found["bearing pressure"].demand == pytest.approx(BLOCK.m_tot * G / (4.0 * BLOCK.half_width), rel=1e-12)


def test_elements_pull_on_the_ground_where_they_stand():
    """x = (F x_k + L_0 |a|)/N as the ground moves to the left."""
    held_block = replace(BLOCK, elements=(rf.Tendon(2000e3, 1e6, 0.3),))
    run = rf.simulate(held_block, rf.rectangular_pulse(0.5, 1.0).scaled(-1.0), "rigid")
    assert run.status == "no_uplift"
    place = (2000e3 * 0.3 + BLOCK.l0r * 0.5) / (BLOCK.m_tot * G + 2000e3)
    found = rows(run, contact_ratio=0.5)["contact length"]
    assert found.demand == pytest.approx(3.0 * (BLOCK.half_width - place) / (2.0 * BLOCK.half_width), rel=1e-12)


def test_the_resultant_reaches_the_edge_as_the_base_lifts():
    """On the border of uplift, M = M_r about the pivot of an eccentric base, nothing is left of the contact."""
    p = replace(rf.Eccentric(FRAME, 0.1).rocking(), elements=(rf.Tendon(100e3, 5e6, 0.2),))
    motions = [PULSE.scaled(sign * scale) for sign in (1.0, -1.0) for scale in np.linspace(0.05, 0.5, 46)]
    closed = [run for run in (rf.simulate(p, each, "MDOF-S") for each in motions) if run.status == "no_uplift"]
    lengths = [rows(run, contact_ratio=0.5)["contact length"].demand for run in closed]
    assert len(lengths) < len(motions)  # the others lift
    assert 0.0 <= min(lengths) < 0.1


def test_friction_limits_the_moment_of_a_block_that_slides():
    """The resultant leans by μ, however strong the ground shakes: c = B - μ h."""
    run = rf.simulate(BLOCK, rf.one_sine_pulse(2.0, 1.0), "rigid", ground=rf.Ground(friction=0.1))
    assert (run.status, run.max_slip > 0.0) == ("no_uplift", True)
    edge = BLOCK.half_width - 0.1 * BLOCK.l0r / BLOCK.m_tot
    found = rows(run, bearing_pressure=1e5, contact_ratio=0.5, breadth=2.0)
    assert found["contact length"].demand == pytest.approx(3.0 * edge / (2.0 * BLOCK.half_width), rel=1e-12)
    assert found["bearing pressure"].demand == pytest.approx(BLOCK.m_tot * G / (2.0 * 2.0 * edge), rel=1e-12)


def test_contact_on_springs_is_that_of_its_edges():
    bed = rf.winkler_bed(FRAME.half_width, 3.0, 4e7)
    run = rf.simulate(FRAME, PULSE, "2DOF-S", ground=rf.Ground(springs=bed, base_inertia=1e5))
    found = rows(run, bearing_pressure=1e6, contact_ratio=0.5)
    up = run.edge_uplift
    apart = np.maximum(np.abs(up[:, 1] - up[:, 0]), 1e-30)  # 0 at rest
    down = np.where(up.max(axis=1) > 0.0, np.minimum(-up.min(axis=1) / apart, 1.0), 1.0)
    assert found["contact length"].demand == pytest.approx(down.min(), rel=1e-9)
    assert found["bearing pressure"].demand == run.bearing_pressure.max()
    ends = rf.Springs([-0.5, 0.5], 4e8)
    bare = rf.simulate(FRAME, PULSE, "2DOF-S", ground=rf.Ground(springs=ends, base_inertia=1e5))
    assert "area" in missing(bare)["bearing pressure"]


def test_checks_of_a_rocking_frame_by_hand():
    run, p = rf.simulate(FRAME, PULSE, "MDOF-S"), FRAME.rocking()
    toe = {"toe_length": 0.2, "toe_stress": 20e6, "breadth": 2.0}
    found = rows(run, rotation_ratio=0.5, drift_ratio=0.005, friction=0.4, seat_width=0.2, **toe)
    assert found["uplift"].demand == run.max_base_moment / (p.m_tot * G * p.half_width)
    assert found["uplift"].ok is None
    assert "lifts" in found["uplift"].note
    assert found["rotation"].limit == 0.7 * math.atan(p.half_width / p.effective_height[0])
    assert "Section 3.3" in found["rotation"].source
    assert found["rotation over α"].demand == pytest.approx(
        run.max_rotation * p.l0r / (p.m_tot * p.half_width), rel=1e-12
    )
    assert found["story drift"].demand == pytest.approx(run.floors.story_drift.max() / FRAME.story_height, rel=1e-14)
    assert found["sliding"].ratio == run.required_friction_excluding_impacts() / 0.4
    assert found["unseating"].ratio == run.max_total_top_displacement / 0.2
    assert found["toe stress"].demand == run.vertical_reaction.max() / (0.2 * 2.0)
    assert {each.source for each in found.values()} == {"user", "", found["rotation"].source}


def test_checks_of_elements_by_hand():
    run = rf.simulate(held(yield_force=130e3, post_yield_ratio=0.02), PULSE, "2DOF-S")
    found = rows(run, fuse_length=0.5, fuse_strain=0.03)
    tendon, fuse = run.max_element_force, run.max_element_elongation
    assert found["tendon stress"].demand == pytest.approx(tendon[0] / 130e3, rel=1e-14)
    assert found["tendon stress"].limit == 1.0
    assert found["tendon stress"].ok == (tendon[0] <= 130e3)
    assert found["fuse strain"].ratio == pytest.approx(fuse[1] / 0.5 / 0.03, rel=1e-14)
    assert found["rupture"].ratio == pytest.approx(fuse[1] / 0.02, rel=1e-14)


def test_the_drift_of_a_light_column_is_the_slope_below_its_tip():
    """A cantilever under a force at its tip: u = u_top (3 s² - s³)/2 at s = z/h, here between s = 0.95 and 1."""
    column = rf.CantileverWithTipMass(
        height=10.0, tip_mass=50e3, mass_per_length=1e-3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0,
        damping_ratio=0.02, n_modes=1,
    )  # fmt: skip
    run = rf.simulate(column, PULSE, "2DOF-S")
    share = 1.0 - (3.0 * 0.95**2 - 0.95**3) / 2.0
    found = rows(run, drift_ratio=0.005)["story drift"]
    assert found.demand == pytest.approx(share * run.max_top_displacement / 0.5, rel=1e-6)  # of the column's mass, 2e-7


def test_a_base_that_slides_is_checked_for_its_slip():
    run = rf.simulate(FRAME, PULSE, "2DOF-S", ground=rf.Ground(friction=0.15))
    found = rows(run, slip=0.01, friction=0.3)
    assert found["slip"].ratio == run.max_slip / 0.01 > 0.0
    assert "sliding" not in found


@pytest.mark.parametrize("factor", [0.5, 3.0])
def test_the_ratio_scales_with_the_limit(factor):
    run = rf.simulate(FRAME, PULSE, "2DOF-S")
    given = {"rotation_ratio": 0.5, "drift_ratio": 0.005, "friction": 0.4, "seat_width": 0.2, "moment_ratio": 1.0}
    one = rows(run, **given)
    other = rows(run, **{name: factor * value for name, value in given.items()})
    for name in ("uplift", "rotation over α", "story drift", "sliding", "unseating"):
        assert other[name].ratio == pytest.approx(one[name].ratio / factor, rel=1e-14)
        assert one[name].ok == (one[name].ratio <= 1.0)


@pytest.mark.parametrize(
    ("result", "name", "word"),
    [
        (lambda: rf.simulate(BLOCK, PULSE, "rigid"), "uplift", "rigid block"),
        (lambda: rf.simulate(BLOCK, PULSE, "rigid"), "story drift", "floors"),
        (lambda: rf.simulate(FRAME, PULSE, "fixed"), "rotation", "fixed"),
        (lambda: rf.simulate(FRAME, PULSE, "2DOF-S"), "bearing pressure", "springs"),
        (lambda: rf.simulate(FRAME, PULSE, "2DOF-S"), "contact length", "edge"),
        (lambda: rf.simulate(FRAME, PULSE, "2DOF-S"), "tendon stress", "no tendons"),
        (lambda: rf.simulate(FRAME, PULSE, "2DOF-S"), "fuse strain", "no fuses"),
        (lambda: rf.simulate(FRAME, PULSE, "2DOF-S"), "slip", "cannot slide"),
        (lambda: rf.simulate(held(), PULSE, "2DOF-S"), "tendon stress", "yield_force"),
    ],
)
def test_what_a_check_lacks_is_said(result, name, word):
    assert word in missing(result())[name]


def test_limits_that_are_not_given_are_said():
    lacks = missing(rf.simulate(FRAME, PULSE, "2DOF-S"), rf.CheckLimits(toe_stress=1e6))
    assert "drift_ratio" in lacks["story drift"]
    assert "toe_length" in lacks["toe stress"]


def test_the_demand_of_a_set_is_that_of_its_rule():
    motions = [replace(rf.one_sine_pulse(3.0, 0.5 + 0.05 * k), name=f"{k}") for k in range(7)]
    limits = {"drift_ratio": 0.005, "friction": 0.4}
    single = [rows(rf.simulate(FRAME, motion, "2DOF-S"), **limits) for motion in motions]
    for n, of in ((7, np.mean), (6, np.max)):
        found = rows(rf.simulate_set(FRAME, motions[:n], "2DOF-S", rule="ec8"), **limits)
        for name in ("uplift", "rotation", "story drift", "sliding"):
            demands = [each[name].demand for each in single[:n]]
            assert found[name].demand == pytest.approx(of(demands), rel=1e-14)
    assert "6 records" in found["story drift"].note
    bed = rf.Ground(springs=rf.winkler_bed(FRAME.half_width, 3.0, 4e7), base_inertia=1e5)
    shares = [
        rows(rf.simulate(FRAME, each, "2DOF-S", ground=bed), contact_ratio=0.5)["contact length"].demand
        for each in motions[:6]
    ]
    found = rows(rf.simulate_set(FRAME, motions[:6], "2DOF-S", rule="ec8", ground=bed), contact_ratio=0.5)
    assert found["contact length"].demand == min(shares) < max(shares)


def test_a_record_that_overturns_keeps_no_limit():
    motions = [replace(rf.one_sine_pulse(12.0, 3.0), name="a"), replace(PULSE, name="b")]
    table = rf.check(rf.simulate_set(BLOCK, motions, "rigid-C"))
    (row,) = table.rows
    assert math.isnan(row.demand)
    assert row.ok is False
    assert not table.ok
    assert "overturns" in row.note


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("drift_ratio", 0.0, "positive"),
        ("friction", -1.0, "positive"),
        ("contact_ratio", 1.01, "[0, 1], but 1.01"),
        ("tendon_ratio", None, "number"),
        ("breadth", "wide", "number in m"),
        ("seat_width", math.nan, "finite"),
    ],
)
def test_wrong_limits_are_refused(field, value, said):
    with pytest.raises(rf.InputError) as caught:
        rf.CheckLimits(**{field: value})
    assert caught.value.field == field
    assert said in str(caught.value)


@pytest.mark.parametrize("result", [None, 3.0, "run", lambda: rf.simulate(FRAME, PULSE, output="peaks")])
def test_what_cannot_be_checked_is_refused(result):
    with pytest.raises(rf.InputError) as caught:
        rf.check(result() if callable(result) else result)
    assert caught.value.field == "result"
    with pytest.raises(rf.InputError):
        rf.check(rf.simulate(FRAME, PULSE), {"friction": 0.5})


@pytest.mark.slow
def test_the_report_of_a_run_has_its_checks(tmp_path):
    found = [rf.simulate(FRAME, PULSE, model) for model in ("2DOF-S", "fixed")]
    table = read(rf.write_report(found, tmp_path / "r.html", limits=rf.CheckLimits(drift_ratio=1e-3))).tables["limits"]
    by_name = {row[0][0]: row for row in table[1:]}
    assert by_name["rotation"][2][0] == "–"
    assert "user" in by_name["story drift"][-1][0]
    assert "limits" not in read(rf.write_report(found, tmp_path / "s.html")).tables
