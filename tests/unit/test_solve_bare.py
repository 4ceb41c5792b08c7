"""Structures without elements, prepared by a kernel, against the phases put together part by part."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import Model, Quantities
from rockflex.response import asked_of
from rockflex.solve import Engine
from rockflex.solve.bare import BarePhases
from rockflex.solve.phases import CompiledPhases

DT = 0.01
KEYS = ((0,), (1,), (-1,))
STRUCTURES = {
    "one mode": (1, make_frame()),
    "five modes": (5, make_frame(n_stories=5)),
    "fifteen modes": (15, make_frame(n_stories=15)),
    "undamped": (3, make_frame(n_stories=3, damping_ratio=0.0)),
    "overdamped while rocking": (3, make_frame(n_stories=3, damping_ratio=0.3)),
    "overdamped": (2, make_frame(n_stories=2, damping_ratio=0.99)),
    "stiff": (4, make_frame(n_stories=4, period=0.1)),
    "narrow": (2, make_frame(n_stories=2, aspect_ratio=25.0)),
    "eccentric": (3, rf.Eccentric(make_frame(n_stories=3), 0.2)),
}


def tied(name):
    n, structure = STRUCTURES[name]
    return Model(n, missing_mass=True).of(structure.rocking())


def both(model, quantities, dt=DT):
    bare, general = (
        BarePhases(model, quantities),
        CompiledPhases(model, quantities, Quantities.none(model.layout.modes)),
    )
    for key in KEYS:
        general.place(key)
    assert [bare.place(key) for key in KEYS] == [general.place(key) for key in KEYS]
    fastest = general.fastest
    assert bare.at(dt, fastest, shaken=False) is bare
    return bare.known_system(dt), general.system(dt, fastest)


def size_of(values):
    return np.abs(values).max(initial=1e-300)


@pytest.mark.parametrize("name", STRUCTURES)
@pytest.mark.parametrize("floors", [False, True])
def test_both_ways_prepare_the_same_tables(name, floors):
    model = tied(name)
    bare, general = both(model, asked_of(model, floors=floors))
    facts = [name for name in general.phases.dtype.names if name != "fastest"]
    assert bare.phases[facts].tolist() == general.phases[facts].tolist()
    np.testing.assert_allclose(bare.phases["fastest"], general.phases["fastest"], rtol=1e-12)
    n = model.properties.n_modes
    for field in ("layout", "dt", "turning_row", "chords", "fences", "fenced"):
        assert getattr(bare, field) == getattr(general, field)
    for field in ("links", "limits", "modes", "border", "base", "push", "pulls", "plain_rows"):
        one, other = getattr(bare, field), getattr(general, field)
        scale = np.abs(other).max(axis=tuple(range(1, other.ndim - 1)), keepdims=True) if other.ndim > 2 else 1.0
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-13 * size_of(scale), err_msg=field)
    assert bare.basis.shape[2] == 2 * n + 2


def matrix_of(blocks):
    return np.block([[np.diag(blocks[0]), np.diag(blocks[1])], [np.diag(blocks[2]), np.diag(blocks[3])]])


@pytest.mark.parametrize("name", STRUCTURES)
def test_both_ways_move_alike(name):
    """Coordinates may differ by signs and order; the motion, the rows and the bounds that follow may not."""
    model = tied(name)
    bare, general = both(model, asked_of(model, floors=True))
    for p in range(3):
        ways = []
        for system in (bare, general):
            out, into = (each[:, : each.shape[0]].T for each in system.basis[p])
            level = system.phases[p].levels
            moved = out @ matrix_of(system.blocks[p, level]) @ into
            forced = system.forced[p] @ out.T
            values, slopes = (each.T @ into for each in system.rows[p])
            ways.append((out @ into, moved, forced, values, slopes, system.row_forcing[p]))
        scale = np.sqrt(np.abs(np.diag(general.basis[p, 0] @ general.basis[p, 0].T)).max())
        for one, other in zip(*ways, strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-11 * max(size_of(other), scale * 1e-3))
        level = bare.phases[p].levels
        for kind in range(3):
            one, other = (np.sort(each.bounds[p, kind, level], axis=0) for each in (bare, general))
            np.testing.assert_allclose(one, other, rtol=1e-7, atol=1e-9 * size_of(other))


@pytest.mark.parametrize("n", [1, 3])
def test_peaks_do_not_depend_on_the_way(n):
    motion = rf.load_suite("el-centro-1940")[0].scaled(2.0)
    model = Model(n).of(make_frame(n_stories=3, aspect_ratio=9.0).rocking())
    engine = Engine(model, asked_of(model), many=True)
    assert isinstance(engine._phases, BarePhases)
    found = engine.run(motion.acceleration, motion.dt)
    other = Engine(model, asked_of(model))
    assert isinstance(other._phases, CompiledPhases)
    expected = other.run(motion.acceleration, motion.dt)
    assert (found.n_uplifts, found.n_impacts) == (expected.n_uplifts, expected.n_impacts)
    assert found.n_impacts > 0
    again = other.run(motion.acceleration * (1.0 + 2e-15), motion.dt)  # how far rounding alone takes the peaks
    sensitive = 30.0 * np.abs(again.peaks / expected.peaks - 1.0).max() + 1e-13
    np.testing.assert_allclose(found.peaks, expected.peaks, rtol=sensitive)
