"""Hostile arguments: what calls are made with, one argument at a time replaced by something it cannot be."""

import dataclasses
import math
from collections.abc import Callable, Iterator
from datetime import date
from functools import partial
from typing import Any

import numpy as np

import rockflex as rf

HUGE = 10**400

Calls = dict[str, tuple[Callable[..., Any], dict[str, Any]]]  # a call, and arguments that work


def junk() -> dict[str, Any]:
    """What no argument should take, or be brought down by, each with a name."""
    loop: list[Any] = []
    loop.append(loop)
    return {
        "none": None,
        "true": True,
        "word": "hostile",
        "long word": "x" * 100_000,
        "bytes": b"\xff\x00",
        "complex": 1.0 + 2.0j,
        "nan": math.nan,
        "inf": math.inf,
        "-inf": -math.inf,
        "-0.0": -0.0,
        "minus one": -1.0,
        "minus two, whole": -2,
        "huge": HUGE,
        "more digits than Python writes": -(10**5000),
        "largest": 1.7e308,
        "smallest": 5e-324,
        "empty": [],
        "ragged": [[1.0, 2.0], [3.0]],
        "mixed": [1.0, [2.0]],
        "nested": [[[[1.0]]]],
        "in itself": loop,
        "with none": [1.0, None],
        "with nan": [1.0, math.nan],
        "with huge": [1.0, HUGE],
        "words": ["a", "b"],
        "long list": list(range(2000)),
        "complex array": np.array([1.0 + 1.0j, 2.0]),
        "object array": np.array([object(), None], dtype=object),
        "no rows": np.zeros((0, 3)),
        "no columns": np.zeros((2, 0)),
        "masked": np.ma.masked_values([1.0, 2.0, -9999.0], -9999.0),
        "masked rows": [np.ma.masked_values([1.0, -9999.0], -9999.0), [1.0, 2.0]],
        "dates": np.array(["2020-01-01", "2020-01-02"], dtype="datetime64[D]"),
        "date": date(2020, 1, 1),
        "dict": {"a": 1},
        "dict of huge": {HUGE: "x" * 100_000},
        "set": {1.0},
        "object": object(),
        "function": lambda *_: "x" * 100_000,
        "class": rf.Frame,
        "bad string": "\ud800\x00",
    }


FRAME = {
    "n_stories": 2, "story_height": 3.0, "story_mass": 4e4, "base_mass": 4e4, "stiffness_ratio": 0.1, "period": 0.5,
    "aspect_ratio": 5.0, "damping_ratio": 0.02,
}  # fmt: skip
MATRICES = {"stiffness": [[2e6, -1e6], [-1e6, 1e6]], "heights": [3.0, 6.0]}
BASE = {"base_mass": 1e4, "half_width": 1.0, "damping_ratio": 0.02}
PROPERTIES = {
    "omega": [10.0, 30.0], "effective_mass": [1e4, 1e3], "effective_height": [3.0, -0.5], "top_ordinate": [1.3, -0.3],
    "i_theta": 2e5, "l0r": 4e4, "m_tot": 2e4, "half_width": 1.0, "zeta": 0.02, "translational_inertia": 1e5,
    "floors": None, "elements": (), "eccentricity": 0.1,
}  # fmt: skip
TOWER = {
    "height": 100.0, "base_radius": 5.0, "top_radius": 3.0, "wall": 0.5, "density": 2400.0, "elastic_modulus": 25e9,
    "damping_ratio": 0.02, "method": "ritz", "n_modes": 2,
}  # fmt: skip
BEAM = {
    "height": 30.0, "mass": 1e3, "bending_stiffness": 1e10, "half_width": 2.0, "damping_ratio": 0.02,
    "shear_stiffness": 1e9, "rotary_inertia": 1e3, "lumped_masses": None, "base_mass": 1e4, "rotary_in_modes": True,
    "method": "fe", "n_modes": 2, "n_elements": 10, "shapes": None,
}  # fmt: skip
CANTILEVER = {
    "height": 10.0, "tip_mass": 1e4, "bending_stiffness": 1e9, "mass_per_length": 0.0, "tip_inertia": 0.0,
    "n_modes": None,
}  # fmt: skip
WALL = {
    "height": 30.0, "mass": 1e6, "stiffness_parameter": 2.0, "base_mass": 1e5, "period": 1.0, "aspect_ratio": 5.0,
    "damping_ratio": 0.02, "n_modes": 2,
}  # fmt: skip
BONE = {"story_heights": [3.0, 3.0], "masses": 1e4, "column_stiffness": 1e8, "beam_stiffness": 1e8}
BED = {"half_width": 2.0, "breadth": 3.0, "n": 10, "eccentricity": 0.1}
SOIL = {"shear_modulus": 2e7, "poisson_ratio": 0.3}
BOUC_WEN = {"yield_displacement": 0.05, "post_yield_ratio": 0.01, "gamma": 0.5, "beta": 0.5, "exponent": 8.0}
SHAKEN = {"free_vibration": 0.0, "bouc_wen": None, "impact": None}
RUN = {"model": "2DOF-S", "output": "history", "initial": None}
MANY = {"scales": 1.0, "workers": 1}
LADDER = {"smallest_scale": 1.0, "largest_scale": 2.0, "growth": 2.0, "tolerance": 0.4, "limit": "overturning"}
IM = [0.1, 0.2, 0.4, 0.8, 0.3]
OUTCOME = [0, 1, 0, 1, 1]


