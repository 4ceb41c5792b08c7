"""The same call gives the same bits, whatever ran before it or beside it, and whatever else is asked for."""

import hashlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import rockflex as rf
from builders import BY_HAND
from random_runs import LINEAR, NONLINEAR, RandomRun, linear_run, nonlinear_run

CASES = {kind: (kind, False) for kind in LINEAR} | {f"{kind}, shaken": (kind, True) for kind in LINEAR}
CASES |= {label: label for label in NONLINEAR}


def run_of(name: str) -> RandomRun:
    case = CASES[name]
    if isinstance(case, tuple):
        return linear_run(case[0], 50, shaken=case[1])
    return nonlinear_run(NONLINEAR.index(case) + 50 * len(NONLINEAR))


def told(run: RandomRun, output: str = "peaks", structure=None) -> dict[str, bytes]:
    """Return what a run says: the bits of every peak, of its history if it has one, and its error if it fails."""
    try:
        found = rf.simulate(structure or run.structure(), run.motion, run.model, **run.options | {"output": output})
    except (rf.SolverError, rf.InputError) as error:
        return {"error": str(error).encode()}
    return bits(found) | ({} if found.history is None else {"states": digest(found.history.states)})


def digest(states) -> bytes:
    return hashlib.sha256(np.ascontiguousarray(states)).digest()


def bits(found: rf.Response) -> dict[str, bytes]:
    of_elements = "max_element_force", "max_element_elongation", "element_yielded", "remaining_prestress"
    return {name: bits_of(value) for name, value in found.peaks().items()} | {
        name: getattr(found, name).tobytes() for name in of_elements
    }


def bits_of(value) -> bytes:
    return str(value).encode() if isinstance(value, str) else np.float64(value).tobytes()


def differences(one: dict[str, bytes], other: dict[str, bytes]) -> list[str]:
    """Names of what both say, but differently; all of them if only one is an error."""
    if ("error" in one) != ("error" in other):
        return ["error"]
    return [name for name in one.keys() & other.keys() if one[name] != other[name]]


def rows_of(run: RandomRun, motions, workers: int) -> dict[str, dict[str, bytes]]:
    """Return what a table of runs says of each motion."""
    options = {name: value for name, value in run.options.items() if name != "output"}
    table = rf.simulate_many(run.structure(), motions, run.model, workers=workers, **options)
    found = {}
    for row in table.to_dict("records"):
        error = row.pop("error")
        del row["structure"], row["motion"], row["model"], row["scale"]
        found[len(found)] = {"error": error.encode()} if error else {key: bits_of(row[key]) for key in row}
    return {motion.name: found[place] for place, motion in enumerate(motions)}


def beside(run: RandomRun) -> list[rf.GroundMotion]:
    """Motions that are run before and after that of a run, in the same batch."""
    motion = run.motion
    return [
        rf.GroundMotion(s * motion.acceleration[:n], motion.dt, name=f"{s}", vertical=cut(motion.vertical, n, s))
        for s, n in ((0.3, 900), (-1.7, 1500), (1.2, 400))
    ]


def cut(values, n, factor):
    return None if values is None else factor * values[:n]


def ways(run: RandomRun) -> dict[str, list[str]]:
    """Return what differs from the peaks of a run, by the way in which it is run again."""
    expected, kept, others = told(run), run.structure(), beside(run)
    history = told(run, "history")
    for motion in others:  # they leave the same solver in another state
        told(run._replace(motion=motion), structure=kept)
    found = {
        "again": [told(run)],
        "with a history": [history],
        "on a solver that has run": [told(run, structure=kept), told(run, "history", kept)],
    }
    for workers in (1, 2):
        together = ([run.motion, *others], [*others, run.motion], [others[0], run.motion, *others[1:]])
        found[f"in a table on {workers}"] = [rows_of(run, each, workers)[run.motion.name] for each in together]
    differ = {way: [name for each in all_ for name in differences(expected, each)] for way, all_ in found.items()}
    return differ | {"its history again": differences(history, told(run, "history", kept))}


