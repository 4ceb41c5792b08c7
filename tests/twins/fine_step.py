"""The simplified rocking model carried exactly by dense matrix exponentials on a fine grid of sub-samples.

Source: Silva & Stojadinović 2024, Eqs. 15 and 23-25. Nothing is integrated numerically. Every quantity is
looked at on every sub-sample, and where a derivative changes sign between two, at the summit in between.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from twins.exact import Exact
from twins.result import InitialState, Ledger, TwinResult, Vector

ROOT = {"xtol": 1e-300, "rtol": 8.9e-16, "maxiter": 500}


def _first_root(f: Callable[[float], float], end: float) -> float:
    """First sign change of f in (0, end]; f(0) may be zero of any order, f > 0 just after it, f(end) <= 0."""
    right = end
    for _ in range(200):
        left = 0.5 * right
        if f(left) > 0.0:
            return float(brentq(f, left, right, **ROOT)) if f(right) < 0.0 else right
        right = left
    msg = "a rocking phase too short to be resolved"
    raise RuntimeError(msg)


def _first_event(ex: Exact, z: Vector, step: float, *, fresh: bool) -> float | None:
    """First event within ``step`` after z (one sub-step or less), None if there is none."""
    phase = z[ex.side] != 0.0
    last = ex.inside(z, step)
    if phase:
        guards = [(np.eye(1, z.size, 0)[0] * z[ex.side], 0.0)]
    else:
        guards = [(ex.rows[4], ex.resisting), (-ex.rows[4], ex.resisting)]
    found = []
    for row, constant in guards:  # the phase lasts while row·z + constant > 0
        rate = row @ ex.generator[phase]

        def value(tau, row=row, constant=constant):
            return float(row @ ex.inside(z, tau)) + constant

        def slope(tau, rate=rate):
            return float(rate @ ex.inside(z, tau))

        end = step
        if value(step) > 0.0:
            if not (rate @ z < 0.0 < rate @ last):
                continue
            end = float(brentq(slope, 0.0, step, **ROOT))  # the dip between two sub-samples
            if value(end) > 0.0:
                continue
        if fresh:
            found.append(_first_root(value, end))
        else:
            found.append(float(brentq(value, 0.0, end, **ROOT)) if value(0.0) > 0.0 else 0.0)
    return min(found) if found else None


def _suspects(ex: Exact, nodes: Vector, steps: Vector) -> Vector:
    """Intervals between nodes that may hold an event (all that do, and a few more)."""
    phase = bool(nodes[0, ex.side] != 0.0)
    if phase:
        rows, constant = np.eye(1, nodes.shape[1], 0) * nodes[0, ex.side], 0.0
    else:
        rows, constant = np.array([ex.rows[4], -ex.rows[4]]), ex.resisting
    value = rows @ nodes.T + constant
    rate = rows @ ex.generator[phase] @ nodes.T
    reach = np.minimum(value[:, :-1], value[:, 1:]) - steps * np.maximum(abs(rate[:, :-1]), abs(rate[:, 1:]))
    dips = (rate[:, :-1] < 0.0) & (rate[:, 1:] > 0.0) & (reach <= 0.0)
    return np.flatnonzero(((value[:, 1:] <= 0.0) | dips).any(axis=0))


def _peaks(ex: Exact, ledger: Ledger, nodes: Vector, times: Vector) -> None:
    """Offer the nodes' values and the summits between them that could beat the best so far."""
    phase = bool(nodes[0, ex.side] != 0.0)
    values, rates = ex.rows[:4] @ nodes.T, ex.rates[phase][:4] @ nodes.T
    size = np.maximum(abs(values[:, :-1]), abs(values[:, 1:]))
    reach = size + np.diff(times) * np.maximum(abs(rates[:, :-1]), abs(rates[:, 1:]))
    turning = rates[:, :-1] * rates[:, 1:] < 0.0
    for q in range(4):
        k = int(np.argmax(abs(values[q])))
        ledger.offer(q, values[q, k], times[k])
        for i in np.flatnonzero(turning[q] & (reach[q] > ledger.best[q])):
            step, row = times[i + 1] - times[i], ex.rates[phase][q]

            def rate(tau, row=row, z=nodes[i]):
                return float(row @ ex.inside(z, tau))

            if rate(0.0) * rate(step) < 0.0:
                top = brentq(rate, 0.0, step, **ROOT)
                ledger.offer(q, float(ex.rows[q] @ ex.inside(nodes[i], top)), times[i] + top)
    if phase and nodes[0, 0] == 0.0 and nodes[0, ex.side] * rates[0, 1] < 0.0:
        # Up and on the way down again within the first sub-step: the rate is zero at its start too.
        first = nodes[0]
        top = _first_root(
            lambda tau: float(first[ex.side] * (ex.rates[True][0] @ ex.inside(first, tau))),
            times[1] - times[0],
        )
        ledger.offer(0, float(ex.inside(first, top)[0]), times[0] + top)


def _lift(ex: Exact, z: Vector) -> Vector:
    """Side from the overturning moment's sign: negative lifts to θ > 0."""
    lifted = z.copy()
    lifted[[0, ex.angular_velocity]] = 0.0
    lifted[ex.side] = -np.sign(ex.overturning(z))
    return lifted