def structures() -> Calls:
    """Calls that make structures and parameters, with arguments that work."""
    modal = rf.modal_properties([1e4, 1e4], MATRICES["stiffness"], MATRICES["heights"])
    p = rf.RockingProperties(**PROPERTIES)
    material = {"elastic_modulus": 30e9, "density": 2500.0, "stiffness_factor": 0.5}
    section = rf.Section.circle(1.0, **material)
    return {
        "Frame": (rf.Frame, FRAME),
        "LumpedStructure": (rf.LumpedStructure, {"masses": [1e4, 1e4], **MATRICES, **BASE}),
        "from_matrices": (
            rf.from_matrices,
            {"mass": [1e4, 1e4], **MATRICES, "rotations": (), **BASE, "n_modes": None},
        ),
        "from_modes": (
            rf.from_modes,
            {"omega": [5.0, 20.0], "shapes": [[1.0, 2.0], [2.0, -1.0]], "mass": [1e4, 1e4], "heights": [3.0, 6.0],
             "rotations": (), **BASE, "n_modes": None},
        ),
        "TaperedTower": (rf.TaperedTower, TOWER),
        "Beam": (rf.Beam, BEAM),
        "Beam of shapes": (rf.Beam, BEAM | {"method": "ritz", "n_elements": None, "shear_stiffness": None}),
        "LumpedMasses": (rf.LumpedMasses, {"heights": [1.0, 2.0], "masses": [1.0, 1.0], "rotary": [0.0, 1.0]}),
        "CantileverWithTipMass": (rf.CantileverWithTipMass, CANTILEVER | BASE),
        "column of a section": (rf.CantileverWithTipMass, {"height": 9.0, "tip_mass": 1e4, "section": section} | BASE),
        "beam of a section": (rf.Beam, {"height": 9.0, "section": section, "half_width": 1.0, "damping_ratio": 0.02}),
        "Section": (rf.Section, {"area": 1.0, "second_moment": 0.1, "rotary_inertia": 250.0, **material}),
        "Section.rectangle": (rf.Section.rectangle, {"width": 1.0, "depth": 2.0, **material}),
        "Section.box": (rf.Section.box, {"width": 1.0, "depth": 2.0, "wall": 0.1, **material}),
        "Section.circle": (rf.Section.circle, {"diameter": 1.0, **material}),
        "Section.tube": (rf.Section.tube, {"diameter": 1.0, "wall": 0.1, **material}),
        "Section.composite": (rf.Section.composite, {"parts": [(section, 0.0)], "stiffness_factor": 0.5}),
        "structure_warnings": (rf.structure_warnings, {"structure": rf.Frame(**FRAME)}),
        "WallFrame": (rf.WallFrame, WALL),
        "FishBone": (rf.FishBone, BONE | BASE),
        "rigid_block": (rf.rigid_block, {"slenderness": 0.2, "half_diagonal": 2.0, "mass": 1.0}),
        "block of sides": (rf.rigid_block, {"width": 0.6, "height": 2.0, "mass": 250.0}),
        "rocking_frame": (
            rf.rocking_frame,
            {"n_columns": 4, "column_width": 1.6, "column_height": 9.6, "column_mass": 6e4, "cap_mass": 2.4e5},
        ),
        "Joint": (rf.Joint, {"height": 6.0, "half_width": 1.0}),
        "Jointed": (rf.Jointed, {"structure": rf.Frame(**FRAME), "joints": rf.Joint(3.0, 1.0)}),
        "Podium": (
            rf.Podium,
            {"structure": rf.Frame(**FRAME), "n_columns": 3, "column_width": 0.6, "column_height": 4.0}
            | {"column_mass": 5e3},
        ),
        "OneSided": (rf.OneSided, {"structure": rf.Frame(**FRAME), "restitution": 0.4, "side": "right"}),
        "OneSided block": (
            rf.OneSided,
            {"structure": rf.rigid_block(0.2, 2.0, 1e3), "restitution": "sorrentino", "side": "left"},
        ),
        "cosine_shapes": (rf.cosine_shapes, {"height": 10.0, "n_shapes": 2}),
        "Tendon": (
            rf.Tendon,
            {"initial_force": 1e5, "stiffness": 1e6, "position": 0.0, "yield_force": 2e5, "post_yield_ratio": 0.02,
             "rupture_elongation": 0.3},
        ),
        "Tendon that snaps": (rf.Tendon, {"initial_force": 1e5, "stiffness": 1e6, "rupture_elongation": 0.02}),
        "YieldingDissipator": (
            rf.YieldingDissipator,
            {"stiffness": 1e7, "yield_force": 1e5, "post_yield_ratio": 0.02, "position": 0.2, "tension_only": False,
             "rupture_elongation": 0.2},
        ),
        "ViscousDamper": (rf.ViscousDamper, {"coefficient": 1e5, "position": 0.2}),
        "FrictionDamper": (rf.FrictionDamper, {"force": 1e5, "position": 0.2}),
        "FlagShapedBar": (
            rf.FlagShapedBar,
            {"stiffness": 1e8, "yield_force": 2e5, "post_yield_ratio": 0.05, "flag_depth": 0.8, "position": 0.2},
        ),
        "GapBar": (rf.GapBar, {"stiffness": 1e8, "gap": 0.01, "position": 0.2}),
        "MultilinearBar": (rf.MultilinearBar, {"elongations": [0.01], "forces": [1e5], "position": 0.2}),
        "strand_tendon": (
            rf.strand_tendon,
            {"n": 4, "strand": "Y1860S7-15.7", "length": 10.0, "prestress": 0.5, "post_yield_ratio": 0.02,
             "ultimate_strain": 0.03, "position": 0.2},
        ),
        "bar_fuse": (
            rf.bar_fuse,
            {"n": 2, "diameter": 0.02, "length": 0.5, "steel": "B500B", "tension_only": False,
             "ultimate_strain": 0.04, "position": 0.2},
        ),
        "u_plate_fuse": (
            rf.u_plate_fuse,
            {"n": 2, "width": 0.12, "thickness": 0.012, "diameter": 0.12, "steel": "S355", "post_yield_ratio": 0.02,
             "position": 0.2},
        ),
        "YieldingStories": (
            rf.YieldingStories,
            {"structure": rf.Frame(**FRAME | {"stiffness_ratio": math.inf}), "strengths": [3e5, 2e5],
             "post_yield_ratio": 0.05},
        ),
        "winkler_bed": (
            rf.winkler_bed,
            BED | {"subgrade_modulus": 4e7, "damping": 1e5, "end_zone": 0.2, "end_ratio": 2.0},
        ),
        "asce41_bed": (rf.asce41_bed, BED | SOIL | {"damping": 1e5}),
        "gazetas_bed": (rf.gazetas_bed, BED | SOIL | {"density": 1900.0, "end_zone": 0.5}),
        "Restrained": (rf.Restrained, {"structure": rf.Frame(**FRAME), "elements": rf.Tendon(1e5, 1e6)}),
        "Eccentric": (rf.Eccentric, {"structure": rf.Frame(**FRAME), "eccentricity": 0.1}),
        "block held": (rf.Restrained, {"structure": rf.rigid_block(0.2, 2.0, 1e3), "elements": rf.Tendon(1e3, 1e5)}),
        "block aside": (rf.Eccentric, {"structure": rf.rigid_block(0.2, 2.0, 1e3), "eccentricity": 0.1}),
        "RockingProperties": (rf.RockingProperties, PROPERTIES),
        "properties to one side": (rf.RockingProperties, PROPERTIES | {"restitution": 0.5, "opens": "right"}),
        "pivot": (p.pivot, {"side": -1}),
        "truncated": (p.truncated, {"n_modes": 1}),
        "modal": (rf.Frame(**FRAME).modal, {"n_modes": 1}),
        "rocking": (rf.Frame(**FRAME).rocking, {"n_modes": 1}),
        "FloorModes": (
            rf.FloorModes,
            {"heights": [3.0, 6.0], "displacement": [[0.5, 0.5], [1.0, -1.0]], "force": [[1e4, 1e4], [1e4, -1e4]]},
        ),
        "modal_properties": (rf.modal_properties, {"mass": [1e4, 1e4], **MATRICES, "n_modes": None}),
        "rocking_properties": (
            rf.rocking_properties,
            {"modal": modal, "mass": [1e4, 1e4], "heights": [3.0, 6.0], **BASE, "n_modes": None},
        ),
        "adequacy": (rf.adequacy, {"properties": p, "tolerance": None, "base_mass": None}),
        "AdequacyTolerance": (
            rf.AdequacyTolerance,
            {"base_moment": 0.1, "first_frequency": 0.1, "second_frequency": 0.2, "base_shear": 0.1},
        ),
        "uplifted_modes": (rf.uplifted_modes, {"properties": p, "n_modes": None, "side": 1}),
        "frequency_equation": (rf.frequency_equation, {"properties": p, "omega": [1.0, 2.0], "side": -1}),
        "pinned_beam": (rf.pinned_beam, {"behaviour": "shear", "spring": 0.0, "n_modes": 2}),
        "equivalent_s1": (
            rf.equivalent_s1,
            {"base_mass_ratio": 0.5, "damping_ratio": 0.02, "width_ratio": 0.2, "effective_height": 1.0},
        ),
        "equivalent_2hz_long_base": (
            rf.equivalent_2hz_long_base,
            {"base_mass_ratio": 0.2, "damping_ratio": 0.02, "n_modes": 2},
        ),
        "BoucWen": (rf.BoucWen, BOUC_WEN),
        "Restitution": (rf.Restitution, {"e": 0.9, "shortest_excursion": 1e-4}),
        "AngularMomentum": (rf.AngularMomentum, {"restitution": 0.9}),
        "Model": (rf.Model, {"n_modes": 1, "lifts": True, "complete": False, "closure": None, "yields": False}),
        "InitialState": (
            rf.InitialState,
            {"rotation": 0.01, "modal_displacement": None, "modal_velocity": None, "rotation_velocity": 0.0},
        ),
        "TendonLevel": (
            rf.TendonLevel,
            {"prestress_ratio": 0.1, "stiffness_ratio": 0.1, "yield_ratio": 2.0, "name": "a"},
        ),
    }  # fmt: skip


