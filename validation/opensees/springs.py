"""A base on two springs that cannot pull: OpenSees' zero-length elements against rockflex's springs.

rockflex's spring-dashpots push with max(0, -k z - c z') while z < 0. OpenSees has no such material. Without dashpots a
no-tension material is the same law. With them two models are compared:

"series"    a stiff no-tension contact on a footing without mass, which stands on the spring and the dashpot. The
            contact cannot pull either, but a footing that has been left behind by the base rises again within some c/k.
"parallel"  a no-tension spring beside a dashpot, the usual choice. The dashpot pulls, and acts on a base in the air.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from first_excursion import crossing, pulse
from frames import (
    BASE_MASS,
    GRAVITY,
    GROUND,
    LEFT,
    RIGHT,
    SECTION,
    STIFF,
    TOTAL_MASS,
    WEIGHT_ARM,
    Prototype,
    base,
    columns,
    load_opensees,
    modes,
    start,
    weights,
)
from numpy.typing import NDArray
from references import hermite
from scipy.integrate import solve_ivp
from speed import Speed, least
from stepping import Run, Scheme, damp, march, settle

import rockflex as rf

Float = NDArray[np.float64]
Kind = Literal["undamped", "series", "parallel"]

INERTIA_SHARE = 1.0 / 3.0  # of the base's m_b B²: a rigid mat
CONTACT = 1e3  # stiffness of the contact of "series" over that of its spring
FOOT, BELOW = 10, 20  # added to the numbers of the corners
DAMPED = 0.015  # of the first mode, by the stiffness of the columns


@dataclass(frozen=True)
class Ground:
    """Two springs under the corners of a base."""

    kind: Kind
    stiffness: float  # of each, N/m
    damping_ratio: float = 0.0  # of the heave mode, of critical

    @property
    def damping(self) -> float:
        """Coefficient c of each dashpot in N s/m."""
        return self.damping_ratio * math.sqrt(2.0 * self.stiffness * TOTAL_MASS)


STIFF_GROUND = Ground("undamped", 1e9)
DAMPED_GROUND = Ground("series", 1e9, 0.3)
PARALLEL_GROUND = Ground("parallel", 1e9, 0.3)
STEPS = (1e-2, 5e-3, 2e-3, 1e-3, 5e-4)  # s
ON_SPRINGS = "MDOF-S on springs"


@dataclass(frozen=True)
class OnSprings:
    """One run of OpenSees against rockflex."""

    ground: Ground
    dt: float  # s
    uplift: float  # time of the first uplift, in rockflex, s
    late: float  # OpenSees' first uplift minus rockflex's, s
    largest: float  # θ_max in rockflex, rad
    peak: float  # OpenSees' θ_max over rockflex's - 1
    rotation: float  # largest difference of θ(t) over θ_max
    opensees: float  # s, in analyze only
    rockflex: float  # s, one call for the peaks


def on_springs(ops: Any, prototype: Prototype, ground: Ground) -> None:
    """Linear geometry: the simplified model on springs, with the moment of the weight as in `frames.linear`."""
    start(ops)
    properties = modes(prototype)
    width = properties.half_width
    ops.geomTransf("Linear", 1)
    base(ops, held=True)
    ops.mass(0, BASE_MASS, BASE_MASS, INERTIA_SHARE * BASE_MASS * width**2)
    ops.node(GROUND, 0.0, 0.0)
    ops.fix(GROUND, 1, 1, 1)
    k, c = ground.stiffness, ground.damping
    series = ground.kind == "series"
    ops.uniaxialMaterial("ENT", 1, CONTACT * k if series else k)
    ops.uniaxialMaterial("Elastic", 2, k if series else 1.0, c)
    for corner, x in ((LEFT, -width), (RIGHT, width)):
        ops.node(corner, x, 0.0)
        ops.node(corner + BELOW, x, 0.0)
        ops.fix(corner + BELOW, 1, 1, 1)
        stiff = 1e5 * k * width**3  # of the base: its bending must not count
        ops.element("elasticBeamColumn", corner, 0, corner, STIFF, 1.0, stiff, 1)
        under = corner + BELOW
        if series:
            under = corner + FOOT
            ops.node(under, x, 0.0)
            ops.fix(under, 1, 0, 1)
            ops.element("zeroLength", corner + FOOT, corner + BELOW, under, "-mat", 2, "-dir", 2)
        materials = (1, 2) if ground.kind == "parallel" else (1,)
        ops.element("zeroLength", corner + BELOW, under, corner, "-mat", *materials, "-dir", *(2,) * len(materials))
    ops.uniaxialMaterial("Elastic", 3, -WEIGHT_ARM * GRAVITY)
    ops.element("zeroLength", SECTION, GROUND, 0, "-mat", 3, "-dir", 6)
    columns(ops, properties.column, 1.0, (2, 3) if prototype.shear else (2,))
    weights(ops)


def in_rockflex(prototype: Prototype, shaking: rf.GroundMotion, ground: Ground) -> tuple[rf.Response, float]:
    """Return the run in rockflex, and the seconds of a call for its peaks with properties computed beforehand."""
    p = damped(prototype).rocking()
    b = p.half_width
    springs = rf.Springs([-b, b], ground.stiffness, ground.damping)
    under = rf.Ground(springs=springs, base_inertia=INERTIA_SHARE * BASE_MASS * b**2)
    seconds = least(lambda: rf.simulate(p, shaking, "MDOF-S", "peaks", ground=under), 10)
    return rf.simulate(p, shaking, "MDOF-S", ground=under), seconds


def with_footings(prototype: Prototype, shaking: rf.GroundMotion, ground: Ground) -> Callable[[Float], Float]:
    """Return θ(t) by LSODA with the law of "series": each corner on a footing w with c w' = -k w - N.

    N = CONTACT k (w - z) while the corner is pressed on it, otherwise 0.
    """
    p = damped(prototype).rocking()
    n, b, k, c = p.n_modes, p.half_width, ground.stiffness, ground.damping
    sampled = np.arange(shaking.acceleration.size) * shaking.dt
    leverage = p.effective_mass * p.effective_height
    inertia = p.translational_inertia + INERTIA_SHARE * BASE_MASS * b**2 - float(leverage @ p.effective_height)
    x = np.array([-b, b])

    def rates(t: float, y: Float) -> Float:
        d, v, (theta, spin, z, rise), w = y[:n], y[n : 2 * n], y[2 * n : 2 * n + 4], y[2 * n + 4 :]
        a = np.interp(t, sampled, shaking.acceleration)
        pushes = CONTACT * k * np.maximum(w - z + x * theta, 0.0)
        bent = -a - 2.0 * p.zeta * p.omega * v - p.omega**2 * d
        turning = p.l0r * (GRAVITY * theta - a) - float(x @ pushes) - float(leverage @ bent)
        angular = turning / inertia
        heaving = pushes.sum() / p.m_tot - GRAVITY
        return np.concatenate(
            (v, bent - p.effective_height * angular, (spin, angular, rise, heaving), (-k * w - pushes) / c)
        )

    begin = np.zeros(2 * n + 6)
    begin[-2:] = -0.5 * p.m_tot * GRAVITY / k
    begin[2 * n + 2] = begin[-1] * (1.0 + 1.0 / CONTACT)
    given = {"method": "LSODA", "rtol": 1e-9, "atol": 1e-12, "max_step": shaking.dt, "dense_output": True}
    found = solve_ivp(rates, (0.0, sampled[-1]), begin, **given)
    return lambda at: found.sol(at)[2 * n]


def damped(prototype: Prototype) -> rf.LumpedStructure:
    """Return the structure with damping by the stiffness of its columns."""
    omega = prototype.frame().rocking().omega
    return prototype.structure(DAMPED * omega / omega[0])


def in_opensees(prototype: Prototype, shaking: rf.GroundMotion, ground: Ground, dt: float) -> Run:
    """Run OpenSees for as long as the motion."""
    ops = load_opensees()
    on_springs(ops, prototype, ground)
    settle(ops)
    damp(ops, prototype, "stiffness", DAMPED)
    return march(ops, shaking, shaking.duration, Scheme(dt), modes(prototype).half_width)


def compare(prototype: Prototype, shaking: rf.GroundMotion, cases: list[tuple[Ground, float]]) -> list[OnSprings]:
    """Run each ground and step of `cases` in OpenSees, against rockflex."""
    found = []
    for ground, dt in cases:
        response, mine = in_rockflex(prototype, shaking, ground)
        run = in_opensees(prototype, shaking, ground, dt)
        lifts = float(response.uplift_times[0])

        def theta(at: Float, response: rf.Response = response) -> Float:
            return hermite(response.time, response.rotation, response.rotation_velocity, at)

        late = crossing(run.time, run.lift.max(axis=1), 0) - lifts
        peak, rotation = differences(run, theta, response.max_rotation)
        found.append(OnSprings(ground, dt, lifts, late, response.max_rotation, peak, rotation, run.seconds, mine))
    return found


def differences(run: Run, theta: Callable[[Float], Float], largest: float) -> tuple[float, float]:
    """Return OpenSees' θ_max over `largest` - 1, and the largest difference of θ(t) over `largest`."""
    inside = run.time <= run.time[-1] - 1e-9
    return (
        float(np.max(np.abs(run.rotation))) / largest - 1.0,
        float(np.max(np.abs(run.rotation[inside] - theta(run.time[inside])))) / largest,
    )


def explained(prototype: Prototype, shaking: rf.GroundMotion, ground: Ground, dt: float) -> tuple[float, float]:
    """Return the differences of OpenSees with "series" from `with_footings`."""
    run = in_opensees(prototype, shaking, ground, dt)
    theta = with_footings(prototype, shaking, ground)
    return differences(run, theta, float(np.max(np.abs(theta(run.time)))))


def speeds_on_springs(
    prototype: Prototype, targets: tuple[float, ...] = (1e-3, 1e-4), steps: tuple[float, ...] = STEPS
) -> list[Speed]:
    """The largest step of OpenSees that meets each target under the pulse, without dashpots; see `speed.speeds`."""
    runs = compare(prototype, pulse(), [(STIFF_GROUND, dt) for dt in steps])
    found = []
    for target in targets:
        good = [run for run in runs if abs(run.peak) <= target]
        if good:
            best = max(good, key=lambda run: run.dt)
            theirs = min(best.opensees, in_opensees(prototype, pulse(), best.ground, best.dt).seconds)
            found.append(Speed(ON_SPRINGS, target, best.ground.stiffness, best.dt, best.peak, theirs, best.rockflex))
    return found
