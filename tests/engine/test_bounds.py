"""What the tables say of a block of samples: no row bends more, or gets further from its chord, than they allow."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg import expm

from rockflex.engine import Event, LinearPhase
from rockflex.engine.loops import GROUP, Phases
from rockflex.engine.preparation import bounds_of
from rockflex.engine.shaken import shaken_of
from rockflex.engine.system import up8
from rockflex.engine.tables import AHEAD, SLOTS

H, BLOCK, FINE = 0.02, 16, 40  # time step, samples that share bounds, and places looked at in a sample
FADING = (-0.8, 0.3), (-2.5, 0.4), (0.0, 0.4, 2.0), (0.0, 0.3, -1.5)
NAMES = ("block", "step", "moves", "now", "outs", "slope", "bend", "cap", "centre", "sway", "jolt")  # as in march.h


def unlaid(flat, rows, columns, group):
    """A table of so many rows from groups of rows that were written column after column."""
    parts, left = [np.zeros((0, columns))], up8(rows)
    while left:
        width = left if left <= group else (left // 8 + 1) // 2 * 8 if left < 2 * group else group
        part, flat = flat[: width * columns], flat[width * columns :]
        parts.append(part.reshape(columns, width).T)
        left -= width
    return np.concatenate(parts)[:rows]


def tables_of(phase):
    """The compiled tables of a stack of phases by name, each with a first axis for the systems."""
    n, m = phase.A.shape[1], phase.d.shape[1]
    rows, known, later = m + len(phase.events), Phases(np.zeros(16), n), n + AHEAD + 2
    known.add(0, phase, H)
    content, places = known.content(0)
    sizes = dict(zip(NAMES, np.diff(places), strict=False))
    bounds = sizes["bend"] // up8(rows)  # columns
    shapes = {"block": (up8(AHEAD * rows) + n, later), "step": (n, n + 3), "moves": (bounds - 2, n + 2)}
    shapes |= dict.fromkeys(("bend", "sway"), (rows, bounds)) | {"jolt": (rows - m, bounds)}
    shapes["cap"] = (rows if sizes["cap"] else 0, bounds)
    found = {
        name: np.array([unlaid(row[places[NAMES.index(name)] :], *shape, GROUP) for row in content])
        for name, shape in shapes.items()
    }
    for name in ("slope", "centre"):  # each row has its own group
        table = content[:, places[NAMES.index(name)] :][:, : sizes[name] // (SLOTS * later) * SLOTS * later]
        found[name] = table.reshape(len(content), -1, later, SLOTS).swapaxes(2, 3)
    return found


def phase_of(rng, turns):
    """Modes that turn by these angles in a sample, hidden behind random coordinates, and four rows.

    A negative angle is a pair of modes that only fade, one three times as fast; 0 is a free mass, which has one vector.
    """
    n = 2 * len(turns)
    modes = np.zeros((n, n))
    for k, turn in enumerate(turns):
        block = [[-0.05 * turn, turn], [-turn, -0.05 * turn]]
        if turn <= 0.0:
            block = [[turn, 0.0], [0.0, 3.0 * turn]] if turn else [[0.0, 1.0], [0.0, 0.0]]
        modes[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = block
    basis = np.linalg.qr(rng.normal(size=(n, n)))[0] + 0.2 * rng.normal(size=(n, n))
    A = basis @ (modes / H) @ np.linalg.inv(basis)
    rest = np.zeros(4)
    return LinearPhase(A, rng.normal(size=n), rng.normal(size=n), rng.normal(size=(4, n)), rest, rest)


@pytest.mark.parametrize("start", ["steady", "ramp", "anywhere"])
@pytest.mark.parametrize("turns", [(0.05, 0.3), (0.3, 1.2, 2.5), (0.1, 8.0), (0.2, 5.0, 60.0), *FADING])
@pytest.mark.parametrize("seed", range(4))
def test_bounds_of_a_block_hold(seed, turns, start):
    rng = np.random.default_rng(seed)
    phase = phase_of(rng, turns)
    A, f, c, C = phase.A, phase.f, phase.c, phase.C
    n, a = len(f), rng.normal(size=BLOCK + 1)
    if start == "ramp":  # in one sample only
        a[1:] = a[1]
    y = rng.normal(size=n) if start == "anywhere" else -np.linalg.pinv(A) @ (f * a[0] + c)
    zero, one = np.zeros(1), np.ones(1)
    conditions = tuple(Event("", row[None], None, zero, zero, one) for row in C)
    stacked = LinearPhase(A[None], f[None], c[None], C[None], phase.d[None], phase.e[None], conditions)
    tables = {name: table[0] for name, table in tables_of(stacked).items()}
    slopes = np.diff(a) / H
    parts = np.abs(tables["moves"] @ np.array((*y, a[0], 1.0)))
    moves = np.array((np.abs(np.diff(a)).sum(), np.abs(slopes).max(), *parts))
    tables["cap"] = tables["cap"] if tables["cap"].size else np.zeros_like(tables["bend"])
    bend, cap, sway, jolt = (tables[name][:4] @ moves for name in ("bend", "cap", "sway", "jolt"))

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
        if cap.any():  # and near what fast modes swing about
            swings = tables["centre"][:4, :2] @ np.array((*y, *a[k : k + 2], *np.zeros(AHEAD - 1), 1.0))
            away = (0.5 * cap + bend) * (1.0 + 1e-9) + 1e-13
            assert ((rows >= swings.min(axis=1) - away) & (rows <= swings.max(axis=1) + away)).all()
        bent, swayed = np.maximum(bent, off), np.maximum(swayed, H**3 / 96.0 * np.abs(third).max(axis=0))
        y = points[-1, :n]
    assert (swayed <= sway * (1.0 + 1e-9) + 1e-13).all()
    if not cap.any():  # and they are of use: within some orders of magnitude
        assert (bend < 1e4 * bent).all()


@pytest.mark.parametrize("turns", [(0.05, 0.3), (0.3, 1.2, 2.5), (0.2, 1.0, 5.0), *FADING])
@pytest.mark.parametrize("seed", range(3))
def test_bounds_of_a_shaken_block_hold(seed, turns):
    """With what is true of p = a_v y, its bounds and those of the rows hold for two such states."""
    rng = np.random.default_rng(seed)
    phase, fed = phase_of(rng, turns), [0, 3]
    A, f, c, C = phase.A, phase.f, phase.c, phase.C
    n = len(f)
    f_v, A_v, C_v = rng.normal(size=n), np.zeros((n, n)), np.zeros((4, n))
    A_v[:, fed], C_v[:, fed] = rng.normal(size=(n, 2)), rng.normal(size=(4, 2))
    a, lift, y = rng.normal(size=BLOCK + 1), rng.normal(size=BLOCK + 1), rng.normal(size=n)
    zero, one = np.zeros(1), np.ones(1)
    events = tuple(
        Event("", row[None], None, zero, zero, one, row_v=more[None], direct_v=zero)
        for row, more in zip(C, C_v, strict=True)
    )
    stacked = LinearPhase(A[None], f[None], c[None], C[None], phase.d[None], phase.e[None], events)
    shaken = {"A_v": A_v[None], "f_v": f_v[None], "C_v": C_v[None], "d_v": np.zeros((1, 4))}
    tables = shaken_of(LinearPhase(**{**vars(stacked), **shaken}), H, bounds_of)
    assert tables.places == fed
    y0 = y
    seen = [np.zeros((0, n)) for _ in range(4)]
    of_rows, of_p, varied = [np.zeros((0, 4)) for _ in range(3)], [np.zeros((0, 2)) for _ in range(4)], np.zeros(2)
    for k in range(BLOCK):
        ramp, rise = (a[k + 1] - a[k]) / H, (lift[k + 1] - lift[k]) / H

        def rate(t, y, k=k, ramp=ramp, rise=rise):
            return A @ y + f * (a[k] + ramp * t) + c + (lift[k] + rise * t) * (A_v @ y + f_v)

        times = np.linspace(0.0, H, FINE + 1)
        path = solve_ivp(rate, (0.0, H), y, "DOP853", rtol=1e-11, atol=1e-14, t_eval=times).y.T
        now = lift[k] + rise * times[:, None]
        v = np.array([rate(*each) for each in zip(times, path, strict=True)])
        p1 = rise * path + now * v
        v1 = v @ A.T + f * ramp + f_v * rise + p1 @ A_v.T
        p2 = 2.0 * rise * v + now * v1
        v2 = v1 @ A.T + p2 @ A_v.T
        p3 = 3.0 * rise * v1 + now * v2
        v3 = v2 @ A.T + p3 @ A_v.T
        p4 = 4.0 * rise * v2 + now * v3
        seen = [np.concatenate(each) for each in zip(seen, (v, v1, v2, v3), strict=True)]
        of_p = [np.concatenate((old, new[:, fed])) for old, new in zip(of_p, (p1, p2, p3, p4), strict=True)]
        rows = v1 @ C.T + p2 @ C_v.T, v2 @ C.T + p3 @ C_v.T, v3 @ C.T + p4 @ C_v.T
        of_rows = [np.concatenate(each) for each in zip(of_rows, rows, strict=True)]
        varied += np.abs(p1[:, fed]).mean(axis=0) * H
        y = path[-1]
    inputs = [np.array((np.abs(np.diff(each)).sum(), np.abs(np.diff(each)).max() / H)) for each in (a, lift)]
    most = [np.abs(each).max(axis=0) for each in of_p]
    parts = np.abs(tables.moves[0] @ np.array((*y0, a[0], 1.0, lift[0], *(lift[0] * y0[fed]))))[
        : tables.bend.shape[2] - 4 - 5 * len(fed)
    ]
    moves = np.concatenate((*inputs, *zip(1.01 * varied, most[0], strict=True), *most[1:], parts))
    for name, values, factor in zip(
        ("bend", "sway", "jolt"), of_rows, (H**2 / 8.0, H**3 / 96.0, H**4 / 384.0), strict=True
    ):
        bound, most = (getattr(tables, name)[0] @ moves)[:4], factor * np.abs(values).max(axis=0)
        assert (most <= bound * (1.0 + 1e-6)).all()
        assert (bound < 1e3 * most).all()
    for order, values in enumerate(seen, 1):
        most = np.abs(values[:, fed]).max(axis=0)
        assert (most <= (getattr(tables, f"swell{order}")[0] @ moves)[:2] * (1.0 + 1e-6)).all()


@pytest.mark.parametrize(("outputs", "conditions"), [(9, 2), (0, 1), (1, 0)])
@pytest.mark.parametrize(
    "turns", [(0.05,), (0.3, 1.2, 2.5), (0.1, 2.95), (0.2, 5.0, 60.0), (*np.arange(0.1, 0.8, 0.1), 4.0, 9.0)]
)
def test_tables_of_samples_are_matrix_exponentials(turns, outputs, conditions):
    """Of all systems of a stack, of which the modes of one turn so far, and of the others farther."""
    rng = np.random.default_rng(7)
    A = np.array([phase_of(rng, np.multiply(turns, share)).A for share in (1.0, 1.03, 1.5)])
    S, n, _ = A.shape
    events = tuple(
        Event("", rng.normal(size=(S, n)), None, rng.normal(size=S), rng.normal(size=S), np.ones(S))
        for _ in range(conditions)
    )
    rest = [rng.normal(size=(S, *shape)) for shape in ((n,), (n,), (outputs, n), (outputs,), (outputs,))]
    stack = LinearPhase(A, *rest, events)
    tables = tables_of(stack)
    for k in range(S):
        f, c, C, d, e = (np.asarray(each[k]) for each in rest)
        C = np.concatenate((C, [event.row[k] for event in events])) if events else C
        d, e = (
            np.append(x, [getattr(event, name)[k] for event in events]) for x, name in ((d, "direct"), (e, "constant"))
        )
        y, a = rng.normal(size=n), rng.normal(size=AHEAD + 1)
        x, start = np.array((*y, *a, 1.0)), y
        G = np.zeros((n + 3, n + 3))  # of y, a, its rise, and 1
        G[:n, :n], G[:n, n], G[:n, n + 2], G[n, n + 1] = A[k] * H, f * H, c * H, 1.0
        move, rows, slopes = expm(G)[:n], [], []
        for i in range(AHEAD + 1):
            rows.append(C @ y + d * a[i] + e)
            slopes.append(C @ (A[k] @ y + f * a[i] + c))
            if i < AHEAD:
                y = move @ np.array((*y, a[i], a[i + 1] - a[i], 1.0))
        R, found = len(C), tables["block"][k] @ x
        size = np.abs(move).sum(axis=1).max() * np.abs(C).sum(axis=1).max(initial=1.0) * np.abs(x).max()
        np.testing.assert_allclose(found[: AHEAD * R].reshape(R, AHEAD).T, rows[1:], atol=1e-11 * size)
        np.testing.assert_allclose(found[up8(AHEAD * R) :], y - start, atol=1e-11 * size)
        at_samples = (tables["slope"][k] @ x)[:, : AHEAD + 1].T
        np.testing.assert_allclose(at_samples, slopes, atol=1e-11 * size * np.abs(A[k]).sum(axis=1).max())
        once = tables["step"][k] @ np.array((*start, *a[:2], 1.0))
        np.testing.assert_allclose(once, move @ np.array((*start, a[0], a[1] - a[0], 1.0)) - start, atol=1e-11 * size)