def motions() -> Calls:
    """Calls that make and change ground motions."""
    motion = rf.GroundMotion([0.0, 1.0, -1.0, 0.5] * 20, 0.01, "short")
    brief = rf.GroundMotion([0.0, 1.0, -1.0, 0.5], 0.01, "brief")  # all angles of thousands of periods take long
    target = rf.ec8_spectrum(2.0, "B")
    pulse = {"amplitude": 1.0, "period": 0.5, "dt": 0.01}
    lasting = {"amplitude": 1.0, "duration": 0.5, "dt": 0.01}
    return {
        "GroundMotion": (
            rf.GroundMotion,
            {"acceleration": [0.0, 1.0, 0.0], "dt": 0.01, "name": "a", "metadata": None},
        ),
        "Suite": (rf.Suite, {"motions": [motion], "name": "a"}),
        "load_suite": (rf.load_suite, {"name": "el-centro-1940"}),
        "read_motion": (rf.read_motion, {"path": "nothing.csv", "units": "g", "dt": 0.01}),
        "read_at2": (rf.read_at2, {"path": "nothing.at2"}),
        "read_suite": (rf.read_suite, {"paths": "nothing", "units": "g", "dt": 0.01}),
        "ricker_pulse": (rf.ricker_pulse, pulse | {"kind": "symmetric"}),
        "one_sine_pulse": (rf.one_sine_pulse, pulse),
        "one_cosine_pulse": (rf.one_cosine_pulse, pulse),
        "half_sine_pulse": (rf.half_sine_pulse, lasting),
        "rectangular_pulse": (rf.rectangular_pulse, lasting),
        "mavroeidis_papageorgiou_pulse": (rf.mavroeidis_papageorgiou_pulse, pulse | {"gamma": 1.5, "nu": 0.0}),
        "quiet_motion": (rf.quiet_motion, {"duration": 1.0, "dt": 0.01}),
        "scaled": (motion.scaled, {"factor": 2.0}),
        "refined": (motion.refined, {"k": 2}),
        "resampled": (motion.resampled, {"dt": 0.005}),
        "baseline_corrected": (motion.baseline_corrected, {"degree": 1}),
        "band_passed": (motion.band_passed, {"low": 1.0, "high": 20.0, "order": 2}),
        "significant_duration": (motion.significant_duration, {"low": 0.05, "high": 0.95}),
        "scaled_to": (motion.scaled_to, {"sa": 1.0, "period": 0.5, "damping_ratio": 0.02}),
        "scaled_to a target": (motion.scaled_to, {"target": target, "periods": (0.2, 1.0)}),
        "select": (
            rf.Suite([motion]).select,
            {
                "target": target,
                "n": 1,
                "periods": (0.2, 1.0),
                "measure": "component",
                "scale_limits": (0.1, 1e9),
                "per_event": 1,
                "per_station": 1,
                "record_weight": 0.5,
                "least_ratio": 0.9,
            },
        ),
        "TargetSpectrum": (
            rf.TargetSpectrum,
            {"periods": [0.1, 1.0], "sa": [2.0, 1.0], "damping_ratio": 0.05, "name": "a"},
        ),
        "ConditionalSpectrum": (
            rf.ConditionalSpectrum,
            {
                "periods": [0.1, 1.0],
                "sa": [2.0, 1.0],
                "dispersion": [0.5, 0.0],
                "period": 1.0,
                "damping_ratio": 0.05,
                "name": "a",
            },
        ),
        "conditional_spectrum": (
            rf.conditional_spectrum,
            {
                "periods": [0.1, 1.0],
                "median": [2.0, 1.0],
                "dispersion": [0.6, 0.6],
                "period": 1.0,
                "epsilon": 1.0,
                "damping_ratio": 0.05,
                "name": "a",
            },
        ),
        "spectral_correlation": (rf.spectral_correlation, {"first": [0.1, 1.0], "second": [1.0, 1.0]}),
        "target.at": (target.at, {"periods": [0.5]}),
        "target.scaled": (target.scaled, {"factor": 2.0}),
        "read_conditional_spectrum": (
            partial(rf.read_conditional_spectrum, epsilon=1.0),
            {"path": "nothing.csv", "period": 1.0, "units": "g"},
        ),
        "read_target": (rf.read_target, {"path": "nothing.csv", "units": "g"}),
        "ec8_spectrum": (
            rf.ec8_spectrum,
            {"ag": 2.0, "ground": "A", "kind": 1, "importance": 1.0, "damping_ratio": 0.05},
        ),
        "asce7_spectrum": (rf.asce7_spectrum, {"sds": 10.0, "sd1": 6.0, "tl": 8.0, "mce": False}),
        "asce7_site_spectrum": (
            rf.asce7_site_spectrum,
            {"ss": 10.0, "s1": 6.0, "site": "C", "tl": 8.0, "mce": False},
        ),
        "rotated_spectrum": (
            rf.rotated_spectrum,
            {"first": brief, "second": brief, "periods": [0.5, 1.0], "damping_ratio": 0.05},
        ),
        "rotd": (rf.rotated_spectrum(motion, motion, [0.5]).rotd, {"percentile": 50}),
        "spectrum": (motion.spectrum, {"periods": [0.5, 1.0], "damping_ratio": 0.05}),
        "sd": (motion.sd, {"period": 0.5, "damping_ratio": 0.05}),
        "sa": (motion.sa, {"period": 0.5, "damping_ratio": 0.05}),
    }


