"""The loops of `march.c` for the level of vector instructions of this processor. Declarations: `levels.pxd`."""

import os

import cython

from rockflex.engine import failures

LEVELS = ("", "baseline", "v3", "v4")


def chosen_level():
    """Return the level asked for by the environment variable ROCKFLEX_SIMD; empty for the best one."""
    asked = os.environ.get("ROCKFLEX_SIMD", "")
    if asked not in LEVELS or rockflex_loops(asked.encode()) == cython.NULL:
        raise failures.missing_vector_level_error(asked)
    return asked.encode()


LOOPS = cython.declare(cython.pointer(cython.const[Loops]), rockflex_loops(chosen_level()))
LEVEL, GROUP = LOOPS.level.decode(), LOOPS.group
