"""Controlled rocking: two fuses and a tendon that yields, against the free base and against LSODA with events."""

import time

from rich.table import Table
from timing import frame, least, milliseconds

import rockflex as rf
from rockflex.models import parse_model
from rockflex.studies import PreparedCase
from twins.controlled import Bar, ControlledTwin

SCALES = (1.0, 1.25, 1.5, 1.75, 2.0)


def table(suite: rf.Suite) -> Table:
    """Times a sample over several records and scales, and the ratio to LSODA for one of them."""
    free = frame(5)
    held = rf.Restrained(free, elements(free))
    motions = [suite[k].scaled(scale) for k in range(0, len(suite), 11) for scale in SCALES]
    one, other = (nanoseconds_a_sample(structure, motions) for structure in (free, held))
    motion = suite["FF-1-a"].scaled(1.5)
    engine = PreparedCase(parse_model("MDOF-S").of(held.rocking()), 0.0).engine
    kernel = least(lambda: engine.run(motion.acceleration, motion.dt), 50)
    twin = twin_of(held)
    started = time.perf_counter()
    found = twin.run(motion.acceleration, motion.dt)
    lsoda = time.perf_counter() - started
    exact = engine.run(motion.acceleration, motion.dt)
    made = Table("", "", title="controlled rocking: MDOF-S, N = 5, two fuses and a yielding tendon")
    made.add_row("free base, ns a sample", f"{one:.0f}")
    made.add_row("with elements, ns a sample", f"{other:.0f}")
    made.add_row("with elements / free base", f"{other / one:.2f}")
    made.add_row("one run, ms", milliseconds(kernel))
    made.add_row("LSODA with events, rtol 1e-7, ms", milliseconds(lsoda))
    made.add_row("LSODA / engine", f"{lsoda / kernel:.0f}")
    made.add_row("largest rotation of LSODA / exact - 1", f"{found.max_rotation / exact.peaks[0] - 1.0:.1e}")
    return made


def elements(structure: rf.Frame) -> list[rf.Tendon | rf.YieldingDissipator]:
    """A hybrid base: the tendon reaches yield at about 1 % of rotation, the fuses at a tenth of it."""
    p = structure.rocking()
    weight, b = p.m_tot * 9.81, p.half_width
    fuses = [rf.YieldingDissipator(0.07 * weight / (0.001 * b), 0.07 * weight, 0.02, 0.8 * x * b) for x in (-1, 1)]
    return [*fuses, rf.Tendon(0.3 * weight, 0.06 * weight / (0.01 * b), 0.0, 0.36 * weight, 0.01)]


def nanoseconds_a_sample(structure: rf.Frame | rf.Restrained, motions: list[rf.GroundMotion]) -> float:
    """Time of the engine over all motions, divided by the samples run, with the least time of each."""
    engine = PreparedCase(parse_model("MDOF-S").of(structure.rocking()), 0.0).engine
    total, samples = 0.0, 0.0
    for motion in motions:
        total += least(lambda m=motion: engine.run(m.acceleration, m.dt), 10)
        samples += engine.run(motion.acceleration, motion.dt).end_time / motion.dt
    return 1e9 * total / samples


def twin_of(structure: rf.Restrained) -> ControlledTwin:
    """The independent implementation, called as a user would call SciPy."""
    p = structure.rocking()
    made = []
    for each in p.elements:
        if isinstance(each, rf.Tendon):
            stretched = each.initial_force / each.stiffness
            made.append(Bar(each.stiffness, each.yield_force, each.post_yield_ratio, 0.0, stretched, no_push=True))
        elif isinstance(each, rf.YieldingDissipator):
            made.append(Bar(each.stiffness, each.yield_force, each.post_yield_ratio, each.position))
    return ControlledTwin.of(p, made, rtol=1e-7, method="LSODA", whole=True)