def studies() -> Calls:
    """Calls that run, in the smallest form."""
    motion = rf.ricker_pulse(6.0, 0.5, dt=0.02)
    structure = rf.Frame(**FRAME)
    block = rf.rigid_block(0.2, 2.0)
    given = {"structures": structure, "motions": motion, "models": "2DOF-S"}
    return {
        "simulate": (rf.simulate, {"structure": structure, "motion": motion, **RUN, **SHAKEN}),
        "simulate_many": (rf.simulate_many, given | SHAKEN | MANY | {"output": "peaks", "initial": None}),
        "simulate_set": (
            rf.simulate_set,
            {"structure": structure, "motions": motion, "model": "2DOF-S", "rule": None, "periods": (0.2, 1.0),
             "initial": None, "workers": 1, **SHAKEN},
        ),
        "check": (rf.check, {"result": rf.simulate(structure, motion), "limits": rf.CheckLimits()}),
        "CheckLimits": (
            rf.CheckLimits,
            {each.name: 0.5 for each in dataclasses.fields(rf.CheckLimits)},
        ),
        "run_cloud": (rf.run_cloud, given | SHAKEN | MANY | {"friction": False}),
        "run_incremental": (rf.run_incremental, given | SHAKEN | LADDER | {"workers": 1}),
        "run_design": (
            rf.run_design,
            {"structure": structure, "motions": motion, "half_widths": [1.0, 1.2], "tendons": (), "models": "2DOF-S",
             "scales": 1.0, "base_mass_per_width": 0.0, **SHAKEN, "workers": 1},
        ),
        "run_population": (
            rf.run_population,
            {"motions": rf.Suite([motion]), "pairs": 2, "seed": 0, "free_vibration": 0.0, "workers": 1},
        ),
        "modal_combination": (
            rf.modal_combination,
            {"structure": structure, "motion": motion, "free_vibration": 0.0},
        ),
        "frequency_ratios": (
            rf.frequency_ratios,
            {"structure": structure, "aspect_ratios": [2.0, 5.0], "n_modes": (1, None)},
        ),
        "overturning_scales": (
            rf.overturning_scales,
            {"structure": block, "motion": motion, "scales": [1.0, 5.0], "model": "rigid-C", "impact": None,
             "tolerance": 1e-2},
        ),
        "overturning_spectrum": (
            rf.overturning_spectrum,
            {"structure": block, "pulse": rf.half_sine_pulse, "frequency_ratios": [2.0], "model": "rigid-C",
             "impact": None, "relative_amplitudes": (1.0, 3.0), "tolerance": 1e-2, "workers": 1},
        ),
        "rocking_spectrum": (
            rf.rocking_spectrum,
            {"motion": motion, "slendernesses": [0.2], "periods": [2.0], "model": "rigid-C", "impact": None,
             "free_vibration": 0.0, "workers": 1},
        ),
        "draw_prototype": (rf.draw_prototype, {"seed": 0, "number": 0, "n_records": 1}),
    }  # fmt: skip


