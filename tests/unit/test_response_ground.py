"""Where the masses are and what the ground gives, against Newton's laws in coordinates of the ground."""

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from twins.newton import Complete, Simplified, integrate, masses_of

FRAME = frame_values(
    n_stories=3, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=6.0, damping_ratio=0.03
)
RECORDS = {"el-centro-1940": (0, slice(60, 210), 2.0), "fema-p695-far-field": (1, slice(500, 1000), 2.0)}


def motion(suite):
    place, cut, factor = RECORDS[suite]
    record = rf.load_suite(suite)[place]
    return rf.GroundMotion(factor * record.acceleration[cut], record.dt)


@pytest.mark.slow
@pytest.mark.parametrize("suite", RECORDS)
@pytest.mark.parametrize(("label", "kind", "bound"), [("MDOF-S", Simplified, 1e-9), ("MDOF-C", Complete, 1e-9)])
def test_against_the_masses_in_coordinates_of_the_ground(label, kind, bound, suite):
    record = motion(suite)
    twin = integrate(kind(masses_of(**FRAME)), record.acceleration, record.dt)
    frame = rf.Frame(**FRAME)
    run = rf.simulate(frame, record, label)
    peaks = rf.simulate(frame, record, label, "peaks")
    assert (run.n_uplifts, run.n_impacts) == (twin.n_uplifts, twin.n_impacts)
    assert twin.n_impacts >= 2
    np.testing.assert_allclose(run.floors.total_floor_displacement, twin.places, rtol=bound)
    for response in (run, peaks):
        assert response.max_rotation == pytest.approx(twin.rotation, rel=bound)
        assert response.max_total_top_displacement == pytest.approx(twin.places[-1], rel=bound)
        # Accelerations carry the error of the motion times the square of the fastest frequency.
        assert response.max_horizontal_reaction == pytest.approx(twin.horizontal, rel=1e2 * bound)
        assert response.min_vertical_reaction == pytest.approx(twin.vertical, rel=1e2 * bound)


WALL = rf.WallFrame(
    height=15.0, mass=250e3, stiffness_parameter=0.0, base_mass=60e3, period=0.5, aspect_ratio=5.0,
    damping_ratio=0.05, n_modes=1,
)  # fmt: skip
OFF = 0.2  # m
P = WALL.rocking()


def under(bed):
    return rf.Ground(springs=bed.damped(0.3, P.m_tot), base_inertia=60e3 * (2.0 * P.half_width) ** 2 / 12.0)


ON_BED = under(rf.winkler_bed(P.half_width, 4.0, 40e6, n=10, eccentricity=OFF))
CENTRED = under(rf.winkler_bed(P.half_width, 4.0, 40e6, n=10))
LEANING = rf.Eccentric(WALL, OFF)
SHAKEN = motion("el-centro-1940").scaled(0.4)


def test_the_residual_rotation_is_measured_from_that_at_rest():
    resting = rf.simulate(LEANING, rf.quiet_motion(1.0), "2DOF-S", ground=ON_BED)
    assert resting.rotation[0] > 1e-4
    assert resting.residual_rotation == pytest.approx(0.0, abs=1e-12)
    assert resting.status == "no_uplift"
    run = rf.simulate(LEANING, SHAKEN, "2DOF-S", ground=ON_BED)
    assert run.residual_rotation == pytest.approx(run.rotation[-1] - run.rotation[0], rel=1e-9)
    assert run.settled_rotation() == pytest.approx(0.0, abs=1e-9 * run.max_rotation)


def test_limits_of_an_eccentric_base_on_springs_are_those_of_the_side_to_which_it_turns():
    p = LEANING.rocking()
    for side in (1, -1):
        start = rf.InitialState(rotation=1.02 * side * p.pivot(side).nominal_overturning_rotation)
        run = rf.simulate(LEANING, rf.quiet_motion(0.02), "2DOF-S", "peaks", initial=start, ground=ON_BED)
        assert run.balance_ratio == pytest.approx(run.max_rotation / p.pivot(side).balance_rotation, rel=1e-12)
        assert run.nominal_overturning == (run.max_rotation > p.pivot(side).nominal_overturning_rotation)
        assert run.nominal_overturning
    other = rf.InitialState(rotation=-1.02 * p.pivot(1).nominal_overturning_rotation)
    run = rf.simulate(LEANING, rf.quiet_motion(0.02), "2DOF-S", "peaks", initial=other, ground=ON_BED)
    assert not run.nominal_overturning


