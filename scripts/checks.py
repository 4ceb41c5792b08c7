"""Run checks by name, one after another: first how long they will take, last what failed.

With `--minutes`, counted from `--since`, a check that would not end by then is left out, and named.
"""

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
STEPS = 3_000_000  # of a loop, by which the speed of this machine is told
SPREAD = 1.4  # machines with the same loop differ by so much


class Check(NamedTuple):
    """A command, and the seconds that it takes on two cores where ten million steps of a Python loop take one."""

    command: str
    seconds: float


PYTEST = "python -m pytest -n {workers} --dist loadgroup -q --no-header"
CHECKS = {
    "environment": Check("make -s .venv/.ready", 65.0),
    "tests": Check(f'{PYTEST} -m "not slow"', 215.0),
    "slow-tests": Check(f"{PYTEST} -m slow", 950.0),
    "slow-validation": Check(f"{PYTEST} -m slow tests/validation tests/engine tests/property", 250.0),
    "slow-web": Check(f"{PYTEST} -m slow tests/web", 450.0),
    "slow-unit": Check(f"{PYTEST} -m slow tests/unit tests/architecture", 650.0),
    "lint": Check("make -s lint", 3.0),
    "types": Check("make -s types", 50.0),
    "docs": Check("make -s docs", 400.0),
    "portable": Check("python scripts/portable_tests.py -n {workers} --dist loadgroup -q", 215.0),
    "newest": Check("make -s test-newest", 330.0),
    "lowest": Check("make -s test-lowest", 250.0),
}


def pace() -> float:
    """Return how many times as long as there checks take here.

    The loop takes 0.4 to 2.3 s on the machines that were tried, and the tests do not differ as much.
    """
    start = time.process_time()
    _ = [i * i for i in range(STEPS)]
    return ((time.process_time() - start) * 1e7 / STEPS) ** 0.67


def minutes(least: float, most: float) -> str:
    """Return a range of seconds in words."""
    low, high = max(1, round(least / 60.0)), max(1, round(most / 60.0))
    return f"{low} to {high} minutes" if low < high else "a minute" if high == 1 else f"{high} minutes"


def main() -> int:
    """Run the checks that are named; 1 if one of them failed."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="+", choices=CHECKS, metavar="CHECK", help=", ".join(CHECKS))
    parser.add_argument("--say", action="store_true", help="say how long the checks will take, and run none")
    parser.add_argument("--workers", default=cores + 1, help="processes that share the tests; one more than cores")
    parser.add_argument("--minutes", type=float, help="time for all checks, from --since on")
    parser.add_argument("--since", type=float, default=time.time(), help="s since 1970; default: now")
    given = parser.parse_args()
    unit = pace()
    if given.say:
        known = unit * sum(CHECKS[name].seconds for name in given.names)
        print(f"{', '.join(given.names)}: {minutes(known / SPREAD, SPREAD * known)} here.", flush=True)
        return 0
    environment = os.environ | {"PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])}
    # The tests start hundreds of processes, each of which would compile anew what it imports.
    if environment.pop("PYTHONDONTWRITEBYTECODE", ""):
        environment["PYTHONPYCACHEPREFIX"] = str(ROOT / ".venv" / "bytecode")
    ended = dict[str, str]()
    for name in given.names:
        command, seconds = CHECKS[name]
        left = None if given.minutes is None else 60.0 * given.minutes - (time.time() - given.since)
        if left is not None and left < (most := SPREAD * unit * seconds):
            ended[name] = f"left out: it takes up to {most:.0f} s, and {max(left, 0.0):.0f} s are left"
            continue
        print(f"\n=== {name}", flush=True)
        start = time.monotonic()
        done = subprocess.run(command.format(workers=given.workers), shell=True, cwd=ROOT, env=environment, check=False)
        ended[name] = f"{'failed' if done.returncode else 'passed'} in {time.monotonic() - start:.0f} s"
    print("\n" + "\n".join(f"{name:10} {how}" for name, how in ended.items()), flush=True)
    return any(how.startswith("failed") for how in ended.values())


if __name__ == "__main__":
    sys.exit(main())
