"""Eccentric bases against runs that were integrated elsewhere, and rigid blocks in closed form.

Source: eccentric_cases.json, an independent integration of the equations of motion; and the linear block of Section 3.1
of Silva & Stojadinović 2024 about one pivot at a time, θ'' = p_s² (θ - s α_s).
"""

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import pytest

import rockflex as rf
from builders import NO_MODES
from twins import impact_laws
from twins.complete import simulate_complete

CASES = json.loads((Path(__file__).parent / "eccentric_cases.json").read_text("utf-8"))["cases"]
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment")
BLOCK = rf.RockingProperties([], [], [], [], i_theta=24e6, l0r=1.8e6, m_tot=240e3, half_width=1.2, zeta=0.02)


def label(case):
    return f"{case['model']}-{case['frame']['n_stories']}-e{case['eccentricity']:g}-{case['record']}"


def inputs(case):
    frame = {**case["frame"], "stiffness_ratio": float(case["frame"]["stiffness_ratio"])}
    return frame, rf.load_suite(case["suite"])[case["record"]].scaled(case["scale"])


def bound(case, name):
    # A rotation of some µrad is the square of what is left above the uplift threshold.
    tiny = name == "max_rotation" and case["max_rotation"] < 1e-4
    return 2e-7 if tiny else 2.0 * case["relative_error"]


@pytest.mark.parametrize("case", CASES, ids=label)
def test_peaks(case):
    frame, motion = inputs(case)
    moved = rf.Eccentric(rf.Frame(**frame), case["eccentricity"])
    for output in ("peaks", "history"):
        response = rf.simulate(moved, motion, case["model"], output=output)
        assert response.n_uplifts == case["n_uplifts"]
        for name in PEAKS:
            assert getattr(response, name) == pytest.approx(case[name], rel=bound(case, name)), name


def landing(eccentricity, side, share):
    """Start and time of the first impact from rest at θ_0: cosh(p t) = 1/(1 - θ_0/α), each pivot with its p and α."""
    arm = 1.2 - side * eccentricity
    inertia = 24e6 - 240e3 * 1.2**2 + 240e3 * arm**2
    alpha, rate = 240e3 * arm / 1.8e6, math.sqrt(1.8e6 * 9.81 / inertia)
    return side * share * alpha, math.acosh(1.0 / (1.0 - share)) / rate


def twin_block(eccentricity, rotation, law):
    given = {name: getattr(BLOCK, name) for name in ("i_theta", "l0r", "m_tot", "half_width", "translational_inertia")}
    return simulate_complete(
        **given, **NO_MODES, acceleration=np.zeros(2), dt=0.1, free=12.0, rotation=rotation, complete=False,
        eccentricity=eccentricity, law=law,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("eccentricity", [0.4, -0.7, 0.0])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("share", [0.1, 0.6, 0.999])
def test_a_rigid_block_lands_in_time(eccentricity, side, share):
    block = dataclasses.replace(BLOCK, eccentricity=eccentricity)
    rotation, expected = landing(eccentricity, side, share)
    twin = twin_block(eccentricity, rotation, impact_laws.SimplifiedVVEL())
    assert twin.impact_times[0] == pytest.approx(expected, rel=1e-9)
    run = rf.simulate(
        block, rf.quiet_motion(12.0), "rigid", initial=rf.InitialState(rotation=rotation),
        impact=rf.VVELSimplified(),
    )  # fmt: skip
    assert run.impact_times[0] == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize("side", [1, -1])
def test_a_rigid_block_falls_beyond_its_own_balance(side):
    block = dataclasses.replace(BLOCK, eccentricity=0.4)
    alpha = 240e3 * (1.2 - side * 0.4) / 1.8e6
    status = [
        rf.simulate(
            block, rf.quiet_motion(60.0), "rigid", initial=rf.InitialState(rotation=side * alpha * share),
            impact=rf.VVELSimplified(),
        ).status
        for share in (1.0 - 1e-9, 1.0 + 1e-9)
    ]  # fmt: skip
    assert status == ["rocking", "overturned"]


@pytest.mark.slow
@pytest.mark.parametrize("side", [1, -1])
def test_a_rigid_block_goes_on_after_its_impact(side):
    """Housner's coefficient of the side that ends gives the height of the next excursion, by energy."""
    block = dataclasses.replace(BLOCK, eccentricity=0.25)
    old, new = 1.2 - side * 0.25, 1.2 + side * 0.25
    axis = 24e6 - 240e3 * 1.2**2
    alpha = 240e3 * old / 1.8e6
    start = 0.2 * alpha
    weight, arm = 240e3 * 9.81, 1.8e6 * 9.81
    energy = weight * old * start - 0.5 * arm * start**2
    spin = (axis - 240e3 * old * new) / (axis + 240e3 * new**2) * math.sqrt(2.0 * energy / (axis + 240e3 * old**2))
    left = 0.5 * (axis + 240e3 * new**2) * spin**2
    expected = (weight * new - math.sqrt((weight * new) ** 2 - 2.0 * arm * left)) / arm
    momentum = axis - 240e3 * old * new
    etas = [momentum / (axis + 240e3 * (1.2 + sign * 0.25) ** 2) for sign in (1, -1)]
    twin = twin_block(0.25, side * start, impact_laws.SidedRestitution(*etas))
    run = rf.simulate(block, rf.quiet_motion(6.0), "rigid", initial=rf.InitialState(rotation=side * start))
    # The greatest height lies halfway between two impacts: cosh(p t/2) = 1/(1 - θ/α).
    half = math.acosh(1.0 / (1.0 - expected / (240e3 * new / 1.8e6))) / math.sqrt(arm / (axis + 240e3 * new**2))
    for impacts in (twin.impact_times, run.impact_times):
        assert impacts[1] - impacts[0] == pytest.approx(2.0 * half, rel=1e-9)
