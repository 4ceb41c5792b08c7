"""A fixed base: equal frequencies, and equal responses to the accuracy of the step."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from frames import Prototype, fixed, load_opensees, modes
from stepping import AVERAGE, Scheme, damp, march

import rockflex as rf

DAMPING_RATIO = 0.02


@dataclass(frozen=True)
class FixedError:
    """Largest difference at the record's samples, as a fraction of the peak, and OpenSees' peak over rockflex's − 1."""

    divisions: int  # steps per sample
    history: tuple[float, float, float]  # u_top, V_b, M_b
    peak: tuple[float, float, float]


def modal_differences(prototype: Prototype) -> dict[str, float]:
    """Largest relative difference of ω_n, m*_n and h*_n of all modes, and of B."""
    mine, theirs = prototype.frame().rocking(), modes(prototype)
    pairs = {
        "ω": (theirs.omega, mine.omega),
        "m*": (theirs.effective_mass, mine.effective_mass),
        "h*": (theirs.effective_height, mine.effective_height),
        "B": (theirs.half_width, mine.half_width),
    }
    return {name: float(np.max(np.abs(np.divide(a, b) - 1.0))) for name, (a, b) in pairs.items()}


def fixed_errors(
    prototype: Prototype, motion: rf.GroundMotion, divisions: Sequence[int], integrator: tuple = AVERAGE
) -> list[FixedError]:
    """OpenSees with 2 % modal damping and `divisions` steps per sample, against rockflex's fixed base."""
    ops = load_opensees()
    response = rf.simulate(prototype.frame(DAMPING_RATIO), motion, "fixed")
    names = ("top_displacement", "base_shear", "base_moment")
    errors = []
    for division in divisions:
        fixed(ops, prototype, modes(prototype).column)
        damp(ops, prototype, "modal", DAMPING_RATIO)
        duration = (motion.acceleration.size - 1) * motion.dt
        run = march(ops, motion, duration, Scheme(motion.dt / division, integrator, "Linear"))
        history, peak = [], []
        for name in names:
            theirs, mine = getattr(run, name), getattr(response, name)[1:]
            largest = getattr(response, f"max_{name}")
            history.append(float(np.max(np.abs(theirs[division - 1 :: division] - mine))) / largest)
            peak.append(float(np.max(np.abs(theirs))) / largest - 1.0)
        errors.append(FixedError(division, tuple(history), tuple(peak)))
    return errors