def _path(ex: Exact, z: Vector, tau: float, grid: int) -> tuple[Vector, Vector]:
    """States and times from z at τ through the grid points that remain in the sample."""
    nodes, times = z[None], np.array([tau])
    if tau > grid * ex.step or (z[ex.side] != 0.0 and z[0] == 0.0):
        grid += 1  # off the grid, or just lifted: to the next grid point by the series
        nodes = np.array([z, ex.inside(z, grid * ex.step - tau)])
        times = np.array([tau, grid * ex.step])
    rest = len(ex.stack[True]) - grid
    nodes = np.concatenate([nodes, ex.stack[bool(z[ex.side] != 0.0)][:rest] @ nodes[-1]])
    return nodes, np.concatenate([times, ex.step * (grid + 1.0 + np.arange(rest))])


def _advance(ex: Exact, ledger: Ledger, z: Vector, start: float, *, fixed: bool) -> tuple[Vector, float]:
    """Carry z through one sample; return it with the time reached (before its end if overturned)."""
    tau, grid, substeps = 0.0, 0, len(ex.stack[True])
    while grid < substeps:
        if z[ex.side] == 0.0 and not fixed and abs(ex.overturning(z)) > ex.resisting:
            z = _lift(ex, z)
            ledger.uplifts.append(start + tau)
        rocking = bool(z[ex.side] != 0.0)
        path, clock = _path(ex, z, tau, grid)

        at, event = len(path) - 1, None
        for i in [] if fixed else _suspects(ex, path, np.diff(clock)):
            event = _first_event(ex, path[i], clock[i + 1] - clock[i], fresh=rocking and path[i, 0] == 0.0)
            if event is not None:
                at = int(i)
                break
        over = np.flatnonzero(abs(path[: at + 1, 0]) >= 0.5 * np.pi)
        if over.size:
            at, event = int(over[0]) - 1, None
            s = path[at, ex.side]
            event = brentq(
                lambda t, s=s, y=path[at]: s * ex.inside(y, t)[0] - 0.5 * np.pi,
                0.0,
                clock[at + 1] - clock[at],
                **ROOT,
            )
        if event is None:
            _peaks(ex, ledger, path, start + clock)
            return path[-1], start + clock[-1]

        z, tau = ex.inside(path[at], event), clock[at] + event
        _peaks(ex, ledger, np.concatenate([path[: at + 1], z[None]]), start + np.append(clock[: at + 1], tau))
        if over.size:
            z[0] = np.copysign(0.5 * np.pi, z[0])
            ledger.best[0] = 0.5 * np.pi
            return z, start + tau
        grid = int(tau / ex.step + 1e-9)
        tau = max(tau, grid * ex.step)
        if rocking:
            z[0] = 0.0
            ledger.impacts.append(start + tau)
            ledger.states.append(ex.plain(z))
            z = ex.landed(z)
        elif grid < substeps:  # at a kink the next sample decides
            z = _lift(ex, z)
            ledger.uplifts.append(start + tau)
    return z, start + substeps * ex.step


def simulate_fine(
    *,
    acceleration: Vector,
    dt: float,
    free_vibration: float = 0.0,
    substeps: int = 64,
    fixed: bool = False,
    initial: InitialState | None = None,
    **structure: object,
) -> TwinResult:
    """Peaks, events and last state of a ``structure`` as `Exact` takes it, on ``substeps`` exact sub-samples a sample.

    ``free_vibration`` is rounded up to whole samples. Raises ValueError if a sub-step is longer than 2/ω of
    the fastest uplifted mode: events could then hide, and the series would lose digits.
    """
    ex = Exact(**structure, dt=dt, substeps=substeps)
    if ex.fastest * ex.step > 2.0:
        msg = f"substeps={substeps} is too coarse: take at least {int(np.ceil(ex.fastest * dt / 2.0))}"
        raise ValueError(msg)
    initial = initial or InitialState()
    if abs(initial.rotation) >= 0.5 * np.pi or (fixed and initial.rotation != 0.0):
        msg = "the initial rotation must lie within ±π/2, and be zero on a fixed base"
        raise ValueError(msg)
    q = ex.n + 1
    z = np.zeros(2 * q + 3)
    z[0], z[ex.side] = initial.rotation, np.sign(initial.rotation)
    if initial.modal_displacement is not None:
        z[1:q] = initial.modal_displacement
    if initial.modal_velocity is not None:
        z[q + 1 : 2 * q] = initial.modal_velocity

    record = np.asarray(acceleration, float)
    quiet = np.zeros(int(np.ceil(free_vibration / dt - 1e-9)))
    first = np.concatenate([record[:-1], quiet])
    last = np.concatenate([record[1:], quiet])
    ledger, history, time, overturned = Ledger(), [ex.plain(z)], 0.0, False
    for k, (a, b) in enumerate(zip(first, last, strict=True)):
        z = z.copy()
        z[ex.a], z[ex.slope] = a, (b - a) / dt
        z, time = _advance(ex, ledger, z, k * dt, fixed=fixed)
        overturned = abs(z[0]) >= 0.5 * np.pi
        if overturned:
            break
        history.append(ex.plain(z))
    return ledger.close(
        time=time, side=int(np.sign(z[ex.side])), state=ex.plain(z), overturned=overturned, history=history
    )
