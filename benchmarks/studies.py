"""The studies of Sections 3.2 and 3.3 as a user runs them: time, its parts, runs per second, and memory.

``python benchmarks/studies.py`` prints their times alone; the column "both" is the paper's campaign.
"""

import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table
from timing import least

import rockflex as rf

EXAMPLES = Path(__file__).parents[1] / "examples"
MANY = (2_000, 10_000)  # population runs whose memory is measured

# In a separate process, since the peak of a process never falls.
MEMORY = """
import json, resource, sys, tempfile, time
import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024.population import PopulationStudy
pairs = int(sys.argv[1]) // 2
study = PopulationStudy(pairs=pairs, records={"suites": ["fema-p695-far-field", "fema-p695-near-field-no-pulse"]})
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
computed = []
begun = time.perf_counter()
with tempfile.TemporaryDirectory() as folder:
    table = rf.run_study(study, folder, progress=lambda now: computed.append(peak()))
seconds = time.perf_counter() - begun
print(json.dumps([computed[2], computed[-1], peak(), table.memory_usage(deep=True).sum() / 2**20, seconds]))
"""


@dataclass(frozen=True)
class Timed:
    """Times of one study."""

    name: str
    runs: int
    seconds: float
    one_thread: float


def table() -> Table:
    """Times of the two example studies, saved in folders, and of their parts on one thread."""
    studies = {name: rf.load_study(EXAMPLES / f"{name}.toml") for name in ("cloud", "population")}
    for study in studies.values():
        study.plan().chunk(0)  # compiled, and read from disk
    found = [measure(name, study) for name, study in studies.items()]
    total = Timed("both", *(sum(getattr(each, name) for each in found) for name in ("runs", "seconds", "one_thread")))
    shown = Table("", *(each.name for each in (*found, total)), title="the studies of Sections 3.2 and 3.3 (s)")
    shown.add_row("runs", *(f"{each.runs:,d}" for each in (*found, total)))
    shown.add_row("run_study, all cores, kept in a folder", *(f"{each.seconds:.2f}" for each in (*found, total)))
    shown.add_row("run_study, one thread, in memory", *(f"{each.one_thread:.2f}" for each in (*found, total)))
    shown.add_row("runs a second, all cores", *(f"{each.runs / each.seconds:,.0f}" for each in (*found, total)))
    for label, values in breakdown(studies).items():
        shown.add_row(label, *values)
    return shown


def measure(name: str, study: "rf.CloudStudy | rf.PopulationStudy") -> Timed:
    def kept() -> None:
        with TemporaryDirectory() as folder:
            rf.run_study(study, Path(folder) / "kept")

    return Timed(name, study.plan().n_runs, least(kept, 3), least(lambda: rf.run_study(study, workers=1), 2))


def breakdown(studies: dict[str, "rf.CloudStudy | rf.PopulationStudy"]) -> dict[str, list[str]]:
    """Parts of the time on one thread."""
    loading = [least(study.plan, 3) for study in studies.values()]
    plan = studies["cloud"].plan()
    matrix = plan.matrix
    begun = time.perf_counter()
    for structure in range(len(matrix.names)):
        for record in range(len(matrix.motions)):
            matrix.measures(structure, record)
    measures = time.perf_counter() - begun
    begun = time.perf_counter()
    for structure in range(len(matrix.names)):
        for model in range(len(matrix.labels)):
            matrix.results([(structure, 0, model, 1.0)])
    engines = time.perf_counter() - begun
    population = studies["population"].plan()
    drawn = [rf.draw_prototype(0, number, len(population.motions)).frame() for number in range(population.n_units)]
    begun = time.perf_counter()
    for frame in drawn:
        frame.rocking()
    structures = time.perf_counter() - begun
    return {
        "  of it: structures and records read": [*(f"{each:.2f}" for each in loading), ""],
        "  of it: intensity measures": [f"{measures:.2f}", "", ""],
        "  of it: engines, and a run each": [f"{engines:.2f}", "", ""],
        "  of it: modes of the random frames": ["", f"{structures:.2f}", ""],
    }


def memory() -> str:
    """Peak resident set of large populations, each in a separate process."""
    lines = ["memory of run_study, population, kept in a folder (peak resident set):"]
    for runs in MANY:
        done = subprocess.run([sys.executable, "-c", MEMORY, str(runs)], capture_output=True, text=True, check=True)
        first, last, end, size, seconds = json.loads(done.stdout)
        lines.append(
            f"  {runs:9,d} runs: {first:.0f} MiB after two parts, {last:.0f} after the last, {end:.0f} with the table "
            f"of {size:.0f} MiB read; {seconds:.1f} s, {runs / seconds:,.0f} runs a second"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    Console(width=120).print(table())
