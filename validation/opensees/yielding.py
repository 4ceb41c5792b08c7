"""A frame whose stories yield, on a base that can uplift, with leaning mass: one excursion against MDOF-S.

With the moment of the leaning weight as a spring on the base, as that of the other weight, the equations are those of
`YieldingStories(Leaning(...))`. Leaning columns of hinged bars have two terms more, which that neglects: P-Δ of the
drifts, and the push of the leaning weight on the floors.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from first_excursion import Excursion, excursion
from frames import (
    FLOORS,
    GRAVITY,
    GROUND,
    HEIGHTS,
    SECTION,
    SHEAR,
    STIFF,
    STORY_HEIGHT,
    STORY_MASS,
    Contact,
    base,
    load_opensees,
    modes,
    start,
    weights,
)
from numpy.typing import NDArray
from references import finer, reference
from stepping import Scheme, march, settle

import rockflex as rf

Float = NDArray[np.float64]

LEANING = 20e3  # kg, of each floor
STRENGTHS = np.array([260e3, 245e3, 215e3, 160e3, 90e3])  # N
HARDENING = 0.05
RATIO = 0.02  # damping of the first mode, proportional to the elastic stiffness


@dataclass(frozen=True)
class YieldingExcursion:
    """One excursion, and the largest difference of the story drifts over their peak."""

    excursion: Excursion
    drift: float
    ductility: Float  # of rockflex's stories, up to the end of the excursion


def stories() -> rf.YieldingStories:
    """Return the structure in rockflex."""
    lumped = SHEAR.structure()
    omega = rf.Leaning(lumped, LEANING).rocking().omega
    damped = replace(lumped, damping_ratio=RATIO * omega / omega[0])
    return rf.YieldingStories(rf.Leaning(damped, LEANING), STRENGTHS, HARDENING)


def story_stiffness() -> float:
    """Return the stiffness of a story in N/m, from OpenSees' modes."""
    return 12.0 * modes(SHEAR).column / STORY_HEIGHT**3


def build(ops: Any, contact: Contact, *, columns: bool) -> None:
    """Build the frame; the leaning weight acts through `columns`, or as a spring on the base."""
    start(ops)
    width = modes(SHEAR).half_width
    base(ops, held=True)
    ops.node(GROUND, 0.0, 0.0)
    ops.fix(GROUND, 1, 1, 1)
    ops.uniaxialMaterial("ENT", 1, contact.stiffness)
    ops.section("Fiber", 1)
    for x in (-width, width):
        ops.fiber(x, 0.0, 1.0, 1)
    ops.element("zeroLengthSection", SECTION, GROUND, 0, 1, "-orient", 0.0, 1.0, 0.0, -1.0, 0.0, 0.0)
    standing = STORY_MASS if columns else STORY_MASS + LEANING
    ops.uniaxialMaterial("Elastic", 2, -standing * float(HEIGHTS.sum()) * GRAVITY)
    ops.element("zeroLength", SECTION + 2, GROUND, 0, "-mat", 2, "-dir", 6)
    for i in FLOORS:
        ops.node(i, 0.0, i * STORY_HEIGHT)
        ops.mass(i, STORY_MASS + LEANING, STORY_MASS, 0.0)
        ops.equalDOF(0, i, 2, 3)
        ops.uniaxialMaterial("Steel01", 10 + i, float(STRENGTHS[i - 1]), story_stiffness(), HARDENING)
        # Shear of the story alone: half of its length turns with either end, as with rigid beams.
        ops.element("twoNodeLink", i, i - 1, i, "-mat", 10 + i, "-dir", 2, "-doRayleigh")
    weights(ops)
    if columns:
        hinged_columns(ops)


def hinged_columns(ops: Any) -> None:
    """Add columns beside the frame, hinged at the floors, which carry the leaning weight and move with the floors."""
    ops.uniaxialMaterial("Elastic", 3, STIFF)
    ops.node(300, 5.0, 0.0)
    ops.fix(300, 1, 1, 1)
    for i in FLOORS:
        ops.node(300 + i, 5.0, i * STORY_HEIGHT)
        ops.fix(300 + i, 0, 0, 1)
        ops.equalDOF(i, 300 + i, 1)
        ops.element("corotTruss", 300 + i, 299 + i, 300 + i, 1.0, 3)
        ops.load(300 + i, 0.0, -LEANING * GRAVITY, 0.0)


def yielding(
    shaking: rf.GroundMotion, cases: list[tuple[float, float]], *, columns: bool = False
) -> list[YieldingExcursion]:
    """Compare the first excursion for each contact stiffness and step."""
    ops, structure = load_opensees(), stories()
    wanted = reference(structure, "MDOF-S", shaking)
    response = rf.simulate(structure, finer(shaking))
    within = response.time <= wanted.impact
    time, drift = response.time[within], response.story_drift[within]
    largest = np.abs(drift).max(axis=0)
    found = []
    for stiffness, dt in cases:
        contact = Contact(stiffness)
        build(ops, contact, columns=columns)
        settle(ops)
        ops.region(1, "-ele", *FLOORS, "-rayleigh", 0.0, 0.0, 2.0 * RATIO / float(structure.rocking().omega[0]), 0.0)
        run = march(ops, shaking, wanted.impact + 0.1, Scheme(dt), modes(SHEAR).half_width)
        there, other = run.story_drift[run.time <= wanted.impact], run.time[run.time <= wanted.impact]
        here = np.column_stack([np.interp(other, time, each) for each in drift.T])
        worst = float((np.abs(there - here).max(axis=0) / largest).max())
        found.append(YieldingExcursion(excursion(run, wanted, contact, dt), worst, largest / structure.yield_drift))
    return found
