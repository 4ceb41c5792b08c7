"""Impacts of a penalty contact, and when they agree with VVEL."""

from dataclasses import dataclass

import numpy as np
from frames import Contact, Prototype, linear, load_opensees, modes
from numpy.typing import NDArray
from references import hermite
from stepping import AVERAGE, Run, Scheme, damp, march, settle

import rockflex as rf

Float = NDArray[np.float64]

AFTER = 0.02  # s after the first impact, in which the rebound is sought
DURATION = 12.0  # s


@dataclass(frozen=True)
class Case:
    """One contact and one integration scheme."""

    name: str
    contact: Contact
    scheme: Scheme


CASES = (
    Case("elastic", Contact(1e11), Scheme(2.5e-4, AVERAGE)),
    Case("elastic", Contact(1e12), Scheme(1e-4, AVERAGE)),
    Case("elastic, HHT α = 0.7", Contact(1e12), Scheme(5e-4, ("HHT", 0.7))),
    Case("elastic, TRBDF2", Contact(1e12), Scheme(5e-4, ("TRBDF2",))),
    Case("absorbing", Contact(1e11, 1.0), Scheme(2.5e-4, AVERAGE)),
    Case("absorbing", Contact(1e11, 1.0), Scheme(5e-4, AVERAGE)),
    Case("absorbing", Contact(1e12, 1.0), Scheme(1e-4, AVERAGE)),
)


@dataclass(frozen=True)
class Cycles:
    """One run against MDOF-S with VVEL, both damped in proportion to the stiffness."""

    case: Case
    run: Run
    errors: tuple[float, ...]  # largest difference of θ up to each of the given times, over θ_max
    rebound: float  # upward speed of the base's middle after the first impact, over B|θ'| before it


def impact_share(prototype: Prototype) -> float:
    """Share of the kinetic energy ½ I_θ θ'² of a rigid rotation that VVEL dissipates: that of m_tot B²."""
    p = prototype.frame().rocking()
    return 1.0 - float(p.effective_mass @ p.effective_height**2) / p.i_theta


def reference(prototype: Prototype, motion: rf.GroundMotion, ratio: float) -> rf.Response:
    """MDOF-S with the ratios of stiffness-proportional damping."""
    omega = prototype.frame().rocking().omega
    return rf.simulate(prototype.structure(ratio * omega / omega[0]), motion, "MDOF-S")


def later_cycles(
    prototype: Prototype,
    motion: rf.GroundMotion,
    ratio: float,
    cases: tuple[Case, ...] = CASES,
    until: tuple[float, ...] = (5.0, 8.0, DURATION),
) -> list[Cycles]:
    """Run OpenSees with each contact, and compare the rotation up to the first impact and up to each time of `until`.

    `ratio` is the damping ratio of the first mode; the others' grow with their frequency.
    """
    ops = load_opensees()
    response = reference(prototype, motion, ratio)
    width = modes(prototype).half_width
    impact = float(response.impact_times[0])
    node = int(np.searchsorted(response.time, impact))
    speed = width * abs(float(response.rotation_velocity[node]))
    found = []
    for case in cases:
        linear(ops, prototype, case.contact)
        settle(ops)
        damp(ops, prototype, "stiffness", ratio)
        run = march(ops, motion, until[-1], case.scheme, width)
        theta = hermite(response.time, response.rotation, response.rotation_velocity, run.time)
        difference = np.abs(run.rotation - theta) / float(np.max(np.abs(theta)))
        errors = tuple(float(np.max(difference[run.time <= end])) for end in (impact, *until))
        rising = np.gradient(run.lift.mean(axis=1), run.time)
        rebound = float(np.max(rising[(run.time > impact) & (run.time < impact + AFTER)])) / speed
        found.append(Cycles(case, run, errors, rebound))
    return found
