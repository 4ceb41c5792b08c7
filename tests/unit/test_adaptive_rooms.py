"""The engine's books where it integrates: long histories, repeated runs, runs without end."""

import dataclasses

import numpy as np
import pytest

from builders import make_frame
from rockflex import GroundMotion, InitialState, Restitution, SolverError, load_suite, quiet_motion, simulate
from rockflex.models import parse_model
from rockflex.response import asked_of
from rockflex.solve import Engine
from rockflex.solve import engine as module
from rockflex.solve.history import MARGIN

FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=6.0, damping_ratio=0.03)
RECORD = load_suite("el-centro-1940")[0].acceleration[60:160] * 2.5


def engine(label="2DOF-C", **options):
    model = parse_model(label).of(FRAME.rocking(), **options)
    return Engine(model, asked_of(model))


def test_a_history_finds_room_for_all_its_events(monkeypatch):
    """More events than there is room for at first: it grows while the run goes on, which ends the same."""
    options = {"impact": Restitution(0.95, 1e-5), "initial": InitialState(5e-4)}
    roomy = simulate(FRAME, quiet_motion(2.0, dt=0.1), "rigid-C", **options)
    monkeypatch.setattr(module, "EVENTS", 16)
    rooms, carry = [], Engine._carry

    def carried(self, system, steps, course, at, log, *others):
        rooms.append(log.history.shape[0])
        return carry(self, system, steps, course, at, log, *others)

    monkeypatch.setattr(Engine, "_carry", carried)
    run = simulate(FRAME, quiet_motion(2.0, dt=0.1), "rigid-C", **options)
    assert run.n_impacts > 40
    assert run.time.size > 21 + module.EVENTS + MARGIN
    assert rooms == sorted(rooms)
    assert rooms[0] < run.time.size < rooms[-1]
    assert set(np.diff(rooms)) - {0} == {size for size in rooms[:-1] if 2 * size in rooms}  # it doubles
    assert np.array_equal(run.history.states, roomy.history.states)
    assert run.time[-1] == 2.0
    assert simulate(FRAME, quiet_motion(2.0, dt=0.1), "rigid-C", "peaks", **options).peaks() == run.peaks()


def test_an_engine_runs_again_and_again():
    """A run leaves nothing behind: not in the engine, nor in what it was given."""
    mine, record = engine(), RECORD.copy()
    start = np.array([0.01, 0.0, 0.02, 0.0])
    kept = start.copy()
    first = mine.run(record, 0.02, state=start, history=True)
    mine.run(-0.5 * record, 0.01)
    again = mine.run(record, 0.02, state=start, history=True)
    assert np.array_equal(first.states, again.states)
    assert np.array_equal(first.peaks, again.peaks)
    assert np.array_equal(record, RECORD)
    assert np.array_equal(start, kept)
    known = mine._phases.known_system
    assert known(0.02) is known(0.02)
    assert known(0.02) is not known(0.01)
    assert known(0.005) is None


def test_records_of_any_kind_are_taken():
    wanted = engine().run(RECORD, 0.02).peaks
    frozen = RECORD.copy()
    frozen.setflags(write=False)
    for record in (frozen, np.repeat(RECORD, 2)[::2], RECORD.astype(">f8")):
        assert np.array_equal(engine().run(record, 0.02).peaks, wanted)


def test_every_sample_and_event_is_a_node():
    run = engine().run(RECORD, 0.02, history=True)
    times = run.states[:, 0]
    for k in range(RECORD.size):
        at = np.flatnonzero(np.abs(times - 0.02 * k) < 1e-12)
        assert at.size >= 1
        assert run.states[at[-1], 2] == RECORD[k]
    assert times.size == RECORD.size + 2 * (run.n_uplifts + run.n_impacts)
    np.testing.assert_allclose(run.states[:, 2], np.interp(times, 0.02 * np.arange(RECORD.size), RECORD), atol=1e-12)


@pytest.mark.parametrize(
    ("model", "structure", "options"),
    [
        ("2DOF-C", FRAME.rocking(), {}),
        ("rigid-C", FRAME.rocking(), {"impact": Restitution(1.0)}),
    ],
)
def test_what_never_comes_to_rest(model, structure, options):
    """Without damping on the ground, or with impacts that lose nothing."""
    structure = dataclasses.replace(structure, zeta=np.zeros(structure.n_modes))
    start = InitialState(0.03)
    text = rf"^The free vibration of {model} has not settled .* Give free_vibration in seconds, or more damping\.$"
    with pytest.raises(SolverError, match=text):
        simulate(structure, quiet_motion(0.2, dt=0.1), model, "peaks", "settle", initial=start, **options)


def test_impacts_that_lose_nothing_go_on():
    """e = 1 and no flexure: every quarter swing is like the first."""
    for model in ("rigid", "rigid-C"):
        run = simulate(FRAME, quiet_motion(20.0, dt=0.02), model, impact=Restitution(1.0), initial=InitialState(0.05))
        assert run.n_impacts > 8
        gaps = np.diff(run.impact_times)
        np.testing.assert_allclose(gaps, 2.0 * run.impact_times[0], rtol=1e-8)
        energy = run.energy.kinetic + run.energy.gravity
        np.testing.assert_allclose(energy, energy[0], rtol=1e-9)


def test_shaking_that_only_begins_at_its_end():
    """A jump at the last sample acts in the free vibration's first instant only if there is one."""
    motion = GroundMotion(np.array([0.0, 0.0, 6.0]), 0.02)
    run = simulate(FRAME, motion, "2DOF-C")
    assert run.ground_acceleration[-1] == 6.0
    longer = simulate(FRAME, motion, "2DOF-C", free_vibration=0.1)
    k = np.flatnonzero(longer.time == 0.04)
    assert longer.ground_acceleration[k].tolist()[-1] == 0.0
    assert np.array_equal(longer.history.states[: run.time.size - 1], run.history.states[:-1])