def fits() -> Calls:
    """Calls that fit and read fragilities."""
    hazard = rf.HazardCurve([0.1, 0.5, 1.0], [1e-1, 1e-2, 1e-3])
    curve = rf.LognormalFragility(0.5, 0.4)
    cloud = rf.fit_cloud(IM, [0.01, 0.02, 0.05, 0.08, 0.02])
    logistic = rf.fit_logistic(IM, OUTCOME)
    outcomes = {"im": IM, "rotation": [0.01, 0.02, 0.05, 0.08, 0.02], "overturned": OUTCOME, "threshold": 1e-4}
    return {
        "HazardCurve": (rf.HazardCurve, {"im": [0.1, 0.5], "rate": [1e-2, 1e-3]}),
        "rate_at": (hazard.rate_at, {"im": [0.2]}),
        "im_at": (hazard.im_at, {"rate": [0.02]}),
        "LognormalFragility": (rf.LognormalFragility, {"median": 0.5, "beta": 0.4}),
        "probability": (curve.probability, {"im": [0.2]}),
        "quantile": (curve.quantile, {"p": [0.2]}),
        "from_poe": (rf.HazardCurve.from_poe, {"im": [0.1, 0.5], "poe": [0.4, 0.1], "years": 50.0}),
        "annual_rate": (rf.annual_rate, {"hazard": hazard, "fragility": curve}),
        "HazardBranches": (rf.HazardBranches, {"curves": [hazard, hazard], "weights": [0.4, 0.6]}),
        "lognormal": (rf.HazardBranches.lognormal, {"mean": hazard, "dispersion": 0.5}),
        "rate_shares": (
            rf.rate_shares,
            {"hazard": rf.HazardBranches.lognormal(hazard, 0.5), "curves": {("a", "M"): curve}, "weights": {"a": 1.0},
             "years": 50.0, "logarithm": False, "confidence": 0.9},
        ),
        "risk_targeted_median": (
            rf.risk_targeted_median,
            {"hazard": hazard, "dispersion": 0.4, "target_rate": 1e-2, "allowed_beyond": 0.5},
        ),
        "fit_cloud": (rf.fit_cloud, {"im": IM, "response": [0.01, 0.02, 0.05, 0.08, 0.02]}),
        "cloud.quantile": (cloud.quantile, {"im": [0.2], "p": 0.5}),
        "cloud.exceedance": (cloud.exceedance, {"im": [0.2], "limit": 0.5}),
        "cloud.band": (cloud.band, {"im": [0.2], "confidence": 0.9}),
        "fit_logistic": (rf.fit_logistic, {"im": IM, "outcome": OUTCOME}),
        "logistic.band": (logistic.band, {"im": [0.2], "confidence": 0.9}),
        "fit_capacities": (rf.fit_capacities, {"im": IM, "censored": OUTCOME}),
        "fit_stripes": (
            rf.fit_stripes,
            {"im_levels": [0.1, 0.2, 0.4], "n_exceeding": [1, 5, 9], "n_total": [10, 10, 10]},
        ),
        "fit_outcomes": (rf.fit_outcomes, outcomes),
        "bootstrap_band": (
            rf.bootstrap_band,
            {"fit_function": rf.fit_cloud, "im": IM, "outcome_or_response": [0.01, 0.02, 0.05, 0.08, 0.02],
             "groups": None, "at": [0.2], "confidence": 0.9, "n": 20, "seed": 0,
             "curve": lambda fit, im: fit.median(im)},
        ),
    }  # fmt: skip


def cases(
    calls: dict[str, tuple[Callable[..., Any], dict[str, Any]]],
) -> Iterator[tuple[str, str, str, Callable, dict]]:
    """Name of the call and the argument and the junk, the call, and its arguments with the junk among them."""
    for name, (call, good) in calls.items():
        for argument in good:
            for what, value in junk().items():
                given = good | {argument: value}
                yield name, argument, what, call, given