def test_a_base_that_starts_off_its_edge_rocks_on_springs_too():
    ground = under(rf.Springs([-P.half_width, P.half_width], stiffness=300e6))
    start = rf.InitialState(rotation=0.03)
    run = rf.simulate(WALL, rf.quiet_motion(0.02), "2DOF-S", initial=start, ground=ground)
    assert (run.n_uplifts, run.n_impacts) == (0, 0)
    assert run.uplifted.all()
    assert run.status == "rocking"
    still = rf.simulate(WALL, rf.quiet_motion(0.02), "2DOF-S", initial=rf.InitialState(rotation=1e-3), ground=ground)
    assert not still.uplifted.any()
    assert still.status == "no_uplift"


@pytest.mark.parametrize("label", ["2DOF-S", "2DOF-C"])
@pytest.mark.parametrize(
    "element", [rf.YieldingDissipator(2e8, 4e6), rf.YieldingDissipator(2e7, 2e6), rf.FrictionDamper(4e6)], ids=str
)
def test_the_settled_rotation_is_that_of_a_run_until_it_settles(label, element):
    if label == "2DOF-C" and isinstance(element, rf.FrictionDamper):
        return  # refused by the complete models
    held = rf.Restrained(WALL, element)
    record = motion("el-centro-1940").scaled(3.0)
    run = rf.simulate(held, record, label)
    settled = rf.simulate(held, record, label, free_vibration="settle")
    assert settled.settled
    assert run.settled_rotation() == pytest.approx(settled.residual_rotation, rel=1e-6, abs=1e-9)


def test_the_settled_rotation_with_fuses_on_springs():
    held = rf.Restrained(WALL, rf.YieldingDissipator(2e8, 1e6))
    record = motion("el-centro-1940").scaled(2.0)
    run = rf.simulate(held, record, "2DOF-S", ground=CENTRED)
    settled = rf.simulate(held, record, "2DOF-S", ground=CENTRED, free_vibration="settle")
    assert run.settled_rotation() == pytest.approx(settled.residual_rotation, rel=1e-6, abs=1e-9)
    assert abs(run.residual_rotation) > 2.0 * abs(settled.residual_rotation)


def test_what_overturned_or_yields_above_has_no_settled_rotation():
    fell = rf.simulate(WALL, rf.one_sine_pulse(20.0, 2.0), "2DOF-S", free_vibration="settle")
    assert fell.status == "overturned"
    assert np.isnan(fell.settled_rotation())
    yields = rf.simulate(WALL, SHAKEN, "2DOF-S", bouc_wen=rf.BoucWen(0.05))
    with pytest.raises(rf.InputError, match="hysteretic spring"):
        yields.settled_rotation()


def test_the_bearing_pressure_is_the_resultant_over_its_effective_area():
    weight, area = P.m_tot * 9.81, 2.0 * P.half_width * 4.0
    run = rf.simulate(LEANING, SHAKEN.scaled(3.0), "2DOF-S", ground=ON_BED)
    off = OFF + P.l0r * run.rotation[0] / P.m_tot  # of the weight from the middle of the base
    assert run.bearing_pressure[0] == pytest.approx(weight / (area * (1.0 - off / P.half_width)), rel=1e-9)
    # Zones at the ends that are stiffer bear more, with the same resultant; so does a spring with its dashpot.
    stiffer = under(rf.asce41_bed(P.half_width, 4.0, 20e6, 0.35, n=10))
    run = rf.simulate(WALL, SHAKEN.scaled(3.0), "2DOF-S", ground=stiffer)
    assert run.bearing_pressure[0] == pytest.approx(weight / area, rel=1e-9)
    assert run.soil_pressure[0].max() > 1.5 * run.bearing_pressure[0]
    assert run.bearing_pressure.max() < run.soil_pressure.max()
    bed = stiffer.springs
    depth = np.maximum(bed.positions * run.rotation[:, None] - run.heave[:, None], 0.0)
    force, moment = depth @ bed.stiffness, depth @ (bed.stiffness * bed.positions)
    width = 2.0 * (P.half_width - np.abs(moment / force))
    np.testing.assert_allclose(run.bearing_pressure, force / (4.0 * width), rtol=1e-9)
    rigid = rf.simulate(WALL, SHAKEN, "2DOF-S")
    with pytest.raises(rf.InputError, match="have no area"):
        _ = rigid.bearing_pressure
