"""A population on one and on two threads, with or without Python's interpreter lock: the least of alternating rounds.

Each run has a structure of its own, so what prepares it counts as much as the kernels. Run it by each interpreter to
compare: ``python3.14t benchmarks/threads.py``.
"""

import argparse
import platform
import sys
import time

import numpy as np

import rockflex as rf


def main() -> None:
    """Print the times and their ratio."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=256, help="structures, in chunks of 32")
    parser.add_argument("--rounds", type=int, default=10)
    given = parser.parse_args()
    suite = rf.load_suite("fema-p695-far-field")
    reference = rf.run_population(suite, given.pairs, workers=1)["max_rotation_mdof"].to_numpy(float)
    times: dict[int, list[float]] = {1: [], 2: []}
    for _ in range(given.rounds):
        for workers, found in times.items():
            begun = time.perf_counter()
            table = rf.run_population(suite, given.pairs, workers=workers)
            found.append(time.perf_counter() - begun)
            assert np.array_equal(table["max_rotation_mdof"].to_numpy(float), reference, equal_nan=True)
    one, two = (min(found) for found in times.values())
    locked = getattr(sys, "_is_gil_enabled", lambda: True)()
    print(
        f"Python {platform.python_version()}, interpreter lock {'on' if locked else 'off'}: {2 * given.pairs} runs in "
        f"{one:.2f} s on one thread, {two:.2f} s on two, {one / two:.2f} times as fast"
    )


if __name__ == "__main__":
    main()