def on_threads(runs: list[RandomRun], output: str = "peaks") -> list[list[dict[str, bytes]]]:
    """Run all of them on two threads at once: in their order, and the other way."""

    def work(order):
        return {place: told(runs[place], output) for place in order}

    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(work, (range(len(runs)), range(len(runs))[::-1])))
    return [[each[place] for place in range(len(runs))] for each in found]


def in_a_process(names: list[str]) -> list[str]:
    """Run all of them in another process, the other way round, and return what each says as hexadecimal digits."""
    code = f"from test_same_bits import *; print(*[line(told(run_of(each))) for each in {names[::-1]}], sep='\\n')"
    here = Path(__file__).parent
    path = f"import sys; sys.path[:0] = [{str(here)!r}, {str(here.parent)!r}]; {code}"
    done = subprocess.run([sys.executable, "-c", path], check=True, capture_output=True, text=True)
    return done.stdout.split()[::-1]


def line(said: dict[str, bytes]) -> str:
    return hashlib.sha256(b"".join(said[name] for name in sorted(said))).hexdigest()


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_a_run_is_the_same_however_it_is_run(name):
    assert not any(ways(run_of(name)).values())


@pytest.mark.slow
def test_runs_are_the_same_on_two_threads_and_in_another_process():
    runs = [run_of(name) for name in CASES]
    alone = [told(run) for run in runs]
    assert sum("error" in each for each in alone) < len(alone) // 4
    for found in on_threads(runs):
        assert not any(differences(*each) for each in zip(alone, found, strict=True))
    assert [line(each) for each in alone] == in_a_process(list(CASES))


WEIGHT, EDGE = 240e3 * 9.81, 1.2  # of the base below
HELD = {  # by what: the elements whose forces are so many times larger
    "nothing": lambda unit: (),
    "a tendon": lambda unit: (rf.Tendon(0.1 * WEIGHT * unit, WEIGHT * unit),),
    "a fuse": lambda unit: (rf.YieldingDissipator(10.0 * WEIGHT * unit, 0.1 * WEIGHT * unit, 0.02, EDGE),),
    "friction": lambda unit: (rf.FrictionDamper(0.05 * WEIGHT * unit, EDGE),),
}
FORCES = "max_base_moment", "max_base_shear", "max_horizontal_reaction", "min_vertical_reaction"
MOTIONS = "max_rotation", "max_top_displacement", "max_total_top_displacement", "time_of_max_base_moment", "n_impacts"


def in_other_units(model, motion, held, unit):
    """Peaks of a base whose masses and forces are so many times larger, and its forces in that unit."""
    base = {
        **BY_HAND,
        **{name: np.multiply(BY_HAND[name], unit) for name in ("effective_mass", "i_theta", "l0r", "m_tot")},
    }
    found = rf.simulate(
        rf.RockingProperties(**base, elements=HELD[held](unit)), motion, model, "peaks", work_limit=None
    )
    return [getattr(found, name) for name in MOTIONS], [getattr(found, name) / unit for name in FORCES]


@pytest.mark.parametrize("held", HELD)
@pytest.mark.parametrize(
    ("model", "shaken"), [("MDOF-S", False), ("MDOF-S", True), ("2DOF-C", False), ("fixed", False)]
)
def test_forces_in_any_unit_have_the_same_bits(model, shaken, held) -> None:
    motion = rf.load_suite("el-centro-1940")[0]
    if shaken:
        motion = rf.GroundMotion(motion.acceleration, motion.dt, vertical=0.4 * motion.acceleration[::-1])
    expected = in_other_units(model, motion, held, 1.0)
    for power in (-900, -600, -1, 1, 300, 400, 480, 900):
        assert in_other_units(model, motion, held, 2.0**power) == expected, power


@pytest.mark.parametrize("power", [-1000, -700, -600, -200, 200, 500, 900])
def test_any_strength_of_a_motion_has_the_same_bits(power) -> None:
    motion, base = rf.load_suite("el-centro-1940")[0], rf.RockingProperties(**BY_HAND)
    one, other = (rf.simulate(base, motion.scaled(2.0**each), "fixed", "peaks") for each in (0, power))
    for name in ("max_top_displacement", "max_base_moment", "max_base_shear"):
        assert getattr(other, name) / 2.0**power == getattr(one, name)
