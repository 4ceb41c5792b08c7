"""What the tables say of a block of samples: no row bends more, or gets further from its chord, than they allow."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg import expm

from rockflex.engine import Event, LinearPhase
from rockflex.engine.tables import BLOCK, tables_of

H, FINE = 0.02, 40  # time step, and places looked at in a sample


def phase_of(rng, turns):
    """Modes that turn by these angles in a sample, hidden behind random coordinates, and four rows."""
    n = 2 * len(turns)
    modes = np.zeros((n, n))
    for k, turn in enumerate(turns):
        modes[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = [[-0.05 * turn, turn], [-turn, -0.05 * turn]]
    basis = np.linalg.qr(rng.normal(size=(n, n)))[0] + 0.2 * rng.normal(size=(n, n))
    A = basis @ (modes / H) @ np.linalg.inv(basis)
    rest = np.zeros(4)
    return LinearPhase(A, rng.normal(size=n), rng.normal(size=n), rng.normal(size=(4, n)), rest, rest)


@pytest.mark.parametrize("start", ["steady", "ramp", "anywhere"])
@pytest.mark.parametrize("turns", [(0.05, 0.3), (0.3, 1.2, 2.5), (0.1, 8.0), (0.2, 5.0, 60.0)])
@pytest.mark.parametrize("seed", range(4))
def test_bounds_of_a_block_hold(seed, turns, start):
    rng = np.random.default_rng(seed)
    phase = phase_of(rng, turns)
    A, f, c, C = phase.A, phase.f, phase.c, phase.C
    n, a = len(f), rng.normal(size=BLOCK + 1)
    if start == "ramp":  # in one sample only
        a[1:] = a[1]
    y = rng.normal(size=n) if start == "anywhere" else -np.linalg.solve(A, f * a[0] + c)
    zero, one = np.zeros(1), np.ones(1)
    conditions = tuple(Event("", row[None], None, zero, zero, one) for row in C)
    stacked = LinearPhase(A[None], f[None], c[None], C[None], phase.d[None], phase.e[None], conditions)
    tables = tables_of(stacked, H, [])
    slopes = np.diff(a) / H
    parts = np.abs(tables.moves[0] @ np.array((*y, a[0], 1.0)))[: tables.bend.shape[2] - 2]
    moves = np.array((*parts[:n], np.abs(np.diff(a)).sum(), np.abs(slopes).max(), *parts[n:]))
    bend, cap, sway, jolt = (each[0, :4] @ moves for each in (tables.bend, tables.cap, tables.sway, tables.jolt))

    # The same motion in small steps, with y, a, a' and 1 as states.
    G = np.zeros((n + 3, n + 3))
    G[:n, :n], G[:n, n], G[:n, n + 2], G[n, n + 1] = A, f, c, 1.0
    step = expm(G * H / FINE)
    bent, swayed = np.zeros(4), np.zeros(4)
    for k, slope in enumerate(slopes):
        values = [np.array((*y, a[k], slope, 1.0))]
        for _ in range(FINE):
            values.append(step @ values[-1])
        points = np.array(values)
        v = points[:, :n] @ A.T + points[:, n, None] * f + c
        third = (C @ A @ (A @ v.T + (f * slope)[:, None])).T
        rows = points[:, :n] @ C.T
        t = np.linspace(0.0, 1.0, FINE + 1)[:, None]
        chord = rows[0] + t * (rows[-1] - rows[0])
        cubic = CubicHermiteSpline((0.0, 1.0), rows[[0, -1]], H * (C @ v[[0, -1]].T).T)(t[:, 0])
        off, ends = np.abs(rows - chord).max(axis=0), (C @ v[[0, -1]].T).T
        assert (off <= (bend + cap) * (1.0 + 1e-9) + 1e-13).all()
        assert (off <= (np.abs(ends[1] - ends[0]) * H / 8.0 + sway) * (1.0 + 1e-9) + 1e-13).all()
        assert (np.abs(rows - cubic).max(axis=0) <= jolt * (1.0 + 1e-9) + 1e-13).all()
        bent, swayed = np.maximum(bent, off), np.maximum(swayed, H**3 / 96.0 * np.abs(third).max(axis=0))
        y = points[-1, :n]
    assert (swayed <= sway * (1.0 + 1e-9) + 1e-13).all()
    if not cap.any():  # and they are of use: within some orders of magnitude
        assert (bend < 1e4 * bent).all()
