"""From uplift to the first impact: the equations of motion only, without an impact law."""

from dataclasses import dataclass

import numpy as np
from frames import Contact, Prototype, corotational, linear, load_opensees, modes
from newton import by_newton
from numpy.typing import NDArray
from references import Reference, absolute_damping, reference
from stepping import Run, Scheme, damp, march, settle

import rockflex as rf

Float = NDArray[np.float64]

PEAK, PERIOD, QUIET = 0.25 * 9.81, 1.0, 2.0  # m/s², s, s after the pulse


def pulse() -> rf.GroundMotion:
    """Antisymmetric Ricker pulse of 0.25 g and 1 s, which causes one large excursion of both structures."""
    ricker = rf.ricker_pulse(PEAK, PERIOD, dt=0.005, kind="antisymmetric")
    quiet = np.zeros(round(QUIET / ricker.dt))
    return rf.GroundMotion(np.concatenate([ricker.acceleration, quiet]), ricker.dt, name="Ricker")


@dataclass(frozen=True)
class Excursion:
    """OpenSees against a reference, from uplift to the first impact."""

    contact: float  # N/m
    dt: float  # s
    uplift: float  # OpenSees' time of uplift minus the reference's, s
    impact: float  # the same of the first impact, s
    peak: float  # OpenSees' θ_max over the reference's − 1
    rotation: float  # largest difference of θ over θ_max
    top: float  # largest difference of u_top over its peak; NaN in large rotations
    seconds: float  # spent by OpenSees


def excursion(run: Run, wanted: Reference, contact: Contact, dt: float, *, large: bool = False) -> Excursion:
    """Compare a run with a reference."""
    inside = (run.time > wanted.uplift) & (run.time < wanted.impact)
    theta, top = wanted.motion(run.time[inside])
    largest = wanted.largest
    raised = run.lift.max(axis=1)  # of the higher corner; negative while both are pressed down
    lifted = crossing(run.time, raised, 0)
    later = int(np.searchsorted(run.time, lifted + 0.1))
    return Excursion(
        contact.stiffness,
        dt,
        lifted - wanted.uplift,
        crossing(run.time, -raised, later) - wanted.impact,
        float(np.max(np.abs(run.rotation[inside]))) / largest[0] - 1.0,
        float(np.max(np.abs(run.rotation[inside] - theta))) / largest[0],
        float("nan") if large else float(np.max(np.abs(run.top_displacement[inside] - top))) / largest[1],
        run.seconds,
    )


def crossing(time: Float, values: Float, start: int) -> float:
    """First time from index `start` on at which `values` become positive, on the chord between steps."""
    i = start + int(np.argmax(values[start:] > 0.0))
    if not values[i] > 0.0 or i == 0:
        raise RuntimeError("The corners of the model never did what was looked for. Shake for longer.")
    before, after = values[i - 1], values[i]
    return float(time[i - 1] - before * (time[i] - time[i - 1]) / (after - before))


def simplified(
    prototype: Prototype,
    shaking: rf.GroundMotion,
    cases: list[tuple[float, float]],
    damping: tuple[str, float] = ("none", 0.0),
    *,
    like_opensees: bool = False,
    gravity_spring: bool = True,
) -> list[Excursion]:
    """Linear geometry against MDOF-S, for each contact stiffness and step of `cases`.

    `damping` is "none", "modal" or "stiffness", with the ratio of the first mode; `like_opensees` compares modal
    damping with `absolute_damping`, not with rockflex; without `gravity_spring` OpenSees lacks the moment L_0^r g θ.
    """
    ops = load_opensees()
    kind, ratio = damping
    omega = prototype.frame().rocking().omega
    ratios = ratio * omega / omega[0] if kind == "stiffness" else ratio
    wanted = (
        absolute_damping(prototype, shaking, ratio)
        if like_opensees
        else reference(prototype.structure(ratios), "MDOF-S", shaking)
    )
    found = []
    for stiffness, dt in cases:
        contact = Contact(stiffness)
        linear(ops, prototype, contact, gravity_spring=gravity_spring)
        settle(ops)
        damp(ops, prototype, kind, ratio)
        run = march(ops, shaking, wanted.impact + 0.1, Scheme(dt), modes(prototype).half_width)
        found.append(excursion(run, wanted, contact, dt))
    return found


def complete(
    prototype: Prototype, shaking: rf.GroundMotion, cases: list[tuple[float, float]], *, like_opensees: bool = False
) -> list[Excursion]:
    """Large rotations without damping against MDOF-C with its stories softened by their P/L, for each of `cases`.

    `like_opensees` compares with Newton's law for columns that shorten as they lean, not with rockflex.
    """
    ops = load_opensees()
    if like_opensees:
        wanted = by_newton(prototype, shaking, shortening=True)
    else:
        wanted = reference(prototype.structure(second_order=True), "MDOF-C", shaking)
    theta, _ = wanted.motion(np.array([0.5 * (wanted.uplift + wanted.impact)]))
    found = []
    for stiffness, dt in cases:
        contact = Contact(stiffness)
        corotational(ops, prototype, contact, float(np.sign(theta[0])))
        settle(ops)
        run = march(ops, shaking, wanted.impact + 0.1, Scheme(dt), corners=True)
        found.append(excursion(run, wanted, contact, dt, large=True))
    return found
