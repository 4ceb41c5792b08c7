"""Scaling of a study over a Dask cluster on the loopback: time, memory, and what follows for a thousand cores.

``python benchmarks/scaling.py`` runs a cloud of short runs (2DOF-S under Ricker pulses) in several sizes on one worker,
two, and so on, each worker a process with one thread, and fits T(K, W) = a + K (t_run / W + t_serial) to the times.
Each measurement has a client and a cluster of its own, so that its memory is its own. For a million runs:
``python benchmarks/scaling.py --runs 1000000 --workers 2``.
"""

import argparse
import json
import subprocess
import sys
import threading
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import psutil
from rich.console import Console
from rich.table import Table
from scipy.optimize import nnls

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import rockflex as rf
from dask_cluster import Cluster
from rockflex.studies.running import core_count

STRUCTURES, PULSES = 20, 50
SAMPLE = 0.2  # s between looks at the memory
IDLE = 5.0  # s in which the processor time of waiting is measured
ROLES = ("client", "scheduler", "workers")
RUNS, CORES = 1e8, 1000  # of the estimate
PART = 10_000  # runs in a part of the estimate
NETWORK = 125e6  # B/s: a gigabit a second
SYNCED = 0.02  # s that a parallel file system may take until a file is on disk


def main() -> None:
    """Measure every size on every number of workers, and print what follows."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, nargs="+", default=[10_000, 20_000, 40_000])
    parser.add_argument("--workers", type=int, nargs="+", default=[*range(1, core_count() + 1)])
    parser.add_argument("--chunk", type=int, default=1000, help="runs in a part")
    parser.add_argument("--one", help=argparse.SUPPRESS)  # the folder of a single measurement, in its own process
    given = parser.parse_args()
    if given.one:
        print(json.dumps(measure(given.runs[0], given.workers[0], given.chunk, Path(given.one))))
        return
    console = Console(width=120)
    found: list[dict[str, Any]] = []
    for workers in given.workers:
        for runs in given.runs:
            found.append(in_own_process(runs, workers, given.chunk))
            console.print(line(found[-1]), highlight=False)
    console.print(table(found))
    law(found, console)
    paper(found, console)


def in_own_process(runs: int, workers: int, chunk: int) -> dict[str, Any]:
    with TemporaryDirectory() as folder:
        command = [sys.executable, __file__, "--runs", str(runs), "--workers", str(workers), "--chunk", str(chunk)]
        done = subprocess.run([*command, "--one", folder], capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(done.stderr)
        return json.loads(done.stdout.splitlines()[-1])


def study_of(runs: int, chunk: int, folder: Path) -> rf.CloudStudy:
    """A cloud of short runs: every structure under every pulse at as many scales as it takes."""
    records = folder / "records"
    if not records.exists():
        records.mkdir()
        for place, period in enumerate(np.linspace(0.3, 1.5, PULSES)):
            pulse = rf.ricker_pulse(2.0, float(period), dt=0.02)
            columns = np.column_stack((np.arange(pulse.acceleration.size) * pulse.dt, pulse.acceleration))
            header = "time (s),acceleration (m/s2)"
            np.savetxt(records / f"P{place:02d}.csv", columns, delimiter=",", header=header, comments="")
    frames = [
        {
            "name": f"T = {period:.2f} s",
            "frame": {
                "n_stories": 2,
                "story_height": 3.0,
                "story_mass": 40e3,
                "base_mass": 40e3,
                "stiffness_ratio": 1.0,
                "period": float(period),
                "aspect_ratio": 8.0,
                "damping_ratio": 0.02,
            },
        }
        for period in np.linspace(0.3, 1.2, STRUCTURES)
    ]
    scales = np.linspace(0.5, 3.0, max(1, round(runs / (STRUCTURES * PULSES))))
    return rf.CloudStudy(
        structures=frames,
        records={"folder": str(records)},
        models=["2DOF-S"],
        scales=scales.tolist(),
        runs_per_chunk=chunk,
    )


class Watch(threading.Thread):
    """The memory of the client, the scheduler and all workers over time, and the runs that were stored by then."""

    def __init__(self, processes: dict[str, list[psutil.Process]]) -> None:
        super().__init__(daemon=True)
        self.processes, self.runs, self.over = processes, 0, threading.Event()
        self.seen: list[tuple[float, int, *tuple[float, ...]]] = []

    def run(self) -> None:
        """Look until it is over."""
        start = time.monotonic()
        while not self.over.wait(SAMPLE):
            sizes = (sum(each.memory_info().rss for each in self.processes[role]) / 2**20 for role in ROLES)
            self.seen.append((time.monotonic() - start, self.runs, *sizes))


def measure(runs: int, workers: int, chunk: int, folder: Path) -> dict[str, Any]:
    """Times, memory and processor time of one study on a cluster of its own."""
    study = study_of(runs, chunk, folder)
    with Cluster(folder, workers) as cluster:
        small = study.model_copy(update={"scales": [1.0], "runs_per_chunk": 20})
        rf.fill_study(small, folder / "small", dask=cluster.address)  # the kernels are loaded
        processes = {
            "client": [psutil.Process()],
            "scheduler": [psutil.Process(cluster.scheduler.pid)],
            "workers": [psutil.Process(each.pid) for each in cluster.workers],
        }
        watch, tasks = Watch(processes), counted_tasks()
        watch.start()  # its own time counts as idle
        idle = {role: -used(each) for role, each in processes.items()}
        time.sleep(IDLE)
        before = {role: used(each) for role, each in processes.items()}
        idle = {role: (idle[role] + before[role]) / IDLE for role in processes}
        begun = time.monotonic()
        stored = rf.fill_study(
            study, folder / "study", dask=cluster.address, progress=lambda now: setattr(watch, "runs", now.runs)
        )
        seconds = time.monotonic() - begun
        watch.over.set()
        busy = {role: used(each) - before[role] - idle[role] * seconds for role, each in processes.items()}
    begun = time.monotonic()
    missing = stored.missing()
    resumed = time.monotonic() - begun
    assert not missing
    parts = [path.stat().st_size for path in (folder / "study" / "parts").iterdir()]
    return {
        "runs": study.plan().n_runs,
        "workers": workers,
        "seconds": seconds,
        "busy": busy,
        "tasks": len(tasks),
        "parts": len(parts),
        "bytes": sum(parts),
        "resumed": resumed,
        "memory": memory(np.array(watch.seen)),
        "document": (folder / "study" / "spec.json").stat().st_size,
    }


def used(processes: list[psutil.Process]) -> float:
    return sum(sum(each.cpu_times()[:2]) for each in processes)


def counted_tasks() -> list[object]:
    """A list to which every task that is sent from now on is added."""
    from distributed import Client

    found: list[object] = []
    real = Client.submit

    def submit(self: Client, *given: object, **options: object) -> object:
        found.append(given[2])
        return real(self, *given, **options)

    Client.submit = submit
    return found


def memory(seen: np.ndarray) -> dict[str, dict[str, float]]:
    """Peak of each role in MiB, and its growth in MiB over the second half of the runs."""
    late = seen[seen[:, 1] >= 0.5 * seen[-1, 1]]
    found: dict[str, dict[str, float]] = {}
    for place, role in enumerate(ROLES, start=2):
        slope = np.polyfit(late[:, 1], late[:, place], 1)[0] if np.ptp(late[:, 1]) > 0 else 0.0
        found[role] = {"peak": float(seen[:, place].max()), "growth": float(slope * np.ptp(late[:, 1]))}
    return found


def line(one: dict[str, Any]) -> str:
    rate = one["runs"] / one["seconds"]
    return f"{one['runs']:9,d} runs on {one['workers']} workers: {one['seconds']:.1f} s, {rate:,.0f} runs a second"


def table(found: list[dict[str, Any]]) -> Table:
    """One column for each measurement."""
    shown = Table("", *(f"{one['runs']:,d} / {one['workers']}" for one in found), title="runs / workers")
    rows = {
        "time (s)": lambda one: f"{one['seconds']:.1f}",
        "runs a second": lambda one: f"{one['runs'] / one['seconds']:,.0f}",
        "workers: processor time of a run (ms)": lambda one: f"{one['busy']['workers'] / one['runs'] * 1e3:.3f}",
        "client: processor time of a run (ms)": lambda one: f"{one['busy']['client'] / one['runs'] * 1e3:.4f}",
        "client: processor time of a part (ms)": lambda one: f"{one['busy']['client'] / one['parts'] * 1e3:.1f}",
        "scheduler: processor time of a task (ms)": lambda one: f"{one['busy']['scheduler'] / one['tasks'] * 1e3:.1f}",
        "tasks, parts": lambda one: f"{one['tasks']}, {one['parts']}",
        "bytes a run on disk": lambda one: f"{one['bytes'] / one['runs']:.0f}",
        "all parts read and checked (s)": lambda one: f"{one['resumed']:.2f}",
    }
    for role in ROLES:
        rows[f"{role}: peak memory (MiB)"] = lambda one, role=role: f"{one['memory'][role]['peak']:.0f}"
        rows[f"{role}: growth in the second half (MiB)"] = lambda one, role=role: (
            f"{one['memory'][role]['growth']:+.1f}"
        )
    for label, value in rows.items():
        shown.add_row(label, *map(value, found))
    return shown


def law(found: list[dict[str, Any]], console: Console) -> None:
    """Fit T = a + K (t_run / W + t_serial), with relative errors."""
    if len({one["workers"] for one in found}) < 2 or len({one["runs"] for one in found}) < 2:
        console.print("The law needs several sizes on several numbers of workers.")
        return
    times = np.array([one["seconds"] for one in found])
    terms = np.array([(1.0, one["runs"] / one["workers"], one["runs"]) for one in found])
    (start, run, serial), _ = nnls(terms / times[:, None], np.ones(len(found)))
    errors = terms @ (start, run, serial) / times - 1.0
    console.print(
        f"T(K, W) = {start:.2f} s + K ({run * 1e3:.4f} ms / W + {serial * 1e3:.4f} ms), "
        f"within {np.abs(errors).max() * 100:.0f} %",
        highlight=False,
    )


def paper(found: list[dict[str, Any]], console: Console) -> None:
    """Work out a large study on many cores from the processor times."""
    last = found[-1]
    run, size, parts = last["busy"]["workers"] / last["runs"], last["bytes"] / last["runs"], RUNS / PART
    client, scheduler = growth(found, "client"), last["busy"]["scheduler"] / last["tasks"]
    rows = {
        f"computing: {RUNS:.0e} runs of {run * 1e3:.2f} ms on {CORES} cores": RUNS * run / CORES,
        f"client: {parts:,.0f} parts of {PART:,d} runs, {client * 1e3:.1f} ms each as measured": parts * client,
        f"store: {SYNCED * 1e3:.0f} ms for each part until it is on disk": parts * SYNCED,
        f"network: {RUNS * size / 1e9:.0f} GB into the client, {NETWORK * 8e-9:.0f} Gbit/s": RUNS * size / NETWORK,
        f"scheduler: a task for each part at most, {scheduler * 1e3:.1f} ms each": parts * scheduler,
    }
    console.print(f"On paper, {RUNS:.0e} runs on {CORES} cores (s), each by itself; the slowest decides:")
    for label, seconds in rows.items():
        console.print(f"  {label}: {seconds:,.0f}", highlight=False)


def growth(found: list[dict[str, Any]], role: str) -> float:
    """Processor time of a role in s for each further part; what it takes to start is left out."""
    parts, busy = [one["parts"] for one in found], [one["busy"][role] for one in found]
    return float(np.polyfit(parts, busy, 1)[0]) if len(set(parts)) > 1 else busy[-1] / parts[-1]


if __name__ == "__main__":
    main()
