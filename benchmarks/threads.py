"""A population on one and on two threads, with or without Python's interpreter lock: the least of alternating rounds.

Each run has a structure of its own, so what prepares it counts as much as the kernels. Run it by each interpreter to
compare: ``python3.14t benchmarks/threads.py``. It needs two idle cores: on a busy machine no time is near the
processor's, and the ratio says nothing; `outside` measures what holds the lock there, too.
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
    parser.add_argument("--pairs", type=int, default=256, help="structures; 384 or fewer are shared piece by piece")
    parser.add_argument("--rounds", type=int, default=10)
    given = parser.parse_args()
    suite = rf.load_suite("fema-p695-far-field")
    reference = rf.run_population(suite, given.pairs, workers=1)["max_rotation_mdof"].to_numpy(float)
    times: dict[int, list[tuple[float, float]]] = {1: [], 2: []}  # of the clock and of the processor
    for _ in range(given.rounds):
        for workers, found in times.items():
            begun, worked = time.perf_counter(), time.process_time()
            table = rf.run_population(suite, given.pairs, workers=workers)
            found.append((time.perf_counter() - begun, time.process_time() - worked))
            assert np.array_equal(table["max_rotation_mdof"].to_numpy(float), reference, equal_nan=True)
    (one, of_one), (two, of_two) = (min(found) for found in times.values())
    locked = getattr(sys, "_is_gil_enabled", lambda: True)()
    print(
        f"Python {platform.python_version()}, interpreter lock {'on' if locked else 'off'}: {2 * given.pairs} runs in "
        f"{one:.2f} s on one thread ({of_one:.2f} s of the processor), {two:.2f} s on two ({of_two:.2f} s), "
        f"{one / two:.2f} times as fast"
    )


if __name__ == "__main__":
    main()
