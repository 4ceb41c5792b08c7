"""The ground: springs, sliding and vertical motion, against rigid ground, and springs against LSODA."""

import time

import numpy as np
from rich.table import Table
from scipy.integrate import solve_ivp
from timing import frame, least, milliseconds

import rockflex as rf
from rockflex.foundation.constants import GRAVITY
from rockflex.models import parse_model
from rockflex.models._prepared_model import PreparedModel
from rockflex.studies import PreparedCase

SCALES = (1.0, 1.5, 2.0)
ROUNDS = 11
SLIPPERY, ROUGH = 0.1, 0.25
RIGID = "rigid ground"
LSODA = 1e-3  # relative tolerance


def table(suite: rf.Suite) -> Table:
    """Times a sample over several records and scales, relative to rigid ground, and springs against LSODA."""
    p = frame(5).rocking()
    motions = [suite[k].scaled(scale) for k in range(0, len(suite), 11) for scale in SCALES]
    shaken = [each.acceleration[::-1] * 0.5 for each in motions]
    cases = {RIGID: (engine_on(p, None), False)}
    for name, ground in grounds(p).items():
        cases[name] = engine_on(p, ground), False
    cases["vertical motion"] = cases[RIGID][0], True
    each = nanoseconds_a_sample(cases, motions, shaken)
    made = Table(
        "", "ns a sample", "over rigid", "slides", title="the ground: MDOF-S, N = 5, median of alternating rounds"
    )
    for name in cases:
        slides = "" if "μ" not in name else f"{sliding(p, grounds(p)[name], motions):.0%} of the time"
        made.add_row(name, f"{each[name]:.0f}", f"{each[name] / each[RIGID]:.2f}", slides)
    made.add_section()
    motion, two = suite["FF-1-a"].scaled(1.5), grounds(p)["two springs"]
    engine = engine_on(p, two)
    kernel = least(lambda: engine.run(motion.acceleration, motion.dt), 20)
    seconds, largest = by_lsoda(p, two, motion)
    exact = rf.simulate(p, motion, "MDOF-S", "peaks", ground=two).max_rotation
    made.add_row("two springs, one run, ms", milliseconds(kernel), "", "")
    made.add_row(f"the same by LSODA, rtol {LSODA:g}, ms", milliseconds(seconds), "", "")
    made.add_row("LSODA / engine", f"{seconds / kernel:.0f}", "", "")
    made.add_row("θ_max of LSODA / exact - 1", f"{largest / exact - 1.0:.1e}", "", "")
    return made


def grounds(p: rf.RockingProperties) -> dict[str, rf.Ground]:
    """Springs that settle by 1 % of B, with dashpots of 30 % of critical, and two coefficients of friction."""
    b = p.half_width
    total = p.m_tot * GRAVITY / (0.01 * b)
    inertia = 0.04 * p.m_tot * b**2
    two = rf.Springs([-b, b], 0.5 * total).damped(0.3, p.m_tot)
    bed = rf.winkler_bed(b, 1.0, total / (2.0 * b), n=7).damped(0.3, p.m_tot)
    return {
        "two springs": rf.Ground(springs=two, base_inertia=inertia),
        "bed of 7 springs": rf.Ground(springs=bed, base_inertia=inertia),
        f"μ = {SLIPPERY}": rf.Ground(friction=SLIPPERY),
        f"μ = {ROUGH}": rf.Ground(friction=ROUGH),
    }


def engine_on(p: rf.RockingProperties, ground: rf.Ground | None) -> PreparedModel:
    return PreparedCase(parse_model("MDOF-S").of(p, ground=ground), 0.0).engine


def nanoseconds_a_sample(
    cases: dict[str, tuple[PreparedModel, bool]], motions: list[rf.GroundMotion], shaken: list[np.ndarray]
) -> dict[str, float]:
    """Time of each case over all motions, of each the median of the rounds, divided by the samples run."""
    spent = {name: np.zeros((ROUNDS + 1, len(motions))) for name in cases}
    samples = dict.fromkeys(cases, 0.0)
    for times in range(ROUNDS + 1):  # the first round is not counted
        for place, (motion, vertical) in enumerate(zip(motions, shaken, strict=True)):
            for name, (engine, rises) in cases.items():
                up = vertical if rises else None
                started = time.process_time()  # other processes do not count
                solution = engine.run(motion.acceleration, motion.dt, vertical=up)
                spent[name][times, place] = time.process_time() - started
                samples[name] += solution.end_time / motion.dt / (ROUNDS + 1)
    return {name: 1e9 * np.median(spent[name][1:], axis=0).sum() / samples[name] for name in cases}


def sliding(p: rf.RockingProperties, ground: rf.Ground, motions: list[rf.GroundMotion]) -> float:
    """Share of the time in which the base slides."""
    slides = total = 0.0
    for motion in motions:
        history = rf.simulate(p, motion, "MDOF-S", ground=ground).history
        slides += np.diff(history.time)[history.slip_velocity[:-1] != 0.0].sum()
        total += history.time[-1]
    return slides / total


def by_lsoda(p: rf.RockingProperties, ground: rf.Ground, motion: rf.GroundMotion) -> tuple[float, float]:
    """Seconds and largest rotation of a plain integration without events, as a user would write it."""
    springs, n = ground.springs, p.n_modes
    x, k, c = springs.positions, springs.stiffness, springs.damping
    leverage = p.effective_mass * p.effective_height
    inertia = p.translational_inertia + ground.base_inertia - leverage @ p.effective_height
    sampled = motion.dt * np.arange(motion.acceleration.size)

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        d, v, (theta, spin, z, rise) = y[:n], y[n : 2 * n], y[2 * n :]
        a = np.interp(t, sampled, motion.acceleration)
        depth = z - x * theta
        pushes = np.where(depth < 0.0, np.maximum(-k * depth - c * (rise - x * spin), 0.0), 0.0)
        bent = -a - 2.0 * p.zeta * p.omega * v - p.omega**2 * d
        angular = (p.l0r * (GRAVITY * theta - a) - x @ pushes - leverage @ bent) / inertia
        heaving = pushes.sum() / p.m_tot - GRAVITY
        return np.concatenate((v, bent - p.effective_height * angular, (spin, angular, rise, heaving)))

    begin = np.zeros(2 * n + 4)
    begin[-2] = -p.m_tot * GRAVITY / springs.total_stiffness
    started = time.perf_counter()
    found = solve_ivp(
        rates, (0.0, sampled[-1]), begin, method="LSODA", rtol=LSODA, atol=1e-3 * LSODA, max_step=motion.dt
    )
    return time.perf_counter() - started, float(np.abs(found.y[2 * n]).max())
