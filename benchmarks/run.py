"""Speed of the engines, as ratios within one run: against SciPy's solvers, and against the bare recurrence.

``make bench`` prints one table. Every time is the minimum of several repetitions (the ODE solvers run once, since they
take seconds). The ratios hold on any machine; the times are those of this machine.
"""

import resource
import time
from collections.abc import Callable

import controlled
import ground
import nonlinear
import numpy as np
import opensees
import sensitivity
import studies
import web_latency
from rich.console import Console
from rich.table import Table
from scipy.signal import lfilter
from timing import frame, least, milliseconds

import rockflex as rf
from rockflex.models import parse_model
from rockflex.studies import PreparedCase
from twins.controlled import ControlledTwin

MODES = (1, 5, 15)
BATCH = 400


def main() -> None:
    console = Console(width=120)
    motion = rf.load_suite("fema-p695-far-field")["FF-1-a"].scaled(1.5)
    steps = motion.acceleration.size - 1
    started = time.perf_counter()
    rf.simulate(frame(2), motion, "MDOF-S", output="peaks")
    console.print(f"first call, kernels compiled or read from disk: {time.perf_counter() - started:.1f} s")
    console.print(
        f"record {motion.name} ×1.5: {steps} steps of {motion.dt} s; shear frames of N stories, T = 1 s, MDOF-S\n"
    )
    table = Table("", *(f"N = {n}" for n in MODES), title="time of one run (ms), and the engine's advantage")
    columns = [measure(n, motion) for n in MODES]
    for label in columns[0]:
        table.add_row(label, *(column[label] for column in columns))
    console.print(table)
    console.print(nonlinear.table(motion))
    if (beside := nonlinear.taylor_table(motion)) is not None:
        console.print(beside)
    console.print(controlled.table(rf.load_suite("fema-p695-far-field")))
    console.print(ground.table(rf.load_suite("fema-p695-far-field")))
    console.print(sensitivity.table())
    console.print(studies.table())
    console.print(opensees.table())
    console.print(web_latency.table())
    console.print(memory())
    console.print(studies.memory())


def measure(n: int, motion: rf.GroundMotion) -> dict[str, str]:
    structure = frame(n)
    steps = motion.acceleration.size - 1
    engine = PreparedCase(parse_model("MDOF-S").of(structure.rocking()), 0.0).engine
    kernel = least(lambda: engine.run(motion.acceleration, motion.dt), 100)
    call = least(lambda: rf.simulate(structure, motion, "MDOF-S", output="peaks"), 50)
    fresh = least(lambda: rf.simulate(frame(n), motion, "MDOF-S", output="peaks"), 50)
    history = least(lambda: rf.simulate(structure, motion, "MDOF-S"), 20)
    batch = least(lambda: rf.simulate_many(structure, [motion] * BATCH, "MDOF-S", workers=1), 3) / BATCH
    cores = least(lambda: rf.simulate_many(structure, [motion] * BATCH, "MDOF-S"), 3) / BATCH
    bare = floor(n, motion)
    lsoda, dop853 = (ode(structure, motion, method) for method in ("LSODA", "DOP853"))
    return {
        "SciPy LSODA, events, rtol 1e-10": milliseconds(lsoda),
        "SciPy DOP853, events, rtol 1e-10": milliseconds(dop853),
        "one call, peaks": milliseconds(call),
        "one call, peaks, structure assembled too": milliseconds(fresh),
        "one call, history and floors": milliseconds(history),
        "batch, peaks, one core": milliseconds(batch),
        "batch, peaks, all cores": milliseconds(cores),
        "engine alone": milliseconds(kernel),
        "bare contact recurrence (floor)": f"{bare * 1e3:.4f}",
        "million steps a second, one core": f"{steps / kernel / 1e6:.1f}",
        "LSODA / one call": f"{lsoda / call:.0f}",
        "LSODA / batch, one core": f"{lsoda / batch:.0f}",
        "LSODA / batch, all cores": f"{lsoda / cores:.0f}",
        "DOP853 / one call": f"{dop853 / call:.0f}",
        "batch, one core / floor": f"{batch / bare:.1f}",
        "400 scales from 1.2 to 1.8, one core / floor": f"{scales_over_floor(n):.1f}",
    }


def ode(structure: rf.Frame, motion: rf.GroundMotion, method: str) -> float:
    """Seconds of one run of the independent reference implementation, as a user would write it."""
    twin = ControlledTwin.of(structure.rocking(), [], rtol=1e-10, method=method, whole=True)
    started = time.perf_counter()
    twin.run(motion.acceleration, motion.dt)
    return time.perf_counter() - started


def recurrence(record: np.ndarray, a: np.ndarray, b: np.ndarray) -> None:
    """Displacements of N oscillators by SciPy's loop in C, sample by sample, without events or peaks."""
    for (a0, a1, a2, a3), (b0, b1, b2, b3) in zip(a.T, b.T, strict=True):
        numerator = [b1, b0 + a1 * b3 - a3 * b1, a1 * b2 - a3 * b0]
        lfilter(numerator, [1.0, -(a0 + a3), a0 * a3 - a1 * a2], record)


def scales_over_floor(n: int) -> float:
    """A run of a batch over the bare contact recurrence: the median of alternating rounds, in processor time."""
    structure, motion = frame(n), rf.load_suite("fema-p695-far-field")["FF-1-a"]
    scales, ratios = np.linspace(1.2, 1.8, BATCH), []
    for _ in range(9):
        started = time.process_time()
        rf.simulate_many(structure, motion, "MDOF-S", scales=scales, workers=1)
        seconds = (time.process_time() - started) / BATCH
        ratios.append(seconds / floor(n, motion, time.process_time))
    return float(np.median(ratios[1:]))


def floor(n: int, motion: rf.GroundMotion, clock: Callable[[], float] = time.perf_counter) -> float:
    """Seconds of the bare contact recurrence with the frame's own coefficients."""
    p = frame(n).rocking()
    dt = motion.dt
    a, b = np.empty((4, n)), np.zeros((4, n))
    damped = p.omega * np.sqrt(1.0 - p.zeta**2)
    decay, sine, cosine = np.exp(-p.zeta * p.omega * dt), np.sin(damped * dt) / damped, np.cos(damped * dt)
    a[0], a[1] = decay * (cosine + p.zeta * p.omega * sine), decay * sine
    a[2], a[3] = -decay * p.omega**2 * sine, decay * (cosine - p.zeta * p.omega * sine)
    b[0] = b[1] = -0.25 * dt**2
    b[2] = b[3] = -0.5 * dt
    recurrence(motion.acceleration, a, b)
    started = clock()
    for _ in range(200):
        recurrence(motion.acceleration, a, b)
    return (clock() - started) / 200


def memory() -> str:
    """Memory growth of the process over many short runs, next to that of the table they return."""
    structure, motion = frame(1), rf.ricker_pulse(2.0, 0.5, dt=0.02)
    lines = ['memory of simulate_many, output="peaks" (2DOF-S under a Ricker pulse):']
    for runs in (10_000, 100_000, 1_000_000):
        started = time.perf_counter()
        table = rf.simulate_many(structure, motion, "2DOF-S", scales=np.linspace(0.5, 3.0, runs))
        seconds = time.perf_counter() - started
        size = table.memory_usage(deep=True).sum() / 2**20
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10
        lines.append(f"  {runs:9,d} runs: peak {peak:6.0f} MiB, of it the table {size:6.1f} MiB; {seconds:5.1f} s")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
