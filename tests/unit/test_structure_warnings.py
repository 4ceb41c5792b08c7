"""What looks like a wrong unit, and the acceleration that lifts a base."""

import math

import pytest

import rockflex as rf
from builders import make_frame
from rockflex import InputError

COLUMN = {
    "height": 10.0,
    "bending_stiffness": 2e9,
    "base_mass": 50e3,
    "half_width": 1.5,
    "damping_ratio": 0.02,
    "mass_per_length": 4e3,
}
TIP = (
    "The tip has a mass of 3999 kg, less than a tenth of the 40000 kg of its column. Masses are in kg: a tonne is "
    "1000 kg."
)


def column(**changes):
    return rf.CantileverWithTipMass(**(COLUMN | changes))


def test_a_light_tip_is_said():
    light = column(tip_mass=3999.0)
    assert rf.structure_warnings(light) == (TIP,)
    assert rf.structure_warnings(rf.Restrained(rf.Eccentric(light, 0.1), rf.Tendon(1e5, 1e6))) == (TIP,)
    assert rf.structure_warnings(column(tip_mass=4000.0)) == ()
    assert rf.structure_warnings(column(tip_mass=1.0, mass_per_length=0.0)) == ()
    assert rf.structure_warnings(light.rocking()) == ()  # the masses are not known there


def test_a_long_period_is_said():
    def oscillator(period):
        return make_frame(n_stories=1, period=period)

    assert rf.structure_warnings(oscillator(9.999)) == ()
    (text,) = rf.structure_warnings(oscillator(10.1))
    assert "10.1 s" in text
    assert "Check the units" in text
    assert rf.structure_warnings(oscillator(10.1).rocking()) == (text,)
    assert rf.structure_warnings(oscillator(10.1).rocking().truncated(0)) == ()
    assert rf.structure_warnings(rf.rigid_block(0.2, 3.0)) == ()


@pytest.mark.parametrize("given", [3.0, rf.Frame, None])
def test_only_structures_are_judged(given):
    with pytest.raises(InputError, match=r"structure must be a structure .*RockingProperties, but"):
        rf.structure_warnings(given)


def test_the_acceleration_that_lifts_a_base():
    tower = column(tip_mass=60e3)
    mass, first = 60e3 + 40e3 + 50e3, 60e3 * 10.0 + 4e3 * 10.0**2 / 2.0
    assert tower.rocking().uplift_acceleration == pytest.approx(mass * 9.81 * 1.5 / first, rel=1e-12)
    tied = rf.Restrained(tower, rf.Tendon(300e3, 1e7)).rocking()
    assert tied.uplift_acceleration == pytest.approx((mass * 9.81 + 300e3) * 1.5 / first, rel=1e-12)
    moved = rf.Eccentric(tower, 0.3).rocking()
    right, left = moved.pivot(1), moved.pivot(-1)
    assert right.uplift_acceleration == pytest.approx(mass * 9.81 * 1.2 / first, rel=1e-12)
    assert left.uplift_acceleration == pytest.approx(mass * 9.81 * 1.8 / first, rel=1e-12)
    assert moved.uplift_acceleration == right.uplift_acceleration
    # A block lifts at g tan α.
    block = rf.rigid_block(0.2, 3.0)
    assert block.uplift_acceleration == pytest.approx(9.81 * math.tan(0.2), rel=1e-12)


def test_it_is_the_acceleration_at_which_a_slow_push_lifts_it():
    block = rf.rigid_block(0.2, 3.0)
    for factor, rocks in ((0.999, False), (1.001, True)):
        push = rf.half_sine_pulse(factor * block.uplift_acceleration, 5.0)
        assert (rf.simulate(block, push, model="rigid").status != "no_uplift") is rocks
